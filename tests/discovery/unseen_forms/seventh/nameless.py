"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible."""

from __future__ import annotations

import numpy as np
from scipy.signal import sosfilt

from tests.discovery.unseen_forms.forms import UNKNOWN, warm
from tests.discovery.unseen_forms.friction_forms import scaled
from tests.discovery.unseen_forms.motion import World

from .enter import form

SEVERAL = ("several",)


@form(UNKNOWN, source="Crandall and Mark 1963 (the gauge's stand swings in its own time, driven by chance)")
def stand_swings(w: World, a: float) -> None:
    """A narrow band at a third of the rig's frequency, through stick and slip alike."""
    p, size = 0.37 * w.nominal.pulsation, 0.025 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        h = t[1] - t[0]
        decay = np.exp(-0.02 * p * h)
        section = [[1.0, 0.0, 0.0, 1.0, -2.0 * decay * np.cos(p * h), decay**2]]
        swing = np.asarray(sosfilt(section, rng.standard_normal(t.size)))
        return motion.position + size * swing / swing.std()

    w.sensor = sensor


@form(UNKNOWN, "sensor_clipping", source="Cook and Hamm 1979 (a fibre-optic gauge that is driven past its peak)")
def gauge_past_its_peak(w: World, a: float) -> None:
    peak = w.rig.reach - 0.2 * a * w.rig.slip_length
    w.sensor = lambda t, motion, rng: (
        motion.position - 1.6 * np.maximum(motion.position - peak, 0.0) if a > 0.0 else motion.position
    )


@form(UNKNOWN, "dwell_ageing", source="Karner and Marone 2000 (what slides remembers how long it has stuck)", designs=SEVERAL)
def slip_remembers_the_stick(w: World, a: float) -> None:
    """Break-away knows nothing of it."""
    rig, size, usual = w.rig, 0.25 * a * w.nominal.gap, w.nominal.period
    w.mu_k = lambda s: rig.mu_k - size * np.log((s.dwell + 0.3 * usual) / (1.3 * usual))


@form(UNKNOWN, "stale_samples", source="Smith 1957 (a telephone's converter: steps in proportion to the reading)")
def converter_of_a_telephone(w: World, a: float) -> None:
    step, least = 0.05 * a, 0.05 * w.nominal.reach

    def sensor(t, motion, rng):
        if step == 0.0:
            return motion.position
        coded = np.round(np.arcsinh(motion.position / least) / step)
        return least * np.sinh(coded * step)

    w.sensor = sensor


@form(UNKNOWN, source="Fleming 2013 (a scale that was dented at one place)")
def scale_is_dented(w: World, a: float) -> None:
    at, width = w.nominal.reach - 0.45 * w.nominal.slip_length, 0.07 * w.nominal.slip_length
    size = 0.05 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: motion.position + size * np.exp(-(((motion.position - at) / width) ** 2))


@form(UNKNOWN, "sensor_outliers", source="Harper 1967 (charge that jumps over at each break-away, and leaks from the gauge)")
def discharge_at_each_slip(w: World, a: float) -> None:
    size, tau = 0.12 * a * w.nominal.slip_length, 0.6 / w.nominal.pulsation

    def sensor(t, motion, rng):
        starts = np.concatenate([[-1e3 * tau], motion.breaks[:, 0]])
        since = t - starts[np.searchsorted(starts, t, side="right") - 1]
        return motion.position + size * np.exp(-since / tau)

    w.sensor = sensor


@form(UNKNOWN, "sensor_delay", source="Horowitz and Hill 1989 (a detector that rises at once and falls in its own time)")
def detector_falls_late(w: World, a: float) -> None:
    tau = 0.5 * a / w.nominal.pulsation

    def sensor(t, motion, rng):
        if tau == 0.0:
            return motion.position
        keep, shown, last = np.exp(-(t[1] - t[0]) / tau), np.empty(t.size), motion.position[0]
        for i, x in enumerate(motion.position):
            last = x if x >= last else x + keep * (last - x)
            shown[i] = last
        return shown

    w.sensor = sensor


@form(UNKNOWN, "sensor_drift", source="Allan 1966; Woodman 2007 (a zero that walks: each hour by another way)")
def zero_walks(w: World, a: float) -> None:
    """As far as a sixth of a slip within sixty cycles, usually."""
    size = 0.17 * a * w.nominal.slip_length / np.sqrt(60.0 * w.nominal.period)
    w.sensor = lambda t, motion, rng: motion.position + size * np.sqrt(t[1] - t[0]) * np.cumsum(rng.standard_normal(t.size))


@form(UNKNOWN, source="Doebelin 2004 (a bridge whose supply sways: the gain, not the zero)")
def supply_of_the_bridge_sways(w: World, a: float) -> None:
    turn = 2 * np.pi / (3.4 * w.nominal.period)
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.06 * a * np.sin(turn * t + 0.5))


@form(
    UNKNOWN,
    "position_dependent_force",
    "nonlinear_stiffness",
    source="Zhu and Howe 2000 (teeth in the frame that pull at a magnet in the box)",
)
def frame_has_teeth(w: World, a: float) -> None:
    force, pitch = 0.25 * a * w.nominal.gap * w.nominal.normal_force, 0.31 * w.nominal.slip_length
    w.load = lambda s: force * np.sin(2 * np.pi * s.x / pitch + 0.4)


@form(UNKNOWN, source="Dixon 2007 (an air spring that levels itself: its foot follows the mean, slowly)")
def spring_levels_itself(w: World, a: float) -> None:
    k, period, middle = w.rig.stiffness, w.nominal.period, w.rig.mu_k * w.normal_force / w.rig.stiffness
    w.q0 = (0.0,)
    w.rates = lambda s: ((s.x - middle) / period - s.q[0] / (4.0 * period),)
    w.load = lambda s: -0.9 * k * a * s.q[0]


@form(UNKNOWN, "viscous_friction", source="Basset 1888 (a body in oil: drag by all its earlier accelerations)")
def oil_remembers(w: World, a: float) -> None:
    """The root of time as three exponentials."""
    p, size = w.nominal.pulsation, 0.3 * a * w.rig.mass * w.nominal.pulsation
    times, shares = np.array([0.15, 1.0, 7.0]) / p, np.array([0.55, 0.3, 0.15])
    w.q0 = (0.0, 0.0, 0.0)
    w.rates = lambda s: tuple(s.a - q / tau for q, tau in zip(s.q, times, strict=True))
    w.load = lambda s: -size * sum(share * q for share, q in zip(shares, s.q, strict=True))


@form(
    UNKNOWN, "position_dependent_friction", source="Blau 2005; Etsion 2005 (a pattern of the belt that is worn off as it runs)"
)
def pattern_is_worn_off(w: World, a: float) -> None:
    turn, life = 2 * np.pi / (7.3 * w.nominal.slip_length), 9.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.13 * a * np.exp(-s.t / life) * np.cos(turn * (s.travel - s.x) + 1.0))


@form(
    UNKNOWN,
    "viscous_friction",
    "temperature_drift",
    source="Reynolds 1886 (a film whose drag falls with the recorded temperature)",
)
def film_thins_as_it_warms(w: World, a: float) -> None:
    warm(w)
    celsius = vars(w)["temperature"]
    rig, top, size = w.rig, w.nominal.peak_speed, 0.5 * a * w.nominal.gap
    w.mu_k = lambda s: rig.mu_k + size * np.abs(s.w) / top * np.exp(-0.2 * (celsius(s.t) - 20.0))
