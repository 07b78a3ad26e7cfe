"""Engines that compute many samples in one call, such as MuJoCo in threads."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from stochfric_mb.engines import adapter
from stochfric_mb.ensemble.result import Block
from stochfric_mb.ensemble.schedule import Array
from stochfric_mb.ensemble.single import Sampling
from stochfric_mb.scenario import Scenario

MANY: dict[str, str] = {
    "mujoco": "stochfric_mb.mujoco.belt_box:simulate_many",
    "warp": "stochfric_mb.warp.simulate:simulate_many",
}
"""Engine -> its function (scenario, *, seed, first_sample, n, dt, threads) -> trajectories."""
RUNS: dict[str, int] = {"mujoco": 16, "warp": 256}
"""Such an engine -> runs in a block."""

Prepared = Callable[[int, int, int, int], Block]
"""(seed, first sample, number of samples, threads) -> their runs."""


def many(engine: str) -> Callable[..., Any] | None:
    """Return the engine's function for many samples, None if it has none.

    Raises:
        MissingEngineError: the engine is not installed.
    """
    if engine not in MANY:
        return None
    adapter(engine)
    module, _, name = MANY[engine].partition(":")
    return getattr(importlib.import_module(module), name)


def all_at_once(scenario: Scenario, simulate_many: Callable[..., Any], dt: float | None, times: Array) -> Prepared:
    """Return the function that computes runs with an engine's ``simulate_many``; times are multiples of the output step."""
    samples = Sampling.of(scenario, times)

    def compute(seed: int, first: int, n: int, threads: int) -> Block:
        return samples.block(n, simulate_many(samples.scenario, seed=seed, first_sample=first, n=n, dt=dt, threads=threads))

    return compute
