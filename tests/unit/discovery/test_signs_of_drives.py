"""A drive that brings energy in is told by what is wrong with it: its sign, or its scale."""

import numpy as np
import pytest

from stochfric_mb import InputError
from stochfric_mb.discovery.driven_joint.decision.signs import require_dissipation
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict

INERTIA, DAMPING, FRICTION, RATE = 0.8, 4.0, 6.0, 500.0
GAIN = 5.4
"""Torque over current of the motor [N m/A]."""


def asked(factor: float, angle: float = 1.0, turned: tuple[str, ...] = ()) -> None:
    """Ask whether friction takes energy out of a sine, with a torque that is ``factor`` times the right one, and an angle."""
    t = np.arange(round(12.0 * RATE)) / RATE
    q, v, a = -np.cos(2.0 * t), 2.0 * np.sin(2.0 * t), 4.0 * np.cos(2.0 * t)
    torque = INERTIA * a + DAMPING * v + FRICTION * np.sign(v)
    channels = {"position": angle * q, "torque": factor * torque}
    mechanism = {"kind": "hinge_pendulum", "mass": 1e-3, "length": 1e-3, "inertia": INERTIA, "damping": DAMPING}
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": mechanism | {"normal_force": FRICTION},
        "law": {"kind": "coulomb", "mu_s": 1.0, "mu_k": 1.0},
        "simulation": {"duration": 12.0, "output_step": 1.0e-3},
    }
    runs = tuple(
        Run(name=r, role=r, time=t, channels=channels, sample_interval=1.0 / RATE, turned=turned) for r in ("fit", "test")
    )
    dataset = Dataset(title="", scenario_path=None, scenario=any_scenario_from_dict(tables), runs=runs)
    require_dissipation(dataset, "", source_of(dataset).balances("", "fit", 0.0))


def test_a_right_drive_is_taken():
    asked(1.0)


def test_a_drive_that_is_turned_round_has_the_wrong_sign():
    with pytest.raises(InputError, match=r"give sign = \{ torque = -1 \}"):
        asked(-1.0)


def test_a_sign_that_is_wrong_because_it_was_turned_is_to_be_taken_out():
    with pytest.raises(InputError, match=r"is wrong; take out sign = \{ torque = -1 \}"):
        asked(-1.0, turned=("torque",))


def test_a_current_in_the_place_of_a_torque_has_the_wrong_scale():
    with pytest.raises(InputError, match=r"5.4 times the driving force .* give scale = \{ torque = 5.4 \}"):
        asked(1.0 / GAIN)


def test_where_both_signs_bring_in_energy_it_is_not_the_sign():
    """Degrees that are labelled rad: with the stated damping friction would drive, whatever the torque."""
    with pytest.raises(InputError, match=r"the sign is not what is wrong: columns may be swapped, a unit wrong") as caught:
        asked(-1.0, 180.0 / np.pi)
    assert "torque = -1" not in str(caught.value)
