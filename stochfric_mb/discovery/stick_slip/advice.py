"""What an experiment cannot see, and the one that would decide what is open."""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery.stick_slip.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.choice import OTHER_RIG
from stochfric_mb.discovery.stick_slip.decision.decision import Decision
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.discovery.stick_slip.validation.explained import FORECASTS
from stochfric_mb.effects import effect_class, effect_kinds, words_of

FORCE = "force"
"""Channel of a measured force."""
SEEN_BY = {"dwell": "a second belt speed", "direction": "a reversed belt", "load": "a second normal load"}
"""Condition that effects answer to -> what an experiment must hold to change it."""


def not_identifiable(study: Study) -> tuple[str, ...]:
    """Return the effects that this experiment cannot see, whatever their strength."""
    constant = constant_conditions(study.pool)
    return tuple(kind for kind in effect_kinds() if effect_class(kind).answers_to in constant)


def constant_conditions(pool: Pool) -> set[str]:
    """Return the conditions that effects may answer to, and that do not change in an experiment."""
    pace = np.array([s.record.mechanism.belt_velocity for s in pool.slips])  # a box that slips keeps up with the belt
    same = {
        "dwell": bool(np.std(np.log(pool.dwell)) < 0.08),
        "direction": len(set(pool.direction)) < 2,
        "load": bool(np.ptp(pool.normal_force) < 0.05 * pool.normal_force.mean()),
        "distance": bool(np.ptp(pace) < 0.1 * pace.mean()),
        "known force": not any(s.record.mechanism.excitation_amplitude for s in pool.slips),
    }
    return {condition for condition, constant in same.items() if constant}


def _separating_experiment(first: str, second: str) -> str | None:
    """Return the experiment that tells two effects apart, if one of them knows it."""
    return effect_class(first).separated_by.get(second) or effect_class(second).separated_by.get(first)


def _untried(study: Study) -> list[str]:
    """Return which speeds and loads would tell more."""
    constant = constant_conditions(study.pool)
    return [SEEN_BY[c] for c in ("dwell", "load") if c in constant] or ["speeds and loads further apart"]


def _to_find(axis: str, study: Study) -> str:
    """Return the experiment that would tell more of what is missing along an axis."""
    if axis == OTHER_RIG:
        return "a load test of the spring and a weighing of the box: with them as stated, what is missing has no name"
    measured = any(FORCE in run.channels for run in study.dataset.fit)
    wanted = _untried(study) if measured else ["a force sensor", *_untried(study)]
    aim = (
        "in which part of the cycle the model errs"
        if axis == FORECASTS
        else f"whether what is missing ({axis}) changes with them"
    )
    return f"a repeat with {' and '.join(wanted)}, to see {aim}"


def next_experiment(decision: Decision, study: Study) -> str:
    """Return the experiment that would decide what is open."""
    belt = belt_speed(study)
    if belt is not None and belt.too_much and not decision.named:
        return belt.advice
    for named in decision.named:
        for other in named.class_:
            if (advice := _separating_experiment(named.kind, other)) is not None:
                return f"{advice}, to distinguish {words_of(named.kind)} from {words_of(other)}"
        if named.class_:
            which = f"{words_of(named.kind)} from {words_of(named.class_[0])}"
            return f"runs with {' and '.join(_untried(study))}, to distinguish {which}"
    if decision.verdict == "unknown" and decision.where is not None:
        return _to_find(decision.where.axis, study)
    blind = [kind for kind in not_identifiable(study) if effect_class(kind).answers_to in SEEN_BY]
    wanted = dict.fromkeys(SEEN_BY[effect_class(kind).answers_to] for kind in blind)
    return f"runs with {', '.join(wanted)}: they would show {', '.join(map(words_of, blind))}" if blind else "none needed"
