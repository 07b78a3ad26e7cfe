"""The model of a joint in the making: corrections of the mechanism, friction law and effects.

A drive is explained only by motion. Where friction F depends on the drive tau itself, the balance is r = g tau - F(tau) - needs
with g the factor by which data have corrected the drive. The drive that the motion needs solves r = 0; the measured one is off
by e = r/|g - dF/dtau|, to first order, and least squares of e is maximum likelihood where the errors are the drive's. Without
the divisor, the Jacobian of r (Box and Cox, J. R. Stat. Soc. B 26, 1964, 211-252, section 3, for the same with
transformations), "friction in proportion to the drive" leaves nothing of any drive, and neither does a drive of factor 0.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import OF_THE_DRIVE, ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.friction_along import friction_along, reads_drive
from stochfric_mb.effects import Effect
from stochfric_mb.laws import Law

Array = npt.NDArray[np.float64]
Own = tuple[str, str, str]
"""Kind of an effect, name of a run, name of a parameter."""
Forces = tuple[Array, Array | None]
"""Friction [N or N m] and its change with the drive [-], shape (n_centres,) each; None: the drive plays no part in it."""

STEP = 1.0e-3
"""Step of the load by which the change of friction with it is taken, over the mean load [-]."""
LEAST = 1.0e-3
"""Least change of the balance with the drive [-]: at 0 the joint locks itself, and no drive moves it."""


@dataclasses.dataclass(frozen=True)
class JointModel:
    """The model of a joint in the making: corrections, law and effects."""

    law: Law
    """Friction law; mu_k holds while the joint slides."""
    effects: tuple[Effect, ...]
    """Effects added to it."""
    nuisances: Mapping[str, float]
    """Number of the mechanism -> its value."""
    load: float
    """Stated load of the joint [N or N m]."""
    contact: bool = False
    """Whether the place is a contact, whose normal force is known along the motion."""
    level: tuple[float, float] = (0.0, np.inf)
    """mu_k as stated, and the standard deviation of its prior; inf: there is none [-]."""
    own: Mapping[Own, float] = dataclasses.field(default_factory=dict[Own, float])
    """Kind of an effect, run, parameter -> its value in that run: phases of what is periodic in time."""

    def plus(self, *effects: Effect, own: Mapping[Own, float] | None = None) -> JointModel:
        """Return the model with further effects, and what of them is each run's own."""
        return dataclasses.replace(self, effects=(*self.effects, *effects), own=dict(self.own) | dict(own or {}))

    def effects_in(self, run: str) -> tuple[Effect, ...]:
        """Return the effects as they are in a run."""
        if not self.own:
            return self.effects
        mine = {(kind, name): value for (kind, at, name), value in self.own.items() if at == run}
        changes = [{name: value for (kind, name), value in mine.items() if kind == e.kind} for e in self.effects]
        return tuple(dataclasses.replace(e, **c) if c else e for e, c in zip(self.effects, changes, strict=True))

    def forces(self, balance: ForceBalance) -> Forces:
        """Return friction at the centres of windows, and its change with the drive; corrections play no part in it."""
        friction = self.friction(balance)
        known = balance.load_by_drive is not None or balance.drive is not None
        reads = known and reads_drive(self.effects)
        return friction, self._friction_by_drive(balance, friction) if reads else None

    def remainder(self, balance: ForceBalance, nuisances: Sequence[Nuisance], forces: Forces | None = None) -> Array:
        """Return what the model leaves of the drive, in units of the drive [N or N m], shape (n_centres,).

        Args:
            balance: a run.
            nuisances: numbers of the mechanism.
            forces: as of `forces`, where they are known already.
        """
        friction, changes = forces or self.forces(balance)
        rest = balance.driven - friction
        by_drive = np.ones(len(rest))
        for n in nuisances:
            if n.name in balance.columns:
                value = self.nuisances.get(n.name, n.value)
                off = value - n.value
                rest = rest - off * (balance.columns[n.name] + off * balance.bends.get(n.name, 0.0))
                if n.name in OF_THE_DRIVE:
                    by_drive = by_drive * value / n.value
        if changes is not None:
            by_drive = by_drive - changes
        return rest / change_of(by_drive)

    def friction(self, balance: ForceBalance) -> Array:
        """Return the friction against the motion at the centres of windows [N or N m], shape (n_centres,)."""
        return friction_along(balance, self.law, self.effects_in(balance.run), self.load)

    def _friction_by_drive(self, balance: ForceBalance, friction: Array) -> Array:
        """Return the change of friction with the driving force [-], shape (n_centres,)."""
        step = STEP * max(float(np.mean(balance.load)), self.load)
        return (self.friction(balance.with_more_drive(step)) - friction) / step


def change_of(by_drive: Array) -> Array:
    """Return by what the error of a balance is divided to be one of the drive [-], shape as ``by_drive``."""
    return np.maximum(np.abs(by_drive), LEAST)
