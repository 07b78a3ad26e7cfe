"""Velocity steps that no law explains: friction that changes smoothly along an axis, kept if held-out runs bear it out."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.inference.paired import Paired, paired
from stochfric_mb.discovery.velocity_step.law_fit import Fitted, fit_from, held_out, score_over
from stochfric_mb.discovery.velocity_step.laws import Law, Number, Track
from stochfric_mb.effects import kinds_with
from stochfric_mb.effects.traits import ANONYMOUS

Array = npt.NDArray[np.float64]

AXES: dict[str, Callable[[Track], Array]] = {
    "speed": lambda track: track.speed,
    "position": lambda track: track.run.channels["position"],
    "time": lambda track: track.run.time,
}
"""Axis of the term -> the place of each sample on it."""
KNOTS = 7
"""Knots of the term's table."""
STEP = 0.002
"""Natural step of a knot [-]."""
BLOCKS = 12
"""Pieces of each held-out record whose errors are compared."""
EVALUATIONS = 12
"""Most steps of a fit: the term enters linearly."""


@dataclasses.dataclass(frozen=True)
class SmoothLaw:
    """A law with a term along an axis."""

    axis: str
    """The axis."""
    low: float
    """Place of the first knot."""
    high: float
    """Place of the last one."""
    score: float
    """Evidence of the fit runs for it [-]."""
    fitted: Fitted
    """The law with the term; the last numbers are the table, from the second knot on."""
    seen: Paired
    """Mean squares of what is left of held-out runs without it and with it, in `BLOCKS` of each."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the last numbers of the law, the table."""
        return self.fitted.law.names[1 - KNOTS :]

    def law_alone(self, law: Law) -> Fitted:
        """Return the law beside the term, with the numbers that it has there."""
        return Fitted(law, self.fitted.values[: 1 - KNOTS], self.fitted.covariance[: 1 - KNOTS, : 1 - KNOTS], self.fitted.rest)

    @property
    def carries_over(self) -> bool:
        """Whether held-out runs are predicted better with it, by more than chance and by enough to be worth a term."""
        seen = self.seen
        beyond = seen.without - seen.with_ > criteria.HELD_OUT_DOUBT * seen.deviation
        return beyond and seen.rms_gain > criteria.CLOSES_NOTHING

    @property
    def sentence(self) -> str:
        """What a reader should know of it."""
        if self.carries_over:
            return f"an unnamed term along the {self.axis} is in augmented.toml: it predicts the held-out runs better"
        return f"an unnamed term along the {self.axis} explains the fit runs, but does not carry over to the held-out ones"


NOWHERE = "no smooth change of friction along speed, position or time explains what is missing: it may be random"
"""What is said where no axis has evidence."""


def smooth_law(closest: Fitted, tracks: Sequence[Track]) -> SmoothLaw | None:
    """Return the law that comes closest with a term along the axis with most evidence; None where no axis has any.

    Args:
        closest: the law.
        tracks: all runs.
    """
    tried = [_along(axis, closest, tracks) for axis in AXES]
    best = max(tried, key=lambda t: t.score)
    return best if best.score > criteria.UNNAMED_LEAST else None


def _along(axis: str, closest: Fitted, tracks: Sequence[Track]) -> SmoothLaw:
    """Return the law with a term along one axis, fitted."""
    place = AXES[axis]
    visited = np.concatenate([place(t) for t in tracks if t.run.role == "fit"])
    low, high = float(visited.min()), float(visited.max())
    law = _with_table(closest.law, place, np.linspace(low, high, KNOTS))
    start = np.r_[closest.values, np.zeros(KNOTS - 1)]
    fitted = fit_from(law, tracks, start, EVALUATIONS)
    n = max(sum(independent_count(r) for r in fitted.rest), 4.0)
    without, with_ = (_blocks(held_out(f, tracks)) for f in (closest, fitted))
    return SmoothLaw(axis, low, high, score_over(closest, fitted, n, len(AXES)), fitted, paired(without, with_))


def _with_table(law: Law, place: Callable[[Track], Array], knots: Array) -> Law:
    """Return a law plus a table over a place: 0 at the first knot, linear between, constant outside."""

    def predict(tracks: Sequence[Track], p: Array) -> list[Array]:
        table = np.r_[0.0, p[1 - KNOTS :]]
        plain = law.predict(tracks, p[: 1 - KNOTS])
        return [friction + np.interp(place(t), knots, table) for t, friction in zip(tracks, plain, strict=True)]

    table = (Number(f"change_{i}", "-", STEP) for i in range(1, KNOTS))
    return Law(kinds_with(ANONYMOUS)[0], (*law.numbers, *table), (), predict)


def _blocks(rest: Sequence[Array]) -> Array:
    """Return the mean squares of what is left in pieces of each record, shape (BLOCKS * len(rest),)."""
    return np.array([float(np.mean(part**2)) for r in rest for part in np.array_split(r, BLOCKS)])
