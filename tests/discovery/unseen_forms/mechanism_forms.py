"""Forms of effects of mechanism and sensor that have a name, in shapes other than the usual ones."""

from __future__ import annotations

import numpy as np
from scipy.signal import bessel, sosfilt, sosfilt_zi

from .forms import arrivals, form, warm
from .motion import World


@form("normal_load_ripple", source="Jacobsson 2003 (thickness variation, triangular)")
def load_triangle(w: World, a: float) -> None:
    load, period = w.normal_force, 4.4 * w.nominal.period
    w.normal = lambda s: load * (1.0 + 0.06 * a * 2.0 / np.pi * np.arcsin(np.sin(2 * np.pi * s.t / period + 0.4)))


@form("normal_load_ripple", source="Duffour and Woodhouse 2004; a runout with two lobes (rectified sine)")
def load_two_lobes(w: World, a: float) -> None:
    load, period = w.normal_force, 5.7 * w.nominal.period
    w.normal = lambda s: load * (1.0 + 0.14 * a * (np.abs(np.sin(np.pi * s.t / period + 0.9)) - 2.0 / np.pi))


@form("belt_speed_ripple", source="Armstrong 1991 (sawtooth)")
def belt_sawtooth(w: World, a: float) -> None:
    speed, period = w.belt_velocity, 0.31 * w.nominal.period
    w.set_belt(lambda t: speed * (1.0 + 0.3 * a * _sawtooth(t / period)))


def _sawtooth(u):
    """Return a sawtooth between -1/2 and 1/2 whose falls take a tenth of the period."""
    u = np.mod(u, 1.0)
    return np.where(u < 0.9, u / 0.9, (1.0 - u) / 0.1) - 0.5


@form("belt_speed_ripple", source="Porat 1980 (Hooke's joint in the drive)")
def belt_hooke_joint(w: World, a: float) -> None:
    speed, period, tilt = w.belt_velocity, 0.9 * w.nominal.period, 0.2 * a
    w.set_belt(lambda t: speed * np.sqrt(1.0 - tilt) / (1.0 - tilt * np.cos(2 * np.pi * t / period) ** 2))


@form("belt_speed_ripple", source="Bouillon and Tordion 1965 (polygon action of a chain)")
def belt_polygon(w: World, a: float) -> None:
    speed, period, half = w.belt_velocity, 0.47 * w.nominal.period, np.pi / 4 * np.sqrt(a)
    mean = np.sin(half) / half if a else 1.0
    w.set_belt(lambda t: speed * np.cos(half * (2.0 * np.mod(t / period, 1.0) - 1.0)) / mean)


@form("nonlinear_stiffness", source="Shaw and Holmes 1983 (second spring behind a gap)")
def stiffness_second_spring(w: World, a: float) -> None:
    k, gap = w.rig.stiffness, 0.55 * w.nominal.reach
    w.spring = lambda s: k * (s.x + 0.5 * a * np.maximum(s.x - gap, 0.0))


@form("nonlinear_stiffness", source="Fung 1967 (exponential)")
def stiffness_exponential(w: World, a: float) -> None:
    k, scale = w.rig.stiffness, w.nominal.reach / max(0.6 * a, 1e-9)
    w.spring = lambda s: k * scale * np.expm1(s.x / scale)


@form("nonlinear_stiffness", source="Rivin 2003 (softening rubber mount)")
def stiffness_softening(w: World, a: float) -> None:
    k, scale = w.rig.stiffness, w.nominal.reach / max(0.7 * a, 1e-9)
    w.spring = lambda s: k * scale * np.tanh(s.x / scale)


@form("backlash", source="Nordin, Galic and Gutman 1997 (yielding gap with round corners)")
def backlash_soft(w: World, a: float) -> None:
    k, gap, corner = w.rig.stiffness, 0.12 * a * w.nominal.reach, 0.008 * w.nominal.reach
    at = 0.5 * w.nominal.reach

    def ramp(u):
        return corner * np.logaddexp(0.0, u / corner)

    w.spring = lambda s: k * (s.x - 0.85 * (ramp(s.x - at) - ramp(s.x - at - gap)))


