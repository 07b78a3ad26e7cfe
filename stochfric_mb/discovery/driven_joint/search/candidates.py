"""What a joint's friction may lack, and from where its fit starts."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.effects import Effect, effect_class, effect_kinds
from stochfric_mb.effects.contract import JointSignature, Scan
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.shapes.course import Course


@dataclasses.dataclass(frozen=True)
class Candidate:
    """An effect with its starting points."""

    kind: str
    """Its kind."""
    starts: tuple[Effect, ...]
    """Where fits begin: the grid over numbers that enter nonlinearly."""
    where: str
    """Axis along which it shows."""
    parameters: int
    """Numbers it adds to a fit."""
    scan: Scan | None = None
    """Waves among which further fits begin."""
    form: int = 0
    """Its place among the forms of its kind."""

    @property
    def any_shape(self) -> bool:
        """Whether it follows a course of any shape, in whose numbers friction is linear."""
        return any(isinstance(s, Course) and s.any_shape for s in self.starts)

    @property
    def names(self) -> set[str]:
        """What it is left out by: its kind, or the course of any shape, or the stated forms, of that kind alone."""
        return {self.kind, self.name if self.any_shape else stated_forms(self.kind)}

    @property
    def name(self) -> str:
        """What leaves out no more than what speaks against it does: of a course of any shape that course alone."""
        return f"{self.kind} of any shape" if self.any_shape else self.kind

    @property
    def moves_load(self) -> bool:
        """Whether the load moves by itself with it."""
        return any(s.moves_load for s in self.starts)


def stated_forms(kind: str) -> str:
    """Return what all candidates of a kind are left out by but a course of any shape."""
    return f"{kind} of a stated form"


def span_of(balances: Sequence[ForceBalance], friction: float, load: float) -> JointSpan:
    """Return what the motion of ``balances`` covers; friction and load are the stated ones [N or N m]."""
    at = [s.window.centres[s.sliding] for s in balances]
    speed = np.concatenate([np.abs(s.velocity[c]) for s, c in zip(balances, at, strict=True)])
    position = np.concatenate([s.position[c] for s, c in zip(balances, at, strict=True)])
    carried = [s.load if s.normal_force is None else s.normal_force for s in balances]
    carries = np.concatenate([x[c] for x, c in zip(carried, at, strict=True)])
    direction = np.concatenate([np.sign(s.velocity[c]) for s, c in zip(balances, at, strict=True)])
    pressures = [s.pressure[c] for s, c in zip(balances, at, strict=True) if s.pressure is not None]
    varies = carries.std() > 0.05 * max(float(np.mean(carries)), 1.0e-12)
    return JointSpan(
        speed=float(np.quantile(speed, 0.95)),
        stroke=float(np.ptp(position)),
        lowest=float(position.min()),
        duration=max(float(s.time[-1] - s.time[0]) for s in balances),
        load=float(np.median(carries)) if varies else 0.0,
        both_ways=0.05 < float(np.mean(direction > 0.0)) < 0.95,
        friction=friction,
        distance=max(float(s.travelled[-1]) for s in balances),
        temperature=_temperatures(balances),
        contact=any(s.normal_force is not None for s in balances),
        stated_load=load,
        drive=_driven(balances, at),
        pressure=float(np.median(np.abs(np.concatenate(pressures)))) if pressures else 0.0,
        window=max(s.window.half_width for s in balances),
        least_load=float(carries.min()),
        load_range=float(np.ptp(carries)),
        inertia=min(0.0 if (motor := s.motor()) is None else motor.inertia for s in balances),
    )


def _driven(balances: Sequence[ForceBalance], at: Sequence[npt.NDArray[np.int64]]) -> bool:
    """Return whether a drive is known in all records and moves the joint."""
    return all(s.drive is not None and bool(np.any(s.drive[c] != 0.0)) for s, c in zip(balances, at, strict=True))


def _temperatures(balances: Sequence[ForceBalance]) -> tuple[float, float] | None:
    seen = [s.temperature for s in balances if s.temperature is not None]
    if len(seen) < len(balances):
        return None
    every = np.concatenate(seen)
    low, high = float(every.min()), float(every.max())
    return (0.5 * (low + high), high - low) if high > low else None


def candidates(span: JointSpan, stated: Sequence[Effect]) -> list[Candidate]:
    """Return the effects that this motion can show and that the model does not have yet, installed ones of other packages too.

    Args:
        span: what the motion covers.
        stated: effects in the model.
    """
    have = {e.kind for e in stated}
    searched: list[Candidate] = []
    for kind in effect_kinds():
        forms = effect_class(kind).at_joint(span) if kind not in have else None
        forms = (forms,) if isinstance(forms, JointSignature) else forms or ()
        searched += [Candidate(kind, f.starts, f.axis, f.parameters, f.scan, i) for i, f in enumerate(forms)]
    # a joint has one load, which moves in one way
    return [c for c in searched if not (c.moves_load and any(e.moves_load for e in stated))]
