"""One round of the decision: which candidate of the screening is meant, and which cannot be told from it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.confirmation import Case, Confirmed, confirm
from stochfric_mb.discovery.stick_slip.decision.entrainment import entrained
from stochfric_mb.discovery.stick_slip.screening.competitors import SOFTENING
from stochfric_mb.discovery.stick_slip.screening.naming import with_candidate
from stochfric_mb.discovery.stick_slip.screening.regression import Terms
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import effect_class, kinds_with
from stochfric_mb.effects.traits import BETWEEN_POINTS, DRIFTS, SHAPED_IF_FORCED, SHAPES_SLIPS

MOST_SIMULATED = 8
"""Candidates that are simulated in the first round."""
MOST_SIMULATED_LATER = 4
"""The same in what an effect leaves, where the best marks can be trusted: what is left is weak."""
REFUTED = "shapes_refuted"
"""Name under which the details hold that simulating effects which shape every slip alike has not borne them out."""

SHAPES = ("slip_shape", "position")
"""Competitors on the axes on which those effects act."""
IN_TIME = ("time", "time_common", "friction_step", "parity")
"""Competitors on the axis of time: a random wander may be what they see."""


@dataclasses.dataclass(frozen=True)
class Chosen:
    """The effect of one round."""

    candidate: Candidate
    """The candidate."""
    class_: tuple[str, ...]
    """Effects that cannot be told from it."""
    model: Model
    """The model with it, at numbers to start from."""
    confirmed: Confirmed | None
    """Its simulation, if it was simulated; what further effects of its family are compared with."""
    simulated: bool
    """Whether its numbers come from simulating."""


def choose(
    study: Study,
    model: Model,
    terms: Terms,
    candidates: Sequence[Candidate],
    cases: Sequence[Case],
    before: Confirmed | None,
    details: dict[str, object],
) -> Chosen | Where | None:
    """Return the effect of this round, or where the unknown lives, or None for nothing.

    Args:
        study: what was measured.
        model: the model so far.
        terms: its terms in the regression.
        candidates: the screening's outcome, best first.
        cases: slips to be predicted in a confirmation.
        before: the simulated model so far.
        details: gets the numbers of the confirmation.
    """
    family, shape = _family(candidates, cases)

    def shapes(candidate: Candidate) -> bool:
        """Return whether it is of the family, or a competitor on its axes."""
        return candidate.name in family + SHAPES or candidate.any_shape

    effects = [c for c in candidates if c.is_effect]
    others = [c for c in candidates if not c.is_effect]
    rest = _best_score(c for c in candidates if not shapes(c))
    if before is not None and shape >= criteria.NAMED and shape >= rest:
        # refuted once, shapes stay refuted: the slips that simulated ones are compared with are the same
        if REFUTED not in details:
            outcome = _by_simulation(study, model, terms, [c for c in effects if shapes(c)], cases, before, details)
            if outcome is not None:
                return outcome
            details[REFUTED] = True
        # simulation does not bear the shape out: what remains are effects that change from slip to slip
        effects = [c for c in effects if not shapes(c) and c.score > criteria.WORTH_SIMULATING * shape]
        others = [c for c in others if c.name not in SHAPES]
    nameless = _nameless(effects, others)
    if nameless is not None or not effects or effects[0].score < criteria.NAMED:
        return nameless
    best = effects[0]
    near = best.score - max(criteria.ALIKE_SCREENED, criteria.ALIKE_SHARE * best.score)
    class_ = tuple(dict.fromkeys(c.name for c in effects[1:] if c.score > near and c.name != best.name))
    return Chosen(best, class_, with_candidate(model, best, study.pool, terms.columns.shape[2]), before, False)


def _best_score(candidates: Iterable[Candidate]) -> float:
    return max((c.score for c in candidates), default=-np.inf)


def _family(candidates: Sequence[Candidate], cases: Sequence[Case]) -> tuple[tuple[str, ...], float]:
    """Return the effects that simulating tells apart here, and the best score of their family and its competitors."""
    several = len(cases) > 1 and not cases[0].record.mechanism.excitation_amplitude
    # an effect of another package says what it marks, not how slips differ: simulating it decides
    own = tuple(c.name for c in candidates if c.is_effect and not effect_class(c.name).__module__.startswith("stochfric_mb."))
    family = kinds_with(SHAPES_SLIPS) + (kinds_with(BETWEEN_POINTS) if several else ()) + own
    shape = _best_score(c for c in candidates if c.name in family + SHAPES or c.any_shape)
    if any(c.has(SHAPED_IF_FORCED) and criteria.OUTDONE * c.score < shape for c in candidates):
        # where slips keep step with a known force, a late sensor shapes every slip alike, too
        family += kinds_with(SHAPED_IF_FORCED)
        shape = max(shape, *(c.score for c in candidates if c.has(SHAPED_IF_FORCED)))
    return family, shape


def _nameless(effects: Sequence[Candidate], others: Sequence[Candidate]) -> Where | None:
    """Return where the unknown lives, if a competitor that names no physics beats the best effect; None if none does."""
    best = effects[0] if effects else None
    other = others[0] if others else None
    if other is not None and other.score >= criteria.NAMED and (best is None or best.score < criteria.OUTDONE * other.score):
        return Where(other.axis, f"the disagreement lives on the axis: {other.axis}; no known effect explains it")
    if best is None or best.score < criteria.NAMED:
        return None
    softer = next((c for c in others if c.name == SOFTENING), None)
    if (
        softer is not None
        and best.has(DRIFTS)
        and softer.score > best.score + max(criteria.SOFTER, criteria.ALIKE_SHARE * best.score)
    ):
        return Where(softer.axis, "the spring, not the friction, drifts in the course of a run")
    parity = next((c for c in others if c.name == "parity"), None)
    if parity is not None and best.is_wave and parity.score > criteria.ALTERNATES * best.score:
        text = "friction alternates from slip to slip: no ripple that has its own frequency stays in step so"
        return Where(parity.axis, text)
    return None


def _by_simulation(
    study: Study,
    model: Model,
    terms: Terms,
    mine: Sequence[Candidate],
    cases: Sequence[Case],
    before: Confirmed,
    details: dict[str, object],
) -> Chosen | Where | None:
    n_terms = terms.columns.shape[2]
    # over the best effect, not the shape: where none comes near it the marks are too far from linear to choose by
    least = max(criteria.WORTH_SIMULATING * mine[0].score if mine else 0.0, criteria.FOLLOWED_UP / 2.0)
    rounds = sum(key.startswith("confirmation") for key in details)
    most = MOST_SIMULATED_LATER if rounds else MOST_SIMULATED
    worth = [c for c in mine if c.score > least]
    firm, loose = [c for c in worth if not c.any_shape][:most], [c for c in worth if c.any_shape]
    tried = [(c, confirm(cases, with_candidate(model, c, study.pool, n_terms), study.uncertainty)) for c in (*firm, *loose)]
    if not model.effects:
        tried += entrained(study, model, terms, cases)
    tried.sort(key=lambda t: t[1].criterion)
    # of several variants of an effect the best one counts
    details[f"confirmation_{rounds + 1}"] = {c.name: [f.chi2, f.criterion] for c, f in reversed(tried)} | {
        "believed": [before.chi2, before.criterion]
    }
    if not tried:
        return None
    # of names about equally good the one stands first that could have been refuted: hardly any shape refutes the others
    fits = [t for t in tried if not t[0].any_shape and _adequate(t[1], before)] or tried
    spread = _spread([f for _, f in fits])
    best, fitted = min(fits, key=lambda t: t[1].scaled(spread))
    if before.criterion - fitted.criterion < criteria.FOLLOWED_UP:
        return None
    if fitted.chi2 > fitted.freedom + criteria.LACK_OF_FIT and fitted.chi2 > criteria.LACK_OF_FIT_SHARE * before.chi2:
        return Where(
            "shape of the friction force within a slip",
            f"no known effect explains the force within the slips; {best.name} comes closest",
        )
    near = fitted.scaled(spread) + criteria.ALIKE_SIMULATED
    tried.sort(key=lambda t: t[1].scaled(spread))
    alike = [c for c, f in tried if f.scaled(spread) < near and (_adequate(f, before) or not (c.any_shape or c.is_wave))]
    class_ = tuple(dict.fromkeys(c.name for c in alike if c.name != best.name))
    return Chosen(best, class_, fitted.model, fitted, True)


def _adequate(fitted: Confirmed, before: Confirmed) -> bool:
    """Return whether a candidate explains the slips' shape but for what another form of it would."""
    return fitted.chi2 <= max(fitted.freedom + criteria.LACK_OF_FIT, criteria.FORM_MISSES * before.chi2)


def _spread(confirmed: Sequence[Confirmed]) -> float:
    """Return chi^2 over its freedom of the best candidate, at least 1: what the forms of all candidates miss.

    Where no form is exact, differences of chi^2 tell of the forms, not of the kinds; the noise in which kinds are compared
    is then the misfit itself (quasi-likelihood: D. R. Anderson, K. P. Burnham, G. C. White, Ecology 75, 1994, 1780-1793).
    """
    return max(min((f.chi2 / max(f.freedom, 1) for f in confirmed), default=1.0), 1.0)
