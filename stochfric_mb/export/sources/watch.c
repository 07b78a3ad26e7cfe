/* --- switches of the law, as numbers that fall below zero --------------------------------------------------------------------- */

/* The law's guards, the velocity along the direction that it had at the last commit and, where laws without modes draw new
   coefficients at each stick, how far the speed is from the one at which stick begins or ends. */
#define INDICATORS (GUARDS + 2)
#define MOST_COMMITS 20         /* at one instant: a new draw can break the contact away again */
#define PAST 1.0e-10            /* a switch is passed by this part of the guard's largest value, so that the law sees it */

typedef struct {
    double armed[INDICATORS]; /* the guard's largest value since the last switch; 0: not armed, so that it announces nothing */
    double direction[2];
} watch;

/* Whether coefficients are drawn anew at each stick. */
static int draws(const stochfric_friction *friction) {
    return friction->process[0] != 0.0 && friction->process[1] == CLOCK_EVENT;
}

/* Commit until no new draw comes; says whether the contact is in another mode or, where coefficients are drawn, stick has
   begun or ended. */
static int commit_all(const stochfric_friction *friction, const stochfric_contact *at, stochfric_state *state, int *switched) {
    *switched = 0;
    for (int i = 0; i < MOST_COMMITS; i++) {
        const stochfric_state before = *state;
        const int status = stochfric_commit(friction, &before, at, state);
        if (status) return status;
        *switched |= IS_MODED && state->state[0] != before.state[0];
        *switched |= draws(friction) && state->book[STUCK] != before.book[STUCK];
        if (!draws(friction) || state->book[EVENTS_SO_FAR] == before.book[EVENTS_SO_FAR]) break;
    }
    return STOCHFRIC_OK;
}

static int measure(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, const watch *w,
                   double *guards) {
    const double above = hypot(at->velocity[0], at->velocity[1]) - friction->stick_speed[0];
    guards[GUARDS] = at->velocity[0] * w->direction[0] + at->velocity[1] * w->direction[1];
    guards[GUARDS + 1] = !draws(friction) || IS_MODED ? 1.0 : state->book[STUCK] != 0.0 ? -above : above;
    return stochfric_guards(friction, state, at, guards);
}

/* Look at the guards after a commit: those that are positive announce the next switch. One that was negative before the
   commit, `before`, and has not led to another mode is left alone until the next commit: the contact rides on it (a clipped
   deflection under a falling coefficient), and it would announce one switch after the other without end. */
static int arm(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, const double *before,
               int switched, watch *w) {
    double guards[INDICATORS];
    const double speed = hypot(at->velocity[0], at->velocity[1]);
    for (int i = 0; i < 2; i++) w->direction[i] = speed > 0.0 ? at->velocity[i] / speed : 0.0;
    const int status = measure(friction, state, at, w, guards);
    for (int i = 0; i < INDICATORS && !status; i++) {
        if (switched || before[i] < 0.0) w->armed[i] = 0.0;
        if (switched || before[i] >= 0.0) w->armed[i] = fmax(w->armed[i], guards[i]);
    }
    return status;
}

/* The indicators: above zero until a switch has been passed. */
static int indicate(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, const watch *w,
                    double *indicators) {
    const int status = measure(friction, state, at, w, indicators);
    for (int i = 0; i < INDICATORS && !status; i++)
        indicators[i] = w->armed[i] > 0.0 ? indicators[i] + PAST * w->armed[i] : 1.0;
    return status;
}
