"""Effects of the vocabulary: by place; forces; links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

STEEPEST = np.exp(-0.25 * np.pi) * np.sin(0.25 * np.pi)
"""Most of exp(-x) sin(x)."""


@form("position_dependent_friction")
def kinked_joint_of_a_rail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hetenyi 1946 (a rail on an elastic bed, kinked where two pieces meet: tight on one side, loose on the other, fading)."""
    size, at, length = (
        0.7 * strength * either_sign(rng),
        bench.reach * rng.uniform(-0.2, 0.2),
        bench.reach * rng.uniform(0.3, 0.4),
    )

    def factor(q: Array) -> Array:
        x = (q - at) / length
        return 1.0 + size * np.exp(-np.abs(x)) * np.sin(x) / STEEPEST

    return friction_at({"size": size, "at": at, "length": length}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def can_sprayed_from_above(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holland and Steckelmacher 1952 (a table coated by a can above one spot: the inverse square of 1 and a square)."""
    less, at, height = 0.65 * strength, rng.uniform(0.12, 0.16), 0.08

    def mu(v: float, x: float) -> float:
        return float(0.32 * (1.0 - less / (1.0 + ((x - at) / height) ** 2) ** 2))

    return Effect({"less": less, "at": at, "height": height}, law=lambda _: Throw(mu, starts=(1.3, 1.7)))


@form("position_dependent_force", on=HINGES)
def chain_lifted_from_the_floor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wong and Yasui 2006 (a chain from the link's tip to a heap right below: the higher the tip, the more of it hangs)."""
    size = 1.5 * strength * bench.level * rng.uniform(0.9, 1.1)
    most = np.sin(bench.reach) * (1.0 - np.cos(bench.reach))

    def force(q: Array) -> Array:
        return size * np.sin(q) * (1.0 - np.cos(q)) / most

    return force_at({"size": size}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def square_lifting_bag(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krivts and Krejnin 2006 (a square bag between plates: rounding takes of either side as the gap opens, a square)."""
    less, side = 0.1 * strength, either_sign(rng)
    return Effect(
        {"less": less, "side": side},
        rig=pressurised,
        alter=lambda plant, _: plant.times_at_place(
            AREA_AT, lambda q: np.maximum(1.0 - less * side * q / bench.reach, 0.0) ** 2
        ),
    )


@form("drive_gain_change", on=SINGLES)
def voice_coil_leaves_its_gap(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Klippel 2006 (a voice coil: all of the force in its gap, less the farther out, by a fourth power; off the middle)."""
    less, at, half = 0.6 * strength, bench.reach * rng.uniform(-0.25, 0.25), bench.reach * rng.uniform(0.5, 0.65)

    def gain(q: Array) -> Array:
        out = ((q - at) / half) ** 4
        return 1.0 - less * out / (1.0 + out)

    return Effect({"less": less, "at": at, "half": half}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain))


POISSON = 0.3


@form("drive_gain", also=("payload",), on=SINGLES)
def bridge_of_two_active_gauges(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Window 1992 (a bridge of two gauges along and two across, entered as four along: it shows 0.65 of the force, always)."""
    gain = (2.0 / (1.0 + POISSON)) ** strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def triangular_gusset(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Meriam and Kraige 2012 (a gusset along the link, wide at the pivot: weight by a third of its mass, inertia a sixth)."""
    share = 0.9 * strength * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(
            inertia=n["inertia"] + mass * length**2 / 6.0, gravity=n["gravity"] + mass * GRAVITY * length / 3.0
        )

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def hysteresis_clutch_keeps_a_cord_taut(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Copeland and Slemon 1963 (a cord's reel behind a hysteresis clutch: alike at any slip; 0.65 of friction, 0.03 stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


MOVES = 0.3
"""Share of a cycle that a neighbour's arm takes for either way."""


def pick_and_place(turns: Array) -> Array:
    """Acceleration of an arm that goes there and back with least jerk and waits at both ends, 1 at most."""
    half = np.mod(2.0 * turns, 1.0)
    s = np.clip(half / (2.0 * MOVES), 0.0, 1.0)
    way = np.where(np.mod(turns, 1.0) < 0.5, 1.0, -1.0)
    return way * (s - 3.0 * s**2 + 2.0 * s**3) * 6.0 * np.sqrt(3.0)


@form("harmonic_force")
def neighbour_picks_and_places(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Flash and Hogan 1985 (a robot on the same frame that picks and places with least jerk: two pushes either way, waits)."""
    size, frequency = 0.7 * strength * bench.level, rng.uniform(1.4, 2.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * pick_and_place(frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def shelf_that_racks_on_a_trolley(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Chopra 2007 (a laden shelf on a trolley that racks as a storey does: half of the mass, little damping, no rail)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.8, 1.0) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.55, frequency=frequency, damping=0.04, held=0.05),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def key_loose_in_its_hub(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Budynas and Nisbett 2011 (a lever whose key is loose in its hub: three fifths of the inertia, on a bush of its own)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15), 17.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.08, held=0.25, half_gap=gap),
    )
