"""From where fits of a force begin that has any smooth shape and comes back: frequency, shape, and where in it each run begins.

What comes back is looked for where a wave with its overtones explains most, and at twice and thrice its length; the overtones
say how the runs are shifted against each other, and the shape is then linear. As in `wave_scan`, numbers that are fitted
already may move.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.wave_scan import BEST, FINE, Start, Waves, length, peaks, wave_starts, waves_left
from stochfric_mb.discovery.inference.alignment import HARMONICS, aligned
from stochfric_mb.discovery.inference.least_squares import solved
from stochfric_mb.effects.contract import Scan
from stochfric_mb.effects.shapes.splines import returning

Array = npt.NDArray[np.float64]

OVERTONES, PEAKS, MAINS = 3, 3, (1, 2, 3)
"""Harmonics by which such waves are looked for, how many of them are, and by what each is divided for it may be an overtone."""


@dataclasses.dataclass(frozen=True)
class Returning:
    """What may come back, whatever its shape."""

    number: float
    """Its wave number [1/s]."""
    begins: Array
    """Where in it each run begins [turns], shape (n_runs,)."""


class WaveSearch:
    """Where fits of waves begin, and of forces of any shape that comes back: what a scan sees serves all forms of an effect."""

    def __init__(self, balances: Sequence[ForceBalance]) -> None:
        self._balances = balances
        self._left_by: JointFit | None = None
        self._of: tuple[str, bool, float, float] | None = None
        self._waves: Waves | None = None
        self._returning: list[Returning] | None = None

    def starts(self, scan: Scan, current: JointFit) -> list[Start]:
        """Return where fits begin in what ``current`` leaves."""
        of = scan.axis, scan.signed, scan.low, scan.high
        if self._waves is None or self._left_by is not current or self._of != of:
            self._left_by, self._of, self._returning = current, of, None
            self._waves = waves_left(scan, current, self._balances)
        if scan.shaped is None:
            return wave_starts(scan, self._waves, self._balances)
        if self._returning is None:
            self._returning = returning_waves(scan, self._waves, current, self._balances)
        return shaped_starts(scan, self._returning, current, self._balances)


def returning_waves(scan: Scan, waves: Waves, current: JointFit, balances: Sequence[ForceBalance]) -> list[Returning]:
    """Return what may come back in what a fit leaves.

    Args:
        scan: range of the wave numbers.
        waves: sines in what the fit leaves.
        current: the fit.
        balances: its runs.
    """
    along = length(scan, balances)
    mains = [_sharpened(number, current, balances, along) for number in _numbers(scan, waves)]
    return [Returning(main, aligned(*_harmonics(main, current, balances))) for main in mains]


def shaped_starts(scan: Scan, found: Sequence[Returning], current: JointFit, balances: Sequence[ForceBalance]) -> list[Start]:
    """Return forces of any shape from which fits begin, best first, that explain more than their numbers cost.

    Args:
        scan: what is looked for, with the pieces of the shape.
        found: what may come back.
        current: the fit.
        balances: its runs.
    """
    assert scan.shaped is not None
    starts: list[Start] = []
    shapes = [(one, *_shape(one, scan.pieces, current, balances)) for one in found]
    for one, weights, left in sorted(shapes, key=lambda s: float(np.sum(s[2] ** 2)))[:BEST]:
        rest = left[: len(current.jacobian)]
        n = max(current.independent_in(current.split(rest)), 4.0)
        if 2.0 * n * float(np.log(current.rms / np.sqrt(np.mean(rest**2)))) < (scan.pieces + len(balances)) * float(np.log(n)):
            break
        effect, begins = scan.shaped(one.number, weights), 2.0 * np.pi * one.begins
        own = {(effect.kind, s.run, n): float(b) for s, b in zip(balances, begins, strict=True) for n in effect.own_to_run}
        starts.append(Start(dataclasses.replace(effect, phase=float(begins[0])), own))
    return starts


def _numbers(scan: Scan, waves: Waves) -> Iterator[float]:
    """Yield the wave numbers of what may come back."""
    numbers, power = waves.numbers.ravel(), waves.gain.sum(axis=0)
    if len(numbers) < 2:
        return
    step = numbers[1] - numbers[0]
    together = np.zeros(len(numbers))
    for order in range(1, OVERTONES + 1):
        at = np.round((order * numbers - numbers[0]) / step).astype(np.int64)
        together[at < len(numbers)] += power[at[at < len(numbers)]]
    mains = [numbers[i] / divisor for i in peaks(together, PEAKS) for divisor in MAINS]
    yield from (float(m) for m in mains if m >= scan.low)


def _sharpened(number: float, current: JointFit, balances: Sequence[ForceBalance], length: float) -> float:
    """Return the wave number near one at which all harmonics explain most: the highest of them tell it best."""
    trials = number + np.arange(-2 * HARMONICS, 2 * HARMONICS + 1) / (2.0 * FINE * HARMONICS * length)
    power = np.zeros(len(trials))
    for time, rest in _seen(current, balances):
        first = np.exp(-2j * np.pi * np.outer(time, trials))
        turned = np.ones_like(first)
        for _ in range(HARMONICS):
            turned = turned * first
            power += np.abs(rest @ turned) ** 2 / len(rest)
    return float(trials[int(np.argmax(power))])


def _harmonics(number: float, current: JointFit, balances: Sequence[ForceBalance]) -> tuple[npt.NDArray[np.complex128], Array]:
    """Return the harmonics of each run, and their variances, shape (n_runs, HARMONICS) each."""
    order = np.arange(1, HARMONICS + 1)
    each = [2.0 / len(r) * (r @ np.exp(-2j * np.pi * number * np.outer(t, order))) for t, r in _seen(current, balances)]
    waves: npt.NDArray[np.complex128] = np.array(each, dtype=np.complex128)
    spread = np.array([4.0 * current.rms**2 / len(r) for _, r in _seen(current, balances)])
    return waves, np.repeat(spread[:, None], HARMONICS, axis=1)


def _shape(one: Returning, pieces: int, current: JointFit, balances: Sequence[ForceBalance]) -> tuple[Array, Array]:
    """Return the weights of a shape beside all that is fitted, and what it leaves, of beliefs as well [N or N m]."""
    columns: list[Array] = []
    for balance, begin in zip(balances, one.begins, strict=True):
        splines = returning(one.number * balance.time + begin, pieces)
        columns.append(np.column_stack([balance.window.at_centres(x) for x in splines.T])[balance.sliding])
    prior, off = prior_rows(current, prior_weight(current))
    design = np.vstack([
        np.column_stack([current.jacobian, np.concatenate(columns)]),
        np.column_stack([prior, np.zeros((len(prior), pieces - 1))]),
    ])  # fmt: skip
    values = np.r_[np.concatenate(current.remainders), off]
    numbers = solved(design, values)
    return numbers[-(pieces - 1) :], values - design @ numbers


def _seen(current: JointFit, balances: Sequence[ForceBalance]) -> Iterator[tuple[Array, Array]]:
    """Yield times of the windows of sliding, and what the fit leaves of them, run by run; of a run that stands still a zero."""
    for balance, rest in zip(balances, current.remainders, strict=True):
        time = balance.time[balance.window.centres][balance.sliding]
        yield (time, rest) if len(rest) else (np.zeros(1), np.zeros(1))
