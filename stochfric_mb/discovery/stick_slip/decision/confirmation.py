"""Confirmation by indirect inference: simulate a candidate, take the same features from it, compare with the data's.

mu_s, mu_k, mass, stiffness and damping are refitted with every candidate, within their uncertainty.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter, steps_of
from stochfric_mb.discovery.inference.threads import in_threads
from stochfric_mb.discovery.stick_slip.decision.cases import Case, predict
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES
from stochfric_mb.discovery.stick_slip.simulation.model import STRENGTHS, TUNED, Model, adjusted, free_parameters
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits

PENALTY = float(np.log(60.0))
"""Evidence that each number of a candidate costs [-]: BIC's for 60 observations, whatever the record's length."""
LEVELLINGS = 2
"""Times that mu_s and mu_k are moved to their places before a fit begins."""
DIFFERENCE = 0.01
"""Step of the derivatives, over a natural step of each number [-]."""
LEVEL_STEP = 0.0154
"""Natural step of mu_s and mu_k [-]."""
MISSED = 1.0e3
"""Deviation at which that of a feature ends, and which counts for all of them where the candidate does not slip as the data do
[-]: what slips otherwise must not be worse than what does not slip at all."""


@dataclasses.dataclass(frozen=True)
class Confirmed:
    """A candidate, fitted to the features."""

    kinds: tuple[str, ...]
    """Effects in it."""
    model: Model
    """With its numbers fitted."""
    chi2: float
    """Misfit, priors included [-]."""
    n_parameters: int
    """Parameters of the effects, and those of the stated model that they leave open."""
    freedom: int
    """Features less parameters."""
    slips: bool
    """Whether it slips where the data do: otherwise the misfit says nothing."""

    @property
    def criterion(self) -> float:
        """chi^2 + p ln 60: lower is better, whatever the record's length."""
        return self.scaled(1.0)

    def scaled(self, spread: float) -> float:
        """Return the criterion with chi^2 in units of ``spread``, what the forms of all candidates miss [-]."""
        return self.chi2 / spread + self.n_parameters * PENALTY


def evidence_needed(numbers: int) -> float:
    """Return by how much an effect of so many numbers must lower the misfit of simulated slips to be followed up [-]."""
    return criteria.FOLLOWED_UP + numbers * PENALTY


@dataclasses.dataclass(frozen=True)
class SeenInSlips:
    """What a model misses of the slips that simulated ones are compared with, for a fit beside forecasts."""

    kinds: tuple[str, ...]
    """Effects that the slips were simulated with."""
    cases: tuple[Case, ...]
    """The slips."""

    def of(self, model: Model) -> Callable[[Model], Array] | None:
        """Return the function from models to errors, in their standard deviations; None for a model of other effects."""
        return self.errors if tuple(e.kind for e in model.effects) == self.kinds else None

    def errors(self, model: Model) -> Array:
        """Return the errors of a model, shape (N_FEATURES * len(cases),)."""
        return np.concatenate([_error(model, case) for case in self.cases])


def confirm(
    cases: Sequence[Case],
    candidate: Model,
    uncertainty: Mapping[str, float],
    *,
    evaluations: int = 20,
    entrained: bool = False,
) -> Confirmed:
    """Return the candidate with its numbers fitted to the features of ``cases``.

    Args:
        cases: slips to be predicted.
        candidate: the model.
        uncertainty: relative standard deviations of the stated numbers.
        evaluations: most Gauss-Newton steps.
        entrained: whether the last effect is a wave to which the slips keep: what they leave open is its phase, not its
            frequency.
    """
    free = _free_in(candidate, cases, uncertainty, entrained=entrained)
    steps = steps_of(free, np.array([_step(k) for k in free]))

    def errors(step: Array) -> Array:
        values = steps.values(step)
        trial = adjusted(candidate, free, values)
        return np.concatenate([*map(functools.partial(_error, trial), cases), steps.surprise(values)])

    def levelled(step: Array) -> Array:
        """Return the step with mu_s and mu_k moved to where the break-away and the mean force in slip are right."""
        for _ in range(LEVELLINGS):
            away = _levels_away(adjusted(candidate, free, steps.values(step)), cases)
            step = np.clip(step + np.array([away.get(k.name, 0.0) for k in free]) / steps.scale, steps.low, steps.high)
        return step

    starts = in_threads(levelled, (np.clip(s, steps.low, steps.high) for s in _starts(candidate, free, steps.scale)))
    first = min(zip(in_threads(errors, starts), starts, strict=True), key=lambda s: float(np.sum(s[0] ** 2)))[1]
    minimum = minimised(
        errors,
        first,
        steps.low,
        steps.high,
        difference=DIFFERENCE,
        evaluations=evaluations,
        tolerance=1.0e-3,
        stride=steps.stride,
        threads=True,
    )
    n_parameters = _own(candidate, free)
    model = adjusted(candidate, free, steps.values(minimum.x))
    return Confirmed(
        tuple(e.kind for e in candidate.effects),
        model,
        float(2.0 * minimum.cost),
        n_parameters,
        N_FEATURES * len(cases) - 2 - n_parameters,
        all(predict(model, case) is not None for case in cases),
    )


