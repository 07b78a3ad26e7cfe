"""The nominal rig, how well it is known, and the true rig."""

from dataclasses import dataclass, replace

import numpy as np

UNCERTAINTY = {"mass": 0.003, "stiffness": 0.01, "damping": 0.2, "normal_force": 0.01, "mu_s": 0.05, "mu_k": 0.05}
"""Relative standard deviations of the nominal numbers."""

_WIDEST = 2.0  # deviations are cut here: a longer tail would make a few cases about lost calibrations, not about effects


@dataclass(frozen=True)
class Rig:
    """Parameters of the belt-box rig, SI units, named as in a scenario."""

    mass: float = 6.08
    damping: float = 0.768
    stiffness: float = 3956.0
    normal_force: float = 13.0
    belt_velocity: float = 2.5e-3
    excitation_amplitude: float = 0.0
    excitation_angular_frequency: float = 0.0
    mu_s: float = 0.8
    mu_k: float = 0.46

    @property
    def slip_speed(self) -> float:
        """Largest speed in slip of the undamped rig [m/s]: the scale of speed-dependent effects."""
        jump = (self.mu_s - self.mu_k) * self.normal_force / self.stiffness
        return float(np.hypot(jump * np.sqrt(self.stiffness / self.mass), self.belt_velocity))

    @property
    def break_away(self) -> float:
        """Position at which stick ends at low speed, without excitation [m]."""
        return self.mu_s * self.normal_force / self.stiffness

    @property
    def slip_length(self) -> float:
        """Distance that one slip covers, undamped, without excitation [m]."""
        return 2.0 * (self.mu_s - self.mu_k) * self.normal_force / self.stiffness


def true_rig(nominal: Rig, rng: np.random.Generator) -> tuple[Rig, float]:
    """The rig with errors drawn within its uncertainty, and the factor on every normal force."""
    factors = {name: 1.0 + sigma * np.clip(rng.standard_normal(), -_WIDEST, _WIDEST) for name, sigma in UNCERTAINTY.items()}
    load = factors.pop("normal_force")
    wrong = {name: float(getattr(nominal, name) * factor) for name, factor in factors.items()}
    return replace(nominal, **wrong), float(load)
