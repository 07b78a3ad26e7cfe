"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import chained
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FACTOR_ON_SPEED, MASS_OF_TIME, ONE_WAY_AT, Array, Plant

from .enter import form

TURN = 2.0 * np.pi


def _read(columns: Callable[[Record], list[str]], parameters: dict[str, float], reading: Callable[[Array], Array]) -> Effect:
    """Columns that are read otherwise than they are."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: reading(record[name]) for name in columns(record)}

    return Effect(parameters, measure=measure)


@form("unknown", also=("drive_saturation",), on=(*HINGES, "arm"))
def dead_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tao and Kokotovic 1996 (an actuator that does not answer to small commands; on slides that is more Coulomb friction)."""
    width = 0.7 * strength * bench.level
    return Effect({"width": width}, alter=lambda plant, _: plant.with_extra(dead_zone=width))


@form("unknown", also=("backlash", "frictional_lag"))
def sticky_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Choudhury, Thornhill and Shah 2005 (what the actuator gives follows the command only beyond a gap)."""
    half = 0.5 * strength * bench.level
    return Effect({"half": half}, alter=lambda plant, _: plant.with_extra(play=half))


@form("unknown", also=("payload", "drive_gain"), on=SINGLES)
def wrong_counts(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016, chapter 3 (a scale error: the encoder has more lines than was entered)."""
    factor = 1.0 + 0.4 * strength
    return _read(positions, {"factor": factor}, lambda x: factor * x)


