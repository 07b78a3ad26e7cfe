"""MuJoCo: spinning and rolling bodies against closed-form mechanics."""

import math

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402

G = 9.81
STIFF = 'solref="-1e5 -600"'
"""Sinks in by 1e-4 m: the radii of the closed forms hold to 1 in 1000."""
MODES = [
    pytest.param(ElasticStick(0.5, 0.5), "explicit", id="elastic-explicit"),
    pytest.param(ElasticStick(0.5, 0.5), "solver", id="elastic-solver"),
    pytest.param(Coulomb(0.5, 0.5), "solver", id="coulomb-solver"),
]


def scene(geom, law, mode, *, degrees=0.0, height=0.1):
    """Return a body of 1 kg that has come to rest on the floor; gravity is tilted towards +x."""
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4" integrator="Euler"/><worldbody>
        <geom name="floor" type="plane" size="50 50 1" {STIFF}/>
        <body pos="0 0 {height}"><freejoint/><geom name="body" mass="1" {STIFF} {geom}/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("body", "floor"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    steps(model, data, 0.3)
    angle = math.radians(degrees)
    data.qvel[:] = 0.0
    model.opt.gravity = [G * math.sin(angle), 0.0, -G * math.cos(angle)]
    return model, data


def steps(model, data, seconds):
    mujoco.mj_step(model, data, nstep=round(seconds / model.opt.timestep))


SPHERE, CYLINDER = 'type="sphere" size=".1"', 'type="cylinder" size=".1 .2" euler="90 0 0"'


@pytest.mark.parametrize(("law", "mode"), MODES)
@pytest.mark.parametrize(("geom", "shape"), [(SPHERE, 2 / 5), (CYLINDER, 1 / 2)])
def test_rolling_down_an_incline(geom, shape, law, mode):
    model, data = scene(geom, law, mode, degrees=20.0)
    steps(model, data, 0.1)
    start, turning = float(data.qvel[0]), float(data.qvel[[3, 4, 5]] @ data.qvel[[3, 4, 5]]) ** 0.5
    steps(model, data, 0.5)
    wanted = 0.5 * G * math.sin(math.radians(20.0)) / (1.0 + shape)  # needs mu >= tan(20) shape/(1 + shape) = 0.12
    assert data.qvel[0] - start == pytest.approx(wanted, rel=1e-3)
    assert np.linalg.norm(data.qvel[3:]) - turning == pytest.approx(wanted / 0.1, rel=1e-3)


@pytest.mark.parametrize(("law", "mode"), MODES)
def test_a_sphere_slips_down_a_steep_incline(law, mode):
    model, data = scene(SPHERE, law, mode, degrees=65.0)
    steps(model, data, 0.1)
    start, turning = float(data.qvel[0]), float(np.linalg.norm(data.qvel[3:]))
    steps(model, data, 0.3)  # mu < 2/7 tan(65)
    angle = math.radians(65.0)
    assert data.qvel[0] - start == pytest.approx(0.3 * G * (math.sin(angle) - 0.5 * math.cos(angle)), rel=1e-3)
    assert np.linalg.norm(data.qvel[3:]) - turning == pytest.approx(0.3 * 2.5 * 0.5 * G * math.cos(angle) / 0.1, rel=1e-3)


@pytest.mark.parametrize(("law", "mode"), MODES)
@pytest.mark.parametrize("backspin", [-60.0, -20.0, 40.0])
def test_a_sphere_with_spin_ends_rolling(law, mode, backspin):
    model, data = scene(SPHERE, law, mode)
    data.qvel[0], data.qvel[4] = 1.0, backspin
    steps(model, data, 1.5)
    rolling = (5.0 * 1.0 + 2.0 * 0.1 * backspin) / 7.0  # angular momentum about the contact point is kept
    assert data.qvel[0] == pytest.approx(rolling, abs=2e-3)
    assert data.qvel[4] == pytest.approx(rolling / 0.1, abs=4e-2)


@pytest.mark.parametrize(("law", "mode"), MODES)
def test_a_box_spins_down(law, mode):
    model, data = scene('type="box" size=".1 .1 .02"', law, mode, height=0.02)
    data.qvel[5] = 20.0
    steps(model, data, 0.1)
    inertia, corner = (0.2**2 + 0.2**2) / 12.0, 0.1 * math.sqrt(2.0)
    assert data.qvel[5] == pytest.approx(20.0 - 0.1 * 0.5 * G * corner / inertia, rel=2e-3)
    assert np.abs(data.qvel[:2]).max() < 1e-3  # it stays where it is


@pytest.mark.parametrize(("law", "mode"), MODES)
def test_a_spinning_top_feels_nothing_at_its_point(law, mode):
    model, data = scene(SPHERE, law, mode)
    data.qvel[5] = 50.0
    steps(model, data, 0.5)
    assert data.qvel[5] == pytest.approx(50.0, rel=1e-9)  # friction in a point has no lever arm
    assert np.abs(data.qvel[:2]).max() < 1e-9


@pytest.mark.parametrize(("law", "mode"), MODES)
def test_a_spinning_box_slides_straight_and_far(law, mode):
    """Spin spends friction: a box that spins as well slides farther than one that does not."""
    stops = []
    for spin in (0.0, 30.0):
        model, data = scene('type="box" size=".1 .1 .02"', law, mode, height=0.02)
        start = data.qpos[:2].copy()
        data.qvel[0], data.qvel[5] = 1.0, spin
        before = float(0.5 * (data.qvel[0] ** 2 + (0.08 / 12.0) * spin**2))
        steps(model, data, 1.5)
        assert np.abs(data.qvel).max() < 1e-3
        mujoco.mj_forward(model, data)
        (result,) = engine.readings(model, data).values()
        assert sum(c.dissipated for c in result) == pytest.approx(before, rel=1e-2)
        stops.append(data.qpos[:2] - start)
    assert stops[0][0] == pytest.approx(1.0 / (2.0 * 0.5 * G), rel=2e-3)
    assert abs(stops[1][1]) < 2e-3  # no side force on average
    assert stops[1][0] > 1.3 * stops[0][0]
