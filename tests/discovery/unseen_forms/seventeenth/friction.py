"""Effects of friction that have a name, as laboratories meet them."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, steady_noise, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Tustin 1947 (friction falls exponentially with the speed)")
def weakening_of_tustin(w: World, a: float) -> None:
    """An exponential of the speed, of which 1/e is left at a fifth of the highest one."""
    speed = 0.2 * w.nominal.peak_speed
    weaken(w, lambda v: np.exp(-v / speed), 0.5 * a * w.nominal.gap)


@form("viscous_friction", source="Petroff 1883 (a full film that is sheared: in proportion to the speed)")
def viscous_of_petroff(w: World, a: float) -> None:
    """A straight line through nothing; at the highest speed 0.4 of the fall of friction."""
    viscous(w, lambda u: u, 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form(
    "dwell_ageing", source="Dieterich 1972 (static friction grows with the logarithm of the time of contact)", designs=SEVERAL
)
def dwell_of_dieterich(w: World, a: float) -> None:
    """The logarithm of one more than the time of rest over a twentieth of a cycle; as stated after one cycle."""
    base, short, size = w.rig.mu_s, 0.05 * w.nominal.period, 0.25 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.log1p(s.dwell / short) - np.log1p(20.0))


@form("frictional_lag", source="Ruina 1983 (the slip law after a jump of the speed: an exponential of the slip)")
def lag_of_ruina(w: World, a: float) -> None:
    """From near the break-away level to the sliding one, of which 1/e is left after 0.07 of a slip."""
    distance = 0.07 * w.nominal.slip_length
    lag(w, lambda s, t: 0.9 * a * np.exp(-s / distance))


@form(
    "direction_asymmetry",
    source="O'Donoghue 1996 (pigs in pipelines: lips that point backwards are bent over and pressed on)",
    designs=SEVERAL,
    reversed=True,
    rig="pig",
)
def asymmetry_of_bent_lips(w: World, a: float) -> None:
    """As stated forwards; backwards break-away is 9 % more, and sliding 12 %."""
    rig, other = w.rig, w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (0.09 * a if other else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (0.12 * a if s.direction < 0.0 else 0.0))


@form(
    "load_dependence",
    source="Schallamach 1952 (rubber whose round asperities are flattened as Hertz has it)",
    designs=SEVERAL,
    loads=True,
    rig="pig",
)
def load_of_schallamach(w: World, a: float) -> None:
    """Both coefficients fall as the cube root of the load."""
    rig, factor = w.rig, (w.normal_force / w.nominal.normal_force) ** (-a / 3.0)
    w.mu_s, w.mu_k = lambda s: rig.mu_s * factor, lambda s: rig.mu_k * factor


@form("presliding_compliance", source="Kondner 1963 (soil in shear: a hyperbola)", rig="caisson")
def presliding_of_kondner(w: World, a: float) -> None:
    """It softens from the start, to a ninth of the first stiffness at half the way and a twenty-fifth where it lets go."""
    if a > 0.0:
        contact(
            w, lambda u: 5.0 * u / (1.0 + 4.0 * u), lambda share: share / (5.0 - 4.0 * share), 0.1 * a * w.nominal.slip_length
        )


@form("position_dependent_friction", source="Popovic and Goldenberg 1998 (friction along the way as a Fourier series)")
def position_of_popovic(w: World, a: float) -> None:
    """A wave of nearly nine slips, and half as much of half its length."""
    turn = 8.7 * w.nominal.slip_length

    def wave(s: State):
        u = 2 * np.pi * (s.travel - s.x) / turn
        return np.cos(u + 0.4) + 0.5 * np.cos(2.0 * u + 1.9)

    scaled(w, lambda s: 1.0 + 0.07 * a * wave(s))


@form("friction_drift", source="Blau 1989 (break-in: it falls fast at first, and settles)", also_one=("distance_drift",))
def drift_of_breaking_in(w: World, a: float) -> None:
    """Down by an eighth in the end, as an exponential of the time, over sixteen cycles."""
    tau = 16.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.125 * a * np.expm1(-s.t / tau))


@form(
    "distance_drift",
    source="Holmberg and Matthews 2009 (a thin coating that is worn through: low, then high)",
    also_one=("friction_drift",),
)
def distance_of_a_worn_coating(w: World, a: float) -> None:
    """A logistic curve of the distance: most of the rise, by a seventh, falls between the tenth and the twenty-sixth slip."""
    slip = w.nominal.slip_length

    def bare(n):
        return 1.0 / (1.0 + np.exp(-(n - 18.0) / 3.5)) - 1.0 / (1.0 + np.exp(18.0 / 3.5))

    scaled(w, lambda s: 1.0 + 0.14 * a * bare(s.slid / slip))


@form("temperature_drift", source="Reynolds 1886 (an oil that thins: an exponential of the temperature)")
def temperature_of_thinning_oil(w: World, a: float) -> None:
    """Each degree takes 1.3 % of what is left; as stated at 20 degC."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: np.exp(-0.013 * a * (celsius(s.t) - 20.0)))


@form("random_coefficients", source="Rabinowicz, Rightmire, Tedholm and Williams 1955 (the statistical nature of friction)")
def scatter_of_rabinowicz(w: World, a: float) -> None:
    """Normal, each slip anew, and independent at break-away and in sliding."""
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = np.clip(w.rng.standard_normal(2), -3.0, 3.0)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.12 * a * gap * z[0], rig.mu_k + 0.05 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Uhlenbeck and Ornstein 1930 (a level that is kicked and comes back)")
def correlated_of_uhlenbeck(w: World, a: float) -> None:
    """Both coefficients wander together, and forget all but 1/e in five cycles."""
    level = steady_noise(w.rng, w.duration, 5.0 * w.nominal.period)
    scaled(w, lambda s: 1.0 + 0.045 * a * level(s.t))
