"""MuJoCo: the engine plugin, friction on any pair of geoms, and the belt-box against the reference."""

import copy
import dataclasses
import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb import reference  # noqa: E402
from stochfric_mb.coefficients import Knots, PerEvent, Spatial  # noqa: E402
from stochfric_mb.coefficients.distributions import Empirical  # noqa: E402
from stochfric_mb.errors import InputError, SimulationError, StabilityError  # noqa: E402
from stochfric_mb.friction import Friction  # noqa: E402
from stochfric_mb.laws import LAWS, make_law, register_law  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.mujoco.memory import structs  # noqa: E402
from stochfric_mb.mujoco.memory.state import place  # noqa: E402
from stochfric_mb.mujoco.plugin import configuration as config  # noqa: E402
from stochfric_mb.mujoco.reading import instances, state_of  # noqa: E402
from stochfric_mb.scenario import load_scenario  # noqa: E402

SCENARIOS = ("kang2015_table1", "kang2015_table2_13_8", "kang2015_table2_18_7")
ELASTIC = ElasticStick(mu_s=0.8, mu_k=0.6)
BOX = """<mujoco><option timestep="{dt}" integrator="{integrator}" gravity="{gx} 0 {gz}"/><worldbody>
<geom name="floor" type="plane" size="5 5 1"/><geom name="wall" type="box" size=".1 1 1" pos="3 0 1"/>
<body name="box" pos="0 0 .05"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>
</worldbody></mujoco>"""
G = 9.81


def scenario(name, **changes):
    return dataclasses.replace(load_scenario(name), **changes)


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def box_spec(*, angle=0.0, dt=2e-4, integrator="RK4"):
    gx, gz = G * math.sin(angle), -G * math.cos(angle)
    return mujoco.MjSpec.from_string(BOX.format(dt=dt, integrator=integrator, gx=gx, gz=gz))


def box_model(friction=ELASTIC, *, mode="auto", **options):
    spec = box_spec(**options)
    engine.add_friction(spec, ("box", "floor"), friction, mode=mode)
    return spec.compile()


def belt_model(law="elastic_stick", **options):
    return belt_box.build(load_scenario("kang2015_table1", law=law), **options)


def steps(model, data, count):
    mujoco.mj_step(model, data, nstep=count)
    return np.concatenate([data.qpos, data.qvel])


# --- the belt-box against the reference -----------------------------------------------------------------------------


def check_against_reference(case, dt, tolerance):
    ours, exact = belt_box.simulate(case, dt=dt), reference.simulate(case)
    assert rms(ours.position - exact.position) <= tolerance
    assert np.array_equal(ours.mu_s, exact.mu_s)
    assert np.array_equal(ours.mu_k, exact.mu_k)
    assert ours.normal_force == pytest.approx(case.mechanism.normal_force, rel=1e-7)  # starts at rest vertically
    assert np.mean(ours.stick != exact.stick) < 1e-3  # a switch may fall one sample apart
    return ours


@pytest.mark.parametrize("name", SCENARIOS)
def test_elastic_stick_follows_the_reference(name):
    # Switches are located within the step, so the error is that of the force between a switch and the step's end:
    # second order in dt, below 1e-9 m. One switch found a step late would shift the anchor by 1.4e-7 m.
    ours = check_against_reference(scenario(name, duration=2.0), 1e-4, 1e-8)
    assert ours.attributes["hook"] == "engine plugin (passive), RK4"
    assert ours.attributes["law"] == "elastic_stick"
    assert ours.attributes["n_steps"] == 20_000


@pytest.mark.long
@pytest.mark.parametrize("name", SCENARIOS)
def test_elastic_stick_follows_the_reference_for_ten_seconds(name):
    check_against_reference(load_scenario(name), 1e-4, 2e-7)  # ten stick-slips amplify the errors of the first


@pytest.mark.parametrize("name", SCENARIOS)
def test_havsin_follows_the_reference(name):
    # Smooth in velocity: the Runge-Kutta error itself, far below a nanometre.
    check_against_reference(dataclasses.replace(load_scenario(name, law="havsin"), duration=0.6), 2e-5, 1e-9)


