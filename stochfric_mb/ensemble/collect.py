"""Collects the blocks of an ensemble: whole runs, or statistics of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from stochfric_mb.ensemble.lanes import TALLIES
from stochfric_mb.ensemble.result import Block, EnsembleResult, empty_block
from stochfric_mb.ensemble.schedule import Array
from stochfric_mb.ensemble.sketch import Sketch
from stochfric_mb.errors import SimulationError
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario

QUANTITIES = ("position", "velocity")
"""Of what statistics are kept."""


class Runs:
    """Collects whole runs."""

    def __init__(self, times: Array, n_runs: int) -> None:
        """Make room for ``n_runs`` runs at ``times`` [s]."""
        self.times = times
        self.arrays = empty_block(n_runs, len(times))

    def add(self, part: Block, done: int) -> None:
        """Take a block whose first run is number ``done``."""
        for mine, new in zip(self.arrays, part, strict=True):
            mine[done : done + len(new)] = new

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        """Return the ensemble once all blocks are in."""
        a = self.arrays
        return EnsembleResult(
            time=self.times, position=a.position, velocity=a.velocity, stick=a.stick, tallies=a.tallies, attributes=attributes
        )


class Statistics:
    """Collects statistics only."""

    def __init__(self, times: Array, n_runs: int, bins: int) -> None:
        """Make room for statistics of ``n_runs`` runs at ``times`` [s], with histograms of ``bins`` bins."""
        self.times = times
        self.sketches = {name: Sketch.empty(len(times), bins) for name in QUANTITIES}
        self.stuck = np.zeros(len(times), dtype=np.int64)
        self.tallies = np.empty((n_runs, TALLIES))

    def add(self, part: Block, done: int) -> None:
        """Take a block whose first run is number ``done``; blocks come in order."""
        for name, sketch in self.sketches.items():
            sketch.add(getattr(part, name))
        self.stuck += part.stick.sum(axis=0)
        self.tallies[done : done + len(part.tallies)] = part.tallies

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        """Return the ensemble once all blocks are in."""
        return EnsembleResult(
            time=self.times, sketches=self.sketches, stuck=self.stuck, tallies=self.tallies, attributes=attributes
        )


def checked_block(part: Block, scenario: Scenario, first: int) -> Block:
    """Return the block once all its positions are finite and of a size that the mechanism can reach.

    Raises:
        SimulationError: they are not; an engine can return success with a state that means nothing.
    """
    if not isinstance(scenario.mechanism, BeltBox):
        return part  # its engine checks: nothing tells how far a user's own model reaches
    reach: float = scenario.reach
    wrong = ~(np.abs(part.position) <= reach).all(axis=1)
    if wrong.any():
        j = int(np.argmax(wrong))
        raise SimulationError(
            f"sample {first + j} left every plausible position (abs(x) <= {reach:g} m) or is not finite; "
            "take a smaller dt or check the law's parameters"
        )
    return part
