"""Timing: whether the motion comes later in the record than the force that drives it; asked before friction is judged.

A delay looks like friction: m q''(t - T) has a part along q'. And friction looks like a delay. So a delay is asked for twice:
beside a generous friction law, where what it explains is surely timing; and beside the believed law alone, where it has to
do better than every friction effect does without it. Only windows in which the joint slides one way count: at reversals,
friction that gives before it slides looks late.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.fitting import independent_count
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.errors import InputError

Array = npt.NDArray[np.float64]

LONGEST = 0.05
"""Longest delay that is looked for, either way [s]."""
GRID = 41
"""Delays on the first grid."""
HALF_WIDTHS = (0.25, 0.5, 1.0)
"""Half widths of the windows through which delays are sought, over that for friction [-]: against noise wide, for quick motion
narrow."""
NARROWEST = 16
"""Narrowest of them [samples]."""
LEAST_SAMPLES = 1.5
"""A delay of fewer samples is how signals are sampled and held, and is not called one."""
NAMED = 14.0
"""Score above which a delay is named: it is one question, not one of many."""
AHEAD = 10.0
"""Score by which it must be ahead of friction effects where these could stand in for it."""
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
    named: bool
    """Whether it is a finding whatever friction is, and compensated."""
    plain_score: float
    """Evidence beside the believed friction law alone."""
    plain_seconds: float
    """The delay in that case [s]."""

    def against(self, friction: float) -> Timing:
        """Return the timing once the best score of a friction effect without it is known."""
        better = self.plain_score > NAMED and self.plain_score > friction + AHEAD and self.material
        if self.named or not better:
            return self
        far = 1.96 * self.plain_deviation
        low, high = self.plain_seconds - far, self.plain_seconds + far
        return dataclasses.replace(
            self, seconds=self.plain_seconds, low=low, high=high, score=self.plain_score, named=low * high > 0.0
        )

    plain_deviation: float = np.inf
    """Its standard deviation [s]."""
    material: bool = False
    """Whether the delay beside the believed law takes away enough error and is longer than sampling explains."""


def timing(
    make: Callable[[float, int], Sequence[ForceBalance]], nuisances: Sequence[Nuisance], interval: float, half_width: float
) -> Timing | None:
    """Return the delay between drive and motion; None if the runs are too short to tell.

    Args:
        make: delay [s] and half width of the window [samples] -> the balances to learn from, that delay compensated.
        nuisances: numbers of the mechanism with their priors; they are free here.
        interval: distance between samples [s].
        half_width: half width of the windows through which friction is seen [s].
    """
    names = [n.name for n in nuisances]
    best: dict[bool, _Seen] = {}
    for width in sorted({max(round(w * half_width / interval), NARROWEST) for w in HALF_WIDTHS}):
        for generous in (True, False):
            try:
                seen = _through(lambda d, w=width: make(d, w), names, interval, generous)
            except InputError:  # a run is too short for this window
                continue
            if generous not in best or seen.score > best[generous].score:
                best[generous] = seen
    if not best:
        return None
    sure, plain = best[True], best[False]
    within = confidence_interval(sure.seconds, sure.deviation, "s")
    return Timing(
        sure.seconds, within.low, within.high, sure.score, sure.gain,
        sure.material and sure.score > NAMED and within.low * within.high > 0.0, plain.score, plain.seconds,
        plain.deviation, plain.material,
    )  # fmt: skip


@dataclasses.dataclass(frozen=True)
class _Seen:
    """A delay as seen through one window beside one friction law."""

    seconds: float
    deviation: float
    score: float
    gain: float
    material: bool


def _through(make: Callable[[float], Sequence[ForceBalance]], names: Sequence[str], interval: float, generous: bool) -> _Seen:
    span = min(LONGEST, 40.0 * interval)
    grid = np.linspace(-span, span, GRID)
    errors = np.array([_left(make(d), names, generous)[0] for d in grid])
    best = int(np.argmin(errors))
    step = grid[1] - grid[0]
    fine = np.linspace(grid[best] - step, grid[best] + step, 9)
    delay = lowest(fine, np.array([_left(make(d), names, generous)[0] for d in fine]))
    rest, n = _left(make(delay), names, generous)
    still, _ = _left(make(0.0), names, generous)
    # S(T) = S (1 + (T - T0)^2 curvature): one standard deviation raises n S by S
    inside = 0 < best < GRID - 1
    rise = max(errors[best - 1], errors[best + 1]) / rest - 1.0 if inside else 0.0
    deviation = float(step / np.sqrt(n * max(rise, 1.0e-12)))
    # as many delays were tried as can be told apart
    tried = len(HALF_WIDTHS) * max(2.0 * span / (4.0 * deviation), 1.0)
    score = n * np.log(still / rest) - np.log(n) - 2.0 * np.log(tried)
    gain = 1.0 - float(np.sqrt(rest / still))
    material = bool(inside and gain > MATERIAL and abs(delay) > LEAST_SAMPLES * interval)
    return _Seen(delay, deviation, float(score), gain, material)


def lowest(x: Array, y: Array) -> float:
    """Return where the parabola through the lowest of equidistant points and its neighbours is lowest."""
    i = min(max(int(np.argmin(y)), 1), len(x) - 2)
    left, middle, right = y[i - 1 : i + 2]
    curve = left - 2.0 * middle + right
    inside = min(left, right) >= middle and curve > 0.0
    return float(x[i] + 0.5 * (x[1] - x[0]) * (left - right) / curve) if inside else float(x[int(np.argmin(y))])


def _left(balances: Sequence[ForceBalance], names: Sequence[str], generous: bool) -> tuple[float, float]:
    """Return the mean square that a friction law leaves, and the number of independent windows."""
    columns = np.concatenate([_columns(s, names, generous)[s.sliding] for s in balances])
    driven = np.concatenate([s.driven[s.sliding] for s in balances])
    scaled = columns / np.maximum(np.linalg.norm(columns, axis=0), 1.0e-300)
    rest = driven - scaled @ np.linalg.lstsq(scaled, driven, rcond=1.0e-10)[0]
    ends = np.cumsum([int(s.sliding.sum()) for s in balances])[:-1]
    return float(np.mean(rest**2)), max(sum(independent_count(r) for r in np.split(rest, ends)), 4.0)


def _columns(balance: ForceBalance, names: Sequence[str], generous: bool) -> Array:
    v, side = balance.velocity, np.sign(balance.velocity)
    top = max(float(np.quantile(np.abs(v), 0.95)), 1.0e-12)
    friction = [side]
    if generous:
        friction += [side * np.exp(-np.abs(v) / (0.1 * top)), v, v * np.abs(v), np.abs(v)]
    known = [balance.columns[n] for n in names if n in balance.columns]
    one = np.ones(len(balance.driven))
    return np.column_stack([one, *known, *(balance.window.at_centres(x) for x in friction)])
