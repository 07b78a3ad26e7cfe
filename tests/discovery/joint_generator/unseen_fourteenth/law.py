"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def rollers_of_polyurethane(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hunter 1961 (rollers of polyurethane on a rail: what they lose rises with the speed and levels off at its top)."""
    size, peak = 1.2 * strength * bench.level, bench.speed * rng.uniform(0.85, 1.1)
    return by_speed({"size": size, "peak": peak}, lambda v: 2.0 * size * (v / peak) / (1.0 + (v / peak) ** 2))


def damped_through(depth: Array) -> Array:
    """Drag of eddies in a plate over its thickness in skin depths, a root of the speed: x^2 while thin, 3 x when thick."""
    x = np.clip(depth, 1e-3, 200.0)
    return 3.0 * x * (np.sinh(x) - np.sin(x)) / (np.cosh(x) - np.cos(x))


@form("viscous_friction")
def solid_iron_back_of_a_motor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lammeraner and Stafl 1966 (eddies in the solid iron of a motor: a line, and a root once their skin is thin)."""
    size, depth = 1.2 * strength * bench.level, rng.uniform(6.0, 8.0)

    def drag(v: Array) -> Array:
        return np.where(v > 0.0, size * damped_through(depth * np.sqrt(v / bench.speed)) / damped_through(np.array(depth)), 0.0)

    return by_speed({"size": size, "depth": depth}, drag)


@form("velocity_weakening")
def cast_iron_slideway(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kragelskii 1965 (a slideway of cast iron, as he fitted it: a line of the speed times an exponential that falls)."""
    size, knee = 0.95 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.16)
    return by_speed({"size": size, "knee": knee}, lambda v: size * (1.0 + 0.6 * v / knee) * np.exp(-v / knee))


@form("direction_asymmetry")
def scraper_of_a_clarifier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Goryachkin 1968 (a scraper that ploughs sludge one way, a level and the square of the speed, and comes back lifted)."""
    size, forward = strength * bench.level, rng.random() < 0.5

    def ploughs(v: Array) -> Array:
        return size * (0.45 + 0.45 * np.minimum(v / bench.speed, 1.5) ** 2)

    def lifted(v: Array) -> Array:
        return -0.25 * size + 0.0 * v  # its shoes are off the floor, where they are believed to rub

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(ploughs, lifted) if forward else plant.add_by_speed(lifted, ploughs)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def float_makes_waves(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Havelock 1909 (a float that is towed: the square of the speed, and the waves that it makes once it is quick enough)."""
    size, depth = 1.3 * strength * bench.level, rng.uniform(1.0, 1.4)

    def drag(v: Array) -> Array:
        u = np.maximum(v / bench.speed, 1e-3)
        return size * u**2 * (0.6 + 0.4 * np.exp(depth * (1.0 - u**-2))) * (v > 0.0)

    return by_speed({"size": size, "depth": depth}, drag)


