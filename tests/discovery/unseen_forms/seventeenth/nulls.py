"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, each_stick, warm
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import DEFAULT_UNCERTAINTY

from .enter import form


@form(NONE, source="Langevin 1908 (an amplifier of little bandwidth: noise that remembers ten samples)", noise="coloured")
def noise_of_a_slow_amplifier(w: World, a: float) -> None:
    """All noise is of one pole."""


@form(NONE, source="Johnson 1925; Hooge 1969 (flicker noise of a potentiometer's track)", noise="pink")
def noise_that_flickers(w: World, a: float) -> None:
    """Power as one over the frequency, down to a thousandth of the rate."""


@form(NONE, source="Bennett 1948 (a converter of few bits, beside the usual noise)", quantum=2.7)
def converter_of_few_bits(w: World, a: float) -> None:
    """Steps of 2.7 times the noise."""


@form(NONE, source="Shinagawa, Akazawa and Wakimoto 1990 (aperture jitter, which nobody writes down)", jitter=0.02)
def clock_jitters(w: World, a: float) -> None:
    """Instants are off by a fiftieth of a sample."""


@form(
    NONE,
    source="Liu and Layland 1973 (a busy computer samples when it can, and says when it did)",
    jitter=0.08,
    stamped=True,
)
def computer_says_when_it_sampled(w: World, a: float) -> None:
    """Time stamps are uneven, and right."""


@form(NONE, source="JCGM 100:2008 (each number of the rig off by two of its standard uncertainties)", at_limits=1.0)
def numbers_two_uncertainties_off(w: World, a: float) -> None:
    """Each up or down by chance."""


@form(
    NONE,
    source="Taylor and Kuyatt 1994 (nobody has stated an uncertainty: numbers are off by twice the usual one)",
    at_limits=1.0,
    uncertainty=DEFAULT_UNCERTAINTY,
    unstated=True,
)
def nobody_stated_an_uncertainty(w: World, a: float) -> None:
    """What is usual is said on the page of discovery."""


@form(
    NONE,
    source="Kang, Choi and Yoo 2015 (a declared scatter, anew at each stick)",
    declared="per_event",
    declared_sigma=0.003,
)
def scatter_as_declared(w: World, a: float) -> None:
    """Each contact has a pair of coefficients of its own."""
    rig, now = w.rig, {}
    each_stick(w, lambda s: now.update(zip("sk", 0.003 * w.rng.standard_normal(2), strict=True)))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + now["s"], lambda s: rig.mu_k + now["k"]


@form(NONE, source="Morrison 1967 (hum from the mains and its third harmonic, both below the noise)")
def hum_below_the_noise(w: World, a: float) -> None:
    """A third of the noise at 23.6 samples, and a fifth at a third of that."""

    def sensor(t, motion, rng):
        turns = 2 * np.pi * (np.arange(t.size) / 23.6 + rng.random())
        return motion.position + w.nominal.noise * (np.sin(turns) / 3.0 + np.sin(3.0 * turns) / 5.0)

    w.sensor = sensor


@form(NONE, source="Tanenbaum 1981 (datagrams: a few are lost on the way, and once a stretch of them)", missing=0.01)
def samples_lost_on_the_way(w: World, a: float) -> None:
    """One in a hundred, and a pause in the middle."""


@form(NONE, source="Merritt 1942 (gears of a good grade: the belt runs as evenly as the noise can tell)")
def belt_as_even_as_its_gears(w: World, a: float) -> None:
    """Thirteen waves in three cycles, which shift the belt by 0.6 of the noise."""
    v, size, turn = w.belt_velocity, 0.6 * w.nominal.noise, 2 * np.pi * 13.0 / (3.0 * w.nominal.period)
    w.travel = lambda t: v * t + size * np.sin(turn * t)
    w.belt = lambda t: v + size * turn * np.cos(turn * t)
    w.belt_acceleration = lambda t: -size * turn**2 * np.sin(turn * t)


@form(NONE, source="Slocum 1992 (a frame of invar on a warm day: it grows by less than the noise, and so does nothing else)")
def frame_on_a_warm_day(w: World, a: float) -> None:
    """A temperature is recorded, and ten kelvins are 0.5 of the noise."""
    warm(w)
    per_kelvin = 0.05 * w.nominal.noise
    w.sensor = lambda t, motion, rng: motion.position + per_kelvin * (w.temperature(t) - 20.0)
