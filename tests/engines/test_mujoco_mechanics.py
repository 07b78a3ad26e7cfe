"""MuJoCo: the implicit mode and the choice between the modes, on mechanics with known answers."""

import math

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb import load_scenario  # noqa: E402
from stochfric_mb.errors import InputError  # noqa: E402
from stochfric_mb.laws import make_law  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.mujoco.memory.state import header_of, slots_of  # noqa: E402
from stochfric_mb.mujoco.reading import state_of  # noqa: E402

G = 9.81
FREE = "<freejoint/>"
SLIDES = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>'


def spec_of(geom, joints, *, dt=2e-3, height=0.05, options=""):
    return mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="{dt}" {options}/><worldbody><geom name="floor" type="plane" size="50 50 1"/>
        <body pos="0 0 {height}">{joints}<geom name="body" mass="1" {geom}/></body></worldbody></mujoco>"""
    )


def box(law, joints=FREE, *, mode="auto", **options):
    spec = spec_of('type="box" size=".05 .05 .05"', joints, **options)
    engine.add_friction(spec, ("body", "floor"), law, mode=mode)
    model = spec.compile()
    return model, mujoco.MjData(model)


def tilt(model, degrees):
    angle = math.radians(degrees)
    model.opt.gravity = [G * math.sin(angle), 0.0, -G * math.cos(angle)]


def steps(model, data, seconds):
    mujoco.mj_step(model, data, nstep=round(seconds / model.opt.timestep))


# --- holding --------------------------------------------------------------------------------------------------------


def creep(law, seconds, settling=1.0, **options):
    model, data = box(law, **options)
    tilt(model, 20.0)
    steps(model, data, settling)
    start = data.qpos[0]
    steps(model, data, seconds)
    assert data.qvel[0] == pytest.approx(0.0, abs=1e-6)  # what the solver leaves of the normal force shakes the box
    return abs(data.qpos[0] - start)


@pytest.mark.parametrize("law", [ElasticStick(0.8, 0.6, e_lim=e) for e in (1e-4, 1e-5, 1e-6, 1e-7)] + [Coulomb(0.8, 0.6)])
def test_a_box_on_an_incline_does_not_creep(law):
    assert creep(law, 2.0) < 1e-11  # [m]


@pytest.mark.long
@pytest.mark.parametrize("law", [ElasticStick(0.8, 0.6, e_lim=e) for e in (1e-4, 1e-5, 1e-6, 1e-7)] + [Coulomb(0.8, 0.6)])
def test_a_box_on_an_incline_does_not_creep_in_ten_seconds(law):
    assert creep(law, 10.0) < 1e-11


def test_a_box_on_long_bristles_does_not_creep():
    """Bristles of 1 mm ring for longer: 9.2e-10 m are left after 1 s, 8e-12 m after 2 s."""
    assert creep(ElasticStick(0.8, 0.6, e_lim=1e-3), 10.0, settling=2.0) < 1e-11  # [m]


@pytest.mark.long
def test_a_box_on_an_incline_does_not_creep_in_explicit_mode():
    """The loading (a tilt at once) rings for 2 s; from then on it shakes with what MuJoCo's solver leaves."""
    model, data = box(ElasticStick(0.8, 0.6, e_lim=1e-3), mode="explicit")
    tilt(model, 20.0)
    steps(model, data, 2.0)
    start = data.qpos[0]
    steps(model, data, 10.0)
    assert abs(data.qpos[0] - start) < 1e-11  # [m]


@pytest.mark.long
@pytest.mark.parametrize("options", ['jacobian="dense"', 'jacobian="sparse"', 'cone="elliptic"', 'solver="PGS"', 'solver="CG"'])
def test_solver_options(options):
    # PGS and CG leave more of the normal force undetermined than Newton does.
    assert creep(ElasticStick(0.8, 0.6), 1.0, options=options) < (1e-8 if "solver" in options else 1e-11)


def break_away_angle(law, joints, size=".05 .05 .05", dt=2e-3, options=""):
    """Tilt slowly; return the angle [degrees] at which the box goes faster than 5 mm/s, soon after break-away."""
    height = float(size.split()[2])
    spec = spec_of(f'type="box" size="{size}"', joints, dt=dt, height=height, options=options)
    engine.add_friction(spec, ("body", "floor"), law)
    model = spec.compile()
    data = mujoco.MjData(model)
    steps(model, data, 0.4)
    angle = 0.0
    while data.qvel[0] < 5e-3:
        angle += dt * (10.0 if angle < 37.0 else 0.5)
        assert angle < 45.0
        tilt(model, angle)
        mujoco.mj_step(model, data)
    return angle


