"""Discovery at driven joints: timing, then friction effects one by one, then the score on held-out runs."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.late_channel import brought_forward, late_channel
from stochfric_mb.discovery.driven_joint.balance.readings import Readings, mended
from stochfric_mb.discovery.driven_joint.balance.timing import NAMED, Timing, timing
from stochfric_mb.discovery.driven_joint.decision.carry_over import with_idle, with_unnamed
from stochfric_mb.discovery.driven_joint.decision.run_scatter import Forecasts, crps_of, run_scatter
from stochfric_mb.discovery.driven_joint.decision.selection import MATERIAL, Selected, Selector
from stochfric_mb.discovery.driven_joint.decision.signs import sign_notes
from stochfric_mb.discovery.driven_joint.decision.stroke_coefficients import dependence
from stochfric_mb.discovery.driven_joint.decision.stroke_scatter import stroke_scatter
from stochfric_mb.discovery.driven_joint.decision.verdict import verdict
from stochfric_mb.discovery.driven_joint.fit.fitting import fit, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome, PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.augmented import augmented, believed_delay, believed_scatter
from stochfric_mb.discovery.driven_joint.simulation.pictures import friction_picture
from stochfric_mb.discovery.driven_joint.simulation.resimulation import simulated
from stochfric_mb.discovery.driven_joint.simulation.scores import noise_floor, score
from stochfric_mb.discovery.driven_joint.source import prior_model, source_of
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.result import Result
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Cascade, Mjcf, PrismaticJoint, ProportionalDerivative, SpringSlider
from stochfric_mb.scenario import Scenario

Progress = Callable[[str], None]
FEWEST = 8
"""Fewest windows of sliding in the runs of a role: fewer say nothing about friction."""
CONTROLLED = {Cascade.kind: PrismaticJoint.kind, ProportionalDerivative.kind: Mjcf.kind}
"""Controller -> the mechanism that it drives."""


def discover_joint(dataset: Dataset, *, progress: Progress | None = None) -> Result:
    """Return what the data of a driven joint say that its model lacks; see `joint_outcome`."""
    return joint_outcome(dataset, progress=progress).result


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
    better, readings = mended(dataset)
    if readings.effects and _quieter(dataset, better):
        return _outcome(better, tell, source_of(better), readings)
    return _outcome(dataset, tell, source_of(dataset), Readings())


def _quieter(given: Dataset, better: Dataset) -> bool:
    """Return whether the balance of a place errs less, by a material part, with wrong readings replaced, seen alike."""
    base, (as_given, repaired) = believed_delay(given.scenario), (source_of(x) for x in (given, better))
    for name, load in as_given.places:
        before = as_given.balances(name, "fit", base)
        width = round(float(np.median([s.window.half_width / s.window.interval for s in before])))
        nuisances = as_given.nuisances(name)
        model = prior_model(given.scenario, name, nuisances, load)
        seen = [s.balances(name, "fit", base, width) for s in (as_given, repaired)]
        raw, replaced = (fit(model, s, nuisances, noise=model.law.mu_k * load).rms for s in seen)
        if replaced < (1.0 - MATERIAL) * raw:
            return True
    return False


def _brought_forward(
    dataset: Dataset, tell: Progress, channel: tuple[str, Timing], base: float
) -> tuple[Dataset, Any, list[PlaceOutcome]]:
    """Return a dataset with a late column brought forward, its balances, and what is found in them."""
    dataset = brought_forward(dataset, channel[0], channel[1].seconds)
    source = source_of(dataset)
    places = [_place(dataset, tell, source, name, load, base, [], timed=False) for name, load in source.places]
    return dataset, source, _beside(dataset, tell, source, places, base)


def _fits_better(before: Sequence[PlaceOutcome], after: Sequence[PlaceOutcome]) -> bool:
    """Return whether places are explained better with a column brought forward, where most is left."""
    names = {p.place: p for p in after}
    worst = max(before, key=lambda p: p.selected.final.rms / p.floor)
    plain, late = worst.selected, names[worst.place].selected
    n = max(late.final.independent, 4.0)
    evidence = 2.0 * n * float(np.log(plain.final.rms / late.final.rms)) - float(np.log(n))
    return evidence > NAMED and _share(plain, late, names[worst.place].fit, worst.nuisances) >= criteria.EXPLAINED_AT_JOINTS


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
        InputError: another mechanism, a missing channel or model file, or a joint that hardly slides.
    """
    if isinstance(dataset.scenario.mechanism, SpringSlider):
        from stochfric_mb.discovery.velocity_step.velocity_steps import track_of

        for run in dataset.runs:
            track_of(run, dataset)
        return
    _require_controller(dataset.scenario)
    _require_sliding_at_places(dataset, source_of(dataset))


def _require_sliding_at_places(dataset: Dataset, source: Any) -> None:
    for name, _ in source.places:
        for role in ("fit", "test"):
            _require_sliding(source.balances(name, role, believed_delay(dataset.scenario)), name, role)


