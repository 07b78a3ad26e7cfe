"""The augmented belt-box in compiled code: what acts on the box, in each mode of its contact, with any effects.

One record holds the model and the run, so that compiled functions pass one pointer; effects are called through their
addresses, so that one compilation serves them all.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.coefficients.path import CURSOR, evaluate
from stochfric_mb.compile import compiled
from stochfric_mb.effects import contract as e
from stochfric_mb.effects.abi import call_effect
from stochfric_mb.laws import elastic_stick, stribeck
from stochfric_mb.numerics.runge_kutta import DOPRI5

MAX_EFFECTS = 24
MAX_PARAMETERS = 24 * MAX_EFFECTS
"""As many waves in time, whose course has many weights, as effects."""
MAX_MEMORY = 8
UNKNOWNS = 2 + MAX_MEMORY
"""x, x' and the effects' memories."""
STAGES = len(DOPRI5.b)
TEMPERATURES = 128
"""Knots of the measured temperature."""

# Modes of the contact.
STUCK, SLIDING, SPRING = 0.0, 1.0, 2.0
"""Stuck rigidly; sliding; stuck by a spring (presliding compliance)."""
# The law's sliding coefficient before effects.
COULOMB, ELASTIC, STRIBECK = 0.0, 1.0, 2.0

# Entries of ``constants``.
(M, C, K, N, VB, FOOT, W, MEAN_S, MEAN_K, CURVE, DECAY, RESTICK, FORM, LIMIT, ZETA, SEED, SAMPLE, CONTACT, TOLERANCE,
 LONGEST_SLIDE, LONGEST_STICK, KNOTS, RESTART) = range(23)  # fmt: skip
# Entries of ``clock``.
(NOW, MODE, SIDE, ARMED, DWELL, SINCE, BROKE_AT, SLID, X_STUCK, TRAVEL_STUCK, ANCHOR, DRAWS, STEP, SWITCHES,
 STATUS, MARGIN) = range(16)  # fmt: skip

_REAL = np.float64
RUN = np.dtype(
    [
        ("constants", _REAL, 23),
        ("counts", np.int64, 3),  # effects around the contact, effects on friction, unknowns of their memories
        ("around", np.int64, (MAX_EFFECTS, 3)),  # address, offset of p, offset of the memory
        ("friction", np.int64, (MAX_EFFECTS, 3)),
        ("p", _REAL, MAX_PARAMETERS),
        ("y", _REAL, UNKNOWNS),  # present unknowns
        ("end", _REAL, UNKNOWNS),  # unknowns at the end of the step tried last
        ("probe", _REAL, UNKNOWNS),  # unknowns of a stage or of a point within the step
        ("unused", _REAL, UNKNOWNS),  # rates that nobody reads
        ("stages", _REAL, (STAGES, UNKNOWNS)),
        ("clock", _REAL, 16),
        ("world", _REAL, e.WORLD),
        ("cursor", _REAL, CURSOR),
        (
            "temperature",
            _REAL,
            2 + TEMPERATURES,
        ),  # time of the first knot [s], their distance [s] (0: none), temperatures [degC]
    ]
)
"""The model and the run."""


@compiled
def temperature_at(table, t):
    """Return the temperature [degC] at a time [s]: linear between knots, constant outside."""
    place = min(max((t - table[0]) / table[1], 0.0), TEMPERATURES - 1.0)
    knot = min(int(place), TEMPERATURES - 2)
    return table[2 + knot] + (place - knot) * (table[3 + knot] - table[2 + knot])


@compiled
def surround(r, t, y, rates):
    """Find what is around the contact for the unknowns y; the rates of the memories are written into ``rates``."""
    c, w = r.constants, r.world
    w[e.TIME], w[e.POSITION], w[e.VELOCITY] = t, y[0], y[1]
    w[e.MASS], w[e.STIFFNESS], w[e.MEAN_BELT_VELOCITY] = c[M], c[K], c[VB]
    w[e.SEED], w[e.SAMPLE] = c[SEED], c[SAMPLE]
    w[e.BELT_VELOCITY], w[e.BELT_ACCELERATION], w[e.BELT_TRAVEL] = c[VB], 0.0, c[VB] * t
    w[e.NORMAL_FORCE] = c[N]
    w[e.LOAD] = 0.0
    if r.temperature[1] > 0.0:
        w[e.TEMPERATURE] = temperature_at(r.temperature, t)
    for i in range(r.counts[0]):
        offset = 8 * (2 + r.around[i, 2])
        call_effect(
            r.around[i, 0], w.ctypes.data, y.ctypes.data + offset, rates.ctypes.data + offset,
            r.p.ctypes.data + 8 * r.around[i, 1],
        )  # fmt: skip


@compiled
def ride(r, t, y, rates):
    """Put the box where the belt has carried it since it stuck, and find what is around it there."""
    clock, c, w = r.clock, r.constants, r.world
    travel = c[VB] * t
    y[0] = clock[X_STUCK] + (travel - clock[TRAVEL_STUCK])
    y[1] = c[VB]
    surround(r, t, y, rates)
    if w[e.BELT_TRAVEL] != travel or w[e.BELT_VELOCITY] != c[VB]:
        y[0] = clock[X_STUCK] + (w[e.BELT_TRAVEL] - clock[TRAVEL_STUCK])
        y[1] = w[e.BELT_VELOCITY]
        surround(r, t, y, rates)


@compiled
def external(r, t):
    """Return the force on the box [N] that neither friction nor damper exerts, after `surround`."""
    c, w = r.constants, r.world
    force = w[e.LOAD] - c[K] * w[e.POSITION]
    if c[FOOT] != 0.0:
        force += c[K] * c[FOOT] * math.cos(c[W] * t)
    return force


@compiled
def hold(r, t):
    """Return the friction force [N] that would make the box follow the belt, after `surround`."""
    c, w = r.constants, r.world
    return c[C] * w[e.BELT_VELOCITY] + c[M] * w[e.BELT_ACCELERATION] - external(r, t)


@compiled
def rub(r, d, t, direction, speed, dwell, slip, slip_time):
    """Find the coefficients, after `surround`: path, effects, law's curve between the two.

    Where friction at the lowest sliding speed exceeds mu_s the contact cannot slide away, so it holds up to there.
    """
    c, w = r.constants, r.world
    w[e.DIRECTION], w[e.SPEED], w[e.DWELL], w[e.SLIP], w[e.SLIP_TIME] = direction, speed, dwell, slip, slip_time
    w[e.BELT_POSITION] = w[e.BELT_TRAVEL] - w[e.POSITION]
    mu_s, mu_k = evaluate(
        d, r.cursor, int(c[SEED]), int(c[SAMPLE]), int(c[CONTACT]), t, w[e.BELT_POSITION], r.clock[DRAWS]
    )  # fmt: skip
    w[e.MU_S], w[e.MU_K], w[e.VISCOUS_FORCE] = mu_s, mu_k, 0.0
    for i in range(r.counts[1]):
        call_effect(r.friction[i, 0], w.ctypes.data, 0, 0, r.p.ctypes.data + 8 * r.friction[i, 1])
    w[e.MU_K] = max(w[e.MU_K], 0.0)  # friction takes energy, whatever factors effects multiply it by
    w[e.MU_S] = max(w[e.MU_S], w[e.MU_K])
    if c[CURVE] == ELASTIC:
        w[e.MU_K] = elastic_stick.slip_coefficient(speed, w[e.MU_S], w[e.MU_K], c[RESTICK], c[DECAY])
    elif c[CURVE] == STRIBECK:
        w[e.MU_K] = stribeck.slip_coefficient(speed, w[e.MU_S], w[e.MU_K], c[DECAY], c[FORM])


@compiled
def slide(r, d, t, y, rates):
    """Find everything for a sliding contact; return the friction force [N]."""
    surround(r, t, y, rates)
    clock, w = r.clock, r.world
    speed = max(clock[SIDE] * (w[e.BELT_VELOCITY] - y[1]), 0.0)
    slip = clock[SLID] + abs(w[e.BELT_TRAVEL] - y[0] - clock[BROKE_AT])
    rub(r, d, t, clock[SIDE], speed, clock[DWELL], slip, max(t - clock[SINCE] - clock[DWELL], 0.0))
    return clock[SIDE] * (w[e.MU_K] * w[e.NORMAL_FORCE] + w[e.VISCOUS_FORCE])


@compiled
def stick(r, d, t, y, rates):
    """Find everything for a contact that rides on the belt; return (holding force, its limit) [N]."""
    ride(r, t, y, rates)
    needed = hold(r, t)
    rub(r, d, t, 1.0 if needed >= 0.0 else -1.0, 0.0, t - r.clock[SINCE], 0.0, 0.0)
    return needed, r.world[e.MU_S] * r.world[e.NORMAL_FORCE]


@compiled
def spring(r, d, t, y, rates):
    """Find everything for a contact stuck by a spring; return (friction force [N], deflection, its limit [m])."""
    surround(r, t, y, rates)
    w = r.world
    z = w[e.BELT_TRAVEL] - y[0] - r.clock[ANCHOR]
    v = w[e.BELT_VELOCITY] - y[1]
    rub(r, d, t, 1.0 if z > 0.0 or (z == 0.0 and v >= 0.0) else -1.0, 0.0, t - r.clock[SINCE], 0.0, 0.0)
    if w[e.NORMAL_FORCE] <= 0.0:
        return 0.0, z, 0.0
    stiffness, damping = spring_constants(r)
    cap = w[e.MU_S] * w[e.NORMAL_FORCE]
    limit = cap / stiffness
    force = stiffness * min(max(z, -limit), limit) + damping * v
    return min(max(force, -cap), cap), z, limit


@compiled
def spring_constants(r):
    """Return stiffness [N/m] and damping [N s/m] of a contact stuck by a spring."""
    c = r.constants
    stiffness = c[MEAN_S] * r.world[e.NORMAL_FORCE] / c[LIMIT]
    return stiffness, 2.0 * c[ZETA] * math.sqrt(stiffness * c[M])


@compiled
def friction_force(r, d, t, y):
    """Return the friction force [N] in the present mode; what is around the contact is in ``world`` afterwards."""
    if r.clock[MODE] == STUCK:
        return stick(r, d, t, y, r.unused)[0]
    if r.clock[MODE] == SPRING:
        return spring(r, d, t, y, r.unused)[0]
    return slide(r, d, t, y, r.unused)


@compiled
def motion(r, d, t, y, rates):
    """Write the derivatives of the unknowns into ``rates``."""
    if r.clock[MODE] == STUCK:
        ride(r, t, y, rates)
        rates[0] = rates[1] = 0.0
        return
    force = slide(r, d, t, y, rates) if r.clock[MODE] == SLIDING else spring(r, d, t, y, rates)[0]
    rates[0] = y[1]
    rates[1] = (force + external(r, t) - r.constants[C] * y[1]) / r.constants[M]


@compiled
def margin(r, d, t, y):
    """Return what turns negative where the mode ends: distance to break-away, or to the end of sliding."""
    if r.clock[MODE] == STUCK:
        needed, limit = stick(r, d, t, y, r.unused)
        return limit - abs(needed)
    if r.clock[MODE] == SPRING:
        _, z, limit = spring(r, d, t, y, r.unused)
        outwards = z * (r.world[e.BELT_VELOCITY] - y[1]) > 0.0
        return limit - abs(z) if outwards else limit
    surround(r, t, y, r.unused)
    slowest = r.constants[RESTICK] if r.clock[ARMED] == 1.0 else 0.0
    return r.clock[SIDE] * (r.world[e.BELT_VELOCITY] - y[1]) - slowest
