"""Delays that were put in are found, to a fraction of a sample; where there is none, none is."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stochfric_mb import InputError
from stochfric_mb.measurement import Term, estimate_delay
from stochfric_mb.measurement.assemble import RunEntry, assemble
from stochfric_mb.measurement.smoothing import smooth, window

from .files import measured

H = 1.0e-3


def tones(rng, n=25, highest=25.0):
    """Return a function of time: a sum of sines of random frequency [Hz], phase and size."""
    f, phase, size = rng.uniform(0.5, highest, n), rng.uniform(0.0, 2.0 * np.pi, n), rng.normal(size=n)
    return lambda t: np.sin(2.0 * np.pi * f * t[:, None] + phase) @ size


@pytest.mark.parametrize("samples", [-7.3, -0.25, 0.0, 0.5, 3.0, 12.7])
def test_delay_without_noise(samples):
    wave = tones(np.random.default_rng(4))
    t = np.arange(3000) * H
    delay = estimate_delay(wave(t), 0.7 * wave(t - samples * H), H)
    assert delay.seconds == pytest.approx(samples * H, abs=0.01 * H)  # parabola over a quarter of a sample
    assert delay.low <= delay.seconds <= delay.high
    assert delay.explained == pytest.approx(1.0, abs=1e-4)
    assert delay.explained_without <= delay.explained


def test_interval_holds_the_delay_as_often_as_it_says():
    rng = np.random.default_rng(8)
    t = np.arange(3000) * H
    held, away = 0, []
    for _ in range(40):
        wave, delay = tones(rng), rng.uniform(-8.0, 8.0) * H
        driver, response = wave(t), wave(t - delay)
        driver += 0.5 * driver.std() * rng.normal(size=t.size)
        response += 0.2 * response.std() * rng.normal(size=t.size)
        result = estimate_delay(driver, response, H, max_delay=0.015)
        held += result.low <= delay <= result.high
        away.append((result.seconds - delay) / (result.high - result.low))
    assert held >= 33  # of 40 at 95 %: fewer has probability 2e-3 at most
    assert np.mean(np.abs(away)) < 0.5


def pendulum(delay, noise, seed=5):
    """Return q, q' and the torque of a damped hinge pendulum (0.6 kg, 0.5 m); the torque is logged ``delay`` [s] early."""
    rng = np.random.default_rng(seed)
    wave = tones(rng, n=8, highest=2.5)
    inertia, damping, weight = 0.15, 0.15, 0.6 * 9.81 * 0.5

    def torque(t):
        return 0.8 * wave(np.atleast_1d(t))

    def rate(t, s):
        return [s[1], (torque(t)[0] - damping * s[1] - weight * np.sin(s[0])) / inertia]

    t = np.arange(4000) * 2.0 * H
    q, v = solve_ivp(rate, (0.0, t[-1] + 0.1), [0.1, 0.0], t_eval=t, rtol=1e-9, atol=1e-9).y
    return q + noise * rng.normal(size=t.size), v, torque(t + delay) + 0.5 * rng.normal(size=t.size)


@pytest.mark.parametrize("delay", [0.0, 0.0137])
def test_inverse_dynamics_of_a_pendulum(delay):
    q, _, torque = pendulum(delay, noise=1e-4)
    result = estimate_delay(torque, [Term(q, 2), Term(q, 1), Term(np.sin(q))], 2.0 * H, half_width=0.04)
    assert result.low <= delay <= result.high
    assert result.high - result.low < 0.01
    assert (result.low > 0.0) == (delay > 0.0)


@pytest.mark.parametrize("name", ["ddp", "direct_collocation"])
def test_real_pendulum(name):
    """The torque of these swing-ups leads the motion by 10 to 20 ms (DFKI torque-limited simple pendulum)."""
    units = {"time": "s", "position": "rad", "velocity": "rad/s", "torque": "N m"}
    run = assemble(RunEntry(file=measured(f"dfki_pendulum/{name}_measured.csv"), name=name, units=units), rotational=True)
    q, v = run.channels["position"], run.channels["velocity"]
    terms = [Term(q, 2), Term(q, 1), Term(np.sin(q)), Term(np.tanh(v / 0.1))]
    delay = estimate_delay(run.channels["torque"], terms, run.sample_interval, max_delay=0.05)
    assert 0.010 < delay.low < delay.seconds < delay.high < 0.025
    assert delay.explained > 0.95
    assert estimate_delay(v, [Term(q, 1)], run.sample_interval).seconds == pytest.approx(0.0, abs=run.sample_interval)


@pytest.mark.parametrize(
    ("driver", "response", "options", "message"),
    [
        (np.arange(999.0), np.arange(998.0), {}, r"term 0 has shape \(998,\) but the driver \(999,\)"),
        (np.ones(999), np.arange(999.0), {}, "driver is constant: it has no delay"),
        (np.arange(999.0), np.full(999, np.nan), {}, "term 0 is not finite everywhere"),
        (np.arange(300.0), np.arange(300.0), {}, r"300 samples are too few .* at least \d+ are needed"),
        (np.arange(999.0), np.arange(999.0), {"half_width": H}, "half_width = 0.001 s is out of range"),
        (np.arange(999.0), np.arange(999.0), {"max_delay": 0.0}, "max_delay = 0 s is out of range"),
    ],
)
def test_errors(driver, response, options, message):
    with pytest.raises(InputError, match=message):
        estimate_delay(driver, response, H, **options)


def test_delay_beyond_what_was_looked_for():
    t = np.arange(3000) * H
    with pytest.raises(InputError, match=r"not within max_delay = 0\.02 s: .*raise max_delay"):
        estimate_delay(np.sin(6.0 * t), np.sin(6.0 * (t - 0.05)), H, max_delay=0.02)


# --- the window ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shift", [0.0, 0.3 * H])
def test_window_is_one_over_its_length(shift):
    w = window(20 * H, H, shift=shift)
    assert w.sum() == pytest.approx(1.0, abs=1e-9)  # the window's six zeros at each end make the sum as good as the integral
    assert np.sum(w * (np.arange(w.size) - w.size // 2)) * H == pytest.approx(shift, abs=1e-9)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_derivative_of_a_polynomial(order):
    t = np.arange(400) * H
    exact = [t**2 + (20 * H) ** 2 / 15.0, 2.0 * t, np.full(t.size, 2.0)][order]  # the window's own second moment is w^2 / 15
    result = smooth(t**2, 20 * H, H, derivative=order)
    np.testing.assert_allclose(result[25:-25], exact[25:-25], rtol=1e-4, atol=1e-9)


@pytest.mark.parametrize("shift", [0.0, 2.0 * H, -7.4 * H])
def test_shift_between_samples(shift):
    t = np.arange(1000) * H
    result = smooth(np.sin(30.0 * t), 20 * H, H, shift=shift)
    factor = np.std(smooth(np.sin(30.0 * t), 20 * H, H)[50:-50]) / np.std(np.sin(30.0 * t)[50:-50])
    np.testing.assert_allclose(result[50:-50], factor * np.sin(30.0 * (t[50:-50] - shift)), atol=2e-4)


def test_window_longer_than_the_record():
    with pytest.raises(InputError, match="give a shorter half_width"):
        smooth(np.ones(20), 20 * H, H)
