"""Forms that no effect of the vocabulary describes. Each says why no name can be defended, or what speaks for one."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import UNKNOWN, steady_noise
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(
    UNKNOWN,
    source="Leonhard 1985 (a speed loop that is tuned too tightly: it swings when a slip has relieved the belt)",
    rig="organ",
    also_one=("belt_speed_ripple",),
)
def belt_swings_after_each_slip(w: World, a: float) -> None:
    """The belt hurries as each slip begins, and swings until it is even; only where all cycles are alike it keeps time."""
    v, size = w.belt_velocity, 0.75 * a * np.sign(w.belt_velocity) * w.nominal.belt_velocity
    root = (-1.0 / 0.3 + 2j * np.pi / 0.35) / w.nominal.period
    since = {"time": 0.0, "travel": 0.0, "swing": 0j}

    def swing(t):
        return since["swing"] * np.exp(root * np.maximum(t - since["time"], 0.0))

    def travel(t):
        return since["travel"] + v * (t - since["time"]) + np.imag((swing(t) - since["swing"]) / root)

    def relieved(s: State) -> None:
        since.update(travel=float(travel(s.t)), swing=complex(swing(s.t)) + size, time=s.t)  # the real part: no jump of speed

    w.travel, w.belt, w.belt_acceleration = travel, lambda t: v + np.imag(swing(t)), lambda t: np.imag(root * swing(t))
    w.on_break = relieved


@form(
    UNKNOWN,
    source="Heilich and Shube 1983 (a friction variator that each slip jolts: its ratio is another one then)",
    rig="points",
)
def variator_settles_anew_in_each_slip(w: World, a: float) -> None:
    """Each ride has a speed of its own, by chance, and keeps it; places and slips are as stated: no ripple, as none repeats."""
    v, tau = w.belt_velocity, 0.3 / w.nominal.pulsation
    since = {"time": 0.0, "travel": 0.0, "to": v, "more": 0.0}

    def more(t):
        return since["more"] * np.exp(-np.maximum(t - since["time"], 0.0) / tau)

    def travel(t):
        return since["travel"] + since["to"] * (t - since["time"]) + tau * (since["more"] - more(t))

    def jolted(s: State) -> None:
        before, to = since["to"] + float(more(s.t)), v * (1.0 + 0.15 * a * w.rng.uniform(-1.0, 1.0))
        since.update(travel=float(travel(s.t)), time=s.t, to=to, more=before - to)

    w.travel, w.belt, w.belt_acceleration = travel, lambda t: since["to"] + more(t), lambda t: -more(t) / tau
    w.on_break = jolted


@form(
    UNKNOWN,
    source="Dietz 1972; Feyrer 2015 (a drum that winds its rope in layers, each of which is pulled in faster)",
    rig="girder",
)
def drum_winds_layer_upon_layer(w: World, a: float) -> None:
    """The speed goes up a stair, each dozen cycles by a share of that stated, which is the third layer's; nothing repeats."""
    v, layer = w.belt_velocity, 12.0 * w.nominal.slip_length

    def pace(t):
        wound = abs(v) * t / layer + 0.5
        steps = np.arange(1.0, wound[-1] + 2.0)
        return v * (1.0 + 0.055 * a * (0.5 + 0.5 * np.tanh((wound[:, None] - steps) / 0.02)).sum(1) - 0.11 * a)

    w.set_belt(pace)


@form(
    UNKNOWN,
    "quadratic_damping",
    source="Cayley 1857 (a chain that the box draws out of its heap as it slips, and lays down again as it rides)",
    rig="sash",
)
def chain_is_drawn_out_of_its_heap(w: World, a: float) -> None:
    """Half as much mass again at a slip's end, and what starts each link is lost; drag says a half of it, and no mass."""
    mass, line = w.rig.mass, 0.5 * a * w.rig.mass / w.nominal.slip_length
    taut, now = w.rig.mu_s * w.normal_force / w.rig.stiffness, {"drawn": 0.0}

    def load(s: State):
        drawn = np.maximum(taut - s.x, 0.0)
        now["drawn"] = float(drawn) if np.ndim(drawn) == 0 else 0.0  # arrays in stick, where an even belt asks for no inertia
        return line * (drawn > 0.0) * np.minimum(s.v, 0.0) ** 2

    w.load, w.mass = load, lambda t: mass + line * now["drawn"]  # load comes first