# Elastic stick slides on at mu_s up to v_s = 0.1 mm/s: it takes 0.04 s, 0.02 degrees, to get there.
STICKING = [Coulomb(0.8, 0.46)] + [ElasticStick(0.8, 0.46, e_lim=e) for e in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)]
LIMIT = math.degrees(math.atan(0.8))


@pytest.mark.parametrize("law", STICKING)
@pytest.mark.parametrize("joints", [SLIDES, FREE])
def test_break_away_angle(law, joints):
    assert break_away_angle(law, joints) == pytest.approx(LIMIT, abs=0.05)


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), ElasticStick(0.8, 0.46, e_lim=1e-7)])
@pytest.mark.parametrize("size", [".1 .05 .03", ".05 .1 .02", ".05 .05 .06"])
def test_break_away_angle_of_boxes_of_other_proportions(law, size):
    """The lower contacts carry 4 to 49 times what the upper ones do, and the box turns on its soft ground as it is tilted."""
    assert break_away_angle(law, FREE, size) == pytest.approx(LIMIT, abs=0.05)


@pytest.mark.long
@pytest.mark.parametrize("law", STICKING)
@pytest.mark.parametrize("options", ['integrator="implicitfast"', 'integrator="RK4"', 'jacobian="sparse"', 'cone="elliptic"'])
def test_break_away_angle_with_other_options(law, options):
    assert break_away_angle(law, FREE, options=options) == pytest.approx(LIMIT, abs=0.05)


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), *(ElasticStick(0.8, 0.46, e_lim=e) for e in (1e-5, 1e-7))])
@pytest.mark.parametrize("dt", [5e-4, 1e-3])
def test_break_away_angle_at_smaller_steps(law, dt):
    assert break_away_angle(law, FREE, dt=dt) == pytest.approx(LIMIT, abs=0.05)


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), ElasticStick(0.8, 0.46, e_lim=1e-5)])
@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit", "implicitfast", "discrete"])
@pytest.mark.parametrize("dt", [5e-3, 1e-2])
def test_break_away_angle_at_longer_steps(law, dt, integrator):
    # elastic_stick at 10 ms: 38.53 once. Where a step cannot follow the law's spring, contacts are held as by a rigid law.
    options = f'integrator="{integrator}" cone="elliptic"'
    assert break_away_angle(law, FREE, dt=dt, options=options) == pytest.approx(LIMIT, abs=0.05)


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), ElasticStick(0.8, 0.46, e_lim=1e-5)])
@pytest.mark.parametrize("dt", [1e-3, 2e-3])
def test_the_discrete_integrator_holds_and_breaks_away(law, dt):
    options = 'integrator="discrete" cone="elliptic"'
    assert break_away_angle(law, FREE, dt=dt, options=options) == pytest.approx(LIMIT, abs=0.05)
    assert creep(law, 5.0, dt=dt, options=options) < 1e-12  # [m]; natively 0.4 mm at 2 ms


@pytest.mark.parametrize("integrator", ["Euler", "discrete"])
def test_havsin_creeps_at_its_own_speed(integrator):
    """At the speed where HAVSIN has tan 20 degrees: mu_s/2 (1 - cos(pi v/v_s)). Slip ended at v_s only with discrete once."""
    model, data = box(Havsin(0.8, 0.6), options=f'integrator="{integrator}" cone="elliptic"')
    tilt(model, 20.0)
    steps(model, data, 3.0)
    start = data.qpos[0]
    steps(model, data, 2.0)
    speed = Havsin(0.8, 0.6).v_s / math.pi * math.acos(1.0 - 2.0 * math.tan(math.radians(20.0)) / 0.8)
    assert (data.qpos[0] - start) / 2.0 == pytest.approx(speed, rel=1e-3)


@pytest.mark.parametrize("dt", [1e-3, 5e-3])
def test_the_discrete_integrator_does_not_lift_what_slides(dt):
    """MuJoCo's cones ask a sliding contact's normal row for more, which lifts it off: natively for 0.3 s of this slide."""
    model, data = box(Coulomb(0.8, 0.6), dt=dt, options='integrator="discrete" cone="elliptic"')
    steps(model, data, 0.5)
    start, height, v = data.qpos[0], data.qpos[2], 2.0
    data.qvel[0] = v
    for _ in range(round(0.5 / dt)):
        mujoco.mj_step(model, data)
        assert data.ncon == 4
        assert data.qpos[2] == pytest.approx(height, abs=5e-4)
    # semi-implicit: v h/2 less than v^2/(2 mu_k g), and what the box pitches at the start and the stop
    assert data.qpos[0] - start == pytest.approx(v * v / (2.0 * 0.6 * G) - 0.5 * v * dt, abs=1e-4)