@pytest.mark.long
@pytest.mark.parametrize("name", SCENARIOS)
def test_havsin_follows_the_reference_for_ten_seconds(name):
    check_against_reference(load_scenario(name, law="havsin"), 2e-5, 5e-8)


@pytest.mark.parametrize("process", [Spatial(sigma_s=0.015, sigma_k=0.023, spacing=2e-4), PerEvent(sigma_s=0.03, sigma_k=0.03)])
def test_paths_along_position_and_events_follow_the_reference(process):
    case = scenario("kang2015_table1", process=process, duration=2.0)
    ours, exact = belt_box.simulate(case, seed=3), reference.simulate(case, seed=3)
    assert rms(ours.position - exact.position) < 1e-8
    assert rms(ours.mu_k - exact.mu_k) < 1e-3  # the path runs along the motion; an event may fall one sample apart
    assert len(np.unique(ours.mu_s)) > 1


@pytest.mark.parametrize("kind", ["tanh", "lugre", "dahl", "piecewise_linear", "smooth", "coulomb", "karnopp", "stribeck"])
def test_every_law_runs(kind):
    case = dataclasses.replace(load_scenario("kang2015_table1", law=kind), duration=1.0)
    ours = belt_box.simulate(case, dt=min(1e-4, case.default_dt()))
    exact = reference.simulate(case)
    assert (ours.attributes["law"] == kind) == (not case.law.needs_holding_force)
    assert bool(ours.attributes["notes"]) == case.law.needs_holding_force
    assert rms(ours.position - exact.position) < 2e-5  # of 2.6 mm: the stand-ins differ from true stick by their e_lim, v_s


def test_step_size_convergence():
    case = dataclasses.replace(load_scenario("kang2015_table1", law="havsin"), duration=0.3, process=None)
    exact = reference.simulate(case).position
    errors = [rms(belt_box.simulate(case, dt=dt).position - exact) for dt in (6.25e-5, 3.125e-5)]
    assert math.log2(errors[0] / errors[1]) > 3.0  # fourth order, less where a step straddles a kink of the law


def test_step_size_convergence_with_switches():
    case = scenario("kang2015_table1", duration=2.0, process=None)
    exact = reference.simulate(case).position
    errors = [rms(belt_box.simulate(case, dt=dt).position - exact) for dt in (5e-4, 5e-5)]
    assert (
        math.log10(errors[0] / errors[1]) > 1.5
    )  # second order on average over where steps fall; first order without location


def test_the_engine_integrates_its_own_model():
    case = scenario("kang2015_table1", duration=2.0)
    model = belt_box.build(case)
    plain = belt_box.integrate(model, case)
    model.body_mass[model.body("box").id] *= 1.05
    heavier = belt_box.integrate(model, case)
    # 5 % more mass is 5 % more normal force: the break-away moves by 5 % of 2.6 mm.
    assert rms(heavier.position - plain.position) > 3e-5


def test_initial_state_and_moving_foot():
    case = scenario("kang2015_table2_13_8", duration=0.5)
    case = dataclasses.replace(
        case, mechanism=dataclasses.replace(case.mechanism, initial_position=1e-3, initial_velocity=-2e-3)
    )
    ours = check_against_reference(case, 1e-4, 1e-8)
    assert ours.position[0] == 1e-3
    assert ours.velocity[0] == -2e-3


