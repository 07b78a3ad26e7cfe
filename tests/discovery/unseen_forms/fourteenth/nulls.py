"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, steady_noise
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

CATALOGUE = UNCERTAINTY | {"stiffness": 0.03, "damping": 0.4}
"""Relative standard deviations of a rig whose spring is as its catalogue says [-]."""
TILTED = UNCERTAINTY | {"mu_s": 0.015, "mu_k": 0.015}
"""Relative standard deviations of a rig whose friction was measured on a tilting table [-]."""
LIMITS = "JCGM 102:2011 (every believed number two standard deviations off)"


@form(NONE, source="Herceg 1976 (a transformer's linearity, as good as its data sheet says: less than the noise)", rig="wire")
def line_bends_within_the_noise(w: World, a: float) -> None:
    """An S along the range, by 0.8 of the noise to each side."""
    size, full = 0.8 * w.nominal.noise, 1.2 * w.nominal.reach
    w.sensor = lambda t, motion, rng: motion.position + size * np.sin(2 * np.pi * motion.position / full)


@form(NONE, source="Birch 1990 (a glass scale whose divisions are interpolated, to 0.7 of the noise)", rig="platen")
def scale_is_interpolated_well(w: World, a: float) -> None:
    """A sine of the place, sixteen times a slip, and half as much at twice that."""
    size, turn = 0.7 * w.nominal.noise, 2 * np.pi * 16.3 / w.nominal.slip_length

    def sensor(t, motion, rng):
        u = turn * motion.position
        return motion.position + size * (np.sin(u) + 0.5 * np.sin(2.0 * u + 0.9))

    w.sensor = sensor


@form(NONE, source="Poisson 1837; Schottky 1918 (few photons: what they count is uneven, and leans to one side)", rig="hair")
def noise_of_few_photons(w: World, a: float) -> None:
    """Counts of five on average, as loud as the white noise beside them."""

    def sensor(t, motion, rng):
        return motion.position + w.nominal.noise * (rng.poisson(5.0, t.size) - 5.0) / np.sqrt(5.0)

    w.sensor = sensor


@form(
    NONE,
    source="Gardner 1986 (an amplifier on a rippling supply: noise that swells and fades in time with the mains)",
    rig="tap",
)
def noise_in_time_with_the_mains(w: World, a: float) -> None:
    """Gone and as loud again as the white noise by turns, within 24 samples."""

    def sensor(t, motion, rng):
        loud = np.sqrt(2.0) * np.abs(np.sin(np.pi * (np.arange(t.size) / 23.7 + rng.random())))
        return motion.position + w.nominal.noise * loud * rng.standard_normal(t.size)

    w.sensor = sensor


@form(
    NONE, source="Buzinski, Levine and Stevenson 1992 (triangulation: noise that grows to both sides of the focus)", rig="strut"
)
def noise_out_of_focus(w: World, a: float) -> None:
    """As stated in the middle of a slip, and twice as loud at both of its ends."""
    middle, half = w.nominal.reach - 0.5 * w.nominal.slip_length, 0.5 * w.nominal.slip_length

    def sensor(t, motion, rng):
        more = np.sqrt(3.0) * np.minimum(np.abs(motion.position - middle) / half, 1.2)
        return motion.position + w.nominal.noise * more * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="IEEE 754 2008 (a file of numbers of two bytes: steps that double where the reading doubles)", rig="chair")
def numbers_of_two_bytes(w: World, a: float) -> None:
    """In millimetres; at break-away a step is 1.6 times the noise."""
    w.sensor = lambda t, motion, rng: 1.0e-3 * np.float16(1.0e3 * motion.position).astype(float)


@form(
    NONE,
    source="Figueroa 1995 (rounded twice: by the gauge to 4.5 times the noise, by the logger to steps of another size)",
    rig="chair",
    quantum=3.2,
)
def rounded_twice(w: World, a: float) -> None:
    """The two kinds of steps have no common one."""
    step = 4.5 * w.nominal.noise
    w.sensor = lambda t, motion, rng: step * np.round(motion.position / step)


@form(NONE, source="Vig 1992 (a quartz that is off by its tolerance: 30 millionths), at an odd rate", rig="strut", rate=1187.0)
def quartz_within_its_tolerance(w: World, a: float) -> None:
    """After sixty cycles a thousandth of a cycle is missing."""
    w.sensor = lambda t, motion, rng: np.interp(t * (1.0 - 3.0e-5), t, motion.position)


@form(NONE, source="Gambier 2004 (a program that polls its gauge: each reading is late by a chance of its own)", rig="wire")
def gauge_is_polled(w: World, a: float) -> None:
    """Anything up to a fourteenth of a sample; at the highest speed twice the noise at most."""
    most = 2.0 * w.nominal.noise / w.nominal.peak_speed
    w.sensor = lambda t, motion, rng: np.interp(t - most * rng.random(t.size), t, motion.position)


@form(
    NONE,
    source=f"{LIMITS}; Wahl 1963 (a spring that nobody has measured); a load cell beside, true and a little noisy",
    rig="hair",
    uncertainty=CATALOGUE,
    at_limits=True,
)
def limits_of_a_catalogue_spring(w: World, a: float) -> None:
    """The column of the load is 2 % off what is believed, as is stated."""
    w.columns["normal_force [N]"] = lambda t, motion: w.normal_force * (1.0 + 0.004 * w.rng.standard_normal(t.size))


@form(
    NONE,
    source=f"{LIMITS}; Erickson and Maksimovic 2001 (friction from a tilting table; three tones of a switched supply)",
    rig="tap",
    uncertainty=TILTED,
    at_limits=True,
)
def limits_after_a_tilting_table(w: World, a: float) -> None:
    """The tones stand at 7.3, 4.9 and 3.1 samples, and are 0.5 of the noise each."""

    def sensor(t, motion, rng):
        turns = np.arange(t.size)[:, None] / np.array([7.3, 4.9, 3.1]) + rng.random(3)
        return motion.position + 0.5 * w.nominal.noise * np.sin(2 * np.pi * turns).sum(1)

    w.sensor = sensor


@form(
    NONE,
    source=f"{LIMITS}; Uhlenbeck and Ornstein 1930 (declared); a hygrometer that matters to nobody",
    rig="platen",
    at_limits=True,
    declared="ornstein_uhlenbeck",
    declared_sigma=0.002,
)
def scatter_declared_at_the_limits(w: World, a: float) -> None:
    """What wanders does so as the scenario says, about numbers that are off as the scenario says."""
    rig, (z, y), turn = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2)), 17.0 * w.nominal.period
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.002 * z(s.t), lambda s: rig.mu_k + 0.002 * y(s.t)
    w.columns["humidity"] = lambda t, motion: np.round(44.0 + 3.0 * np.sin(2 * np.pi * t / turn + 1.0), 1)
