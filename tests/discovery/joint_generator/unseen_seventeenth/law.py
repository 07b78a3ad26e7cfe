"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""

from dataclasses import replace

import numpy as np
from scipy.special import lambertw

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
def melt_in_a_rotary_damper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Phan-Thien 1978 (a polymer in a damper whose network lets go under stress: a line, then the root of a logarithm)."""
    size, top = 0.95 * strength * bench.level, rng.uniform(8.0, 14.0)

    def stress(w: Array | float) -> Array:
        """Solves w = s exp(s^2)."""
        return np.sqrt(0.5 * lambertw(2.0 * np.square(w)).real)

    return by_speed({"size": size, "top": top}, lambda v: size * stress(top * v / bench.speed) / float(stress(top)))


@form("viscous_friction")
def rubber_solution_in_a_seal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Vinogradov and Malkin 1966 (melts and solutions on one curve: a line over 1 and two powers of it, 0.355 and 0.71)."""
    size, top = 1.1 * strength * bench.level, 10.0 ** rng.uniform(5.0, 6.0)

    def stress(w: Array | float) -> Array | float:
        return w / (1.0 + 6.12e-3 * w**0.355 + 2.85e-4 * w**0.71)

    return by_speed({"size": size, "top": top}, lambda v: size * stress(top * v / bench.speed) / stress(top))


