"""Signs of measured forces: friction takes energy out of the sliding, on average it never brings any in."""

from __future__ import annotations

import dataclasses
import importlib
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.smoothing import smooth

if TYPE_CHECKING:
    from stochfric_mb.measurement.run import Run
    from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]

SEGMENTS = 20
"""Pieces of the motion whose works are taken as independent."""
CONFIDENCE = 0.999
"""Confidence that the mean power is positive before a sign is called wrong: a wrong alarm costs trust."""
HALF_WIDTH = 8
"""Half the length of the window through which a velocity is taken from a position [samples]."""


@dataclasses.dataclass(frozen=True)
class SignError:
    """A friction force that brings energy into the sliding."""

    mean_power: float
    """Mean power of the friction force along the sliding velocity [W]; it should be negative."""
    low: float
    """Lower bound of the mean power at confidence `CONFIDENCE` [W], > 0."""
    created: float
    """Energy brought in, as a part of all that is exchanged, 0.5 to 1 [-]; with a mere sign error near 1."""
    remedy: str = "give sign = { friction_force = -1 }"
    """How the sign is turned."""

    def __str__(self) -> str:
        """Return the finding and its remedy."""
        return (
            f"friction brings in energy ({self.mean_power:.3g} W on average, {100 * self.created:.0f} % of what it exchanges): "
            f"its sign, or that of the velocity, is probably wrong; {self.remedy}"
        )


def probable_sign_error(friction_force: Array, sliding_velocity: Array) -> SignError | None:
    """Return the finding if the friction force feeds the sliding on average, with confidence; None otherwise.

    The mean of F v over the record is tested against zero by Student's t over `SEGMENTS` pieces with equal integrals of v^2:
    a few short slips count as what they are, most of the motion. Friction on a body and the body's velocity relative to
    what it slides on have F v <= 0. An applied force that overcomes friction in a motion
    that repeats is tested as ``probable_sign_error(-force, velocity)``.

    Args:
        friction_force: friction on the body, float64[n] [N or N m].
        sliding_velocity: velocity of the body relative to what it slides on, float64[n] [m/s or rad/s].

    Raises:
        InputError: lengths differ, or there are fewer than two samples for each piece.
    """
    if friction_force.shape != sliding_velocity.shape or friction_force.size < 2 * SEGMENTS:
        raise InputError(
            f"{friction_force.size} samples of friction and {sliding_velocity.size} of velocity; give equally many, "
            f"at least {2 * SEGMENTS}"
        )
    power = friction_force * sliding_velocity
    moved: Array = np.cumsum(sliding_velocity**2)
    shares: Array = moved[-1] * np.linspace(0.0, 1.0, SEGMENTS, endpoint=False)
    starts: npt.NDArray[np.intp] = np.unique(np.searchsorted(moved, shares))
    if starts.size < SEGMENTS // 2:
        return None  # all the motion is in a few samples
    works = np.add.reduceat(power, starts)
    error = float(works.std(ddof=1)) * math.sqrt(starts.size) / power.size
    special: Any = importlib.import_module("scipy.special")
    low = float(power.mean()) - float(special.stdtrit(starts.size - 1, CONFIDENCE)) * error
    if not low > 0.0:
        return None
    created = float(np.maximum(power, 0.0).sum() / np.abs(power).sum())
    return SignError(float(power.mean()), low, created)


def run_sign_error(run: Run, scenario: Scenario[Any]) -> SignError | None:
    """Return the finding for a run with ``friction_force``; None where it has none, or no motion to compare it with.

    The friction force is the one on the body, which moves relative to the belt: v = x' - v_b.
    """
    friction = run.channels.get("friction_force")
    motion = _velocity(run, "velocity", "position")
    if friction is None or motion is None or friction.size < 2 * (SEGMENTS + HALF_WIDTH):
        return None
    belt = _velocity(run, "belt_velocity", "belt_position")
    if belt is None:
        belt = np.full(friction.size, float(getattr(run.mechanism(scenario), "belt_velocity", 0.0)))
    inside = slice(HALF_WIDTH, -HALF_WIDTH)
    found = probable_sign_error(friction[inside], (motion - belt)[inside])
    return None if found is None else dataclasses.replace(found, remedy=turned_round(run, "friction_force"))


def turned_round(run: Run, name: str) -> str:
    """Return how the sign of a channel is turned: by a key, or without the one that turns it already."""
    return f"{'take out' if name in run.turned else 'give'} sign = {{ {name} = -1 }}"


def _velocity(run: Run, velocity: str, position: str) -> Array | None:
    """Return a velocity as measured, or from the position through a window; None if neither was measured."""
    if velocity in run.channels:
        return run.channels[velocity]
    if position not in run.channels:
        return None
    h = run.sample_interval
    return smooth(run.channels[position], HALF_WIDTH * h, h, derivative=1)
