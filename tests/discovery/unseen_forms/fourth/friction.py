"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Feeny and Moon 1994 (hyperbolic secant)")
def weakening_secant(w: World, a: float) -> None:
    weaken(w, lambda v: 1.0 / np.cosh(v / (0.3 * w.nominal.peak_speed)), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Kragelskii and Vinogradova 1962 ((a + b v) exp(-c v) + d)")
def weakening_kragelskii(w: World, a: float) -> None:
    slow = 0.15 * w.nominal.peak_speed
    weaken(w, lambda v: (1.0 + v / slow) * np.exp(-v / slow), 0.4 * a * w.nominal.gap)


@form("viscous_friction", source="Sisko 1958 (a Newtonian part and a power of the speed)")
def viscous_sisko(w: World, a: float) -> None:
    viscous(w, lambda u: 0.5 * u + 0.5 * np.sqrt(u), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("viscous_friction", source="Bair and Winer 1979 (a film of limited shear stress)")
def viscous_limited_stress(w: World, a: float) -> None:
    viscous(w, lambda u: 1.09 * (1.0 - np.exp(-2.5 * u)), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Tian et al. 2020 (in proportion to a short time of rest, then no more)", designs=SEVERAL)
def dwell_linear(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, w.nominal.period, 0.3 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.minimum(s.dwell / first, 1.8) - 1.0)


@form("frictional_lag", source="Blanpied, Marone, Lockner, Byerlee and King 1998 (two distances)")
def lag_two_distances(w: World, a: float) -> None:
    distance = 0.03 * w.nominal.slip_length
    lag(w, lambda s, t: a * (0.6 * np.exp(-s / distance) + 0.4 * np.exp(-s / (6.0 * distance))))


@form("frictional_lag", source="Kohlrausch 1854 (stretched exponential in time)")
def lag_stretched(w: World, a: float) -> None:
    tau = 0.15 / w.nominal.pulsation
    lag(w, lambda s, t: a * np.exp(-np.sqrt(max(t, 0.0) / tau)))


@form(
    "direction_asymmetry",
    source="Swevers, Al-Bender, Ganseman and Prajogo 2000 (a Stribeck curve for each direction)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_stribeck_curves(w: World, a: float) -> None:
    base, slow = w.rig.mu_k, 0.6 * w.nominal.peak_speed
    w.mu_k = lambda s: base * (1.0 + (0.1 * a * np.exp(-abs(s.w) / slow) if s.direction < 0 else 0.0))


@form(
    "load_dependence",
    source="Whitehead 1950 (a film that holds light loads and breaks under heavy ones)",
    designs=SEVERAL,
    loads=True,
)
def load_breaks_the_film(w: World, a: float) -> None:
    u = w.normal_force / w.nominal.normal_force
    by_load(w, 1.0 + 0.16 * a * (1.0 / (1.0 + u ** (-1.0 / 0.3)) - 0.5))


@form(
    "load_dependence",
    source="Derjaguin 1934; Gao, Luedtke, Gourdon, Ruths, Israelachvili and Landman 2004 (a constant adhesion)",
    designs=SEVERAL,
    loads=True,
)
def load_and_adhesion(w: World, a: float) -> None:
    u = w.normal_force / w.nominal.normal_force
    by_load(w, (1.0 + 0.2 * a / u) / (1.0 + 0.2 * a))


@form("presliding_compliance", source="Ramberg and Osgood 1943 (straight, then a power)")
def presliding_ramberg_osgood(w: World, a: float) -> None:
    share = np.linspace(0.0, 1.1, 2201)
    z = (share + 0.8 * share**5) / 1.8
    if a > 0.0:
        length = 0.05 * a * w.nominal.slip_length
        contact(w, lambda u: float(np.interp(u, z, share)), lambda q: float(np.interp(q, share, z)), length)


@form("position_dependent_friction", source="Etsion 2005 (textured zones between plain ones)")
def position_zones(w: World, a: float) -> None:
    length = 8.9 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.08 * a * np.clip(2.5 * np.sin(2 * np.pi * (s.travel - s.x) / length + 0.9) - 0.8, -1.0, 1.0))


@form("position_dependent_friction", source="Waterhouse 1972 (a fretting scar in mid-stroke)", also_one=(UNKNOWN,))
def position_scar(w: World, a: float) -> None:
    """At one operating point the place in the stroke and the distance slid say the same."""
    middle, width = w.nominal.reach - 0.5 * w.nominal.slip_length, 0.12 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.15 * a * np.exp(-(((s.x - middle) / width) ** 2)))


@form("friction_drift", source="Suh and Sin 1981 (the stages of running-in)", also_one=("distance_drift",))
def drift_in_stages(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period
    course = PchipInterpolator([0.0, 0.08, 0.25, 0.45, 0.7, 1.0], [0.0, 0.01, 0.09, 0.11, 0.08, 0.07])
    scaled(w, lambda s: 1.0 + a * course(np.minimum(s.t / span, 1.0)))


@form(
    "distance_drift",
    source="Avrami 1939; Rigney and Karthikeyan 2010 (a transfer layer that spreads from nuclei)",
    also_one=("friction_drift",),
)
def distance_avrami(w: World, a: float) -> None:
    length = 12.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.1 * a * (1.0 - np.exp(-((s.slid / length) ** 2))))


@form("temperature_drift", source="Ludema and Tabor 1966 (a polymer's greatest loss at a temperature)")
def temperature_peak(w: World, a: float) -> None:
    warm(w)
    scaled(w, lambda s: 1.0 + 0.1 * a * np.exp(-(((w.temperature(s.t) - 23.5) / 2.0) ** 2)))


@form("random_coefficients", source="Gumbel 1958 (the strongest of many junctions holds)")
def scatter_gumbel(w: World, a: float) -> None:
    rig, sigma = w.rig, 0.09 * a * w.nominal.gap
    each_stick(w, lambda s: w.memory.update(s=rig.mu_s + sigma * np.sqrt(6.0) / np.pi * (w.rng.gumbel() - np.euler_gamma)))
    w.mu_s = lambda s: w.memory["s"]


@form("random_coefficients", source="Engle 1982; Blau 2005 (scatter that grows as the surface roughens)")
def scatter_grows(w: World, a: float) -> None:
    rig, gap, span = w.rig, w.nominal.gap, 40.0 * w.nominal.period

    def draw(s: State | None) -> None:
        size = a * gap * min(0.3 + (s.t / span if s else 0.0), 1.2)
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.09 * size * z[0], rig.mu_k + 0.06 * size * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


def shot_noise(rng: np.random.Generator, duration: float, rate: float, decay_time: float):
    """Return Poisson arrivals of unit steps that decay, less their mean, over their standard deviation, as a function of t."""
    h = decay_time / 200.0
    counts = rng.poisson(rate * h, int(duration / h) + 2020)
    level = lfilter([1.0], [1.0, -np.exp(-1.0 / 200.0)], counts)[2000:]  # ten decay times to settle
    grid = h * np.arange(level.size)
    mean, sd = rate * decay_time, np.sqrt(0.5 * rate * decay_time)
    return lambda t: (np.interp(t, grid, level) - mean) / sd


@form("correlated_coefficients", source="Campbell 1909; Rice 1944 (shot noise: droplets that arrive and are rubbed off)")
def correlated_shots(w: World, a: float) -> None:
    z = shot_noise(w.rng, w.duration, 0.5 / w.nominal.period, 4.0 * w.nominal.period)
    scaled(w, lambda s: 1.0 - 0.04 * a * z(s.t))
