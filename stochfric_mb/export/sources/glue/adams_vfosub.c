/* Friction in Adams/Solver (C interface): a VFORCE whose first two components are the friction on its I marker.

       VFORCE/1, I=10, JFLOAT=11, RM=20, FUNCTION=USER(10, 20, 13.0, 0, 0, 1)\, ROUTINE=friction::Vfosub

   PAR: I marker, RM marker (its x-y plane is the plane of contact; it belongs to the counter-surface), normal force [N],
   seed, sample, number of the contact (below 64). Model units: kg, m, s, N.

   Compiled against a stand-in of slv_c_utils.h, never against or inside Adams. */

#include "slv_c_utils.h"
#include "stochfric_steps.h"

#define MOST_CONTACTS 64
#define LAST_CALL_BEFORE_MOTION 3 /* iflag: 0 the force, to 3 before the motion, above at other times (saving, reloading, the end) */

adams_c_Vfosub Vfosub;

static stochfric_steps contacts[MOST_CONTACTS]; /* Adams keeps no memory for a force: one place for each contact */

void Vfosub(const struct sAdamsVforce *vforce, double time, int dflag, int iflag, double *result) {
    double displacement[3], velocity[3], force[2] = {0.0, 0.0}, accepted = 0.0;
    int count, error = 0;
    result[0] = result[1] = result[2] = 0.0;
    if (iflag > LAST_CALL_BEFORE_MOTION) return;
    if (vforce->NPAR < 6 || !(vforce->PAR[5] >= 0.0 && vforce->PAR[5] < MOST_CONTACTS)) {
        c_errmes(1, "stochfric: six parameters are needed, the last one, the number of the contact, from 0 to 63", vforce->ID, "STOP");
        return;
    }
    const int number = (int)vforce->PAR[5];
    const int markers[3] = {(int)vforce->PAR[0], (int)vforce->PAR[1], (int)vforce->PAR[1]};
    stochfric_steps *contact = &contacts[number];
    c_sysary("TDISP", markers, 3, displacement, &count, &error);
    c_errmes(error, "stochfric: no displacement of the markers", vforce->ID, "STOP");
    c_sysary("TVEL", markers, 3, velocity, &count, &error);
    c_errmes(error, "stochfric: no velocity of the markers", vforce->ID, "STOP");
    if (iflag || error) { /* Adams finds out what the force depends on; the motion has not begun */
        contact->begun = 0;
        return;
    }
    /* the library wants counter-surface minus body: the other way round */
    stochfric_contact at = {time, {-displacement[0], -displacement[1]}, {-velocity[0], -velocity[1]}, vforce->PAR[2], {0.0, 0.0}, 0.0};
    if (!contact->begun) {
        stochfric_defaults(&contact->friction);
        contact->friction.seed = (int64_t)vforce->PAR[3];
        contact->friction.sample = (int64_t)vforce->PAR[4];
        contact->friction.contact = number;
    }
    int status;
    if (dflag && contact->begun) { /* a difference for the Jacobian: looks, and leaves no trace */
        status = stochfric_force(&contact->friction, &contact->state, &at, force);
    } else {
        c_timget(&accepted);
        status = stochfric_steps_force(contact, &at, accepted, force);
    }
    c_errmes(status, stochfric_message(status), vforce->ID, "STOP");
    result[0] = force[0];
    result[1] = force[1];
}
