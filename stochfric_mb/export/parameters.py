"""The parameters of what is exported: name, value, unit, and where each stands in the numbers that the C code reads."""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Iterator
from typing import Any

from stochfric_mb.c.fields import Rule, about_fields, rules
from stochfric_mb.effects import augmented_law as augmented
from stochfric_mb.export.exported import Exported

Place = tuple[str, int]
"""An array of the C code and an index in it."""


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A parameter that can be set before the start."""

    name: str
    """Its name, such as ``law.mu_s``."""
    value: float
    """Its value in the file."""
    unit: str
    """Its unit, "" if it has none."""
    description: str
    """What it is."""
    places: tuple[Place, ...]
    """Where its value goes."""

    @property
    def identifier(self) -> str:
        """Its name in C."""
        return self.name.replace(".", "_")


@dataclasses.dataclass(frozen=True)
class Group:
    """The parameters of one law, process, effect or mechanism, and the rules that they keep."""

    prefix: str
    """What their names begin with."""
    parameters: tuple[Parameter, ...]
    """The parameters, named without the prefix in the rules."""
    rules: tuple[Rule, ...]
    """The rules, in the names of the fields."""


def groups(exported: Exported, *, mechanism: bool) -> list[Group]:
    """Return all parameters of what is exported.

    Args:
        exported: what is exported.
        mechanism: whether the belt-box itself is exported.
    """
    items = [_law(exported)]
    if exported.process is not None:
        items.append(_process(exported))
    if exported.mechanism is not None and (mechanism or exported.effects):
        items.append(_mechanism(exported, with_start=mechanism))
    if exported.effects:
        items += _effects(exported)
    return items


def _group(prefix: str, cls: type, values: dict[str, tuple[float, list[Place]]]) -> Group:
    about = about_fields(cls)
    parameters = tuple(
        Parameter(f"{prefix}.{name}", value, about[name].unit, about[name].description, tuple(places))
        for name, (value, places) in values.items()
    )
    return Group(prefix, parameters, tuple(r for r in rules(cls) if r.names <= set(values)))


def _law(exported: Exported) -> Group:
    """Return the numbers of the law; choices are settled."""
    law = exported.inner
    values: dict[str, tuple[float, list[Place]]] = {}
    for i, field in enumerate(dataclasses.fields(law)):
        value = getattr(law, field.name)
        if isinstance(value, str):
            continue
        places: list[Place] = [("law", i)]
        if field.name in ("mu_s", "mu_k"):
            places.append(("process", 4 + i))
        if field.name == "v_s":
            places += [("stick_speed", 0)] + ([("model", augmented.STICK_SPEED)] if exported.effects else [])
        values[field.name] = float(value), places
    return _group("law", type(law), values)


def _process(exported: Exported) -> Group:
    process = exported.process
    places: dict[str, list[Place]] = {
        "sigma_s": [("process", 6)], "sigma_k": [("process", 7)], "spacing": [("process", 3)],
        "correlation_time": [("process", 14)],
    }  # fmt: skip
    assert process is not None
    values: dict[str, tuple[float, list[Place]]] = {}
    for field in dataclasses.fields(process):
        if field.name in places:
            value = getattr(process, field.name)
            values[field.name] = process.knot_spacing if value is None else float(value), places[field.name]
    return _group("coefficients", type(process), values)


_OF_MODEL = {
    "mass": augmented.M,
    "damping": augmented.C,
    "stiffness": augmented.K,
    "normal_force": augmented.N,
    "belt_velocity": augmented.VB,
    "excitation_amplitude": augmented.FOOT,
    "excitation_angular_frequency": augmented.W,
}


def _mechanism(exported: Exported, *, with_start: bool) -> Group:
    mechanism = exported.mechanism
    values: dict[str, tuple[float, list[Place]]] = {}
    assert mechanism is not None
    for i, field in enumerate(dataclasses.fields(mechanism)):
        fixed = not with_start or any(effect.n_memory for effect in exported.effects)  # memories start at rest there
        if field.name.startswith("initial_") and fixed:
            continue
        places: list[Place] = [("mechanism", i)]
        if exported.effects and field.name in _OF_MODEL:
            places.append(("model", _OF_MODEL[field.name]))
        values[field.name] = getattr(mechanism, field.name), places
    return _group("mechanism", type(mechanism), values)


def _effects(exported: Exported) -> Iterator[Group]:
    """Yield the parameters of the effects, which stand one after the other at the end of the model."""
    numbers: Any = exported.law
    n_rows = int(numbers.model_numbers[augmented.N_AROUND] + numbers.model_numbers[augmented.N_FRICTION])
    place = augmented.TABLE + 3 * n_rows
    seen: Counter[str] = Counter()
    for effect in exported.effects:
        seen[effect.kind] += 1
        name = effect.kind if seen[effect.kind] == 1 else f"{effect.kind}_{seen[effect.kind]}"
        values: dict[str, tuple[float, list[Place]]] = {}
        for field in dataclasses.fields(effect):
            value = getattr(effect, field.name)
            if not isinstance(value, str) and math.isfinite(value):
                values[field.name] = float(value), [("model", place)]
            place += 1
        yield _group(f"effects.{name}", type(effect), values)
