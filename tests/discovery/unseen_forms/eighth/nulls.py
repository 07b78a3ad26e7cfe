"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"


@form(NONE, source="the bearing of a bridge", rig="bearing")
def plain_bearing(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise)", rig="boot", noise="pink")
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by 0.8 of the noise, from cycle to cycle)", rig="lens")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 0.8 * w.nominal.noise * steady_noise(rng, w.duration, 1.5 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of seven times the noise)", rig="head", quantum=7.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by nearly as much as the noise)", rig="gate", jitter=0.035)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="Marvasti 2001 (uneven instants, written down as they were; stamps of a microsecond)",
    rig="piston",
    jitter=0.12,
    stamped=True,
    stamp=1.0e-6,
)
def samples_uneven(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="boot", at_limits=True)
def limits_boot(w: World, a: float) -> None:
    pass


@form(NONE, source=f"{LIMITS}; noise of neighbours is alike", rig="head", at_limits=True, noise="coloured")
def limits_head(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (numbers off by one standard deviation)", rig="gate", at_limits=0.5)
def half_of_the_limits(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="lens",
    declared="per_event",
    declared_sigma=0.009,
)
def scatter_declared(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.009 * z[0], rig.mu_k + 0.009 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(
    NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="bearing", declared="ornstein_uhlenbeck", declared_sigma=0.0015
)
def scatter_declared_correlated(w: World, a: float) -> None:
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.0015 * z(s.t), lambda s: rig.mu_k + 0.0015 * y(s.t)


@form(
    NONE,
    source="Little and Rubin 1987 (every sixteenth sample, and a pause of three cycles)",
    rig="piston",
    missing=0.06,
    gap=3.0,
)
def samples_dropped(w: World, a: float) -> None:
    pass
