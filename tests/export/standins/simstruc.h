/* A minimal stand-in of Simulink's S-function interface: the few declarations that the glue uses. */
#ifndef STAND_IN_SIMSTRUC_H
#define STAND_IN_SIMSTRUC_H
#include <stddef.h>
typedef int int_T;
typedef double mxArray;
typedef struct {
    double time, inputs[5][2], outputs[2][2], work[256];
    mxArray parameters[3];
    int n_parameters, n_work, widths[5];
    const char *error;
} SimStruct;
#define SS_DOUBLE 0
#define CONTINUOUS_SAMPLE_TIME 0.0
#define ssSetNumSFcnParams(S, n) ((S)->n_parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->n_parameters)
#define ssGetSFcnParamsCount(S) 3
#define ssSetNumInputPorts(S, n) ((n) == 5)
#define ssSetNumOutputPorts(S, n) ((n) == 2)
#define ssSetInputPortWidth(S, i, n) ((S)->widths[i] = (n))
#define ssSetInputPortDirectFeedThrough(S, i, x) ((void)0)
#define ssSetInputPortRequiredContiguous(S, i, x) ((void)0)
#define ssSetOutputPortWidth(S, i, n) ((void)0)
#define ssSetNumSampleTimes(S, n) ((void)0)
#define ssSetNumDWork(S, n) ((void)0)
#define ssSetDWorkWidth(S, i, n) ((S)->n_work = (int)(n))
#define ssSetDWorkDataType(S, i, x) ((void)0)
#define ssSetSampleTime(S, i, x) ((void)(S))
#define ssSetOffsetTime(S, i, x) ((void)(S))
#define ssGetInputPortRealSignal(S, i) ((const double *)(S)->inputs[i])
#define ssGetOutputPortRealSignal(S, i) ((S)->outputs[i])
#define ssGetDWork(S, i) ((void *)(S)->work)
#define ssGetT(S) ((S)->time)
#define ssGetSFcnParam(S, i) (&(S)->parameters[i])
#define mxGetScalar(p) (*(p))
#define ssSetErrorStatus(S, text) ((S)->error = (text))
#endif
