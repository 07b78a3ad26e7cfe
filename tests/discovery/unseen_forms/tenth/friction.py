"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Savkoor 1966 (rubber: a bell in the logarithm of the speed)")
def weakening_of_rubber(w: World, a: float) -> None:
    """The bell's top is at a twentieth of the highest speed: but for the first moments of a slip friction falls."""
    top = 0.05 * w.nominal.peak_speed
    weaken(w, lambda v: np.exp(-0.5 * (np.log(max(v / top, 1.0e-9)) / 1.3) ** 2), 0.45 * a * w.nominal.gap)


@form("viscous_friction", source="Reiner 1930; Philippoff 1935 (thick at low stress, thin at high, a bend between)")
def viscous_reiner_philippoff(w: World, a: float) -> None:
    """The speed is an explicit function of the stress; the drag is its inverse."""
    stress = np.linspace(0.0, 3.0, 3001)
    speed = stress / (0.25 + 0.75 / (1.0 + (stress / 0.45) ** 2))
    speed /= np.interp(1.0, stress, speed)
    viscous(w, lambda u: np.interp(u, speed, stress), 0.4 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Washburn 1921; Bhushan 2002 (menisci that climb to a height: an implicit curve)", designs=SEVERAL)
def dwell_of_menisci(w: World, a: float) -> None:
    """A root of time at first, and no more in the end."""
    height = np.linspace(0.0, 1.0 - 1.0e-6, 4001) ** 0.5
    time = -height - np.log1p(-height)
    base, usual, size = w.rig.mu_s, 1.2 * w.nominal.period, 0.8 * a * w.nominal.gap
    first = np.interp(1.0 / 1.2, time, height)
    w.mu_s = lambda s: base + size * (np.interp(s.dwell / usual, time, height) - first)


@form("frictional_lag", source="Cornelissen, Hordijk and Reinhardt 1986 (concrete that softens: a cubic times an exponential)")
def lag_of_concrete(w: World, a: float) -> None:
    """Half is lost over a tenth of the way; a long tail follows, and ends."""
    end = 0.4 * w.nominal.slip_length

    def left(s: float) -> float:
        u = min(s / end, 1.0)
        return (1.0 + (3.0 * u) ** 3) * np.exp(-6.93 * u) - u * 28.0 * np.exp(-6.93)

    lag(w, lambda s, t: a * left(s))


@form(
    "direction_asymmetry",
    source="Eytelwein 1808; Limpert 2011 (a band that is wound up one way and let loose the other)",
    designs=SEVERAL,
    reversed=True,
    rig="webbing",
)
def asymmetry_of_a_band(w: World, a: float) -> None:
    """Neither direction is as stated: exponentials of the coefficient and of the angle wound."""
    rig, angle = w.rig, 0.25 * a / w.nominal.mu_s

    def wound(mu: float, side: float) -> float:
        return float(np.expm1(side * mu * angle) / (side * angle)) if angle else mu

    w.mu_s = lambda s: wound(rig.mu_s, float(np.sign(w.belt_velocity)))
    w.mu_k = lambda s: wound(rig.mu_k, float(s.direction))


@form(
    "load_dependence",
    source="Tsopelas, Constantinou, Okamoto, Fujii and Ozaki 1996 (PTFE bearings: a level less a hyperbolic tangent)",
    designs=SEVERAL,
    loads=True,
)
def load_of_a_bridge_bearing(w: World, a: float) -> None:
    """Under twice the load a fifth less friction, under half the load a quarter more."""

    def level(u: float) -> float:
        return 1.0 - 0.55 * float(np.tanh(0.9 * u))

    by_load(w, 1.0 + a * (level(w.normal_force / w.nominal.normal_force) / level(1.0) - 1.0))


@form("presliding_compliance", source="Dupont, Hayward, Armstrong and Altpeter 2002 (elastic, then more and more plastic)")
def presliding_elasto_plastic(w: World, a: float) -> None:
    """Straight up to half of the force, from where a sine lets the bristles slide along."""
    if a <= 0.0:
        return
    force = np.linspace(0.0, 0.995, 4000)
    plastic = np.where(force < 0.5, 0.0, 0.5 + 0.5 * np.sin(np.pi * (force - 0.75) / 0.5))
    steps = 1.0 / (1.0 - plastic * force)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (steps[1:] + steps[:-1]) * np.diff(force))])
    way, share = np.append(way, way[-1] + 100.0), np.append(force / 0.99, force[-1] / 0.99 + 0.01)
    contact(
        w,
        lambda u: float(np.interp(u, way, share)),
        lambda part: float(np.interp(part, share, way)),
        0.03 * a * w.nominal.slip_length,
    )


