"""What is believed of a joint in the making: corrections of the mechanism, friction law and effects."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.friction_along import friction_along
from stochfric_mb.effects import Effect
from stochfric_mb.laws import Law

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class JointModel:
    """What is believed of a joint in the making: corrections, law and effects."""

    law: Law
    """Friction law; mu_k holds while the joint slides."""
    effects: tuple[Effect, ...]
    """Effects added to it."""
    nuisances: Mapping[str, float]
    """Number of the mechanism -> its value."""
    load: float
    """Believed load of the joint [N or N m]."""
    contact: bool = False
    """Whether the place is a contact, whose normal force is known along the motion."""

    def plus(self, *effects: Effect) -> JointModel:
        """Return the model with further effects."""
        return dataclasses.replace(self, effects=(*self.effects, *effects))

    def remainder(self, balance: ForceBalance, nuisances: Sequence[Nuisance]) -> Array:
        """Return what the model leaves of the balance of a balance [N or N m], shape (n_centres,)."""
        rest = balance.driven - friction_along(balance, self.law, self.effects, self.load)
        for n in nuisances:
            if n.name in balance.columns:
                rest = rest - (self.nuisances[n.name] - n.value) * balance.columns[n.name]
        return rest
