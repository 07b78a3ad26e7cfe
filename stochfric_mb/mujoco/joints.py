"""Joints and tendons as places of friction: their elements in a spec, and their loads."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import mujoco

from stochfric_mb.errors import InputError, require_name, require_number

REACTION = "reaction"
"""The load that a joint's own reaction makes."""


@dataclasses.dataclass(frozen=True)
class Joint:
    """A hinge or slide joint, as the place of friction."""

    name: str
    """Name of the joint in the model."""
    kind: ClassVar = "joint"


@dataclasses.dataclass(frozen=True)
class Tendon:
    """A fixed or spatial tendon, as the place of friction."""

    name: str
    """Name of the tendon in the model."""
    kind: ClassVar = "tendon"


def load_of(place: Joint | Tendon, element: Any, normal_force: float | str | None, radius: float | None) -> dict[str, str]:
    """Return the load as the plugin's key and value.

    Raises:
        InputError: no load, or one that the place cannot have.
    """
    if normal_force is None:
        raise InputError(
            f"friction on {place.kind} {place.name!r} needs its load: give normal_force [N, for a hinge N m], or "
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


def element_of(spec: mujoco.MjSpec, place: Joint | Tendon) -> Any:
    """Return the joint or tendon in a spec.

    Raises:
        InputError: there is none of that name, or it has more than one coordinate.
    """
    elements = [e for e in (spec.joints if isinstance(place, Joint) else spec.tendons) if e.name]
    require_name(place.kind, place.name, [e.name for e in elements])
    element = next(e for e in elements if e.name == place.name)
    if isinstance(place, Joint) and element.type not in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
        raise InputError(
            f"joint {place.name!r} is a ball or free joint, and friction needs one coordinate; "
            "use hinge or slide joints, or a pair of geoms"
        )
    return element
