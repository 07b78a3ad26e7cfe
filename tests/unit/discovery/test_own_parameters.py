"""Parameters of mechanism and law: which the data tell, which only their prior does, and which are off from what is stated."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb import load_scenario
from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM, FreeParameter
from stochfric_mb.discovery.result import Interval
from stochfric_mb.discovery.stick_slip.parameters import moved, not_measured, own_parameters
from stochfric_mb.discovery.stick_slip.simulation.deviations import _blind_to_scale, _with_priors
from stochfric_mb.discovery.stick_slip.simulation.refit import WIDEST, Fit
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
    fit = Fit(None, numbers, nothing, nothing, 0.0, data_share=np.array([0.9, 0.3, 0.1, 0.1]), posterior=nothing)
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


NAMES = (
    ("mu_s", LAW),
    ("mu_k", LAW),
    ("stiffness", MECHANISM),
    ("mass", MECHANISM),
    ("damping", MECHANISM),
    ("rise", 0),
    ("way", 0),
)
VALUES = np.array([0.6, 0.4, 0.02, -0.01, 0.1, 0.05, 3.0])
SCALES = np.array([0.012, 0.012, 0.05, 0.02, 0.3, 0.05, 3.0])
LARGER = np.array([0.6, 0.4, 1.02, 0.99, 1.1, 0.05, 0.0]) / SCALES
"""Where all forces are larger by a share [natural steps]: a coefficient of an effect goes along, a length does not."""


def motion(exact=0.0):
    """Slopes of a motion that knows nothing of that direction, but for differences that err by a share."""
    rng = np.random.default_rng(4)
    size = np.array([50.0, 20.0, 80.0, 5.0, 2.0, 30.0, 10.0])
    seen = size * rng.standard_normal((60, 7))
    blind = seen - np.outer(seen @ LARGER, size**2 * LARGER / (size**2 @ LARGER**2))
    each = zip(NAMES, VALUES, SCALES, strict=True)
    free = [FreeParameter(owner, name, value, scale, -9.0, 9.0) for (name, owner), value, scale in each]
    steps = SimpleNamespace(start=VALUES, scale=SCALES)
    misfit = SimpleNamespace(free=free, steps=steps, errors=lambda step: np.r_[blind @ step, np.zeros(7)])
    return blind, blind * (1.0 + exact * rng.standard_normal(blind.shape)), misfit


def test_no_motion_tells_the_scale_of_all_forces_however_slopes_err():
    exact, erring, misfit = motion(0.02)
    prior = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0])  # natural steps of the mechanism are its stated deviations
    told, blind = (SCALES * _with_priors(x, prior)[1] for x in (erring, _blind_to_scale(erring, misfit)))
    true = SCALES * _with_priors(exact, prior)[1]
    assert told[2] < 0.5 * true[2]  # errors of two hundredths of slopes told it twice as well as mass and stiffness are known
    assert blind == pytest.approx(true, rel=0.05)
    # friction is known as well as all forces are: by the better of what is stated, a mass to 2 %
    assert blind[0] / 0.6 == pytest.approx(true[2] / 1.02, rel=0.1)


def test_a_number_of_the_rig_that_is_exact_tells_it():
    _, erring, misfit = motion(0.02)
    misfit.free = [k for k in misfit.free if k.name != "damping"]
    assert np.array_equal(_blind_to_scale(np.delete(erring, 4, axis=1), misfit), np.delete(erring, 4, axis=1))


def test_what_its_own_interval_leaves_open_is_not_off():
    scenario = dataclasses.replace(load_scenario("kang2015_table1"), uncertainty={"stiffness": 0.02})
    dataset = Dataset(title="", scenario_path=None, scenario=scenario, runs=())
    stated = scenario.mechanism.stiffness
    wide = Interval(1.1 * stated, 0.95 * stated, 1.25 * stated, "N/m")
    assert moved({"stiffness": wide}, dataset, unmeasured=[]) == {}
    sure = Interval(1.1 * stated, 1.08 * stated, 1.12 * stated, "N/m")
    assert moved({"stiffness": sure}, dataset, unmeasured=[])["stiffness"] == pytest.approx(5.0)
