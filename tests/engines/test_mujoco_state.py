"""MuJoCo: what carries state, seeds and parameters: copies, saving, batches, rollouts, derivatives, sleep; and leaks."""

import copy
import gc
import pickle
import sys

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.coefficients import Knots  # noqa: E402
from stochfric_mb.errors import InputError  # noqa: E402
from stochfric_mb.friction import Friction  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.mujoco.memory.state import header_of  # noqa: E402
from stochfric_mb.mujoco.reading import state_of  # noqa: E402

SCENE = """<mujoco><option timestep="1e-3" integrator="{integrator}" cone="elliptic"/><worldbody>
<geom name="floor" type="plane" size="5 5 1"/>
<body pos="0 0 .05"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>
<body pos="0 2 1"><joint name="hinge" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .2 0 0" size=".02" mass="1"
contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
PROCESS = Knots(sigma_s=0.05, sigma_k=0.05, spacing=0.01)
LAW = Friction(ElasticStick(mu_s=0.8, mu_k=0.5, e_lim=1e-4), PROCESS)
SOLVED = {  # mode implicit by choice, by a law with true stick, and by a step beyond the limit
    "chosen": (LAW, "solver"),
    "coulomb": (Friction(Coulomb(mu_s=0.8, mu_k=0.5), PROCESS), "auto"),
    "auto": (Friction(ElasticStick(mu_s=0.8, mu_k=0.5, e_lim=1e-7), PROCESS), "auto"),
}
INTEGRATORS = ["Euler", "RK4", "implicit", "implicitfast"]
BOX, HINGE = "friction_box_floor", "friction_hinge"


def model_of(integrator="Euler", seed=0, law=LAW, mode="auto", joint_law=LAW):
    spec = mujoco.MjSpec.from_string(SCENE.format(integrator=integrator))
    engine.add_friction(spec, ("box", "floor"), law, seed=seed, mode=mode)
    engine.add_friction(spec, engine.Joint("hinge"), joint_law, normal_force=2.0, seed=seed, contact=1)
    return spec.compile()


def moving(model):
    data = mujoco.MjData(model)
    data.qvel[0], data.qvel[6] = 1.0, 5.0
    return data


def after(model, data, count=150):
    mujoco.mj_step(model, data, nstep=count)
    return np.concatenate([data.qpos, data.qvel])


def solved(choice, integrator="Euler", seed=0):
    law, mode = SOLVED[choice]
    return model_of(integrator, seed, law, mode)


@pytest.mark.parametrize("choice", SOLVED)
def test_these_are_solved(choice):
    model = solved(choice)
    data = moving(model)
    after(model, data, 50)
    assert header_of(state_of(model, data, 0)).solved == 1.0


@pytest.mark.parametrize("choice", [None, *SOLVED])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_state_travels_with_the_data(integrator, choice):
    model = solved(choice, integrator, 5) if choice else model_of(integrator, seed=5)
    data = moving(model)
    after(model, data)
    copied = copy.copy(data)
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    saved = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, saved, kind)
    other = mujoco.MjData(model)
    mujoco.mj_copyData(other, model, data)
    pickled_model, pickled = pickle.loads(pickle.dumps((model, data)))
    expected = after(model, data)
    assert np.array_equal(after(model, copied), expected)
    assert np.array_equal(after(model, other), expected)
    assert np.array_equal(after(pickled_model, pickled), expected)
    mujoco.mj_setState(model, data, saved, kind)
    assert np.array_equal(after(model, data), expected)
    mujoco.mj_resetData(model, data)
    data.qvel[0], data.qvel[6] = 1.0, 5.0
    assert np.array_equal(after(model, data, 300), expected)


@pytest.mark.parametrize("choice", [None, *SOLVED])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_batches_give_each_simulation_its_own_seed(integrator, choice):
    batch = pytest.importorskip("mujoco.batch")

    def made(seed):
        return solved(choice, integrator, seed) if choice else model_of(integrator, seed)

    model = made(0)
    seeds = [0, 1, 2, 1]
    results = []
    for threads in (1, 2):
        many = batch.Batch(model, len(seeds), threads)
        states = many.bind("plugin_state")
        for name in (BOX, HINGE):
            engine.set_friction(states, model, name, seed=seeds)
        many.bind("qvel")[:, [0, 6]] = [1.0, 5.0]
        many.step(nstep=300)
        results.append(np.concatenate([many.bind("qpos"), many.bind("qvel")], axis=1))
    assert np.array_equal(results[0], results[1])
    for seed, result in zip(seeds, results[0], strict=True):
        alone = made(seed)
        assert np.array_equal(after(alone, moving(alone), 300), result)
    assert len(np.unique(results[0][:, 0])) == len(np.unique(results[0][:, 7])) == 3


def test_parameters_of_each_simulation():
    batch = pytest.importorskip("mujoco.batch")
    constant = ElasticStick(mu_s=0.8, mu_k=0.5, e_lim=1e-4)
    model = model_of(law=constant, joint_law=constant)
    many = batch.Batch(model, 2, 1)
    states = many.bind("plugin_state")
    engine.set_friction(states, model, BOX, mu_k=[0.5, 0.3])
    engine.set_friction(states, model, HINGE, normal_force=[2.0, 3.0])
    many.bind("qvel")[:, [0, 6]] = [1.0, 5.0]
    many.step(nstep=100)
    changed = mujoco.MjSpec.from_string(SCENE.format(integrator="Euler"))
    engine.add_friction(changed, ("box", "floor"), ElasticStick(mu_s=0.8, mu_k=0.3, e_lim=1e-4))
    engine.add_friction(changed, engine.Joint("hinge"), constant, normal_force=3.0, contact=1)
    for i, alone in enumerate((model, changed.compile())):
        assert np.array_equal(after(alone, moving(alone), 100)[:8], many.bind("qpos")[i])


def test_places_in_the_state():
    model = model_of(seed=7)
    data = mujoco.MjData(model)
    assert data.plugin_state[engine.state_index(model, BOX, "seed")] == 7
    assert data.plugin_state[engine.state_index(model, HINGE, "normal_force")] == 2.0
    assert data.plugin_state[engine.state_index(model, HINGE, "e_lim")] == 1e-4
    with pytest.raises(InputError, match="unknown friction instance 'friction_hing'; did you mean 'friction_hinge'"):
        engine.state_index(model, "friction_hing", "seed")
    with pytest.raises(InputError, match="unknown number 'normal_force'"):
        engine.state_index(model, BOX, "normal_force")
    with pytest.raises(InputError, match="seed = -1"):
        engine.set_friction(data.plugin_state, model, BOX, seed=-1)


@pytest.mark.parametrize("choice", [None, *SOLVED])
def test_rollouts_are_steps(choice):
    rollout = pytest.importorskip("mujoco.rollout")
    model = solved(choice, "Euler", 3) if choice else model_of("RK4", seed=3)
    data = moving(model)
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    first = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, first, kind)
    results = []
    for threads in (1, 2):
        workers = [mujoco.MjData(model) for _ in range(threads)]
        states, _ = rollout.rollout([model] * 4, workers, np.tile(first, (4, 1)), nstep=200)
        results.append(states)
    assert np.array_equal(results[0], results[1])
    expected = after(model, data, 200)
    assert np.array_equal(results[0][0, -1, 1 : 1 + len(expected)], expected)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast"])
def test_derivatives_leave_the_data_as_it_was(integrator):
    model = model_of(integrator)
    data = moving(model)
    after(model, data, 20)
    twin = copy.copy(data)
    size = 2 * model.nv + model.na
    a = np.zeros((size, size))
    mujoco.mjd_transitionFD(model, data, 1e-6, True, a, None, None, None)
    assert np.all(np.isfinite(a))
    # A hinge that slides with a constant force (decay over, knots apart) keeps its velocity's change: column of its rate.
    hinge = model.nv - 1
    assert a[hinge, model.nv + hinge] == pytest.approx(model.opt.timestep, rel=1e-3)
    assert np.array_equal(after(model, data), after(model, twin))


@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_derivatives_with_the_discrete_integrator(speed):
    """Its stuck contacts hold through the surface's velocity; evaluations without a position stage must not add it up."""
    spec = mujoco.MjSpec.from_string(SCENE.format(integrator="discrete"))
    engine.add_friction(spec, ("box", "floor"), LAW, mode="solver")
    model = spec.compile()
    data = mujoco.MjData(model)
    after(model, data, 200)
    data.qvel[0] = speed
    after(model, data, 1)
    twin = copy.copy(data)
    size = 2 * model.nv + model.na
    a = np.zeros((size, size))
    mujoco.mjd_transitionFD(model, data, 1e-6, True, a, None, None, None)
    # a stuck box does not keep a velocity along the floor, a sliding one does
    assert a[0, model.nv] == pytest.approx(model.opt.timestep if speed else 0.0, abs=0.2 * model.opt.timestep)
    assert np.array_equal(after(model, data), after(model, twin))


