"""Making the arrays that friction keeps on the device."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import warp as wp

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.friction import Friction
from stochfric_mb.warp.state import Rows, Slots, Worlds, vec5

LEAST_EXCESS = 0.002
"""A contact at its cap slides, where the law has no v_s, once it is as fast as this acceleration makes it in a step [m/s^2].

It lies above what a stuck contact moves while its load shifts to its neighbours (4e-6 m/s on an incline that tilts by 5
degrees a second, in steps of 5 ms), and delays break-away by sqrt(2 v/(rate of the free acceleration))."""


def world_arrays(friction: Friction, nworld: int, first_sample: int, timestep: float, *, new_paths: bool = False) -> Any:
    """Return the `Worlds` of a friction, none of which has begun."""
    law = friction.law
    worlds: Any = Worlds()
    worlds.last_time = wp.zeros(nworld, dtype=float)
    worlds.count = wp.full(nworld, -1, dtype=int)
    worlds.fresh = wp.zeros(nworld, dtype=int)
    worlds.episode = wp.full(nworld, -1, dtype=int)
    worlds.first_sample = wp.array(first_sample + np.arange(nworld), dtype=wp.int64)
    worlds.sample = wp.array(first_sample + np.arange(nworld), dtype=wp.int64)
    worlds.means = wp.zeros(0, dtype=wp.float64)
    worlds.spreads = wp.zeros((0, 1), dtype=wp.float64)
    names = [field.name for field in dataclasses.fields(law)]
    worlds.v_s = names.index("v_s") if "v_s" in names else -1
    worlds.stride = nworld if new_paths else 0
    worlds.descriptor = _rows(friction.path(0).descriptor, nworld, wp.float64)
    worlds.cursor = wp.zeros((nworld, CURSOR), dtype=wp.float64)
    worlds.parameters = _rows(law.parameters(), nworld, wp.float32)
    worlds.stick_speed = wp.full(nworld, float(getattr(law, "v_s", LEAST_EXCESS * timestep)), dtype=float)
    worlds.mu_s = wp.full(nworld, law.mu_s, dtype=float)
    worlds.mu_k = wp.full(nworld, law.mu_k, dtype=float)
    worlds.overflow = wp.zeros(nworld, dtype=int)
    return worlds


def slot_arrays(nworld: int, n: int) -> Any:
    """Return empty `Slots` for ``n`` contacts in each world."""
    slots: Any = Slots()
    shape = (2, nworld, n)
    slots.used = wp.zeros((2, nworld), dtype=int)
    slots.geoms = wp.zeros(shape, dtype=wp.vec2i)
    slots.rows = wp.zeros(shape, dtype=wp.vec2i)
    slots.axis_1 = wp.zeros(shape, dtype=wp.vec3)
    slots.axis_2 = wp.zeros(shape, dtype=wp.vec3)
    slots.side = wp.zeros(shape, dtype=int)
    slots.place = wp.zeros(shape, dtype=wp.vec3)
    slots.friction = wp.zeros(shape, dtype=vec5)
    slots.force = wp.zeros(shape, dtype=wp.vec3)
    slots.saturation = wp.zeros(shape, dtype=float)
    slots.drift = wp.zeros(shape, dtype=wp.vec3)
    slots.velocity = wp.zeros(shape, dtype=wp.vec3)
    slots.urgency = wp.zeros(shape, dtype=float)
    slots.mode = wp.zeros(shape, dtype=int)
    return slots


def row_arrays(nworld: int) -> Any:
    """Return the empty `Rows` of a joint or tendon."""
    rows: Any = Rows()
    rows.row = wp.full((2, nworld), -1, dtype=int)
    rows.mode = wp.zeros((2, nworld), dtype=int)
    for name in ("cap", "force", "drift", "velocity"):
        setattr(rows, name, wp.zeros((2, nworld), dtype=float))
    return rows


def _rows(numbers: Any, nworld: int, kind: type) -> Any:
    return wp.array(np.tile(np.asarray(numbers, dtype=np.float64), (nworld, 1)), dtype=kind)
