"""Strengths whose intervals hold zero: which they are, and where the likelihood ratio ends them."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit
from stochfric_mb.discovery.stick_slip.validation.strength import NORMAL, decided_by_ratio, undecided
from stochfric_mb.effects import make_effect

WAVE = make_effect("harmonic_force", amplitude=0.3, frequency=2.0)
SPRING = make_effect("nonlinear_stiffness", cubic=1.0e8, quadratic=1.0e5)


def fit_of(names, values, deviations) -> Fit:
    free = [FreeParameter(owner, name, v, 1.0, -np.inf, np.inf) for (owner, name), v in zip(names, values, strict=True)]
    return Fit(None, free, np.array(values), np.array(deviations), 1.0)


def model_of(*effects):
    return Model(law=SimpleNamespace(), corrections={}, effects=effects)


def test_a_kind_is_undecided_where_none_of_its_strengths_is_told():
    names = [(LAW, "mu_s"), (0, "amplitude"), (0, "frequency"), (1, "cubic"), (1, "quadratic")]
    model = model_of(WAVE, SPRING)
    fit = fit_of(names, [0.8, 0.3, 2.0, 1e8, 1e5], [1.0, 3.0, 9.0, 1e9, 1e4])
    assert undecided(fit, model) == ["harmonic_force"]  # the spring's square is told
    fit = fit_of(names, [0.8, 0.3, 2.0, 1e8, 1e5], [1.0, 0.1, 9.0, 1e9, 1e6])
    assert undecided(fit, model) == ["nonlinear_stiffness"]


def test_an_interval_ends_where_fits_with_the_strength_held_are_worse():
    """Of a normal likelihood the signed root is straight: 10 at zero puts 1.96 at a fifth of the way."""
    fit = fit_of([(0, "amplitude"), (0, "frequency")], [0.3, 2.0], [3.0, 9.0])
    held = []

    def held_at(strength: float) -> float:
        held.append(strength)
        return 100.0 * (1.0 - strength / 0.3) ** 2

    cut = decided_by_ratio(fit, model_of(WAVE), "harmonic_force", 100.0, held_at)
    assert cut.deviations[0] == pytest.approx(0.03, rel=0.01)
    assert held[0] == pytest.approx(0.3 * (1.0 - 0.196), rel=0.1)
    assert cut.deviations[1] == 9.0


def test_an_interval_is_as_wide_as_others_can_make_up_for_the_strength():
    """A likelihood that is flat as far as other numbers reach, and steep beyond: zero is far off, half the strength is not."""
    fit = fit_of([(0, "amplitude"), (0, "frequency")], [0.3, 2.0], [3.0, 9.0])

    def held_at(strength: float) -> float:
        return 0.0 if strength > 0.12 else 900.0 * (1.0 - strength / 0.12)

    cut = decided_by_ratio(fit, model_of(WAVE), "harmonic_force", 900.0, held_at)
    assert cut.values[0] - NORMAL * cut.deviations[0] == pytest.approx(0.12, rel=0.02)


def test_the_ratio_says_nothing_of_each_of_two_strengths():
    """A spring's square and cube may make up for each other although both together are there."""
    fit = fit_of([(0, "cubic"), (0, "quadratic")], [1e8, 1e5], [1e9, 1e6])
    cut = decided_by_ratio(fit, model_of(SPRING), "nonlinear_stiffness", 100.0, lambda strength: np.nan)
    np.testing.assert_array_equal(cut.deviations, fit.deviations)
