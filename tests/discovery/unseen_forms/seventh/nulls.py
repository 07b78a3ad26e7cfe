"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import DEFAULT_UNCERTAINTY

from .enter import form

LIMITS = "JCGM 100:2008 (every believed number two standard deviations off)"


@form(NONE, source="side walls of a gripper", rig="gripper")
def plain_gripper(w: World, a: float) -> None:
    pass


@form(NONE, source="Keshner 1982 (1/f noise, half as loud again)", rig="isolator", noise="pink", loudness=1.5)
def noise_pink(w: World, a: float) -> None:
    pass


@form(NONE, source="Uhlenbeck and Ornstein 1930 (zero that wanders by 0.6 of the noise)", rig="drawer")
def zero_wanders(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        return motion.position + 0.6 * w.nominal.noise * steady_noise(rng, w.duration, 4.0 * w.nominal.period)(t)

    w.sensor = sensor


@form(NONE, source="Widrow and Kollar 2008 (steps of eight times the noise)", rig="gib", quantum=8.0)
def quantised(w: World, a: float) -> None:
    pass


@form(NONE, source="Balakrishnan 1962 (sampling instants uncertain by as much as the noise)", rig="catheter", jitter=0.023)
def clock_jitters(w: World, a: float) -> None:
    pass


@form(NONE, source=LIMITS, rig="gripper", at_limits=True)
def limits_gripper(w: World, a: float) -> None:
    pass


@form(NONE, source=f"{LIMITS}; an even density of noise", rig="drawer", at_limits=True, noise="uniform")
def limits_drawer(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="JCGM 100:2008 (nothing stated: three quarters of what the page says is taken then)",
    rig="catheter",
    uncertainty=DEFAULT_UNCERTAINTY,
    unstated=True,
    at_limits=0.75,
)
def uncertainty_unstated(w: World, a: float) -> None:
    pass


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)",
    rig="isolator",
    declared="per_event",
    declared_sigma=0.006,
)
def scatter_declared(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.006 * z[0], rig.mu_k + 0.006 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Uhlenbeck and Ornstein 1930 (declared)", rig="gib", declared="ornstein_uhlenbeck", declared_sigma=0.005)
def scatter_declared_correlated(w: World, a: float) -> None:
    rig, (z, y) = w.rig, (steady_noise(w.rng, w.duration, w.nominal.period) for _ in range(2))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.005 * z(s.t), lambda s: rig.mu_k + 0.005 * y(s.t)


@form(NONE, source="Lange, Little and Taylor 1989 (Student's t of five degrees of freedom beside the noise)", rig="gripper")
def noise_heavy(w: World, a: float) -> None:
    w.sensor = lambda t, motion, rng: motion.position + w.nominal.noise * rng.standard_t(5.0, t.size) / np.sqrt(5.0 / 3.0)


@form(NONE, source="Little and Rubin 1987 (single samples), at 1130 Hz", rig="catheter", missing=0.03, gap=0.0, rate=1130.0)
def samples_missing(w: World, a: float) -> None:
    pass
