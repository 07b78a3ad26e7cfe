"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"


@form(NONE, source="the runner of a piezo stage", rig="stage")
def plain_stage(w: World, a: float) -> None:
    """Nothing at all."""


@form(NONE, source="Keshner 1982 (1/f noise, a third louder)", rig="webbing", noise="pink", loudness=1.3)
def noise_pink(w: World, a: float) -> None:
    """Noise without a corner, as of cheap amplifiers."""


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by 0.6 of the noise, over five cycles)", rig="stern")
def zero_wanders(w: World, a: float) -> None:
    """Less than the noise of one reading."""

    def sensor(t, motion, rng):
        return motion.position + 0.6 * w.nominal.noise * steady_noise(rng, w.duration, 5.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of five and a half times the noise)", rig="syringe", quantum=5.5)
def quantised(w: World, a: float) -> None:
    """Coarse, though far finer than a slip."""


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="telescope", jitter=0.024)
def clock_jitters(w: World, a: float) -> None:
    """Stamps are even."""


@form(NONE, source=LIMITS, rig="clutch", at_limits=True)
def limits_clutch(w: World, a: float) -> None:
    """As far off as is stated, each up or down by chance."""


@form(
    NONE,
    source=f"{LIMITS}; noise of neighbours is alike (Box and Jenkins 1970)",
    rig="syringe",
    at_limits=True,
    noise="coloured",
)
def limits_syringe(w: World, a: float) -> None:
    """The same, and noise of first order."""


@form(
    NONE,
    source="JCGM 100:2008; Horowitz and Hill 1989 (numbers off by one and a half deviations, and a hum)",
    rig="stern",
    at_limits=0.75,
    noise="hum",
)
def limits_and_a_hum(w: World, a: float) -> None:
    """The hum has half the power of the noise."""


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="clutch",
    declared="per_event",
    declared_sigma=0.006,
)
def scatter_declared(w: World, a: float) -> None:
    """What scatters is what the scenario says."""
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.006 * z[0], rig.mu_k + 0.006 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="webbing", declared="ornstein_uhlenbeck", declared_sigma=0.007)
def scatter_declared_correlated(w: World, a: float) -> None:
    """What wanders does so as the scenario says."""
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.007 * z(s.t), lambda s: rig.mu_k + 0.007 * y(s.t)


@form(
    NONE,
    source="Little and Rubin 1987 (one sample of twenty-five, a pause of two cycles); a thermometer that matters to nobody",
    rig="stage",
    missing=0.04,
    gap=2.0,
)
def samples_dropped(w: World, a: float) -> None:
    """A second column is recorded that nothing depends on."""
    period = w.nominal.period
    w.columns["temperature [degC]"] = lambda t, motion: np.round(22.0 + 1.5 * np.sin(2 * np.pi * t / (23.0 * period)), 2)


@form(
    NONE, source="an odd clock that was switched on a day before", rig="telescope", rate=617.3, noise="uniform", begins=86391.5
)
def rate_odd(w: World, a: float) -> None:
    """Samples a natural period: 81.4."""
