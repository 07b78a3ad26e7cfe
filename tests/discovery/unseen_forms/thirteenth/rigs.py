"""Belt rigs of the thirteenth set, of unlike quality.

Three are read worse than those of the eleventh set, with 45 to 60 samples a natural period and slips of 350 to 640 times the
sensor's noise; three are read better, with 87 to 106 samples and slips of 1000 to 1400 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

DIE = Rig(
    name="die",
    mass=35.0,
    stiffness=2.0e6,
    damping=150.0,
    normal_force=4000.0,
    belt_velocity=3.0e-3,
    mu_s=0.19,
    mu_k=0.11,
    rate=2000.0,
    noise=0.76e-6,
    unit="um",
)
"""A strip of sheet metal that is drawn between two flat dies: 52 samples a natural period."""

FORK = Rig(
    name="fork",
    mass=4.0,
    stiffness=3.0e4,
    damping=7.0,
    normal_force=120.0,
    belt_velocity=2.5e-3,
    mu_s=0.17,
    mu_k=0.10,
    rate=1200.0,
    noise=0.56e-6,
    unit="m",
)
"""The telescopic fork of a bicycle, pressed sideways onto its bushes."""

CORK = Rig(
    name="cork",
    mass=0.02,
    stiffness=1500.0,
    damping=0.165,
    normal_force=8.0,
    belt_velocity=16.0e-3,
    mu_s=0.60,
    mu_k=0.42,
    rate=2000.0,
    noise=5.5e-6,
    unit="mm",
)
"""A stopper of cork in the neck of a bottle: slips of two millimetres, 350 times the noise."""

MILL = Rig(
    name="mill",
    mass=1600.0,
    stiffness=4.0e6,
    damping=1600.0,
    normal_force=1.6e4,
    belt_velocity=1.0e-3,
    mu_s=0.21,
    mu_k=0.13,
    rate=840.0,
    noise=0.457e-6,
    unit="mm",
)
"""The table of a boring mill on its plain ways: more than a tonne, read by a glass scale."""

SEAL = Rig(
    name="seal",
    mass=0.5,
    stiffness=8000.0,
    damping=1.5,
    normal_force=25.0,
    belt_velocity=6.0e-3,
    mu_s=0.55,
    mu_k=0.36,
    rate=1200.0,
    noise=1.86e-6,
    unit="m",
)
"""The rod of a pneumatic cylinder in its lip seal."""

BEETLE = Rig(
    name="beetle",
    mass=2.0e-5,
    stiffness=4.0,
    damping=2.1e-4,
    normal_force=8.0e-4,
    belt_velocity=1.2e-3,
    mu_s=0.80,
    mu_k=0.52,
    rate=6800.0,
    noise=93.0e-9,
    unit="um",
)
"""The pad of a beetle's leg on glass: twenty milligrams, slips of a ninth of a millimetre."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (DIE, FORK, CORK, MILL, SEAL, BEETLE)}

RIGS.update(RIGS_OF_THE_SET)
