"""Coulomb stick-slip of the belt-box in closed form between events: polynomials in time, whose roots are the events.

Between two events and two knots mu_s and mu_k are linear in time, and so position, speed and the slack mu_s N - abs(hold) are
Taylor series. In pieces of at most 0.35 rad of the fastest part of the motion twelve terms are exact to rounding
(0.35^13/13! = 2e-16).
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math
import sys

import numpy as np

from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.errors import SimulationError
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.numerics.first_zero import first_zero_of
from stochfric_mb.reference.events import BREAK_AWAY, STICK, note
from stochfric_mb.trajectory import Array

LONGEST = 0.35
"""Longest piece [rad of the fastest part of the motion]."""
TERMS = 13
"""Coefficients of a piece's Taylor polynomial."""
DIVISORS: Array = np.array([1.0 / ((e + 1) * (e + 2)) for e in range(TERMS)])
"""1/((e + 1) (e + 2)): what turns the e-th coefficient of an acceleration into the next one but two of the position."""
RESOLUTION = 1.0e-14
"""Part of a piece to which an event is found [-]: at most 0.35e-14 rad of the motion, which is below the rounding of x."""
MAX_SWITCHES = 10_000
"""Most switches within one piece."""


def obstacle(law: Law, path: CoefficientPath) -> str:
    """Return why the closed form does not apply; empty if it does."""
    if law.kind != "coulomb":
        return f"the law is {law.kind}, not coulomb"
    if path.descriptor[0] != 0.0 and not (path.descriptor[1] == TIME and path.descriptor[2] == 1.0):
        return "the coefficients are not linear in time"
    return ""


def integrate(
    mechanism: BeltBox, path: CoefficientPath, state: tuple[float, float], start_time: float, outputs: Array
) -> tuple[Array, Array, list[float], int]:
    """Return rows (x, x', F, mu_s, mu_k, stick) at ``outputs``, events, final law state and number of legs.

    Raises:
        SimulationError: the contact switches without end.
    """
    constant = path.descriptor[0] == 0.0
    spacing = math.inf if constant else float(path.descriptor[3])
    first = 0 if constant else math.floor(canonical_time(start_time, 0.0) / spacing)
    n = 2 if constant else math.floor((outputs[-1] + 1.0e-9) / spacing) - first + 3
    pairs = path.pairs(n, first)
    rows = np.empty((len(outputs), 6))
    rows[:, 3:5] = path.at_times(outputs)
    longest = LONGEST / mechanism.fastest
    log, mode, n_legs = march(
        mechanism.numbers(), longest, pairs, first, spacing, state, float(start_time), outputs, rows
    )  # fmt: skip
    if n_legs < 0:
        raise SimulationError(
            f"more than {MAX_SWITCHES} switches between two outputs, before the {-n_legs}th leg; use method='adaptive'"
        )
    return rows, log, [abs(mode), mode, 0.0], n_legs


@compiled
def march(box, longest, pairs, first, spacing, state, t, outputs, rows):
    """Integrate to each output; fill ``rows``; return (events, mode, number of legs, negative if it failed)."""
    x, v = state
    log = np.empty((64, 2))
    n_events = 0
    n_legs = 0
    i = 0
    knot = 0
    if (first + 1) * spacing <= t + 1.0e-12:
        knot = 1
    mode = first_mode(box, t, x, v, _line(pairs, knot, first, spacing, t)[0])
    while i < len(outputs):
        if outputs[i] <= t:
            rows[i, 0], rows[i, 1], rows[i, 5] = x, v, 1.0 if mode == 0.0 else 0.0
            mu_k = _line(pairs, knot, first, spacing, t)[2]
            rows[i, 2] = _hold(box, t, x, v) if mode == 0.0 else mode * mu_k * box.normal_force
            i += 1
            continue
        t_end = outputs[i]
        t_knot = (first + knot + 1) * spacing
        at_knot = t_knot <= t_end + 1.0e-12
        if t_knot < t_end - 1.0e-12:
            t_end = t_knot
        line = _line(pairs, knot, first, spacing, t)
        x, v, mode, log, n_events, fine = _leg(box, longest, line, t, t_end - t, x, v, mode, log, n_events)
        n_legs += 1
        if not fine:
            return log[:n_events].copy(), mode, -n_legs
        t = t_end
        if at_knot:
            knot += 1
    return log[:n_events].copy(), mode, n_legs


@compiled
def _line(pairs, knot, first, spacing, t):
    """Return (mu_s, its slope, mu_k, its slope) at time t in the segment from ``knot``."""
    if spacing == math.inf:
        return pairs[0, 0], 0.0, pairs[0, 1], 0.0
    since = t - (first + knot) * spacing
    slope_s = (pairs[knot + 1, 0] - pairs[knot, 0]) / spacing
    slope_k = (pairs[knot + 1, 1] - pairs[knot, 1]) / spacing
    return pairs[knot, 0] + slope_s * since, slope_s, pairs[knot, 1] + slope_k * since, slope_k