def test_progress_is_reported():
    seen = []
    belt_box.simulate(scenario("kang2015_table1", duration=0.5), progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(0.5)


# --- what may not change the motion ---------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["RK4", "Euler", "implicitfast"])
def test_extra_evaluations_change_nothing(integrator):
    model = belt_model()
    model.opt.integrator = {"RK4": 1, "Euler": 0, "implicitfast": 3}[integrator]
    plain, nosy = mujoco.MjData(model), mujoco.MjData(model)
    for i in range(3000):
        mujoco.mj_step(model, plain)
        mujoco.mj_step(model, nosy)
        if i % 7 == 0:
            mujoco.mj_forward(model, nosy)
            mujoco.mj_forward(model, nosy)
            mujoco.mj_inverse(model, nosy)
    assert np.array_equal(plain.qpos, nosy.qpos)
    assert np.array_equal(plain.qvel, nosy.qvel)
    assert plain.qpos[0] > 5e-4


def test_state_travels_with_the_data():
    model, data = (m := belt_model(seed=5)), mujoco.MjData(m)
    steps(model, data, 5000)
    start = data.time
    copied = copy.copy(data)
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    saved = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, saved, kind)
    pickled_model, pickled = pickle.loads(pickle.dumps((model, data)))
    expected = steps(model, data, 5000)
    assert np.array_equal(steps(model, copied, 5000), expected)
    assert np.array_equal(steps(pickled_model, pickled, 5000), expected)
    mujoco.mj_setState(model, data, saved, kind)
    assert data.time == start
    assert np.array_equal(steps(model, data, 5000), expected)


def test_model_and_state_travel_to_another_process(tmp_path):
    model = belt_model(seed=5)
    data = mujoco.MjData(model)
    steps(model, data, 3000)
    (tmp_path / "before").write_bytes(pickle.dumps((model, data)))
    expected = steps(model, data, 3000)
    code = (
        "import pickle, sys, numpy as np, mujoco, stochfric_mb.mujoco\n"
        "model, data = pickle.load(open(sys.argv[1], 'rb'))\n"
        "mujoco.mj_step(model, data, nstep=3000)\n"
        "np.save(sys.argv[2], np.concatenate([data.qpos, data.qvel]))\n"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path / "before", tmp_path / "after.npy"], check=True)
    assert np.array_equal(np.load(tmp_path / "after.npy"), expected)


def test_reset_starts_anew():
    model = belt_model()
    data = mujoco.MjData(model)
    first = steps(model, data, 2000)
    mujoco.mj_resetData(model, data)
    assert np.array_equal(steps(model, data, 2000), first)


def test_batch_carries_seeds_and_state():
    batch = pytest.importorskip("mujoco.batch")
    model = belt_model()
    results = []
    for threads in (1, 2):
        many = batch.Batch(model, 4, threads)
        many.bind("plugin_state")[:, place("seed")] = [0, 1, 2, 1]
        many.step(nstep=6000)
        results.append(np.array(many.bind("qpos")))
    assert np.array_equal(results[0], results[1])
    assert np.array_equal(results[0][1], results[0][3])
    assert len(np.unique(results[0][:, 0])) == 3
    alone = mujoco.MjData(belt_model(seed=2))
    assert np.array_equal(steps(belt_model(seed=2), alone, 6000)[:2], results[0][2])


# --- friction on any model ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["RK4", "Euler", "implicitfast"])
def test_a_box_on_an_incline_holds(integrator):
    model = box_model(angle=math.radians(20.0), integrator=integrator)
    data = mujoco.MjData(model)
    steps(model, data, 2500)
    early = data.qpos[0]
    steps(model, data, 2500)
    assert abs(data.qpos[0] - early) < 1e-11  # no creep: what the solver leaves, over half a second
    assert 0.0 < data.qpos[0] < 1e-4  # the landing, and the elastic deflection below e_lim
    mujoco.mj_forward(model, data)
    contacts = engine.readings(model, data)["friction_box_floor"]
    pull = G * math.sin(math.radians(20.0))
    assert sum(c.force[0] for c in contacts) == pytest.approx(-pull, rel=1e-6)
    assert all(c.stick for c in contacts)


def test_a_box_slides_on_a_steep_incline():
    model = box_model(angle=math.radians(45.0))
    data = mujoco.MjData(model)
    steps(model, data, 500)
    early, start = data.qvel[0], data.time
    steps(model, data, 500)
    wanted = G * (math.sin(math.radians(45.0)) - 0.6 * math.cos(math.radians(45.0)))
    assert (data.qvel[0] - early) / (data.time - start) == pytest.approx(wanted, rel=1e-3)  # pitching moves N about


