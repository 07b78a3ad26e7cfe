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
def swinging_pitch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Varterasian 1969 (grooves whose pitch swings along the stroke, so that they do not sing)."""
    size, length, start = 0.5 * strength, bench.reach * rng.uniform(0.45, 0.7), rng.uniform(0.0, TURN)

    def factor(q: Array) -> Array:
        u = TURN * q / length
        return 1.0 + size * np.cos(u + 1.1 * np.sin(0.4 * u) + start)

    return friction_at({"size": size, "length": length}, factor)


@form("position_dependent_friction", also=("frictional_lag",), on=("thrown",))
def wet_patch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Persson 2000 (a table that is wet at one place, which every slide crosses)."""
    loss = 0.7 * strength
    return Effect(
        {"loss": loss}, law=lambda _: Throw(lambda v, x: 0.28 * (1.0 - loss * float(np.exp(-(((x - 0.13) / 0.05) ** 2)))))
    )


@form("position_dependent_force")
def gap_that_widens(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Boldea and Nasar 1997 (cogging along a track that is not parallel to the iron: waves that die away to one end)."""
    size, pitch, side = 0.6 * strength * bench.level, bench.reach * rng.uniform(0.3, 0.5), either_sign(rng)
    start = rng.uniform(0.0, TURN)
    return force_at(
        {"size": size, "pitch": pitch},
        lambda q: size * np.exp(-0.9 * side * np.clip(q / bench.reach, -1.2, 1.2)) * np.sin(TURN * q / pitch + start),
    )


@form("quadratic_damping", on=SINGLES)
def rolling_ship(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dalzell 1978 (drag of a hull that rolls: a line and a cubic)."""
    size = 0.9 * strength * bench.level
    return by_speed({"size": size}, lambda v: size * (0.3 * v / bench.speed + 0.7 * (v / bench.speed) ** 3))


@form("harmonic_force")
def planet_gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """McFadden and Smith 1985 (a planet gear beside the joint: teeth that swell once a turn, a line with side bands)."""
    size, turns = 0.45 * strength * bench.level, rng.uniform(0.9, 1.3)

    def alter(plant: Plant, rng: Generator) -> Plant:
        one, two = rng.uniform(0.0, TURN, 2)
        return plant.add_in_time(
            FORCE_OF_TIME,
            lambda t: size * (1.0 + 0.8 * np.cos(TURN * turns * t + one)) * np.cos(6.0 * TURN * turns * t + two),
        )

    return Effect({"size": size, "turns": turns}, alter=alter)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def bell_mouth(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967; Neale 1995 (a bore that opens like a bell at one end of the stroke)."""
    size, side = 0.35 * strength, either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(
            AREA_AT, lambda q: 1.0 + size * np.exp(-(1.0 - side * np.clip(q / bench.reach, -1.2, 1.2)) / 0.3)
        )

    return Effect({"size": size, "side": side}, rig=pressurised, alter=alter)


@form("drive_gain_change", also=("unknown",))
def six_steps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jahns and Soong 1996 (a motor that is switched six times a turn: its constant goes by arcs between the switches)."""
    size, arc = 2.2 * strength, bench.reach * rng.uniform(0.35, 0.6)

    def factor(q: Array) -> Array:
        within = np.cos(np.pi / 3.0 * (np.mod(q / arc + 0.2, 1.0) - 0.5))
        return 1.0 + size * (within - 3.0 / np.pi)

    return Effect({"size": size, "arc": arc}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, factor))


@form("joint_compliance", also=("second_mode",), on=LINES)
def oil_column(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967, chapter 6 (three quarters of the mass behind a column of oil, well damped)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.75, 1.0) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.75, frequency=frequency, damping=0.22, held=0.35),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=SINGLES)
def slack_chain(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (a chain with slack: hard and hardly damped once it is drawn tight)."""
    gap = 0.04 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=22.0, damping=0.07, held=0.4, half_gap=gap),
    )


@form("payload", on=HINGES)
def clamp_half_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Swevers, Verdonck and De Schutter 2007 (a clamp at half of the length: weight by a half, inertia by a quarter)."""
    share = 0.8 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass = plant.body, share * bench.numbers["mass"]
        half = 0.5 * bench.numbers["length"]
        return plant.with_body(inertia=n["inertia"] + mass * half**2, gravity=n["gravity"] + mass * GRAVITY * half)

    return Effect({"share": share}, alter=alter)


@form("drive_gain", also=("payload",), on=SINGLES)
def shunt_of_another_range(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tumanski 2006 (a current that is read across another shunt: more force per unit than is stated, always)."""
    gain = 1.0 + 0.4 * strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("constant_force", also=("direction_asymmetry",))
def hose_on_a_reel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Votta 1952 (a reel whose spring pulls alike at any length: 0.65 of friction, against 0.03 that is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))
