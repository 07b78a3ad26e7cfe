"""Forms of effects of friction that have a name, in shapes other than the usual ones."""

from __future__ import annotations

import numpy as np

from .forms import each_stick, form, steady_noise, warm
from .motion import State, World


def weaken(world: World, curve, amount: float) -> None:
    """Add amount times curve(speed) to mu_k, never above mu_s."""
    base, top = world.rig.mu_k, world.rig.mu_s
    world.mu_k = lambda s: min(base + amount * curve(abs(s.w)), top)


@form("velocity_weakening", source="Armstrong-Helouvry, Dupont and Canudas de Wit 1994")
def stribeck_gaussian(w: World, a: float) -> None:
    weaken(w, lambda v: np.exp(-((v / (0.35 * w.nominal.peak_speed)) ** 2)), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Hess and Soom 1990 (Lorentzian)")
def stribeck_lorentzian(w: World, a: float) -> None:
    weaken(w, lambda v: 1.0 / (1.0 + (v / (0.25 * w.nominal.peak_speed)) ** 2), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Makkar, Dixon, Sawyer and Hu 2005 (tanh)")
def stribeck_tanh(w: World, a: float) -> None:
    weaken(w, lambda v: 1.0 - np.tanh(v / (0.4 * w.nominal.peak_speed)), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Dieterich 1979; Rice and Ruina 1983 (logarithmic steady state)")
def weakening_logarithmic(w: World, a: float) -> None:
    slow = 0.02 * w.nominal.peak_speed
    weaken(w, lambda v: -np.log1p(v / slow) / np.log1p(50.0), 0.4 * a * w.nominal.gap)


@form("velocity_weakening", source="Thomsen 1999; Ibrahim 1994 (cubic, with a minimum)")
def weakening_cubic(w: World, a: float) -> None:
    least = 0.7 * w.nominal.peak_speed
    weaken(w, lambda v: 1.0 - 1.5 * v / least + 0.5 * min(v / least, 1.5) ** 3, 0.4 * a * w.nominal.gap)


def viscous(world: World, curve, force: float) -> None:
    """Add force times curve(speed/highest speed) to sliding friction [N]."""
    base, top = world.rig.mu_k, world.nominal.peak_speed
    world.mu_k = lambda s: base + force * curve(abs(s.w) / top) / world.normal_force


@form("viscous_friction", source="Olsson, Astrom, Canudas de Wit, Gafvert and Lischinsky 1998 (power of the speed)")
def viscous_power_below_one(w: World, a: float) -> None:
    viscous(w, lambda u: u**0.8, 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("viscous_friction", source="Olsson, Astrom, Canudas de Wit, Gafvert and Lischinsky 1998 (power of the speed)")
def viscous_power_above_one(w: World, a: float) -> None:
    viscous(w, lambda u: u**1.3, 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("viscous_friction", source="Eyring 1936 (shear thinning)")
def viscous_eyring(w: World, a: float) -> None:
    viscous(w, lambda u: np.arcsinh(6.0 * u) / np.arcsinh(6.0), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Brockley and Davis 1968 (power of the time of rest)", designs=("several",))
def dwell_power(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, w.nominal.period, 0.5 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * ((s.dwell / first) ** 0.35 - 1.0)


@form("dwell_ageing", source="Kato, Sato and Matsubayashi 1972 (saturating)", designs=("several",))
def dwell_saturating(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, w.nominal.period, 0.7 * a * w.nominal.gap
    w.mu_s = lambda s: base - size * (np.exp(-((s.dwell / first) ** 0.6)) - np.exp(-1.0))


def lag(world: World, share) -> None:
    """Make mu fall from mu_s to mu_k by share(slip, slip_time), 1 to 0."""
    rig = world.rig
    world.mu_k = lambda s: rig.mu_k + rig.gap * share(max(s.slip, 0.0), s.slip_time)


@form("frictional_lag", source="Hess and Soom 1990; Polycarpou and Soom 1992 (two time constants)")
def lag_two_times(w: World, a: float) -> None:
    tau = 0.15 / w.nominal.pulsation
    lag(w, lambda s, t: a * (0.5 * np.exp(-t / tau) + 0.5 * np.exp(-t / (6.0 * tau))))


@form("frictional_lag", source="Abercrombie and Rice 2005 (power of the slip)")
def lag_power_of_slip(w: World, a: float) -> None:
    distance = 0.05 * w.nominal.slip_length
    lag(w, lambda s, t: a * (1.0 + s / distance) ** -1.2)


@form("frictional_lag", source="Ida 1972; Andrews 1976 (linear weakening with slip)")
def lag_linear_in_slip(w: World, a: float) -> None:
    distance = 0.25 * w.nominal.slip_length
    lag(w, lambda s, t: a * max(1.0 - s / distance, 0.0))


@form("direction_asymmetry", source="Armstrong-Helouvry 1991; Bona and Indri 2005", designs=("several",), reversed=True)
def asymmetry_of_sliding_alone(w: World, a: float) -> None:
    base = w.rig.mu_k
    w.mu_k = lambda s: base * (1.0 + (0.08 * a if s.direction < 0 else 0.0))


@form("direction_asymmetry", source="Kermani, Patel and Moallem 2007", designs=("several",), reversed=True)
def asymmetry_of_breakaway_mostly(w: World, a: float) -> None:
    rig = w.rig
    side = w.belt_velocity < 0.0
    w.mu_s = lambda s: rig.mu_s * (1.0 + (0.08 * a if side else 0.0))
    w.mu_k = lambda s: rig.mu_k * (1.0 + (0.04 * a if side else 0.0))


@form("load_dependence", source="Wanheim and Bay 1978 (saturating real area)", designs=("several",), loads=True)
def load_saturating(w: World, a: float) -> None:
    rig, u = w.rig, w.normal_force / w.nominal.normal_force

    def factor(u: float) -> float:
        return np.tanh(0.8 * a * u) / (0.8 * a * u) if a else 1.0

    w.mu_s = lambda s: rig.mu_s * factor(u) / factor(1.0)
    w.mu_k = lambda s: rig.mu_k * factor(u) / factor(1.0)


@form("load_dependence", source="Briscoe and Tabor 1975 (logarithm of the pressure)", designs=("several",), loads=True)
def load_logarithmic(w: World, a: float) -> None:
    rig, factor = w.rig, 1.0 - 0.2 * a * np.log(w.normal_force / w.nominal.normal_force)
    w.mu_s = lambda s: rig.mu_s * factor
    w.mu_k = lambda s: rig.mu_k * factor


def contact(world: World, curve, inverse, length: float) -> None:
    """Let the stuck contact yield: force mu_s N curve(z/length), with a little damping."""
    k = world.rig.mu_s * world.rig.normal_force / length
    damper = 0.2 * np.sqrt(k * world.rig.mass)
    world.contact = lambda z, rate, hold: hold * np.sign(z) * curve(abs(z) / length) + damper * rate
    world.contact_deflection = lambda share: length * inverse(share)


@form("presliding_compliance", source="Mindlin 1949; Johnson 1955 (partial slip of spheres)")
def presliding_mindlin(w: World, a: float) -> None:
    if a > 0.0:
        contact(
            w,
            lambda u: 1.0 - max(1.0 - u, 0.0) ** 1.5,
            lambda share: 1.0 - (1.0 - share) ** (2 / 3),
            0.05 * a * w.nominal.slip_length,
        )


@form("presliding_compliance", source="Dahl 1976; Bliman 1992 (exponential approach)")
def presliding_exponential(w: World, a: float) -> None:
    if a > 0.0:
        length = 0.03 * a * w.nominal.slip_length
        contact(w, lambda u: 1.05 * (1.0 - np.exp(-u)), lambda share: -np.log(1.0 - share / 1.05), length)


def scaled(world: World, factor) -> None:
    """Multiply both coefficients by factor(state)."""
    rig = world.rig
    world.mu_s = lambda s: rig.mu_s * factor(s)
    world.mu_k = lambda s: rig.mu_k * factor(s)


@form("position_dependent_friction", source="Persson 2000, chapter 12; patterned surfaces (square wave)")
def position_square(w: World, a: float) -> None:
    length = 9.3 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.06 * a * np.tanh(12.0 * np.sin(2 * np.pi * (s.travel - s.x) / length + 0.7)))


@form("position_dependent_friction", source="Armstrong-Helouvry 1991 (a spot that returns each turn of the belt)")
def position_bump(w: World, a: float) -> None:
    length = 12.6 * w.nominal.slip_length

    def factor(s: State):
        u = np.mod((s.travel - s.x) / length + 0.3, 1.0) - 0.5
        return 1.0 + 0.15 * a * np.exp(-((u / 0.09) ** 2))

    scaled(w, factor)


@form("position_dependent_friction", source="Armstrong-Helouvry 1991 (two incommensurate lengths)")
def position_two_lengths(w: World, a: float) -> None:
    length = 7.4 * w.nominal.slip_length

    def factor(s: State):
        u = 2 * np.pi * (s.travel - s.x) / length
        return 1.0 + 0.05 * a * np.cos(u) + 0.035 * a * np.cos(1.618 * u + 1.0)

    scaled(w, factor)


@form("friction_drift", source="Blau 2005 (S-shaped running-in)", also_one=("distance_drift",))
def drift_logistic(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.10 * a / (1.0 + np.exp(-(s.t / span - 0.45) * 10.0)))


@form("friction_drift", source="Blau 1981 (running-in that rises and falls)", also_one=("distance_drift",))
def drift_rise_and_fall(w: World, a: float) -> None:
    peak = 14.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.12 * a * (s.t / peak) * np.exp(1.0 - s.t / peak))


@form(
    "distance_drift",
    source="Archard 1953; Queener, Smith and Mitchell 1965 (root of the distance)",
    also_one=("friction_drift",),
)
def distance_root(w: World, a: float) -> None:
    length = 40.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 - 0.10 * a * np.sqrt(s.slid / length))


@form("temperature_drift", source="Arrhenius 1889; Briscoe and Tabor 1978 (activated shear)")
def temperature_activated(w: World, a: float) -> None:
    warm(w)
    scaled(w, lambda s: np.exp(2200.0 * a * (1.0 / (273.15 + w.temperature(s.t)) - 1.0 / 293.15)))


@form("temperature_drift", source="Grosch 1963 (passage through a transition)")
def temperature_transition(w: World, a: float) -> None:
    warm(w)
    scaled(w, lambda s: 1.0 - 0.12 * a / (1.0 + np.exp(-(w.temperature(s.t) - 23.0) / 1.2)))


@form("random_coefficients", source="Pearson 1894 (mixture of two states of the surface)")
def scatter_mixture(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s) -> None:
        rough = w.rng.random() < 0.3
        z = w.rng.standard_normal(2)
        w.memory["s"] = rig.mu_s + a * gap * ((-0.14 if rough else 0.06) + 0.015 * z[0])
        w.memory["k"] = rig.mu_k + a * gap * ((0.05 if rough else -0.02) + 0.015 * z[1])

    each_stick(w, draw)
    w.mu_s = lambda s: w.memory["s"]
    w.mu_k = lambda s: w.memory["k"]


@form("random_coefficients", source="Student 1908; Mandelbrot 1963 (heavy tails)")
def scatter_heavy_tails(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s) -> None:
        z = np.clip(w.rng.standard_t(2.5, 2), -6.0, 6.0)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.04 * a * gap * z[0], rig.mu_k + 0.03 * a * gap * z[1]

    each_stick(w, draw)
    w.mu_s = lambda s: w.memory["s"]
    w.mu_k = lambda s: w.memory["k"]


@form("random_coefficients", source="Weibull 1951 (weakest junction, skewed)")
def scatter_weibull(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def draw(s) -> None:
        w.memory["s"] = rig.mu_s + 0.25 * a * gap * (w.rng.weibull(2.0) - 0.886)

    each_stick(w, draw)
    w.mu_s = lambda s: w.memory["s"]


@form("correlated_coefficients", source="Machlup 1954 (random telegraph)")
def correlated_telegraph(w: World, a: float) -> None:
    mean = 6.0 * w.nominal.period
    flips = np.cumsum(w.rng.exponential(mean, int(4.0 * w.duration / mean) + 20))
    sign = 1.0 if w.rng.random() < 0.5 else -1.0
    scaled(w, lambda s: 1.0 + 0.04 * a * sign * (1.0 - 2.0 * np.mod(np.searchsorted(flips, s.t), 2)))


@form("correlated_coefficients", source="Matern 1960 (smooth)")
def correlated_smooth(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap
    z, y = (steady_noise(w.rng, w.duration, 2.5 * w.nominal.period, order=2) for _ in range(2))
    w.mu_s = lambda s: rig.mu_s + 0.10 * a * gap * z(s.t)
    w.mu_k = lambda s: rig.mu_k + 0.06 * a * gap * y(s.t)
