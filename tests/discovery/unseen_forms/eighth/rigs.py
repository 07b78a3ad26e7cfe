"""Belt rigs of the eighth set; 56 to 89 samples a natural period, slips of 640 to 1400 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

LENS = Rig(
    name="lens",
    mass=0.02,
    stiffness=300.0,
    damping=0.1,
    normal_force=0.8,
    belt_velocity=4.0e-3,
    mu_s=0.50,
    mu_k=0.33,
    rate=1400.0,
    noise=0.9e-6,
    unit="um",
)
"""The ring that focuses a lens, in stiff grease."""

BEARING = Rig(
    name="bearing",
    mass=1.2e4,
    stiffness=6.0e6,
    damping=8000.0,
    normal_force=9.0e4,
    belt_velocity=1.2e-3,
    mu_s=0.080,
    mu_k=0.045,
    rate=200.0,
    noise=1.2e-6,
    unit="mm",
)
"""The sliding bearing of a small bridge: twelve tons on a filled polymer."""

PISTON = Rig(
    name="piston",
    mass=0.7,
    stiffness=2.2e4,
    damping=5.0,
    normal_force=45.0,
    belt_velocity=6.0e-3,
    mu_s=0.38,
    mu_k=0.24,
    rate=2500.0,
    noise=0.7e-6,
    unit="m",
)
"""The seal of a piston on a drum."""

GATE = Rig(
    name="gate",
    mass=600.0,
    stiffness=9.0e5,
    damping=460.0,
    normal_force=5200.0,
    belt_velocity=1.5e-3,
    mu_s=0.30,
    mu_k=0.19,
    rate=500.0,
    noise=2.0e-6,
    unit="mm",
)
"""The slide of a sluice gate, barely damped."""

HEAD = Rig(
    name="head",
    mass=3.0e-4,
    stiffness=40.0,
    damping=4.4e-3,
    normal_force=0.05,
    belt_velocity=8.0e-3,
    mu_s=0.42,
    mu_k=0.26,
    rate=4000.0,
    noise=0.3e-6,
    unit="um",
)
"""A reading head on a tape: a third of a gram, sixteen cycles a second."""

BOOT = Rig(
    name="boot",
    mass=28.0,
    stiffness=2500.0,
    damping=16.0,
    normal_force=180.0,
    belt_velocity=20.0e-3,
    mu_s=0.75,
    mu_k=0.48,
    rate=90.0,
    noise=60.0e-6,
    unit="m",
)
"""A boot on a floor that is drawn away below it: strokes of four centimetres, read by a string."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (LENS, BEARING, PISTON, GATE, HEAD, BOOT)}

RIGS.update(RIGS_OF_THE_SET)
