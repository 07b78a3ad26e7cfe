"""What a reader should know beside the verdict: the sensor, the belt, what was refused, where an effect shows."""

from __future__ import annotations

import itertools
from typing import Any

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.advice import FORCE
from stochfric_mb.discovery.stick_slip.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.decision import Decision
from stochfric_mb.discovery.stick_slip.records.long_records import FORECAST, SIMULATED
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.prior_model import NOT_STATED
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.discovery.stick_slip.validation.explained import MORE_MISSING
from stochfric_mb.discovery.stick_slip.validation.feature_skill import Gaps
from stochfric_mb.effects import effect_class, kind_with_signature
from stochfric_mb.effects.traits import BELT, CLIPPED, CREEPING_ZERO, YIELDING
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.scales import load_in_kilograms

NOT_IN_AUGMENTED = "not_in_augmented"
"""Name under which the details hold the effects that augmented.toml does not."""


def notes(study: Study, decision: Decision, model: Model, gaps: Gaps, given: Dataset) -> tuple[str, ...]:
    """Return the notes of a result.

    Args:
        study: what the fit runs show.
        decision: what was decided, with the numbers behind it.
        model: the augmented model.
        gaps: errors on the held-out runs.
        given: the data set as it was given, its uncertainties not assumed.
    """
    details: dict[str, Any] = decision.details
    beyond = details["parameters"]["moved_beyond_uncertainty"]
    seen = {kind_with_signature(s) for s in (CLIPPED, CREEPING_ZERO, YIELDING)}  # while the box sticks
    return (
        *of_the_record(study, varies=any(n.kind in seen or BELT in effect_class(n.kind).traits for n in decision.named)),
        *(
            f"{kind} is not validated on the held-out runs: error {seen['with_']:.3g} m with it, "
            f"{seen['without']:.3g} m without"
            for kind, seen in details.get("not_borne_out", {}).items()
        ),
        *(gaps.forecasts.notes if gaps.forecasts is not None else ()),
        *(details[key] for key in (MORE_MISSING, "unnamed_term") if key in details),
        *not_simulated(model),
        *_of_several_tones(model),
        *_of_one_pace(model, study),
        *_seen_in_forces(gaps.forecasts, gaps.forces),
        *([] if MORE_MISSING in details or not decision.named else _left_in_forces(gaps.forces)),
        *(f"{name} is {abs(by):.2g} stated standard deviations off from what is stated" for name, by in beyond.items()),
        *filter(None, [_in_kilograms(model, given)]),
        *([] if given.scenario.uncertainty else [NOT_STATED]),
    )


def _in_kilograms(model: Model, given: Dataset) -> str:
    """Return that the normal force is probably a mass in kg; empty where the coefficients of friction do not say so."""
    scenario = given.scenario
    load = given.fit[0].mechanism(scenario).normal_force
    return load_in_kilograms((model.law.mu_s, model.law.mu_k), (scenario.law.mu_s, scenario.law.mu_k), load)


def _of_several_tones(model: Model) -> list[str]:
    """Return which effects are waves of several tones: the numbers of an effect are those of the first one."""
    rates: dict[str, list[float]] = {}
    for effect in model.effects:
        if effect.own_to_run and hasattr(effect, "frequency"):
            rates.setdefault(effect.kind, []).append(float(effect.frequency))  # pyright: ignore[reportAttributeAccessIssue]
    return [
        f"{kind} is a wave of {len(tones)} tones, {', '.join(f'{f:.4g}' for f in tones)} Hz: the numbers are those of the "
        "first one, all tones stand in augmented.toml"
        for kind, tones in rates.items()
        if len(tones) > 1
    ]


def _of_one_pace(model: Model, study: Study) -> list[str]:
    """Return which waves of two kinds have one frequency: a single cause, a gain of the sensor too, may be behind both."""
    waves = [(e.kind, float(getattr(e, "frequency", 0.0))) for e in model.effects if e.own_to_run]
    pairs = ((a, b) for a, b in itertools.combinations(waves, 2) if a[0] != b[0] and min(a[1], b[1]) > 0.0)
    return [
        f"{one} and {other} have one frequency, {pace:.3g} Hz: a single cause may be behind both, the gain of a sensor that "
        "sways as well as a drive that is out of true"
        for (one, pace), (other, beside) in pairs
        if abs(pace - beside) < 1.0 / study.pool.duration
    ]


