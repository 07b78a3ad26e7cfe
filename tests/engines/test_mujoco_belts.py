"""MuJoCo: belts, drums and a capstan, against closed-form mechanics."""

import math

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402

G = 9.81
STICKING = [
    pytest.param(ElasticStick(0.8, 0.6), "explicit", id="elastic-explicit"),
    pytest.param(ElasticStick(0.8, 0.6), "solver", id="elastic-solver"),
    pytest.param(Coulomb(0.8, 0.6), "solver", id="coulomb-solver"),
]
SLIDES = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'


def steps(model, data, seconds):
    mujoco.mj_step(model, data, nstep=round(seconds / model.opt.timestep))


# --- belts ----------------------------------------------------------------------------------------------------------


def tilted_belt(degrees, speed, law, mode):
    """Return a box at rest on a belt that runs uphill; gravity is turned, so that x is along the belt."""
    angle = math.radians(degrees)
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4"/><worldbody>
        <geom name="belt" type="plane" size="50 5 1" euler="0 {-degrees} 0" surfacevel="{speed} 0 0 0 0 0"/>
        <body euler="0 {-degrees} 0" pos="{-0.0499 * math.sin(angle)} 0 {0.0499 * math.cos(angle)}">
        {SLIDES}<geom name="box" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("box", "belt"), law, mode=mode)
    model = spec.compile()
    return model, mujoco.MjData(model), angle


@pytest.mark.parametrize(("law", "mode"), STICKING)
def test_a_tilted_belt_carries_a_box_uphill(law, mode):
    model, data, angle = tilted_belt(20.0, 0.5, law, mode)
    steps(model, data, 0.05)  # the landing
    start = float(data.qvel[0])
    steps(model, data, 0.1)
    pull = G * (0.6 * math.cos(angle) - math.sin(angle))
    assert data.qvel[0] - start == pytest.approx(0.1 * pull, rel=1e-3)
    steps(model, data, 0.5)
    assert data.qvel[0] == pytest.approx(0.5, abs=2e-3)  # rides; elastic contacts ring at first
    before = float(data.qpos[0])
    steps(model, data, 1.0)
    assert data.qpos[0] - before == pytest.approx(0.5, abs=2 * law.e_lim if hasattr(law, "e_lim") else 1e-9)


@pytest.mark.parametrize(("law", "mode"), STICKING)
def test_a_box_slides_down_a_steep_belt(law, mode):
    model, data, angle = tilted_belt(45.0, 0.5, law, mode)
    steps(model, data, 0.05)
    start = float(data.qvel[0])
    steps(model, data, 0.5)
    assert data.qvel[0] - start == pytest.approx(-0.5 * G * (math.sin(angle) - 0.6 * math.cos(angle)), rel=1e-3)


