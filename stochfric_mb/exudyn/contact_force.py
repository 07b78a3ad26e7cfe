"""A contact as it is now, from the engine's coordinates: its motion, its normal force, its coefficients, the law's force."""

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import CURSOR, canonical_time, evaluate
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.exudyn import layout as at
from stochfric_mb.laws.abi import call_law
from stochfric_mb.numerics.memory import as_doubles, carray, load_double

SLOW = 1.0e-7
"""Speed [m/s] below which a contact in a plane with true stick slides in the direction in which it let go: friction along v
turns faster than any step can follow there, and engines take derivatives over 1e-9 m/s."""


@compiled_inline
def dot(numbers, a, b):
    """Return the product of the vectors at ``numbers[a:]`` and ``numbers[b:]``."""
    return numbers[a] * numbers[b] + numbers[a + 1] * numbers[b + 1] + numbers[a + 2] * numbers[b + 2]


@compiled_inline
def spun(t, i, numbers):
    """Return the displacement [m] that turning has added by time t along axis i, by the trapezoidal rule in the step."""
    return numbers[at.SPUN + i] + 0.5 * (t - numbers[at.T]) * (numbers[at.SPIN_BEFORE + i] + numbers[at.SPIN + i])


@compiled_inline
def unwrapped(u, numbers, words):
    """Return the displacement u [m] with the whole turns that bring it nearest to the last accepted one."""
    if numbers[at.PERIOD] > 0.0 and words[at.STARTED] == 1:
        return u + numbers[at.PERIOD] * math.floor((numbers[at.U] - u) / numbers[at.PERIOD] + 0.5)
    return u


@compiled
def _let_go(vx, vy, numbers):
    """Return the relative velocity; of a contact that has hardly let go without what is across the way in which it did."""
    if vx * vx + vy * vy >= SLOW * SLOW:
        return vx, vy
    dx, dy = numbers[at.STATE + 1], numbers[at.STATE + 2]
    along = vx * dx + vy * dy
    return along * dx, along * dy


@compiled_inline
def kinematics(t, numbers, words):
    """Return relative displacements [m] and velocities [m/s], counter-surface minus body, from the engine's coordinates."""
    w = numbers[at.SURFACE_VELOCITY]
    if words[at.PLANE] == 1:
        w_2 = numbers[at.SURFACE_VELOCITY_2]
        dx = dot(numbers, at.AXIS_1, at.DISTANCE) + spun(t, 0, numbers)
        dy = dot(numbers, at.AXIS_2, at.DISTANCE) + spun(t, 1, numbers)
        vx, vy = dot(numbers, at.AXIS_1, at.RATE) + numbers[at.SPIN], dot(numbers, at.AXIS_2, at.RATE) + numbers[at.SPIN + 1]
        if words[at.HELD] == 1 and numbers[at.STATE] != 0.0:
            vx, vy = _let_go(w - vx, w_2 - vy, numbers)
            return w * t - dx, w_2 * t - dy, vx, vy
        return w * t - dx, w_2 * t - dy, w - vx, w_2 - vy
    d = load_double(words[at.POSITION_1]) - load_double(words[at.POSITION_0])
    v = load_double(words[at.VELOCITY_1]) - load_double(words[at.VELOCITY_0])
    return unwrapped(w * t - numbers[at.RADIUS] * d, numbers, words), 0.0, w - numbers[at.RADIUS] * v, 0.0


@compiled_inline
def normal_force_at(t, numbers, words):
    """Return the normal force [N] that the engine uses at time t: penalty, or the line on from the last step."""
    if words[at.PENALTY] == 1:
        return penalty(numbers)
    return max(numbers[at.LINE] + numbers[at.LINE + 1] * t, 0.0)


@compiled_inline
def penalty(numbers):
    """Return the unilateral normal force [N] of the penetration, k p + c dp/dt while it is positive and p > 0."""
    depth = numbers[at.TOUCH] - dot(numbers, at.NORMAL, at.DISTANCE)
    if depth <= 0.0:
        return 0.0
    return max(numbers[at.STIFFNESS] * depth - numbers[at.DAMPING] * dot(numbers, at.NORMAL, at.RATE), 0.0)


