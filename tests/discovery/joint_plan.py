"""Which driven joints a suite consists of: every form, with mechanisms and strengths that rotate with the seed."""

from collections.abc import Iterable, Iterator

from .joint_generator.case import Case
from .joint_generator.forms import FORMS
from .joint_generator.unseen import UNSEEN
from .joint_generator.unseen_eighteenth import PAIRS as UNSEEN_EIGHTEENTH_PAIRS
from .joint_generator.unseen_eighteenth import UNSEEN_EIGHTEENTH
from .joint_generator.unseen_eighth import PAIRS as UNSEEN_EIGHTH_PAIRS
from .joint_generator.unseen_eighth import UNSEEN_EIGHTH
from .joint_generator.unseen_eleventh import PAIRS as UNSEEN_ELEVENTH_PAIRS
from .joint_generator.unseen_eleventh import UNSEEN_ELEVENTH
from .joint_generator.unseen_fifteenth import PAIRS as UNSEEN_FIFTEENTH_PAIRS
from .joint_generator.unseen_fifteenth import UNSEEN_FIFTEENTH
from .joint_generator.unseen_fifth import PAIRS as UNSEEN_FIFTH_PAIRS
from .joint_generator.unseen_fifth import UNSEEN_FIFTH
from .joint_generator.unseen_fourteenth import PAIRS as UNSEEN_FOURTEENTH_PAIRS
from .joint_generator.unseen_fourteenth import UNSEEN_FOURTEENTH
from .joint_generator.unseen_fourth import UNSEEN_FOURTH
from .joint_generator.unseen_nineteenth import PAIRS as UNSEEN_NINETEENTH_PAIRS
from .joint_generator.unseen_nineteenth import UNSEEN_NINETEENTH
from .joint_generator.unseen_ninth import PAIRS as UNSEEN_NINTH_PAIRS
from .joint_generator.unseen_ninth import UNSEEN_NINTH
from .joint_generator.unseen_second import UNSEEN_SECOND
from .joint_generator.unseen_seventeenth import PAIRS as UNSEEN_SEVENTEENTH_PAIRS
from .joint_generator.unseen_seventeenth import UNSEEN_SEVENTEENTH
from .joint_generator.unseen_seventh import PAIRS as UNSEEN_SEVENTH_PAIRS
from .joint_generator.unseen_seventh import UNSEEN_SEVENTH
from .joint_generator.unseen_sixteenth import PAIRS as UNSEEN_SIXTEENTH_PAIRS
from .joint_generator.unseen_sixteenth import UNSEEN_SIXTEENTH
from .joint_generator.unseen_sixth import PAIRS as UNSEEN_SIXTH_PAIRS
from .joint_generator.unseen_sixth import UNSEEN_SIXTH
from .joint_generator.unseen_tenth import PAIRS as UNSEEN_TENTH_PAIRS
from .joint_generator.unseen_tenth import UNSEEN_TENTH
from .joint_generator.unseen_third import UNSEEN_THIRD
from .joint_generator.unseen_thirteenth import PAIRS as UNSEEN_THIRTEENTH_PAIRS
from .joint_generator.unseen_thirteenth import UNSEEN_THIRTEENTH
from .joint_generator.unseen_twelfth import PAIRS as UNSEEN_TWELFTH_PAIRS
from .joint_generator.unseen_twelfth import UNSEEN_TWELFTH
from .joint_generator.unseen_twentieth import PAIRS as UNSEEN_TWENTIETH_PAIRS
from .joint_generator.unseen_twentieth import UNSEEN_TWENTIETH
from .joint_generator.unseen_twentyfirst import PAIRS as UNSEEN_TWENTYFIRST_PAIRS
from .joint_generator.unseen_twentyfirst import UNSEEN_TWENTYFIRST

STRENGTHS = (1.0, 0.5)

PAIRS = (
    "viscous_friction.proportional+direction_asymmetry.coulomb_level",
    "position_dependent_friction.wave+viscous_friction.saturating",
    "friction_drift.warming+velocity_weakening.gaussian",
    "load_dependence.gear+viscous_friction.proportional",
    "position_dependent_force.cable+viscous_friction.concave",
    "direction_asymmetry.coulomb_level+random_coefficients.per_stroke",
    "quadratic_damping.drag+friction_drift.wear",
)
"""Two effects at once."""


