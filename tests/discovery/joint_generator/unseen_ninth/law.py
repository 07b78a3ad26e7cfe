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
def film_heats_itself(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nahme 1940; Winter 1977 (an oil film that thins by its own heat: an inverse hyperbolic sine over a root, to its top)."""
    size, heat = 0.8 * strength * bench.level, rng.uniform(1.15, 1.45)

    def drag(v: Array) -> Array:
        s = np.minimum(heat * v / bench.speed, 1.5)  # its top, which no motion asked for reaches
        return size * np.arcsinh(s) / np.sqrt(1.0 + s * s) / 0.66

    return by_speed({"size": size, "heat": heat}, drag)


@form("viscous_friction")
def paste_with_a_shoulder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """De Kee and Turcotte 1980 (a paste: a line, and a part that rises and is broken up: steep, a shoulder, and on)."""
    size, broken = 0.8 * strength * bench.level, bench.speed * rng.uniform(0.2, 0.28)

    def drag(v: Array) -> Array:
        return size * (0.9 * v / broken * np.exp(-v / broken) + 0.75 * v / bench.speed)

    return by_speed({"size": size, "broken": broken}, drag)


@form("velocity_weakening")
def film_over_rough_surfaces(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Greenwood and Tripp 1970; Hu, Cheng and Arai 1994 (asperities under a film: 4 less its height, to the power 6.8)."""
    size, full = 0.75 * strength * bench.level, bench.speed * rng.uniform(2.2, 3.0)

    def asperities(v: Array) -> Array:
        return size * (1.0 - np.minimum(v / full, 1.0) ** 0.67) ** 6.804

    return by_speed({"size": size, "full": full}, asperities)


@form("direction_asymmetry", also=("velocity_weakening",))
def leading_and_trailing_shoe(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Limpert 2011, chapter 2 (a shoe draws itself in one way and lifts itself the other way; its lining fades a little)."""
    pull, fade, forward = 0.36 * strength, 0.18 * strength, rng.random() < 0.5

    def shoe(v: Array, c: float) -> Array:
        grip = 1.0 - fade * np.minimum(v / bench.speed, 1.3)
        return bench.level * (grip / (1.0 - c * grip) - 1.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        side = 1.0 if forward else -1.0
        return plant.add_by_speed(lambda v: shoe(v, side * pull), lambda v: shoe(v, -side * pull))

    return Effect({"pull": pull, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def float_in_a_tank(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Abraham 1970 (a sphere with its boundary layer: the square of the speed and a share of its root)."""
    size, layer = 0.95 * strength * bench.level, rng.uniform(0.22, 0.34)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * ((u + layer * np.sqrt(u)) / (1.0 + layer)) ** 2

    return by_speed({"size": size, "layer": layer}, drag)


@form("load_dependence", on=("slide",))
def sphere_ploughs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Goddard and Wilman 1962 (a sphere that ploughs: N to 1.5 and a fifth of N; weights are laid on and off, recorded)."""
    period, start = bench.duration * rng.uniform(0.2, 0.28), rng.uniform(0.0, TURN)

    def share(t: Array) -> Array:
        return 1.25 + 0.85 * np.clip(1.6 * np.sin(TURN * t / period + start), -1.0, 1.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (0.2 + 0.8 * np.sqrt(share(t)) - 1.0))
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def heat_through_the_housing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Carslaw and Jaeger 1959 (a gear that its motor warms through the housing: level at first, then an approach)."""
    loss, time = 0.55 * strength, bench.duration * rng.uniform(0.13, 0.19)

    def factor(t: Array) -> Array:
        s = np.maximum(t, 0.0) / time
        return 1.0 - loss * (1.0 - (1.0 + s) * np.exp(-s))

    return in_time({"loss": loss, "time": time}, factor)


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=("slider",))
def peak_and_residual(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Skempton 1964 (a clay in the shear box: it grows to a peak over a way, and falls back to what is left of it)."""
    size, peak = 0.03 * strength, rng.uniform(0.9e-4, 1.4e-4)
    return Effect(
        {"size": size, "peak": peak},
        law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * x / peak * np.exp(1.0 - x / peak)),
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def least_when_warm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dowson 1979 (oil too thick when cold and too thin when hot: a hyperbolic cosine; a hall of two tides, recorded)."""
    least, period = rng.uniform(24.0, 28.0), bench.duration * rng.uniform(0.65, 0.85)
    start, other = rng.uniform(0.0, TURN, 2)

    def celsius(t: Array) -> Array:
        return 26.0 + 8.0 * np.sin(TURN * t / period + start) + 4.0 * np.sin(2.7 * TURN * t / period + other)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + 0.6 * strength * (np.cosh((celsius(t) - least) / 7.0) - 1.4))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"least": least, "period": period}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_exponential(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Feller 1966 (what lies on the way by chance: an exponential density above a least friction, a new draw each stroke)."""
    spread = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + spread * (rng.exponential(1.0, 400) - 1.0))

    return Effect({"spread": spread}, alter=alter)


@form("random_coefficients", on=("thrown",))
def throws_of_a_resultant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rayleigh 1880 (two flaws at right angles, each normal: the size of their resultant, a new draw each slide)."""
    spread = 0.25 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.29 * max(1.0 + spread * (float(rng.rayleigh()) - 1.2533) / 0.6551, 0.2)
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def walks_between_two_walls(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Feller 1957, chapter 14 (a preload that steps up or down by chance at each stroke, between stops that turn it back)."""
    half, step = 0.5 * strength, 0.6

    def alter(plant: Plant, rng: Generator) -> Plant:
        walk = rng.uniform(-1.0, 1.0) + step * np.cumsum(rng.choice([-1.0, 1.0], 400))
        return replace(plant, by_stroke=1.0 + half * 2.0 / np.pi * np.arcsin(np.sin(0.5 * np.pi * walk)))

    return Effect({"half": half, "step": step}, alter=alter)


@form("frictional_lag", on=("slider",))
def longer_way_when_fast(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mair and Marone 1999 (a gouge that needs the longer way to be renewed the faster it slides; the slip law else)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(5e-6, 9e-6)

    def state(theta: float, v: float, distance: float) -> float:
        x = v * theta / distance
        return -x * float(np.log(max(x, 1e-12))) * (v / 1e-6) ** -0.35

    return Effect(
        {"a": a, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (1.4 * a,), (distance,), state),
    )
