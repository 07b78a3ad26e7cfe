"""Friction hidden in a tendon of a simulated two-joint finger: found there, and not in the joints that the tendon moves."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.export import mjcf
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict

mujoco = pytest.importorskip("mujoco", reason="the finger is a MuJoCo model")

SAMPLE, STRIDE = 0.002, 4
ARMS = np.array([0.02, 0.012])
"""Radii at which the tendon pulls the joints [m]."""
XML = """
<mujoco>
  <option timestep="0.0005" integrator="implicitfast"/>
  <worldbody>
    <body>
      <joint name="base" axis="0 1 0" armature="0.001"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.1" size="0.01" mass="0.3"/>
      <body pos="0 0 -0.1">
        <joint name="tip" axis="0 1 0" armature="0.0005"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.08" size="0.01" mass="0.2"/>
      </body>
    </body>
  </worldbody>
  <tendon><fixed name="cable"><joint joint="base" coef="0.02"/><joint joint="tip" coef="0.012"/></fixed></tendon>
</mujoco>
"""
COULOMB = np.array([0.03, 0.015])
PULL = 2.0
"""Friction of the joints [N m], and of the tendon [N], all known."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("finger")
    (path / "finger.xml").write_text(XML)
    return path


def scenario(folder, **mechanism):
    tables = {
        "schema": "stochfric.scenario/1",
        "title": "finger",
        "mechanism": {
            "kind": "mjcf",
            "file": "finger.xml",
            "tendons": ["cable"],
            "friction": {"base": 0.03, "tip": 0.015, "cable": 2.0},
            "positions": {"base": "base_angle", "tip": "tip_angle"},
            "drives": {"base": "base_torque", "tip": "tip_torque"},
        }
        | mechanism,
        "law": {"kind": "coulomb", "mu_s": 1.0, "mu_k": 1.0},
        "uncertainty": {"mass": 0.02, "offset": 0.002, "mu_s": 0.2, "mu_k": 0.2},
        "simulation": {"duration": 10.0, "output_step": 0.002},
    }
    return any_scenario_from_dict(tables, folder=folder)


def measured(grease, *, seed, role, duration=10.0):
    """A run; ``grease`` is the hidden force in the tendon per speed of it [N s/m]."""
    spec = mujoco.MjSpec.from_string(XML)
    model = spec.compile()
    model.dof_frictionloss[:] = COULOMB
    model.tendon_frictionloss[:] = PULL
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    phase = rng.uniform(0.0, 2.0 * np.pi, 4)
    rows, held = [], np.zeros(2)
    for step in range(round(duration / model.opt.timestep)):
        t = data.time
        if step % STRIDE == 0:
            goal = np.array(
                [
                    0.5 * np.sin(2.3 * t + phase[0]) + 0.2 * np.sin(5.1 * t + phase[1]),
                    0.6 * np.sin(3.1 * t + phase[2]) + 0.2 * np.sin(6.7 * t + phase[3]),
                ]
            )
            before = held
            held = np.array([12.0, 5.0]) * (goal - data.qpos) - np.array([0.5, 0.2]) * data.qvel
            # what is held acts half a sample late, on average
            rows.append(np.r_[t, data.qpos, 0.5 * (held + before)])
        data.qfrc_applied[:] = held - ARMS * grease * float(ARMS @ data.qvel)
        mujoco.mj_step(model, data)
    table = np.array(rows)
    table[:, 1:3] += 2.0e-5 * rng.standard_normal((len(table), 2))
    table[:, 3:] += 0.002 * rng.standard_normal((len(table), 2))
    names = ("base_angle", "tip_angle", "base_torque", "tip_torque")
    columns = dict(zip(names, table[:, 1:].T, strict=True))
    return Run(name=role, role=role, time=table[:, 0], channels={}, covariates=columns, sample_interval=SAMPLE)


def discovered(folder, grease, seed):
    runs = (measured(grease, seed=seed, role="fit"), measured(grease, seed=seed + 100, role="test"))
    return joint_outcome(Dataset(title="finger", scenario_path=None, scenario=scenario(folder), runs=runs))


@pytest.fixture(scope="module")
def outcome(folder):
    return discovered(folder, 100.0, 3)


def test_the_tendon_the_effect_and_its_size(outcome):
    effects = outcome.result.effects
    assert [e.kind for e in effects] == ["viscous_friction"]
    assert "tendon cable" in effects[0].where.text
    assert outcome.places[0].place == "cable"
    number = effects[0].parameters["coefficient"]
    assert number.unit == "N s/m"
    assert number.value == pytest.approx(100.0, rel=0.05)
    before, after = (outcome.places[0].scores[k] for k in ("recalibrated", "augmented"))
    assert after.sliding < 0.3 * before.sliding
    assert after.forward < 0.5 * before.forward


def test_what_was_found_reads_back_and_goes_into_the_model(outcome, folder):
    again = any_scenario_from_dict(outcome.scenario.to_dict(), folder=folder)
    assert again == outcome.scenario
    model = mujoco.MjModel.from_xml_string(mjcf(outcome.scenario))
    assert float(np.max(model.tendon_damping)) == pytest.approx(100.0, rel=0.05)


def test_nothing_hidden_nothing_found(folder):
    assert discovered(folder, 0.0, 4).result.verdict == "none"


def test_an_unknown_tendon_is_refused_with_those_there_are(folder):
    run = measured(0.0, seed=1, role="fit", duration=1.0)
    wrong = scenario(folder, tendons=["cabel"], friction={"cabel": 1.0})
    runs = (run, dataclasses.replace(run, role="test", name="test"))
    with pytest.raises(InputError, match="did you mean 'cable'"):
        joint_outcome(Dataset(title="", scenario_path=None, scenario=wrong, runs=runs))
