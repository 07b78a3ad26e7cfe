"""Effects outside the vocabulary: the right answer is `unknown`. `also` holds the one name that would be defensible."""

import numpy as np

from tests.discovery.generator.curve import Array, tabulate
from tests.discovery.generator.machine import BELT, LOAD, STATIC, STIFFNESS, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, Record, form
from .randomness import MANY_SLIPS


def _by_slip(parameters: dict[str, float], factors: Array) -> Effect:
    """Both coefficients by slip count; the count at the record's start differs from run to run."""

    def alter(machine: Machine, rng: Generator) -> Machine:
        turned = np.roll(factors, int(rng.integers(factors.size)))
        return machine._replace(static_by_slip=turned, kinetic_by_slip=turned)

    return Effect(parameters, alter)


@form("unknown")
def two_states(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Friction switches between two levels at random slips, and stays there for some."""
    del rig
    half, change = 0.05 * strength, rng.uniform(0.2, 0.35)

    def alter(machine: Machine, rng: Generator) -> Machine:
        state = np.cumsum(rng.random(MANY_SLIPS) < change) % 2
        factors = 1.0 + half * (2.0 * state - 1.0)
        return machine._replace(static_by_slip=factors, kinetic_by_slip=factors)

    return Effect({"half_difference": half, "change_probability": change}, alter)


@form("unknown")
def telegraph(rng: Generator, strength: float, rig: Rig) -> Effect:
    """mu_s alone switches between two levels at random times."""
    del rig
    half, rate = 0.05 * strength, rng.uniform(0.3, 0.6)

    def alter(machine: Machine, rng: Generator) -> Machine:
        switched = (np.cumsum(rng.random(machine.time.size) < rate * 1e-3) % 2).astype(np.float64)
        return machine.scaled(STATIC, 1.0 + half * (2.0 * switched - 1.0))

    return Effect({"half_difference": half, "rate": rate}, alter)


@form("unknown")
def alternating(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Every other slip is harder."""
    del rng, rig
    share = 0.06 * strength
    return _by_slip({"share": share}, np.array([1.0 - share, 1.0 + share]))


@form("unknown")
def slip_count(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Slips number 2, 3 and 5 of every seven are harder."""
    del rig
    share = 0.1 * strength * rng.uniform(0.8, 1.2)
    return _by_slip({"share": share}, 1.0 + share * np.array([0, 0, 1, 1, 0, 1, 0], dtype=np.float64))


@form("unknown")
def every_fifth_slip(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A force that acts during every fifth slip only."""
    force = 0.25 * strength * rig.mu_k * rig.normal_force * rng.uniform(0.8, 1.2)

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine._replace(force_by_slip=np.roll([force, 0.0, 0.0, 0.0, 0.0], int(rng.integers(5))))

    return Effect({"force": force}, alter)


def _bursts(machine: Machine, rng: Generator, rate: float, shortest: float, longest: float) -> Array:
    """1 during random intervals, 0 elsewhere, with ramps of 10 ms."""
    time = machine.time
    level = np.zeros_like(time)
    n = rng.poisson(rate * (time[-1] - time[0]))
    for begin, length in zip(rng.uniform(time[0], time[-1], n), rng.uniform(shortest, longest, n), strict=True):
        level = np.maximum(level, np.clip(np.minimum(time - begin, begin + length - time) / 0.01, 0.0, 1.0))
    return level


@form("unknown", also=("belt_speed_ripple",))
def belt_stalls(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The belt stops for a moment, at random."""
    del rig
    rate, length = rng.uniform(0.4, 0.7), 0.25 * strength

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine.scaled(BELT, 1.0 - _bursts(machine, rng, rate, 0.3 * length, length))

    return Effect({"rate": rate, "longest": length}, alter)


@form("unknown")
def load_dropouts(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The normal force drops for a moment, at random."""
    del rig
    rate, share = rng.uniform(0.5, 0.9), 0.3 * strength

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine.scaled(LOAD, 1.0 - share * _bursts(machine, rng, rate, 0.1, 0.5))

    return Effect({"rate": rate, "share": share}, alter)


@form("unknown")
def stiffness_steps(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The spring changes its stiffness at random times."""
    del rig
    share, rate = 0.08 * strength, rng.uniform(0.08, 0.2)

    def alter(machine: Machine, rng: Generator) -> Machine:
        time = machine.time
        interval = np.cumsum(rng.random(time.size) < rate * 1e-3)
        return machine.scaled(STIFFNESS, 1.0 + share * rng.uniform(-1.0, 1.0, interval[-1] + 1)[interval])

    return Effect({"share": share, "rate": rate}, alter)


@form("unknown", also=("harmonic_force",))
def chirp(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A force whose frequency sweeps up within each run."""
    force = 0.06 * strength * rig.mu_s * rig.normal_force
    low, high = rng.uniform(0.1, 0.2), rng.uniform(1.5, 3.0)

    def alter(machine: Machine, rng: Generator) -> Machine:
        time = machine.time
        share = np.maximum(time, 0.0) / time[-1]
        cycles = low * time + 0.5 * (high - low) * share * np.maximum(time, 0.0)
        return machine.pushed(force * np.sin(2.0 * np.pi * (cycles + rng.random())))

    return Effect({"force": force, "low": low, "high": high}, alter)


@form("unknown", also=("presliding_compliance",))
def creep_burst(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The box creeps on the belt before it breaks away, faster and faster."""
    fastest, begin = 0.6 * strength * rig.belt_velocity, rng.uniform(0.75, 0.85)
    curve = tabulate(lambda share: fastest * np.clip((share - begin) / (1.0 - begin), 0.0, 1.0) ** 2, 0.0, 2.0, 2001)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(creep=curve)

    return Effect({"fastest": fastest, "begin": begin}, alter)


@form("unknown")
def wandering_clock(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The samples are not taken when their time stamps say."""
    del rig
    size, length = 0.03 * strength, rng.uniform(0.4, 1.0)

    def measure(record: Record, rng: Generator) -> Record:
        time = record["time [s]"]
        knots = np.arange(-length, time[-1] + 2.0 * length, length)
        taken = time + np.interp(time, knots, size * rng.standard_normal(knots.size))
        return record | {"position [m]": np.interp(taken, time, record["position [m]"])}

    return Effect({"size": size, "length": length}, measure=measure)


@form("unknown")
def hum(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The mains are in the sensor's cable."""
    del rig
    size, frequency = 25e-6 * strength, float(rng.choice([50.0, 60.0]))

    def measure(record: Record, rng: Generator) -> Record:
        wave = np.sin(2.0 * np.pi * (frequency * record["time [s]"] + rng.random()))
        return record | {"position [m]": record["position [m]"] + size * wave}

    return Effect({"size": size, "frequency": frequency}, measure=measure)


@form("unknown")
def kinetic_regimes(rng: Generator, strength: float, rig: Rig) -> Effect:
    """mu_k alone jumps to a new level every ten to thirty slips."""
    del rng, rig
    sigma = 0.1 * strength

    def alter(machine: Machine, rng: Generator) -> Machine:
        lengths = rng.integers(10, 31, MANY_SLIPS)
        levels = np.repeat(1.0 + sigma * rng.choice([-1.0, -0.4, 0.4, 1.0], MANY_SLIPS), lengths)[:MANY_SLIPS]
        return machine._replace(kinetic_by_slip=levels)

    return Effect({"sigma": sigma}, alter)
