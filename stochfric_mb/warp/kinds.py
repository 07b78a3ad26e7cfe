"""Friction at contacts, and in a joint or tendon: state on the device, and the kernels that a step launches."""

from __future__ import annotations

from typing import Any

import mujoco_warp as mjw
import warp as wp

from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.friction import Friction
from stochfric_mb.warp.contacts import learn, observe, steer_kernel
from stochfric_mb.warp.friction import WarpFriction
from stochfric_mb.warp.joints import hold_kernel, observe_row
from stochfric_mb.warp.worlds import row_arrays, slot_arrays


class ContactFriction(WarpFriction):
    """Friction between geoms in every world; made by `add_friction`."""

    def __init__(self, friction: Friction, d: mjw.Data, partners: Any, slots: int, **address: Any) -> None:
        """Lay out the state on the device; arguments as for `add_friction`."""
        super().__init__(friction, d.nworld, **address)
        self._partners = wp.array(partners, dtype=int)
        clock = TIME if friction.process is None else friction.process.clock
        self.slots = slot_arrays(d.nworld, slots, own_paths=clock != TIME)
        """What it keeps of each contact."""
        self._steer = steer_kernel(friction.law.kind, clock)
        self.normal_force = wp.zeros(d.nworld, dtype=float)
        """Sum of the normal forces over the contacts of each world [N], as of the last `observe`."""
        self.friction_force = wp.zeros(d.nworld, dtype=wp.vec3)
        """Sum of the friction forces on the first geom, in world coordinates [N], likewise."""
        self.stick = wp.zeros(d.nworld, dtype=int)
        """1 where all loaded contacts stick, 0 where one slides or none is loaded, likewise."""
        self.contacts = wp.zeros(d.nworld, dtype=int)
        """Number of loaded contacts, likewise."""

    def steer(self, m: mjw.Model, d: mjw.Data) -> None:
        """Launch the kernels of one step; ``Model.callback.passive`` calls it."""
        self.begin(d, self.slots.used)
        contact, efc = d.contact, d.efc
        wp.launch(learn, dim=self.nworld, inputs=[efc.force, m.geom_bodyid, self.worlds, self.slots])
        threads = d.naconmax if d.time.device.is_cuda else 1  # the CPU goes through them one by one anyway
        wp.launch(
            self._steer,
            dim=threads,
            inputs=[
                threads, d.nacon, contact.geom, contact.worldid, contact.dim, contact.efc_address, contact.frame, contact.pos,
                contact.surfacevel, d.geom_xpos, m.geom_bodyid, m.body_invweight0, m.opt.timestep, m.opt.impratio_invsqrt,
                m.opt.gravity, efc.vel, m.is_sparse, efc.J_rownnz, efc.J_rowadr, self._partners, self.seed, self.contact,
                self.worlds, self.slots,
            ],
            outputs=[contact.friction, efc.D, efc.aref, efc.J],
        )  # fmt: skip

    def observe(self, d: mjw.Data) -> None:
        """Bring the readings up to the step just made; nothing is copied to the host."""
        outputs = [self.normal_force, self.friction_force, self.stick, self.contacts]
        wp.launch(observe, dim=self.nworld, inputs=[d.efc.force, self.worlds, self.slots], outputs=outputs)


class JointFriction(WarpFriction):
    """Friction in a joint or tendon in every world; made by `add_friction`."""

    def __init__(
        self, friction: Friction, d: mjw.Data, place: tuple[int, int], load: float, mobility: float, **address: Any
    ) -> None:
        """Lay out the state on the device; ``place`` is type and number of the constraint row, which yields by ``mobility``."""
        super().__init__(friction, d.nworld, **address)
        self._place, self._load, self._mobility = place, load, mobility
        self._unused = wp.zeros((2, d.nworld), dtype=int)
        self.rows = row_arrays(d.nworld)
        """What it keeps of the joint."""
        self._hold = hold_kernel(friction.law.kind, TIME if friction.process is None else friction.process.clock)
        self.friction_force = wp.zeros(d.nworld, dtype=float)
        """Friction force in the joint's coordinate [N or N m], as of the last `observe`."""
        self.stick = wp.zeros(d.nworld, dtype=int)
        """1 where the joint sticks, likewise."""

    def steer(self, m: mjw.Model, d: mjw.Data) -> None:
        """Launch the kernels of one step; ``Model.callback.passive`` calls it."""
        self.begin(d, self._unused)
        efc = d.efc
        wp.launch(
            self._hold,
            dim=self.nworld,
            inputs=[
                *self._place, self._load, self._mobility, d.ne, d.nf, efc.type, efc.id, m.opt.timestep, efc.vel, efc.force,
                self.seed, self.contact, self.worlds, self.rows,
            ],
            outputs=[efc.D, efc.frictionloss, efc.aref],
        )  # fmt: skip

    def observe(self, d: mjw.Data) -> None:
        """Bring the readings up to the step just made; nothing is copied to the host."""
        outputs = [self.friction_force, self.stick]
        wp.launch(observe_row, dim=self.nworld, inputs=[d.efc.force, self.worlds, self.rows], outputs=outputs)
