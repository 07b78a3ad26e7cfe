"""MuJoCo: friction on joints and tendons, and friction as sensor data."""

import dataclasses
import math

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.coefficients import Knots  # noqa: E402
from stochfric_mb.errors import InputError  # noqa: E402
from stochfric_mb.friction import Friction  # noqa: E402
from stochfric_mb.laws import make_law  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.laws.tanh import Tanh  # noqa: E402
from stochfric_mb.mujoco.memory.state import slots_of  # noqa: E402
from stochfric_mb.mujoco.plugin.sensor import CONTACT_FIELDS, FIELDS  # noqa: E402
from stochfric_mb.mujoco.reading import instances, state_of  # noqa: E402

ARM = """<mujoco><option timestep="{dt}" integrator="{integrator}"/><worldbody><body>
<joint name="hinge" type="hinge" axis="0 1 0" frictionloss="{loss}"/>
<geom type="capsule" fromto="0 0 0 .2 0 0" size=".02" mass="1"/>
<body pos=".2 0 0"><joint name="swing" type="hinge" axis="0 1 0" damping=".05"/>
<geom type="capsule" fromto="0 0 0 0 0 -.1" size=".02" mass=".05"/></body></body></worldbody>
<tendon><fixed name="cable"><joint joint="hinge" coef="1"/></fixed></tendon></mujoco>"""
LOAD = 1.2
"""Holds 1.2 N m, of which gravity's 1.08 N m are 90 %."""
STIFF = ElasticStick(mu_s=1.0, mu_k=0.667, e_lim=1e-6, zeta=0.7)
SLIDER = """<mujoco><option timestep="{dt}" integrator="{integrator}" gravity="0 0 0"/><worldbody><body>
<joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="2"/></body></worldbody></mujoco>"""


def arm(place=None, law=STIFF, *, dt=2e-3, integrator="Euler", loss=0.0, **options):
    spec = mujoco.MjSpec.from_string(ARM.format(dt=dt, integrator=integrator, loss=loss))
    if place is not None:
        engine.add_friction(spec, place, law, normal_force=LOAD, **options)
    return spec.compile()


def slider(law, *, dt=1e-3, integrator="Euler", load=10.0, **options):
    spec = mujoco.MjSpec.from_string(SLIDER.format(dt=dt, integrator=integrator))
    engine.add_friction(spec, engine.Joint("x"), law, normal_force=load, **options)
    return spec.compile()


def creep(model, seconds=9.0):
    """Return the hinge's motion [rad] from one second on."""
    data, second = mujoco.MjData(model), round(1.0 / model.opt.timestep)
    mujoco.mj_step(model, data, nstep=second)
    early = data.qpos[0]
    mujoco.mj_step(model, data, nstep=round(seconds * second))
    return abs(data.qpos[0] - early)


@pytest.mark.parametrize("place", [engine.Joint("hinge"), engine.Tendon("cable")])
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast"])
@pytest.mark.parametrize(("dt", "e_lim"), [(2e-3, 1e-6), (5e-3, 1e-9)])
def test_a_loaded_joint_holds(place, integrator, dt, e_lim):
    model = arm(place, dataclasses.replace(STIFF, e_lim=e_lim), dt=dt, integrator=integrator)
    # MuJoCo's solver stops where its cost falls by less than its tolerance, 1e-8: it finds the force in some seconds.
    assert creep(model) < 1e-9  # [rad]; native 0.57


def test_native_frictionloss_creeps_where_ours_holds():
    assert creep(arm(loss=LOAD)) > 0.1  # why this plugin exists


def test_a_tendon_is_its_joint():
    one, other = arm(engine.Joint("hinge")), arm(engine.Tendon("cable"))
    a, b = mujoco.MjData(one), mujoco.MjData(other)
    for model, data in ((one, a), (other, b)):
        data.qvel[0] = 5.0
        mujoco.mj_step(model, data, nstep=200)
    assert a.qpos == pytest.approx(b.qpos, abs=1e-9)


def test_friction_loss_is_replaced():
    assert arm(engine.Joint("hinge"), loss=0.5).dof_frictionloss[0] == pytest.approx(STIFF.mu_s * LOAD)  # which the law steers


