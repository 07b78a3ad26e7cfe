/* --- derivatives: the law's own source, translated for numbers that carry their derivative along ------------------------------ */

#define NUDGE 1.0e-100 /* too small to be seen in a force, and not too small to be squared */

/* A relative velocity. At rest its direction, which the laws divide by the speed to get, is that in which it is about to change:
   so a law that is smooth in speed has its slope there, too. */
static dual relative_velocity(const stochfric_contact *at, const stochfric_contact *along, int i) {
    const int rests = at->velocity[0] == 0.0 && at->velocity[1] == 0.0;
    return (dual){rests ? NUDGE * along->velocity[i] : at->velocity[i], along->velocity[i]};
}

/* The derivative of the force along a direction in which the contact changes; its time is not looked at. */
int stochfric_derivative(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at,
                                const stochfric_contact *along, double force[2], double derivative[2]) {
    work w;
    const int status = begin(friction, state, at, &w);
    if (status) return status;
    force[0] = force[1] = derivative[0] = derivative[1] = 0.0;
    if (at->normal_force <= 0.0) return STOCHFRIC_OK;
    const double mass_along = at->effective_mass > 0.0 ? along->effective_mass : 0.0;
    const dual u[] = {{at->displacement[0], along->displacement[0]}, {at->displacement[1], along->displacement[1]}};
    const dual v[] = {relative_velocity(at, along, 0), relative_velocity(at, along, 1)};
    const dual h[] = {{at->holding_force[0], along->holding_force[0]}, {at->holding_force[1], along->holding_force[1]}};
    const dual n = {at->normal_force, along->normal_force}, mass = {w.contact.book[MASS], mass_along};
    const double t = path_canonical_time(at->time, w.contact.book[HALF_STEP]);
    const @MU@ mu = @EVALUATE@(w.friction.process, w.contact.cursor, w.address[0], w.address[1], w.address[2], t, u[0],
                               w.contact.book[EVENTS_SO_FAR]);
    if (w.contact.book[ALIVE] == 0.0)
        call_law(LAW_INIT, t, u[0].v, u[1].v, v[0].v, v[1].v, n.v, mu.a0.v, mu.a1.v, mass.v, h[0].v, h[1].v,
                 address_of(w.contact.state), address_of(w.law), address_of(w.contact.state));
    const @PAIR@ r = @FORCE@(t, u[0], u[1], v[0], v[1], n, w.contact.state, mu.a0, mu.a1, mass, h[0], h[1], w.law);
    force[0] = r.a0.v; force[1] = r.a1.v;
    derivative[0] = r.a0.d; derivative[1] = r.a1.d;
    return isfinite(force[0] + force[1] + derivative[0] + derivative[1]) ? STOCHFRIC_OK : STOCHFRIC_NOT_FINITE_FORCE;
}
@FLOW@