"""MuJoCo: friction on a compiled model through ``mjcb_passive``."""

import copy
import ctypes
import math
import threading

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.coefficients import Knots  # noqa: E402
from stochfric_mb.errors import InputError, SimulationError  # noqa: E402
from stochfric_mb.friction import Friction  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.mujoco.memory.engine import library  # noqa: E402

G = 9.81
LAW = ElasticStick(mu_s=0.8, mu_k=0.6)
PAIR = ("box", "floor")
BOX = """<mujoco><option cone="elliptic" timestep="{dt}" integrator="{integrator}" gravity="{gx} 0 {gz}"/><worldbody>
<geom name="floor" type="plane" size="5 5 1"/><geom name="wall" type="box" size=".1 1 1" pos="3 0 1" condim="{wall}"/>
<geom name="lamp" size=".1" pos="0 0 3" contype="0" conaffinity="0"/>
<body name="box" pos="0 0 .05"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/>
<geom name="lid" type="box" size=".01 .01 .01" pos="0 0 .05" mass=".001"/></body></worldbody></mujoco>"""


def box(*, angle=0.0, dt=2e-4, integrator="RK4", wall=3):
    gx, gz = G * math.sin(angle), -G * math.cos(angle)
    model = mujoco.MjModel.from_xml_string(BOX.format(dt=dt, integrator=integrator, gx=gx, gz=gz, wall=wall))
    return model, mujoco.MjData(model)


def installed():
    return ctypes.c_void_p.in_dll(library(), "mjcb_passive").value


@pytest.mark.parametrize("integrator", ["RK4", "Euler", "implicitfast"])
def test_a_box_on_an_incline_holds(integrator):
    model, data = box(angle=math.radians(20.0), integrator=integrator)
    with engine.friction(model, data, {PAIR: LAW}) as friction:
        mujoco.mj_step(model, data, nstep=2500)
        early = data.qpos[0]
        mujoco.mj_step(model, data, nstep=2500)
        assert abs(data.qpos[0] - early) < 1e-11  # no creep: what the solver leaves, over half a second
        mujoco.mj_forward(model, data)
        contacts = friction.readings()[PAIR]
        pull = G * 1.001 * math.sin(math.radians(20.0))
        assert sum(c.force[0] for c in contacts) == pytest.approx(-pull, rel=1e-6)
        assert all(c.stick for c in contacts)
    assert installed() is None
    assert (model.geom_condim == 3).all()


@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
def test_a_sliding_box_is_braked_as_with_the_plugin(integrator):
    model, data = box(dt=1e-4, integrator=integrator)
    data.qvel[0] = 1.0
    with engine.friction(model, data, {PAIR: LAW}):
        mujoco.mj_step(model, data, nstep=1000)
        assert data.qvel[0] == pytest.approx(1.0 - 0.6 * G * 0.1, rel=2e-3)  # landing, as with the plugin
        mujoco.mj_step(model, data, nstep=5000)
        assert data.qpos[0] == pytest.approx(1.0 / (2.0 * 0.6 * G), rel=2e-3)


# Steps of 2 ms are beyond every explicit limit here, and Coulomb has no explicit mode at all.
@pytest.mark.parametrize("law", [LAW, Havsin(mu_s=0.8, mu_k=0.6), Coulomb(mu_s=0.8, mu_k=0.6)], ids=lambda law: law.kind)
@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
def test_long_steps_are_implicit_as_with_the_plugin(integrator, law):
    angle, end = math.radians(20.0), []
    spec = mujoco.MjSpec.from_string(
        BOX.format(dt=2e-3, integrator=integrator, gx=G * math.sin(angle), gz=-G * math.cos(angle), wall=3)
    )
    engine.add_friction(spec, PAIR, law)
    with_plugin = spec.compile()
    for model in (box(angle=angle, dt=2e-3, integrator=integrator)[0], with_plugin):
        data = mujoco.MjData(model)
        data.qvel[0] = 1.0
        pairs = {} if model is with_plugin else {PAIR: law}
        with engine.friction(model, data, pairs):
            mujoco.mj_step(model, data, nstep=400)
        end.append(data.qpos[:3].copy())
    # Apart from MuJoCo's solver (tolerance 1e-8), which starts from different guesses, the two are the same.
    assert end[0] == pytest.approx(end[1], abs=1e-8)
    assert 0.2 < end[0][0] < 0.3  # v^2/(2 (0.6 cos - sin) g) is 0.23 m


