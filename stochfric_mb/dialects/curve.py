"""The friction of a law as other codes see it: a coefficient over speed, break-away, and what else there is."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients import Process
from stochfric_mb.contact import Contact
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws import Law

Array = npt.NDArray[np.float64]

POINTS = 121
"""Speeds at which curves are compared."""
LONG = 1.0e3
"""Distance slid until friction is steady [m]: far beyond any bristle."""
BRISTLE = "presliding: a stuck contact gives elastically"
"""What laws with a deflection remember."""


@dataclasses.dataclass(frozen=True)
class Curve:
    """Friction of a law."""

    speed: Array
    """Speeds [m/s], shape (n,), rising."""
    coefficient: Array
    """Coefficient of steady sliding [-], shape (n,)."""
    break_away: float
    """Coefficient at break-away [-]."""
    holds: bool
    """Whether a load below break-away is held without creep."""
    memory: str = ""
    """What else the law remembers, "" if nothing."""
    random: str = ""
    """How its coefficients vary, "" if they do not."""
    normal_force: float = 1.0
    """Normal force [N]."""
    stiffness: float = 0.0
    """Stiffness of the stuck contact [N/m], 0 if there is none."""
    damping: float = 0.0
    """Its damping [N s/m]."""


def speeds(low: float, high: float) -> Array:
    """Return the speeds at which curves are compared [m/s], evenly spaced in their logarithm.

    Raises:
        InputError: they are not positive and rising.
    """
    require_number("lowest speed", low, above=0.0, unit="m/s")
    require_number("highest speed", high, above=0.0, unit="m/s")
    if high <= low:
        raise InputError(f"speeds from {low:g} to {high:g} m/s do not rise; give the lower one first")
    return np.geomspace(low, high, POINTS)


def curve_of(law: Law, speed: Array, *, normal_force: float, mass: float = 1.0, process: Process | None = None) -> Curve:
    """Return the friction of a law.

    Args:
        law: the law.
        speed: speeds [m/s], shape (n,), > 0.
        normal_force: normal force [N].
        mass: mass that the contact feels [kg]; for the damping of a stuck elastic contact.
        process: how its coefficients vary; they are compared at their means.
    """
    moded = law.state_names[:1] == ("mode",)
    bristle = law.has_flow or law.needs_effective_mass
    mu = coefficient(law, speed)
    stiffness, damping = _stuck(law, normal_force, mass)
    return Curve(
        speed, mu,
        break_away=law.mu_s if moded or law.kind == "lugre" else float(np.max(mu)),
        holds=moded,
        memory=BRISTLE if bristle else "",
        random=f"process {process.kind}, sigma_s = {process.sigma_s:g}, sigma_k = {process.sigma_k:g}" if process else "",
        normal_force=normal_force, stiffness=stiffness, damping=damping,
    )  # fmt: skip


def coefficient(law: Law, speed: Array) -> Array:
    """Return the coefficient of steady sliding [-], shape (n,), after a long way at each speed [m/s]."""
    return np.array([_steady(law, float(v)) for v in speed])


def _steady(law: Law, v: float) -> float:
    contact = Contact(law, effective_mass=1.0)
    contact.start(0.0, 0.0, v, 1.0, hold=2.0 * law.mu_s)
    for way in (LONG, 2.0 * LONG, 3.0 * LONG):
        contact.commit(way / v, way, v, 1.0, hold=2.0 * law.mu_s)
    return contact.force(3.0 * LONG / v, 3.0 * LONG, v, 1.0, hold=2.0 * law.mu_s)


def _stuck(law: Law, normal_force: float, mass: float) -> tuple[float, float]:
    """Return stiffness [N/m] and damping [N s/m] of the stuck contact."""
    p = law.to_dict()
    if "e_lim" in p:
        stiffness = law.mu_s * normal_force / p["e_lim"]
        return stiffness, 2.0 * p["zeta"] * (stiffness * mass) ** 0.5
    if "sigma_0" in p:
        return p["sigma_0"] * normal_force, p.get("sigma_1", 0.0) * normal_force
    return 0.0, 0.0
