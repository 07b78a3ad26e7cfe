"""Runs one sample at a time, by the reference or any other engine: slower, and nothing is unsupported."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np

from stochfric_mb import metrics
from stochfric_mb.engines import adapter
from stochfric_mb.ensemble.lanes import TALLIES
from stochfric_mb.ensemble.result import Block
from stochfric_mb.ensemble.schedule import SAME_TIME, Array
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory


def one_at_a_time(scenario: Scenario, engine: str, dt: float | None, times: Array) -> Callable[[int, int, int], Block]:
    """Return the function (seed, first sample, number of samples) -> their runs.

    Raises:
        InputError: output times that are no multiples of the scenario's output step.
    """
    simulate = adapter(engine).simulate
    shorter = dataclasses.replace(scenario, duration=_cut(scenario, times))
    index = np.round(times / scenario.output_step).astype(np.int64)
    off = np.abs(index * scenario.output_step - times) > 1.0e-9 * scenario.output_step + SAME_TIME
    if off.any():
        raise InputError(
            f"output time {times[np.argmax(off)]:g} s is no multiple of simulation.output_step = {scenario.output_step:g} s, "
            f"as {engine} needs it for {scenario.law.kind}; choose multiples or another output_step"
        )

    def compute(seed: int, first: int, n: int) -> Block:
        shape = (n, len(times))
        block = Block(np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.bool_), np.empty((n, TALLIES)))
        for j in range(n):
            trajectory = simulate(shorter, seed=seed, sample=first + j, dt=dt)
            block.position[j], block.velocity[j] = trajectory.position[index], trajectory.velocity[index]
            block.stick[j] = trajectory.stick[index] == 1.0
            block.tallies[j] = _tallies(trajectory, scenario)
        return block

    return compute


def _cut(scenario: Scenario, times: Array) -> float:
    """Return the duration [s] that reaches the last output time."""
    return max(math.ceil(times[-1] / scenario.output_step - 1.0e-6), 1) * scenario.output_step


def _tallies(trajectory: Trajectory, scenario: Scenario) -> Array:
    """Return the events of one run, as the kernels count them, but located between samples."""
    law, mechanism = scenario.law, scenario.mechanism
    breaks = metrics.break_aways(trajectory, law, mechanism)
    at = np.searchsorted(trajectory.time, breaks) - 1
    first, last = (breaks[0], breaks[-1]) if len(breaks) else (math.nan, math.nan)
    stuck = metrics.stick_fraction(trajectory, law, mechanism) * trajectory.time[-1]
    return np.array([len(breaks), first, last, trajectory.mu_s[at].sum(), stuck])
