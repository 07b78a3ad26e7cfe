"""MuJoCo: friction that differs by direction, against closed forms and a plain integration of the law's equation."""

import math

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.errors import InputError  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.dahl import Dahl  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402

MU_S, MU_K, ACROSS, G = 0.8, 0.6, 1.5, 9.81
LAWS = [Coulomb(MU_S, MU_K), ElasticStick(MU_S, MU_K), Havsin(MU_S, MU_K)]
SLIDES = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>'


def scene(law, direction=(1.0, 0.0, 0.0), *, joints="<freejoint/>", option="", turned=0.0):
    """Return a box of 1 kg on a plane, turned about the vertical by an angle [rad]."""
    spec = mujoco.MjSpec.from_string(f"""
      <mujoco><compiler angle="radian"/><option cone="elliptic" gravity="0 0 {-G}" {option}/><worldbody>
        <geom name="floor" type="plane" size="9 9 1"/>
        <body pos="0 0 .1" euler="0 0 {turned}">{joints}<geom name="box" type="box" size=".2 .2 .1" mass="1"/></body>
      </worldbody></mujoco>""")
    engine.add_friction(spec, ("box", "floor"), law, anisotropy=engine.Anisotropy(ACROSS, direction))
    return spec


def exact_slide(velocity, angle, seconds):
    """Return velocity and way of a slide with elliptical friction, the direction at ``angle`` from x (midpoint rule)."""
    e1, e2 = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])

    def deceleration(v):
        a, b = v @ e1, v @ e2
        return -MU_K * G * (a * e1 + ACROSS**2 * b * e2) / math.hypot(a, ACROSS * b)

    v, way, h = np.array(velocity), np.zeros(2), 1.0e-5
    for _ in range(round(seconds / h)):
        middle = v + 0.5 * h * deceleration(v)
        way += h * middle
        v = v + h * deceleration(middle)
    return v, way


@pytest.mark.parametrize("jacobian", ["dense", "sparse"])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
def test_a_slide_turns_as_elliptical_friction_says(law, integrator, jacobian):
    angle, start, step = 0.6, (1.0, 0.5), 5.0e-4
    option = f'timestep="{step}" integrator="{integrator}" jacobian="{jacobian}"'
    model = scene(law, (math.cos(angle), math.sin(angle), 0.0), joints=SLIDES, option=option).compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=400)
    data.qvel[:2] = start
    before, seconds = data.qpos[:2].copy(), 0.1
    mujoco.mj_step(model, data, nstep=round(seconds / step))
    v, way = exact_slide(start, angle, seconds)
    # first order in the step: a velocity that is set takes effect within some steps of up to mu g h = 0.003 m/s each
    assert data.qvel[:2] == pytest.approx(v, abs=4.0e-3)
    assert data.qpos[:2] - before == pytest.approx(way, abs=4.0e-4)


def slope_at_break_away(model, downhill):
    """Return the slope [rad] at which the box, settled on the level, slides away; the slope grows by 2 degrees a second."""
    data, slope = mujoco.MjData(model), 0.0
    mujoco.mj_step(model, data, nstep=round(0.3 / model.opt.timestep))
    rate = math.radians(20.0)
    while math.hypot(*data.qvel[:2]) < 0.02 and slope < 1.2:
        x, y = G * math.sin(slope) * math.cos(downhill), G * math.sin(slope) * math.sin(downhill)
        model.opt.gravity[:] = x, y, -G * math.cos(slope)
        mujoco.mj_step(model, data)
        slope += rate * model.opt.timestep
        rate = math.radians(20.0 if slope < 0.6 else 2.0)
    return slope


@pytest.mark.parametrize("law", [LAWS[0], LAWS[1]], ids=lambda law: law.kind)
@pytest.mark.parametrize("downhill", [0.0, 0.5, 0.5 * math.pi])
@pytest.mark.parametrize("option", ['timestep="1e-3"', 'timestep="5e-3" integrator="implicitfast"'])
def test_break_away_lies_on_the_ellipse(law, downhill, option):
    """The direction is y: along it mu_s, across it 1.5 mu_s."""
    limit = math.atan(MU_S / math.hypot(math.sin(downhill), math.cos(downhill) / ACROSS))
    slope = slope_at_break_away(scene(law, (0.0, 1.0, 0.0), option=option).compile(), downhill)
    # the box gains 0.02 m/s in some 0.02 s, in which the slope grows by 0.04 degrees
    assert math.degrees(slope) == pytest.approx(math.degrees(limit), abs=0.1)


def test_the_direction_turns_with_the_body():
    """The direction is the body's x, and the body may be turned by a quarter: along world y it then holds mu_s only."""
    slopes = [slope_at_break_away(scene(LAWS[0], turned=turned).compile(), 0.5 * math.pi) for turned in (0.0, 0.5 * math.pi)]
    expected = [math.atan(ACROSS * MU_S), math.atan(MU_S)]
    assert np.degrees(slopes) == pytest.approx(np.degrees(expected), abs=0.1)


