"""A path of coefficients: pairs (mu_s, mu_k) addressed by (seed, sample, contact, knot), the same in every engine.

Compiled callers hold the *descriptor* (see `Process.descriptor`) and a *cursor*, a small array that remembers the knots
around the last evaluation. The cursor is a cache: results depend on the address alone, never on the order of
evaluation, the step size or the thread.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients.distributions import transform, truncated
from stochfric_mb.coefficients.philox import normals
from stochfric_mb.coefficients.processes import EVENT, HEADER, POSITION, TIME, Process
from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError
from stochfric_mb.laws.contract import Law

CURSOR = 10
"""Entries of a cursor: valid, knot, mu_s and mu_k at the knot, the same at the next knot, four filter states there."""
UNBOUNDED = 1.0e300
"""A bound beyond this is none; engines that keep descriptors in their state need finite numbers."""
MAX_ATTEMPTS = 10_000
"""Redraws of an infeasible pair before the means are taken."""


class CoefficientPath:
    """One realisation of the coefficients of one contact.

    >>> from stochfric_mb import ElasticStick, Knots
    >>> path = CoefficientPath(Knots(spacing=0.01, sigma_s=0.015, sigma_k=0.023), ElasticStick(mu_s=0.8, mu_k=0.46), seed=1)
    >>> mu_s, mu_k = path.at(0.005)
    >>> round(mu_s, 6), round(mu_k, 6)
    (0.806938, 0.445174)
    >>> path.at(0.003) == path.at(0.003) != path.at(0.005)  # the address counts, not the order of evaluation
    True
    """

    def __init__(self, process: Process | None, law: Law, *, seed: int = 0, sample: int = 0, contact: int = 0) -> None:
        """Address a path; without a process it is constant at the law's means.

        Args:
            process: the coefficient process, or None.
            law: the law whose mu_s, mu_k are the means.
            seed: first part of the address, an integer in [0, 2^32).
            sample: second part, likewise: the run of an ensemble.
            contact: third part, likewise: the contact of a model.

        Raises:
            InputError: an address outside its range, or means and deviations without feasible pairs.
        """
        for name, value in (("seed", seed), ("sample", sample), ("contact", contact)):
            if int(value) != value or not 0 <= value < 2**32:
                raise InputError(f"{name} = {value} is not an integer in [0, 2^32); choose one in that range")
        self.process = process
        self.seed, self.sample, self.contact = int(seed), int(sample), int(contact)
        self.descriptor: npt.NDArray[np.float64] = constant_descriptor(law) if process is None else process.descriptor(law)
        self._cursor = np.zeros(CURSOR)

    def at(self, t: float, position: float | None = None, events: int | None = None) -> tuple[float, float]:
        """Return (mu_s, mu_k) [-].

        Args:
            t: time [s].
            position: relative displacement (belt position) [m]; needed by processes along the belt alone.
            events: number of stick phases begun so far; needed by processes by event alone.

        Raises:
            InputError: the process runs along what was not given.
        """
        clock = TIME if self.process is None else self.process.clock
        if (clock == POSITION and position is None) or (clock == EVENT and events is None):
            what = (
                "position, the relative displacement [m]" if clock == POSITION else "events, the number of stick phases begun"
            )
            raise InputError(
                f"process {getattr(self.process, 'kind', '')} does not run along time; give {what}: path.at(t, ...)"
            )
        address = (self.seed, self.sample, self.contact)
        return evaluate(self.descriptor, self._cursor, *address, float(t), float(position or 0.0), float(events or 0))

    def at_times(self, times: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the pairs of a process along time at the given times [s], shape (n, 2).

        Raises:
            InputError: the process runs along the belt or by event.
        """
        given = np.ascontiguousarray(times, dtype=np.float64).reshape(-1)
        pairs = np.empty((len(given), 2))
        if len(given):
            self.at(float(given[0]))  # refuses what does not run along time
            _at_each(self.descriptor, self._cursor, self.seed, self.sample, self.contact, given, pairs)
        return pairs

    def pairs(self, n: int, first: int = 0) -> npt.NDArray[np.float64]:
        """Return the pairs at the ``n`` knots from ``first`` on, shape (n, 2)."""
        out = np.empty((n, 2))
        for i in range(n):
            seek(self.descriptor, self._cursor, self.seed, self.sample, self.contact, first + i)
            out[i] = self._cursor[2:4]
        return out

    def segment(self, knot: int) -> tuple[float, float, float, float]:
        """Return (mu_s, mu_k) at ``knot`` and at the next knot."""
        seek(self.descriptor, self._cursor, self.seed, self.sample, self.contact, knot)
        c = self._cursor
        return float(c[2]), float(c[3]), float(c[4]), float(c[5])


