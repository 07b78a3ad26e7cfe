"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Bo and Pavelescu 1982 (an exponential of a power of the speed, between 1/2 and 1)")
def weakening_of_bo_and_pavelescu(w: World, a: float) -> None:
    """The power is 3/4; at a sixth of the highest speed 1/e of it is left."""
    weaken(w, lambda v: np.exp(-((6.0 * v / w.nominal.peak_speed) ** 0.75)), 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Newton 1687; Couette 1890 (a film of oil of even thickness: in proportion to the speed)")
def viscous_of_newton(w: World, a: float) -> None:
    """Straight from nothing to two fifths of the fall of friction at the highest speed."""
    viscous(w, lambda u: u, 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing", source="Coulomb 1785 (oak on oak: a constant and the time of rest to the power of a fifth)", designs=SEVERAL
)
def dwell_of_coulomb(w: World, a: float) -> None:
    """As stated after one cycle; four fifths of the fall of friction grow with the fifth root of the rest."""
    base, usual, size = w.rig.mu_s, w.nominal.period, 0.8 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * ((s.dwell / usual) ** 0.2 - 1.0)


@form("frictional_lag", source="Rabinowicz 1951 (junctions give way over a length of their own: an exponential of the slip)")
def lag_over_a_junction(w: World, a: float) -> None:
    """From nearly break-away friction down to sliding friction; 1/e is left after 0.06 of a slip."""
    length = 0.06 * w.nominal.slip_length
    lag(w, lambda s, t: 0.9 * a * np.exp(-s / length))


@form(
    "direction_asymmetry",
    source="Canudas de Wit, Noel, Aubin and Brogliato 1991 (a pair of coefficients for each sign of the speed)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_two_pairs(w: World, a: float) -> None:
    """As stated one way; the other way break-away is a twelfth more and sliding a tenth."""
    rig, other = w.rig, w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (a / 12.0 if other else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (0.1 * a if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Hertz 1881; Bowden and Tabor 1950 (a round rider that yields elastically: the third root of the load)",
    designs=SEVERAL,
    loads=True,
)
def load_of_a_round_rider(w: World, a: float) -> None:
    """Both coefficients fall as the inverse third root of the load."""
    rig, factor = w.rig, (w.normal_force / w.nominal.normal_force) ** (-a / 3.0)
    w.mu_s, w.mu_k = lambda s: rig.mu_s * factor, lambda s: rig.mu_k * factor


@form("presliding_compliance", source="Canudas de Wit, Olsson, Astrom and Lischinsky 1995 (bristles: a straight spring)")
def presliding_of_bristles(w: World, a: float) -> None:
    """In proportion to the deflection up to break-away, which is 0.08 of a slip away from rest."""
    if a > 0.0:
        contact(w, lambda u: u, lambda share: share, 0.08 * a * w.nominal.slip_length)


@form("position_dependent_friction", source="Armstrong-Helouvry 1991 (a sine over each turn of the belt)")
def position_once_a_turn(w: World, a: float) -> None:
    """Seven per cent up and down over nine and a half slips of the belt."""
    turn = 9.6 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.07 * a * np.sin(2 * np.pi * (s.travel - s.x) / turn + 1.1))


@form("friction_drift", source="Blau 1989 (running-in: an exponential towards a lower level)", also_one=("distance_drift",))
def drift_of_running_in(w: World, a: float) -> None:
    """Down by an eighth; 1/e of that is left after sixteen cycles."""
    tau = 16.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.125 * a * np.expm1(-s.t / tau))


@form(
    "distance_drift",
    source="Suh and Sin 1981 (friction stays at first, rises as wear particles plough, and is steady)",
    also_one=("friction_drift",),
)
def distance_of_wear_particles(w: World, a: float) -> None:
    """Up by an eighth: next to nothing in the first four slips, most of it by the twenty-fifth."""
    length = 15.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.125 * a * np.expm1(-((s.slid / length) ** 2)))


@form("temperature_drift", source="Newcomb and Spurr 1967 (a lining that fades: straight with its temperature)")
def temperature_of_fade(w: World, a: float) -> None:
    """As stated at 20 degC; 1.6 per cent less for each degree more."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 - 0.016 * a * (celsius(s.t) - 20.0))


@form("random_coefficients", source="Ibrahim 1994 (each slip meets new asperities: normal, both coefficients together in part)")
def scatter_of_new_asperities(w: World, a: float) -> None:
    """A tenth and a twentieth of the fall of friction; their correlation is 0.6, and slips know nothing of one another."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        first, second = w.rng.standard_normal(2)
        w.memory["s"] = rig.mu_s + 0.1 * a * gap * first
        w.memory["k"] = rig.mu_k + 0.05 * a * gap * (0.6 * first + 0.8 * second)

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Box and Jenkins 1970 (an autoregression of the first order, from slip to slip)")
def correlated_by_autoregression(w: World, a: float) -> None:
    """Each slip keeps 0.85 of the level before it; a spread of four and a half per cent."""
    keep = 0.85
    w.memory["level"] = float(w.rng.standard_normal())

    def turn(s: State | None) -> None:
        w.memory["level"] = keep * w.memory["level"] + np.sqrt(1.0 - keep**2) * float(w.rng.standard_normal())

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.045 * a * w.memory["level"])
