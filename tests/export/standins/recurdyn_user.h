/* A minimal stand-in of RecurDyn's user subroutine interface: the few declarations that the glue uses. */
#ifndef STAND_IN_RECURDYN_USER_H
#define STAND_IN_RECURDYN_USER_H
#define RECURDYN_EXPORT
void sysary(const char *name, int *id, int n, double *states, int count, int *error);
void errmes(int type, const char *message, int id, int stop);
#endif
