"""The check of somebody's MuJoCo model: numbers against plain simulations and closed forms, and its manners."""

import importlib.util
import json
import math
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

mujoco = pytest.importorskip("mujoco")

from stochfric_mb.__main__ import main  # noqa: E402
from stochfric_mb.errors import InputError, SimulationError  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.mujoco import add_friction  # noqa: E402
from stochfric_mb.mujoco.check import check, sites  # noqa: E402

G = 9.81
ANGLE = math.radians(20.0)
MU = 0.8
LOAD = math.tan(ANGLE) / MU
BOX = f"""<mujoco model="incline"><option timestep="{{dt}}" gravity="{{gx}} 0 {{gz}}"/><worldbody>
<geom name="floor" type="plane" size="5 5 1" friction="{MU}"/>
<body name="box" pos="0 0 .05"><freejoint/><geom {{name}} type="box" size=".05 .05 .05" mass="1" friction="{MU}"/></body>
</worldbody></mujoco>"""
HINGE = """<mujoco><option timestep="0.002" gravity="0 0 0"/><worldbody><body>
<joint name="hinge" type="hinge" axis="0 1 0" frictionloss="1"/><geom size=".1" mass="1" pos=".2 0 0"/></body></worldbody>
{more}</mujoco>"""
SMOOTH = """<mujoco><worldbody><geom type="plane" size="1 1 1" condim="1"/>
<body pos="0 0 .1"><freejoint/><geom size=".1" condim="1"/></body></worldbody></mujoco>"""


def incline(angle=ANGLE, dt=0.002, name='name="box"'):
    return BOX.format(dt=dt, gx=G * math.sin(angle), gz=-G * math.cos(angle), name=name)


def checked(text, **options):
    return check(mujoco.MjSpec.from_string(text), **options)


def only(result):
    assert len(result.rows) == 1
    return result.rows[0]


def invoke(*words):
    return CliRunner().invoke(main, ["check", *map(str, words)])


# --- contact pairs ---------------------------------------------------------------------------------------------------


def test_a_box_on_an_incline():
    row = only(checked(incline()))
    assert (row.kind, row.names, row.unit) == ("contact", ("box", "floor"), "m")
    assert row.normal_force == pytest.approx(G * math.cos(ANGLE), rel=1e-3)  # rests, but for the native creep
    assert row.limit == pytest.approx(MU * row.normal_force)
    assert row.native.own.load == pytest.approx(LOAD, rel=1e-3)
    assert [round(d.load, 2) for d in row.native.held] == [0.5, 0.9]
    # The native creep, measured in a plain simulation of 9 s: 13 to 15 mm.
    model = mujoco.MjModel.from_xml_string(incline())
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    start = data.qpos[0]
    mujoco.mj_step(model, data, nstep=4500)
    assert data.qpos[0] - start > 0.01
    assert row.native.own.speed == pytest.approx((data.qpos[0] - start) / 9.0, rel=0.05)  # corners take turns
    assert row.native.held[1].speed > row.native.held[0].speed > row.native.own.speed
    # Ours holds, with the default e_lim.
    assert row.mode == "solver"
    for drift in (row.ours.own, *row.ours.held):
        assert abs(drift.speed) < 1e-8
    assert row.ours.held[1].load == pytest.approx(0.9, abs=0.01)
    assert row.ours.break_away.share == pytest.approx(1.0, abs=1e-3)  # mu_k = mu_s: the peak is flat
    assert row.ours.slide.mass == pytest.approx(1.0, rel=1e-6)  # sliding as a whole, although a push below also pitches it
    assert row.ours.slide.deceleration == pytest.approx(MU * G * math.cos(ANGLE), rel=0.04)  # the corners' loads settle
    assert row.ours.slide.expected == pytest.approx(MU * G * math.cos(ANGLE), rel=0.01)
    assert row.ours.energy_created < row.limit * row.law.e_lim  # twice what the spring can store
    assert "add_friction(spec, ('box', 'floor'), ElasticStick(mu_s=0.8, mu_k=0.8))" in row.advice
    assert "creeps" in row.advice


