"""Simulated in pieces, from the measured state, a joint remembers what the record has seen before each piece."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.simulation.scores import AHEAD
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict

pytest.importorskip("mujoco", reason="a joint is simulated in MuJoCo")

MASS, LOAD, MU_S, MU_K, DISTANCE = 2.0, 20.0, 0.3, 0.2, 0.05
REACH, PERIOD, RATE = 0.3, 4.0, 500.0
"""Half a stroke [m], two strokes [s], sample rate [Hz]: each stroke is simulated in four pieces."""
MODEL = f"""<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="j" type="slide" axis="1 0 0"/>
<inertial pos="0 0 0" mass="{MASS}" diaginertia="1 1 1"/></body></worldbody></mujoco>"""


def record(role: str) -> Run:
    """A sine, with the force that its inertia and a friction with memory need."""
    t = np.arange(round(12.0 * RATE)) / RATE
    angle = 2.0 * np.pi * t / PERIOD
    q, v, a = -REACH * np.cos(angle), np.sin(angle), REACH * (2.0 * np.pi / PERIOD) ** 2 * np.cos(angle)
    slip = np.abs(q + REACH * np.sign(v))
    friction = LOAD * (MU_K + (MU_S - MU_K) * np.exp(-slip / DISTANCE))
    noise = np.random.default_rng(1).standard_normal(t.size)
    channels = {"position": q + 1.0e-6 * noise, "force": MASS * a + friction * np.sign(v)}
    return Run(name=role, role=role, time=t, channels=channels, sample_interval=1.0 / RATE)


def moved(folder, *runs):
    """The joint and its runs, as they are seen."""
    (folder / "model.xml").write_text(MODEL)
    mechanism = {
        "kind": "mjcf", "file": "model.xml", "friction": {"j": LOAD}, "positions": {"j": "position"}, "drives": {"j": "force"},
    }  # fmt: skip
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism,
        "law": {"kind": "coulomb", "mu_s": MU_S, "mu_k": MU_K},
        "simulation": {"duration": 12.0, "output_step": 1.0e-3},
    }
    scenario = any_scenario_from_dict(tables, folder=folder)
    return source_of(Dataset(title="", scenario_path=None, scenario=scenario, runs=runs))


def test_a_lag_begins_at_the_reversal_and_not_where_a_piece_begins(tmp_path):
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward

    source = moved(tmp_path, record("fit"), record("test"))
    plain = JointModel(make_law("coulomb", mu_s=MU_S, mu_k=MU_K), (), {}, LOAD)
    with_memory = dataclasses.replace(plain, effects=(make_effect("frictional_lag", distance=DISTANCE),))
    seen = [forward(source, {"j": model}, 0.0) for model in (plain, with_memory)]
    without, right = (s.position for s in seen)
    assert seen[0].unit == "m"
    # a constant friction is 2 N low where a stroke begins, 1/2 of which lasts for the first piece; the right one errs by
    # what the velocity at the start of a piece is off
    assert without > 0.05 * (MU_S - MU_K) * LOAD / MASS * AHEAD**2 / 2.0
    assert right < 0.1 * without


def test_a_motion_without_bounds_leaves_no_log_in_the_working_folder(tmp_path, monkeypatch):
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward

    monkeypatch.chdir(tmp_path)
    run = record("test")
    far = dataclasses.replace(run, channels=run.channels | {"force": 1.0e12 * run.channels["force"]})  # beyond MuJoCo's 1e10
    source = moved(tmp_path, record("fit"), far)
    model = JointModel(make_law("coulomb", mu_s=MU_S, mu_k=MU_K), (), {}, LOAD)
    assert forward(source, {"j": model}, 0.0).position > 0.5 * REACH  # MuJoCo puts it back to where the model starts
    assert [p.name for p in tmp_path.iterdir()] == ["model.xml"]


def test_the_load_of_a_hinge_is_its_torque_in_forward_simulation_as_in_fits():
    """What viscous damping takes is part of what the joint transmits: taken off, the friction of a fit is 25 % too low here."""
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward
    from stochfric_mb.discovery.driven_joint.simulation.resimulation import JOINT, as_mjcf

    inertia, damping, constant, slope, rate = 0.5, 4.0, 2.0, 0.4, 500.0
    t = np.arange(round(8.0 * rate)) / rate
    angle = 2.0 * np.pi * 0.5 * t
    q, v, a = -0.4 * np.cos(angle), 0.4 * np.pi * np.sin(angle), 0.4 * np.pi**2 * np.cos(angle)
    needed, side = inertia * a + damping * v, np.sign(v)
    # F = needed + side (constant + slope |F|), of the same sign as the motion or not
    torque = np.where(
        needed * side + constant > 0.0,
        (needed + side * constant) / (1.0 - slope),
        (needed + side * constant) / (1.0 + slope),
    )
    channels = {"position": q, "torque": torque}
    runs = tuple(Run(name=r, role=r, time=t, channels=channels, sample_interval=1.0 / rate) for r in ("fit", "test"))
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": {
            "kind": "hinge_pendulum", "mass": 1.0e-3, "length": 1.0e-3, "inertia": inertia, "damping": damping,
            "normal_force": constant,
        },
        "law": {"kind": "coulomb", "mu_s": 1.0, "mu_k": 1.0},
        "simulation": {"duration": 8.0, "output_step": 1.0e-3},
    }  # fmt: skip
    dataset = Dataset(title="", scenario_path=None, scenario=any_scenario_from_dict(tables), runs=runs)
    plain = JointModel(make_law("coulomb", mu_s=1.0, mu_k=1.0), (), {}, constant)
    loaded = make_effect("load_dependence", exponent=1.0, reference_load=constant / slope)
    without, right = (
        forward(*as_mjcf(dataset, model), 0.0).position for model in (plain, dataclasses.replace(plain, effects=(loaded,)))
    )
    assert JOINT in as_mjcf(dataset, plain)[1]
    assert right < 0.05 * without


def test_a_joint_that_is_stated_to_stay_is_held(tmp_path):
    """A heavy arm hangs from a shoulder that a brake holds level: it would fall by 9.8 rad/s^2 or so."""
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward

    (tmp_path / "model.xml").write_text("""<mujoco><compiler autolimits="true"/><worldbody><body>
        <joint name="shoulder" type="hinge" axis="0 1 0"/><inertial pos="0.5 0 0" mass="5" diaginertia="0.1 0.1 0.1"/>
        <body pos="1 0 0"><joint name="wrist" type="hinge" axis="1 0 0"/>
        <inertial pos="0 0 0" mass="1" diaginertia="0.2 0.2 0.2"/></body></body></worldbody></mujoco>""")
    friction = 0.5
    t = np.arange(2000) / 500.0
    q, v, a = -np.cos(t * np.pi), np.pi * np.sin(t * np.pi), np.pi**2 * np.cos(t * np.pi)
    channels = {"position": q, "torque": 0.2 * a + friction * np.sign(v)}
    runs = tuple(Run(name=r, role=r, time=t, channels=channels, sample_interval=1.0 / 500.0) for r in ("fit", "test"))
    mechanism = {
        "kind": "mjcf", "file": "model.xml", "friction": {"wrist": friction}, "drives": {"wrist": "torque"},
        "positions": {"shoulder": 0.0, "wrist": "position"},
    }  # fmt: skip
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism,
        "law": {"kind": "coulomb", "mu_s": 1.0, "mu_k": 1.0},
        "simulation": {"duration": 4.0, "output_step": 1.0e-3},
    }
    scenario = any_scenario_from_dict(tables, folder=tmp_path)
    source = source_of(Dataset(title="", scenario_path=None, scenario=scenario, runs=runs))
    right = JointModel(make_law("coulomb", mu_s=1.0, mu_k=1.0), (), {}, friction)
    # over both joints; the wrist errs by what its velocity at the start of a piece is off
    seen = forward(source, {"wrist": right}, 0.0)
    assert seen.position < 0.01
    assert seen.unit == "rad"


@pytest.mark.parametrize(("unit", "load"), [("N m", 3.0), ("V", 3.0 - 2.0 * 0.5)])
def test_the_load_of_an_mjcf_joint_is_its_torque_and_of_a_voltage_less_the_back_emf(unit, load):
    from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import back_emf
    from stochfric_mb.mechanisms import Mjcf
    from stochfric_mb.mechanisms.mjcf_parts import Drive

    mechanism = Mjcf(
        file=None, friction={"j": 1.0}, positions={"j": "q"}, drives={"j": Drive(columns=("u",))}, damping={"j": 2.0}
    )
    run = Run(
        name="r", role="fit", time=np.zeros(1), channels={}, sample_interval=1.0, covariates={"u": np.full(1, 3.0)},
        units={"u": unit},
    )  # fmt: skip
    assert 3.0 - back_emf(run, mechanism, "j") * 0.5 == load
