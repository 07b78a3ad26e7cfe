"""Laws with true stick along a line or about an axis: a constraint holds the contact while it sticks.

The constraint on velocities is active while the law sticks; its reaction is the friction. At a switch velocities and
accelerations are set as they are just after it, since the trapezoidal rule would carry a jump of the acceleration on for ever
(as an alternating reaction). A unit relative acceleration is r = M^-1 J^T m_eff with the system's other constraints
(`mass.response`), those of contacts that stick at that moment included, and the force that would hold the contact is
F + m_eff a_rel, whether it sticks or slides.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact import FrictionContact
from stochfric_mb.exudyn.mass import response
from stochfric_mb.exudyn.normal import Normal


class TrueStick(FrictionContact):
    """What contacts with true stick share; a base beside the kind of contact."""

    true_stick = True
    _rows: Any = None
    _hold: Any = None

    def _make_hold(self) -> Any:
        """Return the constraint on the relative velocity, not active yet."""
        raise NotImplementedError

    def _held(self) -> float:
        """Return the constraint's force [N] on the body, along the friction force."""
        raise NotImplementedError

    def _begin(self) -> None:
        """Join the system's hooks, with the constraint that holds."""
        self._hold = self._make_hold()
        self._mbs.SetObjectParameter(self._hold, "name", f"{self._name} hold")
        super()._begin()

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
        others = self._sticking()
        for other in others:
            other._activate(False)
        with self._hooks.in_progress():
            rows, accelerations = response(self._mbs, self._relative_velocities)
        for other in others:
            other._activate(True)
        self._rows, self._free, self._beside = rows[0], accelerations[:, 0], None
        self._feel(())
        require_apart(self, self._hooks.contacts)
        with self._initial_motion():
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
        self._feel(self._sticking())
        acceleration, velocity = data.GetODE2Coordinates_tt(), data.GetODE2Coordinates_t()
        if stuck:
            velocity -= self._unit * self._numbers[at.V]
            acceleration -= self._unit * float(self._rows @ acceleration)
            data.SetODE2Coordinates_t(velocity)
            self._numbers[at.V] = 0.0
        elif before[0] != self.state[0] or float(before[1] * self.state[1]) < 0.0:
            acceleration -= self._unit * (self._forces()[0] - force) / self._mass_felt
        data.SetODE2Coordinates_tt(acceleration)
        return watch

    def _sticking(self) -> tuple[TrueStick, ...]:
        """Return the other contacts that a constraint holds now."""
        contacts = self._hooks.contacts
        return tuple(c for c in contacts if c is not self and isinstance(c, TrueStick) and c._rows is not None and c.stick)

    def _feel(self, others: tuple[TrueStick, ...]) -> None:
        """Find the mass that the contact feels and a unit relative acceleration, beside other contacts that stick.

        Raises:
            InputError: those hold this one's motion already.
        """
        if others == self._beside:
            return
        unit = self._free
        if others:
            rows, theirs = np.array([c._rows for c in others]), np.column_stack([c._free for c in others])
            unit = unit - theirs @ np.linalg.lstsq(rows @ theirs, rows @ unit, rcond=None)[0]
        inverse = float(self._rows @ unit)
        if inverse <= COUPLED * float(self._rows @ self._free):
            raise _same_bodies(self, others[-1])
        self._mass_felt, self._unit, self._beside = 1.0 / inverse, unit / inverse, others

    def _activate(self, active: bool) -> None:
        self._mbs.SetObjectParameter(self._hold, "activeConnector", bool(active))

    def _keep_still(self, stuck: bool) -> None:
        self._activate(stuck)

    def _forces(self) -> tuple[float, float]:
        return super()._forces()[0] + (self._held() if self.stick else 0.0), 0.0

    def _read_motion(self) -> None:
        """Take displacement and velocity, and the force that would hold the contact still."""
        super()._read_motion()
        if self._rows is not None and self._words[at.STARTED]:
            self._feel(self._sticking())
            relative = float(self._rows @ self._mbs.systemData.GetODE2Coordinates_tt())
            self._numbers[at.HOLD] = self._forces()[0] + self._mass_felt * relative


COUPLED = 1.0e-9
"""Part of a contact's acceleration that another one may feel as rounding."""


def require_apart(contact: Any, contacts: Sequence[Any]) -> None:
    """Do nothing if what holds a contact with true stick can be distinguished from what holds the others.

    Raises:
        InputError: two of them hold the same motion, or two act on each other of which one is in a plane.
    """
    rows, unit = np.atleast_2d(contact._rows), contact._unit.reshape(len(contact._unit), -1)
    for other in contacts:
        if other is contact or not other.true_stick or other._rows is None:
            continue
        there = np.atleast_2d(other._rows) @ unit
        here = rows @ other._unit.reshape(len(unit), -1)
        least = 1.0 - COUPLED if max(here.shape) == 1 else COUPLED
        if np.max(np.abs(here @ there)) > least:
            raise _same_bodies(contact, other)


def _same_bodies(contact: Any, other: Any) -> InputError:
    return InputError(
        f"law {contact.friction.law.kind}: {contact._name!r} and {other._name!r} hold the same bodies, so that what "
        "each of them holds cannot be told; keep one of them, or use stochfric_mb.laws.substitute.elastic_substitute"
    )


def require_holdable(kind: str, normal: Normal) -> None:
    """Do nothing if a constraint can hold a law with true stick.

    Raises:
        InputError: its normal force is the reaction of another constraint.
    """
    if normal.reaction:
        raise InputError(
            f"law {kind}: a constraint holds it while it sticks, and its normal force cannot be the reaction of another; give "
            "normal_force as a number or a function of time, or take elastic_stick"
        )
