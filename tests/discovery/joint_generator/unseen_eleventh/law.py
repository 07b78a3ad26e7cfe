"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def bearing_by_its_diameter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Palmgren 1959 (a greased rolling bearing: level up to a speed, from there on the two-thirds power)."""
    size, knee = 1.7 * strength * bench.level, rng.uniform(0.05, 0.1)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.maximum(v / bench.speed, knee) ** (2.0 / 3.0))


@form("viscous_friction")
def damper_without_its_field(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stanway, Sproston and El-Wahed 1996 (a magnetic fluid in a damper: biviscous, steep to a speed and flat beyond)."""
    size, knee, share = 1.3 * strength * bench.level, rng.uniform(0.2, 0.3), 0.65

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * (share * np.minimum(u / knee, 1.0) + (1.0 - share) * np.maximum(u - knee, 0.0) / (1.0 - knee))

    return by_speed({"size": size, "knee": knee}, drag)


@form("velocity_weakening")
def lining_in_a_code(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mostaghel and Davis 1997 (a lining as codes have it: it falls by a ratio of the speed and a root of its square)."""
    size, knee = 1.0 * strength * bench.level, bench.speed * rng.uniform(0.14, 0.22)
    return by_speed({"size": size, "knee": knee}, lambda v: size * (1.0 - v / np.hypot(v, knee)))


@form("direction_asymmetry", also=("velocity_weakening",))
def band_brake(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eytelwein 1808 (a band that wraps a drum: it draws itself tight one way, and its lining fades a little with speed).

    The mean of both ways at half of the speed is what was entered.
    """
    size, wrap, fade = 1.1 * strength * bench.level, rng.uniform(0.85, 1.0), 0.3
    forward = rng.random() < 0.5

    def exponent(v: Array) -> Array:
        return wrap * (1.0 - fade * np.minimum(v / bench.speed, 1.3))

    entered = float(np.sinh(exponent(np.array(0.5 * bench.speed))))

    def tight(v: Array) -> Array:
        return size * (np.exp(exponent(v)) - 1.0 - entered)

    def slack(v: Array) -> Array:
        return size * (1.0 - np.exp(-exponent(v)) - entered)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(tight, slack) if forward else plant.add_by_speed(slack, tight)

    return Effect({"size": size, "wrap": wrap, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", also=("viscous_friction",), on=SINGLES)
def centrifugal_brake(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Orthwein 2004 (shoes that springs hold back until a speed: nothing, and from there on the square less its own)."""
    size, lifts = 1.2 * strength * bench.level, rng.uniform(0.25, 0.35)

    def drag(v: Array) -> Array:
        u = np.minimum(v / bench.speed, 1.5)  # 1.5: its top, beyond what is asked for
        return size * np.maximum(u**2 - lifts**2, 0.0) / (1.0 - lifts**2)

    return by_speed({"size": size, "lifts": lifts}, drag)


@form("load_dependence", on=("slide",))
def film_breaks_under_load(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Czichos 1974 (a film that breaks about a load: a logistic rise of the coefficient; a press that quickens, recorded)."""
    breaks, width = rng.uniform(1.0, 1.2), 0.15
    slow, fast, start = 0.12, rng.uniform(0.45, 0.6), rng.uniform(0.0, TURN)

    def share(t: Array) -> Array:
        turns = slow * t + 0.5 * (fast - slow) * t**2 / bench.duration
        return 1.2 + 0.8 * np.sin(TURN * turns + start)

    def coefficient(n: Array) -> Array:
        return (0.65 + 0.9 / (1.0 + np.exp(-(n - breaks) / width))) / 0.95

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (coefficient(share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"breaks": breaks, "width": width}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def one_shot_of_the_oiler(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Weck and Brecher 2006 (a guide that dries as a line, a shot of the central oiler in the run, and a line again)."""
    shot, rise, freed = rng.uniform(0.42, 0.58), 0.8 * strength, 0.3 * strength
    drop, time = rise * shot + freed, 0.03

    def factor(t: Array) -> Array:
        s = np.maximum(t, 0.0) / bench.duration
        return 1.0 + rise * s - drop * (1.0 - np.exp(-np.maximum(s - shot, 0.0) / time))

    return in_time({"shot": shot, "rise": rise}, factor)


@form("distance_drift", also=("friction_drift",))
def grooves_stroke_by_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Suh and Sin 1981 (debris that ploughs a little deeper at each stroke: the logarithm of their number)."""
    more = 0.75 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return replace(plant, by_stroke=1.0 + more * np.log1p(np.arange(400) / 3.0) / np.log(5.0))

    return Effect({"more": more}, alter=alter)


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def clearance_closes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tu and Stein 1996 (a bearing whose clearance closes as it warms: its inverse; a chamber that dwells, recorded)."""
    closed, dwell = 46.0, bench.duration / 6.0
    levels = rng.permutation(np.linspace(20.0, 38.0, 7))

    def celsius(t: Array) -> Array:
        k = np.clip((t / dwell).astype(int), 0, levels.size - 2)
        s = np.clip((t / dwell - k) / 0.5, 0.0, 1.0)  # half of the time from one level to the next
        return levels[k] + (3.0 - 2.0 * s) * s * s * (levels[k + 1] - levels[k])

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        share = 0.75 * strength
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + share * ((closed - 28.0) / (closed - celsius(t)) - 1.0))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"closed": closed}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def four_scrapers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bernoulli 1713 (four scrapers, each of which bites at a stroke or does not: a binomial, a new draw each stroke)."""
    each = 0.22 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (rng.binomial(4, 0.5, 400) - 2.0))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def block_of_one_of_five_grades(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Renard 1877 (blocks ground to five grades of a geometric series, one of which is taken by chance each slide)."""
    ratio = 10.0 ** (strength / 18.0)

    def law(rng: Generator) -> Throw:
        mu = 0.27 * ratio ** (int(rng.integers(5)) - 1.5)
        return Throw(lambda v, x: mu)

    return Effect({"ratio": ratio}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def chip_under_the_wiper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Markov 1906 (a chip that a wiper catches at one stroke of seven, and loses at one of five: a chain of two states)."""
    spread, caught, lost = 0.33 * strength, 1.0 / 7.0, 0.2
    share = caught / (caught + lost)

    def alter(plant: Plant, rng: Generator) -> Plant:
        chances, there = rng.random(400), rng.random() < share
        states = np.empty(400)
        for i, chance in enumerate(chances):
            there = chance >= lost if there else chance < caught
            states[i] = there
        return replace(plant, by_stroke=1.0 + spread * (states - share) / np.sqrt(share * (1.0 - share)))

    return Effect({"spread": spread}, alter=alter)


@form("frictional_lag", on=("slider",))
def heals_after_a_cut_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nakatani and Scholz 2006 (contacts that do not heal before a cut-off time, and that slip renews as usual)."""
    a, distance, cut_off = rng.uniform(0.008, 0.011) * strength, rng.uniform(8e-6, 1.3e-5), rng.uniform(0.3, 0.5)

    def state(theta: float, v: float, distance: float) -> float:
        return 1.0 - v * (theta - cut_off) / distance  # theta: age and cut-off time

    return Effect(
        {"a": a, "distance": distance, "cut_off": cut_off}, law=lambda _: RateAndState(0.6, a, (1.9 * a,), (distance,), state)
    )
