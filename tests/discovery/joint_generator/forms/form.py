"""What a hidden effect of a driven joint is: a change of the bench, of the plant, or of the record."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import Array, Plant

Generator = np.random.Generator
Record = dict[str, Array]
"""Columns of a run by their header; `time [s]` at least."""

JOINTS = ("slide", "hinge", "mjcf_slide", "mjcf_hinge", "arm")
LINES, HINGES = ("slide", "mjcf_slide"), ("hinge", "mjcf_hinge")
SINGLES = LINES + HINGES
UNKNOWN, NONE = "unknown", "none"


def same_bench(bench: Bench) -> Bench:
    return bench


def same_plant(plant: Plant, rng: Generator) -> Plant:
    del rng
    return plant


def same_record(record: Record, rng: Generator) -> Record:
    del rng
    return record


@dataclass(frozen=True)
class Effect:
    """One effect as drawn for a case. What differs from run to run is drawn from the generator handed to its functions."""

    parameters: dict[str, float] = field(default_factory=dict)
    rig: Callable[[Bench], Bench] = same_bench
    """Changes of the experiment, known to who made it: pressures, temperatures, rates, numbers of runs."""
    alter: Callable[[Plant, Generator], Plant] = same_plant
    measure: Callable[[Record, Generator], Record] = same_record
    deviation: float | None = None
    """Standard deviations by which every parameter is off; None: as drawn."""
    law: Callable[[Generator], object] | None = None
    """Of a spring slider: its friction."""


Draw = Callable[[Generator, float, Bench], Effect]


@dataclass(frozen=True)
class Form:
    """A functional form of an effect, and how to draw one of a given strength."""

    name: str
    """`kind.form`."""
    kind: str
    draw: Draw
    designs: tuple[str, ...]
    """Mechanisms that can show it."""
    also: frozenset[str]
    """Further kinds that describe this form as well."""


FORMS: dict[str, Form] = {}


def form(
    kind: str, *, also: tuple[str, ...] = (), on: tuple[str, ...] = JOINTS, table: dict[str, Form] = FORMS
) -> Callable[[Draw], Draw]:
    """Register a function (rng, strength, bench) -> Effect as `kind.function_name` in a table of forms."""

    def register(draw: Draw) -> Draw:
        name = f"{kind}.{draw.__name__}"
        if name in FORMS or name in table:
            raise ValueError(f"form {name!r} is defined twice")
        table[name] = Form(name, kind, draw, on, frozenset(also))
        return draw

    return register


def either_sign(rng: Generator) -> float:
    """1 or -1."""
    return float(rng.choice([-1.0, 1.0]))