def test_the_step_limit_is_that_of_the_law_with_the_lightest_mass():
    row = only(checked(incline(), duration=0.1))
    # A force at a corner of a cube of side 2a in its face's plane moves 1/m + a^2/I (pitch) + a^2/I or 2 a^2/I (yaw),
    # with I = (2/3) m a^2: at most 1/m (1 + 1.5 (1 + 2)) in the direction square to the diagonal.
    assert row.mass == pytest.approx(1.0 / 5.5, rel=1e-3)
    assert row.step_limit == row.law.step_limit(row.normal_force, row.mass)
    assert row.step_limit == ElasticStick(MU, MU).step_limit(row.normal_force, row.mass)
    assert row.mode == "solver"


def test_mu_k_ratio_changes_the_slide_and_not_the_break_away():
    row = only(checked(incline(angle=0.0), mu_k_ratio=0.5, duration=0.2))
    assert row.law.mu_k == 0.5 * MU
    # The force is averaged over 2 % of a ramp to 1.4 of the limit: the peak appears lower by up to 0.014.
    assert 0.985 < row.ours.break_away.share < 1.001
    assert row.ours.slide.expected == pytest.approx(0.5 * MU * G, rel=0.01)
    assert row.ours.slide.deceleration == pytest.approx(0.5 * MU * G, rel=0.05)


def test_geoms_without_a_name_are_named_in_the_copy_only():
    spec = mujoco.MjSpec.from_string(incline(name=""))
    row = only(check(spec, duration=0.1, settle=0.5))
    assert row.names == ("geom_1", "floor")
    assert row.ours is not None
    assert "it needs a name first: here geom_1" in row.advice
    assert [g.name for g in spec.geoms] == ["floor", ""]
    assert not list(spec.pairs)


@pytest.mark.parametrize(
    ("joint", "reason"),
    [
        ('<joint type="slide" axis="0 0 1"/>', "cannot slide"),
        ('<joint type="slide" axis="0 0 1" range="-1 1"/><joint type="slide" axis="1 0 0"/>', ""),
    ],
)
def test_freedom_along_the_surface(joint, reason):
    text = f"""<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/><body pos="0 0 .05">{joint}
    <geom name="box" type="box" size=".05 .05 .05"/></body></worldbody></mujoco>"""
    row = only(checked(text, settle=0.5, duration=0.1))
    assert row.problem.startswith(reason)
    assert (row.native is None) == bool(reason)
    assert row.advice.startswith("not probed: " + reason) or not reason


def test_a_bouncing_ball_flickers():
    text = """<mujoco><option timestep="0.001"/><worldbody><geom name="floor" type="plane" size="1 1 1" solref="-1e5 0"/>
    <body pos="0 0 .06"><freejoint/><geom name="ball" size=".05" solref="-1e5 0"/></body></worldbody></mujoco>"""
    row = only(checked(text, settle=1.0, duration=0.1))
    assert "flickers" in row.problem
    assert row.native is None
    assert row.ours is None


def test_a_slide_of_a_hopping_box_is_that_of_its_momentum():
    row = only(checked(incline(angle=0.0), settle=0.5, duration=0.1))
    # MuJoCo's pyramids lift a sliding box: it hops, and friction acts on landing only.
    assert row.native.slide.touching < 1.0
    assert "hops" in " ".join(row.native.notes)
    assert 0.3 * MU * G < row.native.slide.deceleration < 1.7 * MU * G
    assert row.ours.slide.touching == 1.0
    assert row.ours.slide.deceleration == pytest.approx(MU * G, rel=0.07)  # its normal force settles within the 10 steps


def test_several_coefficients_and_a_mocap_body():
    text = """<mujoco><worldbody><body name="table" mocap="true"><geom name="table" type="box" size="1 1 .05"/></body>
    <body pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".05 .05 .05"/></body></worldbody>
    <contact><pair geom1="table" geom2="box" condim="3" friction=".8 .2 .005 .0001 .0001"/></contact></mujoco>"""
    result = checked(text, settle=0.5, duration=0.05)
    assert only(result).names == ("box", "table")  # what can move comes first
    assert result.notes == ("box - table has two sliding coefficients, 0.8 and 0.2; the first is used",)


def test_a_ball_joint_has_three_lines():
    text = """<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="b" type="ball" frictionloss=".5"/>
    <geom size=".1" pos=".2 0 0"/></body></worldbody></mujoco>"""
    rows = checked(text, settle=0.0, duration=0.05).rows
    assert [(r.name, r.unit) for r in rows] == [("b[0]", "rad"), ("b[1]", "rad"), ("b[2]", "rad")]
    assert all("ball or free joint" in r.ours_problem for r in rows)


