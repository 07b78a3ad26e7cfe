"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def papanastasiou(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Papanastasiou 1987 (a paste that yields: an exponential approach, and a line)."""
    size, knee = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.12, 0.2)
    return by_speed({"size": size, "knee": knee}, lambda v: size * (0.4 * (1.0 - np.exp(-v / knee)) + 0.6 * v / bench.speed))


@form("velocity_weakening")
def thomsen_cubic(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Thomsen 1999; Ibrahim 1994 (a cubic that falls at once and has a minimum, from where on it is level)."""
    size, least = 0.65 * strength * bench.level, bench.speed * rng.uniform(0.4, 0.6)

    def falls(v: Array) -> Array:
        u = np.minimum(v / least, 1.0)
        return size * (1.0 - 1.5 * u + 0.5 * u**3)

    return by_speed({"size": size, "least": least}, falls)


@form("direction_asymmetry", also=("quadratic_damping", "viscous_friction"))
def flap_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a flap that shuts one way: the square of the speed, and a seventh of it the other way)."""
    size, forward = 1.1 * strength * bench.level, rng.random() < 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def shut(v: Array) -> Array:
            return size * (v / bench.speed) ** 2

        def opened(v: Array) -> Array:
            return 0.14 * shut(v)

        return plant.add_by_speed(shut, opened) if forward else plant.add_by_speed(opened, shut)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("load_dependence", on=("slide",))
def hertz_to_a_third(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bowden and Tabor 1964, chapter 14 (a Hertzian contact: N to -1/3; its load is recorded, and saws up and down)."""
    period, start = bench.duration * rng.uniform(0.2, 0.27), rng.uniform(0.0, TURN)

    def share(t: Array) -> Array:
        return 1.2 + 0.9 * 2.0 / np.pi * np.arcsin(np.sin(TURN * t / period + start))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (share(t) ** (-1.0 / 3.0) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def parabola(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Draper and Smith 1998 (a parabola in time: falls, and rises again from a moment on)."""
    loss, least = 0.5 * strength, bench.duration * rng.uniform(0.6, 0.75)
    return in_time({"loss": loss, "least": least}, lambda t: 1.0 - loss * (1.0 - (1.0 - t / least) ** 2))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def two_lines(rng: Generator, strength: float, bench: Bench) -> Effect:
    """McLaren and Tabor 1963 (a polymer that softens from a temperature on; a room that is heated and aired, recorded)."""
    knee, period, start = rng.uniform(22.0, 25.0), bench.duration * rng.uniform(0.55, 0.75), rng.uniform(0.0, TURN)

    def celsius(t: Array) -> Array:
        return 26.0 + 8.0 * np.sin(TURN * t / period + start)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 - 0.075 * strength * (np.maximum(celsius(t) - knee, 0.0) - 3.0)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"knee": knee, "period": period}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_leaning_triangle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008, 4.3.9 (a triangular density that leans, a new draw each stroke)."""
    spread = 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=np.maximum(1.0 + spread * rng.triangular(-1.0, -0.4, 1.4, 400) / 0.51, 0.2))

    return Effect({"spread": spread}, alter=alter)


@form("correlated_coefficients", also=("random_coefficients",))
def level_stays_for_some_strokes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brissaud and Frisch 1974 (a level that stays, and is drawn anew after one stroke of four)."""
    spread, anew = 0.3 * strength, 0.25

    def alter(plant: Plant, rng: Generator) -> Plant:
        changes = np.cumsum(rng.random(400) < anew)
        return replace(plant, by_stroke=np.maximum(1.0 + spread * rng.standard_normal(401)[changes], 0.2))

    return Effect({"spread": spread, "anew": anew}, alter=alter)


@form("frictional_lag", on=("slider",))
def ageing_that_ends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bureau, Baumberger and Caroli 2002 (contacts whose age grows no further than to what a slow slide leaves them)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(6e-6, 1.1e-5)
    oldest = 2.0 * distance / 1e-6

    def state(theta: float, v: float, distance: float) -> float:
        return 1.0 - theta * (v / distance + 1.0 / oldest)

    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (1.5 * a,), (distance,), state))


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=("slider",))
def coating_until_it_is_gone(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1953; Holmberg and Matthews 2009 (a coating that wears in proportion to the way, until it is gone)."""
    size, gone = 0.025 * strength * either_sign(rng), rng.uniform(2e-4, 3.5e-4)
    return Effect(
        {"size": size, "gone": gone}, law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * np.minimum(x / gone, 1.0))
    )
