"""Engines that compute many samples in one call, such as MuJoCo with its Batch."""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable
from typing import Any

import numpy as np

from stochfric_mb.engines import adapter
from stochfric_mb.ensemble.lanes import TALLIES
from stochfric_mb.ensemble.result import Block
from stochfric_mb.ensemble.schedule import Array
from stochfric_mb.ensemble.single import _cut, _tallies
from stochfric_mb.scenario import Scenario

MANY: dict[str, str] = {"mujoco": "stochfric_mb.mujoco.batch:simulate_many"}
"""Engine -> its function (scenario, *, seed, first_sample, n, dt, threads) -> trajectories."""

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
    shorter = dataclasses.replace(scenario, duration=_cut(scenario, times))
    index = np.round(times / scenario.output_step).astype(np.int64)

    def compute(seed: int, first: int, n: int, threads: int) -> Block:
        shape = (n, len(times))
        block = Block(np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.bool_), np.empty((n, TALLIES)))
        runs = simulate_many(shorter, seed=seed, first_sample=first, n=n, dt=dt, threads=threads)
        for j, run in enumerate(runs):
            block.position[j], block.velocity[j] = run.position[index], run.velocity[index]
            block.stick[j] = run.stick[index] == 1.0
            block.tallies[j] = _tallies(run, scenario)
        return block

    return compute
