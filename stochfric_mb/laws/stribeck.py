"""Stribeck friction: true stick, and a sliding coefficient that falls from mu_s to mu_k with velocity."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import require_name, require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.coulomb import STICK, commit, guards, init
from stochfric_mb.laws.plane import clipped, slip_direction

__all__ = ["Stribeck", "commit", "force", "guards", "init", "sliding_coefficient", "slip_coefficient"]

FORMS = ("exponential", "gaussian", "lorentzian")


@dataclasses.dataclass(frozen=True)
class Stribeck(Law):
    """Coulomb's automaton with a velocity-weakening sliding coefficient.

    mu(v) = mu_k + (mu_s - mu_k) s(v/stribeck_velocity), with s(r) = exp(-r) (exponential; Bo and Pavelescu 1982),
    exp(-r^2) (Gaussian; Tustin's form as in Armstrong-Helouvry 1991) or 1/(1 + r^2) (Lorentzian; Hess and Soom 1990).

    Reference: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994, 1083-1138,
    doi 10.1016/0005-1098(94)90209-7, eqs. 7-9.
    """

    stribeck_velocity: float = 1.0e-3
    """Velocity scale of the fall [m/s], > 0."""
    form: str = dataclasses.field(default="exponential", metadata={"choices": FORMS})
    """Shape of the fall: "exponential", "gaussian" or "lorentzian"."""

    kind: ClassVar[str] = "stribeck"
    rest: ClassVar[str] = "rigid"
    equation: ClassVar[str] = "stuck: as coulomb; sliding: mu = mu_k + (mu_s - mu_k) s(v/stribeck_velocity)"
    source: ClassVar[str] = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994"
    state_names: ClassVar[tuple[str, ...]] = ("mode", "dx", "dy")
    needs_holding_force: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {"continuous": "at v = 0 the force is set-valued, as Coulomb's"}

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("stribeck_velocity", self.stribeck_velocity, above=0.0, unit="m/s")
        require_name("form of the Stribeck curve", self.form, FORMS)


@compiled
def slip_coefficient(speed, mu_s, mu_k, stribeck_velocity, form):
    """Return the sliding coefficient [-] at speed >= 0; form 0 exponential, 1 Gaussian, 2 Lorentzian."""
    r = speed / stribeck_velocity
    if form == 0.0:
        shape = math.exp(-r)
    elif form == 1.0:
        shape = math.exp(-r * r)
    else:
        shape = 1.0 / (1.0 + r * r)
    return mu_k + (mu_s - mu_k) * shape


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N]: the holding force within the cap while stuck, mu(abs(v)) N while sliding."""
    if state[0] == STICK:
        return clipped(hx, hy, mu_s * normal_force)
    ex, ey = slip_direction(vx, vy, state[1], state[2])
    speed = max(vx * ex + vy * ey, 0.0)
    f = slip_coefficient(speed, mu_s, mu_k, p[2], p[3]) * normal_force
    return f * ex, f * ey


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return mu(speed) [-]."""
    return slip_coefficient(speed, mu_s, mu_k, p[2], p[3])
