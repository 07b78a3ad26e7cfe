"""Belt rigs of the eighteenth set, from grams to tens of tonnes.

They are read as laboratories read such things: 49 to 142 samples a natural period, slips of 430 to 1800 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

BRUSH = Rig(
    name="brush",
    mass=6.0e-3,
    stiffness=900.0,
    damping=0.07,
    normal_force=1.5,
    belt_velocity=3.0e-3,
    mu_s=0.28,
    mu_k=0.17,
    rate=5000.0,
    noise=0.3e-6,
    unit="um",
)
"""The carbon brush of a dynamo on its slip ring, six grams: 81 samples a natural period."""

BARN = Rig(
    name="barn",
    mass=60.0,
    stiffness=6000.0,
    damping=15.0,
    normal_force=590.0,
    belt_velocity=15.0e-3,
    mu_s=0.25,
    mu_k=0.16,
    rate=100.0,
    noise=20.0e-6,
    unit="m",
)
"""The sliding door of a barn on its wooden sill: slips of eighteen millimetres, read with a draw wire."""

BOLT = Rig(
    name="bolt",
    mass=1.8,
    stiffness=5.0e4,
    damping=12.0,
    normal_force=45.0,
    belt_velocity=2.0e-3,
    mu_s=0.33,
    mu_k=0.21,
    rate=1300.0,
    noise=0.5e-6,
    unit="um",
)
"""The bolt of a vault's door, brass in steel: 49 samples a natural period, slips of 430 times the noise."""

PALLET = Rig(
    name="pallet",
    mass=900.0,
    stiffness=4.0e5,
    damping=570.0,
    normal_force=8800.0,
    belt_velocity=8.0e-3,
    mu_s=0.45,
    mu_k=0.30,
    rate=200.0,
    noise=10.0e-6,
    unit="mm",
)
"""A loaded pallet on the steel rails of its rack: 60 samples a natural period."""

FURNACE = Rig(
    name="furnace",
    mass=2.5e4,
    stiffness=3.0e7,
    damping=3.5e4,
    normal_force=2.45e5,
    belt_velocity=1.2e-3,
    mu_s=0.22,
    mu_k=0.14,
    rate=500.0,
    noise=1.0e-6,
    unit="mm",
)
"""A furnace on the graphite pads that let it grow: twenty-five tonnes, 91 samples a natural period."""

FINGER = Rig(
    name="finger",
    mass=0.08,
    stiffness=400.0,
    damping=0.45,
    normal_force=1.2,
    belt_velocity=10.0e-3,
    mu_s=0.90,
    mu_k=0.60,
    rate=1600.0,
    noise=1.0e-6,
    unit="um",
)
"""A finger of silicone on glass: 142 samples a natural period, slips of 1800 times the noise."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (BRUSH, BARN, BOLT, PALLET, FURNACE, FINGER)}

RIGS.update(RIGS_OF_THE_SET)
