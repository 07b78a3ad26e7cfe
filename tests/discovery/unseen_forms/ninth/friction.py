"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Leine, van Campen, de Kraker and van den Steen 1998 (a hyperbola)")
def weakening_hyperbola(w: World, a: float) -> None:
    half = 0.14 * w.nominal.peak_speed
    weaken(w, lambda v: 1.0 / (1.0 + v / half), 0.45 * a * w.nominal.gap)


@form("viscous_friction", source="Papanastasiou 1987 (a paste that yields: an exponential approach, and a line)")
def viscous_papanastasiou(w: World, a: float) -> None:
    viscous(w, lambda u: 0.4 * (1.0 - np.exp(-7.0 * u)) + 0.6 * u, 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Ishlinskii and Kragelskii 1944; Howe, Benton and Puddington 1955 (exponential)", designs=SEVERAL)
def dwell_exponential(w: World, a: float) -> None:
    base, usual, size = w.rig.mu_s, w.nominal.period, 0.55 * a * w.nominal.gap
    w.mu_s = lambda s: base - size * (np.exp(-1.1 * s.dwell / usual) - np.exp(-1.1))


@form("frictional_lag", source="Andrews 1985, 2004 (weakening by time: a straight fall, then no more)")
def lag_linear_in_time(w: World, a: float) -> None:
    end = 0.9 / w.nominal.pulsation
    lag(w, lambda s, t: a * max(1.0 - t / end, 0.0))


@form(
    "direction_asymmetry",
    source="Bona and Indri 2005; Janot, Gautier and Brunot 2019 (each direction has a level and a slope of its own)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_level_and_slope(w: World, a: float) -> None:
    rig, size, top = w.rig, a * w.nominal.gap, w.nominal.peak_speed
    w.mu_s = lambda s: rig.mu_s + (0.1 * size if w.belt_velocity < 0.0 else 0.0)
    w.mu_k = lambda s: rig.mu_k + (size * (0.1 + 0.2 * abs(s.w) / top) if s.direction < 0 else 0.0)


@form(
    "load_dependence",
    source="Bowden and Tabor 1964, chapter 14 (a Hertzian contact: N to -1/3, beside a share in proportion)",
    designs=SEVERAL,
    loads=True,
)
def load_of_hertz_and_amontons(w: World, a: float) -> None:
    by_load(w, 1.0 + 0.75 * a * ((w.normal_force / w.nominal.normal_force) ** (-1 / 3) - 1.0))


@form("presliding_compliance", source="Menq, Bielak and Griffin 1986 (a bar that lets go from its end: a root, stiff at first)")
def presliding_bar(w: World, a: float) -> None:
    stiff = 0.25
    if a > 0.0:
        contact(
            w,
            lambda u: np.sqrt(stiff**2 + (1.0 + 2.0 * stiff) * u) - stiff,
            lambda share: ((share + stiff) ** 2 - stiff**2) / (1.0 + 2.0 * stiff),
            0.05 * a * w.nominal.slip_length,
        )


@form("position_dependent_friction", source="Menezes, Kishore and Kailas 2006 (a belt ground rougher and rougher: a triangle)")
def position_triangle(w: World, a: float) -> None:
    turn = 2 * np.pi / (6.8 * w.nominal.slip_length)
    scaled(w, lambda s: 1.0 + 0.08 * a * 2.0 / np.pi * np.arcsin(np.sin(turn * (s.travel - s.x) + 0.9)))


@form("friction_drift", source="Draper and Smith 1998 (a parabola through a shift's readings)", also_one=("distance_drift",))
def drift_parabola(w: World, a: float) -> None:
    least = 38.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.13 * a * ((1.0 - s.t / least) ** 2 - 1.0))


@form(
    "distance_drift",
    source="Archard 1953; Holmberg and Matthews 2009 (a coating that wears in proportion, until it is gone)",
    also_one=("friction_drift",),
)
def distance_until_it_is_gone(w: World, a: float) -> None:
    gone = 13.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.1 * a * np.minimum(s.slid / gone, 1.0))


@form("temperature_drift", source="McLaren and Tabor 1963 (a polymer that softens from a temperature on: two straight lines)")
def temperature_of_two_lines(w: World, a: float) -> None:
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 - 0.025 * a * np.maximum(celsius(s.t) - 22.5, 0.0))


@form("random_coefficients", source="JCGM 100:2008, 4.3.9 (a triangle that leans; each of the two by itself)")
def scatter_of_leaning_triangles(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = w.rng.triangular(-1.0, -0.4, 1.4, 2) / 0.51  # no mean, unit variance
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.09 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Brissaud and Frisch 1974 (a level that stays, and is drawn anew now and then)")
def correlated_kangaroo(w: World, a: float) -> None:
    """One slip in five leaves another level behind; levels are normal."""

    def turn(s: State | None) -> None:
        anew, level = w.rng.random() < 0.2, w.rng.standard_normal()
        w.memory["level"] = level if anew or s is None else w.memory["level"]

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.045 * a * w.memory["level"])
