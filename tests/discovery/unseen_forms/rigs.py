"""Belt rigs: what is believed of them, their sensors, and draws of what they truly are."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

UNCERTAINTY = {"mass": 0.003, "stiffness": 0.01, "damping": 0.2, "normal_force": 0.01, "mu_s": 0.05, "mu_k": 0.05}
"""Relative standard deviations of what is believed [-]."""
DEFAULT_UNCERTAINTY = UNCERTAINTY | {"mass": 0.01, "stiffness": 0.02, "damping": 0.3}
"""The same where a scenario states none, as docs/discovery.md says."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Rig:
    """A mass on a spring, pressed onto a belt: m x'' + c x' + k x = mu N sign(v_b - x') + k u_0 cos(W t)."""

    name: str
    """Name in case names and titles."""
    mass: float
    """[kg]."""
    stiffness: float
    """[N/m]."""
    damping: float
    """[N s/m]."""
    normal_force: float
    """[N]."""
    belt_velocity: float
    """[m/s]."""
    mu_s: float
    """[-]."""
    mu_k: float
    """[-]."""
    rate: float
    """Samples a second [Hz]."""
    noise: float
    """Standard deviation of the position sensor's white noise [m]."""
    unit: str
    """Unit of position in the files."""
    excitation_amplitude: float = 0.0
    """u_0 [m]."""
    excitation_angular_frequency: float = 0.0
    """W [rad/s]."""

    @property
    def pulsation(self) -> float:
        """Natural angular frequency [rad/s]."""
        return float(np.sqrt(self.stiffness / self.mass))

    @property
    def gap(self) -> float:
        """mu_s - mu_k [-]."""
        return self.mu_s - self.mu_k

    @property
    def reach(self) -> float:
        """Position at break-away, mu_s N/k [m]."""
        return self.mu_s * self.normal_force / self.stiffness

    @property
    def slip_length(self) -> float:
        """Length of a slip of the undamped rig at low belt speed [m]."""
        return 2.0 * self.gap * self.normal_force / self.stiffness

    @property
    def peak_speed(self) -> float:
        """Highest speed in a slip [m/s]."""
        return 0.5 * self.slip_length * self.pulsation + self.belt_velocity

    @property
    def period(self) -> float:
        """Duration of a stick-slip cycle of the undamped rig [s]."""
        return self.slip_length / self.belt_velocity + np.pi / self.pulsation

    def drawn(self, rng: np.random.Generator, *, at_limits: float = 0.0, uncertainty: Mapping[str, float] = UNCERTAINTY) -> Rig:
        """Return the true rig: each number within 1.5 of its standard deviations, or 2 `at_limits` of them off, up or down."""
        z = {key: float(np.clip(rng.standard_normal(), -1.5, 1.5)) for key in uncertainty}
        if at_limits:
            z = {key: 2.0 * at_limits if value > 0.0 else -2.0 * at_limits for key, value in z.items()}
        return dataclasses.replace(self, **{key: getattr(self, key) * (1.0 + sd * z[key]) for key, sd in uncertainty.items()})


PAPER = Rig(
    name="paper",
    mass=6.08,
    stiffness=3956.0,
    damping=0.768,
    normal_force=13.0,
    belt_velocity=2.5e-3,
    mu_s=0.8,
    mu_k=0.46,
    rate=1000.0,
    noise=2.0e-6,
    unit="m",
)
"""The rig of Kang, Choi and Yoo 2015, Table 1, with a laser triangulation sensor."""

EXCITED = dataclasses.replace(
    PAPER,
    name="excited",
    mass=5.632,
    stiffness=5610.0,
    normal_force=14.0,
    mu_k=0.55,
    belt_velocity=1.0e-3,
    excitation_amplitude=0.5e-3,
    excitation_angular_frequency=13.8,
)
"""The rig of Kang, Choi and Yoo 2015, Table 2: the foot of its spring is moved."""

SMALL = Rig(
    name="small",
    mass=0.05,
    stiffness=120.0,
    damping=0.012,
    normal_force=0.4,
    belt_velocity=1.0e-3,
    mu_s=0.45,
    mu_k=0.30,
    rate=1000.0,
    noise=0.8e-6,
    unit="um",
)
"""A bench tribometer with a leaf spring."""

FAST = Rig(
    name="fast",
    mass=1.2,
    stiffness=4.5e4,
    damping=4.0,
    normal_force=60.0,
    belt_velocity=10.0e-3,
    mu_s=0.5,
    mu_k=0.35,
    rate=5000.0,
    noise=0.4e-6,
    unit="mm",
)
"""A stiff machine slide."""

PRESS = Rig(
    name="press",
    mass=85.0,
    stiffness=2.4e6,
    damping=285.0,
    normal_force=3000.0,
    belt_velocity=1.5e-3,
    mu_s=0.28,
    mu_k=0.17,
    rate=1000.0,
    noise=0.4e-6,
    unit="mm",
)
"""A heavy slide, well damped."""

SOFT = Rig(
    name="soft",
    mass=0.3,
    stiffness=45.0,
    damping=0.05,
    normal_force=6.0,
    belt_velocity=20.0e-3,
    mu_s=0.65,
    mu_k=0.50,
    rate=200.0,
    noise=20.0e-6,
    unit="m",
)
"""A rubber wiper on a soft spring: strokes of centimetres."""

MICRO = Rig(
    name="micro",
    mass=2.0e-7,
    stiffness=1.5,
    damping=5.0e-6,
    normal_force=3.0e-5,
    belt_velocity=1.0e-3,
    mu_s=0.60,
    mu_k=0.35,
    rate=5.0e4,
    noise=5.0e-9,
    unit="um",
)
"""A micromachine: micrograms, ten micrometres, a hundredth of a second."""

RIGS = {rig.name: rig for rig in (PAPER, SMALL, FAST, EXCITED, PRESS, SOFT, MICRO)}
