"""The event-located reference: what every engine is compared with."""

from stochfric_mb.reference.simulation import simulate
from stochfric_mb.reference.solver import solve

__all__ = ["CARRIES_EFFECTS", "simulate", "solve"]

CARRIES_EFFECTS = True
