"""Fits of a joint's friction and of the stated numbers of its mechanism to the balance of forces."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.free_parameters import adjusted, free_parameters
from stochfric_mb.discovery.driven_joint.fit.joint_model import Forces, JointModel
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.free_parameter import FreeParameter, steps_of
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.effects.traits import ROUGH
from stochfric_mb.numerics.stretches import stretches

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

DIFFERENCE, TOLERANCE = 1.0e-4, 1.0e-7
"""Step of the derivatives in natural steps, and fall of the sum of squares over itself at which a fit ends [-]."""
LARGE_DIFFERENCES = (1.0e-2, 1.0e-3)
"""The same steps where forces are no smooth functions of the numbers [-]: as far as one tells them apart, and a tenth of that
once the best valley is found."""
EVALUATIONS = 12
"""Most Gauss-Newton steps: the balance is linear in most numbers."""
SETTLINGS, SETTLED = 4, 0.8
"""Most refits in which beliefs weigh otherwise, and the ratio of the weights at which one is not worth it [-]."""
PER_STROKE = 6
"""Independent numbers that one stroke can give: friction's errors repeat along a stroke, and that no autocorrelation shows."""


@dataclasses.dataclass(frozen=True)
class JointFit:
    """A fitted model, and what is known of its numbers."""

    model: JointModel
    """The model."""
    free: tuple[FreeParameter, ...]
    """What was adjusted."""
    values: Array
    """Fitted values, shape (n_free,)."""
    covariance: Array
    """Their covariance, correlation of neighbouring windows allowed for, shape (n_free, n_free)."""
    remainders: tuple[Array, ...]
    """What is left at the centres that were fitted, balance by balance [N or N m]."""
    jacobian: Array
    """Change of the remainder with each number, shape (n, n_free)."""
    strokes: int
    """Stretches of sliding one way that were fitted."""

    @property
    def rms(self) -> float:
        """Root mean square of what is left [N or N m]."""
        return float(np.sqrt(np.mean(np.concatenate(self.remainders) ** 2)))

    @property
    def independent(self) -> float:
        """Number of independent windows: from the autocorrelation of what is left, `PER_STROKE` a stroke at most."""
        return self.independent_in(self.remainders)

    @property
    def n(self) -> float:
        """The same as evidence counts it: at least four."""
        return max(self.independent, 4.0)

    def independent_in(self, remainders: Sequence[Array]) -> float:
        """Return the same of what another model leaves at these centres, balance by balance."""
        return min(sum(independent_count(r) for r in remainders), float(PER_STROKE * self.strokes))

    @property
    def strain(self) -> float:
        """Return the sum of squares of what was moved against beliefs, in their standard deviations [-]."""
        return float(np.sum(np.square(steps_of(self.free).surprise(self.values))))

    def at(self, owner: int, name: str) -> list[int]:
        """Return the places of a number among those fitted: none, one, or one for each run."""
        return [i for i, one in enumerate(self.free) if (one.owner, one.name) == (owner, name)]

    def deviation(self, owner: int, name: str) -> float:
        """Return the standard deviation of a fitted number; nan if it was not fitted."""
        at = self.at(owner, name)
        return float(np.sqrt(max(self.covariance[at[0], at[0]], 0.0))) if at else float("nan")

    def split(self, values: Array) -> list[Array]:
        """Return values at all centres that were fitted balance by balance, shape (n,) or (n, k)."""
        return np.split(values, np.cumsum([len(r) for r in self.remainders])[:-1])


def stroke_count(masks: Sequence[Mask]) -> int:
    """Return the number of stretches of windows without a gap."""
    return sum(len(stretches(m)) for m in masks)


