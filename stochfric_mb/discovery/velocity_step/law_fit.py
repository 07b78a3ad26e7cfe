"""Fits of a law to velocity steps, and how well it then predicts the runs that no fit has seen."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.fit.fitting import DIFFERENCE, TOLERANCE
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter, steps_of
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.velocity_step.laws import Law, Track
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import MORE_DAMPING, RATE

Array = npt.NDArray[np.float64]

FIRST, MOST = 6, 30
"""Evaluations of a fit from each start, and from the best of them."""


@dataclasses.dataclass(frozen=True)
class Fitted:
    """A law with its numbers."""

    law: Law
    """The law."""
    values: Array
    """Its numbers."""
    covariance: Array
    """Their covariance, shape (n, n)."""
    rest: list[Array]
    """Residual in the fit runs [-]."""

    @property
    def deviations(self) -> Array:
        """Their standard deviations, shape (n,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def rms(self) -> float:
        """Root mean square of what is left [-]."""
        return float(np.sqrt(np.mean(np.concatenate(self.rest) ** 2)))

    @property
    def kind(self) -> str:
        """The effect that it is; friction that rises with the speed is viscous."""
        rises = self.law.kind == kind_with_signature(RATE) and self.values[2] > 0.0
        return kind_with_signature(MORE_DAMPING) if rises else self.law.kind


def fit(law: Law, tracks: Sequence[Track], starts: Sequence[Sequence[float] | Array]) -> Fitted:
    """Return the best fit of a law from several starts."""
    fits = [fit_from(law, tracks, np.array(s), FIRST) for s in starts]
    best = min(fits, key=lambda f: f.rms)
    return fit_from(law, tracks, best.values, MOST)


def fit_from(law: Law, tracks: Sequence[Track], start: Array, evaluations: int) -> Fitted:
    """Return the fit of a law from one start to the fit runs among the tracks."""
    steps = steps_of([FreeParameter(LAW, k.name, x, k.scale, k.low, k.high) for k, x in zip(law.numbers, start, strict=True)])
    fitted = [i for i, t in enumerate(tracks) if t.run.role == "fit"]

    def errors(step: Array) -> Array:
        predicted = law.predict(tracks, steps.values(step))
        return np.concatenate([tracks[i].friction - predicted[i] for i in fitted])

    minimum = minimised(
        errors, np.zeros(len(start)), steps.low, steps.high, difference=DIFFERENCE, evaluations=evaluations, tolerance=TOLERANCE
    )
    jacobian, values = minimum.jacobian, steps.values(minimum.x)
    predicted = law.predict(tracks, values)
    rest = [tracks[i].friction - predicted[i] for i in fitted]
    n, total = sum(map(len, rest)), sum(independent_count(r) for r in rest)
    variance = float(np.mean(errors(minimum.x) ** 2)) * n / max(total, 1.0)
    covariance = np.linalg.pinv(jacobian.T @ jacobian, hermitian=True) * variance
    return Fitted(law, values, np.asarray(covariance * np.outer(steps.scale, steps.scale), dtype=np.float64), rest)


def score_over(plain: Fitted, richer: Fitted, n: float, choices: int) -> float:
    """Return the score of a law with more numbers over a plainer one, n ln of the ratio of squares - p ln n - 2 ln choices [-].

    Args:
        plain: the plainer law.
        richer: the other one.
        n: independent numbers in what it leaves.
        choices: forms and starts that it was chosen from.
    """
    p = len(richer.values) - len(plain.values)
    return float(n * np.log((plain.rms / richer.rms) ** 2) - p * np.log(n) - 2.0 * np.log(choices))


def held_out(fitted: Fitted, tracks: Sequence[Track]) -> list[Array]:
    """Return what a fitted law leaves of friction in the held-out runs [-]."""
    predicted = fitted.law.predict(tracks, fitted.values)
    return [t.friction - p for t, p in zip(tracks, predicted, strict=True) if t.run.role == "test"]


def held_out_error(fitted: Fitted, tracks: Sequence[Track]) -> float:
    """Return its root mean square [-]."""
    return float(np.sqrt(np.mean(np.concatenate(held_out(fitted, tracks)) ** 2)))
