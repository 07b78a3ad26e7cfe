"""Generalised least squares of the slips' features, with variance components that are always on.

The features of a slip scatter with covariance C_run (from calibration) plus what friction itself may scatter: sigma_s^2
on the onset force, sigma_k^2 on the mean force in slip, and white scatter within the slip, sigma_w^2 (2 q + 1) on the
coefficient of order q. Mass, stiffness and damping are regressors with the priors that the scenario states. Negative
log likelihoods are up to a constant that all models share.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, N_MOMENTS

LOWEST, HIGHEST = -7.0, 1.0
"""Range of the logarithm of the variance components [ln N]."""
DAMPING = 4
"""Place of the relative error of the damping among the terms of the stated model."""
_WHITE = 2.0 * np.arange(N_MOMENTS) + 1.0


@dataclasses.dataclass(frozen=True)
class Terms:
    """Regressors of a model, shape (n, N_FEATURES, p), and the prior deviation of each coefficient (inf: free)."""

    columns: Array
    priors: Array

    def plus(self, columns: Sequence[Array]) -> Terms:
        """Return these terms and further, free ones."""
        if not columns:
            return self
        return Terms(
            np.concatenate([self.columns, np.stack(columns, axis=2)], axis=2), np.r_[self.priors, [np.inf] * len(columns)]
        )


@dataclasses.dataclass(frozen=True)
class Solution:
    """A fitted model."""

    cost: float
    """Negative log likelihood, priors included."""
    coefficients: Array
    """Coefficients of the terms, shape (p,)."""
    deviations: Array
    """Their standard deviations, shape (p,)."""
    scatter: Array
    """Logarithms of sigma_s, sigma_k, sigma_w [ln N], shape (3,)."""


@dataclasses.dataclass(frozen=True)
class Part:
    """What further regressors of one run meet, whitened; rows are (slip, feature) pairs."""

    run: int
    """Number of the run."""
    inverse: Array
    """Whitening of a slip's features [1/N], shape (N_FEATURES, N_FEATURES)."""
    basis: Array
    """The run's rows of an orthonormal basis of the terms, shape (rows, p)."""
    rest: Array
    """What the terms leave of the features, shape (rows,)."""


