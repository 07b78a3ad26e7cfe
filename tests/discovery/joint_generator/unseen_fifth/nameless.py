"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible."""

from dataclasses import replace

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", also=("sensor_delay", "joint_compliance", "second_mode"))
def meter_rings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (a load cell under a heavy bracket: what it shows of the drive rings, lightly damped)."""
    p = TURN * rng.uniform(5.0, 8.0)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, t = drive_of_the_place(record, bench), record["time [s]"]
        x = record[name]
        b, c = bilinear([p * p], [1.0, 0.12 * p, p * p], 1.0 / float(np.median(np.diff(t))))
        rung = np.asarray(lfilter(b, c, x - x[0])) + x[0]
        return record | {name: x + strength * (rung - x)}

    return Effect({"frequency": p / TURN}, measure=measure)


@form("unknown", also=("joint_compliance", "sensor_delay", "payload"), on=SINGLES)
def bracket_yields(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (a motor whose bracket yields under its own force: the encoder reads way that the joint has not gone)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        q, x = positions(record)[0], record[drive_of_the_place(record, bench)]
        return record | {q: record[q] + 0.1 * strength * bench.reach * x / np.quantile(np.abs(x), 0.9)}

    return Effect(measure=measure)


@form("unknown", also=("position_dependent_force",), on=SINGLES)
def scale_is_dented(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fleming 2013 (a scale that was dented at one place: it shows more way there)."""
    at, width = bench.reach * rng.uniform(-0.2, 0.2), bench.reach * rng.uniform(0.09, 0.13)
    size = 0.03 * strength * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: record[name] + size * np.exp(-(((record[name] - at) / width) ** 2))}

    return Effect({"at": at, "width": width, "size": size}, measure=measure)


@form("unknown", also=("drive_gain_change",), on=SINGLES)
def scale_warms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (an analogue position whose sensitivity goes up and down again within each run)."""
    size = 0.3 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, t = positions(record)[0], record["time [s]"]
        return record | {name: record[name] * (1.0 + size * np.sin(0.5 * TURN * t / t[-1]) ** 2)}

    return Effect({"size": size}, measure=measure)


@form("unknown", also=("sensor_delay", "stale_samples"), on=SINGLES)
def buffer_is_synchronised(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Elson, Girod and Estrin 2002 (positions lag by another time after each synchronisation, some twice a second)."""
    most = 0.08 * strength

    def measure(record: Record, rng: Generator) -> Record:
        name, t = positions(record)[0], record["time [s]"]
        times = np.cumsum(rng.exponential(0.6, 200))
        late = most * rng.random(201)
        return record | {name: np.interp(t - late[np.searchsorted(times, t)], t, record[name])}

    return Effect({"most": most}, measure=measure)


@form("unknown", also=("position_dependent_force", "constant_force"), on=("hinge", "mjcf_hinge"))
def homed_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morris 2001 (a hinge whose zero is set by eye before each run, so that its weight pulls by another angle)."""
    spread = 0.45 * strength

    def measure(record: Record, rng: Generator) -> Record:
        off = spread * rng.uniform(-1.0, 1.0)
        return record | {name: record[name] + off for name in positions(record)}

    return Effect({"spread": spread}, rig=lambda bench: replace(bench, n_fit=6, n_test=3, duration=5.0), measure=measure)


@form("unknown", also=("friction_drift", "distance_drift", "correlated_coefficients"), on=("slider",))
def gouge_localises(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Marone 1998 (a gouge that finds a thin layer and loses it again, after distances that nobody foresees)."""
    drop = 0.025 * strength

    def law(rng: Generator) -> RateAndState:
        ends = np.cumsum(rng.exponential(2.5e-5, 400))
        return RateAndState(0.6, 0.0, added=lambda t, x: -drop * np.mod(np.searchsorted(ends, x), 2))

    return Effect({"drop": drop}, law=law)


@form("unknown", also=("random_coefficients", "correlated_coefficients"), on=("thrown",))
def tumbles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stronge 2000 (a block that rocks as it slides, in its own rhythm and from another phase each throw)."""
    size = 0.7 * strength

    def law(rng: Generator) -> Throw:
        length, start = rng.uniform(0.06, 0.12), rng.uniform(0.0, TURN)
        return Throw(lambda v, x: 0.26 * (1.0 + size * float(np.sin(TURN * x / length + start))))

    return Effect({"size": size}, law=law)
