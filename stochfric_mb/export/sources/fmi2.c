/* --- FMI 2.0 ---------------------------------------------------------------------------------------------------------------- */

typedef void (*logger2)(void *environment, const char *name, fmi2Status status, const char *category, const char *message, ...);

static void say(const instance *c, int status, const char *message) {
    (void)status;
    if (c->logger) ((logger2)c->logger)(c->environment, c->name, fmi2Error, "error", message);
}

static fmi2Status status(int bad) { return bad ? fmi2Error : fmi2OK; }

#define INSTANCE(c) instance *i = (instance *)(c); if (!i) return fmi2Error

FMI2_Export const char *fmi2GetTypesPlatform(void) { return "default"; }
FMI2_Export const char *fmi2GetVersion(void) { return "2.0"; }

FMI2_Export fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
    INSTANCE(c);
    (void)n; (void)categories;
    i->logging = on;
    return fmi2OK;
}

FMI2_Export fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    (void)resources; (void)visible;
    return make(name, token, type == fmi2CoSimulation, logging, functions ? functions->componentEnvironment : 0,
                functions ? (void *)functions->logger : 0);
}

FMI2_Export void fmi2FreeInstance(fmi2Component c) { free(c); }

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean with_tolerance, fmi2Real tolerance, fmi2Real start_time,
                                           fmi2Boolean with_stop, fmi2Real stop) {
    INSTANCE(c);
    (void)with_tolerance; (void)tolerance; (void)with_stop; (void)stop;
    if (!isfinite(start_time)) return status(refused(i, "the start time is not finite"));
    i->now.values[VR_TIME] = start_time;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    INSTANCE(c);
    i->now.phase = INITIALIZING;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2ExitInitializationMode(fmi2Component c) { INSTANCE(c); return status(start(i)); }
FMI2_Export fmi2Status fmi2Terminate(fmi2Component c) { INSTANCE(c); i->now.phase = TERMINATED; return fmi2OK; }
FMI2_Export fmi2Status fmi2Reset(fmi2Component c) { INSTANCE(c); clear(i); return fmi2OK; }

FMI2_Export fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
    INSTANCE(c);
    return status(get_values(i, vr, n, 'r', value));
}

FMI2_Export fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
    INSTANCE(c);
    return status(set_values(i, vr, n, 'r', value));
}

#define ACCESS2(NAME, LETTER) \
    FMI2_Export fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2##NAME value[]) { \
        INSTANCE(c); \
        for (size_t k = 0; k < n; k++) { \
            double x; \
            if (get_values(i, &vr[k], 1, LETTER, &x)) return fmi2Error; \
            value[k] = (fmi2##NAME)x; \
        } \
        return fmi2OK; \
    } \
    FMI2_Export fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2##NAME value[]) { \
        INSTANCE(c); \
        for (size_t k = 0; k < n; k++) { \
            const double x = value[k]; \
            if (set_values(i, &vr[k], 1, LETTER, &x)) return fmi2Error; \
        } \
        return fmi2OK; \
    }
ACCESS2(Integer, 'n')
ACCESS2(Boolean, 'b')

FMI2_Export fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    INSTANCE(c);
    (void)vr; (void)value;
    return status(n > 0 && refused(i, "this FMU has no strings"));
}

FMI2_Export fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    INSTANCE(c);
    (void)vr; (void)value;
    return status(n > 0 && refused(i, "this FMU has no strings"));
}

FMI2_Export fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) { INSTANCE(c); return status(save(i, state)); }
FMI2_Export fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { INSTANCE(c); return status(restore(i, state)); }
FMI2_Export fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    (void)c;
    if (state) { free(*state); *state = 0; }
    return fmi2OK;
}
FMI2_Export fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    (void)c; (void)state;
    *size = sizeof(record);
    return fmi2OK;
}
FMI2_Export fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    INSTANCE(c);
    return status(serialized(i, state, bytes, size));
}
FMI2_Export fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    INSTANCE(c);
    return status(deserialized(i, bytes, size, state));
}

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t n_unknown,
                                                    const fmi2ValueReference known[], size_t n_known, const fmi2Real d_known[],
                                                    fmi2Real d_unknown[]) {
    INSTANCE(c);
    return status(directional(i, unknown, n_unknown, known, n_known, d_known, d_unknown));
}

FMI2_Export fmi2Status fmi2EnterEventMode(fmi2Component c) { INSTANCE(c); i->now.phase = EVENTS; return fmi2OK; }
FMI2_Export fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { INSTANCE(c); i->now.phase = CONTINUOUS; return fmi2OK; }

FMI2_Export fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    INSTANCE(c);
    int switched = 0;
    double next = 0.0;
    if (accepted(i, &switched)) return fmi2Error;
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = N_STATES > 0;
    info->nextEventTimeDefined = next_kink(&i->now, &next);
    info->nextEventTime = next;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_return, fmi2Boolean *event, fmi2Boolean *stop) {
    INSTANCE(c);
    int switched = 0;
    (void)no_return;
    *stop = fmi2False;
    *event = fmi2False;
    if (accepted(i, &switched)) return fmi2Error;
    *event = switched ? fmi2True : fmi2False;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    INSTANCE(c);
    if (!isfinite(time)) return status(refused(i, "the time is not finite"));
    i->now.values[VR_TIME] = time;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) { INSTANCE(c); return status(set_states(i, x, n)); }
FMI2_Export fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { INSTANCE(c); return status(get_states(i, x, n)); }
FMI2_Export fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real x[], size_t n) { INSTANCE(c); return status(get_rates(i, x, n)); }
FMI2_Export fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) { INSTANCE(c); return status(get_indicators(i, z, n)); }
FMI2_Export fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { INSTANCE(c); return status(get_nominals(i, x, n)); }

FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                   const fmi2Integer order[], const fmi2Real value[]) {
    INSTANCE(c);
    (void)vr; (void)n; (void)order; (void)value;
    return status(refused(i, "this FMU does not interpolate its inputs"));
}
FMI2_Export fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                                    const fmi2Integer order[], fmi2Real value[]) {
    INSTANCE(c);
    (void)vr; (void)n; (void)order; (void)value;
    return status(refused(i, "this FMU has no derivatives of its outputs"));
}

FMI2_Export fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real h, fmi2Boolean no_return) {
    INSTANCE(c);
    (void)no_return;
    return status(step(i, time, h));
}
FMI2_Export fmi2Status fmi2CancelStep(fmi2Component c) { INSTANCE(c); return status(refused(i, "steps are never pending")); }

#define STATUS2(NAME) \
    FMI2_Export fmi2Status fmi2Get##NAME##Status(fmi2Component c, const fmi2StatusKind kind, fmi2##NAME *value) { \
        (void)c; (void)kind; (void)value; \
        return fmi2Discard; \
    }
STATUS2(Integer)
STATUS2(String)
FMI2_Export fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    (void)c; (void)kind; (void)value;
    return fmi2Discard;
}
FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    INSTANCE(c);
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = i->now.values[VR_TIME];
    return fmi2OK;
}
FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    INSTANCE(c);
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = i->now.phase == TERMINATED;
    return fmi2OK;
}
