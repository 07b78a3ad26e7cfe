"""Effects of friction that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import erfcx

from tests.discovery.unseen_forms.forms import each_stick, warm
from tests.discovery.unseen_forms.friction_forms import contact, lag, scaled, viscous, weaken
from tests.discovery.unseen_forms.motion import State, World
from tests.discovery.unseen_forms.third.friction import by_load

from .enter import form

SEVERAL = ("several",)


@form("velocity_weakening", source="Pennestri, Rossi, Salvini and Valentini 2016 (the cubic step of multibody codes)")
def weakening_cubic_step(w: World, a: float) -> None:
    """Level at rest, and from half of the highest speed on."""
    end = 0.5 * w.nominal.peak_speed

    def step(v: float) -> float:
        u = min(v / end, 1.0)
        return 1.0 - u * u * (3.0 - 2.0 * u)

    weaken(w, step, 0.4 * a * w.nominal.gap)


@form(
    "viscous_friction", source="Ellis 1927, in Bird, Stewart and Lightfoot 1960 (the speed as a cubic of the stress)", rig="gib"
)
def viscous_ellis(w: World, a: float) -> None:
    stress = np.linspace(0.0, 3.0, 3001)
    speed = (stress + 6.0 * stress**3) / 7.0
    viscous(w, lambda u: np.interp(u, speed, stress), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Wool and O'Connor 1981 (chains that heal: the root of time, until all have)", designs=SEVERAL)
def dwell_heals(w: World, a: float) -> None:
    base, healed, size = w.rig.mu_s, 2.2 * w.nominal.period, 0.7 * a * w.nominal.gap
    usual = np.sqrt(1.0 / 2.2)
    w.mu_s = lambda s: base + size * (np.sqrt(np.minimum(s.dwell / healed, 1.0)) - usual)


@form("frictional_lag", source="Rice 2006 (a slip plane whose water heats: exp(u) erfc(root of u) of the slip)")
def lag_of_hot_water(w: World, a: float) -> None:
    distance = 0.01 * w.nominal.slip_length
    lag(w, lambda s, t: a * float(erfcx(np.sqrt(s / distance))))


@form(
    "direction_asymmetry",
    source="Makinson 1948 (wool against its scales: harder to start, and harder once the scales have caught)",
    designs=SEVERAL,
    reversed=True,
)
def asymmetry_of_wool(w: World, a: float) -> None:
    rig, against, length = w.rig, w.belt_velocity < 0.0, 0.15 * w.nominal.slip_length
    w.mu_s = lambda s: rig.mu_s + (0.2 * a * rig.gap if against else 0.0)
    w.mu_k = lambda s: rig.mu_k + (0.3 * a * rig.gap * (1.0 - np.exp(-max(s.slip, 0.0) / length)) if s.direction < 0 else 0.0)


@form(
    "load_dependence",
    source="Kragelskii, Dobychin and Kombalov 1982 (elastic adhesion falls, ploughing rises: a least friction)",
    designs=SEVERAL,
    loads=True,
)
def load_with_a_least(w: World, a: float) -> None:
    u = w.normal_force / w.nominal.normal_force
    by_load(w, 1.0 + a * (0.45 * u ** (-1 / 3) + 0.55 * np.sqrt(u) - 1.0))


@form("presliding_compliance", source="Segalman 2005 (sliders whose strengths are a power law: 3 u - 2 u^1.5)")
def presliding_segalman(w: World, a: float) -> None:
    u = np.linspace(0.0, 1.0, 4001)
    share = 3.0 * u - 2.0 * u**1.5
    if a > 0.0:
        length = 0.06 * a * w.nominal.slip_length
        contact(
            w,
            lambda z: float(np.interp(z, u, share)) if z < 1.0 else 1.0 + 1e-3 * (z - 1.0),
            lambda part: float(np.interp(part, share, u)),
            length,
        )


@form("position_dependent_friction", source="Etsion 2005 (a belt with holes: three dips a turn, unevenly apart)")
def position_holes(w: World, a: float) -> None:
    length, holes = 10.7 * w.nominal.slip_length, ((0.15, 0.13), (0.38, 0.09), (0.79, 0.15))

    def factor(s: State):
        u = (s.travel - s.x) / length
        dips = (depth * np.exp(-(((np.mod(u - at + 0.5, 1.0) - 0.5) / 0.07) ** 2)) for at, depth in holes)
        return 1.0 - a * sum(dips)

    scaled(w, factor)


@form(
    "friction_drift", source="Chiu 1974 (a track that starves: the film thins as a root of time)", also_one=("distance_drift",)
)
def drift_of_a_starved_track(w: World, a: float) -> None:
    time = 10.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.1 * a * (np.sqrt(1.0 + s.t / time) - 1.0))


@form("distance_drift", source="Lin and Cheng 1989 (asperities that flatten: a hyperbola)", also_one=("friction_drift",))
def distance_hyperbolic(w: World, a: float) -> None:
    half = 9.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.14 * a * s.slid / (s.slid + half))


@form("temperature_drift", source="Newcomb and Spurr 1967 (a lining that rises a little, and fades beyond a temperature)")
def temperature_of_a_lining(w: World, a: float) -> None:
    warm(w)
    celsius = vars(w)["temperature"]

    def factor(s: State):
        beyond = celsius(s.t) - 23.0
        return 1.0 + a * np.where(beyond < 0.0, 0.008, -0.03) * beyond

    scaled(w, factor)


@form("random_coefficients", source="Laplace 1774 (density falls exponentially to both sides)")
def scatter_laplace(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s: State | None) -> None:
        z = np.clip(w.rng.laplace(0.0, np.sqrt(0.5), 2), -4.0, 4.0)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.08 * a * gap * z[0], rig.mu_k + 0.05 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form("correlated_coefficients", source="Hamilton 1989 (a chain of three states, one step a slip)")
def correlated_chain(w: World, a: float) -> None:
    def turn(s: State | None) -> None:
        state = int(w.memory.get("state", w.rng.integers(3)))
        if w.rng.random() < 0.2:
            state = int((state + w.rng.integers(1, 3)) % 3)
        w.memory["state"] = state

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.05 * a * (w.memory["state"] - 1.0))