def fit(
    model: JointModel,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    *,
    noise: float,
    masks: Sequence[Mask] | None = None,
    evaluations: int = EVALUATIONS,
    fixed: Sequence[tuple[int, str]] = (),
    refined: bool = False,
) -> JointFit:
    """Return the model fitted to the balance of ``balances``.

    Args:
        model: where the fit starts.
        balances: fit runs.
        nuisances: numbers of the mechanism with their priors.
        noise: standard deviation of the remainder per window for which priors count as one independent window [N or N m].
        masks: windows to use in each balance; None: those in which the joint slides.
        evaluations: most Gauss-Newton steps.
        fixed: number of an effect and name of its parameter, for those that stay.
        refined: whether a fit of rough forces goes on with smaller steps: what is compared must be refined alike.
    """
    used = [s.sliding for s in balances] if masks is None else list(masks)
    rough = any(ROUGH in e.traits for e in model.effects)
    free = free_parameters(model, nuisances, fixed)
    steps = steps_of(free)
    known: dict[Any, Forces] = {}

    def forces(trial: JointModel, balance: ForceBalance, number: int) -> Forces:
        # corrections leave friction as it is, and what is another run's own that in this one
        own = tuple(x for (_, run, _), x in trial.own.items() if run == balance.run)
        key = number, trial.law, trial.effects, own
        if key not in known:
            known[key] = trial.forces(balance)
        return known[key]

    def errors(step: Array) -> Array:
        values = steps.values(step)
        trial = adjusted(model, free, values)
        each = [forces(trial, s, i) for i, s in enumerate(balances)]
        seen = zip(balances, used, each, strict=True)
        parts = [trial.remainder(s, nuisances, f)[m] for s, m, f in seen]
        return np.concatenate([*parts, noise * steps.surprise(values)])

    differences = LARGE_DIFFERENCES[: 2 if refined else 1] if rough else (DIFFERENCE,)
    find = functools.partial(minimised, errors, low=steps.low, high=steps.high, evaluations=evaluations, tolerance=TOLERANCE)
    minimum = find(np.zeros(len(free)), difference=differences[0])
    for difference in differences[1:]:
        minimum = find(minimum.x, difference=difference)
    jacobian, scale, values = minimum.jacobian, steps.scale, steps.values(minimum.x)
    fitted = adjusted(model, free, values)
    parts = tuple(fitted.remainder(s, nuisances)[m] for s, m in zip(balances, used, strict=True))
    n = sum(map(len, parts))
    result = JointFit(
        fitted, tuple(free), values, np.zeros((len(free), len(free))), parts, jacobian[:n] / scale, stroke_count(used)
    )
    inflation = n / max(result.independent, 1.0)
    # priors enter the information as they did the fit, with the weight of one window at ``noise``
    information = jacobian[:n].T @ jacobian[:n] / (result.rms**2 * inflation + 1.0e-300)
    information += np.diag((scale / steps.prior) ** 2)
    if not np.isfinite(information).all():  # the model is no number somewhere: nothing is known of its own
        return dataclasses.replace(result, covariance=np.full_like(result.covariance, np.inf))
    covariance = np.linalg.pinv(information, hermitian=True) * np.outer(scale, scale)
    return dataclasses.replace(result, covariance=covariance)


def settled(
    model: JointModel,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    *,
    noise: float,
    fitted: JointFit | None = None,
    fixed: Sequence[tuple[int, str]] = (),
) -> tuple[JointFit, float]:
    """Return a fit in which beliefs count as much as one independent window of what it leaves itself, and that weight.

    There the deviance n ln(mean square) plus the strain of beliefs, by which fits are compared, is least: its gradient
    vanishes where the weight is the mean square over the share of windows that are independent.

    Args:
        model: where the fit starts.
        balances: fit runs.
        nuisances: numbers of the mechanism with their priors.
        noise: weight of beliefs from which to begin, as of `fit`.
        fitted: the fit with that weight, where it is known.
        fixed: as of `fit`.
    """
    fitted = fitted or fit(model, balances, nuisances, noise=noise, fixed=fixed)
    for _ in range(SETTLINGS):
        weight = prior_weight(fitted)
        if SETTLED * noise < weight < noise / SETTLED:
            break
        noise = weight
        fitted = fit(fitted.model, balances, nuisances, noise=noise, fixed=fixed)
    return fitted, noise


def prior_weight(fitted: JointFit) -> float:
    """Return the deviation per window for which a prior counts as one independent window [N or N m]."""
    n = sum(map(len, fitted.remainders))
    return fitted.rms * float(np.sqrt(n / max(fitted.independent, 1.0)))


def prior_rows(fitted: JointFit, noise: float) -> tuple[Array, Array]:
    """Return the rows by which priors enter a linear fit about ``fitted``, shape (n_tied, n_free), and their values.

    Args:
        fitted: the fit.
        noise: as of `fit`.
    """
    tied = [i for i, k in enumerate(fitted.free) if np.isfinite(k.prior)]
    rows = np.zeros((len(tied), len(fitted.free)))
    values = np.zeros(len(tied))
    for row, i in enumerate(tied):
        one = fitted.free[i]
        rows[row, i] = noise / one.prior
        values[row] = noise * (fitted.values[i] - one.nominal) / one.prior
    return rows, values
