"""Where no effect explains what is missing: `unknown`, and a term without a name if it carries over to held-out runs."""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joints.test_parts import pair


def hump(q, v):
    """Friction that is higher about one speed than on both sides of it, as no law of the vocabulary is."""
    return 2.0 * np.sign(v) * (1.0 + 0.9 * np.exp(-(((np.abs(v) - 0.3) / 0.09) ** 2)))


def test_a_hump_over_speed_is_unknown_and_its_table_carries_over():
    outcome = joint_outcome(pair(hump))
    result = outcome.result
    assert result.verdict == "unknown"
    assert result.where.axis == "speed and direction"
    assert result.unnamed is not None
    assert result.unnamed.where.axis == "relative velocity"
    # the table is linear between knots 0.11 m/s apart, over a hump 0.18 m/s wide: it takes most of it, not all
    assert result.gap.closed > 0.5
    (term,) = outcome.scenario.effects
    assert term.kind == "unnamed"
    assert any_scenario_from_dict(outcome.scenario.to_dict()) == outcome.scenario


def test_friction_that_waves_in_time_is_unknown_and_no_term_carries_over():
    clock = 1.0e-3 * np.arange(8000)
    result = joint_outcome(pair(lambda q, v: 2.0 * np.sign(v) * (1.0 + 0.5 * np.sin(11.0 * clock + q[0])))).result
    assert result.verdict == "unknown"
    assert result.unnamed is None
    assert result.gap.augmented == pytest.approx(result.gap.recalibrated, rel=1e-6)  # of two fits of one model