def test_a_sliding_box_stops_where_it_should_and_stays():
    model = box_model(dt=1e-4)
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    steps(model, data, 6000)
    assert data.qpos[0] == pytest.approx(1.0 / (2.0 * 0.6 * G), rel=2e-3)  # landing and mu_s at the end: under 1e-3
    stopped = data.qpos[0]
    steps(model, data, 2000)
    assert abs(data.qpos[0] - stopped) < 1e-9
    mujoco.mj_forward(model, data)
    contacts = engine.readings(model, data)["friction_box_floor"]
    assert sum(c.dissipated for c in contacts) == pytest.approx(0.5, rel=1e-3)  # all of m v^2/2, less the solver's share


def test_a_new_contact_rubs_from_its_first_step():
    model = box_model(Havsin(mu_s=0.8, mu_k=0.6, v_s=1e-2, v_d=2e-2), mode="explicit")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    data.qpos[2] -= 1e-4
    data.qvel[0] = 1.0
    mujoco.mj_forward(model, data)
    normal_force = sum(abs(data.efc_force[c.efc_address]) for c in data.contact)
    contacts = engine.readings(model, data)["friction_box_floor"]
    assert normal_force > 1.0
    assert sum(c.normal_force for c in contacts) == pytest.approx(normal_force, rel=0.5)  # predicted before the solution
    assert sum(c.force[0] for c in contacts) == pytest.approx(-0.6 * sum(c.normal_force for c in contacts), rel=1e-9)


def test_both_bodies_feel_the_friction():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><option timestep="1e-4" integrator="RK4" gravity="0 0 -9.81"/><worldbody>
        <body name="plate"><joint type="slide" axis="1 0 0"/><geom name="plate" type="box" size="1 1 .1" mass="3"/></body>
        <body name="box" pos="0 0 .15"><joint name="b" type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
        <geom name="box" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("box", "plate"), ELASTIC)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[1] = 0.4
    steps(model, data, 4000)
    momentum = 3.0 * data.qvel[0] + data.qvel[1]
    assert momentum == pytest.approx(0.4, rel=1e-9)
    assert data.qvel[0] == pytest.approx(data.qvel[1], abs=1e-9)  # they end up moving together
    mujoco.mj_forward(model, data)
    mass = sum(c.effective_mass for c in engine.readings(model, data)["friction_box_plate"])
    assert mass == pytest.approx(0.75, rel=1e-6)  # 1/(1/1 + 1/3)


def test_friction_turns_with_a_turntable():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><option timestep="2e-4" integrator="RK4" gravity="0 0 -9.81"/><worldbody>
        <body><joint type="hinge" axis="0 0 1"/><geom name="table" type="cylinder" size="1 .1" mass="1000"/></body>
        <body pos=".3 0 .15"><freejoint/><geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>
        </worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("box", "table"), ELASTIC)
    model = spec.compile()
    data = mujoco.MjData(model)
    rate = 2.0  # rad/s: 1.2 m/s^2 at 0.3 m, a sixth of what friction holds
    data.qvel[0] = rate
    data.qvel[2], data.qvel[6] = rate * 0.3, rate
    steps(model, data, 8000)
    radius = math.hypot(data.qpos[1], data.qpos[2])
    assert radius == pytest.approx(0.3, abs=2e-4)
    early = radius
    steps(model, data, 8000)
    assert math.hypot(data.qpos[1], data.qpos[2]) == pytest.approx(early, abs=1e-6)  # no creep over half a turn


def test_other_contacts_keep_their_native_friction():
    spec = box_spec()
    engine.add_friction(spec, ("box", "floor"), ELASTIC)
    model = spec.compile()
    assert model.geom_condim[model.geom("box").id] == 3
    assert model.npair == 1
    assert model.pair_dim[0] == 3
    assert model.pair_friction[0][0] == ELASTIC.mu_s


def test_the_normal_contact_stays_as_it_was():
    spec = box_spec()
    spec.geom("box").solref, spec.geom("box").solmix, spec.geom("floor").margin = [0.01, 0.7], 3.0, 1e-3
    plain = spec.compile()
    data = mujoco.MjData(plain)
    mujoco.mj_forward(plain, data)
    engine.add_friction(spec, ("box", "floor"), ELASTIC)
    model = spec.compile()
    ours = mujoco.MjData(model)
    mujoco.mj_forward(model, ours)
    assert ours.ncon == data.ncon == 4
    for mine, native in zip(ours.contact, data.contact, strict=True):
        assert mine.dim == 3
        for field in ("solref", "solimp", "includemargin", "dist"):
            assert np.array_equal(getattr(mine, field), getattr(native, field)), field


