"""The controllers of an MJCF model's joints: what they give, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import joint_loops
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import Run
from stochfric_mb.mechanisms import JointLoop, Mjcf, ProportionalDerivative
from stochfric_mb.mechanisms.mjcf_parts import Drive

MECHANISM = Mjcf(
    file=Path("arm.xml"),
    friction={"elbow": 1.0},
    positions={"elbow": "q"},
    drives={"elbow": Drive(columns=("u", "supply"), gain=2.0)},
)


def run(**constants):
    columns = {
        "q": np.zeros(3),
        "goal": np.array([1.0, 1.0, 9.0]),
        "u": np.ones(3),
        "supply": np.full(3, 12.0),
        "pulses": np.ones(3),
    }
    return Run(
        name="run 1",
        role="test",
        time=np.arange(3.0),
        channels={},
        covariates=columns,
        constants=constants,
        sample_interval=1.0,
    )


def loops(loop, mechanism=MECHANISM, **constants):
    return joint_loops(run(**constants), mechanism, ProportionalDerivative(joints={"elbow": loop}))


def test_what_it_gives_is_in_proportion_to_the_error_and_limited():
    loop = JointLoop(position_gain=3.0, velocity_gain=0.5, reference="goal", limit=10.0, factor="stiffness", added="pulses")
    own = loops(loop, stiffness=2.0)["elbow"]
    given = own.output(own.reference, np.zeros(3), np.ones(3))
    np.testing.assert_allclose(given, [2.0 * (3.0 - 0.5) + 1.0, 6.0, 10.0])
    assert own.output(own.reference[0], 0.0, 1.0, 0) == given[0]
    np.testing.assert_allclose(own.force, 24.0)  # of one unit of its output: gain times the supply
    np.testing.assert_allclose(own.recorded, 1.0)


def test_without_a_controller_there_are_none():
    assert joint_loops(run(), MECHANISM, None) == {}


def test_what_it_cannot_read_is_refused():
    with pytest.raises(InputError, match="has no constant 'stiffness'"):
        loops(JointLoop(position_gain=3.0, reference="goal", factor="stiffness"))
    with pytest.raises(InputError, match="did you mean 'goal'"):
        loops(JointLoop(position_gain=3.0, reference="gaol"))
    undriven = Mjcf(file=Path("arm.xml"), friction={"elbow": 1.0}, positions={"elbow": "q"}, drives={})
    with pytest.raises(InputError, match="'elbow' has no drive that a controller could give"):
        loops(JointLoop(position_gain=3.0, reference="goal"), undriven)