@compiled_inline
def pair_at(t, u, numbers, words):
    """Return (mu_s, mu_k) [-] at time t and relative displacement u."""
    if t == numbers[at.PAIR]:
        return numbers[at.PAIR + 1], numbers[at.PAIR + 2]
    descriptor = numbers[at.LAW + words[at.N_LAW] :]
    cursor = numbers[at.CURSOR_AT : at.CURSOR_AT + CURSOR]
    time = canonical_time(t, 0.5 * numbers[at.STEP])
    pair = evaluate(descriptor, cursor, words[at.SEED], words[at.SAMPLE], words[at.CONTACT], time, u, numbers[at.EVENTS])
    if descriptor[0] == 0.0 or descriptor[1] == TIME:
        numbers[at.PAIR], numbers[at.PAIR + 1], numbers[at.PAIR + 2] = t, pair[0], pair[1]
    return pair


@compiled_inline
def ask(address, t, motion, n, pair, numbers, into):
    """Call a function of the law with the committed state; its output goes to ``numbers[into:]``."""
    start = numbers.ctypes.data
    state, p, out = start + 8 * at.STATE, start + 8 * at.LAW, start + 8 * into
    ux, uy, vx, vy = motion
    m, hx, hy = numbers[at.MASS], numbers[at.HOLD], numbers[at.HOLD + 1]
    call_law(address, t, ux, uy, vx, vy, n, pair[0], pair[1], m, hx, hy, state, p, out)


@compiled
def pull(t, displacement, velocity, address):
    """Return what a connector along a line or about an axis pulls marker 1 back with: minus the friction [N or N m]."""
    numbers, words = at.arrays(address)
    w, r, n = numbers[at.SURFACE_VELOCITY], numbers[at.RADIUS], normal_force_at(t, numbers, words)
    if n <= 0.0:
        return 0.0
    u, hold = unwrapped(w * t - r * displacement, numbers, words), numbers[at.HOLD]
    if numbers[at.STUCK] == 1.0:
        numbers[at.HOLD] = 0.0  # a constraint holds
    ask(words[at.FORCE], t, (u, 0.0, w - r * velocity, 0.0), n, pair_at(t, u, numbers, words), numbers, at.NEW)
    numbers[at.HOLD] = hold
    return -r * numbers[at.NEW]


@compiled
def plane_pull(t, displacement, velocity, address, out):
    """Put what a connector between positions pulls marker 1 back with [N], global, into ``out``: minus friction and contact.

    ``displacement`` [m] and ``velocity`` [m/s] of marker 1 relative to marker 0, and ``out``, are shape (3,).
    """
    numbers, words = at.arrays(address)
    for i in range(3):
        numbers[at.DISTANCE + i], numbers[at.RATE + i], out[i] = displacement[i], velocity[i], 0.0
    n = normal_force_at(t, numbers, words)
    if n <= 0.0:
        return
    motion = kinematics(t, numbers, words)
    ask(words[at.FORCE], t, motion, n, pair_at(t, motion[0], numbers, words), numbers, at.NEW)
    press = n if words[at.PENALTY] == 1 else 0.0
    for i in range(3):
        friction = numbers[at.NEW] * numbers[at.AXIS_1 + i] + numbers[at.NEW + 1] * numbers[at.AXIS_2 + i]
        out[i] = -(friction + press * numbers[at.NORMAL + i])


@compiled
def end_of_step(t, address):
    """Return the relative velocity [m/s] in both directions and the largest friction mu_s N [N] at time t, motion in place."""
    numbers, words = at.arrays(address)
    ux, _, vx, vy = kinematics(t, numbers, words)
    return vx, vy, pair_at(t, ux, numbers, words)[0] * normal_force_at(t, numbers, words)


@compiled
def load_force(t, address):
    """Return the friction force [N] of a contact whose coordinates are in place, as a load on marker 1."""
    numbers, words = at.arrays(address)
    n = normal_force_at(t, numbers, words)
    if n <= 0.0:
        return 0.0
    motion = kinematics(t, numbers, words)
    ask(words[at.FORCE], t, motion, n, pair_at(t, motion[0], numbers, words), numbers, at.NEW)
    return numbers[at.NEW]


@compiled
def force_now(t, address, into):
    """Put the friction force [N] at time t at the doubles ``into``: its two directions and the normal force.

    Coordinates must be in place; nothing is committed.
    """
    numbers, words = at.arrays(address)
    out = carray(as_doubles(into), (3,))
    out[0], out[1] = 0.0, 0.0
    motion, out[2] = kinematics(t, numbers, words), normal_force_at(t, numbers, words)
    if out[2] > 0.0:
        pair = pair_at(t, motion[0], numbers, words)
        ask(words[at.FORCE], t, motion, out[2], pair, numbers, at.NEW)
        out[0], out[1] = numbers[at.NEW], numbers[at.NEW + 1]
