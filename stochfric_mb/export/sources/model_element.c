/* --- the friction element as a model ---------------------------------------------------------------------------------------- */

typedef struct {
    stochfric_friction friction;
    stochfric_state state;
    watch watched;
} model;

static stochfric_contact contact_now(const double *values) {
    stochfric_contact at;
    at.time = values[VR_TIME];
    for (int i = 0; i < 2; i++) {
        at.displacement[i] = values[VR_DISPLACEMENT + i];
        at.velocity[i] = values[VR_VELOCITY + i];
        at.holding_force[i] = values[VR_HOLDING_FORCE + i];
    }
    at.normal_force = values[VR_NORMAL_FORCE];
    at.effective_mass = values[VR_EFFECTIVE_MASS];
    return at;
}

#ifdef WITH_DERIVATIVES
/* Put the derivatives of the outputs along a direction of the inputs into their places. */
static int model_tangent(const model *m, const double *values, double *tangent) {
    double force[2], derivative[2];
    stochfric_contact at = contact_now(values), along = contact_now(tangent);
    const int status = stochfric_derivative(&m->friction, &m->state, &at, &along, force, derivative);
    if (status) return status;
    const double size = hypot(force[0], force[1]), n = at.normal_force;
    tangent[VR_FRICTION_FORCE] = derivative[0];
    tangent[VR_FRICTION_FORCE + 1] = derivative[1];
    tangent[VR_MU] = size > 0.0 ? (force[0] * derivative[0] + force[1] * derivative[1]) / size / n - size / n * along.normal_force / n : 0.0;
    return STOCHFRIC_OK;
}
#endif

static int model_parameters(model *m, const double *values) {
    m->friction.step = values[VR_STEP];
    return STOCHFRIC_OK;
}

static int model_start(model *m, double *values) {
    const stochfric_contact at = contact_now(values);
    const int status = stochfric_init(&m->friction, &at, &m->state);
    return status ? status : arm(&m->friction, &m->state, &at, 0, 1, &m->watched);
}

static int model_outputs(const model *m, double *values) {
    double force[2];
    int stick;
    const stochfric_contact at = contact_now(values);
    const int status = stochfric_force(&m->friction, &m->state, &at, force);
    if (status) return status;
    values[VR_FRICTION_FORCE] = force[0];
    values[VR_FRICTION_FORCE + 1] = force[1];
    values[VR_MU] = at.normal_force > 0.0 ? hypot(force[0], force[1]) / at.normal_force : 0.0;
    stochfric_report(&m->state, &values[VR_MU_S], &values[VR_MU_K], &stick);
    values[VR_STICK] = stick;
    return STOCHFRIC_OK;
}

/* The inputs are those at the end of the step; the step is accepted. */
static int model_step(model *m, double *values, double time, double h) {
    values[VR_TIME] = time + h;
    const stochfric_contact at = contact_now(values);
    double force[2];
    const int status = stochfric_commit(&m->friction, &m->state, &at, &m->state);
    return status ? status : stochfric_force(&m->friction, &m->state, &at, force);
}

static int model_accept(model *m, double *values, int *switched) {
    const stochfric_contact at = contact_now(values);
    const double alive = m->state.book[ALIVE];
    double before[INDICATORS];
    int status = measure(&m->friction, &m->state, &at, &m->watched, before);
    if (!status) status = commit_all(&m->friction, &at, &m->state, switched);
    *switched |= m->state.book[ALIVE] != alive;
    return status ? status : arm(&m->friction, &m->state, &at, before, *switched, &m->watched);
}

static int model_indicators(const model *m, const double *values, double *indicators) {
    const stochfric_contact at = contact_now(values);
    return indicate(&m->friction, &m->state, &at, &m->watched, indicators);
}

static int model_derivatives(const model *m, const double *values, double *rates) {
    (void)m; (void)values; (void)rates;
    return STOCHFRIC_OK;
}
