"""How runs that pass one periodic shape are shifted against each other, from the harmonics that each of them shows.

Reference: D. R. Lorimer, M. Kramer, Handbook of Pulsar Astronomy, Cambridge 2005, chapters 6 and 7 (harmonics, folding).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

HARMONICS, BEGINS = 6, 48
"""Harmonics by which runs are shifted against each other, and shifts that are tried, over a turn."""
ALIGNMENTS = 4
"""How often all runs are aligned with what they show together."""


def aligned(waves: npt.NDArray[np.complex128], variance: Array) -> Array:
    """Return where in a shape that comes back each run begins [turns], shape (n_runs,).

    Args:
        waves: harmonics of each run, those of exp(2 pi i h f t), h = 1, 2, ...: shape (n_runs, n_harmonics).
        variance: their variances, shape as ``waves``.
    """
    order = np.arange(1, waves.shape[1] + 1)
    trials = np.exp(-2j * np.pi * order * np.arange(BEGINS)[:, None] / BEGINS)
    begins = np.zeros(len(waves), dtype=np.int64)
    shape = waves[int(np.argmax(np.sum(np.abs(waves) ** 2 / variance, axis=1)))]
    for _ in range(ALIGNMENTS):
        fit = np.real(np.conj(shape) * waves[:, None, :] * trials / variance[:, None, :]).sum(axis=2)
        begins = np.argmax(fit, axis=1)
        shape = np.average(waves * trials[begins], axis=0, weights=1.0 / variance)
    return begins / BEGINS
