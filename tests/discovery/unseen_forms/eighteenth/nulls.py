"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise, warm
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

HANDBOOK = UNCERTAINTY | {"mass": 0.01, "stiffness": 0.03, "damping": 0.4}
"""Relative standard deviations of a rig whose spring was computed from its drawing [-]."""
LIMITS = "JCGM 102:2011 (every believed number two standard deviations off)"


@form(
    NONE,
    source="Jenkins and Watts 1968 (a gauge with a filter of its own: noise that is alike for ten samples)",
    rig="brush",
    noise="coloured",
)
def noise_through_a_filter(w: World, a: float) -> None:
    """Noise alone."""


@form(NONE, source="Keshner 1982 (1/f noise of an amplifier)", rig="finger", noise="pink")
def flicker_of_the_amplifier(w: World, a: float) -> None:
    """Noise alone."""


@form(NONE, source="Ott 1988 (a hum that hides in the noise)", rig="pallet", noise="hum")
def hum_no_louder_than_the_noise(w: World, a: float) -> None:
    """Noise, and a tone of the same power."""


@form(NONE, source="Widrow and Kollar 2008 (a display of few digits)", rig="barn", quantum=3.0)
def display_of_few_digits(w: World, a: float) -> None:
    """Steps of three times the noise."""


@form(NONE, source="Eidson 2006 (a software trigger: each sample a little early or late, by chance)", rig="bolt", jitter=0.03)
def trigger_jitters(w: World, a: float) -> None:
    """By three hundredths of a sample: no more than the noise at the highest speed."""


@form(
    NONE,
    source="Postel 1981 (a network stamps what comes, unevenly and rightly)",
    rig="brush",
    jitter=0.12,
    stamped=True,
    begins=412.0,
)
def stamps_are_uneven_and_true(w: World, a: float) -> None:
    """The stamps count from another instant."""


@form(
    NONE,
    source="Little and Rubin 1987 (samples lost at random, and once a longer piece)",
    rig="furnace",
    missing=0.003,
    gap=0.3,
)
def samples_are_lost(w: World, a: float) -> None:
    """Three of a thousand, and a third of a cycle."""


@form(NONE, source=LIMITS, rig="finger", at_limits=True)
def limits_of_what_is_stated(w: World, a: float) -> None:
    """All else is well."""


@form(
    NONE,
    source=f"{LIMITS}; Shigley 1956 (a spring computed from its drawing); a gauge that bends within the noise",
    rig="pallet",
    uncertainty=HANDBOOK,
    at_limits=True,
)
def limits_of_a_drawing(w: World, a: float) -> None:
    """The gauge's line bends by seven tenths of the noise, once along its range."""
    size, full = 0.7 * w.nominal.noise, 1.2 * w.nominal.reach
    w.sensor = lambda t, motion, rng: motion.position + size * np.sin(2 * np.pi * motion.position / full)


@form(
    NONE,
    source="Gillespie 1996 (declared: coefficients that wander, by 0.5 of a hundredth)",
    rig="bolt",
    declared="ornstein_uhlenbeck",
    declared_sigma=0.005,
)
def wandering_is_declared(w: World, a: float) -> None:
    """With the correlation time of the scenario, and mu_s and mu_k each for itself."""
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.005 * z(s.t), lambda s: rig.mu_k + 0.005 * y(s.t)


@form(
    NONE,
    source="Rabinowicz 1956 (declared: coefficients that are others after each slip, by 0.6 of a hundredth)",
    rig="furnace",
    declared="per_event",
    declared_sigma=0.006,
)
def scatter_of_each_slip_is_declared(w: World, a: float) -> None:
    """A new pair whenever the box sticks."""
    rig, pair = w.rig, np.zeros(2)

    def draw(s):
        pair[:] = 0.006 * w.rng.standard_normal(2)

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: rig.mu_s + pair[0], lambda s: rig.mu_k + pair[1]


@form(NONE, source="Montgomery 1984 (a thermometer and a hygrometer that matter to nobody)", rig="barn", noise="uniform")
def room_is_written_down(w: World, a: float) -> None:
    """The room warms and swings, and nothing minds; the gauge's noise is even between its limits."""
    warm(w)
    turn = 23.0 * w.nominal.period
    w.columns["humidity"] = lambda t, motion: np.round(52.0 + 4.0 * np.sin(2 * np.pi * t / turn + 2.0), 1)
