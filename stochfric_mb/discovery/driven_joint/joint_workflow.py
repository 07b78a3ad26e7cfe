"""Discovery at driven joints: timing, then friction effects one by one, then the score on held-out runs."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.late_channel import brought_forward, late_channel
from stochfric_mb.discovery.driven_joint.balance.readings import mended
from stochfric_mb.discovery.driven_joint.balance.timing import NAMED
from stochfric_mb.discovery.driven_joint.balance.weak_form import least_width
from stochfric_mb.discovery.driven_joint.decision.adequacy import drawn_by_one, drawn_by_two, endless, inadequate
from stochfric_mb.discovery.driven_joint.decision.carry_over import with_idle, with_unnamed
from stochfric_mb.discovery.driven_joint.decision.selection import Stage
from stochfric_mb.discovery.driven_joint.decision.signs import require_dissipation
from stochfric_mb.discovery.driven_joint.decision.verdict import verdict
from stochfric_mb.discovery.driven_joint.fit.fitting import fit, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome, PlaceOutcome
from stochfric_mb.discovery.driven_joint.place import place_outcome, share_by_delay
from stochfric_mb.discovery.driven_joint.simulation.augmented import augmented
from stochfric_mb.discovery.driven_joint.simulation.controller_check import controller_misfit, disbelieved
from stochfric_mb.discovery.driven_joint.simulation.pictures import friction_picture
from stochfric_mb.discovery.driven_joint.simulation.resimulation import simulated
from stochfric_mb.discovery.driven_joint.simulation.scores import Score, rms
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import Effect, kind_with_signature
from stochfric_mb.effects.traits import LATE
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Cascade, Mjcf, PrismaticJoint, ProportionalDerivative, SpringSlider
from stochfric_mb.scenario import ABSOLUTE, Scenario

Array = npt.NDArray[np.float64]
Progress = Callable[[str], None]
Plain = tuple[JointModel, Sequence[Nuisance], float]
"""A model of a place, numbers of its mechanism with their priors, and how beliefs weigh, as of `fit`."""
FEWEST = 8
"""Fewest windows of sliding in the runs of a role: fewer say nothing about friction."""
ANSWERS = 3
"""Answers that are tried, each without what led those before it: the held-out runs judge so many, and no more."""
CONTROLLED = {Cascade.kind: PrismaticJoint.kind, ProportionalDerivative.kind: Mjcf.kind}
"""Controller -> the mechanism that it drives."""


def joint_outcome(dataset: Dataset, *, progress: Progress | None = None) -> JointOutcome:
    """Return the result of a dataset together with what reports and exports need.

    Args:
        dataset: runs of a prismatic joint, hinge pendulum, spring slider or MJCF model, some of them held out.
        progress: called with what is being done, now and then.

    Raises:
        InputError: another mechanism, or a channel is missing.
    """
    tell = progress or (lambda _: None)
    mechanism: Any = dataset.scenario.mechanism
    if isinstance(mechanism, SpringSlider):
        from stochfric_mb.discovery.velocity_step.velocity_steps import spring_slider_outcome

        return spring_slider_outcome(dataset, tell)
    _require_controller(dataset.scenario)
    source_of(dataset)  # refuses a controller that has no drive or reference
    better, readings = mended(dataset)
    notes = disbelieved(controller_misfit(better))
    if notes:
        dataset, better = (
            dataclasses.replace(x, scenario=dataclasses.replace(x.scenario, controller=None)) for x in (dataset, better)
        )
    as_read = source_of(dataset)
    if not readings:
        return _outcome(as_read, tell, (), notes, None)
    repaired = source_of(better)
    left = _left_by(as_read, repaired, {name: _stated(as_read, name) for name in as_read.places})
    if left >= 1.0 - criteria.MATERIAL:  # beside the stated model they matter little, but perhaps beside what it lacks
        outcome = _outcome(as_read, tell, (), notes, None)
        found = {p.place: _named(p) for p in outcome.places}
        if _left_by(as_read, repaired, found, {p.place: p.late for p in outcome.places}) >= 1.0 - criteria.MATERIAL:
            return outcome
    mostly = left**2 <= 1.0 - criteria.EXPLAINED_HELD_OUT
    return _outcome(repaired, tell, readings, notes, as_read if mostly else None)


def _stated(source: Balances, name: str) -> Plain:
    model = source.stated(name)
    return model, source.nuisances(name), model.law.mu_k * model.load


def _named(place: PlaceOutcome) -> Plain:
    final = place.selected.final
    return final.model, place.selected.nuisances, prior_weight(final)


def _left_by(
    as_read: Balances, repaired: Balances, models: Mapping[str, Plain], late: Mapping[str, float] | None = None
) -> float:
    """Return the least part that the error of a place's balance keeps with wrong readings replaced, seen alike [-].

    Args:
        as_read: balances with the readings as they were.
        repaired: the same with wrong ones replaced.
        models: place -> the model of it from which fits begin, numbers of its mechanism, and how beliefs weigh.
        late: place -> by how much positions come late there, beyond what is stated [s].
    """
    parts: list[float] = []
    if _hardly_sliding(as_read) is not None:  # as it was read, nothing could be said: a position that is new now and then
        return 0.0
    for name, (model, nuisances, noise) in models.items():
        delay = as_read.stated_delay + (late or {}).get(name, 0.0)
        before = as_read.balances(name, "fit", delay)
        width = round(float(np.median([s.window.half_width / s.window.interval for s in before])))
        raw, mended_ones = (s.balances(name, "fit", delay, width) for s in (as_read, repaired))
        seen = [_where_sliding(raw, mended_ones), mended_ones]
        error, replaced = (fit(model, s, nuisances, noise=noise).rms for s in seen)
        parts.append(replaced / error)
    return min(parts)


def _where_sliding(as_read: Sequence[ForceBalance], repaired: Sequence[ForceBalance]) -> list[ForceBalance]:
    """Return balances of readings as they were, where the joint slides: a stray reading turns a motion round in its window."""
    return [
        dataclasses.replace(raw, sliding=better.sliding) if len(raw.sliding) == len(better.sliding) else raw
        for raw, better in zip(as_read, repaired, strict=True)
    ]


def _with_readings(place: PlaceOutcome, as_read: Balances) -> PlaceOutcome:
    """Return a place whose errors without effects are those of the readings as they were, seen through the same windows."""
    width = round(float(np.median([s.window.half_width / s.window.interval for s in place.test])))
    seen = [as_read.balances(place.place, role, as_read.stated_delay, width) for role in ("fit", "test")]
    seen = [_where_sliding(*pair) for pair in zip(seen, (place.fit, place.test), strict=True)]
    if not all(any(s.sliding.any() for s in some) for some in seen):
        return place
    fitted = fit(place.stated, seen[0], place.nuisances, noise=place.stated.law.mu_k * place.stated.load).model
    errors: dict[str, Score] = {}
    for label, model in (("baseline", place.stated), ("recalibrated", fitted)):
        rest = np.concatenate([model.remainder(s, place.nuisances)[s.sliding] for s in seen[1]])
        errors[label] = dataclasses.replace(place.scores[label], sliding=rms(rest))
    return dataclasses.replace(place, scores=dict(place.scores) | errors)


def _fits_better(before: Sequence[PlaceOutcome], after: Sequence[PlaceOutcome]) -> bool:
    """Return whether places are explained better with a column brought forward, where most is left."""
    names = {p.place: p for p in after}
    worst = max(before, key=lambda p: p.selected.final.rms / p.floor)
    plain, late = worst.selected, names[worst.place].selected
    n = max(late.final.independent, 4.0)
    evidence = 2.0 * n * float(np.log(plain.final.rms / late.final.rms)) - float(np.log(n))
    share = share_by_delay(plain.recalibrated, late.final, names[worst.place].fit, worst.nuisances)
    return evidence > NAMED and share >= criteria.EXPLAINED_AT_JOINTS


def _require_controller(scenario: Scenario[Any]) -> None:
    """Return if a controller, if any, is one of the mechanism's.

    Raises:
        InputError: it is not.
    """
    controller, kind = scenario.controller, scenario.mechanism.kind
    if controller is not None and kind != CONTROLLED[controller.kind]:
        raise InputError(
            f"controller {controller.kind!r} cannot drive mechanism {kind!r}: it drives {CONTROLLED[controller.kind]}; write "
            "the rig as that mechanism, or leave [controller] out"
        )


def require_usable(dataset: Dataset) -> None:
    """Return if friction can be estimated from the runs of a dataset.

    Raises:
        InputError: another mechanism, a missing channel or model file, a joint that hardly slides, or a drive whose sign is
            wrong.
    """
    if isinstance(dataset.scenario.mechanism, SpringSlider):
        from stochfric_mb.discovery.velocity_step.velocity_steps import track_of

        for run in dataset.runs:
            track_of(run, dataset)
        return
    _require_controller(dataset.scenario)
    better, readings = mended(dataset)
    source = source_of(dataset)
    if readings:
        repaired = source_of(better)
        left = _left_by(source, repaired, {name: _stated(source, name) for name in source.places})
        source = repaired if left < 1.0 - criteria.MATERIAL else source
    _require_sliding(source)
    for name in source.places:
        require_dissipation(dataset, name, source.balances(name, "fit", source.stated_delay))


def _outcome(
    source: Balances, tell: Progress, readings: Sequence[Effect], said: Sequence[str], as_read: Balances | None
) -> JointOutcome:
    """Return the outcome of a dataset.

    Args:
        source: its balances, with wrong readings replaced.
        tell: called with what is being done.
        readings: effects that those mean.
        said: what the reader should know already.
        as_read: balances with the readings as they were, where replacing these explains more than it leaves.
    """
    _require_sliding(source)
    notes = [*said]
    places = _places(source, tell, notes)
    channel = late_channel(source, places)
    if channel is not None:
        moved = source_of(brought_forward(source.dataset, channel[0], channel[1].seconds))
        after = _places(moved, tell, [], timed=False)
        if _fits_better(places, after):
            source = moved
            before = {p.place: {k: p.scores[k] for k in ("baseline", "recalibrated")} for p in places}
            places = [dataclasses.replace(p, scores=p.scores | before[p.place]) for p in after]
        else:
            channel = None
    dataset = source.dataset
    places.sort(key=_evidence)
    places, floor = _adequate(source, tell, places)
    places = [with_idle(dataclasses.replace(p, mended=bool(readings))) for p in places]
    # an answer with a name has no term without one
    places[0] = with_unnamed(dataset, places[0]) if as_read is None else _with_readings(places[0], as_read)
    notes += _run_notes(dataset) + _not_corrected(source)
    result = verdict(dataset, places, notes, floor, readings, channel, mostly=as_read is not None)
    pictures = tuple(map(friction_picture, places))
    scenario = augmented(dataset.scenario, places, readings)
    return JointOutcome(result, scenario, dataset, places=tuple(places), pictures=pictures)


def _adequate(source: Balances, tell: Progress, places: Sequence[PlaceOutcome]) -> tuple[list[PlaceOutcome], float | None]:
    """Return the places simulated, the first one with the first of its answers that is adequate, and the noise of the drive.

    One effect is asked for in the place of two that draw one curve: what is of neither kind would be named by chance then, as
    what is left of a series would.
    """
    first = seen = simulated(source, tell, places)
    stages: tuple[Stage, ...] = ()
    without = frozenset[str]()
    for _ in range(ANSWERS - 1):
        place = seen[0][0]
        if not inadequate(place) or place.again is None or endless(place):
            break
        couple, instead = drawn_by_two(place), drawn_by_one(place)
        if couple and not instead:
            break
        without |= instead or {_leads(place)}
        other = place.again(without)
        if not (other.selected.named or other.late) or (couple and not set(couple).intersection(other.selected.named)):
            break
        stages += place.selected.stages
        seen = simulated(source, tell, [other, *places[1:]])
    best, floor = first if inadequate(seen[0][0]) else seen
    if inadequate(best[0]) and best[0].late and best[0].again is not None:  # a delay beside effects that do not stand
        best, floor = simulated(source, tell, [best[0].again(frozenset({kind_with_signature(LATE)})), *best[1:]])
    best, floor = _less_refuted_delay(source, tell, best, floor)
    return [dataclasses.replace(best[0], beside=stages), *best[1:]], floor


def _less_refuted_delay(
    source: Balances, tell: Progress, best: list[PlaceOutcome], floor: float | None
) -> tuple[list[PlaceOutcome], float | None]:
    """Return the places without a delay beside effects that simulate held-out runs better alone, and the noise of the drive.

    Windows are explained better by what brings their times forward, too, narrow ones above all; a simulation shows what a delay
    does to all of a run.
    """
    place = best[0]
    if not (place.late and place.selected.named) or place.again is None:
        return best, floor
    other, noise = simulated(source, tell, [place.again(frozenset({kind_with_signature(LATE)})), *best[1:]])
    late, plain = (p.scores["augmented"] for p in (place, other[0]))
    simulated_ones = [
        (a, b) for a, b in ((late.loop, plain.loop), (late.forward, plain.forward)) if a is not None and b is not None
    ]
    pairs = simulated_ones or [(late.sliding, plain.sliding)]  # nothing simulates a load that moves by itself
    refuted = all(b < (1.0 - criteria.MATERIAL) * a for a, b in pairs)
    return (other, noise) if refuted and other[0].selected.named and not inadequate(other[0]) else (best, floor)


def _leads(place: PlaceOutcome) -> str:
    """Return what led to the answer at a place: its first name, or a delay beside it that explains more."""
    effects = place.selected.effects
    late = place.timing is not None and place.late and (not effects or place.timing.score > effects[0].score)
    if late:
        return kind_with_signature(LATE)
    return effects[0].candidate.name if effects else place.selected.named[0]


def _evidence(place: PlaceOutcome) -> float:
    """Return minus the evidence at a place, for sorting."""
    return -sum(max(t.score, 0.0) for t in place.selected.effects)


def _places(source: Any, tell: Progress, notes: list[str], *, timed: bool = True) -> list[PlaceOutcome]:
    """Return the outcomes at all places; arguments as of `place_outcome`.

    Where friction in one enters another's balance they are judged anew beside the one with the most evidence.
    """
    places = [place_outcome(source, tell, name, notes, timed=timed) for name in source.places]
    names = [name for name in source.places if source.coupled(name)]
    if not names or not any(p.selected.effects for p in places):
        return places
    outcomes = dict(zip(source.places, places, strict=True))
    first = min(outcomes, key=lambda name: _evidence(outcomes[name]))
    source.known.update({name: p.selected.recalibrated.model for name, p in outcomes.items()})
    source.known[first] = outcomes[first].selected.final.model
    for name in names:
        if name != first:
            outcomes[name] = place_outcome(source, tell, name, [])
            source.known[name] = outcomes[name].selected.final.model
    return list(outcomes.values())


def _require_sliding(source: Balances) -> None:
    """Return if every place slides in the runs of both roles.

    Raises:
        InputError: one hardly does.
    """
    found = _hardly_sliding(source)
    if found is not None:
        name, role, balances = found
        runs = ", ".join(s.run for s in balances)
        where = f"joint {name!r}" if name else "the joint"
        raise InputError(
            f"{where} slides one way in only {_windows(balances)} windows of the runs with role {role!r} ({runs}); at least "
            f"{FEWEST} are needed: record longer or livelier motion, or check units and columns of position and drive"
            f"{_widened(balances, source.dataset.scenario.law.mu_k * source.places[name])}"
        )


def _widened(balances: Sequence[ForceBalance], friction: float) -> str:
    """Return how wide the widest windows are, and whose noise made them so; empty: they are the narrowest.

    Args:
        balances: the balances of a place.
        friction: what is stated of its friction [N or N m].
    """
    widest = max(balances, key=lambda b: b.window.half_width)
    seen = widest.window
    narrow = dataclasses.replace(seen, half_width=least_width(seen.count) * seen.interval)
    if not widest.white or seen.half_width <= narrow.half_width:
        return ""
    noise = {derivative: narrow.gain(derivative) * size for derivative, size in widest.white.items()}
    loudest = max(noise, key=lambda derivative: noise[derivative])
    wide, least = (2.0 * window.half_width for window in (seen, narrow))
    return (
        f". Its windows are up to {wide:.2g} s wide ({least:.2g} s without noise), and it has to slide one way through all of "
        f"one: in narrow ones the noise of the {'position' if loudest else 'drive'} is {noise[loudest]:.3g} {widest.unit}, "
        f"beside {friction:.3g} {widest.unit} of friction; record it with less noise (a controller that chatters is part of "
        "that), or slides that last longer"
    )


def _hardly_sliding(source: Balances) -> tuple[str, str, list[ForceBalance]] | None:
    """Return a place that slides in too few windows of the runs of a role, with these; None: there is none."""
    for name, role in itertools.product(source.places, ("fit", "test")):
        balances = source.balances(name, role, source.stated_delay)
        if _windows(balances) < FEWEST:
            return name, role, balances
    return None


def _windows(balances: Sequence[ForceBalance]) -> int:
    return sum(int(s.sliding.sum()) for s in balances)


def _not_corrected(source: Balances) -> list[str]:
    """Return that an uncertainty is stated of numbers of the mechanism that no data correct, if one is."""
    mechanism, doubts = source.dataset.scenario.mechanism, source.dataset.scenario.uncertainty
    corrected = dict.fromkeys(n.name for place in source.places for n in source.nuisances(place))
    idle = [name for name, doubt in doubts.items() if doubt > 0.0 and name not in corrected and hasattr(mechanism, name)]
    if not idle:
        return []
    zero = [name for name in idle if name not in ABSOLUTE and getattr(mechanism, name) == 0.0]
    why = f" (of {', '.join(zero)} = 0 any share is 0: state another value)" if zero else ""
    return [
        f"the uncertainty of {', '.join(idle)} is not used{why}, and what is stated is taken as exact: records correct "
        f"{', '.join(corrected) or 'nothing'} here, and friction by mu_k"
    ]


def _run_notes(dataset: Dataset) -> list[str]:
    """Return what the reader of results should know about the runs; what several runs share is said once."""
    groups: dict[str, list[str]] = {}
    for run in dataset.runs:
        for note in run.notes:
            groups.setdefault(note.partition(" (")[0], []).append(f"{run.name}: {note}")
    return [notes[0] if len(notes) == 1 else f"{len(notes)} runs, such as {notes[0]}" for notes in groups.values()]
