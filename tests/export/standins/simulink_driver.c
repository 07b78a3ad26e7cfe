/* A stand-in of a solver: mdlUpdate once for each accepted step. */
#include "simulink_sfunction.c"
#define EXPORT __attribute__((visibility("default")))
static SimStruct block;
EXPORT int call(double time, const double *u, const double *v, double accepted, int dflag, int iflag, const double *par, double *result) {
    (void)accepted;
    if (iflag) {
        memset(&block, 0, sizeof block);
        mdlInitializeSizes(&block);
        mdlInitializeSampleTimes(&block);
        if ((size_t)block.n_work * sizeof(double) > sizeof block.work) return 1;
        for (int i = 0; i < 3; i++) block.parameters[i] = par[3 + i];
        mdlStart(&block);
        return 0;
    }
    block.time = time;
    block.inputs[2][0] = par[2];
    for (int i = 0; i < 2; i++) { block.inputs[0][i] = u[i]; block.inputs[1][i] = v[i]; }
    if (dflag == 2) mdlUpdate(&block, 0);
    mdlOutputs(&block, 0);
    result[0] = block.outputs[0][0];
    result[1] = block.outputs[0][1];
    mdlTerminate(&block);
    return block.error != 0;
}
