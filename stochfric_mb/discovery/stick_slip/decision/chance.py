"""What is random in the slips: whether it is to be named before any effect, and what is left of it last of all."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.choice import IN_TIME, SHAPES
from stochfric_mb.discovery.stick_slip.decision.random_effects import kicked, kicks, stray
from stochfric_mb.discovery.stick_slip.screening.folding import comes_back
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.discovery.stick_slip.screening.switching import levels_score, switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import randomness
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import DRIFTS, JUMP, SHAPES_SLIPS


def before_effects(study: Study, candidates: Sequence[Candidate], details: dict[str, object]) -> Where | bool:
    """Return whether friction that wanders or is kicked explains what the best candidate does, or where it switches.

    Args:
        study: what was measured.
        candidates: the outcome of the first screening, best first.
        details: gets the numbers.
    """
    if _wanders(study.baseline, candidates) or _kicked_up(study, candidates[0]):
        return True
    sudden = _sudden(study.baseline, candidates, details)
    # slips that stand out beside an effect in all the others are accidents, or edges that noise hides
    if sudden is None or kicks(study) is not None:
        return False
    return comes_back(study, kicked(study), details) or sudden


def _kicked_up(study: Study, winner: Candidate) -> bool:
    """Return whether a winner stands on slips alone that kicks set apart: without them hardly anything speaks for it."""
    if kicks(study) is None:
        return False
    others = study.baseline.of(study.pool.kept & ~kicked(study))
    return 2.0 * float(others.gains([winner.hypothesis.columns])[0]) < criteria.NAMED


def _wanders(baseline: Baseline, candidates: Sequence[Candidate]) -> bool:
    """Return whether a winner on the axis of time is better described as a random drift."""
    winner = candidates[0]
    if winner.name not in (*IN_TIME, kind_with_signature(JUMP)) and not (winner.is_wave or winner.any_course):
        return False
    drifts = max((c.score for c in candidates if c.has(DRIFTS)), default=-np.inf)
    scatter = randomness(baseline)
    # what names physics has to be beaten; hats on the axis of time name none
    share = 0.5 if winner.name in IN_TIME else 1.0 if winner.any_course else 1.2
    margin = criteria.NAMED if winner.any_course else 0.0
    rival = max(share * winner.score, drifts) - margin
    return scatter.correlation > criteria.SCATTER_MEMORY and scatter.wander > rival


def _sudden(baseline: Baseline, candidates: Sequence[Candidate], details: dict[str, object]) -> Where | None:
    """Return where friction switches, if there is more evidence for that than for the best effect; None if not."""
    levels = switching(baseline.pool, baseline.residuals())
    details["switching"] = dataclasses.asdict(levels)
    # what all slips share is explained first; what jumps beside it is judged last of all
    shared = not levels.two_levels and (candidates[0].name in SHAPES or candidates[0].has(SHAPES_SLIPS))
    if levels.where is None or shared:
        return None
    score = details["levels"] = levels_score(baseline, jumps=not levels.two_levels)
    best = max((c.score for c in candidates if c.is_effect), default=-np.inf)
    return None if best > score else levels.where


def without_accidents(baseline: Baseline) -> Baseline:
    """Return the baseline without slips that stand far out, too few to be kicks: two of a hundred are no scatter."""
    kept = baseline.pool.kept
    far = stray(baseline.pool, baseline.residuals())
    return baseline.of(kept & ~far) if 0.0 < far.sum() < criteria.ACCIDENTS * kept.sum() else baseline
