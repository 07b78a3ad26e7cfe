/* A stand-in of a solver: markers that stand where the test puts them. */
#include "slv_c_utils.h"
#ifdef GFORCE
#define STRUCTURE sAdamsGforce
#define SUBROUTINE Gfosub
#define COMPONENTS 6
#else
#define STRUCTURE sAdamsVforce
#define SUBROUTINE Vfosub
#define COMPONENTS 3
#endif
#define EXPORT __attribute__((visibility("default")))
void SUBROUTINE(const struct STRUCTURE *, double, int, int, double *);
static double displacement[3], velocity[3], converged;
static int errors, n_par = 6;
EXPORT void give_parameters(int n) { n_par = n; }
void c_sysary(const char *name, const int *ipar, int n, double *states, int *count, int *error) {
    const double *from = name[1] == 'D' ? displacement : velocity;
    (void)ipar;
    for (int i = 0; i < 3; i++) states[i] = from[i];
    *count = 3;
    *error = n != 3;
}
void c_errmes(int error, const char *message, int id, const char *stop) { (void)message; (void)id; (void)stop; errors += error != 0; }
void c_timget(double *time) { *time = converged; }
EXPORT int call(double time, const double *u, const double *v, double accepted, int dflag, int iflag, const double *par, double *result) {
    double all[COMPONENTS];
    const struct STRUCTURE force = {1, n_par, par, 10, 11, 20};
    for (int i = 0; i < 2; i++) { displacement[i] = -u[i]; velocity[i] = -v[i]; }
    converged = accepted;
    errors = 0;
    SUBROUTINE(&force, time, dflag, iflag, all);
    result[0] = all[0];
    result[1] = all[1];
    return errors;
}
