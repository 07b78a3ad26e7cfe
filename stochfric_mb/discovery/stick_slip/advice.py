"""What an experiment cannot see, and the one that would decide what is open."""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery.stick_slip.decision.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.rounds import Decision
from stochfric_mb.discovery.stick_slip.study import Study

DECIDES: dict[frozenset[str], str] = {
    frozenset({"position_dependent_friction", "normal_load_ripple"}): "a run at a second belt speed (or a normal-force sensor)",
    frozenset({"position_dependent_friction", "nonlinear_stiffness"}): "a quasi-static load test of the spring",
    frozenset({"position_dependent_friction", "backlash"}): "a quasi-static load test of the spring",
    frozenset({"harmonic_force", "nonlinear_stiffness"}): "a run at a second belt speed",
    frozenset({"position_dependent_friction", "harmonic_force"}): "a run at a second normal load",
    frozenset({"normal_load_ripple", "harmonic_force"}): "a run at a second normal load, or a normal-force sensor",
    frozenset({"viscous_friction", "quadratic_damping"}): "runs at other belt speeds and normal loads",
    frozenset({"viscous_friction", "velocity_weakening"}): "runs at other belt speeds and normal loads",
    frozenset({"velocity_weakening", "quadratic_damping"}): "runs at other belt speeds and normal loads",
    frozenset({"backlash", "second_mode"}): "a free decay or an impact test of the box, lifted off the belt",
    frozenset({"backlash", "nonlinear_stiffness"}): "a quasi-static load test of the spring",
    frozenset({"sensor_drift", "friction_drift"}): "a force sensor, or a second position sensor",
    frozenset({"random_coefficients", "correlated_coefficients"}): "a longer record",
}
"""Pairs that are easily confused -> the experiment that tells them apart (design, discovery)."""


def not_identifiable(study: Study) -> tuple[str, ...]:
    """Return the effects that this experiment cannot see, whatever their strength."""
    pool = study.pool
    blind: list[str] = []
    if np.std(np.log(pool.dwell)) < 0.08:
        blind.append("dwell_ageing")
    if len(set(pool.direction)) < 2:
        blind.append("direction_asymmetry")
    if np.ptp(pool.normal_force) < 0.05 * pool.normal_force.mean():
        blind.append("load_dependence")
    if not any(s.record.mechanism.excitation_amplitude for s in pool.slips):
        blind.append("sensor_delay")
    return tuple(blind)


def next_experiment(decision: Decision, study: Study) -> str:
    """Return the experiment that would decide what is open."""
    belt = belt_speed(study)
    if belt is not None and belt.too_much and not decision.named:
        return belt.advice
    for named in decision.named:
        for other in named.class_:
            if (advice := DECIDES.get(frozenset({named.kind, other}))) is not None:
                return f"{advice}, to tell {named.kind} from {other}"
        if named.class_:
            return f"runs at a second belt speed and a second normal load, to tell {named.kind} from {named.class_[0]}"
    if decision.verdict == "unknown" and decision.where is not None:
        return f"a repeat with a force sensor and a second belt speed, to see what varies along: {decision.where.axis}"
    blind = not_identifiable(study)
    asked = {
        "dwell_ageing": "a second belt speed",
        "direction_asymmetry": "a reversed belt",
        "load_dependence": "a second normal load",
    }
    wanted = [asked[kind] for kind in blind if kind in asked]
    return (
        f"runs with {', '.join(wanted)}: they would show {', '.join(k for k in blind if k in asked)}"
        if wanted
        else "none needed"
    )
