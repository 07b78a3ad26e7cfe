"""A light oscillator hung on the box, driven by the slips as measured: what it does to the box, slip after slip.

r'' + 2 z w r' + w^2 r = -x'' is integrated through every slip of a run in turn; in stick, where the box moves evenly, it
rings on freely.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects.marks import Array, Slips

FIRST = 8
"""Times that the first slip is taken before it counts: by then a steady oscillator has forgotten how it began."""


def oscillator_pull(slips: Slips, frequency: float, damping_ratio: float) -> tuple[Array, Array]:
    """Return w^2 r + 2 z w r' [m/s^2] at the break-aways, shape (n,), and at the nodes, shape (n, nodes).

    Args:
        slips: the slips.
        frequency: of the oscillator with the box held [Hz].
        damping_ratio: its damping ratio z [-].
    """
    at_onset, at_nodes = np.zeros(len(slips.run)), np.zeros_like(slips.node_time)
    w = 2.0 * np.pi * frequency
    for run in range(slips.n_runs):
        mine = np.flatnonzero(slips.run == run)
        rows = slice(int(mine[0]), int(mine[-1]) + 1)
        _ring(
            w, damping_ratio, slips.onset_time[rows], slips.restick_time[rows], slips.node_time[rows],
            slips.node_acceleration[rows], at_onset[rows], at_nodes[rows],
        )  # fmt: skip
    return at_onset, at_nodes


@compiled
def _ring(w, z, onset, restick, time, acceleration, at_onset, at_nodes):
    """Fill what the oscillator does to the box at the break-aways and nodes of one run."""
    n = len(onset)
    dwell = np.median(onset[1:] - restick[:-1]) if n > 1 else 0.0
    r, v = 0.0, 0.0
    for _ in range(FIRST):
        r, v = _freely(w, z, r, v, dwell)
        r, v = _slip(w, z, r, v, onset[0], restick[0], time[0], acceleration[0], at_nodes[0])
    for i in range(n):
        r, v = _freely(w, z, r, v, onset[i] - restick[i - 1] if i > 0 else dwell)
        at_onset[i] = w * w * r + 2.0 * z * w * v
        r, v = _slip(w, z, r, v, onset[i], restick[i], time[i], acceleration[i], at_nodes[i])


@compiled
def _freely(w, z, r, v, duration):
    """Return (r, r') after a free vibration; z < 1."""
    damped = w * math.sqrt(1.0 - z * z)
    envelope = math.exp(-z * w * duration)
    c, s = math.cos(damped * duration), math.sin(damped * duration)
    b = (v + z * w * r) / damped
    now = envelope * (r * c + b * s)
    return now, envelope * damped * (b * c - r * s) - z * w * now


@compiled
def _slip(w, z, r, v, onset, restick, time, acceleration, pull):
    """Return (r, r') at the re-stick; fill the pull at the nodes. Between nodes the acceleration counts by its mean."""
    now = onset
    last = acceleration[0]
    for j in range(len(time) + 1):
        end = time[j] if j < len(time) else restick
        here = acceleration[min(j, len(time) - 1)]
        # about the place where it would rest under an even acceleration it vibrates freely
        rest = -0.5 * (last + here) / (w * w)
        away, v = _freely(w, z, r - rest, v, end - now)
        r = away + rest
        now, last = end, here
        if j < len(time):
            pull[j] = w * w * r + 2.0 * z * w * v
    return r, v
