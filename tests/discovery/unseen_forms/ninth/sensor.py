"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Fluke 1994, chapter 31 (a reference that warms up, and then ages: an exponential and a line)")
def drift_that_warms_and_ages(w: World, a: float) -> None:
    size, period = 0.1 * a * w.nominal.slip_length, w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.exp(-t / (4.0 * period)) + t / (30.0 * period))


@form("sensor_step", source="Horowitz and Hill 1989 (somebody turns the zero's knob: half a cosine over a part of a cycle)")
def step_by_hand(w: World, a: float) -> None:
    size, at, span = 0.11 * a * w.nominal.slip_length, 7.7 * w.nominal.period, 0.4 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + 0.5 * size * (1.0 - np.cos(np.pi * np.clip((t - at) / span, 0.0, 1.0)))


@form("sensor_clipping", source="Todd 1975 (a potentiometer whose wiper runs off its track onto the end contact)")
def clipping_on_the_end_contact(w: World, a: float) -> None:
    """What the contact shows is a little more than where the track ends."""
    if a <= 0.0:
        return
    end, more = w.rig.reach - 0.18 * a * w.rig.slip_length, 0.02 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: np.where(motion.position > end, end + more, motion.position)


@form("sensor_outliers", source="Dorsch, Hausler and Herrmann 1994 (a laser that sees a second reflection, always as far off)")
def outliers_of_a_reflection(w: World, a: float) -> None:
    """As many at any strength, as far off as it says."""
    off = 0.3 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: motion.position + off * (rng.random(t.size) < 0.004)


@form(
    "sensor_delay",
    source="Crochiere and Rabiner 1983 (a converter behind a filter that delays all tones alike)",
    rig="cylinder",
)
def delay_of_a_linear_phase(w: World, a: float) -> None:
    velocity_too(w)

    def sensor(t, motion, rng):
        n = round(0.5 * a / w.nominal.pulsation / (t[1] - t[0]))
        taps = np.hamming(2 * n + 3)[1:-1]
        start = motion.position[0]
        return start + lfilter(taps / taps.sum(), [1.0], motion.position - start)

    w.sensor = sensor
