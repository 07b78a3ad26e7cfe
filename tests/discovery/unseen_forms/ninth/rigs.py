"""Belt rigs of the ninth set; 60 to 80 samples a natural period, slips of 770 to 980 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

CYLINDER = Rig(
    name="cylinder",
    mass=35.0,
    stiffness=4.0e5,
    damping=110.0,
    normal_force=2200.0,
    belt_velocity=3.0e-3,
    mu_s=0.24,
    mu_k=0.15,
    rate=1200.0,
    noise=1.2e-6,
    unit="mm",
)
"""The rod of a hydraulic cylinder in its packing, at creeping speed."""

TREAD = Rig(
    name="tread",
    mass=0.25,
    stiffness=1.2e4,
    damping=2.2,
    normal_force=60.0,
    belt_velocity=12.0e-3,
    mu_s=1.10,
    mu_k=0.75,
    rate=2500.0,
    noise=4.0e-6,
    unit="m",
)
"""A block of a tyre's tread on a drum."""

TENDON = Rig(
    name="tendon",
    mass=0.05,
    stiffness=900.0,
    damping=0.4,
    normal_force=2.4,
    belt_velocity=5.0e-3,
    mu_s=0.28,
    mu_k=0.17,
    rate=1500.0,
    noise=0.6e-6,
    unit="um",
)
"""The tendon of a surgical hand in its sheath."""

SLIPWAY = Rig(
    name="slipway",
    mass=5000.0,
    stiffness=1.2e6,
    damping=3000.0,
    normal_force=4.8e4,
    belt_velocity=8.0e-3,
    mu_s=0.16,
    mu_k=0.10,
    rate=150.0,
    noise=6.0e-6,
    unit="m",
)
"""A cradle of five tons on greased ways, held by a cable."""

COMB = Rig(
    name="comb",
    mass=2.0e-8,
    stiffness=20.0,
    damping=2.5e-5,
    normal_force=2.0e-4,
    belt_velocity=3.0e-3,
    mu_s=0.45,
    mu_k=0.28,
    rate=4.0e5,
    noise=4.0e-9,
    unit="um",
)
"""The shuttle of a comb drive on its side wall: a thousand cycles a second."""

HIP = Rig(
    name="hip",
    mass=1.8,
    stiffness=9.0e4,
    damping=12.0,
    normal_force=350.0,
    belt_velocity=4.0e-3,
    mu_s=0.13,
    mu_k=0.08,
    rate=2200.0,
    noise=0.5e-6,
    unit="mm",
)
"""A pin of polyethylene on a metal plate, as for artificial hips."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (CYLINDER, TREAD, TENDON, SLIPWAY, COMB, HIP)}

RIGS.update(RIGS_OF_THE_SET)
