"""What a joint's friction may lack, and from where its fit starts; and smooth competitors that no effect explains."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.effects import Effect, make_effect

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Span:
    """What the motion covers, over the balances of a joint."""

    speed: float
    """High speed: its 95 % quantile [m/s or rad/s]."""
    stroke: float
    """Distance between the outermost positions [m or rad]."""
    duration: float
    """Longest record [s]."""
    load: float
    """Median load that the joint transmits, or normal force of a contact [N or N m]; 0: not known, or it does not vary."""
    both_ways: bool
    """Whether it slides in both directions."""
    friction: float
    """Believed friction [N or N m]."""
    distance: float
    """Longest distance slid in a record [m or rad]."""
    temperature: tuple[float, float] | None
    """Middle of the temperatures and what they span; None: not measured, or constant."""
    contact: bool
    """Whether the place is a contact, whose normal force is known."""


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


def span_of(balances: Sequence[ForceBalance], friction: float) -> Span:
    """Return what the motion of ``balances`` covers."""
    at = [s.window.centres[s.sliding] for s in balances]
    speed = np.concatenate([np.abs(s.velocity[c]) for s, c in zip(balances, at, strict=True)])
    position = np.concatenate([s.position[c] for s, c in zip(balances, at, strict=True)])
    carried = [s.load if s.normal_force is None else s.normal_force for s in balances]
    load = np.concatenate([x[c] for x, c in zip(carried, at, strict=True)])
    direction = np.concatenate([np.sign(s.velocity[c]) for s, c in zip(balances, at, strict=True)])
    varies = load.std() > 0.05 * max(float(np.mean(load)), 1.0e-12)
    return Span(
        speed=float(np.quantile(speed, 0.95)),
        stroke=float(np.ptp(position)),
        duration=max(float(s.time[-1] - s.time[0]) for s in balances),
        load=float(np.median(load)) if varies else 0.0,
        both_ways=0.05 < float(np.mean(direction > 0.0)) < 0.95,
        friction=friction,
        distance=max(float(s.travelled[-1]) for s in balances),
        temperature=_temperatures(balances),
        contact=any(s.normal_force is not None for s in balances),
    )


def _temperatures(balances: Sequence[ForceBalance]) -> tuple[float, float] | None:
    seen = [s.temperature for s in balances if s.temperature is not None]
    if len(seen) < len(balances):
        return None
    every = np.concatenate(seen)
    low, high = float(every.min()), float(every.max())
    return (0.5 * (low + high), high - low) if high > low else None


def candidates(span: Span, believed: Sequence[Effect], load: float) -> list[Candidate]:
    """Return the effects that this motion can show and that the model does not have yet.

    Args:
        span: what the motion covers.
        believed: effects in the model.
        load: believed load of the joint [N or N m].
    """
    found = [of(span, load) for of in _STARTS]
    have = {e.kind for e in believed}
    return [c for c in found if c is not None and c.kind not in have]


def _viscous(span: Span, load: float) -> Candidate:
    size = 0.5 * span.friction / span.speed
    return Candidate("viscous_friction", (make_effect("viscous_friction", coefficient=size),), "speed", 1)


def _weakening(span: Span, load: float) -> Candidate:
    starts = tuple(
        make_effect("velocity_weakening", amplitude=0.1 * span.friction / load, decay_velocity=part * span.speed)
        for part in (0.05, 0.2, 0.6)
    )
    return Candidate("velocity_weakening", starts, "speed", 2)


def _quadratic(span: Span, load: float) -> Candidate:
    size = 0.2 * span.friction / span.speed**2
    return Candidate("quadratic_damping", (make_effect("quadratic_damping", coefficient=size),), "speed", 1)


def _load(span: Span, load: float) -> Candidate | None:
    if not span.load:
        return None
    if span.contact:  # mu_k holds at the believed load, and the exponent is asked for
        powers = tuple(make_effect("load_dependence", exponent=x, reference_load=load) for x in (-0.3, 0.3))
        return Candidate("load_dependence", powers, "normal force", 1)
    starts = tuple(make_effect("load_dependence", exponent=1.0, reference_load=part * span.load) for part in (0.3, 1.0, 4.0))
    return Candidate("load_dependence", starts, "load", 1)


def _asymmetry(span: Span, load: float) -> Candidate | None:
    if not span.both_ways:
        return None
    return Candidate("direction_asymmetry", (make_effect("direction_asymmetry", asymmetry=0.0),), "direction", 1)


def _position(span: Span, load: float) -> Candidate:
    starts = tuple(
        make_effect("position_dependent_friction", amplitude=0.05, wavelength=span.stroke * part, phase=0.7, axis="position")
        for part in (2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12, 0.08)
    )
    return Candidate("position_dependent_friction", starts, "position", 3)


def _lag(span: Span, load: float) -> Candidate:
    starts = tuple(make_effect("frictional_lag", distance=span.stroke * part) for part in (0.003, 0.02, 0.1))
    return Candidate("frictional_lag", starts, "distance since reversal", 2)


def _drift(span: Span, load: float) -> Candidate:
    return Candidate("friction_drift", (make_effect("friction_drift", rate=0.01 / span.duration),), "time", 1)


def _travelled(span: Span, load: float) -> Candidate:
    return Candidate("distance_drift", (make_effect("distance_drift", rate=0.01 / span.distance),), "distance slid", 1)


def _warmed(span: Span, load: float) -> Candidate | None:
    if span.temperature is None:
        return None
    middle, width = span.temperature
    start = make_effect("temperature_drift", rate=0.01 / width, reference_temperature=middle)
    return Candidate("temperature_drift", (start,), "temperature", 1)


_STARTS: tuple[Callable[[Span, float], Candidate | None], ...] = (
    _viscous, _weakening, _quadratic, _load, _asymmetry, _position, _lag, _drift, _travelled, _warmed,
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Competitor:
    """A smooth dependence that belongs to no effect: where it wins, something is missing that has no name."""

    axis: str
    """What it depends on."""
    values: Callable[[ForceBalance], Array]
    """ForceBalance -> what it depends on, shape (count,)."""
    signed: bool
    """Whether it turns with the direction of the motion, as friction does."""

    def columns(self, balances: Sequence[ForceBalance]) -> list[Array]:
        """Return its columns at the centres of windows of each balance, shape (n_centres, k); k = 0 for a constant.

        Its range is that of all balances: what is asked is a dependence that they share.
        """
        values = [self.values(s) for s in balances]
        low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
        found: list[Array] = []
        for balance, value in zip(balances, values, strict=True):
            rows = _legendre(value, low, high)
            rows = np.sign(balance.velocity) * rows if self.signed else rows
            seen = [balance.window.at_centres(row) for row in rows]
            found.append(np.column_stack(seen) if seen else np.zeros((len(balance.driven), 0)))
        return found


COMPETITORS = (
    Competitor("position", lambda s: s.position, False),
    Competitor("position and direction", lambda s: s.position, True),
    Competitor("speed", lambda s: np.abs(s.velocity), False),
    Competitor("speed and direction", lambda s: np.abs(s.velocity), True),
    Competitor("time", lambda s: s.time, False),
    Competitor("time and direction", lambda s: s.time, True),
    Competitor("load", lambda s: s.load, False),
    Competitor("load and direction", lambda s: s.load, True),
)


def _legendre(values: Array, low: float, high: float) -> Array:
    """Return Legendre polynomials of order 1 to 3, low and high being -1 and 1, shape (3, n); empty if these are the same."""
    if high - low <= 1.0e-12 * max(abs(low), abs(high), 1.0e-300):
        return np.zeros((0, len(values)))
    scaled = 2.0 * (values - low) / (high - low) - 1.0
    rows: Any = np.polynomial.legendre.legvander(scaled, 3)[:, 1:].T
    return rows
