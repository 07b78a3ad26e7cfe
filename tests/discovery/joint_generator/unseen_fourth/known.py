"""Effects of the vocabulary in further shapes."""

import numpy as np
from scipy.signal import bessel, sosfilt, sosfilt_zi
from scipy.special import erf

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def casson(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Casson 1959 (roots of stresses add: a line and a root of the speed)."""
    size, share = 0.8 * strength * bench.level, rng.uniform(0.4, 0.6)
    return by_speed(
        {"size": size, "share": share},
        lambda v: size * (v / bench.speed + 2.0 * np.sqrt(share * v / bench.speed)) / (1.0 + 2.0 * np.sqrt(share)),
    )


@form("velocity_weakening")
def arc_tangent(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Van de Vrande, van Campen and de Kraker 1999 (an arc tangent)."""
    size, knee = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.16)
    return by_speed({"size": size, "knee": knee}, lambda v: size * (1.0 - 2.0 / np.pi * np.arctan(v / knee)))


@form("direction_asymmetry", also=("viscous_friction", "constant_force"))
def pumping_lip(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Salant 1999 (a lip that pumps one way; the other way its film is starved and drags at once, up to a limit)."""
    size, knee, forward = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.2), rng.random() < 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def more(v: Array) -> Array:
            return size * v / np.hypot(v, knee)

        def none(v: Array) -> Array:
            return 0.0 * v

        return plant.add_by_speed(more, none) if forward else plant.add_by_speed(none, more)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("load_dependence", on=("slide",))
def contact_fills(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Persson 2001 (the real area as an error function of the recorded load, which swings by two waves in time)."""
    bend = 1.1 * rng.uniform(0.9, 1.1)
    one, two = rng.uniform(2.0, 2.6), rng.uniform(3.2, 4.2)

    def share(t: Array) -> Array:
        return 1.0 + 0.4 * np.sin(TURN * t / one) + 0.3 * np.sin(TURN * t / two + 1.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: (1.0 - strength) * share(t) + strength * erf(bend * share(t)) / erf(bend)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"bend": bend}, alter=alter, measure=measure)


@form("position_dependent_friction")
def joint_of_two_rails(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hertz 1882; Lodewijks 1996 (two rails of unequal height meet: harder before the place, softer behind it)."""
    size, at, width = 0.7 * strength, bench.reach * rng.uniform(-0.2, 0.2), bench.reach * rng.uniform(0.16, 0.24)

    def factor(q: Array) -> Array:
        u = (q - at) / width
        return np.maximum(1.0 - size * u * np.exp(0.5 * (1.0 - u * u)), 0.1)

    return friction_at({"size": size, "at": at, "width": width}, factor)


@form("position_dependent_force", also=("nonlinear_stiffness",))
def buffers_at_both_ends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hertz 1882; Hunt and Crossley 1975 (a buffer at each end of the stroke: nothing between, then a power of 1.5)."""
    size, begins = 1.2 * strength * bench.level, bench.reach * rng.uniform(0.25, 0.35)

    def force(q: Array) -> Array:
        return size * np.sign(q) * (np.maximum(np.abs(q) - begins, 0.0) / (bench.reach - begins)) ** 1.5

    return force_at({"size": size, "begins": begins}, force)


@form("friction_drift", also=("distance_drift",))
def film_collapses(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Begelinger and de Gee 1974 (a film that collapses: friction rises from one level to the other within a second)."""
    more, at = 0.5 * strength, bench.duration * rng.uniform(0.35, 0.6)
    return in_time({"more": more, "at": at}, lambda t: 1.0 + 0.5 * more * (1.0 + np.tanh((t - at) / 0.4)))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def wax_melts(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bowden and Tabor 1950 (a waxy film that melts within two degrees; a room that is heated and aired, recorded)."""
    loss, melts = 0.55 * strength, rng.uniform(29.0, 31.0)
    period = bench.duration * rng.uniform(0.55, 0.75)

    def celsius(t: Array) -> Array:
        return 30.0 + 6.0 * np.sin(TURN * t / period)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 - loss / (1.0 + np.exp(-(celsius(t) - melts))))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"loss": loss, "melts": melts}, alter=alter, measure=measure)


@form("sensor_delay", on=SINGLES)
def behind_a_bessel_filter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Thomson 1949 (positions behind a filter of third order that delays all tones alike)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        sections = bessel(3, 1.0 / delay, fs=TURN * bench.rate, norm="delay", output="sos")
        return record | {name: sosfilt(sections, record[name], zi=sosfilt_zi(sections) * record[name][0])[0]}

    return Effect({"delay": delay}, measure=measure)


@form("random_coefficients", on=("thrown",))
def junctions_are_counted(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Poisson 1837; Rabinowicz 1965 (another number of junctions in each slide)."""
    step = 0.06 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.25 * (1.0 + step * (min(float(rng.poisson(4.0)), 12.0) - 4.0))
        return Throw(lambda v, x: mu)

    return Effect({"step": step}, law=law)