@pytest.mark.parametrize(("integrator", "dt"), [("Euler", 1e-3), ("implicitfast", 1e-3), ("RK4", 1e-3)])
def test_a_slider_stops_where_it_should_and_stays(integrator, dt):
    law = ElasticStick(mu_s=0.4, mu_k=0.4, e_lim=1e-4, zeta=0.5)
    model = slider(law, integrator=integrator, dt=dt)
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    mujoco.mj_step(model, data, nstep=round(1.0 / dt))
    # v^2/(2 mu_k N/m) = 0.25 m; Euler's first-order error is v dt/2, the elastic deflection below e_lim.
    assert data.qpos[0] == pytest.approx(0.25, abs=0.5 * dt + 2e-4)
    stopped = data.qpos[0]
    mujoco.mj_step(model, data, nstep=1000)
    assert abs(data.qpos[0] - stopped) < 1e-9
    mujoco.mj_forward(model, data)
    assert engine.readings(model, data)["friction_x"][0].dissipated == pytest.approx(1.0, rel=4e-3)  # Euler: dt/2 early


def test_converges_to_the_same_motion_from_implicit_and_explicit_steps():
    def end(integrator, dt):
        model = slider(Havsin(mu_s=0.5, mu_k=0.3, v_s=0.05, v_d=0.2), integrator=integrator, dt=dt)
        data = mujoco.MjData(model)
        data.qvel[0] = 1.0
        mujoco.mj_step(model, data, nstep=round(0.5 / dt))
        return data.qpos[0]

    exact = end("RK4", 1e-4)
    errors = [abs(end("Euler", dt) - exact) for dt in (4e-3, 1e-3)]
    assert math.log(errors[0] / errors[1], 4) == pytest.approx(1.0, abs=0.2)  # first order
    assert errors[1] < 1e-3


@pytest.mark.parametrize(
    "kind", ["coulomb", "karnopp", "stribeck", "havsin", "tanh", "dahl", "piecewise_linear", "smooth", "elastic_stick"]
)
def test_every_law_stops_a_slider(kind):
    model = slider(make_law(kind, mu_s=0.5, mu_k=0.4))
    data = mujoco.MjData(model)
    data.qvel[0] = 0.5
    mujoco.mj_step(model, data, nstep=1000)
    assert 0.04 < data.qpos[0] < 0.07  # 0.0625 m at mu_k = 0.4, 0.05 m at 0.5
    assert abs(data.qvel[0]) < 1e-3


def test_joints_hold_each_other():
    links = "".join(
        f'<body pos="{0.2 * bool(i)} 0 0"><joint name="j{i}" axis="0 1 {0.3 * i}"/>'
        '<geom type="capsule" fromto="0 0 0 .2 0 0" size=".03"/>' for i in range(4)
    )  # fmt: skip
    text = f'<mujoco><option timestep="5e-3" integrator="implicitfast"/><worldbody>{links}{"</body>" * 4}</worldbody></mujoco>'
    spec = mujoco.MjSpec.from_string(text)
    for i in range(4):
        engine.add_friction(spec, engine.Joint(f"j{i}"), STIFF, normal_force=40.0 / 2**i, contact=i)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=200)
    early = data.qpos.copy()
    mujoco.mj_step(model, data, nstep=400)
    assert np.abs(data.qpos).max() < 1e-5  # they sag by less than ten e_lim
    assert np.abs(data.qpos - early).max() < 1e-9


@pytest.mark.parametrize(("integrator", "servo"), [("Euler", False), ("implicit", False), ("implicitfast", True)])
@pytest.mark.parametrize("ratio", [0.5, 5.0, 50.0])
def test_a_damped_joint_is_braked_by_all_its_friction(integrator, servo, ratio):
    """From h c/m = 1 on friction pushed it: its row asked for the acceleration of a stop, of which damping leaves a part."""
    h, mass, cap, v = 2e-3, 2.0, 4.0, 0.1
    damping = ratio * mass / h
    spec = mujoco.MjSpec.from_string(SLIDER.format(dt=h, integrator=integrator))
    if servo:
        spec.add_actuator(target="x", trntype=mujoco.mjtTrn.mjTRN_JOINT).set_to_velocity(kv=damping)
    else:
        spec.joint("x").damping = [damping, 0.0, 0.0]
    engine.add_friction(spec, engine.Joint("x"), Coulomb(0.5, 0.4), normal_force=cap / 0.4)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = v
    while v > h * cap / mass:
        v = (v - h * cap / mass) / (1.0 + ratio)  # implicit in damping, as all three integrators are
        mujoco.mj_step(model, data)
        assert data.qvel[0] == pytest.approx(v, rel=1e-9)
    mujoco.mj_step(model, data)
    assert abs(data.qvel[0]) < 2e-3 * v  # friction could stop it within this step; a thousandth is what its row lets pass