@pytest.mark.parametrize("law", [Coulomb(0.8, 0.46), ElasticStick(0.8, 0.46, e_lim=1e-5)])
def test_contacts_share_by_their_normal_forces(law):
    model, data = box(law)
    steps(model, data, 0.4)
    for k in range(1, 1501):
        tilt(model, 0.02 * k)
        mujoco.mj_step(model, data)
    (contacts,) = engine.readings(model, data).values()
    ratios = [math.hypot(*c.force[:2]) / c.normal_force for c in contacts]
    # All springs are as stiff as their contacts are loaded, and of one length but for the turning of the box on its soft
    # ground: 1e-7 m between upper and lower contacts, of 1e-5 m.
    assert ratios == pytest.approx([math.tan(math.radians(30.0))] * 4, rel=1e-2)


# --- sliding and rolling --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [ElasticStick(0.8, 0.6), Coulomb(0.8, 0.6), Havsin(0.8, 0.6)])
@pytest.mark.parametrize("heading", [0.0, 37.0])
def test_sliding_in_the_plane(law, heading):
    model, data = box(law, SLIDES, mode="solver", dt=1e-3)
    steps(model, data, 2.0)
    direction = np.array([math.cos(math.radians(heading)), math.sin(math.radians(heading))])
    data.qvel[:2] = 3.0 * direction
    steps(model, data, 0.1)  # the normal force settles: by 1e-4 of the weight within what follows
    start = float(np.hypot(*data.qvel[:2]))
    steps(model, data, 0.3)
    assert data.qvel[:2] == pytest.approx((start - 0.6 * G * 0.3) * direction, rel=3e-4, abs=1e-9)
    steps(model, data, 0.3)
    assert np.hypot(*data.qvel[:2]) < 1e-6  # at rest


@pytest.mark.parametrize("mode", ["explicit", "auto", "solver"])
@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_a_stuck_box_that_is_given_a_speed_slides_from_then_on(mode, integrator):
    model, data = box(ElasticStick(0.8, 0.6, e_lim=1e-4), SLIDES, mode=mode, dt=1e-3, options=f'integrator="{integrator}"')
    steps(model, data, 1.0)
    data.qvel[0] = 3.0
    steps(model, data, 0.3)
    assert data.qvel[0] == pytest.approx(3.0 - 0.6 * G * 0.3, rel=1e-6)


@pytest.mark.parametrize("law", [ElasticStick(0.5, 0.5), Coulomb(0.5, 0.5)])
def test_a_sphere_goes_from_sliding_to_rolling(law):
    spec = spec_of('type="sphere" size=".1"', FREE, dt=1e-3, height=0.0999)
    engine.add_friction(spec, ("body", "floor"), law, mode="solver")
    model = spec.compile()
    data = mujoco.MjData(model)
    steps(model, data, 1.0)
    data.qvel[:] = 0.0
    data.qvel[0] = 2.0
    rolling = 2.0 * 2.0 / (7.0 * 0.5 * G)  # a uniform sphere rolls after 2 v0/(7 mu g), at 5/7 v0
    steps(model, data, rolling - 0.02)
    assert data.qvel[0] - 0.1 * data.qvel[4] > 0.1
    steps(model, data, 0.04)
    assert data.qvel[0] == pytest.approx(2.0 * 5.0 / 7.0, rel=2e-3)  # the contact point lies a little below the radius
    mujoco.mj_forward(model, data)
    lever = data.qpos[2] - data.contact[0].pos[2]  # the soft contact's point lies within the sphere
    assert data.qvel[0] - lever * data.qvel[4] == pytest.approx(0.0, abs=2e-4)  # the elastic contact still rings


