"""The scenario of a driven joint with the identified effects, and its stated scatter and delay."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.balances import BESIDE
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.effects import Effect, kind_with_signature, make_effect
from stochfric_mb.effects.shapes.course import Course
from stochfric_mb.effects.traits import DRAWN_ANEW, LATE
from stochfric_mb.mechanisms import Mjcf
from stochfric_mb.scenario import Scenario


def stated_scatter(scenario: Scenario[Any], process: str) -> float:
    """Return the standard deviation of mu_k that the scenario declares, stroke by stroke or run by run [-]."""
    declared = [e.to_dict() for e in scenario.effects if DRAWN_ANEW in e.signatures]
    return float(np.sqrt(sum(e["sigma_k"] ** 2 for e in declared if e["process"] == process)))


def augmented(scenario: Scenario[Any], places: Sequence[PlaceOutcome], readings: Sequence[Effect] = ()) -> Scenario[Any]:
    """Return the scenario with the identified effects; of several joints, the first one's effects and delay, in that joint."""
    model = places[0].selected.final.model
    effects = [e.normalised() if isinstance(e, Course) else e for e in model.effects_in(places[0].fit[0].run)]
    drawn = _drawn(places[0])
    effects += [
        e
        for e in scenario.effects
        if e.group in BESIDE and LATE not in e.signatures and not (drawn and DRAWN_ANEW in e.signatures)
    ]
    if drawn:
        sigma, process = max(drawn)  # a model has one such process
        sigma_s = sigma * model.law.mu_s / model.law.mu_k
        effects.append(make_effect(kind_with_signature(DRAWN_ANEW), process=process, sigma_s=sigma_s, sigma_k=sigma))
    delay = sum(e.late for e in scenario.effects) + places[0].late
    if delay > 0.0:  # one that comes before has no effect of its own, and stays a finding
        effects.append(make_effect(kind_with_signature(LATE), delay=delay))
    return dataclasses.replace(
        scenario,
        mechanism=_corrected(scenario.mechanism, places),
        law=model.law,
        effects=(*effects, *readings),
        title=f"{scenario.title}, augmented by discovery",
    )


def _corrected(mechanism: Any, places: Sequence[PlaceOutcome]) -> Any:
    models = {p.place: p.selected.final.model for p in places}
    if not isinstance(mechanism, Mjcf):
        return dataclasses.replace(mechanism, **models[""].nuisances)
    from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import corrected

    first = places[0].selected.final.model.law.mu_k
    # one law serves all joints: where friction differs, the loads do
    friction = {name: load * models[name].law.mu_k / first for name, load in mechanism.friction.items()}
    known = corrected(mechanism, {name: model.nuisances for name, model in models.items()})
    return dataclasses.replace(known, friction=friction, effects_in=(places[0].place,))


def _drawn(place: PlaceOutcome) -> list[tuple[float, str]]:
    """Return the identified scatter: standard deviation of mu_k, and when it is drawn anew."""
    scatters = ((place.random, "per_event"), (place.runs, "per_run"))
    return [(seen.sigma, process) for seen, process in scatters if seen is not None and seen.named]
