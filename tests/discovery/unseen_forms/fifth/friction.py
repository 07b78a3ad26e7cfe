"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Gelinck and Schipper 2000 (mixed lubrication: an S in the logarithm of the speed)")
def weakening_in_an_s(w: World, a: float) -> None:
    knee = 0.3 * w.nominal.peak_speed
    weaken(w, lambda v: 1.0 / (1.0 + (v / knee) ** 3), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Di Toro and others 2011 (a power of the speed far below 1)")
def weakening_by_a_power(w: World, a: float) -> None:
    slow = 0.05 * w.nominal.peak_speed
    weaken(w, lambda v: (1.0 + v / slow) ** -0.4, 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Gnecco and others 2000 (logarithm of the speed, a line at its beginning)")
def viscous_logarithmic(w: World, a: float) -> None:
    viscous(w, lambda u: np.log1p(6.0 * u) / np.log1p(6.0), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Nakatani and Scholz 2004 (nothing up to a cut-off time, then its logarithm)", designs=SEVERAL)
def dwell_after_a_cut_off(w: World, a: float) -> None:
    base, cut_off, size = w.rig.mu_s, 0.5 * w.nominal.period, 0.3 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.log(np.maximum(s.dwell / cut_off, 1.0)) - np.log(2.0))


@form("frictional_lag", source="Petersson 1981 (softening along two straight lines)")
def lag_along_two_lines(w: World, a: float) -> None:
    corner, end = 0.08 * w.nominal.slip_length, 0.5 * w.nominal.slip_length
    lag(w, lambda s, t: a * float(np.interp(s, [0.0, corner, end], [1.0, 0.3, 0.0])))


@form(
    "direction_asymmetry",
    source="Mueller and Nau 1998, chapter 8 (a lip that drags one way, by a force that knows no load)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_a_lip(w: World, a: float) -> None:
    rig, more = w.rig, 0.1 * a * w.nominal.mu_k * w.nominal.normal_force / w.normal_force
    side = w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s + (0.7 * more if side else 0.0)
    w.mu_k = lambda s: rig.mu_k + (more if s.direction < 0 else 0.0)


@form("load_dependence", source="Bhushan and Kulkarni 1996 (ploughing from a load on)", designs=SEVERAL, loads=True)
def load_ploughs(w: World, a: float) -> None:
    def share(u: float) -> float:
        return 0.2 * np.logaddexp(0.0, (u - 1.0) / 0.2)

    by_load(w, 1.0 + 0.25 * a * (share(w.normal_force / w.nominal.normal_force) - share(1.0)))


@form("presliding_compliance", source="Oden and Pires 1983 (arc tangent)")
def presliding_arc_tangent(w: World, a: float) -> None:
    bend = 0.5 * np.pi / 1.2
    if a > 0.0:
        length = 0.015 * a * w.nominal.slip_length
        contact(w, lambda u: np.arctan(u) / bend, lambda share: np.tan(bend * share), length)


@form("position_dependent_friction", source="Sayles and Thomas 1978 (a rough belt: six harmonics of a turn, as 1/h)")
def position_profile(w: World, a: float) -> None:
    turn = 2 * np.pi / (13.1 * w.nominal.slip_length)
    phases = (0.4, 2.9, 5.1, 1.3, 3.8, 0.9)
    scaled(
        w, lambda s: 1.0 + 0.05 * a * sum(np.cos(h * turn * (s.travel - s.x) + p) / h for h, p in enumerate(phases, start=1))
    )


@form("friction_drift", source="Barnes 1997 (a structure that breaks down in second order)", also_one=("distance_drift",))
def drift_of_second_order(w: World, a: float) -> None:
    half = 12.0 * w.nominal.period
    scaled(w, lambda s: 1.0 - 0.12 * a * s.t / (s.t + half))


@form("distance_drift", source="Blau 1989; Archard 1953 (a fast run-in, then a steady rise)", also_one=("friction_drift",))
def distance_run_in_and_wear(w: World, a: float) -> None:
    length = w.nominal.slip_length
    scaled(w, lambda s: 1.0 + a * (-0.08 * (1.0 - np.exp(-s.slid / (4.0 * length))) + 0.1 * s.slid / (60.0 * length)))


@form("temperature_drift", source="Williams, Landel and Ferry 1955 (rubber above its transition)")
def temperature_of_rubber(w: World, a: float) -> None:
    warm(w)

    def factor(s: State):
        above = w.temperature(s.t) - 20.0
        return 10.0 ** (-0.15 * a * above / (15.0 + above))

    scaled(w, factor)


@form("random_coefficients", source="JCGM 100:2008, 4.3.7 (even between two limits)")
def scatter_even(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = np.sqrt(3.0) * w.rng.uniform(-1.0, 1.0, 2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.09 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Dimentberg 1988; Wedig 1990 (bounded noise: the sine of a random walk)")
def correlated_bounded(w: World, a: float) -> None:
    time, h = 5.0 * w.nominal.period, 0.02 * w.nominal.period
    grid = np.arange(0.0, w.duration + 2.0 * h, h)
    steps = np.sqrt(2.0 * h / time) * w.rng.standard_normal(grid.size)
    wave = np.sin(2 * np.pi * w.rng.random() + np.cumsum(steps))
    scaled(w, lambda s: 1.0 + 0.06 * a * np.interp(s.t, grid, wave))
