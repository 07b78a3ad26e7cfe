"""What the kernels of all laws share: groups of lanes on a common time grid, their outputs and books.

The module of a law's kernel names its ``ROWS`` of the flat array, those of `lanes` included, and has compiled functions::

    numbers(q)              numbers that hold for the whole run
    start(q, m)             sets up its rows; x, x' and the pairs are there
    leg(q, i, numbers, m, tally, pending)   moves all lanes to the end of leg i; returns whether that ended
    sticks(q, m, j)         whether lane j sticks
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.compile import compiled
from stochfric_mb.ensemble.lanes import (
    A_K,
    A_S,
    B_K,
    B_S,
    LANES,
    OPEN,
    TALLIES,
    V,
    X,
    aligned,
    begin,
    close,
    first_pairs,
    next_pairs,
)


def kernel(law: ModuleType) -> Any:
    """Return the compiled function that runs the samples of an ensemble side by side, with the functions of ``law``.

    ``(q, seed, first, n, position, velocity, stick, tallies)`` runs samples ``first`` .. ``first + n - 1``; writes
    (n, n_outputs) arrays and tallies; returns 0, or 1 + the leg that did not end.
    """
    rows, start, numbers, leg, sticks = law.ROWS * LANES, law.start, law.numbers, law.leg, law.sticks
    file = str(law.__file__)

    def record(q, output, n, m, position, velocity, stick):
        for j in range(n):
            position[j, output] = m[X + j]
            velocity[j, output] = m[V + j]
            stick[j, output] = sticks(q, m, j)

    def group(q, seed, first, n, position, velocity, stick, tallies):
        m = aligned(rows)
        m[X : X + LANES] = q.position
        m[V : V + LANES] = q.velocity
        a_s, a_k, b_s, b_k = (m[A_S : A_S + LANES], m[A_K : A_K + LANES], m[B_S : B_S + LANES], m[B_K : B_K + LANES])
        tally, pending = np.empty((TALLIES, LANES)), np.empty((OPEN, LANES))
        cursors = np.zeros((LANES, CURSOR))
        first_pairs(q.descriptor, cursors, seed, first, a_s, a_k, b_s, b_k)
        start(q, m)
        for j in range(LANES):
            begin(tally, pending, j, sticks(q, m, j))
        if q.legs.output_at_start:
            write(q, 0, n, m, position, velocity, stick)
        fixed = numbers(q)
        knot = 0
        for i in range(len(q.legs.length)):
            if q.legs.knot[i] > knot:
                knot += 1
                next_pairs(q.descriptor, cursors, seed, first, knot, a_s, a_k, b_s, b_k)
            if not leg(q, i, fixed, m, tally, pending):
                return i + 1
            if q.legs.output[i] >= 0:
                write(q, q.legs.output[i], n, m, position, velocity, stick)
        end = q.legs.start[-1] + q.legs.length[-1]
        for j in range(n):
            close(tally, pending, j, end, q.box.belt_velocity * end - m[X + j], q.least_slip)
            tallies[j] = tally[:, j]
        return 0

    def simulate(q, seed, first, n, position, velocity, stick, tallies):
        for low in range(0, n, LANES):
            high = min(low + LANES, n)
            failed = run(
                q, seed, first + low, high - low, position[low:high], velocity[low:high], stick[low:high], tallies[low:high]
            )
            if failed > 0:
                return failed
        return 0

    write = compiled(record, parts=file)
    run = compiled(group, parts=file)
    return compiled(simulate, parts=file)
