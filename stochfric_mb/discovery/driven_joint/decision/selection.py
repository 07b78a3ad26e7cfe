"""Selection: one effect at a time, by evidence, by what it is worth on blocks left out, and against smooth competitors."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import f as fisher

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.decision.candidates import (
    COMPETITORS,
    TOGETHER,
    Candidate,
    Competitor,
    candidates,
    span_of,
)
from stochfric_mb.discovery.driven_joint.decision.cross_validation import blocks, compared, each_run, strokes, witnesses
from stochfric_mb.discovery.driven_joint.decision.evidence import scatter, settings_of, whitened
from stochfric_mb.discovery.driven_joint.fit.beliefs import Belief, beliefs
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_rows, prior_weight
from stochfric_mb.discovery.driven_joint.fit.free_parameters import MOST_OFF
from stochfric_mb.discovery.driven_joint.fit.gains import predicted_rms
from stochfric_mb.discovery.driven_joint.fit.joint_model import STEP, JointModel, change_of
from stochfric_mb.discovery.driven_joint.fit.wave_scan import Start, tried, wave_starts
from stochfric_mb.discovery.inference.free_parameter import MECHANISM
from stochfric_mb.discovery.inference.paired import Paired
from stochfric_mb.effects import Effect
from stochfric_mb.effects.joints import JointSpan

Array = npt.NDArray[np.float64]

NAMED = 20.0
"""Score above which an effect is named."""
MATERIAL = 0.05
"""Least share of the error on left-out blocks that an effect must take away: less is real, perhaps, but no explanation."""
MATERIAL_PHASED = 0.15
"""The same, on runs left out, for a wave whose phase is taken from each run: motion that is periodic itself, seen through an
effect of another form, leaves waves that runs share by accident. Chosen: forces of the tests take away 0.5 and more."""
BETTER = 0.5
"""Least share of the blocks that must get better: an effect that shows in one place only is one that was fitted to it."""
CHANCE = 0.05
"""Without that score an effect is taken where strokes left out, one by one, say so with no more chance than this of error,
the axes that were tried counted, and where each half of the record foretells the other better with it."""
FEWEST_STROKES = 8
"""Fewest strokes that can."""
SETTLINGS, SETTLED = 3, 0.8
"""Most refits in which beliefs weigh less, and the part of their weight from which one is worth it [-]."""
TIE = 10.0
"""Difference of scores within which effects cannot be distinguished."""
ALIKE = 0.5
"""Least part of an effect's evidence that one must have which could stand in for it."""
MOST = 4
"""Most effects in one joint: beyond, errors of the first ones would be explained."""
PARTS = np.linspace(0.0, 1.0, 9)
"""Parts of the way to a competitor's fit that are tried where it reads the drive that it explains."""
AT_BOUND = 0.95
"""Part of the way to the bound of a prior from which a number is held by it [-]."""
UNDRIVEN = 1.0e-9
"""Part of the balance that the mechanism's own terms must leave for a drive to be in it [-]: rounding leaves less."""
SIZES = ("amplitude", "coefficient", "asymmetry", "viscous_difference", "rate")
"""Parameters that are zero where an effect is none."""
WIN = (15.0, 0.03)
"""A competitor wins by that score, or that part of the best named effect's score, whichever is more."""


@dataclasses.dataclass(frozen=True)
class Trial:
    """A candidate, fitted."""

    candidate: Candidate
    """The candidate."""
    fit: JointFit
    """Model with it."""
    score: float
    """2 delta log L - p ln n - 2 ln(tried), n counting independent windows, tried: starting points times kinds."""
    p_value: float
    """Chance of that gain without the effect, by Fisher's F on independent windows, times the size of the grid."""


