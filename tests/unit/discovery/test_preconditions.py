"""Runs that show no friction are refused before anything is computed."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.criteria import FEWEST_SAMPLES
from stochfric_mb.discovery.stick_slip.records.preconditions import require_driven, require_usable
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.study import record_of
from stochfric_mb.errors import InputError
from stochfric_mb.mechanisms import BeltBox

BOX = {"mass": 4.0, "damping": 0.8, "stiffness": 4.0 * (2.0 * np.pi * 5.0) ** 2, "normal_force": 13.0}
"""Natural frequency 5 Hz."""


def experiment(interval: float, belt: float) -> SimpleNamespace:
    run = SimpleNamespace(name="a", sample_interval=interval, mechanism=lambda _: BeltBox(**BOX, belt_velocity=belt))
    return SimpleNamespace(fit=(run,), test=(), scenario=None)


def test_as_many_samples_a_period_as_are_needed_will_do():
    require_usable(experiment(0.999 / (FEWEST_SAMPLES * 5.0), 2e-3))


@pytest.mark.parametrize(("interval", "belt", "said"), [(0.01, 2e-3, "200 Hz"), (1e-3, 0.0, "belt_velocity is 0")])
def test_coarse_samples_and_a_belt_at_rest_are_refused(interval, belt, said):
    with pytest.raises(InputError, match=said):
        require_usable(experiment(interval, belt))


def test_a_time_in_milliseconds_that_is_read_as_seconds_is_asked_for():
    with pytest.raises(InputError, match=r'units = \{ time = "ms" \}'):
        require_usable(experiment(1.0, 2e-3))


@pytest.mark.parametrize(
    ("onset", "kinetic", "remedy"),
    [
        (-8.0, -5.0, "same positive direction"),
        (8.0, -0.1, "same positive direction"),
        (470.0, 465.0, "36.2 times the normal force, with mu_s stated as 0.45; count the position from where the spring is"),
        (0.02 * 13.0, 0.01 * 13.0, "0.02 times the normal force, with mu_s stated as 0.45: correct normal_force"),
        (13.0 * 9.81 * 0.45, 40.0, "normal_force = 13 N is probably a mass in kg; write normal_force = 127.5"),
    ],
)
def test_friction_against_the_belt_and_a_zero_that_is_off_are_refused(onset, kinetic, remedy):
    record = SimpleNamespace(name="a", mechanism=BeltBox(**BOX, belt_velocity=2e-3))
    slips = SimpleNamespace(record=record, onset_force=np.full(20, onset), moments=np.full((20, 7), kinetic))
    with pytest.raises(InputError, match=remedy):
        require_driven([slips], 0.45)


def test_rubber_may_hold_more_than_its_load():
    record = SimpleNamespace(name="a", mechanism=BeltBox(**BOX, belt_velocity=2e-3))
    require_driven([SimpleNamespace(record=record, onset_force=np.full(20, 26.0), moments=np.full((20, 7), 20.0))], 0.45)


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ("force", r"a load cell on the spring of a belt_box shows k x: .* which is 1/k, .*name the column of force"),
        ("velocity", r"a velocity alone does not do.*integrate it from a rest"),
        ("temperature", r"such as a column 'position \[m\]'$"),
    ],
)
def test_what_a_record_without_a_position_may_have_instead(channel, said):
    with pytest.raises(InputError, match=said):
        record_of(SimpleNamespace(name="a", channels={channel: np.zeros(9)}), SimpleNamespace(scenario=None))


@pytest.mark.parametrize("rate", [200.0, 1000.0])
def test_corners_of_the_motion_are_no_outliers_however_coarse_the_samples(rate):
    box = BeltBox(**BOX, belt_velocity=2e-3)
    time = np.arange(0.0, 20.0, 1.0 / rate)
    # a stick phase of 0.9 s, and a slip of half a period back
    phase = time % 1.0
    position = np.where(phase < 0.9, 2e-3 * phase, 0.9e-3 * (1.0 + np.cos(np.pi * (phase - 0.9) / 0.1)))
    noisy = position + 5e-6 * np.random.default_rng(1).standard_normal(len(time))
    record = make_record("a", time, noisy, box)
    assert not record.outlier.any()
    spiked = noisy.copy()
    spiked[1234] += 1e-4
    assert np.flatnonzero(make_record("a", time, spiked, box).outlier).tolist() == [1234]
