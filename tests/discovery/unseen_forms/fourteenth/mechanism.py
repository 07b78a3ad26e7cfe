"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Freudenstein 1955 (a crank and a rocker press the box: slower one way than the other)")
def load_of_a_rocker(w: World, a: float) -> None:
    """The angle of a rocker; crank, coupler and rocker are 0.35, 1.2 and 0.7 of the distance of the pivots."""
    load, turn, (crank, coupler, rocker) = w.normal_force, 5.3 * w.nominal.period, (0.35, 1.2, 0.7)
    u = np.linspace(0.0, 1.0, 2001)
    pin = crank * np.exp(2j * np.pi * u) - 1.0  # as the rocker's pivot sees it
    far = np.abs(pin)
    angle = np.mod(np.angle(pin), 2 * np.pi) - np.arccos((rocker**2 + far**2 - coupler**2) / (2.0 * rocker * far))
    shape = (angle - angle[:-1].mean()) / np.ptp(angle)
    w.normal = lambda s: load * (1.0 + 0.18 * a * np.interp(np.mod(s.t / turn + 0.2, 1.0), u, shape))


@form("belt_speed_ripple", source="Lord 2003 (a winder whose speed is wobbled: a triangle, with a jump where it turns)")
def belt_that_is_wobbled(w: World, a: float) -> None:
    """Straight up and down, so that threads do not lie on one another; the mean speed is as stated."""
    speed, turn = w.belt_velocity, 1.9 * w.nominal.period
    u, wobble = (0.0, 0.48, 0.5, 0.98, 1.0), (-0.35, 0.5, 0.35, -0.5, -0.35)
    w.set_belt(lambda t: speed * (1.0 + 0.4 * a * np.interp(t / turn + 0.3, u, wobble, period=1.0)))


@form("nonlinear_stiffness", source="Bisshopp and Drucker 1945 (a leaf spring that bends far: its end comes nearer)", rig="tap")
def stiffness_of_a_long_leaf(w: World, a: float) -> None:
    """As stiff as believed at rest; at the reach the leaf is bent aside by 0.55 of its length."""
    if a <= 0.0:
        return
    k, span = w.rig.stiffness, w.nominal.reach / (0.55 * a)
    slope = np.concatenate([np.geomspace(1e-4, 1e-2, 20), np.linspace(0.02, 1.5, 300)])
    m = 0.5 * (1.0 + np.sin(slope))
    begins = np.arcsin(np.sqrt(0.5 / m))
    root = ellipk(m) - ellipkinc(begins, m)  # of force times length squared over bending stiffness
    aside = np.append(0.0, 1.0 - 2.0 * (ellipe(m) - ellipeinc(begins, m)) / root)
    force = np.append(0.0, root**2 / 3.0)
    w.spring = lambda s: k * span * np.sign(s.x) * np.interp(np.abs(s.x) / span, aside, force)


@form("quadratic_damping", source="Vogel 1984; Alben, Shelley and Zhang 2002 (a thin vane that bends: the square, then 4/3)")
def drag_of_a_bending_vane(w: World, a: float) -> None:
    """The square of the speed up to about a quarter of the highest one; beyond it the vane gives way."""
    drag(w, lambda u: u * np.abs(u) * ((1.0 + 16.0) / (1.0 + 16.0 * u * u)) ** (1 / 3), 0.5 * a)


@form("backlash", source="Menon and Krishnamurthy 1999 (a pin that rubs as it crosses its clearance)")
def backlash_of_a_rubbing_pin(w: World, a: float) -> None:
    """Slack over a tenth of a slip, where the pin's own friction is a twelfth of the fall of friction."""
    if a <= 0.0:
        return
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.5 * w.rig.slip_length
    rub, slow = a * w.nominal.gap * w.nominal.normal_force / 12.0, 0.3 * w.nominal.belt_velocity

    def spring(s):
        inside = np.minimum(np.maximum(s.x - at, 0.0), gap)
        rubs = np.minimum(np.minimum(inside, gap - inside) / (0.1 * gap), 1.0)
        return k * (s.x - inside) + rub * rubs * np.tanh(s.v / slow)

    w.spring = spring


@form("second_mode", source="Bernoulli 1733; Lamb 1920 (a cable that hangs from the box: Bessel's zeros)", rig="platen")
def mode_of_a_hanging_cable(w: World, a: float) -> None:
    """A quarter of the box's mass; its first three modes, of which the lowest is somewhat slower than the rig."""
    if a <= 0.0:
        return
    zeros = np.array([2.404826, 5.520078, 8.653728])
    masses = 0.25 * a * w.rig.mass * 4.0 / zeros**2
    p = 0.8 * w.nominal.pulsation * zeros / zeros[0]

    def pulls(s):
        return [p[i] ** 2 * s.q[2 * i] + 2.0 * 0.03 * p[i] * s.q[2 * i + 1] for i in range(3)]

    def rates(s):
        pull = pulls(s)
        return (s.q[1], -pull[0] - s.a, s.q[3], -pull[1] - s.a, s.q[5], -pull[2] - s.a)

    w.q0, w.rates = (0.0,) * 6, rates
    w.load = lambda s: sum(mass * pull for mass, pull in zip(masses, pulls(s), strict=True))


@form("harmonic_force", source="Dincer 2003 (a refrigerator whose compressor is on and off by turns; its motor is synchronous)")
def force_of_a_refrigerator(w: World, a: float) -> None:
    """A tone for eight cycles of thirteen, and then silence; the phase is that of the mains."""
    force, turn = 0.24 * a * w.nominal.gap * w.nominal.normal_force, 13.0 * w.nominal.period
    f = 2 * np.pi * 1.27 / w.nominal.period
    u, runs = (0.0, 0.03, 8 / 13, 8 / 13 + 0.03), (0.0, 1.0, 1.0, 0.0)
    w.load = lambda s: force * np.cos(f * s.t + 0.8) * np.interp(np.mod(s.t / turn + 0.1, 1.0), u, runs)


@form("impacts", source="Galbraith and Barton 1970 (somebody steps on the frame: the heel, then the ball of the foot)")
def impacts_of_footsteps(w: World, a: float) -> None:
    """People pass now and then, at random; each pushes against the belt, in two humps."""
    times = arrivals(w.rng, w.duration, 0.6 / w.nominal.period)
    sizes = -0.8 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.5, 1.5, times.size)

    def step(u):
        return np.where(u < 1.0, np.sin(np.pi * u) + 0.35 * np.sin(3.0 * np.pi * u), 0.0)

    pulses(w, step, 2.0 / w.nominal.pulsation, sizes, times)
