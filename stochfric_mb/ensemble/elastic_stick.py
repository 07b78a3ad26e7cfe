"""Elastic stick, samples side by side: Runge-Kutta of order 4 at a fixed step, with the law's switches located.

While no lane switches, all of them make the same step without branches. A lane that has passed a switch at the end of
a step (break-away, the peak at v_s, re-stick) makes that step again alone, with the law's own functions: up to the
switch, commit, and on. The deflection needs no equation: z = z_0 + v_b (t - t_0) - (x - x_0) exactly.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.fixed_step import (
    D_K,
    D_S,
    OLD_V,
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
from stochfric_mb.ensemble.lanes import A_K, A_S, LANES, V, X, exponential, fma
from stochfric_mb.laws import elastic_stick as law
from stochfric_mb.laws.elastic_stick import SLIP, SLIP_PEAK, STICK
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial
from stochfric_mb.numerics.runge_kutta import RK4, advance

A, B, C = RK4.a, RK4.b, RK4.c

# Rows beside the shared ones: position one step before, mode, direction of sliding, deflection + position, whether the
# lane has passed a switch
OLD_X, MODE, SIGN, ZX, SWITCHED = (LANES * (STEP_ROWS + i) for i in range(5))
ROWS = STEP_ROWS + 5
MAX_SWITCHES = 20
"""Most switches located within one step; after them the rest of it is made in one go."""
RESOLUTION = 1.0e-10
"""Part of a step to which a switch is located."""


@compiled_inline
def coefficient(speed, mu_s, mu_k, v_s, rate):
    """Return the sliding coefficient [-], the law's `slip_coefficient` without branches; ``rate`` = 1/decay_velocity."""
    y = (v_s - speed) * rate
    return fma(mu_s - mu_k, exponential(y if y < 0.0 else 0.0), mu_k)


@compiled_inline
def stick_force(z, v_rel, limit, stiffness, damping, cap):
    """Return the force of a stuck contact, the law's `force` without branches: z within ``limit``, the sum within ``cap``."""
    z = limit if z > limit else z
    z = -limit if z < -limit else z
    f = fma(stiffness, z, damping * v_rel)
    f = cap if f > cap else f
    return -cap if f < -cap else f


@compiled
def start(q, m):
    """Set every lane to the law's own state at t = 0."""
    at_start(m)
    v_rel = q.box.belt_velocity - q.velocity
    for j in range(LANES):
        s = law.init(
            0.0, 0.0, 0.0, v_rel, 0.0, q.box.normal_force, m[A_S + j], m[A_K + j], q.box.mass, 0.0, 0.0, q.parameters
        )  # fmt: skip
        m[MODE + j], m[SIGN + j], m[ZX + j] = s[0], s[3], q.position - s[1]


@compiled_inline
def sticks(q, m, j):
    """Return whether lane j is stuck."""
    return m[MODE + j] == STICK


@compiled
def numbers(q):
    """Return v_b, v_s, 1/decay_velocity, e_lim/mean mu_s and the rest per unit of mass: k_stick, c_stick, N, c, k."""
    p = q.parameters
    rate = 1.0 / p[5] if p[5] > 0.0 else 1.0e300
    k_stick = law.stick_stiffness(q.box.normal_force, p) / q.box.mass
    c_stick = law.stick_damping(q.box.normal_force, q.box.mass, p) / q.box.mass
    reach = law.deflection_limit(1.0, p)
    m = q.box.mass
    return (
        q.box.belt_velocity,
        p[4],
        rate,
        reach,
        k_stick,
        c_stick,
        q.box.normal_force / m,
        q.box.damping / m,
        q.box.stiffness / m,
    )


# --- all lanes at once ------------------------------------------------------------------------------------------------


