"""Effects of the vocabulary in further shapes."""

from dataclasses import replace

import numpy as np
from scipy.signal import cheby1, sosfilt, sosfilt_zi

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import JOINTS, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def ellis(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ellis 1927, in Bird, Stewart and Lightfoot 1960 (the speed as a cubic of the stress)."""
    size, cubic = 0.7 * strength * bench.level, rng.uniform(3.0, 9.0)
    stress = np.linspace(0.0, 2.0, 4001)
    speed = (stress + cubic * stress**3) / (1.0 + cubic)
    return by_speed({"size": size, "cubic": cubic}, lambda v: size * np.interp(v / bench.speed, speed, stress))


@form("velocity_weakening")
def cubic_step(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pennestri, Rossi, Salvini and Valentini 2016 (the cubic step of multibody codes: level at rest and beyond)."""
    size, end = 0.65 * strength * bench.level, bench.speed * rng.uniform(0.3, 0.5)

    def more(v: Array) -> Array:
        u = np.minimum(v / end, 1.0)
        return size * (1.0 - u * u * (3.0 - 2.0 * u))

    return by_speed({"size": size, "end": end}, more)


@form("direction_asymmetry", also=("velocity_weakening",))
def stribeck_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong-Helouvry 1991; Salant 1999 (a lip: one way a constant drag, the other way a film that must form first)."""
    size, knee, forward = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.2, 0.35), rng.random() < 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def level(v: Array) -> Array:
            return size + 0.0 * v

        def film(v: Array) -> Array:
            return size * np.exp(-((v / knee) ** 2))

        return plant.add_by_speed(level, film) if forward else plant.add_by_speed(film, level)

    return Effect({"size": size, "knee": knee, "forward": float(forward)}, alter=alter)


@form("load_dependence", on=("slide",))
def least_friction(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kragelskii, Dobychin and Kombalov 1982 (adhesion falls and ploughing rises with the recorded load: ramps up and down)."""
    period, start = rng.uniform(3.1, 4.3), rng.uniform(0.0, 1.0)

    def share(t: Array) -> Array:
        return 1.15 + 0.85 * 2.0 / np.pi * np.arcsin(np.sin(TURN * (t / period + start)))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def force(t: Array) -> Array:
            u = share(t)  # the coefficient is least at a third of the stated load, and two fifths higher at twice of it
            return u * (1.0 + 0.6 * strength * (0.25 / np.sqrt(u) + 0.75 * u - 1.0))

        return plant.times_in_time(FACTOR_OF_TIME, force)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"period": period}, alter=alter, measure=measure)


@form("position_dependent_friction")
def sleeve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Etsion 2005 (a stretch of the guide with another texture, between two edges)."""
    size, at, half = 0.7 * strength, bench.reach * rng.uniform(-0.25, 0.25), bench.reach * rng.uniform(0.2, 0.3)
    edge = 0.04 * bench.reach

    def factor(q: Array) -> Array:
        return 1.0 + 0.5 * size * (np.tanh((q - at + half) / edge) - np.tanh((q - at - half) / edge))

    return friction_at({"size": size, "at": at, "half": half}, factor)


@form("position_dependent_force")
def centred_by_springs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a spool between preloaded springs: a constant pull to the middle, and a little more with the way)."""
    size, at, edge = 0.6 * strength * bench.level, bench.reach * rng.uniform(-0.2, 0.2), 0.06 * bench.reach
    return force_at(
        {"size": size, "at": at}, lambda q: size * (np.tanh((q - at) / edge) + 0.4 * np.clip((q - at) / bench.reach, -1.3, 1.3))
    )


