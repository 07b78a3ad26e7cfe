"""The augmented model, in the files of the tools that use it."""

import csv
import io
import tomllib

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.simulation.friction_function import joint_friction
from stochfric_mb.discovery.export import exudyn_snippet, files, mjcf, parameter_table, scenario_toml
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import any_scenario_from_dict, load_scenario
from tests.discovery.joints.test_parts import grease, pair


@pytest.fixture(scope="module")
def outcome():
    return joint_outcome(pair(grease))


def test_the_table_has_the_intervals_of_the_result(outcome):
    rows = list(csv.DictReader(io.StringIO(parameter_table(outcome.result))))
    row = next(r for r in rows if r["effect"] == "viscous_friction")
    number = outcome.result.effects[0].parameters["coefficient"]
    assert float(row["low"]) == pytest.approx(number.low, rel=1e-5)
    assert row["unit"] == "N s/m"


def test_the_files_of_a_slide(outcome):
    pytest.importorskip("mujoco", reason="one of the files is a MuJoCo model")
    written = files(outcome)
    assert sorted(written) == ["augmented.toml", "augmented.xml", "exudyn_friction.py", "parameters.csv"]
    assert "load_any_scenario('augmented.toml')" in written["exudyn_friction.py"]
    assert any_scenario_from_dict(tomllib.loads(written["augmented.toml"])) == outcome.scenario


def test_the_scenario_file_reads_back(outcome):
    assert any_scenario_from_dict(tomllib.loads(scenario_toml(outcome.scenario))) == outcome.scenario


def test_the_mjcf_slides_to_a_stop_as_the_closed_form_does(outcome):
    mujoco = pytest.importorskip("mujoco", reason="the export is a MuJoCo model")
    pytest.importorskip("stochfric_mb.mujoco")
    model = mujoco.MjModel.from_xml_string(mjcf(outcome.scenario))
    data = mujoco.MjData(model)
    data.qvel[0] = 0.6
    mujoco.mj_step(model, data, nstep=20)  # out of the law's stick, in which the joint was made
    start = float(data.qvel[0])
    mujoco.mj_step(model, data, nstep=200)
    m, c = outcome.scenario.mechanism.mass, outcome.scenario.effects[0].coefficient
    f = outcome.scenario.law.mu_k * outcome.scenario.mechanism.normal_force
    expected = (start + f / c) * np.exp(-c * 0.2 / m) - f / c
    assert expected > 0.1
    # implicit Euler at h = 1 ms: h/2 times the change of the deceleration, 0.5 ms 0.75/s (0.4 m/s)
    assert data.qvel[0] == pytest.approx(expected, abs=2e-4)


def test_the_exudyn_snippet_slides_to_a_stop_as_the_closed_form_does(outcome, tmp_path):
    exu = pytest.importorskip("exudyn", reason="the snippet is for Exudyn")
    from exudyn.itemInterface import MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround

    file = tmp_path / "augmented.toml"
    file.write_text(scenario_toml(outcome.scenario))
    names: dict = {}
    exec(exudyn_snippet(file), names)
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddNode(NodePointGround())
    node = mbs.AddNode(Node1D(referenceCoordinates=[0], initialCoordinates=[0], initialVelocities=[0.5]))
    m, c = outcome.scenario.mechanism.mass, outcome.scenario.effects[0].coefficient
    mbs.AddObject(Mass1D(nodeNumber=node, mass=m))
    markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in (ground, node)]
    names["add_friction"](mbs, *markers)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 300, 0.3
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    f = outcome.scenario.law.mu_k * outcome.scenario.mechanism.normal_force
    expected = (0.5 + f / c) * np.exp(-c * 0.3 / m) - f / c
    speed = float(np.ravel(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates_t))[0])
    assert speed == pytest.approx(expected, abs=1e-4)  # a second-order scheme at 1 ms; tanh is 1 at these speeds


def test_the_force_opposes_the_motion(outcome):
    force = joint_friction(outcome.scenario, smoothing_velocity=1e-3)
    assert force(0.0, 0.0, 0.3) == pytest.approx(-force(0.0, 0.0, -0.3))
    assert force(0.0, 0.0, 0.3) < 0.0
    assert force(0.0, 0.0, 0.0) == 0.0


def test_a_belt_box_has_no_joint():
    with pytest.raises(InputError, match="no joint"):
        mjcf(load_scenario("kang2015_table1"))
