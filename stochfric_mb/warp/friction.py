"""What friction at contacts and at joints have in common: the worlds' laws and coefficients."""

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco_warp as mjw
import numpy as np
import numpy.typing as npt
import warp as wp

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.friction import Friction
from stochfric_mb.warp.clock import begin_kernel, restart
from stochfric_mb.warp.domain import Domain
from stochfric_mb.warp.worlds import world_arrays


class WarpFriction:
    """One law in every world, each with its own coefficients."""

    def __init__(
        self, friction: Friction, nworld: int, timestep: float, *, seed: int, contact: int, first_sample: int, new_paths: bool
    ) -> None:
        """Lay out the worlds on the device; arguments as for `stochfric_mb.warp.add_friction`."""
        self.law = friction.law
        """The law."""
        self.seed, self.contact = seed, contact
        self.nworld = nworld
        """Number of worlds."""
        self._timestep = timestep
        self.worlds = world_arrays(friction, nworld, first_sample, new_paths=new_paths)
        """What it keeps of each world."""
        self._begin = begin_kernel()

    @property
    def mu_s(self) -> wp.array[float]:
        """Static coefficient of each world in the last step [-], on the device.

        Where each contact has its own, as of the last ``observe`` and their mean, weighted with the normal forces.
        """
        return self.worlds.mu_s

    @property
    def mu_k(self) -> wp.array[float]:
        """Kinetic coefficient of each world [-], likewise."""
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
        peaks = np.empty(self.nworld)
        for w in range(self.nworld):
            own = {name: float(rows[w, names.index(name)]) for name in values}
            try:
                law = dataclasses.replace(self.law, **{"mu_s": float(rows[w, 0]), "mu_k": float(rows[w, 1])} | own)
            except InputError as error:
                raise InputError(f"world {w}: {error}") from None
            peaks[w] = law.peak_speed
        self.worlds.parameters.assign(rows)
        descriptor = self.worlds.descriptor.numpy()
        descriptor[:, 4:6] = rows[:, :2]
        self.worlds.descriptor.assign(descriptor)
        if self.worlds.v_s >= 0:
            self.worlds.stick_speed.assign(rows[:, self.worlds.v_s])
        self.worlds.peak_speed.assign(peaks)
        cursor = self.worlds.cursor.numpy()
        cursor[:, 0] = 0.0
        self.worlds.cursor.assign(cursor)

    def begin(self, d: mjw.Data, used: Any) -> None:
        """Launch the kernel that begins a step in each world."""
        wp.launch(self._begin, dim=self.nworld, inputs=[d.time, self._timestep, self.seed, self.contact, self.worlds, used])
