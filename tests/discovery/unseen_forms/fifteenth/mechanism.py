"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.third.mechanism import absorbers

from .enter import form


@form("normal_load_ripple", source="Anderson and Knapp 1990 (a disc with hot spots: four bumps a turn, unequally high)")
def load_of_hot_spots(w: World, a: float) -> None:
    """Round bumps, evenly apart; the mean is as stated."""
    load, turn, heights = w.normal_force, 9.1 * w.nominal.period, (1.0, 0.55, 0.8, 0.35)
    u = np.linspace(0.0, 1.0, 4001)
    bumps = sum(h * np.exp(-(((np.mod(u - 0.25 * i, 1.0) - 0.5) / 0.06) ** 2)) for i, h in enumerate(heights))
    bumps = bumps - bumps[:-1].mean()
    w.normal = lambda s: load * (1.0 + 0.18 * a * np.interp(np.mod(s.t / turn + 0.3, 1.0), u, bumps))


@form("belt_speed_ripple", source="Bollen 2000 (the mains sag as a pump on a timer starts: a dip, and slowly back)")
def belt_on_sagging_mains(w: World, a: float) -> None:
    """Down within a tenth of the time along half a cosine, back exponentially; the mean speed is as stated."""
    speed, turn, down, back = w.belt_velocity, 1.43 * w.nominal.period, 0.1, 0.25
    u, left = np.arange(4000) / 4000, np.exp(-(1.0 - down) / back)
    falls = left + (1.0 - left) * 0.5 * (1.0 - np.cos(np.pi * u / down))
    dip = np.where(u < down, falls, np.exp(-(u - down) / back))
    dip = dip - dip.mean()
    w.set_belt(lambda t: speed * (1.0 - 0.42 * a * np.interp(t / turn + 0.4, u, dip, period=1.0)))


@form(
    "nonlinear_stiffness", source="Timoshenko 1956 (a leaf that lies down on a round block: its free end shortens)", rig="fader"
)
def stiffness_on_a_round_block(w: World, a: float) -> None:
    """As stiff as believed up to 0.7 of the reach; from there the force is the inverse root of what is left of the way."""
    k, at = w.rig.stiffness, 0.7 * w.nominal.reach

    def wrapped(u):
        v = np.clip(u, 1.0, 1.4)
        return np.minimum(u, 1.0) - 1.0 + (3.0 - 2.0 * v) ** -0.5 + np.maximum(u - 1.4, 0.0) * 0.2**-1.5

    w.spring = lambda s: k * ((1.0 - a) * s.x + a * at * np.sign(s.x) * wrapped(np.abs(s.x) / at))


@form(
    "quadratic_damping", source="White 1991 (a wire across its own wind: the square, and a power 4/3 at low Reynolds numbers)"
)
def drag_of_a_wire(w: World, a: float) -> None:
    """1 + 10 Re^(-2/3), and a hundred at the highest speed: two thirds of the drag there are the square."""
    more = 10.0 * 100.0 ** (-2 / 3)
    drag(w, lambda u: np.sign(u) * (u * u + more * np.abs(u) ** (4 / 3)) / (1.0 + more), 0.5 * a)


@form("backlash", source="Fisher and Rumpf 1965 (three bolts in wide holes: they let go, and bear again, one by one)")
def backlash_of_three_bolts(w: World, a: float) -> None:
    """Slack in the middle; to either side a third of the stiffness comes with each bolt, unevenly spread."""
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.6 * w.rig.slip_length
    way = np.cumsum([0.0, 0.2, 0.35, 0.5, 0.15, 0.4])
    lost = np.concatenate([[0.0], np.cumsum(np.diff(way) * np.array([1.0, 2.0, 3.0, 2.0, 1.0]) / 3.0)])
    if a > 0.0:
        w.spring = lambda s: k * (s.x - gap * np.interp((s.x - at) / gap, way, lost))


@form("second_mode", source="Euler 1744; Bishop and Johnson 1960 (a mast on the box: a clamped rod's first two bending modes)")
def mode_of_a_mast(w: World, a: float) -> None:
    """A quarter of the box's mass, of which 0.613 and 0.188 swing; one and a half times as fast as the rig, and 9.4 times."""
    absorbers(w, ((0.25 * 0.6131 * a, 1.5, 0.02, 0.0), (0.25 * 0.1883 * a, 1.5 * 6.267, 0.02, 0.0)))


@form("harmonic_force", source="Lander 1993 (a magnet behind a thyristor: of each half wave the last part alone)")
def force_of_a_phase_control(w: World, a: float) -> None:
    """Nothing for 70 degrees, then up to the sine and along it; both halves alike, so that there is no mean."""
    force, f = 0.26 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.23 / w.nominal.period
    fires, rise = np.deg2rad(70.0), 0.12

    def let_through(angle):
        return np.sin(angle) * np.clip((np.mod(angle, np.pi) - fires) / rise, 0.0, 1.0)

    w.load = lambda s: force * let_through(f * s.t + 0.9)


@form("impacts", source="Krylov 1995; Heckl, Hauck and Wettschureck 1996 (wagons pass: two axles, and two more)")
def impacts_of_axles(w: World, a: float) -> None:
    """Wagons come by chance; each pushes against the belt four times within a natural period or so, as Gauss's curve."""
    times = arrivals(w.rng, w.duration, 0.55 / w.nominal.period)
    sizes = -0.8 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.6, 1.4, times.size)

    def axles(u):
        return sum(np.exp(-(((u - at) / 0.15) ** 2)) for at in (0.45, 1.05, 2.6, 3.2))

    pulses(w, axles, 1.8 / w.nominal.pulsation, sizes, times)
