"""Belt rigs of the eleventh set; 67 to 73 samples a natural period, slips of 820 to 850 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

FILM = Rig(
    name="film",
    mass=0.2,
    stiffness=60.0,
    damping=0.14,
    normal_force=1.96,
    belt_velocity=5.0e-3,
    mu_s=0.34,
    mu_k=0.20,
    rate=200.0,
    noise=11.0e-6,
    unit="mm",
)
"""The sled of a friction test of plastic film, two hundred grams on a soft spring."""

NEEDLE = Rig(
    name="needle",
    mass=4.0e-3,
    stiffness=150.0,
    damping=0.046,
    normal_force=0.6,
    belt_velocity=8.0e-3,
    mu_s=0.50,
    mu_k=0.30,
    rate=2100.0,
    noise=1.9e-6,
    unit="um",
)
"""A needle in the rubber of a stopper."""

CRANE = Rig(
    name="crane",
    mass=800.0,
    stiffness=1.6e6,
    damping=1100.0,
    normal_force=7800.0,
    belt_velocity=2.0e-3,
    mu_s=0.24,
    mu_k=0.15,
    rate=480.0,
    noise=1.05e-6,
    unit="mm",
)
"""The brake of a crane's trolley, as it creeps."""

SKI = Rig(
    name="ski",
    mass=2.4,
    stiffness=5200.0,
    damping=2.2,
    normal_force=45.0,
    belt_velocity=3.0e-3,
    mu_s=0.16,
    mu_k=0.095,
    rate=500.0,
    noise=1.35e-6,
    unit="m",
)
"""A piece of a ski on a belt of frost."""

DAMPER = Rig(
    name="damper",
    mass=350.0,
    stiffness=9.0e6,
    damping=2200.0,
    normal_force=5.0e4,
    belt_velocity=7.0e-3,
    mu_s=0.36,
    mu_k=0.22,
    rate=1800.0,
    noise=1.85e-6,
    unit="mm",
)
"""A friction damper for a building, between plates of steel and a lining."""

CANTILEVER = Rig(
    name="cantilever",
    mass=6.0e-9,
    stiffness=0.6,
    damping=4.8e-6,
    normal_force=2.0e-5,
    belt_velocity=4.0e-3,
    mu_s=0.70,
    mu_k=0.45,
    rate=1.1e5,
    noise=20.0e-9,
    unit="um",
)
"""A colloid on a cantilever: six micrograms, slips of a sixtieth of a millimetre."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (FILM, NEEDLE, CRANE, SKI, DAMPER, CANTILEVER)}

RIGS.update(RIGS_OF_THE_SET)
