"""Belt rigs of the fourth set; 89 to 157 samples a natural period, slips of 480 to 1200 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

TRIBOMETER = Rig(
    name="tribometer",
    mass=0.4,
    stiffness=900.0,
    damping=0.45,
    normal_force=8.0,
    belt_velocity=2.0e-3,
    mu_s=0.55,
    mu_k=0.38,
    rate=800.0,
    noise=3.0e-6,
    unit="mm",
)
"""A pin on a moving strip."""

AXIS = Rig(
    name="axis",
    mass=40.0,
    stiffness=8.0e5,
    damping=113.0,
    normal_force=900.0,
    belt_velocity=0.8e-3,
    mu_s=0.30,
    mu_k=0.20,
    rate=2000.0,
    noise=0.25e-6,
    unit="um",
)
"""A feed axis at creeping speed."""

SLED = Rig(
    name="sled",
    mass=12.0,
    stiffness=150.0,
    damping=0.85,
    normal_force=60.0,
    belt_velocity=30.0e-3,
    mu_s=0.50,
    mu_k=0.32,
    rate=60.0,
    noise=0.3e-3,
    unit="m",
)
"""A sled on a spring balance: strokes of a hand's breadth."""

PROBE = Rig(
    name="probe",
    mass=3.0e-4,
    stiffness=20.0,
    damping=2.3e-3,
    normal_force=0.05,
    belt_velocity=5.0e-3,
    mu_s=0.70,
    mu_k=0.42,
    rate=4000.0,
    noise=1.5e-6,
    unit="um",
)
"""A fingertip-sized probe on a leaf spring."""

TURNTABLE = Rig(
    name="turntable",
    mass=2.0,
    stiffness=2.0e4,
    damping=3.2,
    normal_force=40.0,
    belt_velocity=6.0e-3,
    mu_s=0.45,
    mu_k=0.30,
    rate=2500.0,
    noise=0.5e-6,
    unit="mm",
)
"""A block on a turntable: a slip takes a quarter of the cycle."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (TRIBOMETER, AXIS, SLED, PROBE, TURNTABLE)}

RIGS.update(RIGS_OF_THE_SET)
