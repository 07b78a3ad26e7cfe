"""One round of the decision: which candidate of the screening is meant, and which cannot be distinguished from it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.cases import Case
from stochfric_mb.discovery.stick_slip.decision.confirmation import Confirmed, confirm
from stochfric_mb.discovery.stick_slip.decision.entrainment import Trial, entrained
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED
from stochfric_mb.discovery.stick_slip.screening.competitors import SOFTENING
from stochfric_mb.discovery.stick_slip.screening.naming import beside_waves, with_candidate
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate, with_overtones
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import REFIT_WINDOWS, likelihood_ratios, refit
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import effect_class, kinds_with
from stochfric_mb.effects.traits import BETWEEN_POINTS, DRIFTS, SHAPED_IF_FORCED, SHAPES_SLIPS

MOST_SIMULATED = 8
"""Candidates that are simulated in the first round."""
MOST_SIMULATED_LATER = 4
"""The same in what an effect leaves, where the best marks can be trusted: what is left is weak."""
MOST_CONTENDERS = 3
"""Candidates that are refitted to forecasts where their marks are about as good."""
ROUGH = 3
"""Steps of a rough fit, which tells where to begin."""
REFUTED = "shapes_refuted"
"""Name under which the details hold that simulating effects which shape every slip alike has not borne them out."""

OTHER_RIG = "mechanism"
"""Axis of what a rig of other numbers than those stated would explain."""
SHAPES = ("slip_shape", "position")
"""Competitors on the axes on which those effects act."""
IN_TIME = ("time", "friction_step", "parity")
"""Competitors on the axis of time: a random drift may be what they see."""


@dataclasses.dataclass(frozen=True)
class Chosen:
    """The effect of one round."""

    candidate: Candidate
    """The candidate."""
    class_: tuple[str, ...]
    """Effects that cannot be distinguished from it."""
    model: Model
    """The model with it, at numbers to start from."""
    confirmed: Confirmed | None
    """Its simulation, if it was simulated; what further effects of its family are compared with."""
    simulated: bool
    """Whether its numbers come from simulating."""


def choose(
    study: Study,
    model: Model,
    baseline: Baseline,
    candidates: Sequence[Candidate],
    cases: Sequence[Case],
    before: Confirmed | None,
    details: dict[str, object],
) -> Chosen | Where | None:
    """Return the effect of this round, or where the unknown lives, or None for nothing.

    Args:
        study: what was measured.
        model: the model so far.
        baseline: what it leaves.
        candidates: the screening's outcome, best first.
        cases: slips to be predicted in a confirmation.
        before: the simulated model so far.
        details: gets the numbers of the confirmation.
    """
    family = _family(candidates, cases)
    rest = [c for c in candidates if not family.holds(c)]
    if before is None or family.score < max(criteria.NAMED, _best_score(rest)):
        return _by_score(study, model, baseline, candidates, before)
    # refuted once, shapes stay refuted: the slips that simulated ones are compared with are the same
    if REFUTED not in details:
        simulation = _Simulation(study, model, cases, before, details)
        outcome = simulation.outcome([c for c in candidates if c.is_effect and family.holds(c)])
        if outcome is not None:
            return outcome
        details[REFUTED] = True
    # simulation does not bear the shape out: what remains are effects that change from slip to slip
    least = criteria.BESIDE_SHAPES * family.score
    left = [c for c in rest if c.score > least or not c.is_effect]
    return _by_score(study, model, baseline, left, before)


def _by_score(
    study: Study, model: Model, baseline: Baseline, candidates: Sequence[Candidate], before: Confirmed | None
) -> Chosen | Where | None:
    """Return the effect with most evidence, or where a pattern without a name has more."""
    effects = [c for c in candidates if c.is_effect]
    nameless = _nameless(effects, [c for c in candidates if not c.is_effect])
    if nameless is not None or not effects or effects[0].score < criteria.NAMED:
        return nameless
    best, class_ = _distinguished(study, model, baseline, effects)
    return Chosen(best, class_, beside_waves(model, best, baseline), before, False)


def _distinguished(
    study: Study, model: Model, baseline: Baseline, effects: Sequence[Candidate]
) -> tuple[Candidate, tuple[str, ...]]:
    """Return the effect that is meant, and those alike: refitted to forecasts where marks are close.

    The marks of a strong effect are its first order alone, forecasts are exact. They hold the overtones of a wave as well, if
    there are any: without them they would tell which kind of sine imitates them.
    """
    kinds: dict[str, Candidate] = {}
    for candidate in effects:
        kinds.setdefault(candidate.name, candidate)
    best = effects[0]
    near = [c for c in kinds.values() if c.score > criteria.CONTENDS * best.score][:MOST_CONTENDERS]
    # what is there has more tones before anything else is
    held = [c for c in near if c.is_wave and any(e.kind == c.name and e.own_to_run for e in model.effects)]
    if held or len(near) == 1:
        return (held or near)[0], ()
    alike = _alike_in_forecasts(study, [(c, _foretelling(study, model, baseline, c)) for c in near])
    return alike[0], tuple(c.name for c in alike[1:])


def _foretelling(study: Study, model: Model, baseline: Baseline, candidate: Candidate) -> Model:
    """Return the model with a candidate, of a wave with its overtones or without them, whichever forecasts better.

    To the marks, overtones may be what a large sine does beyond its first order.
    """
    fuller = with_overtones(candidate, baseline)
    models = [with_candidate(model, way, study.pool) for way in (candidate, fuller)[: 1 if fuller is candidate else 2]]
    return models[int(np.argmin(likelihood_ratios(models, study.windows)))]


def _alike_in_forecasts(study: Study, trials: Sequence[tuple[Candidate, Model]]) -> list[Candidate]:
    """Return the candidates whose models forecast as well as the best one when refitted, in the order given.

    A course of any shape has many numbers, each of which costs what it costs in the screening.
    """
    fitted = [refit(m, study.windows, study.uncertainty, most=REFIT_WINDOWS, evaluations=20).model for _, m in trials]
    costs = np.array([len(c.hypothesis.columns) * study.baseline.price for c, _ in trials])
    against = likelihood_ratios(fitted, study.windows) + costs
    return [c for (c, _), worse in zip(trials, against - against.min(), strict=True) if worse < criteria.ALIKE_SCREENED]


def _best_score(candidates: Iterable[Candidate]) -> float:
    return max((c.score for c in candidates), default=-np.inf)


@dataclasses.dataclass(frozen=True)
class _Family:
    """The effects that simulating tells apart here, with the competitors on their axes."""

    kinds: tuple[str, ...]
    """The effects."""
    score: float
    """Best score among them all [-]."""

    def holds(self, candidate: Candidate) -> bool:
        """Return whether a candidate is one of them."""
        return candidate.name in self.kinds + SHAPES or candidate.any_shape


def _family(candidates: Sequence[Candidate], cases: Sequence[Case]) -> _Family:
    several = len(cases) > 1 and not cases[0].record.mechanism.excitation_amplitude
    # an effect of another package says what it marks, not how slips differ: simulating it decides
    own = tuple(c.name for c in candidates if c.is_effect and not effect_class(c.name).__module__.startswith("stochfric_mb."))
    kinds = kinds_with(SHAPES_SLIPS) + (kinds_with(BETWEEN_POINTS) if several else ()) + own
    first = _Family(kinds, -np.inf)
    shape = _best_score(c for c in candidates if first.holds(c))
    # where slips keep step with a known force, a late sensor shapes every slip alike, too
    forced = [c for c in candidates if c.has(SHAPED_IF_FORCED) and criteria.OUTDONE * c.score < shape]
    return _Family(kinds + (kinds_with(SHAPED_IF_FORCED) if forced else ()), max(shape, _best_score(forced)))


def _nameless(effects: Sequence[Candidate], others: Sequence[Candidate]) -> Where | None:
    """Return where the unknown lives, if a competitor that names no physics beats the best effect; None if none does."""
    score = effects[0].score if effects else -np.inf
    # a course of any shape follows what has fewer freedoms: only evidence as large tells that it is no less
    least = 1.0 if effects and effects[0].any_course else criteria.OUTDONE
    if others and others[0].score >= criteria.NAMED and score < least * others[0].score:
        axis = others[0].axis
        return Where(axis, f"the disagreement shows along: {axis}; no known effect explains it")
    if score < criteria.NAMED:
        return None
    pattern = {c.name: c for c in reversed(others)}
    softer, parity = pattern.get(SOFTENING), pattern.get("parity")
    if (
        softer is not None
        and effects[0].has(DRIFTS)
        and softer.score > score + max(criteria.SOFTER, criteria.ALIKE_SHARE * score)
    ):
        return Where(softer.axis, "the spring, not the friction, drifts in the course of a run")
    if parity is not None and effects[0].is_wave and parity.score > criteria.ALTERNATES * score:
        text = "friction alternates from slip to slip: no ripple that has its own frequency stays in step so"
        return Where(parity.axis, text)
    return None


@dataclasses.dataclass(frozen=True)
class _Simulation:
    """Candidates distinguished by simulating them."""

    study: Study
    """What was measured."""
    model: Model
    """The present model."""
    cases: Sequence[Case]
    """Slips to be predicted."""
    before: Confirmed
    """The simulated model so far."""
    details: dict[str, object]
    """Gets the numbers."""

    def outcome(self, mine: Sequence[Candidate]) -> Chosen | Where | None:
        """Return the candidate that explains the slips best, or where their shape disagrees with all, or None."""
        tried = [t for t in self._tried(mine) if t[1].slips]
        if not tried:
            return None
        # of names about equally good the one stands first that could have been refuted: hardly any shape refutes friction along
        # the stroke, or a wave of any order to which the slips keep
        fits = [t for t in tried if not (t[0].any_shape or t[0].is_wave) and _adequate(t[1], self.before)] or tried
        spread = _spread([f for _, f in fits])
        best, fitted = min(fits, key=lambda t: t[1].scaled(spread))
        if self.before.criterion - fitted.criterion < criteria.FOLLOWED_UP:
            return None
        alone = self._left_open_alone(fitted)
        if alone is not None and alone.criterion - fitted.criterion < criteria.FOLLOWED_UP:
            return _of_another_rig(alone.model, best.name)
        if _lacking(fitted, self.before):
            return Where(
                "shape of the friction force within a slip",
                f"no known effect explains the force within the slips; {best.name} comes closest",
            )
        alike = _alike(best, fitted, tried, spread, self.before)
        best, fitted, alike = self._against_waves((best, fitted), alike, tried)
        return Chosen(best, alike, fitted.model, fitted, True)

    def _left_open_alone(self, fitted: Confirmed) -> Confirmed | None:
        """Return what the numbers of the mechanism that the last effect of a fit leaves open explain without it; None: none.

        An effect has to explain more than these by themselves: otherwise it is a way to leave them open.
        """
        numbers = frozenset(fitted.model.effects[-1].frees).intersection(CORRECTED)
        if not numbers:
            return None
        begins = fitted.model.without_last(fitted.kinds[-1]), self.before.model
        ways = [confirm(self.cases, dataclasses.replace(m, freed=numbers), self.study.uncertainty) for m in begins]
        return min(ways, key=lambda w: w.chi2)

    def _against_waves(
        self, chosen: Trial, alike: tuple[str, ...], tried: Sequence[Trial]
    ) -> tuple[Candidate, Confirmed, tuple[str, ...]]:
        """Return what is chosen and its class, where forecasts decide against waves: slips that keep to one show its phase."""
        best, fitted = chosen
        waves = [t for t in tried if t[0].is_wave and t[0].name in alike]
        if best.is_wave or not waves:
            return best, fitted, alike
        contenders = {c.name: (c, f) for c, f in reversed([chosen, *waves])}
        near = _alike_in_forecasts(self.study, [(c, f.model) for c, f in reversed(contenders.values())])
        if best in near:
            return best, fitted, alike
        return *contenders[near[0].name], tuple(c.name for c in near[1:])

    def _tried(self, mine: Sequence[Candidate]) -> list[Trial]:
        """Return the candidates that are worth it, simulated, best first."""
        rounds = sum(key.startswith("confirmation") for key in self.details)
        chosen = _worth_simulating(mine, MOST_SIMULATED_LATER if rounds else MOST_SIMULATED)
        tried = self._simulated(chosen)
        if not any(_adequate(f, self.before) for _, f in tried if f.slips):
            # none explains the slips: marks were too far from linear to choose by
            tried += self._simulated([c for c in mine if c not in chosen and not c.any_shape])
        if not self.model.effects:
            tried += entrained(self.study, self.model, self.cases)
        tried.sort(key=lambda t: t[1].criterion)
        # of several variants of an effect the best one counts
        scores = {c.name: [f.chi2, f.criterion] for c, f in reversed(tried)}
        self.details[f"confirmation_{rounds + 1}"] = scores | {"believed": [self.before.chi2, self.before.criterion]}
        return tried

    def _simulated(self, candidates: Sequence[Candidate]) -> list[Trial]:
        return [(c, self._fitted(c)) for c in candidates]

    def _fitted(self, candidate: Candidate) -> Confirmed:
        """Return the model with a candidate, fitted from where marks have it and from where a few steps bring it nearest.

        Estimated beside marks that look like theirs, coefficients of friction may be of another rig: those of the model so far
        are of this one.
        """
        screened, *others = (with_candidate(self.model, c, self.study.pool) for c in (candidate, *candidate.others))
        marked, *others = (dataclasses.replace(way, law=self.before.model.law) for way in (screened, *others))
        rough = [confirm(self.cases, way, self.study.uncertainty, evaluations=ROUGH) for way in (marked, screened, *others)]
        nearest = min(rough, key=lambda r: r.chi2)
        begins = [rough[0].model] if nearest is rough[0] else [rough[0].model, nearest.model]
        return min((confirm(self.cases, m, self.study.uncertainty) for m in begins), key=lambda f: f.chi2)


def _worth_simulating(mine: Sequence[Candidate], most: int) -> list[Candidate]:
    """Return the candidates to simulate first, ``most`` of them: those with most evidence, of kinds a form of which has any.

    Marks are of first order, and tell kinds better than forms of one.
    """
    least = criteria.FOLLOWED_UP / 2.0
    kinds = {c.name for c in mine if c.score > least}
    worth = [c for c in mine if c.name in kinds]
    return [c for c in worth if not c.any_shape][:most] + [c for c in worth if c.any_shape]


def _of_another_rig(model: Model, kind: str) -> Where:
    """Return where the unknown lives if a model whose mechanism is not as stated explains the slips as well as an effect."""
    off = {name: model.corrections.get(name, 0.0) for name in sorted(model.freed)}
    numbers = " and ".join(f"{name} {100.0 * abs(by):.2g} % {'above' if by > 0.0 else 'below'}" for name, by in off.items())
    text = f"a rig with its {numbers} what is stated would slip so; beside that, {kind} explains no more"
    return Where(OTHER_RIG, text)


def _lacking(fitted: Confirmed, before: Confirmed) -> bool:
    """Return whether even the best candidate leaves too much of the slips' shape."""
    beyond = fitted.chi2 > fitted.freedom + criteria.LACK_OF_FIT
    return beyond and fitted.chi2 > criteria.LACK_OF_FIT_SHARE * before.chi2


