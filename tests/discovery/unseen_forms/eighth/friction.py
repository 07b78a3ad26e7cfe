"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Okubo 1989; Weeks 1993 (a logarithm between two cut-off speeds)")
def weakening_between_cut_offs(w: World, a: float) -> None:
    low, high = 0.08 * w.nominal.peak_speed, 0.5 * w.nominal.peak_speed
    weaken(w, lambda v: np.log((high + v) / (low + v)) / np.log(high / low), 0.45 * a * w.nominal.gap)


@form("viscous_friction", source="Powell and Eyring 1944 (a line and an inverse hyperbolic sine)")
def viscous_powell_eyring(w: World, a: float) -> None:
    curve = 8.0
    viscous(
        w,
        lambda u: 0.45 * u + 0.55 * np.arcsinh(curve * u) / np.arcsinh(curve),
        0.4 * a * w.nominal.gap * w.nominal.normal_force,
    )


@form("dwell_ageing", source="Muhuri, Dewers, Scott and Reches 2003 (bonds, and cement that comes later)", designs=SEVERAL)
def dwell_with_cement(w: World, a: float) -> None:
    """Two slopes in the logarithm of time: gentle at first, three times as steep beyond the usual time of rest."""
    base, usual, size = w.rig.mu_s, w.nominal.period, a * w.nominal.gap

    def grown(u):
        return 0.12 * np.log1p(u / 0.05) + 0.117 * np.log1p((u / 0.9) ** 3)

    w.mu_s = lambda s: base + size * (grown(s.dwell / usual) - grown(1.0))


@form("frictional_lag", source="Foote, Mai and Cotterell 1986 (a power of the way that is left to go)")
def lag_power_of_the_rest(w: World, a: float) -> None:
    end = 0.3 * w.nominal.slip_length
    lag(w, lambda s, t: a * max(1.0 - s / end, 0.0) ** 1.8)


@form(
    "direction_asymmetry",
    source="Filippov and Gorb 2013 (bristles that lean: less than stated along them, more against)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_leaning_bristles(w: World, a: float) -> None:
    """Neither direction is as stated; what slides differs by twice what holds does."""
    rig, gap = w.rig, w.nominal.gap
    w.mu_s = lambda s: rig.mu_s + 0.07 * a * gap * (1.0 if w.belt_velocity < 0.0 else -1.0)
    w.mu_k = lambda s: rig.mu_k + 0.14 * a * gap * (1.0 if s.direction < 0 else -1.0)


@form(
    "load_dependence",
    source="Derjaguin, Muller and Toporov 1975 (a sphere that adheres around its contact)",
    designs=SEVERAL,
    loads=True,
)
def load_of_a_dmt_sphere(w: World, a: float) -> None:
    u, pull = w.normal_force / w.nominal.normal_force, 0.15
    by_load(w, 1.0 + a * (((u + pull) / (1.0 + pull)) ** (2 / 3) / u - 1.0))


@form("presliding_compliance", source="Bouc 1967; Wen 1976 (exponent two: a hyperbolic tangent)", rig="piston")
def presliding_tangent(w: World, a: float) -> None:
    if a > 0.0:
        length = 0.03 * a * w.nominal.slip_length
        contact(w, lambda u: 1.04 * np.tanh(u), lambda share: float(np.arctanh(share / 1.04)), length)


@form("position_dependent_friction", source="Varterasian 1969 (treads whose pitch swings along the turn)")
def position_swinging_pitch(w: World, a: float) -> None:
    length = 16.4 * w.nominal.slip_length

    def factor(s: State):
        u = 2 * np.pi * (s.travel - s.x) / length
        return 1.0 + 0.08 * a * np.cos(2.0 * u + 0.9 * np.sin(u) + 0.6)

    scaled(w, factor)


@form("friction_drift", source="Lee and Ludema 1990 (scuffing that feeds itself: exponential)", also_one=("distance_drift",))
def drift_that_feeds_itself(w: World, a: float) -> None:
    """What has changed after forty cycles is 0.15 of friction; in 24 cycles a third of it shows."""
    time, span = 16.0 * w.nominal.period, 40.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.15 * a * np.expm1(np.minimum(s.t, 1.5 * span) / time) / np.expm1(span / time))


@form("distance_drift", source="Bahadur 2000 (a film that is laid on, and rubbed off)", also_one=("friction_drift",))
def distance_laid_on_and_rubbed_off(w: World, a: float) -> None:
    peak = 9.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.12 * a * (s.slid / peak) * np.exp(1.0 - s.slid / peak))


@form("temperature_drift", source="Landau 1937; Carrion and others 2009 (a liquid crystal that loses its order at 25 degC)")
def temperature_of_a_liquid_crystal(w: World, a: float) -> None:
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 + 0.12 * a * (1.0 - np.sqrt(np.maximum(25.0 - celsius(s.t), 0.0) / 5.0)))


@form("random_coefficients", source="Tweedie 1957 (first passages: inverse Gaussian, a long tail above; both move together)")
def scatter_of_first_passages(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z, y = np.clip(w.rng.wald(1.0, 2.0, 2) - 1.0, -1.0, 3.0) / np.sqrt(0.5)
        w.memory["s"] = rig.mu_s + 0.09 * a * gap * z
        w.memory["k"] = rig.mu_k + 0.05 * a * gap * (0.8 * z + 0.6 * y)

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Slutzky 1937 (sums of chance: what the last seven slips have left)")
def correlated_sums(w: World, a: float) -> None:
    left = list(w.rng.standard_normal(7))

    def turn(s: State | None) -> None:
        left[:] = [*left[1:], w.rng.standard_normal()]
        w.memory["sum"] = sum(left) / np.sqrt(7.0)

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.045 * a * w.memory["sum"])
