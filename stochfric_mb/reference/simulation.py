"""The reference solution of a scenario, with or without effects: the interface that every engine has."""

from __future__ import annotations

from collections.abc import Callable

from stochfric_mb.reference.solver import solve
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the reference solution of a scenario at its output times.

    Args:
        scenario: what is simulated.
        seed: first part of the address of the coefficient path.
        sample: second part of it.
        dt: taken for the sake of the common interface and not used: the solution does not depend on a step [s].
        progress: called with the simulated time [s] now and then.

    Raises:
        SimulationError: the integration broke down; says where.
    """
    if scenario.effects:
        from stochfric_mb.reference.with_effects import simulate_with_effects

        return simulate_with_effects(scenario, seed=seed, sample=sample, progress=progress)
    path = scenario.path(seed, sample)
    return solve(scenario.mechanism, scenario.law, path, scenario.output_times(), progress=progress)