def test_an_explicit_pair_is_taken_over():
    spec = box_spec()
    spec.add_pair(geomname1="floor", geomname2="box").margin = 2e-3
    engine.add_friction(spec, ("box", "floor"), ELASTIC)
    model = spec.compile()
    assert model.npair == 1
    assert model.pair_dim[0] == 3
    assert model.pair_margin[0] == 2e-3


def test_xml_alone_is_enough(tmp_path):
    spec = box_spec(angle=0.3)
    process = Knots(sigma_s=0.01, sigma_k=0.02, spacing=0.01, distribution_k=Empirical(values=tuple(np.linspace(0, 1, 50))))
    engine.add_friction(spec, ("box", "floor"), Friction(ELASTIC, process), seed=4, sample=7, contact=2)
    model = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert again.npluginstate == model.npluginstate
    again.opt.gravity = model.opt.gravity  # MuJoCo writes its own numbers with six digits
    assert np.array_equal(state_of(again, mujoco.MjData(again), 0), state_of(model, mujoco.MjData(model), 0))
    ours, theirs = steps(again, mujoco.MjData(again), 500), steps(model, mujoco.MjData(model), 500)
    assert ours == pytest.approx(theirs, abs=1e-12)  # rounding of what MuJoCo wrote


def test_hand_written_xml():
    text = (
        BOX.format(dt=1e-4, integrator="RK4", gx=0.0, gz=-G)
        .replace(
            "<worldbody>",
            """<extension><plugin plugin="stochfric.pair"><instance name="f">
        <config key="law" value="kind = 'havsin', mu_s = 0.5, mu_k = 0.4, v_s = 1e-3, v_d = 2e-3"/>
        <config key="geom1" value="box"/><config key="geom2" value="floor"/></instance></plugin></extension>
        <contact><pair geom1="box" geom2="floor" condim="3"/></contact><worldbody>""",
        )
        .replace("<option", "<option cone='elliptic'")
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    steps(model, data, 1000)
    assert data.qvel[0] == pytest.approx(1.0 - 0.4 * G * 0.1, rel=2e-3)  # the landing bounces a little


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("law", "kind = 'havsin', mu_s = 0.5", "mu_k"),
        ("law", "kind = 'hafsin', mu_s = 0.5, mu_k = 0.4", "did you mean 'havsin'"),
        ("law", "kind: havsin", "not a list of keys"),
        ("coefficients", "process = 'knots', sigma_s = 0.1, sigma_k = 0.1", "spacing"),
    ],
)
def test_malformed_configurations_say_why(key, value, message):
    texts = config.configuration(Friction(ELASTIC)) | {key: value}
    with pytest.raises(InputError, match=message):
        config.friction_of(texts["law"], texts["coefficients"])


def test_a_law_makes_one_trip_to_the_engine(monkeypatch):
    """As text into the model, read once when it compiles; data made from it read nothing."""
    read = []
    parse = config._parse
    monkeypatch.setattr(config, "_parse", lambda name, text: read.append(name) or parse(name, text))
    spec = box_spec()
    engine.add_friction(spec, ("box", "floor"), Coulomb(mu_s=0.4123, mu_k=0.3))
    assert read == []
    model = spec.compile()
    mujoco.mj_step(model, mujoco.MjData(model))
    assert read == ["law"]


def test_a_law_with_true_stick_cannot_be_explicit():
    with pytest.raises(InputError, match="hold the contact"):
        config.configuration(Friction(Coulomb(mu_s=0.5, mu_k=0.4)), mode="explicit")
    with pytest.raises(InputError, match="unknown mode 'fast'"):
        config.configuration(Friction(ELASTIC), mode="fast")


