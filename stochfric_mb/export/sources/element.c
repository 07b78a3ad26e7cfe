/* --- the element ------------------------------------------------------------------------------------------------------- */

/* What one call works on: copies, so that nothing that was given changes. */
typedef struct {
    stochfric_state contact;
    stochfric_friction friction;
    double law[N_LAW + 3], out[MAX_STATE + GUARDS];
    int64_t address[3];
} work;

static int64_t address_of(void *pointer) { return (int64_t)(intptr_t)pointer; }

static int begin(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, work *w) {
    const double all = at->time + at->displacement[0] + at->displacement[1] + at->velocity[0] + at->velocity[1]
                     + at->normal_force + at->holding_force[0] + at->holding_force[1] + at->effective_mass;
    if (!isfinite(all)) return STOCHFRIC_NOT_FINITE_INPUT;
    if (at->normal_force < 0.0) return STOCHFRIC_NEGATIVE_NORMAL_FORCE;
    if (at->effective_mass < 0.0) return STOCHFRIC_NEGATIVE_MASS;
    memset(w, 0, sizeof *w);
    w->friction = *friction;
    if (state) w->contact = *state;
    w->contact.book[MASS] = at->effective_mass > 0.0 ? at->effective_mass : friction->effective_mass;
    w->contact.book[HALF_STEP] = 0.5 * friction->step;
    w->contact.book[STICK_SPEED] = friction->stick_speed[0];
    w->contact.book[MODED] = IS_MODED;
    w->address[0] = friction->seed; w->address[1] = friction->sample; w->address[2] = friction->contact;
#ifdef WITH_EFFECTS
    w->friction.model[INNER_P] = (double)address_of(w->friction.law);
    w->friction.model[MODEL_SEED] = (double)friction->seed;
    w->friction.model[MODEL_SAMPLE] = (double)friction->sample;
#ifndef WITH_MECHANISM
    if (at->normal_force > 0.0) w->friction.model[MODEL_NORMAL_FORCE] = at->normal_force; /* one contact carries it all */
#endif
    w->law[0] = friction->law[0]; w->law[1] = friction->law[1];
    w->law[2] = (double)address_of(w->friction.model);
#else
    memcpy(w->law, friction->law, sizeof friction->law);
#endif
    return STOCHFRIC_OK;
}

#define ARGUMENTS(numbers) numbers, w.address, w.friction.process, w.contact.cursor, w.law, w.contact.state, w.contact.book, \
    w.out, at->time, at->displacement[0], at->displacement[1], at->velocity[0], at->velocity[1], at->normal_force, \
    at->holding_force[0], at->holding_force[1]

void stochfric_defaults(stochfric_friction *friction) {
    memset(friction, 0, sizeof *friction);
    static const double values[] = VALUES, law[] = LAW, process[] = PROCESS, model[] = MODEL, mechanism[] = MECHANISM;
    memcpy(friction->values, values, sizeof friction->values);
    memcpy(friction->law, law, sizeof friction->law);
    memcpy(friction->process, process, sizeof friction->process);
    memcpy(friction->model, model, sizeof friction->model);
    memcpy(friction->mechanism, mechanism, sizeof friction->mechanism);
    friction->stick_speed[0] = DEFAULT_STICK_SPEED;
    friction->effective_mass = DEFAULT_MASS;
    (void)stochfric_prepare(friction);
}

int stochfric_prepare(stochfric_friction *friction) {
    const double *values = friction->values;
    const int broken = broken_rule(values);
    if (broken) return STOCHFRIC_RULE + broken;
    if (!(friction->effective_mass > 0.0) || !isfinite(friction->effective_mass)) return STOCHFRIC_RULE + RULE_MASS;
    if (!(friction->step >= 0.0) || !isfinite(friction->step)) return STOCHFRIC_RULE + RULE_STEP;
    if ((friction->seed | friction->sample | friction->contact) >> 32) return STOCHFRIC_RULE + RULE_ADDRESS;
    spread(friction, values);
    const double *process = friction->process; /* kind, ..., 4: mu_s, mu_k, sigma_s, sigma_k */
    if (process[0] != 0.0 && process[4] - process[5] < 0.25 * hypot(process[6], process[7])) return STOCHFRIC_RULE + RULE_FEASIBLE;
    return STOCHFRIC_OK;
}

