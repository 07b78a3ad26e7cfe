"""Effects of friction that have a name, in shapes that laboratories meet."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, steady_noise, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Tustin 1947; Bo and Pavelescu 1982 (a slideway in mixed lubrication: an exponential)")
def weakening_exponential(w: World, a: float) -> None:
    """It falls by 1/e with each 0.25 of the highest speed."""
    slow = 0.25 * w.nominal.peak_speed
    weaken(w, lambda v: np.exp(-v / slow), 0.55 * a * w.nominal.gap)


@form("viscous_friction", source="Petroff 1883 (an oil film of even thickness: in proportion to the speed)")
def viscous_of_an_oil_film(w: World, a: float) -> None:
    """A straight line through nothing at rest."""
    viscous(w, lambda u: u, 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Dieterich 1972 (a logarithm of the time of rest, beyond a first time)", designs=SEVERAL)
def dwell_logarithmic(w: World, a: float) -> None:
    """Level up to about a tenth of a cycle, then as much with each doubling; as stated after one cycle."""
    base, first, size = w.rig.mu_s, 0.1 * w.nominal.period, 0.22 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.log1p(s.dwell / first) - np.log(11.0))


@form("frictional_lag", source="Mizoguchi, Hirose, Shimamoto and Fukuyama 2007 (gouge: an exponential of the slip)")
def lag_to_a_twentieth(w: World, a: float) -> None:
    """A twentieth of the fall is left after 0.3 of a slip."""
    distance = 0.3 * w.nominal.slip_length
    lag(w, lambda s, t: 0.9 * a * 0.05 ** (s / distance))


@form(
    "direction_asymmetry",
    source="Canudas de Wit, Astrom and Braun 1987 (a drive whose levels are identified for each direction)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_two_levels(w: World, a: float) -> None:
    """Break-away and sliding alike: a twentieth less than stated one way, and a twentieth more the other way."""
    rig, other = w.rig, -float(np.sign(w.belt_velocity))
    w.mu_s = lambda s: rig.mu_s * (1.0 + 0.05 * a * other)
    w.mu_k = lambda s: rig.mu_k * (1.0 - 0.05 * a * s.direction)


@form(
    "load_dependence",
    source="Pascoe and Tabor 1956 (crossed polymer cylinders: a power of the load)",
    designs=SEVERAL,
    loads=True,
)
def load_by_a_power(w: World, a: float) -> None:
    """Both coefficients as the load to the power -0.25."""
    rig, factor = w.rig, (w.normal_force / w.nominal.normal_force) ** (-0.25 * a)
    w.mu_s, w.mu_k = lambda s: rig.mu_s * factor, lambda s: rig.mu_k * factor


@form("presliding_compliance", source="Jenkins 1962 (a spring in series with a slider)", rig="organ")
def presliding_of_a_jenkins_element(w: World, a: float) -> None:
    """Straight up to break-away, over 0.12 of a slip."""
    if a > 0.0:
        contact(w, lambda u: u, lambda share: share, 0.12 * a * w.nominal.slip_length)


@form("position_dependent_friction", source="Popovic and Goldenberg 1998 (a Fourier series of the position, from spectra)")
def position_of_three_harmonics(w: World, a: float) -> None:
    """Once, twice and three times a turn of the belt, with phases of their own."""
    turn = 9.0 * w.nominal.slip_length

    def wave(s: State):
        u = 2 * np.pi * (s.travel - s.x) / turn
        return np.cos(u + 0.4) + 0.5 * np.cos(2.0 * u - 1.1) + 0.3 * np.cos(3.0 * u + 2.0)

    scaled(w, lambda s: 1.0 + 0.07 * a * wave(s))


@form(
    "friction_drift",
    source="Bittencourt, Wernholt, Sander-Tavallaey and Brogardh 2010 (a greased axis warms up to its steady state)",
    also_one=("distance_drift",),
)
def drift_of_a_warming_guide(w: World, a: float) -> None:
    """Down by 0.15 in the end, an exponential of time; 1/e of it is left after 15 cycles."""
    tau = 15.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.15 * a * np.expm1(-s.t / tau))


@form(
    "distance_drift",
    source="Suh and Sin 1981 (debris that is trapped and ploughs: low at first, then up to a level)",
    also_one=("friction_drift",),
)
def distance_of_ploughing_debris(w: World, a: float) -> None:
    """An S along the distance slid, steepest after about ten slips; up by 0.16 in the end."""
    far = 14.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.16 * a * np.expm1(-((s.slid / far) ** 2)))


@form("temperature_drift", source="Reynolds 1886 (the viscosity of an oil: an exponential of the temperature)")
def temperature_of_reynolds(w: World, a: float) -> None:
    """Friction falls by 2.2 % with each kelvin, and is as stated at 20 degC."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: np.exp(-0.022 * a * (celsius(s.t) - 20.0)))


@form("random_coefficients", source="Rabinowicz, Rightmire, Tedholm and Williams 1955 (normal, anew in each measurement)")
def scatter_normal(w: World, a: float) -> None:
    """Both coefficients are normal and know nothing of each other; values beyond three deviations are not met."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        first, second = np.clip(w.rng.standard_normal(2), -3.0, 3.0)
        w.memory["s"] = rig.mu_s + 0.13 * a * gap * first
        w.memory["k"] = rig.mu_k + 0.06 * a * gap * second

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Uhlenbeck and Ornstein 1930 (a level that wanders, and is drawn back)")
def correlated_ornstein_uhlenbeck(w: World, a: float) -> None:
    """A function of time, one for both coefficients; 1/e of the correlation is left after six cycles."""
    level = steady_noise(w.rng, w.duration, 6.0 * w.nominal.period)
    scaled(w, lambda s: 1.0 + 0.05 * a * level(s.t))