def constant_descriptor(law: Law) -> npt.NDArray[np.float64]:
    """Return the descriptor of constant coefficients."""
    descriptor = np.zeros(HEADER)
    descriptor[3:6] = 1.0, law.mu_s, law.mu_k
    return descriptor


@compiled
def canonical_time(t, half_step):
    """Return t [s] freed of the rounding of accumulated steps, so that equal times are equal to the bit.

    A time within 1e-4 of a multiple of ``half_step`` (half the engine's step, 0 if unknown) is taken as that multiple;
    a time within 1e-12 s of a whole nanosecond as that nanosecond.
    """
    if half_step > 0.0:
        n = math.floor(t / half_step + 0.5)
        if abs(t / half_step - n) < 1.0e-4:
            t = n * half_step
    q = math.floor(t * 1.0e9 + 0.5) / 1.0e9
    return q if abs(t - q) < 1.0e-12 else t


@compiled
def evaluate(descriptor, cursor, seed, sample, contact, t, position, events):
    """Return (mu_s, mu_k) [-]; ``cursor`` is a cache and may be moved."""
    if descriptor[0] == 0.0:
        return descriptor[4], descriptor[5]
    if descriptor[1] == 0.0:
        r = canonical_time(t, 0.0) / descriptor[3]
    elif descriptor[1] == 1.0:
        r = position / descriptor[3]
    else:
        r = events
    knot = math.floor(r)
    seek(descriptor, cursor, seed, sample, contact, knot)
    if descriptor[2] == 0.0:
        return cursor[2], cursor[3]
    w = r - knot
    return cursor[2] + w * (cursor[4] - cursor[2]), cursor[3] + w * (cursor[5] - cursor[3])


@compiled
def _at_each(descriptor, cursor, seed, sample, contact, times, pairs):
    for i in range(len(times)):
        pairs[i] = evaluate(descriptor, cursor, seed, sample, contact, times[i], 0.0, 0.0)


@compiled
def seek(descriptor, cursor, seed, sample, contact, knot):
    """Move the cursor to ``knot``: its pair and the next one's."""
    if cursor[0] == 1.0 and cursor[1] == knot:
        return
    if descriptor[0] <= 1.0:
        if cursor[0] == 1.0 and cursor[1] + 1.0 == knot:
            cursor[2], cursor[3] = cursor[4], cursor[5]
        else:
            cursor[2], cursor[3] = independent_pair(descriptor, seed, sample, contact, knot)
        cursor[4], cursor[5] = independent_pair(descriptor, seed, sample, contact, knot + 1)
    else:
        if cursor[0] == 0.0 or cursor[1] > knot:
            _start_filter(descriptor, cursor, seed, sample, contact)
        for next_knot in range(int(cursor[1]) + 2, int(knot) + 2):
            _advance_filter(descriptor, cursor, seed, sample, contact, next_knot)
    cursor[0] = 1.0
    cursor[1] = knot


@compiled
def independent_pair(descriptor, seed, sample, contact, knot):
    """Return the feasible pair at ``knot``: draws are repeated until 0 <= mu_k < mu_s and both are within bounds."""
    if descriptor[0] == 0.0:
        return descriptor[4], descriptor[5]
    for attempt in range(MAX_ATTEMPTS):
        z_s, z_k = normals(seed, sample, contact, knot, attempt)
        mu_s, mu_k = _pair_of_normals(descriptor, z_s, mixed(descriptor, z_s, z_k))
        inside = descriptor[10] <= mu_s <= descriptor[11] and descriptor[12] <= mu_k <= descriptor[13]
        if inside and mu_k >= 0.0 and mu_k < mu_s:
            return mu_s, mu_k
    return descriptor[4], descriptor[5]


