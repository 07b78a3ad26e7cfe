"""Native friction of two geoms of a compiled model: which numbers of the model switch it off, and nothing else."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

from typing import Any

import mujoco

from stochfric_mb.errors import InputError, require_name


def geoms_of(model: mujoco.MjModel, names: tuple[str, str]) -> tuple[int, int]:
    """Return the ids of two geoms given by name.

    Raises:
        InputError: not a pair of names, an unknown name, or geoms of one rigid body.
    """
    if isinstance(names, str) or len(names) != 2:
        raise InputError(f"{names!r} is not a pair; give (body's geom, counter-surface's geom)")
    if "*" in names:
        raise InputError(f"{names!r}: a compiled model's pairs are named one by one; use add_friction(spec, ...) for '*'")
    known = [model.geom(i).name for i in range(model.ngeom) if model.geom(i).name]
    body, surface = (model.geom(require_name("geom", name, known)).id for name in names)
    if model.body_weldid[model.geom_bodyid[body]] == model.body_weldid[model.geom_bodyid[surface]]:
        raise InputError(f"geoms {names!r} belong to one rigid body, so they never slide on each other; choose geoms that move")
    return body, surface


def switches_of(model: mujoco.MjModel, geoms: tuple[int, int], names: tuple[str, str]) -> list[tuple[str, int]]:
    """Return the integers of the model (array, place) that must be 1 for the pair to have no native friction.

    Raises:
        InputError: the geoms never touch, or other contacts would change too.
    """
    for i in range(model.npair):
        if {int(model.pair_geom1[i]), int(model.pair_geom2[i])} == set(geoms):
            return [("pair_dim", i)]
    if not _may_touch(model, *geoms):
        raise InputError(
            f"geoms {names!r} never touch: their contype and conaffinity exclude each other and there is no pair of them; "
            "add a contact pair or change the masks"
        )
    changed = model.geom_condim.copy()
    changed[list(geoms)] = 1
    for geom in geoms:
        for other in range(model.ngeom):
            if {geom, other} == set(geoms) or not _may_touch(model, geom, other):
                continue
            if _dimension(model, model.geom_condim, geom, other) != _dimension(model, changed, geom, other):
                raise InputError(
                    f"native friction of {names!r} cannot be switched off without that of {model.geom(geom).name!r} and "
                    f"{model.geom(other).name or f'geom {other}'!r}; name the pair in the model (<contact><pair .../>) or use "
                    "add_friction(spec, ...)"
                )
    return [("geom_condim", geom) for geom in geoms]


def _may_touch(model: mujoco.MjModel, a: int, b: int) -> bool:
    if model.body_weldid[model.geom_bodyid[a]] == model.body_weldid[model.geom_bodyid[b]]:
        return False
    return bool(model.geom_contype[a] & model.geom_conaffinity[b] or model.geom_contype[b] & model.geom_conaffinity[a])


def _dimension(model: mujoco.MjModel, condim: Any, a: int, b: int) -> int:
    if model.geom_priority[a] != model.geom_priority[b]:
        return int(condim[a if model.geom_priority[a] > model.geom_priority[b] else b])
    return int(max(condim[a], condim[b]))