@form("velocity_weakening")
def junctions_soften_by_their_heat(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Molinari, Estrin and Mercier 1999 (steel whose junctions are hot by the root of the speed: the inverse of 1 and that)."""
    size, softens = 1.1 * strength * bench.level, bench.speed * rng.uniform(0.03, 0.06)
    return by_speed({"size": size, "softens": softens}, lambda v: size / (1.0 + np.sqrt(v / softens)))


@form("direction_asymmetry")
def wing_on_the_carriage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Katz 2006 (a pitched plate on what moves: one way it presses by the square of the speed, the other way it lifts)."""
    size, forward = 0.9 * strength * bench.level, rng.random() < 0.5

    def presses(v: Array) -> Array:
        return size * (v / bench.speed) ** 2

    def lifts(v: Array) -> Array:
        return -0.65 * size * np.minimum(v / bench.speed, 1.0) ** 2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(presses, lifts) if forward else plant.add_by_speed(lifts, presses)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def ball_towed_through_water(rng: Generator, strength: float, bench: Bench) -> Effect:
    """White 1974 (a ball through water, by his fit: the square, a line, and between them a power that falls with the speed)."""
    size, reynolds = 1.3 * strength * bench.level, rng.uniform(2500.0, 6000.0)

    def drag(u: Array | float) -> Array | float:
        return 24.0 * u / reynolds + 6.0 * u**2 / (1.0 + np.sqrt(reynolds * u)) + 0.4 * u**2

    return by_speed({"size": size, "reynolds": reynolds}, lambda v: size * drag(v / bench.speed) / drag(1.0))


SHEARED = 0.85
"""Share of a polymer's friction, at its usual load, that is its film's own strength; the rest grows with the pressure."""


def round_strip(load: Array) -> Array:
    """Friction of a round polymer strip over the load, both in units of a usual one."""
    return SHEARED * np.sqrt(load) + (1.0 - SHEARED) * load


@form("load_dependence", on=("slide",))
def polymer_strips_under_a_tank(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Briscoe and Tabor 1978 (round polymer strips: the width of contact, a root of the load, and a little of the load itself).

    A tank presses, recorded: it is filled evenly, and runs out through a hole, its level by a square.
    """
    period, start, fills = rng.uniform(2.8, 3.8), rng.uniform(0.0, 1.0), rng.uniform(0.3, 0.45)

    def load(t: Array) -> Array:
        s = np.mod(t / period + start, 1.0)
        return 0.3 + 2.2 * np.where(s < fills, s / fills, ((1.0 - s) / (1.0 - fills)) ** 2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def factor(t: Array) -> Array:
            return (1.0 - strength) * load(t) + strength * round_strip(load(t))

        return plant.times_in_time(FACTOR_OF_TIME, factor)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        weight = GRAVITY * bench.numbers["inertia"]
        return record | {"normal_force [N]": weight * load(t) * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"sheared": SHEARED, "period": period, "fills": fills}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def sprayed_oil_evaporates(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Langmuir 1918 (drops of a light oil that evaporate, each surface as a line in time: its volume by 3/2; dry at last)."""
    more, dry = 0.8 * strength, bench.duration * rng.uniform(0.65, 0.9)
    return in_time({"more": more, "dry": dry}, lambda t: 1.0 + more * (1.0 - np.clip(1.0 - t / dry, 0.0, 1.0) ** 1.5))


@form("distance_drift", also=("friction_drift",))
def felt_pills_and_sheds(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brand and Bohmfalk 1967 (felt pads whose fuzz tangles to pills, which strokes tear off: two exponentials' difference)."""
    size, forms, sheds = 0.9 * strength, rng.uniform(1.5, 2.2), rng.uniform(4.5, 7.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        strokes, most = np.arange(400.0), np.log(sheds / forms) * forms * sheds / (sheds - forms)
        pills = np.exp(-strokes / sheds) - np.exp(-strokes / forms)
        return replace(plant, by_stroke=1.0 + size * pills / (np.exp(-most / sheds) - np.exp(-most / forms)))

    return Effect({"size": size, "forms": forms, "sheds": sheds}, alter=alter)


KELVIN, LETS_GO, ENERGY = 273.15, 34.0, 1.6e4
"""Zero of the Celsius scale [K]; temperature at which a molecule stays as long as a pad takes to pass [degC]; energy [K]."""


def bare(celsius: Array) -> Array:
    """Share of a rail from which molecules have gone before the next pad's asperity comes."""
    return 1.0 - np.exp(-np.exp(ENERGY * (1.0 / (KELVIN + LETS_GO) - 1.0 / (KELVIN + celsius))))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def fatty_acid_lets_go(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kingsbury 1958 (fatty acid on steel: its molecules leave the faster the hotter it is; an oven pulses, recorded)."""
    size, start, waves = 0.9 * strength, rng.uniform(0.0, TURN), rng.uniform(2.1, 2.6)

    def celsius(t: Array) -> Array:
        s = TURN * waves * t / bench.duration + start
        return 22.0 + 21.0 * np.exp(1.5 * (np.cos(s) - 1.0)) + 3.0 * np.sin(0.6 * s)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * (bare(celsius(t)) - 0.35))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size, "waves": waves}, alter=alter, measure=measure)


ASIDE = 1.2
"""Steady side pull, in deviations of that which chance adds in either direction."""


@form("random_coefficients", also=("correlated_coefficients",))
def side_pull_of_hoses(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rice 1945 (hoses that pull aside, and lie anew at each stroke: the size of a steady pull and a random one across)."""
    each = 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        pulls = np.hypot(ASIDE + rng.standard_normal(400), rng.standard_normal(400))
        return replace(plant, by_stroke=np.maximum(1.0 + each * (pulls - np.hypot(ASIDE, 1.25)), 0.2))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def grained_block_lands_turned(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zmitrowicz 1989 (a grained block that lands turned by any angle: an ellipse of coefficients, a new draw each slide)."""
    apart = 0.3 * strength

    def law(rng: Generator) -> Throw:
        angle = rng.uniform(0.0, TURN)
        mu = 0.28 * float(np.hypot((1.0 - apart) * np.cos(angle), (1.0 + apart) * np.sin(angle)))
        return Throw(lambda v, x: mu, starts=(1.3, 1.7))

    return Effect({"apart": apart}, law=law)


FALLS_OFF, MOST = 0.2, 14
"""Chance that a stroke clears the way, and how many strokes' swarf there is room for."""


def strokes_since_clean(rng: Generator, strokes: int) -> Array:
    """Strokes since chance last cleared the way, at each stroke; as in the long run from the first one on."""
    age, last = np.empty(strokes), int(rng.geometric(FALLS_OFF)) - 1
    for n in range(strokes):
        last = 0 if rng.random() < FALLS_OFF else last + 1
        age[n] = min(last, MOST)
    return age


@form("correlated_coefficients", also=("random_coefficients",))
def swarf_gathers_and_falls_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cox 1962 (swarf before a wiper: each stroke adds as much, until one of five, by chance, lets all of it fall off)."""
    each, mean = 0.1 * strength, (1.0 - FALLS_OFF) / FALLS_OFF * (1.0 - (1.0 - FALLS_OFF) ** MOST)

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (strokes_since_clean(rng, 400) - mean))

    return Effect({"each": each}, alter=alter)


BEGINS = np.radians(150.0)
"""How far a castor still is from trailing when the way back has begun."""


def across(gone: Array) -> Array:
    """Sine of a castor's angle over the way since a turn in trails: a tractrix, tan(angle / 2) falls exponentially."""
    return np.sin(2.0 * np.arctan(np.tan(0.5 * BEGINS) * np.exp(-gone)))


@form("frictional_lag")
def castors_swing_round(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pacejka 2012 (castors that swing round after each turn: they scrub by the sine of their angle, along a tractrix)."""
    more, trail = 1.1 * strength, bench.reach * rng.uniform(0.12, 0.18)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(x, record["time [s]"])
        scrubs = across(since_the_turn(x, v, 0.02 * bench.speed) / trail)
        return record | {name: record[name] + more * bench.level * scrubs * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    return Effect({"more": more, "trail": trail}, rig=undeclared, measure=measure)
