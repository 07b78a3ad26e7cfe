"""Fits of a joint's friction and of the numbers believed of its mechanism to the balance of forces."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.free_parameters import (
    FreeParameter,
    adjusted,
    bounds_of,
    free_parameters,
    value_of,
)
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.inference.gauss_newton import least_squares

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

EVALUATIONS = 12
"""Most Gauss-Newton steps: the balance is linear in most numbers."""
PER_STROKE = 6
"""Independent numbers that one stroke can give: friction's errors repeat along a stroke, and that no autocorrelation shows."""


@dataclasses.dataclass(frozen=True)
class JointFit:
    """A fitted model, and what is known of its numbers."""

    model: JointModel
    """The model."""
    knobs: tuple[FreeParameter, ...]
    """What was adjusted."""
    values: Array
    """Fitted values, shape (n_knobs,)."""
    covariance: Array
    """Their covariance, correlation of neighbouring windows allowed for, shape (n_knobs, n_knobs)."""
    remainders: tuple[Array, ...]
    """What is left at the centres that were fitted, balance by balance [N or N m]."""
    jacobian: Array
    """Change of the remainder with each number, shape (n, n_knobs)."""
    strokes: int
    """Stretches of sliding one way that were fitted."""

    @property
    def rms(self) -> float:
        """Root mean square of what is left [N or N m]."""
        return float(np.sqrt(np.mean(np.concatenate(self.remainders) ** 2)))

    @property
    def independent(self) -> float:
        """Number of independent windows: from the autocorrelation of what is left, `PER_STROKE` a stroke at most."""
        return min(sum(independent_count(r) for r in self.remainders), float(PER_STROKE * self.strokes))

    def deviation(self, owner: int, name: str) -> float:
        """Return the standard deviation of a fitted number; nan if it was not fitted."""
        for i, knob in enumerate(self.knobs):
            if (knob.owner, knob.name) == (owner, name):
                return float(np.sqrt(max(self.covariance[i, i], 0.0)))
        return float("nan")


def independent_count(values: Array) -> float:
    """Return to how many independent numbers a series is worth: n over its integrated autocorrelation.

    The sum ends where the autocorrelation first falls below two standard errors of white noise.
    """
    n = len(values)
    if n < 8:
        return float(n)
    x = values - values.mean()
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.abs(np.fft.rfft(x, size)) ** 2
    correlation = np.fft.irfft(spectrum, size)[: n // 2]
    if correlation[0] <= 0.0:
        return float(n)
    correlation = correlation / correlation[0]
    end = int(np.argmax(correlation < 2.0 / np.sqrt(n))) or len(correlation)
    return float(n / max(1.0 + 2.0 * correlation[1:end].sum(), 1.0))


def stroke_count(masks: Sequence[Mask]) -> int:
    """Return the number of stretches of windows without a gap."""
    return sum(int(np.count_nonzero(np.diff(np.r_[0, m.astype(np.int8)]) > 0)) for m in masks)


def fit(
    model: JointModel,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    *,
    noise: float,
    masks: Sequence[Mask] | None = None,
    evaluations: int = EVALUATIONS,
    fixed: Sequence[tuple[int, str]] = (),
) -> JointFit:
    """Return the model fitted to the balance of ``balances``.

    Args:
        model: where the fit starts.
        balances: runs to learn from.
        nuisances: numbers of the mechanism with their priors.
        noise: standard deviation of the remainder per window for which priors count as one independent window [N or N m].
        masks: windows to use in each balance; None: those in which the joint slides.
        evaluations: most Gauss-Newton steps.
        fixed: number of an effect and name of its parameter, for those that stay.
    """
    used = [s.sliding for s in balances] if masks is None else list(masks)
    knobs = free_parameters(model, nuisances, fixed)
    start = np.array([value_of(model, k) for k in knobs])
    scale = np.array([k.scale for k in knobs])
    tied = [i for i, k in enumerate(knobs) if np.isfinite(k.deviation)]
    believed = np.array([knobs[i].believed for i in tied])
    deviation = np.array([knobs[i].deviation for i in tied])

    def errors(step: Array) -> Array:
        values = start + scale * step
        trial = adjusted(model, knobs, values)
        parts = [trial.remainder(s, nuisances)[m] for s, m in zip(balances, used, strict=True)]
        return np.concatenate([*parts, noise * (values[tied] - believed) / deviation])

    steps, jacobian = least_squares(errors, *bounds_of(knobs, start, scale), evaluations=evaluations)
    values = start + scale * steps
    fitted = adjusted(model, knobs, values)
    parts = tuple(fitted.remainder(s, nuisances)[m] for s, m in zip(balances, used, strict=True))
    n = sum(map(len, parts))
    result = JointFit(
        fitted, tuple(knobs), values, np.zeros((len(knobs), len(knobs))), parts, jacobian[:n] / scale, stroke_count(used)
    )
    inflation = n / max(result.independent, 1.0)
    # priors enter the information as they did the fit, with the weight of one window at ``noise``
    information = jacobian[:n].T @ jacobian[:n] / (result.rms**2 * inflation + 1.0e-300)
    for i, d in zip(tied, deviation, strict=True):
        information[i, i] += (scale[i] / d) ** 2
    covariance = np.linalg.pinv(information, hermitian=True) * np.outer(scale, scale)
    return dataclasses.replace(result, covariance=covariance)


def prior_weight(fitted: JointFit) -> float:
    """Return the deviation per window for which a prior counts as one independent window [N or N m]."""
    n = sum(map(len, fitted.remainders))
    return fitted.rms * float(np.sqrt(n / max(fitted.independent, 1.0)))


def prior_rows(fitted: JointFit, noise: float) -> tuple[Array, Array]:
    """Return the rows by which priors enter a linear fit about ``fitted``, shape (n_tied, n_knobs), and their values.

    Args:
        fitted: the fit.
        noise: as of `fit`.
    """
    tied = [i for i, k in enumerate(fitted.knobs) if np.isfinite(k.deviation)]
    rows = np.zeros((len(tied), len(fitted.knobs)))
    values = np.zeros(len(tied))
    for row, i in enumerate(tied):
        knob = fitted.knobs[i]
        rows[row, i] = noise / knob.deviation
        values[row] = noise * (fitted.values[i] - knob.believed) / knob.deviation
    return rows, values
