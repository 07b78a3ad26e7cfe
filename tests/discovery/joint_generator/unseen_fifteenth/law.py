"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""

from dataclasses import replace

import numpy as np
from scipy.special import expit, ndtr

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


@form("viscous_friction", also=("velocity_weakening",))
def open_wet_brake(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yuan, Attibele and Dong 2003 (a wet brake that is open: a line of the speed, until its oil is thrown out of the gap).

    From there on the wetted part of the discs falls as the inverse square of the speed, and the drag as the inverse.
    """
    size, thrown_out = 1.2 * strength * bench.level, bench.speed * rng.uniform(0.5, 0.65)

    def drag(v: Array) -> Array:
        w = v / thrown_out
        return size * w / np.maximum(w, 1.0) ** 2

    return by_speed({"size": size, "thrown_out": thrown_out}, drag)


THINNED = 0.1
"""What is left of the viscosity of a thickened oil under a large stress."""


def rate_under_stress(stress: Array) -> Array:
    """Rate of shear of a thickened oil over the stress in units of that at which it thins; a line at either end."""
    return stress * (1.0 + stress**2) / (1.0 + THINNED * stress**2)


@form("viscous_friction")
def thickened_oil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Philippoff 1935 (an oil with a polymer, which thins about a stress: a steep line, a bend, and a line of a tenth)."""
    size, top = 1.2 * strength * bench.level, rng.uniform(18.0, 28.0)
    stresses = np.linspace(0.0, 25.0, 5001)
    rates = rate_under_stress(stresses)
    full = float(np.interp(top, rates, stresses))
    return by_speed({"size": size, "top": top}, lambda v: size * np.interp(top * v / bench.speed, rates, stresses) / full)


@form("velocity_weakening")
def rubber_beyond_its_peak(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Savkoor 1965 (rubber on a dry track beyond the slow speed at which it rubs most: a bell over the speed's logarithm)."""
    size, peak, narrow = 0.95 * strength * bench.level, bench.speed * rng.uniform(0.03, 0.05), 1.2

    def more(v: Array) -> Array:
        decades = np.log10(np.maximum(v / peak, 1e-9))
        return size * np.exp(-narrow * decades**2)

    return by_speed({"size": size, "peak": peak, "narrow": narrow}, more)


@form("direction_asymmetry")
def pads_of_a_climbing_robot(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gravish and others 2010 (dry adhesive pads of leaning hairs: along them they grip by the speed's logarithm, else let go).

    Against the hairs they rub less than is believed.
    """
    size, forward, slow = strength * bench.level, rng.random() < 0.5, 0.02 * bench.speed

    def grips(v: Array) -> Array:
        return size * (0.25 + 0.16 * np.log1p(v / slow))

    def lets_go(v: Array) -> Array:
        return -0.3 * size + 0.0 * v

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(grips, lets_go) if forward else plant.add_by_speed(lets_go, grips)

    return Effect({"size": size, "forward": float(forward), "slow": slow}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def flaps_bend_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Alben, Shelley and Zhang 2002 (rubber flaps in a bath, which bend back: the square of the speed, and later its 4/3)."""
    size, bends = 1.3 * strength * bench.level, rng.uniform(0.9, 1.1)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * u**2 * ((1.0 + bends**-2) / (1.0 + (u / bends) ** 2)) ** (1.0 / 3.0)

    return by_speed({"size": size, "bends": bends}, drag)


ROLLS, RUBS, RETRACT = 0.6, 2.2, 0.75
"""Coefficients of sprung balls and of the plate between them, and the load at which the balls are pressed down."""


def balls_and_plate(load: Array) -> Array:
    """Friction over the load, both in units of a usual one: the balls bear what their springs can, the plate the rest."""
    return ROLLS * np.minimum(load, RETRACT) + RUBS * np.maximum(load - RETRACT, 0.0)


@form("load_dependence", on=("slide",))
def sprung_balls_retract(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mulcahy 1999 (a table of sprung balls: beyond a load they retract, and the plate rubs; loads come and go, recorded)."""
    period, start = rng.uniform(2.4, 3.4), rng.uniform(0.0, 1.0)

    def load(t: Array) -> Array:
        s = np.mod(t / period + start, 1.0)
        up, down = (0.5 - 0.5 * np.cos(np.pi * np.clip((s - begin) / 0.25, 0.0, 1.0)) for begin in (0.05, 0.5))
        return 0.45 + 1.45 * (up - down)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def factor(t: Array) -> Array:
            return (1.0 - strength) * load(t) + strength * balls_and_plate(load(t))

        return plant.times_in_time(FACTOR_OF_TIME, factor)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        weight = GRAVITY * bench.numbers["inertia"]
        return record | {"normal_force [N]": weight * load(t) * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"retract": RETRACT, "period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def oil_sets_in_the_cold(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Avrami 1939 (a vegetable oil that sets in the cold: crystals from many seeds, by the cube of time until they meet)."""
    more, time = 0.7 * strength, bench.duration * rng.uniform(0.45, 0.6)
    return in_time({"more": more, "time": time}, lambda t: 1.0 + more * (1.0 - np.exp(-((np.maximum(t, 0.0) / time) ** 3))))


@form("distance_drift", also=("friction_drift",))
def spots_flake_by_fatigue(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Birnbaum and Saunders 1969 (a hard coating whose spots crack a little at each stroke and flake: a share by their lives).

    While whole it is smoother than is believed.
    """
    half, spread = rng.uniform(5.0, 7.0), 0.6

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        strokes = np.maximum(np.arange(400.0), 1e-6) / half
        flaked = ndtr((np.sqrt(strokes) - 1.0 / np.sqrt(strokes)) / spread)
        return replace(plant, by_stroke=1.0 + strength * (1.1 * flaked - 0.35))

    return Effect({"half": half, "spread": spread}, alter=alter)


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def two_transitions_of_ptfe(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bunn and Howells 1954 (PTFE pads, whose chains come free at 19 and at 30 degrees: two steps down; a hall, recorded)."""
    size, start, waves = 0.9 * strength, rng.uniform(0.0, TURN), rng.uniform(1.6, 2.1)

    def celsius(t: Array) -> Array:
        s = TURN * waves * t / bench.duration
        return 24.5 + 8.5 * np.sin(s + start) + 3.0 * np.sin(2.6 * s + 2.0 * start)

    def stiff(t: Array) -> Array:
        """Share of the chains that is not free."""
        return 0.5 * sum(expit((free - celsius(t)) / 0.7) for free in (19.0, 30.0))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * (stiff(t) - 0.5))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size, "waves": waves}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def carriage_sits_askew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Maxwell 1860 (a carriage that sits askew anew at each stroke, in roll, pitch and yaw: pressed by their resultant)."""
    each, mean = 0.4 * strength, np.sqrt(8.0 / np.pi)

    def alter(plant: Plant, rng: Generator) -> Plant:
        askew = np.linalg.norm(rng.standard_normal((400, 3)), axis=1)
        return replace(plant, by_stroke=1.0 + each * (askew - mean))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def block_on_three_feet(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Irwin 1927 (a block on three feet, each on whatever it meets, evenly between two limits: a new draw each slide)."""
    limit = 0.2 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 + limit * float(rng.uniform(-1.0, 1.0, 3).mean())
        return Throw(lambda v, x: mu, starts=(1.3, 1.7))

    return Effect({"limit": limit}, law=law)


SWEPT, ROOM, USUAL = 1.4, 6.0, 0.83
"""What a stroke sweeps away of a heap before a wiper, how much there is room for, and the heap's mean."""


def heap(rng: Generator, strokes: int) -> Array:
    """What lies before a wiper at each stroke: a stroke brings an exponential amount, 1 in the mean, and sweeps another."""
    lies, last = np.empty(strokes), USUAL
    brought = rng.exponential(size=strokes + 100)
    for n in range(-100, strokes):
        last = min(max(last + brought[n + 100] - SWEPT, 0.0), ROOM)
        if n >= 0:
            lies[n] = last
    return lies


@form("correlated_coefficients", also=("random_coefficients",))
def heap_before_a_wiper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Moran 1954 (chips before a wiper, as water behind a dam: chance brings them, each stroke sweeps as many as it can)."""
    each = 0.2 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (heap(rng, 400) - USUAL))

    return Effect({"each": each}, alter=alter)


@form("frictional_lag")
def film_is_drawn_in_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Glovnea and Spikes 2001 (a pad whose oil film breaks at each turn, and is drawn in from its front edge: a line).

    Oil comes in half as fast as the pad slides, so that all of it floats again after twice its length.
    """
    more, pad = 1.1 * strength, bench.reach * rng.uniform(0.2, 0.3)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(x, record["time [s]"])
        bare = np.clip(1.0 - since_the_turn(x, v, 0.02 * bench.speed) / (2.0 * pad), 0.0, 1.0)
        return record | {name: record[name] + more * bench.level * bare * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    return Effect({"more": more, "pad": pad}, rig=undeclared, measure=measure)
