"""Stochastic coefficients: distributions, processes and the paths they give."""

from __future__ import annotations

from stochfric_mb.coefficients.distributions import (
    DISTRIBUTIONS,
    Distribution,
    Empirical,
    Lognormal,
    Normal,
    TruncatedNormal,
    Uniform,
)
from stochfric_mb.coefficients.path import CoefficientPath
from stochfric_mb.coefficients.processes import (
    PROCESSES,
    FeasibilityWarning,
    Knots,
    Matern,
    OrnsteinUhlenbeck,
    OutputStep,
    PerEvent,
    Process,
    Spatial,
)

__all__ = [
    "DISTRIBUTIONS",
    "PROCESSES",
    "CoefficientPath",
    "Distribution",
    "Empirical",
    "FeasibilityWarning",
    "Knots",
    "Lognormal",
    "Matern",
    "Normal",
    "OrnsteinUhlenbeck",
    "OutputStep",
    "PerEvent",
    "Process",
    "Spatial",
    "TruncatedNormal",
    "Uniform",
]
