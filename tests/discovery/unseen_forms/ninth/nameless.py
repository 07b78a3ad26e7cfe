"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible.

Each says why no name can be defended, or what speaks for the names that stand beside `unknown`.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, arrivals, steady_noise, warm
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form(
    UNKNOWN,
    "viscous_friction",
    "quadratic_damping",
    source="Dixon 2007 (a damper whose bushes are worn: it bears after some way)",
)
def damper_with_play(w: World, a: float) -> None:
    """Drag that begins late within each slip; drag by the speed alone says the rest of it."""
    if a <= 0.0:
        return
    k, p, half = w.rig.stiffness, w.nominal.pulsation, 0.1 * w.nominal.slip_length
    drag, mount = 0.5 * a * k / p, 8.0 * k

    def pull(s):
        return mount * (s.x - s.q[0] - np.clip(s.x - s.q[0], -half, half))

    w.q0 = (0.0,)
    w.rates = lambda s: (pull(s) / drag,)
    w.load = lambda s: -pull(s)


@form(UNKNOWN, "sensor_step", source="Slocum 1992 (a clamp that lets the spring's foot slip, once a run, at another time each)")
def clamp_slips(w: World, a: float) -> None:
    """All places move alike from then on, as if the zero had; yet nothing jumps while the box sticks."""
    force, at = 0.11 * a * w.rig.stiffness * w.nominal.slip_length, w.rng.uniform(0.35, 0.6) * w.duration
    w.foot = lambda t: -force * (t >= at)


@form(UNKNOWN, source="Kuhnen 2003 (a gauge with hysteresis: three plays, one within the other)")
def gauge_has_hysteresis(w: World, a: float) -> None:
    """A loop between stick and slip that has no time of its own: neither a delay, nor a spring, nor a gap in it."""
    halves = (0.02 * w.nominal.slip_length, 0.05 * w.nominal.slip_length, 0.1 * w.nominal.slip_length)

    def sensor(t, motion, rng):
        shown = motion.position.copy()
        for half in halves:
            last = motion.position[0]
            for i, x in enumerate(motion.position):
                last = min(max(last, x - half), x + half)
                shown[i] += 0.25 * a * (last - x)
        return shown

    w.sensor = sensor


@form(UNKNOWN, "belt_speed_ripple", source="Matern 1960; Krishnan 2001 (a drive without a tachometer: its speed wanders)")
def belt_wanders(w: World, a: float) -> None:
    """It is the belt's speed that differs, though by chance and not in a period."""
    speed, z = w.belt_velocity, steady_noise(w.rng, w.duration, 1.6 * w.nominal.period, order=2)
    w.set_belt(lambda t: speed * (1.0 + 0.12 * a * np.clip(z(t), -2.5, 2.5)))


@form(UNKNOWN, source="Flack and Hannaford 2005 (two gauges side by side: the second one takes over with another zero)")
def gauges_are_stitched(w: World, a: float) -> None:
    """A step of the reading by the place, there and back in each cycle; a step in time would stay."""
    place, off = w.rig.reach - 0.42 * w.rig.slip_length, 0.06 * a * w.nominal.slip_length
    w.sensor = lambda t, motion, rng: motion.position + off * (motion.position > place)


@form(
    UNKNOWN,
    "random_coefficients",
    "impacts",
    source="Harris and Piersol 2002 (lorries pass: the weight that presses is jolted, and swings)",
)
def weight_is_jolted(w: World, a: float) -> None:
    """Blows by chance, though on the load: a box that slides or is near break-away feels them, one that holds does not."""
    load, length = w.normal_force, 0.7 / w.nominal.pulsation
    grid = np.arange(0.0, w.duration + length, length / 24.0)
    swing = np.zeros_like(grid)
    for time in arrivals(w.rng, w.duration, 0.9 / w.nominal.period):
        i, j = np.searchsorted(grid, [time, time + 6.0 * length])
        u = (grid[i:j] - time) / length
        swing[i:j] += w.rng.uniform(0.5, 1.5) * np.exp(-u) * np.sin(3.0 * u)
    w.normal = lambda s: load * (1.0 - 0.2 * a * np.clip(np.interp(s.t, grid, swing), -2.0, 2.0))


