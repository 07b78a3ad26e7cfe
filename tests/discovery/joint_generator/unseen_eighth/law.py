"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState, ageing, slipping
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def sisko(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sisko 1958 (a lubricating grease: a line, and a power of the speed well below a half)."""
    size, power = 0.95 * strength * bench.level, rng.uniform(0.25, 0.35)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * (0.65 * u + 0.35 * u**power)

    return by_speed({"size": size, "power": power}, drag)


@form("viscous_friction")
def shear_thickening(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Barnes 1989 (a suspension that thickens about a rate of shear: a logistic rise from a low to a high plateau)."""
    size, middle = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.35, 0.5)

    def drag(v: Array) -> Array:
        return size * (1.0 / (1.0 + np.exp(-(v - middle) / (0.22 * middle))) - 1.0 / (1.0 + np.exp(1.0 / 0.22)))

    return by_speed({"size": size, "middle": middle}, drag)


@form("velocity_weakening")
def asperities_bear_less(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Castro and Seabra 2007 (asperities bear a share that falls as a power of the speed, until a film bears all)."""
    size, full, power = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.45, 0.65), rng.uniform(0.45, 0.6)
    return by_speed({"size": size, "full": full, "power": power}, lambda v: size * (1.0 - np.minimum(v / full, 1.0) ** power))


@form("direction_asymmetry")
def spiral_grooves(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Muijderman 1966 (spiral grooves: one way they pump a film that lifts, the other way they empty it and it drags)."""
    size, forward = 0.75 * strength * bench.level, rng.random() < 0.5

    def lifts(v: Array) -> Array:
        return -size * v / (v + 0.25 * bench.speed)

    def empties(v: Array) -> Array:
        return size * v / bench.speed

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lifts, empties) if forward else plant.add_by_speed(empties, lifts)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", also=("viscous_friction",), on=SINGLES)
def disc_in_a_housing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Daily and Nece 1960 (an enclosed disc: a laminar line, from a third of the highest speed on the power 1.8)."""
    size, turns = 0.9 * strength * bench.level, rng.uniform(0.28, 0.38)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * np.maximum(turns**0.8 * u, u**1.8)

    return by_speed({"size": size, "turns": turns}, drag)


@form("load_dependence", on=("slide",))
def pad_of_rubber(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Thirion 1946 (rubber: the inverse of the coefficient is a line over the load; it is recorded, and charged and vented)."""
    period, start = bench.duration * rng.uniform(0.22, 0.3), rng.uniform(0.0, 1.0)

    def share(t: Array) -> Array:
        u = np.mod(t / period + start, 1.0)
        charged = (1.0 - np.exp(-5.0 * u)) / (1.0 - np.exp(-2.5))
        vented = (np.exp(-5.0 * (u - 0.5)) - np.exp(-2.5)) / (1.0 - np.exp(-2.5))
        return 0.4 + 1.6 * np.where(u < 0.5, charged, vented)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (2.2 / (1.0 + 1.2 * share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def seal_relaxes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kohlrausch 1854; Struik 1978 (a seal that was just fitted: its grip relaxes along a stretched exponential)."""
    loss, time, power = 0.65 * strength, bench.duration * rng.uniform(0.2, 0.35), 0.45
    return in_time({"loss": loss, "time": time}, lambda t: 1.0 - loss * (1.0 - np.exp(-((np.maximum(t, 0.0) / time) ** power))))


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=("slider",))
def transfer_film_grows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bahadur 2000 (a polymer that transfers: a film that grows on what there is of it, so a logistic over the way)."""
    size, half, width = 0.03 * strength * either_sign(rng), rng.uniform(1.6e-4, 2.4e-4), rng.uniform(3e-5, 5e-5)
    return Effect(
        {"size": size, "half": half, "width": width},
        law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size / (1.0 + np.exp(-(x - half) / width))),
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def peak_of_a_rubber(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ludema and Tabor 1966 (a rubber that rubs most at one temperature: a bell; a chamber that ramps to and fro, recorded)."""
    most, period, start = rng.uniform(16.0, 20.0), bench.duration * rng.uniform(0.6, 0.8), rng.uniform(0.0, TURN)

    def celsius(t: Array) -> Array:
        return 22.0 + 14.0 * 2.0 / np.pi * np.arcsin(np.sin(TURN * t / period + start))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 + strength * (0.9 * np.exp(-(((celsius(t) - most) / 8.0) ** 2)) - 0.4)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"most": most, "period": period}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_arc_sine(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1995 (an arc-sine density, most strokes near either limit; a new draw each stroke)."""
    spread = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + spread * np.cos(np.pi * rng.random(400)))

    return Effect({"spread": spread}, alter=alter)


@form("random_coefficients", on=("thrown",))
def throws_of_a_weakest_link(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Weibull 1951 (what holds is as strong as its weakest link: a density that leans to below, a new draw each slide)."""
    spread = 0.3 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.3 * max(1.0 + spread * (float(rng.weibull(5.0)) - 0.918) / 0.21, 0.2)
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def film_of_the_last_strokes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slutzky 1937 (a film that the last five strokes left, each by its own: a moving sum of what is drawn)."""
    spread = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        drawn = rng.standard_normal(404)
        film = np.convolve(drawn, np.ones(5), mode="valid") / np.sqrt(5.0)
        return replace(plant, by_stroke=np.maximum(1.0 + spread * film, 0.2))

    return Effect({"spread": spread}, alter=alter)


@form("frictional_lag", on=("slider",))
def half_by_age_half_by_slip(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beeler, Tullis and Weeks 1994 (contacts half of which follow the ageing law, and half the slip law)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(7e-6, 1.4e-5)

    def state(theta: float, v: float, distance: float) -> float:
        return 0.5 * (ageing(theta, v, distance) + slipping(theta, v, distance))

    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (1.4 * a,), (distance,), state))
