"""Add friction to a joint or tendon of any MuJoCo model."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.friction import Friction
from stochfric_mb.mujoco.plugin import configuration
from stochfric_mb.mujoco.plugin.joint import NAME, register_joints

REACTION = "reaction"
"""The load that a joint's own reaction makes."""


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
    friction: Friction,
    *,
    normal_force: float | str | None,
    radius: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    mode: str = "auto",
) -> str:
    """Return the name of the plugin instance that now sets the friction of a joint or tendon.

    The law steers MuJoCo's own friction of the coordinate, ``frictionloss``, which becomes mu_s normal_force.

    Args:
        spec: the model, before it is compiled; changed in place.
        place: the joint or tendon.
        friction: a law with its coefficient process. For a hinge the law's lengths and velocities are
            angles [rad] and rates [rad/s].
        normal_force: the given load [N]; for a hinge, times the radius at which it rubs [N m]. Or "reaction": the force
            between the joint's two bodies, step by step (of a slide joint, across its axis).
        radius: with "reaction", the radius [m] of a hinge's bearing.
        seed: first part of the coefficient path's address.
        sample: second part: the run of an ensemble.
        contact: third part: number of this place in the model.
        mode: as of `add_friction`.

    Raises:
        InputError: unknown or unsuitable joint, no load, a law that cannot run here, or an address out of range.
    """
    register_joints()
    what = "joint" if isinstance(place, Joint) else "tendon"
    element = _element(spec, place, what)
    load = _load(place, element, what, normal_force, radius)
    texts = configuration.configuration(friction, "", "", seed=seed, sample=sample, contact=contact, mode=mode)
    name = f"friction_{place.name}"
    if name in {p.name for p in spec.plugins}:
        raise InputError(f"the model has a plugin {name!r} already: this {what} has friction; build the spec anew to change it")
    plugin: Any = spec.add_plugin(name=name, plugin_name=NAME, active=True)
    kept = {key: texts[key] for key in ("law", "coefficients", "seed", "sample", "contact", "mode") if texts[key]}
    plugin.config = kept | {what: place.name} | load
    spec.activate_plugin(NAME)
    element.frictionloss = friction.law.mu_s * float(load.get("normal_force", 1.0))
    return name


def _load(
    place: Joint | Tendon, element: Any, what: str, normal_force: float | str | None, radius: float | None
) -> dict[str, str]:
    """Return the load as the plugin's key and value."""
    if normal_force is None:
        raise InputError(
            f"friction on {what} {place.name!r} needs its load: give normal_force [N, for a hinge N m], or "
            'normal_force="reaction" with the radius [m] of a hinge\'s bearing'
        )
    if normal_force != REACTION:
        if radius is not None:
            raise InputError(
                f'radius = {radius!r} goes with normal_force="reaction"; a given load of a hinge is in N m already'
            )
        return {"normal_force": repr(require_number("normal_force", normal_force, above=0.0, unit="N or N m"))}
    if isinstance(place, Tendon):
        raise InputError(f"tendon {place.name!r} has no bearing with a reaction; give normal_force as a number [N]")
    if element.type == mujoco.mjtJoint.mjJNT_SLIDE:
        if radius is not None:
            raise InputError(f"radius = {radius!r}: a slide joint has none; leave it out")
        return {"radius": "1.0"}
    if radius is None:
        raise InputError(f"joint {place.name!r} is a hinge: give the radius [m] at which its bearing rubs")
    return {"radius": repr(require_number("radius", radius, above=0.0, unit="m"))}


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
