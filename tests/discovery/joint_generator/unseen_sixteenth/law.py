"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""

from dataclasses import replace

import numpy as np
from scipy.special import expit

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fourteenth.law import since_the_turn
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def soft_close_of_a_drawer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sutterby 1966 (silicone in the damper of a drawer: a viscosity that falls by a power of asinh(w)/w; steep, then flat)."""
    size, top, power = 0.95 * strength * bench.level, rng.uniform(12.0, 20.0), rng.uniform(0.7, 0.85)

    def stress(w: Array | float) -> Array:
        w = np.maximum(w, 1e-9)
        return w * (np.arcsinh(w) / w) ** power

    return by_speed(
        {"size": size, "top": top, "power": power}, lambda v: size * stress(top * v / bench.speed) / float(stress(top))
    )


@form("viscous_friction")
def stirrer_in_paint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Oldroyd 1958 (a stirrer in paint: a line, a shoulder about one rate of shear, and behind it a line of a seventh)."""
    size, thins = 1.3 * strength * bench.level, bench.speed * rng.uniform(0.12, 0.2)

    def stress(v: Array | float) -> Array | float:
        w = (v / thins) ** 2
        return v * (1.0 + w / 7.0) / (1.0 + w)

    return by_speed({"size": size, "thins": thins}, lambda v: size * stress(v) / stress(bench.speed))


@form("velocity_weakening")
def glides_of_a_chair_melt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ettles 1986 (nylon glides of a chair: level while slow; from a speed on their melting holds them to its inverse root)."""
    size, melts = 0.95 * strength * bench.level, bench.speed * rng.uniform(0.05, 0.09)
    return by_speed({"size": size, "melts": melts}, lambda v: size / np.sqrt(np.maximum(v / melts, 1.0)))


@form("direction_asymmetry")
def scales_of_a_ski(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Colbeck 1992 (a ski with scales: one way they bite, less when quick; the other way it glides, and wets by a root)."""
    size, forward = 0.9 * strength * bench.level, rng.random() < 0.5

    def bites(v: Array) -> Array:
        return size / (1.0 + 0.6 * v / bench.speed)

    def glides(v: Array) -> Array:
        return size * (0.25 * np.sqrt(v / bench.speed) - 0.35)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(bites, glides) if forward else plant.add_by_speed(glides, bites)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


FRONT = 0.55
"""What the front of a blade has of its drag before air comes in behind it."""


