"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Maxwell 1873 (a magnet presses across a gap that runs out: the inverse square)")
def load_of_a_magnet(w: World, a: float) -> None:
    """Sharp where the gap is narrow, broad where it is wide; the mean is as stated."""
    load, turn, out = w.normal_force, 2 * np.pi / (4.9 * w.nominal.period), 0.35
    mean = (1.0 - out**2) ** -1.5
    w.normal = lambda s: load * (1.0 + 0.12 * a * ((1.0 - out * np.cos(turn * s.t + 0.6)) ** -2 / mean - 1.0))


@form("belt_speed_ripple", source="Redfield and Hull 1986 (a treadle: two pushes a turn, a rectified sine)")
def belt_of_a_treadle(w: World, a: float) -> None:
    """The mean speed is as stated."""
    speed, push = w.belt_velocity, 1.23 * w.nominal.period
    w.set_belt(lambda t: speed * (1.0 + 0.45 * a * (np.abs(np.sin(np.pi * t / push + 0.5)) - 2.0 / np.pi)))


@form("nonlinear_stiffness", source="Mindlin 1945 (a cushion that is pressed flat: a tangent)")
def stiffness_of_a_cushion(w: World, a: float) -> None:
    """As stiff as believed at rest; flat at 1.7 of the reach, and straight from nine tenths of that on."""
    k, flat, share = w.rig.stiffness, 1.7 * w.nominal.reach, 0.6 * a
    turn = 0.5 * np.pi / flat
    end = 0.9 * flat

    def push(x):
        inside = np.clip(x, -end, end)
        return np.tan(turn * inside) / turn + (x - inside) / np.cos(turn * end) ** 2

    w.spring = lambda s: k * ((1.0 - share) * s.x + share * push(s.x))


@form("quadratic_damping", source="Lang 1977; Dixon 2007 (a damper with a check valve: three times as strong one way)")
def drag_with_a_check_valve(w: World, a: float) -> None:
    """The square of the speed either way; the strong way is that of slips."""
    drag(w, lambda u: u * np.abs(u) * np.where(u < 0.0, 1.0, 1.0 / 3.0), 0.45 * a)


@form("backlash", source="Ding and Kahraman 2007 (worn teeth: the gap opens along a parabola, and closes at once)")
def backlash_of_worn_teeth(w: World, a: float) -> None:
    """Softer and softer over two thirds of the gap, slack over the last third."""
    k, gap, at = w.rig.stiffness, 0.12 * a * w.nominal.slip_length, w.rig.reach - 0.62 * w.rig.slip_length

    def lost(x):
        z = np.clip((x - at) / gap, 0.0, 1.5)
        return gap * np.where(z < 1.0, 0.5 * z * z, z - 0.5)

    if a > 0.0:
        w.spring = lambda s: k * (s.x - 0.97 * lost(s.x))


@form("second_mode", source="Ren 2001; Liu and Liu 2005 (an absorber whose damper is fixed to the ground)")
def mode_damped_to_the_ground(w: World, a: float) -> None:
    """The box feels the absorber's spring alone."""
    mass, p, share = 0.17 * a * w.rig.mass, 2.1 * w.nominal.pulsation, 0.05
    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -p * p * s.q[0] - 2.0 * share * p * (s.q[1] + s.v) - s.a)
    w.load = lambda s: mass * p * p * s.q[0]


@form("harmonic_force", source="Lowson 1970 (a fan beside the rig: a puff with each blade)")
def force_of_a_fan(w: World, a: float) -> None:
    """Round puffs, a third of the time each; no mean."""
    force, f = 0.35 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.17 / w.nominal.period
    mean = np.exp(-2.5) * np.i0(2.5)
    w.load = lambda s: force * (np.exp(2.5 * (np.cos(f * s.t + 1.3) - 1.0)) - mean)


@form("impacts", source="Jacobsen and Ayre 1958; Lalanne 2002 (triangles of equal sides, exponential sizes, either sign)")
def impacts_triangular(w: World, a: float) -> None:
    """Arrivals by chance; the largest are four times the mean."""
    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = 0.9 * a * w.nominal.gap * w.nominal.normal_force * np.minimum(w.rng.exponential(1.0, times.size), 4.0)
    sizes *= w.rng.choice([-1.0, 1.0], times.size)
    pulses(w, lambda u: np.maximum(1.0 - np.abs(2.0 * u - 1.0), 0.0), 0.5 / w.nominal.pulsation, sizes, times)
