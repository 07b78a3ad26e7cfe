"""Conversion of measured channels to SI units.

pint converts every unit but the SI unit itself; it is loaded where it is used.
"""

from __future__ import annotations

import functools
import importlib
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import Quantity

Array = npt.NDArray[np.float64]

ALONG_AN_ARC = "what turns moves along an arc, its angle in rad times the radius of the contact"
"""What an angle is where friction acts along a line."""
ON_THE_SPRING = (
    "a load cell on the spring of a belt_box shows k x: of 1200 N/m, "
    'scale = { position = 8.333e-4 }, which is 1/k, and units = { position = "m" }'
)
"""How a force is read as a position."""


def to_si(values: Array, unit: str, quantity: Quantity, *, rotational: bool | None) -> tuple[Array, str]:
    """Return ``values`` in the SI unit of ``quantity``, and that unit; a temperature in K stays in K.

    Args:
        values: float64[n] in ``unit``.
        unit: as written in a file: ``mm``, ``N m``, ``m/s^2``, ``m s-1``, ``°C``.
        quantity: what the values are.
        rotational: whether friction acts about an axis; None: motions of both kinds are there, and the unit says which.

    Raises:
        InputError: ``unit`` is unknown, or is a unit of something else.
    """
    targets = quantity.units_of(rotational)
    if unit in targets:
        return values, unit
    if quantity.name == "temperature" and unit == "K":
        return values, "K"
    wrong = (
        f"unit {unit!r} is not one of {quantity.name}, which is kept in {' or '.join(targets)}{_motion(quantity, rotational)}"
    )
    if unit in quantity.units_of(None):  # of the other kind of motion: no library is needed to say so
        arc = _as_arc(quantity, targets) if "rad" in unit else ""
        raise InputError(f"{wrong}; give {' or '.join(targets)}, or a unit of that kind{arc}")
    units = _registry()
    given = _parsed(units, unit, quantity, targets)
    for target in targets:
        wanted = units.Unit(_spelled(target))
        if _alike(units, given, wanted):
            return np.asarray(units.Quantity(values, given).to(wanted).magnitude, dtype=np.float64), target
    arm = (
        "; the torque of a pulley or screw is a force once it is divided by radius or lead / 2 pi: "
        'of 40 mm, scale = { force = 25.0 } and units = { force = "N" }'
    )
    lever = arm if targets == ("N",) and given.dimensionality == units.Unit("N*m").dimensionality else ""
    lever = _as_arc(quantity, targets) if _turns(units, given) else lever
    if quantity.name == "position" and targets == ("m",) and given.dimensionality == units.Unit("N").dimensionality:
        lever = f"; {ON_THE_SPRING}"
    if given.dimensionality == units.Unit("A").dimensionality and targets in (("N",), ("N m",)):
        ampere = float(units.Quantity(1.0, given).to("A").magnitude)
        lever = (
            f"; a motor's current is a force or torque once it is multiplied by its constant: of 0.1 {targets[0]}/A, "
            f'scale = {{ {quantity.name} = {0.1 * ampere:g} }} and units = {{ {quantity.name} = "{targets[0]}" }}'
        )
    raise InputError(f"{wrong}; give {_choices(quantity, targets)}{lever}")


def same_unit(one: str, other: str) -> bool:
    """Return whether two spellings are of one unit: ``mNm`` and ``mN m``, ``°`` and ``deg``."""
    if one == other:
        return True
    try:
        first, second = (_unit(_registry(), unit) for unit in (one, other))
    except Exception:  # pint raises errors of many kinds for text that is no unit
        return False
    return bool(first == second)


def _as_arc(quantity: Quantity, targets: Sequence[str]) -> str:
    """Return how an angle, or its rate, is read where friction acts along a line; empty: it is read in metres nowhere."""
    if len(targets) != 1 or not targets[0].startswith("m"):
        return ""
    return (
        f"; {ALONG_AN_ARC}: of 40 mm, "
        f'scale = {{ {quantity.name} = 0.04 }} and units = {{ {quantity.name} = "{targets[0]}" }} '
        '(docs/datasets.md, "A rig that turns")'
    )


def _parsed(units: Any, unit: str, quantity: Quantity, targets: Sequence[str]) -> Any:
    try:
        return _unit(units, unit)
    except Exception:  # pint raises errors of many kinds for text that is no unit, AssertionError among them
        raise InputError(f"unit {unit!r} of {quantity.name} is unknown; give {_choices(quantity, targets)}") from None


def _unit(units: Any, unit: str) -> Any:
    text = _spelled(unit)
    if re.search(r"\d[\s)]*\*\*", text):
        raise ValueError("a power of a number is no unit; pint would work it out, however large")
    return units.Unit(text)


def _spelled(unit: str) -> str:
    """Return a unit as pint writes it: ``m s-1`` is ``m s**-1``, ``Nm`` is ``N*m``, ``°C`` is ``degC``."""
    text = unit.strip().replace("°C", "degC").replace("℃", "degC").replace("²", "^2").replace("⁻¹", "^-1")
    text = re.sub(r"\b([munkM]?N)m\b", r"\1*m", text)
    return re.sub(r"([A-Za-z])(-?\d)", r"\1**\2", text).replace("^", "**")


def _turns(units: Any, unit: Any) -> bool:
    """Return whether an angle is in the unit: to pint a radian, a count and a per cent are all plain numbers."""
    return "radian" in str(units.get_root_units(unit)[1])


def _alike(units: Any, one: Any, other: Any) -> bool:
    """Return whether two units measure the same, an angle being no plain number."""
    return one.dimensionality == other.dimensionality and _turns(units, one) == _turns(units, other)


def _motion(quantity: Quantity, rotational: bool | None) -> str:
    if quantity.translation == quantity.rotation or rotational is None:
        return ""
    return " (this mechanism rotates)" if rotational else " (this mechanism moves along a line)"


def _choices(quantity: Quantity, targets: Sequence[str]) -> str:
    """Return the units to choose from: of those that a file may use, the ones of this kind of motion."""
    units = _registry()
    wanted = [units.Unit(_spelled(target)) for target in targets]
    fitting = [
        name
        for name in quantity.also
        if any(_alike(units, units.Unit(_spelled(name.partition(" for ")[0])), w) for w in wanted)
    ]
    return ", ".join((*targets, *fitting))


@functools.cache
def _registry() -> Any:
    pint: Any = importlib.import_module("pint")
    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
