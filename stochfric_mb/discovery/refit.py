"""Fits of a model's numbers to one-cycle-ahead forecasts of the runs that are there to be fitted."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.forecast import Windows, forecasts
from stochfric_mb.discovery.least_squares import minimised
from stochfric_mb.discovery.model import Knob, Model, adjusted, knobs_of
from stochfric_mb.discovery.record import Array

MOST_WINDOWS = 16
"""Forecasts a run that a fit uses, spread over the run."""
UNIT = 1.0e-5
"""Size of an error that counts fully [m]; larger ones count by their size, not its square."""
CLIP = 60.0
"""Errors beyond this many units count as this many: a missed slip says no more than that."""


DIFFERENCE = 0.01
"""Step of the derivatives, over a natural step of each number [-]."""


@dataclasses.dataclass(frozen=True)
class Fit:
    """A fitted model."""

    model: Model
    """The model with its numbers fitted."""
    knobs: list[Knob]
    """What was adjusted."""
    values: Array
    """Fitted values, shape (len(knobs),)."""
    deviations: Array
    """Their standard deviations, shape (len(knobs),)."""
    cost: float
    """Robust sum of squares at the end [-]."""


def thinned(windows: Windows, most: int) -> Windows:
    """Return at most ``most`` windows, spread evenly."""
    if len(windows) <= most:
        return windows
    return windows.part(np.unique(np.linspace(0, len(windows) - 1, most).round().astype(int)))


def refit(
    model: Model,
    windows: Sequence[Windows],
    uncertainty: Mapping[str, float],
    *,
    only: Sequence[str] | None = None,
    evaluations: int = 14,
    most: int = MOST_WINDOWS,
) -> Fit:
    """Return the model fitted to forecasts.

    Args:
        model: where the fit starts.
        windows: forecasts, run by run.
        uncertainty: relative standard deviations of what is believed.
        only: names of the knobs that may move; all of them if not given.
        evaluations: most Gauss-Newton steps.
        most: forecasts used in each run.
    """
    used = [thinned(w, most) for w in windows if len(w)]
    knobs = [k for k in knobs_of(model, uncertainty, [w.record.name for w in used]) if only is None or k.name in only]
    start = np.array([k.value for k in knobs])
    scale = np.array([k.scale for k in knobs])
    priors = np.array([k.prior for k in knobs])
    believed = np.array([0.0 if np.isfinite(k.prior) else k.value for k in knobs])
    low = np.array([(k.low - v) / s for k, v, s in zip(knobs, start, scale, strict=True)]) - 1.0e-9
    high = np.array([(k.high - v) / s for k, v, s in zip(knobs, start, scale, strict=True)]) + 1.0e-9

    def errors(step: Array) -> Array:
        values = start + scale * step
        trial = adjusted(model, knobs, values)
        parts = [np.nan_to_num(np.clip((forecasts(trial, w) - w.targets) / UNIT, -CLIP, CLIP), nan=CLIP).ravel() for w in used]
        # priors enter as one observation each; its weight is that of a cycle's worth of independent errors
        return np.concatenate([*parts, 3.0 * (values - believed) / priors])

    found = minimised(
        errors, np.zeros(len(knobs)), low, high, difference=DIFFERENCE, loss="soft_l1", f_scale=2.0, max_nfev=evaluations,
        xtol=1.0e-4, ftol=1.0e-4, x_scale="jac",
    )  # fmt: skip
    values = start + scale * found.x
    information = found.jac.T @ found.jac
    # the errors of one forecast hang together: a forecast counts as about six independent numbers
    inflation = sum(w.targets.size for w in used) / max(6 * sum(map(len, used)), 1)
    variance = max(2.0 * found.cost / max(sum(w.targets.size for w in used), 1), 1.0e-12)
    deviations = np.sqrt(np.diag(np.linalg.pinv(information)) * variance * inflation) * scale
    return Fit(adjusted(model, knobs, values), knobs, values, deviations, float(found.cost))
