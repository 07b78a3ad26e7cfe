"""Generalised least squares of the slips' features, with variance components that are always on.

The features of a slip scatter with covariance C_run (from calibration) plus what friction itself may scatter: sigma_s^2
on the onset force, sigma_k^2 on the mean force in slip, and white scatter within the slip, sigma_w^2 (2 q + 1) on the
coefficient of order q; all three over the median normal force. Mass, stiffness and damping are regressors with the priors
that the scenario states. Negative log likelihoods are up to a constant that all models share.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, N_MOMENTS

LOWEST, HIGHEST = -9.565, -1.565
"""Range of the logarithms of the variance components, standard deviations over the normal force."""
START = np.array([-5.565, -5.565, -6.565])
"""Where the search for them begins: coefficients that scatter by 0.004."""
_WHITE = 2.0 * np.arange(N_MOMENTS) + 1.0


@dataclasses.dataclass(frozen=True)
class Terms:
    """Regressors of a model."""

    columns: Array
    """What each changes in the features for a unit of its coefficient [N], shape (n, N_FEATURES, p)."""
    priors: Array
    """Prior deviation of each coefficient, shape (p,); inf: free."""
    taken_at: Array
    """Coefficients of the first ones with which the features were taken, shape (q,), q <= p: the others' are 0."""

    def target(self, features: Array) -> Array:
        """Return what the terms are to explain [N], shape (n, N_FEATURES)."""
        return features + self.columns[..., : len(self.taken_at)] @ self.taken_at

    def plus(self, columns: Sequence[Array], priors: Array | None = None) -> Terms:
        """Return these terms and further ones, free if no deviations are given."""
        if not len(columns):
            return self
        more = np.full(len(columns), np.inf) if priors is None else priors
        return Terms(np.concatenate([self.columns, np.stack(columns, axis=2)], axis=2), np.r_[self.priors, more], self.taken_at)


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
    """Logarithms of sigma_s, sigma_k, sigma_w over the median normal force, shape (3,)."""


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
        self.load = float(np.median(pool.normal_force))
        self._rows = pool.rows

    @property
    def n(self) -> int:
        """Number of slips in the fits."""
        return sum(map(len, self._rows))

    def solve(self, terms: Terms, scatter: Array) -> Solution:
        """Return the best coefficients for given variance components."""
        target = self._white(terms.target(self.pool.features)[..., None], scatter)[:, 0]
        design = self._white(terms.columns, scatter)
        precision = 1.0 / terms.priors**2
        size = np.sqrt((design**2).sum(axis=0) + precision)
        scale = np.where(size > 0.0, size, 1.0)  # what marks no slip has no size
        scaled = design / scale
        normal = scaled.T @ scaled + np.diag(precision / scale**2)
        # a touch of ridge keeps regressors that the data cannot separate from blowing up
        inverse = np.linalg.inv(normal + 1.0e-10 * np.eye(len(scale)))
        fitted = inverse @ (scaled.T @ target)
        residual = target - scaled @ fitted
        coefficients = fitted / scale
        cost = 0.5 * (residual @ residual + (coefficients**2 * precision).sum()) + 0.5 * self._volume(scatter)
        return Solution(float(cost), coefficients, np.sqrt(np.diag(inverse)) / scale, np.asarray(scatter, dtype=np.float64))

    def fit(self, terms: Terms, start: Array | None = None) -> Solution:
        """Return the best coefficients and variance components, by coordinate search from ``start``."""
        best = self.solve(terms, START if start is None else start)
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
            more = self._white(np.stack(columns, axis=2), scatter)
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
        design = self._white(terms.columns, scatter)
        more = self._white(np.stack(columns, axis=2), scatter)
        basis, _ = np.linalg.qr(np.r_[design, np.diag(1.0 / terms.priors)])
        padded = np.r_[more, np.zeros((design.shape[1], len(columns)))]
        return padded - basis @ (basis.T @ padded)

    def _rest(self, terms: Terms, scatter: Array) -> tuple[Array, Array]:
        """Return an orthonormal basis of the whitened terms, and what they leave of the whitened features."""
        target = self._white(terms.target(self.pool.features)[..., None], scatter)[:, 0]
        design = self._white(terms.columns, scatter)
        weights = np.diag(1.0 / terms.priors)
        basis, _ = np.linalg.qr(np.r_[design, weights])
        rest = np.r_[target, np.zeros(len(weights))]
        rest = rest - basis @ (basis.T @ rest)
        return basis[: len(target)], rest[: len(target)]

    def covariance(self, run: int, scatter: Array) -> Array:
        """Return the covariance of the features in a run [N^2], shape (N_FEATURES, N_FEATURES)."""
        static, kinetic, white = (self.load * np.exp(np.asarray(scatter))) ** 2
        covariance = self.pool.calibrations[run].covariance.copy()
        covariance[0, 0] += static
        covariance[1, 1] += kinetic
        covariance[1:, 1:] += white * np.diag(_WHITE)
        return covariance

    def _whitening(self, run: int, scatter: Array) -> Array:
        return np.asarray(np.linalg.inv(np.linalg.cholesky(self.covariance(run, scatter))), dtype=np.float64)

    def _volume(self, scatter: Array) -> float:
        """Return the logarithm of the determinant of the covariance of all features."""
        factors = (np.diag(self._whitening(r, scatter)) for r in range(self.pool.n_runs))
        return sum(-2.0 * float(np.log(f).sum()) * len(rows) for f, rows in zip(factors, self._rows, strict=True))

    def _white(self, columns: Array, scatter: Array) -> Array:
        """Return columns, shape (n, N_FEATURES, p), of the kept slips in units of their errors, shape (rows, p)."""
        whitened = [self._whitening(r, scatter) @ columns[rows] for r, rows in enumerate(self._rows)]
        return np.concatenate(whitened).reshape(-1, columns.shape[2])


