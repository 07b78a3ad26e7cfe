/* Accepted steps, for solvers that call with trial steps and do not say which one they kept: the same friction as in
   stochfric.h, committed once the solver has moved on.

   A call at a later time than the last one means that the last one was accepted; a call at an earlier time, that it was
   rejected. That is so for solvers that evaluate forces at the ends of trial steps alone (BDF, HHT, generalised alpha).
   Solvers with stages inside a step (Runge-Kutta) need `accepted`, the time of the last accepted step, from the solver. */

#ifndef STOCHFRIC_STEPS_H
#define STOCHFRIC_STEPS_H

#include "stochfric.h"

typedef struct {
    stochfric_friction friction;
    stochfric_state state;      /* as of the last accepted step */
    stochfric_contact trial;    /* the last call */
    int begun;
} stochfric_steps;

/* Give the contact its state at the start. */
static int stochfric_steps_begin(stochfric_steps *steps, const stochfric_contact *at) {
    const int status = stochfric_init(&steps->friction, at, &steps->state);
    steps->trial = *at;
    steps->begun = status == STOCHFRIC_OK;
    return status;
}

/* The friction force at a trial; `accepted` is the time of the last accepted step, or a huge number if the solver tells none. */
static int stochfric_steps_force(stochfric_steps *steps, const stochfric_contact *at, double accepted, double force[2]) {
    if (!steps->begun) {
        const int status = stochfric_steps_begin(steps, at);
        if (status) return status;
    }
    const double rounding = 1.0e-12 * (1.0 + (at->time < 0.0 ? -at->time : at->time));
    if (at->time > steps->trial.time + rounding && steps->trial.time <= accepted + rounding) {
        const int status = stochfric_commit(&steps->friction, &steps->state, &steps->trial, &steps->state);
        if (status) return status;
    }
    steps->trial = *at;
    return stochfric_force(&steps->friction, &steps->state, at, force);
}

#endif
