"""Effects of the vocabulary as laboratories meet them: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def shaft_bent_and_oval(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Popovic and Goldenberg 1998 (a bent shaft: friction has a wave a turn, and its second harmonic as it is oval)."""
    size, turn = 0.45 * strength, bench.reach * rng.uniform(0.5, 0.9)
    starts = rng.uniform(0.0, TURN, 2)

    def factor(q: Array) -> Array:
        angle = TURN * q / turn
        return 1.0 + size * (np.sin(angle + starts[0]) + 0.4 * np.sin(2.0 * angle + starts[1]))

    return friction_at({"size": size, "turn": turn}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def oiled_part_of_the_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hardy and Doubleday 1922 (a part of the table that was oiled: less than half of its friction, between two soft edges).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    less, begins, ends, edge = 0.6 * strength, 0.08, 0.2, 0.006

    def mu(v: float, x: float) -> float:
        return 0.3 * (1.0 - 0.5 * less * float(np.tanh((x - begins) / edge) - np.tanh((x - ends) / edge)))

    return Effect({"less": less}, law=lambda _: Throw(mu, starts=(1.2, 1.6)))


@form("position_dependent_force")
def iron_core_meets_the_magnets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Otten, de Vries, van Amerongen, Rankers and Gaal 1997 (an iron core that cogs at its magnets: a sine of the place)."""
    size, pitch, start = 0.7 * strength * bench.level, bench.reach * rng.uniform(0.3, 0.6), rng.uniform(0.0, TURN)
    return force_at({"size": size, "pitch": pitch}, lambda q: size * np.sin(TURN * q / pitch + start))


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def diaphragm_over_its_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Andersen 1967 (a diaphragm actuator: its effective area falls along the stroke as a line)."""
    slope, side = 0.2 * strength * rng.uniform(0.9, 1.1), either_sign(rng)

    def factor(q: Array) -> Array:
        return 1.0 - slope * side * np.clip(q / bench.reach, -1.5, 1.5)

    return Effect({"slope": slope, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", also=("friction_drift",), on=SINGLES)
def flux_falls_as_magnets_warm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sebastian 1995 (magnets that warm up: force per unit of current falls to a lower level as an exponential of time)."""
    fall, time = 0.3 * strength, bench.duration * rng.uniform(0.2, 0.35)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - fall * (1.0 - np.exp(-t / time)))

    return Effect({"fall": fall, "time": time}, alter=alter)


@form("drive_gain", also=("payload",), on=SINGLES)
def peak_ampere_taken_for_rms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2001 (a constant per ampere of root mean square, used on peaks: force is less by the root of two)."""
    gain = 2.0 ** (-0.5 * strength)
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def workpiece_in_the_gripper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khosla and Kanade 1985 (a gripper with its workpiece at the arm's end, which the model has not)."""
    mass = 0.55 * strength * rng.uniform(0.9, 1.1) * bench.numbers["m2"]

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, upper, fore = plant.body, bench.numbers["l1"], bench.numbers["l2"]
        return plant.with_body(
            inertia=n["inertia"] + mass * upper**2, gravity=n["gravity"] + mass * GRAVITY * upper,
            inertia_2=n["inertia_2"] + mass * fore**2, gravity_2=n["gravity_2"] + mass * GRAVITY * fore,
            coupling=n["coupling"] + mass * upper * fore,
        )  # fmt: skip

    return Effect({"mass": mass}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def coiled_strip_pulls_evenly(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Votta 1952 (a coiled strip, which pulls as hard at any place: a balancer that nobody entered)."""
    size = 0.6 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def unbalanced_fan_on_the_frame(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1934 (a fan out of balance on the same frame: a sine of its speed of rotation)."""
    size, frequency = 0.5 * strength * bench.level, rng.uniform(5.0, 9.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * np.sin(TURN * frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def slide_behind_a_toothed_belt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ellis and Lorenz 2000 (a toothed belt between motor and slide: a spring with little damping, two thirds behind it)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.9, 1.2) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.65, frequency=frequency, damping=0.05, held=0.3),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def play_of_a_spur_gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin, Galic and Gutman 1997 (a pair of spur gears: a play, and behind it teeth and shaft as a damped spring)."""
    if strength == 0.0:
        return Effect()
    gap = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.65, frequency=20.0, damping=0.1, held=0.2, half_gap=gap),
    )
