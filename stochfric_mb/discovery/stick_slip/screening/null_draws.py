"""Records of the stated model, its declared scatter included: what screening makes of them where nothing is missing.

Scores take slips as independent but for what they are to find. A declared process with a memory makes neighbours alike, which
passes for a wave or a drift; how far, its own records tell.

Reference: E. J. Gumbel, Statistics of Extremes, Columbia University Press 1958, section 6.2 (largest values, by moments).
"""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.pool import make_pool
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, baseline_of
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.simulation.scatter import simulated_slips
from stochfric_mb.discovery.stick_slip.study import Study

DRAWS = 16
"""Records that the quantile is estimated from: its standard error is then the scale of the distribution of largest scores."""


def drawn(study: Study, sample: int) -> Baseline:
    """Return the stated model, fitted to the slips of one simulated set of records like the fit runs."""
    slips = [simulated_slips(study.model, s, sample=sample + i) for i, s in enumerate(study.pool.slips)]
    return baseline_of(make_pool(slips, study.pool.calibrations), study.uncertainty, study.baseline.solution.scatter)


def largest_by_chance(study: Study) -> float:
    """Return the score that the best candidate of such records exceeds at the family-wise rate [-]."""
    best = [screen(drawn(study, draw * len(study.pool.slips)))[0].score for draw in range(1, DRAWS + 1)]
    scale = float(np.std(best, ddof=1)) * np.sqrt(6.0) / np.pi
    place = float(np.mean(best)) - np.euler_gamma * scale
    return place - scale * float(np.log(-np.log1p(-criteria.FAMILY_WISE)))
