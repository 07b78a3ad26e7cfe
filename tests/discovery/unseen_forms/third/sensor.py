"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfilt, sosfilt_zi

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_clipping", source="Kester 2005 (an amplifier that recovers late from overload)")
def clipping_recovers_late(w: World, a: float) -> None:
    if a <= 0.0:
        return
    high, tau = w.nominal.reach - 0.15 * a * w.nominal.slip_length, 0.15 / w.nominal.pulsation

    def sensor(t, motion, rng):
        x = motion.position
        last = np.maximum.accumulate(np.where(x > high, np.arange(t.size), -t.size))
        late = np.exp(-(np.arange(t.size) - last) * (t[1] - t[0]) / tau)
        return np.minimum(x, high) * (1.0 - late) + high * late

    w.sensor = sensor


@form("sensor_clipping", source="Baxter 1997 (a range that ends in a second, flat slope)")
def clipping_in_a_second_slope(w: World, a: float) -> None:
    if a <= 0.0:
        return
    high = w.nominal.reach - 0.18 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: np.minimum(motion.position, high + 0.1 * (motion.position - high))


@form("sensor_drift", source="Wilson 2005, chapter 6 (a day's swing, of which a part is seen)")
def drift_of_a_day(w: World, a: float) -> None:
    size, turn = 0.05 * a * w.nominal.reach, 2 * np.pi / (110.0 * w.nominal.period)
    w.sensor = lambda t, motion, rng: motion.position + size * (np.sin(turn * t + 0.5) - np.sin(0.5))


@form("sensor_drift", source="Fleming 2013 (rises, and turns when the heating goes off)")
def drift_that_turns(w: World, a: float) -> None:
    size, period = 0.05 * a * w.nominal.reach, w.nominal.period
    w.sensor = lambda t, motion, rng: (
        motion.position + size * np.interp(t / period, [0.0, 16.0, 60.0, 120.0], [0.0, 1.0, 0.2, 0.0])
    )


@form("sensor_step", source="Basseville and Nikiforov 1993 (a mount that yields three times)")
def step_by_step(w: World, a: float) -> None:
    size, period = 0.025 * a * w.nominal.reach, w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * np.searchsorted([6.1, 15.4, 27.7], t / period)


@form("sensor_step", source="Hoffmann 1989 (a knock, of which a part relaxes)")
def step_that_relaxes(w: World, a: float) -> None:
    size, at, tau = 0.06 * a * w.nominal.reach, 9.2 * w.nominal.period, 5.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position - size * (t >= at) * (0.5 + 0.5 * np.exp(-np.maximum(t - at, 0.0) / tau))


@form("sensor_outliers", source="Kester 2005 (a converter that drops a bit)")
def outliers_of_a_bit(w: World, a: float) -> None:
    w.sensor = lambda t, motion, rng: motion.position - 0.12 * a * w.nominal.reach * (rng.random(t.size) < 0.003)


@form("sensor_outliers", source="Dorsch, Hausler and Herrmann 1994 (speckle, where the target moves fast)")
def outliers_in_fast_motion(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        hit = rng.random(t.size) < 0.06 * np.abs(motion.velocity) / w.nominal.peak_speed
        return motion.position + hit * 0.03 * a * w.nominal.reach * rng.rayleigh(1.0, t.size) * rng.choice([-1.0, 1.0], t.size)

    w.sensor = sensor


@form("sensor_delay", source="Smith 1997 (moving average in the logger)", rig="excited")
def delay_of_a_moving_average(w: World, a: float) -> None:
    velocity_too(w)

    def sensor(t, motion, rng):
        n = max(round(0.8 * a / w.nominal.pulsation / (t[1] - t[0])), 1)
        total = np.cumsum(np.concatenate([[0.0], np.full(n - 1, motion.position[0]), motion.position]))
        return (total[n:] - total[:-n]) / n

    w.sensor = sensor


@form("sensor_delay", source="Butterworth 1930 (an anti-alias filter of second order)", rig="paper")
def delay_butterworth(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        sections = butter(2, w.nominal.pulsation / (0.3 * a), fs=2 * np.pi / (t[1] - t[0]), output="sos")
        return sosfilt(sections, motion.position, zi=sosfilt_zi(sections) * motion.position[0])[0]

    w.sensor = sensor
