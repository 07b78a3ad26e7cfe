"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import fftconvolve, lfilter, savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_sixteenth.nameless import speeds
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def in_sines(bench: Bench) -> Bench:
    """Undeclared, and without rests and gentle strokes."""
    return replace(undeclared(bench), motion="sines")


@form("unknown")
def inverter_waits_between_switches(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jeong and Park 1991 (dead time of an inverter: a constant part of what is asked for is lost, by the sign of the current).

    It follows the sign of the drive and not of the speed: a braked joint and one that holds its weight have it the other way.
    """
    size, knee = 0.8 * strength * bench.level, rng.uniform(0.1, 0.2) * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] + size * np.tanh(record[name] * bench.gain / knee) / bench.gain}

    return Effect({"size": size, "knee": knee}, rig=undeclared, measure=measure)


def stopped(x: Array, half: float) -> Array:
    """The stop operator: it goes along with x, from 0, within half a width to either side."""
    at, ats = 0.0, np.zeros_like(x)
    for i, way in enumerate(np.diff(x)):
        at = min(max(at + way, -half), half)
        ats[i + 1] = at
    return ats


@form("unknown", on=SINGLES)
def solenoid_of_a_valve_stays_magnetised(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mayergoyz 1991 (hysteresis of a proportional valve's solenoid: a rising force asks for more signal than a falling one).

    It is off by which way the drive last went, wherever the joint is and however it moves; friction knows but the motion.
    """
    size, half = 1.0 * strength * bench.level, rng.uniform(0.3, 0.5) * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] + size * stopped(record[name] * bench.gain, half) / half / bench.gain}

    return Effect({"size": size, "half": half}, rig=undeclared, measure=measure)


