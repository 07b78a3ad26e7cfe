"""A second set, written before the method was changed to meet what the first had shown, and run once after that.

Shapes of known effects, effects without a name and plain rigs that neither the generator nor the first set has.
"""

from __future__ import annotations

import functools

import numpy as np
from scipy.signal import lfilter

from . import forms
from .forms import NONE, UNKNOWN, arrivals, each_stick, steady_noise, warm
from .friction_forms import contact, lag, scaled, viscous, weaken
from .mechanism_forms import attach, drag, pulses, velocity_too
from .motion import State, World

form = functools.partial(forms.form, series=2)


@form("friction_drift", source="Blau 2005 (running-in, then wear-out)", also_one=("distance_drift",))
def drift_bathtub(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period
    scaled(w, lambda s: 1.0 + 0.08 * a * (np.exp(-6.0 * s.t / span) + 1.2 * (s.t / span) ** 3))


@form("friction_drift", source="Kragelskii 1965 (running-in in two stages)", also_one=("distance_drift",))
def drift_two_stages(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period

    def stage(u, at: float):
        return 1.0 / (1.0 + np.exp(-(u - at) / 0.04))

    scaled(w, lambda s: 1.0 - 0.06 * a * stage(s.t / span, 0.2) - 0.05 * a * stage(s.t / span, 0.65))


@form("friction_drift", source="Czichos 1978 (a transient that overshoots)", also_one=("distance_drift",))
def drift_overshoots(w: World, a: float) -> None:
    period = w.nominal.period
    scaled(w, lambda s: 1.0 + 0.1 * a * np.exp(-s.t / (25.0 * period)) * np.cos(2 * np.pi * s.t / (38.0 * period)))


@form("distance_drift", source="Blau 1989 (delayed rise with distance)", designs=("several",))
def distance_delayed(w: World, a: float) -> None:
    length = 12.0 * w.nominal.slip_length
    scaled(w, lambda s: 1.0 + 0.10 * a / (1.0 + (length / (s.slid + 1e-12)) ** 4))


@form("temperature_drift", source="Kato and Adachi 2000 (least friction at a temperature)")
def temperature_least(w: World, a: float) -> None:
    warm(w)
    scaled(w, lambda s: 1.0 + 0.08 * a * ((w.temperature(s.t) - 24.0) / 4.0) ** 2)


@form("sensor_drift", source="Hoffmann 1989 (creep of a gauge's adhesive)")
def drift_creep(w: World, a: float) -> None:
    size, tau = 0.012 * a * w.nominal.reach, 1.5 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * np.log1p(t / tau)


@form("sensor_drift", source="Doebelin 2004 (electronics warm up while the room cools)")
def drift_hump(w: World, a: float) -> None:
    size, tau = 0.05 * a * w.nominal.reach, 20.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * np.e * (t / tau) * np.exp(-t / tau)


@form("velocity_weakening", source="Bo and Pavelescu 1982 (stretched exponential)")
def stribeck_stretched(w: World, a: float) -> None:
    weaken(w, lambda v: np.exp(-((v / (0.2 * w.nominal.peak_speed)) ** 0.5)), 0.45 * a * w.nominal.gap)


@form("viscous_friction", source="Cross 1965 (shear thinning)")
def viscous_cross(w: World, a: float) -> None:
    viscous(w, lambda u: 2.5 * u / (1.0 + 1.5 * u**0.7), 0.35 * a * w.nominal.gap * w.nominal.normal_force)


@form("dwell_ageing", source="Dieterich 1972; Baumberger and Caroli 2006 (logarithm with a cut-off)", designs=("several",))
def dwell_cut_off(w: World, a: float) -> None:
    base, first, size = w.rig.mu_s, w.nominal.period, 0.25 * a * w.nominal.gap
    w.mu_s = lambda s: base + size * (np.log1p(s.dwell / (0.15 * first)) - np.log1p(1.0 / 0.15))


@form("frictional_lag", source="Ohnaka and Yamashita 1989 (Gaussian in the slip)")
def lag_gaussian(w: World, a: float) -> None:
    distance = 0.15 * w.nominal.slip_length
    lag(w, lambda s, t: a * np.exp(-((s / distance) ** 2)))


@form("direction_asymmetry", source="Papadopoulos and Chasparis 2002 (break-away alone)", designs=("several",), reversed=True)
def asymmetry_of_breakaway(w: World, a: float) -> None:
    base, side = w.rig.mu_s, w.belt_velocity < 0.0
    w.mu_s = lambda s: base * (1.0 + (0.08 * a if side else 0.0))


@form("load_dependence", source="Adams 1963 (hyperbolic)", designs=("several",), loads=True)
def load_hyperbolic(w: World, a: float) -> None:
    rig, factor = w.rig, (1.0 + 0.6 * a) / (1.0 + 0.6 * a * w.normal_force / w.nominal.normal_force)
    w.mu_s = lambda s: rig.mu_s * factor
    w.mu_k = lambda s: rig.mu_k * factor


@form("presliding_compliance", source="Iwan 1966 (sliders of evenly spread strength)")
def presliding_iwan(w: World, a: float) -> None:
    if a > 0.0:
        length = 0.05 * a * w.nominal.slip_length
        contact(w, lambda u: 1.0 - max(1.0 - u, 0.0) ** 2, lambda share: 1.0 - np.sqrt(1.0 - share), length)


@form("position_dependent_friction", source="Singer and Pollock 1992 (directional texture, sawtooth)")
def position_sawtooth(w: World, a: float) -> None:
    length = 8.1 * w.nominal.slip_length

    def factor(s: State):
        u = np.mod((s.travel - s.x) / length + 0.2, 1.0)
        return 1.0 + 0.12 * a * (np.where(u < 0.85, u / 0.85, (1.0 - u) / 0.15) - 0.5)

    scaled(w, factor)


@form("random_coefficients", source="Limpert, Stahel and Abbt 2001 (one lognormal factor for both)")
def scatter_lognormal(w: World, a: float) -> None:
    each_stick(w, lambda s: w.memory.update(factor=np.exp(0.03 * a * w.rng.standard_normal())))
    scaled(w, lambda s: w.memory["factor"])


@form("correlated_coefficients", source="Granger 1980 (two correlation times)")
def correlated_two_times(w: World, a: float) -> None:
    period = w.nominal.period
    z, y = steady_noise(w.rng, w.duration, 1.2 * period), steady_noise(w.rng, w.duration, 6.0 * period)
    scaled(w, lambda s: 1.0 + 0.02 * a * (z(s.t) + y(s.t)))


@form("normal_load_ripple", source="Whitehouse 2002 (roller with two harmonics)")
def load_two_harmonics(w: World, a: float) -> None:
    load, period = w.normal_force, 3.7 * w.nominal.period

    def normal(s: State):
        u = 2 * np.pi * s.t / period
        return load * (1.0 + 0.06 * a * (np.cos(u + 0.5) + 0.5 * np.cos(2.0 * u - 1.0)))

    w.normal = normal


@form("belt_speed_ripple", source="Holtz and Springob 1996 (cogging in narrow peaks)")
def belt_peaks(w: World, a: float) -> None:
    speed, period = w.belt_velocity, 0.4 * w.nominal.period
    w.set_belt(lambda t: speed * (1.0 + 0.35 * a * (np.exp(4.0 * (np.cos(2 * np.pi * t / period) - 1.0)) - 0.207)))


@form("nonlinear_stiffness", source="Helmholtz 1895 (quadratic, asymmetric)")
def stiffness_quadratic(w: World, a: float) -> None:
    k, reach = w.rig.stiffness, w.nominal.reach
    w.spring = lambda s: k * s.x * (1.0 + 0.4 * a * s.x / reach)


@form("backlash", source="Kim, Rook and Singh 2003 (gap of smooth edges)")
def backlash_smooth(w: World, a: float) -> None:
    k, gap, at = w.rig.stiffness, 0.10 * a * w.nominal.reach, 0.45 * w.nominal.reach

    def taken(x):
        u = np.clip((x - at) / (1.5 * gap), 0.0, 1.0) if a > 0.0 else 0.0 * x
        return gap * u * u * (3.0 - 2.0 * u)

    w.spring = lambda s: k * (s.x - taken(s.x))


@form("quadratic_damping", source="Ravindra and Mallik 1994 (power 2.4)")
def drag_steep(w: World, a: float) -> None:
    drag(w, lambda u: np.sign(u) * np.abs(u) ** 2.4, 0.4 * a)


@form("second_mode", source="Roberson 1952 (softening absorber)")
def mode_softening(w: World, a: float) -> None:
    attach(w, ratio=0.15 * a, frequency=2.6 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.02, cubic=-0.5)


@form("harmonic_force", source="Inman 2014, section 3.3 (triangular wave)")
def force_triangle(w: World, a: float) -> None:
    force, f = 0.14 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi / w.nominal.period
    w.load = lambda s: force * 2.0 / np.pi * np.arcsin(np.cos(1.73 * f * s.t))


@form("impacts", source="Babitsky 1998 (blows that bounce)")
def impacts_bouncing(w: World, a: float) -> None:
    first = arrivals(w.rng, w.duration, 0.5 / w.nominal.period)
    sizes = 1.4 * a * w.nominal.gap * w.nominal.normal_force * w.rng.gamma(4.0, 0.25, first.size)
    times = np.concatenate([first, first + 1.3 / w.nominal.pulsation])
    pulses(w, lambda u: np.exp(-3.0 * u), 0.3 / w.nominal.pulsation, np.concatenate([sizes, 0.5 * sizes]), times)


@form("sensor_clipping", source="Webster 1999 (both ends of the range)")
def clipping_both(w: World, a: float) -> None:
    if a <= 0.0:
        return
    high, low = w.nominal.reach, w.nominal.reach - w.nominal.slip_length
    margin = (0.1 * a - 0.02) * (high - low)
    w.sensor = lambda t, motion, rng: np.clip(motion.position, low + margin, high - margin)


@form("sensor_step", source="Page 1955 (a clamp that slips within a tenth of a cycle)")
def step_ramp(w: World, a: float) -> None:
    size, at, span = 0.04 * a * w.nominal.reach, 9.3 * w.nominal.period, 0.1 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position - size * np.clip((t - at) / span, 0.0, 1.0)


@form("sensor_outliers", source="Laplace 1774; Huber 1964 (two samples each)")
def outliers_in_pairs(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        hit = rng.random(t.size) < 0.004
        size = hit * rng.laplace(0.0, 0.02 * a * w.nominal.reach, t.size)
        return motion.position + size + np.concatenate([[0.0], size[:-1]])

    w.sensor = sensor


@form("sensor_delay", source="Franklin, Powell and Workman 1998 (two first-order filters)", rig="excited")
def delay_two_filters(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        decay = np.exp(-(t[1] - t[0]) / (0.15 * a / w.nominal.pulsation))
        x = motion.position - motion.position[0]
        for _ in range(2):
            x = lfilter([1.0 - decay], [1.0, -decay], x)
        return x + motion.position[0]

    w.sensor = sensor


@form(UNKNOWN, source="Starosvetsky and Gendelman 2009 (damper that acts near the end of the stroke)")
def damper_by_position(w: World, a: float) -> None:
    rig, reach = w.rig, w.nominal.reach
    size = 0.4 * a * w.nominal.gap * w.nominal.normal_force / w.nominal.peak_speed
    w.load = lambda s: -size * s.v * np.exp(-(((s.x / reach - rig.mu_k / rig.mu_s) / 0.08) ** 2))


@form(UNKNOWN, source="Doebelin 2004 (displacement sensor that feels acceleration)")
def sensor_feels_acceleration(w: World, a: float) -> None:
    size = 0.08 * a / w.nominal.pulsation**2
    w.sensor = lambda t, motion, rng: motion.position + size * np.gradient(motion.velocity, t)


@form(UNKNOWN, source="Doebelin 2004 (sensitivity that drifts)")
def sensor_gain_drifts(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.12 * a * t / span)


@form(UNKNOWN, source="Irschik and Holl 2004 (a load that is put on)")
def mass_steps(w: World, a: float) -> None:
    mass, at = w.rig.mass, 8.3 * w.nominal.period
    w.mass = lambda t: mass * (1.0 + 0.3 * a * (t >= at))


@form(UNKNOWN, source="Kester 2005 (codes that a converter misses)")
def sensor_dead_band(w: World, a: float) -> None:
    middle, half = w.nominal.reach - 0.5 * w.nominal.slip_length, 0.05 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        return np.where(np.abs(motion.position - middle) < half, middle, motion.position)

    w.sensor = sensor


@form(NONE, source="Box and Jenkins 1970 (first-order noise)", rig="fast", noise="coloured")
def noise_coloured(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="small", at_limits=True)
def numbers_at_limits_small(w: World, a: float) -> None:
    pass


@form(NONE, source="JCGM 100:2008 (every believed number two standard deviations off)", rig="excited", at_limits=True)
def numbers_at_limits_excited(w: World, a: float) -> None:
    pass


@form(NONE, source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick)", rig="small", declared="per_event")
def scatter_declared_small(w: World, a: float) -> None:
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.015 * z[0], rig.mu_k + 0.015 * z[1]

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: w.memory["s"], lambda s: w.memory["k"]


@form(NONE, source="Little and Rubin 1987", rig="fast", missing=0.02)
def samples_missing_fast(w: World, a: float) -> None:
    pass


@form(NONE, source="Widrow 1956", rig="small", quantum=4.0)
def quantised_small(w: World, a: float) -> None:
    pass


@form(NONE, source="Nyquist 1928", rig="paper", rate=400.0)
def rate_400_hz(w: World, a: float) -> None:
    pass
