/* --- an instance of the FMU: what FMI 2 and FMI 3 have in common ------------------------------------------------------------ */

typedef enum { INSTANTIATED, INITIALIZING, EVENTS, CONTINUOUS, STEPPING, TERMINATED } phase;

/* All that changes: the state of the FMU, which is saved and restored as it stands. */
typedef struct {
    double values[N_VARIABLES + 1];      /* the last one is for what this FMU does not have */
    model model;
    int phase, prepared;
} memory;

typedef struct {
    memory now;
    int co_simulation, logging;
    void *environment;
    void *logger;
    char name[256];
} instance;

static const char KINDS[] = VARIABLE_KINDS;         /* of each variable: (t)ime, (p)arameter, (i)nput, (o)utput, (x) state, (d)erivative, (z) indicator */
static const char TYPES[] = VARIABLE_TYPES;         /* of each variable: (r)eal, (n)umber, (b)oolean */
static const double STARTS[] = VARIABLE_STARTS;

static void say(const instance *c, int status, const char *message);

/* Report a status of the friction code; returns whether it is an error. */
static int failed(const instance *c, int status) {
    if (status == STOCHFRIC_OK) return 0;
    say(c, status, stochfric_message(status));
    return 1;
}

static int refused(const instance *c, const char *message) {
    say(c, -1, message);
    return 1;
}

static void clear(instance *c) {
    memset(&c->now, 0, sizeof c->now);
    memcpy(c->now.values, STARTS, sizeof STARTS);
    stochfric_defaults(&c->now.model.friction);
    c->now.phase = INSTANTIATED;
}

static instance *make(const char *name, const char *token, int co_simulation, int logging, void *environment, void *logger) {
    instance *c = calloc(1, sizeof *c);
    if (!c) return 0;
    c->co_simulation = co_simulation;
    c->logging = logging;
    c->environment = environment;
    c->logger = logger;
    if (name) strncpy(c->name, name, sizeof c->name - 1);
    clear(c);
    if (!name || !name[0]) { refused(c, "the instance has no name; give one"); free(c); return 0; }
    if (!token || strcmp(token, TOKEN) != 0) {
        refused(c, "this binary belongs to another modelDescription.xml: the token differs; export the FMU again");
        free(c);
        return 0;
    }
    return c;
}

/* Put the parameters where the equations read them. */
static int prepare(instance *c) {
    memory *m = &c->now;
    if (m->prepared) return 0;
    for (int i = 0; i < STOCHFRIC_VALUES; i++) m->model.friction.values[i] = m->values[FIRST_PARAMETER + i];
    m->model.friction.seed = (int64_t)m->values[VR_SEED];
    m->model.friction.sample = (int64_t)m->values[VR_SAMPLE];
    m->model.friction.contact = (int64_t)m->values[VR_CONTACT];
    if (failed(c, model_parameters(&m->model, m->values)) || failed(c, stochfric_prepare(&m->model.friction))) return 1;
    m->prepared = 1;
    return 0;
}

static int start(instance *c) {
    if (prepare(c) || failed(c, model_start(&c->now.model, c->now.values))) return 1;
    c->now.phase = c->co_simulation ? STEPPING : EVENTS;
    return 0;
}

/* Compute outputs and derivatives. */
static int computed(const instance *c, memory *m) {
    double rates[N_STATES + 1];
    if (failed(c, model_outputs(&m->model, m->values)) || failed(c, model_derivatives(&m->model, m->values, rates))) return 1;
    for (int i = 0; i < N_STATES; i++) m->values[VR_DERIVATIVES + i] = rates[i];
    return failed(c, model_indicators(&m->model, m->values, m->values + VR_INDICATORS));
}

static int evaluate(instance *c) {
    if (prepare(c)) return 1;
    if (c->now.phase <= INITIALIZING) {   /* what the outputs would be if the motion began now */
        memory trial = c->now;
        if (failed(c, model_start(&trial.model, trial.values)) || computed(c, &trial)) return 1;
        for (int i = 0; i < N_VARIABLES; i++) if (strchr("odxz", KINDS[i])) c->now.values[i] = trial.values[i];
        return 0;
    }
    return computed(c, &c->now);
}

static int get_values(instance *c, const unsigned int *vr, size_t n, char type, double *out) {
    for (size_t i = 0; i < n; i++)
        if (vr[i] >= N_VARIABLES || TYPES[vr[i]] != type) return refused(c, "a value reference names no variable of this type");
    for (size_t i = 0; i < n; i++)
        if (strchr(c->now.phase <= INITIALIZING ? "odxz" : "odz", KINDS[vr[i]])) { if (evaluate(c)) return 1; break; }
    for (size_t i = 0; i < n; i++) out[i] = c->now.values[vr[i]];
    return 0;
}

static int set_values(instance *c, const unsigned int *vr, size_t n, char type, const double *in) {
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= N_VARIABLES || TYPES[vr[i]] != type) return refused(c, "a value reference names no variable of this type");
        const char kind = KINDS[vr[i]];
        if (strchr("odxzt", kind)) return refused(c, "this variable is computed by the FMU and cannot be set");
        if (kind == 'p' && c->now.phase > INITIALIZING) return refused(c, "parameters are fixed after the initialisation; reset the FMU first");
        if (!isfinite(in[i])) return refused(c, "a value that was set is not finite (NaN or infinity); it was not taken");
    }
    for (size_t i = 0; i < n; i++) {
        c->now.values[vr[i]] = in[i];
        if (KINDS[vr[i]] == 'p') c->now.prepared = 0;
    }
    return 0;
}

