"""Fits of a model's numbers to one-cycle-ahead forecasts of the runs that are there to be fitted."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.inference.fitter import loss, minimised
from stochfric_mb.discovery.inference.free_parameter import FreeParameter, steps_of
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows, forecasts
from stochfric_mb.discovery.stick_slip.simulation.model import Model, adjusted, free_parameters
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits
from stochfric_mb.effects import Effect

REFIT_WINDOWS = 12
"""Forecasts of each run that such a fit uses."""
MOST_WINDOWS = 16
"""Forecasts a run that a fit uses, spread over the run."""
UNIT = 3.6e-3
"""Size of an error that counts fully, over what the box moves in a forecast [-]; larger ones count by size, not square."""
TYPICAL = 2.0
"""Errors up to this many units count by their square [-]."""
CLIP = 0.5 / UNIT
"""Errors beyond this many units, half of what the box moves, count as this many: a missed slip says no more than that."""
TELLING = 3.0
"""Change that a difference has to make where what else the runs show counts, in standard deviations: features of a simulated
slip jump by about one as samples fall on the other side of an edge, and forecasts do not."""
DIFFERENCE = 0.01
"""Step of the derivatives in a fit, over a natural step of each number [-]."""
STARTS = np.linspace(-3.0, 3.0, 13)
"""Where a forecast may begin, in standard deviations of what is known of its start [-]."""
LIGHTER = 0.7
"""Share of what priors weighed in a fit, below which they weigh less where it ended for it to go on [-]."""
WIDEST = 30.0
"""Standard deviation of a number that nothing tells, over its natural step [-]."""
LEAST_CURVATURE = 1.0e-8
"""Smallest information on a combination of numbers, over that on single ones, that counts [-]."""
INDEPENDENT = 6
"""Independent numbers in a forecast: its errors hang together."""

Further = Callable[[Model], Array]
"""From a model to the errors of what else the runs show, in its standard deviations."""


@dataclasses.dataclass(frozen=True)
class Fit:
    """A fitted model."""

    model: Model
    """The model with its numbers fitted."""
    free: list[FreeParameter]
    """What was adjusted."""
    values: Array
    """Fitted values, shape (len(free),)."""
    deviations: Array
    """Their standard deviations, shape (len(free),)."""
    cost: float
    """Robust sum of squares of forecasts and priors at the end [-]."""
    objective: float = 0.0
    """The same with what else the runs show, which the fit made as small as it could; equal to `cost` where that is all."""
    data_share: Array = dataclasses.field(default_factory=lambda: np.zeros(0))
    """Share of what is known of each number that the forecasts tell, the rest being its prior [-], 0 .. 1, shape (len(free),);
    empty before `with_deviations`."""
    posterior: Array = dataclasses.field(default_factory=lambda: np.zeros(0))
    """Standard deviations by forecasts and prior together, each at its own weight, shape as `data_share`."""


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
    typical: float = TYPICAL,
    further: Further | None = None,
    weigh: Model | None = None,
) -> Fit:
    """Return the model fitted to forecasts, and to what else the runs show: log likelihoods add.

    Args:
        model: where the fit starts.
        windows: forecasts, run by run.
        uncertainty: relative standard deviations of the stated numbers.
        only: names of the parameters, of single runs, that may move; all of them if not given.
        evaluations: most Gauss-Newton steps.
        most: forecasts used in each run.
        typical: errors up to this many units count by their square [-]; inf: all of them, where a fit begins far off.
        further: errors of what else the runs show.
        weigh: model whose forecasts tell how much an independent number of theirs errs, and so what else weighs; that where
            the fit starts if not given.
    """
    misfit = Misfit(model, windows, uncertainty, only, most)
    misfit.beside(further, weigh or model)
    x = np.zeros(len(misfit.free))
    while True:
        weight = misfit.believe(x)
        minimum = minimised(
            misfit.errors, x, misfit.steps.low, misfit.steps.high, difference=DIFFERENCE,
            evaluations=evaluations, tolerance=1.0e-4, outlying=misfit.outlying(typical), stride=misfit.steps.stride,
            telling=0.0 if further is None else TELLING * weight, threads=True,
        )  # fmt: skip
        x = minimum.x
        if not misfit.believed(x) < LIGHTER * weight:
            break
    values = misfit.steps.values(minimum.x)
    spread = misfit.spread(2.0 * minimum.cost)
    deviations = misfit.steps.scale * left_open(minimum.jacobian, spread)
    cost = float(minimum.cost) if further is None else _robust(misfit.alone(minimum.x))
    return Fit(adjusted(model, misfit.free, values), misfit.free, values, deviations, cost, float(minimum.cost))


def cost_of(model: Model, windows: Sequence[Windows], *, most: int = MOST_WINDOWS) -> float:
    """Return the robust sum of squares that a model as it is leaves of forecasts [-]; compare with `Fit.cost`."""
    misfit = Misfit(model, windows, {}, (), most)
    return _robust(misfit.errors(np.zeros(0)))


def _robust(errors: Array) -> float:
    """Return half the sum of squares of errors, of those beyond `TYPICAL` by size [-]."""
    return float(np.sum(_each(errors)))


def _each(errors: Array) -> Array:
    """Return the same row by row, shape (n,) of (n, k)."""
    return loss(errors, TYPICAL).sum(axis=-1)


def likelihood_ratios(models: Sequence[Model], windows: Sequence[Windows]) -> Array:
    """Return twice the log likelihood ratios of the best of some models to each, in what forecasts count as independent [-].

    All forecasts count, not only those that a fit used: a wave's frequency may be wrong by a wave between two of these. Each
    begins where it is least wrong, as far as noise lets the start be off: a wave to which slips keep knows when the box breaks
    away whatever the start, and would be better by that alone.
    """
    misfits = [Misfit(m, windows, {}, (), max(map(len, windows))) for m in models]
    costs = np.array([sum(float(m.least(w).sum()) for w in m.windows) for m in misfits])
    return 2.0 * (costs - costs.min()) / misfits[0].spread(2.0 * float(costs.min()))


def _together(free: Sequence[FreeParameter], effects: Sequence[Effect]) -> Array:
    """Return what makes independent surprises of those of numbers whose priors hang together, shape (p, p)."""
    whitening = np.eye(len(free))
    for owner, effect in enumerate(effects):
        names, correlation = effect.fitted_together()
        at = [i for i, k in enumerate(free) if k.owner == owner and k.name in names]
        if at:
            whitening[np.ix_(at, at)] = np.linalg.inv(np.linalg.cholesky(correlation))
    return whitening


class Misfit:
    """What forecasts miss, over the free parameters of a model in their natural steps, all 0 at the start."""

    def __init__(
        self, model: Model, windows: Sequence[Windows], uncertainty: Mapping[str, float], only: Sequence[str] | None, most: int
    ) -> None:
        self.model = model
        self.windows = [thinned(w, most) for w in windows if len(w)]
        units = NaturalUnits.of_run(windows[0].record)
        self.unit = UNIT * float(np.median(np.concatenate([np.ptp(w.targets, axis=1) for w in windows])))
        runs = [w.record.name for w in self.windows]
        self.free = [k for k in free_parameters(model, uncertainty, units, runs) if only is None or (k.name in only and k.run)]
        self.steps = steps_of(self.free)
        # numbers of a single run are nothing to the others, whose forecasts stay as they were
        self._seen_by = [np.array([k.run in ("", run) for k in self.free], dtype=bool) for run in runs]
        most = 2 + sum(not k.run for k in self.free)
        self._missed = [functools.lru_cache(most)(functools.partial(self._missed_in, w)) for w in self.windows]
        self.priors = _together(self.free, model.effects)
        """What makes independent surprises of the numbers', shape (n_free, n_free)."""
        self._further: Further | None = None
        self._weight, self._repeats, self._belief = 0.0, 0, 1.0

    def beside(self, further: Further | None, model: Model) -> None:
        """Let what else the runs show count, an independent number of it as much as one of a model's forecasts."""
        if further is None:
            return
        errors = [self._error_of(model, w) for w in self.windows]
        count = sum(map(len, errors))
        self._weight = float(np.sqrt(max(2.0 * _robust(np.concatenate(errors)) / max(count, 1), 1.0e-12)))
        self._repeats = max(round(count / max(INDEPENDENT * sum(map(len, self.windows)), 1)), 1)
        self._further = further

    def alone(self, step: Array) -> Array:
        """Return the errors of forecasts and priors."""
        values = self.steps.values(step)
        parts = [missed(*values[seen]) for missed, seen in zip(self._missed, self._seen_by, strict=True)]
        return np.concatenate([*parts, self._belief * (self.priors @ self.steps.surprise(values))])

    def believed(self, step: Array) -> float:
        """Return what one standard deviation of a prior weighs: what an independent number of a forecast errs."""
        errors = self.alone(step)[: -len(self.free) or None]
        return float(np.sqrt(self.spread(2.0 * _robust(errors))))

    def believe(self, step: Array) -> float:
        """Let priors weigh so much, and return it."""
        self._belief = self.believed(step)
        return self._belief

    def outlying(self, typical: float) -> Array:
        """Return the sizes beyond which errors count by their size [-], shape as `errors`: priors are normal."""
        count = len(self.errors(np.zeros(len(self.free))))
        return np.r_[np.full(count - len(self.free), typical), np.full(len(self.free), np.inf)]

    def errors(self, step: Array) -> Array:
        """Return the errors of what else the runs show, of forecasts, and of priors, in units of `UNIT` and of deviations."""
        errors = self.alone(step)
        if self._further is None:
            return errors
        model = adjusted(self.model, self.free, self.steps.values(step))
        return np.concatenate([np.repeat(self._weight * self._further(model), self._repeats), errors])

    def _missed_in(self, windows: Windows, *values: float) -> Array:
        """Return the errors of a run's forecasts with the ``values`` of the numbers that it depends on."""
        free = [k for k in self.free if k.run in ("", windows.record.name)]
        return self._error_of(adjusted(self.model, free, np.array(values)), windows)

    def _error_of(self, model: Model, windows: Windows) -> Array:
        """Return the errors of a model's forecasts, shape (targets,)."""
        errors = (forecasts(model, windows) - windows.targets) / self.unit
        return np.nan_to_num(np.clip(errors, -CLIP, CLIP), nan=CLIP).ravel()

    def least(self, windows: Windows) -> Array:
        """Return what the model as it is leaves of each forecast, begun where it leaves least, shape (n,); cf. `_robust`."""
        noise = windows.record.noise / self.unit
        tried = [
            _each(self._error_of(self.model, windows.started(d)).reshape(windows.targets.shape)) + 0.5 * (d * noise) ** 2
            for d in STARTS
        ]
        return np.min(tried, axis=0)

    def spread(self, squares: float) -> float:
        """Return the variance that errors count with, from their robust sum of squares."""
        count = sum(w.targets.size for w in self.windows)
        inflation = count / max(INDEPENDENT * sum(map(len, self.windows)), 1)
        return max(squares / max(count, 1), 1.0e-12) * inflation


def left_open(slopes: Array, spread: float) -> Array:
    """Return the standard deviations that slopes leave; a direction that they do not show is left open, not called certain."""
    size = np.sqrt((slopes**2).sum(axis=0))
    seen = size > 0.0
    result = np.full(len(size), WIDEST)
    if seen.any():
        scaled = slopes[:, seen] / size[seen]
        values, vectors = np.linalg.eigh(scaled.T @ scaled)
        variance = (vectors**2 / np.maximum(values, LEAST_CURVATURE)).sum(axis=1)
        result[seen] = np.sqrt(spread * variance) / size[seen]
    return result
