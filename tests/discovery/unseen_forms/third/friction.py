"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, steady_noise, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Brockley, Cameron and Potter 1967 (a straight fall, then a plateau)")
def weakening_straight(w: World, a: float) -> None:
    weaken(w, lambda v: max(1.0 - v / (0.5 * w.nominal.peak_speed), 0.0), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Rice 2006; Goldsby and Tullis 2011 (flash heating: as 1/v beyond a speed)")
def weakening_flash(w: World, a: float) -> None:
    onset = 0.2 * w.nominal.peak_speed
    weaken(w, lambda v: min(onset / max(v, 1e-12), 1.0), 0.45 * a * w.nominal.gap)


@form("velocity_weakening", source="Popp and Stelter 1990 (a hyperbola and a rise)")
def weakening_with_a_rise(w: World, a: float) -> None:
    top = w.nominal.peak_speed
    weaken(w, lambda v: 1.0 / (1.0 + 6.0 * v / top) + 0.12 * (v / top) ** 2, 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Carreau 1972 (shear thinning)")
def viscous_carreau(w: World, a: float) -> None:
    viscous(w, lambda u: 1.7 * u * (1.0 + (4.0 * u) ** 2) ** -0.2, 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("viscous_friction", source="Lu, Khonsari and Gelinck 2006 (lift-off of a film)", also_one=("quadratic_damping",))
def viscous_from_lift_off(w: World, a: float) -> None:
    viscous(w, lambda u: 0.08 * np.logaddexp(0.0, (u - 0.25) / 0.08), 0.5 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Bureau, Baumberger and Caroli 2002 (sigmoid in the logarithm of time)", designs=SEVERAL)
def dwell_sigmoid(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, 0.8 * w.nominal.period, 0.5 * a * w.nominal.gap
    usual = 1.0 / (1.0 + 0.64)
    w.mu_s = lambda s: base + size * (s.dwell**2 / (s.dwell**2 + first**2) - usual)


@form("dwell_ageing", source="Liu and Szlufarska 2012 (two kinds of bonds)", designs=SEVERAL)
def dwell_bonds(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, w.nominal.period, 0.6 * a * w.nominal.gap

    def bonded(t):
        return 0.5 * (1.0 - np.exp(-t / (0.3 * first))) + 0.5 * (1.0 - np.exp(-t / (2.0 * first)))

    w.mu_s = lambda s: base + size * (bonded(s.dwell) - bonded(first))


@form("frictional_lag", source="Bizzarri 2010 (cosine in the slip)")
def lag_cosine(w: World, a: float) -> None:
    distance = 0.3 * w.nominal.slip_length
    lag(w, lambda s, t: 0.5 * a * (1.0 + np.cos(np.pi * min(s / distance, 1.0))))


@form("frictional_lag", source="Barnes 1997 (thixotropy, hyperbolic in time)")
def lag_hyperbolic_in_time(w: World, a: float) -> None:
    tau = 0.25 / w.nominal.pulsation
    lag(w, lambda s, t: a / (1.0 + t / tau) ** 2)


@form("direction_asymmetry", source="Spurr 1961 (a pad that energises itself one way)", designs=SEVERAL, reversed=True)
def asymmetry_of_a_tilted_pad(w: World, a: float) -> None:
    rig, tangent = w.rig, 0.12 * a / w.nominal.mu_s
    side = np.sign(w.belt_velocity)
    w.mu_s = lambda s: rig.mu_s / (1.0 + side * rig.mu_s * tangent)
    w.mu_k = lambda s: rig.mu_k / (1.0 + s.direction * rig.mu_k * tangent)


@form(
    "direction_asymmetry",
    source="Hu, Nirody, Scott and Shelley 2009 (scales: starts easier one way, slides harder)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_scales(w: World, a: float) -> None:
    rig, back = w.rig, w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 - (0.04 * a if back else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (0.08 * a if s.direction < 0 else 0.0))


def by_load(world: World, factor: float) -> None:
    """Multiply both coefficients."""
    rig = world.rig
    world.mu_s = lambda s: rig.mu_s * factor
    world.mu_k = lambda s: rig.mu_k * factor


@form("load_dependence", source="Johnson, Kendall and Roberts 1971 (sphere that adheres)", designs=SEVERAL, loads=True)
def load_of_an_adhering_sphere(w: World, a: float) -> None:
    def area(u: float) -> float:
        return (u + 0.4 + 2.0 * np.sqrt(0.2 * u + 0.04)) ** (2 / 3) / u

    by_load(w, (area(w.normal_force / w.nominal.normal_force) / area(1.0)) ** (0.7 * a))


@form("load_dependence", source="Bowers and Murphy 1967 (Amontons below a load, plastic above)", designs=SEVERAL, loads=True)
def load_with_a_kink(w: World, a: float) -> None:
    by_load(w, max(w.normal_force / w.nominal.normal_force, 1.0) ** (-0.4 * a))


@form("presliding_compliance", source="Kondner 1963; Duncan and Chang 1970 (hyperbola)")
def presliding_hyperbolic(w: World, a: float) -> None:
    if a > 0.0:
        contact(w, lambda u: 1.3 * u / (0.3 + u), lambda share: 0.3 * share / (1.3 - share), 0.05 * a * w.nominal.slip_length)


@form("presliding_compliance", source="Lampaert, Al-Bender and Swevers 2003 (three Maxwell-slip elements)")
def presliding_maxwell_slip(w: World, a: float) -> None:
    z, force = np.array([0.0, 0.2, 0.5, 1.0, 2.0]), np.array([0.0, 0.5, 0.85, 1.0, 1.001])
    if a > 0.0:
        length = 0.05 * a * w.nominal.slip_length
        contact(w, lambda u: float(np.interp(u, z, force)), lambda share: float(np.interp(share, force, z)), length)


@form("position_dependent_friction", source="Bergman, Eriksson and Jacobson 1999 (a worn arc of the belt, rectified sine)")
def position_worn_arc(w: World, a: float) -> None:
    length = 10.7 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.14 * a * (np.maximum(np.sin(2 * np.pi * (s.travel - s.x) / length + 0.4), 0.0) - 0.318))


@form("position_dependent_friction", source="Prevost, Scheibert and Debregeas 2009 (ridges)")
def position_ridges(w: World, a: float) -> None:
    length = 6.7 * w.nominal.slip_length

    def factor(s: State):
        return 1.0 + 0.15 * a * (np.exp(5.0 * (np.cos(2 * np.pi * (s.travel - s.x) / length + 1.1) - 1.0)) - 0.184)

    scaled(w, factor)


@form("position_dependent_friction", source="Armstrong-Helouvry 1991 (waves of the guide, not of the belt)")
def position_along_the_guide(w: World, a: float) -> None:
    length = 0.45 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.1 * a * np.sin(2 * np.pi * s.x / length))


@form("friction_drift", source="Kragelskii, Dobychin and Kombalov 1982 (running-in that ends)", also_one=("distance_drift",))
def drift_then_plateau(w: World, a: float) -> None:
    span = 22.0 * w.nominal.period
    scaled(w, lambda s: 1.0 - 0.1 * a * np.minimum(s.t / span, 1.0))


@form("friction_drift", source="Czichos 1978 (a contamination that passes)", also_one=("distance_drift",))
def drift_passes(w: World, a: float) -> None:
    middle, width = 15.0 * w.nominal.period, 5.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.12 * a * np.exp(-(((s.t - middle) / width) ** 2)))


@form("distance_drift", source="Blau 1989 (logarithm of the distance)", also_one=("friction_drift",))
def distance_logarithmic(w: World, a: float) -> None:
    length = 4.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.06 * a * np.log1p(s.slid / length))


@form("distance_drift", source="Bowden and Tabor 1950 (a transfer film that builds up, under sliding alone)", designs=SEVERAL)
def distance_of_a_film(w: World, a: float) -> None:
    base, length = w.rig.mu_k, 9.0 * w.nominal.slip_length
    w.mu_k = lambda s: base * (1.0 - 0.15 * a * (1.0 - np.exp(-s.slid / length)))


@form("temperature_drift", source="Bowden and Hughes 1939 (a film that melts above a temperature)")
def temperature_melts(w: World, a: float) -> None:
    warm(w)
    scaled(w, lambda s: 1.0 - 0.025 * a * np.maximum(w.temperature(s.t) - 23.0, 0.0))


@form("temperature_drift", source="Marton and Lantos 2007 (the contact warms later than the gauge)")
def temperature_comes_late(w: World, a: float) -> None:
    warm(w)
    late = 1.5 * w.nominal.period
    scaled(w, lambda s: 1.0 - 0.012 * a * (w.temperature(np.maximum(s.t - late, 0.0)) - 20.0))


@form("random_coefficients", source="Greenwood and Williamson 1966 (sums of exponential contacts: gamma, sliding alone)")
def scatter_gamma(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap
    each_stick(w, lambda s: w.memory.update(k=rig.mu_k + 0.10 * a * gap * (w.rng.gamma(2.0) - 2.0) / np.sqrt(2.0)))
    w.mu_k = lambda s: min(w.memory["k"], rig.mu_s)


@form("random_coefficients", source="Feller 1966 (arcsine law: two extremes and all between)")
def scatter_arcsine(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s) -> None:
        z = np.sqrt(2.0) * np.cos(2 * np.pi * w.rng.random(2))
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.08 * a * gap * z[0], rig.mu_k + 0.05 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("random_coefficients", source="Rabinowicz, Rightmire, Tedholm and Williams 1955 (what holds more slides with less)")
def scatter_opposed(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap
    each_stick(w, lambda s: w.memory.update(z=w.rng.standard_normal()))
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.06 * a * gap * w.memory["z"], lambda s: rig.mu_k - 0.04 * a * gap * w.memory["z"]


@form("correlated_coefficients", source="Feller 1951 (square-root process)")
def correlated_one_sided(w: World, a: float) -> None:
    z, y = (steady_noise(w.rng, w.duration, 8.0 * w.nominal.period) for _ in range(2))
    scaled(w, lambda s: 1.0 + 0.035 * a * (0.5 * (z(s.t) ** 2 + y(s.t) ** 2) - 1.0))


@form("correlated_coefficients", source="Box and Jenkins 1970 (first-order autoregression from slip to slip)")
def correlated_slip_by_slip(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s) -> None:
        level = w.memory.get("z", w.rng.standard_normal())
        w.memory["z"] = 0.85 * level + np.sqrt(1.0 - 0.85**2) * w.rng.standard_normal()

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: rig.mu_s + 0.09 * a * gap * w.memory["z"], lambda s: rig.mu_k + 0.05 * a * gap * w.memory["z"]
