"""Rigs that are as believed: nothing is missing, and records have what real ones have besides."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import NONE, each_stick, steady_noise
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

MODAL = UNCERTAINTY | {"mass": 0.001, "stiffness": 0.002, "damping": 0.05}
"""Relative standard deviations after a modal test, which says nothing of friction [-]."""
LIMITS = "JCGM 101:2008 (every believed number two standard deviations off)"


@form(NONE, source="McWhorter 1957 (noise of traps, each with a time of its own: 1/f over three decades)", rig="die")
def noise_of_traps(w: World, a: float) -> None:
    """Times from a third of a sample to four cycles, eight in all; together half as loud as the white noise."""
    times = np.geomspace(0.3 / w.nominal.rate, 4.0 * w.nominal.period, 8)

    def sensor(t, motion, rng):
        keep = np.exp(-(t[1] - t[0]) / times)
        kicks = np.sqrt(1.0 - keep**2)[:, None] * rng.standard_normal((8, t.size))
        kicks[:, 0] = rng.standard_normal(8)
        traps = sum(lfilter([1.0], [1.0, -one], kick) for one, kick in zip(keep, kicks, strict=True))
        return motion.position + 0.5 * w.nominal.noise * traps / np.sqrt(8.0)

    w.sensor = sensor


@form(NONE, source="Slutzky 1937 (moving sums of what comes by chance: five neighbours share most of it)", rig="fork")
def noise_of_moving_sums(w: World, a: float) -> None:
    """Beside the white noise 0.8 of it that is alike in neighbours, and in nothing beyond the fourth."""

    def sensor(t, motion, rng):
        sums = np.convolve(rng.standard_normal(t.size + 4), np.ones(5), "valid") / np.sqrt(5.0)
        return motion.position + 0.8 * w.nominal.noise * sums

    w.sensor = sensor


@form(NONE, source="Engle 1982 (noise whose size hangs on its last values: it comes in clusters)", rig="cork")
def noise_in_clusters(w: World, a: float) -> None:
    """As loud as the white noise beside it; neighbours are alike in size, and not in sign."""

    def sensor(t, motion, rng):
        z, noise, square = rng.standard_normal(t.size), np.empty(t.size), 1.0
        for i in range(t.size):
            noise[i] = z[i] * np.sqrt(0.5 + 0.5 * square)
            square = noise[i] ** 2
        return motion.position + w.nominal.noise * noise

    w.sensor = sensor


@form(NONE, source="Roberts 1962 (steps of four times the noise, with a dither of one step before them)", rig="mill")
def steps_with_a_dither(w: World, a: float) -> None:
    """What is lost below a step is noise of an even density."""
    step = 4.0 * w.nominal.noise

    def sensor(t, motion, rng):
        return step * np.round(motion.position / step + rng.uniform(-0.5, 0.5, t.size))

    w.sensor = sensor


@form(
    NONE,
    source="Wolaver 1991 (a clock with a spur: late and early in turn, by as much as the noise in fast motion)",
    rig="seal",
)
def clock_has_a_spur(w: World, a: float) -> None:
    """Nineteen samples to and fro."""

    def sensor(t, motion, rng):
        turn = 2 * np.pi * (t * w.nominal.rate / 19.3 + rng.random())
        return np.interp(t + w.nominal.noise / w.nominal.peak_speed * np.sin(turn), t, motion.position)

    w.sensor = sensor


@form(
    NONE,
    source="Shinagawa, Akazawa and Wakimoto 1990 (instants by chance: in fast motion as much as the noise)",
    rig="beetle",
    jitter=0.024,
)
def instants_by_chance(w: World, a: float) -> None:
    """Stamps are even."""


@form(NONE, source="Bryan 1990 (air conditioning: the gauge's stand grows and shrinks by half of the noise)", rig="fork")
def zero_breathes(w: World, a: float) -> None:
    """Heated for a third of each seven cycles: an even saw, up in a third of the time and down in the rest."""

    def sensor(t, motion, rng):
        u = np.mod(t / (7.3 * w.nominal.period) + rng.random(), 1.0)
        return motion.position + w.nominal.noise * (np.minimum(3.0 * u, 1.5 * (1.0 - u)) - 0.5)

    w.sensor = sensor


@form(
    NONE,
    source="Kirton and Uren 1989 (one trap: the zero flickers between two levels, a third of the noise to each side)",
    rig="seal",
)
def zero_flickers(w: World, a: float) -> None:
    """Some ten times a cycle, there and back by chance."""

    def sensor(t, motion, rng):
        flips = np.cumsum(rng.random(t.size) < 10.0 / (w.nominal.period * w.nominal.rate)) + rng.integers(2)
        return motion.position + 0.33 * w.nominal.noise * (-1.0) ** flips

    w.sensor = sensor


@form(
    NONE,
    source="Ewins 2000 (a modal test: mass, stiffness and damping stated tightly; all off by two of their deviations)",
    rig="cork",
    uncertainty=MODAL,
    at_limits=True,
)
def limits_after_a_modal_test(w: World, a: float) -> None:
    """Friction is stated as loosely as ever."""


@form(NONE, source=f"{LIMITS}; 1/f noise, a tenth louder than stated", rig="beetle", at_limits=True, noise="pink", loudness=1.1)
def limits_and_pink_noise(w: World, a: float) -> None:
    """Both at once, as of a cheap amplifier on a rig that nobody has measured again."""


@form(
    NONE,
    source=f"{LIMITS}; Rubin 1976 (one sample of sixteen is lost, and half a cycle); begun amid a slip",
    rig="mill",
    at_limits=True,
    missing=0.0625,
    gap=0.5,
    amid=0.6,
)
def limits_and_samples_lost(w: World, a: float) -> None:
    """The logger was busy, and was switched on late."""


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, a pair for each stick); a zero that wanders by 0.3 of the noise",
    rig="die",
    declared="per_event",
    declared_sigma=0.004,
)
def scatter_declared_per_stick(w: World, a: float) -> None:
    """What scatters is what the scenario says; the zero wanders smoothly, over half a cycle."""
    rig = w.rig

    def draw(s) -> None:
        z = w.rng.standard_normal(2)
        w.memory["s"], w.memory["k"] = rig.mu_s + 0.004 * z[0], rig.mu_k + 0.004 * z[1]

    def sensor(t, motion, rng):
        return motion.position + 0.3 * w.nominal.noise * steady_noise(rng, w.duration, 0.5 * w.nominal.period, order=2)(t)

    each_stick(w, draw)
    w.mu_s, w.mu_k, w.sensor = lambda s: w.memory["s"], lambda s: w.memory["k"], sensor
