"""Fits of the candidates beside a fit: of those that are worth one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.evidence import settings_of
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, settled
from stochfric_mb.discovery.driven_joint.fit.gains import predicted_left
from stochfric_mb.discovery.driven_joint.fit.periodic_shape import WaveSearch
from stochfric_mb.discovery.driven_joint.fit.wave_scan import begun
from stochfric_mb.discovery.driven_joint.search.candidates import Candidate, candidates, span_of
from stochfric_mb.discovery.driven_joint.search.first_order import Prospect, prospect, prospects
from stochfric_mb.discovery.driven_joint.simulation.scores import FLOOR, noise_floor
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.shapes.course import LeveledCourse

STARTS, STARTS_ROUGH = 2, 6
"""Best starts of an effect from which it is fitted; of a rough one the best is often in a wrong valley."""
SIZES = ("amplitude", "coefficient", "asymmetry", "viscous_difference", "rate", "load_share", "gap")
"""Parameters that are zero where an effect is none."""
VARIES = ("slope", "curvature", "ripple")
"""Parameters that are all zero where what varies along the stroke is a constant."""
SHARE, AT_AN_END = "load_share", 1.0e-3
"""Part of the inertia that moves by itself, and how close to an end of its range it has reached it, over that range [-]:
rounding."""

Fitted = list[tuple[Candidate, JointFit]]
"""Candidates with their fits."""
Key = tuple[Hashable, ...]
"""The effects of a model by kind and adjusted numbers, and what is believed of law and mechanism."""


class Found(NamedTuple):
    """What stands beside a fit."""

    fits: Fitted
    """Candidates, fitted."""
    faint: tuple[tuple[Candidate, float], ...]
    """Those that cannot pay for their numbers, with the score that a fit might give them at best [-]."""

    @property
    def asked(self) -> int:
        """How many were asked for."""
        return len(self.fits) + len(self.faint)


@dataclasses.dataclass(frozen=True)
class Beside:
    """A fit beside which candidates are asked for."""

    current: JointFit
    """The fit."""
    nuisances: Sequence[Nuisance]
    """Numbers of the mechanism with their priors."""
    noise: float
    """Weight of beliefs, as of `fit`."""
    without: frozenset[str]
    """Kinds and forms that are left out."""

    @property
    def key(self) -> Key:
        """What candidates beside the same effects share."""
        model, numbers = self.current.model, {(k.owner, k.name) for k in self.current.free}
        forms = [(e.kind, *sorted(n for o, n in numbers if o == i)) for i, e in enumerate(model.effects)]
        return *sorted(forms), *self.nuisances, model.level


class CandidateFits:
    """Candidates at one joint; beside the same effects each is fitted once."""

    def __init__(self, balances: Sequence[ForceBalance], tell: Callable[[str], None]) -> None:
        self._balances, self._tell, self._settings = balances, tell, settings_of(balances)
        self._waves = WaveSearch(balances)
        self._prospects: dict[Key, Prospect] = {}
        self._fitted: dict[Key, JointFit | None] = {}

    def others(self, beside: Beside) -> Found:
        """Return all candidates but loads that move by themselves."""
        span = self._span(beside)
        asked = _asked(span, beside, of_loads=False)
        seen = prospects([self._seen(beside, c) for c in asked if not c.any_shape], beside.current, self._settings)
        fits = [(p.candidate, f) for p in seen.worth if (f := self._once(beside, p)) is not None]
        faint = list(seen.faint)
        while faint and not fits:  # what is none of its kind when it is fitted is nothing to compare with
            one, _ = faint.pop(0)
            fits += [] if (f := self._once(beside, one)) is None else [(one.candidate, f)]
        for course in self._worth_fitting(beside, fits, [c for c in asked if c.any_shape]):
            fitted = self._once(beside, self._seen(beside, course))
            fits += [] if fitted is None else [(course, fitted)]
        return Found(fits, tuple((p.candidate, score) for p, score in faint))

    def loads(self, beside: Beside) -> Found:
        """Return loads that move by themselves: too far from linear for what they are worth to first order to say anything."""
        span = self._span(beside)
        asked = [self._seen(beside, c) for c in _asked(span, beside, of_loads=True)]
        return Found([(p.candidate, f) for p in asked if (f := self._once(beside, p)) is not None], ())

    def leaves_more_than_noise(self, found: Found, beside: Beside) -> bool:
        """Return whether the best fit that there is leaves more than noise."""
        least = min((beside.current, *(f for _, f in found.fits)), key=lambda f: f.rms)
        return least.rms > FLOOR * noise_floor(least.model, self._balances, beside.nuisances)

    def _span(self, beside: Beside) -> JointSpan:
        model = beside.current.model
        return span_of(self._balances, model.law.mu_k * model.load, model.load)

    def _seen(self, beside: Beside, candidate: Candidate) -> Prospect:
        key = (candidate.name, candidate.form, *beside.key)
        if key not in self._prospects:
            waves = [] if candidate.scan is None else self._waves.starts(candidate.scan, beside.current)
            self._prospects[key] = prospect(candidate, waves, beside.current, self._balances)
        return self._prospects[key]

    def _once(self, beside: Beside, seen: Prospect) -> JointFit | None:
        """Return a candidate fitted; None: it has no fit, or as fitted is none of its kind."""
        key = (seen.candidate.name, seen.candidate.form, *beside.key)
        if key not in self._fitted:
            self._tell(seen.candidate.kind)
            fitted = self._best(beside, seen)
            self._fitted[key] = fitted if fitted is not None and self._is_one(beside, fitted) else None
        return self._fitted[key]

    def _is_one(self, beside: Beside, fitted: JointFit) -> bool:
        """Return whether the last effect of a fit is one of its kind, and as fitted shows in such a record."""
        last = len(fitted.model.effects) - 1
        return fitted.model.effects[last].seen_at_joint(self._span(beside)) and not is_none(fitted, last)

    def _best(self, beside: Beside, seen: Prospect) -> JointFit | None:
        """Return the best fit with a candidate; None: it is no number, or nothing is left for a wave.

        How a load moves by itself that is in the model already stays as it is: another motion of it is no merit of this one.
        """
        model, noise = beside.current.model, beside.noise
        loads = [(i, e) for i, e in enumerate(model.effects) if e.moves_load]
        fixed = [(i, field.name) for i, e in loads for field in dataclasses.fields(e)]
        begins = (*seen.starts[: STARTS_ROUGH if seen.rough else STARTS], *seen.waves)
        fits = [fit(s.added_to(model), self._balances, beside.nuisances, noise=noise, fixed=fixed) for s in begins]
        best = min((f for f in fits if np.isfinite(f.rms)), key=lambda f: f.rms, default=None)
        if best is None:
            return None
        if seen.rough:
            best = fit(best.model, self._balances, beside.nuisances, noise=noise, refined=True, fixed=fixed)
        return settled(best.model, self._balances, beside.nuisances, noise=noise, fitted=best, fixed=fixed)[0]

    def _worth_fitting(self, beside: Beside, fits: Fitted, courses: Sequence[Candidate]) -> list[Candidate]:
        """Return, of the courses of each kind, the one of as many pieces as the record supports, if it supports any.

        Friction is linear in their weights, so that what a fit will leave is known before it is made. What leaves least counts
        the independent windows: to all others a course that is missing leaves slow noise.

        Args:
            beside: the fit beside which they are asked for.
            fits: other candidates fitted: no course may say less than its kind.
            courses: courses of any shape.
        """
        current = beside.current
        best = min((f for _, f in fits), key=lambda f: f.rms, default=current)
        least, n = best.rms, best.n
        supported: list[tuple[Candidate, float]] = []
        for one in courses:
            left = predicted_left(current.model, begun(one.starts[0], self._balances), self._balances, current)
            rms, own = float(np.sqrt(np.mean(left**2))), current.independent_in(current.split(left))
            if criteria.WINDOWS_A_NUMBER * one.parameters <= own:
                supported.append((one, rms))
                least, n = min((least, n), (rms, own))

        def worth(rms: float, numbers: int) -> float:
            return 2.0 * n * float(np.log(current.rms / rms)) - numbers * float(np.log(n))

        most: dict[str, float] = {}
        for other, fitted in fits:
            most[other.kind] = max(most.get(other.kind, criteria.NAMED), worth(fitted.rms, other.parameters))
        chosen: dict[str, Candidate] = {}
        for one, rms in supported:
            if worth(rms, one.parameters) > most.get(one.kind, criteria.NAMED):
                most[one.kind], chosen[one.kind] = worth(rms, one.parameters), one
        return list(chosen.values())


def _asked(span: JointSpan, beside: Beside, *, of_loads: bool) -> list[Candidate]:
    asked = [c for c in candidates(span, beside.current.model.effects) if c.moves_load == of_loads]
    return [c for c in asked if not c.names & beside.without]


def is_none(fitted: JointFit, owner: int) -> bool:
    """Return whether an effect as fitted is none of its kind.

    It is not where a load that moves by itself may as well not be there or ends at the end of what its share can be, where it
    stands for something else, and where what varies along the stroke does not vary, so that a constant does.
    """
    effect = fitted.model.effects[owner]
    if effect.moves_load:
        share = fitted.free[fitted.at(owner, SHARE)[0]]
        value = float(getattr(effect, SHARE))
        return may_be_zero(fitted, owner) or min(value - share.low, share.high - value) < AT_AN_END * (share.high - share.low)
    varies = effect.weights if isinstance(effect, LeveledCourse) and effect.any_shape else VARIES
    at = [i for i, k in enumerate(fitted.free) if k.owner == owner and k.name in varies]
    numbers, covariance = fitted.values[at], fitted.covariance[np.ix_(at, at)]
    if not at or not np.isfinite(covariance).all():
        return False
    # weights of a course share the doubt of what it begins with: together they tell
    return float(numbers @ np.linalg.pinv(covariance, hermitian=True) @ numbers) < float(chi2.ppf(0.95, len(at)))


def may_be_zero(fitted: JointFit, owner: int) -> bool:
    """Return whether the 95 % interval of an effect's size holds zero; that of a wave is asked for otherwise."""
    effect = fitted.model.effects[owner]
    if hasattr(effect, "wavelength"):
        return False
    sizes = [(abs(getattr(effect, name)), fitted.deviation(owner, name)) for name in SIZES if hasattr(effect, name)]
    return any(np.isfinite(deviation) and size < 1.96 * deviation for size, deviation in sizes)
