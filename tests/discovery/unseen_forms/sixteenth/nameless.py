"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import uniform_filter1d

from tests.discovery.unseen_forms.forms import UNKNOWN
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

GRAVITY = 9.81
"""[m/s^2]."""


@form(
    UNKNOWN,
    source="Blau 2009, chapter 3 (dead weights press the box onto the belt, and ride along with it)",
    rig="sash",
    designs=("several",),
)
def dead_weights_ride_along(w: World, a: float) -> None:
    """Slips last longer under more load, and go as far as stated: no coefficient that hangs on the load does that."""
    mass = w.rig.mass + a * (w.normal_force - w.rig.normal_force) / GRAVITY
    w.mass = lambda t: mass


@form(
    UNKNOWN,
    source="Middleton and Spilhaus 1953 (a rain gauge's tank on the box, that a siphon empties when full)",
    rig="points",
)
def tank_fills_and_is_siphoned(w: World, a: float) -> None:
    """Slips last ever longer for five cycles and soon as short again, over the same way; an empty tank weighs nothing."""
    mass, turn, begins = w.rig.mass, 6.4 * w.nominal.period, w.rng.random()
    w.mass = lambda t: mass * (1.0 + 0.6 * a * np.interp(np.mod(t / turn + begins, 1.0), [0.0, 0.85, 1.0], [0.0, 1.0, 0.0]))


@form(
    UNKNOWN,
    source="Harrison 1983; Nordell and Ciozda 1984 (each slip sends a wave round the belt, which passes the box twice)",
    rig="wedge",
)
def wave_runs_round_the_belt(w: World, a: float) -> None:
    """The box is carried on and back while it sticks, a set time after each slip: no mode waits so, no ripple starts anew."""
    v, height, width = w.belt_velocity, 0.07 * a * w.nominal.slip_length * np.sign(w.belt_velocity), 0.025 * w.nominal.period
    passes, sizes = np.array([0.12, 0.24]) * w.nominal.period, np.array([1.0, 0.5]) * height
    since = {"time": 0.0, "travel": 0.0, "wave": 0.0}

    def humps(t):
        u = (np.asarray(t)[..., None] - since["time"] - passes) / width
        return u, since["wave"] * sizes * np.exp(-0.5 * u**2)

    def travel(t):
        return since["travel"] + v * (t - since["time"]) + humps(t)[1].sum(-1)

    def belt(t):
        u, hump = humps(t)
        return v - (u * hump).sum(-1) / width

    def belt_acceleration(t):
        u, hump = humps(t)
        return ((u**2 - 1.0) * hump).sum(-1) / width**2

    def set_out(s: State, wave: float) -> None:
        since.update(travel=float(travel(s.t)), time=s.t, wave=wave)

    w.travel, w.belt, w.belt_acceleration = travel, belt, belt_acceleration
    w.on_stick, w.on_break = lambda s: set_out(s, 1.0), lambda s: set_out(s, 0.0)


