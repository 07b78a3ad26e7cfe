"""Delay of a place: by how much its motion comes late, seen beside friction and beside what is selected.

Beside friction alone a delay is off, or unseen, where an effect leaves more than it does; beside the effect it is plain. And an
effect can stand in for a delay. So each step of the selection is asked at which delay it would leave least.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import fminbound

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.timing import LEAST_SAMPLES, MATERIAL, NAMED, Mask, Timing, longest_of, shared
from stochfric_mb.discovery.driven_joint.balance.weak_form import FEWEST
from stochfric_mb.discovery.driven_joint.decision.selection import Selected
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight
from stochfric_mb.discovery.driven_joint.simulation.scores import closed_share, noise_floor, rms
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.inference.noise import independent_count
from stochfric_mb.errors import InputError
from stochfric_mb.numerics.robust import deviation

Array = npt.NDArray[np.float64]
HELD = 4
"""Delays from none to that of sampling and holding that are tried."""
GRID, FURTHER = 7, 1.5
"""Delays at which a step of the selection is asked first, half a sample apart where none shows beside friction, and how far
beyond one that does, or beyond the last of them if that leaves least, they go [-]: the squares left are a parabola in the
delay, of which few points tell where it is lowest."""
FINE = 0.02
"""Error of a delay over the distance between two of these [-]: a hundredth of a sample, less than noise tells."""


@dataclasses.dataclass(frozen=True)
class Delayed:
    """What is selected at a place, and with which delay."""

    held: float
    """Delay that is compensated without a name: stated, sampled and held [s]."""
    delay: float
    """Delay that is compensated [s]."""
    timing: Timing | None
    """Delay that was asked for, named or not; None: none was."""
    selected: Selected
    """What is selected with the delay."""
    undelayed: Selected
    """What is selected with that without a name alone."""


@dataclasses.dataclass(frozen=True)
class DelaySearch:
    """A place, seen with any delay."""

    see: Callable[[float, int | None], Sequence[ForceBalance]]
    """Delay that is compensated [s] and half width of the windows [samples], None: as friction asks for -> the fit runs."""
    select: Callable[[float], Selected]
    """Delay that is compensated [s] -> what is selected with it."""
    nuisances: Sequence[Nuisance]
    """Numbers of the mechanism."""
    interval: float
    """Distance between samples [s]."""

    @property
    def shortest(self) -> float:
        """Longest delay that signals have by being sampled and held [s]: beyond it one has a name."""
        return LEAST_SAMPLES * self.interval

    def run(self, stated: float, timing: Timing | None) -> Delayed:
        """Return what is selected, and with which delay.

        Args:
            stated: delay that the scenario states [s].
            timing: delay beyond it that shows beside friction; None: none.
        """
        held = stated
        if timing is not None and abs(timing.seconds) <= self.shortest:
            held, timing = held + timing.seconds, None
        plain = self.select(held)
        seen = None
        with contextlib.suppress(InputError):  # a run is too short to be seen with delays
            seen = self.beside(plain, held, 0.0 if timing is None else stated + timing.seconds - held)
        asked = [] if timing is None else [timing]
        if seen is not None and abs(seen.seconds) > self.shortest:
            asked.append(dataclasses.replace(seen, seconds=seen.seconds + held - stated))
        elif seen is not None:
            anew = self.select(held + seen.seconds)
            if self.better(plain, anew, [held], held + seen.seconds, seen.half_width)[0] > NAMED:
                held, plain = held + seen.seconds, anew
        answers = [self._judged(t, stated, held, plain) for t in asked]
        best = max(answers, key=lambda a: (a[0].named, a[0].score), default=None)
        if best is None or not best[0].named:
            return Delayed(held, held, None if best is None else best[0], plain, plain)
        return Delayed(held, stated + best[0].seconds, best[0], best[1], plain)

    def _judged(self, timing: Timing, stated: float, held: float, plain: Selected) -> tuple[Timing, Selected]:
        """Return a delay with its evidence against what is selected without it, and what is selected with it."""
        late = self.select(stated + timing.seconds)
        early = held + np.linspace(0.0, np.copysign(self.shortest, timing.seconds), HELD)
        return timing.beside(*self.better(plain, late, early.tolist(), stated + timing.seconds, timing.half_width)), late

    def beside(self, selected: Selected, held: float, further: float) -> Timing | None:
        """Return the delay with which a step of the selection leaves less by a material part, the first one first; None: none.

        With about as many numbers as windows a step leaves nothing with any delay.

        Args:
            selected: what was selected.
            held: delay with which it was [s].
            further: delay beyond it that shows beside friction [s]; it is looked for around that, too.

        Raises:
            InputError: a run is too short.
        """
        balances = self.see(held, None)
        width, longest = round(half_width(balances) / self.interval), longest_of(balances)
        see = functools.cache(lambda delay: self.see(held + delay, width))
        steps = (*(t.fit for t in selected.effects), selected.final)
        for step in (s for s in steps if s.n >= criteria.WINDOWS_A_NUMBER * len(s.free)):
            low = max(min(-self.shortest, FURTHER * further), -longest)
            high = min(max(self.shortest, FURTHER * further), longest)
            while True:
                grid = np.unique(np.r_[np.linspace(low, high, GRID), 0.0].round(12))
                same = shared([see(float(d)) for d in grid])
                if sum(int(m.sum()) for m in same) < FEWEST:
                    return None
                seen = _Profile(lambda d, s=step, m=same: refitted(s, selected.nuisances, see(d), m), grid)
                wider = (max(FURTHER * low, -longest), high) if seen.at == 0 else (low, min(FURTHER * high, longest))
                # least at an end by a material part: further on it may be less
                if not seen.ends or wider == (low, high):
                    break
                low, high = wider
            found = seen.least(width)
            if found is not None:
                return found
        return None

    def better(self, plain: Selected, late: Selected, early: Sequence[float], delay: float, width: int) -> tuple[float, bool]:
        """Return the evidence for a delay, and whether it explains more than it leaves, in loud windows and in typical ones.

        The evidence is by how much the record is explained better with it, numbers counted. Of as good an explanation with
        more numbers it need not explain what is left: that is noise.

        Args:
            plain: what was selected without it.
            late: the same with it compensated.
            early: delays that are none, all that sampling and holding may be late by [s].
            delay: the delay [s].
            width: half width of the window that shows it [samples]: friction may need a wider one.
        """
        balances = [self.see(d, width) for d in (*early, delay)]
        same = shared(balances)
        without = [refitted(plain.final, plain.nuisances, seen, same) for seen in balances[:-1]]
        before = min(without, key=lambda f: f.rms)
        after = refitted(late.final, late.nuisances, balances[-1], same)
        n = max(sum(map(independent_count, after.remainders)), 4.0)  # timing shows within strokes, too
        more = len(after.free) + len(late.released) - len(before.free) - len(plain.released) + 1
        gain = float(np.log(before.rms / after.rms))
        simpler = more < 0 and abs(gain) < -np.log(1.0 - criteria.MATERIAL)
        if simpler:
            gain = max(gain, 0.0)  # effects that leave less by no material part explain no more than the delay
        sizes = rms, lambda rest: deviation(rest, about=0.0)
        shares = [share_by_delay(without[0], after, balances[-1], self.nuisances, size) for size in sizes]
        evidence = 2.0 * n * gain + before.strain - after.strain - more * np.log(n)
        return float(evidence), simpler or min(shares) >= criteria.EXPLAINED_BY_DELAY


class _Profile:
    """What a model leaves with each delay of a grid."""

    def __init__(self, left: Callable[[float], JointFit], grid: Array) -> None:
        self.left, self.grid = left, grid
        self.sizes = np.array([left(float(d)).rms for d in grid])
        self.at = int(np.argmin(self.sizes))
        self.now = float(self.sizes[np.argmin(np.abs(grid))])

    @property
    def ends(self) -> bool:
        """Whether it leaves least at an end, by a material part."""
        return self.at in (0, len(self.grid) - 1) and bool(self.sizes[self.at] < (1.0 - MATERIAL) * self.now)

    def least(self, width: int) -> Timing | None:
        """Return the delay with which it leaves least; None: not less by a material part, or at an end."""
        at, grid, left = self.at, self.grid, self.left
        if at in (0, len(grid) - 1):
            return None
        tolerance = FINE * (grid[at + 1] - grid[at - 1])
        found = float(np.asarray(fminbound(lambda d: left(float(d)).rms, grid[at - 1], grid[at + 1], xtol=tolerance)))
        least = left(found)
        gain = 1.0 - least.rms / self.now
        score = -2.0 * least.n * np.log(1.0 - gain) - np.log(least.n)
        if not (gain > MATERIAL and score > NAMED):
            return None
        # S(T) = S (1 + (T - T0)^2 curvature): one standard deviation raises n S by S
        rise = max(left(found + side * 2.0 * tolerance).rms for side in (-1.0, 1.0)) / least.rms
        spread = 2.0 * tolerance / float(np.sqrt(least.n * max(rise**2 - 1.0, 1.0e-12)))
        within = confidence_interval(found, spread, "s")
        return Timing(found, within.low, within.high, float(score), gain, width)


def half_width(balances: Sequence[ForceBalance]) -> float:
    """Return the typical half width of the windows of balances [s]."""
    return float(np.median([s.window.half_width for s in balances]))


def refitted(
    fitted: JointFit, nuisances: Sequence[Nuisance], balances: Sequence[ForceBalance], windows: Sequence[Mask]
) -> JointFit:
    """Return a model of the selection through other windows, some of them; what it released stays free.

    Beliefs weigh as they did in the selection: through narrow windows what is left is mostly the noise of acceleration times
    mass, and a belief that weighs by it gives way to less mass, which is less noise.
    """
    return fit(fitted.model, balances, nuisances, noise=prior_weight(fitted), masks=windows)


def share_by_delay(
    plain: JointFit,
    late: JointFit,
    balances: Sequence[ForceBalance],
    nuisances: Sequence[Nuisance],
    size: Callable[[Array], float] = rms,
) -> float:
    """Return the share of what stands above the noise that a delay, with what was selected beside it, closes [-].

    Args:
        plain: without the delay.
        late: with it.
        balances: with it.
        nuisances: numbers of the mechanism.
        size: size of what is left, in the unit of the balance.
    """
    before, after = (size(np.concatenate(fitted.remainders)) for fitted in (plain, late))
    floor = min(noise_floor(late.model, balances, nuisances), after)
    return closed_share(before, after, floor)
