"""A rig's own units, and those of all numbers of effects in them."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits, exponents
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.mechanisms import BeltBox


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        ("-", (0, 0, 0)), ("rad", (0, 0, 0)), ("N s/m", (1, -1, 1)), ("N s^2/m^2", (1, -2, 2)), ("N/m^3", (1, -3, 0)),
        ("Hz", (0, 0, -1)), ("1/s", (0, 0, -1)), ("kg", (1, -1, 2)), ("m/s", (0, 1, -1)), ("N s", (1, 0, 1)),
    ],
)  # fmt: skip
def test_units_are_read(unit, expected):
    assert exponents(unit) == expected


def test_every_unit_of_an_effect_is_known():
    words = {"N", "m", "s", "kg", "Hz", "rad", "K", "degC", "1", "-"}
    units = {f.metadata["unit"] for kind in effect_kinds() for f in dataclasses.fields(effect_class(kind))}
    parts = {part.partition("^")[0] for unit in units for part in unit.replace("/", " ").split()}
    assert parts <= words


def test_spring_and_mass_are_one_in_the_units_of_their_rig():
    box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
    units = NaturalUnits.of_run(make_record("run", np.arange(100.0) / 1000.0, np.zeros(100), box))
    assert units.of("N") == box.normal_force
    assert units.of("N/m") == pytest.approx(box.stiffness)
    assert units.of("kg") == pytest.approx(box.mass)
    assert units.of("rad") == units.of("K") == 1.0
