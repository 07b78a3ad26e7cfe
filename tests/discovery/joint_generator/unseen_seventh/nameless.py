"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, TIME_SPACING, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form

TURN = 2.0 * np.pi


@form("unknown")
def current_transformer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ripka 2001 (a current transformer: what lasts longer than half a second fades from what it shows of the drive).

    What it hides depends on the past of the drive, not on speed, place or load.
    """
    fades, share = 0.5, 0.8 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, step = drive_of_the_place(record, bench), float(np.median(np.diff(record["time [s]"])))
        kept = float(np.exp(-step / fades))
        return record | {name: record[name] - share * lfilter([1.0 - kept], [1.0, -kept], record[name])}

    return Effect({"share": share}, measure=measure)


@form("unknown", also=("direction_asymmetry", "drive_gain_change"))
def half_bridge_shows_less(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mohan, Undeland and Robbins 2003 (two shunts, one a sign, of which one is burnt: drives of one sign are shown too small).

    A gain by the sign of the drive; friction that differs by direction, and a gain that changes, each say a part.
    """
    loss, sign = 0.4 * strength, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        return record | {name: record[name] * np.where(sign * record[name] > 0.0, 1.0 - loss, 1.0)}

    return Effect({"loss": loss, "sign": sign}, measure=measure)


@form("unknown", also=("stale_samples",), on=SINGLES)
def stamped_in_packets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Elson, Girod and Estrin 2002 (rows that come in packets of 60 ms, and are stamped as they are unpacked).

    Time stands still and leaps; a reading that is repeated would stand still as well, though not the drive beside it.
    """
    length, squeezed = 0.06, 1.0 - 0.8 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        n = round(length / float(np.median(np.diff(t))))
        last = np.minimum(np.arange(t.size) // n * n + n - 1, t.size - 1)
        stamps = t[last] + squeezed * (t - t[last])
        return record | {"time [s]": stamps - stamps[0]}

    return Effect({"squeezed": squeezed}, measure=measure)


@form("unknown", also=("position_dependent_force",), on=LINES)
def gauges_are_stitched(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Flack and Hannaford 2005 (two scales in line: beyond a place the second one takes over, with another zero).

    The reading hurries or waits there and no force does; to a force by the place it is next.
    """
    place, off = bench.reach * rng.uniform(-0.25, 0.25), 0.02 * strength * bench.reach * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        beyond = 0.5 * (1.0 + np.tanh((record[name] - place) / (0.05 * bench.reach)))
        return record | {name: record[name] + off * beyond}

    return Effect({"place": place, "off": off}, measure=measure)


@form("unknown", also=("harmonic_force",))
def building_sways(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tajimi 1960; Crandall and Mark 1963 (a floor that sways: a narrow band of chance about 4 Hz).

    For a second it is a harmonic force, though with no phase and no size that it keeps.
    """
    size, frequency, time = 0.4 * strength * bench.level, rng.uniform(3.0, 5.0), 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        kept = float(np.exp(-TIME_SPACING / time))
        n = plant.times.size + 3000
        z, y = (lfilter([np.sqrt(1.0 - kept**2)], [1.0, -kept], rng.standard_normal(n))[3000:] for _ in range(2))
        angle = TURN * frequency * plant.times
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * (z * np.cos(angle) + y * np.sin(angle)) + 0.0 * t)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("unknown", also=("constant_force",))
def somebody_leans(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Hunter and Hunter 2005 (somebody leans on the joint for a fifth of each run, at another time each).

    A force that is there for a spell; while it lasts it is a constant one, over the record it is none.
    """
    size, side = 1.0 * strength * bench.level, either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        span = plant.times[-1]
        begin = span * rng.uniform(0.2, 0.55)

        def force(t: Array) -> Array:
            return 0.5 * side * size * (np.tanh((t - begin) / 0.05) - np.tanh((t - begin - 0.22 * span) / 0.05))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "side": side}, alter=alter)


@form("unknown", on=("slider",))
def pressure_cycles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a servo that lets the load fall slowly and restores it at once, in its own time: a saw in time).

    By the clock, whatever was slid and however fast; no name repeats itself in time at a slider.
    """
    size, period = 0.035 * strength, rng.uniform(7.0, 9.0)

    def added(t: Array, x: Array) -> Array:
        del x
        u = np.mod(t / period, 1.0)
        return size * (0.5 - np.where(u < 0.9, u / 0.9, 10.0 * (1.0 - u)))

    return Effect({"size": size, "period": period}, law=lambda _: RateAndState(0.6, 0.0, added=added))


@form("unknown", also=("random_coefficients", "position_dependent_friction"), on=("thrown",))
def grains_on_the_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fazeli, Kolbert, Tedrake and Rodriguez 2017 (a grain on the table, each time elsewhere: it brakes for three centimetres).

    Each slide has a place and a size of its own; their scatter, and their mean along the way, have names.
    """
    more = 2.0 * strength

    def law(rng: Generator) -> Throw:
        at, size = rng.uniform(0.03, 0.2), more * rng.uniform(0.6, 1.4)
        return Throw(lambda v, x: 0.25 * (1.0 + size * float(np.exp(-(((x - at) / 0.015) ** 2)))))

    return Effect({"more": more}, law=law)
