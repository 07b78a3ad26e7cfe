"""The rigs: sizes, sample rates, noise, controllers; nominal numbers and true ones."""

from dataclasses import dataclass, replace

import numpy as np

from .plant import ARM, SINGLE

Generator = np.random.Generator
GRAVITY = 9.81

DESIGNS = ("slide", "hinge", "mjcf_slide", "mjcf_hinge", "arm", "slider", "thrown")
"""Mechanisms: prismatic_joint, hinge_pendulum, three MJCF models, spring_slider, and a prismatic_joint that is thrown."""

UNCERTAINTY = {"mass": 0.02, "mu": 0.2, "damping": 0.2, "inertia": 0.05}
"""Relative standard deviations of the nominal numbers; that of an offset is in its own unit."""


@dataclass(frozen=True)
class Sensor:
    """What is added to positions and drives."""

    position: float
    """Standard deviation of white position noise [m or rad]."""
    drive: float
    """Standard deviation of white drive noise [N or N m]."""
    resolution: float = 0.0
    """Step of the encoder [m or rad]; 0: none."""


@dataclass(frozen=True)
class Bench:
    """A rig, its nominal or true numbers, and how it is driven and measured."""

    design: str
    numbers: dict[str, float]
    """Bodies: mass, damping, offset, ..."""
    coulomb: tuple[float, float]
    """Friction of each coordinate [N or N m]."""
    reach: float
    speed: float
    rate: float
    """Samples a second."""
    sensor: Sensor
    motion: str
    declared: bool
    """Whether the scenario declares the controller."""
    place: int = 0
    """Coordinate in which the effect sits."""
    pressures: tuple[float, ...] = ()
    """Pressure of each run [Pa]; none: there is no gauge."""
    gain: float = 1.0
    """Force per unit of output; 1: the force itself is recorded."""
    n_fit: int = 2
    n_test: int = 1
    duration: float = 12.0
    offset_sd: float = 0.0
    """Standard deviation of the nominal offset [N or N m]."""
    bandwidth: float = 1.0
    """Of the controller, as a share of the usual one."""

    @property
    def rotational(self) -> bool:
        return self.design in ("hinge", "mjcf_hinge", "arm")

    @property
    def level(self) -> float:
        """Believed Coulomb friction where the effect sits [N or N m]."""
        return self.coulomb[self.place]

    @property
    def inertia(self) -> float:
        """Inertia against which the place with the effect moves [kg or kg m^2]."""
        if self.design == "arm" and self.place == 1:
            return self.numbers["inertia_2"] + self.numbers["rotor_2"]
        return self.numbers["inertia"]

    def body(self) -> dict[str, float]:
        """The plant's body."""
        kind = {"arm": ARM}.get(self.design, SINGLE)
        return {"kind": kind} | self.numbers


def nominal_bench(design: str, rng: Generator, rate: float | None = None) -> Bench:
    """A rig of the design, of a size of its own."""
    rate = rate or float(rng.choice([500.0, 1000.0, 1000.0, 2000.0]))
    motion = str(rng.choice(["strokes", "sines"]))
    make = {"slide": _slide, "mjcf_slide": _slide, "hinge": _hinge, "mjcf_hinge": _hinge, "arm": _arm}[design]
    bench = make(design, rng, rate, motion)
    return replace(bench, declared=design in ("slide", "mjcf_slide", "mjcf_hinge", "arm") and rng.random() < 0.6)


def _slide(design: str, rng: Generator, rate: float, motion: str) -> Bench:
    mass = float(np.exp(rng.uniform(np.log(1.5), np.log(80.0))))
    friction = rng.uniform(0.05, 0.25) * mass * GRAVITY
    reach = rng.uniform(0.06, 0.3)
    speed = reach * rng.uniform(2.5, 5.0)
    damping = rng.uniform(0.0, 0.25) * friction / speed
    numbers = {"inertia": mass, "damping": damping, "offset": 0.0}
    sensor = Sensor(rng.uniform(1e-5, 6e-5) * reach, rng.uniform(0.005, 0.02) * friction)
    gain = float(rng.choice([1.0, rng.uniform(5.0, 60.0)])) if design == "slide" else 1.0
    return Bench(
        design, numbers, (friction, 0.0), reach, speed, rate, sensor, motion, False, gain=gain, offset_sd=0.03 * friction
    )


