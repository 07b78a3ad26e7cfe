"""Coulomb, event-driven: one matrix product a leg, and the leg's Taylor polynomial only where an event falls.

Within a leg mu_s and mu_k are linear in time. While sliding, position and velocity at its end are linear in those at
its start, in mu_k at both ends and in the harmonic excitation: the state transition of the oscillator, exact whatever
the length. A leg in which a contact may break away, stick or turn over is done sample by sample: legs are at most 0.35
rad of the fastest part of the motion long, so that twelve terms of the Taylor series are exact to rounding
(0.35^13/13! = 2e-16), and events are roots of a polynomial.
"""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

import numpy as np

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.kernel import kernel
from stochfric_mb.ensemble.lanes import A_K, A_S, B_K, B_S, LANES, SHARED_ROWS, V, X, note_break_away, note_slip_end
from stochfric_mb.ensemble.schedule import Array, Schedule, schedule
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.numerics.first_zero import first_zero_of
from stochfric_mb.scenario import Scenario

LONGEST_LEG = 0.35
"""Longest leg [rad of the fastest part of the motion]."""
TERMS = 13
"""Coefficients of a leg's Taylor polynomial."""
DIVISORS: Array = np.array([1.0 / ((e + 1) * (e + 2)) for e in range(TERMS)])
"""1/((e + 1) (e + 2)): what turns the e-th coefficient of an acceleration into the next one but two of the position."""
TABLE_TERMS = 20
"""The same for the tables, whose error would add up over the legs."""
RESOLUTION = 1.0e-14
"""Part of a leg to which an event is found [-]: at most 0.35e-14 rad of the motion, which is below the rounding of x."""
MAX_SWITCHES = 10_000
"""Most switches within one leg."""
# Rows of the flat array beside the shared ones: 0 (stick) or the direction of sliding, whether the leg has an event, and
# room for two polynomials
MODE, EVENTFUL, WORK = (LANES * (SHARED_ROWS + i) for i in range(3))
ROWS = SHARED_ROWS + 3


class Problem(NamedTuple):
    """What all samples share."""

    legs: Schedule
    """The common time grid."""
    transition: Array
    """x and x' at a leg's end from x, x', mu_k at its start and mu_k at its end, shape (n_kinds, 2, 4)."""
    drive: Array
    """k u_0 cos W t [N] at the start and the end of each leg, and its share of x and x' at the end, shape (n_legs, 4)."""
    descriptor: Array
    """Descriptor of the coefficient paths."""
    mass: float
    """m [kg]; then c [N s/m], k [N/m], N [N], k u_0 [N], W [rad/s], v_b [m/s], x and x' at t = 0, least slip [m]."""
    damping: float
    stiffness: float
    normal_force: float
    amplitude: float
    frequency: float
    belt_velocity: float
    position: float
    velocity: float
    least_slip: float


def problem(scenario: Scenario, output_times: Array, least_slip: float) -> Problem:
    """Return what all samples of an ensemble share."""
    b = scenario.mechanism
    fastest = max(math.sqrt(b.stiffness / b.mass), b.excitation_angular_frequency, b.damping / b.mass)
    legs = schedule(scenario, output_times, longest=LONGEST_LEG / fastest)
    transition, drive = _tables(b, legs)
    return Problem(
        legs=legs,
        transition=transition,
        drive=drive,
        descriptor=scenario.path(0).descriptor,
        mass=b.mass,
        damping=b.damping,
        stiffness=b.stiffness,
        normal_force=b.normal_force,
        amplitude=b.stiffness * b.excitation_amplitude,
        frequency=b.excitation_angular_frequency,
        belt_velocity=b.belt_velocity,
        position=b.initial_position,
        velocity=b.initial_velocity,
        least_slip=least_slip,
    )


def _tables(b: BeltBox, legs: Schedule) -> tuple[Array, Array]:
    """Return ``transition`` and ``drive``."""
    w, amplitude, h = b.excitation_angular_frequency, b.stiffness * b.excitation_amplitude, legs.lengths
    rising = _response(b, h, slope=b.normal_force) / h[:, None]  # to mu_k going from 0 to 1
    constant = _response(b, h, force=b.normal_force)
    columns = [_response(b, h, x=1.0), _response(b, h, v=1.0), constant - rising, rising]
    phase: Array = w * legs.start
    cosine = _response(b, h, force=amplitude, frequency=w)[legs.kind]
    sine = _response(b, h, slope=amplitude * w, frequency=w)[legs.kind]
    response = cosine * np.cos(phase)[:, None] - sine * np.sin(phase)[:, None]
    ends: Array = amplitude * np.cos(w * np.stack([legs.start, legs.start + legs.length], axis=1))
    return np.ascontiguousarray(np.stack(columns, axis=2)), np.concatenate([ends, response], axis=1)


