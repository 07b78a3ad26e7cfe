"""How accurate an engine claims to be, and the tolerance that follows from it."""

from __future__ import annotations

import dataclasses
import math

from stochfric_mb.errors import require_number


@dataclasses.dataclass(frozen=True)
class Accuracy:
    """A class of accuracy: how errors fall with the step. An adapter states its own as ``ACCURACY``."""

    order: float = 1.0
    """Order in the step where the force is smooth [-], > 0; infinite: the solution depends on no step."""
    switch_order: float = 1.0
    """Order where contacts stick and break away [-]: 1 if switches fall on whole steps, more if they are located."""
    factor: float = 1.0
    """Error over scale (rate dt)^order [-], > 0, with the scale and the rate of a case."""
    floor: float = 1.0e-8
    """Error over scale that no step goes below [-]: rounding, and how well the engine solves for the normal force."""

    def __post_init__(self) -> None:
        require_number("switch_order", min(self.switch_order, 1.0e9), above=0.0)
        require_number("order", min(self.order, 1.0e9), above=0.0)
        require_number("factor", self.factor, above=0.0)
        require_number("floor", self.floor, low=0.0)

    @property
    def stepless(self) -> bool:
        """Whether the solution depends on no step."""
        return math.isinf(self.order)

    def tolerance(self, scale: float, rate: float, dt: float, *, switches: bool = False, stand_in: bool = False) -> float:
        """Return the error to allow: scale (floor + factor (rate dt)^order).

        Args:
            scale: size of the quantity, in its unit.
            rate: fastest rate of the motion that matters [1/s].
            dt: step [s].
            switches: whether contacts stick or break away.
            stand_in: whether an elastic law ran in the place of one with true stick: with a stiffness that follows from
                the step its switches are late by about a step, so that they are of first order at best.
        """
        order = min(self.switch_order, 1.0 if stand_in else math.inf) if switches else self.order
        return scale * (self.floor + (0.0 if math.isinf(order) else self.factor * (rate * dt) ** order))


EXACT = math.inf
BUILT_IN: dict[str, Accuracy] = {
    "reference": Accuracy(order=EXACT, switch_order=EXACT),
    "mujoco": Accuracy(order=2, switch_order=2),  # Runge-Kutta; switches located within the step
    "exudyn": Accuracy(order=2, switch_order=2),  # likewise
    "fmu": Accuracy(order=2, switch_order=2),  # likewise
    "pymunk": Accuracy(order=1, switch_order=1),  # its damper acts after the kick; coulomb switches on whole steps
}
"""Engine -> its class."""
