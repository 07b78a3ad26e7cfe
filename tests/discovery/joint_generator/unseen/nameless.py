"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import chained, pressurised
from tests.discovery.joint_generator.forms.form import HINGES, JOINTS, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import (
    AREA_AT,
    FACTOR_OF_TIME,
    FORCE_OF_TIME,
    GAIN_OF_TIME,
    TIME_SPACING,
    Array,
    Plant,
)
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


def _in_time(row: int, parameters: dict[str, float], path: Callable[[Array, Generator], Array]) -> Effect:
    """A factor over time (or a force, if that is the row), another one in each run."""

    def alter(plant: Plant, rng: Generator) -> Plant:
        change = plant.add_in_time if row == FORCE_OF_TIME else plant.times_in_time
        return change(row, lambda t: path(t, rng))

    return Effect(parameters, alter=alter)


def _drifting(t: Array, rng: Generator, time: float) -> Array:
    """First-order autoregression of unit variance."""
    kept, path = np.exp(-TIME_SPACING / time), np.zeros(t.size)
    shocks = np.sqrt(1.0 - kept**2) * rng.standard_normal(t.size)
    path[0] = rng.standard_normal()
    for i in range(1, t.size):
        path[i] = kept * path[i - 1] + shocks[i]
    return path


@form("unknown")
def loose_contact(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holm 1967 (a connector whose resistance jumps: force per command between two levels at random)."""
    loss, rate = 0.3 * strength, rng.uniform(1.0, 2.0)
    return _in_time(
        GAIN_OF_TIME, {"loss": loss}, lambda t, rng: 1.0 - loss * (np.cumsum(rng.random(t.size) < rate * TIME_SPACING) % 2)
    )


@form("unknown")
def supply_ripples(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mohan, Undeland and Robbins 2003 (a supply that is loaded by another axis, at a low frequency)."""
    size, frequency = 0.25 * strength, rng.uniform(1.3, 2.8)
    return _in_time(GAIN_OF_TIME, {"size": size}, lambda t, rng: 1.0 + size * np.sin(TURN * (frequency * t + rng.random())))


@form("unknown", also=("position_dependent_force",), on=HINGES)
def eccentric_disc(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Del Re and others 2015 (an encoder disc out of centre: a wave a turn in what is read)."""
    size = 0.5 * strength * bench.level / (bench.numbers["gravity"] + bench.inertia * bench.speed**2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: record[name] + size * np.sin(2.0 * record[name] + 0.8) for name in positions(record)}

    return Effect({"size": size}, measure=measure)


@form("unknown", also=("sensor_delay",))
def clock_wanders(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Elson, Girod and Estrin 2002 (positions and drives from two computers whose clocks drift to and fro)."""
    size, length = 0.02 * strength, rng.uniform(0.6, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        knots = np.arange(-length, t[-1] + 2.0 * length, length)
        taken = t + np.interp(t, knots, size * rng.standard_normal(knots.size))
        return record | {name: np.interp(taken, t, record[name]) for name in positions(record)}

    return Effect({"size": size, "length": length}, measure=measure)


@form("unknown")
def gaps_bridged(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Little and Rubin 1987 (a logger that draws straight lines across what it lost)."""
    rate, longest = 0.8, 0.25 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept = np.ones(t.size, dtype=bool)
        for begin in rng.uniform(0.2, t[-1] - 0.5, rng.poisson(rate * t[-1])):
            kept[(t > begin) & (t < begin + longest * rng.uniform(0.5, 1.0))] = False
        return record | {name: np.interp(t, t[kept], record[name][kept]) for name in positions(record)}

    return Effect({"longest": longest}, measure=measure)


@form("unknown", also=("sensor_delay",), on=SINGLES)
def drive_read_seldom(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Franklin, Powell and Workman 1998 (a drive that is polled 15 to 30 times a second, and held)."""
    n = max(4, round(0.06 * strength * bench.rate))

    def measure(record: Record, rng: Generator) -> Record:
        first = int(rng.integers(n))
        return record | {
            name: record[name][np.maximum((np.arange(record[name].size) - first) // n * n + first, 0)]
            for name in drives(record)
        }

    return Effect({"samples": float(n)}, measure=measure)


@form("unknown")
def belt_skips_teeth(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gerbert 1999 (the belt to the encoder skips a tooth, one way or the other)."""
    size, rate = 0.03 * strength * bench.reach, 0.7

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[bench.place if bench.design == "arm" else 0]
        at = np.sort(rng.uniform(0.0, t[-1], max(3, rng.poisson(rate * t[-1]))))
        steps = np.concatenate([[0.0], np.cumsum(rng.choice([-1.0, 1.0], at.size))])
        return record | {name: record[name] + size * steps[np.searchsorted(at, t)]}

    return Effect({"size": size}, measure=measure)


@form("unknown", also=("payload",), on=SINGLES)
def another_load_each_run(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Swevers, Verdonck and De Schutter 2007 (whatever was to be carried)."""
    size = 0.4 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        factor, n = 1.0 + size * rng.uniform(-1.0, 1.0), plant.body
        return plant.with_body(inertia=n["inertia"] * factor, gravity=n.get("gravity", 0.0) * factor)

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=6, n_test=3, duration=6.0), alter=alter)


@form("unknown", also=("harmonic_force",))
def fan_runs_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lalanne and Ferraris 1998 (an unbalance that runs up: a force whose frequency sweeps)."""
    size, low, high = 0.4 * strength * bench.level, rng.uniform(1.0, 2.0), rng.uniform(6.0, 9.0)

    def path(t: Array, rng: Generator) -> Array:
        share = np.clip(t / bench.duration, 0.0, 1.0)
        return size * np.sin(TURN * (low * t + 0.5 * (high - low) * share * np.maximum(t, 0.0) + rng.random()))

    return _in_time(FORCE_OF_TIME, {"size": size}, path)


@form("unknown", also=("harmonic_force",))
def ship_sways(rng: Generator, strength: float, bench: Bench) -> Effect:
    """From, Gravdahl and Abbeel 2010 (a base that sways)."""
    size, frequency = 0.4 * strength * bench.level, rng.uniform(0.25, 0.6)
    return _in_time(
        FORCE_OF_TIME,
        {"size": size, "frequency": frequency},
        lambda t, rng: size * np.sin(TURN * (frequency * t + rng.random())),
    )


@form("unknown", also=("impacts",))
def hail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rice 1944 (shot noise: pushes of 60 ms of one sign, five a second)."""
    size, sign = 1.0 * strength * bench.level, either_sign(rng)

    def path(t: Array, rng: Generator) -> Array:
        force = np.zeros_like(t)
        for begin in rng.uniform(0.0, t[-1], rng.poisson(5.0 * t[-1])):
            u = (t - begin) / 0.06
            force += np.where((u > 0.0) & (u < 1.0), np.sin(np.pi * np.clip(u, 0.0, 1.0)), 0.0) * rng.exponential(1.0)
        return sign * size * force

    return _in_time(FORCE_OF_TIME, {"size": size}, path)


@form("unknown", also=("correlated_coefficients", "random_coefficients"))
def flutters(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Godet 1984 (third bodies: friction that wanders within strokes)."""
    size, time = 0.3 * strength, rng.uniform(0.1, 0.25)
    return _in_time(
        FACTOR_OF_TIME, {"size": size, "time": time}, lambda t, rng: np.maximum(1.0 + size * _drifting(t, rng, time), 0.1)
    )


@form("unknown", also=("backlash", "joint_compliance", "second_mode"), on=SINGLES)
def worn_coupling(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kim, Rook and Singh 2005 (a gap, and a spring behind it)."""
    gap, frequency = 0.02 * strength * bench.reach, 5.0 * bench.speed / bench.reach
    return Effect({"half_gap": gap}, alter=lambda plant, _: chained(bench, plant, 0.4, frequency, gap))


@form("unknown", also=("joint_compliance", "second_mode"), on=SINGLES)
def strain_wave(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tuttle and Seering 1996 (a soft gear between the encoder and most of the mass)."""
    frequency = 2.0 * (bench.speed / bench.reach) / np.sqrt(strength)
    return Effect({"frequency": frequency}, alter=lambda plant, _: chained(bench, plant, 0.75, frequency, 0.0))


@form("unknown", also=("temperature_drift", "drive_gain", "drive_gain_change"))
def magnets_warm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sebastian 1995 (magnets that weaken with a temperature that is recorded)."""
    size, start = 0.3 * strength, rng.uniform(0.0, 1.0)

    def celsius(t: Array) -> Array:
        return 30.0 + 25.0 * np.sin(np.pi * (1.2 * t / bench.duration + start)) ** 2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - size * (celsius(t) - 30.0) / 25.0)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size}, alter=alter, measure=measure)


@form("unknown")
def pump_duty(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a hydrostatic guide whose pump idles a third of the time: friction, not force)."""
    size, period = 0.7 * strength, rng.uniform(0.7, 1.3)
    return _in_time(
        FACTOR_OF_TIME, {"size": size, "period": period}, lambda t, rng: 1.0 + size * ((t / period + rng.random()) % 1.0 < 0.33)
    )


@form("unknown", also=("position_dependent_force", "effective_area"), on=("slide",))
def bore_with_a_step(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mueller and Nau 1998 (a tube of two pieces: the area changes at a place)."""
    size = 0.12 * strength * either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(AREA_AT, lambda q: 1.0 + 0.5 * size * np.tanh(q / (0.05 * bench.reach)))

    return Effect({"size": size}, rig=pressurised, alter=alter)


@form("unknown", on=("thrown",))
def table_shakes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reznik and Canny 1998 (a plate that vibrates: each slide meets another part of the wave)."""
    size = 0.5 * strength

    def law(rng: Generator) -> Throw:
        length, phase = 0.11, rng.uniform(0.0, TURN)
        return Throw(lambda v, x: 0.26 * (1.0 + size * np.sin(TURN * x / length + phase)))

    return Effect({"size": size}, law=law)


@form("unknown", also=("harmonic_force",), on=JOINTS)
def cable_carrier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Irvine 1981 (a carrier that swings after the joint in its own time: two tones that no column tells)."""
    size, frequency = 0.35 * strength * bench.level, rng.uniform(2.2, 3.6)

    def path(t: Array, rng: Generator) -> Array:
        one, two = rng.random(2)
        return size * (np.sin(TURN * (frequency * t + one)) + 0.7 * np.sin(TURN * (0.618 * frequency * t + two)))

    return _in_time(FORCE_OF_TIME, {"size": size}, path)
