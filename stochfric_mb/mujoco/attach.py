"""Add friction to a pair of geoms of any MuJoCo model, and read it while the model runs."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import warnings
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.config import MAX_SLOTS, configuration
from stochfric_mb.mujoco.joints import Joint, Tendon, add_joint_friction, joint_instances, joint_reading
from stochfric_mb.mujoco.options import check_options
from stochfric_mb.mujoco.plugin import NAME, register
from stochfric_mb.mujoco.reading import Reading

ANY = "*"
"""Stands for every geom that the other one can collide with."""


def add_friction(
    spec: mujoco.MjSpec,
    geoms: tuple[str, str] | Joint | Tendon,
    friction: Law | Friction,
    *,
    normal_force: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    slots: int | None = None,
    mode: str = "auto",
) -> str:
    """Return the name of the plugin instance that now computes the friction between two geoms, or of a joint or tendon.

    The pair becomes an explicit contact pair with ``condim`` 1 (no native friction); all other contacts stay as they are.
    With ``"*"`` for one side, so does every pair of the named geom with a geom that it can collide with (by contype,
    conaffinity, excludes, welding and the parent filter); geoms without a name get one. All these contacts share one
    coefficient path; give them an instance each to have paths of their own.

    Args:
        spec: the model, before it is compiled; changed in place.
        geoms: names of the body's geom and of the counter-surface's (one may be ``"*"``), or a `Joint` or `Tendon`
            (see `add_joint_friction`).
        friction: a law, or a `Friction` with a coefficient process.
        normal_force: the given load of a joint or tendon [N, for a hinge N m]; contacts have MuJoCo's own normal force.
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this pair in the model.
        slots: most contacts at a time; 16, or four for each pair of a ``"*"``, if not given.
        mode: ``explicit``, ``implicit``, or ``auto``: explicit where the step is below half the law's limit.

    Raises:
        InputError: unknown geom, a law that cannot run here, an address out of range, or options that switch passive
            forces off.

    Warns:
        IntegratorWarning: the model uses the ``discrete`` integrator.
    """
    register()
    check_options(spec.option.disableflags, spec.option.integrator)
    if isinstance(geoms, Joint | Tendon):
        return add_joint_friction(spec, geoms, friction, normal_force=normal_force, seed=seed, sample=sample, contact=contact)
    if normal_force is not None:
        raise InputError(f"normal_force = {normal_force!r} is for joints and tendons; contacts have MuJoCo's normal force")
    body, surface = _require_geoms(spec, geoms)
    pairs = colliding_pairs(spec, body, surface) if ANY in (body, surface) else [(body, surface)]
    _require_free(spec, pairs)
    slots = max(16, min(4 * len(pairs), MAX_SLOTS)) if slots is None else slots
    texts = configuration(
        as_friction(friction), body, surface, seed=seed, sample=sample, contact=contact, slots=require_slots(slots), mode=mode
    )
    name = _free_name(spec, f"friction_{body}_{surface}".replace(ANY, "any"))
    plugin: Any = spec.add_plugin(name=name, plugin_name=NAME, active=True)
    plugin.config = {key: value for key, value in texts.items() if value}
    spec.activate_plugin(NAME)
    for pair in pairs:
        take_over(spec, *pair)
    return name


def readings(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, list[Reading]]:
    """Return what each friction instance did at its contacts, by instance name.

    The readings belong to the last evaluation at a step's start: call ``mj_forward`` first to have them at ``data.time``.
    """
    found = {_name(model, mujoco.mjtObj.mjOBJ_PLUGIN, i): _instance_readings(model, data, i) for i in friction_instances(model)}
    for i in joint_instances(model):
        found[_name(model, mujoco.mjtObj.mjOBJ_PLUGIN, i)] = joint_reading(model, header(model, data, i))
    return found


def friction_instances(model: mujoco.MjModel) -> list[int]:
    """Return the plugin instances of a model that are friction of this package."""
    slot = register()
    return [i for i in range(model.nplugin) if model.plugin[i] == slot]


def header(model: mujoco.MjModel, data: mujoco.MjData, instance: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the state of one instance as an array (a view), laid out as `slots` says."""
    first = int(model.plugin_stateadr[instance])
    return data.plugin_state[first : first + int(model.plugin_statenum[instance])]


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    return mujoco.mj_id2name(model, kind, number) or f"#{number}"


def _instance_readings(model: mujoco.MjModel, data: mujoco.MjData, instance: int) -> list[Reading]:
    state = header(model, data, instance)
    first = s.DESCRIPTOR + int(state[s.N_DESCRIPTOR]) + int(state[s.N_SLOTS]) * s.SLOT
    block = state[first : first + int(state[s.N_CURRENT]) * s.SLOT].reshape(-1, s.SLOT)
    return [reading_of(model, state, row) for row in block]


def reading_of(model: mujoco.MjModel, state: Any, row: Any) -> Reading:
    """Return the reading of one contact from its instance's state and its slot there."""
    force = row[s.FX] * row[s.AXIS_1 : s.AXIS_1 + 3] + row[s.FY] * row[s.AXIS_2 : s.AXIS_2 + 3]
    pair = [int(row[s.GEOM_1]) - 1, int(row[s.GEOM_2]) - 1]
    body, surface = int(state[s.GEOM_BODY]), int(state[s.GEOM_SURFACE])
    if pair[1] == body or (body < 0 and pair[0] == surface):
        pair.reverse()
    return Reading(
        time=float(state[s.EVALUATED]),
        body=_name(model, mujoco.mjtObj.mjOBJ_GEOM, pair[0]),
        surface=_name(model, mujoco.mjtObj.mjOBJ_GEOM, pair[1]),
        force=(float(force[0]), float(force[1]), float(force[2])),
        normal_force=float(row[s.NORMAL]),
        mu_s=float(row[s.MU_S]),
        mu_k=float(row[s.MU_K]),
        stick=bool(row[s.STICK]),
        displacement=(float(row[s.UX]), float(row[s.UY])),
        velocity=(float(row[s.VX]), float(row[s.VY])),
        effective_mass=float(row[s.MASS]),
        stick_phases=int(row[s.EVENTS]),
        dissipated=float(row[s.ENERGY]),
    )