class Regression:
    """Fits of models to one pool of slips."""

    def __init__(self, pool: Pool) -> None:
        self.pool = pool
        self._rows = [np.flatnonzero(pool.kept & (pool.run == r)) for r in range(pool.n_runs)]

    @property
    def n(self) -> int:
        """Number of slips in the fits."""
        return sum(map(len, self._rows))

    def solve(self, terms: Terms, scatter: Array) -> Solution:
        """Return the best coefficients for given variance components."""
        design, target, volume = self._whitened(terms.columns, scatter)
        precision = 1.0 / terms.priors**2
        scale = np.sqrt((design**2).sum(axis=0) + precision) + 1.0e-12
        scaled = design / scale
        normal = scaled.T @ scaled + np.diag(precision / scale**2)
        # a touch of ridge keeps regressors that the data cannot separate from blowing up
        inverse = np.linalg.inv(normal + 1.0e-10 * np.eye(len(scale)))
        fitted = inverse @ (scaled.T @ target)
        residual = target - scaled @ fitted
        coefficients = fitted / scale
        cost = 0.5 * (residual @ residual + (coefficients**2 * precision).sum()) + 0.5 * volume
        return Solution(float(cost), coefficients, np.sqrt(np.diag(inverse)) / scale, np.asarray(scatter, dtype=np.float64))

    def fit(self, terms: Terms, start: Array | None = None) -> Solution:
        """Return the best coefficients and variance components, by coordinate search from ``start``."""
        best = self.solve(terms, np.array([-3.0, -3.0, -4.0]) if start is None else start)
        step = 1.0
        while step >= 0.12:
            improved = False
            for j in range(3):
                for sign in (1.0, -1.0):
                    trial = best.scatter.copy()
                    trial[j] = np.clip(trial[j] + sign * step, LOWEST, HIGHEST)
                    solution = self.solve(terms, trial)
                    if solution.cost < best.cost - 1.0e-3:
                        best, improved = solution, True
                        break
            if not improved:
                step /= 2.0
        return best

    def gains(self, terms: Terms, scatter: Array, trials: Sequence[Sequence[Array]]) -> Array:
        """Return by how much each trial's further columns lower the cost at fixed variance components, shape (len(trials),)."""
        top, rest = self._rest(terms, scatter)
        gains = np.zeros(len(trials))
        for i, columns in enumerate(trials):
            more, _, _ = self._whitened(np.stack(columns, axis=2), scatter)
            # what of the columns the stated model cannot imitate, by its Gram matrix: small and quick
            shared = top.T @ more
            gram = more.T @ more - shared.T @ shared
            size = np.sqrt(np.maximum(np.diag(gram), 0.0))
            usable = size > 1.0e-6 * np.sqrt(np.maximum((more**2).sum(axis=0), 1.0e-300))
            if not usable.any():
                continue
            size = size[usable]
            along = (more.T @ rest)[usable] / size
            gram = gram[np.ix_(usable, usable)] / np.outer(size, size) + 1.0e-9 * np.eye(len(size))
            gains[i] = 0.5 * float(along @ np.linalg.solve(gram, along))
        return gains

    def parts(self, terms: Terms, scatter: Array) -> list[Part]:
        """Return what further regressors of single runs meet, run by run."""
        top, rest = self._rest(terms, scatter)
        items: list[Part] = []
        first = 0
        for run, rows in enumerate(self._rows):
            at = slice(first, first + N_FEATURES * len(rows))
            items.append(Part(run, self._whitening(run, scatter), top[at], rest[at]))
            first = at.stop
        return items

    def beyond(self, terms: Terms, scatter: Array, columns: Sequence[Array]) -> Array:
        """Return what the terms cannot imitate of further columns, whitened, shape (rows + p, len(columns)).

        The last p rows are what priors of the terms say against the imitation.
        """
        design, _, _ = self._whitened(terms.columns, scatter)
        more, _, _ = self._whitened(np.stack(columns, axis=2), scatter)
        basis, _ = np.linalg.qr(np.r_[design, np.diag(1.0 / terms.priors)])
        padded = np.r_[more, np.zeros((design.shape[1], len(columns)))]
        return padded - basis @ (basis.T @ padded)

    def _rest(self, terms: Terms, scatter: Array) -> tuple[Array, Array]:
        """Return an orthonormal basis of the whitened terms, and what they leave of the whitened features."""
        design, target, _ = self._whitened(terms.columns, scatter)
        weights = np.diag(1.0 / terms.priors)
        basis, _ = np.linalg.qr(np.r_[design, weights])
        rest = np.r_[target, np.zeros(len(weights))]
        rest = rest - basis @ (basis.T @ rest)
        return basis[: len(target)], rest[: len(target)]

    def residuals(self, terms: Terms, solution: Solution) -> Array:
        """Return the features less the model [N], shape (n, N_FEATURES), of all slips."""
        return self.pool.features - terms.columns @ solution.coefficients

    def covariance(self, run: int, scatter: Array) -> Array:
        """Return the covariance of the features in a run [N^2], shape (N_FEATURES, N_FEATURES)."""
        static, kinetic, white = np.exp(2.0 * np.asarray(scatter))
        covariance = self.pool.calibrations[run].covariance.copy()
        covariance[0, 0] += static
        covariance[1, 1] += kinetic
        covariance[1:, 1:] += white * np.diag(_WHITE)
        return covariance

    def _whitening(self, run: int, scatter: Array) -> Array:
        return np.asarray(np.linalg.inv(np.linalg.cholesky(self.covariance(run, scatter))), dtype=np.float64)

    def _whitened(self, columns: Array, scatter: Array) -> tuple[Array, Array, float]:
        designs: list[Array] = []
        targets: list[Array] = []
        volume = 0.0
        for r, rows in enumerate(self._rows):
            inverse = self._whitening(r, scatter)
            volume -= 2.0 * float(np.log(np.diag(inverse)).sum()) * len(rows)
            targets.append((self.pool.features[rows] @ inverse.T).ravel())
            designs.append((inverse @ columns[rows]).reshape(-1, columns.shape[2]))
        return np.concatenate(designs), np.concatenate(targets), volume


def believed(pool: Pool, uncertainty: dict[str, float]) -> Terms:
    """Return the terms of the model as stated: mu_s, mu_k, and errors of stiffness, mass and damping with their priors.

    Args:
        pool: the slips.
        uncertainty: relative standard deviations of what is believed.
    """

    def of(name: str) -> Array:
        return pool.per_run(lambda s: getattr(s.record.mechanism, name))

    stiffness, mass, damping = of("stiffness"), of("mass"), of("damping")
    priors = [max(uncertainty.get(name, 0.0), 1.0e-6) for name in ("stiffness", "mass", "damping")]
    columns = [
        pool.column(pool.normal_force, None),
        pool.column(None, pool.normal_force),
        pool.column(-pool.typical_onset * stiffness, -pool.typical_position * stiffness[:, None]),
        pool.column(None, -pool.node_acceleration * mass[:, None]),
        pool.column(-pool.belt_velocity * damping, -pool.node_velocity * damping[:, None]),
    ]
    assert all(c.shape[1] == N_FEATURES for c in columns)
    return Terms(np.stack(columns, axis=2), np.array([np.inf, np.inf, *priors]))
