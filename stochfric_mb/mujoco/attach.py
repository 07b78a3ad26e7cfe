"""Add friction to a pair of geoms of any MuJoCo model, and read it while the model runs."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
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
from stochfric_mb.mujoco.plugin import NAME, register


class IntegratorWarning(UserWarning):
    """An integrator with which friction is known to be inaccurate."""


@dataclasses.dataclass(frozen=True)
class Reading:
    """One contact as its friction saw it at the last evaluation at a step's start."""

    time: float
    """Time [s]."""
    body: str
    """Geom on which ``force`` acts; a joint's or tendon's name."""
    surface: str
    """The counter-surface; empty for a joint or tendon."""
    force: tuple[float, float, float]
    """Friction force on the body [N], world axes; for a joint or tendon, along its coordinate [N or N m], 0, 0."""
    normal_force: float
    """Normal force that the law was given [N]."""
    mu_s: float
    """Static coefficient [-]."""
    mu_k: float
    """Kinetic coefficient [-]."""
    stick: bool
    """Whether the contact sticks."""
    displacement: tuple[float, float]
    """Relative displacement, surface minus body, in the contact's tangent frame [m]."""
    velocity: tuple[float, float]
    """Relative velocity, likewise [m/s]."""
    effective_mass: float
    """Mass that the contact feels [kg], 0 for laws that do not use it."""
    stick_phases: int
    """How many times the contact has begun to stick since it was made."""
    dissipated: float
    """Energy dissipated since the contact was made [J]."""


def add_friction(
    spec: mujoco.MjSpec,
    geoms: tuple[str, str] | Joint | Tendon,
    friction: Law | Friction,
    *,
    normal_force: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    slots: int = 16,
    mode: str = "auto",
) -> str:
    """Return the name of the plugin instance that now computes the friction between two geoms, or of a joint or tendon.

    The pair becomes an explicit contact pair with ``condim`` 1 (no native friction); all other contacts stay as they are.

    Args:
        spec: the model, before it is compiled; changed in place.
        geoms: names of the body's geom and of the counter-surface's, or a `Joint` or `Tendon` (see `add_joint_friction`).
        friction: a law, or a `Friction` with a coefficient process.
        normal_force: the given load of a joint or tendon [N, for a hinge N m]; contacts have MuJoCo's own normal force.
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this pair in the model.
        slots: most contacts between the two geoms at a time.
        mode: ``explicit``, ``implicit``, or ``auto``: explicit where the step is below half the law's limit.

    Raises:
        InputError: unknown geom, a law that cannot run here, an address out of range, or options that switch passive
            forces off.

    Warns:
        IntegratorWarning: the model uses the ``discrete`` integrator.
    """
    register()
    _require_passive_forces(spec)
    if isinstance(geoms, Joint | Tendon):
        return add_joint_friction(spec, geoms, friction, normal_force=normal_force, seed=seed, sample=sample, contact=contact)
    if normal_force is not None:
        raise InputError(f"normal_force = {normal_force!r} is for joints and tendons; contacts have MuJoCo's normal force")
    body, surface = _require_geoms(spec, geoms)
    texts = configuration(
        as_friction(friction), body, surface, seed=seed, sample=sample, contact=contact, slots=_require_slots(slots), mode=mode
    )
    name = _free_name(spec, f"friction_{body}_{surface}")
    plugin: Any = spec.add_plugin(name=name, plugin_name=NAME, active=True)
    plugin.config = {key: value for key, value in texts.items() if value}
    spec.activate_plugin(NAME)
    _take_over(spec, body, surface)
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
    return [_reading(model, state, row) for row in block]


def _reading(model: mujoco.MjModel, state: Any, row: Any) -> Reading:
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
    body, surface = (require_name("geom", name, known) for name in geoms)
    if body == surface:
        raise InputError(f"geoms = {geoms!r} names one geom twice; friction needs two")
    if "*" not in geoms and _carrier(spec.geom(body)) == _carrier(spec.geom(surface)):
        raise InputError(f"geoms = {geoms!r} belong to one rigid body, so they never slide on each other; choose geoms that move")
    return body, surface


def _carrier(geom: Any) -> int:
    """Return the number of the body that carries a geom: the nearest one with joints, or the world."""
    body = geom.parent
    while body.parent is not None and body.parent.id != body.id and not body.joints and body.id != 0:
        body = body.parent
    return int(body.id)


def _require_passive_forces(spec: mujoco.MjSpec) -> None:
    off = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    if spec.option.disableflags & off == off:
        raise InputError(
            "option.disableflags has both spring and damper disabled, with which MuJoCo leaves out all passive forces, "
            "friction too; enable one of them (and set stiffness or damping to 0 instead)"
        )
    if spec.option.integrator == mujoco.mjtIntegrator.mjINT_DISCRETE:
        warnings.warn(
            "integrator discrete: its friction error is twenty times that of Euler; use RK4 (best), Euler or implicitfast",
            IntegratorWarning,
            stacklevel=3,
        )


def _require_slots(slots: int) -> int:
    if int(slots) != slots or not 0 < slots <= MAX_SLOTS:
        raise InputError(f"slots = {slots!r} must be a whole number from 1 to {MAX_SLOTS}; 16 suits most pairs")
    return int(slots)


def _free_name(spec: mujoco.MjSpec, name: str) -> str:
    taken = {p.name for p in spec.plugins}
    if name in taken:
        raise InputError(f"the model has a plugin {name!r} already: this pair has friction; build the spec anew to change it")
    return name


def _take_over(spec: mujoco.MjSpec, body: str, surface: str) -> None:
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