static int step(instance *c, double time, double h) {
    if (c->now.phase != STEPPING) return refused(c, "a step was asked for outside of the step mode");
    if (!isfinite(time) || !isfinite(h) || h < 0.0) return refused(c, "time or size of the step is not finite, or the step is negative");
    memory after = c->now;
    if (failed(c, model_step(&after.model, after.values, time, h))) return 1;
    c->now = after;
    return 0;
}

/* Time of the next kink of the coefficients, where they run along time; returns whether there is one. */
static int next_kink(const memory *m, double *time) {
    const double *process = m->model.friction.process, spacing = process[3];
    if (process[0] == 0.0 || process[1] != 0.0) return 0;
    *time = (floor(m->values[VR_TIME] / spacing + 1.0e-9) + 1.0) * spacing;
    return 1;
}

/* An accepted step of a solver in model exchange. */
static int accepted(instance *c, int *switched) {
    memory after = c->now;
    if (failed(c, model_accept(&after.model, after.values, switched))) return 1;
    c->now = after;
    return 0;
}

/* --- saving and restoring --------------------------------------------------------------------------------------------------- */

typedef struct { uint64_t mark, size; memory saved; } record;

static int save(instance *c, void **state) {
    record *saved = *state ? *state : calloc(1, sizeof *saved);
    if (!saved) return refused(c, "there is no memory to save the state");
    saved->mark = MARK;
    saved->size = sizeof *saved;
    saved->saved = c->now;
    *state = saved;
    return 0;
}

static int restore(instance *c, const void *state) {
    const record *saved = state;
    if (!saved || saved->mark != MARK || saved->size != sizeof *saved) return refused(c, "this is no state of this FMU");
    c->now = saved->saved;
    return 0;
}

static int serialized(instance *c, const void *state, void *bytes, size_t size) {
    if (!state || size < sizeof(record)) return refused(c, "the room for a serialised state is too small");
    memcpy(bytes, state, sizeof(record));
    return 0;
}

static int deserialized(instance *c, const void *bytes, size_t size, void **state) {
    record copy;
    if (!bytes || size < sizeof copy) return refused(c, "a serialised state is too short");
    memcpy(&copy, bytes, sizeof copy);
    if (copy.mark != MARK || copy.size != sizeof copy) return refused(c, "this is no serialised state of this FMU");
    record *saved = *state ? *state : malloc(sizeof *saved);
    if (!saved) return refused(c, "there is no memory to restore the state");
    *saved = copy;
    *state = saved;
    return 0;
}

/* --- continuous states ------------------------------------------------------------------------------------------------------- */

static int counted(const instance *c, size_t n, size_t expected) { return n != expected && refused(c, "the number of entries is wrong"); }

static int set_states(instance *c, const double *x, size_t n) {
    if (counted(c, n, N_STATES)) return 1;
    for (size_t i = 0; i < n; i++) if (!isfinite(x[i])) return refused(c, "a state that was set is not finite (NaN or infinity)");
    for (size_t i = 0; i < n; i++) c->now.values[VR_STATES + i] = x[i];
    return 0;
}

static int get_states(instance *c, double *x, size_t n) {
    if (counted(c, n, N_STATES)) return 1;
    for (size_t i = 0; i < n; i++) x[i] = c->now.values[VR_STATES + i];
    return 0;
}

static int get_rates(instance *c, double *x, size_t n) {
    return counted(c, n, N_STATES) || (n > 0 && failed(c, model_derivatives(&c->now.model, c->now.values, x)));
}

static int get_indicators(instance *c, double *z, size_t n) {
    return counted(c, n, INDICATORS) || failed(c, model_indicators(&c->now.model, c->now.values, z));
}

static int get_nominals(instance *c, double *x, size_t n) {
    static const double nominals[] = NOMINALS;
    if (counted(c, n, N_STATES)) return 1;
    memcpy(x, nominals, n * sizeof x[0]);
    return 0;
}

/* --- derivatives --------------------------------------------------------------------------------------------------------------- */

static int directional(instance *c, const unsigned int *unknown, size_t n_unknown, const unsigned int *known, size_t n_known,
                       const double *seed, double *out) {
#ifdef WITH_DERIVATIVES
    double tangent[N_VARIABLES + 1] = {0.0};
    if (c->now.phase <= INITIALIZING) return refused(c, "derivatives are to be had after the initialisation");
    for (size_t i = 0; i < n_known; i++) {
        if (known[i] >= N_VARIABLES || !strchr("ix", KINDS[known[i]])) return refused(c, "derivatives are to be had for inputs and states alone");
        tangent[known[i]] = seed[i];
    }
    for (size_t i = 0; i < n_unknown; i++)
        if (unknown[i] >= N_VARIABLES || !strchr("oxd", KINDS[unknown[i]])) return refused(c, "outputs and rates of states alone have derivatives");
    if (prepare(c) || failed(c, model_tangent(&c->now.model, c->now.values, tangent))) return 1;
    for (size_t i = 0; i < n_unknown; i++) out[i] = tangent[unknown[i]];
    return 0;
#else
    (void)unknown; (void)n_unknown; (void)known; (void)n_known; (void)seed; (void)out;
    return refused(c, "this FMU has no directional derivatives");
#endif
}
