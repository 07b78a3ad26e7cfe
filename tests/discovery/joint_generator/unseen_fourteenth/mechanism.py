"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def nut_out_of_line(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Young and Budynas 2002 (a nut that is out of line with its screw: it binds as a beam is stiff, near either bearing)."""
    side, near, far, more = either_sign(rng), rng.uniform(1.4, 1.5), 1.9, 0.4 * strength

    def stiffness(u: Array) -> Array:
        """Across the screw, over the place in reaches; 1 in the middle."""
        return (near * far) ** 2 / ((near + u) * (far - u)) ** 2

    def factor(q: Array) -> Array:
        return 1.0 + more * (stiffness(np.clip(side * q / bench.reach, -1.1, 1.1)) - 1.2)

    return friction_at({"side": side, "near": near, "far": far}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def ring_of_a_dried_spill(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Deegan and others 1997 (a spill that has dried to a ring on the table: each slide crosses its edge twice, and no more).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    more, edges, width = 1.4 * strength, (0.05, 0.14), 0.012

    def mu(v: float, x: float) -> float:
        return float(0.25 * (1.0 + more * sum(np.exp(-0.5 * ((x - edge) / width) ** 2) for edge in edges)))

    return Effect({"more": more}, law=lambda _: Throw(mu, starts=(1.2, 1.6)))


def slope_of_a_hump(u: Array, rise: tuple[float, float], fall: tuple[float, float], preload: float) -> Array:
    """Force of a spring whose follower rides over a hump of two 3-4-5 polynomials; 1 is its most on an even spring and rise."""
    total = np.zeros_like(u)
    for (begin, end), way in ((rise, 1.0), (fall, -1.0)):
        s = np.clip((u - begin) / (end - begin), 0.0, 1.0)
        lift = 10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5
        lift = lift if way > 0.0 else 1.0 - lift
        steep = 30.0 * s**2 * (1.0 - s) ** 2 / 1.875 * (rise[1] - rise[0]) / (end - begin)
        total += way * steep * (preload + (1.0 - preload) * lift)
    return total


@form("position_dependent_force")
def follower_on_a_cam(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rothbart 1956 (a sprung follower that rides over a hump of a cam along the stroke: up, level, and steeper down)."""
    size, side, at = 1.2 * strength * bench.level, either_sign(rng), rng.uniform(-0.1, 0.1)

    def force(q: Array) -> Array:
        u = side * q / bench.reach - at
        return side * size * slope_of_a_hump(u, (-0.75, -0.1), (0.25, 0.75), 0.6)

    return force_at({"size": size, "side": side, "at": at}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def air_spring_on_an_hourglass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bachrach and Rivin 1983 (an air spring that rolls on a waisted piston: least area at the waist, level far from it)."""
    size, waist, width = 0.22 * strength, bench.reach * rng.uniform(-0.3, 0.3), 0.35 * bench.reach

    def factor(q: Array) -> Array:
        return 1.0 + size * ((q - waist) ** 2 / ((q - waist) ** 2 + width**2) - 0.5)

    return Effect({"size": size, "waist": waist}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", on=SINGLES)
def elliptic_gears(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Litvin and Fuentes 2004 (a pair of elliptic gears, as on flying shears: a ratio that is most over a short stretch)."""
    off, turn, start = 0.22 * strength, bench.reach * rng.uniform(0.9, 1.3), rng.uniform(0.0, TURN)

    def gain(q: Array) -> Array:
        return (1.0 - off**2) / (1.0 + off**2 - 2.0 * off * np.cos(TURN * q / turn + start))

    return Effect({"off": off, "turn": turn}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def pounds_taken_for_newtons(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Thompson and Taylor 2008 (a constant in pound-feet that was entered as in newton metres: 1.36 of the force per unit)."""
    gain = 1.356**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def welding_gun_beyond_the_wrist(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kozlowski 1998 (a welding gun whose weight is a third of a length beyond the wrist: both joints bear it)."""
    share, out = 0.45 * strength * rng.uniform(0.9, 1.1), 1.35

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass = plant.body, share * bench.numbers["m2"]
        upper, gun = bench.numbers["l1"], out * bench.numbers["l2"]
        return plant.with_body(
            inertia=n["inertia"] + mass * upper**2, gravity=n["gravity"] + mass * GRAVITY * upper,
            inertia_2=n["inertia_2"] + mass * gun**2, gravity_2=n["gravity_2"] + mass * GRAVITY * gun,
            coupling=n["coupling"] + mass * upper * gun,
        )  # fmt: skip

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def magnets_bear_too_much(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hol, Lomonova and Vandenput 2006 (magnets that bear the weight, and more: 0.65 of friction, against 0.03 stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


def doublet(turns: Array) -> Array:
    """A short pull back and push on once a turn, 1 at most, and nothing between."""
    z = (np.mod(turns, 1.0) - 0.5) / 0.06
    return z * np.exp(0.5 - 0.5 * z**2)


@form("harmonic_force")
def splice_of_a_belt_passes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lodewijks 1996 (a conveyor on the same frame: each time its belt's splice passes a drum, a pull and a push)."""
    size, frequency = 1.2 * strength * bench.level, rng.uniform(1.5, 2.3)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * doublet(frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def cage_of_a_lift(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Janovsky 1999 (a lift: four fifths of the mass are its cage, on damped ropes, whose shoes have most of the friction)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.8, frequency=frequency, damping=0.1, held=0.55),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def spindle_of_a_rolling_mill(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dhaouadi, Kubo and Tobise 1993 (a mill's spindle on worn slippers: a soft shaft behind its play, half of the inertia)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15), 12.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.55, frequency=frequency, damping=0.07, held=0.35, half_gap=gap),
    )