@pytest.mark.parametrize(("law", "mode"), STICKING)
def test_a_sliding_body_as_belt(law, mode):
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4"/><worldbody>
        <body><joint name="belt" type="slide" axis="1 0 0"/><geom name="belt" type="box" size="20 1 .1" mass="1e6"/></body>
        <body pos="0 0 .1499">{SLIDES}<geom name="box" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("box", "belt"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    steps(model, data, 0.05)
    start = float(data.qvel[1])
    steps(model, data, 0.08)
    assert data.qvel[1] - start == pytest.approx(0.6 * G * 0.08, rel=1e-3)
    steps(model, data, 0.5)
    apart = float(data.qpos[1] - data.qpos[0])
    steps(model, data, 1.0)
    assert data.qpos[1] - data.qpos[0] == pytest.approx(apart, abs=2 * law.e_lim if hasattr(law, "e_lim") else 1e-9)


# --- drums ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("law", "mode"), STICKING)
def test_a_shoe_rides_a_drum_until_its_spring_tears_it_off(law, mode):
    radius, load, stiffness, rate = 0.2, 10.0, 8.0, 0.1
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="5e-4" gravity="0 0 0"/><worldbody>
        <body><joint name="drum" axis="0 1 0"/><geom name="drum" type="cylinder" size="{radius} .1"
        euler="90 0 0" mass="1e5"/></body>
        <body><joint name="arm" axis="0 1 0" stiffness="{stiffness}"/>
        <joint name="press" type="slide" axis="0 0 1"/>
        <geom name="shoe" type="sphere" pos="0 0 {radius + 0.02}" size=".02" mass=".1"
        solref="-1e5 -500"/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("shoe", "drum"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("drum").qvel[0] = data.joint("arm").qvel[0] = rate
    data.joint("press").qfrc_applied[0] = -load
    steps(model, data, 0.1)
    drum, arm = data.joint("drum"), data.joint("arm")
    lag, farthest = float(drum.qpos[0] - arm.qpos[0]), 0.0
    torn_at = 0.8 * load * radius / stiffness  # mu_s N r = k phi
    while arm.qpos[0] > farthest - 1e-3:
        assert data.time < 1.5 * torn_at / rate
        mujoco.mj_step(model, data)
        farthest = max(farthest, float(arm.qpos[0]))
        if drum.qpos[0] < 0.98 * torn_at:
            # e_lim/r is 5e-5; the solver gives a little, too
            assert drum.qpos[0] - arm.qpos[0] - lag == pytest.approx(0.0, abs=8e-5)
    # True stick turns back within two steps, in which the drum turns by 1e-4. Elastic stick slips at mu_s up to v_s first,
    # while the spring's force rises by k rate/r: for sqrt(2 v_s m r/(k rate)) = 2.5 ms, and then needs about a millisecond to
    # reach mu_k; the drum goes on meanwhile.
    assert farthest == pytest.approx(torn_at, abs=5e-4 if isinstance(law, ElasticStick) else 1e-4)


@pytest.mark.parametrize(("law", "mode"), STICKING)
def test_a_body_held_by_a_spring_on_a_running_drum(law, mode):
    radius, stiffness = 0.2, 400.0
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4"/><worldbody>
        <body><joint name="drum" axis="0 1 0"/><geom name="drum" type="cylinder" size="{radius} .1"
        euler="90 0 0" mass="1e5"/></body>
        <body pos="0 0 {radius + 0.05}"><joint name="x" type="slide" axis="1 0 0" stiffness="{stiffness}" damping="16"/>
        <joint name="z" type="slide" axis="0 0 1" damping="2"/>
        <geom name="body" type="sphere" size=".05" mass="1" solref=".005 1"/></body></worldbody></mujoco>"""
    )
    engine.add_friction(spec, ("body", "drum"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("drum").qvel[0] = 5.0
    steps(model, data, 4.0)
    x, z = data.joint("x").qpos[0], radius + 0.05 + data.joint("z").qpos[0]
    angle = math.atan2(x, z)
    pull = stiffness * x
    normal_force = G * math.cos(angle) + pull * math.sin(angle)
    # At rest on the running drum: the tangential parts of spring, weight and mu_k N are in balance.
    assert pull * math.cos(angle) - G * math.sin(angle) == pytest.approx(0.6 * normal_force, rel=1e-6)
    mujoco.mj_forward(model, data)
    assert engine.readings(model, data)["friction_body_drum"][0].normal_force == pytest.approx(normal_force, rel=1e-6)


# --- the capstan ----------------------------------------------------------------------------------------------------

BEADS, BEND, TAIL = 24, math.radians(7.5), 0.1
"""A rope of point masses, wrapped by 180 degrees; its bend at each of them [rad]; the force on its tail [N]."""


def capstan(law, mode):
    """Return a rope on a drum that runs away from where its head is tied."""
    at = 0.102  # the drum's radius and a bead's
    places = [(at * math.cos(a), at * math.sin(a)) for a in (math.pi - (k - 0.5) * BEND for k in range(BEADS + 1))]
    bodies = "".join(
        f'<body pos="{x} 0 {z}"><joint type="slide" axis="1 0 0" damping=".2"/><joint type="slide" axis="0 0 1" damping=".2"/>'
        f'<geom name="bead{k}" type="sphere" size=".002" mass=".01" solref=".002 1"/><site name="s{k}"/></body>'
        for k, (x, z) in enumerate(places)
        if k > 0
    )
    ties = "".join(
        f'<spatial name="t{k}" stiffness="3e4" damping="1"><site site="s{k}"/><site site="s{k + 1}"/></spatial>'
        for k in range(BEADS)
    )
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4" gravity="0 0 0"/><worldbody><site name="s0" pos="{places[0][0]} 0 {places[0][1]}"/>
        <body><joint axis="0 1 0"/><geom name="drum" type="cylinder" size=".1 .1" euler="90 0 0" mass="1e5"
        solref=".002 1" contype="2" conaffinity="2"/></body>{bodies}</worldbody><tendon>{ties}</tendon></mujoco>"""
    )
    for k in range(1, BEADS + 1):
        spec.geom(f"bead{k}").contype, spec.geom(f"bead{k}").conaffinity = 2, 0
    engine.add_friction(spec, ("*", "drum"), law, mode=mode)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    end = BEADS * BEND - 0.5 * BEND  # the tail goes on along the polygon
    last = math.pi - end
    data.xfrc_applied[-1, :3] = TAIL * math.sin(last - BEND / 2), 0.0, -TAIL * math.cos(last - BEND / 2)
    return model, data


@pytest.mark.parametrize(
    ("law", "mode"),
    [
        pytest.param(ElasticStick(0.3, 0.3, e_lim=1e-4), "explicit", id="elastic-explicit"),
        pytest.param(ElasticStick(0.3, 0.3), "solver", id="elastic-solver"),
        pytest.param(Coulomb(0.3, 0.3), "solver", id="coulomb-solver"),
    ],
)
def test_a_rope_on_a_running_drum(law, mode):
    model, data = capstan(law, mode)
    steps(model, data, 4.0)
    assert np.abs(data.qvel[1:]).max() < 1e-6  # the rope stands
    tension = float(model.tendon_stiffness[0] * (data.ten_length[0] - model.tendon_lengthspring[0, 1]))
    half, mu = math.tan(BEND / 2.0), 0.3
    ratio = ((1.0 + mu * half) / (1.0 - mu * half)) ** BEADS  # Euler and Eytelwein's exp(mu pi) for a rope of beads
    assert ratio == pytest.approx(math.exp(mu * math.pi), rel=2e-3)  # of bends of 7.5 degrees instead of a circle
    assert tension / TAIL == pytest.approx(ratio, rel=2e-4)  # the rope stretches by 1 in 10^4
