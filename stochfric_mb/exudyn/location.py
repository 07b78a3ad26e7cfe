"""Event location: the step that ends where a law switches, or at the next point of the grid of fixed steps."""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact_force import ask, kinematics, normal_force_at, pair_at
from stochfric_mb.exudyn.stepping import GRID, settling
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.numerics.cubic import hermite, slope, value
from stochfric_mb.numerics.root import bracket, is_wide, least_armed, narrowed, trial

# in parts of the step
TOLERANCE, BEYOND, SHORTEST, FINE = 1.0e-3, 1.0e-4, 2.0e-4, 0.25
"""How near the end of a step a switch may lie, how far beyond it steps end, the shortest step asked for, and what steps
that follow a change of mode closely are shortened to."""
RESOLUTION = 1.0e-9
"""Part of the step to which a switch is located [-]: steps end 1e-4 beyond it."""


@compiled
def locate(t, address):
    """Return the step [s] that ends at the next grid point or just beyond the law's next switch, or -1 to accept.

    A switch is where a guard of the law turns from positive to not positive; it is sought on the cubic through both
    ends of the step.
    """
    numbers, words = at.arrays(address)
    t_0, step = numbers[at.T], numbers[at.STEP]
    if words[at.STARTED] == 0 or t <= t_0:
        return -1.0
    n = math.floor((t_0 - numbers[at.START]) / step + GRID) + 1.0
    grid = numbers[at.START] + n * step
    end = min(grid, t_0 + FINE * step) if settling(t_0, numbers) else grid
    if numbers[at.JUMP] < end:
        end = numbers[at.JUMP]
        if t > end + RESOLUTION * step:
            return end - t_0
    if t > end + GRID * step:
        return end - t_0
    motion, normal_force = kinematics(t, numbers, words), normal_force_at(t, numbers, words)
    pair = pair_at(t, motion[0], numbers, words)
    ask(words[at.GUARD], t, motion, normal_force, pair, numbers, at.NEW)
    first = _first_crossing(t, motion, normal_force, numbers, words)
    h = t - t_0
    if first > 1.0 or (1.0 - first) * h <= TOLERANCE * step or h <= 2.0 * SHORTEST * step:
        return -1.0
    return max(first * h + BEYOND * step, SHORTEST * step)


@compiled
def _first_crossing(t, motion, normal_force, numbers, words):
    """Return where in the step, from 0 to 1, a guard that was positive turns first, 2 if none does; those at its end stand."""
    before, now = numbers[at.GUARDS_BEFORE : at.GUARDS_BEFORE + GUARDS], numbers[at.NEW : at.NEW + GUARDS]
    at_end = least_armed(before, now)
    if at_end > 0.0:
        return 2.0
    t_0, h = numbers[at.T], t - numbers[at.T]
    along, across = (
        hermite(h, numbers[at.U], numbers[at.V], motion[0], motion[2]),
        hermite(h, numbers[at.U_2], numbers[at.V_2], motion[1], motion[3]),
    )
    hold_x, hold_y = numbers[at.HOLD], numbers[at.HOLD + 1]
    b = bracket(0.0, least_armed(before, before), 1.0, at_end)
    while is_wide(b, RESOLUTION):
        s = trial(b, RESOLUTION)
        x = value(along, s)
        n = numbers[at.NORMAL_FORCE] + s * (normal_force - numbers[at.NORMAL_FORCE])
        numbers[at.HOLD] = numbers[at.HOLD_BEFORE] + s * (hold_x - numbers[at.HOLD_BEFORE])
        numbers[at.HOLD + 1] = numbers[at.HOLD_BEFORE + 1] + s * (hold_y - numbers[at.HOLD_BEFORE + 1])
        there = (x, value(across, s), slope(along, s) / h, slope(across, s) / h)
        ask(words[at.GUARD], t_0 + s * h, there, n, pair_at(t_0 + s * h, x, numbers, words), numbers, at.NEW)
        b = narrowed(b, s, least_armed(before, now))
    numbers[at.HOLD], numbers[at.HOLD + 1] = hold_x, hold_y
    return b.negative
