"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form(NONE, source="a press", rig="press")
def plain_press(w: World, a: float) -> None:
    pass


@form(NONE, source="a rubber wiper on a string potentiometer", rig="soft")
def plain_soft(w: World, a: float) -> None:
    pass


@form(NONE, source="Timpe and Komvopoulos 2006 (side walls of a micromachine)", rig="micro")
def plain_micro(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise)", rig="soft", noise="pink")
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by the noise)", rig="press")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + w.nominal.noise * steady_noise(rng, w.duration, 12.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of six times the noise)", rig="micro", quantum=6.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Marvasti 2001 (uneven instants, written down as they were)", rig="paper", jitter=0.15, stamped=True)
def stamps_uneven(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="press", at_limits=True)
def limits_press(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="soft", at_limits=True)
def limits_soft(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="micro", at_limits=True)
def limits_micro(w: World, a: float) -> None:
    pass


@form(NONE, source="an odd clock", rig="paper", rate=251.3)
def rate_odd(w: World, a: float) -> None:
    pass


@form(NONE, source="a fast clock", rig="paper", rate=3300.0)
def rate_fast(w: World, a: float) -> None:
    pass


@form(NONE, source="Black and Hodges 1980 (two converters in turn, half the noise apart)", rig="fast")
def converters_in_turn(w: World, a: float) -> None:
    w.sensor = lambda t, motion, rng: motion.position + 0.25 * w.nominal.noise * (-1.0) ** np.arange(t.size)


@form(NONE, source="Little and Rubin 1987", rig="small", missing=0.04)
def samples_missing(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="paper", declared="ornstein_uhlenbeck")
def scatter_declared_correlated(w: World, a: float) -> None:
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.015 * z(s.t), lambda s: rig.mu_k + 0.015 * y(s.t)


@form(NONE, source="Dorsch, Hausler and Herrmann 1994 (noise that doubles along the range)", rig="paper")
def noise_grows_with_distance(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 1.7 * w.nominal.noise * motion.position / w.nominal.reach * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="a logger that was switched on long before", rig="small", begins=4210.0)
def begins_late(w: World, a: float) -> None:
    pass


@form(NONE, source="a try that was cut short", rig="press", length=0.5)
def record_short(w: World, a: float) -> None:
    pass
