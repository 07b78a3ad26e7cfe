"""What functions of Python's math, of NumPy and of numba become in C."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from stochfric_mb.c.types import BOOL, DOUBLE, DUAL, INT, UNSIGNED, VOID, Array, Known, Scalar, Value, as_c, plain
from stochfric_mb.coefficients import philox
from stochfric_mb.effects.abi import call_effect
from stochfric_mb.laws.abi import call_law
from stochfric_mb.numerics.memory import as_doubles

PRELUDE = """\
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The whole number that a real stands for; 0 where there is none of 64 bits, so that nothing is undefined. */
static inline int64_t to_int(double x) { return x > -9.2e18 && x < 9.2e18 ? (int64_t)x : 0; }
static inline double largest(double a, double b) { return b > a ? b : a; }
static inline double smallest(double a, double b) { return b < a ? b : a; }
static inline int64_t largest_int(int64_t a, int64_t b) { return b > a ? b : a; }
static inline int64_t smallest_int(int64_t a, int64_t b) { return b < a ? b : a; }
static inline uint64_t bits_of(double x) { uint64_t bits; memcpy(&bits, &x, sizeof bits); return bits; }
static inline double double_of(uint64_t bits) { double x; memcpy(&x, &bits, sizeof x); return x; }
static inline double *doubles_at(int64_t address) { return (double *)(intptr_t)address; }

/* x to a whole power, by squaring. */
static inline double whole_power(double x, int n) {
    double result = 1.0;
    for (; n > 0; n >>= 1) {
        if (n & 1) result *= x;
        x *= x;
    }
    return result;
}
"""
"""What every translation begins with."""

DUALS = """\
/* Numbers with their derivatives along one direction. */
typedef struct { double v, d; } dual;
static inline dual dual_of(double v) { return (dual){v, 0.0}; }
static inline dual dual_negative(dual a) { return (dual){-a.v, -a.d}; }
static inline dual dual_sum(dual a, dual b) { return (dual){a.v + b.v, a.d + b.d}; }
static inline dual dual_difference(dual a, dual b) { return (dual){a.v - b.v, a.d - b.d}; }
static inline dual dual_product(dual a, dual b) { return (dual){a.v * b.v, a.d * b.v + a.v * b.d}; }
static inline dual dual_quotient(dual a, dual b) { return (dual){a.v / b.v, (a.d - a.v / b.v * b.d) / b.v}; }
static inline dual dual_fabs(dual a) { return a.v < 0.0 ? dual_negative(a) : a; }
static inline dual dual_largest(dual a, dual b) { return b.v > a.v ? b : a; }
static inline dual dual_smallest(dual a, dual b) { return b.v < a.v ? b : a; }
static inline dual dual_sqrt(dual a) { const double r = sqrt(a.v); return (dual){r, r > 0.0 ? 0.5 * a.d / r : 0.0}; }
static inline dual dual_exp(dual a) { const double e = exp(a.v); return (dual){e, e * a.d}; }
static inline dual dual_log(dual a) { return (dual){log(a.v), a.d / a.v}; }
static inline dual dual_sin(dual a) { return (dual){sin(a.v), cos(a.v) * a.d}; }
static inline dual dual_cos(dual a) { return (dual){cos(a.v), -sin(a.v) * a.d}; }
static inline dual dual_tanh(dual a) { const double t = tanh(a.v); return (dual){t, (1.0 - t * t) * a.d}; }
static inline dual dual_atan(dual a) { return (dual){atan(a.v), a.d / (1.0 + a.v * a.v)}; }
static inline dual dual_hypot(dual a, dual b) {
    const double r = hypot(a.v, b.v);
    return (dual){r, r > 0.0 ? (a.v * a.d + b.v * b.d) / r : 0.0};
}
static inline dual dual_power(dual a, dual b) {
    const double p = pow(a.v, b.v);
    return (dual){p, b.v * pow(a.v, b.v - 1.0) * a.d + (b.d != 0.0 ? log(a.v) * p * b.d : 0.0)};
}
static inline dual dual_whole_power(dual x, int n) {
    dual result = {1.0, 0.0};
    for (int i = 0; i < n; i++) result = dual_product(result, x);
    return result;
}
"""
"""What a translation with derivatives needs besides."""
_DERIVED = frozenset(re.findall(r"dual_(\w+)\(dual", DUALS))
_REAL = (
    "sqrt",
    "exp",
    "log",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "erf",
    "erfc",
    "log1p",
    "expm1",
)
_MATH: dict[Any, str] = {
    **{getattr(math, name): name for name in _REAL},
    **{
        math.hypot: "hypot",
        math.copysign: "copysign",
        math.atan2: "atan2",
        math.fmod: "fmod",
        math.pow: "pow",
    },
}
_TESTS: dict[Any, str] = {math.isnan: "isnan", math.isfinite: "isfinite", math.isinf: "isinf"}
_CONVERSIONS: dict[Any, Scalar] = {
    float: DOUBLE, numba.float64: DOUBLE, np.float64: DOUBLE, int: INT, numba.int64: INT, np.int64: INT,
    numba.uint64: UNSIGNED, np.uint64: UNSIGNED, bool: BOOL,
}  # fmt: skip

_D, _I = DOUBLE, INT
_INTRINSICS: dict[Any, tuple[str, tuple[Scalar, ...], Any]] = {
    philox.bits_of: ("bits_of", (_D,), UNSIGNED),
    philox.double_of: ("double_of", (UNSIGNED,), DOUBLE),
    as_doubles: ("doubles_at", (_I,), Array(DOUBLE, (None,))),
    call_law: ("call_law", (_I, *[_D] * 11, *[_I] * 3), VOID),
    call_effect: ("call_effect", (_I,) * 5, VOID),
}
"""Functions of LLVM instructions -> their C name, arguments and result; the last two are dispatchers that
`stochfric_mb.c.dispatch` writes."""


def constructor(known: Known) -> bool:
    """Return whether an object makes an array."""
    return known.value in (np.zeros, np.empty)


def call(known: Known, args: list[Value]) -> Value | None:
    """Return what a call of an object that is not one of the package's own functions becomes, None if unknown."""
    function = known.value
    if not _hashable(function):
        return None
    if any(a.type == DUAL for a in args) and (function in _MATH or function in (abs, max, min)):
        return _with_derivative(function, args)
    args = [plain(a) for a in args] if function in _BUILT_IN or function in _TESTS else args
    if function in _BUILT_IN:
        return _BUILT_IN[function](args)
    if function in _CONVERSIONS:
        return _converted(args[0], _CONVERSIONS[function])
    return _of_math(function, args) or _named(function, args)


