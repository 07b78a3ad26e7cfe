"""Add friction to the contacts of a MuJoCo Warp model, in all its worlds."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np
import numpy.typing as npt
import warp as wp

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.warp.cap import require_runnable
from stochfric_mb.warp.checks import check_contacts, check_options, partners_of
from stochfric_mb.warp.clock import begin_kernel, restart
from stochfric_mb.warp.contacts import observe, steer_kernel
from stochfric_mb.warp.domain import Domain
from stochfric_mb.warp.worlds import slot_arrays, world_arrays


class ContactFriction:
    """Friction between two geoms in every world; made by `add_friction`."""

    def __init__(
        self, model: mujoco.MjModel, m: mjw.Model, d: mjw.Data, partners: Any, friction: Friction, *,
        seed: int, contact: int, first_sample: int, slots: int, new_paths: bool,
    ) -> None:  # fmt: skip
        """Lay out the state on the device; arguments as for `add_friction`."""
        self.law = friction.law
        """The law."""
        self.seed, self.contact = seed, contact
        self.nworld = d.nworld
        """Number of worlds."""
        self._timestep = float(model.opt.timestep)
        self._partners = wp.array(partners, dtype=int)
        self.worlds = world_arrays(friction, d.nworld, first_sample, self._timestep, new_paths=new_paths)
        """What it keeps of each world."""
        self.slots = slot_arrays(d.nworld, slots)
        """What it keeps of each contact."""
        self._begin, self._steer = begin_kernel(), steer_kernel(friction.law.kind)
        self.normal_force = wp.zeros(d.nworld, dtype=float)
        """Sum of the normal forces over the contacts of each world [N], as of the last `observe`."""
        self.friction_force = wp.zeros(d.nworld, dtype=wp.vec3)
        """Sum of the friction forces on the first geom, in world coordinates [N], likewise."""
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

    def randomise(self, domain: Domain) -> None:
        """Let each world draw its law when it begins, and again whenever it is reset; call it before graphs are captured.

        Raises:
            InputError: what is drawn does not fit the law.
        """
        self.worlds.means = wp.array(domain.means(self.law), dtype=wp.float64)
        self.worlds.spreads = wp.array(domain.spreads(self.law), dtype=wp.float64)
        self.restart()

    def restart(self, mask: wp.array[bool] | None = None) -> None:
        """Let worlds begin anew at their next step: clock, contacts, coefficients and what `randomise` draws.

        Worlds whose time goes back, as ``mjw.reset_data`` makes it, need no such call if they took two steps at least.

        Args:
            mask: which worlds, shape (nworld,), on the device; all if not given.
        """
        given = wp.full(self.nworld, True, dtype=bool) if mask is None else mask
        wp.launch(restart, dim=self.nworld, inputs=[given, self.worlds])

    def set_parameters(self, **values: npt.ArrayLike) -> None:
        """Give each world parameters of its own, from now on.

        Args:
            values: parameters of the law by name, each a number or an array of shape (nworld,).

        Raises:
            InputError: an unknown name, a shape, or a world whose law would not be valid (mu_k > mu_s, say).
        """
        names = [field.name for field in dataclasses.fields(self.law)]
        rows = self.worlds.parameters.numpy().astype(np.float64)
        for name, value in values.items():
            place = names.index(require_name(f"parameter of law {self.law.kind}", name, names))
            given = np.asarray(value, dtype=np.float64)
            if given.shape not in {(), (self.nworld,)}:
                raise InputError(f"{name} has shape {given.shape}; give a number or one for each of {self.nworld} worlds")
            rows[:, place] = given
        for w in range(self.nworld):
            own = {name: float(rows[w, names.index(name)]) for name in values}
            try:
                dataclasses.replace(self.law, **{"mu_s": float(rows[w, 0]), "mu_k": float(rows[w, 1])} | own)
            except InputError as error:
                raise InputError(f"world {w}: {error}") from None
        self.worlds.parameters.assign(rows)
        descriptor = self.worlds.descriptor.numpy()
        descriptor[:, 4:6] = rows[:, :2]
        self.worlds.descriptor.assign(descriptor)
        if self.worlds.v_s >= 0:
            self.worlds.stick_speed.assign(rows[:, self.worlds.v_s])
        cursor = self.worlds.cursor.numpy()
        cursor[:, 0] = 0.0
        self.worlds.cursor.assign(cursor)

    def steer(self, m: mjw.Model, d: mjw.Data) -> None:
        """Launch the kernels of one step; ``Model.callback.passive`` calls it."""
        wp.launch(
            self._begin,
            dim=self.nworld,
            inputs=[d.time, self._timestep, self.seed, self.contact, self.worlds, self.slots.used],
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
    new_paths: bool = False,
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
        new_paths: whether a world that begins anew takes another path (its sample grows by the number of worlds).

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
        slots=max(d.njmax // 3, 1) if slots is None else slots, new_paths=new_paths,
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
