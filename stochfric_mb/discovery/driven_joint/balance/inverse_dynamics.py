"""Inverse dynamics of prismatic joints and hinge pendulums, in weak form: what is left of the drive for friction."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import (
    DRIVE_FACTOR,
    ForceBalance,
    Nuisance,
    balance_along,
    distance_before,
    integrated,
    least_speed,
    slides,
)
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, narrowest, window_of
from stochfric_mb.discovery.inference.noise import noise_level
from stochfric_mb.effects.load_side import MotorMotion
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, HingePendulum, PrismaticJoint
from stochfric_mb.scenario import ABSOLUTE

Array = npt.NDArray[np.float64]
Joint = PrismaticJoint | HingePendulum

DRIVES = {PrismaticJoint.kind: ("force", "force_gain"), HingePendulum.kind: ("torque", "torque_gain")}
"""Mechanism -> channel of the force that drives it, and the number by which a voltage stands for that."""
DRIVEN = ("drive", "force_gain", "torque_gain")
"""Names of the term that is the drive."""
GAINS = {"force": "N/V", "torque": "N m/V"}
"""Drive that a voltage may stand for -> unit of its gain."""
UNITS = {
    "prismatic_joint": {
        "mass": "kg", "damping": "N s/m", "offset": "N", "piston_area": "m^2", "force_gain": "N/V", DRIVE_FACTOR: "-",
    },
    "hinge_pendulum": {
        "mass": "kg", "length": "m", "inertia": "kg m^2", "damping": "N m s/rad", "offset": "N m", "torque_gain": "N m/V",
        DRIVE_FACTOR: "-",
    },
}  # fmt: skip
"""Numbers of the mechanisms that may be corrected, and their units."""
POSITIVE = ("mass", "length", "inertia", "damping", "piston_area", DRIVE_FACTOR)
"""Numbers that cannot be negative."""
HELD = 0.5
"""How much later than its sample a drive acts that a controller holds until its next sample [samples], on average."""


@dataclasses.dataclass(frozen=True)
class Term:
    """What a number of the mechanism is multiplied with in drive = sum of terms + friction: a signal, or a derivative of it."""

    factor: float
    """Factor on the signal."""
    signal: Array
    """Samples, shape (count,)."""
    derivative: int = 0
    """Which derivative of it is meant."""


@dataclasses.dataclass(frozen=True)
class PlainBalances(Balances):
    """Force balances of the mechanisms that are one joint."""

    @property
    def places(self) -> dict[str, float]:
        """The one place, which needs no name, and its load."""
        return {"": float(self.dataset.scenario.mechanism.normal_force)}

    def nuisances(self, place: str) -> list[Nuisance]:
        """Return the numbers of the mechanism that data may correct, with their priors."""
        joint, uncertainty = self.dataset.scenario.mechanism, self.dataset.scenario.uncertainty
        nuisances: list[Nuisance] = []
        for name, unit in UNITS[joint.kind].items():
            value, spread = float(getattr(joint, name)), uncertainty.get(name, 0.0)
            deviation = spread if name in ABSOLUTE else spread * abs(value)
            if deviation > 0.0:
                nuisances.append(Nuisance(name, value, deviation, unit, 0.0 if name in POSITIVE else -np.inf))
        return nuisances

    def rotates(self, place: str) -> bool:
        """Return whether the joint is a hinge."""
        return self.dataset.scenario.mechanism.rotational

    def presses(self, place: str) -> bool:
        """Return whether all runs hold the normal force of a slide; beside a piston it adds to what seals are pressed with."""
        joint, channels = self.dataset.scenario.mechanism, [run.channels for run in self.dataset.runs]
        return bearing_alone(joint) and all("normal_force" in c for c in channels)

    def balance(self, run: Run, place: str, delay: float, samples: int | None) -> ForceBalance:
        """Return a run as a balance."""
        scenario = self.dataset.scenario
        joint: Joint = run.mechanism(scenario)  # type: ignore[assignment]
        terms = terms_of(run, joint)
        q = position_of(run)
        values = {name: float(getattr(joint, name, 1.0)) for name in terms}
        noise = _noise(terms, values, q)
        window = window_of(run, noise, scenario.law.mu_k * joint.normal_force, samples)
        name, factor = drive_channel(joint)
        late = delay + (HELD * run.sample_interval if isinstance(scenario.controller, Cascade) else 0.0)
        columns: dict[str, Array] = {}
        total = np.zeros(len(window.centres))
        for number, of in terms.items():
            shift = late if number in DRIVEN else 0.0
            seen = [t.factor * window.through(t.signal, t.derivative, shift)[window.centres] for t in of]
            columns[number] = np.sum(seen, axis=0)
            total = total - values[number] * columns[number]
        bends: dict[str, Array] = {}
        if isinstance(joint, HingePendulum):
            bends["length"] = joint.mass * columns["inertia"]
            columns["length"] = joint.mass / joint.length * columns["mass"] + joint.length * bends["length"]
        drive = next(n for n in DRIVEN if n in terms)
        columns[DRIVE_FACTOR] = values[drive] / joint.drive_factor * columns[drive]
        velocity = window.through(q, 1)
        least = least_speed(velocity, window.gain(1) * noise_level(q))
        load, load_by_drive = _transmitted_load(run, joint, window)
        return balance_along(
            run,
            window,
            window.through(q),
            velocity,
            least,
            unit="N m" if joint.rotational else "N",
            load=load,
            load_by_drive=load_by_drive,
            driven=total,
            columns={k: v for k, v in columns.items() if k != "drive"},
            bends=bends,
            sliding=slides(window, velocity, least) & window.covered(late),
            white=noise,
            before=distance_before(run, self.dataset.runs, lambda r: narrowest(r).through(position_of(r), 1)),
            drive=window.sampled(factor * channel(run, name), late),
            drive_factor=joint.drive_factor,
            pressure=window.sampled(run.channels["pressure"]) if "pressure" in run.channels else None,
            normal_force=load if self.presses(place) else None,
            motor=functools.cache(lambda: motor_motion(run, joint)),
        )


def terms_of(run: Run, joint: Joint) -> dict[str, tuple[Term, ...]]:
    """Return what enters drive = sum of terms + friction for each number of the mechanism.

    Raises:
        InputError: a channel is missing.
    """
    q, (name, _) = position_of(run), drive_channel(joint)
    terms: dict[str, tuple[Term, ...]] = {"damping": (Term(1.0, q, 1),), "offset": (Term(1.0, np.ones_like(q)),)}
    if isinstance(joint, PrismaticJoint):
        terms["mass"] = (Term(1.0, q, 2),)
        if joint.piston_area > 0.0:
            terms["piston_area"] = (Term(1.0, channel(run, "pressure")),)
    else:
        terms["inertia"] = (Term(1.0, q, 2),)
        terms["mass"] = (Term(joint.length**2, q, 2), Term(joint.length * joint.gravity, np.sin(q)))
    terms[DRIVES[joint.kind][1] if name == "voltage" else "drive"] = (Term(-joint.drive_factor, channel(run, name)),)
    return terms


def drive_channel(joint: Joint) -> tuple[str, float]:
    """Return the channel that drives a joint, and its factor: the voltage where a gain is stated, otherwise the force."""
    force, gain = DRIVES[joint.kind]
    factor = float(getattr(joint, gain))
    return ("voltage", factor * joint.drive_factor) if factor else (force, joint.drive_factor)


def position_of(run: Run) -> Array:
    """Return the measured position, or the integral of the measured velocity where there is none.

    Raises:
        InputError: the run has neither.
    """
    if "position" in run.channels:
        return run.channels["position"]
    if "velocity" in run.channels:
        return integrated(run.channels["velocity"], run.sample_interval)
    raise InputError(f"run {run.name!r} has neither position nor velocity; a driven joint needs its motion")


def motor_motion(run: Run, joint: Joint) -> MotorMotion | None:
    """Return the motion of the motor and what its load needs beside its acceleration; None: a joint without inertia.

    Gravity acts on the load, whose centre of mass the pendulum states; the pressure on a piston, damping and the offset of the
    drive act on the motor's side.
    """
    inertia, gravity = joint.mass, 0.0
    if isinstance(joint, HingePendulum):
        inertia = joint.inertia + joint.mass * joint.length**2
        gravity = joint.mass * joint.length * joint.gravity
    if inertia <= 0.0:
        return None
    q, narrow = position_of(run), narrowest(run)
    seen = [narrow.through(q, derivative) for derivative in (0, 1, 2)]
    held = gravity * np.stack([np.sin(seen[0]), np.cos(seen[0]), -np.sin(seen[0])])
    return MotorMotion(run.sample_interval, *seen, inertia=inertia, held=held, inside=narrow.inside)


def _noise(terms: Mapping[str, Sequence[Term]], values: Mapping[str, float], q: Array) -> dict[int, float]:
    """Return the noise that enters with each derivative: position noise counts once, however many terms it enters."""
    factors: dict[int, float] = {}
    other = 0.0
    for name, of in terms.items():
        for term in of:
            factor = values[name] * term.factor
            if term.signal is q:
                factors[term.derivative] = factors.get(term.derivative, 0.0) + factor
            elif np.ptp(term.signal) > 0.0 and name in (*DRIVEN, "piston_area"):
                other += (factor * noise_level(term.signal)) ** 2
    noise = {d: abs(f) * noise_level(q) for d, f in factors.items()}
    noise[0] = float(np.hypot(noise.get(0, 0.0), np.sqrt(other)))
    return noise


def _transmitted_load(run: Run, joint: Joint, window: Window) -> tuple[Array, Array | None]:
    """Return the load that the joint transmits beyond its stated load, and its change with the drive, shape (count,) each.

    The load is the channel ``normal_force``, or the force of the pressure on the piston, or the size of the driving torque:
    then it changes with the drive that it is asked to explain.
    """
    known = measured_load(run, joint)
    if known is not None:
        return np.abs(window.through(known)), None
    name, factor = drive_channel(joint)
    torque = factor * window.through(channel(run, name))
    if name == "voltage":
        torque = torque - joint.damping * window.through(position_of(run), 1)
    return np.abs(torque), np.sign(torque)


def bearing_alone(joint: object) -> bool:
    """Return whether a joint is a slide without a piston: a load that was measured there is the normal force itself."""
    return isinstance(joint, PrismaticJoint) and joint.piston_area == 0.0


def measured_load(run: Run, joint: Joint) -> Array | None:
    """Return the load that a joint transmits beyond its stated load, either sign [N or N m], shape (count,).

    None: it is the size of the driving torque, and was not measured apart from that.
    """
    if "normal_force" in run.channels:
        return run.channels["normal_force"]
    if isinstance(joint, HingePendulum):
        return None
    return joint.piston_area * channel(run, "pressure") if joint.piston_area > 0.0 else np.zeros(len(run.time))


def channel(run: Run, name: str) -> Array:
    """Return a channel of a run.

    Raises:
        InputError: it has none of that name; says what would do.
    """
    if name not in run.channels:
        given = ", ".join(run.channels)
        remedy = f"name its column with columns = {{ {name} = ... }}"
        if name in GAINS and "voltage" in run.channels:
            remedy += f", or state mechanism.{name}_gain [{GAINS[name]}], by which the voltage drives"
        raise InputError(f"run {run.name!r} has no {name} (it has {given}); {remedy}")
    return run.channels[name]
