"""Add friction to a joint or tendon of any MuJoCo model, and read it while the model runs."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import config, coordinates
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.dof_plugin import NAME, register_joints, require_no_hold
from stochfric_mb.mujoco.reading import Reading


@dataclasses.dataclass(frozen=True)
class Joint:
    """A hinge or slide joint, as the place of friction."""

    name: str
    """Name of the joint in the model."""


@dataclasses.dataclass(frozen=True)
class Tendon:
    """A fixed or spatial tendon, as the place of friction."""

    name: str
    """Name of the tendon in the model."""


def add_joint_friction(
    spec: mujoco.MjSpec,
    place: Joint | Tendon,
    friction: Law | Friction,
    *,
    normal_force: float | None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
) -> str:
    """Return the name of the plugin instance that now computes the friction of a joint or tendon.

    Its ``frictionloss`` becomes 0: the law takes its place, at the force level mu_s normal_force.

    Args:
        spec: the model, before it is compiled; changed in place.
        place: the joint or tendon.
        friction: a law, or a `Friction` with a coefficient process. For a hinge the law's lengths and velocities are
            angles [rad] and rates [rad/s].
        normal_force: the given load [N]; for a hinge, times the radius at which it rubs [N m].
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this place in the model.

    Raises:
        InputError: unknown or unsuitable joint, no load, a law that cannot run here, or an address out of range.
    """
    register_joints()
    what = "joint" if isinstance(place, Joint) else "tendon"
    if normal_force is None:
        raise InputError(f"friction on {what} {place.name!r} needs its load: give normal_force [N, for a hinge N m]")
    load = require_number("normal_force", normal_force, above=0.0, unit="N or N m")
    element = _element(spec, place, what)
    friction = as_friction(friction)
    require_no_hold(friction.law)
    friction.path(seed, sample, contact)  # checks the address and the process against the law
    texts = config.configuration(friction, "", "", seed=seed, sample=sample, contact=contact)
    name = f"friction_{place.name}"
    if name in {p.name for p in spec.plugins}:
        raise InputError(f"the model has a plugin {name!r} already: this {what} has friction; build the spec anew to change it")
    plugin: Any = spec.add_plugin(name=name, plugin_name=NAME, active=True)
    kept = {key: texts[key] for key in ("law", "coefficients", "seed", "sample", "contact") if texts[key]}
    plugin.config = kept | {what: place.name, "normal_force": repr(load)}
    spec.activate_plugin(NAME)
    element.frictionloss = 0.0
    return name


def joint_instances(model: mujoco.MjModel) -> list[int]:
    """Return the plugin instances of a model that are friction on joints and tendons."""
    slot = register_joints()
    return [i for i in range(model.nplugin) if model.plugin[i] == slot]


def joint_reading(model: mujoco.MjModel, state: np.ndarray[Any, Any]) -> list[Reading]:
    """Return what the friction of one joint or tendon did, as a list of one, empty before the first step."""
    if not state[s.N_CURRENT]:
        return []
    first = s.DESCRIPTOR + int(state[s.N_DESCRIPTOR]) + s.SLOT
    row = state[first : first + s.SLOT]
    kind = mujoco.mjtObj.mjOBJ_TENDON if state[coordinates.KIND] else mujoco.mjtObj.mjOBJ_JOINT
    name = mujoco.mj_id2name(model, kind, int(state[coordinates.OBJECT]))
    return [
        Reading(
            time=float(state[s.EVALUATED]),
            body=name,
            surface="",
            force=(float(row[s.FX]), 0.0, 0.0),
            normal_force=float(row[s.NORMAL]),
            mu_s=float(row[s.MU_S]),
            mu_k=float(row[s.MU_K]),
            stick=bool(row[s.STICK]),
            displacement=(float(row[s.UX]), 0.0),
            velocity=(float(row[s.VX]), 0.0),
            effective_mass=float(row[s.MASS]),
            stick_phases=int(row[s.EVENTS]),
            dissipated=float(row[s.ENERGY]),
        )
    ]


def _element(spec: mujoco.MjSpec, place: Joint | Tendon, what: str) -> Any:
    elements = [e for e in (spec.joints if isinstance(place, Joint) else spec.tendons) if e.name]
    require_name(what, place.name, [e.name for e in elements])
    element = next(e for e in elements if e.name == place.name)
    if isinstance(place, Joint) and element.type not in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
        raise InputError(
            f"joint {place.name!r} is a ball or free joint, and friction needs one coordinate; "
            "use hinge or slide joints, or a pair of geoms"
        )
    return element
