"""What a hidden effect is: a change of the machine, of the measurement, or of the nominal model."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.discovery.generator.curve import Array
from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

Generator = np.random.Generator
Record = dict[str, Array]
"""Columns of a run by their header, `time [s]` and `position [m]` at least."""


def _same_machine(machine: Machine, rng: Generator) -> Machine:
    del rng
    return machine


def _same_record(record: Record, rng: Generator) -> Record:
    del rng
    return record


@dataclass(frozen=True)
class Effect:
    """One effect as drawn for a case. What differs from run to run is drawn from the generator handed to its functions."""

    parameters: dict[str, float]
    alter: Callable[[Machine, Generator], Machine] = _same_machine
    measure: Callable[[Record, Generator], Record] = _same_record
    nominal: dict[str, object] = field(default_factory=dict)
    """What the scenario declares under [coefficients]."""
    channels: tuple[str, ...] = ()
    """Further columns that the experiment records."""
    noise: float = 5e-6
    """Standard deviation of the white position noise [m]."""


@dataclass(frozen=True)
class Form:
    """A functional form of an effect, and how to draw one of a given strength."""

    name: str
    """`kind.form`."""
    kind: str
    draw: Callable[[Generator, float, Rig], Effect]
    rig: dict[str, float]
    """Changes of the nominal rig, for effects that its usual motion cannot show."""
    also: frozenset[str]
    """Further kinds that describe this form as well."""


FORMS: dict[str, Form] = {}


def form(
    kind: str, *, also: tuple[str, ...] = (), **rig: float
) -> Callable[[Callable[[Generator, float, Rig], Effect]], Callable[[Generator, float, Rig], Effect]]:
    """Register a function (rng, strength, rig) -> Effect as `kind.function_name`."""

    def register(draw: Callable[[Generator, float, Rig], Effect]) -> Callable[[Generator, float, Rig], Effect]:
        name = f"{kind}.{draw.__name__}"
        if name in FORMS:
            raise ValueError(f"form {name!r} is defined twice")
        FORMS[name] = Form(name, kind, draw, rig, frozenset(also))
        return draw

    return register


def either_sign(rng: Generator) -> float:
    """1 or -1."""
    return float(rng.choice([-1.0, 1.0]))
