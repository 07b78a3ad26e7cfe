"""Where a mask holds without a gap."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def stretches(mask: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the stretches in which a mask holds without a gap: the first of each, and the one after its last."""
    edges = np.flatnonzero(np.diff(np.r_[0, mask.astype(np.int8), 0]))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
