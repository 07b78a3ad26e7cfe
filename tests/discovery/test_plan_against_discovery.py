"""Detection limits of a plan, put to the test: of three times its limit an effect is found, of a third it is not."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.planner import planned
from stochfric_mb.effects import effect_class, make_effect
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.reference.augmented import Start, augmented_system
from stochfric_mb.scenario import any_scenario_from_dict

pytestmark = pytest.mark.slow

BELT = {
    "schema": "stochfric.scenario/1",
    "mechanism": {
        "kind": "belt_box", "mass": 6.08, "damping": 0.768, "stiffness": 3956.0, "normal_force": 13.0, "belt_velocity": 2.5e-3
    },
    "law": {"kind": "coulomb", "mu_s": 0.8, "mu_k": 0.46},
    "uncertainty": {"mass": 0.003, "stiffness": 0.01, "damping": 0.2, "normal_force": 0.01, "mu_s": 0.05, "mu_k": 0.05},
    "simulation": {"duration": 10.0, "output_step": 1.0e-3},
}  # fmt: skip
BELT_RUNS = [
    PlannedRun(name="slow", duration=30.0, sample_rate=1000.0, noise=5.0e-6),
    PlannedRun(name="fast", duration=15.0, sample_rate=1000.0, noise=5.0e-6, settings={"belt_velocity": 5.0e-3}),
]
JOINT = {
    "schema": "stochfric.scenario/1",
    "mechanism": {"kind": "prismatic_joint", "mass": 95.0, "normal_force": 932.0},
    "law": {"kind": "coulomb", "mu_s": 0.03, "mu_k": 0.02},
    "uncertainty": {"mass": 0.05, "mu_s": 0.5, "mu_k": 0.5},
    "simulation": {"duration": 20.0, "output_step": 1.0e-3},
}
JOINT_RUNS = [
    PlannedRun(name="fast", duration=20.0, sample_rate=1000.0, noise=5.0e-6, force_noise=1.0, stroke=0.2, period=2.0),
    PlannedRun(name="slow", duration=60.0, sample_rate=1000.0, noise=5.0e-6, force_noise=1.0, stroke=0.2, period=6.0),
]


def _limits(table, runs):
    scenario = any_scenario_from_dict(table)
    return scenario, {limit.kind: limit for limit in planned(scenario, runs, extra=False).limits}


@pytest.fixture(scope="module")
def belt():
    return _limits(BELT, BELT_RUNS)


@pytest.fixture(scope="module")
def joint():
    return _limits(JOINT, JOINT_RUNS)


def _effect(limit, multiple):
    fields = effect_class(limit.kind).__dataclass_fields__
    values = {k: v for k, v in limit.beside.items() if k in fields} | {limit.parameter: multiple * limit.value}
    if limit.parameter == "sigma_s":
        values["sigma_k"] = values["sigma_s"]
    return make_effect(limit.kind, **values)


def _belt_run(scenario, run, effect, role, seed):
    """A record that begins anywhere in the cycle."""
    bare = Run(name=run.name + role, role=role, time=np.zeros(0), channels={}, settings=run.settings, sample_interval=1.0e-3)
    box, before = bare.mechanism(scenario), 6.0 + 0.37 * seed
    system = augmented_system(box, scenario.law, [effect], seed=seed)
    start = system.march(Start(-before, 0.0, box.belt_velocity, stick=True), 1.0e-3, round(before / 1.0e-3)).end
    motion = system.march(start, 1.0e-3, round(run.duration / 1.0e-3))
    noise = run.noise * np.random.default_rng(seed).standard_normal(len(motion.position))
    read = effect.measure(1.0e-3 * np.arange(len(noise)), motion.position, np.random.default_rng(seed))
    return dataclasses.replace(bare, time=1.0e-3 * np.arange(len(noise)), channels={"position": read + noise})


def _said(scenario, runs):
    result = discover(Dataset(title="", scenario_path=None, scenario=scenario, runs=tuple(runs))).result
    return result.verdict, {kind for e in result.effects for kind in (e.kind, *e.equivalent_to)}


@pytest.mark.parametrize(
    "kind",
    ["viscous_friction", "velocity_weakening", "quadratic_damping", "dwell_ageing", "position_dependent_friction",
     "harmonic_force", "friction_drift", "random_coefficients"],
)  # fmt: skip
def test_limits_of_a_belt_rig(belt, kind):
    scenario, limits = belt
    for multiple, verdict in ((3.0, "effect"), (0.3, "none")):
        effect = _effect(limits[kind], multiple)
        runs = [
            _belt_run(scenario, run, effect, role, seed=1 + i + 10 * j)
            for j, role in enumerate(("fit", "test"))
            for i, run in enumerate(BELT_RUNS)
        ]
        said, named = _said(scenario, runs)
        assert said == verdict, multiple
        assert (kind in named) == (verdict == "effect")


def _joint_run(scenario, run, extra, role, seed):
    """A harmonic motion and its drive, written from the equation of motion alone."""
    generator, rate = np.random.default_rng(seed), 2.0 * math.pi / run.period
    time = np.arange(round(run.duration * run.sample_rate)) / run.sample_rate
    q, v = 0.5 * run.stroke * np.sin(rate * time), 0.5 * run.stroke * rate * np.cos(rate * time)
    joint, friction = scenario.mechanism, scenario.law.mu_k * scenario.mechanism.normal_force
    force = -joint.mass * rate**2 * q + friction * np.sign(v) + extra(v)
    channels = {
        "position": q + run.noise * generator.standard_normal(len(q)),
        "force": force + run.force_noise * generator.standard_normal(len(q)),
    }
    return Run(name=run.name + role, role=role, time=time, channels=channels, sample_interval=1.0 / run.sample_rate)


@pytest.mark.parametrize(
    ("kind", "force"),
    [
        ("viscous_friction", lambda size, v: size * v),
        ("direction_asymmetry", lambda size, v: np.where(v < 0.0, -size * 0.02 * 932.0, 0.0)),
    ],
)
def test_limits_of_a_joint(joint, kind, force):
    scenario, limits = joint
    for multiple, verdict in ((3.0, "effect"), (0.3, "none")):
        size = multiple * limits[kind].value
        runs = [
            _joint_run(scenario, run, lambda v, size=size: force(size, v), role, seed=50 + i + 10 * j)
            for j, role in enumerate(("fit", "test"))
            for i, run in enumerate(JOINT_RUNS)
        ]
        said, named = _said(scenario, runs)
        assert said == verdict, multiple
        assert (kind in named) == (verdict == "effect")


SLIDER = {
    "schema": "stochfric.scenario/1",
    "mechanism": {"kind": "spring_slider", "stiffness": 2000.0},
    "law": {"kind": "coulomb", "mu_s": 0.6, "mu_k": 0.6},
    "uncertainty": {"stiffness": 0.5, "mu_s": 0.05, "mu_k": 0.05},
    "simulation": {"duration": 120.0, "output_step": 0.02},
}
SLIDER_RUN = PlannedRun(
    name="steps", duration=120.0, sample_rate=50.0, noise=0.0, force_noise=2.0e-4,
    slow_speed=3.0e-6, fast_speed=1.0e-5, period=40.0,
)  # fmt: skip


def _remembering(time, speed, size, distance):
    """Ageing law (Dieterich 1979) with a = b = ``size`` pulled through the spring, by an independent solver."""
    stiffness, slow = SLIDER["mechanism"]["stiffness"], SLIDER_RUN.slow_speed

    def slopes(t, state):
        change, log_theta = state
        v = slow * np.exp((change - size * (log_theta - np.log(distance / slow))) / size)
        return [stiffness * (speed(t) - v), np.exp(-log_theta) - v / distance]

    begin = [0.0, np.log(distance / slow)]
    return solve_ivp(slopes, (0.0, time[-1]), begin, "LSODA", time, rtol=1e-8, atol=1e-12, max_step=0.05).y[0]


def _step_run(limit, multiple, role, seed):
    """Velocity steps of one of the laws, written from its equation."""
    run, size = SLIDER_RUN, multiple * limit.value
    time = np.arange(round(run.duration * run.sample_rate)) / run.sample_rate

    def speed(t):
        return np.where(np.mod(t, run.period) < 0.5 * run.period, run.slow_speed, run.fast_speed)

    way = np.concatenate([[0.0], np.cumsum(speed(time))[:-1]]) / run.sample_rate
    changes = {
        "distance_drift": lambda: size * way,
        "velocity_weakening": lambda: -size * np.log(speed(time) / run.slow_speed),
        "viscous_friction": lambda: size * np.log(speed(time) / run.slow_speed),
        "frictional_lag": lambda: _remembering(time, lambda t: float(speed(t)), size, limit.beside["distance"]),
    }
    noise = run.force_noise * np.random.default_rng(seed).standard_normal(len(time))
    begin = 0.0 if role == "fit" else run.duration  # the held-out run follows the fitted one
    return Run(
        name=role, role=role, time=begin + time, channels={"position": way}, sample_interval=1.0 / run.sample_rate,
        covariates={"friction_coefficient": 0.6 + changes[limit.kind]() + noise},
    )  # fmt: skip


@pytest.mark.parametrize("kind", ["distance_drift", "velocity_weakening", "viscous_friction", "frictional_lag"])
def test_limits_of_a_spring_slider(kind):
    scenario = any_scenario_from_dict(SLIDER)
    plan = planned(scenario, [SLIDER_RUN], extra=False)
    limit = next(one for one in plan.limits if one.kind == kind)
    for multiple, verdict in ((3.0, "effect"), (0.3, "none")):
        runs = [_step_run(limit, multiple, role, seed) for seed, role in enumerate(("fit", "test"))]
        said, named = _said(scenario, runs)
        assert said == verdict, multiple
        assert (kind in named) == (verdict == "effect")


PENDULUM = """<mujoco><compiler angle="radian"/><option timestep="0.001" gravity="0 0 -9.81"/><worldbody><body>
<joint name="pin" type="hinge" axis="0 1 0" armature="0.02"/>
<inertial pos="0 0 -0.3" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/><geom size="0.02" contype="0" conaffinity="0"/>
</body></worldbody></mujoco>"""
PIN = {
    "schema": "stochfric.scenario/1",
    "mechanism": {
        "kind": "mjcf", "file": "pendulum.xml", "friction": {"pin": 1.0}, "positions": {"pin": "q"}, "drives": {"pin": "u"}
    },
    "law": {"kind": "coulomb", "mu_s": 0.2, "mu_k": 0.2},
    "uncertainty": {"mass": 0.02, "mu_s": 0.3, "mu_k": 0.3},
    "simulation": {"duration": 20.0, "output_step": 0.002},
}  # fmt: skip
PIN_RUNS = [
    PlannedRun(name="fast", duration=20.0, sample_rate=500.0, noise=1.0e-5, force_noise=2.0e-3, stroke=1.0, period=2.0),
    PlannedRun(name="slow", duration=40.0, sample_rate=500.0, noise=1.0e-5, force_noise=2.0e-3, stroke=1.0, period=5.0),
]


def _pin_run(run, extra, role, seed):
    """A pendulum that swings harmonically, and its torque, written on paper."""
    generator, rate = np.random.default_rng(seed), 2.0 * math.pi / run.period
    time = np.arange(round(run.duration * run.sample_rate)) / run.sample_rate
    q, v = 0.5 * run.stroke * np.sin(rate * time), 0.5 * run.stroke * rate * np.cos(rate * time)
    torque = -(0.02 + 1.0e-3 + 0.5 * 0.3**2) * rate**2 * q + 0.5 * 9.81 * 0.3 * np.sin(q) + 0.2 * np.sign(v) + extra(v)
    channels = {
        "q": q + run.noise * generator.standard_normal(len(q)),
        "u": torque + run.force_noise * generator.standard_normal(len(q)),
    }
    return Run(name=run.name + role, role=role, time=time, channels=channels, sample_interval=1.0 / run.sample_rate)


@pytest.mark.parametrize(
    ("kind", "torque"),
    [
        ("viscous_friction", lambda size, v: size * v),
        ("direction_asymmetry", lambda size, v: np.where(v < 0.0, -size * 0.2, 0.0)),
    ],
)
def test_limits_of_a_joint_of_a_model(tmp_path, kind, torque):
    pytest.importorskip("mujoco", reason="the model is one of MuJoCo's")
    (tmp_path / "pendulum.xml").write_text(PENDULUM)
    scenario = any_scenario_from_dict(PIN, folder=tmp_path)
    limit = next(one for one in planned(scenario, PIN_RUNS, extra=False).limits if one.kind == kind)
    for multiple, verdict in ((3.0, "effect"), (0.3, "none")):
        size = multiple * limit.value
        runs = [
            _pin_run(run, lambda v, size=size: torque(size, v), role, seed=50 + i + 10 * j)
            for j, role in enumerate(("fit", "test"))
            for i, run in enumerate(PIN_RUNS)
        ]
        said, named = _said(scenario, runs)
        assert said == verdict, multiple
        assert (kind in named) == (verdict == "effect")
