"""What stands beside the effects in the screening: steps, found run by run, and competitors that name no physics.

The marks of an effect are the effect's own (`Effect.hypotheses`, `Effect.wave`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial.legendre import legvander

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.effects.marks import Columns, Hypothesis

SOFTENING = "softening"
"""Competitor of effects that drift, in as few numbers as they."""
STEPS_APART = 25.5
"""Distance of the times at which a step is looked for, at least, as an angle of the natural oscillation [rad]: four periods."""
SETTLING = np.geomspace(0.03, 1.0, 22)
"""Times in which its drift settles, over the length of the record [-]."""


def step_times(pool: Pool) -> Array:
    """Return the times at which a step is looked for [s]."""
    return np.arange(
        0.08 * pool.duration, 0.94 * pool.duration, max(STEPS_APART / pool.angular_frequency, pool.duration / 80.0)
    )


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
    hypotheses: list[Hypothesis] = []
    for tau in (np.inf, *(share * last for share in SETTLING)):
        grown = [t / last if np.isinf(tau) else -np.expm1(-t / tau) for t in (pool.onset_time, pool.mean_time)]
        columns = [
            pool.column(-stiffness * pool.typical_onset * grown[0], -(stiffness * grown[1])[:, None] * pool.typical_position)
        ]
        hypotheses.append(Hypothesis(SOFTENING, columns, (float(tau),)))
    return hypotheses


def competitors(pool: Pool) -> dict[str, tuple[str, Sequence[Array]]]:
    """Return regressors that name no physics: if one of them wins, the answer is "unknown".

    Returns:
        Name -> (axis on which the disagreement lives, columns).
    """
    runs = [pool.run == r for r in range(pool.n_runs)]
    alternating = np.concatenate([(-1.0) ** np.arange(len(s)) for s in pool.slips])
    parity = [pool.column(pool.static * alternating * r, None) for r in runs]
    parity += [pool.column(None, pool.kinetic * alternating * r) for r in runs]
    return {
        "slip_shape": ("shape of the friction force within a slip", _of_moments(pool)),
        "shape_in_time": ("shape of the force within a slip, time within the run", _moments_in_time(pool)),
        "parity": ("alternates from slip to slip", parity),
        "time": ("time within the run", _along_time(pool, runs)),
        "position": ("position of the box", _along_position(pool)),
    }


def _of_moments(pool: Pool) -> Columns:
    """Return a column for each moment of the force within a slip, its mean apart."""
    shape: Columns = []
    for q in range(2, pool.features.shape[1]):
        column = np.zeros_like(pool.features)
        column[:, q] = pool.normal_force
        shape.append(column)
    return shape


def _moments_in_time(pool: Pool) -> Columns:
    """Return columns of a shape that changes smoothly in the course of a run: a mass, a damper or a spring that does."""
    time = 2.0 * pool.onset_time / pool.duration - 1.0
    return [legendre[:, None] * shape for legendre in legvander(time, 3).T[1:] for shape in _of_moments(pool)]


def _along_time(pool: Pool, parts: Sequence[np.ndarray]) -> Columns:
    """Return hats along the time in each part of the slips, of the break-away's force and of the force in slip."""
    knots = np.linspace(0.0, pool.duration, 8)

    def hats(time: Array) -> list[Array]:
        return [np.clip(1.0 - np.abs(time - k) / knots[1], 0.0, 1.0) for k in knots[1:]]

    at_onset = [pool.column(h * part, None) for h in hats(pool.onset_time) for part in parts]
    return at_onset + [pool.column(None, h * part) for h in hats(pool.mean_time) for part in parts]


def _along_position(pool: Pool) -> Columns:
    """Return hats along the stroke."""
    low, high = np.quantile(pool.typical_position, (0.02, 0.98))
    places = np.linspace(low, high, 10)
    width = places[1] - places[0]

    def hat(position: Array, place: float) -> Array:
        return np.clip(1.0 - np.abs(position - place) / width, 0.0, 1.0)

    return [pool.column(hat(pool.typical_onset, p), hat(pool.typical_position, p)) for p in places[1:-1]]
