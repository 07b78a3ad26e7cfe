"""The generator of driven joints against closed forms and MuJoCo, and its files against the documented formats."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan, joint_suite, judge
from tests.discovery.joint_generator import slider, thrown
from tests.discovery.joint_generator.balance import misfit
from tests.discovery.joint_generator.case import Case, make, write
from tests.discovery.joint_generator.forms import FORMS
from tests.discovery.joint_generator.forms.form import JOINTS
from tests.discovery.joint_generator.integrator import simulate
from tests.discovery.joint_generator.motion import MOTIONS
from tests.discovery.joint_generator.plant import ARM, CHAIN, FACTOR_ON_SPEED, MASS_OF_TIME, ONE_WAY_AT, plain_plant
from tests.discovery.joint_generator.unseen import UNSEEN
from tests.discovery.joint_generator.unseen_fourth import UNSEEN_FOURTH
from tests.discovery.joint_generator.unseen_second import UNSEEN_SECOND
from tests.discovery.joint_generator.unseen_third import UNSEEN_THIRD

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


def test_a_link_that_stiffens_keeps_its_energy():
    chain = {"kind": CHAIN, "rotor": 1.0, "inertia": 3.0, "link_stiffness": 500.0, "link_cubic": 5e4}
    states = simulate(plant(chain), FREE, np.zeros((2001, 6)), np.array([0.1, 0.0]), 0, 1e-3)
    stretch = states[:, 0] - states[:, 1]
    energy = 0.5 * states[:, 2] ** 2 + 1.5 * states[:, 3] ** 2 + 250.0 * stretch**2 + 1.25e4 * stretch**4
    # midpoint steps of 1e-4 s: (omega h)^2 of 3.75 J, omega^2 = (500 + 3 5e4 0.1^2)/0.75 kg
    assert np.ptp(energy) < 3.75 * 2667.0 * 1e-8


def dragged(pulled, wanted_speed=0.5, n=1500):
    """2 kg taken along at a constant speed by a stiff controller, at 0 when the record begins: states every millisecond."""
    gains = np.array([[2e5, 2e3, 1.0, 1e9, 1.0], [0.0, 0.0, 0.0, 1e9, 1.0]])
    wanted = np.zeros((n + 501, 6))
    wanted[:, 0], wanted[:, 2] = wanted_speed * (np.arange(n + 501) - 500) * 1e-3, wanted_speed
    return simulate(pulled, gains, wanted, wanted[0, :2], 500, 1e-3)


def test_wear_grows_with_the_distance_since_the_record_began():
    states = dragged(plant({}, (4.0, 0.0)).with_extra(wear=0.8, wear_distance=0.2))
    gone = states[:, 0] - states[0, 0]
    assert states[:, 6] == pytest.approx(4.0 * (1.0 + 0.8 * (1.0 - np.exp(-gone / 0.2))), abs=4.0 * 0.8 / 0.2 * 1e-4)


def test_friction_by_load_and_speed_is_what_its_numbers_say():
    """Level 4 N; 0.3 of what the drive has beyond 2 N; 0.2 s/m of drive and speed: F = 4 + 0.3 (F - 2) + 0.2 0.5 F."""
    states = dragged(plant({}, (4.0, 0.0)).with_extra(drive_share=0.3, drive_from=2.0, drive_speed=0.2))
    assert states[-1, 4] == pytest.approx((4.0 - 0.6) / (1.0 - 0.3 - 0.1), rel=1e-6)


def test_a_boot_relaxes_to_stiffness_times_its_time():
    """Maxwell at a constant speed: the pull approaches k tau v."""
    states = dragged(plant({}).with_extra(relaxing_stiffness=40.0, relaxing_time=0.1))
    assert states[-1, 4] == pytest.approx(40.0 * 0.1 * 0.5, rel=1e-6)


def test_friction_one_way_is_met_one_way():
    one_way = plant({}, (4.0, 0.0)).add_force_at(lambda q: 3.0 + 0.0 * q, ONE_WAY_AT)
    assert dragged(one_way)[-1, 6] == pytest.approx(7.0)
    assert dragged(one_way, -0.5)[-1, 6] == pytest.approx(-4.0)


def test_a_factor_on_the_part_of_speed_leaves_the_rest():
    thins = plant({}, (4.0, 0.0)).add_by_speed(lambda v: 6.0 * v).times_in_time(FACTOR_ON_SPEED, lambda t: np.exp(-t))
    # in half a bristle's time constant of a millisecond the factor changes by 1e-3
    assert dragged(thins)[-1, 6] == pytest.approx(4.0 + 3.0 * math.exp(-1.5), abs=3e-3)


def test_a_load_that_leaks_is_quicker_under_the_same_force():
    """v = (F/m0) integral dt/(1 - t/4) = 4 (F/m0) ln(4/3) after 1 s."""
    pushed = np.zeros((1001, 6))
    pushed[:, 4] = 10.0
    states = simulate(plant({}).times_in_time(MASS_OF_TIME, lambda t: 1.0 - t / 4.0), FREE, pushed, np.zeros(2), 0, 1e-3)
    # tables of time are read where a step of 1e-4 s begins: half a step late, while a grows from 5 to 6.67 m/s^2
    assert states[-1, 2] == pytest.approx(5.0 * 4.0 * math.log(4.0 / 3.0), abs=1.67 * 0.5e-4 + 1e-6)


@pytest.mark.parametrize(
    ("extra", "given"),
    [
        ({"bend": 5.0}, lambda u, v: u / (1.0 + (u / 5.0) ** 2) ** 0.25),
        ({"limit_forward": 5.0}, lambda u, v: np.minimum(u, 5.0)),
        ({"base_speed": 0.5}, lambda u, v: u * np.minimum(1.0, 0.5 / np.maximum(np.abs(v), 1e-9))),
    ],
)
def test_a_motor_gives_what_its_curve_says(extra, given):
    pushed = np.zeros((1001, 6))
    pushed[:, 4] = 10.0 * np.sin(2.0 * math.pi * np.arange(1001) * 1e-3)
    states = simulate(plant({}).with_extra(**extra), FREE, pushed, np.zeros(2), 0, 1e-3)
    # what is given stands beside the next command; 5 m/s^2 change the speed by 2.5e-4 m/s in half a step of 1e-4 s
    assert states[1:, 7] == pytest.approx(given(states[:-1, 4], states[1:, 2]), abs=10.0 / 0.5 * 2.5e-4 + 1e-9)


def test_an_actuator_with_play_follows_half_its_gap_behind():
    pushed = np.zeros((1001, 6))
    pushed[:, 4] = 10.0 * np.sin(2.0 * math.pi * np.arange(1001) * 1e-3)
    states = simulate(plant({}).with_extra(play=2.0), FREE, pushed, np.zeros(2), 0, 1e-3)
    given, command = states[1:, 7], states[:-1, 4]
    assert given[100:240] == pytest.approx(command[100:240] - 2.0)
    # falls by the whole gap of 4 N from 10 N on: until 2 pi t = pi - asin(0.6), t = 0.398 s, it stays
    assert given[255:395] == pytest.approx(8.0, abs=1e-3)
    assert given[400:740] == pytest.approx(command[400:740] + 2.0)


def test_a_tendon_pulls_by_the_angle_of_the_other_joint():
    gains = np.array([[2e3, 60.0, 0.0, 1e9, 1.0], [2e3, 60.0, 0.0, 1e9, 1.0]])
    body = {"kind": ARM, "inertia": 0.5, "inertia_2": 0.2, "coupling": 0.1, "rotor": 0.05, "rotor_2": 0.05}
    wanted = np.zeros((3001, 6))
    wanted[:, :2] = (0.3, 0.5)
    crossed = plant(body).with_extra(other_place=7.0)
    states = simulate(crossed, gains, wanted, np.array([0.3, 0.5]), 0, 1e-3)
    assert states[-1, 4] == pytest.approx(7.0 * 0.5, rel=1e-6)


@pytest.mark.parametrize("name", MOTIONS)
def test_motions_keep_within_reach_and_speed(name):
    times = np.arange(-1000, 8001) * 1e-3
    q, v = MOTIONS[name](np.random.default_rng(3), times, 0.2, 0.7)
    # sines: shares sum to 1.15 at most
    assert np.abs(q).max() <= 0.2 * 1.15 + 1e-9
    assert np.abs(v).max() <= 0.7 * 1.15 + 1e-9
    # trapezoids: the acceleration jumps by up to 4/0.75 v^2/reach
    assert np.gradient(q, times)[2:-2] == pytest.approx(v[2:-2], abs=1e-3 * 4.0 / 0.75 * 0.7**2 / 0.2)


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


def test_a_slider_without_memory_follows_the_logarithm_of_speed():
    """mu_0 + a ln(v/v_0), once the spring has caught up: a/(k v) = 0.17 s."""
    record = slider.record(slider.RateAndState(0.6, 0.005), 3000.0, np.array([1e-6, 1e-5]), 0.0, np.random.default_rng(0))
    assert record["friction_coefficient"][-1] == pytest.approx(0.6 + 0.005 * math.log(10.0), abs=1e-6)


@pytest.mark.parametrize("name", [*FORMS, *UNSEEN, *UNSEEN_SECOND, *UNSEEN_THIRD, *UNSEEN_FOURTH])
def test_every_form_changes_what_is_recorded(name):
    """With the same seed: another record than the one without the effect, apart from nulls."""
    form = (FORMS | UNSEEN | UNSEEN_SECOND | UNSEEN_THIRD | UNSEEN_FOURTH)[name]
    if form.designs[0] in ("slider", "thrown"):
        return
    made = make(Case(name, form.designs[0], 1.0, 1))
    made = replace(made, nominal=replace(made.nominal, duration=9.0), true=replace(made.true, duration=9.0))
    record = made.record(0)
    assert all(np.all(np.isfinite(x)) for x in record.values())
    states, _ = made.states(0)
    plain, _ = made.states(0, with_effects=False)
    changed = float(np.max(np.abs(states[:, 4] - plain[:, 4]))) * made.nominal.gain / made.nominal.level
    if form.kind == "none":
        assert changed == 0.0
    else:
        states = states[: record["time [s]"].size]  # rows may be lost
        measured = np.max(np.abs(record[next(c for c in record if "position" in c or "angle" in c)] - states[:, 0]))
        drive = next(c for c in record if any(word in c for word in ("force", "torque", "voltage")))
        logged = np.max(np.abs(record[drive] - states[:, 4])) * made.nominal.gain
        sensor = made.nominal.sensor
        seen = measured > 20.0 * sensor.position or logged > 20.0 * sensor.drive
        clock = np.ptp(np.diff(record["time [s]"])) < 1e-9 and abs(record["time [s]"][1] * made.nominal.rate - 1.0) > 0.01
        assert changed > 0.05 or seen or clock or "temperature" in str(record.keys())


@pytest.mark.parametrize(
    "name",
    [
        name
        for name, form in (UNSEEN_SECOND | UNSEEN_THIRD | UNSEEN_FOURTH).items()
        if form.kind != "none" and form.designs[0] in JOINTS
    ],
)
def test_a_form_of_half_strength_is_visible(name):
    """A fit of the believed balance, its numbers within their uncertainty, is worse by six standard deviations or more."""
    made = make(Case(name, (UNSEEN_SECOND | UNSEEN_THIRD | UNSEEN_FOURTH)[name].designs[0], 0.5, 1))
    plain, noise = replace(made, effects=()), made.nominal.sensor.drive
    # noise of a block as the fit without the effect shows it: some 150 blocks in each of two runs or more
    noise *= math.sqrt(misfit(plain, noise) / 300.0)
    assert misfit(made, noise) - misfit(plain, noise) > 6.0**2


BRIEF = {
    name: form.designs[0]
    for name, form in (UNSEEN | UNSEEN_SECOND | UNSEEN_THIRD | UNSEEN_FOURTH).items()
    if form.designs[0] in ("slider", "thrown")
}


@pytest.mark.parametrize("name", BRIEF)
def test_every_slide_and_slider_of_the_report_is_written(name, tmp_path):
    from stochfric_mb.measurement import load_dataset

    case = Case(name, BRIEF[name], 1.0, 1)
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


@pytest.mark.parametrize(("series", "least", "of_each"), [(1, 60, 18), (2, 60, 18), (3, 32, 8), (4, 21, 5)])
def test_forms_of_the_report_are_in_no_plan_for_tuning(series, least, of_each):
    forms, _ = joint_plan.SERIES[series]
    assert not {part.name for case in joint_plan.cases(range(2)) for part in case.parts} & set(forms)
    cases = list(joint_plan.unseen_cases([2407], series))
    assert len({case.name for case in cases}) == len(cases)
    assert {part.name for case in cases for part in case.parts} == set(forms)
    kinds = [form.kind for form in forms.values()]
    assert len(forms) >= least
    assert min(kinds.count("unknown"), kinds.count("none")) >= of_each
    assert {case.design for case in cases} == {*JOINTS, "slider", "thrown"}


@pytest.mark.parametrize(
    ("series", "earlier"),
    [(2, FORMS | UNSEEN), (3, FORMS | UNSEEN | UNSEEN_SECOND), (4, FORMS | UNSEEN | UNSEEN_SECOND | UNSEEN_THIRD)],
)
def test_a_later_set_shares_no_form_and_has_both_strengths(series, earlier):
    assert not set(joint_plan.SERIES[series][0]) & set(earlier)
    strengths = {}
    for case in joint_plan.unseen_cases([2407], series):
        strengths.setdefault(case.forms, set()).add(case.strength)
    assert all(seen == {0.5, 1.0} for forms, seen in strengths.items() if not forms.startswith("none"))


def test_summary_counts_what_was_answered():
    name, kind = "viscous_friction.sinh_law", "viscous_friction"
    wrong = judge.Verdict("a", name, kind, "slide", 1.0, False, True, "none", (), False, False, False, True, None, 1.0)
    text = joint_suite.as_markdown([wrong], "t")
    assert "| top-1 name right | 0 (n = 1) | 0.88 |" in text
    assert "| slide | 0 of 1 | 0 of 0 | 0 of 0 |" in text
