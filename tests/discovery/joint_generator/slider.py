"""The spring slider: mu' = k (V - v), friction by a rate-and-state law, integrated in log v by an implicit method.

Dieterich 1979; Ruina 1983; regularisation as Rice and Ben-Zion 1996: v = 2 v_0 exp(-psi/a) sinh(mu/a).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from .plant import Array

V_0 = 1e-6
RATE = 50.0
STEP_TIME = 12.0

StateLaw = Callable[[float, float, float], float]
"""(theta [s], v [m/s], D [m]) -> theta' [-]."""


def ageing(theta: float, v: float, distance: float) -> float:
    return 1.0 - v * theta / distance


def slipping(theta: float, v: float, distance: float) -> float:
    x = v * theta / distance
    return -x * np.log(max(x, 1e-12))


def quadratic(theta: float, v: float, distance: float) -> float:
    """Perrin, Rice and Zheng 1995."""
    return 1.0 - (0.5 * v * theta / distance) ** 2


@dataclass(frozen=True)
class RateAndState:
    """mu = mu_0 + a ln(v/v_0) + sum b_i ln(v_0 theta_i/D_i) + added(t, displacement)."""

    mu_0: float
    a: float
    b: tuple[float, ...] = ()
    distance: tuple[float, ...] = ()
    state: StateLaw = ageing
    added: Callable[[Array, Array], Array] | None = None


def record(law: RateAndState, stiffness: float, velocities: Array, noise: float, rng: np.random.Generator) -> dict[str, Array]:
    """Load point and friction of a test with these load-point velocities [m/s], each for STEP_TIME."""
    n = round(STEP_TIME * RATE)
    times = np.arange(n * velocities.size) / RATE
    speeds = np.repeat(velocities, n)
    place = np.concatenate([[0.0], np.cumsum(speeds[:-1])]) / RATE
    mu = np.full(times.size, law.mu_0) if law.a == 0.0 else _coefficient(law, stiffness, velocities, n)
    if law.added is not None:
        mu = mu + law.added(times, place)
    return {
        "time [s]": times,
        "position [m]": place + 2e-9 * rng.standard_normal(times.size),
        "friction_coefficient": mu + noise * rng.standard_normal(times.size),
    }


def _coefficient(law: RateAndState, stiffness: float, velocities: Array, n: int) -> Array:
    b, distance = np.array(law.b), np.array(law.distance)
    theta = distance / velocities[0]
    mu_start = law.mu_0 + law.a * np.log(velocities[0] / V_0) + float(np.sum(b * np.log(V_0 / velocities[0])))
    state = np.concatenate([[mu_start], np.log(theta)])
    pieces = []
    for velocity in velocities:

        def rates(_: float, y: Array, velocity: float = velocity) -> Array:
            thetas = np.exp(y[1:])
            v = V_0 * np.exp((y[0] - law.mu_0 - np.sum(b * np.log(V_0 * thetas / distance))) / law.a)
            slow = [law.state(t, v, d) / t for t, d in zip(thetas, distance, strict=True)]
            return np.array([stiffness * (velocity - v), *slow])

        at = np.arange(n + 1) / RATE
        solved = solve_ivp(rates, (0.0, at[-1]), state, method="Radau", t_eval=at, rtol=1e-8, atol=1e-10)
        pieces.append(solved.y[0, :-1])
        state = solved.y[:, -1]
    return np.concatenate(pieces)
