"""Belt rigs of the seventeenth set, from grams to tonnes.

They are read as laboratories read such things: 47 to 144 samples a natural period, slips of 400 to 1750 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

PLUG = Rig(
    name="plug",
    mass=2.0e-3,
    stiffness=2.0e4,
    damping=0.15,
    normal_force=4.0,
    belt_velocity=8.0e-3,
    mu_s=0.30,
    mu_k=0.19,
    rate=4.0e4,
    noise=0.048e-6,
    unit="um",
)
"""The spring of a tinned plug on a strip of its socket, two grams: slips of a twentieth of a millimetre, under a vibrometer."""

PIG = Rig(
    name="pig",
    mass=350.0,
    stiffness=1.4e5,
    damping=280.0,
    normal_force=6000.0,
    belt_velocity=15.0e-3,
    mu_s=0.55,
    mu_k=0.38,
    rate=150.0,
    noise=30.0e-6,
    unit="m",
)
"""A pig with discs of rubber that a cable draws through a dry pipe: 47 samples a natural period, read by a string."""

CURTAIN = Rig(
    name="curtain",
    mass=0.02,
    stiffness=60.0,
    damping=0.022,
    normal_force=0.6,
    belt_velocity=8.0e-3,
    mu_s=0.36,
    mu_k=0.24,
    rate=600.0,
    noise=4.0e-6,
    unit="mm",
)
"""The glider of a curtain on its rail."""

CALIPER = Rig(
    name="caliper",
    mass=4.5,
    stiffness=8.0e4,
    damping=18.0,
    normal_force=250.0,
    belt_velocity=4.0e-3,
    mu_s=0.30,
    mu_k=0.19,
    rate=2500.0,
    noise=0.45e-6,
    unit="um",
)
"""A car's brake caliper on its guide pins: 118 samples a natural period, slips of 1530 times the noise."""

CAISSON = Rig(
    name="caisson",
    mass=2.5e4,
    stiffness=4.0e6,
    damping=6300.0,
    normal_force=2.0e5,
    belt_velocity=10.0e-3,
    mu_s=0.60,
    mu_k=0.40,
    rate=130.0,
    noise=50.0e-6,
    unit="m",
)
"""A caisson of concrete on rubble, twenty-five tonnes: slips of two centimetres, 400 times the noise."""

RING = Rig(
    name="ring",
    mass=0.06,
    stiffness=9.0e4,
    damping=1.2,
    normal_force=90.0,
    belt_velocity=7.0e-3,
    mu_s=0.18,
    mu_k=0.11,
    rate=2.8e4,
    noise=0.08e-6,
    unit="um",
)
"""A piece of a piston ring on a strip of its liner: 144 samples a natural period, slips of 1750 times the noise."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (PLUG, PIG, CURTAIN, CALIPER, CAISSON, RING)}

RIGS.update(RIGS_OF_THE_SET)
