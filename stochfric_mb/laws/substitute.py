"""The elastic law that stands in for a law with true stick, where an engine cannot give the holding force."""

from __future__ import annotations

import math

from stochfric_mb.errors import require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.elastic_stick import ElasticStick

ZETA = 0.3
"""Damping ratio of the substitute [-]."""
MARGIN = 2.0
"""The substitute's step limit over the step."""
FALL_AREA = {"exponential": 1.0, "gaussian": 0.5 * math.sqrt(math.pi), "lorentzian": 0.5 * math.pi}
"""Form of a Stribeck curve -> its area over that of the exponential of the same velocity scale [-]."""


def elastic_substitute(law: Law, dt: float, normal_force: float, effective_mass: float) -> tuple[Law, str]:
    """Return the elastic law nearest to ``law`` that is stable at ``dt``, and a note saying so ("" if none is needed).

    A law that needs no holding force comes back unchanged. Otherwise e_lim [m] is the smallest whose step limit
    2 (sqrt(1 + zeta^2) - zeta) sqrt(e_lim m_eff/(mu_s N)) is ``MARGIN`` dt. Sliding, decay_velocity is 0 (mu_k at
    once) or, where the law has a Stribeck curve, the one that gives the fall the same area. v_s is the law's own, or
    a millionth of the velocity mu_s N dt/m_eff that friction changes in one step: below v_s mu stays at mu_s, which puts off
    break-away by sqrt(2 m_eff v_s/(rate of the load)) (at a thousandth this delay was 5 dt, and fell with sqrt(dt) alone).

    Args:
        law: the law to stand in for.
        dt: step [s], > 0.
        normal_force: normal force [N], > 0.
        effective_mass: mass that the contact feels [kg], > 0.

    Raises:
        InputError: ``dt``, ``normal_force`` or ``effective_mass`` is not a positive number.
    """
    require_number("dt", dt, above=0.0, unit="s")
    require_number("normal_force", normal_force, above=0.0, unit="N")
    require_number("effective_mass", effective_mass, above=0.0, unit="kg")
    if not law.needs_holding_force:
        return law, ""
    acceleration = law.mu_s * normal_force / effective_mass
    e_lim = acceleration * (0.5 * MARGIN * dt / (math.sqrt(1.0 + ZETA**2) - ZETA)) ** 2
    v_s = float(getattr(law, "v_s", 1.0e-6 * acceleration * dt))
    decay_velocity = float(getattr(law, "stribeck_velocity", 0.0)) * FALL_AREA[getattr(law, "form", "exponential")]
    elastic = ElasticStick(law.mu_s, law.mu_k, e_lim=e_lim, zeta=ZETA, v_s=v_s, decay_velocity=decay_velocity)
    note = (
        f"{law.kind} needs the holding force, which this engine cannot give: ran elastic_stick with e_lim = {e_lim:.3g} m "
        f"(the smallest with a step limit of {MARGIN:g} dt), v_s = {v_s:.3g} m/s, decay_velocity = {decay_velocity:.3g} m/s"
    )
    return elastic, note
