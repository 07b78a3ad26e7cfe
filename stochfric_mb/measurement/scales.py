"""Wrong units of a belt rig: what the record shows of lengths and times must fit the stated mass, spring and belt.

A box that sticks moves at the belt's speed; it slips for about half a natural period; it moves by about the deflection
that friction can hold. One wrong unit puts these three off by powers of one factor, which says whose unit it is.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from stochfric_mb.measurement.smoothing import smooth
from stochfric_mb.mechanisms import BeltBox, HingePendulum, PrismaticJoint

if TYPE_CHECKING:
    from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

STUCK_SHARE = 0.2
"""Share of the record that must move at one speed for this to be the speed of stick."""
STUCK_SPREAD = 0.1
"""Width of the speeds of that share over their middle [-]: the extremes of a sine hold their fifth in 0.19."""
SPEED_FITS = math.log10(1.6)
"""Largest |log10| of stuck speed over belt speed: belts run off their stated speed by some per cent, units by 10 or more."""
TIME_FITS = (math.log10(0.3), math.log10(5.0))
"""Range of log10 of the time in slip over half a natural period: 1 to 2 by theory, more for lag and weak springs."""
CORRECTED_TIME = math.log10(3.0)
"""Largest log10 of that time once a unit is corrected: theory's 2 and half as much again. A sensor that clips or loses the box
shortens slips to a tenth, and a mass that is off by 1000 would then leave slips three times too long."""
LENGTH_FITS = (-2.0, 1.0)
"""Range of log10 of the range of positions over mu_s N/k: slips are short where mu_k is near mu_s, drifts lengthen it."""
WINDOWS = (8, 24, 72, 216)
"""Half widths of the windows through which an acceleration is taken from a position [samples]."""
SURE = 0.05
"""Largest relative standard error of a mass that counts as seen [-]."""
SURE_OF_A_FACTOR = 1.0 / 6.0
"""The same of a mass that is asked for a factor of two: three standard errors are half of it [-]."""
CLEARLY = 0.5
"""Part of the error as labelled that an angle in another unit leaves at most where it is clearly the better one [-]."""
SHARE = 0.1
"""Least share of the driving force's deviation that inertia must have for a mass to be seen [-]."""
REPEATED = 0.25
"""Different readings over all, below which a sensor reads in steps [-]."""
LAGS = 8
"""Distances over which slopes are taken: powers of 2 [samples]."""

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]: a load in kg makes coefficients of friction so many times too large."""
AS_GRAVITY = 0.1
"""Largest relative distance of every coefficient from that many times the stated one [-]: tables are as good."""
USUAL_FRICTION = (0.02, 1.5)
"""Range of mu_s from lubricated bearings to rubber [-]; another one was no guess from a table."""


@dataclasses.dataclass(frozen=True)
class Shown:
    """What the record shows over what the model states, as log10."""

    speed: float
    """Stuck speed over belt speed."""
    length: float
    """Range of positions over mu_s N/k."""
    time: float
    """Time in slip over half a natural period."""

    def fits(self, cause: Cause | None = None) -> bool:
        """Return whether the record fits the model, once the unit of ``cause`` is corrected."""
        speed, length, time = self.speed, self.length, self.time
        if cause is not None:
            size = math.log10(cause.factor)
            speed -= cause.speed * size
            length -= cause.length * size
            time -= cause.time * size
        return abs(speed) <= SPEED_FITS and LENGTH_FITS[0] <= length <= LENGTH_FITS[1] and TIME_FITS[0] <= time <= TIME_FITS[1]


@dataclasses.dataclass(frozen=True)
class Cause:
    """One number or column that is ``factor`` times too large, and the powers of the factor that it leaves."""

    name: str
    """Channel, or key of ``[mechanism]``."""
    factor: float
    """Value over true value [-]."""
    speed: float
    """Power in stuck speed over belt speed."""
    length: float
    """Power in range over mu_s N/k."""
    time: float
    """Power in time in slip over half a natural period."""


POWERS: dict[str, tuple[float, float, float]] = {
    "position": (1.0, 1.0, 0.0),
    "time": (-1.0, 0.0, 1.0),
    "belt_velocity": (-1.0, 0.0, 0.0),
    "stiffness": (0.0, 1.0, 0.5),
    "mass": (0.0, 0.0, -0.5),
    "normal_force": (0.0, -1.0, 0.0),
}
"""What may have a wrong unit -> powers of its factor in the three ratios: speed, length, time."""
IN_DEGREES = 180.0 / math.pi
"""Factor of an arc that was made of an angle in degrees, as if that were one in rad [-]."""
FACTORS: dict[str, tuple[float, ...]] = {
    "position": (1e3, 1e-3, 1e6, 1e-6, 1e2, 1e-2, 10.0, 0.1, 1.0 / 0.0254, 0.0254, 25.4, 1.0 / 25.4, IN_DEGREES),
    "time": (1e3, 1e-3, 1e6, 1e-6, 60.0, 1.0 / 60.0),
    "belt_velocity": (1e3, 1e-3, 1e6, 1e-6, 1e2, 1e-2, 6e4, 60.0, 1.0 / 60.0),
    "stiffness": (1e-3, 1e-6),
    "mass": (1e3, 1e-3),
    "normal_force": (1e3, 1e-3),
    "force": (1e3, 1e-3),
    "torque": (1e3, 1e-3, 1e2, 1e-2),
    "angle": (IN_DEGREES, 1.0 / IN_DEGREES),
    "length": (1e3, 1e-3),
    "inertia": (1e3, 1e-3, 1e4, 1e-4, 1e6, 1e7, 1e-7),
}
"""What may have a wrong unit -> factors between the units in use; an inertia of a millionth is a time in ms."""


def shown(run: Run, box: BeltBox, mu_s: float) -> Shown | None:
    """Return what a record shows over what is stated; None where the box is not seen to stick and slip on a belt that runs."""
    position = run.channels.get("position")
    belt = belt_speed(run, box)
    if position is None or belt == 0.0:
        return None
    stick = stuck_speed(position, run.sample_interval)
    if stick is None:
        return None
    speed, lag = stick
    low, high = np.quantile(position, (0.005, 0.995))
    hold = mu_s * box.normal_force / box.stiffness
    if not (high > low and speed and hold > 0.0):
        return None
    slip = slip_time(position, run.sample_interval, speed, lag)
    if slip is None:
        return None
    half = math.pi * math.sqrt(box.mass / box.stiffness)
    return Shown(math.log10(abs(speed) / belt), math.log10((high - low) / hold), math.log10(slip / half))


def belt_speed(run: Run, box: BeltBox) -> float:
    """Return the belt's speed, as measured or as stated [m/s]; 0: it rests."""
    measured = run.channels.get("belt_velocity")
    return abs(box.belt_velocity) if measured is None else abs(float(np.median(measured)))


