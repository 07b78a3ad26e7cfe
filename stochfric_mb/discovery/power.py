"""What an experiment could have seen: the smallest strength of each effect that would have been named."""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery.choice import NAME
from stochfric_mb.discovery.hypotheses import screens
from stochfric_mb.discovery.naming import PERIODIC
from stochfric_mb.discovery.study import Study


def smallest(study: Study) -> dict[str, float]:
    """Return effect -> the smallest value of its first parameter that would have been named, in that parameter's unit.

    To first order: the score 2 delta log L - p ln n - 2 ln(grid) reaches the naming score where the coefficient is
    sqrt(score + penalties) of its standard deviations. Of the hypotheses of a kind the most sensitive one counts.
    """
    regression = study.regression
    found: dict[str, float] = {}
    for kind, screen in screens().items():
        hypotheses = screen(study.pool)
        if not hypotheses:
            continue
        # periodic effects are all alike; a few frequencies stand for all
        looked_at = hypotheses[:: max(len(hypotheses) // 12, 1)]
        best = np.inf
        for hypothesis in looked_at:
            p = len(hypothesis.columns)
            solution = regression.solve(study.terms.plus(hypothesis.columns), study.solution.scatter)
            needed = np.sqrt(NAME + p * np.log(regression.n) + 2.0 * np.log(len(hypotheses)))
            strengths = needed * solution.deviations[study.terms.columns.shape[2] :]
            if kind in PERIODIC:
                # cosine and sine of every run share the evidence
                best = min(best, float(np.median(strengths) / np.sqrt(study.pool.n_runs)))
                continue
            values = hypothesis.start(strengths)
            best = min(best, abs(next(iter(values.values()), np.inf)))
        if np.isfinite(best):
            found[kind] = best
    return found
