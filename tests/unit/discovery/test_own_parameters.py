"""Parameters of mechanism and law: which the data tell, which only their prior does, and which are off from what is stated."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb import load_scenario
from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM, FreeParameter
from stochfric_mb.discovery.result import Interval
from stochfric_mb.discovery.stick_slip.parameters import moved, not_measured, own_parameters
from stochfric_mb.discovery.stick_slip.simulation.refit import WIDEST, Fit, _with_priors
from stochfric_mb.measurement.dataset import Dataset


@pytest.mark.parametrize(("slope", "prior"), [(1.0, 1.0), (3.0, 1.0), (0.0, 1.0), (2.0, 0.0), (10.0, 0.1)])
def test_one_number_is_told_by_data_and_prior_in_proportion(slope, prior):
    """Of one number the information adds up: slope^2 from the data, 1/prior^2 from the prior."""
    share, deviation = _with_priors(np.array([[slope]]), np.array([prior]))
    least = WIDEST**-2
    assert deviation[0] == pytest.approx((slope**2 + prior**2 + least) ** -0.5, rel=1e-12)
    assert share[0] == pytest.approx(1.0 - max(prior**2, least) / (slope**2 + prior**2 + least), rel=1e-9, abs=1e-12)


def test_two_numbers_of_which_only_the_sum_is_told_stay_as_believed():
    share, deviation = _with_priors(np.array([[50.0, 50.0]]), np.array([1.0, 1.0]))
    assert (share < 0.51).all()
    assert deviation == pytest.approx([0.5**0.5] * 2, rel=1e-2)  # half of each prior's variance is the sum's, which data decide


def test_only_what_the_prior_made_is_named():
    def free(name, owner, run=""):
        return FreeParameter(owner, name, 0.0, 1.0, -1.0, 1.0, run=run)

    numbers = [free("mu_s", LAW), free("damping", MECHANISM), free("amplitude", 0), free("mu_k", LAW, "run_1")]
    nothing = np.zeros(4)
    fit = Fit(None, numbers, nothing, nothing, nothing, 0.0, data_share=np.array([0.9, 0.3, 0.1, 0.1]), posterior=nothing)
    assert not_measured(fit) == ["damping"]


def test_an_interval_of_what_the_prior_made_is_no_wider_than_the_prior():
    """Where the model does not explain the runs, slopes say nothing of numbers that the data do not tell."""
    study = SimpleNamespace(dataset=Dataset(title="", scenario_path=None, scenario=load_scenario("kang2015_table1"), runs=()))
    model = SimpleNamespace(corrections={"mass": 0.004})
    numbers = [FreeParameter(MECHANISM, "mass", 0.0, 1.0, -1.0, 1.0)]
    fit = Fit(
        None,
        numbers,
        np.zeros(1),
        np.array([0.063]),
        np.zeros(1),
        0.0,
        data_share=np.array([0.08]),
        posterior=np.array([0.0096]),
    )
    mass = own_parameters(fit, model, study)["mass"]
    assert mass.value == pytest.approx(1.004 * 6.08)
    assert (mass.high - mass.low) / 2.0 == pytest.approx(1.96 * 0.0096 * 6.08, rel=1e-3)


def test_what_is_off_by_more_than_stated_is_pointed_out():
    scenario = dataclasses.replace(load_scenario("kang2015_table1"), uncertainty={"mass": 0.02, "damping": 0.2, "mu_s": 0.05})
    dataset = Dataset(title="", scenario_path=None, scenario=scenario, runs=())
    table = {
        "mass": Interval(3.164, 3.1, 3.2, "kg"),
        "damping": Interval(2.0, 1.9, 2.1, "N s/m"),
        "mu_s": Interval(0.82, 0.81, 0.83, "-"),
        "stiffness": Interval(9999.0, 9998.0, 9999.5, "N/m"),  # of which nothing is stated
    }
    off = moved(table, dataset, unmeasured=["damping"])
    assert set(off) == {"mass"}
    assert off["mass"] == pytest.approx((3.164 - 6.08) / (0.02 * 6.08), rel=1e-12)
