"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Dall 1946; Rowe and Barash 1964 (a roller ground without centres: three lobes and five)")
def load_of_a_lobed_roller(w: World, a: float) -> None:
    """Nothing once a turn, which is fourteen cycles; the mean is as stated."""
    load, turn = w.normal_force, 14.0 * w.nominal.period / (2 * np.pi)
    w.normal = lambda s: load * (1.0 + a * (0.06 * np.cos(3.0 * s.t / turn + 0.5) + 0.045 * np.cos(5.0 * s.t / turn + 2.0)))


@form("belt_speed_ripple", source="Wittenbauer 1923 (an engine of four strokes and its flywheel)")
def belt_of_a_gas_engine(w: World, a: float) -> None:
    """Driven up in one stroke, held back in the one before, and slowing in the others; the mean speed is as stated."""
    speed, cycle = w.belt_velocity, 2.3 * w.nominal.period
    u = np.arange(4096) / 4096
    strokes = np.repeat([0.0, 0.3, 1.0, 0.0], 1024)  # it draws in, is held back as it compresses, is driven, and lets out
    push = strokes * np.sin(4 * np.pi * u)
    rate = np.cumsum(push - push.mean())
    shape = (rate - rate.mean()) / np.ptp(rate)
    w.set_belt(lambda t: speed * (1.0 + 0.4 * a * np.interp(t / cycle + 0.15, u, shape, period=1.0)))


@form("nonlinear_stiffness", source="Virgin and Davis 2003 (a strut that buckles: stiff up to its load, and yielding beyond)")
def stiffness_of_a_strut(w: World, a: float) -> None:
    """From the middle of a slip up it has two fifths of its stiffness; at the reach the force is as stated."""
    k, reach, at, bend = w.rig.stiffness, w.nominal.reach, w.nominal.mu_k / w.nominal.mu_s, 0.04

    def strut(u):
        return u - 0.6 * bend * (np.logaddexp(0.0, (u - at) / bend) - np.logaddexp(0.0, -at / bend))

    full = strut(1.0)
    w.spring = lambda s: k * ((1.0 - a) * s.x + a * reach * np.sign(s.x) * strut(np.abs(s.x) / reach) / full)


@form(
    "quadratic_damping",
    source="Milwitzky and Cook 1953 (an undercarriage: a pin narrows its hole along the stroke)",
    rig="fork",
)
def drag_with_a_metering_pin(w: World, a: float) -> None:
    """The square of the speed; at the end of a slip more than twice as much as at its beginning."""
    rig, top, slip = w.rig, w.nominal.peak_speed, w.nominal.slip_length
    force, begins = 0.35 * a * w.nominal.gap * w.nominal.normal_force, w.nominal.reach

    def pin(x):
        return 1.0 + 1.2 * np.minimum(np.maximum((begins - x) / slip, 0.0), 1.0)

    w.damping = lambda s: rig.damping * s.v + force * pin(s.x) * s.v * np.abs(s.v) / top**2


@form("backlash", source="Erkaya and Uzmay 2010 (a linkage whose three joints are worn, one more than the other)")
def backlash_of_a_linkage(w: World, a: float) -> None:
    """The joints hang slack one after the other as the spring lets go: 0.03, 0.065 and 0.045 of a slip."""
    k, reach, slip = w.rig.stiffness, w.rig.reach, w.rig.slip_length

    def taken(x, at: float, gap: float):
        return np.minimum(np.maximum(x - reach + at * slip, 0.0), a * gap * slip)

    w.spring = lambda s: k * (s.x - taken(s.x, 0.28, 0.03) - taken(s.x, 0.55, 0.065) - taken(s.x, 0.8, 0.045))


@form("second_mode", source="Donkin and Clark 1929 (a heavy coil spring that surges)", rig="fork")
def mode_of_a_heavy_spring(w: World, a: float) -> None:
    """The coils move as a mass of their own between two halves of the spring, 2.6 times as fast as the box on it."""
    if a <= 0.0:
        return
    k, mass = w.rig.stiffness, 0.6 * a * w.rig.mass
    damping = 0.06 * np.sqrt(4.0 * k * mass)
    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], (2.0 * k * (s.x - 2.0 * s.q[0]) - damping * s.q[1]) / mass)
    w.spring = lambda s: 2.0 * k * (s.x - s.q[0])


@form(
    "harmonic_force",
    source="Martellotti 1941; Altintas 2000 (a milling cutter: each chip thickens as a sine, and ends)",
    rig="mill",
)
def force_of_a_milling_cutter(w: World, a: float) -> None:
    """Two teeth, each in the work for 110 degrees of its turn; the mean is taken off."""
    force, tooth, ends = 0.4 * a * w.nominal.gap * w.nominal.normal_force, 1.27 * w.nominal.period, 110.0 / 180.0
    u = np.linspace(0.0, 1.0, 2001)
    chip = np.sin(np.pi * u) * np.clip((ends + 0.02 - u) / 0.02, 0.0, 1.0)
    chip = chip - chip[:-1].mean()
    w.load = lambda s: force * np.interp((s.t / tooth + 0.4) % 1.0, u, chip)


@form(
    "impacts", source="Joukowsky 1898 (a valve slams: pressure goes to and fro in the pipe, square and ever weaker)", rig="seal"
)
def impacts_of_a_water_hammer(w: World, a: float) -> None:
    """Somebody shuts a tap now and then, at random; each wave is 0.6 of the one before, and the other way."""
    times = arrivals(w.rng, w.duration, 0.7 / w.nominal.period)
    sizes = a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.5, 1.5, times.size)
    pulses(w, lambda u: (-0.6) ** np.floor(u), 0.35 / w.nominal.pulsation, sizes, times)
