"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.plant import FACTOR_ON_SPEED, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", also=("drive_saturation", "drive_gain"))
def meter_changes_ranges(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tumanski 2006 (a meter of two ranges, the upper of which shows too little; it goes up later than down)."""
    loss = 0.3 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        size = np.abs(record[name])
        low, high = np.quantile(size, (0.45, 0.6))
        upper, now = np.empty(size.size), False
        for i, value in enumerate(size):
            now = bool(value > (low if now else high))
            upper[i] = now
        return record | {name: record[name] * (1.0 - loss * upper)}

    return Effect({"loss": loss}, measure=measure)


@form("unknown", also=("viscous_friction",))
def fluid_is_switched(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Winslow 1949 (a fluid that somebody stiffens and frees by a field, at other moments each run: by speed, not by load)."""
    size = 1.2 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        flips = np.cumsum(rng.exponential(1.5, 100))
        on = float(rng.random() < 0.5)
        plant = plant.add_by_speed(lambda v: size * v / bench.speed)
        return plant.times_in_time(FACTOR_ON_SPEED, lambda t: np.mod(np.searchsorted(flips, t) + on, 2.0))

    return Effect({"size": size}, alter=alter)


@form("unknown", also=("direction_asymmetry", "friction_drift", "constant_force"))
def lip_tires_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mueller and Nau 1998 (a lip that bites forward alone, and yields and recovers in turn within each run)."""
    size, period = 0.8 * strength * bench.level, bench.duration * rng.uniform(0.3, 0.45)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def level(v: Array) -> Array:
            return size + 0.0 * v

        def none(v: Array) -> Array:
            return 0.0 * v

        plant = plant.add_by_speed(level, none)
        return plant.times_in_time(FACTOR_ON_SPEED, lambda t: 0.5 + 0.5 * np.sin(TURN * t / period + start))

    return Effect({"size": size, "period": period}, alter=alter)


@form("unknown", also=("sensor_delay",))
def peak_is_held(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a peak detector: up at once, down with a time of its own, either way)."""
    time = 0.25 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        decay, x = np.exp(-1.0 / (time * bench.rate)), record[name]
        shown, up, down = np.empty_like(x), 0.0, 0.0
        for i, value in enumerate(x):
            up, down = max(value, decay * up), min(value, decay * down)
            shown[i] = up if value >= 0.0 else down
        return record | {name: shown}

    return Effect({"time": time}, measure=measure)


@form("unknown", also=("sensor_outliers", "stale_samples"), on=SINGLES)
def rows_vanish(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bolot 1993 (blocks of rows that are lost, while the logger numbers on as if nothing had been)."""
    rate, lasts = 1.5, 0.08 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        n = max(3, round(lasts * bench.rate))
        kept = np.ones(t.size, bool)
        for begin in rng.integers(n, t.size - 2 * n, max(3, rng.poisson(rate * t[-1]))):
            kept[begin : begin + n] = False
        count = int(kept.sum())
        return {name: t[:count] if name == "time [s]" else x[kept] for name, x in record.items()}

    return Effect({"lasts": lasts}, measure=measure)


@form("unknown", also=("friction_drift",), on=("slider",))
def room_breathes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dieterich and Conrad 1984 (moist air that comes and goes: a wave in time, another phase each run)."""
    size, period = 0.02 * strength, rng.uniform(15.0, 21.0)

    def law(rng: Generator) -> RateAndState:
        start = rng.uniform(0.0, TURN)
        return RateAndState(0.6, 0.0, added=lambda t, x: size * np.sin(TURN * t / period + start))

    return Effect({"size": size, "period": period}, law=law)
