"""Friction that switches between levels at random, or effects: the likelihood of the slips decides."""

import pytest

from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.screening.switching import levels_score, switching
from stochfric_mb.discovery.stick_slip.study import study
from stochfric_mb.measurement.dataset import load_dataset
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box
from tests.discovery.unseen_forms.records import cases, write_record


@pytest.mark.parametrize(
    ("form", "design", "switches"),
    [("unknown.two_states", "one_free", True), ("second_mode.attached", "belt_speeds", False)],
)
def test_the_better_explanation_stands(form, design, switches):
    result = study(belt_box(Case(form, design, 1.0, 17)))
    assert (levels_score(result.baseline) > best_effect(result)) == switches


@pytest.mark.parametrize(
    ("name", "switches"),
    [
        ("ninth_correlated_kangaroo-several-1", True),  # stays at a level, and is drawn anew for one slip in five
        ("twelfth_distance_of_a_worn_tip-several-1", False),  # half of its change comes with four slips of sixty
    ],
)
def test_friction_that_rests_between_jumps_is_weighed_against_effects(name, switches, tmp_path):
    write_record(next(c for c in cases() if c.name == name), tmp_path, 121)
    result = study(load_dataset(tmp_path / "data"))
    assert switching(result.baseline.pool, result.baseline.residuals()).at_rest_between_jumps
    assert (levels_score(result.baseline, jumps=True) > best_effect(result)) == switches


def best_effect(result):
    return max(c.score for c in screen(result.baseline) if c.is_effect)