def test_what_switches_passive_forces_off_is_said():
    text = (
        incline()
        .replace("</option>", "")
        .replace("/><worldbody>", '><flag spring="disable" damper="disable"/></option><worldbody>')
    )
    row = only(checked(text, settle=0.2, duration=0.05))
    assert row.native is not None
    assert "leaves out all passive forces" in row.ours_problem
    assert row.ours_problem in row.advice


def test_a_solver_that_stops_early_is_said():
    text = incline().replace("<option", '<option iterations="2" tolerance="0"')
    assert any("stopped at option.iterations = 2 in " in note for note in checked(text, settle=0.2, duration=0.05).notes)
    assert not any("iterations" in note for note in checked(incline(), settle=0.2, duration=0.05).notes)


@pytest.mark.parametrize(
    ("step", "integrator", "ratio"), [("1e-2", "implicitfast", 5.0), ("2e-3", "implicitfast", 0.0), ("3e-3", "RK4", 1.5)]
)
def test_damping_with_which_nothing_holds_is_said(step, integrator, ratio):
    text = f"""<mujoco><option timestep="{step}" integrator="{integrator}" cone="elliptic"/><worldbody>
      <body name="table"><joint name="x" type="slide" axis="1 0 0"/>
        <geom name="table" type="box" size=".3 .3 .02" mass="2"/></body>
      <body pos="0 0 .07"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/></body></worldbody>
      <actuator><position joint="x" kp="20000" kv="1000"/></actuator></mujoco>"""
    notes = checked(text, settle=0.2, duration=0.05).notes
    said = [note for note in notes if "h kv/m" in note]
    assert len(said) == (1 if ratio else 0)
    assert all(f"h kv/m = {ratio:g} " in note for note in said)


