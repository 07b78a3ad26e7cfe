"""What carries over to held-out runs: effects that do not are not named, and where no name is known an unnamed term may."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.decision.adequacy import at_bound, drawn_by_two, inadequate
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import ALONG
from stochfric_mb.discovery.driven_joint.fit.evidence import settings_of
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.scores import FLOOR, closed_share, noise_floor, score, white_floor
from stochfric_mb.effects import kinds_with, make_effect
from stochfric_mb.effects.traits import ANONYMOUS
from stochfric_mb.measurement.dataset import Dataset

Array = npt.NDArray[np.float64]

SMOOTH = {"position and direction": "position", "speed and direction": "speed", "time and direction": "time"}
"""Axis of a smooth competitor that turns with the direction, as friction does -> axis of an unnamed term."""
KNOTS = 7
"""Knots of its table."""
ENDS = 0.01, 0.99
"""Quantiles of what the motion visits along an axis, at which the table begins and ends [-]."""
BEGIN = 1.0e-3
"""Size of the table from which its fit begins, over mu_k [-]."""


def with_idle(place: PlaceOutcome) -> PlaceOutcome:
    """Return the outcome at a place with why its effects are not named; the model without it, where no delay is.

    Scatter beside a curve that is not named is none of its own: without the curve it is part of what is missing.
    """
    reason = inadequate(place)
    curve = drawn_by_two(place)
    if curve:
        place = dataclasses.replace(place, random=None, runs=None, forecasts=None)
    if not reason or place.late:
        return dataclasses.replace(place, idle=reason, curve=curve)
    # a factor of the drive that nobody doubted is exact again
    nuisances = tuple(n for n in place.nuisances if n.name in place.selected.recalibrated.model.nuisances)
    plain = dataclasses.replace(
        place.selected,
        final=place.selected.recalibrated,
        effects=(),
        standing_in=tuple,
        standing_in_numbers=dict[str, tuple[str, ...]],
        released=(),
        nuisances=nuisances,
    )
    scores = place.scores | {"augmented": place.scores["recalibrated"]}
    return dataclasses.replace(place, selected=plain, nuisances=nuisances, scores=scores, idle=reason, curve=curve)


def lacks(dataset: Dataset, place: PlaceOutcome) -> bool:
    """Return whether a place is mistimed, a curve of two effects, or leaves more than noise explains, if its noise can tell.

    A number of the mechanism that goes as far as beliefs allow for it stands for something else, and runs that differ as a
    condition of theirs does are drawn by no chance.

    Slow and prescribed, without a mass, motion shows the noise of a force sensor alone: what friction itself does is far above
    that.
    """
    mistimed = place.timing is not None and place.timing.puzzling
    noisy = getattr(dataset.scenario.mechanism, "mass", 1.0) > 0.0 and (above_floor(place) or runs_apart(place))
    return mistimed or noisy or bool(told_by(place)) or bool(place.curve) or bool(at_bound(place)) or foretells_nothing(place)


def told_by(place: PlaceOutcome) -> str:
    """Return the condition of the runs that foretells how they differ; empty: none does."""
    return place.runs.told_by if place.runs is not None and place.runs.foretold else ""


def foretells_nothing(place: PlaceOutcome) -> bool:
    """Return whether held-out drives are further from the final model than from their mean over the fit runs, noise apart.

    What differs from run to run, however alike the windows within each are, is then more than the model explains.
    """
    fit, test = ([s.drive[s.window.centres][s.sliding] for s in of if s.drive is not None] for of in (place.fit, place.test))
    if len(fit) < len(place.fit) or len(test) < len(place.test):  # a place without a drive of its own
        return False
    off = np.concatenate(test) - np.mean(np.concatenate(fit))
    error = place.scores["augmented"].sliding
    return bool(np.ptp(np.concatenate(test)) > 0.0 and error > FLOOR * place.floor and error**2 > np.mean(off**2))


def above_floor(place: PlaceOutcome) -> bool:
    """Return whether the final model leaves more within runs than noise explains, on the fit runs."""
    strokes, runs, last = place.random, place.runs, _last(place)
    if strokes is not None and strokes.accounted:
        return not strokes.all_of_it
    # what is missing may be as quick as the windows, and then shows in their differences
    white = 0.0 if place.mended else white_floor(place.fit)
    floor = min(noise_floor(last.model, place.fit, place.nuisances), criteria.COLOURED * white or np.inf)
    within, between = _parts(place)
    # a zero of the drive that wanders goes on across reversals; a force that is larger is no zero
    zero = strokes is not None and strokes.slow_noise and float(np.std(within + between)) < _largest_zero(place)
    if zero or (runs is not None and runs.accounted):
        return False
    # less than the channels' own noise is noise, though neighbouring windows round alike; where nothing is known, nothing is
    return not float(np.std(within)) <= max(FLOOR * floor, white) or _waves(within, last.independent)


def runs_apart(place: PlaceOutcome) -> bool:
    """Return whether runs differ by more than a zero of the drive may, and than the final model leaves within them.

    What differs by less, for no known reason, is said in a note.
    """
    if place.drawn:
        return False
    within, between = _parts(place)
    return float(np.std(between)) > max(_largest_zero(place), FLOOR * float(np.std(within)))


def _last(place: PlaceOutcome) -> JointFit:
    """Return the fit that counts: the plain one where names do not stand."""
    return place.selected.recalibrated if place.idle else place.selected.final


def _parts(place: PlaceOutcome) -> tuple[Array, Array]:
    """Return what the final model leaves of the fit runs, less its mean in each setting and direction, and that mean."""
    rest = np.concatenate(_last(place).remainders)
    settings = np.unique(settings_of(place.fit), return_inverse=True)[1]
    means = (np.bincount(settings, rest) / np.bincount(settings))[settings]
    return rest - means, means


def _largest_zero(place: PlaceOutcome) -> float:
    """Return up to what size a force is the zero of the drive, in the unit of the balance."""
    model = _last(place).model
    return criteria.ZERO_WANDERS * model.law.mu_k * model.load


def _waves(rest: Array, independent: float) -> bool:
    """Return whether what is left is flatter than noise: waves that come and go, of no frequency that stays."""
    off = rest - rest.mean()
    kurtosis = float(np.mean(off**4) / np.mean(off**2) ** 2)
    flat = (3.0 - kurtosis) * float(np.sqrt(independent / 24.0))
    return kurtosis < criteria.WAVE_FLATTENS and flat > criteria.WAVE_CERTAIN


def with_unnamed(dataset: Dataset, place: PlaceOutcome) -> PlaceOutcome:
    """Return the outcome at a place with an unnamed term in its model, if nothing has a name there and one carries over."""
    selected = place.selected
    named = selected.effects or selected.released or place.late or place.idle
    rivals = [(SMOOTH[axis], evidence) for axis, evidence in selected.stages[-1].competitors if axis in SMOOTH]
    if named or place.drawn or not rivals or rivals[0][1] <= 0.0 or not (selected.unknown or lacks(dataset, place)):
        return place
    axis, evidence = rivals[0]
    fitted = _fitted(place, axis)
    after = score(fitted.model, place.test, place.nuisances, dataset.test, dataset.scenario)
    before = place.scores["augmented"]
    if closed_share(before.sliding, after.sliding, place.floor) < criteria.UNNAMED_CARRIES:
        return place
    scores = place.scores | {"augmented": after}
    return dataclasses.replace(place, selected=dataclasses.replace(selected, final=fitted), scores=scores, unnamed=evidence)


def _fitted(place: PlaceOutcome, axis: str) -> JointFit:
    """Return the final model of a place with a table along an axis, fitted."""
    final = place.selected.final
    values = np.concatenate([ALONG[axis](s, i)[s.window.centres][s.sliding] for i, s in enumerate(place.fit)])
    low, high = (float(np.quantile(values, q)) for q in ENDS)
    start = {f"change_{i}": BEGIN * final.model.law.mu_k for i in range(1, KNOTS)}
    term = make_effect(kinds_with(ANONYMOUS)[0], axis=axis, low=low, high=high, static_share=1.0, **start)
    return fit(final.model.plus(term), place.fit, place.nuisances, noise=prior_weight(final))
