"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there."""

from itertools import pairwise

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def relaxed(x: Array, rows: float) -> Array:
    """What a spring holds whose far end creeps after it, within so many rows."""
    kept = rows / (1.0 + rows)
    return lfilter([kept, -kept], [1.0, -kept], x - x[0])


@form("unknown", also=("viscous_friction", "position_dependent_force"), on=SINGLES)
def rubber_mount_relaxes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ferry 1980 (Maxwell's element beside the joint, rubber that relaxes: a spring to quick motion and a drag to slow one)."""
    stiff, time = 3.0 * strength * bench.level / bench.reach, rng.uniform(0.8, 1.2) * bench.reach / bench.speed

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        held = stiff * relaxed(record[place_of(record, bench)], time / step_of(record))
        return record | {name: record[name] + held / bench.gain}

    return Effect({"stiff": stiff, "time": time}, rig=undeclared, measure=measure)


def stretched(x: Array, most: Array) -> Array:
    """How far springs are stretched that slide along beyond their most, (rows, springs)."""
    z, rows = np.zeros_like(most), np.zeros((x.size, most.size))
    for i, way in enumerate(np.diff(x), 1):
        z = np.clip(z + way, -most, most)
        rows[i] = z
    return rows


@form("unknown", on=SINGLES)
def cable_strands_slide_in_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Iwan 1966 (a bent bundle of cables: strands that stick on each other and slide one after the other from each turn on).

    The force is by the way since the turns, and has a branch of its own inside each loop.
    """
    size, most = 2.5 * strength * bench.level, bench.reach * rng.uniform(0.8, 1.2) * np.array([0.1, 0.2, 0.4, 0.8])

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        pulls = size * np.mean(stretched(record[place_of(record, bench)], most) / most, axis=1)
        return record | {name: record[name] + pulls / bench.gain}

    return Effect({"size": size, "most": float(most[-1])}, rig=undeclared, measure=measure)


@form("unknown", on=("arm",))
def torque_cells_hear_each_other(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Voyles, Morrow and Khosla 1997 (crosstalk: each joint's torque cell shows a share of the other joint's torque)."""
    shares = 0.1 * strength * rng.uniform(0.8, 1.2, 2) * rng.choice([-1.0, 1.0], 2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        one, other = drives(record)
        return record | {one: record[one] + shares[0] * record[other], other: record[other] + shares[1] * record[one]}

    return Effect({"of_elbow": shares[0], "of_shoulder": shares[1]}, rig=undeclared, measure=measure)


@form("unknown", also=("drive_gain", "direction_asymmetry"), on=SINGLES)
def rod_side_has_less_area(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a cylinder with its rod on one side: to pull it needs more pressure than to push, by the ratio of areas).

    The gain is by the sign of the force, whatever the way, the place and the time.
    """
    more, side = strength * rng.uniform(0.4, 0.6), either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] * np.where(side * record[name] < 0.0, 1.0 + more, 1.0)}

    return Effect({"more": more, "side": side}, rig=undeclared, measure=measure)


def usual(bench: Bench) -> float:
    """What the drive gives, at most, in usual motion where the effect sits [N or N m]."""
    weight = bench.numbers.get("gravity_2" if bench.place else "gravity", 0.0)
    return bench.level + weight * np.sin(min(bench.reach, 0.5 * np.pi)) + bench.inertia * bench.speed**2 / bench.reach


@form("unknown", also=("drive_gain",))
def iron_of_the_motor_saturates(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2001 (iron that saturates: the torque bends off as the current grows, so that each further part costs more)."""
    bends, full = strength * rng.uniform(0.5, 0.7), usual(bench)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] * (1.0 + bends * (record[name] * bench.gain / full) ** 2)}

    return Effect({"bends": bends, "full": full}, rig=undeclared, measure=measure)


@form("unknown")
def spool_overlaps_its_ports(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tao and Kokotovic 1996 (a dead zone: a spool that overlaps its ports has to be moved across before it gives anything).

    What is asked for more goes by the sign of the force and not by that of the motion: braking as well as speeding up.
    """
    zone, narrow = strength * rng.uniform(1.0, 1.4) * bench.level, 0.15 * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] + zone * np.tanh(record[name] * bench.gain / narrow) / bench.gain}

    return Effect({"zone": zone, "narrow": narrow}, rig=undeclared, measure=measure)


@form("unknown", also=("sensor_delay",), on=SINGLES)
def drive_is_stamped_by_an_rc_clock(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Elson, Girod and Estrin 2002 (two loggers started together, that of the drive by a cheap clock which is too fast).

    The drive comes later and later behind the position, from nothing at the start.
    """
    fast = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], drive_of_the_place(record, bench)
        return record | {name: np.interp(t * (1.0 - fast), t, record[name])}

    return Effect({"fast": fast}, rig=undeclared, measure=measure)


