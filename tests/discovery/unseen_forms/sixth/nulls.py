"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE
from tests.discovery.unseen_forms.motion import World

from .enter import form

TWO_THIRDS = 2.0 / 3.0
"""Of two standard deviations, by which every believed number is off."""


@form(NONE, source="Keshner 1982 (1/f noise, twice as loud)", rig="spool", noise="pink", loudness=2.0)
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Widrow and Kollar 2008 (steps of seven times the noise)", rig="pad", quantum=7.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="granite", jitter=0.013)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (numbers off by two thirds of their limits)", rig="blade", at_limits=TWO_THIRDS)
def two_thirds_of_the_limits(w: World, a: float) -> None:
    pass


@form(
    NONE, source="JCGM 100:2008; Horowitz and Hill 1989 (the same, and a hum)", rig="rosin", at_limits=TWO_THIRDS, noise="hum"
)
def two_thirds_and_a_hum(w: World, a: float) -> None:
    pass


@form(NONE, source="Merry, van de Molengraft and Steinbuch 2010 (interpolated: noise of neighbours is alike)", rig="pad")
def counts_interpolated(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        alike = np.convolve(rng.standard_normal(t.size + 4), np.ones(5) / np.sqrt(5.0), "valid")
        return motion.position + w.nominal.noise * alike

    w.sensor = sensor