def _require_geoms(spec: mujoco.MjSpec, geoms: tuple[str, str]) -> tuple[str, str]:
    if isinstance(geoms, str) or len(geoms) != 2:
        raise InputError(f"geoms = {geoms!r} is not a pair; give the names of the body's and the counter-surface's geom")
    known = [g.name for g in spec.geoms if g.name]
    body, surface = (name if name == ANY else require_name("geom", name, known) for name in geoms)
    if body == surface == ANY:
        raise InputError("geoms = ('*', '*') names no geom; name one of the two, e.g. ('*', 'floor')")
    if body == surface:
        raise InputError(f"geoms = {geoms!r} names one geom twice; friction needs two")
    if "*" not in geoms and _carrier(spec, spec.geom(body)) == _carrier(spec, spec.geom(surface)):
        raise InputError(f"geoms = {geoms!r} belong to one rigid body and never slide on each other; choose others")
    return body, surface


def colliding_pairs(spec: mujoco.MjSpec, body: str, surface: str) -> list[tuple[str, str]]:
    """Return the pairs (body's geom, surface's geom) that ``"*"`` stands for: those that MuJoCo would let collide.

    Geoms without a name get one, in place.

    Raises:
        InputError: there are none.
    """
    for i, geom in enumerate(spec.geoms):
        if not geom.name:
            geom.name = f"geom_{i}"
    copy = spec.copy()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the user's own compilation gives them
        model = copy.compile()
    named = model.geom(surface if body == ANY else body).id
    others = [model.geom(i).name for i in range(model.ngeom) if _can_collide(model, named, i)]
    if not others:
        raise InputError(f"geom {model.geom(named).name!r} can collide with no other; check contype, conaffinity and excludes")
    return [(other, surface) if body == ANY else (body, other) for other in others]


def copied(spec: mujoco.MjSpec) -> mujoco.MjSpec:
    """Return a copy of a spec with its plugin instances, which ``MjSpec.copy`` leaves out."""
    copy: Any = spec.copy()
    have = {p.name for p in copy.plugins}
    for plugin in spec.plugins:
        if plugin.name not in have:
            made = copy.add_plugin(name=plugin.name, plugin_name=plugin.plugin_name, active=plugin.active)
            made.config = dict(plugin.config)
            copy.activate_plugin(plugin.plugin_name)
    return copy


def _can_collide(model: mujoco.MjModel, a: int, b: int) -> bool:
    """Return whether MuJoCo lets two geoms collide (its documentation, computation chapter, collision detection)."""
    pairs = {frozenset((int(i), int(j))) for i, j in zip(model.pair_geom1, model.pair_geom2, strict=True)}
    if frozenset((a, b)) in pairs:
        return True
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


def _require_free(spec: mujoco.MjSpec, pairs: list[tuple[str, str]]) -> None:
    """Refuse pairs that an instance of this package has already."""
    for plugin in spec.plugins:
        if plugin.plugin_name != NAME:
            continue
        theirs = plugin.config.get("geom1"), plugin.config.get("geom2")
        for pair in pairs:
            if any(
                all(mine in (its, ANY) or its == ANY for mine, its in zip(p, theirs, strict=True)) for p in (pair, pair[::-1])
            ):
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


def require_slots(slots: int) -> int:
    """Return a number of slots.

    Raises:
        InputError: it is no whole number, or out of range.
    """
    if int(slots) != slots or not 0 < slots <= MAX_SLOTS:
        raise InputError(f"slots = {slots!r} must be a whole number from 1 to {MAX_SLOTS}; 16 suits most pairs")
    return int(slots)


def _free_name(spec: mujoco.MjSpec, name: str) -> str:
    taken = {p.name for p in spec.plugins}
    if name in taken:
        raise InputError(f"the model has a plugin {name!r} already: this pair has friction; build the spec anew to change it")
    return name


def take_over(spec: mujoco.MjSpec, body: str, surface: str) -> None:
    """Make the two geoms an explicit pair without native friction, with the normal contact that they had."""
    for pair in spec.pairs:
        if {pair.geomname1, pair.geomname2} == {body, surface}:
            pair.condim = 1
            return
    a, b = spec.geom(body), spec.geom(surface)
    made: Any = spec.add_pair(geomname1=body, geomname2=surface)
    made.condim = 1
    made.solref, made.solimp = _mixed(a, b)
    made.margin = a.margin + b.margin
    made.gap = a.gap + b.gap
    made.adhesion = a.adhesion + b.adhesion if a.priority == b.priority else max(a, b, key=lambda g: g.priority).adhesion


def _mixed(a: Any, b: Any) -> tuple[Any, Any]:
    """Return solref and solimp of a contact by MuJoCo's mixing rules (modeling chapter, contact parameters)."""
    if a.priority != b.priority:
        chosen = a if a.priority > b.priority else b
        return chosen.solref, chosen.solimp
    total = a.solmix + b.solmix
    weight = a.solmix / total if total > 0.0 else 0.5
    solimp = weight * np.asarray(a.solimp) + (1.0 - weight) * np.asarray(b.solimp)
    if a.solref[0] <= 0.0 or b.solref[0] <= 0.0:
        return np.minimum(a.solref, b.solref), solimp
    return weight * np.asarray(a.solref) + (1.0 - weight) * np.asarray(b.solref), solimp
