"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Tan, Inoue and Lee 1991 (the gauge's stand settles into the ground: a hyperbola)")
def drift_of_a_settling_stand(w: World, a: float) -> None:
    """Half of it within fifteen cycles, and never all."""
    size, half = 0.25 * a * w.nominal.slip_length, 15.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * t / (t + half)


@form("sensor_step", source="Willsky and Jones 1976 (jumps at times that nobody knows: a small one, and a greater one later)")
def step_and_a_greater_one(w: World, a: float) -> None:
    """The same way both; each run has times of its own."""
    size, (first, second) = a * w.nominal.slip_length, w.rng.uniform([0.2, 0.45], [0.35, 0.65]) * w.duration
    w.sensor = lambda t, motion, rng: motion.position + size * (0.045 * (t >= first) + 0.085 * (t >= second))


@form("sensor_clipping", source="Rapp 1991 (an amplifier that saturates smoothly at both ends)")
def clipping_of_an_amplifier(w: World, a: float) -> None:
    """True to a few parts in a thousand about the middle of a slip, flat at its ends."""
    if a <= 0.0:
        return
    middle, most = w.rig.reach - 0.5 * w.rig.slip_length, (0.62 - 0.23 * a) * w.rig.slip_length

    def sensor(t, motion, rng):
        off = motion.position - middle
        return middle + off * (1.0 + (off / most) ** 8) ** -0.125

    w.sensor = sensor


@form("sensor_outliers", source="Paul 2006 (a dimmer beside the cable: a spike at each half wave of the mains, or none)")
def outliers_of_a_dimmer(w: World, a: float) -> None:
    """Two of three half waves have one, a sample long, to one side and the other in turn."""
    size = 0.45 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        x = motion.position.copy()
        at = np.arange(rng.uniform(0.0, 140.0), t.size - 1, 138.7)
        spikes = size * (1.0 + 0.3 * rng.standard_normal(at.size)) * (-1.0) ** np.arange(at.size)
        x[at.astype(int)] += spikes * (rng.random(at.size) < 2 / 3)
        return x

    w.sensor = sensor


@form("sensor_delay", source="Corke 1996 (a camera: the mean over its exposure, then the time to fetch it)", rig="damper")
def delay_of_a_camera(w: World, a: float) -> None:
    """Late by half of the exposure and all of the fetching."""
    velocity_too(w)
    if a <= 0.0:
        return
    exposure, fetching = 0.3 * a / w.nominal.pulsation, 0.3 * a / w.nominal.pulsation

    def sensor(t, motion, rng):
        area = np.concatenate([[0.0], np.cumsum(0.5 * (motion.position[1:] + motion.position[:-1]) * np.diff(t))])
        before = motion.position[0]

        def total(u):
            return np.interp(u, t, area) + before * np.minimum(u - t[0], 0.0)

        late = t - fetching
        return (total(late) - total(late - exposure)) / exposure

    w.sensor = sensor
