"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Stribeck 1907; Harris 2001 (an oval ball that runs through the load zone of its bearing)")
def load_of_a_ball_in_its_zone(w: World, a: float) -> None:
    """A hump over a part of each turn, a power 1.5 of a cosine, and nothing outside; the mean is as stated."""
    load, turn = w.normal_force, 4.9 * w.nominal.period

    def hump(u):
        return np.maximum(1.0 - (1.0 - np.cos(2 * np.pi * u)) / 0.8, 0.0) ** 1.5

    mean = float(hump((np.arange(20000) + 0.5) / 20000).mean())
    w.normal = lambda s: load * (1.0 + 0.16 * a * (hump(s.t / turn + 0.35) - mean))


@form("belt_speed_ripple", source="Reuleaux 1876; Bickford 1972 (a Geneva wheel, of whose motion a differential adds a part)")
def belt_of_a_geneva_wheel(w: World, a: float) -> None:
    """Four slots: a push for a quarter of each turn, with a sharp top; the mean speed is as stated."""
    speed, turn, ratio = w.belt_velocity, 1.63 * w.nominal.period, np.sqrt(0.5)

    def wheel(u):
        angle = 2 * np.pi * (np.mod(u, 1.0) - 0.5)
        rate = (ratio * np.cos(angle) - ratio**2) / (1.0 - 2.0 * ratio * np.cos(angle) + ratio**2)
        return np.where(np.abs(angle) < np.pi / 4, rate, 0.0)

    w.set_belt(lambda t: speed * (1.0 + 0.4 * a * (wheel(t / turn + 0.1) - 0.25)))


@form("nonlinear_stiffness", source="Rusch 1969 (a block of foam: a power below one, and a steep one)", rig="lift")
def stiffness_of_foam(w: World, a: float) -> None:
    """Stiff, then yielding as its cells buckle, then stiff again as they close; at the reach the force is as stated."""
    k, reach = w.rig.stiffness, w.nominal.reach

    def foam(u):
        return 0.7 * np.sign(u) * np.sqrt(np.abs(u)) + 0.3 * u**3 * np.abs(u)

    w.spring = lambda s: k * ((1.0 - a) * s.x + a * reach * foam(s.x / reach))


@form("quadratic_damping", source="Achenbach 1972 (a sphere: its drag falls by half as the layer on it becomes turbulent)")
def drag_with_a_crisis(w: World, a: float) -> None:
    """The square of the speed below three quarters of the highest one, and half of that beyond."""
    drag(w, lambda u: u * np.abs(u) * (1.0 - 0.25 * (1.0 + np.tanh((np.abs(u) - 0.75) / 0.06))), 0.6 * a)


@form("backlash", source="Ravn 1998; Flores and others 2006 (a joint with oil in its play, which is squeezed out)")
def backlash_with_oil(w: World, a: float) -> None:
    """Slack over a ninth of a slip; near the wall that comes closer oil takes energy, and past it nothing does."""
    if a <= 0.0:
        return
    k, gap, at = w.rig.stiffness, 0.11 * a * w.nominal.slip_length, w.rig.reach - 0.55 * w.rig.slip_length
    film, most = 0.2 * gap, 0.5 * a * np.sqrt(w.rig.stiffness * w.rig.mass)

    def spring(s):
        inside = np.minimum(np.maximum(s.x - at, 0.0), gap)
        left = np.where(np.less(s.v, 0.0), inside, gap - inside)
        oil = most * (film / (film + left)) ** 2 * ((s.x > at) & (s.x < at + gap))
        return k * (s.x - inside) + oil * s.v

    w.spring = spring


@form("second_mode", source="Mann and Sims 2009 (a magnet on the box that floats between two others)")
def mode_of_a_floating_magnet(w: World, a: float) -> None:
    """Dipoles push as the inverse fourth power: ever stiffer, up to walls that it never touches."""
    mass, p, room = 0.15 * a * w.rig.mass, 1.6 * w.nominal.pulsation, 0.9 * w.nominal.slip_length

    def push(s):
        y = np.clip(s.q[0] / room, -0.8, 0.8)
        return p * p * room * ((1.0 - y) ** -4 - (1.0 + y) ** -4) / 8.0 + 0.06 * p * s.q[1]

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -push(s) - s.a)
    w.load = lambda s: mass * push(s)


@form("harmonic_force", source="Holtz 1992 (a linear motor on a six-step inverter: a staircase)")
def force_of_a_six_step_inverter(w: World, a: float) -> None:
    """One, two, one, and the same below: no even harmonics and no third ones."""
    force, turn = 0.1 * a * w.nominal.gap * w.nominal.normal_force, 1.41 * w.nominal.period
    starts = np.arange(6) / 6
    u, steps = np.ravel([starts + 0.01, starts + 0.157], order="F"), np.repeat([1.0, 2.0, 1.0, -1.0, -2.0, -1.0], 2)
    w.load = lambda s: force * np.interp(s.t / turn + 0.3, u, steps, period=1.0)


@form("impacts", source="Gordillo, Sun and Cheng 2018 (drops: the root of time, and an exponential); Marshall and Palmer 1948")
def impacts_of_drops(w: World, a: float) -> None:
    """Drops fall at random against the belt; their diameters are spread exponentially, their pushes as the cube of these."""
    times = arrivals(w.rng, w.duration, 0.9 / w.nominal.period)
    sizes = -0.35 * a * w.nominal.gap * w.nominal.normal_force * np.clip(w.rng.exponential(1.0, times.size), 0.6, 1.6) ** 3
    pulses(w, lambda u: np.sqrt(2.0 * np.e * u) * np.exp(-u), 0.2 / w.nominal.pulsation, sizes, times)
