"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, PRESSURE, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", also=("harmonic_force",))
def water_hammer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Joukowsky 1898 (a valve that shuts now and then, at other times each run: a force that jumps, and rings away).

    One tone, begun anew at times that nobody foresees, and gone between: harmonic only while it lasts.
    """
    size, frequency = 1.6 * strength * bench.level * either_sign(rng), rng.uniform(2.6, 4.0)
    apart, time = 2.2, 0.35

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = apart * (np.arange(40) + rng.uniform(0.1, 0.9, 40))

        def force(t: Array) -> Array:
            return sum(
                size * np.exp(-np.maximum(t - at, 0.0) / time) * np.cos(TURN * frequency * (t - at)) * (t >= at)
                for at in begins[begins < bench.duration]
            )

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("unknown", on=SINGLES)
def encoder_on_a_soft_coupling(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (an encoder that was put on behind a soft coupling: what it shows rings, the joint itself does not).

    The joint seems lighter the faster it shakes, where a link or a second mode would make it seem heavier; nothing is late.
    """
    frequency, damping = bench.speed / bench.reach * rng.uniform(1.0, 1.3) / np.sqrt(strength), 0.06

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        rate, w, x = 1.0 / float(np.median(np.diff(t))), TURN * frequency, record[name]
        filtered = bilinear([2.0 * damping * w, w * w], [1.0, 2.0 * damping * w, w * w], fs=rate)
        before = 2.0 * x[0] - x[min(round(3.0 * rate), x.size - 1) : 0 : -1]  # it had been moving before, too
        shown = before[0] + lfilter(*filtered, np.concatenate([before, x]) - before[0])[before.size :]
        return record | {name: shown + bench.sensor.position * rng.standard_normal(t.size)}

    return Effect({"frequency": frequency}, measure=measure)


@form("unknown", on=("slide",))
def gauge_ends_too_early(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (a pressure that a valve switches, and a gauge whose range ends below the highest levels).

    What is beyond the range pushes the piston and is not shown: by no place, speed or wave, and neither late nor stale.
    """
    top, apart, swing = 5.0e5 - 1.0e5 * strength, rng.uniform(0.5, 0.7), 2.6e5
    levels = np.concatenate([rng.permutation(np.linspace(0.0, 1.0, 6)) for _ in range(20)])

    def rig(bench: Bench) -> Bench:
        return replace(pressurised(bench), pressures=(2.6e5, 3.0e5, 2.8e5))

    def course(t: Array) -> Array:
        k = np.clip((t / apart).astype(int), 0, levels.size - 2)
        edge = np.clip((t - k * apart) / 0.04, 0.0, 1.0)  # 40 ms from one level to the next
        return swing * (levels[k] + edge * (levels[k + 1] - levels[k]))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_in_time(PRESSURE, course)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        true = record["pressure [Pa]"] + course(t)
        return record | {"pressure [Pa]": np.minimum(true, top * (1.0 + 1e-3 * rng.standard_normal(t.size)))}

    return Effect({"top": top}, rig=rig, alter=alter, measure=measure)


@form("unknown", on=LINES)
def camera_looks_aslant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hartley and Zisserman 2003 (a camera that looks aslant along the rail, entered as square: what is far seems near).

    A scale that bends along the way: inertia errs by the place, friction does not, and nothing is late or off at times.
    """
    slant = 0.35 * strength * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: record[name] / (1.0 + slant * np.clip(record[name] / bench.reach, -1.5, 1.5))}

    return Effect({"slant": slant}, measure=measure)


@form("unknown", also=("direction_asymmetry", "viscous_friction"))
def mounted_the_other_way_round(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Hunter and Hunter 2005 (a throttle with a check valve that each mounting turns round by chance).

    In each run it drags one way, over the runs on neither side; half of it is a drag that both ways have in the mean.
    """
    size = 1.3 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        def throttled(v: Array) -> Array:
            return size * v / bench.speed

        def checked(v: Array) -> Array:
            return 0.1 * size * v / bench.speed

        return plant.add_by_speed(throttled, checked) if rng.random() < 0.5 else plant.add_by_speed(checked, throttled)

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=6, n_test=3, duration=6.0), alter=alter)


@form("unknown", also=("sensor_delay",), on=SINGLES)
def queue_grows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kleinrock 1975 (positions wait in a queue that is read too slowly: late by nothing at first, by more and more later).

    No delay fits the whole run; in the mean there is one.
    """
    most = 0.09 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        return record | {name: np.interp(t * (1.0 - most / t[-1]), t, record[name])}

    return Effect({"most": most}, measure=measure)


@form("unknown", also=("payload",), on=("arm",))
def forearm_is_longer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mooring, Roth and Driels 1991 (a forearm that is longer than was entered: inertia by the square, weight by the ratio).

    No mass is missing; one further out than the forearm's own, and as much less there, would be the same.
    """
    ratio = 1.0 + 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n = plant.body
        return plant.with_body(
            inertia_2=n["inertia_2"] * ratio**2, coupling=n["coupling"] * ratio, gravity_2=n["gravity_2"] * ratio
        )

    return Effect({"ratio": ratio}, alter=alter)


@form("unknown", also=("random_coefficients",), on=("thrown",))
def turns_into_its_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zmitrowicz 2006 (a block with a grain that is let go at another angle each time, and turns into its way as it slides).

    It begins rougher or smoother by chance and ends alike: by the place in each slide, by none over the slides.
    """
    most, way = 0.9 * strength, 0.07

    def law(rng: Generator) -> Throw:
        grain = most * rng.uniform(0.3, 1.0) * either_sign(rng)
        return Throw(lambda v, x: 0.28 * (1.0 + grain * float(np.exp(-x / way))))

    return Effect({"most": most, "way": way}, law=law)
