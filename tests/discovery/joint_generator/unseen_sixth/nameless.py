"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FACTOR_ON_SPEED, FORCE_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import STEP_TIME, RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", on=HINGES)
def counts_are_lost_forward(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a counter that misses some lines of the disc, one way alone).

    The zero moves with each stroke, so that the weight pulls by another angle: no force by the place, nor by time.
    """
    share = 0.02 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        forward = np.concatenate([[0.0], np.cumsum(np.maximum(np.diff(record[name]), 0.0))])
        return record | {name: record[name] - share * forward}

    return Effect({"share": share}, measure=measure)


@form("unknown", also=("payload",), on=SINGLES)
def logger_filters_both_ways(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gustafsson 1996 (positions that are smoothed forward and backward: late by nothing, yet flatter).

    What is quick seems smaller than it was; a greater mass makes up for a part of it.
    """
    width = 0.07 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, step = positions(record)[0], float(np.median(np.diff(record["time [s]"])))
        return record | {name: gaussian_filter1d(record[name], width / step, mode="nearest")}

    return Effect({"width": width}, measure=measure)


@form("unknown")
def meter_is_blind_to_braking(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mohan, Undeland and Robbins 2003 (a meter in the supply: what the motor feeds back it shows in part).

    It depends on the sign of the power: neither a gain that changes in time or place, nor friction by speed or by load.
    """
    loss = 0.7 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        drive, place = drive_of_the_place(record, bench), positions(record)[bench.place if bench.design == "arm" else 0]
        window = 2 * max(3, round(0.01 / float(np.median(np.diff(record["time [s]"]))))) + 1
        back = record[drive] * savgol_filter(record[place], window, 2, deriv=1) < 0.0
        return record | {drive: record[drive] * np.where(back, 1.0 - loss, 1.0)}

    return Effect({"loss": loss}, measure=measure)


@form("unknown", also=("viscous_friction", "temperature_drift"))
def oil_by_the_thermometer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (oil whose drag falls with the recorded temperature, while dry friction does not).

    Speed and temperature by a product; each of the two names says a half.
    """
    size, period = 0.8 * strength * bench.level, bench.duration * rng.uniform(0.45, 0.6)

    def celsius(t: Array) -> Array:
        return 27.0 + 9.0 * np.sin(TURN * t / period)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = plant.add_by_speed(lambda v: size * v / bench.speed)
        return plant.times_in_time(FACTOR_ON_SPEED, lambda t: np.exp(-0.11 * (celsius(t) - 27.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size, "period": period}, alter=alter, measure=measure)


@form("unknown", on=("arm",))
def encoders_are_coupled(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tsai 1999 (an elbow's encoder behind a belt that the shoulder turns as well: it shows a share of that angle, too).

    A joint's reading is off by the other joint's place, which no name says.
    """
    share = 0.2 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        shoulder, elbow = positions(record)[:2]
        return record | {elbow: record[elbow] + share * record[shoulder]}

    return Effect({"share": share}, measure=measure)


@form("unknown", also=("harmonic_force",))
def compressor_comes_and_goes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lalanne and Ferraris 1998 (a compressor on the frame that runs a third of the time, each time from another phase).

    While it runs it is a harmonic force; as one force over the whole record it is none.
    """
    size, frequency = 0.7 * strength * bench.level, rng.uniform(6.0, 9.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = np.cumsum(rng.uniform(1.6, 2.8, 40)) - 1.0
        phases = rng.uniform(0.0, TURN, begins.size)

        def force(t: Array) -> Array:
            i = np.maximum(np.searchsorted(begins, t, side="right") - 1, 0)
            on = (t >= begins[i]) & (t < begins[i] + 0.75)
            return size * on * np.sin(TURN * frequency * t + phases[i])

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("unknown", also=("frictional_lag",), on=("slider",))
def frame_rings_at_each_step(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tullis and Weeks 1986 (a frame that rings in the load cell after each change of speed, by time and not by slip).

    A memory that swings; one that decays says a part of it.
    """
    size, frequency = 0.03 * strength, rng.uniform(0.5, 0.8)

    def added(t: Array, x: Array) -> Array:
        del x
        since = np.mod(t, STEP_TIME)
        return size * np.exp(-since / 2.0) * np.sin(TURN * frequency * since)

    return Effect({"size": size, "frequency": frequency}, law=lambda _: RateAndState(0.6, 0.0, added=added))


@form("unknown", also=("random_coefficients", "position_dependent_friction"), on=("thrown",))
def drop_is_wiped_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Persson 2000 (a block on a drop of water that it loses after a way that nobody foresees; then it is dry).

    Each slide has two levels and a place of its own; their scatter, and their mean along the way, have names.
    """
    more = 0.8 * strength

    def law(rng: Generator) -> Throw:
        at = rng.uniform(0.04, 0.24)
        return Throw(lambda v, x: 0.22 * (1.0 + more * (x > at)))

    return Effect({"more": more}, law=law)