def _free_in(
    candidate: Model, cases: Sequence[Case], uncertainty: Mapping[str, float], *, entrained: bool
) -> list[FreeParameter]:
    """Return what is fitted; of a wave to which the slips keep the phase, but not the frequency."""
    last, units = len(candidate.effects) - 1, NaturalUnits.of_run(cases[0].record)
    if not entrained:
        averaged = candidate.waves(cases[0].averaged)
        return [k for k in free_parameters(candidate, uncertainty, units) if not (k.run or k.owner in averaged)]
    runs = list(dict.fromkeys(case.record.name for case in cases))
    free = [k for k in free_parameters(candidate, uncertainty, units, runs) if not k.run or k.owner == last]
    return [k for k in free if k.owner != last or k.name not in TUNED]


def _own(candidate: Model, free: Sequence[FreeParameter]) -> int:
    """Return the number of the effects' parameters, and of those of the stated model that they leave open."""
    return sum(k.owner >= 0 or (k.name in CORRECTED and k.name in candidate.left_open) for k in free)


def _levels_away(model: Model, cases: Sequence[Case]) -> dict[str, float]:
    """Return by how much mu_s and mu_k are too low for the break-away and the mean force in slip, over all cases."""
    away: list[Array] = []
    for case in cases:
        predicted = predict(model, case)
        if predicted is not None:
            away.append((case.features - (predicted - case.offset))[:2] / case.record.mechanism.normal_force)
    return dict(zip(("mu_s", "mu_k"), np.mean(away, axis=0).tolist(), strict=True)) if away else {}


def _starts(candidate: Model, free: Sequence[FreeParameter], scale: Array) -> list[Array]:
    """Return where a fit may start: as screened, and with the stated mechanism and the last effect several times weaker.

    Where an effect is missing, the numbers of the mechanism that marks suggest are those that imitate it best. A stiffness that
    was freed for a curved spring would, without its curve, be of another rig.
    """
    starts = [np.zeros(len(free))]
    if not candidate.effects:
        return starts
    last = len(candidate.effects) - 1
    freed = candidate.effects[last].frees
    values = np.array([k.value for k in free])
    strong = np.array([k.owner == last and k.name in STRENGTHS and k.value != 0.0 for k in free])
    along = strong | np.array([k.owner < 0 and k.name in freed for k in free])
    stated = np.array([k.name in CORRECTED and k.owner < 0 and k.name not in freed for k in free])
    if not strong.any():
        return starts
    return starts + [
        np.where(along, (share - 1.0) * values, np.where(stated, -values, 0.0)) / scale for share in (1.0, 0.5, 0.2, 0.05)
    ]


def _step(one: FreeParameter) -> float:
    return LEVEL_STEP if one.owner == LAW else one.scale


def _error(model: Model, case: Case) -> Array:
    predicted = predict(model, case)
    if predicted is None:
        return np.full(N_FEATURES, MISSED)
    return np.clip(case.whitening @ (case.features - (predicted - case.offset)), -MISSED, MISSED)
