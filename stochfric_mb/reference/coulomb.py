"""Coulomb stick-slip of the belt-box in closed form between events.

Between two events and two knots everything that matters is one kind of curve in the time tau since the last of them::

    g(tau) = exp(-d tau) (C cos w tau + D sin w tau) + q0 + q1 tau + P cos(W (t + tau)) + Q sin(W (t + tau))

the position while sliding (mu_k linear in time), its derivatives, and the slack mu_s N - abs(hold) while stuck. So one
routine finds the first zero of such a curve.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math
import sys
from typing import NamedTuple

import numpy as np

from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled
from stochfric_mb.errors import SimulationError
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.numerics.first_zero import first_zero_of
from stochfric_mb.reference.events import BREAK_AWAY, STICK, note
from stochfric_mb.trajectory import Array

MAX_SWITCHES_PER_LEG = 10_000
SHORTEST = 1.0e-14
"""Rest of a leg [s] in which nothing is looked for: below the rounding of the forces."""


class Curve(NamedTuple):
    """A curve g(tau) of the kind above."""

    decay: float
    """d [1/s]."""
    natural: float
    """w [rad/s]."""
    cosine: float
    """C."""
    sine: float
    """D."""
    constant: float
    """q0."""
    slope: float
    """q1."""
    forcing: float
    """W [rad/s]."""
    phase: float
    """W t at tau = 0 [rad]."""
    in_phase: float
    """P."""
    out_of_phase: float
    """Q."""


class Oscillator(NamedTuple):
    """The belt-box in the numbers that the closed form needs."""

    mass: float
    """m [kg]; then c [N s/m], k [N/m], N [N], k u_0 [N], W [rad/s], v_b [m/s]."""
    damping: float
    stiffness: float
    normal_force: float
    drive: float
    forcing: float
    belt_velocity: float
    decay: float
    """c/(2 m) [1/s]."""
    natural: float
    """Damped angular frequency [rad/s]."""
    in_phase: float
    """Steady response to the drive along cos W t [m]."""
    out_of_phase: float
    """Steady response along sin W t [m]."""


def obstacle(mechanism: BeltBox, law: Law, path: CoefficientPath) -> str:
    """Return why the closed form does not apply; empty if it does."""
    if law.kind != "coulomb":
        return f"the law is {law.kind}, not coulomb"
    if path.descriptor[0] != 0.0 and not (path.descriptor[1] == TIME and path.descriptor[2] == 1.0):
        return "the coefficients are not linear in time"
    if mechanism.damping**2 >= 3.99 * mechanism.mass * mechanism.stiffness:
        return "damping is critical or above"
    if mechanism.damping == 0.0 and mechanism.excitation_amplitude != 0.0:
        ratio = mechanism.mass * mechanism.excitation_angular_frequency**2 / mechanism.stiffness
        if abs(ratio - 1.0) < 1.0e-3:
            return "the undamped oscillator is driven at resonance"
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
    coefficients = path.at_times(outputs)
    rows = np.empty((len(outputs), 6))
    rows[:, 3:5] = coefficients
    log, mode, n_legs = march(_oscillator(mechanism), pairs, first, spacing, state, float(start_time), outputs, rows)
    if n_legs < 0:
        raise SimulationError(
            f"more than {MAX_SWITCHES_PER_LEG} switches between two outputs, before the {-n_legs}th leg; use method='adaptive'"
        )
    return rows, log, [abs(mode), mode, 0.0], n_legs


def _oscillator(mechanism: BeltBox) -> Oscillator:
    m, c, k, w = mechanism.mass, mechanism.damping, mechanism.stiffness, mechanism.excitation_angular_frequency
    drive = k * mechanism.excitation_amplitude
    gap = k - m * w * w
    response = drive / (gap * gap + (c * w) ** 2) if drive != 0.0 else 0.0
    decay = c / (2.0 * m)
    return Oscillator(
        mass=m,
        damping=c,
        stiffness=k,
        normal_force=mechanism.normal_force,
        drive=drive,
        forcing=w,
        belt_velocity=mechanism.belt_velocity,
        decay=decay,
        natural=math.sqrt(k / m - decay * decay),
        in_phase=response * gap,
        out_of_phase=response * c * w,
    )


@compiled
def march(o, pairs, first, spacing, state, t, outputs, rows):
    """Integrate to each output; fill ``rows``; return (events, mode, number of legs, negative if it failed)."""
    x, v = state
    log = np.empty((64, 2))
    n_events = 0
    n_legs = 0
    i = 0
    knot = 0
    if (first + 1) * spacing <= t + 1.0e-12:
        knot = 1
    mu_s, _, mu_k, _ = _line(pairs, knot, first, spacing, t)
    mode = _first_mode(o, t, x, v, mu_s)
    while i < len(outputs):
        if outputs[i] <= t:
            _, _, mu_k, _ = _line(pairs, knot, first, spacing, t)
            hold = _hold(o, t, x, v)
            rows[i, 0], rows[i, 1], rows[i, 5] = x, v, 1.0 if mode == 0.0 else 0.0
            rows[i, 2] = hold if mode == 0.0 else mode * mu_k * o.normal_force
            i += 1
            continue
        t_end = outputs[i]
        t_knot = (first + knot + 1) * spacing
        at_knot = t_knot <= t_end + 1.0e-12
        if t_knot < t_end - 1.0e-12:
            t_end = t_knot
        line = _line(pairs, knot, first, spacing, t)
        x, v, mode, log, n_events, fine = _leg(o, line, t, t_end - t, x, v, mode, log, n_events)
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
def _hold(o, t, x, v):
    """Return the friction force [N] that would make the relative acceleration zero."""
    return o.damping * v + o.stiffness * x - o.drive * math.cos(o.forcing * t)


@compiled
def _first_mode(o, t, x, v, mu_s):
    """Return 0 (stick) or the direction of sliding, +1 or -1."""
    if v != o.belt_velocity:
        return 1.0 if v < o.belt_velocity else -1.0
    return _mode_at_rest(o, t, x, mu_s)


@compiled
def _mode_at_rest(o, t, x, mu_s):
    """Return the mode that the holding force allows a contact at rest."""
    hold = _hold(o, t, x, o.belt_velocity)
    if abs(hold) <= mu_s * o.normal_force:
        return 0.0
    return 1.0 if hold > 0.0 else -1.0


@compiled
def _leg(o, line, t, length, x, v, mode, log, n_events):
    """Advance by ``length`` [s] with coefficients on one line; return (x, v, mode, log, events, whether it ended)."""
    mu_s, slope_s, mu_k, slope_k = line
    tau = 0.0
    for _ in range(MAX_SWITCHES_PER_LEG):
        rest = length - tau
        if rest < SHORTEST:
            return x + v * rest, v, mode, log, n_events, True
        if mode == 0.0:
            dt, direction = _break_away(o, t + tau, x, mu_s + slope_s * tau, slope_s, rest)
            x += o.belt_velocity * min(dt, rest)
            v = o.belt_velocity
            new = direction
        else:
            curve = _sliding(o, t + tau, x, v, mode, mu_k + slope_k * tau, slope_k)
            dt = first_zero(_slack_of_speed(o, _derivative(curve), mode), rest)
            x = value(curve, min(dt, rest))
            v = o.belt_velocity if dt < rest else value(_derivative(curve), rest)
            new = mode
        if dt >= rest:
            return x, v, mode, log, n_events, True
        tau += dt
        if mode != 0.0:
            new = _mode_at_rest(o, t + tau, x, mu_s + slope_s * tau)
        if (new == 0.0) != (mode == 0.0):
            log = note(log, n_events, t + tau, STICK if new == 0.0 else BREAK_AWAY)
            n_events += 1
        mode = new
    return x, v, mode, log, n_events, False


# --- curves -----------------------------------------------------------------------------------------------------------


@compiled
def _sliding(o, t, x, v, direction, mu_k, slope):
    """Return the position while sliding from (x, v) at time t, with mu_k + slope tau."""
    q1 = direction * o.normal_force * slope / o.stiffness
    q0 = (direction * o.normal_force * mu_k - o.damping * q1) / o.stiffness
    phase = o.forcing * t
    c, s = math.cos(phase), math.sin(phase)
    cosine = x - q0 - o.in_phase * c - o.out_of_phase * s
    speed = v - q1 - o.forcing * (o.out_of_phase * c - o.in_phase * s)
    sine = (speed + o.decay * cosine) / o.natural
    return Curve(o.decay, o.natural, cosine, sine, q0, q1, o.forcing, phase, o.in_phase, o.out_of_phase)


@compiled
def _derivative(g):
    """Return dg/dtau as a curve."""
    return Curve(
        g.decay,
        g.natural,
        g.natural * g.sine - g.decay * g.cosine,
        -g.natural * g.cosine - g.decay * g.sine,
        g.slope,
        0.0,
        g.forcing,
        g.phase,
        g.forcing * g.out_of_phase,
        -g.forcing * g.in_phase,
    )


@compiled
def _slack_of_speed(o, v, direction):
    """Return direction (v_b - v(tau)), positive while sliding goes on."""
    s = -direction
    constant = s * (v.constant - o.belt_velocity)
    return Curve(
        v.decay, v.natural, s * v.cosine, s * v.sine, constant, s * v.slope, v.forcing, v.phase,
        s * v.in_phase, s * v.out_of_phase,
    )  # fmt: skip


@compiled
def _break_away(o, t, x, mu_s, slope, rest):
    """Return (time to break-away [s], direction); the time is ``rest`` or more if it holds."""
    best = math.inf
    direction = 0.0
    for s in (1.0, -1.0):
        constant = mu_s * o.normal_force - s * (o.stiffness * x + o.damping * o.belt_velocity)
        rate = slope * o.normal_force - s * o.stiffness * o.belt_velocity
        slack = Curve(0.0, 0.0, 0.0, 0.0, constant, rate, o.forcing, o.forcing * t, s * o.drive, 0.0)
        dt = first_zero(slack, rest)
        if dt < best:
            best = dt
            direction = s
    return best, direction


@compiled
def value(g, tau):
    """Return g(tau)."""
    ring = math.exp(-g.decay * tau) * (g.cosine * math.cos(g.natural * tau) + g.sine * math.sin(g.natural * tau))
    angle = g.phase + g.forcing * tau
    forced = g.in_phase * math.cos(angle) + g.out_of_phase * math.sin(angle)
    return ring + g.constant + g.slope * tau + forced


@compiled
def slope(g, tau):
    """Return dg/dtau(tau)."""
    return value(_derivative(g), tau)


@compiled
def first_zero(g, length):
    """Return the first tau in [0, length) after which g is negative, or infinity.

    A curve that starts at or below zero and rises is taken as positive until it comes back. It is searched in pieces
    of 0.2 rad of its fastest part, in which it has at most one extremum.
    """
    fastest = max(g.natural, g.forcing)
    n = max(1, math.ceil(length * fastest / 0.2))
    for i in range(n):
        tau = zero_within(g, i * (length / n), (i + 1) * (length / n))
        if tau < math.inf:
            return tau
    return math.inf


zero_within = first_zero_of(sys.modules[__name__], 0.0)