@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
def test_extra_evaluations_change_nothing(integrator):
    law = Friction(LAW, Knots(sigma_s=0.05, sigma_k=0.05, spacing=0.01))
    model, plain = box(integrator=integrator)
    nosy = mujoco.MjData(model)
    plain.qvel[0] = nosy.qvel[0] = 1.0
    with engine.friction(model, plain, {PAIR: law}, seed=3), engine.friction(model, nosy, {PAIR: law}, seed=3):
        for i in range(1200):
            mujoco.mj_step(model, plain)
            mujoco.mj_step(model, nosy)
            if i % 7 == 0:
                mujoco.mj_forward(model, nosy)
                mujoco.mj_forward(model, nosy)
                mujoco.mj_inverse(model, nosy)
    assert np.array_equal(plain.qpos, nosy.qpos)
    assert np.array_equal(plain.qvel, nosy.qvel)
    assert plain.qpos[0] > 0.02


def test_an_earlier_callback_is_called_and_put_back():
    model, data = box()

    def wind(model, data):
        data.qfrc_passive[1] += 2.0

    mujoco.set_mjcb_passive(wind)
    try:
        before = installed()
        with engine.friction(model, data, {PAIR: LAW}):
            assert installed() != before
            mujoco.mj_forward(model, data)
            assert data.qfrc_passive[1] == pytest.approx(2.0, abs=1e-9)
        assert installed() == before
        assert mujoco.get_mjcb_passive() is wind
    finally:
        mujoco.set_mjcb_passive(None)


def test_two_models_do_not_disturb_each_other():
    alone = []
    for angle in (0.3, 0.9):
        model, data = box(angle=angle)
        with engine.friction(model, data, {PAIR: LAW}):
            mujoco.mj_step(model, data, nstep=1000)
        alone.append(data.qpos.copy())
    (model_a, a), (model_b, b), (model_c, c) = box(angle=0.3), box(angle=0.9), box(angle=0.3)
    native_alone = mujoco.MjData(model_c)
    mujoco.mj_step(model_c, native_alone, nstep=1000)
    with engine.friction(model_a, a, {PAIR: LAW}):
        outer = engine.friction(model_b, b, {PAIR: LAW})
        with outer:
            runs = [threading.Thread(target=mujoco.mj_step, args=(m, d, 1000)) for m, d in ((model_a, a), (model_b, b))]
            for run in runs:
                run.start()
            mujoco.mj_step(model_c, c, nstep=1000)
            for run in runs:
                run.join()
    assert np.array_equal(a.qpos, alone[0])
    assert np.array_equal(b.qpos, alone[1])
    assert np.array_equal(c.qpos, native_alone.qpos)  # a model without friction of ours keeps its own
    assert installed() is None


def test_contexts_may_end_in_any_order():
    (model_a, a), (model_b, b) = box(), box()
    first, second = engine.friction(model_a, a, {PAIR: LAW}), engine.friction(model_b, b, {PAIR: LAW})
    first.__enter__()
    second.__enter__()
    mujoco.mj_step(model_b, b, nstep=10)
    mujoco.mj_step(model_a, a, nstep=10)
    first.__exit__(None, None, None)
    assert installed() is not None
    second.__exit__(None, None, None)
    assert installed() is None


def test_passive_forces_that_are_switched_off_within_are_reported():
    model, data = box()
    both = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    context = engine.friction(model, data, {PAIR: LAW})
    context.__enter__()
    model.opt.disableflags = both
    mujoco.mj_step(model, data)
    with pytest.raises(SimulationError, match="disabled while"):
        context.__exit__(None, None, None)
    assert (model.geom_condim == 3).all()


