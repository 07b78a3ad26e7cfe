"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def triangle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Menezes, Kishore and Kailas 2006 (a guide that is ground rougher and smoother in turn: a triangle along the stroke)."""
    size, length, start = 0.5 * strength, bench.reach * rng.uniform(0.5, 0.9), rng.uniform(0.0, TURN)
    return friction_at(
        {"size": size, "length": length},
        lambda q: 1.0 + size * 2.0 / np.pi * np.arcsin(np.sin(TURN * q / length + start)),
    )


@form("position_dependent_friction", also=("frictional_lag",), on=("thrown",))
def strip_of_tape(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yu, Bauza, Fazeli and Rodriguez 2016 (a strip of tape across the table: rougher between two edges)."""
    more = 0.8 * strength

    def law(_: Generator) -> Throw:
        return Throw(lambda v, x: 0.26 * (1.0 + more * (0.08 < x < 0.17)))

    return Effect({"more": more}, law=law)


@form("position_dependent_force")
def conical_spring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rodriguez, Paredes and Sartor 2006 (a conical spring that is met at a place, and whose coils come to rest in turn)."""
    size, side, met = 0.8 * strength * bench.level, either_sign(rng), bench.reach * rng.uniform(-0.3, 0.1)

    def force(q: Array) -> Array:
        way = np.clip((side * q - met) / (bench.reach - met), 0.0, 1.15)
        return -side * size * np.log(1.0 - 0.75 * way)

    return force_at({"size": size, "met": met}, force)


@form("quadratic_damping", on=SINGLES)
def hull(rng: Generator, strength: float, bench: Bench) -> Effect:
    """ITTC 1957 (a hull's skin: the square, and a logarithm of the Reynolds number, a million at the highest speed)."""
    size = 0.9 * strength * bench.level

    def drag(u: Array) -> Array:
        return u * u / (np.log10(1.0e6 * u + 1.0e4) - 2.0) ** 2

    return by_speed({"size": size}, lambda v: size * drag(v / bench.speed) / drag(np.ones(1)))


@form("harmonic_force")
def gantry(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lambrechts, Boerlage and Steinbuch 2005 (a gantry on the same frame: it speeds up, coasts, brakes and coasts)."""
    size, frequency = 0.5 * strength * bench.level, rng.uniform(2.2, 3.6)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            wave = np.sin(TURN * frequency * t + start)
            return 0.5 * size * (np.tanh(8.0 * (wave - 0.5)) + np.tanh(8.0 * (wave + 0.5)))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def worn_ends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967; Neale 1995 (a bore that is worn where the piston turns round: wider to both ends of the stroke)."""
    size = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(AREA_AT, lambda q: 1.0 + size * np.minimum((q / bench.reach) ** 4, 1.5))

    return Effect({"size": size}, rig=pressurised, alter=alter)


@form("drive_gain_change", also=("unknown",))
def weaker_half_of_the_track(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gieras, Piech and Tomczuk 2011 (a track of magnets of two batches: beyond a place less force per unit)."""
    loss, side, at = 0.4 * strength, either_sign(rng), bench.reach * rng.uniform(-0.2, 0.2)
    return Effect(
        {"loss": loss, "at": at},
        alter=lambda plant, _: plant.times_at_place(
            GAIN_AT, lambda q: 1.0 - 0.5 * loss * (1.0 + side * np.tanh((q - at) / (0.08 * bench.reach)))
        ),
    )


@form("joint_compliance", also=("second_mode",), on=SINGLES)
def series_elastic(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pratt and Williamson 1995 (an actuator with a spring in line; hardly damped, a fifth of friction at the load)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.8, 1.05) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=frequency, damping=0.03, held=0.2),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def nut_of_a_screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Altintas, Verl, Brecher, Uriarte and Pritschow 2011 (a worn nut: stiff and damped behind its play, a rail that rubs)."""
    gap = 0.04 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.65, frequency=24.0, damping=0.15, held=0.55, half_gap=gap),
    )


@form("payload", on=HINGES)
def long_tool(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil, Gautier and Lemoine 2007 (a tool that reaches out: at 1.4 of the length, so inertia grows more than weight)."""
    share = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, arm = plant.body, share * bench.numbers["mass"], 1.4 * bench.numbers["length"]
        return plant.with_body(inertia=n["inertia"] + mass * arm**2, gravity=n["gravity"] + mass * GRAVITY * arm)

    return Effect({"share": share}, alter=alter)


@form("drive_gain", also=("payload",), on=SINGLES)
def pulley_of_other_teeth(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong, Khatib and Burdick 1986 (a pulley with fewer teeth than was entered: less force per unit, always)."""
    gain = 1.0 - 0.3 * strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("constant_force", also=("direction_asymmetry",))
def bellows_under_vacuum(rng: Generator, strength: float, bench: Bench) -> Effect:
    """O'Hanlon 2003 (a bellows between air and vacuum: 0.7 of friction, always one way, against 0.03 that is stated)."""
    size = 0.7 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))
