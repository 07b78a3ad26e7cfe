"""Coulomb, event-driven: one matrix product a leg, and the reference's closed form only where an event falls.

Within a leg mu_s and mu_k are linear in time. While sliding, position and velocity at its end are linear in those at
its start, in mu_k at both ends and in the harmonic excitation: the state transition of the oscillator, exact whatever
the length. A leg in which a contact may break away, stick or turn over is done sample by sample, by
`stochfric_mb.reference.coulomb`, so that legs are no longer than its pieces.
"""

from __future__ import annotations

import sys
from typing import NamedTuple

import numpy as np

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.kernel import kernel
from stochfric_mb.ensemble.lanes import A_K, A_S, B_K, B_S, LANES, SHARED_ROWS, V, X, note_break_away, note_slip_end
from stochfric_mb.ensemble.schedule import Array, Schedule, schedule
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.mechanisms.belt_box import BoxNumbers
from stochfric_mb.reference.coulomb import LONGEST, MAX_SWITCHES, TERMS, first_mode, to_next_event
from stochfric_mb.scenario import Scenario

TABLE_TERMS = 20
"""Coefficients of the Taylor polynomials of the tables, whose error would add up over the legs."""
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
    box: BoxNumbers
    """The mechanism."""
    position: float
    """x at t = 0 [m]; then x' [m/s]."""
    velocity: float
    least_slip: float
    """Travel from which a slip counts as one [m]."""


def problem(scenario: Scenario, output_times: Array, least_slip: float) -> Problem:
    """Return what all samples of an ensemble share."""
    b = scenario.mechanism
    legs = schedule(scenario, output_times, longest=LONGEST / b.fastest)
    transition, drive = _tables(b, legs)
    return Problem(
        legs=legs,
        transition=transition,
        drive=drive,
        descriptor=scenario.path(0).descriptor,
        box=b.numbers(),
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


@compiled
def numbers(q):
    """Return the box's numbers and the least slip: eight reals, which all travel in registers."""
    b = q.box
    return b.mass, b.damping, b.stiffness, b.normal_force, b.drive, b.frequency, b.belt_velocity, q.least_slip


@compiled
def start(q, m):
    """Set every lane to stick or to a direction of sliding."""
    for j in range(LANES):
        m[MODE + j] = first_mode(q.box, 0.0, q.position, q.velocity, m[A_S + j])


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
    start, length, w0, w1 = leg
    box, least_slip = BoxNumbers(*body[:7]), body[7]
    a_s, a_k = m[A_S + j], m[A_K + j]
    d_s, d_k = m[B_S + j] - a_s, m[B_K + j] - a_k
    line = (a_s + w0 * d_s, (w1 - w0) * d_s / length, a_k + w0 * d_k, (w1 - w0) * d_k / length)
    x, v, s = m[X + j], m[V + j], m[MODE + j]
    g, motion = m[WORK : WORK + TERMS], m[WORK + TERMS : WORK + 2 * TERMS]
    tau = 0.0
    for _ in range(MAX_SWITCHES):
        rest = length - tau
        dt, x, v, new = to_next_event(box, line, start, tau, rest, x, v, s, g, motion)
        if dt == rest:
            m[X + j], m[V + j], m[MODE + j] = x, v, s
            return True
        tau += dt
        t = start + tau
        if s == 0.0:
            note_break_away(tally, pending, j, t, box.belt_velocity * t - x, line[0] + line[1] * tau)
        else:
            note_slip_end(tally, pending, j, t, box.belt_velocity * t - x, least_slip, new == 0.0)
        s = new
    return False


simulate = kernel(sys.modules[__name__])
