"""What speaks for a name: a log likelihood ratio or a detector, and the chance of as much where nothing is missing.

Chances are counted in simulated records in which only parameters are off and sensors are noisy (``null_scores.json``, made by a
script of the tests). A value above all of theirs has a chance of at most one in as many records and one: no smaller chance
can be stated, and none is. The bound is (1 + k)/(1 + N) for k of N records as large.

Reference: A. C. Davison, D. V. Hinkley, Bootstrap Methods and their Application, Cambridge 1997, section 4.2.
"""

from __future__ import annotations

import dataclasses
import functools
import json
from importlib import resources


@dataclasses.dataclass(frozen=True)
class Evidence:
    """What speaks for a name."""

    score: float | None
    """2 delta log L - p ln n - 2 ln(grid size) [-]; None for what a detector says, which has no likelihood."""
    p_value: float | None
    """Chance, at most, of as much where nothing is missing [-]; None where no simulated record tells it."""


def likely(statistic: str, score: float) -> Evidence:
    """Return the evidence of a log likelihood ratio; ``statistic``: that of the simulated records it is compared with."""
    return Evidence(float(score), chance(statistic, score))


def detected(statistic: str, value: float) -> Evidence:
    """Return what a detector says."""
    return Evidence(None, chance(statistic, value))


def chance(statistic: str, value: float) -> float:
    """Return the chance, at most, of a value as large where nothing is missing [-].

    Args:
        statistic: one of those in ``null_scores.json``.
        value: the statistic of the record.
    """
    nulls = null_scores()[statistic]
    return (1 + sum(v >= value for v in nulls)) / (1 + len(nulls))


@functools.cache
def null_scores() -> dict[str, tuple[float, ...]]:
    """Return statistic -> its largest value in each simulated record in which nothing is missing, largest first."""
    file = resources.files("stochfric_mb.discovery") / "null_scores.json"
    return {name: tuple(values) for name, values in json.loads(file.read_text())["statistics"].items()}
