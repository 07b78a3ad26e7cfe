"""Pairs of geoms of a model: which ones a name stands for, and how they become explicit contact pairs."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mujoco.plugin.frictions import ANY, PAIRS, covers


class ContactWarning(UserWarning):
    """A pair that was given friction and never touched, or would not touch without it."""


def require_geoms(spec: mujoco.MjSpec, geoms: tuple[str, str]) -> tuple[str, str]:
    """Return the names of two geoms that can slide on each other (one may be ``"*"``), or raise an `InputError`."""
    body, surface = require_pair(geoms, [g.name for g in spec.geoms])
    if ANY not in geoms and _carrier(spec, spec.geom(body)) == _carrier(spec, spec.geom(surface)):
        raise InputError(f"geoms = {geoms!r} belong to one rigid body and never slide on each other; choose others")
    return body, surface


def require_pair(geoms: tuple[str, str], names: Sequence[str]) -> tuple[str, str]:
    """Return two of a model's geoms by name (one may be ``"*"``), or raise an `InputError`."""
    if isinstance(geoms, str) or len(geoms) != 2:
        raise InputError(f"geoms = {geoms!r} is not a pair; give the names of the body's and the counter-surface's geom")
    known = [name for name in names if name]
    body, surface = (name if name == ANY else require_name("geom", name, known) for name in geoms)
    if body == surface == ANY:
        raise InputError("geoms = ('*', '*') names no geom; name one of the two, e.g. ('*', 'floor')")
    if body == surface:
        raise InputError(f"geoms = {geoms!r} names one geom twice; friction needs two")
    return body, surface


def colliding_pairs(spec: mujoco.MjSpec, body: str, surface: str) -> list[tuple[str, str]]:
    """Return the pairs (body's geom, surface's geom) that ``"*"`` stands for: those that MuJoCo would let collide.

    Geoms without a name get one, in place.

    Raises:
        InputError: there are none.
    """
    name_all("geom", spec.geoms)
    copy = spec.copy()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the user's own compilation gives them
        model = copy.compile()
    named = model.geom(surface if body == ANY else body).id
    others = [model.geom(i).name for i in range(model.ngeom) if condim_of(model, named, i)]
    if not others:
        raise InputError(f"geom {model.geom(named).name!r} can collide with no other; check contype, conaffinity and excludes")
    return [(other, surface) if body == ANY else (body, other) for other in others]


def name_all(kind: str, elements: Sequence[Any]) -> set[str]:
    """Give those of a spec's elements that have no name one, in place; return these names."""
    taken, made = {e.name for e in elements}, set[str]()
    for i, element in enumerate(elements):
        if not element.name:
            element.name = f"{kind}_{i}"
            while element.name in taken:
                element.name += "_"
            made.add(element.name)
    return made


def condim_of(model: mujoco.MjModel, a: int, b: int) -> int:
    """Return the dimension of the contacts of two geoms, 0 if they cannot touch."""
    for i in range(model.npair):
        if {int(model.pair_geom1[i]), int(model.pair_geom2[i])} == {a, b}:
            return int(model.pair_dim[i])
    if not _passes_filters(model, a, b):
        return 0
    if model.geom_priority[a] != model.geom_priority[b]:
        return int(model.geom_condim[a if model.geom_priority[a] > model.geom_priority[b] else b])
    return int(max(model.geom_condim[a], model.geom_condim[b]))


def _passes_filters(model: mujoco.MjModel, a: int, b: int) -> bool:
    """Return whether two geoms without a pair collide (MuJoCo's documentation, computation chapter, collision detection)."""
    kinds = {mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD}
    if a == b or {int(model.geom_type[a]), int(model.geom_type[b])} <= {int(k) for k in kinds}:
        return False
    if not (model.geom_contype[a] & model.geom_conaffinity[b] or model.geom_contype[b] & model.geom_conaffinity[a]):
        return False
    bodies = sorted((int(model.geom_bodyid[a]), int(model.geom_bodyid[b])))
    if (bodies[0] << 16) + bodies[1] in model.exclude_signature:
        return False
    welds = [int(model.body_weldid[i]) for i in bodies]
    parents = [int(model.body_weldid[model.body_parentid[w]]) for w in welds]
    filtered = not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT
    if filtered and 0 not in welds and (welds[0] == parents[1] or welds[1] == parents[0]):
        return False
    return welds[0] != welds[1]


def warn_of_filters(spec: mujoco.MjSpec, body: str, surface: str) -> None:
    """Warn where two geoms collide only because a pair of them is made now, or where flexible bodies are left out."""
    said = ""
    if ANY in (body, surface):
        if spec.flexes:
            flexible = "contacts of the model's flexible bodies keep MuJoCo's own friction"
            said = f"friction ({body!r}, {surface!r}) is for geoms: {flexible}"
    elif not any({p.geomname1, p.geomname2} == {body, surface} for p in spec.pairs):
        a, b = spec.geom(body), spec.geom(surface)
        excluded = any({x.bodyname1, x.bodyname2} == {a.parent.name, b.parent.name} for x in spec.excludes)
        if excluded or not (a.contype & b.conaffinity or b.contype & a.conaffinity):
            why = "are excluded from colliding" if excluded else "do not collide by contype and conaffinity"
            remedy = "choose other geoms if that is not what you want"
            said = f"geoms {body!r} and {surface!r} {why}; as a pair with friction they do from now on: {remedy}"
    if said:
        warnings.warn(said, ContactWarning, stacklevel=3)


def require_free(spec: mujoco.MjSpec, pairs: list[tuple[str, str]]) -> None:
    """Refuse pairs that an instance of this package has already."""
    for plugin in spec.plugins:
        if plugin.plugin_name != PAIRS:
            continue
        theirs = plugin.config.get("geom1"), plugin.config.get("geom2")
        for pair in pairs:
            if covers(theirs, pair):
                raise InputError(
                    f"geoms {pair[0]!r} and {pair[1]!r} have friction already, from the plugin instance {plugin.name!r}; "
                    "build the spec anew to change it, or name the geoms one by one instead of '*'"
                )


def _carrier(spec: mujoco.MjSpec, geom: Any) -> Any:
    """Return the body that carries a geom: the nearest one with joints, or the world."""
    body = geom.parent
    while body != spec.worldbody and not body.joints:
        body = body.parent
    return body


def take_over(spec: mujoco.MjSpec, body: str, surface: str, mu_s: float) -> None:
    """Make the two geoms an explicit pair with sliding friction ``mu_s`` and otherwise the contact that they had.

    In a model that has lost this package's plugin (``MjSpec.attach`` leaves it behind), the pair has MuJoCo's own friction.
    """
    made: Any = next((p for p in spec.pairs if {p.geomname1, p.geomname2} == {body, surface}), None)
    if made is None:
        a, b = spec.geom(body), spec.geom(surface)
        made = spec.add_pair(geomname1=body, geomname2=surface)
        chosen = [a, b] if a.priority == b.priority else [max(a, b, key=lambda g: g.priority)]
        made.condim = max(g.condim for g in chosen)
        made.friction = np.max([g.friction for g in chosen], axis=0)[[0, 0, 1, 2, 2]]
        made.solref[:], made.solimp[:] = np.nan, np.nan  # MuJoCo's compiler mixes those of the geoms
        made.margin, made.gap = a.margin + b.margin, a.gap + b.gap
        made.adhesion = sum(g.adhesion for g in chosen)
    made.condim = max(3, made.condim)
    made.friction = [mu_s, mu_s, *made.friction[2:]]