@form("backlash", source="Tustin 1947 (play taken up through a light spring)")
def backlash_with_light_spring(w: World, a: float) -> None:
    k, gap, at = w.rig.stiffness, 0.08 * a * w.nominal.reach, 0.35 * w.nominal.reach
    w.spring = lambda s: k * (s.x - 0.95 * np.minimum(np.maximum(s.x - at, 0.0), gap))


def drag(world: World, curve, share: float) -> None:
    """Add drag against the motion: share of (mu_s - mu_k) N at the highest speed."""
    rig, top, force = world.rig, world.nominal.peak_speed, share * world.nominal.gap * world.nominal.normal_force
    world.damping = lambda s: rig.damping * s.v + force * curve(s.v / top)


@form("quadratic_damping", source="Morison, O'Brien, Johnson and Schaaf 1950 (in a current)")
def drag_in_a_current(w: World, a: float) -> None:
    drag(w, lambda u: (u - 0.25) * np.abs(u - 0.25) + 0.0625, 0.4 * a)


@form("quadratic_damping", source="Blasius 1913 (turbulent, power 1.75)")
def drag_turbulent(w: World, a: float) -> None:
    drag(w, lambda u: u * np.abs(u) ** 0.75, 0.4 * a)


def attach(world: World, *, ratio: float, frequency: float, damping_ratio: float, cubic: float = 0.0) -> None:
    """Put a second mass on the box, on a spring that may harden."""
    mass, p = ratio * world.rig.mass, 2 * np.pi * frequency
    scale = world.nominal.slip_length

    def force(s):
        return p * p * s.q[0] * (1.0 + cubic * (s.q[0] / scale) ** 2) + 2.0 * damping_ratio * p * s.q[1]

    world.q0 = (0.0, 0.0)
    world.rates = lambda s: (s.q[1], -force(s) - s.a)
    world.load = lambda s: mass * force(s)


@form("second_mode", source="Popp and Rudolph 2004; Den Hartog 1956 (light damping, hardening)")
def mode_light(w: World, a: float) -> None:
    attach(w, ratio=0.10 * a, frequency=3.3 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.004, cubic=4.0)


@form("second_mode", source="Brock 1946 (heavily damped absorber)")
def mode_heavy(w: World, a: float) -> None:
    attach(w, ratio=0.20 * a, frequency=1.9 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.3)


@form("harmonic_force", source="Thomsen 2003 (two shakers)")
def force_two_tones(w: World, a: float) -> None:
    force, f = 0.14 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi / w.nominal.period
    w.load = lambda s: force * (np.cos(0.83 * f * s.t + 0.3) + 0.8 * np.cos(2.27 * f * s.t))


@form("harmonic_force", source="Armstrong-Helouvry, Dupont and Canudas de Wit 1994, section 4 (dither, rounded square)")
def force_chopped(w: World, a: float) -> None:
    force, f = 0.12 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi / w.nominal.period
    w.load = lambda s: force * np.tanh(4.0 * np.cos(1.41 * f * s.t))


@form("harmonic_force", source="Den Hartog 1956 (unbalance near resonance)")
def force_near_resonance(w: World, a: float) -> None:
    """The amplitude beats: 1 + 0.4 cos."""
    force, p = 0.10 * a * w.nominal.gap * w.nominal.normal_force, w.nominal.pulsation
    w.load = lambda s: force * (1.0 + 0.4 * np.cos(0.021 * p * s.t)) * np.cos(0.87 * p * s.t)


def pulses(world: World, shape, length: float, sizes: np.ndarray, times: np.ndarray) -> None:
    """Add a force: sizes times shape(time since the pulse's start/length) [N]."""
    grid = np.arange(0.0, world.duration + length, length / 24.0)
    force = np.zeros_like(grid)
    for time, size in zip(times, sizes, strict=True):
        i, j = np.searchsorted(grid, [time, time + 6.0 * length])
        force[i:j] += size * shape((grid[i:j] - time) / length)
    world.load = lambda s: np.interp(s.t, grid, force)


@form("impacts", source="Goldsmith 1960 (half-sine pulses of one sign)")
def impacts_half_sine(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.7 / w.nominal.period)
    sizes = 1.2 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.5, 1.5, times.size)
    pulses(w, lambda u: np.where(u < 1.0, np.sin(np.pi * u), 0.0), 0.3 / w.nominal.pulsation, sizes, times)


