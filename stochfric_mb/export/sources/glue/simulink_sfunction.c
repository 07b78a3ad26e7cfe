/* Friction in Simulink: a level-2 C MEX S-function.

   Inputs: relative displacement (2), relative velocity (2), normal force (1), holding force (2), effective mass (1).
   Outputs: friction force (2), stick (1). Parameters: seed, sample, contact. The state lives in a work vector, so that
   saved and restored simulation states carry it; mdlUpdate, which Simulink calls once per accepted step, commits.

       mex simulink_sfunction.c stochfric.c -output stochfric_sfunction

   Compiled against a stand-in of simstruc.h, never against or inside Simulink. */

#define S_FUNCTION_NAME stochfric_sfunction
#define S_FUNCTION_LEVEL 2

#include "simstruc.h"
#include "stochfric.h"

#include <string.h>

#define STATE_DOUBLES (sizeof(stochfric_state) / sizeof(double))

static void mdlInitializeSizes(SimStruct *S) {
    static const int widths[] = {2, 2, 1, 2, 1};
    ssSetNumSFcnParams(S, 3);
    if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) return;
    if (!ssSetNumInputPorts(S, 5)) return;
    for (int i = 0; i < 5; i++) {
        ssSetInputPortWidth(S, i, widths[i]);
        ssSetInputPortDirectFeedThrough(S, i, 1);
        ssSetInputPortRequiredContiguous(S, i, 1);
    }
    if (!ssSetNumOutputPorts(S, 2)) return;
    ssSetOutputPortWidth(S, 0, 2);
    ssSetOutputPortWidth(S, 1, 1);
    ssSetNumSampleTimes(S, 1);
    ssSetNumDWork(S, 1);
    ssSetDWorkWidth(S, 0, STATE_DOUBLES + 1); /* the state, and whether it has begun */
    ssSetDWorkDataType(S, 0, SS_DOUBLE);
}

static void mdlInitializeSampleTimes(SimStruct *S) {
    ssSetSampleTime(S, 0, CONTINUOUS_SAMPLE_TIME);
    ssSetOffsetTime(S, 0, 0.0);
}

static int look(SimStruct *S, stochfric_friction *friction, stochfric_state *state, stochfric_contact *at) {
    const double *u = ssGetInputPortRealSignal(S, 0), *v = ssGetInputPortRealSignal(S, 1), *n = ssGetInputPortRealSignal(S, 2);
    const double *h = ssGetInputPortRealSignal(S, 3), *m = ssGetInputPortRealSignal(S, 4);
    double *work = (double *)ssGetDWork(S, 0);
    const stochfric_contact now = {ssGetT(S), {u[0], u[1]}, {v[0], v[1]}, n[0], {h[0], h[1]}, m[0]};
    *at = now;
    stochfric_defaults(friction);
    friction->seed = (int64_t)mxGetScalar(ssGetSFcnParam(S, 0));
    friction->sample = (int64_t)mxGetScalar(ssGetSFcnParam(S, 1));
    friction->contact = (int64_t)mxGetScalar(ssGetSFcnParam(S, 2));
    memcpy(state, work, sizeof *state);
    if (work[STATE_DOUBLES] != 0.0) return STOCHFRIC_OK;
    const int status = stochfric_init(friction, at, state);
    if (status) return status;
    memcpy(work, state, sizeof *state);
    work[STATE_DOUBLES] = 1.0;
    return STOCHFRIC_OK;
}

#define MDL_START
static void mdlStart(SimStruct *S) {
    memset(ssGetDWork(S, 0), 0, (STATE_DOUBLES + 1) * sizeof(double));
}

static void mdlOutputs(SimStruct *S, int_T tid) {
    stochfric_friction friction;
    stochfric_state state;
    stochfric_contact at;
    double force[2] = {0.0, 0.0}, mu_s, mu_k;
    int stick = 0;
    (void)tid;
    int status = look(S, &friction, &state, &at);
    if (!status) status = stochfric_force(&friction, &state, &at, force);
    if (status) { ssSetErrorStatus(S, stochfric_message(status)); return; }
    stochfric_report(&state, &mu_s, &mu_k, &stick);
    ssGetOutputPortRealSignal(S, 0)[0] = force[0];
    ssGetOutputPortRealSignal(S, 0)[1] = force[1];
    ssGetOutputPortRealSignal(S, 1)[0] = stick;
}

#define MDL_UPDATE
static void mdlUpdate(SimStruct *S, int_T tid) {
    stochfric_friction friction;
    stochfric_state state;
    stochfric_contact at;
    (void)tid;
    int status = look(S, &friction, &state, &at);
    if (!status) status = stochfric_commit(&friction, &state, &at, &state);
    if (status) { ssSetErrorStatus(S, stochfric_message(status)); return; }
    memcpy(ssGetDWork(S, 0), &state, sizeof state);
}

static void mdlTerminate(SimStruct *S) { (void)S; }

#ifdef MATLAB_MEX_FILE
#include "simulink.c"
#else
#include "cg_sfun.h"
#endif