@form("load_dependence", on=("slide",))
def pockets_bear_a_part(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stansfield 1970 (oil pockets bear an even part of the load, and the rest rubs; a pump of strokes clamps, recorded)."""
    borne, period, start = 0.28, rng.uniform(2.4, 3.4), rng.uniform(0.0, 1.0)

    def share(t: Array) -> Array:
        return 0.45 + 1.45 * np.abs(np.sin(np.pi * (t / period + start)))

    def coefficient(n: Array) -> Array:
        return (1.0 - borne / n) / (1.0 - borne)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (coefficient(share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"borne": borne, "period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def felt_wiper_fills(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Washburn 1921 (a felt wiper that draws oil: friction falls as the root of time, until the felt is full)."""
    fall, full = 0.6 * strength, bench.duration * rng.uniform(0.4, 0.55)
    return in_time({"fall": fall, "full": full}, lambda t: 1.0 - fall * np.sqrt(np.clip(t / full, 0.0, 1.0)))


@form("distance_drift", also=("friction_drift",))
def skin_tires_first(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Suh 1973 (a skin that comes off in sheets: nothing for some strokes, then a little more at each one, then all)."""
    begins, each, all_off = rng.uniform(4.0, 6.0), 0.13, 15.0

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        off = np.clip(np.arange(400.0), begins, all_off) - begins
        return replace(plant, by_stroke=1.0 + strength * (each * off - 0.3))

    return Effect({"begins": begins, "each": each}, alter=alter)


def water_vapour(celsius: Array) -> Array:
    """Pressure of saturated vapour [hPa]."""
    return 6.1078 * np.exp(17.27 * celsius / (celsius + 237.3))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def rails_sweat(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tetens 1930 (chilled rails that sweat: dry down to the dew point, below it by the vapour; a chiller hunts, recorded)."""
    dew, share, start = 17.0, 0.9 * strength, rng.uniform(0.0, TURN)
    waves = rng.uniform(1.7, 2.3)
    whole = float(water_vapour(np.array(dew)) - water_vapour(np.array(9.0)))

    def celsius(t: Array) -> Array:
        s = t / bench.duration
        return 16.5 + 7.5 * (0.6 + 0.4 * s) * np.sin(TURN * waves * s + start)

    def wet(t: Array) -> Array:
        return np.maximum(water_vapour(np.array(dew)) - water_vapour(celsius(t)), 0.0) / whole

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + share * (wet(t) - 0.3))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"dew": dew, "share": share}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def oversized_balls_come_round(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Kemp 1992 (six of twenty balls are too large, five bear: hypergeometric, a new draw each stroke)."""
    each = 0.2 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (rng.hypergeometric(6, 14, 5, size=400) - 1.5))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def rougher_of_two_runners(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Azzalini 1985 (a sledge on two runners, of which the rougher one decides: a skewed normal, a new draw each slide)."""
    spread = 0.07 * strength

    def law(rng: Generator) -> Throw:
        rougher = float(np.clip(rng.standard_normal(2), -2.2, 2.2).max())
        mu = 0.28 + spread * (rougher - 1.0 / np.sqrt(np.pi))
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def chips_change_wipers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ehrenfest and Ehrenfest 1907 (eight chips behind two wipers, any one of which each stroke carries to the other one)."""
    each, chips = 0.2 * strength, 8

    def alter(plant: Plant, rng: Generator) -> Plant:
        number = np.empty(400)
        number[0] = rng.binomial(chips, 0.5)
        for n in range(1, 400):
            number[n] = number[n - 1] + (-1.0 if rng.random() < number[n - 1] / chips else 1.0)
        return replace(plant, by_stroke=1.0 + each * (number - 0.5 * chips))

    return Effect({"each": each}, alter=alter)


def overlap(moved: Array) -> Array:
    """Share that two equal circles have in common, over what parts them in diameters."""
    x = np.clip(moved, 0.0, 1.0)
    return 2.0 / np.pi * (np.arccos(x) - x * np.sqrt(1.0 - x**2))


def since_the_turn(x: Array, v: Array, slow: float) -> Array:
    """Distance from the last turn, once the speed has passed `slow` the other way; before the first one, far."""
    way = np.where(np.abs(v) > slow, np.sign(v), 0.0)
    way = way[np.maximum.accumulate(np.where(way != 0.0, np.arange(x.size), 0))]
    far = np.full(x.size, np.inf)
    for turn in np.flatnonzero(way[1:] * way[:-1] < 0.0) + 1:
        far[turn:] = np.abs(x[turn:] - x[turn])
    return far


@form("frictional_lag")
def junctions_part_as_circles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1953 (junctions that grow at each turn and part as circles do: high after it, and gone after a diameter)."""
    more, diameter = 1.1 * strength, bench.reach * rng.uniform(0.3, 0.45)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(x, record["time [s]"])
        left = overlap(since_the_turn(x, v, 0.02 * bench.speed) / diameter)
        return record | {name: record[name] + more * bench.level * left * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    return Effect({"more": more, "diameter": diameter}, rig=undeclared, measure=measure)