def stuck_speed(position: Array, interval: float) -> tuple[float, int] | None:
    """Return the speed at which a record moves most of the time [units of position/s], and the lag that shows it [samples].

    Slopes are taken over several distances, because noise blurs short ones and slips long ones: the shortest distance at
    which a share of `STUCK_SHARE` lies within `STUCK_SPREAD` of one speed decides, and at which steps of the sensor are finer
    than that. None: there is no such speed.
    """
    step = _sensor_step(position)
    for lag in (2**i for i in range(LAGS)):
        if 20 * lag > position.size:
            break
        slopes = np.sort((position[lag:] - position[:-lag]) / (lag * interval))
        count = max(int(STUCK_SHARE * slopes.size), 2)
        widths = slopes[count - 1 :] - slopes[: slopes.size - count + 1]
        first = int(np.argmin(widths))
        middle = float(np.median(slopes[first : first + count]))
        if max(widths[first], step / (lag * interval)) < STUCK_SPREAD * abs(middle):
            return middle, lag
    return None


def _sensor_step(position: Array) -> float:
    """Return the step in which a sensor reads [units of position]; 0 where most readings are of their own."""
    levels = np.unique(position)
    return float(np.diff(levels).min()) if 1 < levels.size < REPEATED * position.size else 0.0


def slip_time(position: Array, interval: float, speed: float, lag: int) -> float | None:
    """Return the median time for which a record turns back from the stuck speed [s]; None if it is none, or less than the lag.

    Windows lengthen slips by the lag; a slip shorter than its window is not resolved, and tells no time.
    """
    lengths = np.array([last - first - lag for first, last in _backwards(position, interval, speed, lag)])
    return float(np.median(lengths)) * interval if lengths.size and np.median(lengths) >= lag else None


def slip_spans(position: Array, interval: float) -> list[tuple[int, int]]:
    """Return the first and last sample of each slip of a box that sticks most of the time; empty where it does not.

    Args:
        position: shape (n,), uniform samples.
        interval: distance between samples [s].
    """
    stick = stuck_speed(position, interval)
    if stick is None:
        return []
    speed, lag = stick
    spans = _backwards(position, interval, speed, lag)
    return [(first + lag - 1, max(last, first + lag)) for first, last in spans]


def _backwards(position: Array, interval: float, speed: float, lag: int) -> list[tuple[int, int]]:
    """Return where slopes over ``lag`` samples turn back from the stuck speed, without the few samples that noise turns."""
    slopes = (position[lag:] - position[:-lag]) / (lag * interval)
    back = np.concatenate(([False], slopes / speed < 0.0, [False]))
    edges = np.flatnonzero(np.diff(back.astype(np.int8)))
    firsts, lasts = edges[::2], edges[1::2]
    long = lasts - firsts > 0.2 * (lasts - firsts).max(initial=0)
    return list(zip(firsts[long].tolist(), lasts[long].tolist(), strict=True))


def likeliest(seen: Shown) -> Cause | None:
    """Return the one wrong unit that explains best what a record shows; None if it fits, or no single unit explains it."""
    if seen.fits():
        return None
    known = [Cause(name, factor, *powers) for name, powers in POWERS.items() for factor in FACTORS[name]]
    return min(
        (c for c in known if seen.fits(c) and (not c.time or seen.time - c.time * math.log10(c.factor) <= CORRECTED_TIME)),
        key=lambda cause: abs(seen.speed - cause.speed * math.log10(cause.factor)),
        default=None,
    )


