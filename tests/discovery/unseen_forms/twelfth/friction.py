"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import erf, erfinv

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Greenwood and Williamson 1966 (evenly spread heights that a film lifts: a power 2.5)")
def weakening_of_even_heights(w: World, a: float) -> None:
    """The film grows with the speed; asperities carry less and less, and nothing from 0.8 of the highest speed on."""
    lifts = 0.8 * w.nominal.peak_speed
    weaken(w, lambda v: max(1.0 - v / lifts, 0.0) ** 2.5, 0.55 * a * w.nominal.gap)


@form("viscous_friction", source="Quemada 1978 (a crowded suspension: the square of a ratio of roots)")
def viscous_of_a_suspension(w: World, a: float) -> None:
    """Grains cling together in slow flow, and let go as it quickens: four times as thick at rest as at the highest speed."""

    def stress(u: float) -> float:
        root = np.sqrt(u / 0.05)
        return float(u * ((1.0 + root) / (0.45 + root)) ** 2)

    viscous(w, lambda u: stress(u) / stress(1.0), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing",
    source="Terzaghi 1925; Sivaram and Swamee 1977 (a wet lining that drains while the box rests: one curve for all times)",
    designs=SEVERAL,
)
def dwell_drains(w: World, a: float) -> None:
    """Water carries a part of the load until it has left: as the root of time at first, exponentially at the end."""
    base, tau, size = w.rig.mu_s, 1.2 * w.nominal.period, 0.8 * a * w.nominal.gap

    def drained(dwell):
        root = np.sqrt(4.0 / np.pi * dwell / tau)
        return root / (1.0 + root**5.6) ** 0.179

    usual = drained(w.nominal.period)
    w.mu_s = lambda s: base + size * (drained(s.dwell) - usual)


@form("frictional_lag", source="Reinhardt 1984 (concrete in tension: one less a power 0.31 of the way)")
def lag_of_a_steep_power(w: World, a: float) -> None:
    """Four fifths of the gap are left at first; half of them go within a ninth of the way, which is 0.45 of a slip."""
    end = 0.45 * w.nominal.slip_length
    lag(w, lambda s, t: 0.8 * a * max(1.0 - (s / end) ** 0.31, 0.0))


@form(
    "direction_asymmetry",
    source="Adams, Briscoe and Wee 1990 (fibres against their scales: the difference is less under more load)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_loaded_fibres(w: World, a: float) -> None:
    """As stated along the scales; harder against them, by a share that falls as the cube root of the load."""
    rig, more = w.rig, 0.12 * a * (w.normal_force / w.nominal.normal_force) ** (-1 / 3)
    against = w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (more if against else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (more if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Barton and Choubey 1977 (a rough joint: an angle that falls with the logarithm of the load, and its tangent)",
    designs=SEVERAL,
    loads=True,
)
def load_of_a_rough_joint(w: World, a: float) -> None:
    """Asperities that ride up are sheared off: 7 degrees less for ten times the load, of break-away and sliding alike."""
    rig, angle = w.rig, np.deg2rad(7.0) * a * np.log10(w.normal_force / w.nominal.normal_force)
    w.mu_s = lambda s: float(np.tan(np.arctan(rig.mu_s) - angle))
    w.mu_k = lambda s: float(np.tan(np.arctan(rig.mu_k) - angle))


@form("presliding_compliance", source="Segalman and Starr 2008 (a backbone of normally spread strengths: an error function)")
def presliding_error_function(w: World, a: float) -> None:
    """Straight at first, and level when nearly all junctions have let go."""
    if a > 0.0:
        contact(
            w,
            lambda u: 1.05 * float(erf(u)),
            lambda share: float(erfinv(share / 1.05)),
            0.09 * a * w.nominal.slip_length,
        )


@form("position_dependent_friction", source="Majumdar and Bhushan 1990 (a fractal belt: lengths and sizes in a geometric row)")
def position_of_a_fractal_belt(w: World, a: float) -> None:
    """Six waves, each two thirds as long as the one before; nothing ever repeats."""
    longest, phases = 9.0 * w.nominal.slip_length, (0.4, 2.9, 5.1, 1.3, 3.8, 0.1)

    def profile(s: State):
        u = 2 * np.pi * (s.travel - s.x) / longest
        return sum(1.5 ** (-0.5 * n) * np.cos(1.5**n * u + phase) for n, phase in enumerate(phases))

    scaled(w, lambda s: 1.0 + 0.045 * a * profile(s))


@form(
    "friction_drift",
    source="Deal and Grove 1965 (an oxide that grows in proportion to time, and later as its root)",
    also_one=("distance_drift",),
    rig="jewel",
)
def drift_of_an_oxide(w: World, a: float) -> None:
    """Up by a seventh within sixty cycles."""
    tau = 10.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.055 * a * (np.sqrt(1.0 + 2.0 * s.t / tau) - 1.0))


@form(
    "distance_drift",
    source="Archard and Hirst 1956 (a round tip that is worn flat: its scar grows as the fourth root of the way)",
    also_one=("friction_drift",),
)
def distance_of_a_worn_tip(w: World, a: float) -> None:
    """Half of the change comes with the first four slips of sixty."""
    length = 60.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.14 * a * (s.slid / length) ** 0.25)


@form("temperature_drift", source="Sirota, King, Singer and Shao 1993 (a wax with a rotator phase: it softens in two steps)")
def temperature_of_a_rotator_phase(w: World, a: float) -> None:
    """Level between the steps, at 21.2 and 25.6 degC."""
    warm(w)
    celsius = vars(w)["temperature"]

    def step(s: State, at: float):
        return 0.5 * (1.0 + np.tanh((celsius(s.t) - at) / 0.35))

    scaled(w, lambda s: 1.0 - a * (0.06 * step(s, 21.2) + 0.07 * step(s, 25.6)))


@form("random_coefficients", source="Roberts 1966; Azzalini 1985 (the better of two spots holds: skew normal)")
def scatter_of_the_better_spot(w: World, a: float) -> None:
    """The box rests on two spots of normal scatter, and the one that bites more counts; the means are as stated."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = w.rng.standard_normal((2, 2)).max(0) - 1.0 / np.sqrt(np.pi)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.13 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Hurst 1951; Hosking 1981 (a long memory: correlations fall as a power)")
def correlated_over_long(w: World, a: float) -> None:
    """Chance summed to the order 0.35; the debris of long ago still counts."""
    order, reach = 0.35, 1500
    weights = np.cumprod(np.concatenate([[1.0], (np.arange(1, reach) - 1.0 + order) / np.arange(1, reach)]))
    weights = weights / np.sqrt(np.sum(weights**2))
    past = w.rng.standard_normal(reach)

    def turn(s: State | None) -> None:
        past[1:] = past[:-1].copy()
        past[0] = w.rng.standard_normal()
        w.memory["level"] = float(weights @ past)

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * w.memory["level"])
