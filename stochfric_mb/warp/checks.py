"""What is refused before the first step."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mujoco import Joint, Tendon
from stochfric_mb.mujoco.pairs import condim_of

ANY = "*"
"""Stands for every geom that the other one can collide with."""
INTEGRATORS = ("Euler", "implicitfast", "implicit")
"""Integrators that take what is written in the passive stage."""


def check_options(model: mujoco.MjModel, m: mjw.Model, d: mjw.Data) -> None:
    """Check the model's options.

    Raises:
        InputError: the model and the device's do not belong together, or an option that friction cannot run with.
    """
    if m.ngeom != model.ngeom or m.nv != model.nv:
        raise InputError(f"the model has {model.ngeom} geoms, m has {m.ngeom}; give the model that put_model was called with")
    if int(m.opt.cone) != int(mujoco.mjtCone.mjCONE_ELLIPTIC):
        raise InputError(
            "opt.cone is pyramidal, where the coefficient is frozen into the constraint rows; set "
            'model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC (MJCF: <option cone="elliptic"/>) before put_model'
        )
    names = {int(getattr(mujoco.mjtIntegrator, f"mjINT_{n.upper()}")): n for n in INTEGRATORS}
    if int(m.opt.integrator) not in names:
        name = mujoco.mjtIntegrator(int(m.opt.integrator)).name.removeprefix("mjINT_")
        raise InputError(
            f"opt.integrator = {name} commits a contact more than once a step; use one of {', '.join(INTEGRATORS)}"
        )
    off = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    if int(m.opt.disableflags) & int(off) == int(off):
        raise InputError(
            "springs and dampers are both disabled, which switches the passive stage off, and friction with it; enable one"
        )
    for bit in ("CONTACT", "CONSTRAINT"):
        if int(m.opt.disableflags) & int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{bit}")):
            raise InputError(f"{bit.lower()}s are disabled (disableflags), so that there is no friction; enable them")


def partners_of(model: mujoco.MjModel, geoms: tuple[str, str]) -> np.ndarray[Any, np.dtype[np.int32]]:
    """Return which geoms rub on which: 1 for (body, counter-surface), -1 for the reverse order, 0 otherwise, (ngeom, ngeom).

    Raises:
        InputError: a name is unknown, or nothing can collide.
    """
    if isinstance(geoms, str) or len(geoms) != 2:
        raise InputError(f"geoms = {geoms!r} is not a pair; give the names of the body's and the counter-surface's geom")
    known = [model.geom(i).name for i in range(model.ngeom) if model.geom(i).name]
    body, surface = (name if name == ANY else require_name("geom", name, known) for name in geoms)
    if body == surface:
        raise InputError(f"geoms = {geoms!r} must be two geoms, one of which may be '*'; name both")
    everything = list(range(model.ngeom))
    bodies = everything if body == ANY else [int(model.geom(body).id)]
    surfaces = everything if surface == ANY else [int(model.geom(surface).id)]
    partners = np.zeros((model.ngeom, model.ngeom), dtype=np.int32)
    condims: set[int] = set()
    for b in bodies:
        for s in surfaces:
            condim = condim_of(model, b, s)
            if condim:
                partners[b, s], partners[s, b] = 1, -1
                condims.add(condim)
    if not condims:
        raise InputError(f"geoms {body!r} and {surface!r} can never touch; check contype, conaffinity, excludes and pairs")
    if min(condims) < 3:
        raise InputError(
            f"contacts of {body!r} and {surface!r} have condim {min(condims)}: no friction that a law could steer; set condim "
            "to 3 (or 4, 6) on the geoms or the pair before put_model"
        )
    return partners


def row_of(model: mujoco.MjModel, place: Joint | Tendon) -> tuple[tuple[int, int], float]:
    """Return type and number of the friction row of a joint or tendon, and its mobility [1/kg, 1/(kg m^2)].

    Raises:
        InputError: it is unknown, has more than one coordinate, or no friction row.
    """
    if isinstance(place, Tendon):
        number = _numbered("tendon", place.name, [model.tendon(i).name for i in range(model.ntendon)])
        kind, loss, mobility = "TENDON", model.tendon_frictionloss[number], model.tendon_invweight0[number]
    else:
        joint = _numbered("joint", place.name, [model.joint(i).name for i in range(model.njnt)])
        if int(model.jnt_type[joint]) not in {int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)}:
            raise InputError(
                f"joint {place.name!r} is a ball or free joint; friction needs one coordinate: take a slide or hinge"
            )
        number = int(model.jnt_dofadr[joint])
        kind, loss, mobility = "DOF", model.dof_frictionloss[number], model.dof_invweight0[number]
    if loss <= 0.0 or model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS:
        raise InputError(
            f"{place.name!r} has no friction row; give it frictionloss > 0 (any number: the law replaces it) and leave "
            "frictionloss enabled before put_model"
        )
    row = int(getattr(mujoco.mjtConstraint, f"mjCNSTR_FRICTION_{kind}"))
    return (row, number), float(mobility)


def _numbered(what: str, name: str, names: list[str]) -> int:
    return names.index(require_name(what, name, [n for n in names if n]))


def check_contacts(model: mujoco.MjModel, d: mjw.Data, partners: Any, slots: int | None) -> None:
    """Check that the contacts that are there now find room.

    Raises:
        InputError: ``slots`` is no number from 1 on, or fewer than the contacts of a world.
    """
    if slots is None:
        return
    if int(slots) != slots or slots < 1:
        raise InputError(f"slots = {slots!r} must be a whole number from 1 on; leave it out for as many as can be")
    n = min(int(d.nacon.numpy()[0]), d.naconmax)
    pairs, worlds = d.contact.geom.numpy()[:n], d.contact.worldid.numpy()[:n]
    ours = [w for (a, b), w in zip(pairs, worlds, strict=True) if a >= 0 and b >= 0 and partners[a, b]]
    most = max(np.bincount(ours)) if ours else 0
    if most > slots:
        raise InputError(f"{most} contacts in one world, but slots = {slots}; give at least that many, or leave slots out")
