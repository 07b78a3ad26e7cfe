"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, arrivals, each_stick
from tests.discovery.unseen_forms.friction_forms import scaled
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(UNKNOWN, source="Gautschi 2002 (a piezoelectric gauge whose charge leaks away)")
def gauge_leaks(w: World, a: float) -> None:
    """Of 0.3 of the signal, what lasts longer than two cycles is lost."""
    tau = 2.0 * w.nominal.period

    def sensor(t, motion, rng):
        decay = np.exp(-(t[1] - t[0]) / tau)
        slow = lfilter([1.0 - decay], [1.0, -decay], motion.position)
        return motion.position - 0.3 * a * slow

    w.sensor = sensor


@form(UNKNOWN, source="Tumanski 2006 (a meter that changes its range, up later than down)")
def gauge_changes_ranges(w: World, a: float) -> None:
    """The upper range shows a share more of the travel beyond the middle of a slip."""
    middle, slip = w.nominal.reach - 0.5 * w.nominal.slip_length, w.nominal.slip_length

    def sensor(t, motion, rng):
        x, upper = motion.position, False
        high = np.empty(t.size)
        for i, place in enumerate((x - middle) / slip):
            upper = place > (-0.2 if upper else 0.2)
            high[i] = upper
        return x + 0.12 * a * high * (x - middle + 0.3 * slip)

    w.sensor = sensor


@form(UNKNOWN, "velocity_weakening", "frictional_lag", source="Tolstoi 1967 (a box that rises as it slides, and sinks late)")
def box_rises(w: World, a: float) -> None:
    load, top, late, lost = w.normal_force, w.nominal.peak_speed, 0.6 / w.nominal.pulsation, 0.25 * a
    w.q0 = (0.0,)
    w.rates = lambda s: ((np.abs(s.w) / top - s.q[0]) / late,)
    w.normal = lambda s: load * (1.0 - lost * s.q[0])


@form(UNKNOWN, "second_mode", source="Den Hartog 1931 (a Lanchester damper: a mass that is held by dry friction alone)")
def lanchester_damper(w: World, a: float) -> None:
    if a <= 0.0:
        return
    mass, hold = 0.3 * a * w.rig.mass, 0.15 * a * w.nominal.gap * w.nominal.normal_force
    slow = 0.05 * w.nominal.peak_speed

    def pull(s: State):
        return hold * np.tanh((s.v - s.q[0]) / slow)

    w.q0 = (0.0,)
    w.rates = lambda s: (pull(s) / mass,)
    w.load = lambda s: -pull(s)


@form(UNKNOWN, source="Reid 1956 (a spring whose layers rub by how far it is bent)")
def spring_rubs_as_it_bends(w: World, a: float) -> None:
    k, slow = 0.04 * a * w.rig.stiffness, 0.2 * w.nominal.belt_velocity
    w.load = lambda s: -k * np.abs(s.x) * np.tanh(s.v / slow)


@form(
    UNKNOWN,
    "correlated_coefficients",
    source="Godet 1984; Bak, Tang and Wiesenfeld 1987 (debris that each slip adds to, and that goes at once)",
)
def debris_gathers_and_goes(w: World, a: float) -> None:
    def turn(s: State | None) -> None:
        before = w.memory.get("debris", 2.0)
        w.memory["debris"] = 0.0 if w.rng.random() < 0.17 else before + 1.0

    each_stick(w, turn)
    scaled(w, lambda s: 1.0 + 0.025 * a * (min(w.memory["debris"], 10.0) - 4.0))


@form(UNKNOWN, "stale_samples", source="Little and Rubin 1987 (a logger that draws straight lines across what it lost)")
def logger_draws_lines(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        kept = np.ones(t.size, bool)
        for time in arrivals(rng, w.duration, 0.5 / w.nominal.period) if a > 0.0 else ():
            i, j = np.searchsorted(t, [time, time + 0.3 * a * w.nominal.period])
            kept[i:j] = False
        kept[[0, -1]] = True
        return np.interp(t, t[kept], motion.position[kept])

    w.sensor = sensor


@form(UNKNOWN, source="Gustafsson 1996 (a logger that filters forward and backward: late by nothing)")
def logger_filters_both_ways(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        width = 0.3 * a / w.nominal.pulsation / (t[1] - t[0])
        return gaussian_filter1d(motion.position, width, mode="nearest") if a > 0.0 else motion.position

    w.sensor = sensor
