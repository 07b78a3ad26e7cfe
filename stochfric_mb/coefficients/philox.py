"""Counter-based random numbers: Philox4x32-10, and standard normals from it by Box-Muller.

A draw is a pure function of (seed, sample, contact, knot, attempt): counter = (knot low word, knot high word, contact,
attempt), key = (sample, seed); negative knots as two's complement. Uniforms u = (k + 1/2) 2^-53 with
k = ((w1 << 32) + w0) >> 11 and the same of w2, w3. Logarithm, sine and cosine are polynomials of plain IEEE
operations, accurate to about one unit in the last place, so that the bits do not depend on a system's libm or on
whether a loop was vectorised.

Reference: J. Salmon, M. Moraes, R. Dror, D. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC'11,
doi 10.1145/2063384.2063405.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np
from llvmlite import ir
from numba import float64, int64, types, uint64

from stochfric_mb.compile import compiled_inline
from stochfric_mb.numerics.memory import instructions

_LOW = np.uint64(0xFFFFFFFF)
_32 = np.uint64(32)
_11 = np.uint64(11)
_52 = np.uint64(52)
_MULTIPLIER_0 = np.uint64(0xD2511F53)
_MULTIPLIER_1 = np.uint64(0xCD9E8D57)
_WEYL_0 = np.uint64(0x9E3779B9)
_WEYL_1 = np.uint64(0xBB67AE85)
_MANTISSA = np.uint64(0x000FFFFFFFFFFFFF)
_ONE = np.uint64(0x3FF0000000000000)


@compiled_inline
def philox4x32(c0, c1, c2, c3, k0, k1):
    """Return the four 32-bit output words (as uint64) of ten Philox rounds on a counter and a key of 32-bit words."""
    for _ in range(10):
        product_0 = _MULTIPLIER_0 * c0
        product_1 = _MULTIPLIER_1 * c2
        c0, c1, c2, c3 = (product_1 >> _32) ^ c1 ^ k0, product_1 & _LOW, (product_0 >> _32) ^ c3 ^ k1, product_0 & _LOW
        k0 = (k0 + _WEYL_0) & _LOW
        k1 = (k1 + _WEYL_1) & _LOW
    return c0, c1, c2, c3


@compiled_inline
def uniforms(seed, sample, contact, knot, attempt):
    """Return two uniforms in (0, 1] for the given address (all integers)."""
    word = uint64(int64(knot))
    w0, w1, w2, w3 = philox4x32(
        word & _LOW, word >> _32, uint64(contact) & _LOW, uint64(attempt) & _LOW, uint64(sample) & _LOW, uint64(seed) & _LOW
    )
    u1 = (float64(((w1 << _32) + w0) >> _11) + 0.5) * 1.1102230246251565e-16
    u2 = (float64(((w3 << _32) + w2) >> _11) + 0.5) * 1.1102230246251565e-16
    return u1, u2


@compiled_inline
def normals(seed, sample, contact, knot, attempt):
    """Return two independent standard normals for the given address: Box-Muller, cosine first."""
    u1, u2 = uniforms(seed, sample, contact, knot, attempt)
    radius = math.sqrt(-2.0 * _log(u1))
    angle = 6.283185307179586 * (u2 - 0.5)
    inner = angle if abs(angle) <= 1.5707963267948966 else math.copysign(3.141592653589793, angle) - angle
    return -radius * _sin(1.5707963267948966 - abs(angle)), -radius * _sin(inner)


bits_of = instructions(types.uint64(types.float64), lambda _c, builder, _s, args: builder.bitcast(args[0], ir.IntType(64)))
"""Return the 64 bits of a double as an unsigned integer."""
double_of = instructions(types.float64(types.uint64), lambda _c, builder, _s, args: builder.bitcast(args[0], ir.DoubleType()))
"""Return the double with the given 64 bits."""


@compiled_inline
def _log(x):
    """Return the natural logarithm of a normal positive double."""
    bits = bits_of(x)
    exponent = float64(int64(bits >> _52) - 1023)
    mantissa = double_of((bits & _MANTISSA) | _ONE)
    if mantissa > 1.4142135623730951:
        mantissa *= 0.5
        exponent += 1.0
    s = (mantissa - 1.0) / (mantissa + 1.0)
    z = s * s
    series = 1.0 / 19.0 + z * (1.0 / 21.0)
    series = 1.0 / 15.0 + z * (1.0 / 17.0 + z * series)
    series = 1.0 / 11.0 + z * (1.0 / 13.0 + z * series)
    series = 1.0 / 7.0 + z * (1.0 / 9.0 + z * series)
    series = 1.0 / 3.0 + z * (1.0 / 5.0 + z * series)
    return exponent * 0.6931471805599453 + 2.0 * s * (1.0 + z * series)


@compiled_inline
def _sin(y):
    """Return sin(y) for abs(y) <= pi/2."""
    z = y * y
    series = -1.0 / 121645100408832000.0 + z * (1.0 / 51090942171709440000.0)
    series = -1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0 + z * series)
    series = -1.0 / 39916800.0 + z * (1.0 / 6227020800.0 + z * series)
    series = -1.0 / 5040.0 + z * (1.0 / 362880.0 + z * series)
    series = -1.0 / 6.0 + z * (1.0 / 120.0 + z * series)
    return y + y * (z * series)
