"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import erf

from tests.discovery.unseen_forms.forms import each_stick
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Van de Vrande, van Campen and de Kraker 1999 (arc tangent)")
def weakening_arc_tangent(w: World, a: float) -> None:
    knee = 0.2 * w.nominal.peak_speed
    weaken(w, lambda v: 1.0 - 2.0 / np.pi * np.arctan(v / knee), 0.45 * a * w.nominal.gap)


@form("viscous_friction", source="Casson 1959 (roots of stresses add: a line and a root of the speed)")
def viscous_casson(w: World, a: float) -> None:
    viscous(w, lambda u: (u + 2.0 * np.sqrt(0.5 * u)) / (1.0 + np.sqrt(2.0)), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Derjaguin, Push and Tolstoi 1957 (a hyperbola in the time of rest)", designs=SEVERAL)
def dwell_hyperbolic(w: World, a: float) -> None:
    base, half, size = w.rig.mu_s, 0.7 * w.nominal.period, 0.8 * a * w.nominal.gap
    usual = 1.0 / 1.7
    w.mu_s = lambda s: base + size * (s.dwell / (s.dwell + half) - usual)


@form("frictional_lag", source="Matsu'ura, Kataoka and Shibazaki 1992 (asperities hold first, and are then worn off)")
def lag_holds_first(w: World, a: float) -> None:
    distance = 0.07 * w.nominal.slip_length
    lag(w, lambda s, t: a * (1.0 + s / distance) * np.exp(-s / distance))


@form(
    "direction_asymmetry",
    source="Salant 1999 (a lip that pumps one way: the other way friction rises as the root of the speed)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_a_pumping_lip(w: World, a: float) -> None:
    rig, top, more = w.rig, w.nominal.peak_speed, 0.4 * a * w.nominal.gap
    w.mu_k = lambda s: rig.mu_k + (more * np.sqrt(abs(s.w) / top) if s.direction < 0 else 0.0)


@form("load_dependence", source="Persson 2001 (the real area as an error function of the load)", designs=SEVERAL, loads=True)
def load_error_function(w: World, a: float) -> None:
    u = w.normal_force / w.nominal.normal_force
    by_load(w, 1.0 + a * (erf(0.7 * u) / (u * erf(0.7)) - 1.0))


@form("presliding_compliance", source="Richard and Abbott 1975 (a straight line that bends into a plateau)")
def presliding_richard_abbott(w: World, a: float) -> None:
    if a > 0.0:
        length = 0.03 * a * w.nominal.slip_length

        def inverse(share: float) -> float:
            y = share / 1.05
            return y / (1.0 - y**3) ** (1 / 3)

        contact(w, lambda u: 1.05 * u / (1.0 + u**3) ** (1 / 3), inverse, length)


@form("position_dependent_friction", source="Lodewijks 1996 (a splice of the belt: harder before it, softer behind it)")
def position_splice(w: World, a: float) -> None:
    length = 11.3 * w.nominal.slip_length

    def factor(s: State):
        u = (np.mod((s.travel - s.x) / length + 0.2, 1.0) - 0.5) / 0.13
        return 1.0 + 0.12 * a * u * np.exp(0.5 * (1.0 - u * u))

    scaled(w, factor)


@form("random_coefficients", source="Poisson 1837; Rabinowicz 1965 (a number of junctions: counts)")
def scatter_counts(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = (w.rng.poisson(4.0, 2) - 4.0) / 2.0
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.08 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: min(w.memory["k"], 0.9 * w.memory["s"])
