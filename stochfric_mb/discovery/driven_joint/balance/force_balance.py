"""A force balance: one run at one joint, as the balance of forces in weak form and the motion along which friction acts."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, narrowest
from stochfric_mb.effects import Effect
from stochfric_mb.effects.load_side import MotorMotion
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.smoothing import window
from stochfric_mb.measurement.temperature import temperature_of

Array = npt.NDArray[np.float64]

LEAST_SPEED = 0.02
"""Speed below which a joint is not taken to slide, over its 90 % speed [-]."""
REMEMBERED = 16
"""Forces of loads that are kept: a fit moves one number after the other, and comes back."""
GAIN, DRIVE_FACTOR = "gain", "drive_factor"
"""Column of the whole drive at a joint of a user's model, and at a slide or hinge, by the number that is its factor there."""
OF_THE_DRIVE = (GAIN, DRIVE_FACTOR, "force_gain", "torque_gain")
"""Numbers that the whole drive is multiplied by."""
PAYLOADS = {"centre": "payload_centre", "end": "payload_end"}
"""Place of further mass in the last body of a chain of joints -> its column; none is stated."""
SURE = 5.0
"""Least sliding speed in standard deviations of the velocity's noise."""


@dataclasses.dataclass(frozen=True)
class Nuisance:
    """A number of the stated model that enters the balance linearly."""

    name: str
    """Its name in the scenario's ``[mechanism]``."""
    value: float
    """Prior mean."""
    deviation: float
    """Standard deviation of the prior, > 0; inf: there is none."""
    unit: str
    """Its unit."""
    low: float = -np.inf
    """Smallest value that it can have."""


