"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Spikes and Olver 2003 (asperities and a film share the load: a power of the film's height)")
def weakening_of_shared_load(w: World, a: float) -> None:
    """The film grows as the speed to 0.67; what asperities carry is (1 + height) to -2."""
    slow = 0.15 * w.nominal.peak_speed
    weaken(w, lambda v: (1.0 + (v / slow) ** 0.67) ** -2, 0.7 * a * w.nominal.gap)


@form("viscous_friction", source="Nahme 1940; Gruntfest 1963 (a film that thins as it heats itself)")
def viscous_of_a_film_that_heats(w: World, a: float) -> None:
    """A line at low speed, that bends and nearly levels off at the highest."""
    heat = 1.2

    def stress(u: float) -> float:
        return float(np.arcsinh(heat * u) / np.sqrt(1.0 + (heat * u) ** 2))

    viscous(w, lambda u: stress(u) / stress(1.0), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Stefan 1874; Moore 1965 (a film that is squeezed out while the box rests)", designs=SEVERAL)
def dwell_squeezes_out(w: World, a: float) -> None:
    """What is lacking falls as the height of the film, the inverse root of 1 + time."""
    base, tau, size = w.rig.mu_s, 0.3 * w.nominal.period, 1.2 * a * w.nominal.gap
    usual = (1.0 + 1.0 / 0.3) ** -0.5
    w.mu_s = lambda s: base + size * (usual - (1.0 + s.dwell / tau) ** -0.5)


@form("frictional_lag", source="Lu, Teng, Ye and Jiang 2005 (sheets off concrete: an exponential of the root of slip)")
def lag_of_glued_sheets(w: World, a: float) -> None:
    """Steep at first, with a long tail."""
    length = 0.03 * w.nominal.slip_length
    lag(w, lambda s, t: a * np.exp(-np.sqrt(s / length)))


@form(
    "direction_asymmetry",
    source="Euler 1750; Patton 1966 (facets that lean: their angle adds to that of friction, or is taken off)",
    designs=SEVERAL,
    reversed=True,
    rig="crane",
)
def asymmetry_of_leaning_facets(w: World, a: float) -> None:
    """Neither direction is as stated; break-away and sliding move together, by the tangent of a sum of angles."""
    rig, slope = w.rig, 0.25 * a * w.nominal.gap

    def up(mu: float, side: float) -> float:
        return (mu + side * slope) / (1.0 - side * mu * slope)

    w.mu_s = lambda s: up(rig.mu_s, float(np.sign(w.belt_velocity)))
    w.mu_k = lambda s: up(rig.mu_k, float(s.direction))


@form(
    "load_dependence",
    source="Kumar, Whittaker and Constantinou 2015 (pendulum bearings: 0.7 to a power in proportion to the pressure)",
    designs=SEVERAL,
    loads=True,
)
def load_of_a_pendulum_bearing(w: World, a: float) -> None:
    """A quarter less under twice the load."""
    by_load(w, 0.7 ** (0.8 * a * (w.normal_force / w.nominal.normal_force - 1.0)))


@form("presliding_compliance", source="Fromm 1927; Pacejka 2006 (a brush under a parabola of pressure: a cubic)")
def presliding_brush(w: World, a: float) -> None:
    """Three times as stiff at first as on the whole."""
    if a > 0.0:
        contact(
            w,
            lambda u: 1.0 - max(1.0 - u, 0.0) ** 3,
            lambda share: 1.0 - (1.0 - share) ** (1 / 3),
            0.09 * a * w.nominal.slip_length,
        )


@form("position_dependent_friction", source="Whitehouse 1994 (a belt turned on a lathe: parabolas that meet in cusps)")
def position_of_turning_marks(w: World, a: float) -> None:
    """Most friction at the cusps; the mean is as stated."""
    pitch = 5.3 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.14 * a * ((2.0 * np.mod((s.travel - s.x) / pitch + 0.2, 1.0) - 1.0) ** 2 - 1 / 3))


@form(
    "friction_drift",
    source="Elovich and Zhabrova 1939 (vapour that the surfaces take up: a logarithm of time)",
    also_one=("distance_drift",),
)
def drift_of_adsorbed_vapour(w: World, a: float) -> None:
    """By 0.13 of friction within sixty cycles, half of it within eleven."""
    tau = 2.0 * w.nominal.period
    scaled(w, lambda s: 1.0 - 0.038 * a * np.log1p(s.t / tau))


@form(
    "distance_drift",
    source="Weibull 1951 (run-in by asperities that last over very different ways: a stretched exponential)",
    also_one=("friction_drift",),
)
def distance_of_unequal_asperities(w: World, a: float) -> None:
    """Fast at first; the last of the change takes hundreds of slips."""
    length = 12.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.16 * a * (1.0 - np.exp(-((s.slid / length) ** 0.6))))


@form("temperature_drift", source="Dash, Fu and Wettlaufer 1995 (wax that melts at its surface first: a cube root)")
def temperature_below_melting(w: World, a: float) -> None:
    """The bulk melts at 31 degC; friction falls as the film grows, steeper and steeper as that comes near."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 - 0.4 * a * (1.0 - ((31.0 - celsius(s.t)) / 11.0) ** (1 / 3)))


@form("random_coefficients", source="Jaynes 1957 (only a mean loss is known: exponential, from a ceiling down)")
def scatter_below_a_ceiling(w: World, a: float) -> None:
    """Spots of grease take friction away, from each coefficient by itself; the means are as stated."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = 1.0 - np.minimum(w.rng.exponential(1.0, 2), 4.5)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.09 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Yule 1927 (second order from slip to slip: sways, as sunspots do)")
def correlated_that_sways(w: World, a: float) -> None:
    """About eleven slips to a sway; after one, a sixteenth of it is remembered."""
    past = [0.0, 0.0]
    sd = np.sqrt(1.6 / (0.4 * (1.6**2 - 1.3**2)))

    def turn(s: State | None) -> None:
        for _ in range(200 if s is None else 1):
            past[:] = 1.3 * past[0] - 0.6 * past[1] + w.rng.standard_normal() / sd, past[0]

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * past[0])