@pytest.mark.parametrize("stiffness", [2e4, 2e6])
@pytest.mark.parametrize("mode", ["solver", "auto"])
@pytest.mark.parametrize("dt", [2e-3, 1e-3, 1e-4])
def test_bouncing_sphere_feels_the_right_normal_force(dt, mode, stiffness):
    joints = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
    spec = spec_of(f'type="sphere" size=".1" solref="-{stiffness} -10"', joints, dt=dt, height=0.5)
    engine.add_friction(spec, ("body", "floor"), ElasticStick(0.5, 0.5), mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = 100.0
    steps(model, data, 2.0)
    assert (100.0 - data.qvel[0]) / (data.qvel[1] + G * 2.0) == pytest.approx(0.5, abs=5e-4)


def test_a_box_rides_an_accelerating_belt():
    spec = spec_of('type="box" size=".05 .05 .05"', SLIDES)
    spec.geom("floor").surfacevel = [1e-9, 0.0, 0.0, 0.0, 0.0, 0.0]
    engine.add_friction(spec, ("body", "floor"), ElasticStick(0.8, 0.6), mode="solver")
    model = spec.compile()
    data = mujoco.MjData(model)
    belt = model.geom("floor").id
    steps(model, data, 0.5)
    for acceleration, follows in ((0.5 * 0.8 * G, True), (1.5 * 0.8 * G, False)):
        start, before = float(data.qvel[0]), float(model.geom_surfacevel[belt, 0])
        for _ in range(250):
            model.geom_surfacevel[belt, 0] += acceleration * model.opt.timestep
            mujoco.mj_step(model, data)
        gained = (data.qvel[0] - start) / 0.5
        if follows:
            assert data.qvel[0] == pytest.approx(model.geom_surfacevel[belt, 0] - before + start, rel=1e-2)
        else:
            assert gained == pytest.approx(0.6 * G, rel=2e-2)  # it slips after its first millimetres


# --- manners --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [ElasticStick(0.8, 0.6), Coulomb(0.8, 0.6), Havsin(0.8, 0.6)])
@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete"])
def test_extra_evaluations_change_nothing(law, integrator):
    ends = []
    for nosy in (False, True):
        model, data = box(law, mode="solver", options=f'integrator="{integrator}"')
        tilt(model, 20.0)
        data.qvel[1] = 0.5
        for i in range(300):
            mujoco.mj_step(model, data)
            if nosy and i % 5 == 0:
                mujoco.mj_forward(model, data)
                mujoco.mj_inverse(model, data)
                mujoco.mj_forward(model, data)
        ends.append(np.concatenate([data.qpos, data.qvel]))
    assert np.array_equal(*ends)


@pytest.mark.parametrize(("integrator", "e_lim", "solved"), [("RK4", 1e-5, 0), ("RK4", 1e-9, 1), ("Euler", 1e-5, 1)])
def test_modes_choose_themselves(integrator, e_lim, solved):
    """Explicit with RK4 below half the law's limit, 2 (sqrt(1 + 0.09) - 0.3) sqrt(e_lim m/(0.8 N)) = 3.6 ms and 36 us."""
    mechanism = load_scenario("kang2015_table1").mechanism
    spec = belt_box.scene(mechanism)
    spec.option.timestep = 1e-4
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    engine.add_friction(spec, ("box", "belt"), ElasticStick(0.8, 0.46, e_lim=e_lim))
    model = spec.compile()
    data = belt_box.start(model, mechanism)
    mujoco.mj_step(model, data, nstep=100)
    assert header_of(state_of(model, data, 0)).solved == solved


@pytest.mark.parametrize("kind", ["coulomb", "karnopp", "stribeck", "tanh", "smooth", "piecewise_linear"])
def test_every_law_with_a_cap_steers_the_solver(kind):
    model, data = box(make_law(kind, mu_s=0.8, mu_k=0.6), SLIDES, mode="solver")
    steps(model, data, 0.5)
    data.qvel[0] = 1.0
    steps(model, data, 0.1)
    assert 0.3 < data.qvel[0] < 0.55  # 1 - (0.6 to 0.8) g 0.1
    steps(model, data, 0.4)
    assert abs(data.qvel[0]) < 1e-6


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
def test_laws_with_a_memory_of_their_own_are_refused_by_the_solver_mode(kind):
    law = make_law(kind, mu_s=0.8, mu_k=0.6)
    with pytest.raises(InputError, match="use mode 'explicit'"):
        box(law, mode="solver")
    model, data = box(law, SLIDES, dt=1e-4)  # auto: explicit
    steps(model, data, 0.05)
    assert not header_of(state_of(model, data, 0)).solved


def test_any_geom():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><geom name="floor" type="plane" size="5 5 1"/><geom type="box" size="1 1 1" pos="9 0 0"/>
        <body pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05"/></body>
        <body pos="1 0 .05"><freejoint/><geom name="b" type="sphere" size=".05"/></body>
        <body pos="2 0 .05"><freejoint/><geom name="ghost" type="sphere" size=".05" contype="0" conaffinity="0"/></body>
        </worldbody></mujoco>"""
    )
    name = engine.add_friction(spec, ("*", "floor"), ElasticStick(0.8, 0.6))
    model = spec.compile()
    assert name == "friction_any_floor"
    paired = {frozenset((int(i), int(j))) for i, j in zip(model.pair_geom1, model.pair_geom2, strict=True)}
    assert paired == {frozenset((model.geom("floor").id, model.geom(other).id)) for other in ("geom_2", "b")}
    assert set(model.pair_dim) == {3}  # native friction, which the law steers
    with pytest.raises(InputError, match="have friction already"):
        engine.add_friction(spec, ("b", "floor"), ElasticStick(0.8, 0.6))
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    data = mujoco.MjData(again)
    mujoco.mj_step(again, data, nstep=50)
    assert len(engine.readings(again, data)[name]) == 5
    with pytest.raises(InputError, match="names no geom"):
        engine.add_friction(spec, ("*", "*"), ElasticStick(0.8, 0.6))
    with pytest.raises(InputError, match="can collide with no other"):
        engine.add_friction(spec, ("ghost", "*"), ElasticStick(0.8, 0.6))


def test_two_instances_hold_one_body_together():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><option timestep="2e-3" gravity="3 0 -9.2"/><worldbody><geom name="floor" type="plane" size="5 5 1"/>
        <body pos="0 0 .05"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
        <geom name="a" type="sphere" size=".05" pos="-.1 0 0" mass=".5"/>
        <geom name="b" type="sphere" size=".05" pos=".1 0 0" mass=".5"/></body></worldbody></mujoco>"""
    )
    for geom in "ab":
        engine.add_friction(spec, (geom, "floor"), ElasticStick(0.8, 0.6, e_lim=1e-6))
    model = spec.compile()
    data = mujoco.MjData(model)
    steps(model, data, 1.0)
    start = data.qpos[0]
    steps(model, data, 1.0)
    assert abs(data.qpos[0] - start) < 1e-11
    forces = [c[0].force[0] for c in engine.readings(model, data).values()]
    assert sum(forces) == pytest.approx(-3.0, rel=1e-6)
    assert forces[0] == pytest.approx(forces[1], rel=1e-2)


