"""Belt rigs of the fourteenth set, of unlike quality.

Three are read worse than those of the eleventh set, with 49 to 60 samples a natural period and slips of 380 to 640 times the
sensor's noise; three are read better, with 80 to 108 samples and slips of 900 to 1300 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

WIRE = Rig(
    name="wire",
    mass=0.15,
    stiffness=2400.0,
    damping=0.5,
    normal_force=20.0,
    belt_velocity=5.0e-3,
    mu_s=0.22,
    mu_k=0.13,
    rate=1000.0,
    noise=3.3e-6,
    unit="mm",
)
"""The wire of a Bowden cable in its liner: 50 samples a natural period."""

STRUT = Rig(
    name="strut",
    mass=60.0,
    stiffness=9.0e5,
    damping=176.0,
    normal_force=5500.0,
    belt_velocity=2.0e-3,
    mu_s=0.16,
    mu_k=0.095,
    rate=1100.0,
    noise=1.24e-6,
    unit="m",
)
"""The lower bush of an aircraft's landing gear, pressed sideways."""

HAIR = Rig(
    name="hair",
    mass=3.0e-6,
    stiffness=3.0,
    damping=9.0e-5,
    normal_force=2.0e-3,
    belt_velocity=5.0e-3,
    mu_s=0.38,
    mu_k=0.26,
    rate=9600.0,
    noise=0.42e-6,
    unit="um",
)
"""A hair across another one, three milligrams in all: slips of a sixth of a millimetre, 380 times the noise."""

PLATEN = Rig(
    name="platen",
    mass=900.0,
    stiffness=5.5e6,
    damping=1270.0,
    normal_force=1.3e4,
    belt_velocity=1.2e-3,
    mu_s=0.17,
    mu_k=0.10,
    rate=1000.0,
    noise=0.288e-6,
    unit="mm",
)
"""The platen of a moulding machine on its bars: nearly a tonne, read by a glass scale."""

TAP = Rig(
    name="tap",
    mass=0.3,
    stiffness=2.0e4,
    damping=2.5,
    normal_force=70.0,
    belt_velocity=9.0e-3,
    mu_s=0.45,
    mu_k=0.29,
    rate=4000.0,
    noise=1.24e-6,
    unit="um",
)
"""The ceramic disc of a water tap whose grease is gone."""

CHAIR = Rig(
    name="chair",
    mass=6.0,
    stiffness=1500.0,
    damping=1.5,
    normal_force=58.8,
    belt_velocity=15.0e-3,
    mu_s=0.42,
    mu_k=0.26,
    rate=270.0,
    noise=9.65e-6,
    unit="m",
)
"""A chair with felt under its feet on a wooden floor: strokes of more than a centimetre, 1300 times the noise."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (WIRE, STRUT, HAIR, PLATEN, TAP, CHAIR)}

RIGS.update(RIGS_OF_THE_SET)
