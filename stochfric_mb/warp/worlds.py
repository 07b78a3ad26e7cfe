"""Making the arrays that friction keeps on the device."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import warp as wp

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.friction import Friction
from stochfric_mb.warp.state import Rows, Slots, Worlds, vec5


def world_arrays(friction: Friction, nworld: int, first_sample: int, *, new_paths: bool = False) -> Any:
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
    worlds.stick_speed = wp.full(nworld, law.stick_speed, dtype=float)
    worlds.peak_speed = wp.full(nworld, law.peak_speed, dtype=float)
    worlds.peak_ratio = law.peak_speed / law.stick_speed
    worlds.origin = 0.0
    worlds.mu_s = wp.full(nworld, law.mu_s, dtype=float)
    worlds.mu_k = wp.full(nworld, law.mu_k, dtype=float)
    worlds.overflow = wp.zeros(nworld, dtype=int)
    return worlds


def slot_arrays(nworld: int, n: int, *, own_paths: bool) -> Any:
    """Return empty `Slots` for ``n`` contacts in each world; with ``own_paths``, each has its own place on the path."""
    slots: Any = Slots()
    shape = (2, n, nworld)
    slots.used = wp.zeros((2, nworld), dtype=int)
    for name in ("geoms", "rows"):
        setattr(slots, name, wp.zeros(shape, dtype=wp.vec2i))
    for name in ("axis_1", "axis_2", "place", "pull", "drift", "velocity"):
        setattr(slots, name, wp.zeros(shape, dtype=wp.vec3))
    for name in ("side", "saturated", "loose", "events", "mode", "springs"):
        setattr(slots, name, wp.zeros(shape, dtype=int))
    for name in ("scale", "mu_s", "mu_k", "normal", "creep"):
        setattr(slots, name, wp.zeros(shape, dtype=float))
    slots.friction = wp.zeros(shape, dtype=vec5)
    slots.path = wp.zeros(shape, dtype=wp.float64)
    slots.cursor = wp.zeros((*shape, CURSOR) if own_paths else (0, 0, 0, 0), dtype=wp.float64)
    return slots


def row_arrays(nworld: int) -> Any:
    """Return the empty `Rows` of a joint or tendon."""
    rows: Any = Rows()
    rows.row = wp.full((2, nworld), -1, dtype=int)
    for name in ("mode", "events", "springs"):
        setattr(rows, name, wp.zeros((2, nworld), dtype=int))
    rows.path = wp.zeros((2, nworld), dtype=wp.float64)
    for name in ("cap", "force", "drift", "creep", "mu_s", "mu_k"):
        setattr(rows, name, wp.zeros((2, nworld), dtype=float))
    return rows


def _rows(numbers: Any, nworld: int, kind: type) -> Any:
    return wp.array(np.tile(np.asarray(numbers, dtype=np.float64), (nworld, 1)), dtype=kind)
