"""Effects of the vocabulary: by place; forces; links, numbers and motors."""

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
def rail_is_corrugated_behind_a_weld(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Grassie and Kalousek 1993 (a crane rail that wheels have corrugated behind a weld: a wave that dies away along it)."""
    size, side, weld = 0.6 * strength, either_sign(rng), bench.reach * rng.uniform(-0.75, -0.55)
    wave, dies = bench.reach * rng.uniform(0.32, 0.42), 0.9 * bench.reach

    def factor(q: Array) -> Array:
        behind = np.maximum(side * q - weld, 0.0)
        return 1.0 + size * np.exp(-behind / dies) * np.sin(TURN * behind / wave)

    return friction_at({"size": size, "side": side, "weld": weld, "wave": wave, "dies": dies}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def felt_disc_was_drawn_across(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Preston 1927 (a table that a round felt disc has polished, drawn across it: as much as its chord is long, and no more).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    less, middle, radius = 0.65 * strength, 0.11, 0.07

    def mu(v: float, x: float) -> float:
        return float(0.32 * (1.0 - less * np.sqrt(max(1.0 - ((x - middle) / radius) ** 2, 0.0))))

    return Effect({"less": less}, law=lambda _: Throw(mu, starts=(1.2, 1.6)))


@form("position_dependent_force", on=LINES)
def bridge_sags_under_its_trolley(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Timoshenko 1955 (a trolley on a bridge that sags under it: its path is a^2 b^2, down whose slope its weight pulls)."""
    size, half_span = 1.3 * strength * bench.level, bench.reach * rng.uniform(1.2, 1.4)

    def force(q: Array) -> Array:
        u = np.clip(q / half_span, -1.0, 1.0)
        return size * 1.5 * np.sqrt(3.0) * u * (1.0 - u**2)

    return force_at({"size": size, "half_span": half_span}, force)


def area_of_a_zigzag(out: Array) -> Array:
    """What pressure pulls at in a skin over a zigzag, over how far that is drawn out of its length when flat."""
    return (1.0 - 2.0 * out**2) / np.sqrt(1.0 - out**2)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def muscle_over_a_zigzag(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Li, Vogt, Rus and Wood 2017 (a vacuum muscle, a skin over a folded zigzag: it pulls by the change of its volume)."""
    size, side = 0.28 * strength, either_sign(rng)

    def factor(q: Array) -> Array:
        out = 0.45 + 0.22 * side * np.clip(q / bench.reach, -1.1, 1.1)
        return 1.0 + size * (area_of_a_zigzag(out) / float(area_of_a_zigzag(np.array(0.45))) - 0.9)

    return Effect({"size": size, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", on=SINGLES)
def single_hookes_joint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Duditza 1973 (a motor behind a single Hooke's joint at an angle: the ratio goes to and fro, two waves a turn)."""
    bent, half_turn, start = 0.42 * strength, bench.reach * rng.uniform(0.9, 1.3), rng.uniform(0.0, np.pi)

    def gain(q: Array) -> Array:
        return (1.0 - bent * np.cos(np.pi * q / half_turn + start) ** 2) / np.sqrt(1.0 - bent)

    return Effect(
        {"bent": bent, "half_turn": half_turn, "start": start}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain)
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def cylinder_piped_the_other_way_round(rng: Generator, strength: float, bench: Bench) -> Effect:
    """ISO 7181:1991 (a cylinder of ratio 1.6 that is piped the other way round: its ring pushes, 0.625 of what is stated)."""
    gain = 1.6**-strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def board_in_the_gripper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kubus, Kroeger and Wahl 2008 (a board left in the gripper, along the forearm from the wrist on: both joints bear it)."""
    share, length = 0.4 * strength * rng.uniform(0.9, 1.1), 0.7

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass = plant.body, share * bench.numbers["m2"]
        upper, board = bench.numbers["l1"], length * bench.numbers["l2"]
        middle = bench.numbers["l2"] + 0.5 * board
        return plant.with_body(
            inertia=n["inertia"] + mass * upper**2, gravity=n["gravity"] + mass * GRAVITY * upper,
            inertia_2=n["inertia_2"] + mass * (middle**2 + board**2 / 12.0),
            gravity_2=n["gravity_2"] + mass * GRAVITY * middle, coupling=n["coupling"] + mass * upper * middle,
        )  # fmt: skip

    return Effect({"share": share, "length": length}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def current_sensor_stays_magnetised(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ziegler, Woodward, Iu and Borle 2009 (a current sensor that an overload has left magnetised: its zero is off).

    The amplifier gives what brings its reading to the command, and always 0.65 of friction more, against 0.03 stated.
    """
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


def geneva(turns: Array) -> Array:
    """Acceleration of a Geneva wheel of four slots over the turns of its crank, 1 at most; its slot is met with a jerk."""
    crank, ratio = TURN * (np.mod(turns, 1.0) - 0.5), np.sqrt(0.5)
    engaged = np.abs(crank) <= np.pi / 4.0
    most = 5.40698  # of what follows, at 11.5 degrees before and behind the middle
    return engaged * ratio * (ratio**2 - 1.0) * np.sin(crank) / (1.0 + ratio**2 - 2.0 * ratio * np.cos(crank)) ** 2 / most


@form("harmonic_force")
def geneva_wheel_on_the_frame(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bickford 1972 (a filler on the same frame, whose Geneva wheel moves on once a turn: two short pushes, and a dwell)."""
    size, frequency = 1.3 * strength * bench.level, rng.uniform(1.5, 2.2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * geneva(frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=HINGES)
def limb_in_an_exoskeleton(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jarrasse and Morel 2012 (a limb strapped to an exoskeleton: three fifths of the inertia behind flesh, well damped)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.2, held=0.1),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def stem_of_a_control_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Choudhury, Thornhill and Shah 2005 (a stem with play in its clamp: two fifths of the mass, held by its packing)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15), 14.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.4, frequency=frequency, damping=0.08, held=0.6, half_gap=gap),
    )
