"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Plant
from tests.discovery.joint_generator.slider import STEP_TIME, RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("unknown", also=("position_dependent_force", "constant_force"))
def hose_is_laid_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Hunter and Hunter 2005 (a hidden block: a hose that is laid anew before each run, and at rest elsewhere then).

    Within a run it is a spring; over the runs its slope is one, and its constant is another one each time.
    """
    slope = 0.6 * strength * bench.level / bench.reach

    def alter(plant: Plant, rng: Generator) -> Plant:
        rest = bench.reach * either_sign(rng) * rng.uniform(0.4, 1.6)
        return plant.add_force_at(lambda q: slope * (q - rest))

    return Effect({"slope": slope}, rig=lambda bench: replace(bench, n_fit=5, n_test=3, duration=6.5), alter=alter)


@form("unknown", on=LINES)
def transformer_beyond_its_range(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doebelin 2004 (a differential transformer that is moved beyond its range: it shows too little toward both ends).

    A scale that bends by a cubic: inertia errs by the place, friction does not, and nothing is late or off at times.
    """
    bend = 0.24 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: record[name] * (1.0 - bend * np.clip(record[name] / bench.reach, -1.2, 1.2) ** 2)}

    return Effect({"bend": bend}, measure=measure)


@form("unknown", on=SINGLES)
def wheel_slips_when_jerked(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Borenstein and Feng 1996 (a measuring wheel that slips while the joint speeds up or brakes beyond a limit).

    It loses way at either end of a stroke and drifts; neither late nor stale, and it comes back to no scale.
    """
    slips, limit = 0.35 * strength, 0.22 * bench.speed**2 / bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        step = float(np.median(np.diff(t)))
        window = 2 * max(3, round(0.02 / step)) + 1
        v, a = (savgol_filter(record[name], window, 3, deriv=k, delta=step) for k in (1, 2))
        lost = slips * np.clip(np.abs(a) / limit - 1.0, 0.0, 1.0) * v * step
        return record | {name: record[name] - np.concatenate([[0.0], np.cumsum(lost[1:])])}

    return Effect({"slips": slips, "limit": limit}, measure=measure)


@form("unknown", also=("sensor_delay",), on=LINES)
def draw_wire_goes_slack(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016 (a draw wire whose spring is weak: it winds up no faster than that, and is pulled out at any speed).

    It comes late on the way back alone, and only on quick ones; no delay fits, to one of the position it is next.
    """
    fastest, side = (0.72 - 0.3 * strength) * bench.speed, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        most, x = fastest * float(np.median(np.diff(t))), side * record[name]
        shown, now = np.empty_like(x), x[0]
        for i, value in enumerate(x):
            now = max(value, now - most)
            shown[i] = now
        return record | {name: side * shown}

    return Effect({"fastest": fastest, "side": side}, measure=measure)


@form("unknown", also=("viscous_friction", "random_coefficients"))
def oil_of_the_day(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (a rig in an unheated hall, of which no gauge tells: its oil drags in each run by another coefficient).

    Dry friction stays; a drag that all runs have is half of it, and a level by chance is not by speed.
    """
    size = 1.6 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        coefficient = size * rng.uniform(0.05, 1.0) / bench.speed
        return plant.add_by_speed(lambda v: coefficient * v)

    return Effect({"size": size}, rig=lambda bench: replace(bench, n_fit=6, n_test=3, duration=6.0), alter=alter)


def least_room(body: dict[str, float]) -> float:
    """How much both joints' coupling may grow until the inertia of some posture is singular [kg m^2]."""
    c = np.cos(np.linspace(0.0, np.pi, 181))
    first = body["inertia"] + body["inertia_2"] + 2.0 * body["coupling"] * c + body["rotor"]
    second = body["inertia_2"] + body["rotor_2"]
    return float(np.min(np.sqrt(first * second) - body["inertia_2"] - body["coupling"] * c))


@form("unknown", on=("arm",))
def rotor_couples_the_joints(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Murphy, Wen and Saridis 1991 (an elbow's motor on the upper arm: its rotor's spin holds both joints back by ratio).

    Each joint is pushed by the other one's acceleration alone: no mass that could be added, nor weight, has only that.
    """
    share = 0.6 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, more = plant.body, share * least_room(plant.body)
        return plant.with_body(
            inertia=n["inertia"] - more, inertia_2=n["inertia_2"] + more, rotor_2=n["rotor_2"] - more
        )  # what couples grows alone: `inertia_2` stands in both diagonals, too

    return Effect({"share": share}, alter=alter)


@form("unknown", also=("random_coefficients",), on=("slider",))
def settles_anew_at_each_step(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mair and Marone 1999 (a gear that is changed at each step of the speed: the sample settles anew, by chance).

    A level from step to step, of which neither speed nor way decides; within a run it is no number of that run.
    """
    size = 0.015 * strength

    def law(rng: Generator) -> RateAndState:
        levels = size * rng.standard_normal(64)
        return RateAndState(0.6, 0.0, added=lambda t, x: levels[(t / STEP_TIME + 1e-9).astype(int)])

    return Effect({"size": size}, law=law)


@form("unknown", also=("random_coefficients",), on=("thrown",))
def sole_is_wet_or_dry(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Persson 2000 (a rubber sole that is wet or dry by chance: wet it rubs less the faster it goes, dry it rubs more).

    Each slide has a law of the speed, over the slides there is none.
    """
    more = 0.55 * strength

    def law(rng: Generator) -> Throw:
        side = either_sign(rng)
        return Throw(lambda v, x: 0.28 * (1.0 + side * more * (v - 0.7) / 0.7))

    return Effect({"more": more}, law=law)
