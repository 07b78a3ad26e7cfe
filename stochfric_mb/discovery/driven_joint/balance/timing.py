"""Timing: whether the motion comes later in the record than the force that drives it.

A delay looks like friction: m q''(t - T) has a part along q'. And friction looks like a delay. So a delay is sought beside a
generous friction law, where what it explains is surely timing, and beside the stated law alone; and what it could be is
named only if the record is explained better with it than by any effects without it (`Timing.beside`). Only windows in which
the joint slides one way count: at reversals, friction that gives before it slides looks late.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.weak_form import FEWEST
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.inference.least_squares import left_by
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.errors import InputError

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

LONGEST, SHORT_RUN = 0.05, 0.125
"""Longest delay that is looked for, either way [s], and the part of the shortest run that it may be [-]: three quarters of that
run hold windows which all delays share."""
GRID = 41
"""Delays on the first grid."""
HALF_WIDTHS = (0.25, 0.5, 1.0)
"""Half widths of the windows through which delays are sought, over that for friction [-]: against noise wide, for quick motion
narrow."""
NARROWEST = 16
"""Narrowest of them [samples]."""
LEAST_SAMPLES = 1.5
"""A delay of fewer samples is how signals are sampled and held: it is compensated, and not called one."""
NAMED = 14.0
"""Score above which a delay is asked for, and named: it is one question, not one of many."""
MATERIAL = 0.03
"""Least part of the error that a delay must take away."""


@dataclasses.dataclass(frozen=True)
class Timing:
    """By how much the position comes after the driving force in the record."""

    seconds: float
    """The delay [s]; negative: the force comes later."""
    low: float
    """Lower end of its 95 % interval [s]."""
    high: float
    """Upper end of its 95 % interval [s]."""
    score: float
    """Evidence: n ln(S_0/S) - ln n - 2 ln(grid size), n counting independent windows."""
    gain: float
    """Part of the error (rms) that it takes away [-]."""
    half_width: int
    """Half width of the window through which it shows [samples]."""
    named: bool = False
    """Whether it is a finding, and compensated."""

    def beside(self, evidence: float, explains: bool) -> Timing:
        """Return the timing once it is known by how much the record is explained better with it than by effects without it.

        Args:
            evidence: that, numbers counted.
            explains: whether it explains more than it leaves, all along the motion.
        """
        return dataclasses.replace(self, score=evidence, named=evidence > NAMED and explains)

    @property
    def shows(self) -> bool:
        """Whether the balances speak for it, and for its sign."""
        return self.score > NAMED and self.low * self.high > 0.0

    @property
    def puzzling(self) -> bool:
        """Whether motion is late or early somewhere, and no delay explains it."""
        return self.score > NAMED and not self.named


def timing(
    make: Callable[[float, int], Sequence[ForceBalance]], nuisances: Sequence[Nuisance], interval: float, half_width: float
) -> Timing | None:
    """Return the delay between drive and motion that the record may hold; None: none, or the runs are too short to tell.

    Args:
        make: delay [s] and half width of the window [samples] -> the balances of the fit runs, that delay compensated.
        nuisances: numbers of the mechanism with their priors; they are free here.
        interval: distance between samples [s].
        half_width: half width of the windows through which friction is seen [s].
    """
    names = [n.name for n in nuisances]
    make = functools.cache(make)
    timings: list[Timing] = []
    for generous in (True, False):
        seen: list[Timing] = []
        for width in sorted({max(round(w * half_width / interval), NARROWEST) for w in HALF_WIDTHS}):
            with contextlib.suppress(InputError):  # a run is too short for this window
                seen.append(sought(lambda d, w=width: make(d, w), names, generous=generous, width=width))
        timings += sorted(seen, key=lambda t: -t.score)[:1]
    return next((t for t in timings if t.shows), None)


def sought(make: Callable[[float], Sequence[ForceBalance]], names: Sequence[str], *, generous: bool, width: int) -> Timing:
    """Return the delay with which windows of one width are explained best.

    Args:
        make: delay [s] -> the balances of the fit runs, that delay compensated.
        names: numbers of the mechanism, which are free here.
        generous: whether the friction law beside it is a generous one, or the stated one.
        width: half width of the windows [samples].

    Raises:
        InputError: the runs are too short for the longest delays.
    """
    span = longest_of(make(0.0))
    grid = np.linspace(-span, span, GRID)
    same = shared([make(d) for d in grid[[0, -1]]])
    if sum(int(m.sum()) for m in same) < FEWEST:
        raise InputError(f"no {FEWEST} windows of the runs can be seen with delays of up to {span:.3g} s")

    def left(delay: float) -> list[Array]:
        return _left(make(delay), same, names, generous)

    errors = np.array([_square(left(d)) for d in grid])
    best = int(np.argmin(errors))
    step = grid[1] - grid[0]
    fine = np.linspace(grid[best] - step, grid[best] + step, 9)
    delay = lowest(fine, np.array([_square(left(d)) for d in fine]))
    remains = left(delay)
    rest, n = _square(remains), max(sum(map(independent_count, remains)), 4.0)
    still = _square(left(0.0))
    # S(T) = S (1 + (T - T0)^2 curvature): one standard deviation raises n S by S
    inside = 0 < best < GRID - 1
    rise = max(errors[best - 1], errors[best + 1]) / rest - 1.0 if inside else 0.0
    deviation = float(step / np.sqrt(n * max(rise, 1.0e-12)))
    # as many delays were tried as can be distinguished
    tried = len(HALF_WIDTHS) * max(2.0 * span / (4.0 * deviation), 1.0)
    score = n * np.log(still / rest) - np.log(n) - 2.0 * np.log(tried)
    gain = 1.0 - float(np.sqrt(rest / still))
    material = inside and gain > MATERIAL
    within = confidence_interval(delay, deviation, "s")
    return Timing(delay, within.low, within.high, float(score) if material else 0.0, gain, width)


def longest_of(balances: Sequence[ForceBalance]) -> float:
    """Return the longest delay, either way, that runs can show [s]."""
    return min(LONGEST, SHORT_RUN * min(float(np.ptp(b.time)) for b in balances))


def lowest(x: Array, y: Array) -> float:
    """Return where the parabola through the lowest of equidistant points and its neighbours is lowest."""
    i = min(max(int(np.argmin(y)), 1), len(x) - 2)
    left, middle, right = y[i - 1 : i + 2]
    curve = left - 2.0 * middle + right
    inside = min(left, right) >= middle and curve > 0.0
    return float(x[i] + 0.5 * (x[1] - x[0]) * (left - right) / curve) if inside else float(x[int(np.argmin(y))])


def shared(delayed: Sequence[Sequence[ForceBalance]]) -> list[Mask]:
    """Return the windows of sliding that balances share, whatever delay each has: errors in these alone can be compared."""
    return [np.logical_and.reduce([s.sliding for s in each]) for each in zip(*delayed, strict=True)]


def _left(balances: Sequence[ForceBalance], windows: Sequence[Mask], names: Sequence[str], generous: bool) -> list[Array]:
    """Return what a friction law leaves in ``windows`` of each balance."""
    columns = np.concatenate([_columns(s, names, generous)[m] for s, m in zip(balances, windows, strict=True)])
    driven = np.concatenate([s.driven[m] for s, m in zip(balances, windows, strict=True)])
    rest = left_by(columns, driven)
    return np.split(rest, np.cumsum([int(m.sum()) for m in windows])[:-1])


def _square(remains: Sequence[Array]) -> float:
    """Return the mean square of what is left."""
    return float(np.mean(np.concatenate(remains) ** 2))


def _columns(balance: ForceBalance, names: Sequence[str], generous: bool) -> Array:
    v, side = balance.velocity, np.sign(balance.velocity)
    top = max(float(np.quantile(np.abs(v), 0.95)), 1.0e-12)
    friction = [side]
    if generous:
        friction += [side * np.exp(-np.abs(v) / (0.1 * top)), v, v * np.abs(v), np.abs(v)]
    known = [balance.columns[n] for n in names if n in balance.columns]
    one = np.ones(len(balance.driven))
    return np.column_stack([one, *known, *(balance.window.at_centres(x) for x in friction)])