def load_in_kilograms(shown: Sequence[float], stated: Sequence[float], load: float) -> str:
    """Return what is said of a load [N] that is probably a mass in kg; empty where coefficients do not say so.

    Args:
        shown: coefficients of friction as a record has them, with this load [-].
        stated: the same as stated, mu_s or the only one first [-].
        load: the normal force stated [N].
    """
    usual = USUAL_FRICTION[0] <= stated[0] <= USUAL_FRICTION[1]
    if not usual or any(abs(a / (GRAVITY * b) - 1.0) > AS_GRAVITY for a, b in zip(shown, stated, strict=True)):
        return ""
    return (
        f"friction comes out at {shown[0] / stated[0]:.3g} times what is stated, as much as gravity in m/s^2: normal_force = "
        f"{load:g} N is probably a mass in kg; write normal_force = {GRAVITY * load:.4g} (N)"
    )


def inertia(run: Run, joint: PrismaticJoint | HingePendulum, angle: float = 1.0) -> tuple[float, float] | None:
    """Return force over acceleration, and friction, in the units of the file; None where a record does not show them.

    Least squares of the driving force on acceleration, velocity, its sign, position, pressure and a constant, all seen through
    one window; that of the windows in which the mass is surest. At a hinge the weight of the arm comes in as sine and cosine
    of the angle in place of the position. An angle in another unit than labelled that leaves far less of the force shows its
    mass with fewer digits, too: what no term of these is, such as a spring, leaves it unsure.

    Args:
        run: the record.
        joint: the joint stated.
        angle: the unit of the recorded angle [rad].

    Returns:
        Mass [kg] and friction [N], or inertia [kg m^2] and friction torque [N m].
    """
    hinge = isinstance(joint, HingePendulum)
    position, drive = run.channels.get("position"), run.channels.get("torque" if hinge else "force")
    gain = joint.torque_gain if isinstance(joint, HingePendulum) else joint.force_gain
    if drive is None and gain > 0.0 and "voltage" in run.channels:
        drive = gain * run.channels["voltage"]
    if position is None or drive is None:
        return None
    drive = joint.drive_factor * drive
    others = [np.sin(angle * position), np.cos(angle * position)] if hinge else [position]
    others += [run.channels[name] for name in ("pressure",) if name in run.channels]
    h, widths = run.sample_interval, [m for m in WINDOWS if 20 * m < position.size]
    fits = [_force_balance(angle * position, drive, others, h, m) for m in widths]
    if not fits:
        return None
    i = min(range(len(fits)), key=lambda n: fits[n].error / abs(fits[n].mass))
    sure, seen = SURE, fits[i]
    if angle != 1.0 and seen.error >= sure * seen.mass:
        as_labelled = [np.sin(position), np.cos(position), *others[2:]]
        if seen.left < CLEARLY * _force_balance(position, drive, as_labelled, h, widths[i]).left:
            sure = SURE_OF_A_FACTOR
    if seen.mass > 0.0 and seen.friction > 0.0 and seen.error < sure * seen.mass and seen.share > SHARE:
        return seen.mass, seen.friction
    return None


class _Fit(NamedTuple):
    """What a balance of forces shows, in the units of the file."""

    mass: float
    """Force over acceleration; NaN for 0."""
    error: float
    """Its standard error."""
    friction: float
    """Dry friction."""
    share: float
    """Deviation of the inertial force over that of the driving force [-]."""
    left: float
    """Deviation of the driving force that no term explains."""


def _force_balance(position: Array, drive: Array, others: list[Array], h: float, m: int) -> _Fit:
    """Return what least squares of a driving force on acceleration, sign of velocity, velocity and others show."""
    rows = slice(2 * m, -2 * m, m)  # about one row a window
    velocity = smooth(position, m * h, h, derivative=1)
    terms = [smooth(position, m * h, h, derivative=2), smooth(np.sign(velocity), m * h, h), velocity]
    terms += [smooth(values, m * h, h) for values in others]
    columns: Array = np.column_stack([*terms, np.ones_like(position)])[rows]
    sizes: Array = np.sqrt((columns**2).sum(axis=0))
    sizes[sizes == 0.0] = 1.0
    driving = smooth(drive, m * h, h)[rows]
    basis = np.asarray(np.linalg.pinv(columns / sizes), dtype=np.float64)
    values: Array = basis @ driving
    rest: Array = driving - (columns / sizes) @ values
    error = math.sqrt(float(rest @ rest) / max(len(rest) - len(values), 1) * float(basis[0] @ basis[0]))
    spread = float(driving.std())
    share = abs(values[0]) * float((columns[:, 0] / sizes[0]).std()) / spread if spread > 0.0 else 0.0
    mass = float(values[0] / sizes[0]) or math.nan
    return _Fit(mass, error / float(sizes[0]), float(values[1] / sizes[1]), float(share), float(rest.std()))
