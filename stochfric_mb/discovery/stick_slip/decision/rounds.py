"""The decision: which effects are named, which cannot be distinguished, and when the answer is "none" or "unknown"."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import cast

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.false_alarms import Evidence, likely
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.choice import IN_TIME, REFIT_WINDOWS, SHAPES, Chosen, choose
from stochfric_mb.discovery.stick_slip.decision.confirmation import Case, Confirmed, SeenInSlips, cases_of, confirm
from stochfric_mb.discovery.stick_slip.decision.innovations import left_over
from stochfric_mb.discovery.stick_slip.decision.kinematics import delay_deviation, kinematics, with_kinematic
from stochfric_mb.discovery.stick_slip.decision.random_effects import RandomEffects, kicked, kicks, random_effects, stray
from stochfric_mb.discovery.stick_slip.decision.sensor_zero import seen_step, steady
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array, corrections_of
from stochfric_mb.discovery.stick_slip.screening.folding import comes_back
from stochfric_mb.discovery.stick_slip.screening.naming import as_harmonic, with_candidate
from stochfric_mb.discovery.stick_slip.screening.null_draws import largest_by_chance
from stochfric_mb.discovery.stick_slip.screening.regression import Regression, Solution, Terms, stated_terms
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate, screen
from stochfric_mb.discovery.stick_slip.screening.smooth_term import axes_of, smooth_term
from stochfric_mb.discovery.stick_slip.screening.switching import JUMPS, SWITCHES, levels_score, switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import Randomness, randomness
from stochfric_mb.discovery.stick_slip.screening.waves import shared_by_runs
from stochfric_mb.discovery.stick_slip.simulation.delay_compensation import delay_compensated, driven, with_delay, without_delay
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import cost_of, refit
from stochfric_mb.discovery.stick_slip.study import EVERYTHING, Channels, Progress, Study
from stochfric_mb.effects import effect_class, kind_with_signature, kinds_with, make_effect
from stochfric_mb.effects.course import PIECES
from stochfric_mb.effects.traits import (
    BELT_RIPPLE,
    BETWEEN_POINTS,
    CLIPPED,
    COURSE_OF_RUN,
    DRIFTS,
    JUMP,
    LATE,
    MOVES_ZERO,
    SHAPES_SLIPS,
    WANDER,
    WANDERS_ALIKE,
    WAVES,
    YIELDING,
)

SHAPE_LEFT = "shape_left"
"""Name under which the details hold the misfit of simulated slips with the effects named over that without."""
SCORE_LEFT = "left_over_score"
"""Name under which the details hold the score of a pattern without a name in what the effects named leave."""
LARGEST = "largest_by_chance"
"""Name under which the details hold the score that a declared scatter reaches by chance."""
MOST_EFFECTS = 3
"""Effects that are looked for."""
MOST_ROUNDS = 5
"""Rounds of the search: harmonics of a named ripple take rounds of their own."""


@dataclasses.dataclass(frozen=True)
class Named:
    """One effect that was decided on."""

    kind: str
    """Its name."""
    class_: tuple[str, ...]
    """Effects that the data cannot distinguish from it, without itself."""
    evidence: Evidence
    """What speaks for it."""
    where: Where
    """Where it shows."""
    before: Model | None = None
    """The model without it, as it stood when it was selected."""


@dataclasses.dataclass(frozen=True)
class Decision:
    """What the fit runs say."""

    verdict: str
    """"effect", "none" or "unknown"."""
    named: tuple[Named, ...]
    """The effects, in the order of selection."""
    where: Where | None
    """Where an unknown disagreement lives."""
    model: Model
    """The model with the effects, at starting values for the refit."""
    ranking: tuple[tuple[str, float], ...]
    """Every candidate of the first round with its score."""
    random: Randomness | None
    """What the scatter says."""
    details: dict[str, object]
    """Numbers behind it."""
    form: Named | None = None
    """The unnamed term of the model that carries what the form of the first effect leaves along the effect's own axis."""
    seen: SeenInSlips | None = None
    """The slips that the effects were simulated with, where they were."""


