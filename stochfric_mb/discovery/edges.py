"""Break-away and re-stick, located between samples by the physics around them.

Near an edge at t_e the box moves with the belt on one side, and on the other it leaves the belt's line as

    x - (x_e + v_b (t - t_e)) = -a (1 - cos w tau) - side v_b (tau - sin(w tau)/w) - b (w tau)^3 / 6,  tau = |t - t_e|

which is the exact take-off under a constant friction force; the cubic term, held small by a ridge, lets the force
change. ``side`` is 1 for a break-away (slip follows) and -1 for a re-stick.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled

GRID = 28
"""Places at which the edge is first looked for."""


@compiled
def _misfit(time, position, edge, belt, side, frequency, ridge):
    """Return the least squared misfit [m^2] for an edge at ``edge``, and (x_e, a, b)."""
    normal = np.zeros((3, 3))
    right = np.zeros(3)
    total = 0.0
    row = np.zeros(3)
    for i in range(len(time)):
        tau = max((time[i] - edge) * side, 0.0)
        row[0] = 1.0
        row[1] = 1.0 - np.cos(frequency * tau)
        row[2] = (frequency * tau) ** 3 / 6.0
        value = position[i] - belt * (time[i] - edge) + side * belt * (tau - np.sin(frequency * tau) / frequency)
        for p in range(3):
            right[p] += row[p] * value
            for q in range(3):
                normal[p, q] += row[p] * row[q]
        total += value * value
    normal[2, 2] += ridge**2
    fitted = np.linalg.solve(normal, right)
    return total - right @ fitted, fitted


@compiled
def locate_edge(position, time, belt, index, side, frequency, n_stick, n_slip, ridge):
    """Return (t_e [s], x_e [m], a [m], mean squared misfit [m^2]) of the edge near sample ``index``.

    ``n_stick`` and ``n_slip`` are the samples used on either side; ``ridge`` is the weight that holds b small.
    """
    if side > 0:
        first, last = max(index - n_stick, 0), min(index + n_slip, len(position))
    else:
        first, last = max(index - n_slip, 0), min(index + n_stick, len(position))
    t0, x0 = time[index], position[index]
    near_time = time[first:last] - t0
    near = position[first:last] - x0
    reach = 0.41 / frequency
    pitch = 1.6 * reach / GRID
    best, edge = np.inf, 0.0
    for j in range(GRID):
        trial = (-reach + pitch * j) * side
        misfit, _ = _misfit(near_time, near, trial, belt, side, frequency, ridge)
        if misfit < best:
            best, edge = misfit, trial
    pitch /= 2.0
    for _ in range(4):
        left = _misfit(near_time, near, edge - pitch, belt, side, frequency, ridge)[0]
        middle = _misfit(near_time, near, edge, belt, side, frequency, ridge)[0]
        right = _misfit(near_time, near, edge + pitch, belt, side, frequency, ridge)[0]
        curvature = left - 2.0 * middle + right
        if curvature > 0.0:
            edge += pitch * max(min(0.5 * (left - right) / curvature, 1.5), -1.5)
        else:
            edge += pitch * (-1.0 if left < right else 1.0)
        pitch /= 2.0
    misfit, fitted = _misfit(near_time, near, edge, belt, side, frequency, ridge)
    return t0 + edge, x0 + fitted[0], fitted[1], misfit / max(last - first - 4, 1)