def test_an_exception_puts_everything_back():
    model, data = box()

    def broken(model, data):
        raise ValueError("broken")

    mujoco.set_mjcb_passive(broken)
    try:
        with pytest.raises(ValueError, match="broken"), engine.friction(model, data, {PAIR: LAW}):
            mujoco.mj_step(model, data)
        assert mujoco.get_mjcb_passive() is broken
    finally:
        mujoco.set_mjcb_passive(None)
    assert (model.geom_condim == 3).all()


def test_other_data_of_the_model_are_refused():
    model, data = box()
    with engine.friction(model, data, {PAIR: LAW}):
        mujoco.mj_step(model, data)
        with pytest.raises(mujoco.FatalError, match="that one MjData only"):
            mujoco.mj_step(model, copy.copy(data))
        mujoco.mj_step(model, data)


def test_a_replaced_callback_is_reported():
    model, data = box()
    context = engine.friction(model, data, {PAIR: LAW})
    context.__enter__()
    try:
        mujoco.set_mjcb_passive(lambda model, data: None)
        with pytest.raises(SimulationError, match="mjcb_passive was replaced"):
            context.__exit__(None, None, None)
    finally:
        mujoco.set_mjcb_passive(None)
    assert (model.geom_condim == 3).all()


def test_nothing_of_the_model_changes():
    model, data = box()
    before = copy.copy(model)
    with engine.friction(model, data, {PAIR: LAW}):
        mujoco.mj_step(model, data)
        for name in ("geom_condim", "geom_friction", "pair_dim"):
            assert np.array_equal(getattr(model, name), getattr(before, name))


def test_reset_starts_anew():
    model, data = box(angle=0.9)
    with engine.friction(model, data, {PAIR: LAW}):
        mujoco.mj_step(model, data, nstep=500)
        first = data.qpos.copy()
        mujoco.mj_resetData(model, data)
        mujoco.mj_step(model, data, nstep=500)
    assert np.array_equal(data.qpos, first)


def test_what_cannot_work_is_refused():
    model, data = box()
    other, others = box()
    with pytest.raises(InputError, match="another model"):
        engine.friction(model, others, {PAIR: LAW})
    with pytest.raises(InputError, match="unknown geom 'bax'; did you mean 'box'"):
        engine.friction(model, data, {("bax", "floor"): LAW})
    with pytest.raises(InputError, match="one rigid body"):
        engine.friction(model, data, {("box", "lid"): LAW})
    with pytest.raises(InputError, match="never touch"):
        engine.friction(model, data, {("box", "lamp"): LAW})
    with pytest.raises(InputError, match="is not a pair"):
        engine.friction(model, data, {"box": LAW})
    with pytest.raises(InputError, match="named one by one"):
        engine.friction(model, data, {("*", "floor"): LAW})
    with pytest.raises(InputError, match="pairs is a list"):
        engine.friction(model, data, [(PAIR, LAW)])
    with pytest.raises(InputError, match="model is a MjSpec; compile it first"):
        engine.friction(mujoco.MjSpec(), data, {PAIR: LAW})
    with pytest.raises(InputError, match="explicit mode cannot know"):
        engine.friction(model, data, {PAIR: Coulomb(mu_s=0.8, mu_k=0.6)}, mode="explicit")
    other.geom_condim[:] = 1
    with pytest.raises(InputError, match="without friction"):
        engine.friction(other, others, {PAIR: LAW})
    other.geom_condim[:] = 3
    other.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    with pytest.raises(InputError, match="cone is pyramidal"):
        engine.friction(other, others, {PAIR: LAW})
    other.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    with (
        engine.friction(model, data, {PAIR: LAW}),
        pytest.raises(InputError, match="another context"),
        engine.friction(model, data, {("floor", "box"): LAW}),
    ):
        pass
    model.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    with pytest.raises(InputError, match="passive"):
        engine.friction(model, data, {PAIR: LAW})
    other.opt.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    with pytest.raises(InputError, match="integrator discrete leaves nothing"):
        engine.friction(other, others, {PAIR: LAW})


def test_a_pair_that_never_touches_is_reported():
    model, data = box()
    with pytest.warns(engine.ContactWarning, match="never touched"), engine.friction(model, data, {("box", "wall"): LAW}):
        mujoco.mj_step(model, data, nstep=5)
