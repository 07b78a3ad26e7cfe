"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"


@form(NONE, source="the shuttle of a comb drive", rig="comb")
def plain_comb(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise, a fifth louder)", rig="tendon", noise="pink", loudness=1.2)
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by 0.7 of the noise, over three cycles)", rig="hip")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 0.7 * w.nominal.noise * steady_noise(rng, w.duration, 3.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of six times the noise)", rig="tread", quantum=6.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="cylinder", jitter=0.025)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source=f"{LIMITS}; an even density of noise", rig="cylinder", at_limits=True, noise="uniform")
def limits_cylinder(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="slipway", at_limits=True)
def limits_slipway(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="JCGM 100:2008; Horowitz and Hill 1989 (numbers off by 1.2 deviations, and a hum)",
    rig="tread",
    at_limits=0.6,
    noise="hum",
)
def limits_and_a_hum(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="hip",
    declared="per_event",
    declared_sigma=0.003,
)
def scatter_declared(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.003 * z[0], rig.mu_k + 0.003 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="comb", declared="ornstein_uhlenbeck", declared_sigma=0.008)
def scatter_declared_correlated(w: World, a: float) -> None:
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.008 * z(s.t), lambda s: rig.mu_k + 0.008 * y(s.t)


@form(
    NONE,
    source="Little and Rubin 1987 (one sample of twenty, and a pause of a cycle and a half)",
    rig="tendon",
    missing=0.05,
    gap=1.5,
)
def samples_dropped(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="an odd clock, and noise of neighbours that is alike (Box and Jenkins 1970)",
    rig="slipway",
    rate=213.7,
    noise="coloured",
)
def rate_odd(w: World, a: float) -> None:
    pass