def _of_math(function: Any, args: list[Value]) -> Value | None:
    if function in _MATH:
        return Value(f"{_MATH[function]}({', '.join(as_c(a, DOUBLE) for a in args)})", DOUBLE)
    if function in _TESTS:
        return Value(f"({_TESTS[function]}({as_c(args[0], DOUBLE)}) != 0)", BOOL)
    return None


def _with_derivative(function: Any, args: list[Value]) -> Value | None:
    """Return a function of numbers with derivatives, None where there is none of it."""
    name = {abs: "fabs", max: "largest", min: "smallest"}.get(function) or _MATH[function]
    if name not in _DERIVED:
        return None
    code = as_c(args[0], DUAL)
    if len(args) == 1:
        return Value(f"dual_{name}({code})", DUAL)
    for other in args[1:]:
        code = f"dual_{name}({code}, {as_c(other, DUAL)})"
    return Value(code, DUAL)


def _hashable(function: Any) -> bool:
    try:
        hash(function)
    except TypeError:
        return False
    return True


def _named(function: Any, args: list[Value]) -> Value | None:
    """Return the call of an intrinsic."""
    if function not in _INTRINSICS:
        return None
    name, types, result = _INTRINSICS[function]
    return Value(f"{name}({', '.join(as_c(a, t) for a, t in zip(args, types, strict=True))})", result)


def _converted(value: Value, wanted: Scalar) -> Value:
    if value.type == wanted or (value.type == DUAL and wanted == DOUBLE):
        return value
    value = plain(value)
    if wanted == INT and value.type == DOUBLE:
        return Value(f"to_int({value.code})", INT)
    if wanted == UNSIGNED and value.type == DOUBLE:
        return Value(f"((uint64_t)to_int({value.code}))", UNSIGNED)
    return Value(as_c(value, wanted), wanted)


def _extreme(name: str, args: list[Value]) -> Value:
    """Return the largest or smallest, a later one only where it is strictly more so, as Python does."""
    whole = all(a.type == INT for a in args)
    kind, suffix = (INT, "_int") if whole else (DOUBLE, "")
    code = as_c(args[0], kind)
    for other in args[1:]:
        code = f"{name}{suffix}({code}, {as_c(other, kind)})"
    return Value(code, kind)


def _absolute(args: list[Value]) -> Value:
    if args[0].type == INT:
        return Value(f"llabs({args[0].code})", INT)
    return Value(f"fabs({as_c(args[0], DOUBLE)})", DOUBLE)


def _whole(name: str, args: list[Value]) -> Value:
    return Value(f"to_int({name}({as_c(args[0], DOUBLE)}))", INT)


def _length(args: list[Value]) -> Value | None:
    kind = args[0].type
    if not isinstance(kind, Array) or kind.shape[0] is None:
        return None
    return Value(f"INT64_C({kind.shape[0]})", INT, kind.shape[0])


_BUILT_IN: dict[Any, Callable[[list[Value]], Value | None]] = {
    abs: _absolute,
    len: _length,
    max: functools.partial(_extreme, "largest"),
    min: functools.partial(_extreme, "smallest"),
    math.floor: functools.partial(_whole, "floor"),
    math.ceil: functools.partial(_whole, "ceil"),
}
