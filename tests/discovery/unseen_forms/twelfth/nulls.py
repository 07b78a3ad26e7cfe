"""Records of rigs that are as believed, with what real records have besides: nothing is missing."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import NONE, steady_noise
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.rigs import UNCERTAINTY

from .enter import form

TIGHT = {key: sd / 3.0 for key, sd in UNCERTAINTY.items()}
"""Relative standard deviations of a rig that a laboratory has measured [-]."""


@form(NONE, source="Candy and Temes 1992 (a converter that shapes its noise: differences of neighbours)", rig="sheet")
def noise_shaped(w: World, a: float) -> None:
    """Beside the white noise as much that is alike in nothing but sign: what is too much now is too little next."""

    def sensor(t, motion, rng):
        return motion.position + w.nominal.noise * np.diff(rng.standard_normal(t.size + 1)) / np.sqrt(2.0)

    w.sensor = sensor


@form(NONE, source="Lawson and Rothberg 1995 (a laser's speckle: noise that grows with the speed)", rig="ice")
def noise_grows_with_speed(w: World, a: float) -> None:
    """Twice the noise at the highest speed, and the stated one while the box sticks."""

    def sensor(t, motion, rng):
        more = np.sqrt(3.0) * np.abs(motion.velocity) / w.nominal.peak_speed
        return motion.position + w.nominal.noise * more * rng.standard_normal(t.size)

    w.sensor = sensor


@form(NONE, source="IEEE 1241 2000 (a converter whose steps, of thrice the noise, are unevenly wide)", rig="jewel")
def steps_uneven(w: World, a: float) -> None:
    """Each edge is off by a fifth of a step; the converter is the same in all runs."""
    step, slip = 3.0 * w.nominal.noise, w.nominal.slip_length

    def sensor(t, motion, rng):
        edges = np.arange(w.nominal.reach - 2.0 * slip, w.nominal.reach + slip, step)
        edges += 0.2 * step * np.random.default_rng(12).standard_normal(edges.size)
        levels = 0.5 * (edges[1:] + edges[:-1])
        return levels[np.clip(np.searchsorted(edges, motion.position) - 1, 0, levels.size - 1)]

    w.sensor = sensor


@form(NONE, source="Demir, Mehrotra and Roychowdhury 2000 (a clock in a loop: it walks, and is drawn back)", rig="lift")
def clock_walks(w: World, a: float) -> None:
    """Late and early by turns, each for a third of a cycle, and by as much as the noise at the highest speed."""

    def sensor(t, motion, rng):
        late = w.nominal.noise / w.nominal.peak_speed * steady_noise(rng, w.duration, 0.3 * w.nominal.period)(t)
        return np.interp(t - late, t, motion.position)

    w.sensor = sensor


@form(
    NONE,
    source="JCGM 100:2008 (stated three times as tightly as usual, and off by two of these deviations)",
    rig="shoe",
    uncertainty=TIGHT,
    at_limits=True,
)
def stated_tightly(w: World, a: float) -> None:
    """A rig that is known well."""


@form(
    NONE,
    source="JCGM 100:2008 (every believed number two standard deviations off); Rice 1944 (noise with a hump in its spectrum)",
    rig="bracket",
    at_limits=True,
)
def limits_and_a_hump(w: World, a: float) -> None:
    """A cable that resonates: beside the white noise some that swings, with a period of seven samples."""

    def sensor(t, motion, rng):
        swing = lfilter([1.0], [1.0, -1.8 * np.cos(2 * np.pi / 7.0), 0.81], rng.standard_normal(t.size + 200))[200:]
        return motion.position + 0.7 * w.nominal.noise * swing / swing.std()

    w.sensor = sensor


@form(NONE, source="Pallas-Areny and Webster 2001 (an amplifier that hisses until it is warm)", rig="shoe")
def noise_dies_away(w: World, a: float) -> None:
    """Twice the noise at first, a third more than stated after eleven cycles, and as stated in the end."""

    def sensor(t, motion, rng):
        more = np.sqrt(3.0) * np.exp(-t / (16.0 * w.nominal.period))
        return motion.position + w.nominal.noise * more * rng.standard_normal(t.size)

    w.sensor = sensor


@form(
    NONE,
    source="Kang, Choi and Yoo 2015, section 2.2 (declared, knots)",
    rig="lift",
    declared="knots",
    declared_sigma=0.004,
)
def scatter_declared_in_knots(w: World, a: float) -> None:
    """What scatters is what the scenario says: values each hundredth of a second, and straight lines between."""
    rig, grid = w.rig, np.arange(0.0, w.duration + 0.03, 0.01)
    z = w.rng.standard_normal((2, grid.size))
    w.mu_s = lambda s: rig.mu_s + 0.004 * np.interp(s.t, grid, z[0])
    w.mu_k = lambda s: rig.mu_k + 0.004 * np.interp(s.t, grid, z[1])