@compiled_inline
def acceleration(j, w, tau, drive, numbers, m):
    """Return x'' [m/s^2] of lane j at its stage, ``tau`` after the start of the step."""
    v_b, v_s, rate, reach, k_stick, c_stick, load, damping, stiffness = numbers
    x, v = m[STAGE_X + j], m[STAGE_V + j]
    v_rel = v_b - v
    mu_s, mu_k = fma(w, m[D_S + j], m[A_S + j]), fma(w, m[D_K + j], m[A_K + j])
    held = stick_force(fma(v_b, tau, m[ZX + j]) - x, v_rel, reach * mu_s, k_stick, c_stick, mu_s * load)
    s = m[SIGN + j]
    ahead = s * v_rel
    slid = s * load * coefficient(ahead if ahead > 0.0 else 0.0, mu_s, mu_k, v_s, rate)
    return fma(-damping, v, fma(-stiffness, x, drive)) + (held if m[MODE + j] == STICK else slid)


@compiled
def finish(w_old, w, h, drive, numbers, m):
    """Evaluate the fourth acceleration, finish the step, and look for switches and for the kink at the cap."""
    v_b, v_s, _, reach, k_stick, c_stick, load, _, _ = numbers
    switched = 0
    crossed = 0
    for j in range(LANES):
        x = m[X + j]
        x_new, v_new = end_of_step(j, acceleration(j, w, h, drive, numbers, m), h, m)
        was, now = v_b - m[V + j], v_b - v_new
        z_old = m[ZX + j] - x
        zx = fma(v_b, h, m[ZX + j])
        z = zx - x_new
        cap_old = load * fma(w_old, m[D_S + j], m[A_S + j])
        mu_s = fma(w, m[D_S + j], m[A_S + j])
        capped_old = abs(fma(k_stick, z_old, c_stick * was)) >= cap_old
        capped = abs(fma(k_stick, z, c_stick * now)) >= load * mu_s
        ahead = m[SIGN + j] * now
        peak = (ahead <= 0.0) | (ahead > v_s)
        slip = peak if m[MODE + j] == SLIP_PEAK else ahead <= v_s
        switch = ((abs(z) >= reach * mu_s) | (capped != capped_old)) if m[MODE + j] == STICK else slip
        switched += 1 if switch else 0
        crossed += 1 if passed(was, now, v_s) else 0
        m[SWITCHED + j] = 1.0 if switch else 0.0
        m[OLD_X + j] = x
        m[ZX + j] = zx
        begin_step(j, x_new, v_new, m)
    return switched, crossed


# --- one lane that switches -------------------------------------------------------------------------------------------
# line: time and mu_s, mu_k at the start of the step, and their slopes; r: (x, x', z), the same after a trial step and at a
# stage of it, and the rates of its four stages, taken as rows once: a view costs as much as a stage


@compiled
def switch(q, t, h, w, part, m):
    """Make the last step again for the lanes that have passed a switch."""
    rows = np.empty((3 + len(B), 3))
    r = (rows[0], rows[1], rows[2], rows[3:])
    for j in range(LANES):
        if m[SWITCHED + j] == 1.0:
            _switching_step(q.box, q.parameters, j, t, h, w, part, m, r)


@compiled
def _switching_step(box, p, j, t, h, w, part, m, r):
    """Make the last step of lane j again, with its switches located and committed by the law."""
    d_s, d_k = m[D_S + j], m[D_K + j]
    line = (t, m[A_S + j] + w * d_s, m[A_K + j] + w * d_k, part * d_s / h, part * d_k / h)
    y, end, _, _ = r
    y[0], y[1], y[2] = m[OLD_X + j], m[OLD_V + j], m[ZX + j] - box.belt_velocity * h - m[OLD_X + j]
    state = (m[MODE + j], 0.0, 0.0, m[SIGN + j], 0.0)
    tau = 0.0
    for count in range(MAX_SWITCHES + 1):
        dt = h - tau
        if count < MAX_SWITCHES:
            dt = _switch_time(box, p, line, state, tau, dt, r)
        last = dt == h - tau
        _advance(box, p, line, state, tau, dt, r)
        tau = h if last else tau + dt
        mu_s, mu_k = line[1] + tau * line[3], line[2] + tau * line[4]
        new = law.commit(
            t + tau, end[2], 0.0, box.belt_velocity - end[1], 0.0, box.normal_force, state, mu_s, mu_k, box.mass, 0.0, 0.0, p
        )
        y[0], y[1], y[2] = end[0], end[1], end[2] - new[1]
        state = (new[0], 0.0, 0.0, new[3], 0.0)
        if last:
            break
    m[X + j] = m[STAGE_X + j] = y[0]
    m[V + j] = m[STAGE_V + j] = y[1]
    m[ZX + j] = y[2] + y[0]
    m[MODE + j], m[SIGN + j] = state[0], state[3]