def test_a_stuck_scene_falls_asleep_and_wakes():
    spec = mujoco.MjSpec.from_string(SCENE.format(integrator="Euler"))
    spec.option.enableflags = mujoco.mjtEnableBit.mjENBL_SLEEP
    spec.option.sleep_tolerance = 1e-3
    engine.add_friction(spec, engine.Joint("hinge"), ElasticStick(mu_s=1.0, mu_k=0.6), normal_force=2.0)
    model = spec.compile()
    data = mujoco.MjData(model)
    after(model, data, 2000)
    assert (data.tree_asleep >= 0).all()
    held = data.qpos[7]
    after(model, data, 500)
    assert data.qpos[7] == held
    data.qfrc_applied[6] = 3.0  # with gravity's 1.08 N m more than the 2 N m that friction holds
    after(model, data, 200)
    assert data.qpos[7] > held + 0.1
    data.qfrc_applied[6] = 0.0
    after(model, data, 3000)
    assert (data.tree_asleep >= 0).all()


@pytest.mark.parametrize("law", [LAW, Havsin(0.8, 0.6), Coulomb(0.8, 0.6)], ids=["elastic_stick", "havsin", "coulomb"])
def test_extra_evaluations_change_no_bit_of_the_state(law):
    """A box that falls, tumbles and slides: contacts come and go."""
    spec = mujoco.MjSpec.from_string(SCENE.format(integrator="Euler"))
    engine.add_friction(spec, ("box", "floor"), law)
    model = spec.compile()
    plain, nosy = mujoco.MjData(model), mujoco.MjData(model)
    for data in (plain, nosy):
        data.qpos[2] += 0.1
        data.qvel[:6] = 1.0, 0.2, 0.0, 3.0, 1.0, 0.5
    for _ in range(600):
        for evaluate in (mujoco.mj_forward, mujoco.mj_inverse, mujoco.mj_forward):
            evaluate(model, nosy)
        mujoco.mj_step(model, plain)
        mujoco.mj_step(model, nosy)
        assert np.array_equal(plain.qpos, nosy.qpos)
        assert np.array_equal(plain.plugin_state, nosy.plugin_state)


