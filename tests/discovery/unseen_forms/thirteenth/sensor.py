"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form(
    "sensor_drift",
    source="Bernoulli 1738 (a tank on the floor beside the gauge's stand runs out: a parabola, until it is empty)",
    rig="cork",
)
def drift_of_a_tank_that_runs_out(w: World, a: float) -> None:
    """The floor rises as the tank empties, within 45 cycles."""
    size, empty = 0.22 * a * w.nominal.slip_length, 45.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.maximum(1.0 - t / empty, 0.0) ** 2)


@form(
    "sensor_step",
    source="Omori 1894; Mogi 1962 (the stand's grouting cracks: more than half at once, and aftershocks)",
    rig="mill",
)
def step_with_aftershocks(w: World, a: float) -> None:
    """Eight small cracks follow within twelve cycles, ever more seldom; each run has times of its own."""
    size, first, last = 0.15 * a * w.nominal.slip_length, 0.3 * w.nominal.period, 12.0 * w.nominal.period
    begins = w.rng.uniform(0.25, 0.5) * w.duration
    after = first * np.expm1(np.sort(w.rng.uniform(0.0, 1.0, 8)) * np.log1p(last / first))
    small = w.rng.exponential(1.0, 8)
    times = begins + np.concatenate([[0.0], after])
    level = np.cumsum(np.concatenate([[0.0, 0.55], 0.45 * small / small.sum()]))
    w.sensor = lambda t, motion, rng: motion.position + size * level[np.searchsorted(times, t)]


@form("sensor_clipping", source="Froelich 1881 (a magnetic gauge whose core saturates: a hyperbola)", rig="seal")
def clipping_of_a_core(w: World, a: float) -> None:
    """True below; of the upper two fifths of a slip a fifth is shown."""
    if a <= 0.0:
        return
    most, begins = 0.1 * w.rig.slip_length, w.rig.reach - 0.4 * a * w.rig.slip_length

    def sensor(t, motion, rng):
        beyond = np.maximum(motion.position - begins, 0.0) / most
        return np.minimum(motion.position, begins) + most * beyond / (1.0 + beyond)

    w.sensor = sensor


@form("sensor_outliers", source="Landau 1944; Groom 2002 (muons that cross a line camera: a long tail above)", rig="fork")
def outliers_of_muons(w: World, a: float) -> None:
    """One sample of a hundred, always upwards; sizes as Moyal's approximation says."""
    size = 0.2 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        hit = rng.random(t.size) < 0.01
        left = -np.log(rng.standard_normal(t.size) ** 2)
        return motion.position + size * hit * np.maximum(1.0 + 0.25 * left, 0.0)

    w.sensor = sensor


@form("sensor_delay", source="Tukey 1977 (a logger that shows the running median of the last samples)", rig="beetle")
def delay_of_a_running_median(w: World, a: float) -> None:
    """Late by half of its length, and exactly so where nothing turns round."""
    velocity_too(w)

    def sensor(t, motion, rng):
        half = round(0.5 * a / w.nominal.pulsation / (t[1] - t[0]))
        padded = np.concatenate([np.full(2 * half, motion.position[0]), motion.position])
        return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=1)

    w.sensor = sensor