@form("unknown", also=("payload", "drive_gain"), on=SINGLES)
def fast_clock(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mills 1991 (a clock of the logger that runs slow: everything seems quicker)."""
    factor = 1.0 - 0.2 * strength
    return _read(lambda record: ["time [s]"], {"factor": factor}, lambda t: factor * t)


@form("unknown", also=("sensor_drift", "constant_force"))
def zero_creeps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016, chapter 3 (the zero of the drive's sensor creeps from one side to the other within each run)."""
    size = 0.7 * strength * bench.level / bench.gain * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        power = rng.uniform(0.7, 1.4)
        path = size * (2.0 * (t / t[-1]) ** power - 1.0)
        changed = drives(record)[bench.place if bench.design == "arm" else 0]
        return record | {changed: record[changed] + path}

    return Effect({"size": size}, measure=measure)


@form("unknown", also=("drive_saturation", "sensor_clipping"))
def meter_clips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lyons 2010 (a converter whose range ends below the largest drives, one way only)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drives(record)[bench.place if bench.design == "arm" else 0]
        return record | {name: np.minimum(record[name], np.quantile(record[name], 1.0 - 0.3 * strength))}

    return Effect({"share": 0.3 * strength}, measure=measure)


@form("unknown", also=("backlash", "sensor_delay"))
def load_cell_with_play(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Visintin 1994 (the play operator: a load cell that follows only beyond a gap)."""
    half = 0.45 * strength * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drives(record)[bench.place if bench.design == "arm" else 0]
        x, read = record[name], np.empty_like(record[name])
        last = x[0]
        for i, value in enumerate(x):
            last = min(max(last, value - half), value + half)
            read[i] = last
        return record | {name: read}

    return Effect({"half": half}, measure=measure)


@form("unknown", also=("friction_drift", "distance_drift", "viscous_friction"))
def oil_thins(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (only the viscous part falls as the joint warms)."""
    size, time = 0.9 * strength * bench.level, 0.3 * bench.duration
    plain = by_speed({"size": size, "time": time}, lambda v: size * v / bench.speed)

    def alter(plant: Plant, rng: Generator) -> Plant:
        return plain.alter(plant, rng).times_in_time(FACTOR_ON_SPEED, lambda t: 1.6 * np.exp(-np.maximum(t, 0.0) / time))

    return Effect(plain.parameters, alter=alter)


@form("unknown", also=("position_dependent_friction", "direction_asymmetry"))
def scraper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Neale 1995 (a wiper that bites one way, over one half of the stroke)."""
    size, width = 0.9 * strength * bench.level, 0.1 * bench.reach

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_force_at(lambda q: 0.5 * size * (1.0 + np.tanh(q / width)), ONE_WAY_AT)

    return Effect({"size": size}, alter=alter)


@form("unknown", also=("load_dependence", "viscous_friction"), on=(*HINGES, "arm"))
def load_times_speed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamon, Gautier and Garrec 2010 (a viscous friction that grows with the torque carried)."""
    share = 0.2 * strength / bench.speed
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(drive_speed=share))


@form("unknown", also=("payload",), on=SINGLES)
def leaking_bucket(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Meshchersky 1897 (a mass that leaves at the speed of the body: from a full bucket to an empty one within each run)."""
    size = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(MASS_OF_TIME, lambda t: 1.0 + size * (1.0 - 2.0 * np.clip(t / bench.duration, 0.0, 1.0)))

    return Effect({"size": size}, alter=alter)


@form("unknown", also=("payload",), on=SINGLES)
def pick_and_place(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Swevers, Verdonck and De Schutter 2007 (a part that is picked up and put down, several times a run)."""
    more = 0.4 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        at = np.cumsum(rng.uniform(0.7, 2.2, 40))
        return plant.times_in_time(MASS_OF_TIME, lambda t: 1.0 + more * (np.searchsorted(at, t) % 2))

    return Effect({"more": more}, alter=alter)


@form("unknown", also=("joint_compliance", "second_mode"), on=("slide", "mjcf_slide"))
def sloshing_tank(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Abramson 1966 (a part of the liquid swings like a mass on a soft, lightly damped spring)."""
    share, frequency = 0.45 * strength, 0.45 * bench.speed / bench.reach * rng.uniform(0.9, 1.1)
    return Effect({"share": share, "frequency": frequency}, alter=lambda plant, _: chained(bench, plant, share, frequency, 0.0))


@form("unknown", also=("viscous_friction", "velocity_weakening"))
def eddy_brake(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wouterse 1991 (an eddy-current brake: rises to a critical speed, and falls beyond)."""
    size, knee = 0.9 * strength * bench.level, bench.speed * rng.uniform(0.35, 0.5)
    return by_speed({"size": size, "knee": knee}, lambda v: 2.0 * size * (v / knee) / (1.0 + (v / knee) ** 2))


@form("unknown", also=("position_dependent_force",), on=("arm",))
def crossed_tendons(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tsai 1999 (a tendon of one joint passes the other one: a moment by the other one's angle)."""
    stiffness = 0.9 * strength * bench.level / bench.reach
    return Effect({"stiffness": stiffness}, alter=lambda plant, _: plant.with_extra(other_place=stiffness))


@form("unknown", also=("viscous_friction", "position_dependent_force", "frictional_lag", "joint_compliance"))
def rubber_boot(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Maxwell 1867 (a boot that pulls back and relaxes: spring and damper in line)."""
    time = 0.35 * bench.reach / bench.speed * rng.uniform(0.9, 1.1)
    stiffness = 2.4 * strength * bench.level / bench.reach
    return Effect(
        {"stiffness": stiffness, "time": time},
        alter=lambda plant, _: plant.with_extra(relaxing_stiffness=stiffness, relaxing_time=time),
    )


@form("unknown", also=("frictional_lag", "presliding_compliance"))
def builds_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Al-Bender, Lampaert and Swevers 2005 (asperities engage one by one: friction rises with the distance from a turn)."""
    size, distance = 0.8 * strength, bench.reach * rng.uniform(0.25, 0.4)
    return Effect(
        {"size": size, "distance": distance}, alter=lambda plant, _: plant.with_extra(memory=-size, memory_distance=distance)
    )


@form("unknown", also=("backlash", "position_dependent_friction", "load_dependence"), on=HINGES)
def loose_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Visintin 1994 (an encoder on a shaft with play: it reads where the joint was a gap ago)."""
    half = 0.6 * strength * bench.level / bench.numbers["gravity"]

    def follow(x: Array) -> Array:
        read, last = np.empty_like(x), x[0]
        for i, value in enumerate(x):
            last = min(max(last, value - half), value + half)
            read[i] = last
        return read

    return _read(positions, {"half": half}, follow)


@form("unknown", also=("friction_drift", "random_coefficients"), on=SINGLES)
def every_other_run(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Hunter and Hunter 2005 (a hidden block: a cover that rubs only when the joint goes fast, on in half of the runs)."""
    size = 1.0 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        on = float(rng.random() < 0.5)
        return plant.add_by_speed(lambda v: on * size * (v > 0.4 * bench.speed))

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=8, n_test=4, duration=5.0), alter=alter)
