"""Inverse dynamics of prismatic joints and hinge pendulums, in weak form: what is left of the drive for friction."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.conditions import distance_before, known_factors, temperature_through
from stochfric_mb.discovery.driven_joint.balance.force_balance import (
    ForceBalance,
    Nuisance,
    distance_slid,
    least_speed,
    slides,
    slipped,
)
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, chosen_window, narrowest
from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, HingePendulum, PrismaticJoint
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Joint = PrismaticJoint | HingePendulum

GAINS = {"force": "N/V", "torque": "N m/V"}
"""Drive that a voltage may stand for -> unit of its gain."""
UNITS = {
    "prismatic_joint": {"mass": "kg", "damping": "N s/m", "offset": "N", "piston_area": "m^2", "force_gain": "N/V"},
    "hinge_pendulum": {"mass": "kg", "inertia": "kg m^2", "damping": "N m s/rad", "offset": "N m", "torque_gain": "N m/V"},
}
"""Numbers of the mechanisms that may be corrected, and their units."""
ABSOLUTE = ("offset",)
"""Numbers whose uncertainty is given in their own unit, since they may be stated as 0."""
POSITIVE = ("mass", "inertia", "damping", "piston_area")
"""Numbers that cannot be negative."""
HELD = 0.5
"""How much later than its sample a drive acts that a controller holds until its next sample [samples], on average."""


@dataclasses.dataclass(frozen=True)
class Term:
    """A signal, or a derivative of it, in the balance."""

    signal: Array
    """Samples, shape (count,)."""
    derivative: int = 0
    """Which derivative of it is meant."""


def terms_of(run: Run, joint: Joint) -> dict[str, Callable[[float], list[tuple[float, Term]]]]:
    """Return what enters drive = sum of terms + friction for each number of the mechanism: value -> (factor, term).

    Raises:
        InputError: a channel is missing.
    """
    q = position_of(run)
    one = np.ones_like(q)
    terms: dict[str, Callable[[float], list[tuple[float, Term]]]] = {
        "damping": lambda x: [(x, Term(q, 1))],
        "offset": lambda x: [(x, Term(one))],
    }
    if isinstance(joint, PrismaticJoint):
        terms["mass"] = lambda x: [(x, Term(q, 2))]
        if joint.piston_area > 0.0:
            pressure = _channel(run, "pressure")
            terms["piston_area"] = lambda x: [(x, Term(pressure))]
    else:
        length, g = joint.length, joint.gravity
        terms["inertia"] = lambda x: [(x, Term(q, 2))]
        terms["mass"] = lambda x: [(x * length**2, Term(q, 2)), (x * length * g, Term(np.sin(q)))]
    name, gain = ("force", "force_gain") if isinstance(joint, PrismaticJoint) else ("torque", "torque_gain")
    if getattr(joint, gain):
        drive = _channel(run, "voltage")
        terms[gain] = lambda x: [(-x, Term(drive))]
    else:
        drive = _channel(run, name)
        terms["drive"] = lambda x: [(-x, Term(drive))]
    return terms


def position_of(run: Run) -> Array:
    """Return the measured position, or the integral of the measured velocity where there is none.

    Raises:
        InputError: the run has neither.
    """
    if "position" in run.channels:
        return run.channels["position"]
    if "velocity" in run.channels:
        v = run.channels["velocity"]
        return np.r_[0.0, np.cumsum(0.5 * (v[1:] + v[:-1]))] * run.sample_interval
    raise InputError(f"run {run.name!r} has neither position nor velocity; a driven joint needs its motion")


def drive_of(run: Run, joint: Joint) -> Array:
    """Return the driving force, its gain as stated [N or N m], shape (count,)."""
    force, gain = ("force", "force_gain") if isinstance(joint, PrismaticJoint) else ("torque", "torque_gain")
    factor = getattr(joint, gain)
    return factor * _channel(run, "voltage") if factor else _channel(run, force)


def motion_velocity(run: Run) -> Array:
    """Return the velocity of a run through its narrowest window [m/s or rad/s], shape (count,)."""
    return narrowest(run).through(position_of(run), 1)


def nuisances_of(scenario: Scenario, joint: Joint) -> list[Nuisance]:
    """Return the numbers of the mechanism that data may correct, with their priors."""
    nuisances: list[Nuisance] = []
    for name, unit in UNITS[joint.kind].items():
        value = float(getattr(joint, name))
        spread = scenario.uncertainty.get(name, 0.0)
        deviation = spread if name in ABSOLUTE else spread * abs(value)
        if deviation > 0.0:
            nuisances.append(Nuisance(name, value, deviation, unit, 0.0 if name in POSITIVE else -np.inf))
    return nuisances


def stated_friction(scenario: Scenario, load: float) -> float:
    """Return the sliding friction that the scenario believes in [N or N m]."""
    return scenario.law.mu_k * load


def balance_of(
    run: Run, scenario: Scenario, *, delay: float = 0.0, samples: int | None = None, runs: Sequence[Run] = ()
) -> ForceBalance:
    """Return a run of a prismatic joint or hinge pendulum as a balance.

    Args:
        run: the run.
        scenario: the present model.
        delay: by how much the position comes after the driving force in the record [s]; compensated here.
        samples: half width of the window [samples]; None: chosen from the noise.
        runs: all runs of the dataset; pieces of the same record that come before have slid already.

    Raises:
        InputError: a channel is missing, or the run is too short.
    """
    joint: Joint = run.mechanism(scenario)  # type: ignore[assignment]
    terms = terms_of(run, joint)
    q, h = position_of(run), run.sample_interval
    values = {name: float(getattr(joint, name, 1.0)) for name in terms}
    noise = _noise(terms, values, q)
    window = (
        chosen_window(h, len(q), noise, stated_friction(scenario, joint.normal_force))
        if samples is None
        else Window(samples * h, h, len(q))
    )
    if len(window.centres) < 8:
        raise InputError(
            f"run {run.name!r}: {len(q)} samples are too few for windows of {window.half_width:.3g} s; record longer"
        )
    drives = ("drive", "force_gain", "torque_gain")
    late = delay + (HELD * h if isinstance(scenario.controller, Cascade) else 0.0)
    columns: dict[str, Array] = {}
    total = np.zeros(len(window.centres))
    for name, of in terms.items():
        shift = late if name in drives else 0.0
        column = sum(f * window.through(t.signal, t.derivative, shift)[window.centres] for f, t in of(1.0))
        total = total - values[name] * column
        columns[name] = np.asarray(column)
    velocity = window.through(q, 1)
    least = least_speed(velocity, window.gain(1) * white_noise(q))
    position = window.through(q)
    load, load_by_drive = transmitted_load(run, joint, window)
    before = distance_before(run, runs, motion_velocity)
    return ForceBalance(
        run=run.name,
        role=run.role,
        place="",
        unit="N m" if joint.rotational else "N",
        window=window,
        time=run.time,
        position=position,
        velocity=velocity,
        load=load,
        slip=slipped(position, velocity, least),
        driven=total,
        columns={k: v for k, v in columns.items() if k != "drive"},
        sliding=slides(window, velocity, least),
        noise=float(np.sqrt(sum((window.gain(d) * s) ** 2 for d, s in noise.items()))),
        factors=known_factors(run, window, position, velocity, load, before + distance_slid(velocity, window)),
        white=noise,
        before=before,
        temperature=temperature_through(run, window),
        load_by_drive=load_by_drive,
        drive=window.sampled(drive_of(run, joint), late),
        pressure=window.sampled(run.channels["pressure"]) if "pressure" in run.channels else None,
    )


def _noise(
    terms: Mapping[str, Callable[[float], list[tuple[float, Term]]]], values: Mapping[str, float], q: Array
) -> dict[int, float]:
    """Return the noise that enters with each derivative: position noise counts once, however many terms it enters."""
    factors: dict[int, float] = {}
    other = 0.0
    for name, of in terms.items():
        for factor, term in of(values[name]):
            if term.signal is q:
                factors[term.derivative] = factors.get(term.derivative, 0.0) + factor
            elif np.ptp(term.signal) > 0.0 and name in ("drive", "force_gain", "torque_gain", "piston_area"):
                other += (factor * white_noise(term.signal)) ** 2
    noise = {d: abs(f) * white_noise(q) for d, f in factors.items()}
    noise[0] = float(np.hypot(noise.get(0, 0.0), np.sqrt(other)))
    return noise


def transmitted_load(run: Run, joint: Joint, window: Window) -> tuple[Array, Array | None]:
    """Return the load that the joint transmits beyond its stated load, and its change with the drive, shape (count,) each.

    The load is the channel ``normal_force``, or the force of the pressure on the piston, or the size of the driving torque:
    then it changes with the drive that it is asked to explain.
    """
    known = measured_load(run, joint)
    if known is not None:
        return np.abs(window.through(known)), None
    assert isinstance(joint, HingePendulum)
    if joint.torque_gain:
        torque = joint.torque_gain * window.through(run.channels["voltage"])
        torque = torque - joint.damping * window.through(position_of(run), 1)
    else:
        torque = window.through(run.channels["torque"])
    return np.abs(torque), np.sign(torque)


def measured_load(run: Run, joint: Joint) -> Array | None:
    """Return the load that a joint transmits beyond its stated load, either sign [N or N m], shape (count,).

    None: it is the size of the driving torque, and was not measured apart from that.
    """
    if "normal_force" in run.channels:
        return run.channels["normal_force"]
    if isinstance(joint, HingePendulum):
        return None
    return joint.piston_area * _channel(run, "pressure") if joint.piston_area > 0.0 else np.zeros(len(run.time))


def _channel(run: Run, name: str) -> Array:
    if name not in run.channels:
        given = ", ".join(run.channels)
        remedy = f"name its column with columns = {{ {name} = ... }}"
        if name in GAINS and "voltage" in run.channels:
            remedy += f", or state mechanism.{name}_gain [{GAINS[name]}], by which the voltage drives"
        raise InputError(f"run {run.name!r} has no {name} (it has {given}); {remedy}")
    return run.channels[name]