def cases(seeds: Iterable[int]) -> Iterator[Case]:
    """For each seed every form and pair once, and nulls in two mechanisms."""
    for seed in seeds:
        for i, forms in enumerate([*FORMS, *PAIRS]):
            parts = [FORMS[name] for name in forms.split("+")]
            designs = [d for d in parts[0].designs if all(d in part.designs for part in parts)]
            turns = min(2, len(designs)) if parts[0].kind == "none" else 1
            for turn in range(turns):
                design = designs[(seed + i + 2 * turn) % len(designs)]
                yield Case(forms, design, STRENGTHS[(seed + i + seed // len(designs)) % 2], seed)


UNSEEN_PAIRS = (
    "viscous_friction.logarithmic_grease+position_dependent_force.hose",
    "direction_asymmetry.one_way_clutch+position_dependent_friction.wipers",
    "friction_drift.grease_flows+viscous_friction.third_order",
    "velocity_weakening.hyperbola+position_dependent_force.slots_and_poles",
    "load_dependence.bearing_preload+viscous_friction.hyperbolic_film",
    "quadratic_damping.windage+position_dependent_friction.two_lengths",
)


UNSEEN_SECOND_PAIRS = (
    "viscous_friction.limiting_shear+position_dependent_force.two_pitches",
    "velocity_weakening.flash_heating+direction_asymmetry.rebound_and_bump",
    "friction_drift.cold_start+position_dependent_friction.three_scratches",
    "harmonic_force.runners+viscous_friction.cross_fluid",
    "load_dependence.preloaded_nut+position_dependent_friction.cardan",
    "direction_asymmetry.pile_of_a_brush+friction_drift.there_and_back",
    "sensor_delay.resistor_and_capacitor+viscous_friction.limiting_shear",
    "payload.counterweight+position_dependent_friction.worn_rack",
)

SERIES = {
    1: (UNSEEN, UNSEEN_PAIRS),
    2: (UNSEEN_SECOND, UNSEEN_SECOND_PAIRS),
    3: (UNSEEN_THIRD, ()),
    4: (UNSEEN_FOURTH, ()),
    5: (UNSEEN_FIFTH, UNSEEN_FIFTH_PAIRS),
    6: (UNSEEN_SIXTH, UNSEEN_SIXTH_PAIRS),
    7: (UNSEEN_SEVENTH, UNSEEN_SEVENTH_PAIRS),
    8: (UNSEEN_EIGHTH, UNSEEN_EIGHTH_PAIRS),
    9: (UNSEEN_NINTH, UNSEEN_NINTH_PAIRS),
    10: (UNSEEN_TENTH, UNSEEN_TENTH_PAIRS),
    11: (UNSEEN_ELEVENTH, UNSEEN_ELEVENTH_PAIRS),
    12: (UNSEEN_TWELFTH, UNSEEN_TWELFTH_PAIRS),
    13: (UNSEEN_THIRTEENTH, UNSEEN_THIRTEENTH_PAIRS),
    14: (UNSEEN_FOURTEENTH, UNSEEN_FOURTEENTH_PAIRS),
    15: (UNSEEN_FIFTEENTH, UNSEEN_FIFTEENTH_PAIRS),
    16: (UNSEEN_SIXTEENTH, UNSEEN_SIXTEENTH_PAIRS),
    17: (UNSEEN_SEVENTEENTH, UNSEEN_SEVENTEENTH_PAIRS),
    18: (UNSEEN_EIGHTEENTH, UNSEEN_EIGHTEENTH_PAIRS),
    19: (UNSEEN_NINETEENTH, UNSEEN_NINETEENTH_PAIRS),
    20: (UNSEEN_TWENTIETH, UNSEEN_TWENTIETH_PAIRS),
    21: (UNSEEN_TWENTYFIRST, UNSEEN_TWENTYFIRST_PAIRS),
}
"""Sets of forms for a report, with their pairs."""


def unseen_cases(seeds: Iterable[int], series: int = 1) -> Iterator[Case]:
    """For each seed every form of the report twice, at full and at half strength, in two mechanisms where there are; nulls
    in three.
    """
    forms_of, pairs = SERIES[series]
    for seed in seeds:
        for i, forms in enumerate([*forms_of, *pairs]):
            parts = [forms_of[name] for name in forms.split("+")]
            designs = [d for d in parts[0].designs if all(d in part.designs for part in parts)]
            turns = min(3, len(designs)) if parts[0].kind == "none" else 2
            for turn in range(turns):
                yield Case(forms, designs[(seed + i + turn) % len(designs)], STRENGTHS[turn % 2], seed)
