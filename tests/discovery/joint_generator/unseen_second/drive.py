"""What lies between command and load: springs, play, pistons, amplifiers; and numbers that are far off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import _usual_peak as usual_peak
from tests.discovery.joint_generator.forms.coupling import chained, pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_OF_TIME, Plant

from .enter import form


@form("joint_compliance", also=("second_mode", "unknown"), on=SINGLES)
def stiffening_gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kennedy and Desai 2005 (a strain-wave gear with a cubic stiffness; the encoder sits at the motor)."""
    frequency = (bench.speed / bench.reach) * rng.uniform(1.1, 1.5) / np.sqrt(strength)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = chained(bench, plant, 0.65, frequency, 0.0)
        stiffness, load = plant.body["link_stiffness"], plant.body["inertia"]
        carried = load * bench.speed**2 / bench.reach + plant.body.get("gravity", 0.0) * np.sin(min(bench.reach, 1.5))
        return plant.with_body(link_cubic=stiffness * (stiffness / carried) ** 2)

    return Effect({"frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode", "unknown"), on=SINGLES)
def rubber_coupling(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong 1987, with the damping of rubber: a quarter of the critical one."""
    frequency = (bench.speed / bench.reach) * rng.uniform(1.0, 1.4) / np.sqrt(strength)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = chained(bench, plant, 0.5, frequency, 0.0)
        return plant.with_body(link_damping=8.0 * plant.body["link_damping"])

    return Effect({"frequency": frequency}, alter=alter)


@form("backlash", also=("joint_compliance", "second_mode", "unknown"), on=SINGLES)
def loose_key(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (as much inertia behind the gap as before it)."""
    gap = 0.07 * strength * bench.reach * rng.uniform(0.9, 1.1)
    return Effect({"half_gap": gap}, alter=lambda plant, _: chained(bench, plant, 0.5, 25.0, gap))


@form("backlash", also=("joint_compliance", "second_mode", "unknown"), on=SINGLES)
def play_of_a_heavy_load(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lagerberg and Egardt 2007 (a driveline: most of the inertia behind the gap, the shaft damped)."""
    gap = 0.035 * strength * bench.reach * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = chained(bench, plant, 0.85, 18.0, gap)
        return plant.with_body(link_damping=4.0 * plant.body["link_damping"])

    return Effect({"half_gap": gap}, alter=alter)


@form("effective_area", also=("position_dependent_force", "unknown"), on=("slide",))
def rolling_diaphragm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Caldwell, Medrano-Cerda and Goodwin 1995 (contraction: the area falls with the square of the place)."""
    size, side = 0.12 * strength, either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(
            AREA_AT, lambda q: 1.0 - size * (1.0 + side * np.clip(q / bench.reach, -1.5, 1.5)) ** 2 / 2.0
        )

    return Effect({"size": size}, rig=pressurised, alter=alter)


@form("effective_area", also=("position_dependent_force", "unknown"), on=("slide",))
def bellows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Haringx 1952 (a bellows that bulges: its area waves along the stroke)."""
    size, length, phase = 0.12 * strength, bench.reach * rng.uniform(0.8, 1.3), rng.uniform(0.0, 2.0 * np.pi)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(AREA_AT, lambda q: 1.0 + size * np.sin(2.0 * np.pi * q / length + phase))

    return Effect({"size": size, "length": length}, rig=pressurised, alter=alter)


@form("drive_saturation", also=("unknown",))
def iron_saturates(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krause, Wasynczuk and Sudhoff 2002 (torque bends away from the current that is recorded, to its square root)."""
    bend = 0.5 * (usual_peak(bench) + 0.5 * bench.inertia * bench.speed**2 / bench.reach) / strength
    return Effect({"bend": bend}, alter=lambda plant, _: plant.with_extra(bend=bend))


@form("drive_saturation", also=("unknown",), on=LINES)
def relief_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a relief valve in one of two lines: the force forward ends below what is asked for)."""
    limit = bench.level + 1.2 * (1.0 - 0.35 * strength) * bench.inertia * bench.speed**2 / bench.reach
    return Effect({"limit": limit}, alter=lambda plant, _: plant.with_extra(limit_forward=limit))


@form("drive_gain_change", also=("unknown", "viscous_friction", "quadratic_damping"))
def field_weakening(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2001 (beyond a base speed force per current falls as the inverse of speed)."""
    base = bench.speed * (0.75 - 0.4 * strength)
    return Effect({"base_speed": base}, alter=lambda plant, _: plant.with_extra(base_speed=base))


@form("drive_gain_change", also=("unknown", "friction_drift"))
def derates(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2001 (an amplifier that protects itself: a ramp down from a moment on, then a plateau)."""
    loss, begin = 0.35 * strength, bench.duration * rng.uniform(0.25, 0.4)
    return Effect(
        {"loss": loss, "begin": begin},
        alter=lambda plant, _: plant.times_in_time(
            GAIN_OF_TIME, lambda t: 1.0 - loss * np.clip((t - begin) / (0.3 * bench.duration), 0.0, 1.0)
        ),
    )


@form("drive_gain_change", also=("unknown",))
def supply_dips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bollen 2000 (voltage sags: the gain falls for a second, three times a run, at other moments each run)."""
    loss = 0.4 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = bench.duration * (np.array([0.15, 0.45, 0.75]) + rng.uniform(-0.1, 0.1, 3))
        return plant.times_in_time(
            GAIN_OF_TIME, lambda t: 1.0 - loss * np.any([(t > b) & (t < b + 1.0) for b in begins], axis=0)
        )

    return Effect({"loss": loss}, alter=alter)


@form("payload", also=("unknown",), on=("arm",))
def other_gearbox(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong, Khatib and Burdick 1986 (the square of a gear ratio: the rotor counts several times as much)."""
    name, more = ("rotor_2", "inertia_2") if bench.place else ("rotor", "inertia")
    extra = 0.5 * strength * bench.numbers[more]
    return Effect({"more": extra}, alter=lambda plant, _: plant.with_body(**{name: plant.body[name] + extra}))


@form("payload", also=("position_dependent_force", "unknown"), on=HINGES)
def counterweight(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Arakelian and Smith 2005 (a weight behind the pivot takes off moment and adds inertia)."""
    less, more = 1.0 - 0.5 * strength, 1.0 + 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.with_body(gravity=plant.body["gravity"] * less, inertia=plant.body["inertia"] * more)

    return Effect({"less": less, "more": more}, alter=alter)


@form("constant_force", also=("direction_asymmetry",), on=(*HINGES, "arm"))
def spiral_spring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Votta 1952 (a coil of constant moment: half of friction, against 0.03 that is stated)."""
    size = 0.6 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))