def raw_plugin(**changes):
    spec = box_spec()
    engine.add_friction(spec, ("box", "floor"), ELASTIC)
    plugin = spec.plugins[0]
    plugin.config = dict(plugin.config) | changes
    return spec


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"seed": "-1"}, "seed = '-1'"),
        ({"seed": "4294967296"}, "seed = '4294967296'"),
        ({"sample": "1.5"}, "sample = '1.5'"),
        ({"slots": "0"}, "slots = 0 must be a whole number"),
        ({"geom2": "flor"}, "geom2 = 'flor'"),
        ({"geom1": "*", "geom2": "*"}, "geom1 = '*'"),
        ({"law": "kind = 'hafsin'"}, "did you mean 'havsin'"),
        ({"mode": "quick"}, "unknown mode 'quick'"),
        ({"law": "kind = 'coulomb', mu_s = 0.5, mu_k = 0.4", "mode": "explicit"}, "hold the contact"),
    ],
)
def test_a_bad_configuration_in_xml_is_refused(changes, message):
    with pytest.raises(ValueError, match=r"plugin stochfric\.pair: InputError") as refusal:
        raw_plugin(**changes).compile()
    assert message in str(refusal.value)


def test_unknown_geom_lists_the_known_ones():
    with pytest.raises(InputError, match=r"'belz'; did you mean 'belt'\? Known: belt, box"):
        engine.add_friction(belt_box.scene(load_scenario("kang2015_table1").mechanism), ("box", "belz"), ELASTIC)


def test_unusable_requests_are_refused():
    with pytest.raises(InputError, match="names one geom twice"):
        engine.add_friction(box_spec(), ("box", "box"), ELASTIC)
    with pytest.raises(InputError, match="elastic_substitute"):
        engine.add_friction(box_spec(), ("box", "floor"), make_law("coulomb", mu_s=0.8, mu_k=0.6), mode="explicit")
    with pytest.raises(InputError, match="seed = -1"):
        engine.add_friction(box_spec(), ("box", "floor"), ELASTIC, seed=-1)
    with pytest.raises(InputError, match="slots"):
        engine.add_friction(box_spec(), ("box", "floor"), ELASTIC, slots=0)
    spec = box_spec()
    engine.add_friction(spec, ("box", "floor"), ELASTIC)
    with pytest.raises(InputError, match="already"):
        engine.add_friction(spec, ("box", "floor"), ELASTIC)
    spec = box_spec()
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    with pytest.raises(InputError, match="passive"):
        engine.add_friction(spec, ("box", "floor"), ELASTIC)
    spec = box_spec()
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    with pytest.warns(engine.IntegratorWarning, match="explicit friction is inaccurate"):
        engine.add_friction(spec, ("box", "floor"), ELASTIC, mode="explicit")


@pytest.mark.parametrize("place", [("box", "floor"), engine.Joint("turn")])
def test_passive_forces_switched_off_while_it_runs_stop_it(place):
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 1"/><body pos="0 0 .05"><freejoint/>
        <geom name="box" type="box" size=".05 .05 .05"/></body><body pos="0 0 3"><joint name="turn"/><geom size=".1"/></body>
        </worldbody></mujoco>"""
    )
    load = None if isinstance(place, tuple) else 1.0
    engine.add_friction(spec, place, ELASTIC, normal_force=load)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER
    with pytest.raises(mujoco.FatalError, match="both spring and damper disabled"):
        mujoco.mj_step(model, data)


def test_two_pairs_have_their_own_friction():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><option timestep="1e-4" integrator="RK4"/><worldbody><geom name="floor" type="plane" size="5 5 1"/>
        <body pos="0 0 .05"><freejoint/><geom name="a" type="box" size=".05 .05 .05" mass="1"/></body>
        <body pos="0 1 .05"><freejoint/><geom name="b" type="box" size=".05 .05 .05" mass="1"/></body>
        </worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("a", "floor"), ElasticStick(mu_s=0.4, mu_k=0.2), contact=0)
    engine.add_friction(spec, ("b", "floor"), ElasticStick(mu_s=0.8, mu_k=0.6), contact=1)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = data.qvel[6] = 1.0
    steps(model, data, 1000)
    assert data.qvel[0] == pytest.approx(1.0 - 0.2 * G * 0.1, rel=2e-3)
    assert data.qvel[6] == pytest.approx(1.0 - 0.6 * G * 0.1, rel=2e-3)


def test_more_contacts_than_slots_are_reported():
    spec = box_spec()
    engine.add_friction(spec, ("box", "floor"), ELASTIC, slots=2)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] -= 1e-4
    with pytest.raises(mujoco.FatalError, match="give add_friction"):
        mujoco.mj_forward(model, data)


def test_a_users_own_law(tmp_path, monkeypatch):
    (tmp_path / "users_law.py").write_text(
        """
