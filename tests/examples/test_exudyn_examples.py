"""The Exudyn examples run, and what they show is right."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("exudyn", reason="exudyn is not installed")

EXAMPLES = Path(__file__).parents[2] / "examples"


def load(name):
    specification = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def squeal():
    return load("exudyn_brake_squeal")


@pytest.mark.parametrize("factor", [0.8, 1.05, 1.2])
def test_the_brake_squeals_above_the_critical_coefficient(squeal, factor):
    mu = factor * squeal.critical_coefficient()
    predicted, measured = squeal.predicted_growth(mu), squeal.growth(squeal.vibration(mu))
    assert (predicted > 1.0) is (factor > 1.0)
    # 1/s; a rate over ten periods at either end: beats of the two modes
    assert measured == pytest.approx(predicted, rel=0.1, abs=2.0)


def test_random_coefficients_make_a_quiet_brake_squeal(squeal):
    mu = 0.97 * squeal.critical_coefficient()
    quiet = squeal.growth(squeal.vibration(mu))
    random = [squeal.growth(squeal.vibration(mu, sigma=0.1 * mu, seed=seed)) for seed in (0, 1)]
    assert max(random) > quiet + 5.0
    assert random[0] != random[1]


def test_the_slider_crank_loses_what_friction_takes():
    crank = load("exudyn_slider_crank")
    start = crank.kinetic_energy(crank.build()[0])
    for seed in (0, 1):
        end, rows = crank.run(seed=seed, duration=0.2)
        work = sum(np.trapezoid(r[:, 3] * r[:, 2], r[:, 0]) for r in rows)
        assert work > 0.3 * start
        # samples at every step: second order; a first half step without friction would cost 2.5e-4
        assert start - end == pytest.approx(work, rel=5e-5)
        bearing = rows[0]  # turns one way, fast: mu_k N, but for what N and mu_k change in a step
        np.testing.assert_allclose(bearing[:, 3], -bearing[:, 5] * bearing[:, 7], rtol=0.05)


def test_the_examples_print_what_they_found(squeal, capsys):
    squeal.STEPS = 500
    squeal.main()
    assert "critical coefficient 0.333" in capsys.readouterr().out
    load("exudyn_slider_crank").main()
    assert "J left" in capsys.readouterr().out