def _alike(best: Candidate, fitted: Confirmed, tried: Sequence[Trial], spread: float, before: Confirmed) -> tuple[str, ...]:
    """Return the other candidates that explain the slips about as well."""
    near = fitted.scaled(spread) + criteria.ALIKE_SIMULATED
    alike = [
        c
        for c, f in sorted(tried, key=lambda t: t[1].scaled(spread))
        if f.scaled(spread) < near and (_adequate(f, before) or not (c.any_shape or c.is_wave))
    ]
    return tuple(dict.fromkeys(c.name for c in alike if c.name != best.name))


def _adequate(fitted: Confirmed, before: Confirmed) -> bool:
    """Return whether a candidate explains the slips' shape but for what another form of it would."""
    return fitted.chi2 <= max(fitted.freedom + criteria.LACK_OF_FIT, criteria.FORM_MISSES * before.chi2)


def _spread(confirmed: Sequence[Confirmed]) -> float:
    """Return chi^2 over its freedom of the best candidate, at least 1: what the forms of all candidates miss.

    Where no form is exact, differences of chi^2 tell of the forms, not of the kinds; the noise in which kinds are compared
    is then the misfit itself (quasi-likelihood: D. R. Anderson, K. P. Burnham, G. C. White, Ecology 75, 1994, 1780-1793).
    """
    return max(min((f.chi2 / max(f.freedom, 1) for f in confirmed), default=1.0), 1.0)
