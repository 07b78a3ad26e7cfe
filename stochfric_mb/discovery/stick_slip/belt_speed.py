"""Whether the belt runs at its stated speed: a stuck box shows it, and a wrong one is a calibration, not an effect.

Every force in a slip is worked out with the belt's speed at both its ends, so that a wrong speed leaves a pattern that
some effect would fit. It is therefore settled before forces are looked at.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.kinematics import kinematics
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.discovery.stick_slip.study import study as measured
from stochfric_mb.measurement.dataset import Dataset


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
    def rests(self) -> bool:
        """Whether the box all but rests, so that it slides on and does not stick."""
        return abs(self.ratio) < criteria.BELT_RESTS

    @property
    def note(self) -> str:
        """A sentence for a reader."""
        if self.rests:
            return (
                f"in {self.run} the box all but rests for long ({self.ratio * self.stated:.4g} m/s on a belt of "
                f"{self.stated:.4g} m/s): it slides on there and does not stick"
            )
        return (
            f"in stick the box moves at {self.ratio:.3f} times the stated belt velocity ({self.ratio * self.stated:.4g} m/s in "
            f"{self.run}, stated {self.stated:.4g} m/s): check the belt velocity"
        )

    @property
    def where(self) -> Where:
        """Where the disagreement lives."""
        text = self.note if self.rests else f"the belt does not run at its stated speed: {self.note}"
        return Where("belt velocity", text)

    @property
    def advice(self) -> str:
        """What to do next."""
        if self.rests:
            return f"leave out where the box slides on without sticking: {self.note}"
        return (
            f"measure the belt's speed: in {self.run} the stuck box moves at {self.ratio * self.stated:.4g} m/s, not the "
            f"stated {self.stated:.4g} m/s; state the measured belt_velocity and repeat (a calibration, no effect)"
        )


def at_shown_speed(study: Study) -> Study:
    """Return the study with forces taken at the belt speed that the stuck box shows; itself, if that is the stated one.

    All runs have to show the same factor, of a belt's gear or of a sensor's scale, and nothing else may show in stick.
    """
    belt, sticking = belt_speed(study), study.sticking
    if belt is None or belt.too_much or sticking is None or kinematics(study, {}):
        return study
    away = sticking.belt_velocity_error - (belt.ratio - 1.0)
    if np.any(np.abs(away) > np.maximum(criteria.BELT_NOTED / 2.0, criteria.BELT_DOUBT * sticking.belt_velocity_deviation)):
        return study
    again = measured(at_speed(study.dataset, belt.ratio))
    return study if again is None else dataclasses.replace(again, belt=belt.ratio)


def at_speed(dataset: Dataset, factor: float) -> Dataset:
    """Return a data set whose belts run faster than is stated by a factor, that of its scenario among them."""
    if factor == 1.0:
        return dataset
    box = dataset.scenario.mechanism
    faster = dataclasses.replace(box, belt_velocity=factor * box.belt_velocity)
    runs = tuple(
        dataclasses.replace(
            r, settings=dict(r.settings) | {"belt_velocity": factor * r.mechanism(dataset.scenario).belt_velocity}
        )
        for r in dataset.runs
    )
    return dataclasses.replace(dataset, scenario=dataclasses.replace(dataset.scenario, mechanism=faster), runs=runs)


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
