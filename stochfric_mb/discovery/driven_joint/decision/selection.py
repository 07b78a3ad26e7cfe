"""Selection: one effect at a time, by evidence, by what it is worth on blocks left out, and against smooth competitors."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.stats import f as fisher

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, by_state, confounded
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.decision.cross_validation import blocks, compared, each_run, strokes, witnesses
from stochfric_mb.discovery.driven_joint.decision.released import INERTIAL, Freed, Released, beyond_beliefs, finding
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import COMPETITORS, SIGNED, TIMES, SmoothDependences
from stochfric_mb.discovery.driven_joint.fit.beliefs import at_end, beliefs
from stochfric_mb.discovery.driven_joint.fit.evidence import evidence, settings_of
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit, fit, prior_weight, settled
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.fit.wave_scan import tried
from stochfric_mb.discovery.driven_joint.search.candidate_fits import Beside, CandidateFits, Found, is_none, may_be_zero
from stochfric_mb.discovery.driven_joint.search.candidates import Candidate
from stochfric_mb.discovery.inference.paired import Paired
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.effects.contract import OF_FRICTION


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
    """Every candidate that is worth a fit, best first."""
    competitors: tuple[tuple[str, float], ...]
    """Axis of each smooth competitor, with its score."""
    blocks: Paired
    """What the best candidate is worth on blocks left out."""
    strokes: Paired | None
    """What it is worth on strokes left out, where this was asked."""
    accepted: bool
    """Whether it was taken into the model."""
    faint: tuple[tuple[Candidate, float], ...] = ()
    """Candidates that are not worth a fit, with the score that it might give them at best [-]."""


@dataclasses.dataclass(frozen=True)
class Selected:
    """The outcome at one joint."""

    recalibrated: JointFit
    """The stated model with its numbers fitted."""
    final: JointFit
    """With the selected effects."""
    effects: tuple[Trial, ...]
    """Effects, as they were when accepted."""
    standing_in: Callable[[], tuple[tuple[str, ...], ...]]
    """Works out `equivalents`, which takes as long as the selection."""
    standing_in_numbers: Callable[[], Mapping[str, tuple[str, ...]]]
    """Works out `alike`, which does, too."""
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

    @functools.cached_property
    def equivalents(self) -> tuple[tuple[str, ...], ...]:
        """Effects, and numbers of the mechanism, that could stand in the place of each effect that is named."""
        return self.standing_in()

    @functools.cached_property
    def alike(self) -> Mapping[str, tuple[str, ...]]:
        """The same in the place of numbers that are off, by what these are called together."""
        return self.standing_in_numbers()

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
        self._balances = list(balances)
        self._tell = progress or (lambda _: None)
        self._candidates = CandidateFits(self._balances, self._tell)
        self._settings, self._smooth, self._pairs = settings_of(balances), SmoothDependences(balances), confounded(balances)
        typical = float(np.std(np.concatenate([s.driven[s.sliding] for s in balances])))
        self.recalibrated, noise = settled(start, balances, nuisances, noise=typical)
        self.begin = Beside(self.recalibrated, list(nuisances), noise, frozenset())
        """The fit of the stated model, with nothing left out."""

    def _refitted(self, at: Beside, model: JointModel) -> Beside:
        fitted = fit(model, self._balances, at.nuisances, noise=at.noise, refined=True)
        return dataclasses.replace(at, current=fitted)

    def run(self, without: frozenset[str] = frozenset()) -> Selected:
        """Return what is selected, without some kinds of effects and numbers of the mechanism."""
        at = dataclasses.replace(self.begin, without=without)
        effects: list[Trial] = []
        stages: list[Stage] = []
        released: list[Released] = []
        while len(effects) < criteria.MOST_EFFECTS:
            self._tell(f"effect {len(effects) + 1}")
            stage = self._stage(at)
            freed = self._released(at, stage)
            if freed is not None:
                numbers, at = freed
                released += numbers
                continue
            stages.append(stage)
            if not stage.accepted:
                break
            effects.append(stage.trials[0])
            at = self._refitted(dataclasses.replace(at, noise=prior_weight(stage.trials[0].fit)), stage.trials[0].fit.model)
            at, effects = self._re_examined(dataclasses.replace(at, noise=prior_weight(at.current)), effects)
            at, released = self._taken_back(at, released)
        at, effects = self._without_pushing(*self._without_zero(self._refitted(at, at.current.model), effects))
        unknown = self._unknown(stages[-1], at.noise) if not stages[-1].accepted else ("", 0.0)
        left = (unknown, self._smooth.together(at.current, at.noise) if effects or released else ("", 0.0))
        imitated = left[1][0] if any(self._imitated(at, i, t, left[1][0]) for i, t in enumerate(effects)) else ""
        return Selected(
            self.recalibrated,
            at.current,
            tuple(effects),
            functools.partial(self._equivalents, at, tuple(t.candidate.parameters for t in effects)),
            functools.partial(self._alike, at, tuple(released)),
            tuple(stages),
            unknown[0],
            tuple((axis, gain) for axis, gain in left if axis),
            tuple(released),
            tuple(at.nuisances),
            imitated,
        )

    def _imitated(self, at: Beside, number: int, trial: Trial, axis: str) -> bool:
        """Return whether an effect of other conditions explains nothing beside two on which what is left depends together.

        The motion comes back, and the clock goes on with it: a course in time of many pieces can draw a part of what the state
        does, and leave the rest.
        """
        if not axis or trial.candidate.where in axis.removesuffix(SIGNED).split(TIMES):
            return False
        final, own = at.current, len(self.recalibrated.model.effects) + number
        others = tuple(e for i, e in enumerate(final.model.effects) if i != own)
        without = self._refitted(at, dataclasses.replace(final.model, effects=others)).current
        numbers = _numbers(without, trial.candidate, final)
        keeps = self._smooth.left_to(final, without, at.noise, axis)
        return keeps - numbers * float(np.log(final.n)) < criteria.NAMED

    def _released(self, at: Beside, stage: Stage) -> tuple[list[Released], Beside] | None:
        """Return the number that is off by more than its uncertainty, or two, if that explains more than any effect.

        It is a finding of its own, a payload for instance: within its belief it would hide behind what it cannot explain. As
        effects do, it has to foretell parts of the record that were left out.
        """
        current, freed = at.current, self._freed(at)
        # all are judged by the same count of independent windows: that of the best fit
        finest = min((*(t.fit for t in stage.trials), *(f.fit for f in freed)), key=lambda f: f.rms)
        n = finest.n

        def worth(fitted: JointFit, numbers: int) -> float:
            return evidence(current, fitted, finest, self._settings) - numbers * float(np.log(n))

        # a prior is given up where that explains more than any effect that leaves it alone and could be named, or as much with
        # fewer numbers: an effect whose curve is straight is a constant
        rivals = [(t.fit, _numbers(current, t.candidate, t.fit)) for t in stage.trials if t.score > criteria.NAMED]
        needs = (worth(f, numbers) + (criteria.TIE if numbers <= 1 else -criteria.TIE) for f, numbers in rivals)
        enough = max(needs, default=-np.inf)
        named = [f for f in freed if f.score >= criteria.NAMED and worth(f.fit, f.count) >= enough]
        best = next((f for f in named if self._foretells(at, f)), None)
        if best is None:
            return None
        at = dataclasses.replace(at, nuisances=best.nuisances, noise=prior_weight(best.fit))
        return best.released(current), self._refitted(at, best.fit.model)

    def _taken_back(self, at: Beside, released: list[Released]) -> tuple[Beside, list[Released]]:
        """Believe again numbers that effects found after them explain: what is left of their evidence no longer names them."""
        for number in released:
            current = at.current
            model, nuisances = number.belief.held(current.model, at.nuisances)
            fitted, noise = settled(model, self._balances, nuisances, noise=at.noise)
            score = evidence(fitted, current, current, self._settings) - float(np.log(current.n))
            if score < criteria.NAMED:
                at = dataclasses.replace(at, current=fitted, nuisances=nuisances, noise=noise)
                released = [r for r in released if r is not number]
        return at, released

    def _foretells(self, at: Beside, freed: Freed) -> bool:
        """Return whether a number beyond its belief predicts parts that were left out better, by a material part."""
        noise = min(at.noise, prior_weight(freed.fit))
        models = at.current.model, freed.fit.model
        parts = witnesses(self._balances)
        seen = compared(*models, self._balances, at.nuisances, noise, parts, freed.nuisances)
        return seen.rms_gain > criteria.MATERIAL and seen.share_better >= criteria.BETTER

    def _freed(self, at: Beside) -> list[Freed]:
        beside = len(at.current.model.effects) > len(self.recalibrated.model.effects)
        return beyond_beliefs(at.current, self._balances, at.nuisances, at.noise, beside=beside, without=at.without)

    def _without_zero(self, at: Beside, effects: list[Trial]) -> tuple[Beside, list[Trial]]:
        """Drop effects that are none, or may be, beside those selected after them: nothing is said by them."""
        while True:
            final = at.current
            first = len(final.model.effects) - len(effects)
            each = range(len(effects))
            empty = next((i for i in each if may_be_zero(final, first + i) or is_none(final, first + i)), None)
            if empty is None:
                return at, effects
            others = tuple(e for i, e in enumerate(final.model.effects) if i != first + empty)
            at = self._refitted(at, dataclasses.replace(final.model, effects=others))
            effects = [t for i, t in enumerate(effects) if i != empty]

    def _without_pushing(self, at: Beside, effects: list[Trial]) -> tuple[Beside, list[Trial]]:
        """Drop further effects that need a number as far off as beliefs give way, where those before them leave it within."""
        believed = beliefs(at.current.model, at.nuisances)
        shorter, kept = at, effects
        while at_end(model := shorter.current.model, believed) is not None and len(kept) > 1:
            shorter, kept = self._refitted(shorter, dataclasses.replace(model, effects=model.effects[:-1])), kept[:-1]
        return (at, effects) if at_end(model, believed) is not None else (shorter, kept)

    def _stage(self, at: Beside) -> Stage:
        current, found = at.current, self._found(at)
        trials = self._scored(current, found)
        rivals = self._smooth.scores(current, trials[0].fit, at.noise)
        models = current.model, trials[0].fit.model
        phased = len(models[1].own) > len(models[0].own) and len(self._balances) > 1
        parts = each_run(self._balances) if phased else witnesses(self._balances)
        noise = min(at.noise, prior_weight(trials[0].fit))
        inside = compared(*models, self._balances, at.nuisances, noise, parts)
        better = inside.share_better > criteria.BETTER if phased else inside.share_better >= criteria.BETTER
        enough = (
            trials[0].score > criteria.NAMED
            and inside.rms_gain > (criteria.MATERIAL_PHASED if phased else criteria.MATERIAL)
            and better
        )
        repeats = None
        if not enough and len(parts := strokes(self._balances)) >= criteria.FEWEST_STROKES:
            repeats = compared(*models, self._balances, at.nuisances, at.noise, parts)
            questions = len({t.candidate.where for t in trials})  # effects along one axis ask nearly the same
            repeats = dataclasses.replace(repeats, p_value=min(1.0, repeats.p_value * questions))
            enough = (
                repeats.rms_gain > criteria.MATERIAL
                and repeats.p_value < criteria.STROKES_BY_CHANCE
                and self._predicted_better(at, trials[0].fit.model)
            )
        return Stage(current, tuple(trials), tuple(rivals), inside, repeats, enough, found.faint)

    def _found(self, at: Beside) -> Found:
        """Return the candidates that the model does not have yet, fitted.

        A load that moves by itself is looked for where all other candidates leave more than noise: it can take noise of the
        acceleration away, whether there is such a load or not. Its force takes long to work out: it is looked for first, and
        again where nothing else has a name.
        """
        current, found = at.current, self._candidates.others(at)
        first = len(current.model.effects) == len(self.recalibrated.model.effects)
        asked = first or self._scored(current, found)[0].score <= criteria.NAMED
        if asked and self._candidates.leaves_more_than_noise(found, at):
            loads = self._candidates.loads(at)
            found = Found(found.fits + loads.fits, found.faint)
        return found

    def _predicted_better(self, at: Beside, richer: JointModel) -> bool:
        """Return whether each half of the record, left out, is predicted better by the richer model by a material part."""
        halves = blocks(self._balances, 2)
        seen = [compared(at.current.model, richer, self._balances, at.nuisances, at.noise, [half]) for half in halves]
        return min(s.rms_gain for s in seen) > criteria.MATERIAL

    def _scored(self, current: JointFit, found: Found) -> list[Trial]:
        # all are judged by the same count of independent windows: that of the best fit
        best = min((f for _, f in found.fits), key=lambda f: f.rms)
        n = best.n
        trials = [self._trial(current, c, f, best, n, found.asked) for c, f in found.fits]
        return simplest_first(sorted(trials, key=lambda t: -t.score), self._pairs)

    def _trial(self, current: JointFit, candidate: Candidate, fitted: JointFit, best: JointFit, n: float, kinds: int) -> Trial:
        waves = tried(candidate.scan, self._balances) if candidate.scan is not None else 0.0
        p, grid = _numbers(current, candidate, fitted), (len(candidate.starts) + waves) * kinds
        ratio = max((current.rms / fitted.rms) ** 2, 1.0)
        score = evidence(current, fitted, best, self._settings) - p * np.log(n) - 2.0 * np.log(grid)
        spare = max(n - len(fitted.free), 1.0)
        chance = float(fisher.sf((ratio - 1.0) * spare / p, p, spare))
        return Trial(candidate, fitted, float(score), min(1.0, chance * grid))

    def _re_examined(self, at: Beside, effects: list[Trial]) -> tuple[Beside, list[Trial]]:
        """Drop effects that later ones have made superfluous."""
        for trial in effects[:-1]:
            if trial.score < criteria.NAMED:  # taken for what it is worth on strokes left out
                continue
            kind, current = trial.candidate.kind, at.current
            without = dataclasses.replace(current.model, effects=tuple(e for e in current.model.effects if e.kind != kind))
            fitted, _ = settled(without, self._balances, at.nuisances, noise=at.noise)
            score = evidence(fitted, current, current, self._settings) - trial.candidate.parameters * np.log(current.n)
            if score < criteria.NAMED:
                at, effects = dataclasses.replace(at, current=fitted), [t for t in effects if t.candidate.kind != kind]
        return at, effects

    def _equivalents(self, at: Beside, sizes: Sequence[int]) -> tuple[tuple[str, ...], ...]:
        """Return what could stand in the place of each effect of the final model, of so many numbers."""
        model = at.current.model
        found: list[tuple[str, ...]] = []
        for own, size in zip(model.effects[len(model.effects) - len(sizes) :], sizes, strict=True):
            others = tuple(e for e in model.effects if e is not own)
            without = self._refitted(at, dataclasses.replace(model, effects=others))
            found.append(self._standing_in(at.current, without, size, own.kind))
        return tuple(found)

    def _alike(self, at: Beside, released: Sequence[Released]) -> dict[str, tuple[str, ...]]:
        """Return what could stand in the place of each finding of numbers beyond their beliefs, by its name."""
        found: dict[str, tuple[str, ...]] = {}
        for name in dict.fromkeys(finding(r.name) for r in released):
            numbers = [r.belief for r in released if finding(r.name) == name]
            model, nuisances = at.current.model, at.nuisances
            for belief in numbers:
                model, nuisances = belief.held(model, nuisances)
            fitted, noise = settled(model, self._balances, nuisances, noise=at.noise)
            found[name] = self._standing_in(at.current, Beside(fitted, nuisances, noise, at.without), len(numbers), name)
            # a mass that nobody doubts either is no surer than the drive: the motion shows their ratio alone
            if not numbers[0].stated and not any(n.name in INERTIAL for n in nuisances):
                found[name] = tuple(dict.fromkeys((*found[name], INERTIAL[0])))
        return found

    def _standing_in(self, final: JointFit, without: Beside, size: int, own: str) -> tuple[str, ...]:
        """Return what could stand in the place of a finding of ``size`` numbers.

        Kinds of effects, and names of numbers of the mechanism that would be beyond their beliefs: all within `criteria.TIE`,
        and beside a law of friction those that leave no more of what it explains than an empirical law may miss.

        Args:
            final: the fit with all findings.
            without: the fit without this one.
            size: how many numbers it has.
            own: what it is called.
        """
        fits = [(c.kind, c.parameters, f) for c, f in self._found(without).fits]
        fits += [(f.name, f.count, f.fit) for f in self._freed(without)]
        price = float(np.log(final.n))
        mine = evidence(without.current, final, final, self._settings)
        # one that explains next to nothing stands in for nothing, however close the scores
        least = mine - size * price - criteria.TIE
        found: list[str] = []
        for name, n, other in fits:
            score = evidence(without.current, other, final, self._settings)
            near = score - n * price > least or as_good(own, name, without.current.rms, final.rms, other.rms)
            if finding(name) != own and score > criteria.STANDS_IN * mine and near:
                found.append(name)
        return tuple(dict.fromkeys(found))

    def _unknown(self, last: Stage, noise: float) -> tuple[str, float]:
        """Return the axis of what is missing that no effect explains, empty if nothing is, and what part it takes away."""
        axis, score = last.competitors[0] if last.competitors else ("", -np.inf)
        named = last.trials[0].score
        if score < criteria.NAMED + 2.0 * np.log(len(COMPETITORS)) or score < named + max(
            criteria.WINS_BY, criteria.WINS_BY_SHARE * abs(named)
        ):
            return "", 0.0
        gain = self._smooth.gain(last.before, noise, next(c for c in COMPETITORS if c.axis == axis))
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


def as_good(own: str, other: str, without: float, with_: float, instead: float) -> bool:
    """Return whether a law of friction, in the place of another, leaves no more of what that explains than such a law may miss.

    Args:
        own: what is named.
        other: what may stand in its place.
        without: error without either, rms.
        with_: with what is named.
        instead: with the other.
    """
    laws = all(name in effect_kinds() and effect_class(name).group in OF_FRICTION for name in (own, other))
    return laws and instead**2 - with_**2 < criteria.FORM_MISSES**2 * (without**2 - with_**2)
