"""Discovery at driven joints: timing, then friction effects one by one, then the score on held-out runs."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.late_channel import brought_forward, late_channel
from stochfric_mb.discovery.driven_joint.balance.readings import Readings, mended
from stochfric_mb.discovery.driven_joint.balance.timing import LEAST_SAMPLES, NAMED, Timing, timing
from stochfric_mb.discovery.driven_joint.decision.carry_over import with_idle, with_unnamed
from stochfric_mb.discovery.driven_joint.decision.run_scatter import Forecasts, crps_of, run_scatter
from stochfric_mb.discovery.driven_joint.decision.selection import MATERIAL, Selected, Selector
from stochfric_mb.discovery.driven_joint.decision.signs import sign_notes
from stochfric_mb.discovery.driven_joint.decision.stroke_coefficients import dependence
from stochfric_mb.discovery.driven_joint.decision.stroke_scatter import stroke_scatter
from stochfric_mb.discovery.driven_joint.decision.verdict import verdict
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome, PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.augmented import augmented, stated_delay, stated_scatter
from stochfric_mb.discovery.driven_joint.simulation.pictures import friction_picture
from stochfric_mb.discovery.driven_joint.simulation.resimulation import simulated
from stochfric_mb.discovery.driven_joint.simulation.scores import noise_floor, score
from stochfric_mb.discovery.driven_joint.source import prior_model, source_of
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.discovery.result import Result
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Cascade, Mjcf, PrismaticJoint, ProportionalDerivative, SpringSlider
from stochfric_mb.numerics.robust import deviation
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Progress = Callable[[str], None]
FEWEST = 8
"""Fewest windows of sliding in the runs of a role: fewer say nothing about friction."""
HELD = 4
"""Delays from none to that of sampling and holding that are tried."""
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
    base, (as_given, repaired) = stated_delay(given.scenario), (source_of(x) for x in (given, better))
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
    """Return a dataset with a late column brought forward, its balances, and the outcomes from them."""
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
    share = _share(plain.recalibrated, late.final, names[worst.place].fit, worst.nuisances)
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
            _require_sliding(source.balances(name, role, stated_delay(dataset.scenario)), name, role)


def _outcome(dataset: Dataset, tell: Progress, source: Any, readings: Readings) -> JointOutcome:
    _require_sliding_at_places(dataset, source)
    notes: list[str] = []
    base = stated_delay(dataset.scenario)
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
    timing = places[0].timing
    places, floor = simulated(dataset, tell, source, places, (base, base + places[0].late))
    places = [with_idle(p) for p in places]
    places[0] = with_unnamed(dataset, places[0])
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
    scenario = augmented(dataset.scenario, places, timing, readings.effects)
    return JointOutcome(result, scenario, dataset, places=tuple(places), pictures=pictures)


def _evidence(place: PlaceOutcome) -> float:
    """Return minus the evidence at a place, for sorting."""
    return -sum(max(t.score, 0.0) for t in place.selected.effects)


def _beside(dataset: Dataset, tell: Progress, source: Any, places: list[PlaceOutcome], base: float) -> list[PlaceOutcome]:
    """Return the places anew, judged beside the one with the most evidence, where friction in one enters another's balance."""
    names = [(p, load) for p, load in source.places if isinstance(dataset.scenario.mechanism, Mjcf) and source.coupled(p)]
    outcomes = {name: place for (name, _), place in zip(source.places, places, strict=True)}
    if not names or not any(p.selected.effects for p in places):
        return places
    first = min(outcomes, key=lambda name: _evidence(outcomes[name]))
    source.known.update({name: p.selected.recalibrated.model for name, p in outcomes.items()})
    source.known[first] = outcomes[first].selected.final.model
    for name, load in names:
        if name != first:
            outcomes[name] = _place(dataset, tell, source, name, load, base, [])
            source.known[name] = outcomes[name].selected.final.model
    return [outcomes[name] for name, _ in source.places]


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
    stated = prior_model(scenario, name, nuisances, load)
    fit_balances = source.balances(name, "fit", base)
    notes += sign_notes(dataset, name, load, fit_balances)
    where = f"{name}: " if name else ""
    undelayed, timing = None, _timing(dataset, tell, source, name, base, fit_balances) if timed else None
    shortest = LEAST_SAMPLES * dataset.fit[0].sample_interval
    if timing is not None and abs(timing.seconds) <= shortest:  # how signals are sampled and held
        base, timing = base + timing.seconds, None
        fit_balances = source.balances(name, "fit", base)
    selected = Selector(fit_balances, nuisances, stated, lambda text: tell(where + text)).run()
    if timing is not None:
        balances = source.balances(name, "fit", base + timing.seconds)
        late = Selector(balances, nuisances, stated, lambda text: tell(f"{where}{text}, a delay compensated")).run()
        early = base + np.linspace(0.0, np.copysign(shortest, timing.seconds), HELD)
        narrow = [source.balances(name, "fit", d, timing.half_width) for d in (*early, base + timing.seconds)]
        timing = timing.beside(*_better(selected, late, narrow, nuisances))
        if timing.named:  # the stated model knows nothing of the identified delay
            undelayed, selected, fit_balances = selected.recalibrated.model, late, balances
    delay = base + (timing.seconds if timing is not None and timing.named else 0.0)
    test_balances = source.balances(name, "test", delay)
    tell(f"{where}held-out runs")
    scores = {
        label: score(model, test_balances, nuisances, dataset.test, scenario)
        for label, model in _models(stated, selected).items()
    }
    if undelayed is not None:
        early = source.balances(name, "test", base)
        scores["baseline"] = score(stated, early, nuisances, dataset.test, scenario)
        scores["recalibrated"] = score(undelayed, early, nuisances, dataset.test, scenario)
    final = with_phases(selected.final.model, test_balances)
    # where something without a name is missing from the mean, strokes differ for that
    random = None if selected.unknown else stroke_scatter(final, fit_balances, nuisances, stated_scatter(scenario, "per_event"))
    noise = floor = noise_floor(final, test_balances, nuisances)
    if random is not None and random.accounted:
        floor = float(np.hypot(floor, random.sigma * _rms_dependence(final, test_balances)))
    kinds = {"tendon": getattr(scenario.mechanism, "tendons", ()), "pair": getattr(scenario.mechanism, "pairs", ())}
    thing = next((kind for kind, names in kinds.items() if name in names), "joint")
    runs = None if selected.unknown else run_scatter(final, fit_balances, nuisances, stated_scatter(scenario, "per_run"))
    forecasts = None
    if runs is not None and runs.accounted:
        models = (stated, runs.believed), (selected.recalibrated.model, runs.believed), (final, runs.foreseen)
        each = [crps_of(m, test_balances, nuisances, noise, sigma) for m, sigma in models]
        forecasts = Forecasts(*(score for score, _ in each), floor=each[-1][1])
    seen = tuple(fit_balances), tuple(test_balances)
    return PlaceOutcome(
        name,
        selected,
        tuple(nuisances),
        stated,
        *seen,
        scores,
        floor,
        thing,
        random,
        runs,
        forecasts,
        undelayed,
        timing=timing,
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
) -> tuple[float, bool]:
    """Return the evidence for a delay, and whether it explains more than it leaves, in loud windows and in typical ones.

    The evidence is by how much the record is explained better with it, numbers counted.

    Args:
        plain: what was selected without it.
        late: the same with it compensated.
        balances: without and with it, through the window that shows it: friction may need a wider one. The last are with it;
            those before are without, for all that sampling and holding may be late by.
        nuisances: numbers of the mechanism.
    """
    without = [fit(plain.final.model, seen, nuisances, noise=prior_weight(plain.final)) for seen in balances[:-1]]
    before = min(without, key=lambda f: f.rms)
    after = fit(late.final.model, balances[-1], nuisances, noise=prior_weight(late.final))
    n = max(sum(map(independent_count, after.remainders)), 4.0)  # timing shows within strokes, too
    more = len(after.free) - len(before.free) + 1
    gain = float(np.log(before.rms / after.rms))
    if more < 0 and gain > np.log(1.0 - MATERIAL):
        gain = max(gain, 0.0)  # effects that leave less by no material part explain no more than the delay, which is simpler
    stated = fit(plain.recalibrated.model, balances[0], nuisances, noise=prior_weight(plain.recalibrated))
    sizes = _rms, lambda rest: deviation(rest, about=0.0)
    shares = [_share(stated, after, balances[-1], nuisances, size) for size in sizes]
    evidence = 2.0 * n * gain + before.strain - after.strain - more * np.log(n)
    return float(evidence), min(shares) >= criteria.EXPLAINED_BY_DELAY


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _share(
    plain: JointFit,
    late: JointFit,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    size: Callable[[Array], float] = _rms,
) -> float:
    """Return the share of what stands above the noise that a delay, with what was selected beside it, closes [-].

    Args:
        plain: without the delay.
        late: with it.
        balances: with it.
        nuisances: numbers of the mechanism.
        size: size of what is left, in the unit of the balance.
    """
    before, after = (size(np.concatenate(fitted.remainders)) for fitted in (plain, late))
    floor = min(noise_floor(late.model, balances, nuisances), after)
    return (before**2 - after**2) / max(before**2 - floor**2, 1.0e-300)


def _models(stated: JointModel, selected: Selected) -> dict[str, JointModel]:
    models = {"baseline": stated, "recalibrated": selected.recalibrated.model}
    models |= {f"with {t.candidate.kind}": t.fit.model for t in selected.effects}
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
