"""Effects of the vocabulary in further shapes."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import AREA_AT, FACTOR_OF_TIME, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def two_flow_units(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ree and Eyring 1955 (a Newtonian unit, and one that gives way to stress: a line and an inverse hyperbolic sine)."""
    size, knee = 0.8 * strength * bench.level, 0.06 * bench.speed * rng.uniform(0.8, 1.2)
    return by_speed(
        {"size": size, "knee": knee},
        lambda v: size * (0.45 * v / bench.speed + 0.55 * np.arcsinh(v / knee) / np.arcsinh(bench.speed / knee)),
    )


@form("velocity_weakening")
def mixed_film(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gelinck and Schipper 2000 (mixed lubrication: an S in the logarithm of the speed)."""
    size, knee = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.2, 0.3)
    return by_speed({"size": size, "knee": knee}, lambda v: size / (1.0 + (v / knee) ** 3))


@form("quadratic_damping", on=SINGLES)
def orifice_and_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dixon 2007 (an orifice: the square, until a valve opens at two thirds of the highest speed)."""
    size, opens = 1.3 * strength * bench.level, 0.67 * bench.speed

    def drag(v: Array) -> Array:
        u = v / bench.speed
        return size * np.where(v < opens, u**2, (opens / bench.speed) ** 2 + 0.6 * (u - opens / bench.speed))

    return by_speed({"size": size}, drag)


@form("direction_asymmetry", also=("viscous_friction", "constant_force"))
def chevron_packing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mueller and Nau 1998 (lips that are dragged open one way: a level and the root of the speed, the other way neither)."""
    size, forward = 0.4 * strength * bench.level, rng.random() < 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def more(v: Array) -> Array:
            return size * (1.0 + 0.6 * np.sqrt(v / bench.speed))

        def none(v: Array) -> Array:
            return 0.0 * v

        return plant.add_by_speed(more, none) if forward else plant.add_by_speed(none, more)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("frictional_lag")
def hyperbola_of_both(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Barnes 1997; Rabinowicz 1958 (after a reversal structure breaks down by distance and by time, in second order)."""
    size, distance = 1.1 * strength, bench.reach * rng.uniform(0.12, 0.2)
    time = 0.2 * bench.reach / bench.speed * rng.uniform(0.9, 1.1)
    return Effect(
        {"size": size, "distance": distance, "time": time},
        alter=lambda plant, _: plant.with_extra(memory=size, memory_distance=distance, memory_time=time, rational=1.0),
    )


@form("load_dependence", on=("slide",))
def magnetic_rail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Derjaguin 1934 (a rail that holds by itself: friction of the recorded load and a constant pull, two waves in time)."""
    pull = 1.6 * strength
    one, two = rng.uniform(2.2, 2.8), rng.uniform(3.4, 4.4)

    def share(t: Array) -> Array:
        return 1.0 + 0.35 * np.sin(TURN * t / one) + 0.25 * np.sin(TURN * t / two + 1.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: (share(t) + pull) / (1.0 + pull))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"pull": pull}, alter=alter, measure=measure)


@form("load_dependence", on=(*HINGES, "arm"))
def worm_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tomlinson 1929; Archard 1957 (flanks between plastic and elastic: the torque to the power 0.9, from a tenth on)."""
    power = 0.9
    weight = bench.numbers["gravity_2" if bench.place else "gravity"]
    factor = 0.35 * strength * weight ** (1.0 - power) * rng.uniform(0.9, 1.1)
    return Effect(
        {"factor": factor},
        alter=lambda plant, _: plant.with_extra(drive_share=factor, drive_power=power, drive_from=0.1 * weight),
    )


@form("position_dependent_friction")
def balls_return(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Harris 2001 (balls that enter a loaded zone one by one: a rectified sine)."""
    size, length, phase = 1.0 * strength, bench.reach * rng.uniform(0.5, 0.8), rng.uniform(0.0, np.pi)
    return friction_at(
        {"size": size, "length": length}, lambda q: 1.0 + size * (np.abs(np.sin(np.pi * q / length + phase)) - 2.0 / np.pi)
    )


@form("position_dependent_friction")
def dented_race(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sayles and Thomas 1978 (a rough race: six waves along the stroke, as 1/h)."""
    size, length, phases = 0.35 * strength, 1.7 * bench.reach, rng.uniform(0.0, TURN, 6)
    return friction_at(
        {"size": size, "length": length},
        lambda q: np.maximum(
            1.0 + size * sum(np.cos(TURN * (i + 1) * q / length + p) / (i + 1) for i, p in enumerate(phases)), 0
        ),
    )


@form("position_dependent_force")
def magnet_in_the_middle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Moon and Holmes 1979 (a magnet that draws the joint to a place within its stroke)."""
    size, width = 0.9 * strength * bench.level, 0.3 * bench.reach
    at = bench.reach * rng.uniform(-0.2, 0.2)

    def force(q: Array) -> Array:
        u = (q - at) / width
        return size * u * np.exp(0.5 * (1.0 - u * u))

    return force_at({"size": size, "at": at}, force)


@form("position_dependent_force", on=(*HINGES, "arm"))
def reluctance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krause, Wasynczuk and Sudhoff 2002 (a salient rotor beside a magnet: two waves a turn)."""
    size, phase = 0.6 * strength * bench.level, rng.uniform(0.0, TURN)
    return force_at({"size": size, "phase": phase}, lambda q: size * np.sin(2.0 * q + phase))


@form("friction_drift", also=("distance_drift",))
def thins_in_second_order(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mewis and Wagner 2009 (a grease whose structure breaks down as 1/t)."""
    loss, half = 0.6 * strength, 0.25 * bench.duration * rng.uniform(0.8, 1.2)
    return in_time({"loss": loss, "half": half}, lambda t: 1.0 - loss * np.maximum(t, 0.0) / (np.maximum(t, 0.0) + half))


@form("distance_drift", also=("friction_drift",))
def wears_evenly(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1953 (a groove that deepens in proportion to the distance)."""
    gain, usual = 0.6 * strength, 0.4 * bench.speed * bench.duration
    return Effect({"gain": gain}, alter=lambda plant, _: plant.with_extra(wear=50.0 * gain, wear_distance=50.0 * usual))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def polymer_bush(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Williams, Landel and Ferry 1955 (a polymer above its transition; a heater that goes on and off, recorded)."""
    shift, on = 0.5 * strength, bench.duration * rng.uniform(0.25, 0.4)

    def celsius(t: Array) -> Array:
        since = np.maximum(t - on, 0.0)
        return 22.0 + 14.0 * (1.0 - np.exp(-np.minimum(since, 4.0) / 2.0)) * np.exp(-np.maximum(since - 4.0, 0.0) / 3.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 10.0 ** (-shift * (celsius(t) - 22.0) / (celsius(t) + 2.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"shift": shift}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_two_grades(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pearson 1894 (a mixture: three strokes of ten run on debris, at random)."""
    more = 0.45 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        grade = np.where(rng.random(400) < 0.3, 1.0 + more, 1.0 - 0.4 * more)
        return replace(plant, by_stroke=grade + 0.04 * rng.standard_normal(400))

    return Effect({"more": more}, alter=alter)


@form("harmonic_force")
def quick_return(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Norton 2011 (a shaper beside the joint: a sine whose phase is skewed)."""
    size, frequency = 0.5 * strength * bench.level, rng.uniform(3.0, 6.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            angle = TURN * frequency * t + start
            return size * np.sin(angle + 0.6 * np.sin(angle))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("drive_gain_change", also=("unknown", "friction_drift"))
def battery_runs_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Shepherd 1965 (a battery: a slow fall of the gain, then a fast one)."""
    loss = 0.4 * strength
    return Effect(
        {"loss": loss},
        alter=lambda plant, _: plant.times_in_time(
            GAIN_OF_TIME,
            lambda t: 1.0 - loss * 0.2 * np.clip(t / bench.duration, 0.0, 1.0) / (1.2 - np.clip(t / bench.duration, 0.0, 1.0)),
        ),
    )


@form("effective_area", also=("position_dependent_force", "unknown"), on=("slide",))
def worn_middle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a bore that is worn where the piston mostly stands: a bump of the area)."""
    size, at, width = 0.2 * strength, bench.reach * rng.uniform(-0.3, 0.3), 0.35 * bench.reach
    return Effect(
        {"size": size, "at": at},
        rig=pressurised,
        alter=lambda plant, _: plant.times_at_place(AREA_AT, lambda q: 1.0 + size * np.exp(-0.5 * ((q - at) / width) ** 2)),
    )


@form("sensor_delay", on=SINGLES)
def sliding_sums(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hogenauer 1981 (three sliding sums in the encoder's converter)."""
    n = max(3, round((0.024 * strength * rng.uniform(0.8, 1.2) * bench.rate + 1.5) / 1.5))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        x = record[name]
        for _ in range(3):
            x = np.convolve(np.concatenate([np.full(n - 1, x[0]), x]), np.ones(n) / n, "valid")
        return record | {name: x}

    return Effect({"delay": 1.5 * (n - 1) / bench.rate}, measure=measure)


@form("stale_samples", also=("sensor_delay",))
def crowded_bus(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gilbert 1960; Nilsson, Bernhardsson and Wittenmark 1998 (spells of 0.25 s in which few telegrams are new)."""
    rate = 2.0 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        n, step = round(0.25 * bench.rate), max(4, round(0.012 * bench.rate))
        source = np.arange(t.size)
        for begin in rng.integers(1, t.size - n - 1, max(3, rng.poisson(rate * t[-1]))):
            source[begin : begin + n] = begin + (np.arange(n) // step) * step
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"rate": rate}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def counter_slips_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a counter that is read while it carries: short by half a power of two, always one way)."""
    size, share = 0.05 * strength * bench.reach, 0.002

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        hit = rng.random(record[name].size) < share
        return record | {name: record[name] - hit * size * rng.choice([1.0, 2.0], hit.size)}

    return Effect({"size": size, "share": share}, measure=measure)


@form("payload", also=("unknown",), on=SINGLES)
def flywheel_behind_a_belt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Smith 2002 (an inerter: inertia without weight that nobody entered)."""
    more = 0.5 * strength
    return Effect({"more": more}, alter=lambda plant, _: plant.with_body(inertia=plant.body["inertia"] * (1.0 + more)))


@form("constant_force", also=("direction_asymmetry", "unknown"))
def hanging_counterweight(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Arakelian and Smith 2005 (a weight on a rope over a pulley: 0.6 of friction, against 0.03 that is stated)."""
    size = 0.6 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))
