
#ifdef WITH_FLOW
/* The same for solvers that integrate the bristle themselves, with the derivative of its rate. */
static int stochfric_flow_derivative(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at,
                                     const stochfric_contact *along, double deflection, double deflection_along,
                                     double force[2], double derivative[2], double *rate_derivative) {
    work w;
    const int status = begin(friction, state, at, &w);
    if (status) return status;
    const dual u = {at->displacement[0], along->displacement[0]}, n = {at->normal_force, along->normal_force};
    const dual v[] = {relative_velocity(at, along, 0), relative_velocity(at, along, 1)};
    const dual z = {deflection, deflection_along}, none = {0.0, 0.0};
    const @MU@ mu = @EVALUATE@(w.friction.process, w.contact.cursor, w.address[0], w.address[1], w.address[2],
                               path_canonical_time(at->time, w.contact.book[HALF_STEP]), u, w.contact.book[EVENTS_SO_FAR]);
    const @FLOWN@ r = @FLOW_NAME@(v[0], v[1], n, z, none, mu.a0, mu.a1, w.law);
    force[0] = r.a0.v; force[1] = r.a1.v;
    derivative[0] = r.a0.d; derivative[1] = r.a1.d;
    *rate_derivative = r.a2.d;
    return isfinite(derivative[0] + derivative[1] + *rate_derivative) ? STOCHFRIC_OK : STOCHFRIC_NOT_FINITE_FORCE;
}
#endif
