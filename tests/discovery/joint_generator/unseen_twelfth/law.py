"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np
from scipy.special import erfc

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("viscous_friction")
def drilling_mud(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Robertson and Stiff 1976 (a mud: a power of the speed and a rate of its own; what yields at rest is Coulomb's)."""
    size, own, power = 1.3 * strength * bench.level, rng.uniform(0.04, 0.09), 0.45

    def drag(v: Array) -> Array:
        return size * ((v / bench.speed + own) ** power - own**power) / ((1.0 + own) ** power - own**power)

    return by_speed({"size": size, "own": own}, drag)


@form("viscous_friction")
def knees_of_a_robot_joint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kostic, de Jager, Steinbuch and Hensen 2004 (a robot's joint as it is fitted: two sigmoids of the speed, and a line)."""
    size, knee, other = 1.1 * strength * bench.level, rng.uniform(0.1, 0.16), rng.uniform(0.5, 0.7)

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * (0.4 * np.tanh(u / knee) + 0.3 * np.tanh(u / other) / np.tanh(1.0 / other) + 0.3 * u)

    return by_speed({"size": size, "knee": knee, "other": other}, drag)


@form("velocity_weakening")
def heights_are_normal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Greenwood and Williamson 1966 (asperities of normal heights over a film that grows by the power 0.67 of the speed)."""
    size, knee = 1.0 * strength * bench.level, bench.speed * rng.uniform(0.15, 0.22)
    return by_speed({"size": size, "knee": knee}, lambda v: size * erfc((v / knee) ** 0.67))


@form("direction_asymmetry")
def cylinder_out_and_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kanters and Visscher 1989 (a rod's seal: out it drags a film, a line; in it rubs more, and that fades with the speed).

    The mean of both ways is level with the speed; their difference is largest while slow.
    """
    size, forward = strength * bench.level, rng.random() < 0.5

    def out(v: Array) -> Array:
        return size * (0.3 * np.minimum(v / bench.speed, 1.5) - 0.35)

    def back(v: Array) -> Array:
        return size * 0.6 * np.exp(-v / bench.speed / 1.3)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(out, back) if forward else plant.add_by_speed(back, out)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def exhaust_throttles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """ISO 6358:1989, in Beater 2007 (throttled exhausts: back pressure as the square, and steeper toward the choked speed)."""
    size, critical, choked = 1.2 * strength * bench.level, 0.3, rng.uniform(1.3, 1.5)

    def pressure(u: Array) -> Array:
        """Above the air's, in its own units, at a share of the choked speed."""
        return 1.0 / (critical + (1.0 - critical) * np.sqrt(1.0 - np.minimum(u, 0.98) ** 2)) - 1.0

    entered = float(pressure(np.array(1.0 / choked)))
    return by_speed({"size": size, "choked": choked}, lambda v: size * pressure(v / bench.speed / choked) / entered)


@form("load_dependence", on=("slide",))
def tyre_under_a_hopper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pacejka 2012 (rubber tyres: the coefficient falls as a line of the load; a hopper that fills and tips, recorded)."""
    falls, period, start = 0.38, rng.uniform(2.6, 3.6), rng.uniform(0.0, 1.0)

    def share(t: Array) -> Array:
        s = np.mod(t / period + start, 1.0)
        filled = (1.0 - np.exp(-2.0 * np.minimum(s, 0.88) / 0.88)) / (1.0 - np.exp(-2.0))
        tipped = np.clip((s - 0.88) / 0.12, 0.0, 1.0)
        return 0.45 + 1.45 * filled * (1.0 - (3.0 - 2.0 * tipped) * tipped * tipped)

    def coefficient(n: Array) -> Array:
        return 1.0 + falls * (1.0 - n)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) * (1.0 + strength * (coefficient(share(t)) - 1.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"falls": falls, "period": period}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def bush_swells(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Crank 1975 (a polyamide bush that swells in coolant: diffusion into a sheet, a root of time first, exponential last)."""
    rise, time = 0.75 * strength, bench.duration * rng.uniform(0.3, 0.42)
    odd = np.arange(1.0, 60.0, 2.0)

    def factor(t: Array) -> Array:
        terms = np.exp(-(odd**2) * np.maximum(t, 0.0)[:, None] / time) / odd**2
        return 1.0 + rise * (1.0 - terms.sum(axis=1) / np.sum(1.0 / odd**2))

    return in_time({"rise": rise, "time": time}, factor)


@form("distance_drift", also=("friction_drift",))
def life_of_a_dry_film(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Weibull 1951 (a bonded dry film that wears through here and there: a share by the strokes since it was new)."""
    more, life, slope = 0.85 * strength, rng.uniform(7.0, 9.0), 2.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return replace(plant, by_stroke=1.0 + more * (1.0 - np.exp(-((np.arange(400) / life) ** slope))))

    return Effect({"more": more, "life": life}, alter=alter)


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def rails_on_another_metal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992; Hertz 1882 (steel rails on an aluminium bed: their interference, to 3/2; coolant on and off, recorded)."""
    even, span, share = 20.0, 12.0, 0.7 * strength
    turns = bench.duration * np.array([0.0, rng.uniform(0.25, 0.32), 0.47, rng.uniform(0.68, 0.75)])
    ends, time = np.array([37.0, 20.5, 37.0, 20.5]), 0.16 * bench.duration

    def celsius(t: Array) -> Array:
        t, now = np.maximum(t, 0.0), 22.5
        value = np.full(t.shape, now)
        for k, (begin, end) in enumerate(zip(turns, ends, strict=True)):
            value = np.where(t >= begin, end + (now - end) * np.exp(-(t - begin) / time), value)
            if k + 1 < turns.size:
                now = end + (now - end) * np.exp(-(turns[k + 1] - begin) / time)
        return value

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + share * (((celsius(t) - even) / span) ** 1.5 - 0.4))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"even": even}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def chips_lie_in_nests(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Greenwood and Yule 1920 (chips on the way, which lie in nests: a negative binomial number, a new draw each stroke)."""
    each = 0.14 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + each * (np.minimum(rng.negative_binomial(2, 0.5, 400), 12) - 2.0))

    return Effect({"each": each}, alter=alter)


@form("random_coefficients", on=("thrown",))
def share_of_the_sole_that_touches(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pearson 1895 (a sole that touches by a share between none and all: a beta density, a new draw each slide)."""
    span = 0.3 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 + span * (rng.beta(2.0, 3.0) - 0.4)
        return Throw(lambda v, x: mu)

    return Effect({"span": span}, law=law)


def long_memory(order: float, n: int) -> Array:
    """Weights of pushes of the past in fractional noise, scaled to unit variance, shape (n,)."""
    k = np.arange(1.0, n)
    weights = np.concatenate([[1.0], np.cumprod((k - 1.0 + order) / k)])
    return weights / np.sqrt(np.sum(weights**2))


@form("correlated_coefficients", also=("random_coefficients",))
def way_remembers_for_long(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hurst 1951; Granger and Joyeux 1980 (a worn way that forgets by a power of the strokes: fractional noise of 0.38)."""
    spread, weights = 0.32 * strength, long_memory(0.38, 1500)

    def alter(plant: Plant, rng: Generator) -> Plant:
        level = np.convolve(rng.standard_normal(400 + weights.size - 1), weights, mode="valid")
        return replace(plant, by_stroke=np.maximum(1.0 + spread * level, 0.15))

    return Effect({"spread": spread}, alter=alter)


@form("frictional_lag", on=("slider",))
def between_both_laws(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ruina 1983 (a state between his two laws: twice the root of its share of what is steady, less twice that share)."""
    a, distance = rng.uniform(0.008, 0.011) * strength, rng.uniform(8e-6, 1.3e-5)

    def state(theta: float, v: float, distance: float) -> float:
        x = v * theta / distance
        return 2.0 * (np.sqrt(max(x, 0.0)) - x)  # 1 - x is his first law, -x log x his second; powers 1 and 0 of this one

    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (1.6 * a,), (distance,), state))
