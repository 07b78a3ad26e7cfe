"""Confounding: conditions that went together in an experiment, so that no analysis can say which of them mattered."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.effects import effect_class, effect_kinds

Array = npt.NDArray[np.float64]

TOGETHER = 0.8
"""Part of one condition's variance that another explains, from which they are called confounded [-]."""
PARTLY = 0.5
"""The same, from which they are called partly confounded."""
INSIDE = 0.5
"""Least part of a condition's standard deviation that is within runs, for what it does there to count [-]."""
CLOCKS = ("time", "distance", "temperature")
"""Conditions that mostly grow together: for friction that drifts the fits are asked which of them it was."""


@dataclasses.dataclass(frozen=True)
class Confounded:
    """Two conditions that went together."""

    first: str
    """One of them."""
    second: str
    """The other."""
    explained: float
    """Part of the variance of one that the other explains [-]."""

    @property
    def strong(self) -> bool:
        """Whether no analysis can say which of them mattered."""
        return self.explained >= TOGETHER

    def __str__(self) -> str:
        """Return the finding as a sentence."""
        word = "are" if self.strong else "are partly"
        return (
            f"{self.first} and {self.second} {word} confounded here: one explains {100 * self.explained:.0f} % of the other's "
            "variance"
        )


def confounded(balances: Sequence[ForceBalance]) -> list[Confounded]:
    """Return the pairs of conditions that went together over the sliding windows of ``balances``, the worst first."""
    names = list(dict.fromkeys(name for s in balances for name in s.factors))
    whole = [n for n in names if all(n in s.factors for s in balances)]
    runs = [{n: s.factors[n][s.sliding] for n in whole} for s in balances if s.sliding.any()]
    pairs: list[Confounded] = []
    for i, first in enumerate(whole):
        for second in whole[i + 1 :]:
            share = _together([(r[first], r[second]) for r in runs])
            if share >= PARTLY:
                pairs.append(Confounded(first, second, share))
    return sorted(pairs, key=lambda c: -c.explained)


def _together(runs: Sequence[tuple[Array, Array]]) -> float:
    """Return how far two conditions went together: over all runs, or within each run (then the mean over runs).

    The latter says something only where both vary within runs about as much as they do at all.
    """
    whole = tuple(np.concatenate([r[k] for r in runs]) for k in (0, 1))
    inside = [np.concatenate([r[k] - r[k].mean() for r in runs]).std() / max(float(whole[k].std()), 1.0e-300) for k in (0, 1)]
    within = float(np.mean([_share(*r) for r in runs])) if min(inside) > INSIDE else 0.0
    return max(_share(*whole), within)


def _share(first: Array, second: Array) -> float:
    if min(_spread(first), _spread(second)) < 1.0e-9:
        return 0.0
    return max(_explained(first, second), _explained(second, first))


def _spread(values: Array) -> float:
    return float(np.ptp(values) / max(float(np.max(np.abs(values))), 1.0e-300))


def _explained(cause: Array, result: Array) -> float:
    """Return the part of the variance of ``result`` that is between the levels of ``cause``, at most eight of them."""
    levels = np.unique(cause)
    if len(levels) > 8:
        return float(np.corrcoef(cause, result)[0, 1] ** 2)
    between = sum(np.mean(cause == x) * (result[cause == x].mean() - result.mean()) ** 2 for x in levels)
    return float(between / result.var())


def spoken_of(pairs: Sequence[Confounded], kinds: Sequence[str]) -> list[Confounded]:
    """Return the confounded pairs that matter: that time and distance grew together does where friction drifts.

    Args:
        pairs: conditions that went together.
        kinds: kinds of the selected effects.
    """
    drifts = any(map(by_clock, kinds))
    return [p for p in pairs if p.strong and (drifts or {p.first, p.second} != {"time", "distance"})]


def stand_ins(kind: str, pairs: Sequence[Confounded]) -> tuple[str, ...]:
    """Return the effects that could pass for ``kind`` because its condition went together with theirs.

    Of clocks among each other the fits have been asked.
    """
    own = effect_class(kind).answers_to
    others = {p.second if p.first == own else p.first for p in pairs if p.strong and own in (p.first, p.second)}
    others -= set(CLOCKS) if own in CLOCKS else set()
    return tuple(k for k in effect_kinds() if k != kind and effect_class(k).answers_to in others)


def by_state(kind: str, others: Sequence[str], pairs: Sequence[Confounded]) -> list[str]:
    """Return those of ``others`` that hold whenever a speed, place or load comes back, where ``kind`` follows the clock.

    Where the clock went together with that condition, an effect of the clock supposes besides that every run begins anew as
    the others did.

    Args:
        kind: an effect.
        others: effects that explain as much.
        pairs: conditions that went together.
    """
    if not by_clock(kind):
        return []
    own = effect_class(kind).answers_to
    return [k for k in others if not by_clock(k) and {own, effect_class(k).answers_to} in _strong(pairs)]


def one_curve(kinds: Sequence[str], pairs: Sequence[Confounded]) -> tuple[str, ...]:
    """Return the first two of ``kinds`` that answer to conditions which went together; empty: there are none.

    One curve along both conditions is then drawn with two effects: that it takes two of them says that neither has its form,
    and the share of each is what their forms make of it.

    Args:
        kinds: kinds of the selected effects.
        pairs: conditions that went together.
    """
    couples = itertools.combinations([k for k in kinds if k in effect_kinds()], 2)
    return next((c for c in couples if {effect_class(k).answers_to for k in c} in _strong(pairs)), ())


def _strong(pairs: Sequence[Confounded]) -> list[set[str]]:
    return [{p.first, p.second} for p in pairs if p.strong]


def by_clock(kind: str) -> bool:
    """Return whether an effect answers to one of the `CLOCKS`."""
    return kind in effect_kinds() and effect_class(kind).answers_to in CLOCKS
