"""Effects of the vocabulary as laboratories meet them: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def bent_shaft_rubs_once_a_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong 1988 (a shaft that is bent, behind a gear: friction waves once a turn of the motor, as at a robot's joint)."""
    size, turn, start = 0.45 * strength, bench.reach * rng.uniform(0.45, 0.8), rng.uniform(0.0, TURN)
    return friction_at({"size": size, "turn": turn}, lambda q: 1.0 + size * np.sin(TURN * q / turn + start))


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def off_the_waxed_part(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bowden and Tabor 1950 (a plank that is waxed up to a line: beyond it friction is higher, over a foot's length).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    more, line, foot = 0.45 * strength, rng.uniform(0.07, 0.1), 0.015

    def mu(v: float, x: float) -> float:
        del v
        return float(0.24 * (1.0 + 0.5 * more * (1.0 + np.tanh((x - line) / foot))))

    return Effect({"more": more, "line": line}, law=lambda _: Throw(mu, starts=(1.2, 1.6)))


@form("position_dependent_force")
def magnets_cog_at_the_slots(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zhu and Howe 2000 (magnets that cog at the slots of their motor: a wave along the stroke and a third of its double)."""
    size, pitch = 0.8 * strength * bench.level, bench.reach * rng.uniform(0.35, 0.6)
    start, second = rng.uniform(0.0, TURN, 2)

    def force(q: Array) -> Array:
        angle = TURN * q / pitch
        return size * (np.sin(angle + start) + 0.33 * np.sin(2.0 * angle + second))

    return force_at({"size": size, "pitch": pitch}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def brake_chamber_at_its_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Acarman, Ozguner, Hatipoglu and Igusky 2000 (a brake chamber: its diaphragm has less area toward the stroke's end)."""
    fall, side, begins = 0.25 * strength, either_sign(rng), rng.uniform(-0.4, -0.2)

    def factor(q: Array) -> Array:
        return 1.0 - fall * (np.clip(side * q / bench.reach - begins, 0.0, 1.5) / (1.0 - begins)) ** 2

    return Effect({"fall": fall, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", on=SINGLES)
def phases_not_of_one_strength(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jahns and Soong 1996 (a brushless motor whose phases differ: its force per ampere waves twice a pole pitch)."""
    size, pitch, start = 0.22 * strength, bench.reach * rng.uniform(0.4, 0.8), rng.uniform(0.0, TURN)

    def gain(q: Array) -> Array:
        return 1.0 + size * np.cos(TURN * q / pitch + start)

    return Effect({"size": size, "pitch": pitch}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def rms_read_as_peak(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krause, Wasynczuk and Sudhoff 2002 (amperes that are effective ones, and a constant for peak ones: root 2 of force)."""
    gain = np.sqrt(2.0) ** strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=SINGLES)
def workpiece_left_in_the_chuck(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil and Dombre 2002 (a workpiece that nobody entered, on the carriage or at the arm's end; the guide is preloaded)."""
    share = 0.45 * strength * rng.uniform(0.85, 1.15)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n = plant.body
        if "gravity" not in n:
            return plant.with_body(inertia=n["inertia"] * (1.0 + share))
        more, arm = share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(inertia=n["inertia"] + more * arm**2, gravity=n["gravity"] + more * GRAVITY * arm)

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def balancer_set_for_another_tool(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautier and Khalil 1990 (a balancer that was set for another tool: an even pull of 0.65 of friction)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def compressor_on_the_same_base(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a compressor on the same base: its piston shakes once a turn, and a quarter of that twice a turn)."""
    size, frequency = 0.7 * strength * bench.level, rng.uniform(4.0, 8.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            angle = TURN * frequency * t + start
            return size * (np.cos(angle) + 0.25 * np.cos(2.0 * angle))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=SINGLES)
def long_belt_to_the_load(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong 1987; Hace, Jezernik and Sabanovic 2007 (two thirds of the inertia behind a long toothed belt that gives)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.15) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.66, frequency=frequency, damping=0.06, held=0.3),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=SINGLES)
def play_of_a_spur_stage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (a stage of spur gears with play: two thirds of the inertia are free between its flanks)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15), 14.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.66, frequency=frequency, damping=0.08, held=0.3, half_gap=gap),
    )