@form("impacts", source="Harris and Crede 1961 (decaying pulses of both signs)")
def impacts_decaying(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 1.0 / w.nominal.period)
    sizes = 1.5 * a * w.nominal.gap * w.nominal.normal_force * w.rng.standard_normal(times.size)
    pulses(w, lambda u: np.exp(-2.0 * u), 0.25 / w.nominal.pulsation, sizes, times)


@form("sensor_clipping", source="Fraden 2016, chapter 3 (gradual saturation)")
def clipping_soft(w: World, a: float) -> None:
    if a <= 0.0:
        return
    high, width = (1.05 - 0.2 * a) * w.nominal.reach, 0.02 * w.nominal.reach
    w.sensor = lambda t, motion, rng: high - width * np.logaddexp(0.0, (high - motion.position) / width)


@form("sensor_clipping", source="Fraden 2016, chapter 3 (lower end of the range, limit that yields)")
def clipping_low_leaky(w: World, a: float) -> None:
    if a <= 0.0:
        return
    low = w.nominal.reach - (1.02 - 0.2 * a) * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: np.where(motion.position < low, low + 0.06 * (motion.position - low), motion.position)


def velocity_too(world: World) -> None:
    """Record a velocity [m/s] from a sensor of its own, which is not late."""
    noise = 2.0e-3 * world.nominal.peak_speed
    world.columns["velocity [m/s]"] = lambda t, motion: (
        motion.velocity + noise * np.random.default_rng(len(t)).standard_normal(len(t))
    )


@form("sensor_delay", source="Thomson 1949 (Bessel filter in the amplifier)", rig="excited")
def delay_bessel(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        corner = 1.0 / (0.35 * a / w.nominal.pulsation)  # with norm="delay" the delay is 1/corner
        sections = bessel(3, corner, fs=2 * np.pi / (t[1] - t[0]), norm="delay", output="sos")
        return sosfilt(sections, motion.position, zi=sosfilt_zi(sections) * motion.position[0])[0]

    w.sensor = sensor


@form("sensor_delay", source="Astrom and Wittenmark 1997 (slow converter behind a sample and hold)", rig="excited")
def delay_sample_and_hold(w: World, a: float) -> None:
    velocity_too(w)

    def sensor(t, motion, rng):
        hold = max(round(0.5 * a / w.nominal.pulsation / (t[1] - t[0])), 1)
        return motion.position[np.maximum(np.arange(t.size) // hold * hold - hold // 2, 0)]

    w.sensor = sensor


@form("sensor_drift", source="Fraden 2016, chapter 3 (warming up)")
def drift_warming_up(w: World, a: float) -> None:
    size, tau = 0.04 * a * w.nominal.reach, 18.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.exp(-t / tau))


@form("sensor_drift", source="Fleming 2013 (zero that follows the room's temperature)")
def drift_with_temperature(w: World, a: float) -> None:
    warm(w)
    size = 0.006 * a * w.nominal.reach
    w.sensor = lambda t, motion, rng: motion.position + size * (w.temperature(t) - 20.0)


@form("sensor_step", source="Basseville and Nikiforov 1993 (settling in)")
def step_settling(w: World, a: float) -> None:
    size, at, tau = 0.04 * a * w.nominal.reach, 6.6 * w.nominal.period, 0.25 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.exp(-np.maximum(t - at, 0.0) / tau))


@form("sensor_step", source="Basseville and Nikiforov 1993 (there and half the way back)")
def step_two(w: World, a: float) -> None:
    size, first, second = 0.04 * a * w.nominal.reach, 5.2 * w.nominal.period, 21.3 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * ((t >= first) - 0.5 * (t >= second))


@form("sensor_outliers", source="Fox 1972 (patches)")
def outliers_in_bursts(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        x = motion.position.copy()
        for time in arrivals(rng, w.duration, 0.4 / w.nominal.period) if a > 0.0 else ():
            i = np.searchsorted(t, time)
            j = i + rng.integers(3, 20)
            x[i:j] += 0.03 * a * w.nominal.reach * rng.standard_normal(x[i:j].size)
        return x

    w.sensor = sensor


@form("sensor_outliers", source="Tukey 1960; Hampel 1974 (one-sided, exponential sizes)")
def outliers_one_sided(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        hit = rng.random(t.size) < 0.01
        return motion.position + hit * rng.exponential(0.02 * a * w.nominal.reach, t.size)

    w.sensor = sensor
