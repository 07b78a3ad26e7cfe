"""The adapter: which samples MuJoCo Warp simulates, each in a world."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from stochfric_mb.effects.combine import any_but_random
from stochfric_mb.errors import InputError
from stochfric_mb.mechanisms import BeltBox, Mjcf
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory
from stochfric_mb.warp import belt_box, mjcf


def simulate(
    scenario: Scenario[Any],
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return one sample; arguments and errors as for `simulate_many`."""
    (trajectory,) = simulate_many(scenario, seed=seed, first_sample=sample, n=1, dt=dt)
    if progress is not None:
        progress(scenario.duration)
    return trajectory


def simulate_many(
    scenario: Scenario[Any], *, seed: int = 0, first_sample: int = 0, n: int, dt: float | None = None, threads: int = 1
) -> list[Trajectory]:
    """Return samples ``first_sample`` .. ``first_sample + n - 1`` of a belt-box or of a user's own model, a world each.

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient paths.
        first_sample: second part of the first one.
        n: number of samples.
        dt: step [s], dividing the output step; if not given, the model's own, for a belt-box 1e-3 s.
        threads: without effect: Warp's device does the work.

    Raises:
        InputError: another mechanism, effects, or what `belt_box.run_worlds` and `mjcf.run_worlds` refuse.
        SimulationError: a run broke down.
    """
    if any_but_random(scenario.effects):
        raise InputError("MuJoCo Warp carries no effects; take engine mujoco, or remove the [[effects]] tables")
    if isinstance(scenario.mechanism, BeltBox):
        return belt_box.run_worlds(scenario, seed=seed, first_sample=first_sample, n=n, dt=dt)
    if isinstance(scenario.mechanism, Mjcf):
        return mjcf.run_worlds(scenario, seed=seed, first_sample=first_sample, n=n, dt=dt)
    raise InputError(
        f"MuJoCo Warp simulates the mechanisms belt_box and mjcf, not {scenario.mechanism.kind!r}; write it as an MJCF model"
    )


def identity(scenario: Scenario[Any]) -> str:
    """Return what a scenario leaves to another file: a digest of the compiled model; empty where it is all there is."""
    return mjcf.digest(scenario.mechanism) if isinstance(scenario.mechanism, Mjcf) else ""
