"""Belt rigs of the fifth set; 52 to 99 samples a natural period, slips of 770 to 1400 times the sensor's noise.

The fall from mu_s to mu_k stays well above nothing where both are two standard deviations off.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

VALVE = Rig(
    name="valve",
    mass=1.6,
    stiffness=6000.0,
    damping=3.0,
    normal_force=25.0,
    belt_velocity=1.5e-3,
    mu_s=0.42,
    mu_k=0.27,
    rate=700.0,
    noise=1.5e-6,
    unit="mm",
)
"""A spool in its packing."""

WIPER = Rig(
    name="wiper",
    mass=0.12,
    stiffness=260.0,
    damping=0.2,
    normal_force=3.0,
    belt_velocity=10.0e-3,
    mu_s=0.90,
    mu_k=0.50,
    rate=400.0,
    noise=12.0e-6,
    unit="m",
)
"""A wiper blade on nearly dry glass."""

BRAKE = Rig(
    name="brake",
    mass=3.0,
    stiffness=3.0e5,
    damping=15.0,
    normal_force=400.0,
    belt_velocity=4.0e-3,
    mu_s=0.48,
    mu_k=0.30,
    rate=5000.0,
    noise=0.4e-6,
    unit="um",
)
"""A brake pad that creeps to a halt."""

ROCK = Rig(
    name="rock",
    mass=250.0,
    stiffness=8.0e6,
    damping=900.0,
    normal_force=2.0e4,
    belt_velocity=1.6e-3,
    mu_s=0.72,
    mu_k=0.50,
    rate=1500.0,
    noise=0.8e-6,
    unit="mm",
)
"""Granite in direct shear: friction falls by a third from a high level."""

BOW = Rig(
    name="bow",
    mass=0.01,
    stiffness=1000.0,
    damping=0.075,
    normal_force=1.2,
    belt_velocity=20.0e-3,
    mu_s=0.80,
    mu_k=0.45,
    rate=4000.0,
    noise=1.0e-6,
    unit="m",
)
"""Rosin on a short string: a slip takes a fifth of the cycle."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (VALVE, WIPER, BRAKE, ROCK, BOW)}

RIGS.update(RIGS_OF_THE_SET)
