"""A log of located switches that grows: rows (time [s], 1 for break-away or 0 for stick)."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled

BREAK_AWAY, STICK = 1.0, 0.0


@compiled
def note(log, n, t, kind):
    """Return the log with row ``n`` set; twice as long if it was full."""
    if n == len(log):
        longer = np.empty((2 * n, 2))
        for i in range(n):
            longer[i, 0] = log[i, 0]
            longer[i, 1] = log[i, 1]
        log = longer
    log[n, 0] = t
    log[n, 1] = kind
    return log
