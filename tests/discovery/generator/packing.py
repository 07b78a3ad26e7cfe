"""A machine as four plain arrays, the only thing that compiled code passes from function to function without cost."""

from typing import NamedTuple

import numba
import numpy as np

from .curve import Array, Curve
from .machine import Machine

_NUMBERS = (
    "mass",
    "start",
    "speed_delay",
    "forward_factor",
    "backward_factor",
    "contact_length",
    "contact_damping",
    "second_mass",
    "link_stiffness",
    "link_damping",
    "ground_stiffness",
    "ground_damping",
    "creeps",
)
(
    MASS,
    START,
    SPEED_DELAY,
    FORWARD,
    BACKWARD,
    CONTACT_LENGTH,
    CONTACT_DAMPING,
    SECOND_MASS,
    LINK_STIFFNESS,
    LINK_DAMPING,
    GROUND_STIFFNESS,
    GROUND_DAMPING,
    CREEPS,
) = range(len(_NUMBERS))
"""Places in `Packed.numbers`."""

_CURVES = (
    "spring",
    "damper",
    "sliding",
    "memory_of_distance",
    "memory_of_time",
    "ageing",
    "belt_surface",
    "stroke",
    "creep",
    "contact_shape",
    "static_by_slip",
    "kinetic_by_slip",
    "force_by_slip",
)
(
    SPRING,
    DAMPER,
    SLIDING,
    MEMORY_OF_DISTANCE,
    MEMORY_OF_TIME,
    AGEING,
    BELT_SURFACE,
    STROKE,
    CREEP,
    CONTACT_SHAPE,
    STATIC_BY_SLIP,
    KINETIC_BY_SLIP,
    FORCE_BY_SLIP,
) = range(len(_CURVES))
"""Rows of `Packed.heads`."""


class Packed(NamedTuple):
    """Arguments of every compiled function, in this order."""

    numbers: Array
    signals: Array
    heads: Array
    """A row a curve: origin, spacing, 1 if periodic, first value's place, number of values."""
    values: Array


def pack(machine: Machine) -> Packed:
    """The machine as plain arrays."""
    creeps = float(np.any(machine.creep.values != 0.0))
    numbers = np.array([creeps if name == "creeps" else getattr(machine, name) for name in _NUMBERS])
    curves = [_as_curve(getattr(machine, name)) for name in _CURVES]
    places = np.concatenate([[0], np.cumsum([curve.values.size for curve in curves])])
    heads = np.array(
        [
            [curve.origin, curve.spacing, float(curve.periodic), float(place), float(curve.values.size)]
            for curve, place in zip(curves, places, strict=False)
        ]
    )
    return Packed(numbers, np.ascontiguousarray(machine.signals), heads, np.concatenate([curve.values for curve in curves]))


def _as_curve(value: Curve | Array) -> Curve:
    """Factors by slip are read at whole numbers, repeated."""
    return value if isinstance(value, Curve) else Curve(0.0, 1.0, True, np.asarray(value, dtype=np.float64))


@numba.njit(cache=True, error_model="numpy")
def look_up(heads, values, curve, at):
    """A curve's value at a point: linear between its points, repeated or continued linearly."""
    position = (at - heads[curve, 0]) / heads[curve, 1]
    first = int(heads[curve, 3])
    n = int(heads[curve, 4])
    if heads[curve, 2] != 0.0:
        position -= np.floor(position / n) * n
        i = min(int(position), n - 1)
        following = i + 1 if i + 1 < n else 0
    else:
        i = min(max(int(position), 0), n - 2)
        following = i + 1
    low = values[first + i]
    return low + (position - i) * (values[first + following] - low)
