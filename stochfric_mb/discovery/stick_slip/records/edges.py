"""Break-away and re-stick, located between samples by the physics around them.

Near an edge at t_e the box moves with the belt on one side, and on the other it leaves the belt's line as

    x - (x_e + v_b (t - t_e)) = -a (1 - cos w tau) - side v_b (tau - sin(w tau)/w) - b (w tau)^3 / 6,  tau = |t - t_e|

which is the exact take-off under a constant friction force; the cubic term, held small by a ridge, lets the force
change. ``side`` is 1 for a break-away (slip follows) and -1 for a re-stick. A known excitation k u_0 cos W t changes the
force as well, but not in an unknown way: what it adds is the undamped answer y to its change since the edge,

    y'' + w^2 y = w^2 u_0 (cos W t - cos W t_e),  y = y' = 0 at t_e
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled, compiled_inline

NEAR = (0.41, 0.246)
"""How far into stick and slip an edge is looked for at first, as angles of the natural oscillation [rad]."""
FAR = (1.0, 0.85)
"""The same where it comes out at an end of these places: noise that stays for a few samples can hide a slip's first or last
ones from the smoothed velocity. Into the slip, a fifth of the samples used must remain."""
NEVER, ALWAYS, IF_BETTER = 0, 1, 2
"""When places FAR are looked at. Without noise a gentle take-off is a little better there by any measure: those of simulated
slips are looked for where most of the measured ones were found."""
PITCH = 0.0234
"""Distance of the places [rad]."""
FAR_BETTER = 0.75
"""Misfit there over that of the first places that is no chance and no matter of how a slip begins [-]: of 130 samples, noise
alone does not lower it so; a slip that begins slowly has gentler ones from before fit it nearly as well."""
LAST = 4
"""Places that are the end of them: a slip that begins further on is better described as a gentler one from before."""
RESONANCE = 1.0e-3
"""Relative distance of an excitation's frequency from the natural one that its answer is worked out with at least [-]."""


@compiled_inline
def _answer(tau, phase, side, frequency, forcing):
    """Return what an excitation of unit amplitude at ``phase`` [rad] at the edge adds to the motion ``tau`` [s] from it [-]."""
    turned, own = np.cos(forcing * tau), np.cos(frequency * tau)
    resonant = frequency**2 / (frequency**2 - forcing**2)
    straight = resonant * (turned - own) - (1.0 - own)
    return np.cos(phase) * straight - side * np.sin(phase) * resonant * (
        np.sin(forcing * tau) - forcing / frequency * np.sin(frequency * tau)
    )


@compiled
def _misfit(time, position, edge, belt, side, frequency, ridge, excitation):
    """Return the least squared misfit [m^2] for an edge at ``edge``, and (x_e, a, b)."""
    amplitude, forcing, phase = excitation
    normal = np.zeros((3, 3))
    right = np.zeros(3)
    total = 0.0
    for i in range(len(time)):
        value = position[i] - belt * (time[i] - edge)
        tau = (time[i] - edge) * side
        normal[0, 0] += 1.0
        if tau > 0.0:
            away, change = 1.0 - np.cos(frequency * tau), (frequency * tau) ** 3 / 6.0
            value += side * belt * (tau - np.sin(frequency * tau) / frequency)
            if amplitude != 0.0:
                value -= amplitude * _answer(tau, phase + forcing * edge, side, frequency, forcing)
            right[1] += away * value
            right[2] += change * value
            normal[0, 1] += away
            normal[0, 2] += change
            normal[1, 1] += away * away
            normal[1, 2] += away * change
            normal[2, 2] += change * change
        right[0] += value
        total += value * value
    normal[1, 0], normal[2, 0], normal[2, 1] = normal[0, 1], normal[0, 2], normal[1, 2]
    normal[2, 2] += ridge**2
    fitted = np.linalg.solve(normal, right)
    return total - right @ fitted, fitted


@compiled
def _located(time, position, belt, index, side, frequency, n_stick, n_slip, ridge, amplitude, forcing, reach):
    """Return the edge as `locate_edge` does, within ``reach`` of ``index``, and whether it lies at an end of the places."""
    if side > 0:
        first, last = max(index - n_stick, 0), min(index + n_slip, len(position))
    else:
        first, last = max(index - n_slip, 0), min(index + n_stick, len(position))
    t0, x0 = time[index], position[index]
    phase = forcing * t0
    if abs(forcing / frequency - 1.0) < RESONANCE:
        forcing = (1.0 + RESONANCE) * frequency
    excitation = (amplitude, forcing, phase)
    near_time = time[first:last] - t0
    near = position[first:last] - x0
    pitch = PITCH / frequency
    places = int((reach[0] + reach[1]) / PITCH)
    best, edge, place = np.inf, 0.0, 0
    for j in range(places):
        trial = (-reach[0] / frequency + pitch * j) * side
        misfit, _ = _misfit(near_time, near, trial, belt, side, frequency, ridge, excitation)
        if misfit < best:
            best, edge, place = misfit, trial, j
    pitch /= 2.0
    for _ in range(4):
        left = _misfit(near_time, near, edge - pitch, belt, side, frequency, ridge, excitation)[0]
        middle = _misfit(near_time, near, edge, belt, side, frequency, ridge, excitation)[0]
        right = _misfit(near_time, near, edge + pitch, belt, side, frequency, ridge, excitation)[0]
        curvature = left - 2.0 * middle + right
        if curvature > 0.0:
            edge += pitch * max(min(0.5 * (left - right) / curvature, 1.5), -1.5)
        else:
            edge += pitch * (-1.0 if left < right else 1.0)
        pitch /= 2.0
    misfit, fitted = _misfit(near_time, near, edge, belt, side, frequency, ridge, excitation)
    return t0 + edge, x0 + fitted[0], fitted[1], misfit / max(last - first - 4, 1), not LAST <= place < places - LAST


@compiled
def locate_edge(position, time, belt, index, side, frequency, n_stick, n_slip, ridge, amplitude, forcing, beyond):
    """Return (t_e [s], x_e [m], a [m], mean squared misfit [m^2], whether it is FAR) of the edge near sample ``index``.

    ``n_stick`` and ``n_slip`` are the samples used on either side; ``ridge`` is the weight that holds b small;
    ``amplitude`` u_0 [m] and ``forcing`` W [rad/s] are those of the excitation; ``beyond`` says when edges that NEAR does
    not hold are taken from FAR: NEVER, ALWAYS or IF_BETTER.
    """
    first = _located(time, position, belt, index, side, frequency, n_stick, n_slip, ridge, amplitude, forcing, NEAR)
    if not first[4] or beyond == NEVER:
        return first[0], first[1], first[2], first[3], False
    far = _located(time, position, belt, index, side, frequency, n_stick, n_slip, ridge, amplitude, forcing, FAR)
    if beyond == IF_BETTER and far[3] > FAR_BETTER * first[3]:
        return first[0], first[1], first[2], first[3], False
    centre = index + round((far[0] - time[index]) / (time[1] - time[0]))
    if not n_slip <= centre < len(position) - n_slip:
        return first[0], first[1], first[2], first[3], False
    # at its right place the samples used lie about it as about any other
    again = _located(time, position, belt, centre, side, frequency, n_stick, n_slip, ridge, amplitude, forcing, NEAR)
    if again[4]:
        return first[0], first[1], first[2], first[3], False
    return again[0], again[1], again[2], again[3], True
