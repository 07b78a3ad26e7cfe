"""Belt rigs of the tenth set; 66 to 75 samples a natural period, slips of 810 to 890 times the sensor's noise."""

from __future__ import annotations

from tests.discovery.unseen_forms.rigs import RIGS, Rig

SYRINGE = Rig(
    name="syringe",
    mass=0.012,
    stiffness=400.0,
    damping=0.06,
    normal_force=1.5,
    belt_velocity=6.0e-3,
    mu_s=0.40,
    mu_k=0.24,
    rate=2000.0,
    noise=1.4e-6,
    unit="um",
)
"""The rubber plunger of a syringe in its barrel."""

TELESCOPE = Rig(
    name="telescope",
    mass=2200.0,
    stiffness=5.0e6,
    damping=2900.0,
    normal_force=3.0e4,
    belt_velocity=1.0e-3,
    mu_s=0.21,
    mu_k=0.14,
    rate=500.0,
    noise=1.0e-6,
    unit="mm",
)
"""The friction drive of a telescope of two tons, as it tracks."""

CLUTCH = Rig(
    name="clutch",
    mass=0.9,
    stiffness=1.6e5,
    damping=12.0,
    normal_force=320.0,
    belt_velocity=14.0e-3,
    mu_s=0.46,
    mu_k=0.31,
    rate=5000.0,
    noise=0.7e-6,
    unit="mm",
)
"""A lining of a clutch that is about to grip."""

WEBBING = Rig(
    name="webbing",
    mass=0.5,
    stiffness=700.0,
    damping=0.56,
    normal_force=22.0,
    belt_velocity=15.0e-3,
    mu_s=0.34,
    mu_k=0.21,
    rate=400.0,
    noise=10.0e-6,
    unit="m",
)
"""The webbing of a seat belt in its loop: slips of eight millimetres."""

STERN = Rig(
    name="stern",
    mass=140.0,
    stiffness=2.2e6,
    damping=480.0,
    normal_force=9000.0,
    belt_velocity=2.5e-3,
    mu_s=0.19,
    mu_k=0.115,
    rate=1400.0,
    noise=0.75e-6,
    unit="mm",
)
"""A stave of a ship's stern bearing, wetted by water."""

STAGE = Rig(
    name="stage",
    mass=2.0e-5,
    stiffness=250.0,
    damping=2.1e-3,
    normal_force=0.012,
    belt_velocity=2.0e-3,
    mu_s=0.32,
    mu_k=0.20,
    rate=4.0e4,
    noise=13.0e-9,
    unit="um",
)
"""The runner of a piezo stage: twenty milligrams, slips of a hundredth of a millimetre."""

RIGS_OF_THE_SET = {rig.name: rig for rig in (SYRINGE, TELESCOPE, CLUTCH, WEBBING, STERN, STAGE)}

RIGS.update(RIGS_OF_THE_SET)
