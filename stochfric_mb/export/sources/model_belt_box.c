/* --- the belt-box as a model: m x'' + c x' + k x = F + k u_0 cos(W t) + external force --------------------------------------- */

#define RATES 3 /* of x, x' and, for laws whose memory is a differential equation, the bristle's deflection */

typedef struct {
    stochfric_friction friction;
    stochfric_state state;
    watch watched;
    double internal_step;
} model;

static int pinned(const model *m) { return IS_HOLDING && m->state.state[0] == 0.0; }

static stochfric_contact contact_at(const model *m, double external, double t, const double *y) {
    const double *box = m->friction.mechanism;
    stochfric_contact at;
    memset(&at, 0, sizeof at);
    const double y_x = y[0], y_v = pinned(m) ? box[BOX_BELT_VELOCITY] : y[1];
    at.time = t;
    at.displacement[0] = motion_slip((double *)box, t, y_x);
    at.velocity[0] = motion_slip_velocity((double *)box, y_v);
    at.normal_force = box[BOX_NORMAL_FORCE];
    at.holding_force[0] = motion_holding_force((double *)box, t, y_x, y_v, external);
    at.effective_mass = box[BOX_MASS];
    return at;
}

static int friction_at(const model *m, const stochfric_contact *at, const double *y, double *force, double *rate) {
    double both[2] = {0.0, 0.0};
    *rate = 0.0;
#ifdef WITH_FLOW
    const int status = stochfric_flow(&m->friction, &m->state, at, y[2], both, rate);
#else
    (void)y;
    const int status = stochfric_force(&m->friction, &m->state, at, both);
#endif
    *force = both[0];
    return status;
}

static int rates_at(const model *m, double external, double t, const double *y, double *dy) {
    double force, rate;
    const double *box = m->friction.mechanism;
    if (pinned(m)) {
        dy[0] = box[BOX_BELT_VELOCITY]; dy[1] = 0.0; dy[2] = 0.0;
        return STOCHFRIC_OK;
    }
    const stochfric_contact at = contact_at(m, external, t, y);
    const int status = friction_at(m, &at, y, &force, &rate);
    dy[0] = y[1];
    dy[1] = (force - at.holding_force[0]) / box[BOX_MASS];
    dy[2] = rate;
    return status;
}

/* Commit an accepted step: the law's state, and the velocity of a box that has come to rest on the belt. */
static int settle(model *m, double external, double t, double *y, int *switched) {
    const stochfric_contact at = contact_at(m, external, t, y);
    double before[INDICATORS];
    int status = measure(&m->friction, &m->state, &at, &m->watched, before);
    if (!status) status = commit_all(&m->friction, &at, &m->state, switched);
    if (status) return status;
#ifdef WITH_FLOW
    m->state.state[BRISTLE] = y[2];
#endif
    if (pinned(m)) y[1] = m->friction.mechanism[BOX_BELT_VELOCITY];
    const stochfric_contact then = contact_at(m, external, t, y);
    return arm(&m->friction, &m->state, &then, before, *switched, &m->watched);
}

