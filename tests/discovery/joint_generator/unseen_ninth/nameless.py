"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, PRESSURE, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", also=("constant_force",))
def tared_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morris 2001 (a load cell that is set to zero by hand before each run: off by another constant each time).

    Within a run it is a constant force; over the runs there is none that all have.
    """
    size = 0.65 * strength * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] + size * either_sign(rng) * rng.uniform(0.4, 1.0)}

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=4, n_test=2, duration=7.0), measure=measure)


@form("unknown", also=("sensor_delay",), on=LINES)
def meter_slews(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (an amplifier whose output changes no faster than it can: large steps become ramps).

    What changes slowly is shown at once, so that no delay fits; to one of the drive it is next.
    """
    usual = bench.level + 0.5 * bench.inertia * bench.speed**2 / bench.reach
    fastest = 0.9 / strength * usual * bench.speed / bench.reach / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        name, t = drives(record)[0], record["time [s]"]
        most, x = fastest * float(np.median(np.diff(t))), record[name]
        shown, now = np.empty_like(x), x[0]
        for i, value in enumerate(x):
            now += min(max(value - now, -most), most)
            shown[i] = now
        return record | {name: shown + 0.5 * bench.sensor.drive / bench.gain * rng.standard_normal(t.size)}

    return Effect({"fastest": fastest}, measure=measure)


@form("unknown", also=("position_dependent_force",), on=HINGES)
def potentiometer_is_loaded(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a potentiometer with too small a resistor across its wiper: right at both ends, short between).

    A scale that bends; the weight pulls by another angle than is read, which is a moment by the place, and inertia errs too.
    """
    load, travel = 0.8 * strength, 2.8 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        x = 0.5 + record[name] / travel
        return record | {name: travel * (x / (1.0 + load * x * (1.0 - x)) - 0.5)}

    return Effect({"load": load}, measure=measure)


@form("unknown", also=("sensor_delay",), on=("slide",))
def gauge_behind_a_capillary(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (a pressure that a valve switches, and a gauge behind a capillary that shows it late and smoothed).

    Neither positions nor drives are late; the force of the pressure that is not yet shown depends on time alone.
    """
    lag, apart, swing = 0.3 * strength, rng.uniform(0.45, 0.6), 1.2e5
    levels = rng.uniform(-1.0, 1.0, 400)

    def course(t: Array) -> Array:
        k = np.clip((t / apart).astype(int), 0, levels.size - 2)
        edge = np.clip((t - k * apart) / 0.03, 0.0, 1.0)  # 30 ms from one level to the next
        return swing * (levels[k] + edge * (levels[k + 1] - levels[k]))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_in_time(PRESSURE, course)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        kept = float(np.exp(-float(np.median(np.diff(t))) / lag))
        true = course(t)
        shown = true[0] + lfilter([1.0 - kept], [1.0, -kept], true - true[0])
        return record | {"pressure [Pa]": record["pressure [Pa]"] + shown}

    return Effect({"lag": lag}, rig=pressurised, alter=alter, measure=measure)


@form("unknown", also=("harmonic_force",))
def frame_still_rings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a frame that still rings from what was set down on it before each run: a wave that dies away).

    Harmonic for a second, and gone for most of the run.
    """
    size, frequency, time = 1.4 * strength * bench.level, rng.uniform(1.7, 2.7), 0.2 * bench.duration

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * np.exp(-t / time) * np.cos(TURN * frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("unknown", also=("position_dependent_force", "constant_force"), on=("arm",))
def base_is_tilted(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil and Dombre 2002 (an arm whose base was bolted on aslant: all angles of the shoulder are meant from there).

    Weight pulls at both joints by other angles, at the elbow by both joints' angles; at one place it is a force.
    """
    tilt = 0.25 * strength * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        shoulder = positions(record)[0].removesuffix("_angle [rad]")
        return {name: x + tilt if name.startswith(shoulder) and "[rad]" in name else x for name, x in record.items()}

    return Effect({"tilt": tilt}, measure=measure)


@form("unknown", also=("stale_samples",), on=SINGLES)
def dead_reckoning(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Singhal and Cheriton 1995 (news of the position comes seldom; between, it goes on as straight as it last went).

    No reading is repeated, and none is late as long as nothing turns; it overshoots and jumps back.
    """
    apart = 0.09 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        n = max(4, round(apart / float(np.median(np.diff(t)))))
        first = int(rng.integers(1, n))
        i = np.arange(t.size)
        news = np.maximum((i - first) // n * n + first, 0)
        before = np.maximum(news - n, 0)
        slope = (record[name][news] - record[name][before]) / np.maximum(news - before, 1)
        return record | {name: record[name][news] + slope * (i - news)}

    return Effect({"apart": apart}, measure=measure)


@form("unknown", also=("frictional_lag",), on=("slider",))
def pore_water_needs_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Segall and Rice 1995 (a gouge that swells with speed and draws water in: stronger at once, until the water has come).

    It fades in seconds, whatever was slid; a memory of the way would need other ways at other speeds.
    """
    size, time = 0.012 * strength, rng.uniform(2.0, 3.0)

    def added(t: Array, x: Array) -> Array:
        speed = np.log(np.maximum(np.gradient(x, t), 1e-8) / 1e-6)
        kept = float(np.exp(-float(t[1] - t[0]) / time))
        return size * (speed - speed[0] - lfilter([1.0 - kept], [1.0, -kept], speed - speed[0]))

    return Effect({"size": size, "time": time}, law=lambda _: RateAndState(0.6, 0.0, added=added))