def _outcome(dataset: Dataset, tell: Progress, source: Any, readings: Readings) -> JointOutcome:
    _require_sliding_at_places(dataset, source)
    notes: list[str] = []
    base = believed_delay(dataset.scenario)
    places = [_place(dataset, tell, source, name, load, base, notes) for name, load in source.places]
    places = _beside(dataset, tell, source, places, base)
    channel = late_channel(dataset, source, places, base)
    if channel is not None:
        again = _brought_forward(dataset, tell, channel, base)
        if _fits_better(places, again[2]):
            dataset, source, after = again
            before = {p.place: {k: p.scores[k] for k in ("baseline", "recalibrated")} for p in places}
            places = [dataclasses.replace(p, scores=p.scores | before[p.place]) for p in after]
        else:
            channel = None
    places.sort(key=_evidence)
    found = places[0].timing
    places, floor = simulated(dataset, tell, source, places, (base, base + places[0].late))
    places[0] = with_unnamed(dataset, with_idle(places[0]))
    notes += _run_notes(dataset)
    result = verdict(dataset, places, notes, floor, readings.effects, channel)
    pictures = tuple(
        friction_picture(
            p.place and f"{p.thing} {p.place}",
            p.test,
            p.nuisances,
            p.selected.recalibrated.model,
            with_phases(p.selected.final.model, p.test),
        )
        for p in places
    )
    scenario = augmented(dataset.scenario, places, found, readings.effects)
    return JointOutcome(result, scenario, dataset, places=tuple(places), pictures=pictures)


def _evidence(place: PlaceOutcome) -> float:
    """Return minus the evidence found at a place, for sorting."""
    return -sum(max(t.score, 0.0) for t in place.selected.found)


def _beside(dataset: Dataset, tell: Progress, source: Any, places: list[PlaceOutcome], base: float) -> list[PlaceOutcome]:
    """Return the places anew, judged beside the one with the most evidence, where friction in one enters another's balance."""
    names = [(p, load) for p, load in source.places if isinstance(dataset.scenario.mechanism, Mjcf) and source.coupled(p)]
    found = {name: place for (name, _), place in zip(source.places, places, strict=True)}
    if not names or not any(p.selected.found for p in places):
        return places
    first = min(found, key=lambda name: _evidence(found[name]))
    source.known.update({name: p.selected.recalibrated.model for name, p in found.items()})
    source.known[first] = found[first].selected.final.model
    for name, load in names:
        if name != first:
            found[name] = _place(dataset, tell, source, name, load, base, [])
            source.known[name] = found[name].selected.final.model
    return [found[name] for name, _ in source.places]


def _place(
    dataset: Dataset,
    tell: Progress,
    source: Any,
    name: str,
    load: float,
    base: float,
    notes: list[str],
    *,
    timed: bool = True,
) -> PlaceOutcome:
    scenario = dataset.scenario
    nuisances = source.nuisances(name)
    believed = prior_model(scenario, name, nuisances, load)
    fit_balances = source.balances(name, "fit", base)
    notes += sign_notes(dataset, name, load, fit_balances)
    where = f"{name}: " if name else ""
    selected = Selector(fit_balances, nuisances, believed, lambda text: tell(where + text)).run()
    undelayed, found = None, None
    if timed:
        found = _timing(dataset, tell, source, name, base, fit_balances)
    if found is not None:
        balances = source.balances(name, "fit", base + found.seconds)
        late = Selector(balances, nuisances, believed, lambda text: tell(f"{where}{text}, a delay compensated")).run()
        narrow = [source.balances(name, "fit", d, found.half_width) for d in (base, base + found.seconds)]
        found = found.beside(_better(selected, late, narrow, nuisances))
        if found.named:  # what was believed knows nothing of the delay that was found
            undelayed, selected, fit_balances = selected.recalibrated.model, late, balances
    delay = base + (found.seconds if found is not None and found.named else 0.0)
    test_balances = source.balances(name, "test", delay)
    tell(f"{where}held-out runs")
    scores = {
        label: score(model, test_balances, nuisances, dataset.test, scenario)
        for label, model in _models(believed, selected).items()
    }
    if undelayed is not None:
        early = source.balances(name, "test", base)
        scores["baseline"] = score(believed, early, nuisances, dataset.test, scenario)
        scores["recalibrated"] = score(undelayed, early, nuisances, dataset.test, scenario)
    final = with_phases(selected.final.model, test_balances)
    # where something without a name is missing from the mean, strokes differ for that
    random = (
        None if selected.unknown else stroke_scatter(final, fit_balances, nuisances, believed_scatter(scenario, "per_event"))
    )
    noise = floor = noise_floor(final, test_balances, nuisances)
    if random is not None and random.accounted:
        floor = float(np.hypot(floor, random.sigma * _rms_dependence(final, test_balances)))
    kinds = {"tendon": getattr(scenario.mechanism, "tendons", ()), "pair": getattr(scenario.mechanism, "pairs", ())}
    thing = next((kind for kind, names in kinds.items() if name in names), "joint")
    runs = None if selected.unknown else run_scatter(final, fit_balances, nuisances, believed_scatter(scenario, "per_run"))
    forecasts = None
    if runs is not None and runs.accounted:
        models = (believed, runs.believed), (selected.recalibrated.model, runs.believed), (final, runs.foreseen)
        each = [crps_of(m, test_balances, nuisances, noise, sigma) for m, sigma in models]
        forecasts = Forecasts(*(score for score, _ in each), floor=each[-1][1])
    seen = tuple(fit_balances), tuple(test_balances)
    return PlaceOutcome(
        name,
        selected,
        tuple(nuisances),
        believed,
        *seen,
        scores,
        floor,
        thing,
        random,
        runs,
        forecasts,
        undelayed,
        timing=found,
    )