def decide(study: Study, *, channels: Channels = EVERYTHING, progress: Progress = lambda _: None) -> Decision:
    """Return what the fit runs say."""
    details: dict[str, object] = {}
    model = _levels(study.model, study)
    blamed = kinematics(study, details) if channels.kinematic else []
    belt = belt_speed(study)
    if not blamed and channels.kinematic and belt is not None and belt.too_much:
        return Decision("unknown", (), belt.where, model, (), None, details)
    if isinstance(blamed, Where):
        return Decision("unknown", (), blamed, model, (), None, details)
    named: list[Named] = []
    late: float | None = None
    late_kind = kind_with_signature(LATE)
    for blame in blamed:
        kind, values = blame.kind, blame.values
        named.append(Named(kind, (), blame.evidence, _shown_by(kind), model if late is None else with_delay(model, late)))
        if kind == late_kind and driven(study):
            # forces are looked at on time
            late = values["delay"]
            study = delay_compensated(study, late)
            model = _levels(study.model, study)
        else:
            model = with_kinematic(study, model, kind, values)
        if kind == late_kind:
            # a velocity tells it far better than forecasts, and no forecast tells it where no known force acts
            model = dataclasses.replace(model, measured={"delay": delay_deviation(details)})
    if any(n.kind == kind_with_signature(CLIPPED) for n in named):
        # a clipped record says too little of the forces
        return Decision("effect", tuple(named), None, model if late is None else with_delay(model, late), (), None, details)
    progress("screening")
    return _Search(study, model, named, details, progress, channels.confirmation, late).run()


def of_wander(study: Study, refuted: Decision) -> Decision | None:
    """Return the decision that friction wanders, where effects in the course of time explain too little; None if it does not.

    Twelve numbers of a ripple with harmonics may follow any wander of a short record; they do not forecast it.

    Args:
        study: what was measured.
        refuted: a decision whose effects were not validated by forecasts of the fit runs.
    """
    if not refuted.named or any(n.kind not in kinds_with(WANDERS_ALIKE) for n in refuted.named):
        return None
    result = _Search(study, _levels(study.model, study), [], dict(refuted.details), lambda _: None, confirmation=False)
    decision = dataclasses.replace(result.by_chance(), ranking=refuted.ranking)
    return decision if [n.kind for n in decision.named] == [kind_with_signature(WANDER)] else None


def term_of(model: Model, score: float) -> Named:
    """Return a model's last effect, a term without a name, for the result."""
    term = model.effects[-1]
    return Named(term.kind, (), Evidence(score, None), Where(*term.appears()))


def _shown_by(kind: str) -> Where:
    """Return where an effect shows."""
    cls = effect_class(kind)
    return Where(cls.shows_on or kind, cls.shows or f"{kind} explains the disagreement")


def _levels(model: Model, study: Study) -> Model:
    """Return the model at the coefficients of the regression, with the mechanism that it estimates."""
    mu_s, mu_k = map(float, study.solution.coefficients[:2])
    model = dataclasses.replace(model, corrections=corrections_of(study.solution.coefficients[2 : 2 + len(CORRECTED)]))
    return model.with_law(max(mu_s, 1.0e-3), float(np.clip(mu_k, 1.0e-5, 0.999 * mu_s)))


def _scores(candidates: Sequence[Candidate]) -> dict[str, float]:
    """Return name -> score, best first; of several variants of an effect the best."""
    numbers: dict[str, float] = {}
    for candidate in candidates:
        numbers.setdefault(candidate.name, candidate.score)
    return numbers


