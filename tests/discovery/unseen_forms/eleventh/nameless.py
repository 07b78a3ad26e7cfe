"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import filtfilt, iirnotch

from tests.discovery.unseen_forms.forms import UNKNOWN
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(UNKNOWN, source="Eksergian 1930; Biezeno and Grammel 1939 (a linkage whose inertia varies with the place of the box)")
def linkage_weighs_more_where_slips_end(w: World, a: float) -> None:
    """Slips start quicker and end slower, over the same way; whatever acts while the box sticks is as believed."""
    m, share, half = w.rig.mass, 0.4 * a, 0.5 * w.rig.slip_length
    middle, now = w.rig.reach - half, {"off": 0.0}

    def load(s: State):
        off = np.clip((s.x - middle) / half, -1.3, 1.3)
        now["off"] = float(off) if np.ndim(off) == 0 else 0.0  # arrays in stick, where an even belt asks for no inertia
        return 0.5 * m * share / half * (np.abs(off) < 1.3) * s.v**2

    w.load, w.mass = load, lambda t: m * (1.0 - share * now["off"])  # load comes first


@form(UNKNOWN, source="Makris and Kampas 2016; Malaga-Chuquitaype and others 2019 (a clutched inerter)")
def flywheel_on_a_freewheel(w: World, a: float) -> None:
    """A mass while the box speeds up, and none while it slows down: the wheel runs on, and stops in its bearing."""
    m, more, now = w.rig.mass, 0.55 * a, {"highest": 0.0, "driven": False}

    def load(s: State) -> float:
        speed = -s.direction * float(np.mean(s.v))
        now["driven"] = speed >= now["highest"]
        now["highest"] = max(speed, now["highest"])
        return 0.0

    w.on_break = lambda s: now.update(highest=0.0)
    w.load, w.mass = load, lambda t: m * (1.0 + more * now["driven"])  # load comes first


@form(UNKNOWN, source="Kenjo and Nagamori 1985 (a drive whose speed is set by hand before each run)")
def drive_is_set_by_hand(w: World, a: float) -> None:
    """Faster than stated in one run and slower in another, and even within each: no ripple."""
    v = w.belt_velocity * (1.0 + a * w.rng.choice([-1.0, 1.0]) * w.rng.uniform(0.06, 0.1))
    w.belt, w.travel = lambda t: v + 0.0 * t, lambda t: v * t


@form(UNKNOWN, source="Krishnan 2001 (a drive with a soft start: the belt takes a dozen cycles to come up to its speed)")
def drive_starts_softly(w: World, a: float) -> None:
    """What rides on the belt shows its speed; that rises once, and repeats nothing."""
    tau = 6.0 * w.nominal.period
    w.set_belt(lambda t: w.belt_velocity * (1.0 - 0.4 * a * np.exp(-t / tau)))


@form(UNKNOWN, source="Black and Hodges 1980; Vogel 2005 (two converters in turn, of which one has more gain)")
def converters_differ_in_gain(w: World, a: float) -> None:
    """Each second sample is too large and each other too small, by the place of the box: half of all, so no outliers."""
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.045 * a * (-1.0) ** np.arange(t.size))


@form(UNKNOWN, source="Liang, Chang and Chen 2008 (a camera that reads its rows in turn: the instant hangs on the place)")
def camera_reads_rows_in_turn(w: World, a: float) -> None:
    """Early where slips begin, late where they end, and right between: one delay cannot be both."""
    half = 0.5 * w.rig.slip_length
    middle, most = w.rig.reach - half, 0.4 * a / w.nominal.pulsation

    def sensor(t, motion, rng):
        row = np.clip((motion.position - middle) / half, -1.0, 1.0)
        return np.interp(t + most * row, t, motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Dorsch, Hausler and Herrmann 1994 (a rough target: at each place an error of its own)")
def target_is_rough(w: World, a: float) -> None:
    """The reading swings while the box rides on the belt, again and again at the same places: no force does that."""
    rng, slip = np.random.default_rng(int(1.0e9 * w.rig.mu_s)), w.nominal.slip_length  # one target for all runs
    knots = np.arange(-0.5 * slip, w.nominal.reach + 0.8 * slip, 0.1 * slip)
    error = CubicSpline(knots, 0.03 * a * slip * rng.standard_normal(knots.size))
    w.sensor = lambda t, motion, rng: motion.position + error(motion.position)


@form(UNKNOWN, source="Oppenheim and Schafer 1989 (a logger that cuts out a band about the mains, forward and backward)")
def logger_cuts_out_a_band(w: World, a: float) -> None:
    """What lacks rings before each slip as much as after it: neither a delay nor a second mass does."""

    def sensor(t, motion, rng):
        x = motion.position
        b, c = iirnotch(0.6 * w.nominal.pulsation / (2 * np.pi), 4.0, fs=1.0 / (t[1] - t[0]))
        return x + a * (filtfilt(b, c, x) - x)

    w.sensor = sensor
