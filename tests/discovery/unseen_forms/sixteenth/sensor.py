"""Effects of the position sensor that have a name, in shapes that laboratories meet."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Fraden 2016, chapter 3 (a zero that moves at an even rate)")
def drift_straight(w: World, a: float) -> None:
    """A straight line, 0.4 of a slip in sixty cycles."""
    rate = 0.4 * a * w.nominal.slip_length / (60.0 * w.nominal.period)
    w.sensor = lambda t, motion, rng: motion.position + rate * t


@form("sensor_step", source="Basseville and Nikiforov 1993 (a change of the mean: somebody knocks against the stand)")
def step_of_a_knock(w: World, a: float) -> None:
    """One jump by 0.16 of a slip, up or down, between a third and two thirds of the run."""
    size = 0.16 * a * w.nominal.slip_length * w.rng.choice([-1.0, 1.0])
    time = w.rng.uniform(1 / 3, 2 / 3) * w.duration
    w.sensor = lambda t, motion, rng: motion.position + size * (t >= time)


@form("sensor_clipping", source="Bentley 2005 (a converter at the end of its range)")
def clipping_of_a_converter(w: World, a: float) -> None:
    """True up to 0.3 of a slip below the highest position, and level from there on."""
    if a > 0.0:
        high = w.rig.reach - 0.3 * a * w.rig.slip_length
        w.sensor = lambda t, motion, rng: np.minimum(motion.position, high)


@form("sensor_outliers", source="Tukey 1960 (a contaminated normal)", rig="wedge")
def outliers_of_tukey(w: World, a: float) -> None:
    """One sample in a hundred, each for itself, is off by a normal error of 0.3 of a slip."""
    size = 0.3 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        return motion.position + size * rng.standard_normal(t.size) * (rng.random(t.size) < 0.01)

    w.sensor = sensor


@form("sensor_delay", source="Nilsson, Bernhardsson and Wittenmark 1998 (an even delay of a bus with a schedule)")
def delay_of_a_bus(w: World, a: float) -> None:
    """The reading of a twentieth of a natural period ago."""
    velocity_too(w)
    delay = 0.05 * a * 2 * np.pi / w.nominal.pulsation
    if a > 0.0:
        w.sensor = lambda t, motion, rng: CubicSpline(t, motion.position)(np.maximum(t - delay, t[0]))