CHAIN = """<mujoco><option timestep="2e-3" jacobian="{jacobian}"/><worldbody>
<body pos="0 0 1"><freejoint/><geom size=".1" mass="5"/>{links}</body></worldbody>
<tendon><fixed name="pull"><joint joint="j0" coef=".5"/><joint joint="j5" coef="-2"/></fixed></tendon></mujoco>"""


def chain(*, ours, jacobian="auto", n=12):
    """Two limbs of six light links on a heavy body that falls, with friction in each joint: the law's, or frictionloss."""
    links = "".join(
        f'<body pos=".1 {0.05 * i} 0"><joint name="j{i}" axis="{i % 2} {1 - i % 2} 0"/>'
        f'<geom type="capsule" fromto="0 0 0 .1 0 0" size=".01"/>' + "</body>" * 6 * (i % 6 == 5) for i in range(n)
    )  # fmt: skip
    spec = mujoco.MjSpec.from_string(CHAIN.format(links=links, jacobian=jacobian))
    for joint in spec.joints[1:]:
        joint.frictionloss = 0.02
        if ours:
            engine.add_friction(spec, engine.Joint(joint.name), Coulomb(0.5, 0.4), normal_force=0.04)
    if ours:
        engine.add_friction(spec, engine.Tendon("pull"), Coulomb(0.5, 0.4), normal_force=0.04)
    return spec.compile()


@pytest.mark.parametrize("jacobian", ["dense", "sparse"])
def test_the_mass_that_friction_feels_is_that_of_the_inertia_matrix(jacobian):
    """J M^-1 J' by half of a solution, against MuJoCo's whole one; 1e-12: rounding."""
    model = chain(ours=True, jacobian=jacobian)
    data = mujoco.MjData(model)
    data.qvel[:] = np.linspace(-1.0, 1.0, model.nv)
    mujoco.mj_step(model, data, nstep=50)
    rows = {f"j{i}": np.eye(model.nv)[6 + i] for i in range(12)}
    rows["pull"] = 0.5 * rows["j0"] - 2.0 * rows["j5"]
    mujoco.mj_forward(model, data)  # the evaluation of the step to come
    solved = np.zeros((1, model.nv))
    for name, number in instances(model).items():
        row = rows[name.removeprefix("friction_")]
        mujoco.mj_solveM(model, data, solved, row[None])
        felt = slots_of(state_of(model, data, number), committed=False)[0]["felt"]
        assert felt == pytest.approx(1.0 / (row @ solved[0]), rel=1e-12)


def test_a_joint_that_slides_has_all_its_friction():
    """A light link whose tendon holds it back had a fifth of it in every second step, and stuck in between."""
    model = chain(ours=True)
    data = mujoco.MjData(model)
    data.qvel[6:] = np.linspace(-3.0, 3.0, 12)
    sliding = 0
    for _ in range(300):
        before = data.qvel[6:].copy()
        mujoco.mj_step(model, data)
        for name, number in instances(model).items():
            slot = slots_of(state_of(model, data, number), committed=True)[0]
            joint = name.removeprefix("friction_j")
            if joint.isdigit() and before[int(joint)] * data.qvel[6 + int(joint)] > 0.1:  # (0.3 rad/s)^2
                sliding += 1
                assert abs(slot["fx"]) == pytest.approx(slot["cap"] * slot["given"], rel=1e-6)  # the solver's tolerance
    assert sliding > 500


@pytest.mark.parametrize("loss", [0.02, 0.1])
def test_many_joints_cost_the_solver_hardly_more_than_their_own_friction(loss):
    """24 light links with 1 kg at their end: 4 iterations a step where stuck rows are stiffer than is needed, natively 1."""

    def iterations(ours):
        links = "".join(
            f'<body pos=".1 0 0"><joint name="j{i}" axis="{i % 2} {1 - i % 2} 0" damping="1e-4" frictionloss="{loss}"/>'
            '<geom type="capsule" fromto="0 0 0 .1 0 0" size=".01" contype="0" conaffinity="0"/>' for i in range(24)
        )  # fmt: skip
        tip = '<body pos=".1 0 0"><geom size=".03" mass="1" contype="0" conaffinity="0"/></body>'
        spec = mujoco.MjSpec.from_string(f"<mujoco><worldbody>{links}{tip}{'</body>' * 24}</worldbody></mujoco>")
        for joint in spec.joints if ours else ():
            engine.add_friction(spec, engine.Joint(joint.name), Coulomb(0.5, 0.4), normal_force=2.0 * loss)
        model = spec.compile()
        data, total = mujoco.MjData(model), 0
        data.qvel[-5:] = np.linspace(-3.0, 3.0, 5)
        for _ in range(300):
            mujoco.mj_step(model, data)
            total += int(data.solver_niter[: max(data.nisland, 1)].sum())
        return total / 300.0

    assert iterations(True) < 2.5 * iterations(False)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
