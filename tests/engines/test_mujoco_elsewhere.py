"""MuJoCo: friction of one pair leaves the rest of the model alone, whatever cone, Jacobian, solver and integrator it has."""

import itertools
import subprocess
import sys

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.lugre import Lugre  # noqa: E402
from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.scenario import load_scenario  # noqa: E402

G = 9.81
SCENE = """<mujoco><option timestep="1e-3" {options}/><worldbody><geom name="floor" type="plane" size="50 50 1"/>
<geom name="other" type="plane" size="50 50 1" pos="0 0 0" contype="2" conaffinity="2"/>
{ours}
<body pos="0 5 .0499"><freejoint/><geom type="box" size=".05 .05 .05" mass="1" condim="4" friction=".5 .01 .001" contype="2"
conaffinity="2"/></body>
<body pos="0 7 .0999"><freejoint/><geom type="sphere" size=".1" mass="1" condim="6" friction=".5 .01 .01" contype="2"
conaffinity="2"/></body>
<body pos="0 9 1"><joint name="hinge" axis="0 1 0" frictionloss=".2" limited="true" range="-40 40"/>
<geom type="capsule" fromto="0 0 0 0 0 -.5" size=".02" mass="1" contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
OURS = """<body pos="0 0 .0499"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
<geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>"""
MODES = [(ElasticStick(0.8, 0.5), "explicit"), (ElasticStick(0.8, 0.5), "solver"), (Coulomb(0.8, 0.5), "solver")]
FIRST_STEPS = 1e-3
"""A stuck contact that is given 3 m/s slides from there on: the normal force is off in the first of 500 steps."""
CONES, JACOBIANS = ("pyramidal", "elliptic"), ("dense", "sparse")


def run(ours, law, mode, options):
    spec = mujoco.MjSpec.from_string(SCENE.format(ours=OURS if ours else "", options=options))
    if ours:
        engine.add_friction(spec, ("box", "floor"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    first = 2 if ours else 0
    mujoco.mj_step(model, data, nstep=500)  # to rest: until then normal forces change
    if ours:
        data.qvel[0] = 3.0
    data.qvel[first : first + 3] = 1.0, 0.3, 0.0
    data.qvel[first + 5] = 4.0
    data.qvel[first + 6 : first + 9] = 2.0, 0.0, 0.0
    data.qvel[first + 12] = 3.0
    mujoco.mj_step(model, data)  # explicit friction is still stuck in this one
    speed = float(data.qvel[0])
    mujoco.mj_step(model, data, nstep=499)
    return (speed - data.qvel[0], data.qpos[2:].copy()) if ours else (0.0, data.qpos.copy())


@pytest.mark.parametrize(("cone", "jacobian"), list(itertools.product(CONES, JACOBIANS)))
@pytest.mark.parametrize(("law", "mode"), MODES)
def test_the_rest_of_the_model_moves_as_without_us(law, mode, cone, jacobian):
    cone = "elliptic" if mode == "solver" else cone  # which add_friction makes of it
    options = f'cone="{cone}" jacobian="{jacobian}" tolerance="1e-14" iterations="200" ls_iterations="100"'
    _, alone = run(False, law, mode, options)
    lost, rest = run(True, law, mode, options)
    assert lost == pytest.approx(0.5 * G * 0.499, rel=1e-6 if mode == "explicit" else FIRST_STEPS)
    assert np.abs(rest - alone).max() < 1e-7  # what the solver's tolerance makes of bodies that slide, spin and roll


@pytest.mark.parametrize("solver", ["Newton", "CG", "PGS"])
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "RK4"])
@pytest.mark.parametrize(("law", "mode"), MODES)
def test_solvers_and_integrators(law, mode, integrator, solver):
    options = f'cone="elliptic" solver="{solver}" integrator="{integrator}" iterations="500" tolerance="1e-12"'
    lost, _ = run(True, law, mode, options)
    # As well as CG and PGS know the normal force; PGS keeps MuJoCo's own sliding reference, whose lift it does not take out.
    steered = 2e-2 if solver == "PGS" else FIRST_STEPS
    assert lost == pytest.approx(0.5 * G * 0.499, rel=1e-5 if mode == "explicit" else steered)


STACK = """<mujoco><option timestep="1e-3" {options}/><worldbody><geom name="floor" type="plane" size="50 50 1"
friction="1 .01 .01"/><body pos="0 0 .0499"><freejoint/><geom name="lower" type="box" size=".1 .1 .05" mass="2"
friction="1 .01 .01"/></body>
<body pos="0 0 .1498"><freejoint/><geom name="upper" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(("cone", "jacobian"), list(itertools.product(CONES, JACOBIANS)))
@pytest.mark.parametrize(("law", "mode"), MODES)
def test_our_contact_on_a_body_that_native_friction_holds(law, mode, cone, jacobian):
    """The same bodies have both: the lower box stands by native friction while the upper one slides on it by ours."""
    spec = mujoco.MjSpec.from_string(STACK.format(options=f'cone="{cone}" jacobian="{jacobian}"'))
    engine.add_friction(spec, ("upper", "lower"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    data.qvel[6] = 0.4
    start = float(data.qpos[0])
    mujoco.mj_step(model, data, nstep=10)  # in which the boxes sink in on one side, and the lever arm takes up speed
    speed = float(data.qvel[6] - data.qvel[0])
    mujoco.mj_step(model, data, nstep=50)
    assert data.qvel[6] - data.qvel[0] - speed == pytest.approx(-0.5 * G * 0.05, rel=3e-3)
    (result,) = engine.readings(model, data).values()
    assert sum(c.normal_force for c in result) == pytest.approx(G, rel=1e-3)  # no contact lifts off
    assert abs(data.qpos[0] - start) < 2e-4  # native friction lets the lower box drift
    mujoco.mj_step(model, data, nstep=600)
    assert abs(data.qvel[6]) < 1e-4


# --- options with which friction cannot act ---------------------------------------------------------------------------

CODE = """
import warnings, mujoco, stochfric_mb.mujoco as engine
from stochfric_mb.laws.elastic_stick import ElasticStick
spec = mujoco.MjSpec.from_string({scene!r})
engine.add_friction(spec, {place}, ElasticStick(0.8, 0.5){load})
text = spec.to_xml()
for old, new in {changes!r}:
    assert old in text
    text = text.replace(old, new)
warnings.simplefilter("always")
model = mujoco.MjModel.from_xml_string(text)
data = mujoco.MjData(model)
mujoco.mj_step(model, data)
"""
FLAGS = ("<option ", '<option><flag spring="disable" damper="disable"/></option><option ')


@pytest.mark.parametrize(
    ("place", "load", "changes", "said", "refused"),
    [
        ('("box", "floor")', "", [FLAGS], "leaves out all passive forces, friction too; enable one of them", True),
        ('engine.Joint("hinge")', ", normal_force=1.0", [FLAGS], "leaves out all passive forces", True),
        (
            'engine.Joint("hinge")',
            ", normal_force=1.0",
            [('integrator="RK4"', 'integrator="discrete"')],
            "use Euler, implicitfast",
            False,
        ),
        ('("box", "floor")', "", [('value="box"', 'value="bax"')], "geom1 = 'bax'", True),
    ],
)
def test_a_model_file_with_options_that_will_not_do(place, load, changes, said, refused):
    """The plugin itself says so, also of a file that others have written."""
    scene = SCENE.format(ours=OURS, options='integrator="RK4" cone="elliptic"')
    code = CODE.format(scene=scene, place=place, load=load, changes=changes)
    out = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert said in out.stderr
    assert (out.returncode != 0) == refused


# --- what is not to pass in silence ----------------------------------------------------------------------------------


@pytest.fixture
def said(tmp_path, monkeypatch):
    """What MuJoCo warns of while it runs."""
    monkeypatch.chdir(tmp_path)
    texts, before = [], mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(texts.append)
    yield texts
    mujoco.set_mju_user_warning(before)


FACES = """<mujoco><size memory="{memory}"/><option cone="elliptic"/><worldbody>
<geom name="floor" type="box" size=".05 .05 .05" pos="0 0 -.05"/>
<body pos="0 0 .0495"><freejoint/><geom name="box" type="box" size=".05 .05 .05" euler="0 0 1e-3"/></body>
</worldbody></mujoco>"""


def test_contacts_that_find_no_room_for_rows_are_left_alone(said):
    """Eight contacts of two equal faces, four of them between the others: these bear nothing, and have no rows to say so in."""
    dropped = 0
    for memory in range(4000, 9000, 500):
        spec = mujoco.MjSpec.from_string(FACES.format(memory=memory))
        engine.add_friction(spec, ("box", "floor"), Coulomb(0.8, 0.5))
        model = spec.compile()
        data = mujoco.MjData(model)
        try:
            mujoco.mj_step(model, data)
        except mujoco.FatalError:
            continue  # no room for anything
        dropped += data.ncon == 8 and data.contact.efc_address.max() < 0
    assert dropped
    assert any("arena memory" in text for text in said)


PID = """<mujoco><option cone="elliptic"/><extension><plugin plugin="mujoco.pid">{instance}</plugin></extension>
<worldbody><geom name="floor" type="plane" size="1 1 1"/><body pos="0 0 .05"><joint name="x" type="slide"/>
<geom name="box" type="box" size=".05 .05 .05"/></body></worldbody>
<actuator><plugin joint="x" plugin="mujoco.pid" {use}</actuator></mujoco>"""


def test_beside_other_plugins_friction_is_saved_or_said_not_to_be():
    gain = '<config key="kp" value="40"/>'
    for named in (True, False):
        instance, use = (f'<instance name="pid">{gain}</instance>', 'instance="pid"/>') if named else ("", f">{gain}</plugin>")
        spec = mujoco.MjSpec.from_string(PID.format(instance=instance, use=use))
        if named:
            name = engine.add_friction(spec, ("box", "floor"), Coulomb(0.8, 0.5))
        else:
            with pytest.warns(engine.PluginWarning, match="to_xml leaves out"):
                name = engine.add_friction(spec, ("box", "floor"), Coulomb(0.8, 0.5))
        model = spec.compile()
        assert name in engine.readings(model, mujoco.MjData(model))
        assert (f'<instance name="{name}">' in spec.to_xml()) == named  # MuJoCo 4.0 stops at the first one without a name


@pytest.mark.parametrize("mode", ["auto", "explicit"])
@pytest.mark.parametrize("place", [("box", "floor"), engine.Joint("hinge")])
def test_an_explicit_step_beyond_the_limit_of_its_law_is_said(said, place, mode):
    load = 1.0 if isinstance(place, engine.Joint) else None
    law = Lugre(0.8, 0.5) if mode == "auto" else ElasticStick(0.8, 0.5)
    for dt, stable in ((1e-5, True), (1e-2, False)):
        spec = mujoco.MjSpec.from_string(SCENE.format(ours=OURS, options='cone="elliptic"'))
        spec.option.timestep = dt
        name = engine.add_friction(spec, place, law, mode=mode, normal_force=load)
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, nstep=3)
        assert all(reading.stable == stable for reading in engine.readings(model, data)[name])
        assert len(said) == (not stable)  # once


def test_a_search_for_the_rest_position_is_no_step(said):
    scenario = load_scenario("kang2015_table1")
    model = belt_box.build(scenario, seed=1)
    data = belt_box.start(model, scenario.mechanism)  # tries heights at which the box presses 4000 times as hard
    mujoco.mj_step(model, data, nstep=3)
    assert not said
