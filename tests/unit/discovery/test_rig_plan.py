"""What plans of all rigs have in common."""

import numpy as np
import pytest

from stochfric_mb.discovery.planning.joint_plan import JointPlan
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.rig_plan import Part, RigPlan
from stochfric_mb.scenario import any_scenario_from_dict

TABLES = {
    "schema": "stochfric.scenario/1",
    "mechanism": {"kind": "prismatic_joint", "mass": 2.0, "normal_force": 10.0},
    "law": {"kind": "coulomb", "mu_s": 0.2, "mu_k": 0.2},
    "simulation": {"duration": 10.0, "output_step": 1.0e-2},
}
RUN = PlannedRun(name="run 1", duration=10.0, sample_rate=100.0, stroke=0.1, period=2.0)


@pytest.fixture
def plan() -> RigPlan:
    return JointPlan(any_scenario_from_dict(TABLES))


def test_the_first_further_run_is_the_planned_one_again(plan):
    (text, again), *others = plan.extra_runs(RUN)
    assert text == "another 10 s as in run 1"
    assert (again.name, again.stroke, again.period) == ("extra run", 0.1, 2.0)
    assert any(run.period == 1.0 for _, run in others)


def test_a_part_is_said_with_its_noise_and_what_the_rig_shows(plan):
    part = plan.part(RUN, 0)
    assert isinstance(part, Part)
    facts = plan.facts(part)
    assert list(facts) == ["name", "seconds", "sample_rate", "noise", "force_noise", "stroke", "period", "set"]
    assert facts["force_noise"] == pytest.approx(0.01 * 0.2 * 10.0)
    np.testing.assert_allclose(part.measured.time, np.arange(1000) / 100.0)
    assert plan.unit("N s/m") == "N s/m"
