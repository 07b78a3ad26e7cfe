/* --- FMI 3.0 ---------------------------------------------------------------------------------------------------------------- */

static void say(const instance *c, int status, const char *message) {
    (void)status;
    if (c->logger) ((fmi3LogMessageCallback)c->logger)(c->environment, fmi3Error, "error", message);
}

static fmi3Status status(int bad) { return bad ? fmi3Error : fmi3OK; }

#define INSTANCE(c) instance *i = (instance *)(c); if (!i) return fmi3Error
#define REFS const fmi3ValueReference vr[], size_t n

FMI3_Export const char *fmi3GetVersion(void) { return "3.0"; }

FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[]) {
    INSTANCE(c);
    (void)n; (void)categories;
    i->logging = on;
    return fmi3OK;
}

FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                                      fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log) {
    (void)resources; (void)visible;
    return make(name, token, 0, logging, environment, (void *)log);
}

FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                                     fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
                                                     const fmi3ValueReference required[], size_t n_required,
                                                     fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                                     fmi3IntermediateUpdateCallback update) {
    (void)resources; (void)visible; (void)early_return; (void)required; (void)n_required; (void)update;
    instance *made = make(name, token, 1, logging, environment, (void *)log);
    if (made && event_mode) { refused(made, "co-simulation has no event mode here"); free(made); return 0; }
    return made;
}

FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                                           fmi3Boolean visible, fmi3Boolean logging,
                                                           fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                                           fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock,
                                                           fmi3UnlockPreemptionCallback unlock) {
    (void)name; (void)token; (void)resources; (void)visible; (void)logging; (void)clock; (void)lock; (void)unlock;
    if (log) log(environment, fmi3Error, "error", "scheduled execution is not supported");
    return 0;
}

FMI3_Export void fmi3FreeInstance(fmi3Instance c) { free(c); }

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean with_tolerance, fmi3Float64 tolerance,
                                                   fmi3Float64 start_time, fmi3Boolean with_stop, fmi3Float64 stop) {
    INSTANCE(c);
    (void)with_tolerance; (void)tolerance; (void)with_stop; (void)stop;
    if (!isfinite(start_time)) return status(refused(i, "the start time is not finite"));
    i->now.values[VR_TIME] = start_time;
    i->now.phase = INITIALIZING;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { INSTANCE(c); return status(start(i)); }
FMI3_Export fmi3Status fmi3EnterEventMode(fmi3Instance c) { INSTANCE(c); i->now.phase = EVENTS; return fmi3OK; }
FMI3_Export fmi3Status fmi3Terminate(fmi3Instance c) { INSTANCE(c); i->now.phase = TERMINATED; return fmi3OK; }
FMI3_Export fmi3Status fmi3Reset(fmi3Instance c) { INSTANCE(c); clear(i); return fmi3OK; }

#define ACCESS3(NAME, LETTER) \
    FMI3_Export fmi3Status fmi3Get##NAME(fmi3Instance c, REFS, fmi3##NAME values[], size_t n_values) { \
        INSTANCE(c); \
        if (counted(i, n_values, n)) return fmi3Error; \
        for (size_t k = 0; k < n; k++) { \
            double x; \
            if (get_values(i, &vr[k], 1, LETTER, &x)) return fmi3Error; \
            values[k] = (fmi3##NAME)x; \
        } \
        return fmi3OK; \
    } \
    FMI3_Export fmi3Status fmi3Set##NAME(fmi3Instance c, REFS, const fmi3##NAME values[], size_t n_values) { \
        INSTANCE(c); \
        if (counted(i, n_values, n)) return fmi3Error; \
        for (size_t k = 0; k < n; k++) { \
            const double x = (double)values[k]; \
            if (set_values(i, &vr[k], 1, LETTER, &x)) return fmi3Error; \
        } \
        return fmi3OK; \
    }
ACCESS3(Float64, 'r')
ACCESS3(UInt32, 'n')
ACCESS3(Boolean, 'b')
ACCESS3(Float32, '-')
ACCESS3(Int8, '-')
ACCESS3(UInt8, '-')
ACCESS3(Int16, '-')
ACCESS3(UInt16, '-')
ACCESS3(Int32, '-')
ACCESS3(Int64, '-')
ACCESS3(UInt64, '-')

static fmi3Status without(void *c, const char *what) { INSTANCE(c); return status(refused(i, what)); }