@form("unknown", also=("frictional_lag",), on=SINGLES)
def load_cell_creeps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hoffmann 1989 (creep of a load cell in the drive: after a while under load it shows a share more, and later less again).

    A share of the drive follows it by a lag. After each turn that looks like friction that grows with time; but the weight
    and the inertia creep as well.
    """
    share, time = 0.5 * strength, rng.uniform(0.4, 0.8)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        u, kept = record[name], np.exp(-step_of(record) / time)
        crept = u[0] + lfilter([1.0 - kept], [1.0, -kept], u - u[0])
        return record | {name: u + share * crept}

    return Effect({"share": share, "time": time}, rig=undeclared, measure=measure)


@form("unknown", on=SINGLES)
def magnetic_encoder_hears_its_motor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ripka 2001 (a magnet and a Hall chip at the motor's end: the stray field of its current turns what the chip sees).

    The reading errs by the drive times a wave of the place: one way or the other, early or late, and not at all at no load.
    """
    pitch, start = bench.reach * rng.uniform(0.9, 1.3), rng.uniform(0.0, TURN)
    share = 0.2 * strength
    usual = bench.level + bench.inertia * bench.speed**2 / bench.reach + bench.numbers.get("gravity", 0.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, drive = place_of(record, bench), record[drive_of_the_place(record, bench)] * bench.gain
        angle = TURN * record[name] / pitch + start
        stray = share * savgol_filter(drive, 2 * max(2, round(0.01 / step_of(record))) + 1, 2) / usual
        turned = np.angle(1.0 + 1j * stray * np.exp(-1j * angle))
        return record | {name: record[name] + pitch / TURN * turned}

    return Effect({"share": share, "pitch": pitch, "start": start, "usual": usual}, measure=measure)


@form("unknown", also=("sensor_delay",))
def loggers_drift_apart(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mills 1991 (two loggers of clocks of their own, laid over each other by the middle of the run: positions come from one).

    They are early at one end and late at the other, by nothing in the mean; a delay has one half of the run alone.
    """
    faster = 0.008 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        then = t - faster * (t - 0.5 * (t[0] + t[-1]))
        return record | {name: np.interp(then, t, record[name]) for name in positions(record)}

    return Effect({"faster": faster}, measure=measure)


def half_derivative(x: Array, step: float) -> Array:
    """Derivative of order 1/2 of what had its first value for ever before (Gruenwald and Letnikov)."""
    k = np.arange(1, x.size)
    weights = np.cumprod(np.concatenate([[1.0], (k - 1.5) / k]))
    return fftconvolve(x - x[0], weights)[: x.size] / np.sqrt(step)


@form("unknown", also=("viscous_friction",), on=SINGLES)
def plate_drags_its_boundary_layer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stokes 1851 (a plate that moves along in deep oil: the layer that it drags has a memory of all its speeds).

    The force is the derivative of order 1/2 of the speed: a drag in part and a mass in part, the less of either the slower.
    """
    size, usual = 2.5 * strength * bench.level * rng.uniform(0.9, 1.1), np.sqrt(bench.speed / bench.reach)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        drag = size * half_derivative(v, step_of(record)) / (bench.speed * usual)
        return record | {name: record[name] + drag / bench.gain}

    return Effect({"size": size, "usual": usual}, rig=undeclared, measure=measure)


def bouc_wen(x: Array, length: float, grips: float) -> Array:
    """State z of Bouc and Wen, from 0 and within -1 and 1: dz = dx/length (1 - |z| (grips sign(z dx) + 1 - grips))."""
    z, states = 0.0, np.zeros_like(x)
    for i, way in enumerate(np.diff(x)):
        z += way / length * (1.0 - abs(z) * (grips * np.sign(z * way) + 1.0 - grips))
        states[i + 1] = z
    return states


@form("unknown", also=("frictional_lag", "position_dependent_force"), on=SINGLES)
def wire_rope_isolator(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Demetriades, Constantinou and Reinhorn 1993 (a carriage held by wire ropes: their strands slide on each other in turn).

    Loops as wide as the stroke: a spring after a turn, friction after a long way. Friction that lags forgets the stroke
    before, and a force of the place has no loop.
    """
    size, length, grips = 2.0 * strength * bench.level, rng.uniform(0.5, 0.8) * bench.reach, rng.uniform(0.6, 0.9)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        return record | {name: record[name] + size * bouc_wen(x, length, grips) / bench.gain}

    return Effect({"size": size, "length": length, "grips": grips}, rig=undeclared, measure=measure)


@form("unknown", on=HINGES)
def wave_generator_errs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tuttle and Seering 1996 (kinematic error of a harmonic drive: a disc behind it runs ahead and behind along the turn).

    It is at q + e sin(w q), and asks for an inertia by the place and for the square of the speed by the slope of that. Slow
    motion feels nothing of it: no force of the place.
    """
    disc, error = 0.3 * bench.inertia, 0.35 * strength
    pitch, start = bench.reach * rng.uniform(0.35, 0.5), rng.uniform(0.0, TURN)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        angle, a, v = TURN * q / pitch + start, accelerations(q, step_of(record)), speed_of(q, record["time [s]"])
        ratio = 1.0 + error * np.cos(angle)
        asked = disc * ((ratio**2 - 1.0) * a - ratio * error * TURN / pitch * np.sin(angle) * v**2)
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"disc": disc, "error": error, "pitch": pitch, "start": start}, rig=in_sines, measure=measure)


@form("unknown", also=("harmonic_force",), on=SINGLES)
def grinding_wheel_coasts_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rao 2011 (an unbalanced grinding wheel on the carriage, switched off before: bearings slow it evenly until it stands).

    A force whose frequency falls by the time and whose size by the square of that; a harmonic force keeps both.
    """
    size, first, stands = 2.5 * strength * bench.level, rng.uniform(7.0, 9.0), rng.uniform(10.0, 11.5)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            left = np.maximum(1.0 - t / stands, 0.0)
            return size * left**2 * np.cos(start - 0.5 * TURN * first * stands * left**2)

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "first": first, "stands": stands}, rig=undeclared, alter=alter)


def carried(a: Array, step: float, most: float) -> Array:
    """Acceleration of a crate on a carriage of this one: as the carriage, but no more than `most` until it is as fast."""
    ahead, gains = 0.0, np.zeros_like(a)
    for i, wanted in enumerate(a):
        gains[i] = min(max(wanted - ahead / step, -most), most)
        ahead += step * (gains[i] - wanted)
    return gains


@form("unknown", on=LINES)
def crate_slides_on_the_carriage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (a crate that stands on the carriage unfastened: jerked it slides, until it is as fast as the carriage).

    A part of the mass goes along while the carriage is gentle; it lacks when jerked, and pulls or pushes on afterwards.
    """
    crate, most = 0.6 * strength * bench.inertia, rng.uniform(0.2, 0.3) * bench.speed**2 / bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, step = drive_of_the_place(record, bench), step_of(record)
        a = accelerations(record[place_of(record, bench)], step)
        return record | {name: record[name] + crate * (carried(a, step, most) - a) / bench.gain}

    return Effect({"crate": crate, "most": most}, rig=in_sines, measure=measure)


@form("unknown", on=("arm",))
def differential_rubs_in_its_cage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Asada and Cro Granito 1985 (bevel gears of a differential wrist: they rub as one motor turns against the other).

    Friction by the sign of the difference of both speeds, which both drives feel and either one the other way. Friction of
    a joint of its own has nothing of it where both turn alike.
    """
    size, slow = 1.5 * strength * bench.level, 0.02 * bench.speed
    ratio = rng.uniform(0.8, 1.25)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        shoulder, elbow = (speed_of(record[name], record["time [s]"]) for name in positions(record))
        rubs = size * np.tanh((shoulder - ratio * elbow) / slow)
        asked = zip(drives(record), (rubs, -ratio * rubs), strict=True)
        return record | {name: record[name] + more for name, more in asked}

    return Effect({"size": size, "ratio": ratio, "slow": slow}, rig=undeclared, measure=measure)


@form("unknown", also=("position_dependent_friction",), on=("arm",))
def elbow_bends_the_sheath(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kaneko, Yamashita and Tanie 1991 (a tendon of one joint in a sheath that the other joint bends: it rubs as a rope does).

    Friction of the place by the exponential of the other joint's angle. A place of its own has of it what both joints
    happen to share.
    """
    size, mu = 1.2 * strength * bench.level, rng.uniform(0.9, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, bend = drive_of_the_place(record, bench), np.abs(record[positions(record)[1 - bench.place]])
        v = speed_of(record[place_of(record, bench)], record["time [s]"])
        rubs = size * np.expm1(mu * bend / bench.reach) * np.tanh(v / (0.02 * bench.speed))
        return record | {name: record[name] + rubs / bench.gain}

    return Effect({"size": size, "mu": mu}, rig=undeclared, measure=measure)


@form("unknown", on=("slider",))
def servo_of_the_normal_load_rings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Linker and Dieterich 1992 (a normal load that a servo holds: each step of the speed sets it off, and it rings in time).

    It swings about the level that it had, with a period of seconds at any speed: nothing settles along a way, and no speed
    has another friction.
    """
    size, period, side = 0.03 * strength, rng.uniform(1.8, 2.4), either_sign(rng)

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            v, total = speeds(t, x), np.zeros_like(t)
            for row in np.flatnonzero(np.abs(np.diff(np.log(v))) > 0.1) + 1:
                since, kick = t[row:] - t[row], side * size * np.log10(v[row] / v[row - 1])
                total[row:] += kick * np.exp(-since / 1.5) * np.sin(TURN * since / period)
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "period": period, "side": side}, law=law)


@form("unknown", also=("position_dependent_force",), on=("thrown",))
def cord_comes_taut(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wexler 1950 (a block on an elastic cord by which it is fetched back, lying in other loops at each throw).

    From a place on, another one each throw, it is braked by the way beyond: a force of one place fits a few throws.
    """
    pull, rubs = 4.0 * strength, 0.26

    def law(rng: Generator) -> Throw:
        slack = rng.uniform(0.03, 0.2)
        return Throw(lambda _, x: rubs + pull * max(x - slack, 0.0))

    return Effect({"pull": pull, "rubs": rubs}, law=law)
