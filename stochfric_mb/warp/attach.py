"""Add friction to the contacts of a MuJoCo Warp model, in all its worlds."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.warp.cap import require_runnable
from stochfric_mb.warp.checks import check_contacts, check_options, partners_of
from stochfric_mb.warp.contacts import begin_kernel, observe, steer_kernel
from stochfric_mb.warp.worlds import slot_arrays, world_arrays


class ContactFriction:
    """Friction between two geoms in every world; made by `add_friction`."""

    def __init__(
        self, model: mujoco.MjModel, m: mjw.Model, d: mjw.Data, partners: Any, friction: Friction, *,
        seed: int, contact: int, first_sample: int, slots: int,
    ) -> None:  # fmt: skip
        """Lay out the state on the device; arguments as for `add_friction`."""
        self.law = friction.law
        """The law."""
        self.seed, self.contact = seed, contact
        self.nworld = d.nworld
        """Number of worlds."""
        self._timestep = float(model.opt.timestep)
        self._partners = wp.array(partners, dtype=int)
        self.worlds = world_arrays(friction, d.nworld, first_sample, self._timestep)
        """What it keeps of each world."""
        self.slots = slot_arrays(d.nworld, slots)
        """What it keeps of each contact."""
        self._begin, self._steer = begin_kernel(), steer_kernel(friction.law.kind)
        self.normal_force = wp.zeros(d.nworld, dtype=float)
        """Sum of the normal forces over the contacts of each world [N], as of the last `observe`."""
        self.friction_force = wp.zeros(d.nworld, dtype=float)
        """Sum of the sizes of the friction forces [N], likewise."""
        self.stick = wp.zeros(d.nworld, dtype=int)
        """1 where all loaded contacts stick, 0 where one slides or none is loaded, likewise."""
        self.contacts = wp.zeros(d.nworld, dtype=int)
        """Number of loaded contacts, likewise."""

    @property
    def mu_s(self) -> wp.array[float]:
        """Static coefficient of each world in the last step [-], on the device."""
        return self.worlds.mu_s

    @property
    def mu_k(self) -> wp.array[float]:
        """Kinetic coefficient of each world in the last step [-], on the device."""
        return self.worlds.mu_k

    def steer(self, m: mjw.Model, d: mjw.Data) -> None:
        """Launch the kernels of one step; ``Model.callback.passive`` calls it."""
        wp.launch(
            self._begin,
            dim=self.nworld,
            inputs=[d.time, self._timestep, self.seed, self.contact, self.worlds, self.slots],
        )
        contact, efc = d.contact, d.efc
        wp.launch(
            self._steer,
            dim=d.naconmax,
            inputs=[
                d.nacon, contact.geom, contact.worldid, contact.dim, contact.efc_address, contact.frame, contact.pos,
                contact.solimp, d.geom_xpos, m.opt.timestep, m.opt.gravity, efc.vel, efc.force, self._partners,
                self.worlds, self.slots,
            ],
            outputs=[contact.friction, efc.D, efc.aref],
        )  # fmt: skip

    def observe(self, d: mjw.Data) -> None:
        """Bring the readings up to the step just made; nothing is copied to the host."""
        outputs = [self.normal_force, self.friction_force, self.stick, self.contacts]
        wp.launch(observe, dim=self.nworld, inputs=[d.efc.force, self.worlds, self.slots], outputs=outputs)


def add_friction(
    model: mujoco.MjModel,
    m: mjw.Model,
    d: mjw.Data,
    geoms: tuple[str, str],
    friction: Law | Friction,
    *,
    seed: int = 0,
    contact: int = 0,
    first_sample: int = 0,
    slots: int | None = None,
) -> ContactFriction:
    """Return the friction that now acts between two geoms in every world; call it once after ``put_model`` and ``put_data``.

    MuJoCo Warp's own solver computes the force; the law steers it (see `stochfric_mb.warp.contacts`). All other contacts stay
    as they are. World w has the coefficient path (seed, first_sample + w, contact).

    Args:
        model: the compiled model that ``m`` was made of.
        m: the model on the device.
        d: the data on the device.
        geoms: names of the body's geom and of the counter-surface's; one may be ``"*"``: all that it can collide with.
        friction: a law, or a `Friction` with a coefficient process.
        seed: first part of the coefficient paths' addresses.
        contact: third part: number of this pair in the model.
        first_sample: second part of world 0.
        slots: most contacts of these geoms in one world; as many as the constraint rows of a world allow if not given.

    Raises:
        InputError: unknown geoms, geoms that cannot collide, contacts without friction, a pyramidal cone, an integrator
            or a law that cannot run here, an address out of range, or more contacts than slots.
    """
    known = as_friction(friction)
    require_runnable(known.law)
    check_options(model, m, d)
    partners = partners_of(model, geoms)
    check_contacts(model, d, partners, slots)
    for sample in (first_sample, first_sample + d.nworld - 1):
        known.path(seed, sample, contact)  # refuses what is out of range
    made = ContactFriction(
        model, m, d, np.asarray(partners), known, seed=seed, contact=contact, first_sample=first_sample,
        slots=max(d.njmax // 3, 1) if slots is None else slots,
    )  # fmt: skip
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


__all__ = ["ContactFriction", "InputError", "add_friction", "chain"]
