"""What an effect is worth on parts of the record that were left out of the fits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.evidence import FEWEST
from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases
from stochfric_mb.discovery.inference.paired import Paired, paired

Masks = list[npt.NDArray[np.bool_]]
"""Windows that are left out, balance by balance."""

BLOCKS = 8
"""Blocks of the record that are left out in turn."""
MOST_FITS = 24
"""Most fits without parts of the record: of more parts several are left out at once, spread over the record, which raises the
variance of what is fitted by a 24th at most."""
EVALUATIONS = 4
"""Gauss-Newton steps of a fit without a part: it starts from the fit to all."""


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


def witnesses(balances: Sequence[ForceBalance]) -> list[Masks]:
    """Return what an effect has to foretell: runs in one direction where there are up to `BLOCKS` of these, or else blocks.

    Half of a run foretells the other half with whatever is peculiar to that run in that direction. Of more runs a block holds
    whole ones.
    """
    settings = strokes(balances) if len(balances) >= FEWEST else []
    return settings if 1 < len(settings) <= BLOCKS else blocks(balances)


def each_run(balances: Sequence[ForceBalance]) -> list[Masks]:
    """Return the runs, one by one: what each run has a phase of its own for must show in runs that it was not learned from."""
    return [[s.sliding if s is own else np.zeros_like(s.sliding) for s in balances] for own in balances]


def compared(
    plain: JointModel,
    richer: JointModel,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    noise: float,
    parts: Sequence[Masks],
    beliefs: Sequence[Nuisance] | None = None,
) -> Paired:
    """Return what ``richer`` is worth on each of the ``parts``, fitted without it; ``noise`` is as of `fit`.

    ``beliefs`` are the numbers of the mechanism with their priors in the richer model; None: as in the plain one.
    """
    both = (plain, nuisances), (richer, nuisances if beliefs is None else beliefs)
    together = [list(range(first, len(parts), MOST_FITS)) for first in range(min(len(parts), MOST_FITS))]
    errors = np.empty((2, len(parts)))
    for row, (model, believed) in zip(errors, both, strict=True):
        for chosen in together:
            row[chosen] = _errors(model, balances, believed, noise, [parts[i] for i in chosen])
    return paired(*errors)


def _errors(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], noise: float, parts: Sequence[Masks]
) -> list[float]:
    """Return the sum of squares on each of some parts, of a model fitted without them."""
    kept = [s.sliding & ~np.logical_or.reduce(out) for s, out in zip(balances, zip(*parts, strict=True), strict=True)]
    fitted = fit(model, balances, nuisances, noise=noise, masks=kept, evaluations=EVALUATIONS).model
    fitted = with_phases(fitted, [s for s, mask in zip(balances, kept, strict=True) if not mask.any()], nuisances)
    rest = [fitted.remainder(s, nuisances) for s in balances]
    return [float(np.sum(np.concatenate([r[out] for r, out in zip(rest, part, strict=True)]) ** 2)) for part in parts]


def _split(mask: npt.NDArray[np.bool_], balances: Sequence[ForceBalance]) -> Masks:
    return np.split(mask, np.cumsum([len(s.sliding) for s in balances])[:-1])