@dataclasses.dataclass(frozen=True)
class Stage:
    """One step of the selection."""

    before: JointFit
    """Model before it."""
    trials: tuple[Trial, ...]
    """Every candidate, best first."""
    competitors: tuple[tuple[str, float], ...]
    """Axis of each smooth competitor, with its score."""
    blocks: Paired
    """What the best candidate is worth on blocks left out."""
    strokes: Paired | None
    """What it is worth on strokes left out, where this was asked."""
    accepted: bool
    """Whether it was taken into the model."""


@dataclasses.dataclass(frozen=True)
class Released:
    """A number of law or mechanism that data take beyond what is believed of it."""

    belief: Belief
    """The number, and what was believed."""
    score: float
    """Evidence, as of a trial."""
    before: float
    """Error with the number within its belief (rms) [N or N m]."""
    after: float
    """Error with it where the data take it."""
    alike: tuple[str, ...] = ()
    """Other numbers that explain as much."""

    @property
    def name(self) -> str:
        """Name of the number."""
        return self.belief.name


@dataclasses.dataclass(frozen=True)
class Selected:
    """The outcome at one joint."""

    recalibrated: JointFit
    """The stated model with its numbers fitted."""
    final: JointFit
    """With the selected effects."""
    effects: tuple[Trial, ...]
    """Effects, as they were when accepted."""
    equivalents: tuple[tuple[str, ...], ...]
    """Effects, and numbers of the mechanism, that could stand in the place of each."""
    stages: tuple[Stage, ...]
    """The steps."""
    unknown: str
    """Axis of what is missing without a name; empty: nothing is."""
    left: tuple[tuple[str, float], ...] = ()
    """Conditions on which what is left plainly depends, one or two together, and by what part the error on blocks left out
    falls with them."""
    released: tuple[Released, ...] = ()
    """Numbers of law and mechanism that are off by more than their uncertainty."""

    @property
    def named(self) -> tuple[str, ...]:
        """Kinds of the effects, and names of the numbers, that were selected."""
        return (*(t.candidate.kind for t in self.effects), *(r.name for r in self.released))