def test_pairs_that_never_touch_are_named():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/><geom name="wall" size=".1" pos="9 0 0"/>
        <body pos="0 0 .05"><freejoint/><geom name="box" type="box" size=".05 .05 .05"/></body>
        <body pos="0 0 9"><joint type="slide" axis="1 0 0"/><geom name="kite" size=".1"/></body></worldbody>
        <contact><pair geom1="kite" geom2="floor"/></contact></mujoco>"""
    )
    add_friction(spec, ("box", "wall"), Coulomb(0.8, 0.6))
    add_friction(spec, ("box", "floor"), Coulomb(0.8, 0.6))
    notes = check(spec, settle=0.1, duration=0.1).notes
    (note,) = (n for n in notes if "never touched" in n)
    assert "never touched in 0.1 s" in note
    assert ": box x wall, floor x kite;" in note
    assert "1 touching pair has friction of this package already" in notes


def test_only_the_most_loaded_pairs_are_probed():
    boxes = "".join(
        f'<body pos="{i} 0 .05"><freejoint/><geom name="b{i}" type="box" size=".05 .05 .05" mass="{1 + i}"/></body>'
        for i in range(3)
    )
    text = f'<mujoco><worldbody><geom name="f" type="plane" size="9 9 1"/>{boxes}</worldbody></mujoco>'
    rows = checked(text, settle=0.2, duration=0.05, most=1).rows
    assert [r.names[0] for r in rows] == ["b2", "b1", "b0"]
    assert [r.native is not None for r in rows] == [True, False, False]
    assert "only the 1 most loaded" in rows[1].problem


# --- joints and tendons ----------------------------------------------------------------------------------------------


def test_a_hinge_with_frictionloss_creeps():
    row = only(checked(HINGE.format(more="")))
    assert (row.kind, row.name, row.unit, row.limit) == ("joint", "hinge", "rad", 1.0)
    assert row.native.held[1].load == pytest.approx(0.9, abs=0.01)
    # MuJoCo's softened friction slides at a speed proportional to the load: it never holds.
    assert row.native.held[1].speed == pytest.approx(1.8 * row.native.held[0].speed, rel=0.02)
    assert row.native.held[1].speed > 1e-3
    assert row.native.break_away.share == pytest.approx(1.0, abs=0.01)
    inertia = 1.0 * 0.2**2 + 0.4 * 0.1**2
    assert row.native.slide.mass == pytest.approx(inertia, rel=1e-9)
    assert row.native.slide.deceleration == pytest.approx(1.0 / inertia, rel=0.02)
    # Ours is implicit in the velocity: it holds, to rounding over the step.
    assert all(abs(d.speed) < 1e-9 for d in (row.ours.own, *row.ours.held))
    assert row.ours.held[1].load == pytest.approx(0.9, abs=1e-3)
    assert row.ours.break_away.share == pytest.approx(1.0, abs=1e-3)
    assert row.ours.slide.deceleration == pytest.approx(1.0 / inertia, rel=0.02)
    assert row.ours.energy_created == pytest.approx(0.0, abs=1e-5)  # N e_lim/2 is what its spring can store
    assert "creeps" in row.advice
    assert "add_friction(spec, Joint('hinge'), ElasticStick(mu_s=1, mu_k=1), normal_force=1)" in row.advice


def test_a_load_that_a_neighbour_carries():
    tendon = '<tendon><fixed name="cable" frictionloss=".3"><joint joint="hinge" coef="2"/></fixed></tendon>'
    rows = checked(HINGE.format(more=tendon), settle=0.1, duration=0.1).rows
    assert [(r.kind, r.name) for r in rows] == [("joint", "hinge"), ("tendon", "cable")]
    assert "no break-away up to 140 % of the limit" in rows[1].ours.notes  # the hinge holds 1 N m, the load is 0.84


@pytest.mark.parametrize("side", [-2.0, 2.0])
def test_a_joint_is_probed_in_the_direction_of_its_load(side):
    """Against it, friction at its limit once read as a load of -100 %, and slides as -1e7 % of what was due."""
    text = HINGE.format(more="").replace("hinge", "slide").replace("0 0 0", f"0 {side} 0", 1)
    row = only(checked(text.replace('frictionloss="1"', 'frictionloss="4"')))
    for findings in (row.native, row.ours):
        assert findings.own.load == pytest.approx(0.5, abs=0.01)
        assert findings.break_away.share == pytest.approx(1.0, abs=0.03)
        assert findings.slide.deceleration == pytest.approx(findings.slide.expected, rel=0.05)


def test_what_swings_by_itself_is_not_probed():
    text = HINGE.format(more="").replace("0 0 0", "0 0 -9.81", 1).replace('frictionloss="1"', 'frictionloss=".02"')
    row = only(checked(text, settle=0.2))
    assert "not at rest: moves by up to" in row.advice
    assert row.native is None


def test_short_steps_make_short_holds():
    assert checked(SMOOTH, settle=0.1).duration == 0.5
    short = SMOOTH.replace("<worldbody>", '<option timestep="1e-4"/><worldbody>')
    assert checked(short, settle=0.1).duration == pytest.approx(0.05)


def test_what_slides_already_is_not_held():
    text = HINGE.format(more="").replace("hinge", "slide").replace('gravity="0 0 0"', 'gravity="0 9.81 0"')
    row = only(checked(text, settle=0.2, duration=0.1))
    assert row.unit == "m"
    assert row.native.own.load == pytest.approx(1.0, abs=1e-3)
    assert row.native.held == (None, None)
    assert "slides in the given state: nothing to hold" in row.native.notes
    assert "creeps" not in row.advice


def test_a_tendon_with_frictionloss():
    tendon = '<tendon><fixed name="cable" frictionloss=".3"><joint joint="hinge" coef="2"/></fixed></tendon>'
    cable = only(checked(HINGE.format(more=tendon).replace('frictionloss="1"', ""), settle=0.1))
    assert (cable.kind, cable.name, cable.unit) == ("tendon", "cable", "m")
    assert cable.native.held[1].speed > 1e-3
    assert abs(cable.ours.held[1].speed) < 1e-9
    assert cable.ours.break_away.share == pytest.approx(1.0, abs=1e-3)
    assert cable.limit == pytest.approx(0.3)
    assert cable.native.slide.mass == pytest.approx((0.2**2 + 0.4 * 0.1**2) / 4.0, rel=1e-9)  # seen through coef 2


# --- manners ---------------------------------------------------------------------------------------------------------


def test_no_friction_is_said_so(tmp_path):
    assert checked(SMOOTH, settle=0.5).rows == ()
    (tmp_path / "smooth.xml").write_text(SMOOTH)
    out = invoke(tmp_path / "smooth.xml", "--settle", 0.5, "--out", tmp_path)
    assert out.exit_code == 0
    assert "nothing to check" in out.stdout
    assert "1 touching pair has no friction" in out.stdout
    assert json.loads((tmp_path / "check.json").read_text())["rows"] == []


def test_the_command_writes_a_table_and_json(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("incline.xml").write_text(incline())
    words = ("incline.xml", "--settle", 0.5, "--duration", 0.1)
    out = invoke(*words)
    assert out.exit_code == 0, out.output
    for text in ("box - floor", "native", "ours", "What to change", "add_friction(spec"):
        assert text in out.stdout
    content = json.loads(Path("check.json").read_text())
    assert content["schema"] == "stochfric.check/1"
    assert content["timestep"] == 0.002
    (row,) = content["rows"]
    assert row["native"]["own"]["speed"] > 1e-4
    assert row["law"]["kind"] == "elastic_stick"
    again = invoke(*words)
    assert again.exit_code == 2
    assert "check.json exists" in again.stderr
    assert invoke(*words, "--force").exit_code == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["check.json", "incline.xml"]  # no MUJOCO_LOG.TXT either


def test_bundled_models(tmp_path):
    out = invoke("incline", "--settle", 0.2, "--duration", 0.05, "--out", tmp_path)
    assert out.exit_code == 0, out.output
    assert "box - floor" in out.stdout
    assert check("belt_box", settle=0.1).rows == ()  # its friction is added by this package


@pytest.mark.parametrize(
    ("content", "words", "message"),
    [
        (None, (), "no such file"),
        ("<mujoco><worldbody><geom sise='1'/></worldbody></mujoco>", (), "is no model that MuJoCo can load"),
        ("no xml", (), "is no model that MuJoCo can load"),
        ("<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>", (), "does not compile"),
        (SMOOTH, ("--keyframe", "home"), "the model has no keyframes"),
        (SMOOTH, ("--law", "elastick_stick"), "did you mean 'elastic_stick'"),
        (SMOOTH, ("--mu-k-ratio", "1.5"), "mu_k_ratio"),
        (SMOOTH, ("--duration", "0"), "duration"),
        (SMOOTH, ("--settle", "nan"), "settle"),
    ],
)
def test_errors_are_one_line_and_exit_code_2(tmp_path, content, words, message):
    path = tmp_path / "model.xml"
    if content is not None:
        path.write_text(content)
    out = invoke(path, *words, "--out", tmp_path / "out.json")
    assert out.exit_code == 2, out.output
    assert message in out.stderr
    assert out.stderr.count("\n") == 1
    assert not (tmp_path / "out.json").exists()


def test_a_model_that_breaks_by_itself():
    with pytest.raises(SimulationError, match="the model itself breaks"):
        checked(incline().replace("<freejoint/>", '<joint type="slide" stiffness="1e9" axis="0 0 1"/>'))


def test_keyframes():
    key = '<keyframe><key name="up" qpos="0 0 .05 1 0 0 0"/><key qpos="0 0 3 1 0 0 0"/></keyframe></mujoco>'
    text = incline().replace("</mujoco>", key)
    assert len(checked(text, keyframe="up", settle=0.1, duration=0.05).rows) == 1
    assert checked(text, keyframe="1", settle=0.1, duration=0.05).rows == ()  # still in the air
    with pytest.raises(InputError, match="did you mean 'up'"):
        checked(text, keyframe="upp")


def test_a_binary_model_is_measured_but_not_changed(tmp_path):
    model = mujoco.MjModel.from_xml_string(incline())
    mujoco.mj_saveModel(model, str(tmp_path / "m.mjb"))
    row = only(check(tmp_path / "m.mjb", settle=0.5, duration=0.1))
    assert row.native.own.speed > 1e-4
    assert row.ours is None
    assert "binary model" in row.ours_problem


def test_urdf(tmp_path):
    (tmp_path / "ball.urdf").write_text(
        """<robot name="r"><link name="base"/><link name="arm"><inertial><mass value="1"/>
        <inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" type="revolute">
        <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="1" velocity="1"/>
        <dynamics friction="0.5"/></joint></robot>"""
    )
    row = only(check(tmp_path / "ball.urdf", settle=0.1))
    assert (row.kind, row.name, row.limit) == ("joint", "j", 0.5)


@pytest.mark.parametrize("kind", ["havsin", "coulomb", "lugre"])
def test_other_laws_run_or_say_why_not(kind):
    for text in (incline(), HINGE.format(more="")):
        row = only(checked(text, law=kind, settle=0.3, duration=0.05))
        assert (row.ours is None) == bool(row.ours_problem)
        assert row.law.kind == kind


# --- the parts -------------------------------------------------------------------------------------------------------


def test_a_kick_slides_a_box_without_turning_or_lifting_it():
    model = mujoco.MjModel.from_xml_string(incline(angle=0.0))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    mujoco.mj_forward(model, data)
    site = sites.ContactPair((1, 0), ("box", "floor"), MU, (1.0, 0.0, 0.0))
    change, mass = sites.kick(model, data, site.sample(model, data).row)
    assert change == pytest.approx([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], abs=1e-6)
    assert mass == pytest.approx(1.0, rel=1e-6)


def test_signs_and_power_of_native_friction():
    model = mujoco.MjModel.from_xml_string(incline(angle=0.0))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    data.qvel[0] = 0.3
    mujoco.mj_forward(model, data)
    box = sites.ContactPair((1, 0), ("box", "floor"), MU, (1.0, 0.0, 0.0)).sample(model, data)
    assert box.velocity == pytest.approx(0.3, abs=1e-3)
    assert box.resistance > 0.0
    assert box.power == pytest.approx(-box.resistance * box.velocity, rel=0.05)  # the corners' velocities differ a little
    floor = sites.ContactPair((0, 1), ("floor", "box"), MU, (1.0, 0.0, 0.0)).sample(model, data)
    assert (floor.velocity, floor.resistance, floor.power) == pytest.approx((-box.velocity, -box.resistance, box.power))


def test_a_belt_counts_in_the_sliding_velocity():
    text = incline(angle=0.0).replace('type="plane"', 'type="plane" surfacevel=".2 0 0 0 0 0"')
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[2] = 0.0499
    mujoco.mj_forward(model, data)
    for geoms in ((1, 0), (0, 1)):
        sample = sites.ContactPair(geoms, ("", ""), MU, (1.0, 0.0, 0.0)).sample(model, data)
        assert abs(sample.velocity) == pytest.approx(0.2)
        assert sample.power < 0.0
    box = sites.ContactPair((1, 0), ("", ""), MU, (1.0, 0.0, 0.0)).sample(model, data)
    assert box.velocity == pytest.approx(-0.2)  # the box lags behind the belt
    assert np.isfinite(box[:-1]).all()


# --- other people's models -------------------------------------------------------------------------------------------


def gymnasium_model(name):
    result = importlib.util.find_spec("gymnasium")
    if result is None:
        pytest.skip("gymnasium is not installed: its models are not here")
    return Path(result.submodule_search_locations[0]) / "envs" / "mujoco" / "assets" / f"{name}.xml"


def check_gymnasium(name, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # so short a look at it says little
        check(gymnasium_model("hopper"), settle=0.01, duration=0.01)  # what is compiled for the first model is not counted
    began = time.process_time()
    result = check(gymnasium_model(name), **options)
    assert time.process_time() - began < 60.0
    json.dumps(result.to_dict(), allow_nan=False)
    assert result.rows
    for row in result.rows:
        assert row.advice
        assert (row.native is None) == bool(row.problem)
        for probe in (row.native, row.ours):
            assert probe is None or probe.energy_dissipated > -1e-6
    assert any(row.native is not None for row in result.rows)
    return result


def test_half_cheetah_in_short():
    rows = check_gymnasium("half_cheetah", settle=1.0, duration=0.2).rows
    assert {row.name for row in rows} == {"ffoot - floor", "bfoot - floor"}
    assert all(row.native.held[1].speed > 10 * abs(row.ours.held[1].speed) for row in rows)


@pytest.mark.long
@pytest.mark.parametrize("name", ["ant", "humanoid", "half_cheetah", "walker2d"])
def test_gymnasium_models(name):
    check_gymnasium(name)
