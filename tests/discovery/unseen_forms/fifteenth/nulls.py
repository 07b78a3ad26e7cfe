"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import NONE, steady_noise
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

WEIGHED = UNCERTAINTY | {"mass": 0.02, "normal_force": 0.005}
"""Relative standard deviations of a rig whose parts were weighed on a spring balance, and whose load is a weight [-]."""
LIMITS = "JCGM 104:2009 (every believed number two standard deviations off)"


@form(
    NONE, source="Granger and Joyeux 1980; Hosking 1981 (noise that is differenced by a fraction: a long memory)", rig="fader"
)
def noise_of_long_memory(w: World, a: float) -> None:
    """Of the order 0.3, beside the white noise and 0.6 as loud."""

    def sensor(t, motion, rng):
        n = np.arange(1, 2000)
        weights = np.cumprod(np.append(1.0, (n - 0.7) / n))
        memory = lfilter(weights, [1.0], rng.standard_normal(t.size + 2000))[2000:] / np.sqrt(np.sum(weights**2))
        return motion.position + 0.6 * w.nominal.noise * memory

    w.sensor = sensor


@form(
    NONE,
    source="Middleton 1977 (noise that people make: little for most of the time, and much for a twelfth of it)",
    rig="wedge",
)
def noise_that_people_make(w: World, a: float) -> None:
    """A third of the stated one, and then twice as much as that; each sample by its own chance."""

    def sensor(t, motion, rng):
        loud = np.where(rng.random(t.size) < 1.0 / 12.0, 2.0, 1.0 / 3.0)
        return motion.position + w.nominal.noise * loud * rng.standard_normal(t.size)

    w.sensor = sensor


@form(
    NONE, source="Kurosawa and others 2001 (converters in turn, of which every fourth one is worn: it is noisier)", rig="points"
)
def every_fourth_converter_is_noisier(w: World, a: float) -> None:
    """Twice the noise in one sample of four; gains and zeros are alike."""

    def sensor(t, motion, rng):
        worn = np.arange(t.size) % 4 == rng.integers(4)
        return motion.position + np.sqrt(3.0) * w.nominal.noise * worn * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="Enz and Temes 1996 (a chopped amplifier, whose ripple is as its data sheet says)", rig="organ")
def chopper_leaves_a_ripple(w: World, a: float) -> None:
    """A triangle of 9.4 samples, by 0.9 of the noise to each side."""

    def sensor(t, motion, rng):
        turns = np.arange(t.size) / 9.4 + rng.random()
        return motion.position + 0.9 * w.nominal.noise * (4.0 * np.abs(np.mod(turns, 1.0) - 0.5) - 1.0)

    w.sensor = sensor


@form(NONE, source="Helmholtz 1863 (two fans of nearly one speed: their hum beats)", rig="sash")
def hum_of_two_fans_beats(w: World, a: float) -> None:
    """Tones of 5.3 and 5.4 samples, 0.6 of the noise each: together loud and still within 286 samples."""

    def sensor(t, motion, rng):
        turns = np.arange(t.size)[:, None] / np.array([5.3, 5.4]) + rng.random(2)
        return motion.position + 0.6 * w.nominal.noise * np.sin(2 * np.pi * turns).sum(1)

    w.sensor = sensor


@form(
    NONE,
    source="Kester 2005 (an encoder's counter with hysteresis: it turns round a quarter of a step late)",
    rig="organ",
)
def counter_turns_round_late(w: World, a: float) -> None:
    """Steps of twice the noise; readings are cut to steps after they have been through a play of half a step."""
    step = 2.0 * w.nominal.noise

    def sensor(t, motion, rng):
        shown, last = np.empty(t.size), motion.position[0]
        for i, x in enumerate(motion.position):
            last = min(max(last, x - 0.25 * step), x + 0.25 * step)
            shown[i] = last
        return step * np.round(shown / step)

    w.sensor = sensor


@form(
    NONE,
    source="ISO/IEC 17025 2017 (a gauge that was calibrated, and is as good as its certificate: four parts in ten thousand)",
    rig="wedge",
)
def gain_within_its_certificate(w: World, a: float) -> None:
    """Too much or too little, by chance; at break-away two thirds of the noise."""
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 4.0e-4 * (-1.0) ** int(1.0e9 * w.rig.mu_s))  # one gauge for all


@form(
    NONE,
    source="Gardner 2005 (an integrating converter: each reading is the mean over its whole interval, stamped amid it)",
    rig="girder",
)
def readings_are_means_over_their_interval(w: World, a: float) -> None:
    """An eighth of the noise too flat where a slip bends most."""

    def sensor(t, motion, rng):
        x = motion.position
        return x + np.diff(np.pad(x, 1, "edge"), 2) / 24.0  # the bend that a mean over an interval sees

    w.sensor = sensor


@form(
    NONE,
    source="Stewart and Arora 2003 (a computer that is busy now and then: a spell of readings is late)",
    rig="sash",
)
def readings_are_late_in_spells(w: World, a: float) -> None:
    """By what is twice the noise at the highest speed, at most; a spell lasts a dozen samples, and there are two a cycle."""
    most, apart = 2.0 * w.nominal.noise / w.nominal.peak_speed, 0.5 * w.nominal.period * w.nominal.rate

    def sensor(t, motion, rng):
        busy = np.zeros(t.size)
        busy[rng.random(t.size) < 1.0 / apart] = 1.0
        late = np.minimum(np.convolve(busy, np.linspace(1.0, 0.0, 12))[: t.size], 1.0)
        return motion.position - most * late * motion.velocity

    w.sensor = sensor


@form(
    NONE,
    source=f"{LIMITS}; Dietz and others 2020 (parts that were weighed on a spring balance, a load that is a weight)",
    rig="fader",
    uncertainty=WEIGHED,
    at_limits=True,
    quantum=2.0,
)
def limits_after_a_spring_balance(w: World, a: float) -> None:
    """The mass is four hundredths off, and steps of the reading are twice the noise."""


@form(
    NONE,
    source=f"{LIMITS}; Gilbert 1960 (one sample of twenty-two is lost, and two cycles); begun amid a ride; a thermometer",
    rig="points",
    at_limits=True,
    missing=0.045,
    gap=2.0,
    amid=4.0,
)
def limits_and_a_logger_that_is_late(w: World, a: float) -> None:
    """The room cools by a degree, which matters to nobody."""
    w.columns["temperature [degC]"] = lambda t, motion: np.round(
        22.4 - t / w.duration + 0.05 * w.rng.standard_normal(t.size), 2
    )


@form(
    NONE,
    source="Uhlenbeck and Ornstein 1930 (declared); numbers off by one and a half deviations; JCGM 106:2012",
    rig="girder",
    at_limits=0.75,
    declared="ornstein_uhlenbeck",
    declared_sigma=0.0012,
    noise="coloured",
)
def scatter_declared_and_coloured_noise(w: World, a: float) -> None:
    """What wanders does so as the scenario says, and noise of neighbours is alike."""
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.0012 * z(s.t), lambda s: rig.mu_k + 0.0012 * y(s.t)
