/* A minimal stand-in of Adams/Solver's C interface: the few declarations that the glue uses. */
#ifndef STAND_IN_SLV_C_UTILS_H
#define STAND_IN_SLV_C_UTILS_H
struct sAdamsVforce { int ID, NPAR; const double *PAR; int I, JFLOAT, RM; };
struct sAdamsGforce { int ID, NPAR; const double *PAR; int I, JFLOAT, RM; };
typedef void adams_c_Vfosub(const struct sAdamsVforce *, double time, int dflag, int iflag, double *result);
typedef void adams_c_Gfosub(const struct sAdamsGforce *, double time, int dflag, int iflag, double *result);
void c_sysary(const char *name, const int *ipar, int n, double *states, int *count, int *error);
void c_errmes(int error, const char *message, int id, const char *stop);
void c_timget(double *time);
#endif
