"""Bias and covariance of the features at an operating point, from simulating the model as stated.

The baseline is simulated with friction that scatters from event to event about as much as the data do, measured with
noise of the data's level and colour, and taken through the same extraction; inside the simulation the truth is known.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.records.long_records import middle
from stochfric_mb.discovery.stick_slip.records.record import Array, make_record
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips, extract
from stochfric_mb.effects import kind_with_signature, make_effect
from stochfric_mb.effects.traits import DRAWN_ANEW
from stochfric_mb.laws import make_law
from stochfric_mb.numerics.robust import deviation
from stochfric_mb.reference.augmented import Start, augmented_system

REPEATS = 2
"""Simulated records for each measured one."""
FINER = 4
"""Simulated steps in one sample: what is taken for the truth at a break-away must be sharper than a sample."""
FEWEST = 15
"""Simulated slips below which the bias cannot be estimated."""
UNKNOWN = np.array([0.003, 0.01, 0.02, 0.03, 0.03, 0.03, 0.03, 0.03])
"""Standard deviations of the features that are assumed in that case, over the force at break-away [-]."""
LEAST_ERROR = 1.0e-4
"""Error of the features that always remains, over the same [-]: it keeps a noiseless record's covariance invertible."""


@dataclasses.dataclass(frozen=True)
class Calibration:
    """Systematic and random errors of the features at one operating point."""

    bias: Array
    """Mean error [N], shape (N_FEATURES,)."""
    slopes: Array
    """Change of the error with the onset force and with the mean force in slip [-], shape (N_FEATURES, 2)."""
    reference: tuple[float, float]
    """Onset force and mean force in slip at which the bias is given [N]."""
    covariance: Array
    """Covariance of the error [N^2], shape (N_FEATURES, N_FEATURES)."""

    def unbiased(self, features: Array) -> Array:
        """Return features [N], shape (n, N_FEATURES), less their bias."""
        away = features[:, :2] - np.asarray(self.reference)
        return features - self.bias - away @ self.slopes.T


def calibrate(slips: Slips, *, seed: int = 11) -> Calibration:
    """Return the errors of the features of ``slips``, by simulation.

    Args:
        slips: the slips of a record.
        seed: of the simulated measurements.
    """
    static, kinetic = float(np.median(slips.onset_force)), float(np.median(slips.moments[:, 0]))
    generator, like = np.random.default_rng(seed), middle(slips)
    simulated = [_simulated(like, static, kinetic, repeat, generator) for repeat in range(REPEATS)]
    features, forces = map(np.concatenate, zip(*simulated, strict=True))
    if len(features) < FEWEST:
        return Calibration(np.zeros(N_FEATURES), np.zeros((N_FEATURES, 2)), (static, kinetic), np.diag((UNKNOWN * static) ** 2))
    error = features.copy()
    error[:, :2] -= forces
    design = np.c_[np.ones(len(error)), forces - (static, kinetic)]
    fitted = np.linalg.lstsq(design, error, rcond=None)[0]
    rest = error - design @ fitted
    kept = np.ones(len(error), dtype=bool)
    for _ in range(3):
        fitted = np.linalg.lstsq(design[kept], error[kept], rcond=None)[0]
        rest = error - design @ fitted
        kept = (np.abs(rest) < 6.0 * deviation(rest, about=0.0, axis=0) + 1.0e-7 * static).all(axis=1)
    covariance = np.cov(rest[kept].T) + (LEAST_ERROR * static) ** 2 * np.eye(N_FEATURES)
    return Calibration(fitted[0], fitted[1:].T, (static, kinetic), covariance)


def _simulated(slips: Slips, static: float, kinetic: float, repeat: int, generator: np.random.Generator) -> tuple[Array, Array]:
    """Return features and true (onset force, mean force in slip) [N] of the slips of one simulated record."""
    record = slips.record
    box = record.mechanism
    spread = (0.005 * static, 0.05 * static)
    sigma_s = float(np.clip(deviation(slips.onset_force), *spread)) / box.normal_force
    sigma_k = float(np.clip(deviation(slips.moments[:, 0]), *spread)) / box.normal_force
    kinetic = min(kinetic, 0.98 * static)
    law = make_law("coulomb", mu_s=static / box.normal_force, mu_k=max(kinetic, 1.0e-3 * static) / box.normal_force)
    scatter = make_effect(kind_with_signature(DRAWN_ANEW), process="per_event", sigma_s=sigma_s, sigma_k=sigma_k)
    system = augmented_system(box, law, [scatter], seed=repeat + 1)
    step = 1.0 / record.rate
    first = Start(-slips.settling, 0.0, box.belt_velocity, stick=True)
    start = system.march(first, step, round(slips.settling * record.rate)).end
    motion = system.march(start, step / FINER, len(record.time) * FINER)
    position = motion.position[FINER - 1 :: FINER]
    time = np.asarray(start.time + step * np.arange(1, len(position) + 1), dtype=np.float64)
    simulated = make_record(record.name, time, position + slips.noise.draw(len(position), generator), box)
    result = extract(simulated, ridge=slips.ridge)
    fine = start.time + step / FINER * np.arange(1, len(motion.position) + 1)
    onsets = np.flatnonzero((motion.stick[:-1] > 0.5) & (motion.stick[1:] < 0.5))
    resticks = np.flatnonzero((motion.stick[:-1] < 0.5) & (motion.stick[1:] > 0.5))
    features: list[Array] = []
    forces: list[Array] = []
    for i in range(len(result)):
        if len(onsets) == 0:
            break
        onset = onsets[np.argmin(np.abs(fine[onsets] - result.onset_time[i]))]
        later = resticks[resticks > onset]
        if len(later) == 0 or abs(fine[onset] - result.onset_time[i]) > 1.0 / record.angular_frequency:
            continue
        at = slice(int(onset) + 2, max(int(later[0]) - 1, int(onset) + 3))
        # the sample before the break-away is on average half a step early
        late = 0.5 * step / FINER * box.stiffness * box.belt_velocity
        features.append(result.features[i])
        forces.append(
            np.array([float(motion.friction_force[onset]) + late, float(np.mean(motion.friction_force[at]))], dtype=np.float64)
        )
    return np.array(features).reshape(-1, N_FEATURES), np.array(forces).reshape(-1, 2)