def test_extra_evaluations_change_nothing(integrator):
    process = Knots(sigma_s=0.05, sigma_k=0.05, spacing=0.01)
    law = Friction(ElasticStick(mu_s=1.0, mu_k=0.6, e_lim=1e-4, zeta=0.7), process)
    model = arm(engine.Joint("hinge"), law, dt=1e-3, integrator=integrator, seed=3)
    plain, nosy = mujoco.MjData(model), mujoco.MjData(model)
    plain.qvel[0] = nosy.qvel[0] = 1.0
    for i in range(500):
        mujoco.mj_step(model, plain)
        mujoco.mj_step(model, nosy)
        if i % 7 == 0:
            mujoco.mj_forward(model, nosy)
            before = nosy.qacc.copy()
            mujoco.mj_inverse(model, nosy)
            assert np.array_equal(nosy.qacc, before)
    assert np.array_equal(plain.qpos, nosy.qpos)
    assert np.array_equal(plain.qvel, nosy.qvel)
    assert np.array_equal(plain.plugin_state[:20], nosy.plugin_state[:20]) or plain.time == nosy.time


def test_the_force_of_a_creeping_law_is_that_of_the_end_velocity():
    law = Tanh(mu_s=0.5, mu_k=0.5)
    model = slider(law)
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = 3.0  # of 5 N
    mujoco.mj_step(model, data, nstep=2000)
    mujoco.mj_forward(model, data)
    reading = engine.readings(model, data)["friction_x"][0]
    assert reading.force[0] == pytest.approx(-3.0, rel=1e-7)  # what the solver's tolerance leaves
    assert reading.effective_mass == pytest.approx(2.0, rel=1e-12)


# --- sensors --------------------------------------------------------------------------------------------------------

BOX = """<mujoco><option timestep="1e-3" integrator="RK4"/><worldbody><geom name="floor" type="plane" size="5 5 1"/>
<body pos="0 0 .05"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>
<body pos="1 0 1"><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>"""


def watched():
    spec = mujoco.MjSpec.from_string(BOX)
    pair = engine.add_friction(spec, ("box", "floor"), ElasticStick(mu_s=0.8, mu_k=0.6), mode="explicit")
    joint = engine.add_friction(spec, engine.Joint("x"), STIFF, normal_force=1.0)
    engine.add_sensor(spec, pair, contacts=5)
    engine.add_sensor(spec, joint, name="joint")
    return spec


def test_sensors_read_what_readings_do():
    model = watched().compile()
    data = mujoco.MjData(model)
    data.qvel[0] = data.qvel[6] = 1.0
    mujoco.mj_step(model, data, nstep=60)
    mujoco.mj_forward(model, data)
    contacts = engine.readings(model, data)["friction_box_floor"]
    sums = dict(zip(FIELDS, data.sensor("friction_box_floor").data, strict=False))
    assert sums["contacts"] == len(contacts) == 4
    assert sums["force_x"] == pytest.approx(sum(c.force[0] for c in contacts), rel=1e-12)
    assert sums["force_x"] == pytest.approx(-0.6 * sums["normal_force"], rel=1e-9)
    assert sums["dissipated"] == pytest.approx(sum(c.dissipated for c in contacts), rel=1e-12)
    rows = data.sensor("friction_box_floor").data[len(FIELDS) :].reshape(5, len(CONTACT_FIELDS))
    assert rows[:4, 3] == pytest.approx([c.normal_force for c in contacts], rel=1e-12)
    assert not rows[4].any()
    joint = dict(zip(FIELDS, data.sensor("joint").data, strict=True))
    assert joint["force_x"] == engine.readings(model, data)["friction_x"][0].force[0]
    assert joint["normal_force"] == 1.0
    assert joint["mu_k"] == STIFF.mu_k


