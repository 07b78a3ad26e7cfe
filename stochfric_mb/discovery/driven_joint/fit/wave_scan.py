"""From where fits of waves begin: the wave numbers at which a cosine and a sine explain most of what a fit leaves.

Beside them the numbers that are fitted already may move: the columns of the fit are projected out. It is the periodogram of
Lomb and Scargle for windows that are not evenly spaced, with all that is fitted as further columns.

Reference: J. D. Scargle, Astrophys. J. 263, 1982, 835-853, doi 10.1086/160554.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize_scalar

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.fitting import EVALUATIONS, JointFit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel, Own
from stochfric_mb.discovery.inference.alignment import BEGINS
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.least_squares import lengths
from stochfric_mb.effects import Effect
from stochfric_mb.effects.contract import Scan
from stochfric_mb.effects.shapes.periodic import Periodic

Array = npt.NDArray[np.float64]

FINE = 4.0
"""Wave numbers that are tried within 1/length, by which a peak is known [-]: at the middle between two, a wave loses 3 %."""
BEST = 2
"""Peaks from which fits begin."""


@dataclasses.dataclass(frozen=True)
class Start:
    """Where a fit begins: an effect, and what of it each run has for itself."""

    effect: Effect
    """The effect."""
    own: Mapping[Own, float] = dataclasses.field(default_factory=dict[Own, float])
    """Its phases in the runs, where each has one of its own."""

    def added_to(self, model: JointModel) -> JointModel:
        """Return the model with it."""
        return model.plus(self.effect, own=self.own)


def begun(effect: Effect, balances: Sequence[ForceBalance]) -> Start:
    """Return a start from an effect as it is, what each run has for itself being the same in all."""
    names = effect.own_to_run if effect.moves_load else ()
    return Start(effect, {(effect.kind, s.run, n): float(getattr(effect, n)) for s in balances for n in names})


def tried(scan: Scan, balances: Sequence[ForceBalance]) -> float:
    """Return how many waves can be distinguished in the range of a scan [-]."""
    return max((scan.high - scan.low) * length(scan, balances), 1.0)


@dataclasses.dataclass(frozen=True)
class Waves:
    """Cosine and sine that explain most of what a fit leaves, at each wave number; their groups are runs, or all of these."""

    numbers: Array
    """Wave numbers [1/s or 1/m or 1/rad], shape (n,)."""
    cosine: Array
    """Size of the cosine [N or N m], shape (n_groups, n)."""
    sine: Array
    """Size of the sine, shape as `cosine`."""
    gain: Array
    """By how much both lower the sum of squares, shape as `cosine`."""


def waves_left(scan: Scan, current: JointFit, balances: Sequence[ForceBalance]) -> Waves:
    """Return the waves of a scan in what a fit leaves, all that is fitted free to move; none where the scan holds none."""
    numbers = np.arange(scan.low, scan.high, 1.0 / (FINE * length(scan, balances)))
    if len(numbers) < 2:
        return Waves(*(np.zeros((1, 0)) for _ in range(4)))
    known = np.vstack([current.jacobian, prior_rows(current, prior_weight(current))[0]])
    basis = np.linalg.svd(known / lengths(known), full_matrices=False)[0][: len(current.jacobian)]
    parts = zip(balances, current.remainders, current.split(basis), strict=True)
    sums = np.array([_sums(scan, s, r, q, numbers) for s, r, q in parts])
    own = scan.begin(float(numbers[0]), 1.0, 0.0).own_to_run
    return Waves(numbers, *_solved(sums if own else sums.sum(axis=0, keepdims=True)))


def wave_starts(scan: Scan, waves: Waves, balances: Sequence[ForceBalance]) -> list[Start]:
    """Return the waves that would explain most of what a fit leaves, best first."""
    starts: list[Start] = []
    for i in peaks(waves.gain.sum(axis=0), BEST):
        number, a, b = float(waves.numbers[i]), waves.cosine[:, i], waves.sine[:, i]
        each = [scan.begin(number, float(x), float(y)) for x, y in zip(a, b, strict=True)]
        own = each[0].own_to_run
        if not own:
            starts.append(Start(each[0]))
            continue
        first = scan.begin(number, float(np.sqrt(np.mean(a**2 + b**2))), 0.0)
        phases = {
            (first.kind, s.run, n): float(getattr(e, n))
            for s, e in zip(balances, each, strict=True)
            for n in own
            if hasattr(e, n)
        }
        starts.append(Start(dataclasses.replace(first, **{n: getattr(each[0], n) for n in own}), phases))
    return starts


def peaks(power: Array, most: int) -> list[int]:
    """Return where a power over the wave numbers of a scan is largest, peaks that are apart alone, best first."""
    power, chosen = power.copy(), list[int]()
    while len(chosen) < most and len(power) and power.max() > 0.0:
        i = int(np.argmax(power))
        power[max(i - int(2.0 * FINE), 0) : i + int(2.0 * FINE) + 1] = 0.0
        chosen.append(i)
    return chosen


def with_phases(model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]) -> JointModel:
    """Return the model with the phases that waves in time have in further runs, in which all else of them is known.

    Where in its period a force is when a record begins, or how a load swings, no model can say; it is taken from the record
    itself.
    """
    own = dict(model.own)
    for effect in model.effects:
        names = {n for kind, _, n in model.own if kind == effect.kind}
        if effect.moves_load and names:
            own |= _swinging(model, effect, sorted(names), balances, nuisances)
            continue
        for name in names:
            others = tuple(e for e in model.effects if e is not effect)
            for balance in balances:
                if isinstance(effect, Periodic) and effect.any_shape:
                    own[effect.kind, balance.run, name] = _phase_of_shape(model, effect, balance, nuisances)
                    continue
                parts = [dataclasses.replace(effect, **{name: x}) for x in (0.0, 0.5 * np.pi)]
                plain = dataclasses.replace(model, effects=others).remainder(balance, ())
                columns = [
                    plain - dataclasses.replace(model, effects=(*others, p), own={}).remainder(balance, ()) for p in parts
                ]
                design = np.column_stack([np.ones(len(plain)), *columns])[balance.sliding]
                b = np.linalg.lstsq(design, plain[balance.sliding], rcond=1.0e-10)[0]
                own[effect.kind, balance.run, name] = float(np.arctan2(b[2], b[1]))
    return dataclasses.replace(model, own=own)


def _phase_of_shape(model: JointModel, effect: Effect, balance: ForceBalance, nuisances: Sequence[Nuisance]) -> float:
    """Return the phase of a force of any shape in a run at which it leaves least, but for a constant [rad]."""
    others = tuple(e for e in model.effects if e is not effect)

    def left(phase: float) -> float:
        trial = dataclasses.replace(model, effects=(*others, dataclasses.replace(effect, phase=phase)), own={})
        return float(np.var(trial.remainder(balance, nuisances)[balance.sliding]))

    turns = 2.0 * np.pi * np.arange(BEGINS) / BEGINS
    best = float(turns[int(np.argmin([left(float(x)) for x in turns]))])
    step = 2.0 * np.pi / BEGINS
    found: Any = minimize_scalar(left, bounds=(best - step, best + step), method="bounded")
    return float(found.x)


def _swinging(
    model: JointModel, effect: Effect, names: Sequence[str], balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance]
) -> dict[Own, float]:
    """Return how the load swings when further runs begin, from the records themselves, all else being known."""
    others = tuple(e for e in model.effects if e is not effect)
    size = np.array([abs(getattr(effect, n)) or 1.0 for n in names])  # as large as where fits begin
    free = np.full(len(names), np.inf)
    own: dict[Own, float] = {}
    for balance in balances:

        def left(x: Array, balance: ForceBalance = balance) -> Array:
            swings = dataclasses.replace(effect, **dict(zip(names, map(float, x * size), strict=True)))
            trial = dataclasses.replace(model, effects=(*others, swings), own={})
            return trial.remainder(balance, nuisances)[balance.sliding]

        minimum = minimised(left, np.zeros(len(names)), -free, free, difference=0.1, evaluations=EVALUATIONS, tolerance=1.0e-5)
        own |= {(effect.kind, balance.run, n): float(x) for n, x in zip(names, minimum.x * size, strict=True)}
    return own


def length(scan: Scan, balances: Sequence[ForceBalance]) -> float:
    """Return how far the axis of a scan is gone along, in the longest run where it is time."""
    values = [v for s in balances if len(v := _along(scan, s))]  # a joint may slide in some of the runs alone
    if scan.axis == "time":
        return max(float(np.ptp(v)) for v in values)
    return max(float(max(v.max() for v in values) - min(v.min() for v in values)), 1.0e-300)


def _along(scan: Scan, balance: ForceBalance) -> Array:
    signal = balance.time if scan.axis == "time" else balance.position
    return signal[balance.window.centres][balance.sliding]


def _sums(scan: Scan, balance: ForceBalance, rest: Array, basis: Array, numbers: Array) -> Array:
    """Return the sums of squares and products of cosine, sine and rest, shape (5, n_numbers)."""
    side = np.sign(balance.velocity[balance.window.centres][balance.sliding]) if scan.signed else np.ones(len(rest))
    known = np.ascontiguousarray(basis.T)
    parts: list[Array] = []
    for cosine, sine in _waves(2.0 * np.pi * _along(scan, balance), numbers):
        c, s = side[:, None] * cosine, side[:, None] * sine
        known_c, known_s = known @ c, known @ s
        parts.append(np.stack([
            np.einsum("ij,ij->j", c, c) - np.sum(known_c * known_c, axis=0),
            np.einsum("ij,ij->j", s, s) - np.sum(known_s * known_s, axis=0),
            np.einsum("ij,ij->j", c, s) - np.sum(known_c * known_s, axis=0),
            rest @ c,
            rest @ s,
        ]))  # fmt: skip
    return np.concatenate(parts, axis=1)


def _waves(angles: Array, numbers: Array) -> Iterator[tuple[Array, Array]]:
    """Yield cosine and sine of angles times numbers, some equidistant numbers at a time, shape (n, n_some).

    Sums of angles are products of few cosines and sines.
    """
    width = int(np.ceil(np.sqrt(len(numbers))))
    fine = np.outer(angles, (numbers[1] - numbers[0]) * np.arange(width))
    fine_c, fine_s = np.cos(fine), np.sin(fine)
    for begin in range(0, len(numbers), width):
        coarse = (angles * numbers[begin])[:, None]
        coarse_c, coarse_s = np.cos(coarse), np.sin(coarse)
        size = min(width, len(numbers) - begin)
        c, s = fine_c[:, :size], fine_s[:, :size]
        yield coarse_c * c - coarse_s * s, coarse_s * c + coarse_c * s


def _solved(sums: Array) -> tuple[Array, Array, Array]:
    """Return a, b and the fall of the sum of squares, shape (n_groups, n_numbers) each."""
    cc, ss, cs, cr, sr = np.moveaxis(sums, 1, 0)
    determinant = cc * ss - cs**2
    good = determinant > LEAST * np.maximum(cc, ss).max() ** 2
    safe = np.where(good, determinant, 1.0)
    a, b = np.where(good, (ss * cr - cs * sr) / safe, 0.0), np.where(good, (cc * sr - cs * cr) / safe, 0.0)
    return a, b, a * cr + b * sr


LEAST = 1.0e-4
"""Determinant of cosine and sine over that of independent ones, below which what is fitted already imitates a wave [-]."""
