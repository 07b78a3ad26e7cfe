"""Laws with true stick in a plane: while the contact sticks, each step is repeated until the friction that holds it is found.

PostNewton reads the relative velocity v that a trial step ends with and adds to the friction what the contact's response says
would have kept it at rest, F += 2 m_eff v/h by the trapezoidal rule. Forces above mu_s N are left to event location, which ends
the step where the contact lets go. At a switch velocities and accelerations are set as they are just after it
(see `true_stick`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact import REPEATS
from stochfric_mb.exudyn.contact_force import end_of_step
from stochfric_mb.exudyn.mass import response
from stochfric_mb.exudyn.plane import PlaneContact
from stochfric_mb.exudyn.true_stick import require_apart

AT_REST = 1.0e-9
"""What the friction that holds a contact may be off by, of mu_s N."""
SMALLEST = 1.0e-300


class TrueStickPlane(PlaneContact):
    """Friction with true stick in a plane; made by `add_friction`."""

    true_stick = True
    _rows: Any = None

    def prepare(self, dt: float, start: float) -> None:
        """Start afresh, with the response of the initial configuration."""
        self._rows, self._tried = None, (np.nan, 0)
        self._numbers[at.HOLD : at.HOLD + 2] = 0.0
        super().prepare(dt, start)
        with self._hooks.in_progress():
            self._rows, accelerations = response(self._mbs, self._relative_velocities)
        self._felt = np.linalg.inv(self._rows @ accelerations)
        self._unit = accelerations @ self._felt
        require_apart(self, self._hooks.contacts)

    @property
    def refines(self) -> bool:
        """Whether trial steps tell what friction needs: always."""
        return True

    def require_friction_at_rest(self) -> None:
        """Refuse a static solution.

        Raises:
            InputError: always; the friction that holds is found from step to step.
        """
        raise InputError(
            f"law {self.friction.law.kind}: the friction that holds in a plane is found from the velocity that a step ends "
            "with, and a static solution has none; use elastic_stick, or let the motion come to rest with solve_dynamic"
        )

    def take_trial(self) -> None:
        """Take the friction that holds the contact at the start."""
        self._take_hold()

    def refine(self, t: float) -> bool:
        """Let friction be what would have held the contact over the trial step to t [s]; return whether to repeat the step."""
        numbers = self._numbers
        if not self.stick or t <= numbers[at.T]:
            return False
        self._read_motion()
        *v, cap = end_of_step(t, self.where)
        hold = numbers[at.HOLD : at.HOLD + 2]
        applied = hold * min(1.0, cap / max(float(np.linalg.norm(hold)), SMALLEST))
        missing = 2.0 / (t - numbers[at.T]) * (self._felt @ v)
        last, count = self._tried
        self._tried = t, count + 1 if t == last else 1
        lets_go = np.linalg.norm(hold) > cap and np.linalg.norm(applied + missing) > cap
        hold[:] = applied + missing
        return not (np.linalg.norm(missing) <= AT_REST * cap or lets_go or self._tried[1] > REPEATS)

    def settle(self, t: float, bits: int) -> bool:
        """Commit, and let the motion be as it is just after it: at rest where the contact sticks, free where it has let go.

        The trapezoidal rule would carry on what is left of a resting contact's relative acceleration, with alternating sign.
        """
        before, force = self.state, np.asarray(self._forces())
        watch = super().settle(t, bits)
        if self._rows is None or not (self.stick or _turned(before, self.state)):
            return watch
        data = self._mbs.systemData
        acceleration = data.GetODE2Coordinates_tt()
        if self.stick:
            motion = np.array(self._relative_velocities())
            data.SetODE2Coordinates_t(data.GetODE2Coordinates_t() - self._unit @ motion)
            self._numbers[[at.V, at.V_2]] = 0.0
            acceleration -= self._unit @ (self._rows @ acceleration)
        else:
            acceleration -= self._unit @ np.linalg.solve(self._felt, np.asarray(self._forces()) - force)
        data.SetODE2Coordinates_tt(acceleration)
        return watch

    def _read_motion(self) -> None:
        """Take the motion and, while the contact slides, the friction that would keep it as fast as it is."""
        super()._read_motion()
        if self._rows is not None and self._words[at.STARTED] and not self.stick:
            self._take_hold()

    def _take_hold(self) -> None:
        relative = self._rows @ self._mbs.systemData.GetODE2Coordinates_tt()
        self._numbers[at.HOLD : at.HOLD + 2] = self._forces() + self._felt @ relative


def _turned(before: Any, now: Any) -> bool:
    """Return whether a law's mode has changed, or the direction in which it slides has turned round."""
    return bool(before[0] != now[0] or before[1:] @ now[1:] < 0.0)
