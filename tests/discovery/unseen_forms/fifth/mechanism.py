"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import j1

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Merritt 1967 (a valve that opens and shuts: a square with round corners)")
def load_of_a_valve(w: World, a: float) -> None:
    load, turn = w.normal_force, 2 * np.pi / (4.9 * w.nominal.period)
    w.normal = lambda s: load * (1.0 + 0.05 * a * np.tanh(4.0 * np.sin(turn * s.t + 0.3)))


@form("belt_speed_ripple", source="Tsypkin 1984 (a relay in the drive: the speed saws up and down)")
def belt_of_a_relay(w: World, a: float) -> None:
    speed, turn = w.belt_velocity, 2 * np.pi / (0.63 * w.nominal.period)
    w.set_belt(lambda t: speed * (1.0 + 0.3 * a * 2.0 / np.pi * np.arcsin(np.sin(turn * t + 0.8))))


@form("nonlinear_stiffness", source="Treloar 1944 (a rubber rod in tension)")
def stiffness_of_a_rubber_rod(w: World, a: float) -> None:
    k, length, share = w.rig.stiffness, 2.0 * w.nominal.reach, 0.7 * a

    def pull(x):
        stretch = 1.0 + x / length
        return length / 3.0 * (stretch - stretch**-2)

    middle = 0.4 * length / pull(0.4 * length)
    w.spring = lambda s: k * ((1.0 - share) * s.x + share * middle * pull(s.x))


@form("quadratic_damping", source="Dixon 2007 (a damper that blows off: the square, then a shallow line)")
def drag_blows_off(w: World, a: float) -> None:
    drag(w, lambda u: np.sign(u) * np.where(np.abs(u) < 0.6, u * u, 0.36 + 0.35 * (np.abs(u) - 0.6)) / 0.5, 0.45 * a)


@form("backlash", source="Kahraman and Singh 1990 (a clearance, here one that closes exponentially)")
def backlash_closes_slowly(w: World, a: float) -> None:
    k, gap, at = w.rig.stiffness, 0.12 * a * w.nominal.slip_length, w.rig.reach - 0.65 * w.rig.slip_length
    if a > 0.0:
        w.spring = lambda s: k * (s.x - gap * (1.0 - np.exp(-np.maximum(s.x - at, 0.0) / gap)))


@form("second_mode", source="Asami and Nishihara 1999 (an absorber whose damper has a spring in line)")
def mode_with_an_elastic_damper(w: World, a: float) -> None:
    mass, p = 0.2 * a * w.rig.mass, 1.8 * w.nominal.pulsation
    w.q0 = (0.0, 0.0, 0.0)
    w.rates = lambda s: (s.q[1], -p * p * s.q[0] - s.q[2] - s.a, 0.4 * p * p * s.q[1] - p * s.q[2])
    w.load = lambda s: mass * (p * p * s.q[0] + s.q[2])


@form("harmonic_force", source="Norton 2011, chapter 3 (a quick return)")
def force_of_a_quick_return(w: World, a: float) -> None:
    force, f, skew = 0.2 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.27 / w.nominal.period, 0.7
    w.load = lambda s: force * (np.cos(f * s.t + 0.5 + skew * np.sin(f * s.t + 0.5)) + j1(skew))


@form("impacts", source="Ricker 1953 (wavelets of either sign)")
def impacts_of_wavelets(w: World, a: float) -> None:
    def wavelet(u):
        x = 3.0 * (u - 1.0)
        return (1.0 - 2.0 * x * x) * np.exp(-x * x)

    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = 1.6 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.6, 1.4, times.size)
    pulses(w, wavelet, 0.8 / w.nominal.pulsation, sizes * w.rng.choice([-1.0, 1.0], times.size), times)
