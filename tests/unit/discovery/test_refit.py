"""Deviations of fitted numbers: what forecasts leave open, also where errors jump; and what fits go by."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.simulation import deviations, refit
from stochfric_mb.discovery.stick_slip.simulation.forecast import N_OUTPUTS, Windows
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
MODEL = Model(make_law("coulomb", mu_s=0.8, mu_k=0.5), {})
NOISE = 5e-6
GAIN = 1e-3
"""Change of a forecast with mu_s [m]."""
COUNT = 20
MOTION = np.linspace(0.0, 2.8e-3, N_OUTPUTS)
"""What the box moves in a forecast [m]."""


@pytest.fixture
def windows():
    record = make_record("run", np.arange(1000) * 1e-3, np.zeros(1000), BOX)
    noise = NOISE * np.random.default_rng(3).standard_normal((COUNT, N_OUTPUTS))
    return Windows(record, np.zeros((COUNT, 3)), MOTION + noise, 1, np.zeros(COUNT))


def fitted(monkeypatch, windows, shown):
    """The deviation of mu_s by a fit's own differences, and by wide ones; forecasts are ``shown`` of mu_s and mu_k."""

    def forecasts(model, asked):
        return np.full(asked.targets.shape, MOTION + shown(model.law.mu_s, model.law.mu_k))

    monkeypatch.setattr(refit, "forecasts", forecasts)
    fit = refit.refit(MODEL, [windows], {}, most=COUNT)
    wide = deviations.with_deviations(fit, [windows], {}, most=COUNT)
    return [dict(zip((k.name for k in f.free), f.deviations, strict=True)) for f in (fit, wide)]


def test_smooth_forecasts_leave_what_least_squares_leaves(monkeypatch, windows):
    fit, wide = fitted(monkeypatch, windows, lambda s, k: GAIN * (s - 0.8))
    assert wide["mu_s"] == pytest.approx(fit["mu_s"], rel=0.01)
    # a forecast counts as six independent numbers
    assert wide["mu_s"] == pytest.approx(NOISE / GAIN / np.sqrt(6 * COUNT), rel=0.1)


def test_a_number_that_errors_do_not_tell_is_left_open(monkeypatch, windows):
    _, wide = fitted(monkeypatch, windows, lambda s, k: GAIN * (s - 0.8))
    assert wide["mu_k"] > 0.25  # half of all that it may be


def test_where_errors_jump_the_interval_is_as_wide_as_the_step(monkeypatch, windows):
    """Forecasts that stay the same within 0.05: the fit's differences, of 0.00016, see nothing."""
    fit, wide = fitted(monkeypatch, windows, lambda s, k: GAIN * 0.05 * np.round((s - 0.8) / 0.05))
    assert fit["mu_s"] > 0.25  # against no friction at all
    assert 0.005 < wide["mu_s"] < 0.1


def test_a_cliff_beside_the_fit_is_no_precision(monkeypatch, windows):
    """Forecasts that jump by ten standard deviations of the noise, 0.0001 above where the fit ends."""
    fit, wide = fitted(monkeypatch, windows, lambda s, k: GAIN * 0.2 * (s - 0.8) + 10.0 * NOISE * (s > 0.8001))
    smooth = 5.0 * NOISE / GAIN / np.sqrt(6 * COUNT)
    assert fit["mu_s"] < 0.2 * smooth
    assert wide["mu_s"] == pytest.approx(smooth, rel=0.1)  # what the other side tells


def test_a_model_that_does_not_hang_on_the_start_is_no_better_for_that(monkeypatch, windows):
    start = 3.0e-6
    late = start * np.random.default_rng(5).standard_normal(COUNT)
    edge = 0.5 * MOTION[-1]

    def path(shift):
        here = MOTION + shift[:, None]
        return np.where(MOTION + 10.0 * shift[:, None] < edge, here, here - edge)  # a slip, sooner by what the start is off

    noise = NOISE * np.random.default_rng(6).standard_normal((COUNT, N_OUTPUTS))
    windows = dataclasses.replace(
        windows, starts=np.stack([np.zeros(COUNT), late, np.zeros(COUNT)], axis=1), targets=path(0.0 * late) + noise,
        uncertain=np.full(COUNT, start),
    )  # fmt: skip

    def forecasts(model, asked):
        return path(asked.starts[:, 1] if model.law.mu_k < 0.45 else 0.0 * late)

    monkeypatch.setattr(refit, "forecasts", forecasts)
    honest, clock = MODEL.with_law(0.8, 0.4), MODEL.with_law(0.8, 0.5)
    # chi^2 of one degree and less: with the starts as measured it is 200 and more
    assert max(refit.likelihood_ratios([clock, honest], [windows])) < 4.0
    monkeypatch.setattr(refit, "STARTS", np.zeros(1))
    assert refit.likelihood_ratios([clock, honest], [windows])[1] > 40.0


@pytest.mark.parametrize(("missing", "moved"), [(0.0, 2.0), (3.0e-4, 0.0)])
def test_what_is_stated_weighs_more_where_forecasts_miss_more(missing, moved, monkeypatch, windows):
    wave = np.sin(np.linspace(0.0, 40.0, N_OUTPUTS))
    drift = 1.0e-3 * np.linspace(-1.0, 1.0, N_OUTPUTS)
    windows = dataclasses.replace(windows, targets=windows.targets + missing * wave + 0.02 * drift)

    def forecasts(model, asked):
        return np.full(asked.targets.shape, MOTION + model.corrections.get("stiffness", 0.0) * drift)

    monkeypatch.setattr(refit, "forecasts", forecasts)
    fit = refit.refit(MODEL, [windows], {"stiffness": 0.01}, most=COUNT)
    # 2 % of stiffness, two stated deviations, are what the drift in the forecasts asks for
    assert fit.model.corrections["stiffness"] / 0.01 == pytest.approx(moved, abs=0.5)


def test_numbers_that_make_up_for_each_other_are_left_open_together(monkeypatch, windows):
    """Forecasts tell the sum of both coefficients, and, bent, next to nothing of their difference: no interval is narrower."""
    _, wide = fitted(monkeypatch, windows, lambda s, k: GAIN * (s + k - 1.26) * (1.0 + 3.0 * (s - k)))
    assert min(wide["mu_s"], wide["mu_k"]) > 20.0 * NOISE / GAIN / np.sqrt(6 * COUNT)
