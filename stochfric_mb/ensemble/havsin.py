"""HAVSIN, samples side by side: classical Runge-Kutta of order 4 at a fixed step.

The law is smooth enough to be stepped over (its curvature jumps at v_s and v_d, its slope does not); what limits the
step is the steep rise below v_s. `coefficient` says the same as the law's own function without branches, so that the
loops over lanes vectorise; a test compares the two.
"""

from __future__ import annotations

import math
import sys

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.fixed_step import (
    D_K,
    D_S,
    STAGE_V,
    STAGE_X,
    STEP_ROWS,
    at_start,
    begin_step,
    end_of_step,
    passed,
    stepping,
)
from stochfric_mb.ensemble.kernel import kernel
from stochfric_mb.ensemble.lanes import A_K, A_S, LANES, V, fma, sine

ROWS = STEP_ROWS


@compiled_inline
def coefficient(speed, mu_s, mu_k, v_s, rise, fall):
    """Return mu(speed) [-], the law's `coefficient` without branches; ``rise`` = 1/v_s, ``fall`` = 1/(v_d - v_s)."""
    rising = speed <= v_s
    h0 = 0.0 if rising else mu_s
    h1 = mu_s if rising else mu_k
    beyond = (speed - v_s) * fall
    part = speed * rise if rising else (beyond if beyond < 1.0 else 1.0)
    return 0.5 * (h0 + h1) + 0.5 * (h1 - h0) * sine((part - 0.5) * math.pi)


@compiled
def numbers(q):
    """Return v_b, v_s, 1/v_s, 1/(v_d - v_s) and normal force, damping and stiffness per unit of mass."""
    v_s, v_d, m = q.parameters[2], q.parameters[3], q.box.mass
    load, damping, stiffness = q.box.normal_force / m, q.box.damping / m, q.box.stiffness / m
    return q.box.belt_velocity, v_s, 1.0 / v_s, 1.0 / (v_d - v_s), load, damping, stiffness


@compiled
def start(q, m):
    """Nothing but the first stage: the law has no memory."""
    at_start(m)


@compiled_inline
def sticks(q, m, j):
    """Return whether lane j is slower than the law's stick speed."""
    return abs(q.box.belt_velocity - m[V + j]) <= q.stick_speed


@compiled_inline
def acceleration(j, w, tau, drive, numbers, m):
    """Return x'' [m/s^2] of lane j at its stage."""
    v_b, v_s, rise, fall, load, damping, stiffness = numbers
    v = m[STAGE_V + j]
    v_rel = v_b - v
    mu_s, mu_k = fma(w, m[D_S + j], m[A_S + j]), fma(w, m[D_K + j], m[A_K + j])
    mu = coefficient(abs(v_rel), mu_s, mu_k, v_s, rise, fall)
    return fma(mu if v_rel > 0.0 else -mu, load, fma(-damping, v, fma(-stiffness, m[STAGE_X + j], drive)))


@compiled
def finish(w_old, w, h, drive, numbers, m):
    """Evaluate the fourth acceleration and finish the step; nothing switches, count what passed v_s or turned over."""
    v_b, v_s = numbers[0], numbers[1]
    changes = 0
    for j in range(LANES):
        x, v = end_of_step(j, acceleration(j, w, h, drive, numbers, m), h, m)
        changes += 1 if passed(v_b - m[V + j], v_b - v, v_s) else 0
        begin_step(j, x, v, m)
    return 0, changes


@compiled
def switch(q, t, h, w, part, m):
    """Do nothing: the law is stepped over."""


leg = stepping(sys.modules[__name__])
simulate = kernel(sys.modules[__name__])