ARM = """<mujoco><option timestep="1e-4" {jacobian}/><worldbody>
<body name="cart"><joint type="slide" axis="1 0 0"/><joint axis="0 0 1"/><geom name="cart" type="box" size="2 2 .1" mass="3"/>
  <body pos="0 0 .3"><geom size=".05" mass=".2" contype="0" conaffinity="0"/></body></body>
<body pos="-.5 .2 .6"><joint axis="0 1 .2"/><joint axis="1 0 0"/><geom type="capsule" size=".04" fromto="0 0 0 .4 0 0"
  contype="0" conaffinity="0"/>
  <body pos=".4 0 0"><joint axis="0 1 0"/><geom type="capsule" size=".04" fromto="0 0 0 .1 .1 -.2" contype="0" conaffinity="0"/>
    <body pos=".1 .1 -.2"><geom name="tip" size=".31"/></body></body></body></worldbody></mujoco>"""


# Both bodies move, one of them through a body without joints of its own; a force at the contact feels 1/(J M^-1 J^T).
@pytest.mark.parametrize("jacobian", ["dense", "sparse"])
def test_the_mass_felt_is_that_of_the_jacobian(jacobian):
    spec = mujoco.MjSpec.from_string(ARM.format(jacobian=f'jacobian="{jacobian}"'))
    engine.add_friction(spec, ("tip", "cart"), ElasticStick(mu_s=0.8, mu_k=0.6), mode="explicit")
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = [0.1, 0.2, 0.05, -0.1, 0.3]
    data.qvel[:] = [0.3, -0.2, 0.1, 0.4, -0.5]
    mujoco.mj_forward(model, data)
    assert data.ncon == 1  # a sphere on a flat top
    (row,) = slots_of(state_of(model, data, 0), committed=False)
    axes = np.array([row["axis_1"], row["axis_2"]])
    jacobian_of = {}
    for name in ("tip", "cart"):
        rows = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, rows, None, data.contact.pos[0], model.geom(name).bodyid[0])
        jacobian_of[name] = rows
    rows = axes @ (jacobian_of["tip"] - jacobian_of["cart"])
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    felt = 1.0 / np.linalg.eigvalsh(rows @ np.linalg.solve(mass, rows.T)).max()
    assert row["felt"] == pytest.approx(felt, rel=1e-12)
    relative = axes @ (jacobian_of["cart"] - jacobian_of["tip"]) @ data.qvel
    assert [row["vx"], row["vy"]] == pytest.approx(relative, abs=1e-13)
