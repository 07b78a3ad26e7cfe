"""What an effect is worth on parts of the record that were left out of the fits."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import wilcoxon

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.decision.evidence import FEWEST
from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel

Masks = list[npt.NDArray[np.bool_]]
"""Windows that are left out, balance by balance."""

BLOCKS = 8
"""Blocks of the record that are left out in turn."""
EVALUATIONS = 4
"""Gauss-Newton steps of a fit without a part: it starts from the fit to all."""


@dataclasses.dataclass(frozen=True)
class LeftOut:
    """Two models on parts that were left out."""

    gain: float
    """Part of the error (rms) that the richer one takes away [-]."""
    better: float
    """Share of the parts that it makes better [-]."""
    p_value: float
    """Chance of as much without the effect, by Wilcoxon's signed ranks of the parts, which are taken as independent."""
    parts: int
    """Number of the parts."""


def blocks(balances: Sequence[ForceBalance], count: int = BLOCKS) -> list[Masks]:
    """Return ``count`` stretches of the runs, one after the other, of equally many windows of sliding."""
    sliding = np.concatenate([s.sliding for s in balances])
    number = np.cumsum(sliding) * count // (int(sliding.sum()) + 1)
    return [_split((number == k) & sliding, balances) for k in range(count)]


def strokes(balances: Sequence[ForceBalance]) -> list[Masks]:
    """Return what repeats: the strokes of a single run, or of several runs the strokes of each in each direction.

    Strokes of one run repeat what is peculiar to that run, so that they are no witnesses of what runs have in common.
    """
    sliding = np.concatenate([s.sliding for s in balances])
    if len(balances) >= FEWEST:
        number = np.concatenate([2 * i + (s.velocity[s.window.centres] > 0.0).astype(np.int64) for i, s in enumerate(balances)])
    else:
        number = np.cumsum(np.diff(np.r_[0, sliding.astype(np.int8)]) > 0)
    return [_split((number == k) & sliding, balances) for k in np.unique(number[sliding])]


def compared(
    plain: JointModel,
    richer: JointModel,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    noise: float,
    parts: Sequence[Masks],
) -> LeftOut:
    """Return what ``richer`` is worth on each of the ``parts``, fitted without it; ``noise`` is as of `fit`."""
    errors = np.array([[_error(m, balances, nuisances, noise, part) for m in (plain, richer)] for part in parts])
    before, after = errors.sum(axis=0)
    fall = errors[:, 0] - errors[:, 1]
    ranked: Any = wilcoxon(fall, alternative="greater") if np.any(fall != 0.0) else None
    chance = 1.0 if ranked is None else float(ranked.pvalue)
    return LeftOut(1.0 - float(np.sqrt(after / before)), float(np.mean(fall > 0.0)), chance, len(parts))


def _error(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], noise: float, part: Masks
) -> float:
    """Return the sum of squares on a part, of a model fitted without it."""
    kept = [s.sliding & ~out for s, out in zip(balances, part, strict=True)]
    fitted = fit(model, balances, nuisances, noise=noise, masks=kept, evaluations=EVALUATIONS).model
    rest = [fitted.remainder(s, nuisances)[out] for s, out in zip(balances, part, strict=True)]
    return float(np.sum(np.concatenate(rest) ** 2))


def _split(mask: npt.NDArray[np.bool_], balances: Sequence[ForceBalance]) -> Masks:
    return np.split(mask, np.cumsum([len(s.sliding) for s in balances])[:-1])
