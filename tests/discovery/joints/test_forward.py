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


def test_a_lag_begins_at_the_reversal_and_not_where_a_piece_begins(tmp_path):
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward

    (tmp_path / "model.xml").write_text(MODEL)
    mechanism = {
        "kind": "mjcf", "file": "model.xml", "friction": {"j": LOAD}, "positions": {"j": "position"}, "drives": {"j": "force"},
    }  # fmt: skip
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism,
        "law": {"kind": "coulomb", "mu_s": MU_S, "mu_k": MU_K},
        "simulation": {"duration": 12.0, "output_step": 1.0e-3},
    }
    scenario = any_scenario_from_dict(tables, folder=tmp_path)
    source = source_of(Dataset(title="", scenario_path=None, scenario=scenario, runs=(record("fit"), record("test"))))
    plain = JointModel(make_law("coulomb", mu_s=MU_S, mu_k=MU_K), (), {}, LOAD)
    with_memory = dataclasses.replace(plain, effects=(make_effect("frictional_lag", distance=DISTANCE),))
    without, right = (forward(source, {"j": model}, 0.0).position for model in (plain, with_memory))
    # a constant friction is 2 N low where a stroke begins, 1/2 of which lasts for the first piece; the right one errs by
    # what the velocity at the start of a piece is off
    assert without > 0.05 * (MU_S - MU_K) * LOAD / MASS * AHEAD**2 / 2.0
    assert right < 0.1 * without
