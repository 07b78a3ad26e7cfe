"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Slocum 1992 (a gauge's casing warms fast one way, its base slowly the other)")
def drift_of_casing_and_base(w: World, a: float) -> None:
    """Up within five cycles, back where it began after sixteen, and more than twice as far below in the end."""
    size, fast, slow = 0.25 * a * w.nominal.slip_length, 3.5 * w.nominal.period, 22.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.9 * np.expm1(-t / slow) - np.expm1(-t / fast))


@form(
    "sensor_step", source="Peck and Obetz 1953 (somebody crosses an interferometer's beam three times: whole fringes are lost)"
)
def step_of_lost_fringes(w: World, a: float) -> None:
    """Three fringes down, one up, and two down; each run has times of its own."""
    fringe = 0.05 * a * w.nominal.slip_length
    times = w.rng.uniform([0.15, 0.4, 0.65], [0.35, 0.6, 0.8]) * w.duration
    level = np.array([0.0, -3.0, -2.0, -4.0])
    w.sensor = lambda t, motion, rng: motion.position + fringe * level[np.searchsorted(times, t)]


@form("sensor_clipping", source="Merritt 1967, chapter 6 (an air gauge: one less the inverse of 1 + the square of its gap)")
def clipping_of_an_air_gauge(w: World, a: float) -> None:
    """True below; of the upper part of a slip ever less is shown, from the nozzle's steepest point on."""
    if a <= 0.0:
        return
    most, begins = 0.2 * w.rig.slip_length, w.rig.reach - 0.45 * a * w.rig.slip_length
    steepest = 1.0 / np.sqrt(3.0)

    def pressure(u):
        return u * u / (1.0 + u * u)

    def sensor(t, motion, rng):
        beyond = np.maximum(motion.position - begins, 0.0) / most
        shown = (pressure(steepest + beyond) - 0.25) / (0.375 * np.sqrt(3.0))
        return np.minimum(motion.position, begins) + most * shown

    w.sensor = sensor


@form(
    "sensor_outliers",
    source="Portmann and Meng 1996 (a flash converter's sparkle codes: any bit of the word turns over)",
    rig="wedge",
)
def outliers_of_sparkle_codes(w: World, a: float) -> None:
    """One sample of a hundred, either way; six bits, each as likely, of half the weight of the one before."""
    size = 0.5 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        bit = rng.choice([-1.0, 1.0], t.size) * 0.5 ** rng.integers(0, 6, t.size)
        return motion.position + size * bit * (rng.random(t.size) < 0.01)

    w.sensor = sensor


@form("sensor_delay", source="Isermann 1989 (a slow device: straight from the reading before to the last one)", rig="organ")
def delay_of_a_slow_device(w: World, a: float) -> None:
    """It reads every few samples, and what lies between is only known, and drawn, when the next reading is there."""
    velocity_too(w)

    def sensor(t, motion, rng):
        n = max(round(0.5 * a / w.nominal.pulsation / (t[1] - t[0])), 0)
        read = slice(None, None, max(n, 1))
        return np.interp(np.maximum(t - n * (t[1] - t[0]), t[0]), t[read], motion.position[read])

    w.sensor = sensor
