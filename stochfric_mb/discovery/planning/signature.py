"""What an effect would leave in data that are not there yet, beyond what the stated model can imitate."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.effects import effect_class
from stochfric_mb.effects.traits import POSITIVE

Array = npt.NDArray[np.float64]

STRONG = 3.0
"""Size over the detection limit up to which effects must differ to count as distinguished [-]."""

BEYOND = 1.0 / (1.0 - criteria.MATERIAL) ** 2 - 1.0
"""Mean square over that of what stays that an effect must take away to lower the error by a material part [-]."""


@dataclasses.dataclass(frozen=True)
class Signature:
    """One form of an effect; signals are in standard deviations of the data, at the detection limit."""

    kind: str
    """The effect."""
    parameter: str
    """The parameter that is its size."""
    unit: str
    """Its unit."""
    limit: float
    """Its detection limit: the size at which the expected evidence reaches the score of a name."""
    beside: Mapping[str, float | str]
    """Other numbers that the limit belongs to, such as a wavelength [SI]."""
    signals: tuple[Array, ...]
    """Change of the data at the limit, one for each phase that it may have, shape (rows,) each."""
    columns: Array
    """What a search for the effect fits, shape (rows, p)."""

    at_most: bool = False
    """Whether the limit is an upper bound: below it the effect is not in proportion to its size."""

    @property
    def needed(self) -> float:
        """Evidence at the limit: 2 delta log L [-]."""
        return float(np.mean([s @ s for s in self.signals]))


def separation(true: Signature, other: Sequence[Signature]) -> float:
    """Return the size over its limit from which on an effect is distinguished from another one; inf: at no size.

    The other one explains the share r^2 of the evidence E = size^2 needed, r the correlation. Effects are of one class where
    their scores differ by less than `criteria.ALIKE_SCREENED`, or by less than the share `criteria.ALIKE_SHARE`.

    Args:
        true: the effect that is there.
        other: the forms of the one that is fitted in its place.
    """
    missed = min((missed_share(true, form) for form in other), default=1.0)
    if missed <= criteria.ALIKE_SHARE:
        return float("inf")
    return max(float(np.sqrt(criteria.ALIKE_SCREENED / (missed * true.needed))), 1.0)


def missed_share(true: Signature, form: Signature) -> float:
    """Return the share of the evidence for an effect that another one leaves unexplained [-]."""
    size = np.linalg.norm(form.columns, axis=0)
    kept = size > 1.0e-9 * max(float(size.max(initial=0.0)), 1.0e-300)
    if not kept.any():
        return 1.0
    basis, triangle = np.linalg.qr(form.columns[:, kept] / size[kept])
    basis = basis[:, np.abs(np.diag(triangle)) > 1.0e-6]
    if _of_one_sign(form.kind) and _of_one_sign(true.kind) and float(form.columns[:, 0] @ true.signals[0]) < 0.0:
        return 1.0  # it would have to be negative
    left = [s @ s - (b := basis.T @ s) @ b for s in true.signals]
    return float(np.mean(left)) / true.needed


def _of_one_sign(kind: str) -> bool:
    return POSITIVE in effect_class(kind).traits


def best_of_each(signatures: Sequence[Signature]) -> dict[str, Signature]:
    """Return the form of each kind with the smallest limit, of those whose size is the number of the first that shows."""
    table: dict[str, Signature] = {}
    for one in signatures:
        best = table.setdefault(one.kind, one)
        if one.limit < best.limit and (one.parameter == best.parameter or math.isinf(best.limit)):
            table[one.kind] = one
    return table


def needed_for_a_name(parameters: int, independent: float, tried: float) -> float:
    """Return the evidence, 2 delta log L, that an effect needs to be named [-].

    Args:
        parameters: numbers that it adds to a fit.
        independent: independent numbers in the data.
        tried: starting points times kinds.
    """
    return criteria.NAMED + parameters * math.log(independent) + 2.0 * math.log(tried)


Apart = Callable[[Signature, Sequence[Signature]], float]


def confused_pairs(signatures: Sequence[Signature], apart: Apart = separation) -> dict[tuple[str, str], float]:
    """Return the pairs of effects that are not distinguished up to `STRONG` limits, and the multiple from which on they are.

    Args:
        signatures: the forms of all effects.
        apart: effect and forms of another -> the size over its limit from which on it is distinguished from that one.
    """
    best = best_of_each([s for s in signatures if s.signals])
    forms = {kind: [s for s in signatures if s.kind == kind] for kind in best}
    pairs: dict[tuple[str, str], float] = {}
    for i, first in enumerate(best):
        for second in list(best)[i + 1 :]:
            multiple = max(apart(best[first], forms[second]), apart(best[second], forms[first]))
            if multiple > STRONG:
                pairs[first, second] = multiple
    return pairs
