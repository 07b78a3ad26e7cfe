"""Laws with true stick on a line: a constraint holds the contact while it sticks.

The constraint on velocities is active while the law sticks; its reaction is the friction. At a switch velocities and
accelerations are set as they are just after it, since the trapezoidal rule would carry a jump of the acceleration on for ever
(as an alternating reaction). A unit relative acceleration is r = M^-1 J^T m_eff with the system's other constraints
(`mass.response`), and the force that would hold the contact is F + m_eff a_rel, whether it sticks or slides.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from exudyn.itemInterface import CoordinateConstraint

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.attach import CoordinateContact
from stochfric_mb.exudyn.contact import OUTPUT
from stochfric_mb.exudyn.mass import response
from stochfric_mb.exudyn.normal import Normal
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law


class TrueStickContact(CoordinateContact):
    """Friction with true stick between two coordinates; made by `add_friction`."""

    true_stick = True

    def __init__(
        self,
        mbs: Any,
        markers: tuple[Any, Any],
        friction: Law | Friction,
        normal: Normal,
        surface_velocity: Any,
        **options: Any,
    ) -> None:
        law = as_friction(friction).law
        if normal.reaction:
            raise InputError(
                f"law {law.kind}: a constraint holds it while it sticks, and its normal force cannot be the reaction of "
                "another; give normal_force as a number or a function of time, or take elastic_stick"
            )
        if law.kind == "karnopp":
            raise InputError(
                "law karnopp: within its zone it slides under the force that would hold it, which neither a constraint nor "
                "a force of velocity gives; take coulomb or stribeck"
            )
        self._rows: Any = None
        self._hold = mbs.AddObject(
            CoordinateConstraint(
                markerNumbers=list(markers), velocityLevel=True, offset=float(surface_velocity), activeConnector=False
            )
        )
        super().__init__(mbs, markers, friction, normal, surface_velocity, **options)
        mbs.SetObjectParameter(self._hold, "name", f"{self._name} hold")

    def find(self) -> bool:
        """Find both objects again."""
        self._hold = self._mbs.GetObjectNumber(f"{self._name} hold")
        return super().find()

    def connect(self) -> None:
        """Keep to fetching: the holding force has to be found after each step."""
        super().connect()
        self._words[at.ASK_FIRST] = 1

    def prepare(self, dt: float, start: float) -> None:
        """Start afresh, held if the contact sticks."""
        self._numbers[at.HOLD] = self._numbers[at.HOLD_BEFORE] = 0.0
        self._keep_still(False)
        super().prepare(dt, start)
        with self._hooks.in_progress():
            rows, accelerations = response(self._mbs, self._relative_velocities)
        self._rows = rows[0]
        inverse = float(rows[0] @ accelerations[:, 0])
        self._mass_felt = 1.0 / inverse
        self._unit = accelerations[:, 0] / inverse
        self._keep_still(self.stick)

    def settle(self, t: float, bits: int) -> bool:
        """Commit, and where the law has switched hold the contact or let it go, with the motion just after that."""
        before, force = self.state, self._forces()[0]
        watch = super().settle(t, bits)
        if self._rows is None or np.array_equal(before, self.state):
            return watch
        stuck, data = self.stick, self._mbs.systemData
        self._keep_still(stuck)
        if before[0] == 0.0 and stuck:
            return watch
        acceleration, velocity = data.GetODE2Coordinates_tt(), data.GetODE2Coordinates_t()
        if stuck:
            velocity -= self._unit * self._numbers[at.V]
            acceleration -= self._unit * float(self._rows @ acceleration)
            data.SetODE2Coordinates_t(velocity)
            self._numbers[at.V] = 0.0
        elif before[0] == 0.0 or float(before[1] * self.state[1]) < 0.0:
            acceleration -= self._unit * (self._forces()[0] - force) / self._mass_felt
        data.SetODE2Coordinates_tt(acceleration)
        return watch

    def _keep_still(self, stuck: bool) -> None:
        self._mbs.SetObjectParameter(self._hold, "activeConnector", bool(stuck))

    def _forces(self) -> tuple[float, float]:
        held = float(self._mbs.GetObjectOutput(self._hold, OUTPUT.Force)) if self.stick else 0.0
        return super()._forces()[0] - held, 0.0

    def _read_motion(self) -> None:
        """Take displacement and velocity, and the force that would hold the contact still."""
        super()._read_motion()
        if self._rows is not None and self._words[at.STARTED]:
            relative = float(self._rows @ self._mbs.systemData.GetODE2Coordinates_tt())
            self._numbers[at.HOLD] = self._forces()[0] + self._mass_felt * relative
