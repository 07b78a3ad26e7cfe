"""The variables of an FMU: what a master sees, and where each stands."""

from __future__ import annotations

import dataclasses
import math

from stochfric_mb.export.exported import Exported
from stochfric_mb.export.parameters import Parameter
from stochfric_mb.laws.contract import GUARDS

REAL, NUMBER, FLAG = "r", "n", "b"
"""Types of variables: real, whole number, truth value."""
TIME, PARAMETER, INPUT, OUTPUT, STATE, DERIVATIVE, INDICATOR = "t", "p", "i", "o", "x", "d", "z"
"""Kinds of variables."""
INDICATORS = GUARDS + 2
"""Event indicators: the law's guards, the turning point of the velocity, and the speed at which stick begins or ends."""
DEFAULT_STEP = 1.0e-4
"""Internal step of a belt-box in co-simulation [s], unless the law needs a smaller one."""


@dataclasses.dataclass(frozen=True)
class Variable:
    """A variable; its value reference is its place in the list."""

    name: str
    """Its name."""
    kind: str
    """What it is: time, parameter, input, output, state or derivative."""
    description: str
    """What it means."""
    unit: str = ""
    """Its unit."""
    start: float = 0.0
    """Its value at the start."""
    type: str = REAL
    """Its type."""
    place: str = ""
    """The name of its place in C, VR_..., "" where C has none."""
    of: int = -1
    """Of a derivative: the value reference of its state."""
    nominal: float = 0.0
    """Typical size of a state, 0 if there is none."""


def default_mass(exported: Exported) -> float:
    """Return the mass that a contact feels unless it is stated [kg]: the box's, or 1."""
    return 1.0 if exported.mechanism is None else exported.mechanism.mass


def variables(exported: Exported, parameters: tuple[Parameter, ...], *, mechanism: bool) -> list[Variable]:
    """Return the variables of the FMU.

    Args:
        exported: what is exported.
        parameters: the parameters of its law, coefficients, mechanism and effects.
        mechanism: whether the belt-box is exported, not the friction element alone.
    """
    items = [Variable("time", TIME, "Time", "s", place="TIME")]
    items += [Variable(p.name, PARAMETER, p.description, p.unit, p.value) for p in parameters]
    for name, text in (
        ("seed", "Seed of the coefficients: first part of their address"),
        ("sample", "Sample of an ensemble: second part of the address of the coefficients"),
        ("contact", "Number of the contact: third part of the address, different for each contact of a model"),
    ):
        items.append(Variable(name, PARAMETER, text, type=NUMBER, place=name.upper()))
    items += _belt_box(exported, len(items)) if mechanism else _element(exported)
    return [*items, *_reported()]


def _element(exported: Exported) -> list[Variable]:
    step = "Step of the master [s], 0 if it varies: frees summed times of their rounding"
    items = [Variable("step", PARAMETER, step, "s", place="STEP")]
    for place, name, text, unit in (
        ("DISPLACEMENT", "relative_displacement", "Relative displacement [m], counter-surface minus body; must not jump", "m"),
        ("VELOCITY", "relative_velocity", "Relative velocity [m/s], counter-surface minus body", "m/s"),
        ("HOLDING_FORCE", "holding_force", "Friction force that would keep the velocity as it is [N]; 0 if not known", "N"),
    ):
        items += [Variable(f"{name}[{i + 1}]", INPUT, text, unit, place="" if i else place) for i in (0, 1)]
    mass = "Mass that the contact feels [kg]; elastic_stick uses it"
    items += [
        Variable("normal_force", INPUT, "Normal force [N], >= 0", "N", place="NORMAL_FORCE"),
        Variable("effective_mass", INPUT, mass, "kg", default_mass(exported), place="EFFECTIVE_MASS"),
    ]
    force = "Friction force on the body [N], along the relative velocity"
    return items + [
        Variable(f"friction_force[{i + 1}]", OUTPUT, force, "N", place="" if i else "FRICTION_FORCE") for i in (0, 1)
    ]


def _belt_box(exported: Exported, first: int) -> list[Variable]:
    mechanism, law = exported.mechanism, exported.inner
    assert mechanism is not None
    omega = math.sqrt(mechanism.stiffness / mechanism.mass)
    size = law.mu_s * mechanism.normal_force / mechanism.stiffness + abs(mechanism.excitation_amplitude)
    size += abs(mechanism.initial_position) + abs(mechanism.initial_velocity) / omega
    limit = law.step_limit(mechanism.normal_force, mechanism.mass)
    step = min(DEFAULT_STEP, 0.5 * limit)
    states = [
        ("position", "Position of the box [m]", "m", mechanism.initial_position, size, "POSITION"),
        ("velocity", "Velocity of the box [m/s]", "m/s", mechanism.initial_velocity, omega * size, "BOX_VELOCITY"),
    ]
    if law.has_flow and not exported.effects:
        states.append(("bristle_deflection", "Deflection of the law's bristle [m]", "m", 0.0, 1.0e-2 * size, "BRISTLE"))
    items = [
        Variable("internal_step", PARAMETER, "Longest step inside a communication step [s]", "s", step, place="STEP"),
        Variable("external_force", INPUT, "Further force on the box [N]", "N", place="EXTERNAL_FORCE"),
    ]
    first += len(items)
    items += [Variable(n, STATE, text, u, start, place=place, nominal=z) for n, text, u, start, z, place in states]
    items += [
        Variable(f"der({n})", DERIVATIVE, f"Rate of {n}", f"{u}/s" if u == "m" else "m/s2", place="" if i else "DERIVATIVES",
                 of=first + i)
        for i, (n, _, u, *_) in enumerate(states)
    ]  # fmt: skip
    force = "Friction force on the box [N], along the relative velocity, belt minus box"
    return [*items, Variable("friction_force", OUTPUT, force, "N", place="FRICTION_FORCE")]


def _reported() -> list[Variable]:
    return [
        Variable("mu", OUTPUT, "Friction force over normal force [-]", place="MU"),
        Variable("mu_s", OUTPUT, "Static coefficient as of the last commit [-]", place="MU_S"),
        Variable("mu_k", OUTPUT, "Kinetic coefficient as of the last commit [-]", place="MU_K"),
        Variable("stick", OUTPUT, "Whether the contact sticks, as of the last commit", type=FLAG, place="STICK"),
        *(
            Variable(f"event_indicator[{i + 1}]", INDICATOR, "Falls below zero where the law switches; 1 if unused",
                     place="" if i else "INDICATORS")
            for i in range(INDICATORS)
        ),
    ]  # fmt: skip