@form(
    UNKNOWN,
    source="Pawley 2006 (a scanner that sweeps to and fro, whose way back is not turned round in the file)",
    rig="organ",
    end=0.25,
)
def scanner_sweeps_to_and_fro(w: World, a: float) -> None:
    """Each second sweep, of a tenth of a cycle, is back to front: time itself runs back there, as early as late."""
    sweep = round(0.1 * a * w.nominal.period * w.nominal.rate)
    if sweep < 2:
        return

    def sensor(t, motion, rng):
        x = np.pad(motion.position, (0, -t.size % (2 * sweep)), "edge").reshape(-1, 2, sweep).copy()
        x[:, 1] = x[:, 1, ::-1]
        return x.ravel()[: t.size]

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Enz and Temes 1996 (an amplifier that zeroes itself by a clock, and takes a part of the signal for its offset)",
    rig="sash",
)
def amplifier_zeroes_itself(w: World, a: float) -> None:
    """Another zero each 1.37 cycles, up or down by where the box was just then: the zero neither drifts, nor steps once."""
    apart, middle = 1.37 * w.nominal.period, w.rig.reach - 0.5 * w.rig.slip_length

    def sensor(t, motion, rng):
        caught = np.interp(apart * np.floor(t / apart), t, motion.position)
        return motion.position - 0.25 * a * (caught - middle)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Hickman 2001 (a recorder that each slip triggers, blind until it is armed anew; nobody notes the time between)",
    rig="wedge",
    end=4.5,
)
def recorder_is_blind_after_each_slip(w: World, a: float) -> None:
    """A twentieth of a cycle is cut out after each slip, where the reading leaps on: the places of slips are as stated."""
    blind = 0.05 * a * w.nominal.period

    def sensor(t, motion, rng):
        ends = motion.sticks[:, 0]
        return np.interp(t + blind * np.searchsorted(ends - blind * np.arange(ends.size), t), t, motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Haar 1910; Donoho 1995 (somebody has hushed the record: small wavelets are taken out)", rig="fader")
def record_is_hushed_by_wavelets(w: World, a: float) -> None:
    """Rides are uneven stairs about the truth, and slips lose their details: as early as late, and not what was last read."""
    least, levels = 0.2 * a * w.nominal.slip_length, 5

    def sensor(t, motion, rng):
        means, details = np.pad(motion.position, (0, -t.size % 2**levels), "edge"), []
        for _ in range(levels):
            even, odd = means[::2], means[1::2]
            means, d = (even + odd) / np.sqrt(2.0), (even - odd) / np.sqrt(2.0)
            details.append(np.sign(d) * np.maximum(np.abs(d) - least, 0.0))
        for d in reversed(details):
            means = (np.column_stack([means + d, means - d]) / np.sqrt(2.0)).ravel()
        return means[: t.size]

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Nayar and Nakagawa 1994; He, Zhou and Hong 2003 (after each slip a camera climbs past its focus, and back)",
    rig="girder",
)
def camera_hunts_for_its_focus(w: World, a: float) -> None:
    """The gain goes up or down by three steps and back within half of a cycle, by chance: no force moves a stuck box so."""
    step, levels = 0.08 * w.nominal.period, np.array([0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0])

    def sensor(t, motion, rng):
        ends = np.append(-np.inf, motion.sticks[:, 0])
        last = np.searchsorted(ends, t, "right") - 1
        ways = w.rng.choice([-1.0, 1.0], ends.size)
        now = levels[np.minimum((t - ends[last]) / step + 1.0, 6.0).astype(int)]
        return motion.position * (1.0 + 0.055 * a * ways[last] * now)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Kopetz 1997 (each slip is a message of its own, put in at the tick of the clock that is nearest to its trigger)",
    rig="points",
    end=0.15,
)
def slips_are_put_at_ticks(w: World, a: float) -> None:
    """Rides are cut short or drawn out amid, by up to a tenth of a cycle; no two slips are late alike, and half are early."""
    tick = 0.2 * a * w.nominal.period
    if tick <= 0.0:
        return

    def sensor(t, motion, rng):
        begins = motion.breaks[:, 0]
        put = tick * np.round(begins / tick)
        late = np.append(0.0, put - begins)[np.searchsorted(put - 0.25 * w.nominal.period, t)]
        return np.interp(t - late, t, motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Godin 1972 (a program takes tides out: a part of the running mean over half a cycle)", rig="fader")
def running_mean_is_taken_away(w: World, a: float) -> None:
    """The reading falls before each slip as much as it rises after it, as no gauge that leaks does; the mean is put back."""
    size = round(0.45 * w.nominal.period * w.nominal.rate)

    def sensor(t, motion, rng):
        mean = uniform_filter1d(motion.position, size, mode="nearest")
        return motion.position - 0.5 * a * (mean - mean.mean())

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Lamport 1978 (two loggers stand in for one another by turns, and their clocks differ)",
    rig="girder",
    end=0.05,
)
def loggers_stand_in_for_one_another(w: World, a: float) -> None:
    """For spells all is early and for spells late by a thirtieth of a cycle: no delay has both, and no belt leaps so."""
    period = w.nominal.period
    turns = np.cumsum(period * w.rng.uniform(0.4, 2.6, int(3.0 * w.duration / period) + 4))
    first = w.rng.choice([-1.0, 1.0])

    def sensor(t, motion, rng):
        return np.interp(t + 0.035 * a * period * first * (-1.0) ** np.searchsorted(turns, t), t, motion.position)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Holmes and Lipo 2003 (a gauge that writes the widths of pulses, and a filter that lets their ripple through)",
    rig="organ",
)
def pulses_shine_through(w: World, a: float) -> None:
    """Triangles of nine samples whose slopes hang on the place, in rest and slip alike: no force, and no outliers."""
    full, apart = 1.3 * w.nominal.reach, 9.3 / w.nominal.rate

    def sensor(t, motion, rng):
        width, u = np.clip(motion.position / full, 0.0, 1.0), np.mod(t / apart + w.rng.random(), 1.0)
        rises, falls = (1.0 - width) * (u - 0.5 * width), width * (0.5 * (1.0 + width) - u)
        return motion.position + 0.6 * a * w.nominal.slip_length * np.where(u < width, rises, falls)

    w.sensor = sensor
