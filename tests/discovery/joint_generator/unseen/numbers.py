"""A number of the mechanism is far off its stated uncertainty; positions come late."""

import numpy as np
from scipy.signal import butter, lfilter, lfilter_zi

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, JOINTS, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import late, positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, GAIN_OF_TIME, Plant

from .enter import form


@form("payload", on=HINGES)
def flywheel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Atkeson, An and Hollerbach 1986 (inertia that nobody entered, balanced: no weight)."""
    factor = 1.0 + 0.6 * strength
    return Effect({"factor": factor}, alter=lambda plant, _: plant.with_body(inertia=plant.body["inertia"] * factor))


@form("payload", on=LINES)
def full_bucket(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil, Gautier and Lemoine 2007 (a load on the carriage)."""
    factor = 1.0 + 0.7 * strength
    return Effect({"factor": factor}, alter=lambda plant, _: plant.with_body(inertia=plant.body["inertia"] * factor))


@form("drive_gain", also=("payload", "unknown"), on=SINGLES)
def weak_magnets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautier and Briot 2014 (a torque constant that is not the catalogue's)."""
    gain = 1.0 - 0.35 * strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("constant_force", also=("direction_asymmetry",), on=LINES)
def tilted(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A rail that is out of level: 0.6 of friction, against 0.03 that is stated."""
    size = 0.6 * strength * bench.level * either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t)

    return Effect({"size": size}, alter=alter)


@form("sensor_delay", on=JOINTS)
def estimator(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Butterworth 1930 (positions behind a low-pass of second order)."""
    delay = max(0.018 * strength * rng.uniform(0.8, 1.2), 4.0 / bench.rate)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        numerator, denominator = butter(2, np.sqrt(2.0) / delay / (2.0 * np.pi), fs=bench.rate)
        rest = lfilter_zi(numerator, denominator)
        return record | {
            name: lfilter(numerator, denominator, record[name], zi=rest * record[name][0])[0] for name in positions(record)
        }

    return Effect({"delay": delay}, measure=measure)


@form("sensor_delay", on=("arm",))
def both_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cervin and others 2003 (one field bus for both encoders)."""
    delay = max(0.016 * strength * rng.uniform(0.8, 1.2), 4.0 / bench.rate)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: late(record[name], record["time [s]"], delay) for name in positions(record)}

    return Effect({"delay": delay}, measure=measure)
