"""The reference solution of a scenario with effects."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from stochfric_mb import __version__
from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.effects.augmented_law import augmented_law
from stochfric_mb.effects.columns import as_measured, without_loads
from stochfric_mb.effects.combine import moving, with_compliance
from stochfric_mb.reference.augmented import TOLERANCE, Motion, Start, augmented_system
from stochfric_mb.reference.solver import solve
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

CHUNK = 10_000
"""Outputs between two calls of ``progress``."""
FAST = ("coulomb", "stribeck")
"""Laws for which the fast simulator is the reference: true stick, for which an augmented law lacks the holding force."""


def simulate_with_effects(
    scenario: Scenario, *, seed: int = 0, sample: int = 0, progress: Callable[[float], None] | None = None
) -> Trajectory:
    """Return the reference solution of a scenario with effects at its output times.

    Laws with true stick go through the fast simulator, every other law through the adaptive solver as a law with
    effects; the notes of the trajectory say which. ``mu_s`` and ``mu_k`` are those of the path, before effects.

    Raises:
        InputError: a law that cannot carry the effects.
        SimulationError: the integration broke down; says where.
    """
    if moving(scenario.effects) and scenario.law.kind in FAST:
        trajectory = _fast(scenario, seed, sample, progress)
    else:
        trajectory = _adaptive(scenario, seed, sample, progress)
    return as_measured(trajectory, scenario.effects, seed=seed, sample=sample)


def _adaptive(scenario: Scenario, seed: int, sample: int, progress: Callable[[float], None] | None) -> Trajectory:
    mechanism, effects = scenario.mechanism, scenario.effects
    law = with_compliance(scenario.law, effects)
    path = CoefficientPath(scenario.coefficient_process, law, seed=seed, sample=sample)
    acting = augmented_law(law, mechanism, effects, seed=seed, sample=sample)
    trajectory = solve(mechanism, acting, path, scenario.output_times(), progress=progress)
    if acting is not law:
        trajectory = without_loads(trajectory, mechanism, effects, seed=seed, sample=sample)
        trajectory.attributes["notes"].append("effects within the law, in the event-located adaptive solver")
    trajectory.attributes["law"] = scenario.law.kind
    return trajectory


def _fast(scenario: Scenario, seed: int, sample: int, progress: Callable[[float], None] | None) -> Trajectory:
    mechanism = scenario.mechanism
    system = augmented_system(mechanism, scenario.law, scenario.effects, scenario.process, seed=seed, sample=sample)
    start = Start(
        position=mechanism.initial_position,
        velocity=mechanism.initial_velocity,
        stick=mechanism.initial_velocity == mechanism.belt_velocity,
        deflection=0.0,
    )
    before = time.perf_counter()
    parts: list[Motion] = [system.at(start)]
    for first in range(0, scenario.n_outputs - 1, CHUNK):
        count = min(CHUNK, scenario.n_outputs - 1 - first)
        parts.append(system.march(parts[-1].end, scenario.output_step, count))
        if progress is not None:
            progress(parts[-1].end.time)
    seconds = time.perf_counter() - before
    return Trajectory(
        time=scenario.output_times(),
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in (
            "position", "velocity", "friction_force", "normal_force", "mu_s", "mu_k", "stick")},
        events=np.concatenate([part.events for part in parts]),
        attributes={
            "engine": "reference",
            "version": __version__,
            "hook": "fast simulator of effects: Dormand-Prince 5(4), switches located within the step",
            "dt": 0.0,
            "seed": seed,
            "sample": sample,
            "law": scenario.law.kind,
            "notes": [f"dt = 0: steps are adaptive, local error {TOLERANCE:g} of the static deflection or below"],
            "seconds_per_step": seconds / max(scenario.n_outputs - 1, 1),
            "n_steps": scenario.n_outputs - 1,
        },
    )  # fmt: skip