def _response(
    b: BeltBox, h: Array, *, x: float = 0.0, v: float = 0.0, force: float = 0.0, slope: float = 0.0, frequency: float = 0.0
) -> Array:
    """Return x and x' at the times h [s], shape (n, 2), from a force f with f(0), f'(0) given and f'' = -frequency^2 f.

    By the Taylor series (and not by a matrix exponential, whose linear algebra would wake up its own threads).
    """
    c = [x, v]
    for e in range(TABLE_TERMS - 2):
        c.append((force - b.damping * (e + 1) * c[e + 1] - b.stiffness * c[e]) / (b.mass * (e + 1) * (e + 2)))
        force, slope = slope, -(frequency**2) * force / ((e + 1) * (e + 2))
    position, velocity = np.zeros(len(h)), np.zeros(len(h))
    for e in range(TABLE_TERMS - 1, -1, -1):
        velocity = velocity * h + position
        position = position * h + c[e]
    return np.stack([position, velocity], axis=1)


# body: m, c, k, N, k u_0, W, v_b, least slip; leg: start, length, parts of the way between knots at its start and end


@compiled
def numbers(q):
    """Return the body."""
    return q.mass, q.damping, q.stiffness, q.normal_force, q.amplitude, q.frequency, q.belt_velocity, q.least_slip


@compiled
def start(q, m):
    """Set every lane to stick or to a direction of sliding."""
    for j in range(LANES):
        m[MODE + j] = _first_mode(numbers(q), q.position, q.velocity, m[A_S + j])


@compiled_inline
def sticks(q, m, j):
    """Return whether lane j is stuck."""
    return m[MODE + j] == 0.0


@compiled_inline
def leg(q, i, body, m, tally, pending):
    """Move all lanes to the end of leg i; return whether that ended."""
    this = (q.legs.start[i], q.legs.length[i], q.legs.from_knot[i], q.legs.to_knot[i])
    if _calm_leg(body, this, q.transition[q.legs.kind[i]], q.drive[i], m) == 0:
        return True
    ended = True
    for j in range(LANES):
        if m[EVENTFUL + j] == 1.0 and not _eventful_leg(body, this, j, m, tally, pending):
            ended = False
    return ended


@compiled
def _first_mode(body, x, v, mu_s):
    """Return 0 (stick) or the direction of sliding at t = 0."""
    if v != body[6]:
        return 1.0 if v < body[6] else -1.0
    return _mode_at_rest(body, 0.0, x, mu_s)


@compiled
def _mode_at_rest(body, t, x, mu_s):
    """Return 0 (stick) or the direction in which a contact at rest breaks away."""
    _, damping, stiffness, normal_force, amplitude, frequency, v_b, _ = body
    hold = stiffness * x + damping * v_b - (amplitude * math.cos(frequency * t) if amplitude != 0.0 else 0.0)
    if abs(hold) <= mu_s * normal_force:
        return 0.0
    return 1.0 if hold > 0.0 else -1.0


@compiled
def _calm_leg(body, leg, e, drive, m):
    """Move the lanes without an event to the end of a leg; mark the others and return how many they are."""
    xx, xv, x0, x1, vx, vv, v0, v1 = e[0, 0], e[0, 1], e[0, 2], e[0, 3], e[1, 0], e[1, 1], e[1, 2], e[1, 3]
    f0, f1, fx, fv = drive[0], drive[1], drive[2], drive[3]
    _, c, k, nf, amplitude, frequency, vb, _ = body
    _, h, w0, w1 = leg
    bulge = abs(amplitude) * frequency * frequency * h * h / 8.0
    count = 0
    for j in range(LANES):
        s, x, v = m[MODE + j], m[X + j], m[V + j]
        a_s, a_k = m[A_S + j], m[A_K + j]
        d_s, d_k = m[B_S + j] - a_s, m[B_K + j] - a_k
        s0, s1 = (a_s + w0 * d_s) * nf - bulge, (a_s + w1 * d_s) * nf - bulge
        k0, k1 = a_k + w0 * d_k, a_k + w1 * d_k
        x_stick = x + vb * h
        holds = (abs(k * x + c * vb - f0) <= s0) & (abs(k * x_stick + c * vb - f1) <= s1)
        x_slip = xx * x + xv * v + s * (x0 * k0 + x1 * k1) + fx
        v_slip = vx * x + vv * v + s * (v0 * k0 + v1 * k1) + fv
        g0 = s * (k * x + c * v - f0) - k0 * nf
        g1 = s * (k * x_slip + c * v_slip - f1) - k1 * nf
        speed0 = s * (vb - v)
        speed1 = s * (vb - v_slip)
        slides = (speed1 > 0.0) & ((g0 >= 0.0) | (g1 <= 0.0)) & ((speed0 > 0.0) | ((speed0 == 0.0) & (g0 > 0.0)))
        stuck = s == 0.0
        calm = holds if stuck else slides
        m[X + j] = (x_stick if stuck else x_slip) if calm else x
        m[V + j] = (vb if stuck else v_slip) if calm else v
        m[EVENTFUL + j] = 0.0 if calm else 1.0
        count += 0 if calm else 1
    return count