def _require_sliding(balances: Sequence[ForceBalance], name: str, role: str) -> None:
    """Return if the joint slides in the runs of a role.

    Raises:
        InputError: it hardly does.
    """
    windows = sum(int(s.sliding.sum()) for s in balances)
    if windows < FEWEST:
        runs = ", ".join(s.run for s in balances)
        where = f"joint {name!r}" if name else "the joint"
        raise InputError(
            f"{where} slides one way in only {windows} windows of the runs with role {role!r} ({runs}); at least {FEWEST} are "
            "needed: record longer or livelier motion, or check the unit of position"
        )


def _timing(
    dataset: Dataset, tell: Progress, source: Any, name: str, base: float, balances: Sequence[ForceBalance]
) -> Timing | None:
    """Return by how much the motion at a place may come late; None: it does not, or nothing could be late."""
    mechanism = dataset.scenario.mechanism
    if isinstance(mechanism, PrismaticJoint) and mechanism.mass <= 0.0:
        return None  # a slow prescribed motion has no inertia by which it could be late
    tell("timing")
    half_width = float(np.median([s.window.half_width for s in balances]))
    return timing(
        lambda d, w: source.balances(name, "fit", base + d, w),
        source.nuisances(name),
        dataset.fit[0].sample_interval,
        half_width,
    )


def _better(
    plain: Selected, late: Selected, balances: Sequence[Sequence[ForceBalance]], nuisances: Sequence[Nuisance]
) -> float:
    """Return the evidence for a delay: by how much the record is explained better with it, numbers counted.

    Args:
        plain: what was selected without it.
        late: the same with it compensated.
        balances: without and with it, through the window that shows it: friction may need a wider one.
        nuisances: numbers of the mechanism.
    """
    models = plain.final.model, late.final.model
    before, after = (
        fit(model, seen, nuisances, noise=prior_weight(selected.final))
        for model, seen, selected in zip(models, balances, (plain, late), strict=True)
    )
    n = max(sum(map(independent_count, after.remainders)), 4.0)  # timing shows within strokes, too
    more = len(after.free) - len(before.free) + 1
    gain = float(np.log(before.rms / after.rms))
    if more < 0 and gain > np.log(1.0 - MATERIAL):
        gain = max(gain, 0.0)  # effects that leave less by no material part explain no more than the delay, which is simpler
    return float(2.0 * n * gain + before.strain - after.strain - more * np.log(n))


def _share(plain: Selected, late: Selected, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]) -> float:
    """Return the share of what stands above the noise that a delay, with what was selected beside it, closes [-]."""
    floor = min(noise_floor(late.final.model, balances, nuisances), late.final.rms)
    before = plain.recalibrated.rms
    return (before**2 - late.final.rms**2) / max(before**2 - floor**2, 1.0e-300)


def _models(believed: JointModel, selected: Selected) -> dict[str, JointModel]:
    models = {"baseline": believed, "recalibrated": selected.recalibrated.model}
    models |= {f"with {t.candidate.kind}": t.fit.model for t in selected.found}
    return models | {"augmented": selected.final.model}


def _run_notes(dataset: Dataset) -> list[str]:
    """Return what the reader of results should know about the runs; what several runs share is said once."""
    groups: dict[str, list[str]] = {}
    for run in dataset.runs:
        for note in run.notes:
            groups.setdefault(note.partition(" (")[0], []).append(f"{run.name}: {note}")
    return [
        notes[0] if len(notes) == 1 else f"{len(notes)} runs: {kind} (such as {notes[0]})" for kind, notes in groups.items()
    ]


def _rms_dependence(model: JointModel, balances: Sequence[ForceBalance]) -> float:
    """Return the change of friction with mu_k, rms over the windows of sliding [N or N m]."""
    return float(np.sqrt(np.mean(np.concatenate([dependence(model, s)[s.sliding] for s in balances]) ** 2)))
