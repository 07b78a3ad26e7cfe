"""Second mode: an oscillator hung on the body."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, MASS, POSITION, VELOCITY, Array, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips
from stochfric_mb.effects.oscillator import oscillator_pull
from stochfric_mb.effects.traits import POSITIVE, SHAPES_SLIPS

RATIOS = (0.01, 0.03, 0.1)
"""Damping ratios with which a second mode is looked for [-]; its frequencies lie as close, relatively, as it is wide."""
MOST_DAMPED = RATIOS[-1]
"""Damping ratio up to which a second mode is looked for [-]: one that hardly rings could stand for any shape."""
FREQUENCIES = (1.5, 7.0)
"""Frequencies between which it is looked for, over that of the box on its spring [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SecondMode(Effect):
    """r'' + 2 damping_ratio w r' + w^2 r = -x'', w = 2 pi frequency.

    The force on the body is mass_ratio m (w^2 r + 2 damping_ratio w r'). r is the oscillator's position relative to the
    body; memory = (q, q') with q = x + r, so that no acceleration is needed.

    Reference: J. P. Den Hartog, Mechanical Vibrations, 4th ed., McGraw-Hill 1956, section 3.2.
    """

    mass_ratio: float = parameter("-", "mass of the oscillator over that of the body", scale=0.05, low=0.0, high=1.0)
    """Mass of the oscillator over that of the body [-]."""
    frequency: float = parameter("Hz", "its frequency with the body held", scale=20.0, low=0.0, strict=True)
    """Its frequency with the body held [Hz]."""
    damping_ratio: float = parameter(
        "-", "its damping ratio", scale=0.01, low=0.0, high=1.0, default=0.01, fit_high=MOST_DAMPED
    )
    """Its damping ratio [-]."""

    kind: ClassVar[str] = "second_mode"
    equation: ClassVar[str] = (
        "r'' + 2 damping_ratio w r' + w^2 r = -x'', w = 2 pi frequency; force mass_ratio m (w^2 r + 2 damping_ratio w r')"
    )
    source: ClassVar[str] = "Den Hartog 1956, chapter 3 (the dynamic absorber)"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    frees: ClassVar[tuple[str, ...]] = ("mass",)
    shows_on: ClassVar[str] = "frequency"
    shows: ClassVar[str] = "the box rings with a second mode in slip"
    n_memory: ClassVar[int] = 2

    def shortest_time(self, speed: float) -> float:
        """Return the period [s]."""
        return 1.0 / self.frequency

    def left_open(self) -> Mapping[str, tuple[float, float]]:
        """Return that no more than the oscillator may be missing of the stated mass, and that any mass may come with it.

        It may have been weighed with the body, and what holds it, and oscillators of higher frequencies, may not.
        """
        return {"mass": (-self.mass_ratio / (1.0 + self.mass_ratio), math.inf)}

    def rest(self, position: Array, velocity: Array) -> Array:
        """Return (q, q') of an oscillator that moves along with the body, shape (n, 2)."""
        return np.stack([position, velocity], axis=1)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the force of a light oscillator on the box, driven by the slips; the box's own mass is left open."""
        natural = slips.slips[0].record.angular_frequency / (2.0 * np.pi)
        mass = slips.per_run(lambda s: s.record.mechanism.mass)
        inertia = slips.column(None, -mass[:, None] * slips.node_acceleration)
        items: list[Hypothesis] = []
        for ratio in RATIOS:
            for frequency in natural * np.geomspace(*FREQUENCIES, 1 + round(math.log(FREQUENCIES[1] / FREQUENCIES[0]) / ratio)):
                onset, nodes = oscillator_pull(slips, frequency, ratio)

                def start(b: Array, frequency: float = frequency, ratio: float = ratio) -> dict[str, float]:
                    share = float(np.clip(b[0], 0.005, 0.9))
                    return {"mass_ratio": share, "frequency": frequency, "damping_ratio": ratio, "mass": float(b[1])}

                columns = [slips.column(mass * onset, mass[:, None] * nodes), inertia]
                items.append(Hypothesis(cls.kind, columns, (frequency, ratio), start))
        return items


def surroundings(world, memory, rates, p):
    """Add the oscillator's force; write its motion."""
    w = 2.0 * math.pi * p[1]
    pull = w * w * (memory[0] - world[POSITION]) + 2.0 * p[2] * w * (memory[1] - world[VELOCITY])
    rates[0] = memory[1]
    rates[1] = -pull
    world[LOAD] += p[0] * world[MASS] * pull
