"""Short slides one way: a block that is thrown and comes to rest, a few dozen samples each; nothing drives it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .plant import Array

RATE, STEPS = 200.0, 20
"""Frames a second, and steps of the integration between two."""
NOISE = 8e-5
"""Standard deviation of a position [m]."""
N_RUNS = 48


@dataclass(frozen=True)
class Throw:
    """Friction coefficient over speed [m/s] and place [m] in one slide; slowest and fastest start [m/s]; position noise [m]."""

    mu: Callable[[float, float], float]
    starts: tuple[float, float] = (1.1, 1.5)
    noise: float = NOISE


def record(throw: Throw, rng: np.random.Generator) -> dict[str, Array]:
    """Frames of a slide until it is nearly at rest."""
    h = 1.0 / (RATE * STEPS)
    x, v, places = 0.0, rng.uniform(*throw.starts), []
    for i in range(400 * STEPS):
        if i % STEPS == 0:
            places.append(x)
        half = v - 0.5 * h * 9.81 * throw.mu(v, x)
        x += h * half
        v -= h * 9.81 * throw.mu(half, x)
        if v < 0.05:
            break
    n = len(places)
    return {
        "time [s]": np.arange(n) / RATE,
        "position [m]": np.array(places) + throw.noise * rng.standard_normal(n),
        "force [N]": np.zeros(n),
    }
