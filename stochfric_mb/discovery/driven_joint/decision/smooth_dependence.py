"""Smooth dependences that belong to no effect: what they are, and what they explain of what a model leaves at a joint."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.decision.cross_validation import blocks
from stochfric_mb.discovery.driven_joint.fit.evidence import scatter, settings_of, whitened
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, prior_rows
from stochfric_mb.discovery.driven_joint.fit.joint_model import STEP, change_of
from stochfric_mb.discovery.inference.free_parameter import MECHANISM
from stochfric_mb.discovery.inference.least_squares import lengths, solved

Array = npt.NDArray[np.float64]

PARTS = np.linspace(0.0, 1.0, 9)
"""Parts of the way to a competitor's fit that are tried where it reads the drive that it explains."""


Axis = Callable[[ForceBalance, int], Array]
"""ForceBalance and its number -> a condition, shape (count,)."""


@dataclasses.dataclass(frozen=True)
class Competitor:
    """A smooth dependence that belongs to no effect: where it wins, something is missing that has no name."""

    axis: str
    """What it depends on."""
    conditions: tuple[Axis, ...]
    """One condition, or two that act together."""
    signed: bool
    """Whether it turns with the direction of the motion, as friction does."""
    order: int = 3
    """Order of its polynomial in a condition; of two the product of the conditions is taken."""
    fewest: int = 1
    """Fewest balances of which it can be asked."""

    def columns(self, balances: Sequence[ForceBalance], like: Sequence[ForceBalance] | None = None) -> list[Array]:
        """Return its columns at the centres of windows of each balance, shape (n_centres, k); k = 0 for a constant.

        Its range is that of all balances, or of those that it shall be ``like``: what is asked is a dependence that they share.
        """
        rows = [np.ones((1, len(s.time))) for s in balances]
        for condition in self.conditions if len(balances) >= self.fewest else ():
            values = [condition(s, i) for i, s in enumerate(balances)]
            around = values if like is None else [condition(s, i) for i, s in enumerate(like)]
            low, high = min(float(v.min()) for v in around), max(float(v.max()) for v in around)
            one = [_legendre(v, low, high, self.order) for v in values]
            rows = [(r[:, None] * x[None]).reshape(-1, r.shape[1]) for r, x in zip(rows, one, strict=True)]
        columns: list[Array] = []
        for balance, row in zip(balances, rows, strict=True):
            side = np.sign(balance.velocity) if self.signed else 1.0
            seen = [balance.window.at_centres(side * x) for x in row] if len(balances) >= self.fewest else []
            columns.append(np.column_stack(seen) if seen else np.zeros((len(balance.driven), 0)))
        return columns


def _number(balance: ForceBalance, number: int) -> Array:
    """Return the number of a run, in the order of the dataset, at all its samples."""
    return np.full(len(balance.time), float(number))


SIGNED = " and direction"
"""What the name of an axis ends with where the dependence turns with the direction, as friction does."""
TIMES = " times "
"""What stands between the two conditions of an axis."""
ALONG: dict[str, Axis] = {
    "position": lambda balance, _: balance.position,
    "speed": lambda balance, _: np.abs(balance.velocity),
    "time": lambda balance, _: balance.time,
    "load": lambda balance, _: balance.load,
}
"""Conditions that vary within a run."""
COMPETITORS = (
    *(Competitor(n + end, (x,), signed) for n, x in ALONG.items() for end, signed in (("", False), (SIGNED, True))),
    Competitor("run", (_number,), False, 1, criteria.FEWEST_RUNS),
    Competitor("run and direction", (_number,), True, 1, criteria.FEWEST_RUNS),
)
TOGETHER = tuple(
    (
        Competitor(f"{first}{TIMES}{second}{end}", (ALONG[first], ALONG[second]), signed, 1),
        tuple(Competitor(name, (ALONG[name],), signed) for name in (first, second)),
    )
    for first, second in itertools.combinations(ALONG, 2)
    for end, signed in (("", False), (SIGNED, True))
)
"""Two conditions that act together, and what each does by itself: the product counts beyond these, as an interaction does in an
analysis of variance. It is asked of what a named effect leaves, since effects act one by one."""


