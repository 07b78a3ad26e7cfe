"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Fraden 2016, chapter 3 (a zero that runs away evenly)")
def drift_along_a_line(w: World, a: float) -> None:
    """A hundredth of a slip in each cycle."""
    rate = 0.01 * a * w.nominal.slip_length / w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + rate * t


@form("sensor_step", source="Page 1954 (a clamp of the sensor slips: one step, up or down, which stays)")
def step_of_a_slipped_clamp(w: World, a: float) -> None:
    """A sixth of a slip, at a time that each run draws from its middle half."""
    size = a * w.nominal.slip_length / 6.0 * float(w.rng.choice([-1.0, 1.0]))
    at = w.rng.uniform(0.25, 0.75) * w.duration
    w.sensor = lambda t, motion, rng: motion.position + size * (t >= at)


@form("sensor_clipping", source="Doebelin 2004 (a sensor whose range is too short: it stays at its upper end)")
def clipping_of_a_short_range(w: World, a: float) -> None:
    """True up to a quarter of a slip below break-away, and level from there on."""
    if a <= 0.0:
        return
    high = w.rig.reach - 0.25 * a * w.rig.slip_length
    w.sensor = lambda t, motion, rng: np.minimum(motion.position, high)


@form("sensor_outliers", source="Rousseeuw and Leroy 1987 (specks in a beam of light: a reading anywhere near, now and then)")
def outliers_of_specks(w: World, a: float) -> None:
    """One sample in a hundred is off by anything up to a third of a slip, either way."""
    most = a * w.nominal.slip_length / 3.0

    def sensor(t, motion, rng):
        hit = rng.random(t.size) < 0.01
        return motion.position + hit * rng.uniform(-most, most, t.size)

    w.sensor = sensor


@form(
    "sensor_delay", source="Astrom and Wittenmark 1997 (a converter that hands each value on late: a dead time)", rig="finger"
)
def delay_of_a_pipeline(w: World, a: float) -> None:
    """All is shown late by two fifths of the inverse natural angular frequency."""
    velocity_too(w)
    late = 0.4 * a / w.nominal.pulsation
    w.sensor = lambda t, motion, rng: np.interp(t - late, t, motion.position)
