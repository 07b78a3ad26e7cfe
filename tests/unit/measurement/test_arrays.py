"""Runs made of arrays are checked as those of files are."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb import Dataset, InputError, Run, discover, load_any_scenario, load_scenario
from stochfric_mb.discovery.result import Interval, Result
from stochfric_mb.measurement.dataset import checked
from stochfric_mb.scenario import any_scenario_from_dict

RATE = 500.0
TIME = np.arange(3000) / RATE
ANGLE = 0.6 * np.sin(2.0 * TIME) + 0.2 * np.sin(5.0 * TIME)


def hinge():
    """Return the scenario of a hinge."""
    return any_scenario_from_dict(
        {
            "schema": "stochfric.scenario/1",
            "mechanism": {"kind": "hinge_pendulum", "mass": 1e-3, "length": 1e-3, "inertia": 0.05, "normal_force": 1.0},
            "law": {"kind": "coulomb", "mu_s": 1.5, "mu_k": 1.5},
            "simulation": {"duration": 6.0, "output_step": 2e-3},
        }
    )


def run(role="fit", **changes):
    """Return a run of a hinge that moves, or one that differs."""
    given = {"name": role, "role": role, "time": TIME, "channels": {"position": ANGLE}, "sample_interval": 1.0 / RATE}
    return Run(**(given | changes))


class Column:
    """What a column of pandas is: an array with an index that does not count from the end."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.values, dtype)


def test_lists_and_columns_become_arrays():
    made = run(time=list(TIME), channels={"position": Column(ANGLE)}, covariates={"humidity": [40] * TIME.size})
    assert made.time.dtype == np.float64
    np.testing.assert_array_equal(made.channels["position"], ANGLE)
    assert made.covariates["humidity"].dtype == np.float64
    assert dataclasses.replace(made, name="other").notes == ()


def test_a_covariate_with_missing_values_is_left_out_and_said():
    made = run(covariates={"humidity": np.where(TIME > 2.0, np.nan, 40.0)})
    assert not made.covariates
    assert dataclasses.replace(made, name="other").notes == ("covariate 'humidity' has missing values and is left out",)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"units": {"position": "deg"}}, r"units.position = 'deg'.* convert the array to m or rad, such as np.radians"),
        ({"role": "train"}, "role = 'train'; it is \"fit\""),
        ({"sample_interval": 2.0 / RATE}, r"sample_interval = 0.004 s, but time stamps are 0.002 s apart"),
        ({"sample_interval": 0.0}, r"sample_interval = 0 s; give the positive distance"),
        ({"time": TIME[::-1]}, r"run 'fit', sample 1: the time falls in 2999 of 3000 rows: .* turned round"),
        ({"time": TIME**1.1}, r"interpolate onto a uniform time"),
        ({"channels": {"position": ANGLE[1:]}}, r"position has 2999 samples but time has 3000"),
        ({"channels": {"position": ANGLE[:, None]}}, r"position has shape \(3000, 1\)"),
        ({"channels": {"position": ["a"] * 3000}}, r"position is not a column of numbers \(list\)"),
        ({"channels": {"position": np.where(TIME > 1.0, np.nan, ANGLE)}}, r"run 'fit', sample 501: position is missing or not"),
    ],
)
def test_a_run_that_is_none_is_refused(changes, said):
    with pytest.raises(InputError, match=said):
        run(**changes)


def test_a_temperature_in_kelvin_and_a_piece_of_a_run_are_as_in_files():
    made = run(channels={"temperature": 0.0 * TIME + 300.0}, units={"temperature": "K"})
    assert made.between(1.0, 2.0, name="piece", role="test").time.size == 500
    assert made.between(8.0, 9.0, name="none", role="test").time.size == 0


def test_both_roles_are_needed():
    data = Dataset(title="", scenario=hinge(), runs=(run(),))
    with pytest.raises(InputError, match=r"no run is held out \(fit: fit\)"):
        discover(data)
    with pytest.raises(InputError, match=r"no run to fit \(\)"):
        discover(dataclasses.replace(data, runs=()))


def test_samples_in_both_roles_are_said_once():
    data = checked(Dataset(title="", scenario=hinge(), runs=(run(), run("test"))))
    assert checked(data).runs[1].notes == data.runs[1].notes
    assert "3000 of its samples are in run 'fit'" in data.runs[1].notes[0]


def test_values_that_cannot_be_right_are_refused():
    dead = {"position": 0.0 * TIME + 2.0}
    with pytest.raises(InputError, match=r"run 'fit': position is 2 rad in all 3000 samples.*bring the arrays to SI units"):
        checked(Dataset(title="", scenario=hinge(), runs=(run(channels=dead), run("test"))))


def test_a_table_is_no_dataset():
    with pytest.raises(InputError, match=r'a dict is no dataset.*"Records in arrays"'):
        discover({"time": TIME})


def test_a_scenario_for_data_names_its_loader():
    assert load_any_scenario("two_joint_arm").mechanism.kind == "mjcf"
    with pytest.raises(InputError, match="in Python with load_any_scenario"):
        load_scenario("two_joint_arm")


def test_what_is_believed_is_an_attribute():
    numbers = {"mass": Interval(1.0, 0.9, 1.1, "kg")}
    assert Result.believed.fget(SimpleNamespace(parameters=numbers)) is numbers


def test_another_model_takes_the_place_of_a_datasets_own():
    """It was not looked at where the dataset was an object."""
    known = hinge()
    given = Dataset(title="", scenario=known, runs=(run(), run("test")))
    other = dataclasses.replace(known, mechanism=dataclasses.replace(known.mechanism, inertia=0.07))
    assert checked(given).scenario is known
    assert checked(given, scenario=other).scenario.mechanism.inertia == 0.07
    with pytest.raises(InputError):
        discover(given, scenario="no_such_scenario")


def test_runs_of_one_name_are_refused():
    """What is each run's own goes by its name."""
    with pytest.raises(InputError, match="2 runs have the name 'fit'"):
        checked(Dataset(title="", scenario=hinge(), runs=(run(), run("test", name="fit"))))
