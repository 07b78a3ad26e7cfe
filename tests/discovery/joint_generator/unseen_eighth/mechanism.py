"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def bent_screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sommerfeld 1904; Slocum 1992 (a bent screw: its nut is tight as the inverse of the gap that is left, once a turn)."""
    bend, length, start = 0.5 * strength, bench.reach * rng.uniform(0.5, 0.9), rng.uniform(0.0, TURN)
    return friction_at(
        {"bend": bend, "length": length},
        lambda q: 1.0 / (1.0 - bend * np.cos(TURN * q / length + start)) + 1.0 - 1.0 / np.sqrt(1.0 - bend**2),
    )


@form("position_dependent_friction", on=("thrown",))
def striped_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zmitrowicz 2006 (a table of stripes four centimetres wide, rougher and smoother in turn, alike in each slide)."""
    size, width = 0.45 * strength, 0.04

    def law(_: Generator) -> Throw:
        return Throw(lambda v, x: 0.29 * (1.0 + size * (1.0 if int(x / width) % 2 == 0 else -1.0)))

    return Effect({"size": size, "width": width}, law=law)


@form("position_dependent_force")
def rubber_cord(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Treloar 1975 (a rubber cord, always taut: its stretch less the inverse square of that, which bends the other way)."""
    size, side = 0.9 * strength * bench.level, either_sign(rng)

    def force(q: Array) -> Array:
        stretch = 1.15 + 0.85 * np.clip(1.0 + side * q / bench.reach, 0.0, 2.4) / 2.0
        return side * size * (stretch - stretch**-2 - 0.85)

    return force_at({"size": size, "side": side}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def rolling_lobe(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Quaglia and Sorli 2001 (an air spring that rolls down a piston of two diameters: one area, a cone, another area)."""
    size, side, middle = 0.1 * strength, either_sign(rng), bench.reach * rng.uniform(-0.15, 0.15)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(
            AREA_AT, lambda q: 1.0 + size * side * np.clip((q - middle) / (0.4 * bench.reach), -1.0, 1.0)
        )

    return Effect({"size": size, "side": side}, rig=pressurised, alter=alter)


@form("drive_gain_change")
def accumulator_runs_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pourmovahed and Otis 1990 (a drive that is fed from an accumulator: gas that expands by a power, at a steady flow)."""
    flow = 0.45 * strength * rng.uniform(0.9, 1.1)
    return Effect(
        {"flow": flow},
        alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: (1.0 + flow * t / bench.duration) ** -1.4),
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def effective_for_peak_value(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hendershot and Miller 1994 (a constant by peak, a current by effective value: 0.71 of the force per unit, always)."""
    gain = 2.0 ** (-0.5 * strength)
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def hoses_along_the_link(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sciavicco and Siciliano 2000 (hoses strapped along the link: weight by a half of the length, inertia by a third)."""
    share = 0.7 * strength * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(
            inertia=n["inertia"] + mass * length**2 / 3.0, gravity=n["gravity"] + 0.5 * mass * GRAVITY * length
        )

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def rod_on_one_side(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a cylinder with its rod on one side, equal pressures: 0.65 of friction, against 0.03 that is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def compressor_strokes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a piston compressor on the frame: once a turn a smooth push, and little between)."""
    size, frequency = 0.85 * strength * bench.level, rng.uniform(4.5, 7.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            return size * (np.exp(3.0 * (np.cos(TURN * frequency * t + start) - 1.0)) - np.exp(-3.0) * np.i0(3.0))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def table_on_a_long_screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Varanasi and Nayfeh 2004 (a table on a long screw: three quarters of the mass and of the friction are the table's)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.75, frequency=frequency, damping=0.09, held=0.75),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def worn_spline(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kahraman and Singh 1990 (a worn spline: half of the inertia behind the play, lightly damped flanks, a dry bearing)."""
    gap = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.5, frequency=20.0, damping=0.06, held=0.4, half_gap=gap),
    )
