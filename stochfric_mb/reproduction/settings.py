"""How much a reproduction computes."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping


@dataclasses.dataclass(frozen=True, kw_only=True)
class Settings:
    """Sizes of the studies; `FULL` is the reproduction, `QUICK` its small twin."""

    n_paper: int = 100
    """Samples of the paper's ensembles (10 or more)."""
    n_many: int = 3000
    """Samples of ours, for the same distributions."""
    times: tuple[float, ...] = (2.0, 10.0)
    """Times at which distributions are compared [s]."""
    steps: tuple[float, ...] = (0.01, 0.001, 0.0001)
    """Output steps [s], coarse to fine."""
    resamples: int = 499
    """Bootstrap samples of an interval."""
    n_grid: int = 8
    """Runs with which processes are compared on whole output grids."""
    n_pairs: int = 1_000_000
    """Pairs drawn to measure rejection."""
    n_paths: int = 2000
    """Paths whose interpolation is measured."""
    n_portrait: int = 100
    """Stochastic runs of a phase portrait."""
    discarded: Mapping[str, float] = dataclasses.field(
        default_factory=lambda: {"Table 1": 10.0, "Table 2, 13.8 rad/s": 30.0, "Table 2, 18.7 rad/s": 100.0}
    )
    """Time that portraits discard as transient [s]."""
    portrait_time: float = 40.0
    """Time of a portrait after the transients [s]."""
    n_sensitivity: int = 200
    """Stochastic runs for each value of a default."""
    n_cost: int = 256
    """Runs timed."""
    cost_repeats: int = 7
    """Timings of each kind."""
    cost_multiples: tuple[int, ...] = (1, 3, 10, 30, 100, 300, 1000)
    """Sizes of the ensembles whose cost is compared, over the smallest (three or more)."""


FULL = Settings()
QUICK = Settings(
    n_paper=100, n_many=1000, times=(2.0,), resamples=99, n_grid=2, n_pairs=200_000, n_paths=400, n_portrait=10,
    discarded={"Table 1": 10.0, "Table 2, 13.8 rad/s": 30.0, "Table 2, 18.7 rad/s": 30.0}, portrait_time=10.0,
    n_sensitivity=20, n_cost=64, cost_repeats=3, cost_multiples=(1, 3, 10, 30),
)  # fmt: skip
