"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("nonlinear_stiffness", source="Ernst 1965; Irvine 1981 (a rope that sags less, the more it is stretched)")
def stiffness_of_a_sagging_rope(w: World, a: float) -> None:
    """As stiff as believed, from rest to four fifths of the reach."""
    k, reach, sag = w.rig.stiffness, w.nominal.reach, 2.0 * a
    stretch = np.linspace(0.0, 4.0 * reach, 20001)  # force over stiffness
    start = 0.4 * reach
    place = stretch + 0.5 * sag * start * (1.0 - (start / (start + stretch)) ** 2)
    middle = 0.8 * reach / np.interp(0.8 * reach, place, stretch)
    w.spring = lambda s: k * middle * np.sign(s.x) * np.interp(np.abs(s.x), place, stretch)


@form("harmonic_force", source="Den Hartog 1956, section 5.2 (the crank of an engine: once and twice a turn)")
def force_of_a_crank(w: World, a: float) -> None:
    force, f = 0.15 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.63 / w.nominal.period
    w.load = lambda s: force * (np.cos(f * s.t + 1.1) + 0.6 * np.cos(2.0 * (f * s.t + 1.1)))
