"""MuJoCo, mode solver: what statics and dynamics ask of Coulomb's law, on an incline, in a gripper, a stack, between bodies."""

import math

import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402

G = 9.81
INTEGRATORS = ("Euler", "implicitfast", "RK4", "discrete")
COULOMB, ELASTIC = Coulomb(0.5, 0.4), ElasticStick(0.5, 0.4)
pytestmark = pytest.mark.filterwarnings("ignore::stochfric_mb.mujoco.IntegratorWarning")


def model_of(bodies, pairs, law, *, dt=2e-3, integrator="Euler", extra=""):
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="{dt}" integrator="{integrator}" cone="elliptic"/><worldbody>
        <geom name="floor" type="plane" size="50 50 1"/>{bodies}</worldbody>{extra}</mujoco>"""
    )
    for k, pair in enumerate(pairs):
        engine.add_friction(spec, pair, law, contact=k, mode="solver")
    return spec.compile()


def box(name, height, size, mass):
    half = size.split()[2]
    return (
        f'<body pos="0 0 {height}"><freejoint/><geom name="{name}" type="box" size="{size}" mass="{mass}"/></body>',
        2.0 * float(half),
    )


def tilt(model, degrees):
    angle = math.radians(degrees)
    model.opt.gravity[:] = G * math.sin(angle), 0.0, -G * math.cos(angle)


@pytest.mark.parametrize("law", [COULOMB, ELASTIC], ids=lambda law: law.kind)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_box_holds_on_twenty_degrees_for_ten_seconds(integrator, law):
    model = model_of(box("box", 0.05, ".05 .05 .05", 1.0)[0], [("box", "floor")], law, integrator=integrator)
    data = mujoco.MjData(model)
    tilt(model, 20.0)
    mujoco.mj_step(model, data, nstep=2000)
    start = float(data.qpos[0])
    mujoco.mj_step(model, data, nstep=5000)
    # [m]; natively 9 mm. With implicitfast, MuJoCo's solver iterates in most steps, and stops within its tolerance (1e-8).
    assert abs(data.qpos[0] - start) < (5e-11 if integrator == "implicitfast" else 1e-12)


@pytest.mark.parametrize("dt", [1e-3, 2e-3, 5e-3])
def test_what_implicitfast_creeps_is_the_tolerance_of_the_solver(dt):
    model = model_of(box("box", 0.05, ".05 .05 .05", 1.0)[0], [("box", "floor")], COULOMB, dt=dt, integrator="implicitfast")
    model.opt.tolerance = 1e-10  # MuJoCo's default is 1e-8
    data = mujoco.MjData(model)
    tilt(model, 20.0)
    mujoco.mj_step(model, data, nstep=round(4.0 / dt))
    start = float(data.qpos[0])
    mujoco.mj_step(model, data, nstep=round(10.0 / dt))
    assert abs(data.qpos[0] - start) < 1e-12  # [m]


@pytest.mark.parametrize("shrink", [0.0, 0.01], ids=["equal", "smaller upwards"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_stack_of_five_slabs_slides_at_the_angle_of_friction(integrator, shrink):
    """Of equal slabs, which lie edge on edge, contacts come and go by rounding; soft ground lets each tilt a little further."""
    bodies, height = "", 0.0
    for k in range(5):
        side = 0.1 - shrink * k
        body, thick = box(f"slab{k}", height + 0.01, f"{side} {side} .01", 1.0)
        bodies, height = bodies + body, height + thick
    pairs = [("slab0", "floor"), *((f"slab{k + 1}", f"slab{k}") for k in range(4))]
    model = model_of(bodies, pairs, COULOMB, integrator=integrator)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    angle = 0.0
    while abs(data.qvel[24] - data.qvel[18]) < 5e-3:
        angle += 2e-3 * (10.0 if angle < 24.0 else 0.5)
        assert angle < 32.0
        tilt(model, angle)
        mujoco.mj_step(model, data)
    top = {model.geom("slab4").id, model.geom("slab3").id}
    (normal, *_) = (frame for frame, geoms in zip(data.contact.frame, data.contact.geom, strict=True) if set(geoms) == top)
    leaning = math.degrees(math.atan(normal[0] / normal[2]))
    assert 0.1 < leaning < 0.2
    assert angle + leaning == pytest.approx(math.degrees(math.atan(0.5)), abs=0.02)


FINGERS = """<body pos="-.03 0 .3"><joint name="left" type="slide" axis="1 0 0"/><geom name="left" type="box"
size=".01 .02 .04" mass=".1"/></body><body pos=".03 0 .3"><joint name="right" type="slide" axis="-1 0 0"/>
<geom name="right" type="box" size=".01 .02 .04" mass=".1"/></body><body pos="0 0 .3"><freejoint/><geom name="part" type="box"
size=".0199 .015 .03" mass=".2"/></body>"""


@pytest.mark.parametrize("size", [".0199 .015 .03", ".0199 .02 .04"], ids=["smaller", "faces alike"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("share", "holds"), [(1.01, True), (0.99, False)])
def test_a_gripper_holds_from_its_threshold_on(integrator, share, holds, size):
    """Two fingers hold a weight of up to 2 mu_s times the force that presses them."""
    actuators = '<actuator><motor joint="left"/><motor joint="right"/></actuator>'
    pairs = [("part", "left"), ("part", "right")]
    model = model_of(FINGERS.replace(".0199 .015 .03", size), pairs, COULOMB, integrator=integrator, extra=actuators)
    data = mujoco.MjData(model)
    data.ctrl[:] = share * 0.2 * G / (2.0 * 0.5)
    model.opt.gravity[2] = 0.0
    mujoco.mj_step(model, data, nstep=500)
    for k in range(500):  # not at once, which would ask for more for a moment
        model.opt.gravity[2] = -G * (k + 1) / 500
        mujoco.mj_step(model, data)
    start = float(data.qpos[4])
    mujoco.mj_step(model, data, nstep=500)
    fallen = start - float(data.qpos[4])
    assert fallen < 1e-7 if holds else fallen > 0.1  # [m]


@pytest.mark.parametrize("law", [COULOMB, ELASTIC], ids=lambda law: law.kind)
@pytest.mark.parametrize("dt", [1e-3, 5e-3])
def test_a_box_stops_where_its_energy_is_spent(dt, law):
    model = model_of(box("box", 0.05, ".2 .2 .05", 1.0)[0], [("box", "floor")], law, dt=dt)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(1.0 / dt))
    start = float(data.qpos[0])
    data.qvel[0] = 2.0
    mujoco.mj_step(model, data, nstep=round(1.5 / dt))
    # Semi-implicit Euler stops v h/2 short of v^2/(2 mu g); the box pitches, which moves its middle by a tenth of a millimetre.
    assert data.qpos[0] - start == pytest.approx(4.0 / (2.0 * 0.4 * G) - dt, abs=3e-4 + 0.1 * dt)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_two_bodies_keep_their_momentum(integrator):
    """A box slides on a plank that nothing else holds: 3 kg end at a third of 1 m/s."""
    bodies = """<body name="plank" pos="0 0 1"><joint type="slide" axis="1 0 0"/><geom name="plank" type="box" size="2 .2 .05"
    mass="2"/></body><body pos="0 0 1.1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><geom name="box"
    type="box" size=".1 .1 .05" mass="1"/></body>"""
    model = model_of(bodies, [("box", "plank")], COULOMB, integrator=integrator)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=200)
    data.qvel[:2] = 0.0, 1.0
    for _ in range(500):
        mujoco.mj_step(model, data)
        assert 2.0 * data.qvel[0] + data.qvel[1] == pytest.approx(1.0, abs=1e-11)
    assert data.qvel[0] == pytest.approx(1.0 / 3.0, abs=1e-9)
    assert data.qvel[1] == pytest.approx(1.0 / 3.0, abs=1e-9)
