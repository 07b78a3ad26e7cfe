"""Friction that switches between two levels, or effects: the likelihood of the slips decides."""

import pytest

from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.screening.switching import levels_score
from stochfric_mb.discovery.stick_slip.study import study
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box


@pytest.mark.parametrize(
    ("form", "design", "switches"),
    [("unknown.two_states", "one_free", True), ("second_mode.attached", "belt_speeds", False)],
)
def test_the_better_explanation_stands(form, design, switches):
    result = study(belt_box(Case(form, design, 1.0, 17)))
    levels = levels_score(result.baseline)
    best = max(c.score for c in screen(result.baseline) if c.is_effect)
    assert (levels > best) == switches