@dataclasses.dataclass(frozen=True)
class ForceBalance:
    """driven = sum of nuisance columns times (value - stated), bends times its square + friction, at the centres of windows.

    ``driven`` is the driving force less inertia, gravity and all else that the stated model says, friction left out.
    """

    run: str
    """Name of the run."""
    unit: str
    """Unit of forces: N, or N m."""
    window: Window
    """The window and its centres."""
    time: Array
    """Time since the start of the record [s], shape (count,)."""
    position: Array
    """Position through the window [m or rad], shape (count,)."""
    velocity: Array
    """Velocity in weak form [m/s or rad/s], shape (count,)."""
    load: Array
    """Load that the joint transmits, beyond its stated load [N or N m], shape (count,), >= 0."""
    slip: Array
    """Distance since the last reversal [m or rad], shape (count,)."""
    driven: Array
    """Force that friction has to take up [N or N m], shape (n_centres,)."""
    columns: Mapping[str, Array]
    """Nuisance -> change of the balance per unit of it, shape (n_centres,)."""
    sliding: npt.NDArray[np.bool_]
    """Whether the joint slides one way all through the window, shape (n_centres,)."""
    white: Mapping[int, float] = dataclasses.field(default_factory=dict[int, float])
    """Derivative -> white noise of what enters the balance with it."""
    bends: Mapping[str, Array] = dataclasses.field(default_factory=dict[str, Array])
    """Nuisance that enters by its square -> half the change of its column per unit of it, shape (n_centres,)."""
    before: float = 0.0
    """Distance slid in the pieces of the same record that come before this one [m or rad]."""
    temperature: Array | None = None
    """Measured temperature [degC], shape (count,); None: none was."""
    constants: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Known conditions that stay the same in the run."""
    load_by_drive: Array | None = None
    """Change of ``load`` with the driving force, -1 or 1, shape (count,); None: the load is known without it."""
    drive: Array | None = None
    """Driving force, its gain as stated [N or N m], shape (count,); None: the place has none of its own."""
    drive_factor: float = 1.0
    """What is stated of the factor of the drive, see `DRIVE_FACTOR` [-]."""
    pressure: Array | None = None
    """Pressure on the piston [Pa], shape (count,); None: none was measured."""
    normal_force: Array | None = None
    """Normal force of a contact [N], shape (count,), >= 0; None: the stated load, which stays."""
    motor: Callable[[], MotorMotion | None] = lambda: None
    """Returns the motion of the motor, behind which the load may move by itself; None: no joint with an inertia."""
    known: dict[Effect, Array] = dataclasses.field(default_factory=dict[Effect, Array])
    """Forces of such loads that were worked out last [N or N m], shape (n_centres,) each."""
    at_motor: dict[Any, Array] = dataclasses.field(default_factory=dict[Any, Array])
    """Friction beside such a load that was worked out last, by law, effects and load [N or N m], shape (n_centres,)."""

    def white_variance(self, along: Array, centres: npt.NDArray[np.int64]) -> float:
        """Return the variance that white noise of the channels gives the coefficient of ``along`` [1/(N or N m)^2 of it].

        Windows overlap, and a derivative's noise in one is made up for in the next: the sum over windows is of one signal.

        Args:
            along: what the balance is projected on, at the centres of some windows, shape (n,).
            centres: samples of those centres, shape (n,).
        """
        half, size = len(self.window.taps) // 2, float(along @ along)
        spread = np.zeros(int(centres[-1] - centres[0]) + 1)
        spread[centres - centres[0]] = along
        total = 0.0
        for derivative, noise in self.white.items():
            taps = window(self.window.half_width, self.window.interval, derivative=derivative)
            total += noise**2 * float(np.sum(np.convolve(spread, taps[: 2 * half + 1]) ** 2))
        return total / size**2

    def load_force(self, effect: Effect) -> Array | None:
        """Return the force of a load that moves by itself [N or N m], shape (n_centres,); None: none does.

        Args:
            effect: what lets it.
        """
        if not effect.moves_load:
            return None
        if effect not in self.known:
            motor = self.motor()
            force = None if motor is None else effect.load_force(motor)
            if force is None:
                return None
            if len(self.known) >= REMEMBERED:
                self.known.pop(next(iter(self.known)))
            self.known[effect] = self.window.at_centres(force)
        return self.known[effect]

    def with_more_drive(self, step: float) -> ForceBalance:
        """Return the same motion with a larger drive, and the load that it makes; the balance itself stays.

        Args:
            step: by how much the drive is larger [N or N m].
        """
        if step not in self._moved:
            load = self.load if self.load_by_drive is None else self.load + step * self.load_by_drive
            drive = None if self.drive is None else self.drive + step
            self._moved[step] = dataclasses.replace(self, load=load, drive=drive, at_motor={})
        return self._moved[step]

    @functools.cached_property
    def _moved(self) -> dict[float, ForceBalance]:
        return {}

    @functools.cached_property
    def travelled(self) -> Array:
        """Distance slid since the record began, whichever way [m or rad], shape (count,)."""
        return self.before + distance_slid(self.velocity, self.window)

    @functools.cached_property
    def signals(self) -> tuple[Array, ...]:
        """What friction is evaluated with, at every stride-th sample, in the order of `friction_along`'s compiled code.

        Time, position, velocity, load, slip, distance, temperature (0: not measured), normal force [N] (0: the stated load),
        drive and pressure (0: not measured), shape (n_samples,) each.
        """
        none = np.zeros(len(self.time))
        measured = (
            self.time, self.position, self.velocity, self.load, self.slip, self.travelled, self.temperature, self.normal_force,
            self.drive, self.pressure,
        )  # fmt: skip
        return tuple(np.ascontiguousarray((none if x is None else x)[:: self.window.stride]) for x in measured)

    @property
    def factors(self) -> dict[str, Array]:
        """The conditions that friction may depend on: name -> shape (n_centres,)."""
        at = self.window.centres
        along = {
            "direction": np.sign(self.velocity),
            "speed": np.abs(self.velocity),
            "position": self.position,
            "load": self.load,
            "time": self.time,
            "distance": self.travelled,
        }
        along |= {} if self.temperature is None else {"temperature": self.temperature}
        return {k: v[at] for k, v in along.items()} | {k: np.full(len(at), v) for k, v in self.constants.items()}


def balance_along(run: Run, window: Window, position: Array, velocity: Array, least: float, **more: Any) -> ForceBalance:
    """Return the balance of a run whose motion along a place is known.

    Args:
        run: the run.
        window: the window that it is seen through.
        position: position through it [m or rad], shape (count,).
        velocity: velocity in weak form [m/s or rad/s], shape (count,).
        least: speed above which the place surely slides [m/s or rad/s].
        more: the other fields of a balance.
    """
    temperature = temperature_of(run)
    return ForceBalance(
        run=run.name,
        window=window,
        time=run.time,
        position=position,
        velocity=velocity,
        slip=slipped(position, velocity, least),
        temperature=None if temperature is None else window.held(window.through(temperature)),
        constants=run.constants,
        **more,
    )


def known_temperature(run: Run) -> Array:
    """Return the measured temperature [degC], shape (count,); zeros where there is none, and no effect that asks for it."""
    seen = temperature_of(run)
    return np.zeros(len(run.time)) if seen is None else seen


def distance_before(run: Run, runs: Sequence[Run], velocity: Callable[[Run], Array]) -> float:
    """Return the distance slid in earlier pieces of the record that a run is a piece of [m or rad].

    Args:
        run: the run.
        runs: all runs of its dataset.
        velocity: velocity of a run through its narrowest window, shape (count,).
    """
    earlier = [r for r in runs if run.source and r.source == run.source and r.time[-1] <= run.time[0]]
    return sum(float(distance_slid(velocity(r), narrowest(r))[-1]) for r in earlier)


def distance_slid(velocity: Array, window: Window) -> Array:
    """Return the distance moved since the first sample, whichever way [m or rad], shape (count,).

    Args:
        velocity: velocity through a window, so that noise at rest hardly counts [m/s or rad/s], shape (count,).
        window: the window.
    """
    return integrated(np.abs(window.held(velocity)), window.interval)


def integrated(values: Array, interval: float) -> Array:
    """Return the integral of a signal since its first sample, by trapezoids, shape (n,)."""
    return np.r_[0.0, np.cumsum(0.5 * (values[1:] + values[:-1]))] * interval


def slipped(position: Array, velocity: Array, least: float) -> Array:
    """Return the distance moved since the joint last reversed or rested [m or rad], shape as ``position``."""
    moving = np.abs(velocity) > least
    direction = np.where(moving, np.sign(velocity), 0.0)
    starts = np.r_[True, direction[1:] != direction[:-1]]
    first = np.maximum.accumulate(np.where(starts, np.arange(len(position)), 0))
    return np.where(moving, np.abs(position - position[first]), 0.0)


def least_speed(velocity: Array, noise: float) -> float:
    """Return the speed above which a joint surely slides.

    Args:
        velocity: velocity in weak form, shape (n,).
        noise: standard deviation of its noise.
    """
    return max(SURE * noise, LEAST_SPEED * float(np.quantile(np.abs(velocity), 0.9)))


def slides(window: Window, velocity: Array, least: float) -> npt.NDArray[np.bool_]:
    """Return at which centres the joint slides one way all through the window, shape (n_centres,)."""
    seen = window.views(velocity)
    return (seen.min(axis=1) > least) | (seen.max(axis=1) < -least)
