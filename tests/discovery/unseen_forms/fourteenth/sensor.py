"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Astrom and Hagglund 1995 (a stand whose temperature is regulated: it overshoots, and swings in)")
def drift_that_swings_in(w: World, a: float) -> None:
    """One swing in seventeen cycles; after fourteen of them 1/e is left of it."""
    size, tau, f = 0.2 * a * w.nominal.slip_length, 14.0 * w.nominal.period, 2 * np.pi / (17.0 * w.nominal.period)

    def response(t):
        return 1.0 - np.exp(-t / tau) * (np.cos(f * t) + np.sin(f * t) / (f * tau))

    w.sensor = lambda t, motion, rng: motion.position + size * response(t)


@form("sensor_step", source="Bickford 1995 (four bolts of the stand are tightened crosswise: there, back, there, back)")
def step_of_four_bolts(w: World, a: float) -> None:
    """A bolt a cycle or so, each moves the stand less than the one before; each run has times of its own."""
    size, begins = a * w.nominal.slip_length, w.rng.uniform(0.25, 0.55) * w.duration
    times = begins + 1.1 * w.nominal.period * np.arange(4)
    level = np.array([0.0, 0.22, 0.1, 0.18, 0.14])
    w.sensor = lambda t, motion, rng: motion.position + size * level[np.searchsorted(times, t)]


@form("sensor_clipping", source="Wallmark 1957 (a round spot of light that runs over the edge of its detector)")
def clipping_of_a_spot(w: World, a: float) -> None:
    """True as long as all of the spot is on the detector; the share that is on it counts, and level when it has left."""
    if a <= 0.0:
        return
    wide, begins = 0.35 * w.rig.slip_length, w.rig.reach - 0.5 * a * w.rig.slip_length
    u = np.linspace(0.0, 1.0, 501)
    z = 1.0 - 2.0 * u
    share = 1.0 - (np.arccos(z) - z * np.sqrt(1.0 - z * z)) / np.pi
    shown = np.concatenate([[0.0], np.cumsum(0.5 * (share[1:] + share[:-1])) / 500])

    def sensor(t, motion, rng):
        return np.minimum(motion.position, begins) + wide * np.interp((motion.position - begins) / wide, u, shown)

    w.sensor = sensor


@form(
    "sensor_outliers",
    source="Itoh 1982 (a phase that is unwrapped wrongly: a turn up or down, and now and then two)",
    rig="platen",
)
def outliers_of_whole_turns(w: World, a: float) -> None:
    """Eight samples of a thousand, either way; of these one in six is off by two turns."""
    turn = 0.22 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        turns = rng.choice([-1.0, 1.0], t.size) * np.where(rng.random(t.size) < 1 / 6, 2.0, 1.0)
        return motion.position + turn * turns * (rng.random(t.size) < 0.008)

    w.sensor = sensor


@form(
    "sensor_delay",
    source="Macaulay 1931 (a logger's mean of the last samples, whose weights fall straight to nothing)",
    rig="tap",
)
def delay_of_straight_weights(w: World, a: float) -> None:
    """The last sample counts most; late by a third of its length."""
    velocity_too(w)

    def sensor(t, motion, rng):
        length, h = 1.5 * a / w.nominal.pulsation, t[1] - t[0]
        weights = np.maximum(1.0 - np.arange(int(length / h) + 1) * h / max(length, h), 0.0)
        weights /= weights.sum()
        first = motion.position[0]
        return first + lfilter(weights, [1.0], motion.position - first)

    w.sensor = sensor
