"""Which pairs of geoms were meant to have friction, and have never touched."""

from __future__ import annotations

from collections.abc import Set as AbstractSet

import mujoco

from stochfric_mb.mujoco.memory.engine import plugin_text
from stochfric_mb.mujoco.reading import friction_instances

ANY = -1
"""Stands for every geom."""
NAMED = 4
"""Most pairs that a note names."""


def own_pairs(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Return the geoms of the model's instances of this package's friction; one of a pair may be `ANY`."""
    return [(_geom(model, i, "geom1"), _geom(model, i, "geom2")) for i in friction_instances(model)]


def _geom(model: mujoco.MjModel, instance: int, key: str) -> int:
    name = plugin_text(model, instance, key)
    return ANY if name == "*" else model.geom(name).id


def covers(pair: tuple[int, int], geoms: tuple[int, int]) -> bool:
    """Return whether a pair, in which one may be `ANY`, stands for two geoms, in either order."""
    return any(a in (ANY, c) and b in (ANY, d) for a, b in (pair, pair[::-1]) for c, d in (geoms,))


def forgotten(model: mujoco.MjModel, met: AbstractSet[frozenset[int]], duration: float) -> list[str]:
    """Return a note on the pairs that the model names, in ``<pair>`` or for this package's friction, and that never touched.

    Args:
        model: the model.
        met: the pairs of geoms that have touched.
        duration: for how long was looked [s].
    """
    owned = own_pairs(model)
    open_ended = [pair for pair in owned if ANY in pair]
    named = {frozenset(pair) for pair in owned if ANY not in pair}
    for i in range(model.npair):
        geoms = int(model.pair_geom1[i]), int(model.pair_geom2[i])
        if not any(covers(pair, geoms) for pair in open_ended):
            named.add(frozenset(geoms))
    apart = sorted(" x ".join(sorted(_name(model, g) for g in pair)) for pair in named - met)
    for pair in open_ended:
        if not any(len(geoms) == 2 and covers(pair, (min(geoms), max(geoms))) for geoms in met):
            apart.append(" x ".join("*" if g == ANY else _name(model, g) for g in pair))
    if not apart:
        return []
    listed = ", ".join(apart[:NAMED]) + (f" and {len(apart) - NAMED} more" if len(apart) > NAMED else "")
    return [
        f"never touched in {duration:g} s, so nothing is known of their friction: {listed}; "
        "give a keyframe in which they touch, or a longer --settle"
    ]


def _name(model: mujoco.MjModel, geom: int) -> str:
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or f"#{geom}"
