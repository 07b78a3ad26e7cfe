"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Estrin and Brechet 1996 (asperities that age while they meet: 1 - exp(-(1/v)^(2/3)))")
def weakening_of_ageing_asperities(w: World, a: float) -> None:
    """Slow asperities age in full; beyond 0.15 of the highest speed they have ever less time for it."""
    slow = 0.15 * w.nominal.peak_speed
    weaken(w, lambda v: 1.0 - np.exp(-((slow / max(v, 1e-9 * slow)) ** (2 / 3))), 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Williamson 1929 (a paint: a hyperbola of the speed, and a line)")
def viscous_of_a_paint(w: World, a: float) -> None:
    """At the highest speed the hyperbola and the line carry a half each."""
    viscous(w, lambda u: 0.5 * 1.25 * u / (0.25 + u) + 0.5 * u, 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing", source="Burgers 1935 (bitumen that is pressed flat: it yields exponentially, and flows on)", designs=SEVERAL
)
def dwell_of_bitumen(w: World, a: float) -> None:
    """An exponential of 0.4 cycles and a line; there is no end to it."""
    base, first, size = w.rig.mu_s, w.nominal.period, 0.45 * a * w.nominal.gap

    def spread(dwell):
        return 1.0 - np.exp(-dwell / (0.4 * first)) + 0.25 * dwell / first

    usual = spread(first)
    w.mu_s = lambda s: base + size * (spread(s.dwell) - usual)


@form("frictional_lag", source="Tvergaard and Hutchinson 1992 (a trapezoid over the slip: level, then straight down)")
def lag_of_a_trapezoid(w: World, a: float) -> None:
    """Four fifths of the gap hold on for 0.06 of a slip, and are gone after 0.24."""
    holds, ends = 0.06 * w.nominal.slip_length, 0.24 * w.nominal.slip_length
    lag(w, lambda s, t: 0.8 * a * min(max((ends - s) / (ends - holds), 0.0), 1.0))


@form(
    "direction_asymmetry",
    source="Bullock, Drechsler and Federle 2008 (an insect's pad holds when it is pulled, and peels when it is pushed)",
    designs=SEVERAL,
    reversed=True,
    rig="beetle",
)
def asymmetry_of_an_insects_pad(w: World, a: float) -> None:
    """As stated when pulled; when pushed a seventh less to start, and a twelfth less to slide."""
    rig, pushed = w.rig, w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 - (0.14 * a if pushed else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 - (0.08 * a if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Shaw, Ber and Mamin 1960 (from Amontons to a stress that cannot be passed: a bend of exponent 1.6)",
    designs=SEVERAL,
    loads=True,
    rig="die",
)
def load_up_to_the_shear_strength(w: World, a: float) -> None:
    """At twice the load a sixth less than stated, of break-away and sliding alike."""
    rig, n = w.rig, 1.6

    def factor(u: float) -> float:
        p = 0.55 * a * u
        return float((-np.expm1(-(p**n))) ** (1.0 / n) / p) if p > 0.0 else 1.0

    share = factor(w.normal_force / w.nominal.normal_force) / factor(1.0)
    w.mu_s, w.mu_k = lambda s: rig.mu_s * share, lambda s: rig.mu_k * share


@form("presliding_compliance", source="Frenkel 1926; Tomlinson 1929 (what holds rises as a sine, up to its top)")
def presliding_sine(w: World, a: float) -> None:
    """Nearly straight up to two thirds, and level where it lets go."""
    if a > 0.0:
        contact(
            w,
            lambda u: 1.02 * float(np.sin(0.5 * np.pi * min(u, 1.0))),
            lambda share: float(np.arcsin(share / 1.02)) * 2.0 / np.pi,
            0.13 * a * w.nominal.slip_length,
        )


@form(
    "position_dependent_friction", source="Inasaki, Karpuschewski and Lee 2001 (chatter marks that swell and fade along a turn)"
)
def position_of_chatter_marks(w: World, a: float) -> None:
    """Six marks a turn, deep on one side of the belt and gone on the other."""
    turn = 17.0 * w.nominal.slip_length

    def marks(s: State):
        u = 2 * np.pi * (s.travel - s.x) / turn
        return 0.5 * (1.0 + np.cos(u + 1.1)) * np.cos(6.0 * u)

    scaled(w, lambda s: 1.0 + 0.09 * a * marks(s))


@form(
    "friction_drift",
    source="Semenov 1935 (an oil whose inhibitor is used up: nothing for a while, then it turns to gum)",
    also_one=("distance_drift",),
    rig="mill",
)
def drift_after_an_induction(w: World, a: float) -> None:
    """Level for seven cycles, then exponentially up by a seventh."""
    begins, tau = 7.0 * w.nominal.period, 15.0 * w.nominal.period
    scaled(w, lambda s: 1.0 - 0.14 * a * np.expm1(-np.maximum(s.t - begins, 0.0) / tau))


@form(
    "distance_drift",
    source="Schedin 1994 (galling: what has been picked up picks up more, exponentially with the way)",
    also_one=("friction_drift",),
    rig="fork",
)
def distance_of_galling(w: World, a: float) -> None:
    """Ever faster: 5 % within 24 slips, 17 % within 60."""
    length = 60.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.1 * a * np.expm1(s.slid / length))


@form("temperature_drift", source="Kingsbury 1958 (an adsorbed film that leaves: 1 - exp(-rate), the rate exponential)")
def temperature_of_an_adsorbed_film(w: World, a: float) -> None:
    """Friction rises by a seventh about 24 degC: slowly at first, and soon all of the film is gone."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 - 0.14 * a * np.expm1(-np.exp((celsius(s.t) - 24.3) / 1.2)))


@form("random_coefficients", source="Rayleigh 1880; Longuet-Higgins 1952 (the height of the crest that a slip stops at)")
def scatter_of_crests(w: World, a: float) -> None:
    """One draw for both coefficients, which leans upwards; the means are as stated."""
    rig, gap, mean = w.rig, w.nominal.gap, np.sqrt(0.5 * np.pi)

    def draw(s: State | None) -> None:
        z = (w.rng.rayleigh() - mean) / np.sqrt(2.0 - 0.5 * np.pi)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.13 * a * gap * z, rig.mu_k + 0.05 * a * gap * z

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Ehrenfest and Ehrenfest 1907 (an urn: of twelve patches each slip turns one over)")
def correlated_patches_of_film(w: World, a: float) -> None:
    """A patch of film is rubbed off or laid on, whichever it is; after six slips 1/e is remembered."""
    patches = w.rng.integers(0, 2, 12)

    def turn(s: State | None) -> None:
        patches[w.rng.integers(patches.size)] ^= 1
        w.memory["level"] = (patches.sum() - 6.0) / np.sqrt(3.0)

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * w.memory["level"])
