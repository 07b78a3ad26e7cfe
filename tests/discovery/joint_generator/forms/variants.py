"""Forms that were written before a change of the method and run after it: for reporting, not for tuning."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, GAIN_OF_TIME, TIME_SPACING, Array, Plant

from .coupling import chained
from .form import JOINTS, LINES, SINGLES, Effect, Generator, Record, either_sign, form
from .law import by_speed
from .null import drives
from .place import force_at, friction_at
from .sensor import late, positions
from .time import in_time


@form("viscous_friction", also=("quadratic_damping",))
def beyond_a_speed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A seal that drags from a speed on: two straight lines."""
    knee = bench.speed * rng.uniform(0.1, 0.25)
    c = 0.7 * strength * bench.level / (bench.speed - knee)
    return by_speed({"coefficient": c, "knee": knee}, lambda v: c * np.maximum(v - knee, 0.0))


@form("velocity_weakening")
def falling_line(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A straight fall to a speed, and a constant beyond."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.25, 0.5)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.maximum(1.0 - v / knee, 0.0))


@form("position_dependent_friction")
def bowl(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A bent rail: tighter at both ends."""
    size = 0.8 * strength
    return friction_at({"size": size}, lambda q: 1.0 + size * np.minimum((q / bench.reach) ** 2, 2.0))


@form("position_dependent_friction")
def joined_rails(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Two rails of different finish: a step along the stroke."""
    size, at = 0.5 * strength * either_sign(rng), bench.reach * rng.uniform(-0.3, 0.3)
    return friction_at({"size": size, "at": at}, lambda q: 1.0 + 0.5 * size * np.tanh((q - at) / (0.03 * bench.reach)))


@form("position_dependent_force")
def detents(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Notches: a force like a saw that is rounded."""
    size, pitch = 0.45 * strength * bench.level, bench.reach * rng.uniform(0.25, 0.5)

    def force(q: Array) -> Array:
        angle = 2.0 * np.pi * q / pitch
        return size * np.sin(angle + 0.6 * np.sin(angle))

    return force_at({"size": size, "pitch": pitch}, force)


@form("position_dependent_force")
def magnet_at_an_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A magnet that catches the joint at one end of its stroke."""
    size, side = 1.2 * strength * bench.level, either_sign(rng)
    return force_at({"size": size}, lambda q: size * np.exp(-3.0 * np.maximum(1.0 - side * q / bench.reach, 0.0)))


@form("friction_drift", also=("distance_drift",))
def warm_from_a_moment(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A smooth change about the middle of the record."""
    loss, time = 0.45 * strength, bench.duration * rng.uniform(0.08, 0.15)
    return in_time(
        {"loss": loss, "time": time}, lambda t: 1.0 - 0.5 * loss * (1.0 + np.tanh((t - 0.5 * bench.duration) / time))
    )


@form("harmonic_force")
def beats(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Two machines that run at nearly the same speed."""
    size, frequency = 0.3 * strength * bench.level, rng.uniform(5.0, 9.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        one, two = rng.uniform(0.0, 2.0 * np.pi, 2)
        return plant.add_in_time(
            FORCE_OF_TIME,
            lambda t: size * (np.sin(2.0 * np.pi * frequency * t + one) + 0.6 * np.sin(2.2 * np.pi * frequency * t + two)),
        )

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("payload", also=("quadratic_damping",), on=JOINTS)
def tool_taken_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    factor = 1.0 - 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n = plant.body
        if bench.design == "arm":
            less = (factor - 1.0) * bench.numbers["m2"]
            l1, l2 = bench.numbers["l1"], bench.numbers["l2"]
            return plant.with_body(
                inertia=n["inertia"] + less * l1**2, inertia_2=n["inertia_2"] + less * l2**2,
                coupling=n["coupling"] + less * l1 * l2, gravity=n["gravity"] + less * 9.81 * l1,
                gravity_2=n["gravity_2"] + less * 9.81 * l2,
            )  # fmt: skip
        return plant.with_body(inertia=n["inertia"] * factor, gravity=n.get("gravity", 0.0) * factor)

    return Effect({"factor": factor}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=SINGLES)
def long_belt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A toothed belt with a light load at its end."""
    frequency = (bench.speed / bench.reach) * rng.uniform(1.0, 1.5) / np.sqrt(strength)
    return Effect({"frequency": frequency}, alter=lambda plant, _: chained(bench, plant, 0.4, frequency, 0.0))


@form("drive_gain_change", also=("friction_drift",), on=JOINTS)
def brown_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The supply sags from one moment on: less force for the same command."""
    loss = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        at = bench.duration * rng.uniform(0.35, 0.65)
        return plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - loss * (t > at))

    return Effect({"loss": loss}, alter=alter)


@form("unknown", also=("harmonic_force",))
def switching_force(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A brake of another axis that leans on this one, on and off at random times: a force, not friction."""
    size, rate = 0.4 * strength * bench.level, rng.uniform(1.5, 3.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        switched = np.cumsum(rng.random(plant.times.size) < rate * TIME_SPACING) % 2
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * (2.0 * switched - 1.0) + 0.0 * t)

    return Effect({"size": size, "rate": rate}, alter=alter)


@form("unknown", also=("position_dependent_force",), on=LINES)
def scale_error(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A linear scale with an error of interpolation: the reading waves about the place."""
    pitch = bench.reach * rng.uniform(0.3, 0.6)
    size = 0.12 * strength * bench.level / bench.inertia * (pitch / (2.0 * np.pi * 0.5 * bench.speed)) ** 2

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: record[name] + size * np.sin(2.0 * np.pi * record[name] / pitch) for name in positions(record)}

    return Effect({"size": size, "pitch": pitch}, measure=measure)


@form("sensor_delay", on=SINGLES)
def late_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The current is logged late, not the position."""
    delay = max(0.02 * strength * rng.uniform(0.7, 1.3), 4.0 / bench.rate)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        # so that a delay of the drive is all that is wrong: its noise is delayed with it
        return record | {name: late(record[name], t, delay) for name in drives(record)}

    return Effect({"delay": delay}, measure=measure)


@form("none")
def slow_motion(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, speed=0.4 * bench.speed))


@form("none")
def many_runs(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, n_fit=6, n_test=3, duration=5.0))
