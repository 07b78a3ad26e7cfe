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


def bearing_numbers(left: Array) -> tuple[Array, Array]:
    """Sommerfeld number of a short bearing and its friction, over one less the square of the eccentricity."""
    off = np.sqrt(1.0 - left)
    number = left**2 / (np.pi * off * np.sqrt(np.pi**2 * left + 16.0 * off**2))
    return number, number / np.sqrt(left)


@form("viscous_friction")
def short_journal_bearing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """DuBois and Ocvirk 1953 (a short oiled bush: the power 3/4 of the speed while slow, a line when fast)."""
    size, eccentricity = 1.2 * strength * bench.level, rng.uniform(0.35, 0.5)
    numbers, frictions = bearing_numbers(np.concatenate([np.geomspace(1e-7, 0.5, 400), np.linspace(0.501, 0.9995, 400)]))
    entered, drags = bearing_numbers(np.array(1.0 - eccentricity**2))

    def drag(v: Array) -> Array:
        return size * np.interp(entered * v / bench.speed, numbers, frictions, left=0.0) / drags

    return by_speed({"size": size, "eccentricity": eccentricity}, drag)


@form("viscous_friction", also=("quadratic_damping",))
def vortices_in_an_oiled_gap(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Taylor 1923; Donnelly and Simon 1960 (a motor in oil: a line, and steeper from the speed on at which vortices form)."""
    size, critical = 1.2 * strength * bench.level, rng.uniform(0.38, 0.48)

    def torque(w: Array) -> Array:
        """Over the speed as a share of the critical one, 1 there."""
        w = np.asarray(w)
        beyond = np.maximum(w, 1.0)
        return np.where(w < 1.0, w, 1.5 * beyond**1.36 - 0.5 / beyond)

    full = float(torque(np.array(1.0 / critical)))
    return by_speed({"size": size, "critical": critical}, lambda v: size * torque(v / bench.speed / critical) / full)


@form("velocity_weakening")
def wheels_aquaplane(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horne and Dreher 1963 (rubber wheels on a wet track: water bears the square of the speed, and from one speed on all)."""
    size, planing = 0.95 * strength * bench.level, bench.speed * rng.uniform(0.4, 0.55)
    return by_speed({"size": size, "planing": planing}, lambda v: size * np.maximum(1.0 - (v / planing) ** 2, 0.0))


@form("direction_asymmetry")
def over_a_counterbalance_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Handroos, Halme and Vilenius 1993 (a counterbalance valve: one way its setting and a line, the other way the square)."""
    size, forward = strength * bench.level, rng.random() < 0.5

    def lowered(v: Array) -> Array:
        return size * (0.5 + 0.2 * v / bench.speed)

    def raised(v: Array) -> Array:
        return size * (0.2 * (v / bench.speed) ** 2 - 0.4)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lowered, raised) if forward else plant.add_by_speed(raised, lowered)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def rough_boom_in_water(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Achenbach 1971 (a rough boom in water: the square, of which a third goes as its boundary layer turns turbulent)."""
    size, critical = 1.3 * strength * bench.level, rng.uniform(0.45, 0.55)

    def coefficient(u: Array) -> Array:
        return 1.1 - 0.36 / (1.0 + np.exp(-np.clip((u - critical) / 0.04, -50.0, 50.0)))

    full = float(coefficient(np.array(1.0)))
    return by_speed(
        {"size": size, "critical": critical}, lambda v: size * (v / bench.speed) ** 2 * coefficient(v / bench.speed) / full
    )


@form("load_dependence", on=("slide",))
def soft_liner_shears(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Orowan 1943 (a soft liner: friction as the load until it shears, and no more from there on; a cam presses, recorded)."""
    shears, more, period, start = 0.9, 1.2, rng.uniform(2.4, 3.4), rng.uniform(0.0, 1.0)

    def share(t: Array) -> Array:
        s = np.mod(t / period + start, 1.0)
        rise, fall = np.clip((s - 0.1) / 0.4, 0.0, 1.0), np.clip((s - 0.6) / 0.4, 0.0, 1.0)
        cycloids = [x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi) for x in (rise, fall)]
        return 0.4 + 1.5 * (cycloids[0] - cycloids[1])

    def coefficient(n: Array) -> Array:
        return more * np.minimum(1.0, shears / n)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (coefficient(share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"shears": shears, "period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def oil_is_squeezed_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stefan 1874 (oil under a slide that was just let down: its film is the inverse root of a line in time)."""
    rise, time = 1.1 * strength, bench.duration * rng.uniform(0.06, 0.1)
    return in_time({"rise": rise, "time": time}, lambda t: 1.0 + rise * (1.0 - 1.0 / np.sqrt(1.0 + np.maximum(t, 0.0) / time)))


@form("distance_drift", also=("friction_drift",))
def runs_in_and_then_wears(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 1981 (a bush that runs in and then wears: an exponential fall, and a line up, by the strokes since it was new)."""
    fall, strokes, slope = 1.7, rng.uniform(2.3, 2.7), 0.1

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n = np.arange(400)
        return replace(plant, by_stroke=1.0 + strength * (fall * np.exp(-n / strokes) + slope * np.minimum(n, 16) - 0.8))

    return Effect({"fall": fall, "strokes": strokes, "slope": slope}, alter=alter)


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def rails_fit_at_one_temperature(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bryan 1990 (two rails that fit at 21.5 degrees and strain to either side of it; a gate opens three times, recorded)."""
    fits, span, share = 21.5, 3.5, 0.8 * strength
    opens = bench.duration * np.array([rng.uniform(0.02, 0.08), rng.uniform(0.34, 0.42), rng.uniform(0.66, 0.74)])
    time, cools = 0.13 * bench.duration, 0.02 * bench.duration

    def celsius(t: Array) -> Array:
        since = np.maximum(t[:, None] - opens, 0.0)
        return 25.0 - np.max(10.0 * (1.0 - np.exp(-since / cools)) * np.exp(-since / time), axis=1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + share * (np.abs(celsius(t) - fits) / span - 0.5))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"fits": fits, "span": span}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def disc_of_six_facets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Laplace 1812 (a preload disc of six facets, any of which may come to bear: six even levels, a new draw each stroke)."""
    each = 0.16 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (rng.integers(6, size=400) - 2.5))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def hardest_grain_decides(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Frechet 1927 (the hardest of many grains under a block: a density with a tail to above, a new draw each slide)."""
    scale, power = 0.13 * strength, 4.0

    def law(rng: Generator) -> Throw:
        grain = min((-np.log(rng.uniform(1e-9, 1.0))) ** (-1.0 / power), 3.5)
        mu = 0.28 + scale * (grain - 1.225)
        return Throw(lambda v, x: mu)

    return Effect({"scale": scale}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def chips_stay_or_are_swept(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Al-Osh and Alzaid 1987 (chips on a guide, each of which a stroke leaves by a chance of 0.72; others fall on it)."""
    each, stays, mean = 0.22 * strength, 0.72, 2.0

    def alter(plant: Plant, rng: Generator) -> Plant:
        number = np.empty(400)
        number[0] = rng.poisson(mean)
        for n in range(1, 400):
            number[n] = rng.binomial(int(number[n - 1]), stays) + rng.poisson(mean * (1.0 - stays))
        return replace(plant, by_stroke=1.0 + each * (np.minimum(number, 9.0) - mean))

    return Effect({"each": each, "stays": stays}, alter=alter)


@form("frictional_lag", on=("slider",))
def no_younger_than_a_cut_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Okubo and Dieterich 1986 (contacts that slip renews, yet not to less than a cut-off age: when fast, none is left)."""
    a, distance, least = rng.uniform(0.008, 0.011) * strength, rng.uniform(8e-6, 1.3e-5), rng.uniform(0.3, 0.5)

    def state(theta: float, v: float, distance: float) -> float:
        return 1.0 - v * (theta - least) / distance

    return Effect(
        {"a": a, "distance": distance, "least": least}, law=lambda _: RateAndState(0.6, a, (1.6 * a,), (distance,), state)
    )