@compiled
def _eventful_leg(body, leg, j, m, tally, pending):
    """Move lane j to the end of a leg, event by event; return whether that ended."""
    v_b, least_slip = body[6], body[7]
    start, length, w0, w1 = leg
    a_s, a_k = m[A_S + j], m[A_K + j]
    d_s, d_k = m[B_S + j] - a_s, m[B_K + j] - a_k
    mu_s, mu_k = a_s + w0 * d_s, a_k + w0 * d_k
    slope_s, slope_k = (w1 - w0) * d_s / length, (w1 - w0) * d_k / length
    g, motion = m[WORK : WORK + TERMS], m[WORK + TERMS : WORK + 2 * TERMS]
    x, v, s = m[X + j], m[V + j], m[MODE + j]
    tau = 0.0
    for _ in range(MAX_SWITCHES):
        t, rest = start + tau, length - tau
        if s == 0.0:
            dt, new = _break_away(body, t, x, mu_s + slope_s * tau, slope_s, rest, g)
            dt = min(dt, rest)
            x += v_b * dt
            v = v_b
        else:
            _slip_motion(body, t, x, v, s, mu_k + slope_k * tau, slope_k, motion)
            for e in range(TERMS - 1):
                g[e] = -s * (e + 1) * motion[e + 1]
            g[0] += s * v_b
            dt = min(first_zero((g, TERMS - 1), 0.0, rest), rest)
            x = value((motion, TERMS), dt)
            v = v_b - s * value((g, TERMS - 1), dt) if dt == rest else v_b
            new = s
        if dt == rest:
            m[X + j], m[V + j], m[MODE + j] = x, v, s
            return True
        tau += dt
        t = start + tau
        if s == 0.0:
            note_break_away(tally, pending, j, t, v_b * t - x, mu_s + slope_s * tau)
        else:
            new = _mode_at_rest(body, t, x, mu_s + slope_s * tau)
            note_slip_end(tally, pending, j, t, v_b * t - x, least_slip, new == 0.0)
        s = new
    return False


@compiled
def _slip_motion(body, t, x, v, s, mu_k, slope, out):
    """Write the Taylor coefficients of the position while sliding in direction s from (x, v) at time t."""
    mass, damping, stiffness, normal_force, amplitude, frequency, _, _ = body
    wave = amplitude * math.cos(frequency * t) if amplitude != 0.0 else 0.0
    next_wave = -amplitude * frequency * math.sin(frequency * t) if amplitude != 0.0 else 0.0
    inverse_mass = 1.0 / mass
    out[0] = x
    out[1] = v
    for e in range(TERMS - 2):
        force = wave
        if e == 0:
            force += s * normal_force * mu_k
        elif e == 1:
            force += s * normal_force * slope
        force -= damping * (e + 1) * out[e + 1] + stiffness * out[e]
        out[e + 2] = force * inverse_mass * DIVISORS[e]
        wave, next_wave = next_wave, -frequency * frequency * wave * DIVISORS[e]


@compiled
def _break_away(body, t, x, mu_s, rate_s, length, g):
    """Return (time to break-away [s], direction); infinity if the contact holds for ``length``."""
    _, damping, stiffness, normal_force, amplitude, frequency, v_b, _ = body
    hold = stiffness * x + damping * v_b
    rate = stiffness * v_b
    best, direction = math.inf, 0.0
    for s in (1.0, -1.0):
        wave, next_wave = 0.0, 0.0
        n = 2
        if amplitude != 0.0:
            wave = s * amplitude * math.cos(frequency * t)
            next_wave = -s * amplitude * frequency * math.sin(frequency * t)
            n = TERMS
        g[0], g[1] = mu_s * normal_force - s * hold, rate_s * normal_force - s * rate
        for e in range(n):
            g[e] = wave if e > 1 else g[e] + wave
            wave, next_wave = next_wave, -frequency * frequency * wave * DIVISORS[e]
        dt = first_zero((g, n), 0.0, length)
        if dt < best:
            best, direction = dt, s
    return best, direction


# --- polynomials ------------------------------------------------------------------------------------------------------


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
simulate = kernel(sys.modules[__name__])
