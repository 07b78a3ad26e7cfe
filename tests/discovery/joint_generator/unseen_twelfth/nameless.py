"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import savgol_filter

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form
from .sensor import speed_of

TURN = 2.0 * np.pi


def place_of(record: Record, bench: Bench) -> str:
    """Column of the position where the effect sits."""
    return positions(record)[bench.place if bench.design == "arm" else 0]


def undeclared(bench: Bench) -> Bench:
    """The joint goes where it did: a controller of which nothing is said makes up for a force, and the drive has it, too."""
    return replace(bench, declared=False)


@form("unknown", also=("payload",), on=HINGES)
def inclinometer_feels_the_swing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016 (an inclinometer on the link for an encoder: it shows where down seems to be, and swings along).

    It errs by the acceleration, is right at even speed, and neither late nor off at times. To first order it is a lack
    of inertia without a lack of weight; no mass has that, yet a number of the mechanism would be so corrected.
    """
    out = strength * min(0.6 * bench.numbers["length"], 0.3 * GRAVITY * bench.reach / bench.speed**2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        step = float(np.median(np.diff(t)))
        window = 2 * max(3, round(0.03 / step)) + 1
        q = record[name]
        v, a = (savgol_filter(q, window, 3, deriv=k, delta=step) for k in (1, 2))
        return record | {name: np.arctan2(GRAVITY * np.sin(q) + out * a, GRAVITY * np.cos(q) + out * v**2)}

    return Effect({"out": out}, measure=measure)


@form("unknown", also=("sensor_delay",), on=LINES)
def rolling_shutter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Meingast, Geyer and Sastry 2005 (a camera that reads its rows one by one: late at one end of the stroke alone).

    By the place it is late by nothing or by 50 ms; a delay of half of it fits the middle.
    """
    most, side = 0.05 * strength, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        row = np.clip(0.5 + 0.5 * side * record[name] / bench.reach, 0.0, 1.0)
        return record | {name: np.interp(t - most * row, t, record[name])}

    return Effect({"most": most, "side": side}, measure=measure)


@form("unknown", also=("stale_samples", "sensor_delay"), on=SINGLES)
def meter_counts_charges(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kirianaki, Yurish, Shpak and Deynega 2002 (a drive's meter that counts charges: the mean over as long as one took).

    A large drive it shows at once, a small one late and seldom; no delay fits, and no reading is lost.
    """
    usual = bench.level + 0.5 * bench.inertia * bench.speed**2 / bench.reach
    charge = strength * usual / bench.gain / 100.0

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, t = drives(record)[0], record["time [s]"]
        step, x = float(np.median(np.diff(t))), record[name]
        shown, now, held, rows = np.empty_like(x), x[0], 0.0, 0
        for i, value in enumerate(x):
            held, rows = held + value * step, rows + 1
            if abs(held) >= charge:
                now, held, rows = held / (rows * step), 0.0, 0
            shown[i] = now
        return record | {name: shown}

    return Effect({"charge": charge}, measure=measure)


@form("unknown", also=("harmonic_force",))
def railway_hums_at_one_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (a railway's supply of 16.7 Hz beside one end of the stroke: the drive's meter hums there, by the place).

    A wave in time whose size the place decides; one of an even size is half of it, and nothing pushes the joint.
    """
    size, side = 1.1 * strength * bench.level / bench.gain, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        name, start = drive_of_the_place(record, bench), rng.uniform(0.0, TURN)
        near = np.clip(0.5 + 0.5 * side * record[place_of(record, bench)] / bench.reach, 0.0, 1.1) ** 2
        return record | {name: record[name] + size * near * np.sin(TURN * 16.7 * record["time [s]"] + start)}

    return Effect({"size": size, "side": side}, measure=measure)


@form("unknown", also=("position_dependent_force",))
def hose_softens_as_it_warms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ferry 1980 (a hose that is stiff and cold at first: a spring that its warm oil softens within each run).

    A force by the place and by the time at once; at any one time it is a spring, of which a ninth is left at the end.
    """
    size, time, rest = 1.5 * strength * bench.level, 0.3 * bench.duration, bench.reach * rng.uniform(-0.3, 0.3)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, soft = drive_of_the_place(record, bench), 0.08 + 0.92 * np.exp(-record["time [s]"] / time)
        pulls = size * soft * (record[place_of(record, bench)] - rest) / bench.reach
        return record | {name: record[name] + pulls / bench.gain}

    return Effect({"size": size, "rest": rest}, rig=undeclared, measure=measure)


@form("unknown", on=("arm",))
def harness_twists_in_the_other_joint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yoon and Mansour 1982 (a harness through both joints: as the other one twists it, it grips this one's more, or less).

    Friction by the other joint's angle: it has no place of its own, no speed and no load that would decide, and no drift.
    """
    more, side = 0.8 * strength, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, t = drive_of_the_place(record, bench), record["time [s]"]
        twisted = np.clip(record[positions(record)[1 - bench.place]] / bench.reach, -1.1, 1.1)
        way = np.tanh(speed_of(record[place_of(record, bench)], t) / (0.02 * bench.speed))
        return record | {name: record[name] + more * side * bench.level * twisted * way}

    return Effect({"more": more, "side": side}, rig=undeclared, measure=measure)


@form("unknown", also=("friction_drift", "distance_drift"), on=("slider",))
def polished_by_its_quickest_step(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Siman-Tov, Aharonov, Boneh and Reches 2015 (a fault that quick slip polishes: its quickest so far decides, for good).

    It weakens with each new highest speed, and a slower one restores nothing; a drift has no steps, a law of the speed
    no memory, and the memory of contacts is renewed by slip.
    """
    size = 0.011 * strength

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            speed = np.diff(x, append=2.0 * x[-1] - x[-2]) * (t.size - 1) / (t[-1] - t[0])
            return -size * np.log(np.maximum.accumulate(speed) / speed[0])

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size}, law=law)


@form("unknown", also=("random_coefficients",), on=("thrown",))
def gathers_dust_or_sheds_it(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Godet 1984 (a block that gathers dust as it slides, or sheds what it had: rougher and rougher, or less, by chance).

    By the way in each slide; over the slides there is no place, and no way, that decides.
    """
    more = 0.5 * strength

    def law(rng: Generator) -> Throw:
        side = either_sign(rng)
        return Throw(lambda v, x: 0.28 * (1.0 + side * more * (min(x, 0.36) - 0.15) / 0.15))

    return Effect({"more": more}, law=law)
