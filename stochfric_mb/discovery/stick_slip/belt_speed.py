"""Whether the belt runs at its stated speed: a stuck box shows it, and a wrong one is a calibration, not an effect.

Every force in a slip is worked out with the belt's speed at both its ends, so that a wrong speed leaves a pattern that
some effect would fit. It is therefore settled before forces are looked at.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.study import Study


@dataclasses.dataclass(frozen=True)
class BeltSpeed:
    """The run in which the box, while it sticks, is furthest from the belt's stated speed."""

    run: str
    """Name of the run."""
    ratio: float
    """Measured over stated speed [-]."""
    stated: float
    """Stated speed [m/s], its size."""

    @property
    def too_much(self) -> bool:
        """Whether it keeps forces from being judged."""
        return abs(self.ratio - 1.0) > criteria.BELT_TOO_MUCH

    @property
    def note(self) -> str:
        """A sentence for a reader."""
        return (
            f"in stick the box moves at {self.ratio:.3f} times the stated belt velocity ({self.ratio * self.stated:.4g} m/s in "
            f"{self.run}, stated {self.stated:.4g} m/s): check the belt velocity"
        )

    @property
    def where(self) -> Where:
        """Where the disagreement lives."""
        return Where("belt velocity", f"the belt does not run at its stated speed: {self.note}")

    @property
    def advice(self) -> str:
        """What to do next."""
        return (
            f"measure the belt's speed: in {self.run} the stuck box moves at {self.ratio * self.stated:.4g} m/s, not the "
            f"stated {self.stated:.4g} m/s; state the measured belt_velocity and repeat (a calibration, no effect)"
        )


def belt_speed(study: Study) -> BeltSpeed | None:
    """Return the run whose belt is furthest from its stated speed, where that is beyond doubt; None if all are right."""
    sticking = study.sticking
    if sticking is None or (study.curve is not None and study.curve.bends):  # what bends over says nothing of the belt
        return None
    errors, doubts = sticking.belt_velocity_error, sticking.belt_velocity_deviation
    worst = int(np.argmax(np.abs(errors)))
    if abs(errors[worst]) < max(criteria.BELT_NOTED, criteria.BELT_DOUBT * doubts[worst]):
        return None
    run, stated = sticking.runs[worst]
    return BeltSpeed(run, 1.0 + float(errors[worst]), stated)
