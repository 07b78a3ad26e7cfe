"""Belt rigs of the sixth set: those of the fifth, with two numbers of each changed."""

from __future__ import annotations

import dataclasses

from tests.discovery.unseen_forms.fifth.rigs import BOW, BRAKE, ROCK, VALVE, WIPER
from tests.discovery.unseen_forms.rigs import RIGS

SPOOL = dataclasses.replace(VALVE, name="spool", mass=2.2, belt_velocity=1.1e-3)
BLADE = dataclasses.replace(WIPER, name="blade", mass=0.16, normal_force=2.6)
PAD = dataclasses.replace(BRAKE, name="pad", normal_force=330.0, mu_k=0.27)
GRANITE = dataclasses.replace(ROCK, name="granite", mass=330.0, belt_velocity=2.2e-3)
ROSIN = dataclasses.replace(BOW, name="rosin", damping=0.11, mu_s=0.86)

RIGS_OF_THE_SET = {rig.name: rig for rig in (SPOOL, BLADE, PAD, GRANITE, ROSIN)}

RIGS.update(RIGS_OF_THE_SET)