@form("friction_drift", also=("distance_drift",))
def oiler_comes_on(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Neale 1995 (an oiler that is switched on: nothing until then, then an exponential approach)."""
    loss, at, time = 0.5 * strength, bench.duration * rng.uniform(0.2, 0.35), 0.15 * bench.duration
    return in_time({"loss": loss, "at": at}, lambda t: 1.0 - loss * (1.0 - np.exp(-np.maximum(t - at, 0.0) / time)))


@form("distance_drift", also=("friction_drift",))
def galls_stroke_by_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lin and Cheng 1989 (each stroke leaves the surface as it is for the next one: a hyperbola of their number)."""
    more, half = 0.7 * strength, rng.uniform(8.0, 14.0)
    count = np.arange(2000.0)
    return Effect(
        {"more": more, "half": half}, alter=lambda plant, _: replace(plant, by_stroke=1.0 + more * count / (count + half))
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def lining_fades(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Newcomb and Spurr 1967 (a lining that fades beyond a temperature; a heater on and off, recorded as it is: a saw)."""
    fades, period = rng.uniform(26.0, 29.0), bench.duration * rng.uniform(0.4, 0.55)

    def celsius(t: Array) -> Array:
        return 30.0 + 8.0 * 2.0 / np.pi * np.arcsin(np.sin(TURN * t / period))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 + strength * np.where(celsius(t) < fades, 0.01, -0.055) * (celsius(t) - fades)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"fades": fades, "period": period}, alter=alter, measure=measure)


@form("quadratic_damping", on=SINGLES)
def steep_fan(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ravindra and Mallik 1994 (drag by a power of the speed, here 2.3)."""
    size = 0.9 * strength * bench.level
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 2.3)


@form("sensor_delay", on=SINGLES)
def behind_a_chebyshev_filter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Chebyshev, in Oppenheim and Schafer 1989 (positions behind an anti-alias filter that ripples)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        rate = 1.0 / float(np.median(np.diff(record["time [s]"])))
        sections = cheby1(3, 0.5, 2.1 / delay, fs=TURN * rate, output="sos")
        return record | {name: sosfilt(sections, record[name], zi=sosfilt_zi(sections) * record[name][0])[0]}

    return Effect({"delay": delay}, measure=measure)


@form("harmonic_force")
def feeder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Winkler 1978 (the magnet of a vibratory conveyor beside the joint: half a wave)."""
    size, frequency = 0.7 * strength * bench.level, rng.uniform(3.3, 5.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        return plant.add_in_time(
            FORCE_OF_TIME, lambda t: size * (np.maximum(np.cos(TURN * frequency * t + start), 0.0) - 1.0 / np.pi)
        )

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("stale_samples", also=("sensor_delay",))
def memory_is_swept(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jones, Hosking and Moss 2011 (a logger that sweeps its memory: a pause every 0.35 s or so, all alike)."""
    lasts, apart = 0.06 * strength, rng.uniform(0.3, 0.4)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        starts = np.arange(rng.uniform(0.05, apart), t[-1], apart)
        i = np.searchsorted(starts, t, side="right") - 1
        begin = np.searchsorted(t, starts)[np.maximum(i, 0)]
        held = (i >= 0) & (t - starts[np.maximum(i, 0)] < lasts)
        source = np.where(held, np.minimum(begin, np.arange(t.size)), np.arange(t.size))
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"lasts": lasts, "apart": apart}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def cauchy(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cauchy 1853; Tukey 1960 (one reading of four hundred is off, mostly by little, at times by very much)."""
    size, share = 0.03 * strength * bench.reach, 0.0025

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        n = record[name].size
        off = np.clip(rng.standard_cauchy(n), -15.0, 15.0)
        return record | {name: record[name] + (rng.random(n) < share) * size * off}

    return Effect({"size": size, "share": share}, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_laplace(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Laplace 1774 (a new draw each stroke, whose density falls exponentially to both sides)."""
    spread = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        z = np.clip(rng.laplace(0.0, np.sqrt(0.5), 400), -2.8, 2.8)
        return replace(plant, by_stroke=np.maximum(1.0 + spread * z, 0.1))

    return Effect({"spread": spread}, alter=alter)


@form("drive_gain_change", also=("friction_drift", "unknown"))
def fan_of_the_motor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sebastian 1995 (a motor that is cooled in turns: its constant falls and recovers, along exponentials)."""
    loss, period = 0.35 * strength, bench.duration * rng.uniform(0.35, 0.5)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def warmth(t: Array) -> Array:
            u = np.mod(t / period, 1.0)
            top, ease = 1.0 / (1.0 + np.exp(-2.5)), np.exp(-2.5)
            return np.where(u < 0.5, 1.0 - top * np.exp(-5.0 * u), top * np.exp(-5.0 * (u - 0.5))) - top * ease

        return plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - loss * warmth(t))

    return Effect({"loss": loss, "period": period}, alter=alter)


@form("drive_gain", also=("payload",), on=JOINTS)
def partly_demagnetised(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ruoho, Kolehmainen, Ikaheimo and Arkkio 2010 (magnets that have lost a part: less force per unit, always)."""
    loss = 0.3 * strength
    return Effect({"loss": loss}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - loss + 0.0 * t))


@form("constant_force", also=("direction_asymmetry",), on=("slide", "mjcf_slide", "arm"))
def guide_is_not_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (a guide that slopes: 0.7 of friction, always one way, against 0.03 that is stated)."""
    size = 0.7 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("frictional_lag", on=("slider",))
def composite_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kato and Tullis 2001 (contacts that heal only below a speed, here one of the test, and are renewed by slip)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(8e-6, 1.4e-5)
    critical = 3e-6

    def state(theta: float, v: float, d: float) -> float:
        x = v * theta / d
        return float(np.exp(-v / critical)) - x * float(np.log(max(x, 1e-12)))

    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (1.3 * a,), (distance,), state))


@form("random_coefficients", on=("thrown",))
def triangle_of_throws(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008, 4.3.9 (a triangular density, a new draw each slide)."""
    half = 0.25 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.27 * (1.0 + half * rng.triangular(-1.0, 0.0, 1.0))
        return Throw(lambda v, x: mu)

    return Effect({"half": half}, law=law)
