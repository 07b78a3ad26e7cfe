"""Event location: the step that ends where a law switches, or at the next point of the grid of fixed steps."""

from __future__ import annotations

import math

from numba import carray  # pyright: ignore[reportPrivateImportUsage]

from stochfric_mb.compile import compiled
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact_force import ask, kinematics, normal_force_at, pair_at
from stochfric_mb.exudyn.stepping import GRID, settling
from stochfric_mb.laws.contract import GUARDS

# in parts of the step
TOLERANCE, BEYOND, SHORTEST, FINE = 1.0e-3, 1.0e-4, 2.0e-4, 0.25
"""How near the end of a step a switch may lie, how far beyond it steps end, the shortest step asked for, and what steps
that follow a change of mode closely are shortened to."""


@compiled
def locate(t, address):
    """Return the step [s] that ends at the next grid point or just beyond the law's next switch, or -1 to accept.

    A switch is where a guard of the law turns from positive to not positive; it is sought on the cubic through both
    ends of the step.
    """
    words = carray(at.words_from(address), (at.N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(at.numbers_from(words[at.NUMBERS]), (words[at.N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    t_0, step = numbers[at.T], numbers[at.STEP]
    if words[at.STARTED] == 0 or t <= t_0:
        return -1.0
    n = math.floor((t_0 - numbers[at.START]) / step + GRID) + 1.0
    grid = numbers[at.START] + n * step
    end = min(grid, t_0 + FINE * step) if settling(t_0, numbers) else grid
    if t > end + GRID * step:
        return end - t_0
    motion, normal_force = kinematics(t, numbers, words), normal_force_at(t, numbers, words)
    pair = pair_at(t, motion[0], numbers, words)
    ask(words[at.GUARD], t, motion, normal_force, pair, numbers, at.NEW)
    first = 2.0
    for i in range(GUARDS):
        if numbers[at.GUARDS_BEFORE + i] > 0.0 and numbers[at.NEW + i] <= 0.0:
            first = min(first, _crossing(i, t, motion, normal_force, numbers, words))
            ask(words[at.GUARD], t, motion, normal_force, pair, numbers, at.NEW)
    h = t - t_0
    if first > 1.0 or (1.0 - first) * h <= TOLERANCE * step or h <= 2.0 * SHORTEST * step:
        return -1.0
    return max(first * h + BEYOND * step, SHORTEST * step)


@compiled
def _crossing(i, t, motion, normal_force, numbers, words):
    """Return where in the step, from 0 to 1, guard ``i`` turns, by bisection on the cubic through both ends."""
    t_0, h = numbers[at.T], t - numbers[at.T]
    ux, uy, vx, vy = motion
    low, high = 0.0, 1.0
    for _ in range(30):
        s = 0.5 * (low + high)
        x, v_x = _between(s, h, numbers[at.U], numbers[at.V], ux, vx)
        y, v_y = _between(s, h, numbers[at.U_2], numbers[at.V_2], uy, vy)
        n = numbers[at.NORMAL_FORCE] + s * (normal_force - numbers[at.NORMAL_FORCE])
        pair = pair_at(t_0 + s * h, x, numbers, words)
        ask(words[at.GUARD], t_0 + s * h, (x, y, v_x, v_y), n, pair, numbers, at.NEW)
        if numbers[at.NEW + i] > 0.0:
            low = s
        else:
            high = s
    return high


@compiled
def _between(s, h, u_0, v_0, u, v):
    """Return u and v at the part s of a step h, u = u_0 + h v_0 s + (3 a - b) s^2 + (b - 2 a) s^3."""
    a, b = u - u_0 - h * v_0, h * (v - v_0)
    u_s = u_0 + h * v_0 * s + (3.0 * a - b) * s * s + (b - 2.0 * a) * s**3
    return u_s, v_0 + (2.0 * (3.0 * a - b) * s + 3.0 * (b - 2.0 * a) * s * s) / h