@compiled
def _guards(box, p, line, state, tau, y):
    """Return the law's distances to its switches at (x, x', z) = y, positive before them."""
    mu_s, mu_k = line[1] + tau * line[3], line[2] + tau * line[4]
    return law.guards(
        line[0] + tau, y[2], 0.0, box.belt_velocity - y[1], 0.0, box.normal_force, state, mu_s, mu_k, box.mass, 0.0, 0.0, p
    )


@compiled
def _switch_time(box, p, line, state, tau, rest, r):
    """Return the time to the next switch, or kink at the cap [s], just past it; ``rest`` if there is none.

    A contact that is at a switch already (a clipped deflection whose limit falls) is committed at the end only.
    """
    g = _guards(box, p, line, state, tau, r[0])
    second = 1 if state[0] != STICK or g[1] > 0.0 else 2  # the cap is left where it was reached
    at_start = min(g[0], g[second])
    at_end = _margin_after(box, p, line, state, tau, rest, second, r)
    if at_start <= 0.0 or at_end > 0.0:
        return rest
    b = bracket(0.0, at_start, rest, at_end)
    while is_wide(b, RESOLUTION * rest):
        dt = trial(b, RESOLUTION * rest)
        b = narrowed(b, dt, _margin_after(box, p, line, state, tau, dt, second, r))
    return b.negative


@compiled
def _margin_after(box, p, line, state, tau, dt, second, r):
    """Return the least distance to a switch a time dt after ``tau``."""
    _advance(box, p, line, state, tau, dt, r)
    g = _guards(box, p, line, state, tau + dt, r[1])
    return min(g[0], g[second])


@compiled
def _advance(box, p, line, state, tau, dt, r):
    """Make a Runge-Kutta step ``dt`` after ``tau`` into the step, with the law's own force."""
    y, end, stage, k = r
    for i in range(len(B)):
        advance(A[i], i, dt, y, k, 0, 3, stage)
        _rates(box, p, line, state, tau + C[i] * dt, stage, k, i)
    advance(B, len(B), dt, y, k, 0, 3, end)


@compiled
def _rates(box, p, line, state, tau, y, k, i):
    """Write the derivatives of (x, x', z) = y into row i of k, with the law's own force."""
    mass, damping, stiffness, normal_force, amplitude, frequency, v_b = box
    t = line[0] + tau
    mu_s, mu_k = _branch(line[1] + tau * line[3], line[2] + tau * line[4], state, p)
    f, _ = law.force(t, y[2], 0.0, v_b - y[1], 0.0, normal_force, state, mu_s, mu_k, mass, 0.0, 0.0, p)
    drive = amplitude * math.cos(frequency * t) if amplitude != 0.0 else 0.0
    k[i, 0], k[i, 1], k[i, 2] = y[1], (f + drive - damping * y[1] - stiffness * y[0]) / mass, v_b - y[1]


@compiled
def _branch(mu_s, mu_k, state, p):
    """Return the pair that continues the present mode's force past its switch, so that a trial step meets no jump."""
    if state[0] == SLIP_PEAK:
        return mu_s, mu_s
    if state[0] == SLIP and p[5] <= 0.0:
        return mu_k, mu_k
    return mu_s, mu_k


leg = stepping(sys.modules[__name__])
simulate = kernel(sys.modules[__name__])
