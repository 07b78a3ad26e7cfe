"""Load, belt speed or an unknown force vary over time."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array
from tests.discovery.generator.machine import BELT, LOAD, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, either_sign, form

_Wave = Callable[[Array], Array]


def _sine(cycles: Array) -> Array:
    return np.sin(2.0 * np.pi * cycles)


def _square(cycles: Array) -> Array:
    return np.tanh(np.sin(2.0 * np.pi * cycles) / 0.15)


def _triangle(cycles: Array) -> Array:
    return 4.0 * np.abs(cycles % 1.0 - 0.5) - 1.0


def _sawtooth(cycles: Array) -> Array:
    """Slow rise, fast fall, no corner: five partial waves."""
    partial = np.arange(1, 6)[:, None]
    return np.sum(np.sin(2.0 * np.pi * partial * cycles) / partial, axis=0) / 1.5


def _ripple(column: int, amplitude: float, frequency: float, wave: _Wave) -> Effect:
    """A signal times 1 + amplitude wave; every run begins at another phase."""

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine.scaled(column, 1.0 + amplitude * wave(frequency * machine.time + rng.random()))

    return Effect({"amplitude": amplitude, "frequency": frequency}, alter)


@form("normal_load_ripple")
def sinusoidal(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(LOAD, 0.07 * strength, rng.uniform(0.08, 0.4), _sine)


@form("normal_load_ripple")
def square(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(LOAD, 0.06 * strength, rng.uniform(0.06, 0.25), _square)


@form("normal_load_ripple")
def triangular(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(LOAD, 0.08 * strength, rng.uniform(0.08, 0.4), _triangle)


@form("normal_load_ripple")
def fast(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Several waves in a cycle."""
    del rig
    return _ripple(LOAD, 0.08 * strength, rng.uniform(1.5, 3.0), _sine)


@form("belt_speed_ripple")
def belt_sinusoidal(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(BELT, 0.1 * strength, rng.uniform(0.3, 3.0), _sine)


@form("belt_speed_ripple")
def belt_square(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(BELT, 0.08 * strength, rng.uniform(0.2, 0.8), _square)


@form("belt_speed_ripple")
def belt_sawtooth(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    return _ripple(BELT, 0.1 * strength, rng.uniform(0.2, 1.2), _sawtooth)


def _force(rig: Rig, share: float, frequency: float, wave: _Wave) -> Effect:
    amplitude = share * rig.mu_s * rig.normal_force

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine.pushed(amplitude * wave(frequency * machine.time + rng.random()))

    return Effect({"amplitude": amplitude, "frequency": frequency}, alter)


@form("harmonic_force")
def sine(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _force(rig, 0.06 * strength, rng.uniform(0.1, 0.45), _sine)


@form("harmonic_force")
def fast_sine(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Several waves in a cycle."""
    return _force(rig, 0.06 * strength, rng.uniform(1.5, 5.0), _sine)


@form("harmonic_force")
def with_overtones(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _force(rig, 0.06 * strength, rng.uniform(0.15, 0.6), lambda cycles: _sine(cycles) + 0.35 * _sine(2.0 * cycles + 0.2))


def _pulses(machine: Machine, times: Array, impulses: Array, length: float) -> Machine:
    """Half-sine force pulses [N s] of the given length [s]."""
    time = machine.time
    force = np.zeros_like(time)
    for begin, impulse in zip(times, impulses, strict=True):
        inside = (time >= begin) & (time <= begin + length)
        force[inside] += impulse * np.pi / (2.0 * length) * np.sin(np.pi * (time[inside] - begin) / length)
    return machine.pushed(force)


@form("impacts")
def random_kicks(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Short kicks of either sign at random times."""
    jump, rate = 0.8 * strength * rig.slip_speed, rng.uniform(0.3, 0.5)

    def alter(machine: Machine, rng: Generator) -> Machine:
        n = rng.poisson(rate * (machine.time[-1] - machine.start))
        times = np.sort(rng.uniform(machine.start, machine.time[-1], n))
        return _pulses(machine, times, rig.mass * jump * rng.uniform(0.5, 1.0, n) * rng.choice([-1.0, 1.0], n), 0.004)

    return Effect({"velocity_jump": jump, "rate": rate}, alter)


@form("impacts")
def hammer(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Blows of one sign and size, nearly regular."""
    jump, interval, sign = 0.6 * strength * rig.slip_speed, rng.uniform(1.7, 3.1), either_sign(rng)

    def alter(machine: Machine, rng: Generator) -> Machine:
        gaps = interval * (1.0 + 0.15 * rng.standard_normal(round(200.0 / interval)))
        times = machine.start + np.cumsum(gaps)
        times = times[times < machine.time[-1] - 0.1]
        return _pulses(machine, times, np.full(times.size, sign * rig.mass * jump), 0.008)

    return Effect({"velocity_jump": sign * jump, "interval": interval}, alter)
