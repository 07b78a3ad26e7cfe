"""Runs one sample at a time, by the reference or any other engine: slower, and nothing is unsupported."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable

import numpy as np
import numpy.typing as npt

from stochfric_mb import metrics
from stochfric_mb.engines import adapter
from stochfric_mb.ensemble.result import Block, empty_block
from stochfric_mb.ensemble.schedule import SAME_TIME, Array
from stochfric_mb.errors import InputError
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory


def one_at_a_time(scenario: Scenario, engine: str, dt: float | None, times: Array) -> Callable[[int, int, int], Block]:
    """Return the function (seed, first sample, number of samples) -> their runs.

    Raises:
        InputError: output times that are no multiples of the scenario's output step.
    """
    simulate = adapter(engine, effects=scenario.effects).simulate
    samples = Sampling.of(scenario, times)
    off = np.abs(samples.index * scenario.output_step - times) > 1.0e-9 * scenario.output_step + SAME_TIME
    if off.any():
        raise InputError(
            f"output time {times[np.argmax(off)]:g} s is no multiple of simulation.output_step = {scenario.output_step:g} s, "
            f"as {engine} needs it for {scenario.law.kind}; choose multiples or another output_step"
        )

    def compute(seed: int, first: int, n: int) -> Block:
        return samples.block(n, (simulate(samples.scenario, seed=seed, sample=first + j, dt=dt) for j in range(n)))

    return compute


@dataclasses.dataclass(frozen=True)
class Sampling:
    """What an ensemble keeps of an engine's trajectories."""

    scenario: Scenario
    """The scenario, as long as the last output time needs."""
    index: npt.NDArray[np.int64]
    """Numbers of the samples at the output times, shape (n_times,)."""

    @classmethod
    def of(cls, scenario: Scenario, times: Array) -> Sampling:
        """Return what ``times`` [s] need of a scenario's output steps."""
        step = scenario.output_step
        duration = max(math.ceil(times[-1] / step - 1.0e-6), 1) * step
        return cls(dataclasses.replace(scenario, duration=duration), np.round(times / step).astype(np.int64))

    def block(self, n: int, trajectories: Iterable[Trajectory]) -> Block:
        """Return n trajectories as a block."""
        block = empty_block(n, len(self.index))
        for j, trajectory in enumerate(trajectories):
            block.position[j], block.velocity[j] = trajectory.position[self.index], trajectory.velocity[self.index]
            block.stick[j] = trajectory.stick[self.index] == 1.0
            block.tallies[j] = _tallies(trajectory, self.scenario)
        return block


def _tallies(trajectory: Trajectory, scenario: Scenario) -> Array:
    """Return the events of one run, as the kernels count them, but located between samples."""
    law, mechanism = scenario.law, scenario.mechanism
    if not isinstance(mechanism, BeltBox):
        return _switches(trajectory)
    breaks = metrics.break_aways(trajectory, law, mechanism)
    at = np.searchsorted(trajectory.time, breaks) - 1
    first, last = (breaks[0], breaks[-1]) if len(breaks) else (math.nan, math.nan)
    stuck = metrics.stick_fraction(trajectory, law, mechanism) * trajectory.time[-1]
    return np.array([len(breaks), first, last, trajectory.mu_s[at].sum(), stuck])


def _switches(trajectory: Trajectory) -> Array:
    """Return the events of a run of a user's own model: the contact's own state, in the middle between two samples."""
    stick, time = trajectory.stick == 1.0, trajectory.time
    at = np.flatnonzero(stick[:-1] & ~stick[1:])
    breaks = 0.5 * (time[at] + time[at + 1])
    first, last = (breaks[0], breaks[-1]) if len(breaks) else (math.nan, math.nan)
    return np.array([len(breaks), first, last, trajectory.mu_s[at].sum(), stick.mean() * time[-1]])
