"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form


@form("position_dependent_friction")
def rail_bent_in_an_s(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Timoshenko 1955 (a rail that its bolts have bent in an S, as a beam is: a cubic of the place)."""
    more = 0.65 * strength * either_sign(rng)

    def factor(q: Array) -> Array:
        x = np.clip(q / bench.reach, -1.1, 1.1)
        return 1.0 + 2.5 * more * (x**3 - 0.6 * x)

    return friction_at({"more": more}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def three_boards(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yu, Bauza, Fazeli and Rodriguez 2016 (a table of three boards, of Delrin, of rubber and of plywood: stairs).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    ends, levels = (0.08, 0.18), 0.26 * (1.0 + strength * np.array([-0.25, 0.5, 0.05]))

    def law(_: Generator) -> Throw:
        return Throw(lambda v, x: float(levels[(x > ends[0]) + (x > ends[1])]))

    return Effect({"first": ends[0], "second": ends[1]}, law=law)


@form("position_dependent_force")
def spring_with_a_helper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wahl 1963 (a spring, and from a place on a stiffer helper beside it: two lines)."""
    size, side = strength * bench.level, either_sign(rng)
    rest, met = bench.reach * rng.uniform(-0.2, 0.0), bench.reach * rng.uniform(0.15, 0.3)

    def force(q: Array) -> Array:
        way = side * q
        return side * size * (0.4 * (way - rest) + 1.4 * np.maximum(way - met, 0.0)) / bench.reach

    return force_at({"size": size, "rest": rest, "met": met}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def pleated_muscle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Daerden and Lefeber 2002 (a pleated muscle: pressure pulls by an inverse root of what it has contracted)."""
    size, side = 0.25 * strength, either_sign(rng)

    def factor(q: Array) -> Array:
        contracted = 1.0 + 0.75 * side * np.clip(q / bench.reach, -1.1, 1.1)
        return 1.0 + size * (1.0 / np.sqrt(contracted) - 1.0)

    return Effect({"size": size, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change")
def capacitors_run_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Burke 2000 (a drive fed from large capacitors, whose energy falls evenly: their voltage, and the gain, as a root)."""
    loss = 0.65 * strength * rng.uniform(0.9, 1.1)
    return Effect(
        {"loss": loss},
        alter=lambda plant, _: plant.times_in_time(
            GAIN_OF_TIME, lambda t: np.sqrt(1.0 - loss * np.clip(t / bench.duration, 0.0, 1.0))
        ),
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def tackle_of_two_falls(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Verschoof 2002 (a tackle that is reeved twice and was entered as reeved thrice: two thirds of the force per unit)."""
    gain = (2.0 / 3.0) ** strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def camera_on_the_forearm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Siciliano, Sciavicco, Villani and Oriolo 2009 (a camera half way along the forearm: a quarter of the inertia there)."""
    share, where = 0.9 * strength * rng.uniform(0.9, 1.1), 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, b = plant.body, bench.numbers
        mass, upper, out = share * b["m2"], b["l1"], where * b["l2"]
        return plant.with_body(
            inertia=n["inertia"] + mass * upper**2,
            inertia_2=n["inertia_2"] + mass * out**2,
            coupling=n["coupling"] + mass * upper * out,
            gravity=n["gravity"] + mass * GRAVITY * upper,
            gravity_2=n["gravity_2"] + mass * GRAVITY * out,
        )

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def web_under_tension(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Roisum 1996 (a web that a dancer keeps taut pulls along: 0.65 of friction, against 0.03 that is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def pump_of_three_plungers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ivantysyn and Ivantysynova 2001 (a pump of three plungers on the frame: arches, with a cusp six times a turn)."""
    size, frequency, half = 1.3 * strength * bench.level, rng.uniform(3.5, 6.0), np.pi / 6.0

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)

        def force(t: Array) -> Array:
            angle = 2.0 * half * (np.mod(frequency * t + start, 1.0) - 0.5)
            return size * (np.cos(angle) - np.sin(half) / half) / (1.0 - np.cos(half))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def belt_in_an_h(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sollmann, Jouaneh and Lavender 2010 (a carriage on a belt in an H: a long loop that hardens, and a light rail)."""
    frequency, cubic = bench.speed / bench.reach * rng.uniform(0.8, 1.0) / np.sqrt(strength), 0.3 * bench.reach
    return Effect(
        {"frequency": frequency, "cubic": cubic},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=frequency, damping=0.08, held=0.2, cubic=cubic),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def worm_of_a_rotary_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Weck and Brecher 2006 (a rotary table on a worn worm wheel: stiff flanks in oil, and a table that its bearing holds)."""
    gap = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=22.0, damping=0.2, held=0.45, half_gap=gap),
    )
