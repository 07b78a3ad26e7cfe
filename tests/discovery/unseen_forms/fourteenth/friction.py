"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Evans, Nye and Cheeseman 1976 (a surface that its own heat melts: an inverse root)")
def weakening_of_melting(w: World, a: float) -> None:
    """Level up to 0.04 of the highest speed, where melting begins; from there on as the inverse root of the speed."""
    melts = 0.04 * w.nominal.peak_speed
    weaken(w, lambda v: np.sqrt(melts / max(v, melts)), 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Robertson and Stiff 1976 (a drilling fluid: a power of the speed and a further speed)")
def viscous_of_a_drilling_fluid(w: World, a: float) -> None:
    """The power is 0.35, and the further speed 0.03 of the highest one: steep at first, nearly level at the end."""

    def stress(u: float) -> float:
        return (u + 0.03) ** 0.35 - 0.03**0.35

    viscous(w, lambda u: stress(u) / stress(1.0), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing",
    source="Johnson and Mehl 1939 (a grease whose soap grows again from nuclei: a cube of time)",
    designs=SEVERAL,
)
def dwell_from_nuclei(w: World, a: float) -> None:
    """Next to nothing in a third of a cycle, most of it about one cycle, and all of it after two."""
    base, usual, size = w.rig.mu_s, w.nominal.period, 0.6 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.exp(-1.0) - np.exp(-((s.dwell / usual) ** 3)))


@form("frictional_lag", source="Xu and Needleman 1993 (a bond that is sheared: one more than the slip, times an exponential)")
def lag_of_a_sheared_bond(w: World, a: float) -> None:
    """It falls slowly at first, fastest after 0.08 of a slip, and has no end."""
    distance = 0.08 * w.nominal.slip_length
    lag(w, lambda s, t: 0.9 * a * (1.0 + s / distance) * np.exp(-s / distance))


@form(
    "direction_asymmetry",
    source="Bonchis, Corke and Rye 1999 (a cylinder: its packing is pressed harder one way, and more so under pressure)",
    designs=SEVERAL,
    reversed=True,
    rig="strut",
)
def asymmetry_of_a_pressed_packing(w: World, a: float) -> None:
    """As stated one way; the other way more, of break-away and sliding alike, in proportion to the load."""
    rig, more = w.rig, 0.1 * a * w.normal_force / w.nominal.normal_force
    other = w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (more if other else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (more if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Draper and Smith 1998 (a straight line through what a dynamometer shows of a lining)",
    designs=SEVERAL,
    loads=True,
)
def load_along_a_line(w: World, a: float) -> None:
    """A fifth less than stated under twice the load, of break-away and sliding alike."""
    rig, factor = w.rig, 1.0 - 0.2 * a * (w.normal_force / w.nominal.normal_force - 1.0)
    w.mu_s, w.mu_k = lambda s: rig.mu_s * factor, lambda s: rig.mu_k * factor


@form(
    "presliding_compliance", source="Pawluk and Howe 1999 (a soft pad that stiffens: the force is an exponential)", rig="chair"
)
def presliding_of_felt(w: World, a: float) -> None:
    """Few fibres bear at first, ever more do: a hyperbolic sine, five times as stiff where it lets go."""
    if a > 0.0:
        contact(
            w,
            lambda u: float(np.sinh(2.3 * u) / np.sinh(2.3)),
            lambda share: float(np.arcsinh(share * np.sinh(2.3))) / 2.3,
            0.12 * a * w.nominal.slip_length,
        )


@form(
    "position_dependent_friction",
    source="Grassie and Kalousek 1993 (corrugation that a weld starts, and that dies away behind it)",
)
def position_behind_a_weld(w: World, a: float) -> None:
    """Five waves a turn, each less than half as high as the one before."""
    turn = 15.0 * w.nominal.slip_length

    def waves(s: State):
        u = np.mod((s.travel - s.x) / turn + 0.6, 1.0)
        return np.exp(-4.0 * u) * np.sin(10.0 * np.pi * u)

    scaled(w, lambda s: 1.0 + 0.15 * a * waves(s))


@form(
    "friction_drift",
    source="Sherwood 1929 (a wet surface that dries: a constant rate, then a falling one)",
    also_one=("distance_drift",),
)
def drift_of_drying(w: World, a: float) -> None:
    """Straight up for eleven cycles, then an exponential that goes on from there; up by a seventh in the end."""
    wet, tau = 11.0 * w.nominal.period, 9.0 * w.nominal.period

    def dried(t):
        return (np.minimum(t, wet) - tau * np.expm1(-np.maximum(t - wet, 0.0) / tau)) / (wet + tau)

    scaled(w, lambda s: 1.0 + 0.14 * a * dried(s.t))


@form(
    "distance_drift",
    source="Taylor 1907; ISO 3685:1993 (an edge that dulls: fast, steadily, and fast again)",
    also_one=("friction_drift",),
)
def distance_of_a_dulling_edge(w: World, a: float) -> None:
    """A twentieth within the first slips, then little, and from the fourteenth slip on a quarter of a per cent each."""
    slip = w.nominal.slip_length

    def worn(n):
        return 0.05 * (1.0 - np.exp(-n / 2.5)) + 0.0006 * n + 0.0025 * np.maximum(n - 14.0, 0.0)

    scaled(w, lambda s: 1.0 + a * worn(s.slid / slip))


@form("temperature_drift", source="van 't Hoff 1887; Coutinho and Daridon 2005 (wax that leaves its oil below the cloud point)")
def temperature_of_a_cloud_point(w: World, a: float) -> None:
    """Level above 25 degC, where all of the wax is dissolved; below it friction is the greater, the colder it is."""
    warm(w)
    celsius = vars(w)["temperature"]

    def wax(c):
        return -np.expm1(-np.maximum(25.0 - c, 0.0) / 3.0)

    scaled(w, lambda s: 1.0 + 0.15 * a * (wax(celsius(s.t)) - wax(20.0)))


@form("random_coefficients", source="JCGM 101:2008, 6.4.4 (a wide even part and a narrow one: a trapezoid)")
def scatter_of_trapezoids(w: World, a: float) -> None:
    """The wide part is one for both coefficients, each has a narrow one of its own; the means are as stated."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        wide, first, second = w.rng.uniform(-1.0, 1.0, 3)
        w.memory["s"] = rig.mu_s + a * gap * (0.19 * wide + 0.08 * first)
        w.memory["k"] = rig.mu_k + a * gap * (0.07 * wide + 0.03 * second)

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Muth 1960 (a level that remembers, and fresh scatter on top of it)")
def correlated_below_scatter(w: World, a: float) -> None:
    """An eighth of the level is forgotten with each slip; a quarter of the variance is fresh."""
    keep = 7 / 8
    w.memory["level"] = float(w.rng.standard_normal())

    def turn(s: State | None) -> None:
        kick, fresh = w.rng.standard_normal(2)
        w.memory["level"] = keep * w.memory["level"] + np.sqrt(1.0 - keep**2) * kick
        w.memory["factor"] = np.sqrt(0.75) * w.memory["level"] + 0.5 * fresh

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * w.memory["factor"])
