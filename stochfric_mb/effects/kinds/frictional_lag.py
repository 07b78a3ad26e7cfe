"""Frictional lag: friction falls from static to kinetic over a sliding distance, or over a time."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, SLIP, SLIP_TIME, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import MEMORY, POSITIVE, SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class FrictionalLag(Effect):
    """mu = mu_k + (mu_s - mu_k) exp(-slip/distance - slip_time/time_constant), both counted from break-away.

    This is a memory f with f' = -f (abs(v_rel)/distance + 1/time_constant) that a stick phase fills to 1.

    References: E. Rabinowicz, Proc. Phys. Soc. 71, 1958, 668-675, doi 10.1088/0370-1328/71/4/316 (distance);
    D. P. Hess, A. Soom, J. Tribology 112, 1990, 147-152, doi 10.1115/1.2920220 (a lag in time).
    """

    distance: float = parameter(
        "m", "sliding distance over which friction falls to 1/e", scale=1.0e-4, low=0.0, strict=True, infinite=True,
        default=math.inf,
    )  # fmt: skip
    """Sliding distance over which friction falls to 1/e [m]."""
    time_constant: float = parameter(
        "s", "time over which friction falls to 1/e", scale=1.0e-2, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Time over which friction falls to 1/e [s]."""

    kind: ClassVar[str] = "frictional_lag"
    equation: ClassVar[str] = "mu = mu_k + (mu_s - mu_k) exp(-slip/distance - slip_time/time_constant)"
    source: ClassVar[str] = "Rabinowicz 1951, 1958; Dieterich 1979; Hess and Soom 1990"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    signatures: ClassVar[tuple[str, ...]] = (MEMORY,)
    frees: ClassVar[tuple[str, ...]] = ("mu_s",)
    form_axis: ClassVar[str] = "slip"
    shows_on: ClassVar[str] = "slip distance"
    shows: ClassVar[str] = "friction falls with the distance slid after a break-away, not at once"
    order: ClassVar[int] = 2

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a memory of parts of the stroke."""
        starts = tuple(cls(distance=span.stroke * part) for part in (0.003, 0.02, 0.1))
        return JointSignature(starts, "distance since reversal", 2)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that falls with the distance slipped since the break-away, or with the time."""
        gap = np.maximum(slips.static - slips.kinetic, 0.02 * slips.static)[:, None]
        items: list[Hypothesis] = []
        for name, since, shares in (
            ("distance", slips.slip_distance, (0.007, 0.014, 0.028, 0.056, 0.11, 0.22)),
            ("time_constant", slips.node_time - slips.onset_time[:, None], (0.03, 0.06, 0.12, 0.24)),
        ):
            whole = float(np.median(since.max(axis=1)))
            for scale in whole * np.array(shares):

                def start(b: Array, name: str = name, scale: float = scale) -> dict[str, float]:
                    return {name: float(scale * np.clip(b[0], 0.2, 3.0))}

                columns = [slips.column(None, gap * np.exp(-since / scale))]
                items.append(Hypothesis(cls.kind, columns, (scale,), start, variant=name))
        return items


def friction(world, memory, rates, p):
    """Let mu_k start at mu_s."""
    world[MU_K] += (world[MU_S] - world[MU_K]) * math.exp(-world[SLIP] / p[0] - world[SLIP_TIME] / p[1])
