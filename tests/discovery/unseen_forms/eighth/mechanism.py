"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form("normal_load_ripple", source="Gerstner 1802 (a float on steep waves: sharp crests, broad troughs)")
def load_of_a_float(w: World, a: float) -> None:
    load, turn, steep = w.normal_force, 4.7 * w.nominal.period, 0.75
    angle = np.linspace(0.0, 2 * np.pi, 4001)
    phase = (angle - steep * np.sin(angle)) / (2 * np.pi)
    height = -np.cos(angle) - 0.5 * steep  # of no mean over the phase
    w.normal = lambda s: load * (1.0 + 0.07 * a * np.interp(np.mod(s.t / turn + 0.3, 1.0), phase, height))


@form("belt_speed_ripple", source="Mohan, Undeland and Robbins 2003 (a drive in burst control: slow for a third of each burst)")
def belt_in_burst_control(w: World, a: float) -> None:
    """Two speeds with round corners; their mean is as stated."""
    speed, turn = w.belt_velocity, 1.53 * w.nominal.period
    u = np.linspace(0.0, 1.0, 2001)
    slow = 0.5 * (np.tanh((u - 0.3) / 0.03) - np.tanh((u - 0.63) / 0.03))
    slow = slow - np.trapezoid(slow, u)
    w.set_belt(lambda t: speed * (1.0 - 0.35 * a * np.interp(np.mod(t / turn + 0.05, 1.0), u, slow)))


@form("nonlinear_stiffness", source="Lanir 1983 (wavy fibres that are drawn straight one after the other)")
def stiffness_of_wavy_fibres(w: World, a: float) -> None:
    """As stiff as believed at eight tenths of the reach."""
    k, reach, share = w.rig.stiffness, w.nominal.reach, 0.5 * a
    middle, width = 0.5 * reach, 0.2 * reach

    def pull(x):
        z = (x - middle) / width
        return width * (z * ndtr(z) + np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi))

    most = 0.8 * reach / (pull(0.8 * reach) - pull(0.0))
    w.spring = lambda s: k * ((1.0 - share) * s.x + share * most * (pull(s.x) - pull(0.0)))


@form("quadratic_damping", source="Dalzell 1978 (a ship that rolls: a line and a cubic)")
def drag_of_a_rolling_ship(w: World, a: float) -> None:
    drag(w, lambda u: 0.3 * u + 0.7 * u**3, 0.5 * a)


@form("backlash", source="Flodin and Andersson 1997 (a gap that wear makes wider)")
def backlash_that_widens(w: World, a: float) -> None:
    """By half, within forty cycles."""
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.55 * w.rig.slip_length
    life = 40.0 * w.nominal.period
    w.spring = lambda s: k * (s.x - 0.95 * np.clip(s.x - at, 0.0, gap * (1.0 + 0.5 * np.minimum(s.t / life, 1.0))))


@form("second_mode", source="Chondros, Dimarogonas and Yao 2001 (a cracked arm: stiffer one way than the other)")
def mode_of_a_cracked_arm(w: World, a: float) -> None:
    mass, p = 0.18 * a * w.rig.mass, 2.3 * w.nominal.pulsation

    def pull(s: State):
        return p * p * s.q[0] * np.where(s.q[0] > 0.0, 1.5, 1.0) + 0.03 * p * s.q[1]

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -pull(s) - s.a)
    w.load = lambda s: mass * pull(s)


@form("harmonic_force", source="McFadden and Smith 1985 (a planet gear: a line of teeth that swells once a turn)")
def force_of_a_planet_gear(w: World, a: float) -> None:
    force, turn = 0.16 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 0.293 / w.nominal.period
    w.load = lambda s: force * (1.0 + 0.8 * np.cos(turn * s.t + 0.4)) * np.cos(6.0 * turn * s.t + 1.2)


@form("impacts", source="Bruce and Golde 1941; Pareto 1896 (two exponentials; a few blows are far larger than most)")
def impacts_of_two_exponentials(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.9 / w.nominal.period)
    sizes = 0.9 * a * w.nominal.gap * w.nominal.normal_force * np.minimum(0.5 * (1.0 + w.rng.pareto(2.0, times.size)), 2.5)
    pulses(w, lambda u: 1.9 * (np.exp(-1.3 * u) - np.exp(-6.0 * u)), 0.3 / w.nominal.pulsation, sizes, times)
