"""A course in time of any smooth shape: a sum of cubic B-splines over a stretch of time.

A slow course is told from a random wander by its length scale: it bends over a part of the record that many slips fall into,
and it comes back in the next run. Reference: C. de Boor, A Practical Guide to Splines, Springer 1978, chapter IX.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from stochfric_mb.effects.contract import Array, parameter

PIECES = 16
"""Pieces of the course between its beginning and its end."""
COURSE = tuple(f"course_{i}" for i in range(1, PIECES + 3))
"""Parameters that are its shape; a course begins at 0, so that the spline before them is left out."""
COARSER = (4, 8, PIECES)
"""Pieces of the courses that are looked for; each course is a finer one, too."""


def shape(number: int) -> Any:
    """Return the field of one number of a course's shape: no fit moves it, a fit moves the size."""
    return parameter(
        "-", f"weight of spline {number} of {PIECES + 2} in the course", scale=1.0, default=0.0, fit_prior=0.0, optional=True
    )


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


@functools.cache
def refined(pieces: int) -> Array:
    """Return what turns the weights of a coarser course into those of the finest, shape (PIECES + 2, pieces + 2)."""
    place = np.linspace(0.0, 1.0, 20 * PIECES + 1)
    return np.asarray(np.linalg.lstsq(splines(place, PIECES), splines(place, pieces), rcond=None)[0], dtype=np.float64)


def sized(weights: Array, pieces: int, span: float) -> dict[str, float]:
    """Return the parameters of a course: its size, its shape with a largest change of 1, and its span [s]."""
    fine = refined(pieces) @ weights
    course = splines(np.linspace(0.0, 1.0, 20 * PIECES + 1), PIECES) @ fine
    size = float(course[np.argmax(np.abs(course))]) or 1.0
    return {"change": size, "span": span} | {name: float(w / size) for name, w in zip(COURSE, fine, strict=True)}
