"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_sixteenth.nameless import speeds
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def along(v: Array, bench: Bench) -> Array:
    """Sign of the motion, continuous through rest."""
    return np.tanh(v / (0.02 * bench.speed))


def peak_since_turn(load: Array, v: Array, slow: float) -> Array:
    """Largest load since the joint last began to go the other way, none of which is as slow as noise."""
    held, way, peaks = 0.0, 0.0, np.empty_like(load)
    for i, (x, speed) in enumerate(zip(load, v, strict=True)):
        turned = abs(speed) > slow and np.sign(speed) != way
        held, way = (x, np.sign(speed)) if turned else (max(held, x), way)
        peaks[i] = held
    return peaks


@form("unknown", also=("load_dependence",), on=SINGLES)
def taper_is_drawn_tight(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kollmann 1984 (a taper that loads draw tight and that only a turn sets free: it rubs by the most since then).

    Friction by a load that is over: high to the end of a stroke after a hard start, low after a soft one.
    """
    size = 1.2 * strength * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        load = np.abs(record[name])
        rubs = size * peak_since_turn(load, v, 0.05 * bench.speed) / np.quantile(load, 0.9) * along(v, bench)
        return record | {name: record[name] + rubs / bench.gain}

    return Effect({"size": size}, rig=undeclared, measure=measure)


@form("unknown", also=("viscous_friction", "position_dependent_friction"), on=LINES)
def screw_whips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Genta 2005 (a long screw that whips: its free end resonates at a speed that falls as the square of its length).

    It rubs most at one speed here and at another there; a friction by the speed, or by the place, has half of it.
    """
    size, side, loses = 0.9 * strength * bench.level, either_sign(rng), 0.2
    critical, free = 0.45 * bench.speed, 2.6 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v, length = speed_of(x, record["time [s]"]), np.maximum(1.0 + side * x / free, 0.3)
        square = (v / critical * length**2) ** 2
        bends = square / np.sqrt((1.0 - square) ** 2 + 4.0 * loses**2 * square)
        return record | {name: record[name] + size * bends * along(v, bench) / bench.gain}

    return Effect({"size": size, "side": side, "critical": critical, "free": free}, rig=undeclared, measure=measure)


@form("unknown", also=("load_dependence", "position_dependent_friction"), on=HINGES)
def load_brake_drags_while_lowering(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Verschoof 2002 (a hoist's load brake: the weight itself sets it, and it drags as that is lowered, never as it is lifted).

    One way on one side of the lowest place and the other way on the other one; half of what a load would do to both ways.
    """
    size = 2.5 * strength * bench.level / np.sin(min(bench.reach, 0.5 * np.pi))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        lowers = np.maximum(-np.sign(np.sin(q)) * along(speed_of(q, record["time [s]"]), bench), 0.0)
        return record | {name: record[name] - size * np.sin(q) * lowers / bench.gain}

    return Effect({"size": float(size)}, rig=undeclared, measure=measure)


@form("unknown", on=HINGES)
def friction_drive_creeps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kalker 1990 (a friction wheel creeps by the torque that it passes on; the encoder is at the motor and gains that way).

    It errs by all that was driven so far: up under a weight, down on its other side, with the way and not with time.
    """
    creep = 0.08 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = place_of(record, bench), record[place_of(record, bench)]
        torque = record[drive_of_the_place(record, bench)] * bench.gain / bench.numbers["gravity"]
        gains = np.cumsum(torque * np.abs(speed_of(q, record["time [s]"]))) * step_of(record)
        return record | {name: q + creep * gains}

    return Effect({"creep": creep}, rig=undeclared, measure=measure)


@form("unknown", on=(*HINGES, "arm"))
def flux_follows_the_load(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kirschen, Novotny and Lipo 1985 (an induction motor that saves losses: its flux follows the load, and late).

    The current of the same torque is up to some times as large after rest as after work; no place and no time tells which.
    """
    lacks, time = 0.8 * strength, rng.uniform(0.3, 0.45)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        load, kept = np.abs(record[name]), float(np.exp(-step_of(record) / time))
        flux = lfilter([1.0 - kept], [1.0, -kept], load, zi=[kept * load.mean()])[0] / np.quantile(load, 0.95)
        return record | {name: record[name] / (1.0 - lacks * (1.0 - np.minimum(flux, 1.0)))}

    return Effect({"lacks": lacks, "time": time}, rig=undeclared, measure=measure)


def trapped(pumped: Array, step: float, empties: float) -> Array:
    """Pressure between two seals, fed by pumped [1/s]; at 1 it opens a vent, which shuts again at 0.15."""
    kept, pressure, vents, pressures = float(np.exp(-step / empties)), 0.0, False, np.empty_like(pumped)
    for i, fed in enumerate(pumped):
        pressure = pressure * kept if vents else pressure + step * fed
        vents = pressure > (0.15 if vents else 1.0)
        pressures[i] = pressure
    return pressures


@form("unknown", also=("correlated_coefficients",), on=SINGLES)
def seals_trap_pressure(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Flitney 2014 (two rod seals trap what each stroke out drags between them: pressed on more and more, they blow off).

    Friction climbs by the way out and drops at once, wherever that happens; it comes back by no place and no time.
    """
    size, side, way = 2.0 * strength * bench.level, either_sign(rng), bench.reach * rng.uniform(0.9, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        pressure = trapped(np.maximum(side * v, 0.0) / way, step_of(record), 0.03)
        return record | {name: record[name] + size * pressure * along(v, bench) / bench.gain}

    return Effect({"size": size, "side": side, "way": way}, rig=undeclared, measure=measure)


def dragged(v: Array, step: float, limit: float) -> Array:
    """Acceleration of a wheel that friction takes along: that of its shaft, as far as the friction's limit goes."""
    wheel, rates = v[0], np.empty_like(v)
    for i, shaft in enumerate(v):
        rates[i] = min(max((shaft - wheel) / step, -limit), limit)
        wheel += step * rates[i]
    return rates


@form("unknown", also=("payload",), on=SINGLES)
def wheel_behind_a_dry_clutch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lanchester 1914 (his damper: a wheel that the shaft takes along by dry friction, and that slips when it is jerked).

    A mass to the gentle; to the hasty a constant force, by which of both is quicker, and not by the way that the joint goes.
    """
    slips, limit = 1.6 * strength * bench.level, rng.uniform(0.3, 0.4) * bench.speed**2 / bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, step = drive_of_the_place(record, bench), step_of(record)
        v = speed_of(record[place_of(record, bench)], record["time [s]"], 0.03)
        return record | {name: record[name] + slips * dragged(v, step, limit) / limit / bench.gain}

    return Effect({"slips": slips, "limit": limit}, rig=undeclared, measure=measure)


def flag(stretch: Array, soft: float, low: float) -> Array:
    """Pull of a superelastic wire, 1 while it is drawn longer, `low` while it shortens, and elastic between and near rest."""
    set_by, pulls = 0.0, np.empty_like(stretch)
    for i, x in enumerate(stretch):
        set_by = max(set_by, x - soft, 0.0)
        set_by = max(min(set_by, x - low * soft), 0.0)
        pulls[i] = (x - set_by) / soft
    return pulls


@form("unknown", also=("position_dependent_force", "position_dependent_friction"), on=SINGLES)
def superelastic_wires(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Graesser and Cozzarelli 1991 (nickel-titanium wires to either side: two plateaus, the lower one on the way back).

    A force by the place whose loop is a flag: none about the middle, full beyond a yield, and after any turn elastic first.
    """
    size, soft, low = 2.0 * strength * bench.level, rng.uniform(0.15, 0.2) * bench.reach, 0.3

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        return record | {name: record[name] + size * np.sign(x) * flag(np.abs(x), soft, low) / bench.gain}

    return Effect({"size": size, "soft": soft, "low": low}, rig=undeclared, measure=measure)


def heaped(x: Array, flows: float, fills: float) -> Array:
    """Heap before a blade, 0 to 1, as it goes up: none until it meets sludge that has flowed back since [m a row]."""
    edge, gone, heaps = x[0], 0.0, np.zeros_like(x)
    for i in range(1, x.size):
        edge -= flows
        meets = x[i] >= edge
        gone = gone + max(x[i] - max(x[i - 1], edge), 0.0) if meets else 0.0
        edge = max(edge, x[i])
        heaps[i] = min(gone / fills, 1.0) if meets else 0.0
    return heaps


@form("unknown", also=("position_dependent_friction",), on=SINGLES)
def sludge_flows_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gill and Vanden Berg 1968 (a blade in sludge that slowly flows back: it pushes from where that has come to meanwhile).

    Friction on the way out, at either end, and from another place each time, by how long ago the last stroke was so far.
    """
    size, flows, fills = 3.0 * strength * bench.level, rng.uniform(0.3, 0.4) * bench.reach, 0.15 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x, step = drive_of_the_place(record, bench), record[place_of(record, bench)], step_of(record)
        v = along(speed_of(x, record["time [s]"]), bench)
        up, down = (heaped(side * x, flows * step, fills) * np.maximum(side * v, 0.0) for side in (1.0, -1.0))
        return record | {name: record[name] + size * (up - down) / bench.gain}

    return Effect({"size": size, "flows": flows, "fills": fills}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_force",), on=SINGLES)
def anticogging_comes_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Piccoli and Yim 2016 (a table against cogging behind the log, which a bus reads late: right while slow, then behind).

    A wave by the place that grows with the speed and turns its sign with it; a force by the place is the least part of it.
    """
    size, pitch, start = 2.0 * bench.level, bench.reach * rng.uniform(0.3, 0.4), rng.uniform(0.0, TURN)
    late = 1.4 * strength * pitch / (TURN * bench.speed)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name, x = record["time [s]"], drive_of_the_place(record, bench), record[place_of(record, bench)]
        cogs, made_up = (np.cos(TURN * q / pitch + start) for q in (x, np.interp(t - late, t, x)))
        return record | {name: record[name] + size * (cogs - made_up) / bench.gain}

    return Effect({"size": size, "pitch": pitch, "start": start, "late": late}, rig=undeclared, measure=measure)


def behind_a_throttle(u: Array, step: float, rate: float, leak: float) -> Array:
    """Pressure before a throttle: u pumps it up at a rate, the orifice lets out by its root; drawn back it falls to none."""
    pressure, pressures = 0.0, np.empty_like(u)
    for i, pumps in enumerate(u):
        pressure = max(pressure + step * (rate * pumps - leak * np.sqrt(pressure)), 0.0)
        pressures[i] = pressure
    return pressures


@form("unknown", also=("quadratic_damping", "viscous_friction", "direction_asymmetry"), on=SINGLES)
def exhaust_is_throttled_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Burrows 1972 (a pneumatic axis whose exhaust is throttled one way: air is shut in first, and leaves by the root).

    A spring to what is quick and the square of the speed to what lasts, one way; on the way back it pushes until it is let out.
    """
    size, side, rate = 1.6 * strength * bench.level, either_sign(rng), 7.0 * bench.speed / bench.reach
    leak = rate / 2.6

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        pressure = behind_a_throttle(side * v / bench.speed, step_of(record), rate, leak)
        return record | {name: record[name] + side * size * pressure / bench.gain}

    return Effect({"size": size, "side": side, "rate": rate, "leak": leak}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_friction",), on=("arm",))
def tool_polishes_a_plate(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nagata, Kusumoto, Fujimoto and Watanabe 2007 (a tool pressed on an upright plate beside the arm: it rubs back).

    As much whichever way the tip goes; what a joint has of it is a lever by both angles, and its sign is that of both speeds.
    """
    upper, fore = bench.numbers["l1"], bench.numbers["l2"]
    size = 1.5 * strength * bench.level / (upper + fore if bench.place == 0 else fore)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, (shoulder, elbow) = record["time [s]"], positions(record)
        first, both = record[shoulder], record[shoulder] + record[elbow]
        aside, down = upper * np.sin(first) + fore * np.sin(both), upper * np.cos(first) + fore * np.cos(both)
        across, fall = speed_of(aside, t), speed_of(down, t)
        share = size / np.sqrt(across**2 + fall**2 + (0.02 * bench.speed * (upper + fore)) ** 2)
        levers = (down * across - aside * fall, fore * (np.cos(both) * across - np.sin(both) * fall))
        return record | {name: record[name] + share * more for name, more in zip(drives(record), levers, strict=True)}

    return Effect({"size": size}, rig=undeclared, measure=measure)


@form("unknown", also=("velocity_weakening", "frictional_lag"), on=("slider",))
def gel_sets_when_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Di Toro, Goldsby and Tullis 2004 (silica that quick slip shears to a gel, and that sets only once it is much slower).

    Between the two speeds it has either friction, by which of them it passed last; no curve of the speed has two.
    """
    size, high, low, distance = 0.03 * strength, 7e-6, 2e-6, 5e-6

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            flows, share, total = False, 0.0, np.empty_like(t)
            for row, (v, step) in enumerate(zip(speeds(t, x), np.diff(x, prepend=x[0]), strict=True)):
                flows = v > (low if flows else high)
                share += (flows - share) * (1.0 - np.exp(-step / distance))
                total[row] = -size * share
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "high": high, "low": low, "distance": distance}, law=law)


@form("unknown", also=("position_dependent_friction", "position_dependent_force"), on=("thrown",))
def hand_lets_go_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hubbard, de Mestre and Scott 2001 (the hand is still on the block at first: its push fades over a way of chance).

    A push at the start alone, over one to ten centimetres; behind it all slides are alike. One place would err at most of them.
    """
    push, rubs = 0.5 * strength, 0.28

    def law(rng: Generator) -> Throw:
        way = rng.uniform(0.01, 0.1)
        return Throw(lambda v, x: rubs - push * max(1.0 - x / way, 0.0), starts=(1.2, 1.5))

    return Effect({"push": push, "rubs": rubs}, law=law)