@compiled
def mixed(descriptor, z_s, z_k):
    """Return the normal of mu_k, whose correlation with that of mu_s is the descriptor's, from two independent ones."""
    return descriptor[17] * z_s + math.sqrt(1.0 - descriptor[17] * descriptor[17]) * z_k


@compiled
def _pair_of_normals(descriptor, z_s, z_k):
    n_s = int(descriptor[15])
    n_k = int(descriptor[16])
    mu_s = transform(z_s, descriptor[8], descriptor[4], descriptor[6], descriptor, HEADER, n_s)
    mu_k = transform(z_k, descriptor[9], descriptor[5], descriptor[7], descriptor, HEADER + n_s, n_k)
    return mu_s, mu_k


@compiled
def _clipped_pair(descriptor, z_s, z_k):
    """Return the pair clipped to 0 <= mu_k <= mu_s (correlated processes cannot be redrawn); bounds truncate."""
    y_k = mixed(descriptor, z_s, z_k)
    mu_s, mu_k = _pair_of_normals(descriptor, z_s, y_k)
    if descriptor[10] > -UNBOUNDED or descriptor[11] < UNBOUNDED:
        mu_s = truncated(z_s, descriptor[4], descriptor[6], descriptor[10], descriptor[11])
    if descriptor[12] > -UNBOUNDED or descriptor[13] < UNBOUNDED:
        mu_k = truncated(y_k, descriptor[5], descriptor[7], descriptor[12], descriptor[13])
    mu_s = max(mu_s, 0.0)
    return mu_s, min(max(mu_k, 0.0), mu_s)


@compiled
def _start_filter(descriptor, cursor, seed, sample, contact):
    """Set the cursor to knot 0 of a correlated process, in its stationary state."""
    z_s, z_k = normals(seed, sample, contact, 0, 0)
    y_s, y_k = normals(seed, sample, contact, 0, 1)
    rate = math.sqrt(3.0) / descriptor[14]
    cursor[2], cursor[3] = _clipped_pair(descriptor, z_s, z_k)
    cursor[4], cursor[5] = cursor[2], cursor[3]
    cursor[6], cursor[7], cursor[8], cursor[9] = z_s, rate * y_s, z_k, rate * y_k
    cursor[0] = 1.0
    cursor[1] = -1.0
    _advance_filter(descriptor, cursor, seed, sample, contact, 1)
    cursor[1] = 0.0


@compiled
def _advance_filter(descriptor, cursor, seed, sample, contact, knot):
    """Move the pair at the next knot to the pair at this one, and draw the one at ``knot`` from the filter."""
    cursor[2], cursor[3] = cursor[4], cursor[5]
    z_s, z_k = normals(seed, sample, contact, knot, 0)
    if descriptor[0] == 2.0:
        a = math.exp(-descriptor[3] / descriptor[14])
        b = math.sqrt(1.0 - a * a)
        cursor[6] = a * cursor[6] + b * z_s
        cursor[8] = a * cursor[8] + b * z_k
    else:
        y_s, y_k = normals(seed, sample, contact, knot, 1)
        cursor[6], cursor[7] = matern_step(cursor[6], cursor[7], descriptor[3], descriptor[14], z_s, y_s)
        cursor[8], cursor[9] = matern_step(cursor[8], cursor[9], descriptor[3], descriptor[14], z_k, y_k)
    cursor[4], cursor[5] = _clipped_pair(descriptor, cursor[6], cursor[8])


@compiled
def matern_step(f, g, h, correlation, z, y):
    """Return value and derivative of a unit Matern-3/2 process after h: exact transition and exact noise covariance."""
    rate = math.sqrt(3.0) / correlation
    e = math.exp(-rate * h)
    a11, a12 = e * (1.0 + rate * h), e * h
    a21, a22 = -e * rate * rate * h, e * (1.0 - rate * h)
    q11 = 1.0 - (a11 * a11 + a12 * a12 * rate * rate)
    q12 = -(a11 * a21 + a12 * a22 * rate * rate)
    q22 = rate * rate - (a21 * a21 + a22 * a22 * rate * rate)
    l11 = math.sqrt(max(q11, 0.0))
    l21 = q12 / l11 if l11 > 0.0 else 0.0
    l22 = math.sqrt(max(q22 - l21 * l21, 0.0))
    return a11 * f + a12 * g + l11 * z, a21 * f + a22 * g + l21 * z + l22 * y
