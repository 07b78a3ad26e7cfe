"""What stands beside the effects in the screening: steps, found run by run, and competitors that name no physics.

The marks of an effect are the effect's own (`Effect.hypotheses`, `Effect.wave`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.effects.marks import Columns, Hypothesis

SOFTENING = "softening"
"""Competitor of effects that drift, in as few numbers as they."""
SETTLING = np.geomspace(0.03, 1.0, 22)
"""Times in which its drift settles, over the length of the record [-]."""


def step_times(pool: Pool) -> Array:
    """Return the times at which a step is looked for [s]."""
    return np.arange(0.08 * pool.duration, 0.94 * pool.duration, max(1.0, pool.duration / 80.0))


def steps(pool: Pool, run: int, *, multiplied: bool) -> list[Array]:
    """Return columns of a step of one run's friction (``multiplied``) or of its position sensor, one a time of `step_times`."""
    mine = pool.run == run
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)
    static, kinetic = (pool.static, pool.kinetic) if multiplied else (stiffness * pool.direction,) * 2
    return [pool.column(static * (pool.onset_time > t) * mine, kinetic * (pool.mean_time > t) * mine) for t in step_times(pool)]


def softening(pool: Pool) -> list[Hypothesis]:
    """Return a stiffness that drifts in each run, along the same courses as the effect of friction that drifts."""
    last = pool.duration
    stiffness = pool.per_run(lambda s: s.record.mechanism.stiffness)
    found: list[Hypothesis] = []
    for tau in (np.inf, *(share * last for share in SETTLING)):
        grown = [t / last if np.isinf(tau) else -np.expm1(-t / tau) for t in (pool.onset_time, pool.mean_time)]
        columns = [
            pool.column(-stiffness * pool.typical_onset * grown[0], -(stiffness * grown[1])[:, None] * pool.typical_position)
        ]
        found.append(Hypothesis(SOFTENING, columns, (float(tau),)))
    return found


def competitors(pool: Pool) -> dict[str, tuple[str, Sequence[Array]]]:
    """Return regressors that name no physics: if one of them wins, the answer is "unknown".

    Returns:
        Name -> (axis on which the disagreement lives, columns).
    """
    n = len(pool.run)
    load = pool.normal_force
    found: dict[str, tuple[str, Sequence[Array]]] = {}
    shape: Columns = []
    for q in range(1, pool.features.shape[1] - 1):
        column = np.zeros_like(pool.features)
        column[:, 1 + q] = load
        shape.append(column)
    found["slip_shape"] = ("shape of the friction force within a slip", shape)
    alternating = np.concatenate([(-1.0) ** np.arange(len(s)) for s in pool.slips])
    runs = [pool.run == r for r in range(pool.n_runs)]
    found["parity"] = (
        "alternates from slip to slip",
        [pool.column(pool.static * alternating * r, None) for r in runs]
        + [pool.column(None, pool.kinetic * alternating * r) for r in runs],
    )
    knots = np.linspace(0.0, pool.duration, 8)
    hats = [np.clip(1.0 - np.abs(t - k) / knots[1], 0.0, 1.0) for k in knots[1:] for t in (pool.onset_time, pool.mean_time)]
    found["time"] = (
        "time within the run",
        [pool.column(h * r, None) for h in hats[0::2] for r in runs]
        + [pool.column(None, h * r) for h in hats[1::2] for r in runs],
    )
    low, high = np.quantile(pool.typical_position, (0.02, 0.98))
    places = np.linspace(low, high, 10)
    width = places[1] - places[0]
    found["time_common"] = (
        "time within the run",
        [pool.column(h, None) for h in hats[0::2]] + [pool.column(None, h) for h in hats[1::2]],
    )
    found["position"] = (
        "position of the box",
        [
            pool.column(
                np.clip(1.0 - np.abs(pool.typical_onset - p) / width, 0.0, 1.0),
                np.clip(1.0 - np.abs(pool.typical_position - p) / width, 0.0, 1.0),
            )
            for p in places[1:-1]
        ],
    )
    assert all(c.shape[0] == n for _, columns in found.values() for c in columns)
    return found
