"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

import numpy as np
from scipy.fft import dct, idct

from tests.discovery.unseen_forms.forms import UNKNOWN
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(UNKNOWN, source="Janovsky 1999 (an overspeed governor that trips in each slip, and is set again at rest)", rig="lift")
def governor_trips_in_each_slip(w: World, a: float) -> None:
    """A brake between box and frame, off while the box speeds up and on until it stands: no curve of speed, way or time."""
    force, trips = 0.25 * a * w.nominal.gap * w.nominal.normal_force, 0.45 * w.nominal.peak_speed
    now = {"on": False}

    def load(s: State) -> float:
        speed = -s.direction * float(np.mean(s.v))
        now["on"] = now["on"] or speed > trips
        return s.direction * force * (now["on"] and speed > 0.0)

    w.load = load
    w.on_stick = w.on_break = lambda s: now.update(on=False)


@form(UNKNOWN, source="Whiteman and Ferri 1996 (dry friction that hangs on the place: a felt beside a part of the stroke)")
def felt_rubs_along_a_part(w: World, a: float) -> None:
    """Slips lose way to it at any speed, and break-away, beyond the felt, is as stated; a spring would give back."""
    force, slow = 0.3 * a * w.nominal.gap * w.nominal.normal_force, 0.3 * w.nominal.belt_velocity
    low, high = (w.rig.reach - part * w.rig.slip_length for part in (0.75, 0.55))  # below break-away under the least load, too
    edge = 0.02 * w.rig.slip_length

    def felt(x):
        return 0.5 * (np.tanh((x - low) / edge) - np.tanh((x - high) / edge))

    w.load = lambda s: -force * felt(s.x) * np.tanh(s.v / slow)


@form(
    UNKNOWN, source="Marone, Scholz and Bilham 1991 (afterslip: a creep after each slip, by the logarithm of time)", rig="ice"
)
def box_creeps_on_after_each_slip(w: World, a: float) -> None:
    """It falls back behind the belt while it should stick, the most when the pull is least: no contact yields like that."""
    if a <= 0.0:
        return
    v, tau = w.belt_velocity, 0.02 * w.nominal.period * w.nominal.belt_velocity / abs(w.belt_velocity)
    since = {"time": 0.0, "travel": 0.0, "size": 0.0}

    def travel(t):
        u = np.maximum(t - since["time"], 0.0)
        return since["travel"] + v * u - since["size"] * np.log1p(u / tau)

    def set_out(s: State, size: float) -> None:
        since.update(travel=float(travel(s.t)), time=s.t, size=size)

    w.travel = travel
    w.belt = lambda t: v - since["size"] / (tau + np.maximum(t - since["time"], 0.0))
    w.belt_acceleration = lambda t: since["size"] / (tau + np.maximum(t - since["time"], 0.0)) ** 2
    w.on_stick = lambda s: set_out(s, 0.016 * a * np.sign(v) * w.nominal.slip_length)
    w.on_break = lambda s: set_out(s, 0.0)


@form(UNKNOWN, source="Ahmed, Natarajan and Rao 1974; Wallace 1992 (a logger that compresses by cosines)", rig="jewel")
def logger_compresses_blocks(w: World, a: float) -> None:
    """Each block of 64 rings in its own way, before a slip as much as after it, and the same slip never twice alike."""
    if a <= 0.0:
        return
    step = 0.25 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        x = np.pad(motion.position, (0, -t.size % 64), "edge").reshape(-1, 64)
        kept = step * np.round(dct(x, norm="ortho") / step)
        return idct(kept, norm="ortho").ravel()[: t.size]

    w.sensor = sensor


@form(UNKNOWN, source="Daniel, Mee and Clark 1999 (print-through: a tape whose neighbouring layers leave a copy of each slip)")
def tape_prints_through(w: World, a: float) -> None:
    """A faint slip a layer before each slip and another a layer after it: no delay is early, and no force is both."""
    layer, copy = 0.37 * w.nominal.period, 0.07 * a

    def sensor(t, motion, rng):
        before, after = (np.interp(t + shift, t, motion.position) for shift in (layer, -layer))
        return (motion.position + copy * (before + after)) / (1.0 + 2.0 * copy)

    w.sensor = sensor


@form(UNKNOWN, source="Catt 1967 (crosstalk: the channel beside, of another rig that sticks and slips in its own time)")
def channel_beside_leaks_in(w: World, a: float) -> None:
    """Ramps and drops of the reading that nothing in the motion answers; they come unevenly and leave no step behind."""
    usual, count = 0.618 * w.nominal.period, int(3.0 * w.duration / w.nominal.period) + 20
    slips = np.cumsum(usual * w.rng.uniform(0.7, 1.3, count)) - usual

    def sensor(t, motion, rng):
        i = np.searchsorted(slips, t)
        begins = np.where(i > 0, slips[i - 1], slips[0] - usual)
        return motion.position + 0.19 * a * w.nominal.slip_length * ((t - begins) / usual - 0.5)

    w.sensor = sensor


@form(UNKNOWN, source="Tektronix 2009 (peak detection: the least and the greatest of a dozen readings, always in this order)")
def logger_keeps_the_extremes(w: World, a: float) -> None:
    """Early for half of each dozen and late for the other half: a saw in each slip, that no force and no delay makes."""
    half = round(6.0 * a)
    if half < 1:
        return

    def sensor(t, motion, rng):
        x = np.pad(motion.position, (0, -t.size % (2 * half)), "edge").reshape(-1, 2 * half)
        return np.repeat(np.column_stack([x.min(1), x.max(1)]), half, axis=1).ravel()[: t.size]

    w.sensor = sensor


@form(UNKNOWN, source="Razavi 2004 (pulling: a logger's clock that runs faster, the higher the reading)", rig="lift")
def clock_is_pulled_by_the_signal(w: World, a: float) -> None:
    """Stick phases bend upwards and slips begin early, though lengths and period are as stated: neither belt nor delay."""

    def sensor(t, motion, rng):
        pull = (motion.position - motion.position.mean()) / w.rig.slip_length
        return np.interp(t + 0.15 * a * np.cumsum(pull) * (t[1] - t[0]), t, motion.position)

    w.sensor = sensor