@pytest.mark.parametrize(
    ("element", "text"), [("joint", ""), ("tendon", '<tendon><fixed name="x"><joint joint="x" coef="1"/></fixed></tendon>')]
)
def test_a_coordinate_without_frictionloss_in_xml_has_the_friction_all_the_same(element, text):
    keys = {"law": "kind = 'coulomb', mu_s = 0.5, mu_k = 0.4", element: "x", "normal_force": "10"}
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    plugin = f'<extension><plugin plugin="stochfric.dof"><instance name="f">{config}</instance></plugin></extension>'
    xml = SLIDER.format(dt=1e-3, integrator="Euler").replace("<worldbody>", plugin + "<worldbody>", 1)
    model = mujoco.MjModel.from_xml_string(xml.replace("</mujoco>", text + "</mujoco>"))
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    mujoco.mj_step(model, data, nstep=200)
    assert data.qvel[0] == pytest.approx(1.0 - 0.4 * 10.0 / 2.0 * 0.2, rel=1e-3)  # v - mu_k N/m t, to the solver's tolerance
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS)
    with pytest.raises(mujoco.FatalError, match="frictionloss disabled"):
        mujoco.MjData(model)


def test_sensors_and_joints_work_from_xml():
    spec = watched()
    model, again = spec.compile(), mujoco.MjModel.from_xml_string(spec.to_xml())
    results = []
    for m in (model, again):
        data = mujoco.MjData(m)
        data.qvel[0] = data.qvel[6] = 1.0
        mujoco.mj_step(m, data, nstep=60)
        results.append(data.sensordata.copy())
    assert results[0] == pytest.approx(results[1], rel=1e-6, abs=1e-9)  # MuJoCo writes six digits of its own numbers


# --- errors ---------------------------------------------------------------------------------------------------------


def test_unusable_requests_are_refused():
    def spec(kind="hinge"):
        return mujoco.MjSpec.from_string(
            f'<mujoco><worldbody><body><joint name="a" type="{kind}"/><geom size=".1"/></body></worldbody></mujoco>'
        )

    with pytest.raises(InputError, match="unknown joint 'b'"):
        engine.add_friction(spec(), engine.Joint("b"), STIFF, normal_force=1.0)
    with pytest.raises(InputError, match="unknown tendon 'b'"):
        engine.add_friction(spec(), engine.Tendon("b"), STIFF, normal_force=1.0)
    with pytest.raises(InputError, match="needs its load"):
        engine.add_friction(spec(), engine.Joint("a"), STIFF)
    with pytest.raises(InputError, match="normal_force = -1"):
        engine.add_friction(spec(), engine.Joint("a"), STIFF, normal_force=-1.0)
    with pytest.raises(InputError, match="cannot take as a cap"):
        engine.add_friction(spec(), engine.Joint("a"), make_law("dahl", mu_s=0.5, mu_k=0.4), normal_force=1.0, mode="solver")
    with pytest.raises(InputError, match="ball or free"):
        engine.add_friction(spec("ball"), engine.Joint("a"), STIFF, normal_force=1.0)
    twice = spec()
    engine.add_friction(twice, engine.Joint("a"), STIFF, normal_force=1.0)
    with pytest.raises(InputError, match="already"):
        engine.add_friction(twice, engine.Joint("a"), STIFF, normal_force=1.0)
    off = spec()
    off.option.disableflags = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    with pytest.raises(InputError, match="passive"):
        engine.add_friction(off, engine.Joint("a"), STIFF, normal_force=1.0)
    off = spec()
    off.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    with pytest.warns(engine.IntegratorWarning, match="discrete"):
        engine.add_friction(off, engine.Joint("a"), STIFF, normal_force=1.0)
    with pytest.raises(InputError, match="are for joints and tendons"):
        engine.add_friction(mujoco.MjSpec.from_string(BOX), ("box", "floor"), STIFF, normal_force=1.0)
    with pytest.raises(InputError, match="unknown friction 'x'"):
        engine.add_sensor(spec(), "x")
    with pytest.raises(InputError, match="contacts = 65"):
        engine.add_sensor(twice, "friction_a", contacts=65)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"joint": "b"}, "joint = 'b'"),
        ({"joint": "a", "tendon": "a"}, "give one of them"),
        ({"normal_force": "heavy"}, "normal_force"),
        ({"normal_force": "-1"}, "normal_force"),
        ({"seed": "-1"}, "seed = '-1'"),
        ({"law": "kind = 'hafsin'"}, "did you mean 'havsin'"),
        ({"law": "kind = 'coulomb', mu_s = 0.5, mu_k = 0.4", "mode": "explicit"}, "hold the contact"),
        ({"radius": "0.1"}, "give one of them"),
    ],
)
def test_a_bad_configuration_in_xml_is_refused(changes, message):
    spec = mujoco.MjSpec.from_string('<mujoco><worldbody><body><joint name="a"/><geom size=".1"/></body></worldbody></mujoco>')
    engine.add_friction(spec, engine.Joint("a"), STIFF, normal_force=1.0)
    spec.plugins[0].config = dict(spec.plugins[0].config) | changes
    with pytest.raises(ValueError, match=r"plugin stochfric\.dof: InputError") as refusal:
        spec.compile()
    assert message in str(refusal.value)


