"""The implicit equation of one joint or tendon: the end velocity whose force leads to it.

v = free - reach F(v)
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot

TRIALS = 60
"""Most evaluations of the equation between two bounds."""
ALONE, SLOPE, STOPPED = range(MAX_STATE, MAX_STATE + 3)
"""Behind a coordinate's law state: velocity and slope where it was solved alone, 1 where it has stopped in this step."""
START = 30
"""The search for a root begins with 2^-START of the way to the farthest point, and doubles."""


@compiled
def solve_one(state, h, reach, free, memory):
    """Return the force that belongs to the end velocity v = free - reach force of one coordinate.

    Args:
        state: address of its state.
        h: step [s].
        reach: velocity per force [rad/s per N m or m/s per N].
        free: end velocity (counter-surface minus coordinate) without the force [rad/s or m/s].
        memory: the law's state, changed here where sliding stops within the step; the velocity found and the slope
            there are written behind it.
    """
    address = slot(state, 1, 0)
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    before = n.load(address + 8 * s.VX)
    v = root(state, address, row, memory, h, reach, free, before if memory[STOPPED] == 0.0 else 0.0)
    if v * before < 0.0 and memory[STOPPED] == 0.0:
        at_rest(state, address, row, memory)
        memory[STOPPED] = 1.0
        v = root(state, address, row, memory, h, reach, free, 0.0)
    small = 1.0e-9 * reach * n.load(address + 8 * s.MU_S) * n.load(address + 8 * s.NORMAL) + 1.0e-300
    force = force_at_end(state, address, row, memory, h, v)
    memory[ALONE] = v
    memory[SLOPE] = (force_at_end(state, address, row, memory, h, v + small) - force) / small
    return (free - v) / reach


@compiled
def at_rest(state, address, row, memory):
    """Replace the law's memory by what its commit makes of it at zero velocity: sliding does not turn over within a step."""
    call_law(
        n.load_word(row + n.COMMIT), n.load(address + 8 * s.SINCE), n.load(address + 8 * s.UX), 0.0, 0.0, 0.0,
        n.load(address + 8 * s.NORMAL), n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K),
        n.load(address + 8 * s.MASS), 0.0, 0.0, memory.ctypes.data, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip
    for j in range(MAX_STATE):
        memory[j] = n.load(state + 8 * (s.OUTPUT + j))


@compiled
def force_at_end(state, address, row, memory, h, v):
    """Return the law's force at the step's end with the velocity v."""
    call_law(
        n.load_word(row + n.FORCE), n.load(address + 8 * s.SINCE) + h, n.load(address + 8 * s.UX) + h * v, 0.0, v, 0.0,
        n.load(address + 8 * s.NORMAL), n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K),
        n.load(address + 8 * s.MASS), 0.0, 0.0, memory.ctypes.data, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip
    return n.load(state + 8 * s.OUTPUT)


@compiled
def miss_at(state, address, row, memory, h, reach, free, v):
    """Return v - free + reach F(v) [rad/s or m/s], zero at the end velocity."""
    return v - free + reach * force_at_end(state, address, row, memory, h, v)


@compiled
def root(state, address, row, memory, h, reach, free, guess):
    """Return the root v of v - free + reach F(v) that is reached first on the way from ``guess``.

    A force that falls with velocity can have several roots: a joint that sticks or creeps stays on its branch.
    Friction is bounded or grows with v, so a root lies between ``free`` and ``free`` less what F(free) or mu_s N does.
    """
    most = max(
        abs(force_at_end(state, address, row, memory, h, free)), n.load(address + 8 * s.MU_S) * n.load(address + 8 * s.NORMAL)
    )
    width = reach * most * (1.0 + 1.0e-9) + 1.0e-300
    small, exact = 1.0e-9 * width, 1.0e-13 * (abs(free) + width)
    x, miss = guess, miss_at(state, address, row, memory, h, reach, free, guess)
    if abs(miss) <= exact:
        return x
    following = newton(state, address, row, memory, h, reach, free, x, miss, small)
    if abs(miss_at(state, address, row, memory, h, reach, free, following)) <= exact:
        return following
    end = free + math.copysign(width, -miss)
    step = (end - x) * 2.0**-START
    for _ in range(START + 1):
        if miss_at(state, address, row, memory, h, reach, free, x + step) * miss <= 0.0:
            break
        x += step
        step *= 2.0
    return bracketed(state, address, row, memory, h, reach, free, min(x, x + step), max(x, x + step), small, exact)


@compiled
def newton(state, address, row, memory, h, reach, free, x, miss, small):
    """Return the next velocity by Newton's method, with a difference for the slope."""
    slope = (miss_at(state, address, row, memory, h, reach, free, x + small) - miss) / small
    return x - miss / slope if slope > 0.0 else x - miss


@compiled
def bracketed(state, address, row, memory, h, reach, free, low, high, small, exact):
    """Return the root between ``low`` and ``high``: Newton's method, halving where it leaves the bracket."""
    x = 0.5 * (low + high)
    for _ in range(TRIALS):
        miss = miss_at(state, address, row, memory, h, reach, free, x)
        if abs(miss) <= exact:
            break
        if miss > 0.0:
            high = x
        else:
            low = x
        following = newton(state, address, row, memory, h, reach, free, x, miss, min(small, 1.0e-3 * (high - low)))
        if not low < following < high:
            following = 0.5 * (low + high)
        if following in (low, high):
            break
        x = following
    return x