@form("quadratic_damping", on=SINGLES)
def oar_draws_air(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Breslin and Skalak 1959 (an oar near the surface: the square, until air comes in behind it; its suction stays then)."""
    size, airs = 1.3 * strength * bench.level, bench.speed * rng.uniform(0.5, 0.65)

    def drag(v: Array | float) -> Array:
        return FRONT * v**2 + (1.0 - FRONT) * np.minimum(v, airs) ** 2

    return by_speed({"size": size, "airs": airs}, lambda v: size * drag(v) / float(drag(bench.speed)))


ADHERES = 0.25
"""What a gel foot pulls at a table, 3 pi w R, in units of its usual load."""


def gel_foot(load: Array) -> Array:
    """Area of contact of an adhering sphere over the load, both in units of a usual one."""

    def area(load: Array | float) -> Array:
        return (load + ADHERES + np.sqrt(2.0 * ADHERES * load + ADHERES**2)) ** (2.0 / 3.0)

    return area(load) / float(area(1.0))


@form("load_dependence", on=("slide",))
def gel_feet_under_an_air_bag(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kendall and Roberts 1971 (gel feet that adhere: friction by their area; an air bag loads them, recorded)."""
    period, start, fills = rng.uniform(2.6, 3.6), rng.uniform(0.0, 1.0), rng.uniform(0.1, 0.14)

    def load(t: Array) -> Array:
        s = np.mod(t / period + start, 1.0)
        rest = 1.0 / (1.0 + np.exp(-0.5 / fills))
        full = np.where(s < 0.5, 1.0 - rest * np.exp(-s / fills), rest * np.exp(-(s - 0.5) / fills))
        return 0.35 + 1.55 * full

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def factor(t: Array) -> Array:
            return (1.0 - strength) * load(t) + strength * gel_foot(load(t))

        return plant.times_in_time(FACTOR_OF_TIME, factor)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        weight = GRAVITY * bench.numbers["inertia"]
        return record | {"normal_force [N]": weight * load(t) * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"adheres": ADHERES, "period": period, "fills": fills}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def limescale_closes_a_gap(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hasson and others 1968 (lime that settles evenly in the gap of a plunger: friction as the inverse of what is left)."""
    more, closed = 0.85 * strength, rng.uniform(0.65, 0.8)

    def factor(t: Array) -> Array:
        left = 1.0 - closed * np.clip(t / bench.duration, 0.0, 1.0)
        return 1.0 + more * (1.0 / left - 1.0) * (1.0 - closed) / closed

    return in_time({"more": more, "closed": closed}, factor)


COATS = (0.7, 1.2, 1.75)
"""Friction on three coats of paint, the upper one first, as shares of the believed one."""


@form("distance_drift", also=("friction_drift",))
def coats_of_paint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holmberg, Matthews and Ronkainen 1998 (three coats of paint, worn through in turn: two steps by the strokes)."""
    first, second = rng.uniform(2.5, 3.5), rng.uniform(6.0, 7.5)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        strokes, top = np.arange(400.0), COATS[0]
        level = top + sum(
            (below - above) * expit((strokes - worn) / 0.3)
            for above, below, worn in zip(COATS[:-1], COATS[1:], (first, second), strict=True)
        )
        return replace(plant, by_stroke=1.0 + strength * (level - 1.0))

    return Effect({"first": first, "second": second}, alter=alter)


MELTED, SOLID = 31.0, 12.0
"""Temperatures at which tallow has melted, and at which it is as stiff as it gets here [degC]."""


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def tallow_on_the_ways(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Narine and Marangoni 1999 (tallow on wooden ways: the power 2.5 of what is solid, until it melts; draughts, recorded)."""
    size, start, waves = 1.1 * strength, rng.uniform(0.0, TURN), rng.uniform(1.5, 1.9)

    def celsius(t: Array) -> Array:
        s = TURN * waves * t / bench.duration
        return 23.5 + 7.5 * np.sin(s + start) + 4.5 * np.sin(1.7 * s + 3.0 * start)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def factor(t: Array) -> Array:
            return 1.0 + size * (np.maximum((MELTED - celsius(t)) / (MELTED - SOLID), 0.0) ** 2.5 - 0.3)

        return plant.times_in_time(FACTOR_OF_TIME, factor)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size, "waves": waves}, alter=alter, measure=measure)


CRUMBS, MOST = 0.75, 8
"""Share by which each further crumb is rarer, and how many a runner has room for."""


def mean_crumbs() -> float:
    """Mean number of crumbs, of which no more than there is room for count."""
    number = np.arange(1, 400)
    chance = CRUMBS**number / number
    return float(np.sum(np.minimum(number, MOST) * chance) / np.sum(chance))


@form("random_coefficients", also=("correlated_coefficients",))
def crumbs_in_a_drawer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fisher, Corbet and Williams 1943 (crumbs under a drawer's runner: a logarithmic series, a new draw each stroke)."""
    each = 0.2 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        crumbs = np.minimum(rng.logseries(CRUMBS, 400), MOST)
        return replace(plant, by_stroke=1.0 + each * (crumbs - mean_crumbs()))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def shuffleboard_is_swept_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fisk 1961 (a shuffleboard whose wax is swept anew each time: a log-logistic density, a new draw each slide)."""
    spread = 0.11 * strength

    def law(rng: Generator) -> Throw:
        share = rng.uniform(0.01, 0.99)
        mu = 0.28 * (share / (1.0 - share)) ** spread
        return Throw(lambda v, x: mu, starts=(1.3, 1.7))

    return Effect({"spread": spread}, law=law)


STAYS, DROPS = 0.8, 5.0
"""Share of a spill that a stroke leaves, and how much of it a tray holds."""


def spills(rng: Generator, strokes: int) -> Array:
    """What lies on a tray's rail at each stroke: most strokes wipe a fifth, one of five brings an exponential amount too."""
    lies, last = np.empty(strokes), float(rng.exponential())
    for n in range(strokes):
        last = STAYS * last + (float(rng.exponential()) if rng.random() < 1.0 - STAYS else 0.0)
        lies[n] = last
    return np.minimum(lies, DROPS)


@form("correlated_coefficients", also=("random_coefficients",))
def drops_of_syrup(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gaver and Lewis 1980 (drops of syrup on a rail: chance brings one, each stroke wipes a fifth; exponential in all)."""
    each = 0.33 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (spills(rng, 400) - 1.0))

    return Effect({"each": each}, alter=alter)


@form("frictional_lag")
def blade_of_a_wiper_turns_over(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Okura, Sekiguchi and Oya 2000 (a windscreen wiper whose lip turns over at each turn: pressed most when it stands up).

    It has fallen to the other side after a way of its own, by the square of a cosine.
    """
    more, way = 1.1 * strength, bench.reach * rng.uniform(0.35, 0.5)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(x, record["time [s]"])
        gone = np.minimum(since_the_turn(x, v, 0.02 * bench.speed) / way, 1.0)
        stands = np.cos(0.5 * np.pi * gone) ** 2
        return record | {name: record[name] + more * bench.level * stands * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    return Effect({"more": more, "way": way}, rig=undeclared, measure=measure)
