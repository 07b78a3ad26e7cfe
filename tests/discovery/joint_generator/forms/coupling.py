"""Friction depends on a load; bodies are coupled, heavier, or driven otherwise than believed."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import AREA_AT, GAIN_OF_TIME, Plant

from .form import HINGES, JOINTS, SINGLES, Effect, Generator, either_sign, form


@form("load_dependence", on=("hinge", "mjcf_hinge", "arm"))
def gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Teeth rub by the torque that they carry: a share of the drive (Pescaru et al. 2022; Rouhaud et al. 2025)."""
    share = 0.3 * strength * rng.uniform(0.8, 1.2)
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(drive_share=share))


@form("load_dependence", on=("hinge", "mjcf_hinge", "arm"))
def gear_power(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The same with a power below 1, as of Hertzian contacts."""
    power = rng.uniform(0.65, 0.85)
    typical = bench.numbers["gravity_2" if bench.place else "gravity"]
    factor = 0.25 * strength * typical ** (1.0 - power)
    return Effect(
        {"factor": factor, "power": power}, alter=lambda plant, _: plant.with_extra(drive_share=factor, drive_power=power)
    )


@form("load_dependence", also=("position_dependent_friction",), on=HINGES)
def held_weight(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A worm that rubs by the weight that it holds, not by what accelerates it: a friction that the place alone decides."""
    share = 0.3 * strength * rng.uniform(0.8, 1.2)
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(hold_share=share))


def pressurised(bench: Bench) -> Bench:
    """A cylinder: pressure acts on a piston, a new one each run."""
    area = 2.0e-5 * bench.level
    pressures = (2e5, 5e5, 3.5e5)
    numbers = bench.numbers | {"area": area}
    return replace(bench, numbers=numbers, pressures=pressures, n_fit=2, n_test=1, declared=False, motion="strokes", gain=1.0)


@form("load_dependence", on=("slide",))
def seal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A lip that the pressure presses on (Mueller and Nau 1998)."""
    share = 1.6e-6 * strength * rng.uniform(0.8, 1.2) * bench.level
    return Effect({"share": share}, rig=pressurised, alter=lambda plant, _: plant.with_extra(pressure_share=share))


@form("position_dependent_force", also=("effective_area", "position_dependent_friction"), on=("slide",))
def effective_area(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A bore that widens along the stroke: pressure times area times place."""
    size, where = 0.12 * strength, either_sign(rng) / bench.reach

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_at_place(AREA_AT, lambda q: 1.0 + size * q * where)

    return Effect({"share": size}, rig=pressurised, alter=alter)


@form("payload", also=("quadratic_damping",), on=JOINTS)
def heavier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A tool nobody entered: far beyond the stated uncertainty of the mass."""
    factor = 1.0 + 0.35 * strength * rng.uniform(0.8, 1.2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n = plant.body
        if bench.design == "arm":
            more = (factor - 1.0) * bench.numbers["m2"]
            l1, l2 = bench.numbers["l1"], bench.numbers["l2"]
            return plant.with_body(
                inertia=n["inertia"] + more * l1**2, inertia_2=n["inertia_2"] + more * l2**2,
                coupling=n["coupling"] + more * l1 * l2, gravity=n["gravity"] + more * 9.81 * l1,
                gravity_2=n["gravity_2"] + more * 9.81 * l2,
            )  # fmt: skip
        return plant.with_body(inertia=n["inertia"] * factor, gravity=n.get("gravity", 0.0) * factor)

    return Effect({"factor": factor}, alter=alter)


def chained(bench: Bench, plant: Plant, share: float, frequency: float, half_gap: float) -> Plant:
    """Motor and load on a spring: friction at the motor, a tenth of it at the load too."""
    n = plant.body
    load, motor = share * n["inertia"], (1.0 - share) * n["inertia"]
    stiffness = (2.0 * np.pi * frequency) ** 2 * load * motor / (load + motor)
    damping = 2.0 * 0.03 * np.sqrt(stiffness * load * motor / (load + motor))
    plant = plant.with_body(
        kind=1.0, rotor=motor, inertia=load, link_stiffness=stiffness, link_damping=damping, half_gap=half_gap
    )
    return replace(plant, coulomb=(0.95 * plant.coulomb[0], 0.05 * plant.coulomb[0]))


@form("joint_compliance", also=("second_mode",), on=SINGLES)
def soft_coupling(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A belt or a strain-wave gear between motor and load; the encoder sits at the motor (Spong 1987)."""
    frequency = (bench.speed / bench.reach) * rng.uniform(1.2, 1.8) / np.sqrt(strength)
    return Effect({"frequency": frequency}, alter=lambda plant, _: chained(bench, plant, 0.6, frequency, 0.0))


@form("backlash", also=("joint_compliance", "second_mode"), on=SINGLES)
def play(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Play between motor and load (Nordin and Gutman 2002)."""
    gap = 0.04 * strength * bench.reach * rng.uniform(0.8, 1.2)
    return Effect({"half_gap": gap}, alter=lambda plant, _: chained(bench, plant, 0.7, 30.0, gap))


@form("drive_saturation", on=JOINTS)
def weak_amplifier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The amplifier gives less than the command that is recorded: its current limit is set too low."""

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        peak = _usual_peak(bench)
        return plant.with_extra(saturation=peak * (1.0 - 0.45 * strength))

    return Effect({"share": 1.0 - 0.45 * strength}, alter=alter)


@form("drive_gain_change", also=("friction_drift",), on=JOINTS)
def fading_magnets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The motor gives less and less per unit of command as it warms up."""
    loss = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(GAIN_OF_TIME, lambda t: 1.0 - loss * (1.0 - np.exp(-t / 5.0)))

    return Effect({"loss": loss}, alter=alter)


def _usual_peak(bench: Bench) -> float:
    """About the largest drive of the motion asked for [N or N m]."""
    held = bench.numbers.get("gravity_2" if bench.place else "gravity", 0.0) * np.sin(min(bench.reach, np.pi / 2.0))
    return float(bench.level + held + 0.5 * bench.inertia * bench.speed**2 / bench.reach)