@form(
    "position_dependent_friction", source="Neale 1995 (a wick oils the belt at one place: the film is wiped off along the turn)"
)
def position_oiled_at_one_place(w: World, a: float) -> None:
    """An exponential rise along the turn, and a short fall at the wick."""
    turn = 9.7 * w.nominal.slip_length
    u = np.linspace(0.0, 1.0, 2001)
    dry = np.where(u < 0.94, 1.0 - np.exp(-u / 0.3), (1.0 - np.exp(-0.94 / 0.3)) * (1.0 - u) / 0.06)
    dry = dry - np.trapezoid(dry, u)
    scaled(w, lambda s: 1.0 + 0.15 * a * np.interp(np.mod((s.travel - s.x) / turn + 0.35, 1.0), u, dry))


@form(
    "friction_drift",
    source="Lancaster 1990 (the air dries while the heating runs, and is moist again: two exponentials)",
    also_one=("distance_drift",),
)
def drift_while_the_heating_runs(w: World, a: float) -> None:
    """Up for twenty cycles, and slower back."""
    off, tau = 20.0 * w.nominal.period, 8.0 * w.nominal.period
    most = 1.0 - np.exp(-off / tau)

    def dried(t):
        return np.where(t < off, 1.0 - np.exp(-t / tau), most * np.exp(-np.maximum(t - off, 0.0) / (1.8 * tau)))

    scaled(w, lambda s: 1.0 + 0.13 * a * dried(s.t))


@form(
    "distance_drift",
    source="Liu, Erdemir and Meletis 1996 (a diamond-like coating that turns into graphite)",
    also_one=("friction_drift",),
)
def distance_of_graphite(w: World, a: float) -> None:
    """Slow at first, half after eleven slips, and a tail as the inverse square."""
    half = 11.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.13 * a * s.slid**2 / (s.slid**2 + half**2))


@form("temperature_drift", source="Johnson and Cook 1983 (a metal that softens: a power of the temperature beyond the room's)")
def temperature_of_johnson_and_cook(w: World, a: float) -> None:
    """Steepest just above 20 degC, and nothing below."""
    warm(w)
    celsius = vars(w)["temperature"]
    scaled(w, lambda s: 1.0 - 0.13 * a * (np.maximum(celsius(s.t) - 20.0, 0.0) / 10.0) ** 0.6)


@form("random_coefficients", source="Johnson, Kotz and Balakrishnan 1995, chapter 25 (beta: between two limits, and leaning)")
def scatter_of_shares(w: World, a: float) -> None:
    """A share of the area that touches; each coefficient has its own, and each stick draws anew."""
    rig, gap, mean, sd = w.rig, w.nominal.gap, 2.0 / 7.0, np.sqrt(10.0 / 392.0)

    def draw(s: State | None) -> None:
        z = (w.rng.beta(2.0, 5.0, 2) - mean) / sd
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.09 * a * gap * z[0], rig.mu_k + 0.06 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Feller 1954; Harrison 1985 (a random walk between two walls)")
def correlated_between_walls(w: World, a: float) -> None:
    """A step a slip; what it has left after seven slips is 1/e. Any level between the walls is as likely."""
    wall = np.sqrt(3.0)  # unit variance

    def turn(s: State | None) -> None:
        level = w.rng.uniform(-wall, wall) if s is None else w.memory["level"] + 0.6 * w.rng.standard_normal()
        w.memory["level"] = wall - abs(np.mod(level + wall, 4.0 * wall) - 2.0 * wall)

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.045 * a * w.memory["level"])
