"""Belt rigs of the seventh set; 70 to 89 samples a natural period, slips of 700 to 1000 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

CATHETER = Rig(
    name="catheter",
    mass=4.0e-3,
    stiffness=60.0,
    damping=0.02,
    normal_force=0.3,
    belt_velocity=3.0e-3,
    mu_s=0.36,
    mu_k=0.21,
    rate=1500.0,
    noise=1.5e-6,
    unit="um",
)
"""A coated tube that is drawn through a clamp."""

ISOLATOR = Rig(
    name="isolator",
    mass=2000.0,
    stiffness=1.0e6,
    damping=1070.0,
    normal_force=1.5e4,
    belt_velocity=5.0e-3,
    mu_s=0.17,
    mu_k=0.10,
    rate=250.0,
    noise=3.0e-6,
    unit="mm",
)
"""Polymer on steel under two tons, as under a building: a slip takes a quarter of the cycle."""

GRIPPER = Rig(
    name="gripper",
    mass=5.0e-9,
    stiffness=8.0,
    damping=6.0e-6,
    normal_force=4.0e-5,
    belt_velocity=2.0e-3,
    mu_s=0.55,
    mu_k=0.35,
    rate=5.0e5,
    noise=2.0e-9,
    unit="um",
)
"""Side walls of an etched gripper: cycles of a millisecond."""

DRAWER = Rig(
    name="drawer",
    mass=4.5,
    stiffness=500.0,
    damping=1.9,
    normal_force=30.0,
    belt_velocity=15.0e-3,
    mu_s=0.62,
    mu_k=0.44,
    rate=150.0,
    noise=25.0e-6,
    unit="m",
)
"""Wood on wood, on a soft spring."""

GIB = Rig(
    name="gib",
    mass=15.0,
    stiffness=3.0e7,
    damping=340.0,
    normal_force=2500.0,
    belt_velocity=0.25e-3,
    mu_s=0.22,
    mu_k=0.13,
    rate=2.0e4,
    noise=1.5e-8,
    unit="um",
)
"""The gib of a grinding machine: micrometres on a very stiff frame."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (CATHETER, ISOLATOR, GRIPPER, DRAWER, GIB)}

RIGS.update(RIGS_OF_THE_SET)
