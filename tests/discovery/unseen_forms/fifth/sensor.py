"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Crank 1956 (a mount that swells as moisture enters: the root of time)")
def drift_of_a_swelling_mount(w: World, a: float) -> None:
    size, span = 0.12 * a * w.nominal.slip_length, 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * np.sqrt(t / span)


@form("sensor_step", source="Findley, Lai and Onaran 1976 (a clamp that yields at once, and creeps on)")
def step_that_creeps_on(w: World, a: float) -> None:
    size, at, period = 0.1 * a * w.nominal.slip_length, 7.7 * w.nominal.period, w.nominal.period

    def sensor(t, motion, rng):
        since = np.maximum(t - at, 0.0) / period
        return motion.position - size * (t >= at) * (1.0 + 0.15 * np.log1p(since))

    w.sensor = sensor


@form("sensor_clipping", source="Webster 1999 (the lower end of the range, which moves up)", rig="valve")
def clipping_moves_up(w: World, a: float) -> None:
    if a <= 0.0:
        return
    low, slip, span = w.rig.reach - w.rig.slip_length, w.rig.slip_length, 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: np.maximum(
        motion.position, low + slip * (0.04 + 0.12 * a * (1.0 + 0.3 * np.minimum(t / span, 1.0)))
    )


@form("sensor_outliers", source="Horowitz and Hill 1989 (a multiplexer that has not settled: every 173rd sample)")
def outliers_of_a_multiplexer(w: World, a: float) -> None:
    size = 0.1 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: motion.position + size * rng.standard_normal(t.size) * (np.arange(t.size) % 173 == 31)


@form("sensor_delay", source="Hogenauer 1981 (three sliding sums in a converter)", rig="brake")
def delay_of_sliding_sums(w: World, a: float) -> None:
    velocity_too(w)

    def sensor(t, motion, rng):
        n = 1 + round(0.35 * a / w.nominal.pulsation / (t[1] - t[0]) / 1.5)
        x = motion.position
        for _ in range(3):
            total = np.cumsum(np.concatenate([[0.0], np.full(n - 1, x[0]), x]))
            x = (total[n:] - total[:-n]) / n
        return x

    w.sensor = sensor