def _hinge(design: str, rng: Generator, rate: float, motion: str) -> Bench:
    mass, length = rng.uniform(0.3, 2.5), rng.uniform(0.1, 0.5)
    rotor = rng.uniform(0.05, 0.4) * mass * length**2
    gravity = mass * GRAVITY * length
    friction = rng.uniform(0.05, 0.25) * gravity
    reach = rng.uniform(0.6, 1.8)
    speed = reach * rng.uniform(2.5, 5.0)
    damping = rng.uniform(0.0, 0.2) * friction / speed
    numbers = {
        "inertia": mass * length**2 + rotor, "damping": damping, "offset": 0.0, "gravity": gravity,
        "mass": mass, "length": length, "rotor_part": rotor,
    }  # fmt: skip
    sensor = Sensor(rng.uniform(1e-5, 1e-4) * reach, rng.uniform(0.005, 0.02) * friction)
    return Bench(design, numbers, (friction, 0.0), reach, speed, rate, sensor, motion, False, offset_sd=0.03 * friction)


def _arm(design: str, rng: Generator, rate: float, motion: str) -> Bench:
    """Two links as point masses on light rods, with rotors at both joints."""
    m1, m2, l1, l2 = rng.uniform(1.0, 2.5), rng.uniform(0.5, 1.5), rng.uniform(0.25, 0.45), rng.uniform(0.2, 0.4)
    place, reach = int(rng.integers(2)), rng.uniform(0.5, 0.9)
    friction = (rng.uniform(0.6, 1.4), rng.uniform(0.3, 0.8))
    numbers = {
        "inertia": (m1 + m2) * l1**2, "inertia_2": m2 * l2**2, "coupling": m2 * l1 * l2, "rotor": 0.05, "rotor_2": 0.03,
        "gravity": (m1 + m2) * GRAVITY * l1, "gravity_2": m2 * GRAVITY * l2, "damping": 0.0, "offset": 0.0,
        "m1": m1, "m2": m2, "l1": l1, "l2": l2,
    }  # fmt: skip
    sensor = Sensor(rng.uniform(1e-5, 5e-5), rng.uniform(0.005, 0.02) * friction[place])
    return Bench(
        design, numbers, friction, reach, reach * rng.uniform(2.5, 4.5), rate, sensor, motion, False,
        place=place, offset_sd=0.03 * friction[place],
    )  # fmt: skip


def true_bench(nominal: Bench, rng: Generator, deviation: float | None = None) -> Bench:
    """What is true of the rig: within the stated uncertainty, or at this many standard deviations on a random side."""

    def off(sd: float) -> float:
        drawn = float(np.clip(rng.standard_normal(), -1.5, 1.5))
        return sd * (drawn if deviation is None else deviation * float(rng.choice([-1.0, 1.0])))

    n = dict(nominal.numbers)
    mass, rotor = 1.0 + off(UNCERTAINTY["mass"]), 1.0 + off(UNCERTAINTY["inertia"])
    if nominal.design == "arm":
        for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2"):
            n[name] *= mass
        n["rotor"], n["rotor_2"] = n["rotor"] * rotor, n["rotor_2"] * rotor
    elif "gravity" in n:
        n["gravity"] *= mass
        n["inertia"] = n["mass"] * mass * n["length"] ** 2 + n["rotor_part"] * rotor
    else:
        n["inertia"] *= mass
    n["damping"] *= 1.0 + off(UNCERTAINTY["damping"])
    n["offset"] += off(nominal.offset_sd)
    coulomb = tuple(level * (1.0 + off(UNCERTAINTY["mu"])) for level in nominal.coulomb)
    return replace(nominal, numbers=n, coulomb=(coulomb[0], coulomb[1]))
