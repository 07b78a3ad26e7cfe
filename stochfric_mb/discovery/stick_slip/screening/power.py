"""What an experiment could have seen: the smallest strength of each effect that would have been named."""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.cases import evidence_in_medians
from stochfric_mb.discovery.stick_slip.decision.confirmation import evidence_needed
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.screening.hypotheses import hypotheses_in, waves_in
from stochfric_mb.discovery.stick_slip.screening.regression import Terms
from stochfric_mb.discovery.stick_slip.screening.waves import frequencies, wave_columns
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import effect_class
from stochfric_mb.effects.marks import Hypothesis
from stochfric_mb.effects.traits import SHAPES_SLIPS

LOOKED_AT = 12
"""Frequencies that stand for all: periodic effects are all alike."""


def simulated_limit(pool: Pool, terms: Terms, hypothesis: Hypothesis) -> float:
    """Return the coefficient from which simulating an effect that shapes every slip alike confirms it.

    Args:
        pool: the slips.
        terms: the stated model.
        hypothesis: the effect.
    """
    evidence = evidence_in_medians(pool, terms, hypothesis.columns[0])
    return float(np.sqrt(evidence_needed(len(hypothesis.columns) + len(hypothesis.setting)) / max(evidence, 1.0e-300)))


def smallest(study: Study) -> dict[str, float]:
    """Return effect -> the smallest value of its first parameter that would have been named, in that parameter's unit.

    To first order: the score 2 delta log L - p ln n - 2 ln(grid) reaches the naming score where the coefficient is
    sqrt(score + penalties) of its standard deviations, and, where simulated slips decide, their misfit falls by enough. Of the
    hypotheses of a kind the most sensitive one counts.
    """
    baseline = study.baseline
    numbers: dict[str, float] = {}
    families = hypotheses_in(study.pool)
    periodic = waves_in(study.pool)
    grid = {kind: len(some) for kind, some in families.items()}
    every = frequencies(study.pool)
    for kind, wave in periodic.items():
        some = every[:: max(len(every) // LOOKED_AT, 1)]
        families[kind] = [Hypothesis(kind, wave_columns(study.pool, wave, f, 1), (f, 1.0)) for f in some]
        grid[kind] = len(every)
    for kind, family in families.items():
        looked_at = family[:: max(len(family) // LOOKED_AT, 1)]
        best = np.inf
        for hypothesis in looked_at:
            p = len(hypothesis.columns)
            needed = np.sqrt(criteria.NAMED + p * baseline.price + 2.0 * np.log(grid[kind]))
            strengths = needed * baseline.solved(hypothesis.columns).deviations[baseline.n_terms :]
            if SHAPES_SLIPS in effect_class(kind).traits and strengths[0] > 0.0:
                strengths = strengths * max(1.0, simulated_limit(study.pool, baseline.terms, hypothesis) / strengths[0])
            if kind in periodic:
                # cosine and sine of every run share the evidence
                best = min(best, float(np.median(strengths) / np.sqrt(study.pool.n_runs)))
                continue
            values = hypothesis.start(strengths)
            best = min(best, abs(next(iter(values.values()), np.inf)))
        if np.isfinite(best):
            numbers[kind] = best
    return numbers
