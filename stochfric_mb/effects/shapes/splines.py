"""Splines of a course: in arrays, where fits are linear in their weights, and compiled, for laws at work.

Reference: C. de Boor, A Practical Guide to Splines, Springer 1978, chapter IX.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects.contract import Array

PIECES = 16
"""Most pieces of a course between its beginning and its end."""
COURSE = tuple(f"course_{i}" for i in range(1, PIECES + 3))
"""Parameters that are its shape; a course begins at 0, so that the spline before them is left out."""
COARSER = (4, 8, PIECES)
"""Pieces of the courses that are looked for."""
RETURNING_PIECES = (8, PIECES)
"""Pieces of the courses that come back; with fewer they are sines."""


def splines(place: Array, pieces: int) -> Array:
    """Return the splines of a course with so many pieces, each less its value at the begin, shape (..., pieces + 2).

    Args:
        place: 0 at the begin of the course, 1 at its end.
        pieces: number of pieces.
    """
    value = _raw(place, pieces)
    return value - _raw(np.zeros(1), pieces)[0]


def _raw(place: Array, pieces: int) -> Array:
    node = np.arange(pieces + 2, dtype=np.float64)
    apart = np.abs(pieces * np.clip(place, 0.0, 1.0)[..., None] - node)
    near = 2.0 / 3.0 - apart**2 + apart**3 / 2.0
    return np.where(apart < 1.0, near, np.maximum(2.0 - apart, 0.0) ** 3 / 6.0)


def returning(turns: Array, pieces: int) -> Array:
    """Return the splines of a course that comes back with each turn, shape (..., pieces - 1).

    The last one is left out: all of them together are a constant.

    Args:
        turns: turns from the begin of the course; whole numbers are its begin and its end.
        pieces: number of pieces in a turn, 4 or more.
    """
    raw = _raw(turns - np.floor(turns), pieces)
    once = raw[..., : pieces - 1].copy()
    once[..., :2] += raw[..., pieces:]
    return once


def returning_course(weights: Array, pieces: int) -> dict[str, float]:
    """Return the parameters of a course from the weights of `returning`: its size, and a shape of mean 0 and largest change 1.

    Args:
        weights: shape (pieces - 1,).
        pieces: as of `returning`.
    """
    course = returning(np.linspace(0.0, 1.0, 20 * PIECES, endpoint=False), pieces) @ weights
    course, begin = course - course.mean(), float(course[0] - course.mean())
    size = float(course[np.argmax(np.abs(course))]) or 1.0
    whole = np.concatenate([weights, [0.0], weights[:2]]) / size
    shape = {name: float(w) for name, w in zip(COURSE, whole, strict=False)}
    return {"course": size, "at_begin": begin / size, "pieces": float(pieces)} | shape


def sized(weights: Array, pieces: int, span: float) -> dict[str, float]:
    """Return the parameters of a course: its size, its shape with a largest change of 1, its pieces and its span."""
    course = splines(np.linspace(0.0, 1.0, 20 * PIECES + 1), pieces) @ weights
    size = float(course[np.argmax(np.abs(course))]) or 1.0
    shape = {name: float(w / size) for name, w in zip(COURSE, weights, strict=False)}
    return {"change": size, "span": span, "pieces": float(pieces)} | shape


@compiled
def along(p, place):
    """Return the course at a place, 0 at its begin and 1 at its end, from an effect's parameters."""
    where = p[18] * min(max(place, 0.0), 1.0)
    value = -(2.0 / 3.0 * p[0] + p[1] / 6.0)  # less what the splines are at the begin
    for k in range(max(int(where) - 1, 0), min(int(where) + 3, int(p[18]) + 2)):
        away = abs(where - k)
        if away < 1.0:
            value += p[k] * (2.0 / 3.0 - away * away * (1.0 - away / 2.0))
        elif away < 2.0:
            value += p[k] * (2.0 - away) * (2.0 - away) * (2.0 - away) / 6.0
    return value


@compiled
def along_slope(p, place):
    """Return the slope of `along` between its begin, at 0, and its end, at 1."""
    where, value = p[18] * place, 0.0
    for k in range(int(p[18]) + 2):
        away, side = abs(where - k), math.copysign(1.0, where - k)
        if away < 1.0:
            value += side * p[k] * away * (1.5 * away - 2.0)
        elif away < 2.0:
            value -= side * p[k] * (2.0 - away) * (2.0 - away) / 2.0
    return p[18] * value


@compiled
def along_integral(p, place):
    """Return the integral of `along` from its begin, at 0, to a place up to its end, at 1."""
    value = -p[18] * place * (2.0 / 3.0 * p[0] + p[1] / 6.0)
    for k in range(int(p[18]) + 2):
        value += p[k] * (_half_of_spline(p[18] * place - k) - _half_of_spline(-1.0 * k))
    return value / p[18]


@compiled
def _half_of_spline(away):
    """Return the integral of a cubic B-spline from its middle, at 0, to a distance from that in pieces, of either sign."""
    far = min(abs(away), 2.0)
    if far < 1.0:
        half = far * (2.0 / 3.0 - far * far * (1.0 / 3.0 - far / 8.0))
    else:
        half = 0.5 - (2.0 - far) * (2.0 - far) * (2.0 - far) * (2.0 - far) / 24.0
    return math.copysign(half, away)