FMI3_Export fmi3Status fmi3GetString(fmi3Instance c, REFS, fmi3String values[], size_t m) { (void)vr; (void)values; (void)m; return n ? without(c, "this FMU has no strings") : fmi3OK; }
FMI3_Export fmi3Status fmi3SetString(fmi3Instance c, REFS, const fmi3String values[], size_t m) { (void)vr; (void)values; (void)m; return n ? without(c, "this FMU has no strings") : fmi3OK; }
FMI3_Export fmi3Status fmi3GetBinary(fmi3Instance c, REFS, size_t sizes[], fmi3Binary values[], size_t m) { (void)vr; (void)sizes; (void)values; (void)m; return n ? without(c, "this FMU has no binaries") : fmi3OK; }
FMI3_Export fmi3Status fmi3SetBinary(fmi3Instance c, REFS, const size_t sizes[], const fmi3Binary values[], size_t m) { (void)vr; (void)sizes; (void)values; (void)m; return n ? without(c, "this FMU has no binaries") : fmi3OK; }
FMI3_Export fmi3Status fmi3GetClock(fmi3Instance c, REFS, fmi3Clock values[]) { (void)vr; (void)values; return n ? without(c, "this FMU has no clocks") : fmi3OK; }
FMI3_Export fmi3Status fmi3SetClock(fmi3Instance c, REFS, const fmi3Clock values[]) { (void)vr; (void)values; return n ? without(c, "this FMU has no clocks") : fmi3OK; }
FMI3_Export fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, REFS, fmi3Float64 a[], fmi3IntervalQualifier q[]) { (void)vr; (void)n; (void)a; (void)q; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3GetIntervalFraction(fmi3Instance c, REFS, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[]) { (void)vr; (void)n; (void)a; (void)b; (void)q; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3GetShiftDecimal(fmi3Instance c, REFS, fmi3Float64 a[]) { (void)vr; (void)n; (void)a; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3GetShiftFraction(fmi3Instance c, REFS, fmi3UInt64 a[], fmi3UInt64 b[]) { (void)vr; (void)n; (void)a; (void)b; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, REFS, const fmi3Float64 a[]) { (void)vr; (void)n; (void)a; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3SetIntervalFraction(fmi3Instance c, REFS, const fmi3UInt64 a[], const fmi3UInt64 b[]) { (void)vr; (void)n; (void)a; (void)b; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3SetShiftDecimal(fmi3Instance c, REFS, const fmi3Float64 a[]) { (void)vr; (void)n; (void)a; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3SetShiftFraction(fmi3Instance c, REFS, const fmi3UInt64 a[], const fmi3UInt64 b[]) { (void)vr; (void)n; (void)a; (void)b; return without(c, "this FMU has no clocks"); }
FMI3_Export fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference vr, size_t *n) { (void)vr; (void)n; return without(c, "dependencies stand in modelDescription.xml"); }
FMI3_Export fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference vr, size_t a[], fmi3ValueReference b[], size_t d[], fmi3DependencyKind e[], size_t n) {
    (void)vr; (void)a; (void)b; (void)d; (void)e; (void)n;
    return without(c, "dependencies stand in modelDescription.xml");
}

FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) { INSTANCE(c); return status(save(i, state)); }
FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { INSTANCE(c); return status(restore(i, state)); }
FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    (void)c;
    if (state) { free(*state); *state = 0; }
    return fmi3OK;
}
FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    (void)c; (void)state;
    *size = sizeof(record);
    return fmi3OK;
}
FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    INSTANCE(c);
    return status(serialized(i, state, bytes, size));
}
FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    INSTANCE(c);
    return status(deserialized(i, bytes, size, state));
}

#define DERIVATIVE const fmi3ValueReference unknown[], size_t n_unknown, const fmi3ValueReference known[], size_t n_known, \
    const fmi3Float64 seed[], size_t n_seed, fmi3Float64 out[], size_t n_out
#define UNUSED_DERIVATIVE (void)unknown; (void)n_unknown; (void)known; (void)n_known; (void)seed; (void)n_seed; (void)out; (void)n_out
FMI3_Export fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, DERIVATIVE) {
    INSTANCE(c);
    if (counted(i, n_seed, n_known) || counted(i, n_out, n_unknown)) return fmi3Error;
    return status(directional(i, unknown, n_unknown, known, n_known, seed, out));
}
FMI3_Export fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, DERIVATIVE) { UNUSED_DERIVATIVE; return without(c, "this FMU has no adjoint derivatives"); }

FMI3_Export fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return without(c, "this FMU has no structural parameters"); }
FMI3_Export fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return without(c, "this FMU has no structural parameters"); }
FMI3_Export fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { INSTANCE(c); return fmi3OK; }

FMI3_Export fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *stop, fmi3Boolean *nominals,
                                                fmi3Boolean *states, fmi3Boolean *defined, fmi3Float64 *next) {
    INSTANCE(c);
    int switched = 0;
    if (accepted(i, &switched)) return fmi3Error;
    *again = *stop = *nominals = false;
    *states = N_STATES > 0;
    *defined = next_kink(&i->now, next) != 0;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { INSTANCE(c); i->now.phase = CONTINUOUS; return fmi3OK; }

FMI3_Export fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean no_return, fmi3Boolean *event, fmi3Boolean *stop) {
    INSTANCE(c);
    int switched = 0;
    (void)no_return;
    *event = *stop = false;
    if (accepted(i, &switched)) return fmi3Error;
    *event = switched != 0;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    INSTANCE(c);
    if (!isfinite(time)) return status(refused(i, "the time is not finite"));
    i->now.values[VR_TIME] = time;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) { INSTANCE(c); return status(set_states(i, x, n)); }
FMI3_Export fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { INSTANCE(c); return status(get_states(i, x, n)); }
FMI3_Export fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 x[], size_t n) { INSTANCE(c); return status(get_rates(i, x, n)); }
FMI3_Export fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) { INSTANCE(c); return status(get_indicators(i, z, n)); }
FMI3_Export fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { INSTANCE(c); return status(get_nominals(i, x, n)); }
FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { INSTANCE(c); (void)i; *n = INDICATORS; return fmi3OK; }
FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { INSTANCE(c); (void)i; *n = N_STATES; return fmi3OK; }

FMI3_Export fmi3Status fmi3EnterStepMode(fmi3Instance c) { INSTANCE(c); i->now.phase = STEPPING; return fmi3OK; }
FMI3_Export fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, REFS, const fmi3Int32 orders[], fmi3Float64 values[], size_t m) {
    (void)vr; (void)orders; (void)values; (void)m;
    return n ? without(c, "this FMU has no derivatives of its outputs") : fmi3OK;
}

FMI3_Export fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 h, fmi3Boolean no_return, fmi3Boolean *event,
                                  fmi3Boolean *stop, fmi3Boolean *early, fmi3Float64 *last) {
    INSTANCE(c);
    (void)no_return;
    *event = *stop = *early = false;
    const int bad = step(i, time, h);
    *last = i->now.values[VR_TIME];
    return status(bad);
}

FMI3_Export fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time) { (void)clock; (void)time; return without(c, "this FMU has no clocks"); }
