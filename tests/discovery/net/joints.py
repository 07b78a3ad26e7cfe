"""Driven joints and spring sliders of the net: motions in closed form, forces on paper."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict

Array = npt.NDArray[np.float64]
Force = Callable[[Array, Array, Array], Array]
"""(time [s], position, velocity) -> friction against the motion [N or N m]."""

DURATION = 6.0
"""Length of a run [s]."""
COULOMB, TRANSITION = 2.0, 1.0e-3
"""Coulomb friction [N or N m] and the speed at which it turns round [1/s or m/s]."""


def _coulomb(velocity: Array) -> Array:
    return COULOMB * np.tanh(velocity / TRANSITION)


def _stribeck(t: Array, q: Array, v: Array) -> Array:
    return _coulomb(v) * (1.0 + 0.5 * np.exp(-np.abs(v) / 0.05))


HIDDEN: dict[str, Force] = {
    "nothing": lambda t, q, v: _coulomb(v),
    "viscous": lambda t, q, v: _coulomb(v) + 1.5 * v,
    "asymmetry": lambda t, q, v: _coulomb(v) * (1.0 + 0.2 * np.sign(v)),
    "stribeck": _stribeck,
    "wave": lambda t, q, v: _coulomb(v) * (1.0 + 0.25 * np.cos(2.0 * np.pi * q / 0.05)),
    "warming": lambda t, q, v: _coulomb(v) * (1.0 - 0.04 * t),
    "drag": lambda t, q, v: _coulomb(v) + 4.0 * np.abs(v) * v,
    "two": lambda t, q, v: _coulomb(v) * (1.0 + 0.15 * np.sign(v)) + 1.0 * v,
}
"""Friction of the joints."""


def _motion(t: Array, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    a, b = rng.uniform(0.0, 2.0 * np.pi, 2)
    q = 0.1 * np.sin(4.0 * t + a) + 0.03 * np.sin(9.0 * t + b)
    v = 0.4 * np.cos(4.0 * t + a) + 0.27 * np.cos(9.0 * t + b)
    return q, v, -1.6 * np.sin(4.0 * t + a) - 2.43 * np.sin(9.0 * t + b)


def _dataset(runs: list[Run], mechanism: dict[str, object], uncertainty: dict[str, float], mu: float) -> Dataset:
    tables = {
        "schema": "stochfric.scenario/1",
        "title": "net",
        "mechanism": mechanism,
        "law": {"kind": "coulomb", "mu_s": mu, "mu_k": mu},
        "uncertainty": uncertainty,
        "simulation": {"duration": DURATION, "output_step": 1.0e-3},
    }
    return Dataset(title="net", scenario_path=None, scenario=any_scenario_from_dict(tables), runs=tuple(runs))


def slide(hidden: str, seed: int, *, rate: float = 1000.0, noise: float = 0.05) -> Dataset:
    """Return three records of a slide whose force is measured, the last held out."""
    runs: list[Run] = []
    for i in range(3):
        rng = np.random.default_rng([seed, i])
        t = np.arange(round(DURATION * rate)) / rate
        q, v, a = _motion(t, rng)
        force = 2.1 * a + HIDDEN[hidden](t, q, v) + noise * rng.standard_normal(len(t))
        channels = {"position": q + 1.0e-6 * rng.standard_normal(len(t)), "force": force}
        role = "test" if i == 2 else "fit"
        runs.append(Run(name=f"run {i}", role=role, time=t, channels=channels, sample_interval=1.0 / rate))
    mechanism: dict[str, object] = {"kind": "prismatic_joint", "mass": 2.0, "normal_force": 10.0}
    return _dataset(runs, mechanism, {"mass": 0.05, "offset": 0.1, "mu_s": 0.3, "mu_k": 0.3}, 0.2)


def hinge(hidden: str, seed: int, *, late: float = 0.0) -> Dataset:
    """Return three records of a driven pendulum whose torque is measured, ``late`` [s] after the angle, the last held out."""
    rate, runs = 500.0, list[Run]()
    for i in range(3):
        rng = np.random.default_rng([seed, i])
        t = np.arange(round(DURATION * rate)) / rate
        q, v, a = (6.0 * x for x in _motion(t, rng))
        torque = (0.51 * 0.16 + 0.02) * a + 0.51 * 0.4 * 9.81 * np.sin(q) + 0.1 * HIDDEN[hidden](t, q, v)
        torque = np.interp(t - late, t, torque) + 0.005 * rng.standard_normal(len(t))
        channels = {"position": q + 2.0e-5 * rng.standard_normal(len(t)), "torque": torque}
        role = "test" if i == 2 else "fit"
        runs.append(Run(name=f"run {i}", role=role, time=t, channels=channels, sample_interval=1.0 / rate))
    mechanism: dict[str, object] = {
        "kind": "hinge_pendulum", "mass": 0.5, "length": 0.4, "inertia": 0.02, "normal_force": 1.0
    }  # fmt: skip
    return _dataset(runs, mechanism, {"mass": 0.03, "inertia": 0.2, "offset": 0.02, "mu_s": 0.3, "mu_k": 0.3}, 0.2)


def slider(direct: float, evolving: float, seed: int) -> Dataset:
    """Return velocity steps of a spring slider with the ageing law; ``direct`` and ``evolving``: its a and b [-]."""
    stiffness, distance, slow, fast = 2.0e3, 1.0e-5, 3.0e-6, 1.0e-5
    ends = (0.0, 20.0, 40.0, 44.0, 60.0, 80.0)
    speeds = (slow, fast, fast, slow, slow)
    roles = ("fit", "fit", "test", "fit", "test")

    def drive(t: float) -> float:
        return speeds[min(int(np.searchsorted(ends[1:-1], t, side="right")), len(speeds) - 1)]

    def slopes(t: float, state: Array) -> list[float]:
        mu, log_theta = state
        speed = slow * np.exp((mu - 0.6 - evolving * (log_theta - np.log(distance / slow))) / direct)
        return [stiffness * (drive(t) - speed), np.exp(-log_theta) - speed / distance]

    t = np.arange(0.0, ends[-1], 0.02)
    solved = solve_ivp(slopes, (0.0, t[-1]), [0.6, np.log(distance / slow)], "LSODA", t, rtol=1e-8, atol=1e-10, max_step=0.05)
    rng = np.random.default_rng(seed)
    mu = solved.y[0] + 2.0e-4 * rng.standard_normal(len(t))
    position = np.cumsum([drive(s) for s in t]) * 0.02
    whole = Run(
        name="whole", role="fit", time=t, channels={"position": position}, covariates={"friction_coefficient": mu},
        sample_interval=0.02,
    )  # fmt: skip
    pieces = zip(ends[:-1], ends[1:], roles, strict=True)
    runs = [whole.between(a, b, name=f"piece {i}", role=role) for i, (a, b, role) in enumerate(pieces)]
    mechanism: dict[str, object] = {"kind": "spring_slider", "stiffness": 1.8e3}
    return _dataset(runs, mechanism, {"stiffness": 0.5, "mu_s": 0.05, "mu_k": 0.05}, 0.6)