@form(UNKNOWN, source="Todd 1975 (a worn potentiometer: its wiper hops in motion, and shows too little)", rig="fader")
def worn_track_shows_too_little_in_motion(w: World, a: float) -> None:
    """Each reading of a slip lacks another share, by chance; in rides next to nothing: no rare samples, and never too much."""
    size, top = 0.12 * a, w.nominal.peak_speed

    def sensor(t, motion, rng):
        lost = np.minimum(rng.exponential(1.0, t.size), 4.0)
        return motion.position * (1.0 - size * lost * np.abs(motion.velocity) / top)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Robinson 1961 (a baseline restorer: it takes the least reading for its zero, and lets go of it slowly)",
    rig="sash",
)
def restorer_takes_the_least_for_zero(w: World, a: float) -> None:
    """Rides bend down and slips lack their ends, yet each ride begins at once: what is clipped would rest there first."""
    tau = 3.3 * w.nominal.period

    def sensor(t, motion, rng):
        least = begins = motion.sticks[1, 1]  # once the first slip is over
        first, keep = np.searchsorted(t, motion.sticks[1, 0]), a * (t[1] - t[0]) / tau
        shown = motion.position.copy()
        for i in range(first, t.size) if a > 0.0 else ():
            x = shown[i]
            least = min(least + keep * (x - least), x)
            shown[i] = x - least + begins
        return shown

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Elson, Girod and Estrin 2002 (a radio link: packets come late by chance, and are spread over their arrivals)",
    rig="girder",
)
def packets_are_spread_over_their_arrivals(w: World, a: float) -> None:
    """Each half cycle is drawn out or pressed together, so that all is now early and now late: no delay, and no belt."""
    apart, late = 0.5 * w.nominal.period, 0.04 * a * w.nominal.period

    def sensor(t, motion, rng):
        sent = apart * np.arange(int(t[-1] / apart) + 3)
        return np.interp(
            np.interp(t, sent + late * (np.minimum(rng.exponential(1.0, sent.size), 4.0) - 1.0), sent), t, motion.position
        )

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Lynnworth 1989 (an ultrasonic gauge that takes the wave beside for the right one, until it is still again)",
    rig="wedge",
)
def gauge_takes_the_wave_beside(w: World, a: float) -> None:
    """In two slips of three it jumps by a wave, up or down, and jumps back in the ride: no step stays, and none is rare."""
    wave, half = 0.08 * a * w.nominal.slip_length, 0.5 * np.pi / w.nominal.pulsation

    def sensor(t, motion, rng):
        shown = motion.position.copy()
        taken = motion.breaks[:, 0] + half
        for begins, again in zip(taken, np.append(taken[1:], t[-1]), strict=True):
            off, lasts = rng.integers(-1, 2), w.nominal.period * rng.uniform(0.15, 0.6)
            shown[slice(*np.searchsorted(t, [begins, min(begins + lasts, again)]))] += wave * off
        return shown

    w.sensor = sensor


@form(UNKNOWN, source="Krotkov 1988 (a camera whose focus hunts after each slip, and takes the scale along)", rig="wedge")
def focus_hunts_after_each_slip(w: World, a: float) -> None:
    """The scale swings about the picture's middle while the box rides; a mode would swing as much wherever the box is."""
    middle, turn, tau = (
        w.nominal.reach - 0.5 * w.nominal.slip_length,
        2 * np.pi / (0.22 * w.nominal.period),
        0.15 * w.nominal.period,
    )

    def sensor(t, motion, rng):
        ends = np.append(-np.inf, motion.sticks[1:, 0])
        late = np.minimum(t - ends[np.searchsorted(ends, t, "right") - 1], 40.0 * tau)
        return motion.position + 0.1 * a * np.exp(-late / tau) * np.sin(turn * late) * (motion.position - middle)

    w.sensor = sensor


@form(UNKNOWN, source="Rice 1948; Jakes 1974 (a radio link of two paths, past which people walk: it fades)", rig="fader")
def link_fades_on_two_paths(w: World, a: float) -> None:
    """The gain swings by chance, sharper where the paths are opposed: even while the box sticks its speed is not the belt's."""
    turns = steady_noise(w.rng, w.duration, 1.5 * w.nominal.period, order=2)
    w.sensor = lambda t, motion, rng: motion.position * np.abs(1.0 + 0.12 * a * np.exp(2j * np.pi * turns(t)))


@form(UNKNOWN, source="Sheingold 1986 (a converter from voltage to frequency, whose own ripple is read along)", rig="points")
def ripple_is_as_quick_as_the_reading_is_high(w: World, a: float) -> None:
    """A whistle that goes up with each ride and down with each slip: no tone, and not the same at the same place."""
    size, most = 0.03 * a * w.nominal.slip_length, 12.0 / w.nominal.period

    def sensor(t, motion, rng):
        turns = most * np.cumsum(motion.position) / w.nominal.reach * (t[1] - t[0])
        return motion.position + size * np.sin(2 * np.pi * turns)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Carslaw and Jaeger 1959 (the heat of each slip comes to the gauge's arm late, and leaves it later)",
    rig="organ",
)
def heat_of_each_slip_comes_late(w: World, a: float) -> None:
    """A hump of the reading in each ride, on what is left of earlier ones; no contact yields and returns at such a time."""
    size, period, usual = 0.06 * a * w.nominal.slip_length, w.nominal.period, w.nominal.slip_length
    diffuses, leaves = 0.08 * period, 1.2 * period

    def sensor(t, motion, rng):
        shown = motion.position.copy()
        for (begins, high), (_, low) in zip(motion.breaks, motion.sticks[1:], strict=False):
            here = slice(*np.searchsorted(t, [begins + 1e-3 * diffuses, begins + 10.0 * leaves]))
            late = t[here] - begins
            hump = np.sqrt(2.0 * diffuses / late) * np.exp(0.5 - diffuses / late - late / leaves)
            shown[here] += size * abs(high - low) / usual * hump
        return shown

    w.sensor = sensor
