"""The search: which effects are named, which cannot be distinguished, and when the answer is "none" or "unknown"."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import cast

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.chance import before_effects, without_accidents
from stochfric_mb.discovery.stick_slip.decision.choice import SHAPES, Chosen, choose
from stochfric_mb.discovery.stick_slip.decision.decision import Decision, Finding
from stochfric_mb.discovery.stick_slip.decision.kinematics import kinematics
from stochfric_mb.discovery.stick_slip.decision.random_effects import kicked, kicks, random_effects
from stochfric_mb.discovery.stick_slip.decision.sensor_zero import seen_in_stick
from stochfric_mb.discovery.stick_slip.decision.working_model import WorkingModel, at_estimates
from stochfric_mb.discovery.stick_slip.screening.folding import comes_back
from stochfric_mb.discovery.stick_slip.screening.naming import with_candidate
from stochfric_mb.discovery.stick_slip.screening.null_draws import largest_by_chance
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate, screen
from stochfric_mb.discovery.stick_slip.screening.switching import switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import Randomness, randomness
from stochfric_mb.discovery.stick_slip.screening.waves import shared_by_runs
from stochfric_mb.discovery.stick_slip.study import EVERYTHING, Channels, Progress, Study
from stochfric_mb.effects import kind_with_signature, kinds_with
from stochfric_mb.effects.shapes.splines import PIECES
from stochfric_mb.effects.traits import BETWEEN_POINTS, CLIPPED, DRIFTS, SHAPES_SLIPS, WANDER, WANDERS_ALIKE

SCORE_LEFT = "left_over_score"
"""Name under which the details hold the score of a pattern without a name in what the effects named leave."""
LARGEST = "largest_by_chance"
"""Name under which the details hold the score that a declared scatter reaches by chance."""
MOST_EFFECTS = 3
"""Effects that are looked for."""
MOST_ROUNDS = 5
"""Rounds of the search: harmonics of a named ripple take rounds of their own."""


def decide(study: Study, *, channels: Channels = EVERYTHING, progress: Progress = lambda _: None) -> Decision:
    """Return what the fit runs say."""
    details: dict[str, object] = {}
    shown = kinematics(study, details) if channels.kinematic else []
    belt = belt_speed(study)
    if channels.kinematic and not shown and belt is not None and belt.too_much:
        shown = belt.where
    if isinstance(shown, Where):
        return Decision("unknown", (), shown, at_estimates(study), (), details)
    working = WorkingModel(study)
    for finding in shown:
        working.take_finding(finding, details)
    if kind_with_signature(CLIPPED) in working.kinds:
        # a clipped record says too little of the forces
        return Decision("effect", tuple(working.named), None, working.as_recorded, (), details)
    progress("screening")
    return _Search(working, details, progress, channels.confirmation).run()


def of_wander(study: Study, refuted: Decision) -> Decision | None:
    """Return the decision that friction wanders, where effects in the course of time explain too little; None if it does not.

    Twelve numbers of a ripple with harmonics may follow any wander of a short record; they do not forecast it.

    Args:
        study: what was measured.
        refuted: a decision whose effects were not validated by forecasts of the fit runs.
    """
    if not refuted.named or any(n.kind not in kinds_with(WANDERS_ALIKE) for n in refuted.named):
        return None
    decision = _Search(WorkingModel(study), dict(refuted.details), lambda _: None, confirmation=False).ended()
    kinds = [n.kind for n in decision.named]
    return dataclasses.replace(decision, ranking=refuted.ranking) if kinds == [kind_with_signature(WANDER)] else None


class _Search:
    """The search for effects in the forces of the slips, one after the other."""

    def __init__(self, working: WorkingModel, details: dict[str, object], progress: Progress, confirmation: bool) -> None:
        self.working, self.details, self.progress, self.confirmation = working, details, progress, confirmation
        self.in_forces = not working.named
        self.ranking: tuple[tuple[str, float], ...] = ()

    def run(self) -> Decision:
        """Return the decision."""
        for round_ in range(MOST_ROUNDS):
            if len(self.working.named) >= MOST_EFFECTS:
                break
            result = self._round(round_)
            if isinstance(result, Where):
                return self._unknown(result)
            if not result:
                break
        return self.ended()

    def _round(self, round_: int) -> Where | bool:
        """Look for one effect; return whether to look for another one, or where what no known effect explains lives."""
        candidates = self._screened(round_)
        if round_ == 0 and (seen := seen_in_stick(candidates, self.details)) is not None:
            study = self.working.study
            self.working.take(Chosen(seen, (), with_candidate(self.working.model, seen, study.pool), None, False), self.details)
            return True
        if not candidates or candidates[0].score < self._needed(round_) or self._by_chance(candidates[0].score):
            return False
        if round_ == 0 and not self.working.named:
            of_chance = before_effects(self.working.study, candidates, self.details)
            if of_chance is not False:
                return of_chance if isinstance(of_chance, Where) else False
        return self._chosen(candidates)

    def _chosen(self, candidates: Sequence[Candidate]) -> Where | bool:
        """Take the effect that is meant into the model, if one is; return as `_round` does."""
        self.progress("confirmation")
        working = self.working
        if self.confirmation:
            working.look_at(candidates)
        outcome = choose(
            working.study, working.model, working.baseline, candidates, working.cases, working.confirmed, self.details
        )
        if isinstance(outcome, Where) and working.named:
            # the selected effects stand; the rest is noted, not named
            self.details["left_over"] = dataclasses.asdict(outcome)
            self.details[SCORE_LEFT] = candidates[0].score
            return False
        if outcome is None or isinstance(outcome, Where):
            return outcome or False
        if not self._stands_alone(outcome, candidates):
            return False
        self.progress("what is left")
        return working.take(outcome, self.details) and not working.stalled

    def _screened(self, round_: int) -> list[Candidate]:
        """Return what may be missing beside the effects that are named, best first."""
        candidates = screen(self.working.baseline, held=self.working.kinds)
        if any(c.any_course for c in self.working.taken):
            candidates = [c for c in candidates if not (c.has(DRIFTS) or c.any_course or self._slow(c))]
        # what the simulated effects leave of all slips alike may be no more than another form of theirs would
        if self.working.shape_left < criteria.FORM_MISSES:
            candidates = self._beside_form(candidates)
        if round_ == 0:
            self.ranking = tuple(_scores(candidates).items())
        self.details[f"round_{round_ + 1}"] = _scores(candidates[:8])
        return candidates

    def _slow(self, candidate: Candidate) -> bool:
        """Return whether a candidate is a wave that a course of any shape follows: what such a course leaves looks like it."""
        pool = self.working.study.pool
        return candidate.is_wave and candidate.frequency(float(pool.belt_velocity.min())) * pool.duration < PIECES / 2.0

    def _needed(self, round_: int) -> float:
        """Return the score that is worth a look: of further effects one that is no part of what a form leaves of the first."""
        if round_ == 0:
            return max(criteria.NAMED, criteria.SECOND_SHARE * self.working.study.explained)
        return max(criteria.FOLLOWED_UP, criteria.SECOND_SHARE * self.ranking[0][1])

    def _by_chance(self, score: float) -> bool:
        """Return whether a score is no larger than a declared scatter makes by chance."""
        if self.working.study.model.process is None:
            return False
        if LARGEST not in self.details:
            self.progress("records of the declared scatter")
            self.details[LARGEST] = largest_by_chance(self.working.study)
        return score < cast("float", self.details[LARGEST])

    def _beside_form(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return the candidates that have evidence beside what all slips of a run share: the rest would correct a form."""
        alike = (SHAPES_SLIPS, BETWEEN_POINTS)
        candidates = [c for c in candidates if c.name not in SHAPES and not (c.any_shape or any(map(c.has, alike)))]
        baseline = self.working.baseline
        beside = dataclasses.replace(baseline, terms=baseline.terms.plus(shared_by_runs(baseline.pool)))
        gains = beside.gains([c.hypothesis.columns for c in candidates])
        return [
            c
            for c, gain in zip(candidates, gains, strict=True)
            if 2.0 * gain - len(c.hypothesis.columns) * baseline.price >= criteria.FOLLOWED_UP
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
        alone = self.working.baseline
        beside = dataclasses.replace(alone, terms=alone.terms.plus([x for c in shapes[:2] for x in c.hypothesis.columns]))
        lost = [float(baseline.gains([chosen.candidate.hypothesis.columns])[0]) for baseline in (alone, beside)]
        return chosen.candidate.score - 2.0 * (lost[0] - lost[1]) >= criteria.NAMED

    def ended(self) -> Decision:
        """Return the decision once what is random has been looked for, last of all."""
        working = self.working
        self.details["shape_left"] = working.shape_left
        working.baseline = without_accidents(working.baseline)
        scatter = randomness(working.baseline)
        self.details["randomness"] = dataclasses.asdict(scatter)
        kick = kicks(working.study) if not working.named else None
        if kick is None and "single_moments" in self.details:
            where = Where(
                "stick, single moments",
                "in stick the box departs from the belt's motion, and is back after the next slip",
            )
            if not working.named:
                return self._unknown(where)
            self.details["left_over"] = dataclasses.asdict(where)
        result = self._random(scatter, kick)
        if isinstance(result, Where):
            return self._unknown(result)
        if result is not None:
            working.take_random(result)
        verdict = "effect" if working.named else "none"
        model, named = working.as_recorded, tuple(working.named)
        return Decision(verdict, named, None, model, self.ranking, self.details, working.form, working.seen)

    def _random(self, scatter: Randomness, kick: Finding | None) -> Finding | Where | None:
        """Return the random effect that the slips show, or where they scatter in a way that none explains."""
        study, baseline, kinds = self.working.study, self.working.baseline, self.working.kinds
        levels = switching(baseline.pool, baseline.residuals())
        result = kick or random_effects(study, baseline, scatter, levels, kinds)
        if not kinds and (result is not None or levels.where is not None):
            bump = comes_back(study, kicked(study), self.details)
            if bump is not None:
                return bump
        if not isinstance(result, Where):
            return result
        left = min(baseline.variance / study.baseline.variance, self.working.shape_left)
        if not kinds or (self.in_forces and left > criteria.LEFT_OVER):
            return result
        self.details["left_over"] = dataclasses.asdict(result)
        before = cast("float", self.details.get(SCORE_LEFT, 0.0))
        self.details[SCORE_LEFT] = max(before, scatter.static, scatter.kinetic, scatter.within)
        return None

    def _unknown(self, where: Where) -> Decision:
        return Decision("unknown", (), where, at_estimates(self.working.study), self.ranking, self.details)


def _scores(candidates: Sequence[Candidate]) -> dict[str, float]:
    """Return name -> score, best first; of several variants of an effect the best."""
    numbers: dict[str, float] = {}
    for candidate in candidates:
        numbers.setdefault(candidate.name, candidate.score)
    return numbers
