"""HAVSIN, samples side by side: classical Runge-Kutta of order 4 at a fixed step.

The law is smooth enough to be stepped over (its curvature jumps at v_s and v_d, its slope does not); what limits the
step is the steep rise below v_s. `coefficient` says the same as the law's own function without branches, so that the
loops over lanes vectorise; a test compares the two. Each stage is a loop of its own over the lanes (one vector's
stages depend on each other, another vector's do not), over rows of one flat array, so that the compiler sees that rows
do not overlap.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false, reportCallIssue=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.fixed_step import (
    A_K,
    A_S,
    B_K,
    B_S,
    D_K,
    D_S,
    SHARED_ROWS,
    STAGE_V,
    STAGE_X,
    V,
    X,
    begin_step,
    changes_to_next_knot,
    drives,
    end_of_step,
    finish_stage,
    note_step,
    passed,
)
from stochfric_mb.ensemble.lanes import LANES, OPEN, TALLIES, aligned, begin, close, first_pairs, fma, next_pairs, sine


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
def simulate(q: Any, seed: int, first: int, n: int, position: Any, velocity: Any, stick: Any, tallies: Any) -> int:
    """Run samples ``first`` .. ``first + n - 1``; write (n, n_outputs) arrays and tallies; return 0."""
    for group in range((n + LANES - 1) // LANES):
        low = group * LANES
        high = min(low + LANES, n)
        _group(q, seed, first + low, high - low, position[low:high], velocity[low:high], stick[low:high], tallies[low:high])
    return 0


@compiled
def _group(q, seed, first, n, position, velocity, stick, tallies):
    """Run one group of lanes."""
    m = aligned(SHARED_ROWS * LANES)
    m[X : X + LANES] = m[STAGE_X : STAGE_X + LANES] = q.position
    m[V : V + LANES] = m[STAGE_V : STAGE_V + LANES] = q.velocity
    a_s, a_k, b_s, b_k = (m[A_S : A_S + LANES], m[A_K : A_K + LANES], m[B_S : B_S + LANES], m[B_K : B_K + LANES])
    tally, pending = np.empty((TALLIES, LANES)), np.empty((OPEN, LANES))
    cursors = np.zeros((LANES, CURSOR))
    first_pairs(q.descriptor, cursors, seed, first, a_s, a_k, b_s, b_k)
    changes_to_next_knot(m)
    knot = 0
    for j in range(LANES):
        begin(tally, pending, j, abs(q.belt_velocity - q.velocity) <= q.stick_speed)
    if q.legs.output_at_start:
        _record(q, 0, n, m, position, velocity, stick)
    numbers = _numbers(q)
    for i in range(len(q.legs.length)):
        if q.legs.knot[i] > knot:
            knot += 1
            next_pairs(q.descriptor, cursors, seed, first, knot, a_s, a_k, b_s, b_k)
            changes_to_next_knot(m)
        n_steps = int(q.n_steps[q.legs.kind[i]])
        h = q.legs.length[i] / n_steps
        part = (q.legs.to_knot[i] - q.legs.from_knot[i]) / n_steps
        for step in range(n_steps):
            t = q.legs.start[i] + step * h
            w = q.legs.from_knot[i] + step * part
            if _step(q.amplitude / q.mass, q.frequency, t, h, w, part, numbers, m) > 0:
                note_step(q, t, h, w, m, tally, pending)
        if q.legs.output[i] >= 0:
            _record(q, q.legs.output[i], n, m, position, velocity, stick)
    end = q.legs.start[-1] + q.legs.length[-1]
    for j in range(n):
        close(tally, pending, j, end, q.belt_velocity * end - m[X + j], q.least_slip)
        tallies[j] = tally[:, j]


@compiled
def _numbers(q):
    """Return v_b, v_s, 1/v_s, 1/(v_d - v_s) and normal force, damping and stiffness per unit of mass."""
    v_s, v_d = q.parameters[2], q.parameters[3]
    return q.belt_velocity, v_s, 1.0 / v_s, 1.0 / (v_d - v_s), q.normal_force / q.mass, q.damping / q.mass, q.stiffness / q.mass


@compiled
def _step(amplitude, frequency, t, h, w, part, numbers, m):
    """Make one step of every lane; return how many entered or left stick or turned over."""
    f0, f1, f2 = drives(amplitude, frequency, t, h)
    _stage(w, 0.5 * h, 0.0, f0, numbers, m)
    _stage(w + 0.5 * part, 0.5 * h, 1.0, f1, numbers, m)
    _stage(w + 0.5 * part, h, 1.0, f1, numbers, m)
    return _last_stage(w + part, h, f2, numbers, m)


@compiled_inline
def _acceleration(j, w, drive, numbers, m):
    """Return x'' [m/s^2] of lane j at its stage."""
    v_b, v_s, rise, fall, load, damping, stiffness = numbers
    v = m[STAGE_V + j]
    v_rel = v_b - v
    mu_s, mu_k = fma(w, m[D_S + j], m[A_S + j]), fma(w, m[D_K + j], m[A_K + j])
    mu = coefficient(abs(v_rel), mu_s, mu_k, v_s, rise, fall)
    return fma(mu if v_rel > 0.0 else -mu, load, fma(-damping, v, fma(-stiffness, m[STAGE_X + j], drive)))


@compiled
def _stage(w, ahead, middle, drive, numbers, m):
    """Evaluate an acceleration of every lane and go ``ahead`` [s] with it."""
    for j in range(LANES):
        finish_stage(j, _acceleration(j, w, drive, numbers, m), ahead, middle, m)


@compiled
def _last_stage(w, h, drive, numbers, m):
    """Evaluate the fourth acceleration, finish the step, and count the lanes that passed v_s or turned over."""
    v_b, v_s = numbers[0], numbers[1]
    changes = 0
    for j in range(LANES):
        x, v = end_of_step(j, _acceleration(j, w, drive, numbers, m), h, m)
        changes += 1 if passed(v_b - m[V + j], v_b - v, v_s) else 0
        begin_step(j, x, v, m)
    return changes


@compiled
def _record(q, output, n, m, position, velocity, stick):
    for j in range(n):
        position[j, output] = m[X + j]
        velocity[j, output] = m[V + j]
        stick[j, output] = abs(q.belt_velocity - m[V + j]) <= q.stick_speed
