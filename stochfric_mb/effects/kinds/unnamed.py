"""Unnamed term: friction that changes smoothly along an axis, in a way that no named effect explains."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np
from numpy.polynomial import legendre

from stochfric_mb.effects.contract import (
    MU_K,
    MU_S,
    NORMAL_FORCE,
    POSITION,
    SLIP,
    SPEED,
    TEMPERATURE,
    TIME,
    Array,
    Effect,
    choice,
    parameter,
)
from stochfric_mb.effects.traits import ANONYMOUS
from stochfric_mb.errors import InputError

AXES = {"speed": "m/s", "position": "m", "slip": "m", "time": "s", "load": "N", "temperature": "degC"}
"""Axis -> unit of its ends."""
WORDS = {
    "speed": "relative velocity", "position": "position of the box", "slip": "distance slid since break-away",
    "time": "time within the run", "load": "normal force", "temperature": "temperature",
}  # fmt: skip
"""Axis -> its name for readers."""
CHANGES = tuple(f"change_{i}" for i in range(1, 7))
"""Parameters that are the table, from the second knot on."""

LEAST_LOAD = 1.0e-3
"""Normal force over the reference load below which the force of the table falls with it [-]: nothing presses there."""
FINER = 0.01
"""Deviation of the first polynomial by which a fit may move the curve [-]: it is that of the features, forecasts refine it."""
SMOOTH, CORNERS = 4, 0.05
"""Polynomials by which it may move, the k-th one by 1/k^2 of the first, and single knots beside them over the first [-]: a few
runs each tell a number or two, and knots of their own would follow any of them."""


def _change(knot: int) -> float:
    return parameter("-", f"change of mu_k at knot {knot} of 6 after the first", scale=0.03, default=0.0, fit_prior=FINER)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Unnamed(Effect):
    """mu_k plus a table over speed, position, slip, time, load or temperature, and mu_s plus static_share times it.

    With a reference load the table counts times reference_load/N: what it adds is a force of its own. The table is linear
    between seven knots, evenly spaced from ``low`` to ``high``, 0 at the first and constant outside.

    Reference: C. de Boor, A Practical Guide to Splines, Springer 1978, chapter III (broken lines).
    """

    axis: str = choice("along what friction changes", tuple(AXES))
    """Along what friction changes: "speed" past the counter-surface, "position", "slip" since break-away, "time", "load" or
    "temperature"."""
    low: float = parameter("-", "place of the first knot, in the unit of the axis", scale=0.0)
    """Place of the first knot [m/s, m, s, N or degC]."""
    high: float = parameter("-", "place of the last knot, in the unit of the axis", scale=1.0)
    """Place of the last knot [m/s, m, s, N or degC], above ``low``."""
    static_share: float = parameter("-", "change of mu_s over that of mu_k", scale=1.0, default=0.0)
    """Change of mu_s over that of mu_k [-]: 0, mu_k alone; 1, both alike."""
    change_1: float = _change(1)
    """Change of mu_k at the second knot [-]; it is 0 at the first."""
    change_2: float = _change(2)
    """The same at the third knot [-]."""
    change_3: float = _change(3)
    """The same at the fourth knot [-]."""
    change_4: float = _change(4)
    """The same at the fifth knot [-]."""
    change_5: float = _change(5)
    """The same at the sixth knot [-]."""
    change_6: float = _change(6)
    """The same at the seventh knot [-]."""
    reference_load: float = parameter(
        "N", "normal force at which the changes hold, if they are a force that it does not change", scale=10.0, low=0.0,
        default=0.0,
    )  # fmt: skip
    """Normal force at which the changes hold, the force that they make being the same at any other [N]; 0: the force grows with
    the load, as friction does."""

    kind: ClassVar[str] = "unnamed"
    equation: ClassVar[str] = (
        "mu_k plus a table over speed, position, slip, time, load or temperature, mu_s plus static_share times it"
    )
    source: ClassVar[str] = "de Boor 1978, chapter III (broken lines)"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({ANONYMOUS})
    order: ClassVar[int] = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.axis == "temperature":  # one table of many: the kind itself reads nothing
            object.__setattr__(self, "reads", ("temperature",))
        if self.high <= self.low:
            raise InputError(
                f"unnamed.high = {self.high:g} is not above low = {self.low:g}; give the places of the last and first knot"
            )

    def appears(self) -> tuple[str, str]:
        """Return the axis in words, and that it has no name."""
        return WORDS[self.axis], f"friction changes along the {WORDS[self.axis]}, in a way that no known effect explains"

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return the ends of the table, which are those of the motion."""
        return ("low", "high")

    def fitted_together(self) -> tuple[tuple[str, ...], Array]:
        """Return the knots: the curve is smooth."""
        waves = legendre.legvander(np.linspace(-1.0, 1.0, len(CHANGES) + 1), SMOOTH)[:, 1:]
        moved = (waves - waves[0])[1:] / np.arange(1, SMOOTH + 1) ** 2
        return CHANGES, moved @ moved.T + CORNERS**2 * np.eye(len(CHANGES))

    def unit_of(self, name: str) -> str:
        """Return the unit of a parameter; that of the ends is the axis's."""
        return AXES[self.axis] if name in ("low", "high") else super().unit_of(name)


def friction(world, memory, rates, p):
    """Add the table to both coefficients."""
    s = world[SPEED]
    if p[0] == 1.0:
        s = world[POSITION]
    elif p[0] == 2.0:
        s = world[SLIP]
    elif p[0] == 3.0:
        s = world[TIME]
    elif p[0] == 4.0:
        s = world[NORMAL_FORCE]
    elif p[0] == 5.0:
        s = world[TEMPERATURE]
    k = 6.0 * (s - p[1]) / (p[2] - p[1])
    change = p[4] * min(max(k, 0.0), 1.0)
    change += (p[5] - p[4]) * min(max(k - 1.0, 0.0), 1.0)
    change += (p[6] - p[5]) * min(max(k - 2.0, 0.0), 1.0)
    change += (p[7] - p[6]) * min(max(k - 3.0, 0.0), 1.0)
    change += (p[8] - p[7]) * min(max(k - 4.0, 0.0), 1.0)
    change += (p[9] - p[8]) * min(max(k - 5.0, 0.0), 1.0)
    if p[10] > 0.0:
        change *= p[10] / max(world[NORMAL_FORCE], LEAST_LOAD * p[10])
    world[MU_K] = max(world[MU_K] + change, 0.0)
    world[MU_S] = max(world[MU_S] + p[3] * change, 0.0)
