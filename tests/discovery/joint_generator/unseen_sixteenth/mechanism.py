"""Effects of the vocabulary: by place; forces; links, numbers and motors."""

import numpy as np
from scipy.special import ellipj, ellipk, expit

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi
PLANKS = 8


@form("position_dependent_friction")
def planks_of_a_deck(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Serra 1982 (a box over a deck of equal planks, each rough or smooth by chance: a mosaic, the same in all runs)."""
    size, width = 0.6 * strength, bench.reach * rng.uniform(0.3, 0.36)
    first, edge = -0.5 * PLANKS * width + bench.reach * rng.uniform(-0.1, 0.1), 0.012 * bench.reach
    spread = rng.permutation(np.linspace(-1.0, 1.0, PLANKS))

    def factor(q: Array) -> Array:
        rough = spread[0] + 0.0 * q
        for k in range(1, PLANKS):
            rough = rough + (spread[k] - spread[k - 1]) * expit((q - first - k * width) / (0.25 * edge))
        return 1.0 + size * rough

    planks = {f"plank_{k + 1}": float(rough) for k, rough in enumerate(spread)}
    return friction_at({"size": size, "width": width, "first": first} | planks, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def ripples_in_a_sand_tray(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Taberlet, Morris and McElwaine 2007 (sand in ripples that grow along a tray: a wave whose height is a line of the way).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    size, wave, grown = 0.7 * strength, 0.09, 0.18

    def mu(v: float, x: float) -> float:
        return float(0.28 * (1.0 + size * min(max(x / grown, 0.0), 1.0) * np.sin(TURN * x / wave)))

    return Effect({"size": size, "wave": wave, "grown": grown}, law=lambda _: Throw(mu, starts=(1.3, 1.7)))


KEPT = 0.35
"""Share of its greatest moment that a folded tape keeps."""


@form("position_dependent_force", on=HINGES)
def tape_of_a_tape_measure(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Seffen and Pellegrino 1999 (a steel tape as a hinge: stiff while straight; it folds at an angle, and is weak from there).

    Folded, it falls to what a fold takes to move on, and stays there; what it took to fold it gives back.
    """
    size, folds, falls = 1.5 * strength * bench.level, bench.reach * rng.uniform(0.2, 0.3), 0.2 * bench.reach

    def force(q: Array) -> Array:
        over = np.maximum(np.abs(q) - folds, 0.0)
        bent = np.where(np.abs(q) < folds, np.abs(q) / folds, KEPT + (1.0 - KEPT) * np.exp(-over / falls))
        return size * np.sign(q) * bent

    return force_at({"size": size, "folds": folds, "falls": falls}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def spear_leaves_its_bush(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Schwartz, De Negri and Climaco 2005 (a cushioned cylinder: while its spear is in the bush, pressure has the ring alone).

    The bush is vented; over the length of a chamfer pressure comes to the spear's face as well.
    """
    less, side = 0.2 * strength, either_sign(rng)
    leaves, chamfer = bench.reach * rng.uniform(-0.25, 0.25), 0.1 * bench.reach

    def factor(q: Array) -> Array:
        return 1.0 - less * np.clip(0.5 - (side * q - leaves) / chamfer, 0.0, 1.0)

    return Effect(
        {"less": less, "side": side, "leaves": leaves, "chamfer": chamfer},
        rig=pressurised,
        alter=lambda plant, _: plant.times_at_place(AREA_AT, factor),
    )


@form("drive_gain_change", on=SINGLES)
def dirty_bars_of_a_commutator(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Shobert 1965 (a brush motor with dirty bars on its commutator: once a turn it gives half for a seventh of the turn)."""
    less, turn, start = 0.55 * strength, bench.reach * rng.uniform(0.55, 0.8), rng.uniform(0.0, 1.0)

    def gain(q: Array) -> Array:
        off = np.abs(np.mod(q / turn + start, 1.0) - 0.5)
        return 1.0 - less * expit((0.07 - off) / 0.01)

    return Effect({"less": less, "turn": turn, "start": start}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def lever_pinned_at_its_outer_hole(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Shigley and Uicker 1995 (a lever pinned at its hole of 90 mm, entered with that of 60: 1.5 of the force, always)."""
    gain = 1.5**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def reel_on_the_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hibbeler 2010 (a reel of cable bolted to the link's end: its weight is at the end, and its own inertia adds to it)."""
    share, inner, outer = 0.4 * strength * rng.uniform(0.9, 1.1), 0.25, 0.55

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        own = 0.5 * mass * length**2 * (inner**2 + outer**2)
        return plant.with_body(inertia=n["inertia"] + mass * length**2 + own, gravity=n["gravity"] + mass * GRAVITY * length)

    return Effect({"share": share, "inner": inner, "outer": outer}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def float_held_under_water(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lautrup 2011 (a float that is wholly under water pulls by a rope, alike at any depth: 0.65 of friction, 0.03 stated).

    At a hinge the rope runs off a drum.
    """
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


def bell(turns: Array, most: float) -> Array:
    """Force across of a swinging bell over its swings, in weights of a small one; `most`: how far it swings [rad]."""
    k = np.sin(0.5 * most)
    sn, *_ = ellipj(4.0 * ellipk(k**2) * np.mod(turns, 1.0), k**2)
    angle = 2.0 * np.arcsin(k * sn)
    return np.sin(angle) * (3.0 * np.cos(angle) - 2.0 * np.cos(most))


@form("harmonic_force")
def bell_swings_in_the_frame(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Heyman and Threlfall 1976 (a small bell in the same frame that swings past the level: its force across, six lobes)."""
    size, frequency, most = 0.7 * strength * bench.level, rng.uniform(1.5, 2.1), np.radians(rng.uniform(95.0, 125.0))
    largest = float(np.abs(bell(np.linspace(0.0, 1.0, 4001), most)).max())

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * bell(frequency * t + start, most) / largest)

    return Effect({"size": size, "frequency": frequency, "most": float(most)}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def tub_of_a_washing_machine(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Conrad and Soedel 1995 (a washing machine on a carriage: its tub, two thirds of the mass, on damped springs)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.66, frequency=frequency, damping=0.12, held=0.2),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def loose_steering_column(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reimpell, Stoll and Betzler 2001 (a steering column with play: half of the inertia behind it, held by ball joints)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15), 13.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.5, frequency=frequency, damping=0.1, held=0.45, half_gap=gap),
    )
