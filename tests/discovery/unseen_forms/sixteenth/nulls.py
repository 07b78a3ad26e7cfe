"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import NONE, each_stick
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

WEIGHED = UNCERTAINTY | {"mass": 0.015, "normal_force": 0.025}
"""Relative standard deviations of a rig whose parts and weights stood on a goods scale [-]."""
TABLED = UNCERTAINTY | {"mu_s": 0.065, "mu_k": 0.065}
"""Relative standard deviations of a rig whose friction is from a table [-]."""
LIMITS = "JCGM 104:2009 (every believed number two standard deviations off)"


@form(NONE, source="Hosking 1981 (noise of a long memory: differences of a broken order)", rig="fader")
def noise_of_long_memory(w: World, a: float) -> None:
    """Of order 0.3, and 0.7 as loud as the white noise beside it."""

    def sensor(t, motion, rng):
        lines = np.fft.rfft(rng.standard_normal(t.size))
        lines[1:] /= (2.0 * np.sin(np.pi * np.fft.rfftfreq(t.size)[1:])) ** 0.3
        lines[0] = 0.0
        noise = np.fft.irfft(lines, t.size)
        return motion.position + 0.7 * w.nominal.noise * noise / noise.std()

    w.sensor = sensor


@form(NONE, source="Kotz, Kozubowski and Podgorski 2001 (noise of exponential tails to both sides)", rig="organ")
def noise_of_two_tails(w: World, a: float) -> None:
    """As loud as the white noise beside it."""
    w.sensor = lambda t, motion, rng: motion.position + w.nominal.noise * rng.laplace(0.0, np.sqrt(0.5), t.size)


@form(NONE, source="Inclan and Tiao 1994 (somebody opens the door of the cabinet: noise is louder from then on)", rig="girder")
def noise_is_louder_from_a_time_on(w: World, a: float) -> None:
    """Half as loud again, from somewhere in the middle third of the run."""

    def sensor(t, motion, rng):
        more = np.sqrt(1.5**2 - 1.0) * (t > t[-1] * rng.uniform(1 / 3, 2 / 3))
        return motion.position + w.nominal.noise * more * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="Redl, Weber and Oliphant 1995 (a telephone on the desk: one of eight slots, for spells)", rig="wedge")
def telephone_buzzes(w: World, a: float) -> None:
    """Pulses of 0.9 of the noise, twelve samples apart, for a tenth of the time."""

    def sensor(t, motion, rng):
        period, calls = w.nominal.period, rng.uniform(0.0, t[-1], int(t[-1] / (4.0 * w.nominal.period)) + 1)
        on = np.any(np.abs(t[:, None] - calls) < 0.2 * period, axis=1)
        slot = np.mod(np.arange(t.size) / 12.2 + rng.random(), 1.0) < 0.125
        return motion.position + 0.9 * w.nominal.noise * on * slot

    w.sensor = sensor


@form(
    NONE, source="Schmitt 1938 (a converter of 3.4 times the noise whose edges are higher upwards than downwards)", rig="sash"
)
def steps_with_hysteresis(w: World, a: float) -> None:
    """By a fifth of a step, which is 0.7 of the noise."""
    step = 3.4 * w.nominal.noise
    w.sensor = lambda t, motion, rng: step * np.round(motion.position / step - 0.1 * np.sign(motion.velocity))


@form(
    NONE,
    source="Goldberg 1991 (stamps of four bytes: after 25 minutes they have steps of an eighth of a millisecond)",
    rig="girder",
    begins=1500.0,
    stamp=2.0**-13,
)
def stamps_of_four_bytes(w: World, a: float) -> None:
    """Off by 0.8 % of an interval at most."""


@form(
    NONE,
    source="Hardin, Fessler and Bush 1994 (a clock that spreads its spectrum: its rate goes to and fro in straight lines)",
    rig="points",
)
def clock_spreads_its_spectrum(w: World, a: float) -> None:
    """Instants are off by arcs of parabolas of 31 samples, early and late in turn, and in fast motion by the noise at most."""

    def sensor(t, motion, rng):
        u = np.mod(t * w.nominal.rate / 31.3 + rng.random(), 1.0)
        arcs = np.where(u < 0.5, 8.0 * u * (1.0 - 2.0 * u), -8.0 * (u - 0.5) * (2.0 - 2.0 * u))
        return np.interp(t + w.nominal.noise / w.nominal.peak_speed * arcs, t, motion.position)

    w.sensor = sensor


@form(NONE, source="Goeke 1989 (a converter that integrates: each sample is the mean of its own interval)", rig="fader")
def converter_integrates(w: World, a: float) -> None:
    """To both sides of the stamp alike, and so late by nothing; the tightest bends are rounded by a fifth of the noise."""

    def sensor(t, motion, rng):
        x = np.pad(motion.position, 1, "edge")
        return x[1:-1] + (x[2:] - 2.0 * x[1:-1] + x[:-2]) / 24.0

    w.sensor = sensor


@form(NONE, source="Figliola and Beasley 2006 (a tachometer that is out of true beside an even belt)", rig="organ")
def tachometer_is_out_of_true(w: World, a: float) -> None:
    """Its column swings by 2 %, once in 1.7 cycles, with as much noise: the belt does not."""
    turn, begins = 1.7 * w.nominal.period, w.rng.random()

    def column(t, motion):
        swing = np.sin(2 * np.pi * (t / turn + begins))
        return w.belt_velocity * (1.0 + 0.02 * (swing + w.rng.standard_normal(t.size)))

    w.columns["belt_velocity [m/s]"] = column


@form(
    NONE,
    source=f"{LIMITS}; OIML R 111-1 2004 (mass and weights from a goods scale); noise of an even density",
    rig="points",
    uncertainty=WEIGHED,
    at_limits=True,
    noise="uniform",
)
def limits_of_a_goods_scale(w: World, a: float) -> None:
    """The load may be off by a twentieth, as is stated."""


@form(
    NONE,
    source=f"{LIMITS}; Bowden and Tabor 1964 (friction from a table); a gauge that settles by 0.6 of the noise",
    rig="wedge",
    uncertainty=TABLED,
    at_limits=True,
)
def limits_of_tabled_friction(w: World, a: float) -> None:
    """The zero comes to rest within some ten cycles; its mean over them is as stated."""
    tau = 5.0 * w.nominal.period

    def sensor(t, motion, rng):
        left = np.exp(-t / tau)
        return motion.position + 0.6 * w.nominal.noise * (left - left.mean())

    w.sensor = sensor


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick); numbers off by one deviation; AR(1) noise",
    rig="sash",
    at_limits=0.5,
    noise="coloured",
    declared="per_event",
    declared_sigma=0.003,
)
def scatter_declared_in_coloured_noise(w: World, a: float) -> None:
    """What scatters is what the scenario says; neighbours of the noise are alike."""
    rig, now = w.rig, {}

    def draw(s) -> None:
        now["s"], now["k"] = np.array([rig.mu_s, rig.mu_k]) + 0.003 * w.rng.standard_normal(2)

    each_stick(w, draw)
    w.mu_s, w.mu_k = lambda s: now["s"], lambda s: now["k"]
