"""A claim of a paper, the numbers that test it, and the rules that turn numbers into a verdict."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from typing import Any

from stochfric_mb.statistics import Estimate

HOLDS, FAILS, UNDECIDABLE = "holds", "fails", "undecidable"

ALPHA = 0.01
"""Chance of rejecting one true hypothesis among all tests of a claim (divided by their number, after Bonferroni) [-]."""
RELEVANT_DISTANCE = 0.05
"""Kolmogorov-Smirnov distance below which a difference, however certain, is too small to matter [-]."""
ENOUGH = 1000
"""Samples from which a test that rejects nothing counts as evidence that nothing relevant is there."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Number:
    """One number that a claim is judged by."""

    name: str
    """Key in reproduce.json."""
    label: str
    """What it is, for people."""
    value: float
    """The estimate."""
    low: float | None = None
    """Lower end of its interval; None where there is none (an exact number, or one deterministic run)."""
    high: float | None = None
    """Upper end."""
    unit: str = "-"
    """Unit."""
    p_value: float | None = None
    """p-value of the test that goes with it."""
    n: int | None = None
    """Samples behind it (in each of two samples, where two are compared)."""
    group: str = ""
    """Heading under which a page folds it away; empty: always shown."""
    interval: str = "95 %"
    """What the interval is."""

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON: value, low, high, unit, and p_value and n where there are any; NaN becomes null."""
        table: dict[str, Any] = {"label": self.label, "unit": self.unit}
        table |= {k: _finite(getattr(self, k)) for k in ("value", "low", "high")}
        if self.low is not None:
            table["interval"] = self.interval
        return table | {k: v for k in ("p_value", "n") if (v := getattr(self, k)) is not None}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Mend:
    """What of ours makes a failed claim true, and how well."""

    process: str
    """Name of the process."""
    text: str
    """How it was tried."""
    outcome: str
    """One of holds, fails, undecidable, by the rule of the claim itself."""
    numbers: tuple[Number, ...]
    """Its numbers."""

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {"process": self.process, "text": self.text, "outcome": self.outcome, "figures": as_figures(self.numbers)}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim and its verdict."""

    id: str
    """Key in reproduce.json."""
    claim: str
    """What is claimed."""
    where: str
    """Figure, table or section of the paper."""
    test: str
    """What was computed."""
    rule: str
    """How the numbers decide."""
    verdict: str
    """One of holds, fails, undecidable."""
    reason: str
    """The numbers that decided, in a sentence."""
    numbers: tuple[Number, ...]
    """The numbers."""
    mends: tuple[Mend, ...] = ()
    """What mends it, each tried."""
    remark: str = ""
    """What else a reader should know."""

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        table = {k: getattr(self, k) for k in ("id", "claim", "where", "verdict", "test", "rule", "reason", "remark")}
        return table | {"figures": as_figures(self.numbers), "mended_by": [mend.to_dict() for mend in self.mends]}

    def number(self, name: str) -> Number:
        """Return one of its numbers by name."""
        return next(number for number in self.numbers if number.name == name)


def as_figures(numbers: Iterable[Number]) -> dict[str, Any]:
    """Return numbers as the ``figures`` of reproduce.json: name -> number."""
    return {number.name: number.to_dict() for number in numbers}


def of_estimate(name: str, label: str, estimate: Estimate | None, **more: Any) -> Number:
    """Return the number that an estimate is; NaN where there is none."""
    if estimate is None:
        return Number(name=name, label=label, value=math.nan, **more)
    return Number(name=name, label=label, value=estimate.value, low=estimate.low, high=estimate.high, **more)


def differs(number: Number, n_tests: int) -> bool:
    """Return whether two samples differ, certainly and by enough: p < ALPHA/n_tests and interval above 0.05."""
    assert number.p_value is not None
    assert number.low is not None
    return number.p_value < ALPHA / n_tests and number.low > RELEVANT_DISTANCE


def same_distribution(distances: Sequence[Number]) -> str:
    """Return the verdict on "all these pairs of samples are of one distribution".

    fails: a pair differs (`differs`). holds: no test rejects at ALPHA/number of tests and each sample has at least
    `ENOUGH` values. undecidable otherwise: too few samples, or a difference that is certain but small.
    """
    n = len(distances)
    if any(differs(d, n) for d in distances):
        return FAILS
    quiet = all(d.p_value is not None and d.p_value >= ALPHA / n for d in distances)
    return HOLDS if quiet and all((d.n or 0) >= ENOUGH for d in distances) else UNDECIDABLE


def worst(distances: Sequence[Number]) -> Number:
    """Return the largest distance."""
    return max(distances, key=lambda d: d.value)


def _finite(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)
