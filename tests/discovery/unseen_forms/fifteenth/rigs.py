"""Belt rigs of the fifteenth set, of unlike quality.

Three are read worse than those of the eleventh set, with 52 to 58 samples a natural period and slips of 400 to 620 times the
sensor's noise; three are read better, with 83 to 106 samples and slips of 990 to 1290 times the noise.
"""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

FADER = Rig(
    name="fader",
    mass=0.008,
    stiffness=120.0,
    damping=0.0235,
    normal_force=0.5,
    belt_velocity=6.0e-3,
    mu_s=0.34,
    mu_k=0.20,
    rate=1050.0,
    noise=2.25e-6,
    unit="mm",
)
"""The fader of a mixing desk, eight grams on its track: 54 samples a natural period."""

SASH = Rig(
    name="sash",
    mass=9.5,
    stiffness=7600.0,
    damping=8.0,
    normal_force=90.0,
    belt_velocity=10.0e-3,
    mu_s=0.48,
    mu_k=0.31,
    rate=260.0,
    noise=10.0e-6,
    unit="m",
)
"""The sash of a window in its frame of painted wood: slips of four millimetres, 400 times the noise."""

GIRDER = Rig(
    name="girder",
    mass=4.0e4,
    stiffness=9.0e6,
    damping=1.2e4,
    normal_force=4.0e5,
    belt_velocity=2.5e-3,
    mu_s=0.090,
    mu_k=0.055,
    rate=125.0,
    noise=5.0e-6,
    unit="m",
)
"""The girder of a bridge that is launched over its pads: forty tonnes, 52 samples a natural period."""

ORGAN = Rig(
    name="organ",
    mass=1.1,
    stiffness=1.4e4,
    damping=3.0,
    normal_force=32.0,
    belt_velocity=3.5e-3,
    mu_s=0.40,
    mu_k=0.27,
    rate=1500.0,
    noise=0.6e-6,
    unit="um",
)
"""The slider below a rank of an organ's pipes, oak on leather."""

WEDGE = Rig(
    name="wedge",
    mass=110.0,
    stiffness=2.6e6,
    damping=440.0,
    normal_force=9000.0,
    belt_velocity=5.0e-3,
    mu_s=0.33,
    mu_k=0.20,
    rate=2600.0,
    noise=0.7e-6,
    unit="mm",
)
"""The friction wedge of a goods wagon's bogie: 106 samples a natural period, slips of 1290 times the noise."""

POINTS = Rig(
    name="points",
    mass=700.0,
    stiffness=1.1e6,
    damping=830.0,
    normal_force=6900.0,
    belt_velocity=1.8e-3,
    mu_s=0.26,
    mu_k=0.165,
    rate=600.0,
    noise=1.06e-6,
    unit="mm",
)
"""The blade of a railway's points on its dry slide chairs."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (FADER, SASH, GIRDER, ORGAN, WEDGE, POINTS)}

RIGS.update(RIGS_OF_THE_SET)
