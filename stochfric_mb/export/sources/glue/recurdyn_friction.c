/* Friction in RecurDyn: user subroutine of a screw force; its first two components are the friction on the action body.

   UPAR: action marker, base marker (its x-y plane is the plane of contact; it belongs to the counter-surface), normal
   force [N], seed, sample, number of the contact (below 64). Model units: kg, m, s, N. The solver tells no time of its
   last accepted step: use an integrator that evaluates at the ends of its steps (the default, generalised alpha, does).

   Compiled against a stand-in of RecurDyn's interface, never against or inside RecurDyn. */

#include "recurdyn_user.h"
#include "stochfric_steps.h"

#define MOST_CONTACTS 64
#define NOT_TOLD 1.0e300
#ifndef RECURDYN_FAILED
#define RECURDYN_FAILED(error) ((error) != 0 && (error) != -1) /* its subroutines say -1 (true in Fortran) or 0 where all is well */
#endif

static stochfric_steps contacts[MOST_CONTACTS];

RECURDYN_EXPORT void screw_force(double time, double upar[], int npar, int jflag, int iflag, double result[6]) {
    int error = 0, count = 6;
    double displacement[6] = {0.0}, velocity[6] = {0.0}, force[2] = {0.0, 0.0};
    for (int i = 0; i < 6; i++) result[i] = 0.0;
    if (npar < 6 || !(upar[5] >= 0.0 && upar[5] < MOST_CONTACTS)) {
        errmes(0, "stochfric: six parameters are needed, the last one from 0 to 63", 0, 1);
        return;
    }
    stochfric_steps *contact = &contacts[(int)upar[5]];
    int markers[3] = {(int)upar[0], (int)upar[1], (int)upar[1]};
    sysary("TDISP", markers, 3, displacement, count, &error);
    if (!RECURDYN_FAILED(error)) sysary("TVEL", markers, 3, velocity, count, &error);
    if (RECURDYN_FAILED(error)) {
        errmes(0, "stochfric: no displacement or velocity of the markers", 0, 1);
        return;
    }
    if (iflag) {
        contact->begun = 0;
        return;
    }
    stochfric_contact at = {time, {-displacement[0], -displacement[1]}, {-velocity[0], -velocity[1]}, upar[2], {0.0, 0.0}, 0.0};
    if (!contact->begun) {
        stochfric_defaults(&contact->friction);
        contact->friction.seed = (int64_t)upar[3];
        contact->friction.sample = (int64_t)upar[4];
        contact->friction.contact = (int64_t)upar[5];
    }
    const int status = jflag && contact->begun ? stochfric_force(&contact->friction, &contact->state, &at, force)
                                               : stochfric_steps_force(contact, &at, NOT_TOLD, force);
    if (status) errmes(0, stochfric_message(status), 0, 1);
    result[0] = force[0];
    result[1] = force[1];
}
