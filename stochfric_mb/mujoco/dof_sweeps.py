"""The implicit equations of all joints and tendons together: one after the other, then all at once by Newton's method."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.dof_root import ALONE, SLOPE, force_at_end, solve_one
from stochfric_mb.numerics.elimination import eliminate

SWEEPS, HALVINGS = 50, 16
"""Most rounds of the joints in turn, and halvings of a Newton step."""
SETTLED = 1.0e-10
"""Change of an end velocity [rad/s or m/s] that ends the iterations."""


@compiled
def settle(states, awake, mobility, h, end, forces, memory):
    """Solve all coordinates for forces and end velocities; return the first sweep's largest change of velocity.

    Sweeps solve one coordinate after the other; between them one Newton step moves all at once.
    """
    first = 0.0
    for sweep in range(SWEEPS):
        largest = 0.0
        for k in range(len(states)):
            if awake[k]:
                reach = h * mobility[k, k]
                change = solve_one(states[k], h, reach, reach * forces[k] - end[k], memory[k]) - forces[k]
                forces[k] += change
                for j in range(len(states)):
                    end[j] += h * mobility[j, k] * change
                largest = max(largest, reach * abs(change))
        if sweep == 0:
            first = largest
        if largest < SETTLED or len(states) == 1:
            break
        newton_step(states, awake, mobility, h, end, forces, memory)
    return first


@compiled
def newton_step(states, awake, mobility, h, end, forces, memory):
    """Move all forces and end velocities by one Newton step, from the law's slopes where each was solved alone."""
    count = len(states)
    matrix, miss = np.eye(count), np.zeros((count, 1))
    for k in range(count):
        if awake[k]:
            slope = max(memory[k, SLOPE], 0.0)
            miss[k, 0] = slope * (-end[k] - memory[k, ALONE])
            for j in range(count):
                if awake[j]:
                    matrix[k, j] += slope * h * mobility[k, j]
    change = eliminate(matrix, miss)[:, 0].copy()
    moved_by = h * mobility @ change
    part = best_part(states, awake, memory, h, forces, end, change, moved_by)
    forces += part * change
    end += part * moved_by


@compiled
def best_part(states, awake, memory, h, forces, end, change, moved_by):
    """Return which part of a Newton step to take, 0 to 1: to the least of the potential of which the solution is the minimum.

    The potential 1/2 p W^-1 p/h + sum of the integrals of F is convex where friction grows with velocity.
    """
    if not rise(states, awake, memory, h, forces, end, change, moved_by, 0.0) < 0.0:
        return 0.0
    if rise(states, awake, memory, h, forces, end, change, moved_by, 1.0) <= 0.0:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if rise(states, awake, memory, h, forces, end, change, moved_by, middle) <= 0.0:
            low = middle
        else:
            high = middle
    return low


@compiled
def rise(states, awake, memory, h, forces, end, change, moved_by, part):
    """Return the slope of the potential along a Newton step, after a part of it."""
    total = 0.0
    for k in range(len(states)):
        if awake[k]:
            row = n.law_row(int(n.load(states[k] + 8 * s.LAW)))
            v = -(end[k] + part * moved_by[k])
            force = force_at_end(states[k], slot(states[k], 1, 0), row, memory[k], h, v)
            total -= moved_by[k] * (force - forces[k] - part * change[k])
    return total