@form(
    UNKNOWN,
    "velocity_weakening",
    "frictional_lag",
    source="Hess and Soom 1990; Armstrong-Helouvry 1991 (friction by the speed of a while ago)",
)
def film_follows_late(w: World, a: float) -> None:
    """A loop over the speed: weakening, and a memory, each says a half."""
    rig, top, tau = w.rig, w.nominal.peak_speed, 0.4 / w.nominal.pulsation
    w.q0 = (0.0,)
    w.rates = lambda s: ((np.abs(s.w) - s.q[0]) / tau,)
    w.mu_k = lambda s: rig.mu_k + 0.5 * a * w.nominal.gap * np.exp(-s.q[0] / (0.22 * top))


@form(UNKNOWN, "sensor_drift", source="Jaeger 1942; Czichos 1978 (the gauge's arm grows by the heat of friction)")
def arm_grows_by_friction(w: World, a: float) -> None:
    """A zero that drifts, though by the power of sliding: in each operating point to another end."""
    size, tau = 0.2 * a * w.nominal.slip_length, 7.0 * w.nominal.period
    usual = w.nominal.belt_velocity * w.nominal.normal_force

    def sensor(t, motion, rng):
        keep = np.exp(-(t[1] - t[0]) / tau)
        power = np.abs(w.belt(t) - motion.velocity) * w.normal_force / usual
        return motion.position + size * lfilter([1.0 - keep], [1.0, -keep], power)

    w.sensor = sensor


@form(
    UNKNOWN,
    "stale_samples",
    "sensor_delay",
    source="Yilmaz, Javed and Shah 2006 (a camera that loses what moves too fast, and finds it again)",
)
def tracker_loses_the_box(w: World, a: float) -> None:
    """The last place is shown again, though in each slip's fast part alone and not now and then."""
    if a <= 0.0:
        return
    limit = (1.0 - 0.6 * a) * 0.5 * w.nominal.slip_length * w.nominal.pulsation

    def sensor(t, motion, rng):
        seen = np.where(np.abs(motion.velocity) < limit, np.arange(t.size), 0)
        return motion.position[np.maximum.accumulate(seen)]

    w.sensor = sensor


@form(UNKNOWN, "sensor_delay", source="McCool 1984; Whitehouse 2002 (a plunger that cannot fall as fast as the box retreats)")
def plunger_leaves_the_box(w: World, a: float) -> None:
    """Late in each slip and right in each stick; one delay cannot be both."""
    if a <= 0.0:
        return
    falls = 0.85 / (1.0 + 1.4 * a) * 0.5 * w.nominal.slip_length * w.nominal.pulsation**2

    def sensor(t, motion, rng):
        h, shown = t[1] - t[0], np.empty(t.size)
        place, speed = motion.position[0], motion.velocity[0]
        for i, (x, v) in enumerate(zip(motion.position, motion.velocity, strict=True)):
            place, speed = place + speed * h - 0.5 * falls * h * h, speed - falls * h
            if place <= x:
                place, speed = x, v
            shown[i] = place
        return shown

    w.sensor = sensor


@form(UNKNOWN, "temperature_drift", source="Doebelin 2004 (a gauge whose gain follows the recorded temperature)")
def gain_by_the_thermometer(w: World, a: float) -> None:
    """Places of break-away and of stick grow alike, as if friction did; what rides on the belt would not."""
    warm(w)
    celsius = vars(w)["temperature"]
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.012 * a * (celsius(t) - 20.0))


@form(UNKNOWN, "harmonic_force", source="Tajimi 1960; Crandall and Mark 1963 (a building that sways: a narrow band of chance)")
def building_sways(w: World, a: float) -> None:
    """For some cycles it is a harmonic force, though with no phase that it keeps."""
    force, f = 0.13 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 0.43 / w.nominal.period
    z, y = (steady_noise(w.rng, w.duration, 4.0 * w.nominal.period) for _ in range(2))
    w.load = lambda s: force * (z(s.t) * np.cos(f * s.t) + y(s.t) * np.sin(f * s.t))
