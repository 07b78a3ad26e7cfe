"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np
from scipy.signal import savgol_filter

from tests.discovery.unseen_forms.forms import NONE, arrivals, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"
LOOSE = {"mass": 0.03, "stiffness": 0.05, "damping": 0.5, "normal_force": 0.03, "mu_s": 0.08, "mu_k": 0.08}
"""Relative standard deviations of a rig that was never weighed [-]."""


@form(NONE, source="granite in direct shear", rig="rock")
def plain_rock(w: World, a: float) -> None:
    pass


@form(NONE, source="rosin on a string", rig="bow")
def plain_bow(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise)", rig="brake", noise="pink")
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by 0.7 of the noise)", rig="valve")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 0.7 * w.nominal.noise * steady_noise(rng, w.duration, 6.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of six times the noise)", rig="wiper", quantum=6.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="bow", jitter=0.025)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="valve", at_limits=True)
def limits_valve(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="brake", at_limits=True)
def limits_brake(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (stated loosely, and off by as much)", rig="wiper", uncertainty=LOOSE, at_limits=True)
def stated_loosely(w: World, a: float) -> None:
    pass


@form(NONE, source="Kang, Choi and Yoo 2015, section 2.2 (declared)", rig="valve", declared="per_event", declared_sigma=0.01)
def scatter_declared(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.01 * z[0], rig.mu_k + 0.01 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Little and Rubin 1987 (single samples)", rig="rock", missing=0.02, gap=0.0)
def samples_missing(w: World, a: float) -> None:
    pass


@form(NONE, source="Savitzky and Golay 1964 (a sensor that smooths over seven samples, without delay)", rig="bow")
def sensor_smooths(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return savgol_filter(motion.position + 2.0 * w.nominal.noise * rng.standard_normal(t.size), 7, 3)

    w.sensor = sensor


@form(NONE, source="Ott 2009 (a welder next door: twice the noise, in spells)", rig="wiper")
def noise_in_spells(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        flips = arrivals(rng, w.duration, 0.4 / w.nominal.period)
        loud = np.mod(np.searchsorted(flips, t), 2)
        return motion.position + np.sqrt(3.0) * w.nominal.noise * loud * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="an odd clock", rig="valve", rate=473.7)
def rate_odd(w: World, a: float) -> None:
    pass


@form(NONE, source="a fast clock", rig="wiper", rate=1500.0)
def rate_fast(w: World, a: float) -> None:
    pass
