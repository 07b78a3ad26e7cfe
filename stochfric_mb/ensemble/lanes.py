"""Samples side by side: LANES of them in a group, one array entry each.

A group is always full: lanes beyond the last sample of a block compute samples that nobody reads. All arithmetic is
plain IEEE (with explicit fused multiply-adds, never the compiler's choice), so that a sample has the same bits in
every lane, block and thread.

The loops over lanes vectorise when they have no branches and call nothing from a system's libm. Hence the sine and the
exponential below, and the laws' formulas without branches in the kernels; tests hold them against the laws' own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from stochfric_mb.coefficients.path import independent_pair, matern_step, mixed, seek
from stochfric_mb.coefficients.philox import bits_of, double_of, normals
from stochfric_mb.coefficients.processes import ORNSTEIN_UHLENBECK
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.numerics.memory import instructions

LANES = 64
"""Samples in a group."""
_BIAS = np.uint64(1023)
_MANTISSA_BITS = np.uint64(52)
NORMAL_CODE = 0.0
"""Code of the distributions that are mean + sigma z."""

# Rows of a group's flat array: position, velocity, pair at the knot, pair at the next knot; a kernel's own rows follow
X, V, A_S, A_K, B_S, B_K = (LANES * i for i in range(6))
SHARED_ROWS = 6
# Rows of a group's tallies
BREAK_AWAYS, FIRST, LAST, MU_S_SUM, STICK_TIME = range(5)
TALLIES = 5
"""Numbers kept of each run: break-aways, times of the first and the last one, sum of mu_s there, time stuck."""
# Rows of what is open in a run: is a slip open, where and when it began, mu_s there; is stick open, since when
SLIP_OPEN, SLIP_TIME, SLIP_PLACE, SLIP_MU_S, STICK_SINCE = range(5)
OPEN = 5


@compiled
def aligned(n):
    """Return n zeros that start on a cache line (a vector that straddles two lines costs up to three times as much)."""
    room = np.zeros(n + 8)
    skip = (-room.ctypes.data) % 64 // 8
    return room[skip : skip + n]


fma = instructions(types.float64(*[types.float64] * 3), lambda _context, builder, _signature, args: builder.fma(*args))
"""Return a b + c with one rounding."""


@compiled_inline
def sine(y):
    """Return sin(y) for abs(y) <= pi/2, to 3e-16."""
    z = y * y
    s = fma(z, -1.0 / 121645100408832000.0, 1.0 / 355687428096000.0)
    s = fma(z, s, -1.0 / 1307674368000.0)
    s = fma(z, s, 1.0 / 6227020800.0)
    s = fma(z, s, -1.0 / 39916800.0)
    s = fma(z, s, 1.0 / 362880.0)
    s = fma(z, s, -1.0 / 5040.0)
    s = fma(z, s, 1.0 / 120.0)
    s = fma(z, s, -1.0 / 6.0)
    return fma(y * z, s, y)


@compiled_inline
def exponential(y):
    """Return exp(y) for y <= 0 to 3e-16 of its value; below -700, exp(-700), which is no number that matters."""
    y = y if y > -700.0 else -700.0
    n = math.floor(y * 1.4426950408889634 + 0.5)
    r = fma(-n, 1.9082149292705877e-10, fma(-n, 0.6931471803691238, y))
    s = fma(r, 1.0 / 479001600.0, 1.0 / 39916800.0)
    s = fma(r, s, 1.0 / 3628800.0)
    s = fma(r, s, 1.0 / 362880.0)
    s = fma(r, s, 1.0 / 40320.0)
    s = fma(r, s, 1.0 / 5040.0)
    s = fma(r, s, 1.0 / 720.0)
    s = fma(r, s, 1.0 / 120.0)
    s = fma(r, s, 1.0 / 24.0)
    s = fma(r, s, 1.0 / 6.0)
    s = fma(r, s, 0.5)
    s = fma(r, s, 1.0)
    s = fma(r, s, 1.0)
    # adding 1.5 2^52 leaves n in the low bits, where it can be moved into the exponent without a conversion
    return s * double_of((bits_of(n + 6755399441055744.0) + _BIAS) << _MANTISSA_BITS)


@compiled
def first_pairs(descriptor, cursors, seed, first, a_s, a_k, b_s, b_k):
    """Write the pairs at knots 0 (a) and 1 (b) of every lane."""
    _pairs(descriptor, cursors, seed, first, 0, b_s, b_k)
    next_pairs(descriptor, cursors, seed, first, 0, a_s, a_k, b_s, b_k)


@compiled
def next_pairs(descriptor, cursors, seed, first, knot, a_s, a_k, b_s, b_k):
    """Move every lane to ``knot``: its pair, which was the next one so far, to a, and the one after it to b."""
    for j in range(LANES):
        a_s[j] = b_s[j]
        a_k[j] = b_k[j]
    _pairs(descriptor, cursors, seed, first, knot + 1, b_s, b_k)


@compiled
def _pairs(descriptor, cursors, seed, first, knot, mu_s, mu_k):
    """Write the pair at ``knot`` of every lane, to the bit the one of a `CoefficientPath`."""
    normal = descriptor[8] == NORMAL_CODE and descriptor[9] == NORMAL_CODE
    bounded = max(descriptor[10], descriptor[12], -descriptor[11], -descriptor[13]) > -math.inf
    if descriptor[0] > 1.0 and normal and not bounded and knot > 0:
        _filtered_pairs(descriptor, cursors, seed, first, knot, mu_s, mu_k)
    elif descriptor[0] > 1.0:
        for j in range(LANES):
            seek(descriptor, cursors[j], seed, first + j, 0, knot)
            mu_s[j] = cursors[j, 2]
            mu_k[j] = cursors[j, 3]
    elif descriptor[0] == 1.0 and normal:
        if _normal_pairs(descriptor, seed, first, knot, mu_s, mu_k) < LANES:
            for j in range(LANES):
                mu_s[j], mu_k[j] = independent_pair(descriptor, seed, first + j, 0, knot)
    else:
        for j in range(LANES):
            mu_s[j], mu_k[j] = independent_pair(descriptor, seed, first + j, 0, knot)


@compiled
def _normal_pairs(descriptor, seed, first, knot, mu_s, mu_k):
    """Write the first draw at ``knot`` of every lane; return how many of them are feasible."""
    mean_s, mean_k, sigma_s, sigma_k = descriptor[4], descriptor[5], descriptor[6], descriptor[7]
    low_s, high_s, low_k, high_k = descriptor[10], descriptor[11], max(descriptor[12], 0.0), descriptor[13]
    shared, own = descriptor[17], math.sqrt(1.0 - descriptor[17] * descriptor[17])
    feasible = 0
    for j in range(LANES):
        z_s, z_k = normals(seed, first + j, 0, knot, 0)
        s = mean_s + sigma_s * z_s
        k = mean_k + sigma_k * (shared * z_s + own * z_k)
        mu_s[j] = s
        mu_k[j] = k
        feasible += 1 if (low_s <= s) & (s <= high_s) & (low_k <= k) & (k <= high_k) & (k < s) else 0
    return feasible


@compiled
def _filtered_pairs(descriptor, cursors, seed, first, knot, mu_s, mu_k):
    """Write the pairs at ``knot`` >= 1 of a correlated process; the knot before was asked for last.

    Columns 6 to 9 of the cursors hold the filters' states at the last knot drawn; knot 1 is in columns 4 and 5 already.
    """
    if knot == 1:
        for j in range(LANES):
            mu_s[j], mu_k[j] = cursors[j, 4], cursors[j, 5]
        return
    factors = _filter_factors(descriptor)
    f_s, g_s, f_k, g_k = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty(LANES)
    for j in range(LANES):
        f_s[j], g_s[j], f_k[j], g_k[j] = cursors[j, 6], cursors[j, 7], cursors[j, 8], cursors[j, 9]
    if descriptor[0] == ORNSTEIN_UHLENBECK:
        _exponential_filter(factors, seed, first, knot, f_s, f_k)
    else:
        _matern_filter(factors, seed, first, knot, f_s, g_s, f_k, g_k)
    for j in range(LANES):
        cursors[j, 6], cursors[j, 7], cursors[j, 8], cursors[j, 9] = f_s[j], g_s[j], f_k[j], g_k[j]
    for j in range(LANES):
        s = max(descriptor[4] + descriptor[6] * f_s[j], 0.0)
        mu_s[j] = s
        mu_k[j] = min(max(descriptor[5] + descriptor[7] * mixed(descriptor, f_s[j], f_k[j]), 0.0), s)


@compiled
def _filter_factors(descriptor):
    """Return what one step of the process's filter multiplies (f, g, z, y) by, for the new f and the new g.

    Those of Matern come from its own step, which is linear: unit vectors in, columns out, to the bit.
    """
    h, correlation = descriptor[3], descriptor[14]
    if descriptor[0] == ORNSTEIN_UHLENBECK:
        a = math.exp(-h / correlation)
        return a, 0.0, math.sqrt(1.0 - a * a), 0.0, 0.0, 0.0, 0.0
    a11, a21 = matern_step(1.0, 0.0, h, correlation, 0.0, 0.0)
    a12, a22 = matern_step(0.0, 1.0, h, correlation, 0.0, 0.0)
    l11, l21 = matern_step(0.0, 0.0, h, correlation, 1.0, 0.0)
    _, l22 = matern_step(0.0, 0.0, h, correlation, 0.0, 1.0)
    return a11, a12, l11, a21, a22, l21, l22


@compiled
def _exponential_filter(factors, seed, first, knot, f_s, f_k):
    a, b = factors[0], factors[2]
    for j in range(LANES):
        z_s, z_k = normals(seed, first + j, 0, knot, 0)
        f_s[j] = a * f_s[j] + b * z_s
        f_k[j] = a * f_k[j] + b * z_k


@compiled
def _matern_filter(factors, seed, first, knot, f_s, g_s, f_k, g_k):
    a11, a12, l11, a21, a22, l21, l22 = factors
    for j in range(LANES):
        z_s, z_k = normals(seed, first + j, 0, knot, 0)
        y_s, y_k = normals(seed, first + j, 0, knot, 1)
        f, g = f_s[j], g_s[j]
        f_s[j] = a11 * f + a12 * g + l11 * z_s
        g_s[j] = a21 * f + a22 * g + l21 * z_s + l22 * y_s
        f, g = f_k[j], g_k[j]
        f_k[j] = a11 * f + a12 * g + l11 * z_k
        g_k[j] = a21 * f + a22 * g + l21 * z_k + l22 * y_k


@compiled
def begin(tally, pending, j, stuck):
    """Start the books of lane j at t = 0."""
    tally[BREAK_AWAYS, j] = 0.0
    tally[FIRST, j] = np.nan
    tally[LAST, j] = np.nan
    tally[MU_S_SUM, j] = 0.0
    tally[STICK_TIME, j] = 0.0
    pending[SLIP_OPEN, j] = 0.0
    pending[STICK_SINCE, j] = 0.0 if stuck else np.nan


@compiled
def note_break_away(tally, pending, j, t, place, mu_s):
    """Note that lane j leaves stick at time t and relative displacement ``place``; it counts once it has slid far enough."""
    tally[STICK_TIME, j] += t - pending[STICK_SINCE, j]
    pending[STICK_SINCE, j] = np.nan
    pending[SLIP_OPEN, j] = 1.0
    pending[SLIP_TIME, j] = t
    pending[SLIP_PLACE, j] = place
    pending[SLIP_MU_S, j] = mu_s


@compiled
def note_slip_end(tally, pending, j, t, place, least_slip, sticks):
    """Note that lane j sticks or turns over; the slip counts as a break-away if it went ``least_slip`` or further."""
    if pending[SLIP_OPEN, j] == 1.0 and abs(place - pending[SLIP_PLACE, j]) >= least_slip:
        if tally[BREAK_AWAYS, j] == 0.0:
            tally[FIRST, j] = pending[SLIP_TIME, j]
        tally[BREAK_AWAYS, j] += 1.0
        tally[LAST, j] = pending[SLIP_TIME, j]
        tally[MU_S_SUM, j] += pending[SLIP_MU_S, j]
    pending[SLIP_OPEN, j] = 0.0
    if sticks:
        pending[STICK_SINCE, j] = t


@compiled
def close(tally, pending, j, t, place, least_slip):
    """Close the books of lane j at the end of the run."""
    if pending[STICK_SINCE, j] == pending[STICK_SINCE, j]:
        tally[STICK_TIME, j] += t - pending[STICK_SINCE, j]
    note_slip_end(tally, pending, j, t, place, least_slip, False)


@compiled
def note_crossings(t, h, v_b, level, positions, velocities, before, mu_s, tally, pending, least_slip):
    """Note the lanes whose speed passed ``level`` [m/s], or that turned over, within the step from t to t + h."""
    end = t + h
    for j in range(LANES):
        was, now = v_b - before[j], v_b - velocities[j]
        sticks, stuck = abs(now) <= level, abs(was) <= level
        if stuck and not sticks:
            at = t + h * (math.copysign(level, now) - was) / (now - was)
            place = v_b * at - (positions[j] - velocities[j] * (end - at))
            note_break_away(tally, pending, j, at, place, mu_s[j])
        elif sticks and not stuck:
            at = t + h * (math.copysign(level, was) - was) / (now - was)
            note_slip_end(tally, pending, j, at, v_b * end - positions[j], least_slip, True)
        elif was * now < 0.0 and not sticks:
            note_slip_end(tally, pending, j, end, v_b * end - positions[j], least_slip, False)
