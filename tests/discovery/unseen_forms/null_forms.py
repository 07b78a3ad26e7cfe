"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np

from .forms import NONE, UNKNOWN, each_stick, form
from .motion import World


@form(NONE, source="Kang, Choi and Yoo 2015, Table 1", rig="paper")
def plain(w: World, a: float) -> None:
    pass


@form(NONE, source="Kang, Choi and Yoo 2015, Table 2", rig="excited")
def plain_excited(w: World, a: float) -> None:
    pass


@form(NONE, source="a bench tribometer", rig="small")
def plain_small(w: World, a: float) -> None:
    pass


@form(NONE, source="a machine slide", rig="fast")
def plain_fast(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise)", rig="paper", noise="pink")
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by twice the noise)", rig="small", noise="wander")
def zero_wanders(w: World, a: float) -> None:
    pass


@form(NONE, source="Widrow 1956", rig="paper", quantum=5.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain, stamps even)", rig="paper", jitter=0.25)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="paper", at_limits=True)
def numbers_at_limits(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="fast", at_limits=True)
def numbers_at_limits_fast(w: World, a: float) -> None:
    pass


@form(NONE, source="Nyquist 1928", rig="paper", rate=125.0)
def rate_125_hz(w: World, a: float) -> None:
    pass


@form(NONE, source="Nyquist 1928", rig="paper", rate=5000.0)
def rate_5_khz(w: World, a: float) -> None:
    pass


@form(NONE, source="Little and Rubin 1987", rig="paper", missing=0.01)
def samples_missing(w: World, a: float) -> None:
    pass


@form(NONE, source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)", rig="paper", declared="per_event")
def scatter_declared_per_stick(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.015 * z[0], rig.mu_k + 0.015 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Kang, Choi and Yoo 2015, section 2.2 (declared, knots)", rig="paper", declared="knots")
def scatter_declared_knots(w: World, a: float) -> None:
    rig, grid = w.rig, np.arange(0.0, w.duration + 0.03, 0.01)
    z = w.rng.standard_normal((2, grid.size))
    w.mu_s = lambda s: rig.mu_s + 0.015 * np.interp(s.t, grid, z[0])
    w.mu_k = lambda s: rig.mu_k + 0.015 * np.interp(s.t, grid, z[1])


@form(NONE, source="a morning's second try", rig="paper", designs=("one",), length=0.5)
def record_short(w: World, a: float) -> None:
    pass


@form(NONE, UNKNOWN, source="a morning's first try", rig="paper", designs=("one",), length=0.2)
def record_too_short(w: World, a: float) -> None:
    """Twelve cycles for the fit and seven held out: to say that this is too little is right, to name an effect is not."""


@form(NONE, source="a night's run", rig="paper", designs=("one",), length=6.0)
def record_long(w: World, a: float) -> None:
    pass