int stochfric_init(const stochfric_friction *friction, const stochfric_contact *at, stochfric_state *state) {
    work w;
    int64_t functions[] = {LAW_INIT, LAW_FORCE, LAW_COMMIT, N_STATE};
    const int status = begin(friction, 0, at, &w);
    if (status) return status;
    contact_start(ARGUMENTS(functions));
    *state = w.contact;
    return STOCHFRIC_OK;
}

int stochfric_force(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, double force[2]) {
    work w;
    int64_t functions[] = {LAW_INIT, LAW_FORCE, LAW_COMMIT, N_STATE};
    const int status = begin(friction, state, at, &w);
    if (status) return status;
    contact_compute(ARGUMENTS(functions));
    if (!isfinite(w.out[0] + w.out[1])) return STOCHFRIC_NOT_FINITE_FORCE;
    force[0] = w.out[0];
    force[1] = w.out[1];
    return STOCHFRIC_OK;
}

int stochfric_commit(const stochfric_friction *friction, const stochfric_state *before, const stochfric_contact *at,
                     stochfric_state *after) {
    work w;
    int64_t functions[] = {LAW_INIT, LAW_FORCE, LAW_COMMIT, N_STATE};
    const int status = begin(friction, before, at, &w);
    if (status) return status;
    contact_commit(ARGUMENTS(functions));
    *after = w.contact;
    return STOCHFRIC_OK;
}

#ifdef WITH_FLOW
/* Force and rate of the bristle at a given deflection, for solvers that integrate it themselves. */
static int stochfric_flow(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at,
                          double deflection, double force[2], double *rate) {
    work w;
    const int status = begin(friction, state, at, &w);
    if (status) return status;
    const tuple_d2 mu = path_evaluate(w.friction.process, w.contact.cursor, w.address[0], w.address[1], w.address[2],
                                      path_canonical_time(at->time, w.contact.book[HALF_STEP]), at->displacement[0],
                                      w.contact.book[EVENTS_SO_FAR]);
    const tuple_d4 r = LAW_FLOW(at->velocity[0], at->velocity[1], at->normal_force, deflection, 0.0, mu.a0, mu.a1, w.law);
    force[0] = r.a0;
    force[1] = r.a1;
    *rate = r.a2;
    return isfinite(r.a0 + r.a1 + r.a2) ? STOCHFRIC_OK : STOCHFRIC_NOT_FINITE_FORCE;
}
#endif

int stochfric_guards(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at,
                     double guards[GUARDS]) {
    work w;
    int64_t functions[] = {LAW_INIT, LAW_GUARDS, LAW_COMMIT, N_STATE};
    const int status = begin(friction, state, at, &w);
    if (status) return status;
    for (int i = 0; i < GUARDS; i++) guards[i] = 1.0;
    if (at->normal_force <= 0.0) return STOCHFRIC_OK;
    contact_compute(ARGUMENTS(functions));
    memcpy(guards, w.out, GUARDS * sizeof guards[0]);
    return STOCHFRIC_OK;
}

void stochfric_report(const stochfric_state *state, double *mu_s, double *mu_k, int *stick) {
    *mu_s = state->book[BOOK_MU_S];
    *mu_k = state->book[BOOK_MU_K];
    *stick = state->book[STUCK] != 0.0;
}

const char *stochfric_message(int status) {
    switch (status) {
        case STOCHFRIC_OK: return "";
        case STOCHFRIC_NOT_FINITE_INPUT: return "what the solver gives is not finite; the motion has broken down: use a smaller step";
        case STOCHFRIC_NEGATIVE_NORMAL_FORCE: return "the normal force is negative; give 0 where the bodies do not touch";
        case STOCHFRIC_NOT_FINITE_FORCE: return "the friction force is not finite; the motion has broken down: use a smaller step";
        case STOCHFRIC_NOT_FINITE_MOTION: return "the motion is not finite; use a smaller internal step";
        case STOCHFRIC_NEGATIVE_MASS: return "the effective mass is negative; give the mass that the contact feels";
        case STOCHFRIC_RULE + RULE_FEASIBLE:
            return "mu_s and mu_k are less than a quarter of their joint standard deviation apart: give smaller sigma_s, sigma_k";
        case STOCHFRIC_RULE + RULE_MASS: return "effective_mass is out of range: effective_mass must be > 0";
        case STOCHFRIC_RULE + RULE_STEP: return "step is out of range: step must be >= 0";
        case STOCHFRIC_RULE + RULE_ADDRESS: return "seed, sample or contact is out of range: each must be in [0, 2^32)";
        default: return rule_message(status - STOCHFRIC_RULE);
    }
}
