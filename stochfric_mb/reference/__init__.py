"""The event-located reference: what every engine is compared with."""

from stochfric_mb.reference.solver import simulate, solve

__all__ = ["simulate", "solve"]
