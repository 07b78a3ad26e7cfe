"""The generator of driven joints against closed forms and MuJoCo, and its files against the documented formats."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan, joint_suite, judge
from tests.discovery.joint_generator import slider, thrown
from tests.discovery.joint_generator.case import Case, make, write
from tests.discovery.joint_generator.forms import FORMS
from tests.discovery.joint_generator.forms.form import JOINTS
from tests.discovery.joint_generator.integrator import simulate
from tests.discovery.joint_generator.plant import ARM, CHAIN, plain_plant
from tests.discovery.joint_generator.unseen import UNSEEN

FREE = np.zeros((2, 5)) + np.array([0.0, 0.0, 0.0, 1e9, 1.0])


def plant(body, coulomb=(0.0, 0.0), duration=2.0):
    return plain_plant({"kind": 0.0, "inertia": 2.0} | body, coulomb, top_speed=5.0, reach=2.0, duration=duration)


def test_a_sliding_mass_comes_to_rest_and_stays():
    """Pushed with 10 N for 0.5 s, 4 N of friction: v = 1.5 m/s, then -2 m/s^2 until it rests after 0.75 s."""
    pushed = np.zeros((2001, 6))
    pushed[:500, 4] = 10.0
    states = simulate(plant({}, (4.0, 0.0)), FREE, pushed, np.zeros(2), 0, 1e-3)
    # the bristle takes up 4 N/(2 kg (1000/s)^2) = 2 um before it slides, in about 2 ms
    assert states[500, 2] == pytest.approx(1.5, abs=3e-3)
    assert states[1000, 2] == pytest.approx(0.5, abs=3e-3)
    assert abs(states[1300:, 2]).max() < 1e-6
    assert np.ptp(states[1300:, 0]) < 1e-8


def test_a_swing_without_friction_keeps_its_energy():
    states = simulate(plant({"inertia": 0.1, "gravity": 3.0}), FREE, np.zeros((2001, 6)), np.array([1.0, 0.0]), 0, 1e-3)
    energy = 0.05 * states[:, 2] ** 2 - 3.0 * np.cos(states[:, 0])
    # midpoint steps of 1e-4 s: (omega h)^2/24 of the potential, omega = sqrt(30)/s
    assert np.ptp(energy) < 3.0 * (math.sqrt(30.0) * 1e-4) ** 2


def test_the_arm_moves_as_mujoco_says(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    made = make(Case("none.right_numbers", "arm", 1.0, 3))
    write(made.case, tmp_path / "set", tmp_path / "truth.json")
    n = made.true.numbers
    body = {k: n[k] for k in ("inertia", "inertia_2", "coupling", "rotor", "rotor_2", "gravity", "gravity_2")}
    free = plain_plant({"kind": ARM} | body, (0.0, 0.0), top_speed=9.0, reach=4.0, duration=1.0)
    states = simulate(free, FREE, np.zeros((10001, 6)), np.array([0.7, -0.4]), 0, 1e-4)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "set" / "model.xml"))
    data = mujoco.MjData(model)
    acceleration = (states[2:, 2:4] - states[:-2, 2:4]) / 2e-4
    for i in range(1000, 9000, 1000):
        data.qpos[:], data.qvel[:], data.qacc[:] = states[i + 1, 0:2], states[i + 1, 2:4], acceleration[i]
        mujoco.mj_inverse(model, data)
        assert data.qfrc_inverse == pytest.approx(np.zeros(2), abs=1e-5 * n["gravity"])  # central differences of 1e-4 s


def test_the_load_of_a_chain_is_moved_by_its_spring_alone():
    """Pushed at the motor with 10 N for 1 s: 10 N s in all, whatever the second row of gains."""
    chain = {"kind": CHAIN, "rotor": 1.0, "inertia": 3.0, "link_stiffness": 500.0, "link_damping": 2.0}
    gains, pushed = FREE.copy(), np.zeros((1001, 6))
    gains[1, 0], pushed[:, 4] = 1e3, 10.0
    v, v_2 = simulate(plant(chain), gains, pushed, np.zeros(2), 0, 1e-3)[-1, 2:4]
    assert 1.0 * v + 3.0 * v_2 == pytest.approx(10.0, rel=1e-9)


def test_a_throw_ends_where_constant_friction_ends_it():
    rng = np.random.default_rng(0)
    x = thrown.record(thrown.Throw(lambda v, x: 0.25), rng)["position [m]"]
    speed = np.random.default_rng(0).uniform(1.1, 1.5)
    rest = 0.5 * (speed**2 - 0.05**2) / (9.81 * 0.25)
    assert x[-1] == pytest.approx(
        rest, abs=0.07 / thrown.RATE + 5.0 * thrown.NOISE
    )  # the last frame comes before the last step


def test_ageing_and_slip_laws_settle_at_the_same_friction():
    """Steady state is mu_0 + (a - b) ln(v/v_0) with every state law."""
    for law in (slider.ageing, slider.slipping):
        test = slider.RateAndState(0.6, 0.01, (0.015,), (1e-5,), law)
        record = slider.record(test, 3000.0, np.array([1e-5, 1e-4]), 0.0, np.random.default_rng(0))
        assert record["friction_coefficient"][-1] == pytest.approx(0.6 - 0.005 * math.log(100.0), abs=1e-5)


@pytest.mark.parametrize("name", [*FORMS, *UNSEEN])
def test_every_form_changes_what_is_recorded(name):
    """With the same seed: another record than the one without the effect, apart from nulls."""
    form = (FORMS | UNSEEN)[name]
    if form.designs[0] in ("slider", "thrown"):
        return
    made = make(Case(name, form.designs[0], 1.0, 1))
    made = replace(made, believed=replace(made.believed, duration=9.0), true=replace(made.true, duration=9.0))
    record = made.record(0)
    assert all(np.all(np.isfinite(x)) for x in record.values())
    states, _ = made.states(0)
    plain, _ = made.states(0, with_effects=False)
    changed = float(np.max(np.abs(states[:, 4] - plain[:, 4]))) * made.believed.gain / made.believed.level
    if form.kind == "none":
        assert changed == 0.0
    else:
        measured = np.max(np.abs(record[next(c for c in record if "position" in c or "angle" in c)] - states[:, 0]))
        drive = next(c for c in record if any(word in c for word in ("force", "torque", "voltage")))
        logged = np.max(np.abs(record[drive] - states[:, 4])) * made.believed.gain
        sensor = made.believed.sensor
        seen = measured > 20.0 * sensor.position or logged > 20.0 * sensor.drive
        assert changed > 0.05 or seen or "temperature" in str(record.keys())


@pytest.mark.parametrize("name", [name for name, form in UNSEEN.items() if form.designs[0] in ("slider", "thrown")])
def test_every_slide_and_slider_of_the_report_is_written(name, tmp_path):
    from stochfric_mb.measurement import load_dataset

    case = Case(name, UNSEEN[name].designs[0], 1.0, 1)
    write(case, tmp_path / "set", tmp_path / "truth.json")
    dataset = load_dataset(tmp_path / "set")
    assert {run.role for run in dataset.runs} == {"fit", "test"}
    assert all(np.isfinite(run.channels["position"]).all() for run in dataset.runs)


@pytest.mark.parametrize("design", [*JOINTS, "slider"])
def test_files_are_what_the_formats_say(design, tmp_path):
    pytest.importorskip("mujoco")
    from stochfric_mb.measurement import load_dataset

    name = "none.constant_friction" if design == "slider" else "none.wrong_numbers"
    write(Case(name, design, 1.0, 0), tmp_path / "set", tmp_path / "truth.json")
    assert tomllib.loads((tmp_path / "set" / "scenario.toml").read_text())["schema"] == "stochfric.scenario/1"
    dataset = load_dataset(tmp_path / "set")
    assert {run.role for run in dataset.runs} == {"fit", "test"}


def test_plan_has_every_form_in_all_its_mechanisms():
    cases = list(joint_plan.cases(range(10)))
    assert len({case.name for case in cases}) == len(cases)
    for name, form in FORMS.items():
        assert {case.design for case in cases if case.forms == name} == set(form.designs)
    assert len(FORMS) >= 60


def test_forms_of_the_report_are_in_no_plan_for_tuning():
    assert not {part.name for case in joint_plan.cases(range(2)) for part in case.parts} & set(UNSEEN)
    cases = list(joint_plan.unseen_cases([2407]))
    assert len({case.name for case in cases}) == len(cases)
    assert {part.name for case in cases for part in case.parts} == set(UNSEEN)
    kinds = [form.kind for form in UNSEEN.values()]
    assert len(UNSEEN) >= 60
    assert min(kinds.count("unknown"), kinds.count("none")) >= 18
    assert {case.design for case in cases} == {*JOINTS, "slider", "thrown"}


def test_summary_counts_what_was_answered():
    name, kind = "viscous_friction.sinh_law", "viscous_friction"
    wrong = judge.Verdict("a", name, kind, "slide", 1.0, False, True, "none", (), False, False, False, True, None, 1.0)
    text = joint_suite.as_markdown([wrong], "t")
    assert "| top-1 name right | 0 (n = 1) | 0.88 |" in text
    assert "| slide | 0 of 1 | 0 of 0 | 0 of 0 |" in text