@pytest.mark.parametrize("downhill", [0.0, 0.5 * math.pi])
def test_a_direction_normal_to_the_contact_is_none(downhill):
    slope = slope_at_break_away(scene(LAWS[0], (0.0, 0.0, 1.0)).compile(), downhill)
    assert math.degrees(slope) == pytest.approx(math.degrees(math.atan(MU_S)), abs=0.1)


def test_a_spinning_skate_stays_within_the_ellipse_and_loses_energy():
    """A long box that slides and spins on uneven ground: every contact's force within its ellipse, energy never up by 1 %."""
    rng = np.random.default_rng(3)
    spec = mujoco.MjSpec.from_string("""
      <mujoco><option cone="elliptic" timestep="1e-3"><flag energy="enable"/></option><size memory="16M"/><asset>
      <hfield name="h" nrow="30" ncol="30" size="3 3 .02 .1"/></asset><worldbody><geom name="floor" type="hfield" hfield="h"/>
      <body pos="0 0 .06"><freejoint/><geom name="box" type="box" size=".3 .05 .02" mass="1"/></body></worldbody></mujoco>""")
    spec.hfields[0].userdata = rng.uniform(0.0, 1.0, 900).astype(np.float32)
    engine.add_friction(spec, ("box", "floor"), LAWS[0], slots=64, anisotropy=engine.Anisotropy(ACROSS, (1.0, 0.0, 0.0)))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=300)
    data.qvel[:2], data.qvel[5] = (0.8, 0.4), 4.0
    mujoco.mj_forward(model, data)
    start, loaded = data.energy.sum(), 0
    kinetic = data.energy[1]
    for _ in range(800):
        mujoco.mj_step(model, data)
        for contact in data.contact:
            row = contact.efc_address
            if row >= 0 and data.efc_force[row] > 0.1:
                loaded += 1
                a, b = data.efc_force[row + 1 : row + 3]
                assert math.hypot(a, b / ACROSS) <= MU_S * data.efc_force[row] * (1.0 + 1e-9)
        assert data.energy.sum() <= start + 0.01 * kinetic
    assert loaded > 500
    assert data.energy[1] < 1e-4 * kinetic  # it has come to rest


def test_a_ratio_of_one_is_isotropic_to_rounding():
    ends = []
    for across in (1.0, 1.0 + 1.0e-12):
        spec = mujoco.MjSpec.from_string("""
          <mujoco><option cone="elliptic"/><worldbody><geom name="floor" type="plane" size="9 9 1"/>
          <body pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".2 .2 .1" mass="1"/></body></worldbody></mujoco>""")
        engine.add_friction(spec, ("box", "floor"), LAWS[0], anisotropy=engine.Anisotropy(across, (1.0, 2.0, 0.0)))
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, nstep=50)
        data.qvel[:2] = 1.0, 0.3
        mujoco.mj_step(model, data, nstep=100)
        ends.append(data.qpos[:3].copy())
    assert ends[0] == pytest.approx(ends[1], abs=1.0e-8)  # turned rows are solved in another order, to the solver's tolerance


def test_the_context_and_a_saved_model_do_the_same(tmp_path):
    spec = scene(LAWS[0], (1.0, 1.0, 0.0), joints=SLIDES)
    path = tmp_path / "scene.xml"
    model = spec.compile()
    path.write_text(spec.to_xml(), encoding="utf-8")
    bare = scene(LAWS[0], joints=SLIDES)
    for plugin in list(bare.plugins):
        bare.delete(plugin)
    plain = bare.compile()
    ends = []
    for made in (model, mujoco.MjModel.from_xml_path(str(path))):
        data = mujoco.MjData(made)
        data.qvel[:2] = 0.5, 0.0
        mujoco.mj_step(made, data, nstep=50)
        ends.append(data.qpos[:2].copy())
    data = mujoco.MjData(plain)
    data.qvel[:2] = 0.5, 0.0
    pair = ("box", "floor")
    with engine.friction(plain, data, {pair: LAWS[0]}, anisotropy={pair: engine.Anisotropy(ACROSS, (1.0, 1.0, 0.0))}):
        mujoco.mj_step(plain, data, nstep=50)
    ends.append(data.qpos[:2].copy())
    assert ends[0][1] > 1.0e-3  # friction is stronger across the direction, so the body turns towards it
    assert np.array_equal(ends[0], ends[1])
    assert ends[2] == pytest.approx(ends[0], abs=1.0e-6)  # the context finds the solver's forces again, from its acceleration


def test_what_cannot_be_is_refused():
    with pytest.raises(InputError, match="across must be > 0"):
        engine.Anisotropy(0.0)
    with pytest.raises(InputError, match="has no length"):
        engine.Anisotropy(1.5, (0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="three numbers"):
        engine.Anisotropy(1.5, (1.0, 0.0))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="differs by direction is found by MuJoCo's solver"):
        scene(Dahl(MU_S, MU_K))
    with pytest.raises(InputError, match="needs Newton or CG"):
        scene(LAWS[0], option='solver="PGS"')
    spec = scene(LAWS[0], joints='<joint name="j" type="slide" axis="1 0 0"/>')
    with pytest.raises(InputError, match="has one direction"):
        engine.add_friction(spec, engine.Joint("j"), LAWS[0], normal_force=1.0, anisotropy=engine.Anisotropy(1.5))
