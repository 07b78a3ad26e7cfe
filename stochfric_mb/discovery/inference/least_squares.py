"""Linear least squares in columns of unit length: numbers of any units, and of any rank, are solved alike."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

RANK = 1.0e-10
"""Singular value, over the largest, below which a combination of columns counts as none [-]: rounding."""
SHORTEST = 1.0e-300
"""Least length of a column: one of zeros stays so."""


def lengths(design: Array) -> Array:
    """Return the lengths of the columns of ``design``, > 0, shape (p,)."""
    return np.maximum(np.linalg.norm(design, axis=0), SHORTEST)


def solved(design: Array, values: Array, size: Array | None = None) -> Array:
    """Return the numbers b of least |values - design b|, the shortest of several, shape (p,).

    Args:
        design: columns, shape (n, p).
        values: what they are to give, shape (n,).
        size: lengths that the columns are taken to have, shape (p,); None: their own.
    """
    size = lengths(design) if size is None else size
    return np.linalg.lstsq(design / size, values, rcond=RANK)[0] / size


def left_by(design: Array, values: Array, rank: float | None = RANK) -> Array:
    """Return what the columns of ``design`` leave of ``values``, shape (n,).

    Args:
        design: columns, shape (n, p).
        values: what they are to give, shape (n,).
        rank: as `RANK`; None: rounding of as many numbers as there are.
    """
    scaled = design / lengths(design)
    return values - scaled @ np.linalg.lstsq(scaled, values, rcond=rank)[0]


def beyond(known: Array, columns: Array) -> Array:
    """Return what ``columns``, shape (n, k), have that those of ``known``, shape (n, p) and of full rank, do not: (n, k)."""
    basis, _ = np.linalg.qr(known / lengths(known))
    return columns - basis @ (basis.T @ columns)
