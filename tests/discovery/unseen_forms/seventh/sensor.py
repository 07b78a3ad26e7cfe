"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import cheby1, sosfilt, sosfilt_zi

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Bryan 1990 (the sun reaches the stand: an S in time)")
def drift_of_a_sunny_stand(w: World, a: float) -> None:
    size, middle, width = 0.2 * a * w.nominal.slip_length, 11.0 * w.nominal.period, 5.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + 0.5 * size * (1.0 + np.tanh((t - middle) / width))


@form("sensor_step", source="Voight 1989 (a glued mount that creeps faster and faster, and gives way)")
def step_after_a_warning(w: World, a: float) -> None:
    size, at, period = 0.11 * a * w.nominal.slip_length, 9.2 * w.nominal.period, w.nominal.period

    def sensor(t, motion, rng):
        ahead = np.maximum(at - t, 0.0) / period
        return motion.position + size * np.where(t >= at, 1.0, 0.02 / (0.1 + ahead))

    w.sensor = sensor


@form("sensor_clipping", source="Sedra and Smith 2004 (a diode limiter: the logarithm beyond a level)")
def clipping_by_a_diode(w: World, a: float) -> None:
    if a <= 0.0:
        return
    level, soft = w.rig.reach - 0.16 * a * w.rig.slip_length, 0.01 * w.nominal.slip_length

    def sensor(t, motion, rng):
        over = np.maximum(motion.position - level, 0.0)
        return motion.position - over + soft * np.log1p(over / soft)

    w.sensor = sensor


@form("sensor_outliers", source="Gonzalez and Woods 2008 (salt and pepper: either end of the range)")
def outliers_of_salt_and_pepper(w: World, a: float) -> None:
    """As many at any strength, as far off as it says."""

    def sensor(t, motion, rng):
        hit, up = rng.random(t.size) < 0.003, rng.random(t.size) < 0.5
        ends = np.where(up, 1.3 * w.nominal.reach, -0.2 * w.nominal.reach)
        return motion.position + 0.5 * a * hit * (ends - motion.position)

    w.sensor = sensor


@form("sensor_delay", source="Chebyshev, in Oppenheim and Schafer 1989 (an anti-alias filter that ripples)", rig="isolator")
def delay_chebyshev(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        corner = 6.0 * w.nominal.pulsation / a  # delays by about 2.1/corner
        sections = cheby1(3, 0.5, corner, fs=2 * np.pi / (t[1] - t[0]), output="sos")
        return sosfilt(sections, motion.position, zi=sosfilt_zi(sections) * motion.position[0])[0]

    w.sensor = sensor
