"""What effects with a motion of their own remember: driven by the record as measured, up to where a simulation begins.

A second mode rings on from slip to slip, so that no simulation can begin in the middle of a record with it at rest.
"""

from __future__ import annotations

import numpy as np

from stochfric_mb.discovery.stick_slip.records.record import Array, Record
from stochfric_mb.reference.augmented import AugmentedSystem


def auxiliary_state(
    system: AugmentedSystem, record: Record, time: Array, position: Array, *, since: float = 0.0
) -> Array | None:
    """Return the memories of the effects at the starts of simulations, shape (k, n_memory); None where they have none.

    Args:
        system: the model of the run.
        record: the run.
        time: starts [s], shape (k,); the box sticks there.
        position: position of the box there [m], not mirrored, shape (k,).
        since: how long before the first start the effects are taken to be at rest [s]; 0: at the record's begin.
    """
    if not any(effect.n_memory for effect in system.effects):
        return None
    first = max(int(np.searchsorted(record.time, time.min() - since)) - 1, 0) if since > 0.0 else 0
    last = min(int(np.searchsorted(record.time, time.max())) + 2, len(record.time))
    measured, velocity = (a[first:last] for a in record.motion)
    times = record.time[first:last]
    path = system.recalled(times, measured, velocity)
    belt = np.full(len(time), record.stated.belt_velocity)
    # positions are absolute: what is taken over is how far the effects are away from rest
    away = path - _rest(system, measured, velocity)
    return _rest(system, position, belt) + np.stack([np.interp(time, times, column) for column in away.T], axis=1)


def _rest(system: AugmentedSystem, position: Array, velocity: Array) -> Array:
    return np.hstack([effect.rest(position, velocity) for effect in system.effects if effect.n_memory])