class _Search:
    """The search for effects in the forces of the slips, one after the other."""

    def __init__(
        self,
        study: Study,
        model: Model,
        named: list[Named],
        details: dict[str, object],
        progress: Progress,
        confirmation: bool,
        late: float | None = None,
    ) -> None:
        self.study, self.model, self.named, self.details, self.progress = study, model, named, details, progress
        self.confirmation, self.late = confirmation, late
        self.pool, self.regression = study.pool, study.regression
        self.terms: Terms = study.terms
        self.solution: Solution = study.solution
        self.ranking: tuple[tuple[str, float], ...] = ()
        self.stalled = self.any_shape = self.course = self.simulated = False
        self.in_forces = not named
        self.kept: list[Array] = []
        self.cases: list[Case] = []
        self.confirmed: Confirmed | None = None
        self.unaided: Confirmed | None = None
        self.first = 0.0
        self.form: Named | None = None
        if any(n.kind in (kind_with_signature(BELT_RIPPLE), kind_with_signature(YIELDING)) for n in named):
            self._take_out()

    def run(self) -> Decision:
        """Return the decision."""
        for round_ in range(MOST_ROUNDS):
            if len(self.named) >= MOST_EFFECTS:
                break
            result = self._round(round_)
            if isinstance(result, Where):
                return self._unknown(result)
            if not result:
                break
        return self.by_chance()

    def _round(self, round_: int) -> Where | bool:
        """Look for one effect; return whether to look for another one, or where what no known effect explains lives."""
        candidates = self._screened(round_)
        if round_ == 0 and (step := seen_step(candidates, self.details)) is not None:
            self._add(Chosen(step, (), with_candidate(self.model, step, self.pool, self._n_terms), None, False))
            return True
        if not candidates or candidates[0].score < self._needed(round_) or self._by_chance(candidates[0].score):
            return False
        if round_ == 0 and not self.named and (of_chance := self._of_chance(candidates)) is not False:
            return of_chance if of_chance is not True else False
        return self._chosen(candidates)

    def _chosen(self, candidates: Sequence[Candidate]) -> Where | bool:
        """Take the effect that is meant into the model, if one is; return as `_round` does."""
        self.progress("confirmation")
        self._look_at(candidates)
        outcome = choose(self.study, self.model, self.terms, candidates, self.cases, self.confirmed, self.details)
        if isinstance(outcome, Where) and self.named:
            # the selected effects stand; the rest is noted, not named
            self.details["left_over"] = dataclasses.asdict(outcome)
            self.details[SCORE_LEFT] = candidates[0].score
            return False
        if isinstance(outcome, Where):
            return outcome
        if outcome is None or not self._stands_alone(outcome, candidates):
            return False
        self.confirmed, self.simulated = outcome.confirmed, self.simulated or outcome.simulated
        return self._add(outcome) and not self.stalled

    def _screened(self, round_: int) -> list[Candidate]:
        """Return what may be missing beside the effects that are named, best first."""
        kinds = [n.kind for n in self.named if n.kind not in kinds_with(WAVES)]
        candidates = screen(self.pool, self.regression, self.terms, self.solution, without=kinds)
        if self.course:
            candidates = [c for c in candidates if not (c.has(DRIFTS) or c.any_course or self._slow(c))]
        if self._form_alone():
            candidates = self._beside_form(candidates)
        if round_ == 0:
            self.ranking = tuple(_scores(candidates).items())
            self.first = candidates[0].score
        self.details[f"round_{round_ + 1}"] = _scores(candidates[:8])
        return candidates

    def _slow(self, candidate: Candidate) -> bool:
        """Return whether a candidate is a wave that a course of any shape follows: what such a course leaves looks like it."""
        if not candidate.is_wave:
            return False
        main = float(candidate.hypothesis.setting[0])
        frequency = float(self.pool.belt_velocity.min()) / main if candidate.along_belt else main
        return frequency * self.pool.duration < PIECES / 2.0

    def _needed(self, round_: int) -> float:
        """Return the score that is worth a look."""
        return criteria.NAMED if round_ == 0 else max(criteria.FOLLOWED_UP, criteria.SECOND_SHARE * self.first)

    def _by_chance(self, score: float) -> bool:
        """Return whether a score is no larger than a declared scatter makes by chance."""
        if self.study.model.process is None:
            return False
        if LARGEST not in self.details:
            self.progress("records of the declared scatter")
            self.details[LARGEST] = largest_by_chance(self.study)
        return score < cast("float", self.details[LARGEST])

    @property
    def _n_terms(self) -> int:
        return self.terms.columns.shape[2]

    def _look_at(self, candidates: Sequence[Candidate]) -> None:
        """Take the slips that simulated ones are compared with, if that has not been done."""
        if self.confirmation and not self.cases:
            self.cases = cases_of(steady(self.regression, self.terms, candidates, self.kept, self.solution), self.model)
            self.confirmed = confirm(self.cases, self.model, self.study.uncertainty) if self.cases else None
            self.unaided = self.unaided or self.confirmed

    def _of_chance(self, candidates: Sequence[Candidate]) -> Where | bool:
        """Return whether no effect is to be named before friction that wanders or is kicked, or where it switches."""
        if self._wanders(candidates) or self._kicked_up(candidates[0]):
            return True
        sudden = self._sudden(candidates)
        # slips that stand out beside an effect in all the others are accidents, or edges that noise hides
        return (
            False
            if sudden is None or kicks(self.study) is not None
            else comes_back(self.study, kicked(self.study), self.details) or sudden
        )

    def _kicked_up(self, winner: Candidate) -> bool:
        """Return whether a winner stands on slips alone that kicks set apart: without them hardly anything speaks for it."""
        if kicks(self.study) is None:
            return False
        others = Regression(dataclasses.replace(self.pool, kept=self.pool.kept & ~kicked(self.study)))
        scatter = others.fit(self.terms, self.solution.scatter).scatter
        return 2.0 * float(others.gains(self.terms, scatter, [winner.hypothesis.columns])[0]) < criteria.NAMED

    def _wanders(self, candidates: Sequence[Candidate]) -> bool:
        """Return whether a winner on the axis of time is better described as a random drift."""
        winner = candidates[0]
        if winner.name not in (*IN_TIME, kind_with_signature(JUMP)) and not (winner.is_wave or winner.any_course):
            return False
        drifts = max((c.score for c in candidates if c.has(DRIFTS)), default=-np.inf)
        scatter = randomness(self.regression, self.terms, self.solution)
        # what names physics has to be beaten; hats on the axis of time name none
        share = 0.5 if winner.name in IN_TIME else 1.0 if winner.any_course else 1.2
        margin = criteria.NAMED if winner.any_course else 0.0
        rival = max(share * winner.score, drifts) - margin
        return scatter.correlation > criteria.SCATTER_MEMORY and scatter.wander > rival

    def _sudden(self, candidates: Sequence[Candidate]) -> Where | None:
        """Return where friction switches, if it does and the best effect does not explain that as well; None if not."""
        levels = switching(self.regression, self.regression.residuals(self.terms, self.solution))
        self.details["switching"] = dataclasses.asdict(levels)
        best = next((c for c in candidates if c.is_effect), None)
        if levels.two_levels:
            score = levels_score(self.regression, self.terms, self.solution)
            self.details["two_levels"] = score
            return None if best is not None and best.score > score else SWITCHES
        # what all slips share is explained first; what jumps beside it is judged last of all
        if levels.where is None or candidates[0].name in SHAPES or candidates[0].has(SHAPES_SLIPS):
            return None
        if best is not None:
            with_best = self.terms.plus(best.hypothesis.columns)
            levels = switching(self.regression, self.regression.residuals(with_best, best.solution))
        return JUMPS if levels.at_rest_between_jumps else None

    def _shape_left(self) -> float:
        """Return the misfit of simulated slips with the effects named over that without [-]; 1 where none were simulated."""
        now, before = self.confirmed, self.unaided
        return 1.0 if now is None or before is None else now.chi2 / before.chi2

    def _form_alone(self) -> bool:
        """Return whether what the simulated effects leave of all slips alike is no more than another form of theirs would."""
        return self._shape_left() < criteria.FORM_MISSES

    def _beside_form(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return the candidates that have evidence beside what all slips of a run share: the rest would correct a form."""
        alike = (SHAPES_SLIPS, BETWEEN_POINTS)
        candidates = [c for c in candidates if c.name not in SHAPES and not (c.any_shape or any(map(c.has, alike)))]
        beside = self.terms.plus(shared_by_runs(self.pool))
        gains = self.regression.gains(beside, self.solution.scatter, [c.hypothesis.columns for c in candidates])
        cost = float(np.log(self.regression.n))
        return [
            c
            for c, gain in zip(candidates, gains, strict=True)
            if 2.0 * gain - len(c.hypothesis.columns) * cost >= criteria.FOLLOWED_UP
        ]

    def _stands_alone(self, chosen: Chosen, candidates: Sequence[Candidate]) -> bool:
        """Return whether an effect outside the family of shapes has evidence beside the shapes that beat it.

        Where simulating them does not bear such shapes out, they are what the features leave of every slip, and an effect
        that has nothing but a likeness to them is not there.
        """
        alike = (c for c in candidates if c.has(SHAPES_SLIPS) or c.name in SHAPES or c.any_shape)
        shapes = [c for c in alike if c.score > chosen.candidate.score]
        if chosen.simulated or not shapes:
            return True
        beside = self.terms.plus([column for c in shapes[:2] for column in c.hypothesis.columns])
        own = [chosen.candidate.hypothesis.columns]
        lost = [float(self.regression.gains(terms, self.solution.scatter, own)[0]) for terms in (self.terms, beside)]
        return chosen.candidate.score - 2.0 * (lost[0] - lost[1]) >= criteria.NAMED

    def _add(self, chosen: Chosen) -> bool:
        """Take an effect into the model, and out of the features; return whether it is worth a place beside the others."""
        kind, without, known = chosen.candidate.name, self.model, self._timed()
        harmonic = as_harmonic(self.model, chosen.candidate, self.study.pool, self._n_terms)
        self.model = chosen.model if harmonic is None else harmonic
        self._complete(kind)
        screened = self.model
        fitted = (kind in kinds_with(COURSE_OF_RUN) or chosen.simulated) and kind != kind_with_signature(LATE)
        # single forecasts of friction that scatters tell less than the slips' medians, to which a simulated model is fitted
        fitted &= not (chosen.simulated and without.random)
        if fitted and not self._refitted(without):
            return False
        if harmonic is None and all(n.kind != kind for n in self.named):
            self.named.append(Named(kind, chosen.class_, likely("slips", chosen.candidate.score), _shown_by(kind), known))
        self.any_shape |= chosen.candidate.any_shape
        self.course |= chosen.candidate.any_course
        self.progress("what is left")
        before = _scatter(self.solution)
        if kind == kind_with_signature(LATE):
            self._put_on_time()
            return True
        if kind in kinds_with(MOVES_ZERO):
            self.kept += chosen.candidate.hypothesis.columns
        self._go_on(chosen, screened if fitted else None, before)
        return True

    def _complete(self, kind: str) -> None:
        """Take what the form of the one effect leaves along the effect's own axis into the model: a term without a name.

        A name says on what friction depends, not how. What is left on that axis is its shape, as long as the effect's own form
        takes the larger part of what both take together.
        """
        own = effect_class(kind).form_axis
        if not own or self.named or self.model.random or any(e.group == "sensor" for e in self.model.effects):
            return
        pool = left_over(self.study.pool, self.model)
        if pool.kept.sum() < criteria.LEAST_KEPT * self.pool.kept.sum():
            return
        regression, terms = Regression(pool), stated_terms(pool, dict(self.study.uncertainty))
        solution = regression.fit(terms, self.solution.scatter)
        axis = next(a for a in axes_of(pool) if a.name == own)
        term = smooth_term(regression, terms, solution, self.model, axis)
        # of the same slips: costs of fewer are those of other data
        measured = Regression(dataclasses.replace(self.study.pool, kept=pool.kept))
        shown = measured.solve(self.study.terms, term.solution.scatter).cost - term.solution.cost
        left = regression.solve(terms, term.solution.scatter).cost - term.solution.cost
        self.details["form"] = {"axis": own, "score": term.score}
        if shown <= 0.0:  # both together explain nothing: there is no share of it
            return
        share = float(np.clip(1.0 - left / shown, 0.0, 1.0))
        self.details["form"] = {"axis": own, "score": term.score, "share": share}
        if term.score <= criteria.NAMED or share < criteria.EXPLAINED:
            return
        model = term.model
        if self.confirmed is not None:
            fitted = confirm(self.cases, model, self.study.uncertainty)
            if fitted.criterion >= self.confirmed.criterion:  # simulated slips say no more than the regression's first order
                return
            self.confirmed, model = fitted, fitted.model
        self.model, self.form = model, term_of(model, term.score)

    def _go_on(self, chosen: Chosen, screened: Model | None, before: float) -> None:
        """Go on with what is left; ``screened``: the model before a fit to forecasts, ``before``: the scatter then."""
        self._take_out()
        if chosen.simulated:
            return
        if screened is not None and (self.stalled or _scatter(self.solution) > criteria.LEFT_OVER * before):
            self._take_out_better(screened)
        self.stalled |= chosen.candidate.is_wave and _scatter(self.solution) > criteria.STALLED * before

    def _refitted(self, without: Model) -> bool:
        """Fit the model to forecasts; go back to the one ``without`` its last effect if that forecasts as well."""
        # a simulated fit knows the features alone, whose bias by noise is that of the stated model
        windows, uncertainty, seen = self.study.windows, self.study.uncertainty, self._seen()
        further = None if seen is None else seen.of(self.model)
        fit = refit(self.model, windows, uncertainty, most=REFIT_WINDOWS, evaluations=20, further=further)
        least = (1.0 - criteria.CLOSES_NOTHING) * cost_of(without, self.study.windows, most=REFIT_WINDOWS)
        idle = bool(self.named) and fit.cost > least
        self.model = without if idle else fit.model
        return not idle

    def _seen(self) -> SeenInSlips | None:
        """Return the slips with which the effects were simulated; None where none were."""
        known = self.confirmed if self.simulated else None
        return None if known is None else SeenInSlips(known.kinds, tuple(self.cases))

    def _put_on_time(self) -> None:
        """Go on with the records put on time, by the delay that their forecasts show."""
        fit = refit(self.model, self.study.windows, self.study.uncertainty, most=REFIT_WINDOWS, evaluations=20)
        self.model, self.late = without_delay(fit.model), fit.model.late
        self.study = delay_compensated(self.study, self.late)
        self.cases, self.confirmed, self.simulated = [], None, False
        self._take_out()

    def _take_out(self) -> None:
        """Go on with what the model leaves of the features."""
        shaped = self.any_shape or any(n.kind in kinds_with(SHAPES_SLIPS) for n in self.named)
        left = left_over(self.study.pool, self.model, anew=shaped)
        if left.kept.sum() < criteria.LEAST_KEPT * self.pool.kept.sum():
            self.stalled = True
            return
        self.pool = left
        self.regression = Regression(self.pool)
        self.terms = stated_terms(self.pool, dict(self.study.uncertainty)).plus(self.kept)
        self.solution = self.regression.fit(self.terms, self.solution.scatter)

    def _take_out_better(self, other: Model) -> None:
        """Go on with what another model leaves, if it leaves less: forecasts that jump between slips may lead a fit astray."""
        fitted, left, stalled = self.model, _scatter(self.solution), self.stalled
        self.model, self.stalled = other, False
        self._take_out()
        if self.stalled or (not stalled and _scatter(self.solution) > left):
            self.model, self.stalled = fitted, stalled
            self._take_out()

    def by_chance(self) -> Decision:
        """Look for what is random, last of all."""
        self.details[SHAPE_LEFT] = self._shape_left()
        self._without_accidents()
        scatter = randomness(self.regression, self.terms, self.solution)
        self.details["randomness"] = dataclasses.asdict(scatter)
        kinds = [n.kind for n in self.named]
        kick = kicks(self.study) if not kinds else None
        if kick is None and "single_moments" in self.details:
            where = Where(
                "stick, single moments",
                "in stick the box departs from the belt's motion, and is back after the next slip",
            )
            if not self.named:
                return self._unknown(where, scatter)
            self.details["left_over"] = dataclasses.asdict(where)
        result = self._random(scatter, kick)
        if isinstance(result, Where):
            return self._unknown(result, scatter)
        if result is not None:
            self.named.append(Named(result.kind, (), result.evidence, _shown_by(result.kind), self._timed()))
            self.model = self.model.plus(make_effect(result.kind, **result.values))
        verdict = "effect" if self.named else "none"
        model = self._timed()
        return Decision(verdict, tuple(self.named), None, model, self.ranking, scatter, self.details, self.form, self._seen())

    def _random(self, scatter: Randomness, kick: RandomEffects | None) -> RandomEffects | Where | None:
        """Return the random effect that the slips show, or where they scatter in a way that none explains."""
        kinds = [n.kind for n in self.named]
        levels = switching(self.regression, self.regression.residuals(self.terms, self.solution))
        result = kick or random_effects(self.study, scatter, levels, self.solution, kinds)
        if not kinds and (result is not None or levels.where is not None):
            bump = comes_back(self.study, kicked(self.study), self.details)
            if bump is not None:
                return bump
        if not isinstance(result, Where):
            return result
        left = min(_scatter(self.solution) / _scatter(self.study.solution), self._shape_left())
        if not self.named or (self.in_forces and left > criteria.LEFT_OVER):
            return result
        self.details["left_over"] = dataclasses.asdict(result)
        return None

    def _timed(self) -> Model:
        """Return the model so far with the sensor's delay, if the records were put on time."""
        return self.model if self.late is None else with_delay(self.model, self.late)

    def _without_accidents(self) -> None:
        """Leave out the slips that stand far out, where they are too few for kicks: two of a hundred are no scatter."""
        far = stray(self.pool, self.regression.residuals(self.terms, self.solution))
        if 0.0 < far.sum() < criteria.FEWEST_KICKED * self.pool.kept.sum():
            self.pool = dataclasses.replace(self.pool, kept=self.pool.kept & ~far)
            self.regression = Regression(self.pool)
            self.solution = self.regression.fit(self.terms, self.solution.scatter)

    def _unknown(self, where: Where, scatter: Randomness | None = None) -> Decision:
        return Decision("unknown", (), where, _levels(self.study.model, self.study), self.ranking, scatter, self.details)


def _scatter(solution: Solution) -> float:
    """Return the variance of both forces of a slip about a fitted model, over the normal force [-]."""
    return float(np.exp(2.0 * solution.scatter[:2]).sum())
