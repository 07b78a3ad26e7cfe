"""Add friction to the contacts, joints and tendons of a MuJoCo Warp model, in all its worlds."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

from typing import Any

import mujoco
import mujoco_warp as mjw

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import Joint, Tendon
from stochfric_mb.mujoco.joints import REACTION
from stochfric_mb.warp.checks import check_contacts, check_options, partners_of, row_of
from stochfric_mb.warp.kinds import ContactFriction, JointFriction
from stochfric_mb.warp.law import require_runnable


def add_friction(
    model: mujoco.MjModel,
    m: mjw.Model,
    d: mjw.Data,
    geoms: tuple[str, str] | Joint | Tendon,
    friction: Law | Friction,
    *,
    normal_force: float | str | None = None,
    seed: int = 0,
    contact: int = 0,
    first_sample: int = 0,
    slots: int | None = None,
    new_paths: bool = False,
) -> ContactFriction | JointFriction:
    """Return the friction that now acts between two geoms, or in a joint or tendon, in every world.

    Call it once after ``put_model`` and ``put_data``.

    MuJoCo Warp's own solver computes the force; the law steers it (see `stochfric_mb.warp.contacts`). All other contacts stay
    as they are. World w has the coefficient path (seed, first_sample + w, contact).

    Args:
        model: the compiled model that ``m`` was made of.
        m: the model on the device.
        d: the data on the device.
        geoms: names of the body's geom and of the counter-surface's; one may be ``"*"``: all that it can collide with. Or a
            `stochfric_mb.mujoco.Joint` or `Tendon` with ``frictionloss`` > 0, which the law replaces.
        friction: a law, or a `Friction` with a coefficient process.
        normal_force: the given load of a joint or tendon [N, for a hinge N m]; contacts have the solver's own.
        seed: first part of the coefficient paths' addresses.
        contact: third part: number of this pair in the model.
        first_sample: second part of world 0.
        slots: most contacts of these geoms in one world; as many as the constraint rows of a world allow if not given.
        new_paths: whether a world that begins anew takes another path (its sample grows by the number of worlds).

    Raises:
        InputError: unknown geoms, geoms that cannot collide, contacts without friction, a pyramidal cone, an integrator
            or a law that cannot run here, an address out of range, or more contacts than slots.
    """
    known = as_friction(friction)
    require_runnable(known.law)
    check_options(model, m, d)
    for sample in (first_sample, first_sample + d.nworld - 1):
        known.path(seed, sample, contact)  # refuses what is out of range
    address: dict[str, Any] = {
        "timestep": float(model.opt.timestep), "seed": seed, "contact": contact, "first_sample": first_sample,
        "new_paths": new_paths,
    }  # fmt: skip
    if isinstance(geoms, Joint | Tendon):
        place, mobility = row_of(model, geoms)
        if normal_force == REACTION:
            raise InputError(
                f"normal_force = {REACTION!r}: MuJoCo Warp has a joint's reaction only after the step; give its load as a "
                "number [N, for a hinge N m], or use stochfric_mb.mujoco.add_friction, which follows the reaction"
            )
        load = require_number("normal_force", normal_force, above=0.0, unit="N or N m")
        made = JointFriction(known, d, place, load, mobility, **address)
    else:
        if normal_force is not None:
            raise InputError(f"normal_force = {normal_force!r} is for joints and tendons; contacts have the solver's own")
        partners = partners_of(model, geoms)
        check_contacts(model, d, partners, slots)
        made = ContactFriction(known, d, partners, max(d.njmax // 3, 1) if slots is None else slots, **address)
    chain(m, made.steer)
    return made


def chain(m: mjw.Model, steer: Any) -> None:
    """Let a model call ``steer`` in its passive stage, after what it called there before."""
    before = m.callback.passive
    if before is None:
        m.callback.passive = steer
        return

    def both(m: mjw.Model, d: mjw.Data) -> None:
        before(m, d)
        steer(m, d)

    m.callback.passive = both