def not_simulated(model: Model) -> list[str]:
    """Return which effects read what a simulated belt-box does not have."""
    return [
        f"{effect.kind} reads a measured {effect.reads[0]}, which a simulated belt-box has not: it is not in augmented.toml, "
        f"all its numbers stand in result.json, in details.{NOT_IN_AUGMENTED}"
        for effect in model.effects
        if effect.reads
    ]


def not_in_augmented(model: Model) -> dict[str, object]:
    """Return these effects with their numbers, under their name in the details; empty where there are none."""
    elsewhere = [effect.given() for effect in model.effects if effect.reads]
    return {NOT_IN_AUGMENTED: elsewhere} if elsewhere else {}


def of_the_record(study: Study, *, varies: bool = False) -> list[str]:
    """Return what to know of the fit runs: which are not used, outliers, noise, length, the belt's speed.

    Args:
        study: what the fit runs show.
        varies: whether the belt's speed is known to vary, or the reading not to follow the stuck box: slips that keep step
            with a belt do not stick at its mean, and a reading that clips or drifts is no measure of it.
    """
    used = {slips.record.name for slips in study.pool.slips}
    said = [
        f"run {record.name} is not used: it holds fewer than {criteria.FEWEST_OF_RUN} slips (a dead sensor, a rig at rest, or "
        "steady sliding)"
        for record in study.records
        if record.name not in used
    ]
    if study.outliers > 0.0:
        said.append(f"{study.outliers:.2e} of the samples were outliers and were replaced by a running median")
    colour = max((s.noise for s in study.pool.slips), key=lambda n: n.coloured)
    if colour.coloured > 0.0:
        said.append(f"the sensor's noise is coloured: {colour.coloured:.2g} m with a memory of {colour.memory:.2f} a sample")
    if (most := max(map(len, study.pool.slips))) > SIMULATED:
        said.append(
            f"long records: all {len(study.pool.run)} slips count; what is simulated stands for {SIMULATED} slips in the "
            f"middle of a run, and {min(most, FORECAST)} forecasts of a run are scored, spread evenly"
        )
    if any(FORCE in run.channels for run in study.dataset.fit):
        said.append(f"the column {FORCE} is read and not used: forces follow from the measured motion and the stated spring")
    if study.belt != 1.0:
        said.append(
            f"in stick the box moves at {study.belt:.3f} times the stated belt velocity in all runs, and forces are taken at "
            "that speed: check the belt velocity, or the scale of the position (of a load cell, over the stiffness), by which "
            "coefficients are then off as well"
        )
    if not varies and (belt := belt_speed(study)) is not None:
        said.append(belt.note)
    return said


def _left_in_forces(forces: Gap | None) -> list[str]:
    """Return that what is named is not all, where the forces of held-out slips say so.

    Forecasts follow what friction does on average, and not how it varies within a slip.
    """
    if forces is None or not forces.augmented > criteria.LEFT_IN_FORCES * forces.floor:
        return []
    return [
        f"the forces of held-out slips are off by {forces.augmented:.3g} times their noise with what is named, "
        f"{forces.recalibrated:.3g} without it, {forces.floor:.3g} if the model "
        "were true: more is missing, or a number is farther off than its interval says"
    ]


def _seen_in_forces(gap: Gap | None, forces: Gap | None) -> tuple[str, ...]:
    """Return where an effect shows that one-cycle forecasts of the position do not show."""
    if gap is None or gap.closed is not None or forces is None or forces.closed is None:
        return ()
    return (
        f"forecasts of the position do not show the effect; the forces of held-out slips do: off by "
        f"{forces.recalibrated:.3g} times their noise without it, {forces.augmented:.3g} with it, "
        f"{forces.floor:.3g} if the model is true",
    )
