"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def rails_cross(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (two rails that are not parallel and cross at a place: tighter in proportion to the way from it)."""
    more, place = 1.1 * strength, bench.reach * rng.uniform(-0.3, 0.3)
    return friction_at(
        {"more": more, "place": place}, lambda q: 1.0 + more * (np.minimum(np.abs(q - place) / bench.reach, 1.4) - 0.4)
    )


@form("position_dependent_friction", also=("velocity_weakening", "frictional_lag"), on=("thrown",))
def worn_where_slides_begin(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1953 (a table that throws have worn where they begin: an exponential approach to what nobody has touched).

    Slides are slow where the table is rough, which a law of the speed, or a memory, says in part.
    """
    more, way = 0.8 * strength, 0.09

    def law(_: Generator) -> Throw:
        return Throw(lambda v, x: 0.24 * (1.0 + more * (1.0 - float(np.exp(-x / way)))), starts=(0.8, 1.6))

    return Effect({"more": more, "way": way}, law=law)


@form("position_dependent_force", on=LINES)
def scissor_lift(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spackman 1989 (a screw under a scissor lift: its load by the cotangent of the scissors' angle)."""
    size, side = 0.8 * strength * bench.level, either_sign(rng)

    def force(q: Array) -> Array:
        base = 0.7 + 0.2 * side * np.clip(q / bench.reach, -1.4, 1.25)
        return side * size * (base / np.sqrt(1.0 - base**2) - 0.98)

    return force_at({"size": size, "side": side}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def diaphragm_leaves_its_cup(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beater 2007 (a diaphragm that rolls in its cup on one area, and beyond the cup's rim spreads: two lines)."""
    size, side, rim = 0.2 * strength, either_sign(rng), bench.reach * rng.uniform(-0.25, 0.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(AREA_AT, lambda q: 1.0 + size * np.clip((side * q - rim) / (bench.reach - rim), 0.0, 1.4))

    return Effect({"size": size, "side": side, "rim": rim}, rig=pressurised, alter=alter)


@form("drive_gain_change", on=LINES)
def rope_winds_on_itself(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Feyrer 2015 (a flat rope that winds on itself: the drum's radius grows, and force per unit is its inverse)."""
    grows = 0.35 * strength * either_sign(rng)
    return Effect(
        {"grows": grows},
        alter=lambda plant, _: plant.times_at_place(
            GAIN_AT, lambda q: 1.0 / (1.0 + grows * np.clip(q / bench.reach, -1.5, 1.5))
        ),
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def wired_in_star(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hendershot and Miller 1994 (a winding that is wired in star and was entered as in delta: 1.73 of the force per unit)."""
    gain = 3.0 ** (0.5 * strength)
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def beam_across_the_pivot(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil and Dombre 2002 (a beam to 1.5 and 1.2 lengths either way: little weight, four times as much inertia by ratio)."""
    share = 0.8 * strength * rng.uniform(0.9, 1.1)
    out, back = 1.5, 1.2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(
            inertia=n["inertia"] + mass * length**2 * (out**3 + back**3) / (3.0 * (out + back)),
            gravity=n["gravity"] + mass * GRAVITY * length * (out - back) / 2.0,
        )

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def air_balancer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beater 2007 (a balancing cylinder behind a pressure regulator: 0.7 of friction, against 0.03 that is stated)."""
    size = 0.7 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def diesel_at_idle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Heywood 1988 (a diesel at idle on the frame: the firing order, half of it and half as much again)."""
    size, frequency = 0.45 * strength * bench.level, rng.uniform(5.0, 7.5)
    low, high = rng.uniform(0.0, TURN, 2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            angle = 0.5 * TURN * frequency * t + start
            return size * (np.sin(2.0 * angle) + 0.45 * np.sin(angle + low) + 0.3 * np.sin(3.0 * angle + high))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=HINGES)
def link_on_cables(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Townsend and Salisbury 1988 (a link on cables from a motor in the base: four fifths of inertia, a third of friction)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.8, frequency=frequency, damping=0.1, held=0.35),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def worn_clevis(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (a cylinder's clevis on a worn pin: three fifths of the mass behind it, on a guide that rubs)."""
    gap = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=28.0, damping=0.1, held=0.35, half_gap=gap),
    )
