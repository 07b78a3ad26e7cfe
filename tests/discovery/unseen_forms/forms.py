"""What a form is, and the list of all of them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from scipy.signal import lfilter

from .motion import World

UNKNOWN, NONE = "unknown", "none"
KINDS = {
    "random_coefficients": "randomness",
    "correlated_coefficients": "randomness",
    "velocity_weakening": "friction law",
    "viscous_friction": "friction law",
    "dwell_ageing": "friction law",
    "frictional_lag": "friction law",
    "direction_asymmetry": "friction law",
    "load_dependence": "friction law",
    "presliding_compliance": "friction law",
    "position_dependent_friction": "friction varies",
    "friction_drift": "friction varies",
    "distance_drift": "friction varies",
    "temperature_drift": "friction varies",
    "normal_load_ripple": "mechanism",
    "belt_speed_ripple": "mechanism",
    "nonlinear_stiffness": "mechanism",
    "quadratic_damping": "mechanism",
    "backlash": "mechanism",
    "second_mode": "mechanism",
    "harmonic_force": "mechanism",
    "impacts": "mechanism",
    "sensor_drift": "sensor",
    "sensor_step": "sensor",
    "sensor_clipping": "sensor",
    "sensor_outliers": "sensor",
    "sensor_delay": "sensor",
}
"""Vocabulary: name -> class."""
AT_JOINTS = {"position_dependent_force": "mechanism", "stale_samples": "sensor"}
"""The same of names that are looked for at driven joints alone: on a belt rig `unknown` is right as well."""


@dataclasses.dataclass(frozen=True)
class Form:
    """One way in which a rig may differ from what is believed of it."""

    name: str
    """Unique among forms."""
    apply: Callable[[World, float], None]
    """Gives a world the form at a strength; 0 changes nothing."""
    truth: frozenset[str]
    """First names that count as right; {"unknown"} or {"none"}."""
    truth_one: frozenset[str]
    """The same where there is one operating point, which may not tell them apart."""
    rig: str
    """Name of the rig."""
    designs: tuple[str, ...]
    """Designs under which it shows, `one` or `several`."""
    source: str
    """Author and year."""
    options: dict[str, object]
    """What is special about its records (`records.py`)."""
    series: int = 1
    """The set that it was written for: 1, 2 (`second_forms.py`), 3 (`third`), and so on to 18 (`eighteenth`)."""

    def right(self, design: str) -> frozenset[str]:
        """Return the first names that count as right in `design`."""
        return self.truth_one if design == "one" else self.truth

    def classes(self, design: str) -> frozenset[str]:
        """Return the classes that count as right in `design`."""
        return frozenset((KINDS | AT_JOINTS).get(name, name) for name in self.right(design))


FORMS: dict[str, Form] = {}
"""Name -> form."""

ROTA = ("paper", "paper", "small", "paper", "fast")
"""Rigs that forms take in turn."""


def form(
    *truth: str,
    source: str,
    also_one: tuple[str, ...] = (),
    rig: str | None = None,
    designs: tuple[str, ...] = ("one", "several"),
    series: int = 1,
    **options: object,
) -> Callable:
    """Enter a function (world, strength) into the list of forms under its own name."""

    def entered(apply: Callable[[World, float], None]) -> Callable[[World, float], None]:
        name = apply.__name__
        if name in FORMS:
            raise ValueError(f"{name} stands twice")
        right = frozenset(truth)
        chosen = rig or ROTA[len(FORMS) % len(ROTA)]
        FORMS[name] = Form(name, apply, right, right | set(also_one), chosen, designs, source, options, series)
        return apply

    return entered


def each_stick(world: World, act: Callable) -> None:
    """Call `act` at the start of the run and at the end of each slip."""
    act(None)
    world.on_stick = act


def steady_noise(rng: np.random.Generator, duration: float, correlation_time: float, *, order: int = 1) -> Callable:
    """Return a stationary function of time with unit variance: Ornstein-Uhlenbeck (order 1) or Matern 3/2 (order 2)."""
    h = correlation_time / 50.0
    decay = np.exp(-h / correlation_time)
    value = rng.standard_normal(int(duration / h) + 1060)
    for _ in range(order):
        value = lfilter([1.0], [1.0, -decay], value)
    variance = (1.0 / (1.0 - decay**2), (1.0 + decay**2) / (1.0 - decay**2) ** 3)[order - 1]
    value = value[1000:] / np.sqrt(variance)
    grid = h * np.arange(len(value))
    return lambda t: np.interp(t, grid, value)


def arrivals(rng: np.random.Generator, duration: float, rate: float) -> np.ndarray:
    """Return the times of a Poisson process [s]."""
    return np.sort(rng.uniform(0.0, duration, rng.poisson(rate * duration)))


def warm(world: World) -> None:
    """Let the temperature rise and swing [degC], and record it."""
    hour = 30.0 * world.nominal.period

    def temperature(t):
        return 20.0 + 5.0 * (1.0 - np.exp(-t / hour)) + 4.0 * np.sin(2 * np.pi * t / (0.55 * hour))

    world.temperature = temperature
    world.columns["temperature [degC]"] = lambda t, motion: np.round(temperature(t), 2)
