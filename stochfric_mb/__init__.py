"""Stochastic dry friction for multibody simulation: laws, coefficient processes, engines, reference.

Names are loaded on first use: importing the package loads no engine, no plotting and no compiler.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_EXPORTS: dict[str, str] = {
    "Coulomb": "stochfric_mb.laws.coulomb",
    "Havsin": "stochfric_mb.laws.havsin",
    "Tanh": "stochfric_mb.laws.tanh",
    "Karnopp": "stochfric_mb.laws.karnopp",
    "PiecewiseLinear": "stochfric_mb.laws.piecewise_linear",
    "Smooth": "stochfric_mb.laws.smooth",
    "ElasticStick": "stochfric_mb.laws.elastic_stick",
    "Stribeck": "stochfric_mb.laws.stribeck",
    "Dahl": "stochfric_mb.laws.dahl",
    "Lugre": "stochfric_mb.laws.lugre",
    "Law": "stochfric_mb.laws",
    "make_law": "stochfric_mb.laws",
    "register_law": "stochfric_mb.laws",
    "CoefficientPath": "stochfric_mb.coefficients",
    "Knots": "stochfric_mb.coefficients",
    "OutputStep": "stochfric_mb.coefficients",
    "OrnsteinUhlenbeck": "stochfric_mb.coefficients",
    "Matern": "stochfric_mb.coefficients",
    "Spatial": "stochfric_mb.coefficients",
    "PerEvent": "stochfric_mb.coefficients",
    "Normal": "stochfric_mb.coefficients",
    "TruncatedNormal": "stochfric_mb.coefficients",
    "Lognormal": "stochfric_mb.coefficients",
    "Uniform": "stochfric_mb.coefficients",
    "Empirical": "stochfric_mb.coefficients",
    "Friction": "stochfric_mb.friction",
    "Contact": "stochfric_mb.contact",
    "PlaneContact": "stochfric_mb.contact",
    "BeltBox": "stochfric_mb.mechanisms",
    "Effect": "stochfric_mb.effects",
    "make_effect": "stochfric_mb.effects",
    "register_effect": "stochfric_mb.effects",
    "Scenario": "stochfric_mb.scenario",
    "load_scenario": "stochfric_mb.scenario",
    "Trajectory": "stochfric_mb.trajectory",
    "StochfricError": "stochfric_mb.errors",
    "InputError": "stochfric_mb.errors",
    "MissingEngineError": "stochfric_mb.errors",
    "StabilityError": "stochfric_mb.errors",
    "SimulationError": "stochfric_mb.errors",
}

__all__ = [
    "BeltBox",
    "CoefficientPath",
    "Contact",
    "Coulomb",
    "Dahl",
    "Effect",
    "ElasticStick",
    "Empirical",
    "Friction",
    "Havsin",
    "InputError",
    "Karnopp",
    "Knots",
    "Law",
    "Lognormal",
    "Lugre",
    "Matern",
    "MissingEngineError",
    "Normal",
    "OrnsteinUhlenbeck",
    "OutputStep",
    "PerEvent",
    "PiecewiseLinear",
    "PlaneContact",
    "Scenario",
    "SimulationError",
    "Smooth",
    "Spatial",
    "StabilityError",
    "StochfricError",
    "Stribeck",
    "Tanh",
    "Trajectory",
    "TruncatedNormal",
    "Uniform",
    "__version__",
    "load_scenario",
    "make_effect",
    "make_law",
    "register_effect",
    "register_law",
]

if TYPE_CHECKING:
    from stochfric_mb.coefficients import (
        CoefficientPath,
        Empirical,
        Knots,
        Lognormal,
        Matern,
        Normal,
        OrnsteinUhlenbeck,
        OutputStep,
        PerEvent,
        Spatial,
        TruncatedNormal,
        Uniform,
    )
    from stochfric_mb.contact import Contact, PlaneContact
    from stochfric_mb.effects import Effect, make_effect, register_effect
    from stochfric_mb.errors import InputError, MissingEngineError, SimulationError, StabilityError, StochfricError
    from stochfric_mb.friction import Friction
    from stochfric_mb.laws import Law, make_law, register_law
    from stochfric_mb.laws.coulomb import Coulomb
    from stochfric_mb.laws.dahl import Dahl
    from stochfric_mb.laws.elastic_stick import ElasticStick
    from stochfric_mb.laws.havsin import Havsin
    from stochfric_mb.laws.karnopp import Karnopp
    from stochfric_mb.laws.lugre import Lugre
    from stochfric_mb.laws.piecewise_linear import PiecewiseLinear
    from stochfric_mb.laws.smooth import Smooth
    from stochfric_mb.laws.stribeck import Stribeck
    from stochfric_mb.laws.tanh import Tanh
    from stochfric_mb.mechanisms import BeltBox
    from stochfric_mb.scenario import Scenario, load_scenario
    from stochfric_mb.trajectory import Trajectory


def __getattr__(name: str) -> Any:
    if name not in _EXPORTS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_EXPORTS[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
