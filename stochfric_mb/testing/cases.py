"""The mechanisms and laws of the suite, and the rates that its tolerances are made of."""

from __future__ import annotations

import math
from typing import Any

from stochfric_mb.coefficients import Process
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

STEP = 2.0e-4
"""Step of the cases [s], unless they say otherwise."""
TABLE_1 = {"mass": 6.08, "damping": 0.768, "stiffness": 3956.0, "normal_force": 13.0, "belt_velocity": 2.5e-3}
"""Kang, Choi and Yoo 2015, Table 1."""
BLOCK = {"mass": 2.0, "damping": 0.0, "stiffness": 800.0, "normal_force": 10.0, "belt_velocity": 0.0}
"""A block on a belt at rest: omega = 20 1/s."""
MU_S, MU_K = 0.6, 0.4


def case(
    law: str,
    duration: float,
    *,
    mechanism: dict[str, float],
    output_step: float = 1.0e-3,
    process: Process | None = None,
    parameters: dict[str, Any] | None = None,
    **changes: float,
) -> Scenario:
    """Return a scenario with a law of mu_s = 0.6, mu_k = 0.4 (or other ``parameters``) and ``changes`` of the mechanism."""
    return Scenario(
        mechanism=BeltBox(**(mechanism | changes)),
        law=make_law(law, **({"mu_s": MU_S, "mu_k": MU_K} | (parameters or {}))),
        process=process,
        duration=duration,
        output_step=output_step,
    )


def table_1(law: str, duration: float, *, process: Process | None = None, output_step: float = 1.0e-3) -> Scenario:
    """Return Table 1 with another law and process."""
    return case(
        law,
        duration,
        mechanism=TABLE_1,
        output_step=output_step,
        process=process,
        parameters={"mu_s": 0.8, "mu_k": 0.46},
    )


def stands_in(run: Trajectory, s: Scenario) -> bool:
    """Return whether another law ran in the place of the scenario's."""
    return run.attributes["law"] != s.law.kind


def natural_rate(s: Scenario) -> float:
    """Return omega = sqrt(k/m) [1/s]: how fast the motion changes between switches."""
    return math.sqrt(s.mechanism.stiffness / s.mechanism.mass)


def static_deflection(s: Scenario) -> float:
    """Return mu_s N/k [m], the size of the motions that friction makes."""
    return s.law.mu_s * s.mechanism.normal_force / s.mechanism.stiffness
