"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FACTOR_AT, GAIN_AT, GAIN_OF_TIME, MASS_OF_TIME, Plant

from .enter import form

TURN = 2.0 * np.pi


def drive_of_the_place(record: Record, bench: Bench) -> str:
    return drives(record)[bench.place if bench.design == "arm" else 0]


@form("unknown", also=("sensor_delay",))
def drive_hears_an_echo(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Paul 2006 (a long cable without a terminator: a share of the drive is shown again 80 ms later)."""
    share, late = 0.3 * strength, 0.08

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], drive_of_the_place(record, bench)
        return record | {name: record[name] + share * np.interp(t - late, t, record[name])}

    return Effect({"share": share}, measure=measure)


@form("unknown", on=SINGLES)
def clock_runs_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rawlings 1993 (a clockwork that is set by its mean: fast when it is wound, slow when it has run down)."""
    size = 0.25 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        true = t + size * t * (t / t[-1] - 1.0)  # when the clock shows t
        return {name: x if name == "time [s]" else np.interp(true, t, x) for name, x in record.items()}

    return Effect({"size": size}, measure=measure)


@form("unknown", also=("stale_samples",))
def archive_keeps_changes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bristol 1990; Miskowicz 2006 (an archive that keeps a position once it has changed by a threshold)."""
    threshold = 0.03 * strength * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        changed = {}
        for name in positions(record):
            x, shown = record[name], np.empty_like(record[name])
            last = x[0]
            for i, value in enumerate(x):
                last = value if abs(value - last) >= threshold else last
                shown[i] = last
            changed[name] = shown
        return record | changed

    return Effect({"threshold": threshold}, measure=measure)


@form("unknown", also=("random_coefficients", "drive_gain"), on=SINGLES)
def amplifier_set_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morris 2001 (an amplifier whose gain is set by hand before each run)."""
    spread = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        factor = 1.0 + spread * rng.uniform(-1.0, 1.0)
        return plant.times_in_time(GAIN_OF_TIME, lambda t: factor + 0.0 * t)

    return Effect({"spread": spread}, rig=lambda bench: replace(bench, n_fit=7, n_test=3, duration=5.0), alter=alter)


@form("unknown", also=("drive_saturation", "drive_gain"))
def meter_bends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ripka 2001 (a Hall sensor whose core saturates: large drives are shown too small, either way)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drive_of_the_place(record, bench)
        most = np.quantile(np.abs(record[name]), 0.99) * (1.4 - 0.8 * strength)
        return record | {name: most * np.tanh(record[name] / most)}

    return Effect(measure=measure)


@form("unknown", also=("payload",), on=SINGLES)
def mass_pulsates(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Meshchersky 1897 (water that is pumped to and fro between the carriage and the frame)."""
    share, period = 0.35 * strength, rng.uniform(1.6, 2.6)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        return plant.times_in_time(MASS_OF_TIME, lambda t: 1.0 + share * np.sin(TURN * t / period + start))

    return Effect({"share": share, "period": period}, alter=alter)


@form("unknown", also=("random_coefficients", "correlated_coefficients"))
def wiped_every_sixth(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Godet 1984 (debris that each stroke adds to, and a wiper that clears it at every sixth)."""
    more = 0.22 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        level = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]) - 2.5
        return replace(plant, by_stroke=1.0 + more * np.roll(level, int(rng.integers(6))))

    return Effect({"more": more}, alter=alter)


@form("unknown", also=("position_dependent_friction",))
def voice_coil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Klippel 2006 (a coil that leaves its magnet: force per command falls to both ends of the stroke)."""
    loss = 0.45 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(GAIN_AT, lambda q: 1.0 - loss * np.minimum((q / bench.reach) ** 2, 1.2))

    return Effect({"loss": loss}, alter=alter)


@form("unknown", also=("position_dependent_friction", "friction_drift"), on=SINGLES)
def lathe_of_two_men(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Hunter and Hunter 2005 (a hidden block: who mounts it strains the guide at one end, or at the other one)."""
    size = 0.7 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        side = 1.0 if rng.random() < 0.5 else -1.0
        return plant.times_at_place(FACTOR_AT, lambda q: 1.0 + size * np.tanh(2.0 * side * q / bench.reach))

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=8, n_test=4, duration=5.0), alter=alter)
