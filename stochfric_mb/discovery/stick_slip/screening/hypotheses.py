"""What effects would leave in the slips: asked of the effects themselves, those of installed packages included."""

from __future__ import annotations

from collections.abc import Sequence

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.effects.marks import Hypothesis, Wave


def hypotheses_in(pool: Pool, *, without: Sequence[str] = ()) -> dict[str, list[Hypothesis]]:
    """Return kind -> the ways in which an effect may have marked the slips; ``without``: kinds that are not asked."""
    table = {kind: effect_class(kind).hypotheses(pool) for kind in effect_kinds() if kind not in without}
    return {kind: some for kind, some in table.items() if some}


def waves_in(pool: Pool, *, without: Sequence[str] = ()) -> dict[str, Wave]:
    """Return kind -> where a periodic effect runs and what it modulates; ``without``: kinds that are not asked."""
    table = {kind: effect_class(kind).wave(pool) for kind in effect_kinds() if kind not in without}
    return {kind: wave for kind, wave in table.items() if wave is not None}