def _legendre(values: Array, low: float, high: float, order: int) -> Array:
    """Return Legendre polynomials from order 1, low and high being -1 and 1, shape (order, n); empty if these are the same."""
    if high - low <= 1.0e-12 * max(abs(low), abs(high), 1.0e-300):
        return np.zeros((0, len(values)))
    scaled = 2.0 * (values - low) / (high - low) - 1.0
    rows: Any = np.polynomial.legendre.legvander(scaled, order)[:, 1:].T
    return rows


class SmoothDependences:
    """What smooth dependences explain beside a fit to the balances of a joint."""

    def __init__(self, balances: Sequence[ForceBalance]) -> None:
        self._balances, self._settings = list(balances), settings_of(balances)

    def scores(self, current: JointFit, best: JointFit, noise: float) -> list[tuple[str, float]]:
        """Return the axes with the evidence for a dependence on each, the best first; ``best`` counts the independent windows.

        Args:
            current: what is left by it.
            best: the best fit there is.
            noise: weight of beliefs, as of `fit`.
        """
        n = best.n
        before = scatter(np.concatenate(current.remainders), self._settings, n)
        rivals: list[tuple[str, float]] = []
        for rival in COMPETITORS:
            width = self._sliding_columns(rival).shape[1]
            if width == 0:
                continue
            after = self._deviance_beside(current, noise, (rival,), n, 0.0, before.ratio)
            score = before.deviance - after - width * np.log(n)
            rivals.append((rival.axis, float(score)))
        return sorted(rivals, key=lambda r: -r[1])

    def together(self, current: JointFit, noise: float) -> tuple[str, float]:
        """Return the two conditions on which what is left depends together, beyond what it does on each; empty: on none.

        Beside them stands by what part the error on blocks left out falls with them.
        """
        n = current.n
        ratio = scatter(np.concatenate(current.remainders), self._settings, n).ratio
        scores: list[float] = []
        for both, alone in TOGETHER:
            before, after = (self._deviance_beside(current, noise, some, n, ratio) for some in (alone, (*alone, both)))
            scores.append(before - after - float(np.log(n)))
        best = int(np.argmax(scores))
        if scores[best] < criteria.NAMED + 2.0 * np.log(len(TOGETHER)):
            return "", 0.0
        both, alone = TOGETHER[best]
        gain = self.gain(current, noise, both, alone)
        return (both.axis, gain) if gain > criteria.MATERIAL else ("", 0.0)

    def left_to(self, richer: JointFit, plain: JointFit, noise: float, axis: str) -> float:
        """Return the evidence [-] that an effect keeps beside any smooth dependence on two conditions; numbers are not counted.

        Args:
            richer: the fit with the effect, which counts the independent windows.
            plain: the fit without it.
            noise: weight of beliefs, as of `fit`.
            axis: the two conditions, as `together` names them.
        """
        pair = next(b for b, _ in TOGETHER if b.axis == axis).conditions
        some = [c for both, alone in TOGETHER if both.conditions == pair for c in (*alone, both)]
        n = richer.n
        ratio = scatter(np.concatenate(richer.remainders), self._settings, n).ratio
        before, after = (self._deviance_beside(f, noise, some, n, ratio) for f in (plain, richer))
        return before - after

    def gain(self, current: JointFit, noise: float, rival: Competitor, beside: Sequence[Competitor] = ()) -> float:
        """Return by what part a competitor lowers the error on blocks left out, beyond what those ``beside`` it do."""
        inside = [s.sliding for s in self._balances]
        prior, offsets = prior_rows(current, noise)
        known = np.vstack([current.jacobian, prior])[:, adjustable(current)]
        y = np.r_[np.concatenate(current.remainders), offsets]
        errors = [0.0, 0.0]
        for i, some in enumerate((tuple(beside), (*beside, rival))):
            more = [self._sliding_columns(c) for c in some]
            slopes = np.column_stack([self._by_drive(c) for c in some]) if some else np.zeros((len(y) - len(prior), 0))
            design = np.column_stack([known, *(np.vstack([c, np.zeros((len(prior), c.shape[1]))]) for c in more)])
            size = lengths(design)
            for block in blocks(self._balances):
                inner = np.concatenate([b[m] for b, m in zip(block, inside, strict=True)])
                out = np.r_[inner, np.zeros(len(prior), dtype=bool)]
                b = solved(design[~out], y[~out], size)
                left = error_of_drive(y[out], design[out], b, slopes[inner]) if slopes.any() else y[out] - design[out] @ b
                errors[i] += float(np.sum(left**2))
        return 1.0 - float(np.sqrt(errors[1] / errors[0]))

    def _sliding_columns(self, rival: Competitor) -> Array:
        """Return the columns of a competitor at the windows of sliding, shape (n_windows, k)."""
        seen = rival.columns(self._balances)
        return np.concatenate([c[s.sliding] for c, s in zip(seen, self._balances, strict=True)])

    def _deviance_beside(self, current: JointFit, noise: float, some: Sequence[Competitor], n: float, *ratios: float) -> float:
        """Return the least deviance of what a fit leaves beside some dependences, for some ratios of the variances."""
        prior, offsets = prior_rows(current, noise)
        kept = adjustable(current)
        columns = np.column_stack([self._sliding_columns(c) for c in some])
        design = np.column_stack([current.jacobian[:, kept], columns])
        below = np.column_stack([prior[:, kept], np.zeros((len(prior), columns.shape[1]))])
        slopes = np.column_stack([self._by_drive(c) for c in some])
        rest = np.concatenate(current.remainders)
        return min(self._deviance_without(rest, offsets, design, below, n, ratio, slopes) for ratio in {*ratios})

    def _deviance_without(
        self, rest: Array, offsets: Array, design: Array, below: Array, n: float, ratio: float, slopes: Array
    ) -> float:
        """Return the deviance of what ``design`` leaves, fitted for one ratio of the variances; ``below`` are the priors.

        ``slopes`` is the change of its last columns with the drive: where they have any, the best part of the way to that
        fit is taken, the drive being explained by motion only.
        """
        both = np.vstack([whitened(design, self._settings, n, ratio), below])
        goal = np.r_[whitened(rest[:, None], self._settings, n, ratio)[:, 0], offsets]
        b = solved(both, goal)
        if not slopes.any():
            return scatter(rest - design @ b, self._settings, n).deviance
        left = [error_of_drive(rest, design, part * b, slopes) for part in PARTS]
        return min(scatter(r, self._settings, n).deviance for r in left)

    def _by_drive(self, rival: Competitor) -> Array:
        """Return the change of a competitor's columns with the drive, shape (n_windows, k)."""
        at = self._balances
        step = STEP * max(float(np.mean(np.concatenate([s.load for s in at]))), 1.0e-300)
        moved = [s if s.load_by_drive is None else dataclasses.replace(s, load=s.load + step * s.load_by_drive) for s in at]
        change = zip(rival.columns(moved, at), rival.columns(at), at, strict=True)
        return np.concatenate([((there - here) / step)[s.sliding] for there, here, s in change])


def error_of_drive(rest: Array, design: Array, b: Array, slopes: Array) -> Array:
    """Return the error of the drive that ``design`` times ``b`` leaves; its last columns change with it by ``slopes``."""
    by_drive = 1.0 - slopes @ b[len(b) - slopes.shape[1] :]
    return (rest - design @ b) / change_of(by_drive)


def adjustable(fitted: JointFit) -> list[int]:
    """Return the numbers of a fit that a smooth competitor may move: all but gains.

    With less gain and a potential of its own in the place of gravity there would be less of everything, errors included.
    """
    return [i for i, k in enumerate(fitted.free) if k.owner != MECHANISM or not k.name.endswith("gain")]