class Selector:
    """Selection at one joint."""

    def __init__(
        self,
        balances: Sequence[ForceBalance],
        nuisances: Sequence[Nuisance],
        start: JointModel,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        self._balances, self._nuisances = list(balances), list(nuisances)
        self._without: frozenset[str] = frozenset()
        self._first: list[tuple[Candidate, JointFit]] = []
        self._tell = progress or (lambda _: None)
        self._settings = settings_of(balances)
        first = fit(start, balances, nuisances, noise=_typical(balances))
        self._noise = prior_weight(first)
        self.recalibrated = self._fit(start)
        self._begin = self._noise, self._nuisances

    def _fit(self, model: JointModel, evaluations: int = 12) -> JointFit:
        return fit(model, self._balances, self._nuisances, noise=self._noise, evaluations=evaluations)

    def run(self, without: frozenset[str] = frozenset()) -> Selected:
        """Return what is selected, without some kinds of effects and numbers of the mechanism."""
        self._without, (self._noise, self._nuisances) = without, self._begin
        current = self.recalibrated
        effects: list[Trial] = []
        stages: list[Stage] = []
        released: list[Released] = []
        while len(effects) < MOST:
            self._tell(f"effect {len(effects) + 1}")
            stage = self._stage(current)
            freed = self._released(current, stage)
            if freed is not None:
                number, current = freed
                released.append(number)
                continue
            stages.append(stage)
            if not stage.accepted:
                break
            effects.append(stage.trials[0])
            self._noise = prior_weight(stage.trials[0].fit)
            current = self._fit(stage.trials[0].fit.model)
            self._noise = prior_weight(current)
            current, effects = self._re_examined(current, effects)
        final, effects = self._without_zero(self._fit(current.model), effects)
        unknown = self._unknown(stages[-1]) if not stages[-1].accepted else ("", 0.0)
        left = (unknown, self._together(final) if effects or released else ("", 0.0))
        return Selected(
            self.recalibrated,
            final,
            tuple(effects),
            tuple(self._equivalents(final, i, t.candidate.parameters) for i, t in enumerate(effects)),
            tuple(stages),
            unknown[0],
            tuple((axis, gain) for axis, gain in left if axis),
            tuple(released),
        )

    def _released(self, current: JointFit, stage: Stage) -> tuple[Released, JointFit] | None:
        """Return the number that is off by more than its uncertainty, if that explains more than any effect.

        It is a finding of its own, a payload for instance: within its belief it would hide behind what it cannot explain.
        """
        freed = sorted(self._freed(current), key=lambda f: -f[0].score)
        # a prior is given up only where it explains more than any effect that leaves it alone
        if not freed or freed[0][0].score < max(NAMED, stage.trials[0].score + TIE):
            return None
        (best, fitted, self._nuisances), others = freed[0], [number for number, _, _ in freed[1:]]
        alike = tuple(r.name for r in others if r.score > max(best.score - TIE, ALIKE * best.score))
        self._noise = prior_weight(fitted)
        return dataclasses.replace(best, alike=alike), self._fit(fitted.model)

    def _freed(self, current: JointFit) -> list[tuple[Released, JointFit, list[Nuisance]]]:
        """Return the numbers that data take beyond their priors, each with the fit in which it may be anything."""
        released: list[tuple[Released, JointFit, list[Nuisance]]] = []
        beside = len(current.model.effects) > len(self.recalibrated.model.effects)
        believed = beliefs(current.model, self._nuisances)
        for belief in believed:
            if belief.name in self._without or (belief.owner == MECHANISM and not self._driven):
                continue
            # beside an effect that imitates inertia less mass would only be less noise: it must press against its bound
            if beside and abs(belief.off(current.model)) < AT_BOUND * MOST_OFF:
                continue
            model, wide = belief.given_up(current.model, self._nuisances)
            freed = fit(model, self._balances, wide, noise=self._noise)
            if abs(belief.off(freed.model)) < MOST_OFF:
                continue
            n = max(freed.independent, 4.0)
            score = self._evidence(current, freed, freed, n) - np.log(n) - 2.0 * np.log(len(believed))
            released.append((Released(belief, float(score), current.rms, freed.rms), freed, wide))
        return released

    @functools.cached_property
    def _driven(self) -> bool:
        """Whether a drive is measured: without one all forces could be less in the same proportion, errors included."""
        names = [n.name for n in self._nuisances]
        columns = np.concatenate([np.column_stack([s.columns[n] for n in names if n in s.columns]) for s in self._balances])
        driven = np.concatenate([s.driven for s in self._balances])
        scaled = columns / np.maximum(np.linalg.norm(columns, axis=0), 1.0e-300)
        rest = driven - scaled @ np.linalg.lstsq(scaled, driven, rcond=None)[0]
        return float(np.linalg.norm(rest)) > UNDRIVEN * float(np.linalg.norm(driven))

    def _without_zero(self, final: JointFit, effects: list[Trial]) -> tuple[JointFit, list[Trial]]:
        """Drop effects whose size may be zero beside those selected after them: nothing is said by them."""
        while True:
            first = len(final.model.effects) - len(effects)
            empty = next((i for i in range(len(effects)) if _may_be_zero(final, first + i)), None)
            if empty is None:
                return final, effects
            others = tuple(e for i, e in enumerate(final.model.effects) if i != first + empty)
            final = self._fit(dataclasses.replace(final.model, effects=others))
            effects = [t for i, t in enumerate(effects) if i != empty]

    def _candidates(self, span: JointSpan, stated: Sequence[Effect]) -> list[Candidate]:
        return [c for c in candidates(span, stated) if c.kind not in self._without]

    def first(self) -> Stage:
        """Return the first step alone."""
        return self._stage(self.recalibrated)

    def _stage(self, current: JointFit) -> Stage:
        span = span_of(self._balances, current.model.law.mu_k * current.model.load, current.model.load)
        again = current is self.recalibrated and bool(self._first)
        fits = [(c, f) for c, f in self._first if c.kind not in self._without] if again else self._fitted(current, span)
        if current is self.recalibrated and not self._first:
            self._first = fits
        trials = self._scored(current, fits)
        rivals = self._competitors(current, trials[0].fit)
        models = current.model, trials[0].fit.model
        phased = len(models[1].own) > len(models[0].own) and len(self._balances) > 1
        parts = each_run(self._balances) if phased else witnesses(self._balances)
        noise = min(self._noise, prior_weight(trials[0].fit))
        inside = compared(*models, self._balances, self._nuisances, noise, parts)
        better = inside.share_better > BETTER if phased else inside.share_better >= BETTER
        enough = trials[0].score > NAMED and inside.rms_gain > (MATERIAL_PHASED if phased else MATERIAL) and better
        repeats = None
        if not enough and len(parts := strokes(self._balances)) >= FEWEST_STROKES:
            repeats = compared(*models, self._balances, self._nuisances, self._noise, parts)
            questions = len({t.candidate.where for t in trials})  # effects along one axis ask nearly the same
            repeats = dataclasses.replace(repeats, p_value=min(1.0, repeats.p_value * questions))
            enough = repeats.rms_gain > MATERIAL and repeats.p_value < CHANCE and self._predicted_better(*models)
        return Stage(current, tuple(trials), tuple(rivals), inside, repeats, enough)

    def _fitted(self, current: JointFit, span: JointSpan) -> list[tuple[Candidate, JointFit]]:
        """Return the candidates that the model does not have yet, fitted."""
        fits: list[tuple[Candidate, JointFit]] = []
        for candidate in self._candidates(span, current.model.effects):
            self._tell(candidate.kind)
            fitted = self._best(current, candidate)
            fits += [(candidate, fitted)] if fitted is not None else []
        return fits

    def _predicted_better(self, plain: JointModel, richer: JointModel) -> bool:
        """Return whether each half of the record, left out, is predicted better by the richer model by a material part."""
        halves = blocks(self._balances, 2)
        seen = [compared(plain, richer, self._balances, self._nuisances, self._noise, [half]) for half in halves]
        return min(s.rms_gain for s in seen) > MATERIAL

    def _best(self, current: JointFit, candidate: Candidate) -> JointFit | None:
        """Return the best fit with a candidate; None: nothing is left that a wave of it would explain."""
        starts = [Start(e) for e in candidate.starts]
        if len(starts) > 2:
            starts.sort(key=lambda s: predicted_rms(current.model, s.effect, self._balances, current))
        waves = wave_starts(candidate.scan, current, self._balances) if candidate.scan is not None else []
        fits = [self._fit(s.added_to(current.model)) for s in (*starts[:2], *waves)]
        return self._settled(min(fits, key=lambda f: f.rms)) if fits else None

    def _settled(self, fitted: JointFit) -> JointFit:
        """Return a fit in which beliefs count as much as one independent window of what it leaves itself."""
        noise = self._noise
        for _ in range(SETTLINGS):
            if prior_weight(fitted) > SETTLED * noise:
                break
            noise = prior_weight(fitted)
            fitted = fit(fitted.model, self._balances, self._nuisances, noise=noise)
        return fitted

    def _scored(self, current: JointFit, fits: Sequence[tuple[Candidate, JointFit]]) -> list[Trial]:
        # all are judged by the same count of independent windows: that of the best fit
        best = min((f for _, f in fits), key=lambda f: f.rms)
        n = max(best.independent, 4.0)
        trials = [self._trial(current, c, f, best, n, len(fits)) for c, f in fits]
        return simplest_first(sorted(trials, key=lambda t: -t.score))

    def _trial(self, current: JointFit, candidate: Candidate, fitted: JointFit, best: JointFit, n: float, kinds: int) -> Trial:
        waves = tried(candidate.scan, self._balances) if candidate.scan is not None else 0.0
        p, grid = candidate.parameters, (len(candidate.starts) + waves) * kinds
        p += max(len(fitted.model.own) - len(current.model.own) - 1, 0)
        ratio = max((current.rms / fitted.rms) ** 2, 1.0)
        score = self._evidence(current, fitted, best, n) - p * np.log(n) - 2.0 * np.log(grid)
        spare = max(n - len(fitted.free), 1.0)
        chance = float(fisher.sf((ratio - 1.0) * spare / p, p, spare))
        return Trial(candidate, fitted, float(score), min(1.0, chance * grid))

    def _evidence(self, plain: JointFit, richer: JointFit, best: JointFit, n: float) -> float:
        """Return 2 delta log L of two fits, beliefs included, settings scattering as they do about the best fit there is."""
        ratio = scatter(np.concatenate(best.remainders), self._settings, n).ratio
        before, after = (
            scatter(np.concatenate(f.remainders), self._settings, n, ratios=np.array([ratio])) for f in (plain, richer)
        )
        return before.deviance + plain.strain - after.deviance - richer.strain

    def _competitors(self, current: JointFit, best: JointFit) -> list[tuple[str, float]]:
        n = max(best.independent, 4.0)
        prior, offsets = prior_rows(current, self._noise)
        rest = np.concatenate(current.remainders)
        before = scatter(rest, self._settings, n)
        kept = adjustable(current)
        rivals: list[tuple[str, float]] = []
        for rival in COMPETITORS:
            columns = self._sliding_columns(rival)
            width = columns.shape[1]
            if width == 0:
                continue
            design = np.column_stack([current.jacobian[:, kept], columns])
            below = np.column_stack([prior[:, kept], np.zeros((len(prior), width))])
            slopes = self._by_drive(rival)
            after = min(self._deviance_without(rest, offsets, design, below, n, ratio, slopes) for ratio in {0.0, before.ratio})
            score = before.deviance - after - width * np.log(n)
            rivals.append((rival.axis, float(score)))
        return sorted(rivals, key=lambda r: -r[1])

    def _together(self, current: JointFit) -> tuple[str, float]:
        """Return the two conditions on which what is left depends together, beyond what it does on each; empty: on none.

        Beside them stands by what part the error on blocks left out falls with them.
        """
        n = max(current.independent, 4.0)
        prior, offsets = prior_rows(current, self._noise)
        rest, kept = np.concatenate(current.remainders), adjustable(current)
        ratio = scatter(rest, self._settings, n).ratio
        scores: list[float] = []
        for both, alone in TOGETHER:
            deviances: list[float] = []
            for some in (alone, (*alone, both)):
                columns = np.column_stack([self._sliding_columns(c) for c in some])
                design = np.column_stack([current.jacobian[:, kept], columns])
                below = np.column_stack([prior[:, kept], np.zeros((len(prior), columns.shape[1]))])
                slopes = np.column_stack([self._by_drive(c) for c in some])
                deviances.append(self._deviance_without(rest, offsets, design, below, n, ratio, slopes))
            scores.append(deviances[0] - deviances[1] - float(np.log(n)))
        best = int(np.argmax(scores))
        if scores[best] < NAMED + 2.0 * np.log(len(TOGETHER)):
            return "", 0.0
        both, alone = TOGETHER[best]
        gain = self._rival_gain(current, both, alone)
        return (both.axis, gain) if gain > MATERIAL else ("", 0.0)

    def _sliding_columns(self, rival: Competitor) -> Array:
        """Return the columns of a competitor at the windows of sliding, shape (n_windows, k)."""
        seen = rival.columns(self._balances)
        return np.concatenate([c[s.sliding] for c, s in zip(seen, self._balances, strict=True)])

    def _deviance_without(
        self, rest: Array, offsets: Array, design: Array, below: Array, n: float, ratio: float, slopes: Array
    ) -> float:
        """Return the deviance of what ``design`` leaves, fitted for one ratio of the variances; ``below`` are the priors.

        ``slopes`` is the change of its last columns with the drive: where they have any, the best part of the way to that
        fit is taken, the drive being explained by motion only.
        """
        both = np.vstack([whitened(design, self._settings, n, ratio), below])
        scale = np.maximum(np.linalg.norm(both, axis=0), 1.0e-300)
        goal = np.r_[whitened(rest[:, None], self._settings, n, ratio)[:, 0], offsets]
        fitted = np.linalg.lstsq(both / scale, goal, rcond=1.0e-10)[0]
        b = fitted / scale
        if not slopes.any():
            return scatter(rest - design @ b, self._settings, n).deviance
        left = [explained(rest, design, part * b, slopes) for part in PARTS]
        return min(scatter(r, self._settings, n).deviance for r in left)

    def _by_drive(self, rival: Competitor) -> Array:
        """Return the change of a competitor's columns with the drive, shape (n_windows, k)."""
        at = self._balances
        step = STEP * max(float(np.mean(np.concatenate([s.load for s in at]))), 1.0e-300)
        moved = [s if s.load_by_drive is None else dataclasses.replace(s, load=s.load + step * s.load_by_drive) for s in at]
        change = zip(rival.columns(moved, at), rival.columns(at), at, strict=True)
        return np.concatenate([((there - here) / step)[s.sliding] for there, here, s in change])

    def _re_examined(self, current: JointFit, effects: list[Trial]) -> tuple[JointFit, list[Trial]]:
        """Drop effects that later ones have made superfluous."""
        for trial in effects[:-1]:
            if trial.score < NAMED:  # taken for what it is worth on strokes left out
                continue
            kind = trial.candidate.kind
            without = dataclasses.replace(current.model, effects=tuple(e for e in current.model.effects if e.kind != kind))
            fitted = self._fit(without)
            n = max(current.independent, 4.0)
            score = self._evidence(fitted, current, current, n) - trial.candidate.parameters * np.log(n)
            if score < NAMED:
                current, effects = fitted, [t for t in effects if t.candidate.kind != kind]
        return current, effects

    def _equivalents(self, final: JointFit, number: int, size: int) -> tuple[str, ...]:
        """Return what could stand in the place of an effect of ``size`` numbers of the final model, within `TIE`.

        Kinds of effects, and names of numbers of the mechanism that would be beyond their beliefs.
        """
        added = len(final.model.effects) - len(self.recalibrated.model.effects)
        own = final.model.effects[len(final.model.effects) - added + number]
        others = tuple(e for e in final.model.effects if e is not own)
        without = self._fit(dataclasses.replace(final.model, effects=others))
        span = span_of(self._balances, without.model.law.mu_k * without.model.load, without.model.load)
        choices = [c for c in self._candidates(span, others) if c.kind != own.kind]
        fits = [(c, f) for c in choices if (f := self._best(without, c)) is not None]
        n = max(final.independent, 4.0)
        mine = self._evidence(without, final, final, n)
        theirs = [(c.kind, c.parameters, self._evidence(without, f, final, n)) for c, f in fits]
        theirs += [(number.name, 1, self._evidence(without, f, final, n)) for number, f, _ in self._freed(without)]
        # one that explains next to nothing stands in for nothing, however close the scores
        return tuple(
            dict.fromkeys(
                name
                for name, numbers, gain in theirs
                if gain > ALIKE * mine and gain - numbers * np.log(n) > mine - size * np.log(n) - TIE
            )
        )

    def _unknown(self, last: Stage) -> tuple[str, float]:
        """Return the axis of what is missing that no effect explains, empty if nothing is, and what part it takes away."""
        axis, score = last.competitors[0] if last.competitors else ("", -np.inf)
        named = last.trials[0].score
        if score < NAMED + 2.0 * np.log(len(COMPETITORS)) or score < named + max(WIN[0], WIN[1] * abs(named)):
            return "", 0.0
        gain = self._rival_gain(last.before, next(c for c in COMPETITORS if c.axis == axis))
        return (axis, gain) if gain > MATERIAL else ("", 0.0)

    def _rival_gain(self, current: JointFit, rival: Competitor, beside: Sequence[Competitor] = ()) -> float:
        """Return by what part a competitor lowers the error on blocks left out, beyond what those ``beside`` it do."""
        inside = [s.sliding for s in self._balances]
        prior, offsets = prior_rows(current, self._noise)
        known = np.vstack([current.jacobian, prior])[:, adjustable(current)]
        y = np.r_[np.concatenate(current.remainders), offsets]
        errors = [0.0, 0.0]
        for i, some in enumerate((tuple(beside), (*beside, rival))):
            more = [self._sliding_columns(c) for c in some]
            slopes = np.column_stack([self._by_drive(c) for c in some]) if some else np.zeros((len(y) - len(prior), 0))
            design = np.column_stack([known, *(_padded(c, len(prior)) for c in more)])
            for block in blocks(self._balances):
                inner = np.concatenate([b[m] for b, m in zip(block, inside, strict=True)])
                out = np.r_[inner, np.zeros(len(prior), dtype=bool)]
                scale = np.maximum(np.linalg.norm(design, axis=0), 1.0e-300)
                b = np.linalg.lstsq(design[~out] / scale, y[~out], rcond=1.0e-10)[0] / scale
                left = explained(y[out], design[out], b, slopes[inner]) if slopes.any() else y[out] - design[out] @ b
                errors[i] += float(np.sum(left**2))
        return 1.0 - float(np.sqrt(errors[1] / errors[0]))


def simplest_first(trials: list[Trial]) -> list[Trial]:
    """Return trials, best first, with the one of fewest numbers in front among those as good as the best.

    A wave far longer than the stroke is a constant force with three numbers. Of forms of one effect with as many numbers it is
    the one that the effect gives first, which assumes least.
    """
    tied = [t for t in trials if t.score > max(trials[0].score - TIE, 0.0)]
    if not tied:
        return trials
    best = min(tied, key=lambda t: (t.candidate.parameters, -t.score)).candidate
    alike = [t for t in tied if (t.candidate.kind, t.candidate.parameters) == (best.kind, best.parameters)]
    first = min(alike, key=lambda t: t.candidate.form)
    return [first, *(t for t in trials if t is not first)]


def explained(rest: Array, design: Array, b: Array, slopes: Array) -> Array:
    """Return what ``design`` times ``b`` leaves of the drive, whose last columns change with the drive by ``slopes``."""
    by_drive = 1.0 - slopes @ b[len(b) - slopes.shape[1] :]
    return (rest - design @ b) / change_of(by_drive)


def _may_be_zero(fitted: JointFit, owner: int) -> bool:
    """Return whether the 95 % interval of an effect's size holds zero; that of a wave is asked for otherwise."""
    effect = fitted.model.effects[owner]
    if hasattr(effect, "wavelength"):
        return False
    sizes = [(abs(getattr(effect, name)), fitted.deviation(owner, name)) for name in SIZES if hasattr(effect, name)]
    return any(np.isfinite(deviation) and size < 1.96 * deviation for size, deviation in sizes)


def adjustable(fitted: JointFit) -> list[int]:
    """Return the numbers of a fit that a smooth competitor may move: all but gains.

    With less gain and a potential of its own in the place of gravity there would be less of everything, errors included.
    """
    return [i for i, k in enumerate(fitted.free) if k.owner != MECHANISM or not k.name.endswith("gain")]


def _padded(columns: Array, rows: int) -> Array:
    """Return ``columns`` with ``rows`` rows of zeros below."""
    return np.vstack([columns, np.zeros((rows, columns.shape[1]))])


def _typical(balances: Sequence[ForceBalance]) -> float:
    return float(np.std(np.concatenate([s.driven[s.sliding] for s in balances])))
