"""Discovery at driven joints: timing, then friction effects one by one, then the score on held-out runs."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.late_channel import brought_forward, late_channel
from stochfric_mb.discovery.driven_joint.balance.readings import mended
from stochfric_mb.discovery.driven_joint.balance.timing import NAMED
from stochfric_mb.discovery.driven_joint.decision.adequacy import drawn_by_one, drawn_by_two, endless, inadequate
from stochfric_mb.discovery.driven_joint.decision.carry_over import with_idle, with_unnamed
from stochfric_mb.discovery.driven_joint.decision.selection import Stage
from stochfric_mb.discovery.driven_joint.decision.signs import require_dissipation
from stochfric_mb.discovery.driven_joint.decision.verdict import verdict
from stochfric_mb.discovery.driven_joint.delay import share_by_delay
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome, PlaceOutcome
from stochfric_mb.discovery.driven_joint.place import place_outcome
from stochfric_mb.discovery.driven_joint.replaced_readings import as_named, as_stated, error_kept, with_readings
from stochfric_mb.discovery.driven_joint.simulation.augmented import augmented
from stochfric_mb.discovery.driven_joint.simulation.controller_check import controller_misfit, disbelieved
from stochfric_mb.discovery.driven_joint.simulation.pictures import friction_picture
from stochfric_mb.discovery.driven_joint.simulation.resimulation import simulated
from stochfric_mb.discovery.driven_joint.sliding import require_sliding
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import Effect, kind_with_signature
from stochfric_mb.effects.traits import LATE
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Cascade, Mjcf, PrismaticJoint, ProportionalDerivative, SpringSlider
from stochfric_mb.scenario import ABSOLUTE, Scenario

Progress = Callable[[str], None]
Simulated = tuple[list[PlaceOutcome], float | None]
"""Places with their simulations, and the noise of the drive."""
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
    left = error_kept(as_read, repaired, {name: as_stated(as_read, name) for name in as_read.places})
    if left >= 1.0 - criteria.MATERIAL:  # beside the stated model they matter little, but perhaps beside what it lacks
        outcome = _outcome(as_read, tell, (), notes, None)
        found = {p.place: as_named(p) for p in outcome.places}
        if error_kept(as_read, repaired, found, {p.place: p.late for p in outcome.places}) >= 1.0 - criteria.MATERIAL:
            return outcome
    mostly = left**2 <= 1.0 - criteria.EXPLAINED_HELD_OUT
    return _outcome(repaired, tell, readings, notes, as_read if mostly else None)


def _fits_better(before: Sequence[PlaceOutcome], after: Sequence[PlaceOutcome]) -> bool:
    """Return whether places are explained better with a column brought forward, where most is left."""
    names = {p.place: p for p in after}
    worst = max(before, key=lambda p: p.selected.final.rms / p.floor)
    plain, late = worst.selected, names[worst.place].selected
    n = late.final.n
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
        left = error_kept(source, repaired, {name: as_stated(source, name) for name in source.places})
        source = repaired if left < 1.0 - criteria.MATERIAL else source
    require_sliding(source)
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
    require_sliding(source)
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
    places[0] = with_unnamed(dataset, places[0]) if as_read is None else with_readings(places[0], as_read)
    notes += _run_notes(dataset) + _not_corrected(source)
    result = verdict(dataset, places, notes, floor, readings, channel, mostly=as_read is not None)
    pictures = tuple(map(friction_picture, places))
    scenario = augmented(dataset.scenario, places, readings)
    return JointOutcome(result, scenario, dataset, places=tuple(places), pictures=pictures)


def _adequate(source: Balances, tell: Progress, places: Sequence[PlaceOutcome]) -> Simulated:
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


def _less_refuted_delay(source: Balances, tell: Progress, best: list[PlaceOutcome], floor: float | None) -> Simulated:
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
