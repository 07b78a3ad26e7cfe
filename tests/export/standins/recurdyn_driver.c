/* A stand-in of a solver: markers that stand where the test puts them. */
#include "recurdyn_user.h"
#define EXPORT __attribute__((visibility("default")))
void screw_force(double time, double upar[], int npar, int jflag, int iflag, double result[6]);
static double displacement[3], velocity[3];
static int errors;
void sysary(const char *name, int *id, int n, double *states, int count, int *error) {
    const double *from = name[1] == 'D' ? displacement : velocity;
    (void)id; (void)count;
    for (int i = 0; i < 3; i++) states[i] = from[i];
    *error = n != 3 ? 1 : name[1] == 'D' ? 0 : -1; /* both ways to say that all is well */
}
void errmes(int type, const char *message, int id, int stop) { (void)type; (void)message; (void)id; (void)stop; errors++; }
EXPORT int call(double time, const double *u, const double *v, double accepted, int dflag, int iflag, const double *par, double *result) {
    double all[6], upar[6];
    (void)accepted;
    for (int i = 0; i < 6; i++) upar[i] = par[i];
    for (int i = 0; i < 2; i++) { displacement[i] = -u[i]; velocity[i] = -v[i]; }
    errors = 0;
    screw_force(time, upar, 6, dflag, iflag, all);
    result[0] = all[0];
    result[1] = all[1];
    return errors;
}