@compiled
def _leg(box, longest, line, t, length, x, v, mode, log, n_events):
    """Advance by ``length`` [s] with coefficients on one line; return (x, v, mode, log, events, whether it ended)."""
    g, motion = np.empty(TERMS), np.empty(TERMS)
    n = max(1, math.ceil(length / longest))
    for piece in range(n):
        tau, end = length * (piece / n), length * ((piece + 1) / n)
        for switch in range(MAX_SWITCHES + 1):
            rest = end - tau
            dt, x, v, new = to_next_event(box, line, t, tau, rest, x, v, mode, g, motion)
            if dt == rest:
                break
            if switch == MAX_SWITCHES:
                return x, v, mode, log, n_events, False
            tau += dt
            if (new == 0.0) != (mode == 0.0):
                log = note(log, n_events, t + tau, STICK if new == 0.0 else BREAK_AWAY)
                n_events += 1
            mode = new
    return x, v, mode, log, n_events, True


@compiled
def first_mode(box, t, x, v, mu_s):
    """Return 0 (stick) or the direction of sliding at time t."""
    if v != box.belt_velocity:
        return 1.0 if v < box.belt_velocity else -1.0
    return _mode_at_rest(box, t, x, mu_s)


@compiled_inline
def to_next_event(box, line, start, tau, rest, x, v, mode, g, motion):
    """Return (dt, x, x', mode) at the next switch of a contact, at most ``rest`` [s] on from ``tau`` after ``start``.

    Where dt is ``rest`` there is none: the mode stays. ``line`` is mu_s, its slope, mu_k and its slope at ``start``; ``g``
    and ``motion`` have room for a polynomial each.
    """
    mu_s, slope_s, mu_k, slope_k = line
    v_b = box.belt_velocity
    t = start + tau
    if mode == 0.0:
        dt, new = _break_away(box, t, x, mu_s + slope_s * tau, slope_s, rest, g)
        dt = min(dt, rest)
        return dt, x + v_b * dt, v_b, new
    _slip_motion(box, t, x, v, mode, mu_k + slope_k * tau, slope_k, motion)
    for e in range(TERMS - 1):
        g[e] = -mode * (e + 1) * motion[e + 1]
    g[0] += mode * v_b
    dt = min(first_zero((g, TERMS - 1), 0.0, rest), rest)
    x = value((motion, TERMS), dt)
    if dt == rest:
        return dt, x, v_b - mode * value((g, TERMS - 1), dt), mode
    tau += dt
    return dt, x, v_b, _mode_at_rest(box, start + tau, x, mu_s + slope_s * tau)


@compiled_inline
def _hold(box, t, x, v):
    """Return the friction force [N] that would make the relative acceleration zero."""
    return box.stiffness * x + box.damping * v - (box.drive * math.cos(box.frequency * t) if box.drive != 0.0 else 0.0)


@compiled_inline
def _mode_at_rest(box, t, x, mu_s):
    """Return 0 (stick) or the direction in which a contact at rest breaks away."""
    hold = _hold(box, t, x, box.belt_velocity)
    if abs(hold) <= mu_s * box.normal_force:
        return 0.0
    return 1.0 if hold > 0.0 else -1.0


@compiled
def _slip_motion(box, t, x, v, s, mu_k, slope, out):
    """Write the Taylor coefficients of the position while sliding in direction s from (x, v) at time t."""
    wave = box.drive * math.cos(box.frequency * t) if box.drive != 0.0 else 0.0
    next_wave = -box.drive * box.frequency * math.sin(box.frequency * t) if box.drive != 0.0 else 0.0
    inverse_mass = 1.0 / box.mass
    out[0] = x
    out[1] = v
    for e in range(TERMS - 2):
        force = wave
        if e == 0:
            force += s * box.normal_force * mu_k
        elif e == 1:
            force += s * box.normal_force * slope
        force -= box.damping * (e + 1) * out[e + 1] + box.stiffness * out[e]
        out[e + 2] = force * inverse_mass * DIVISORS[e]
        wave, next_wave = next_wave, -box.frequency * box.frequency * wave * DIVISORS[e]


@compiled
def _break_away(box, t, x, mu_s, rate_s, length, g):
    """Return (time to break-away [s], direction); infinity if the contact holds for ``length``."""
    hold = box.stiffness * x + box.damping * box.belt_velocity
    rate = box.stiffness * box.belt_velocity
    best, direction = math.inf, 0.0
    for s in (1.0, -1.0):
        wave, next_wave = 0.0, 0.0
        n = 2
        if box.drive != 0.0:
            wave = s * box.drive * math.cos(box.frequency * t)
            next_wave = -s * box.drive * box.frequency * math.sin(box.frequency * t)
            n = TERMS
        g[0], g[1] = mu_s * box.normal_force - s * hold, rate_s * box.normal_force - s * rate
        for e in range(n):
            g[e] = wave if e > 1 else g[e] + wave
            wave, next_wave = next_wave, -box.frequency * box.frequency * wave * DIVISORS[e]
        dt = first_zero((g, n), 0.0, length)
        if dt < best:
            best, direction = dt, s
    return best, direction


@compiled_inline
def value(g, t):
    """Return the polynomial with the first n coefficients c at time t; g = (c, n)."""
    c, n = g
    total = c[n - 1]
    for e in range(n - 2, -1, -1):
        total = total * t + c[e]
    return total


@compiled_inline
def slope(g, t):
    """Return its derivative."""
    c, n = g
    total = (n - 1) * c[n - 1]
    for e in range(n - 2, 0, -1):
        total = total * t + e * c[e]
    return total


first_zero = first_zero_of(sys.modules[__name__], RESOLUTION)