@form("unknown", on=HINGES)
def crank_pulls_a_slide_along(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eksergian 1930; Biezeno and Grammel 1939 (a crank with a heavy slide on a long rod: inertia by the crank's angle).

    The slide's kinetic energy is M sin^2(q)/2 q'^2: M sin^2 times the acceleration, and M sin cos times the speed's square.
    """
    heavy, start = 1.2 * strength * bench.inertia, rng.uniform(0.0, np.pi)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        pulls = np.sin(q + start) ** 2 * accelerations(q, step_of(record))
        pulls += 0.5 * np.sin(2.0 * (q + start)) * speed_of(q, record["time [s]"]) ** 2
        return record | {name: record[name] + heavy * pulls / bench.gain}

    return Effect({"heavy": heavy, "start": start}, rig=undeclared, measure=measure)


def pulled(x: Array, holds: Array) -> Array:
    """Way since something was last caught; it springs free at each of these ways in turn, and is caught there anew."""
    caught, i, ways = x[0], 0, np.empty_like(x)
    for row, place in enumerate(x):
        if abs(place - caught) > holds[i % holds.size]:
            caught, i = place, i + 1
        ways[row] = place - caught
    return ways


@form("unknown", on=SINGLES)
def hose_catches_and_springs_free(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bowden and Leben 1939 (stick and slip of a hose that trails along: it is caught, stretches, springs free, is caught).

    A sawtooth along the way, each tooth of a length of chance, and the spring's own line back wherever the joint turns.
    """
    size, apart = 2.0 * strength * bench.level, rng.uniform(0.25, 0.35) * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        name = drive_of_the_place(record, bench)
        ways = pulled(record[place_of(record, bench)], apart * rng.uniform(0.5, 1.5, 400))
        return record | {name: record[name] + size * ways / apart / bench.gain}

    return Effect({"size": size, "apart": apart}, rig=undeclared, measure=measure)


@form("unknown", also=("payload",), on=HINGES)
def part_is_held_for_a_while(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil and Dombre 2002 (an arm that grips a part at one time and lays it down at a later one, in each run at others).

    Weight and inertia come and go together, with a person's hand to ease both.
    """
    share, eases = strength * rng.uniform(0.25, 0.35), 0.15

    def measure(record: Record, rng: Generator) -> Record:
        t, name, q = record["time [s]"], drive_of_the_place(record, bench), record[place_of(record, bench)]
        begin, end = rng.uniform(0.15, 0.35) * t[-1], rng.uniform(0.6, 0.85) * t[-1]
        held = np.clip((t - begin) / eases, 0.0, 1.0) - np.clip((t - end) / eases, 0.0, 1.0)
        n = bench.numbers
        asks = n["gravity"] * np.sin(q) + n["mass"] * n["length"] ** 2 * accelerations(q, step_of(record))
        return record | {name: record[name] + share * held * asks / bench.gain}

    return Effect({"share": share, "eases": eases}, rig=undeclared, measure=measure)


@form("unknown", also=("joint_compliance",), on=SINGLES)
def bracket_of_the_sensor_swings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Harris and Piersol 2002 (a reading head on a soft bracket: what the joint's acceleration makes it swing is shown along).

    The position is off by the head's own swing, which rings after each jolt; the motion itself is as it was.
    """
    often, loses = rng.uniform(6.0, 9.0) * bench.speed / bench.reach, 0.06

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        swings = bilinear([-1.0], [1.0, 2.0 * loses * often, often**2], 1.0 / step_of(record))
        return record | {name: record[name] + strength * lfilter(*swings, accelerations(record[name], step_of(record)))}

    return Effect({"often": often, "share": strength}, measure=measure)


@form("unknown", also=("position_dependent_friction", "quadratic_damping"), on=SINGLES)
def absorber_at_the_end_of_the_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """McCloy and Martin 1980 (a hydraulic shock absorber before one end: it drags on the way in, by the square of the speed).

    On the way out it is left behind, and elsewhere nothing drags.
    """
    size, side, at = 15.0 * strength * bench.level, either_sign(rng), rng.uniform(0.1, 0.2) * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), side * record[place_of(record, bench)]
        inwards = np.maximum(speed_of(x, record["time [s]"]) / bench.speed, 0.0)
        drags = size * inwards**2 * np.clip((x - at) / (0.15 * bench.reach), 0.0, 1.0)
        return record | {name: record[name] + side * drags / bench.gain}

    return Effect({"size": size, "side": side, "at": at}, rig=undeclared, measure=measure)


def followed(x: Array, n: Array, distance: float) -> Array:
    """What comes after a load by the way slid, within a distance."""
    y, rows = n[0], np.empty_like(n)
    for i, way in enumerate(np.diff(x, prepend=x[0])):
        y = n[i] + (y - n[i]) * np.exp(-way / distance)
        rows[i] = y
    return rows


@form("unknown", on=("slider",))
def ram_leaks_and_is_pumped_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Linker and Dieterich 1992 (a ram that leaks and is pumped up by hand now and then; friction follows the load in part).

    The coefficient is told by the load that was meant. Of each step a part comes at once and the rest by the way slid.
    """
    leaks, distance, late = 0.012 * strength, 1e-5, 0.35

    def law(rng: Generator) -> RateAndState:
        pumped = np.concatenate([[0.0], np.cumsum(rng.uniform(2.0, 6.0, 100))])

        def added(t: Array, x: Array) -> Array:
            load = -leaks * (t - pumped[np.searchsorted(pumped, t, "right") - 1])
            return 0.6 * ((1.0 - late) * load + late * followed(x, load, distance))

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"leaks": leaks, "distance": distance, "late": late}, law=law)


@form("unknown", on=("thrown",))
def strikes_blocks_at_rest(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Brach 1991 (a block that strikes lighter ones at rest, one after the other, and takes them along).

    Each takes a share of the speed at once, at places that differ from throw to throw; friction is the same before and after.
    """
    rubs, lighter, wide = 0.24, 0.12 * strength, 4e-3

    def law(rng: Generator) -> Throw:
        places = np.cumsum(rng.uniform(0.04, 0.11, 2))
        masses = 1.0 + lighter * np.arange(3)
        logs = [float(np.log(after / before)) for before, after in pairwise(masses)]

        def mu(v: float, x: float) -> float:
            total = rubs
            for place, lost in zip(places, logs, strict=True):
                past = (x - place) / wide
                if abs(past) < 0.5:
                    total += lost * v**2 / (GRAVITY * wide) * (1.0 + np.cos(TURN * past))
            return total

        return Throw(mu, starts=(1.2, 1.6))

    return Effect({"lighter": lighter, "rubs": rubs}, law=law)
