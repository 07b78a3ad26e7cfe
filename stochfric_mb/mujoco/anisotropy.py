"""Friction that differs by direction in the tangent plane: machined, woven or laid surfaces, skates, wheels of a kind."""

from __future__ import annotations

import dataclasses
import math

from stochfric_mb.errors import InputError, require_number


@dataclasses.dataclass(frozen=True)
class Anisotropy:
    """Coefficients of friction across a direction of the body over those along it.

    With F_1, v_1 along and F_2, v_2 across the direction, and r = ``across``, the law rules between (F_1, F_2/r) and
    (v_1, r v_2). So the largest force lies on an ellipse with the axes mu N along and r mu N across, and a sliding contact's
    force is (v_1, r^2 v_2) mu N/sqrt(v_1^2 + r^2 v_2^2), the one that dissipates most.

    Reference: A. Zmitrowicz, Models of kinematics dependent anisotropic and heterogeneous friction, International Journal of
    Solids and Structures 43, 2006, 4407-4451 (elliptical friction with the associated sliding rule).
    """

    across: float
    """mu_s and mu_k across the direction over those along it [-], > 0; 1 is isotropic."""
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    """The direction, in the frame of the body's geom's body; what counts is its part in the contact's tangent plane.

    Where it has none, because it stands normal to the contact, friction is that along it, the same in all directions.
    """

    def __post_init__(self) -> None:
        require_number("across", self.across, above=0.0)
        if len(self.direction) != 3 or not all(isinstance(x, int | float) and math.isfinite(x) for x in self.direction):
            raise InputError(f"direction = {self.direction!r} is not a vector of three numbers; give e.g. (1.0, 0.0, 0.0)")
        if not math.hypot(*self.direction) > 0.0:
            raise InputError(f"direction = {self.direction!r} has no length; give e.g. (1.0, 0.0, 0.0)")


ISOTROPIC = Anisotropy(1.0)
"""The same in all directions."""
