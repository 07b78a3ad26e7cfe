"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form("normal_load_ripple", source="Jacobsson 2003 (a disc that is thicker along a half: half a wave a turn)")
def load_of_half_a_wave(w: World, a: float) -> None:
    load, turn = w.normal_force, 2 * np.pi / (5.3 * w.nominal.period)
    w.normal = lambda s: load * (1.0 + 0.14 * a * (np.maximum(np.sin(turn * s.t + 0.2), 0.0) - 1.0 / np.pi))


@form("belt_speed_ripple", source="Jahns and Soong 1996 (a motor's torque: once, twice and six times a turn)")
def belt_of_a_motor(w: World, a: float) -> None:
    speed, turn = w.belt_velocity, 2 * np.pi / (1.71 * w.nominal.period)

    def velocity(t):
        u = turn * t
        return speed * (1.0 + 0.22 * a * (np.cos(u + 0.4) + 0.5 * np.cos(2.0 * u + 2.0) + 0.25 * np.cos(6.0 * u + 1.0)))

    w.set_belt(velocity)


@form("nonlinear_stiffness", source="Rodriguez, Paredes and Sartor 2006 (a conical spring whose coils come to rest in turn)")
def stiffness_of_a_conical_spring(w: World, a: float) -> None:
    k, reach, share = w.rig.stiffness, w.nominal.reach, 0.8 * a
    first = 0.45 * reach  # way after which the widest coil rests

    def more(x):
        beyond = np.maximum(x - first, 0.0)
        u = share * np.minimum(beyond / reach, 1.0)  # farther than a box comes: along the tangent
        return reach / share * ((share * beyond / reach - u) / (1.0 - u) - np.log(1.0 - u)) - beyond

    if a > 0.0:
        w.spring = lambda s: k * (s.x + more(s.x))


@form("quadratic_damping", source="ITTC 1957 (a hull's skin: the square, and a logarithm of the Reynolds number)")
def drag_of_a_hull(w: World, a: float) -> None:
    """A million at the highest speed."""

    def coefficient(u):
        return (np.log10(1.0e6 * np.abs(u) + 1.0e4) - 2.0) ** -2

    drag(w, lambda u: u * np.abs(u) * coefficient(u) / coefficient(1.0), 0.45 * a)


@form("backlash", source="Padmanabhan and Singh 1995 (a clutch: two slopes to either side of the gap)")
def backlash_between_shoulders(w: World, a: float) -> None:
    """Half as stiff over a quarter of the gap before and behind it."""
    k, gap, at = w.rig.stiffness, 0.11 * a * w.nominal.slip_length, w.rig.reach - 0.6 * w.rig.slip_length
    way, lost = np.array([0.0, 0.25, 1.25, 1.5]), np.array([0.0, 0.125, 1.095, 1.22])
    if a > 0.0:
        w.spring = lambda s: k * (s.x - gap * np.interp((s.x - at) / gap, way, lost))


@form("second_mode", source="Crede 1951 (a payload on mounts with snubbers: stiffer beyond a way)")
def mode_with_snubbers(w: World, a: float) -> None:
    mass, p, free = 0.18 * a * w.rig.mass, 2.6 * w.nominal.pulsation, 0.05 * w.nominal.slip_length

    def pull(s: State):
        beyond = np.sign(s.q[0]) * np.maximum(np.abs(s.q[0]) - free, 0.0)
        return p * p * (s.q[0] + 1.5 * beyond) + 0.04 * p * s.q[1]

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -pull(s) - s.a)
    w.load = lambda s: mass * pull(s)


@form("harmonic_force", source="Bachmann and Ammann 1987 (somebody walks in place: three tones, 0.4 to 0.1 to 0.1)")
def force_of_a_walker(w: World, a: float) -> None:
    force, f = 0.18 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.37 / w.nominal.period
    w.load = lambda s: force * (np.cos(f * s.t + 0.2) + 0.25 * np.cos(2.0 * f * s.t + 1.8) + 0.25 * np.cos(3.0 * f * s.t + 1.8))


@form("impacts", source="Irvine 2002; MIL-STD-810, method 517 (decaying sines, to either side at first)")
def impacts_that_ring(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = 1.3 * a * w.nominal.gap * w.nominal.normal_force * w.rng.gamma(3.0, 1.0 / 3.0, times.size)
    sizes *= w.rng.choice([-1.0, 1.0], times.size)
    pulses(w, lambda u: 1.9 * np.exp(-u) * np.sin(2.0 * u), 0.3 / w.nominal.pulsation, sizes, times)
