"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Beater 2007 (air from a compressor that cuts in and out: filled fast, and leaks slowly)")
def load_of_a_compressor(w: World, a: float) -> None:
    """Two exponentials, up for a quarter of the time; the mean is as stated."""
    load, turn, up = w.normal_force, 6.1 * w.nominal.period, 0.25

    def pressure(u):
        filled = (1.0 - np.exp(-2.0 * u / up)) / (1.0 - np.exp(-2.0))
        left = (np.exp(-1.5 * (u - up) / (1.0 - up)) - np.exp(-1.5)) / (1.0 - np.exp(-1.5))
        return np.where(u < up, filled, left)

    mean = float(pressure((np.arange(20000) + 0.5) / 20000).mean())
    w.normal = lambda s: load * (1.0 + 0.15 * a * (pressure(np.mod(s.t / turn + 0.4, 1.0)) - mean))


@form("belt_speed_ripple", source="Gerbert 1999 (a V-belt with a lump: faster as it passes one pulley, slower at the other)")
def belt_with_a_lump(w: World, a: float) -> None:
    """A hump and a dip a turn, unevenly apart; the mean speed is as stated."""
    speed, turn = w.belt_velocity, 1.37 * w.nominal.period

    def lump(u):
        return np.exp(-(((np.mod(u, 1.0) - 0.5) / 0.09) ** 2))

    w.set_belt(lambda t: speed * (1.0 + 0.5 * a * (lump(t / turn + 0.2) - lump(t / turn + 0.57))))


@form("nonlinear_stiffness", source="Den Hartog and Heiles 1936 (a spring that is set up: it gives beyond its preload)")
def stiffness_beyond_a_preload(w: World, a: float) -> None:
    """As stiff as believed up to 0.62 of the reach, and nearly half as stiff beyond."""
    k, at = w.rig.stiffness, 0.62 * w.nominal.reach
    w.spring = lambda s: k * (s.x - 0.45 * a * np.maximum(s.x - at, 0.0))


@form("quadratic_damping", source="Shapiro 1953 (air through a port that is nearly choked: steeper than the square)")
def drag_near_choking(w: World, a: float) -> None:
    """The square of the speed over what is left to the speed of sound."""
    drag(w, lambda u: 0.5 * u * np.abs(u) / (1.0 - 0.5 * np.minimum(u * u, 1.3)), 0.5 * a)


@form("backlash", source="Hunt and Crossley 1975 (play, and where it is taken up a damping by how deep it is)")
def backlash_damped_where_it_bears(w: World, a: float) -> None:
    """Slack over a tenth of a slip; beyond it the joint takes energy, the more, the deeper it is."""
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.58 * w.rig.slip_length
    damping, scale = 0.08 * a * np.sqrt(w.rig.stiffness * w.rig.mass), w.nominal.slip_length

    def spring(s):
        deep = np.maximum(s.x - at - gap, 0.0)
        return k * (np.minimum(s.x, at) + deep) + damping * deep / scale * s.v

    if a > 0.0:
        w.spring = spring


@form("second_mode", source="Gendelman and others 2001; Bergeot, Berger and Bellizzi 2017 (an energy sink with a cubic spring)")
def mode_of_a_cubic_sink(w: World, a: float) -> None:
    """A mass on the box whose spring is a cubic and nothing else: as fast as the rig at a fifth of a slip."""
    mass, p, usual, share = 0.2 * a * w.rig.mass, 1.3 * w.nominal.pulsation, 0.2 * w.nominal.slip_length, 0.05

    def push(s):
        return p * p * s.q[0] * (s.q[0] / usual) ** 2 + 2.0 * share * p * s.q[1]

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -push(s) - s.a)
    w.load = lambda s: mass * push(s)


@form("harmonic_force", source="Randall 2011 (a motor that hunts: a tone whose pitch sways, side bands in pairs)")
def force_of_a_hunting_motor(w: World, a: float) -> None:
    """The size stays; the phase swings by 0.9 rad, once in seven turns or so."""
    force, f = 0.22 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.31 / w.nominal.period
    w.load = lambda s: force * np.cos(f * s.t + 0.4 + 0.9 * np.sin(f * s.t / 7.3))


@form("impacts", source="Lalanne 2002 (versed sines); Cox 1962 (a renewal: some time always passes until the next)")
def impacts_of_versed_sines(w: World, a: float) -> None:
    """Soft blows against the belt, sizes as Rayleigh's; between two of them is a sum of three exponential times."""
    count = int(2.5 * w.duration / w.nominal.period) + 20
    times = np.cumsum(w.rng.gamma(3.0, 0.45 * w.nominal.period, count))
    sizes = -0.7 * a * w.nominal.gap * w.nominal.normal_force * np.minimum(w.rng.rayleigh(0.8, count), 2.4)
    inside = times < w.duration
    pulses(
        w,
        lambda u: np.where(u < 1.0, 0.5 * (1.0 - np.cos(2 * np.pi * u)), 0.0),
        0.6 / w.nominal.pulsation,
        sizes[inside],
        times[inside],
    )
