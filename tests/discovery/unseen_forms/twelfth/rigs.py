"""Belt rigs of the twelfth set, of unlike quality.

Three are read worse than those of the eleventh set, with 45 to 57 samples a natural period and slips of 330 to 560 times the
sensor's noise; three are read better, with 83 to 113 samples and slips of 990 to 1450 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

SHOE = Rig(
    name="shoe",
    mass=18.0,
    stiffness=1.1e6,
    damping=89.0,
    normal_force=2500.0,
    belt_velocity=4.0e-3,
    mu_s=0.30,
    mu_k=0.18,
    rate=1800.0,
    noise=1.36e-6,
    unit="mm",
)
"""A shoe of cast iron on the wheel of a goods wagon: 46 samples a natural period."""

BRACKET = Rig(
    name="bracket",
    mass=1.5e-3,
    stiffness=220.0,
    damping=0.0138,
    normal_force=1.2,
    belt_velocity=10.0e-3,
    mu_s=0.42,
    mu_k=0.27,
    rate=2900.0,
    noise=2.9e-6,
    unit="um",
)
"""A dentist's bracket on its arch wire, a gram and a half."""

SHEET = Rig(
    name="sheet",
    mass=0.06,
    stiffness=900.0,
    damping=0.15,
    normal_force=1.5,
    belt_velocity=7.0e-3,
    mu_s=0.62,
    mu_k=0.40,
    rate=1100.0,
    noise=2.2e-6,
    unit="m",
)
"""The roller that feeds sheets to a copier: a slip takes a fifth of the cycle, and is 330 times the noise."""

LIFT = Rig(
    name="lift",
    mass=450.0,
    stiffness=3.2e6,
    damping=760.0,
    normal_force=1.1e4,
    belt_velocity=1.8e-3,
    mu_s=0.26,
    mu_k=0.165,
    rate=1500.0,
    noise=0.5e-6,
    unit="mm",
)
"""A guide shoe of a lift's cage on its rail: 112 samples a natural period."""

ICE = Rig(
    name="ice",
    mass=7.5,
    stiffness=2.6e4,
    damping=7.0,
    normal_force=70.0,
    belt_velocity=2.2e-3,
    mu_s=0.38,
    mu_k=0.22,
    rate=900.0,
    noise=0.594e-6,
    unit="m",
)
"""A block of sea ice on the plate of a ship's hull, under an interferometer."""

JEWEL = Rig(
    name="jewel",
    mass=8.0e-5,
    stiffness=55.0,
    damping=1.33e-3,
    normal_force=6.0e-3,
    belt_velocity=0.6e-3,
    mu_s=0.24,
    mu_k=0.14,
    rate=1.1e4,
    noise=22.0e-9,
    unit="um",
)
"""A watch's pivot in its jewel: eighty milligrams, slips of a fiftieth of a millimetre."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (SHOE, BRACKET, SHEET, LIFT, ICE, JEWEL)}

RIGS.update(RIGS_OF_THE_SET)