def test_forgotten_pairs_are_listed():
    spec = mujoco.MjSpec.from_string(SCENE.format(integrator="Euler"))
    engine.add_friction(spec, ("box", "floor"), LAW)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] = 1.0
    after(model, data, 10)
    assert engine.untouched(model, data) == [BOX]
    data.qpos[2] = 0.05
    after(model, data, 10)
    assert engine.untouched(model, data) == []


@pytest.mark.skipif(sys.platform == "win32", reason="the resident memory is read through the resource module")
@pytest.mark.parametrize("route", ["compile", "implicit", "callback"])
def test_a_thousand_cycles_leak_nothing(route):
    import resource

    unit = 1 if sys.platform == "darwin" else 1024

    def peak():
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit

    plain = mujoco.MjModel.from_xml_string(SCENE.format(integrator="Euler"))
    data = mujoco.MjData(plain)
    mujoco.mj_step(plain, data, nstep=500)  # to rest: a context warns of pairs that do not touch within it

    def cycle():
        if route != "callback":
            model = model_of() if route == "compile" else solved("chosen")
            mujoco.mj_step(model, mujoco.MjData(model))
        else:
            with engine.friction(plain, data, {("box", "floor"): LAW}):
                mujoco.mj_step(plain, data)

    for _ in range(200):
        cycle()
    before = peak()
    for _ in range(1000):
        cycle()
    assert peak() - before < 8e6  # a leak of one state (12 kB) a cycle would be 12 MB


def test_geoms_of_one_body_are_refused():
    spec = mujoco.MjSpec.from_string(
        '<mujoco><worldbody><geom name="floor" size=".1"/><body><geom name="shelf" size=".1"/></body><body><joint/>'
        '<geom name="a" size=".1"/><body><geom name="b" size=".1"/></body></body></worldbody></mujoco>'
    )
    for pair in (("a", "b"), ("floor", "shelf")):
        with pytest.raises(InputError, match="one rigid body"):
            engine.add_friction(spec, pair, LAW)
    engine.add_friction(spec, ("b", "shelf"), LAW)