/* The classical Runge-Kutta step of size h. */
static int try_step(const model *m, double external, double t, const double *y, double h, double *end) {
    static const double PART[] = {0.0, 0.5, 0.5, 1.0}, WEIGHT[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double k[RATES] = {0.0}, probe[RATES], total[RATES] = {0.0};
    for (int s = 0; s < 4; s++) {
        for (int j = 0; j < RATES; j++) probe[j] = y[j] + PART[s] * h * k[j];
        const int status = rates_at(m, external, t + PART[s] * h, probe, k);
        if (status) return status;
        for (int j = 0; j < RATES; j++) total[j] += WEIGHT[s] * k[j];
    }
    for (int j = 0; j < RATES; j++) end[j] = y[j] + h * total[j];
    return isfinite(end[0] + end[1] + end[2]) ? STOCHFRIC_OK : STOCHFRIC_NOT_FINITE_MOTION;
}

/* Whether a switch has been passed. */
static int crossed(const model *m, double external, double t, const double *y, int *status) {
    double indicators[INDICATORS];
    const stochfric_contact at = contact_at(m, external, t, y);
    *status = indicate(&m->friction, &m->state, &at, &m->watched, indicators);
    for (int i = 0; i < INDICATORS && !*status; i++) if (indicators[i] < 0.0) return 1;
    return 0;
}

/* Go from t to t + h, onto every switch of the law in between, each found on the step size by bisection. */
static int march(model *m, double external, double t, double h, double *y) {
    double done = 0.0;
    for (int located = 0; done < h; ) {
        double end[RATES], low = 0.0, high = h - done;
        int status = try_step(m, external, t + done, y, high, end);
        if (status) return status;
        const int switches = located < MOST_SWITCHES && crossed(m, external, t + done + high, end, &status);
        if (status) return status;
        for (int i = 0; i < 60 && switches && high - low > 1.0e-15 * (1.0 + t); i++) {
            const double middle = 0.5 * (low + high);
            status = try_step(m, external, t + done, y, middle, end);
            if (status) return status;
            if (crossed(m, external, t + done + middle, end, &status)) high = middle; else low = middle;
            if (status) return status;
        }
        if (switches && (status = try_step(m, external, t + done, y, high, end))) return status;
        located += switches;
        memcpy(y, end, sizeof end);
        done = switches ? done + high : h;
        int switched = 0;
        status = settle(m, external, t + done, y, &switched);
        if (status) return status;
    }
    return STOCHFRIC_OK;
}

static void unpack(const double *values, double *y) {
    y[0] = values[VR_POSITION]; y[1] = values[VR_BOX_VELOCITY]; y[2] = values[VR_BRISTLE];
}

static void pack(const double *y, double *values) {
    values[VR_POSITION] = y[0]; values[VR_BOX_VELOCITY] = y[1]; values[VR_BRISTLE] = y[2];
}

#ifdef WITH_DERIVATIVES
/* Put the derivatives of outputs and rates along a direction of states and external force into their places. */
static int model_tangent(const model *m, const double *values, double *tangent) {
    const double *box = m->friction.mechanism, external = values[VR_EXTERNAL_FORCE];
    double y[RATES], dy[RATES], force[2], derivative[2];
    unpack(values, y);
    unpack(tangent, dy);
    if (pinned(m)) dy[1] = 0.0; /* the velocity is the belt's then */
    const stochfric_contact at = contact_at(m, external, values[VR_TIME], y);
    stochfric_contact along;
    memset(&along, 0, sizeof along);
    along.displacement[0] = -dy[0];
    along.velocity[0] = -dy[1];
    along.holding_force[0] = box[BOX_DAMPING] * dy[1] + box[BOX_STIFFNESS] * dy[0] - tangent[VR_EXTERNAL_FORCE];
    double rate = 0.0;
#ifdef WITH_FLOW
    const int status = stochfric_flow_derivative(&m->friction, &m->state, &at, &along, y[2], dy[2], force, derivative, &rate);
#else
    const int status = stochfric_derivative(&m->friction, &m->state, &at, &along, force, derivative);
#endif
    if (status) return status;
    const double rates[RATES] = {dy[1], (derivative[0] - along.holding_force[0]) / box[BOX_MASS], rate};
    for (int j = 0; j < N_STATES; j++) tangent[VR_DERIVATIVES + j] = pinned(m) ? 0.0 : rates[j];
    tangent[VR_FRICTION_FORCE] = derivative[0];
    tangent[VR_MU] = derivative[0] / at.normal_force;
    return STOCHFRIC_OK;
}
#endif

static int model_parameters(model *m, const double *values) {
    m->internal_step = values[VR_STEP];
    return m->internal_step > 0.0 ? STOCHFRIC_OK : STOCHFRIC_RULE + RULE_STEP;
}

static int model_start(model *m, double *values) {
    const double *box = m->friction.mechanism, external = values[VR_EXTERNAL_FORCE];
    double y[RATES] = {box[BOX_INITIAL_POSITION], box[BOX_INITIAL_VELOCITY], 0.0};
    memset(&m->state, 0, sizeof m->state);
    m->state.state[0] = -1.0; /* not pinned yet */
    const stochfric_contact at = contact_at(m, external, values[VR_TIME], y);
    const int status = stochfric_init(&m->friction, &at, &m->state);
    if (status) return status;
#ifdef WITH_FLOW
    y[2] = m->state.state[BRISTLE];
#endif
    if (pinned(m)) y[1] = box[BOX_BELT_VELOCITY];
    pack(y, values);
    const stochfric_contact then = contact_at(m, external, values[VR_TIME], y);
    return arm(&m->friction, &m->state, &then, 0, 1, &m->watched);
}

static int model_outputs(const model *m, double *values) {
    double y[RATES], force, rate;
    int stick;
    unpack(values, y);
    const stochfric_contact at = contact_at(m, values[VR_EXTERNAL_FORCE], values[VR_TIME], y);
    const int status = friction_at(m, &at, y, &force, &rate);
    if (status) return status;
    values[VR_FRICTION_FORCE] = force;
    values[VR_MU] = force / at.normal_force;
    stochfric_report(&m->state, &values[VR_MU_S], &values[VR_MU_K], &stick);
    values[VR_STICK] = stick;
    return STOCHFRIC_OK;
}

static int model_step(model *m, double *values, double time, double h) {
    double y[RATES];
    unpack(values, y);
    const double n = ceil(h / m->internal_step - 1.0e-9);
    for (double i = 0.0; i < n; i += 1.0) {
        const double first = time + i * h / n, last = i + 1.0 < n ? time + (i + 1.0) * h / n : time + h;
        const int status = march(m, values[VR_EXTERNAL_FORCE], first, last - first, y);
        if (status) return status;
    }
    pack(y, values);
    values[VR_TIME] = time + h;
    return STOCHFRIC_OK;
}

static int model_accept(model *m, double *values, int *switched) {
    double y[RATES];
    unpack(values, y);
    const int status = settle(m, values[VR_EXTERNAL_FORCE], values[VR_TIME], y, switched);
    pack(y, values);
    return status;
}

static int model_indicators(const model *m, const double *values, double *indicators) {
    double y[RATES];
    unpack(values, y);
    const stochfric_contact at = contact_at(m, values[VR_EXTERNAL_FORCE], values[VR_TIME], y);
    return indicate(&m->friction, &m->state, &at, &m->watched, indicators);
}

static int model_derivatives(const model *m, const double *values, double *rates) {
    double y[RATES], dy[RATES];
    unpack(values, y);
    const int status = rates_at(m, values[VR_EXTERNAL_FORCE], values[VR_TIME], y, dy);
    for (int j = 0; j < N_STATES; j++) rates[j] = dy[j];
    return status;
}
