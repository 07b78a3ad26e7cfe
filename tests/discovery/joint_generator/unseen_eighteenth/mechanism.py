"""Effects of the vocabulary: by place; forces; links, numbers and motors."""

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
def tight_once_a_turn_of_the_screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Popovic and Goldenberg 1998 (a drive with runout: friction waves with each turn, and a quarter as much twice a turn)."""
    size, pitch = 0.45 * strength, bench.reach * rng.uniform(0.4, 0.7)
    first, second = rng.uniform(0.0, TURN, 2)

    def factor(q: Array) -> Array:
        angle = TURN * q / pitch
        return 1.0 + size * (np.sin(angle + first) + 0.25 * np.sin(2.0 * angle + second))

    return friction_at({"size": size, "pitch": pitch}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def smooth_board_then_a_rough_one(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (two boards end to end, the second rougher: a level up to the joint and a higher one behind it).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    size, joint, block = 0.3 * strength, rng.uniform(0.13, 0.18), 0.02

    def mu(v: float, x: float) -> float:
        return 0.28 * (1.0 + size * min(max((x - joint) / block, -1.0), 1.0))

    return Effect({"size": size, "joint": joint}, law=lambda _: Throw(mu, starts=(1.3, 1.7)))


@form("position_dependent_force", on=HINGES)
def cable_loom_pulls_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Timoshenko and Goodier 1970 (a loom of cables through the joint: a spring about its rest, stiffer as it is wound up)."""
    size, rest = 0.8 * strength * bench.level, bench.reach * rng.uniform(-0.3, 0.3)

    def force(q: Array) -> Array:
        wound = (q - rest) / bench.reach
        return size * (0.7 * wound + 0.3 * wound**3)

    return force_at({"size": size, "rest": rest}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def diaphragm_of_a_brake_chamber(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Andersen 1967 (a flat diaphragm: it has less area the further it is pushed out, and loses it faster at the end)."""
    less, side = 0.14 * strength, either_sign(rng)

    def factor(q: Array) -> Array:
        out = np.clip(side * q / bench.reach, -1.2, 1.2)
        return 1.0 - less * (out + 0.3 * out**2)

    return Effect({"less": less, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", on=SINGLES)
def torque_constant_fades_as_it_warms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sebastian 1995 (magnets that warm up under way: less force for the same output, by an exponential approach)."""
    less, time = 0.32 * strength, bench.duration * rng.uniform(0.3, 0.5)

    def gain(t: Array) -> Array:
        return 1.0 - less * (1.0 - np.exp(-t / time))

    return Effect({"less": less, "time": time}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def torque_constant_of_another_winding(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautier and Briot 2014 (a motor entered with the constant of the next winding in its catalogue: 0.7 of it is true)."""
    gain = 0.7**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def gripper_nobody_entered(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil, Gautier and Lemoine 2007 (a gripper at the link's end that the model lacks: its weight and its inertia)."""
    share = 0.42 * strength * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(inertia=n["inertia"] + mass * length**2, gravity=n["gravity"] + mass * GRAVITY * length)

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def weight_on_a_cord(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Atwood 1784 (a light weight on a cord over a pulley, left on the rig: 0.6 of friction, always; 0.03 are stated).

    At a hinge the cord runs off a drum.
    """
    size = 0.6 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def blower_out_of_balance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a blower on the frame that is out of balance: a sine in time, and a fifth of it at twice the rate)."""
    size, frequency = 0.45 * strength * bench.level, rng.uniform(6.0, 10.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        first, second = rng.uniform(0.0, TURN, 2)

        def force(t: Array) -> Array:
            angle = TURN * frequency * t
            return size * (np.sin(angle + first) + 0.2 * np.sin(2.0 * angle + second))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def toothed_belt_gives(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong 1987 (a carriage on a long toothed belt: six tenths of the mass, and half of the friction, behind a spring)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.07, held=0.5),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def spur_gears_with_play(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (spur gears with play: seven tenths of the inertia beyond a dead zone, its bearings rub)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15), 15.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=frequency, damping=0.1, held=0.3, half_gap=gap),
    )
