"""What a joint's friction may lack, and from where its fit starts; and smooth competitors that no effect explains."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.effects import Effect, effect_class, effect_kinds
from stochfric_mb.effects.contract import JointSignature, Scan
from stochfric_mb.effects.joints import JointSpan

Array = npt.NDArray[np.float64]


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
    return searched


Axis = Callable[[ForceBalance, int], Array]
"""ForceBalance and its number -> a condition, shape (count,)."""


@dataclasses.dataclass(frozen=True)
class Competitor:
    """A smooth dependence that belongs to no effect: where it wins, something is missing that has no name."""

    axis: str
    """What it depends on."""
    conditions: tuple[Axis, ...]
    """One condition, or two that act together."""
    signed: bool
    """Whether it turns with the direction of the motion, as friction does."""
    order: int = 3
    """Order of its polynomial in a condition; of two the product of the conditions is taken."""
    fewest: int = 1
    """Fewest balances of which it can be asked."""

    def columns(self, balances: Sequence[ForceBalance], like: Sequence[ForceBalance] | None = None) -> list[Array]:
        """Return its columns at the centres of windows of each balance, shape (n_centres, k); k = 0 for a constant.

        Its range is that of all balances, or of those that it shall be ``like``: what is asked is a dependence that they share.
        """
        rows = [np.ones((1, len(s.time))) for s in balances]
        for condition in self.conditions if len(balances) >= self.fewest else ():
            values = [condition(s, i) for i, s in enumerate(balances)]
            around = values if like is None else [condition(s, i) for i, s in enumerate(like)]
            low, high = min(float(v.min()) for v in around), max(float(v.max()) for v in around)
            one = [_legendre(v, low, high, self.order) for v in values]
            rows = [(r[:, None] * x[None]).reshape(-1, r.shape[1]) for r, x in zip(rows, one, strict=True)]
        columns: list[Array] = []
        for balance, row in zip(balances, rows, strict=True):
            side = np.sign(balance.velocity) if self.signed else 1.0
            seen = [balance.window.at_centres(side * x) for x in row] if len(balances) >= self.fewest else []
            columns.append(np.column_stack(seen) if seen else np.zeros((len(balance.driven), 0)))
        return columns


FEWEST_RUNS = 4
"""Fewest runs of which a trend from one to the next is asked: through three of them nearly every curve is a line."""


def _number(balance: ForceBalance, number: int) -> Array:
    """Return the number of a run, in the order of the dataset, at all its samples."""
    return np.full(len(balance.time), float(number))


def _position(balance: ForceBalance, _: int) -> Array:
    return balance.position


def _speed(balance: ForceBalance, _: int) -> Array:
    return np.abs(balance.velocity)


def _time(balance: ForceBalance, _: int) -> Array:
    return balance.time


def _load(balance: ForceBalance, _: int) -> Array:
    return balance.load


SIGNED = " and direction"
"""What the name of an axis ends with where the dependence turns with the direction, as friction does."""
ALONG: dict[str, Axis] = {"position": _position, "speed": _speed, "time": _time, "load": _load}
"""Conditions that vary within a run."""
COMPETITORS = (
    *(Competitor(n + end, (x,), signed) for n, x in ALONG.items() for end, signed in (("", False), (SIGNED, True))),
    Competitor("run", (_number,), False, 1, FEWEST_RUNS),
    Competitor("run and direction", (_number,), True, 1, FEWEST_RUNS),
)
TOGETHER = tuple(
    (
        Competitor(f"{first} times {second}{end}", (ALONG[first], ALONG[second]), signed, 1),
        tuple(Competitor(name, (ALONG[name],), signed) for name in (first, second)),
    )
    for first, second in itertools.combinations(ALONG, 2)
    for end, signed in (("", False), (SIGNED, True))
)
"""Two conditions that act together, and what each does by itself: the product counts beyond these, as an interaction does in an
analysis of variance. It is asked of what a named effect leaves, since effects act one by one."""


def _legendre(values: Array, low: float, high: float, order: int) -> Array:
    """Return Legendre polynomials from order 1, low and high being -1 and 1, shape (order, n); empty if these are the same."""
    if high - low <= 1.0e-12 * max(abs(low), abs(high), 1.0e-300):
        return np.zeros((0, len(values)))
    scaled = 2.0 * (values - low) / (high - low) - 1.0
    rows: Any = np.polynomial.legendre.legvander(scaled, order)[:, 1:].T
    return rows