@pytest.mark.parametrize(
    ("body", "rest", "load"),
    [
        ("", "", 2.0 * 9.81),
        ('gravcomp="1"', "", 2.0 * 9.81),  # MuJoCo's reaction does not know it; the bearing bears nothing
        ("", '<actuator><motor site="s" gear="0 0 1 0 0 0" ctrlrange="50 50"/></actuator>', 2.0 * 9.81),  # nor this one
        ("", "{tendon}<actuator><motor tendon='t' gear='-1'/></actuator>", 50.0 - 2.0 * 9.81),
        ("", "{tendon}", 2.0 * 9.81),
    ],
)
def test_what_a_reaction_knows(body, rest, load):
    """As docs/mujoco_joints.md says; 50 N pull up through the axis of 2 kg."""
    tendon = '<tendon><spatial name="t"><site site="a"/><site site="s"/></spatial></tendon>'
    bearing = mujoco.MjSpec.from_string(
        f'<mujoco><worldbody><site name="a" pos="0 0 2"/><body pos="0 0 1" {body}><joint name="a" axis="0 1 0"/>'
        f'<geom size=".1" mass="2"/><site name="s"/></body></worldbody>{rest.format(tendon=tendon)}</mujoco>'
    )
    name = engine.add_friction(bearing, engine.Joint("a"), STIFF, normal_force="reaction", radius=0.01)
    model = bearing.compile()
    data = mujoco.MjData(model)
    data.ctrl[:] = 50.0
    mujoco.mj_step(model, data, nstep=20)
    assert engine.readings(model, data)[name][0].normal_force == pytest.approx(0.01 * load, rel=1e-9)


@pytest.mark.parametrize(
    ("integrator", "servo"),
    [("Euler", False), ("implicit", False), ("implicitfast", False), ("implicit", True), ("implicitfast", True)],
)
@pytest.mark.parametrize("ratio", [1.0, 5.0, 50.0])
def test_a_damped_joint_holds(integrator, servo, ratio):
    """These integrators take damping implicitly. Above h c/m = 4 what the solver had not foreseen, told a step late, shook."""
    damping = ratio * 0.01 / 2e-3
    gear = 3.0  # the damping of an actuator is kv times its gear squared
    drive = f'<actuator><velocity joint="a" kv="{damping / gear**2}" gear="{gear}"/></actuator>' if servo else ""
    damped = mujoco.MjSpec.from_string(
        f'<mujoco><option timestep="2e-3" integrator="{integrator}" gravity="0 0 0"/><worldbody><body>'
        f'<joint name="a" damping="{0.0 if servo else damping}" armature=".01"/><geom size=".01" mass="1e-9"/></body>'
        f"</worldbody>{drive}</mujoco>"
    )
    engine.add_friction(damped, engine.Joint("a"), make_law("coulomb", mu_s=0.5, mu_k=0.4), normal_force=4.0)
    model = damped.compile()
    data = mujoco.MjData(model)
    for k in range(200):
        data.qfrc_applied[0] = 0.9 * 2.0 * k / 200
        mujoco.mj_step(model, data)
    mujoco.mj_step(model, data, nstep=100)
    start = float(data.qpos[0])
    mujoco.mj_step(model, data, nstep=2000)
    assert abs(data.qpos[0] - start) < 1e-12  # 6e-3 rad before, natively 0.1
    data.qfrc_applied[0] = 1.02 * 2.0
    mujoco.mj_step(model, data, nstep=100)
    assert data.qpos[0] - start > 1e-5