@dataclasses.dataclass(frozen=True)
class Baseline:
    """A model's terms fitted to slips, as measured or as effects leave them: what further terms are held against."""

    regression: Regression
    """Fits to the slips."""
    terms: Terms
    """The terms."""
    solution: Solution
    """Their fit."""

    @property
    def pool(self) -> Pool:
        """The slips."""
        return self.regression.pool

    @property
    def n_terms(self) -> int:
        """Number of its coefficients, which stand before those of further terms."""
        return self.terms.columns.shape[2]

    @property
    def price(self) -> float:
        """Evidence that each further number costs, the logarithm of the number of slips [-]."""
        return float(np.log(self.regression.n))

    @property
    def variance(self) -> float:
        """Variance of both forces of a slip about the fit, over the normal force [-]."""
        return float(np.exp(2.0 * self.solution.scatter[:2]).sum())

    def residuals(self) -> Array:
        """Return the features less the fit [N], shape (n, N_FEATURES), of all slips."""
        return self.terms.target(self.pool.features) - self.terms.columns @ self.solution.coefficients

    def gains(self, trials: Sequence[Sequence[Array]]) -> Array:
        """Return by how much each trial's further columns lower the cost at the same scatter, shape (len(trials),)."""
        return self.regression.gains(self.terms, self.solution.scatter, trials)

    def solved(self, columns: Sequence[Array]) -> Solution:
        """Return the fit with further columns at the same scatter."""
        return self.regression.solve(self.terms.plus(columns), self.solution.scatter)

    def fitted(self, columns: Sequence[Array], priors: Array | None = None) -> Solution:
        """Return the fit with further columns and the scatter that they leave."""
        return self.regression.fit(self.terms.plus(columns, priors), self.solution.scatter)

    def plus(self, columns: Sequence[Array]) -> Baseline:
        """Return the baseline with further terms, fitted."""
        return Baseline(self.regression, self.terms.plus(columns), self.fitted(columns))

    def of(self, kept: np.ndarray) -> Baseline:
        """Return the same terms fitted to some of the slips, where ``kept`` is true, shape (n,)."""
        regression = Regression(dataclasses.replace(self.pool, kept=kept))
        return Baseline(regression, self.terms, regression.fit(self.terms, self.solution.scatter))


def baseline_of(
    pool: Pool, uncertainty: Mapping[str, float], start: Array | None = None, more: Sequence[Array] = ()
) -> Baseline:
    """Return the stated model fitted to slips.

    Args:
        pool: the slips.
        uncertainty: relative standard deviations of the stated numbers.
        start: variance components from which the fit begins; the usual ones if not given.
        more: columns of further terms.
    """
    regression, terms = Regression(pool), stated_terms(pool, uncertainty).plus(more)
    return Baseline(regression, terms, regression.fit(terms, start))


def stated_terms(pool: Pool, uncertainty: Mapping[str, float]) -> Terms:
    """Return the terms of the model as stated: mu_s, mu_k, and errors of stiffness, mass and damping with their priors.

    Args:
        pool: the slips.
        uncertainty: relative standard deviations of the stated numbers.
    """

    def of(name: str) -> Array:
        return pool.per_run(lambda s: getattr(s.record.stated, name))

    stiffness, _, damping = map(of, CORRECTED)
    priors = [max(uncertainty.get(name, 0.0), 1.0e-6) for name in CORRECTED]
    taken_at = np.array([0.0, 0.0, *pool.slips[0].record.corrections.values()])
    static, kinetic = pool.column(pool.normal_force, None), pool.column(None, pool.normal_force)
    spring = pool.column(pool.typical_onset * stiffness, pool.typical_position * stiffness[:, None])
    damper = pool.column(pool.belt_velocity * damping, pool.node_velocity * damping[:, None])
    # what friction leaves of spring, damper and known force: an acceleration as measured errs, and a rig of which all forces
    # are a share less, errors and misfit too, would fit better, though nothing in a motion shows how large the forces are
    levels = (float(np.median(force / pool.normal_force)) for force in (pool.static, pool.kinetic))
    inertia = sum(level * column for level, column in zip(levels, (static, kinetic), strict=True)) - spring - damper
    inertia += pool.column(_known(pool, pool.onset_time[:, None])[:, 0], _known(pool, pool.node_time))
    columns = [static, kinetic, -spring, -inertia, -damper]
    return Terms(np.stack(columns, axis=2), np.array([np.inf, np.inf, *priors]), taken_at)


def _known(pool: Pool, time: Array) -> Array:
    """Return the known force [N] at times in the slips [s], shape (n, m) each."""
    force = np.zeros_like(time)
    for run, slips in enumerate(pool.slips):
        force[pool.run == run] = slips.record.excitation(time[pool.run == run])
    return force
