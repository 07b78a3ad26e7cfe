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
from stochfric_mb.ensemble.lanes import (
    LANES,
    OPEN,
    TALLIES,
    aligned,
    begin,
    close,
    first_pairs,
    fma,
    next_pairs,
    note_crossings,
    sine,
)

# Rows of the flat array: position, velocity, velocity one step before, position and velocity of a stage, sum of the
# first three accelerations, sum of the second and third, pair at the knot, its change to the next knot, pair there, mu_s
X, V, BEFORE, STAGE_X, STAGE_V, SUM, MIDDLE, A_S, A_K, D_S, D_K, B_S, B_K, MU = (LANES * i for i in range(14))
ROWS = 14


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
    m = aligned(ROWS * LANES)
    m[X : X + LANES] = m[STAGE_X : STAGE_X + LANES] = q.position
    m[V : V + LANES] = m[STAGE_V : STAGE_V + LANES] = q.velocity
    a_s, a_k, b_s, b_k = (m[A_S : A_S + LANES], m[A_K : A_K + LANES], m[B_S : B_S + LANES], m[B_K : B_K + LANES])
    tally, pending = np.empty((TALLIES, LANES)), np.empty((OPEN, LANES))
    cursors = np.zeros((LANES, CURSOR))
    first_pairs(q.descriptor, cursors, seed, first, a_s, a_k, b_s, b_k)
    _slopes(m)
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
            _slopes(m)
        n_steps = int(q.n_steps[q.legs.kind[i]])
        h = q.legs.length[i] / n_steps
        part = (q.legs.to_knot[i] - q.legs.from_knot[i]) / n_steps
        for step in range(n_steps):
            t = q.legs.start[i] + step * h
            w = q.legs.from_knot[i] + step * part
            if _step(q.amplitude / q.mass, q.frequency, t, h, w, part, numbers, m) > 0:
                _note(q, t, h, w, m, tally, pending)
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
def _slopes(m):
    """Write the change of each pair to the next knot."""
    for j in range(LANES):
        m[D_S + j] = m[B_S + j] - m[A_S + j]
        m[D_K + j] = m[B_K + j] - m[A_K + j]


@compiled
def _step(amplitude, frequency, t, h, w, part, numbers, m):
    """Make one step of every lane; return how many entered or left stick or turned over."""
    f0 = f1 = f2 = 0.0
    if amplitude != 0.0:
        f0 = amplitude * math.cos(frequency * t)
        f1 = amplitude * math.cos(frequency * (t + 0.5 * h))
        f2 = amplitude * math.cos(frequency * (t + h))
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
    """Evaluate an acceleration and go ``ahead`` [s] from the start of the step with it.

    ``middle`` is 0 for the first stage and 1 for the second and third.
    """
    for j in range(LANES):
        a = _acceleration(j, w, drive, numbers, m)
        v = m[STAGE_V + j]
        m[SUM + j] += a
        m[MIDDLE + j] += middle * a
        m[STAGE_X + j] = fma(ahead, v, m[X + j])
        m[STAGE_V + j] = fma(ahead, a, m[V + j])


@compiled
def _last_stage(w, h, drive, numbers, m):
    """Evaluate the fourth acceleration and finish the step: for x'' = a(x, x') the sums of Runge-Kutta's formula are these."""
    v_b, v_s = numbers[0], numbers[1]
    changes = 0
    for j in range(LANES):
        a = _acceleration(j, w, drive, numbers, m)
        v = m[V + j]
        three = m[SUM + j]
        x_new = fma(h * h / 6.0, three, fma(h, v, m[X + j]))
        v_new = fma(h / 6.0, three + m[MIDDLE + j] + a, v)
        was, now = v_b - v, v_b - v_new
        changes += 1 if ((abs(was) <= v_s) != (abs(now) <= v_s)) | (was * now < 0.0) else 0
        m[BEFORE + j] = v
        m[X + j] = m[STAGE_X + j] = x_new
        m[V + j] = m[STAGE_V + j] = v_new
        m[SUM + j] = m[MIDDLE + j] = 0.0
    return changes


@compiled
def _note(q, t, h, w, m, tally, pending):
    """Note what happened within the step before now."""
    for j in range(LANES):
        m[MU + j] = m[A_S + j] + w * m[D_S + j]
    rows = m.reshape(ROWS, LANES)
    x, v, before, mu_s = rows[X // LANES], rows[V // LANES], rows[BEFORE // LANES], rows[MU // LANES]
    note_crossings(t, h, q.belt_velocity, q.stick_speed, x, v, before, mu_s, tally, pending, q.least_slip)


@compiled
def _record(q, output, n, m, position, velocity, stick):
    for j in range(n):
        position[j, output] = m[X + j]
        velocity[j, output] = m[V + j]
        stick[j, output] = abs(q.belt_velocity - m[V + j]) <= q.stick_speed