from typing import ClassVar
import dataclasses
from stochfric_mb.compile import compiled
from stochfric_mb.laws.contract import Law

@dataclasses.dataclass(frozen=True)
class Viscous(Law):
    viscosity: float = 2.0
    kind: ClassVar[str] = "test_viscous"
    equation: ClassVar[str] = "F = viscosity v"
    source: ClassVar[str] = "a test"

@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    return (0.0,)

@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    return p[2] * vx, p[2] * vy

@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    return (0.0,)

@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    return 1.0, 1.0, 1.0, 1.0, 1.0, 1.0
""",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    import users_law  # pyright: ignore[reportMissingImports]

    register_law(users_law.Viscous)
    try:
        model = box_model(users_law.Viscous(mu_s=0.8, mu_k=0.6, viscosity=0.5), mode="explicit")
        data = mujoco.MjData(model)
        data.qpos[2] -= 1e-3
        data.qvel[0] = 1.0
        mujoco.mj_forward(model, data)
        contacts = engine.readings(model, data)["friction_box_floor"]
        assert [c.force[0] for c in contacts] == pytest.approx([-0.5] * 4, rel=1e-12)
    finally:
        del LAWS["test_viscous"]


# --- steps and failures ---------------------------------------------------------------------------------------------


def test_a_step_beyond_the_limit_is_refused():
    case = load_scenario("kang2015_table1", law="havsin")
    with pytest.raises(StabilityError, match=r"4 v_s m_eff/\(pi mu_s N\).*use dt <="):
        belt_box.simulate(case, dt=2e-4)
    with pytest.raises(InputError, match="does not divide"):
        belt_box.simulate(case, dt=3e-5)


@pytest.mark.parametrize(("field", "value"), [("jnt_stiffness", np.nan), ("jnt_stiffness", -3e4), ("dof_damping", -1e7)])
def test_a_failing_engine_is_caught(field, value):
    case = scenario("kang2015_table1", duration=2.0)
    model = belt_box.build(case)
    getattr(model, field)[0] = value
    with pytest.raises(SimulationError, match="mujoco: "):
        belt_box.integrate(model, case)


def test_layouts_are_checked():
    assert structs.verify() > 300
    assert structs.DATA.fields["time"][1] == structs.struct("mjData").fields["time"][1]


def test_a_wrong_layout_is_refused(monkeypatch):
    original = structs.struct
    kind = original("mjData")
    names = list(kind.names)
    i = names.index("ncon")
    names[i], names[i + 1] = names[i + 1], names[i]
    formats, offsets = zip(*(kind.fields[name][:2] for name in kind.names), strict=True)
    moved = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": kind.itemsize})
    monkeypatch.setattr(structs, "struct", lambda name: moved if name == "mjData" else original(name))
    from stochfric_mb.errors import MissingEngineError

    with pytest.raises(MissingEngineError, match="differs"):
        structs.verify()


def test_one_law_serves_all_instances_that_are_alike():
    texts = {kind: {"law": f"kind = '{kind}', mu_s = 0.5, mu_k = 0.4"} for kind in LAWS}
    laws = {kind: config.law_of(text, (0, 1, 2)) for kind, text in texts.items() if kind != "lugre"}
    assert len({law.ctypes.data for law in laws.values()}) == len(laws)
    again = config.law_of(texts["havsin"] | {"seed": "7"}, (0, 1, 2))
    assert again is laws["havsin"]
    assert instances(belt_model()) == {"friction_box_belt": 0}
