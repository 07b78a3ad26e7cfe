"""Impacts: knocks on the body at random times."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.coefficients.philox import normals, uniforms
from stochfric_mb.effects.contract import LOAD, SAMPLE, SEED, TIME, Effect, parameter
from stochfric_mb.effects.traits import KICKS, RANDOM
from stochfric_mb.errors import InputError

ADDRESS = 0x696D7061
"""Third part of the address of the draws: no contact has this number."""
MOST = 20
"""Most impacts within one mean interval (more have a probability below 1e-18)."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Impacts(Effect):
    """A Poisson process of pulses, each of normal size, mean ``mean`` and standard deviation ``impulse``.

    A pulse has the shape (J/duration) (1 - cos(2 pi tau/duration)), 0 <= tau <= duration. In each mean interval 1/rate
    the number of impacts is Poisson with mean 1 and their times are uniform, which is a Poisson process; numbers, times
    and sizes are addressed by (seed, sample, interval, impact), so that every engine sees the same.

    Reference: D. R. Cox, V. Isham, Point Processes, Chapman and Hall 1980, section 3.1.
    """

    rate: float = parameter("1/s", "mean number of impacts per second", scale=0.5, low=0.0, strict=True)
    """Mean number of impacts per second [1/s]."""
    impulse: float = parameter("N s", "standard deviation of an impact's impulse", scale=0.02, low=0.0)
    """Standard deviation of an impact's impulse [N s]."""
    duration: float = parameter("s", "duration of an impact", scale=2.0e-3, low=0.0, strict=True, default=2.0e-3)
    """Duration of an impact [s], at most 1/rate."""
    mean: float = parameter("N s", "mean of an impact's impulse", scale=0.02, default=0.0)
    """Mean of an impact's impulse [N s]: 0, blows from both sides."""

    kind: ClassVar[str] = "impacts"
    equation: ClassVar[str] = "further force: Poisson pulses (J/duration) (1 - cos(2 pi tau/duration)), J normal"
    source: ClassVar[str] = "Cox and Isham 1980 (Poisson process)"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({RANDOM})
    signatures: ClassVar[tuple[str, ...]] = (KICKS,)
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "single impacts let the box break away early or jump"

    def draws(self, duration: float, slips: int) -> float:
        """Return the number of impacts in a duration, on average."""
        return max(duration * self.rate, 1.0)

    def deviations(self, draws: float) -> dict[str, float]:
        """Return those of a Poisson process with normal sizes."""
        root = math.sqrt(draws)
        return {"impulse": self.impulse / (math.sqrt(2.0) * root), "mean": self.impulse / root, "rate": self.rate / root}

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.duration * self.rate > 1.0:
            raise InputError(
                f"impacts.duration = {self.duration:g} s is above 1/rate = {1.0 / self.rate:g} s; give shorter or fewer impacts"
            )

    def shortest_time(self, speed: float) -> float:
        """Return a time [s] of which a twentieth resolves an impact."""
        return 5.0 * self.duration


def surroundings(world, memory, rates, p):
    """Add the pulses that act at this time: of this interval and of the one before."""
    here = math.floor(world[TIME] * p[0])
    for interval in range(here - 1, here + 1):
        u, _ = uniforms(int(world[SEED]), int(world[SAMPLE]), ADDRESS, interval, 0)
        likely = math.exp(-1.0)
        total = likely
        for i in range(1, MOST + 1):
            if u <= total:
                break
            likely /= i
            total += likely
            moment, _ = uniforms(int(world[SEED]), int(world[SAMPLE]), ADDRESS, interval, 2 * i - 1)
            tau = world[TIME] - (interval + moment) / p[0]
            if 0.0 < tau < p[2]:
                size, _ = normals(int(world[SEED]), int(world[SAMPLE]), ADDRESS, interval, 2 * i)
                world[LOAD] += (p[3] + p[1] * size) / p[2] * (1.0 - math.cos(2.0 * math.pi * tau / p[2]))
