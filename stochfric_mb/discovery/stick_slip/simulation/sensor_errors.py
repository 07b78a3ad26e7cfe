"""What the sensor's noise does to the features of a model with effects.

Noise hides an edge, and by how far it is then missed depends on how the box leaves the belt: a friction that falls
slowly lets it leave slowly, and the edge is found late, early, or in one of two places. The calibration knows this of the
stated model alone. So a run of the model is simulated; its slips are extracted without noise and with it, and the
difference is the error of each.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.records.calibration import FEWEST
from stochfric_mb.discovery.stick_slip.records.long_records import middle
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips, extract
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.scatter import measured_slips, shown_by
from stochfric_mb.errors import SimulationError

REPEATS = 2
"""Records with noise of one simulated run."""
SEED = 23
"""Seed of the noise; any other would do."""


@dataclasses.dataclass(frozen=True)
class Errors:
    """Errors of the features by noise."""

    bias: Array
    """Their mean [N], shape (N_FEATURES,)."""
    covariance: Array
    """Their covariance [N^2], shape (N_FEATURES, N_FEATURES)."""


def errors_by_noise(model: Model, like: Slips) -> Errors | None:
    """Return the errors that the noise of a run makes in the features of the model's slips; None for too few slips."""
    like = middle(like)
    record = like.record
    generator = np.random.default_rng(SEED)
    try:
        shown = shown_by(model, like, generator)
    except SimulationError:
        return None
    still = extract(record.showing(shown), ridge=like.ridge, noise=like.noise)
    arrays: list[Array] = []
    for _ in range(REPEATS):
        noisy = measured_slips(shown, like, generator)
        if len(still) == 0 or len(noisy) == 0:
            continue
        nearest = np.abs(noisy.onset_time[:, None] - still.onset_time).argmin(axis=1)
        same = np.abs(noisy.onset_time - still.onset_time[nearest]) < 1.0 / record.angular_frequency
        arrays.append(noisy.features[same] - still.features[nearest[same]])
    errors = np.concatenate(arrays) if arrays else np.zeros((0, N_FEATURES))
    if len(errors) < FEWEST:
        return None
    return Errors(errors.mean(axis=0), np.cov(errors.T))
