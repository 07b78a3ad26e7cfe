"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import V_0, RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def bearing_catalogue(rng: Generator, strength: float, bench: Bench) -> Effect:
    """SKF 2018 (a rolling bearing by its catalogue: the power 0.6, less by the heat at its inlet and by starvation)."""
    size, heat, starved = 0.9 * strength * bench.level, rng.uniform(0.2, 0.3), rng.uniform(0.08, 0.14)

    def moment(u: Array) -> Array:
        return u**0.6 * np.exp(-starved * u) / (1.0 + heat * u**1.28)

    def drag(v: Array) -> Array:
        return size * moment(np.minimum(v / bench.speed, 1.3)) / moment(np.ones(1))  # 1.3: its top, beyond what is asked for

    return by_speed({"size": size, "heat": heat, "starved": starved}, drag)


@form("viscous_friction")
def slurry_breaks_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Quemada 1978 (a slurry whose clusters break up: a line times the square of a ratio of roots)."""
    size, still, knee = 0.9 * strength * bench.level, rng.uniform(0.1, 0.15), rng.uniform(0.25, 0.4)

    def stress(u: Array) -> Array:
        root = np.sqrt(u / knee)
        return u * ((1.0 + root) / (still + root)) ** 2

    return by_speed({"size": size, "still": still, "knee": knee}, lambda v: size * stress(v / bench.speed) / stress(np.ones(1)))


@form("velocity_weakening")
def seal_of_a_cylinder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yanada and Sekikawa 2008 (seals of a hydraulic cylinder: an exponential of the root of the speed)."""
    size, knee = 1.0 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.15)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.exp(-np.sqrt(v / knee)))


@form("direction_asymmetry", also=("viscous_friction",))
def digressive_and_progressive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dixon 2007 (a damper that is digressive one way, a root of the speed, and progressive the other way, its square)."""
    size, forward = 1.1 * strength * bench.level, rng.random() < 0.5

    def root(v: Array) -> Array:
        return size * np.sqrt(v / bench.speed)

    def square(v: Array) -> Array:
        return size * np.minimum(v / bench.speed, 1.5) ** 2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(root, square) if forward else plant.add_by_speed(square, root)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def laminar_to_turbulent(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Borutzky, Barnard and Thoma 2002 (an orifice: a line while laminar, the square when turbulent, a hyperbola between)."""
    size, turns = 1.3 * strength * bench.level, rng.uniform(0.15, 0.25)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * u * np.hypot(u, turns) / np.hypot(1.0, turns)

    return by_speed({"size": size, "turns": turns}, drag)


@form("load_dependence", on=("slide",))
def preloaded_carriage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Harris 2001 (rows of balls against each other: their preload and the load in quadrature; a press roller, recorded)."""
    preload, apart = rng.uniform(1.1, 1.4), rng.uniform(0.7, 1.0)
    levels = np.concatenate([rng.permutation(np.linspace(0.4, 2.0, 7)) for _ in range(20)])

    def share(t: Array) -> Array:
        k = np.clip((t / apart).astype(int), 0, levels.size - 2)
        s = np.clip((t / apart - k) / 0.35, 0.0, 1.0)  # a third of the time from one level to the next, then it stays
        return levels[k] + (3.0 - 2.0 * s) * s * s * (levels[k + 1] - levels[k])

    def coefficient(n: Array) -> Array:
        return np.hypot(preload, n) / n / np.hypot(preload, 1.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (coefficient(share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"preload": preload, "apart": apart}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def thermostat_overshoots(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Astrom and Hagglund 1995 (oil that a thermostat heats: friction falls, overshoots and settles, as a second order)."""
    loss, period, damping = 0.42 * strength, bench.duration * rng.uniform(0.4, 0.55), 0.25

    def factor(t: Array) -> Array:
        s = TURN / period * np.maximum(t, 0.0)
        ring = np.sqrt(1.0 - damping**2)
        return 1.0 - loss * (1.0 - np.exp(-damping * s) * (np.cos(ring * s) + damping / ring * np.sin(ring * s)))

    return in_time({"loss": loss, "period": period}, factor)


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=("slider",))
def hyperbola_of_a_soil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kondner 1963 (a soil in the shear box: the way over a line of the way)."""
    size, half = 0.035 * strength, rng.uniform(4e-5, 8e-5)
    return Effect(
        {"size": size, "half": half},
        law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * x / (half + np.maximum(x, 0.0))),
    )


def viscosity(celsius: Array) -> Array:
    """Of an oil ISO VG 150: 150 mm^2/s at 40 degC, 15 mm^2/s at 100 degC (Walther 1931; ASTM D341)."""
    warm, hot = (np.log10(np.log10(grade + 0.7)) for grade in (150.0, 15.0))
    share = np.log10((celsius + 273.15) / 313.15) / np.log10(373.15 / 313.15)
    return 10.0**10.0 ** (warm + share * (hot - warm)) - 0.7


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def oil_by_its_grade(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Walther 1931 (gear oil by its grade: the logarithm of its logarithm; the sun passes over the sump, recorded)."""
    noon, width = bench.duration * rng.uniform(0.4, 0.6), 0.28 * bench.duration

    def celsius(t: Array) -> Array:
        return 20.0 + 19.0 * np.exp(-(((t - noon) / width) ** 2))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        share = 0.75 * strength
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 + share * (viscosity(celsius(t)) / viscosity(np.full(1, 28.0)) - 1.0)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"noon": noon, "width": width}, alter=alter, measure=measure)


@form("random_coefficients")
def gib_set_by_a_wrench(rng: Generator, strength: float, bench: Bench) -> Effect:
    """VDI 2230:2015 (a gib that a wrench sets before each run: an even moment over an even friction of the thread)."""
    share = 1.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        preload = (1.0 + rng.uniform(-0.1, 0.1)) * 0.13 / rng.uniform(0.1, 0.16)
        factor = 1.0 + share * (preload - 1.02)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: factor + 0.0 * t)

    return Effect({"share": share}, rig=lambda bench: replace(bench, n_fit=8, n_test=4, duration=5.0), alter=alter)


@form("random_coefficients", on=("thrown",))
def dust_only_adds(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Daniel 1959 (dust that only adds to what is least: half of a normal density, a new draw each slide)."""
    more = 0.4 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.24 * (1.0 + more * min(abs(float(rng.standard_normal())), 3.0))
        return Throw(lambda v, x: mu)

    return Effect({"more": more}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def pelted_pendulum(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yule 1927 (a level that each stroke has from the last two and a push by chance: it swings over a dozen strokes)."""
    spread = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        swing = lfilter([1.0], [1.0, -1.3, 0.55], rng.standard_normal(460))[60:] / 2.2
        return replace(plant, by_stroke=np.maximum(1.0 + spread * swing, 0.2))

    return Effect({"spread": spread}, alter=alter)


@form("frictional_lag", on=("slider",))
def heals_as_the_root(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brechet and Estrin 1994 (contacts whose age grows as the root of the time at rest, and is renewed by slip)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(8e-6, 1.4e-5)

    def state(theta: float, v: float, distance: float) -> float:
        return distance / (V_0 * theta) - v * theta / distance

    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (2.8 * a,), (distance,), state))
