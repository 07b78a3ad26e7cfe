/* --- switches of the law, as numbers that fall below zero --------------------------------------------------------------------- */

#define INDICATORS (GUARDS + 1) /* the law's guards, and the velocity along the direction that it had at the last commit */
#define PAST 1.0e-10            /* a switch is passed by this part of the guard's largest value, so that the law sees it */

typedef struct {
    double armed[INDICATORS]; /* the guard's largest value since the last switch; 0: not armed, so that it announces nothing */
    double direction[2];
} watch;

static int measure(const stochfric_friction *friction, const stochfric_state *state, const stochfric_contact *at, const watch *w,
                   double *guards) {
    guards[GUARDS] = at->velocity[0] * w->direction[0] + at->velocity[1] * w->direction[1];
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
