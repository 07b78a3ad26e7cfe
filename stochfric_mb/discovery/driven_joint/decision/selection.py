"""Selection: one effect at a time, by evidence, by what it is worth on blocks left out, and against smooth competitors."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable, Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2
from scipy.stats import f as fisher

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, by_state, confounded
from stochfric_mb.discovery.driven_joint.balance.force_balance import GAIN, ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.decision.candidates import Candidate, candidates, span_of
from stochfric_mb.discovery.driven_joint.decision.cross_validation import blocks, compared, each_run, strokes, witnesses
from stochfric_mb.discovery.driven_joint.decision.evidence import evidence, settings_of
from stochfric_mb.discovery.driven_joint.decision.released import Freed, Released, beyond_beliefs, by_gain
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import COMPETITORS, SIGNED, TIMES, SmoothDependences
from stochfric_mb.discovery.driven_joint.fit.beliefs import at_end, beliefs
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight, settled
from stochfric_mb.discovery.driven_joint.fit.gains import predicted_left, predicted_rms
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.periodic_shape import WaveSearch
from stochfric_mb.discovery.driven_joint.fit.wave_scan import begun, tried
from stochfric_mb.discovery.driven_joint.simulation.scores import FLOOR, noise_floor
from stochfric_mb.discovery.inference.paired import Paired
from stochfric_mb.effects.course import LeveledCourse
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.traits import ROUGH

Array = npt.NDArray[np.float64]

STARTS, STARTS_ROUGH = 2, 6
"""Best starts of an effect from which it is fitted; of a rough one the best is often in a wrong valley."""
SIZES = ("amplitude", "coefficient", "asymmetry", "viscous_difference", "rate", "load_share", "gap")
"""Parameters that are zero where an effect is none."""
VARIES = ("slope", "curvature", "ripple")
"""Parameters that are all zero where what varies along the stroke is a constant."""
SHARE, AT_AN_END = "load_share", 1.0e-3
"""Part of the inertia that moves by itself, and how close to an end of its range it has reached it, over that range [-]:
rounding."""


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
    nuisances: tuple[Nuisance, ...] = ()
    """Numbers of the mechanism with their priors in the final fit: those released have none that holds them."""
    imitated: str = ""
    """Two conditions of a smooth dependence beside which an effect of others explains nothing; empty: all explain something."""

    @property
    def named(self) -> tuple[str, ...]:
        """Kinds of the effects, and names of the numbers, that were selected."""
        return (*(t.candidate.kind for t in self.effects), *(r.name for r in self.released))


Beside = tuple[Hashable, ...]
"""The effects of a model by kind and adjusted numbers, and what is believed of law and mechanism."""
Fixed = Sequence[tuple[int, str]]
"""Numbers of effects, by their places in a model and names, that a fit leaves as they are."""
Fitted = list[tuple[Candidate, JointFit]]
"""Candidates with their fits."""


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
        self._forms: dict[Beside, tuple[frozenset[str], Fitted]] = {}
        self._courses: dict[Beside, JointFit | None] = {}
        self._waves = WaveSearch(balances)
        self._tell = progress or (lambda _: None)
        self._settings, self._smooth, self._pairs = settings_of(balances), SmoothDependences(balances), confounded(balances)
        self.recalibrated, self._noise = settled(start, balances, nuisances, noise=_typical(balances))
        self._begin = self._noise, self._nuisances

    def _fit(self, model: JointModel, *, refined: bool = True, fixed: Fixed = ()) -> JointFit:
        return fit(model, self._balances, self._nuisances, noise=self._noise, refined=refined, fixed=fixed)

    def run(self, without: frozenset[str] = frozenset()) -> Selected:
        """Return what is selected, without some kinds of effects and numbers of the mechanism."""
        self._without, (self._noise, self._nuisances) = without, self._begin
        current = self.recalibrated
        effects: list[Trial] = []
        stages: list[Stage] = []
        released: list[Released] = []
        while len(effects) < criteria.MOST_EFFECTS:
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
            current, released = self._taken_back(current, released)
        final, effects = self._without_pushing(*self._without_zero(self._fit(current.model), effects))
        unknown = self._unknown(stages[-1]) if not stages[-1].accepted else ("", 0.0)
        left = (unknown, self._smooth.together(final, self._noise) if effects or released else ("", 0.0))
        imitated = left[1][0] if any(self._imitated(final, i, t, left[1][0]) for i, t in enumerate(effects)) else ""
        return Selected(
            self.recalibrated,
            final,
            tuple(effects),
            tuple(self._equivalents(final, i, t.candidate.parameters) for i, t in enumerate(effects)),
            tuple(stages),
            unknown[0],
            tuple((axis, gain) for axis, gain in left if axis),
            tuple(released),
            tuple(self._nuisances),
            imitated,
        )

    def _imitated(self, final: JointFit, number: int, trial: Trial, axis: str) -> bool:
        """Return whether an effect of other conditions explains nothing beside two on which what is left depends together.

        The motion comes back, and the clock goes on with it: a course in time of many pieces can draw a part of what the state
        does, and leave the rest.
        """
        if not axis or trial.candidate.where in axis.removesuffix(SIGNED).split(TIMES):
            return False
        effects = final.model.effects
        own = len(self.recalibrated.model.effects) + number
        without = self._fit(dataclasses.replace(final.model, effects=tuple(e for i, e in enumerate(effects) if i != own)))
        numbers = _numbers(without, trial.candidate, final)
        keeps = self._smooth.left_to(final, without, self._noise, axis)
        return keeps - numbers * float(np.log(max(final.independent, 4.0))) < criteria.NAMED

    def _released(self, current: JointFit, stage: Stage) -> tuple[Released, JointFit] | None:
        """Return the number that is off by more than its uncertainty, if that explains more than any effect.

        It is a finding of its own, a payload for instance: within its belief it would hide behind what it cannot explain. As
        effects do, it has to foretell parts of the record that were left out.
        """
        freed = self._freed(current)
        # all are judged by the same count of independent windows: that of the best fit
        finest = min((*(t.fit for t in stage.trials), *(f.fit for f in freed)), key=lambda f: f.rms)
        n = max(finest.independent, 4.0)

        def worth(fitted: JointFit, numbers: int) -> float:
            return evidence(current, fitted, finest, self._settings) - numbers * float(np.log(n))

        # a prior is given up where that explains more than any effect that leaves it alone and could be named, or as much with
        # fewer numbers: an effect whose curve is straight is a constant
        rivals = [(t.fit, _numbers(current, t.candidate, t.fit)) for t in stage.trials if t.score > criteria.NAMED]
        needs = (worth(f, numbers) + (criteria.TIE if numbers <= 1 else -criteria.TIE) for f, numbers in rivals)
        enough = max(needs, default=-np.inf)
        named = [f for f in freed if f.number.score >= criteria.NAMED and worth(f.fit, 1) >= enough]
        best = next((f for f in named if self._foretells(current, f)), None)
        if best is None:
            return None
        others = [f.number for f in freed if f is not best]
        gain = None if GAIN in self._without else by_gain(current, self._balances, self._nuisances, self._noise)
        others += [] if gain is None else [gain]
        least = max(best.number.score - criteria.TIE, criteria.STANDS_IN * best.number.score)
        self._nuisances, self._noise = best.nuisances, prior_weight(best.fit)
        released = dataclasses.replace(best.number, alike=tuple(r.name for r in others if r.score > least))
        return released, self._fit(best.fit.model)

    def _taken_back(self, current: JointFit, released: list[Released]) -> tuple[JointFit, list[Released]]:
        """Believe again numbers that effects found after them explain: what is left of their evidence no longer names them."""
        for number in released:
            model, nuisances = number.belief.held(current.model, self._nuisances)
            fitted, noise = settled(model, self._balances, nuisances, noise=self._noise)
            score = evidence(fitted, current, current, self._settings) - float(np.log(max(current.independent, 4.0)))
            if score < criteria.NAMED:
                self._nuisances, self._noise, current = nuisances, noise, fitted
                released = [r for r in released if r is not number]
        return current, released

    def _foretells(self, current: JointFit, freed: Freed) -> bool:
        """Return whether a number beyond its belief predicts parts that were left out better, by a material part."""
        noise = min(self._noise, prior_weight(freed.fit))
        models = current.model, freed.fit.model
        parts = witnesses(self._balances)
        seen = compared(*models, self._balances, self._nuisances, noise, parts, freed.nuisances)
        return seen.rms_gain > criteria.MATERIAL and seen.share_better >= criteria.BETTER

    def _freed(self, current: JointFit) -> list[Freed]:
        beside = len(current.model.effects) > len(self.recalibrated.model.effects)
        return beyond_beliefs(current, self._balances, self._nuisances, self._noise, beside=beside, without=self._without)

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

    def _without_pushing(self, final: JointFit, effects: list[Trial]) -> tuple[JointFit, list[Trial]]:
        """Drop further effects that need a number as far off as beliefs give way, where those before them leave it within."""
        believed = beliefs(final.model, self._nuisances)
        shorter, kept = final, effects
        while at_end(shorter.model, believed) is not None and len(kept) > 1:
            shorter, kept = self._fit(dataclasses.replace(shorter.model, effects=shorter.model.effects[:-1])), kept[:-1]
        return (final, effects) if at_end(shorter.model, believed) is not None else (shorter, kept)

    def _stage(self, current: JointFit) -> Stage:
        span = span_of(self._balances, current.model.law.mu_k * current.model.load, current.model.load)
        fits = self._fitted(current, span)
        trials = self._scored(current, fits)
        rivals = self._smooth.scores(current, trials[0].fit, self._noise)
        models = current.model, trials[0].fit.model
        phased = len(models[1].own) > len(models[0].own) and len(self._balances) > 1
        parts = each_run(self._balances) if phased else witnesses(self._balances)
        noise = min(self._noise, prior_weight(trials[0].fit))
        inside = compared(*models, self._balances, self._nuisances, noise, parts)
        better = inside.share_better > criteria.BETTER if phased else inside.share_better >= criteria.BETTER
        enough = (
            trials[0].score > criteria.NAMED
            and inside.rms_gain > (criteria.MATERIAL_PHASED if phased else criteria.MATERIAL)
            and better
        )
        repeats = None
        if not enough and len(parts := strokes(self._balances)) >= criteria.FEWEST_STROKES:
            repeats = compared(*models, self._balances, self._nuisances, self._noise, parts)
            questions = len({t.candidate.where for t in trials})  # effects along one axis ask nearly the same
            repeats = dataclasses.replace(repeats, p_value=min(1.0, repeats.p_value * questions))
            enough = (
                repeats.rms_gain > criteria.MATERIAL
                and repeats.p_value < criteria.STROKES_BY_CHANCE
                and self._predicted_better(*models)
            )
        return Stage(current, tuple(trials), tuple(rivals), inside, repeats, enough)

    def _fitted(self, current: JointFit, span: JointSpan) -> Fitted:
        """Return the candidates that the model does not have yet, fitted.

        A load that moves by itself is looked for where all other candidates leave more than noise: it can take noise of the
        acceleration away, whether there is such a load or not. Its force takes long to work out: it is looked for first, and
        again where nothing else has a name.
        """
        fits = self._fits(current, span, of_loads=False)
        least = min((current, *(f for _, f in fits)), key=lambda f: f.rms)
        first = len(current.model.effects) == len(self.recalibrated.model.effects)
        asked = first or self._scored(current, fits)[0].score <= criteria.NAMED
        if asked and least.rms > FLOOR * noise_floor(least.model, self._balances, self._nuisances):
            fits += self._fits(current, span, of_loads=True)
        return fits

    def _fits(self, current: JointFit, span: JointSpan, *, of_loads: bool) -> Fitted:
        """Return candidates, those of moving loads or all others, fitted; beside the same effects that is done once."""
        key = (of_loads, *self._beside(current))
        left_out, forms = self._forms.get(key, (frozenset[str](), None))
        asked = [c for c in candidates(span, current.model.effects) if c.moves_load == of_loads]
        asked = [c for c in asked if not c.names & self._without]
        if forms is None or not left_out <= self._without:
            forms = [(c, f) for c in asked if not c.any_shape and (f := self._searched(current, c)) is not None]
            self._forms[key] = self._without, forms
        fits = [(c, f) for c, f in forms if not c.names & self._without]
        for course in self._worth_fitting(current, fits, [c for c in asked if c.any_shape]):
            one = (*key, course.name, course.parameters)
            if one not in self._courses:
                self._courses[one] = self._searched(current, course)
            fitted = self._courses[one]
            fits += [] if fitted is None else [(course, fitted)]
        return fits

    def _searched(self, current: JointFit, candidate: Candidate) -> JointFit | None:
        """Return a candidate fitted; None: it has no fit, or as fitted is none of its kind."""
        self._tell(candidate.kind)
        fitted = self._best(current, candidate)
        return fitted if fitted is not None and not _is_none(fitted, len(fitted.model.effects) - 1) else None

    def _worth_fitting(self, current: JointFit, fits: Fitted, courses: Sequence[Candidate]) -> list[Candidate]:
        """Return, of the courses of each kind, the one of as many pieces as the record supports, if it supports any.

        Friction is linear in their weights, so that what a fit will leave is known before it is made. What leaves least counts
        the independent windows: to all others a course that is missing leaves slow noise.

        Args:
            current: the fit beside which they are asked for.
            fits: other candidates fitted: no course may say less than its kind.
            courses: courses of any shape.
        """
        best = min((f for _, f in fits), key=lambda f: f.rms, default=current)
        least, n = best.rms, max(best.independent, 4.0)
        ends = np.cumsum([len(r) for r in current.remainders])[:-1]
        supported: list[tuple[Candidate, float]] = []
        for one in courses:
            left = predicted_left(current.model, begun(one.starts[0], self._balances), self._balances, current)
            rms, own = float(np.sqrt(np.mean(left**2))), current.independent_in(np.split(left, ends))
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

    def _beside(self, current: JointFit) -> Beside:
        numbers = {(k.owner, k.name) for k in current.free}
        forms = [(e.kind, *sorted(n for o, n in numbers if o == i)) for i, e in enumerate(current.model.effects)]
        return *sorted(forms), *self._nuisances, current.model.level

    def _predicted_better(self, plain: JointModel, richer: JointModel) -> bool:
        """Return whether each half of the record, left out, is predicted better by the richer model by a material part."""
        halves = blocks(self._balances, 2)
        seen = [compared(plain, richer, self._balances, self._nuisances, self._noise, [half]) for half in halves]
        return min(s.rms_gain for s in seen) > criteria.MATERIAL

    def _best(self, current: JointFit, candidate: Candidate) -> JointFit | None:
        """Return the best fit with a candidate; None: it is no number, or nothing is left for a wave.

        How a load moves by itself that is in the model already stays as it is: another motion of it is no merit of this one.
        """
        loads = [(i, e) for i, e in enumerate(current.model.effects) if e.moves_load]
        fixed = [(i, field.name) for i, e in loads for field in dataclasses.fields(e)]
        starts = [begun(e, self._balances) for e in candidate.starts]
        if len(starts) > STARTS:
            starts.sort(key=lambda s: predicted_rms(current.model, s, self._balances, current))
        waves = [] if candidate.scan is None else self._waves.starts(candidate.scan, current)
        count = STARTS_ROUGH if any(ROUGH in s.effect.traits for s in starts) else STARTS
        fits = [self._fit(s.added_to(current.model), refined=False, fixed=fixed) for s in (*starts[:count], *waves)]
        best = min((f for f in fits if np.isfinite(f.rms)), key=lambda f: f.rms, default=None)
        if best is None:
            return None
        if any(ROUGH in s.effect.traits for s in starts):
            best = self._fit(best.model, fixed=fixed)
        return settled(best.model, self._balances, self._nuisances, noise=self._noise, fitted=best, fixed=fixed)[0]

    def _scored(self, current: JointFit, fits: Sequence[tuple[Candidate, JointFit]]) -> list[Trial]:
        # all are judged by the same count of independent windows: that of the best fit
        best = min((f for _, f in fits), key=lambda f: f.rms)
        n = max(best.independent, 4.0)
        trials = [self._trial(current, c, f, best, n, len(fits)) for c, f in fits]
        return simplest_first(sorted(trials, key=lambda t: -t.score), self._pairs)

    def _trial(self, current: JointFit, candidate: Candidate, fitted: JointFit, best: JointFit, n: float, kinds: int) -> Trial:
        waves = tried(candidate.scan, self._balances) if candidate.scan is not None else 0.0
        p, grid = _numbers(current, candidate, fitted), (len(candidate.starts) + waves) * kinds
        ratio = max((current.rms / fitted.rms) ** 2, 1.0)
        score = evidence(current, fitted, best, self._settings) - p * np.log(n) - 2.0 * np.log(grid)
        spare = max(n - len(fitted.free), 1.0)
        chance = float(fisher.sf((ratio - 1.0) * spare / p, p, spare))
        return Trial(candidate, fitted, float(score), min(1.0, chance * grid))

    def _re_examined(self, current: JointFit, effects: list[Trial]) -> tuple[JointFit, list[Trial]]:
        """Drop effects that later ones have made superfluous."""
        for trial in effects[:-1]:
            if trial.score < criteria.NAMED:  # taken for what it is worth on strokes left out
                continue
            kind = trial.candidate.kind
            without = dataclasses.replace(current.model, effects=tuple(e for e in current.model.effects if e.kind != kind))
            fitted, _ = settled(without, self._balances, self._nuisances, noise=self._noise)
            n = max(current.independent, 4.0)
            score = evidence(fitted, current, current, self._settings) - trial.candidate.parameters * np.log(n)
            if score < criteria.NAMED:
                current, effects = fitted, [t for t in effects if t.candidate.kind != kind]
        return current, effects

    def _equivalents(self, final: JointFit, number: int, size: int) -> tuple[str, ...]:
        """Return what could stand in the place of an effect of ``size`` numbers of the final model, within `criteria.TIE`.

        Kinds of effects, and names of numbers of the mechanism that would be beyond their beliefs.
        """
        added = len(final.model.effects) - len(self.recalibrated.model.effects)
        own = final.model.effects[len(final.model.effects) - added + number]
        others = tuple(e for e in final.model.effects if e is not own)
        without = self._fit(dataclasses.replace(final.model, effects=others))
        span = span_of(self._balances, without.model.law.mu_k * without.model.load, without.model.load)
        fits = [(c, f) for c, f in self._fitted(without, span) if c.kind != own.kind]
        n = max(final.independent, 4.0)
        mine = evidence(without, final, final, self._settings)
        theirs = [(c.kind, c.parameters, evidence(without, f, final, self._settings)) for c, f in fits]
        theirs += [(f.number.name, 1, evidence(without, f.fit, final, self._settings)) for f in self._freed(without)]
        # one that explains next to nothing stands in for nothing, however close the scores
        return tuple(
            dict.fromkeys(
                name
                for name, numbers, gain in theirs
                if gain > criteria.STANDS_IN * mine and gain - numbers * np.log(n) > mine - size * np.log(n) - criteria.TIE
            )
        )

    def _unknown(self, last: Stage) -> tuple[str, float]:
        """Return the axis of what is missing that no effect explains, empty if nothing is, and what part it takes away."""
        axis, score = last.competitors[0] if last.competitors else ("", -np.inf)
        named = last.trials[0].score
        if score < criteria.NAMED + 2.0 * np.log(len(COMPETITORS)) or score < named + max(
            criteria.WINS_BY, criteria.WINS_BY_SHARE * abs(named)
        ):
            return "", 0.0
        gain = self._smooth.gain(last.before, self._noise, next(c for c in COMPETITORS if c.axis == axis))
        return (axis, gain) if gain > criteria.MATERIAL else ("", 0.0)


def simplest_first(trials: list[Trial], pairs: Sequence[Confounded] = ()) -> list[Trial]:
    """Return trials, best first, with the one of fewest numbers in front among those as good as the best.

    A wave far longer than the stroke is a constant force with three numbers. Of forms of one effect with as many numbers it is
    the one that the effect gives first, which assumes least. A course of any shape has to be better than what has another form
    by as much as anything needs to be named. An effect of the clock stands behind one of a state that went
    together with it.

    Args:
        trials: candidates.
        pairs: conditions that went together.
    """
    best = trials[0]
    least = criteria.NAMED if best.score > criteria.NAMED else 0.0  # what could not be named stands before nothing that can
    # a course follows what has fewer freedoms: in front of it stands what explains as much but for what names need
    margins = [criteria.NAMED if best.candidate.any_shape and not t.candidate.any_shape else criteria.TIE for t in trials]
    tied = [t for t, margin in zip(trials, margins, strict=True) if t.score > max(best.score - margin, least)]
    if not tied:
        return trials
    by_size = sorted(tied, key=lambda t: (t.candidate.parameters, -t.score))
    states = by_state(by_size[0].candidate.kind, [t.candidate.kind for t in tied], pairs)
    chosen = next((t for t in by_size if t.candidate.kind in states), by_size[0]).candidate
    alike = [t for t in tied if (t.candidate.kind, t.candidate.parameters) == (chosen.kind, chosen.parameters)]
    first = min(alike, key=lambda t: t.candidate.form)
    return [first, *(t for t in trials if t is not first)]


def _numbers(current: JointFit, candidate: Candidate, fitted: JointFit) -> int:
    """Return how many numbers a candidate adds to a fit, phases that each run has for itself among them."""
    return candidate.parameters + max(len(fitted.model.own) - len(current.model.own) - 1, 0)


def _is_none(fitted: JointFit, owner: int) -> bool:
    """Return whether an effect as fitted is none of its kind.

    It is not where a load that moves by itself may as well not be there or ends at the end of what its share can be, where it
    stands for something else, and where what varies along the stroke does not vary, so that a constant does.
    """
    effect = fitted.model.effects[owner]
    if effect.moves_load:
        share = next(k for k in fitted.free if (k.owner, k.name) == (owner, SHARE))
        value = float(getattr(effect, SHARE))
        return _may_be_zero(fitted, owner) or min(value - share.low, share.high - value) < AT_AN_END * (share.high - share.low)
    varies = effect.weights if isinstance(effect, LeveledCourse) and effect.any_shape else VARIES
    at = [i for i, k in enumerate(fitted.free) if k.owner == owner and k.name in varies]
    numbers, covariance = fitted.values[at], fitted.covariance[np.ix_(at, at)]
    if not at or not np.isfinite(covariance).all():
        return False
    # weights of a course share the doubt of what it begins with: together they tell
    return float(numbers @ np.linalg.pinv(covariance, hermitian=True) @ numbers) < float(chi2.ppf(0.95, len(at)))


def _may_be_zero(fitted: JointFit, owner: int) -> bool:
    """Return whether the 95 % interval of an effect's size holds zero; that of a wave is asked for otherwise."""
    effect = fitted.model.effects[owner]
    if hasattr(effect, "wavelength"):
        return False
    sizes = [(abs(getattr(effect, name)), fitted.deviation(owner, name)) for name in SIZES if hasattr(effect, name)]
    return any(np.isfinite(deviation) and size < 1.96 * deviation for size, deviation in sizes)


def _typical(balances: Sequence[ForceBalance]) -> float:
    return float(np.std(np.concatenate([s.driven[s.sliding] for s in balances])))
