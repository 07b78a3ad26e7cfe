"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import UNKNOWN, arrivals
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(UNKNOWN, source="Leeman, Saffer, Scuderi and Marone 2016 (slow slips and fast slips take turns)", rig="beetle")
def slow_slips_take_turns_with_fast_ones(w: World, a: float) -> None:
    """Each second slip is slow and short, the others are as stated: one curve of the speed cannot be both, nor is it chance."""
    rig, size, top = w.rig, 1.8 * a * w.nominal.gap, w.nominal.peak_speed
    w.mu_k = lambda s: rig.mu_k + size * (s.count % 2) * (s.w / top) ** 2


@form(
    UNKNOWN,
    source="Colgate and Schenkel 1994 (a part of the spring is a motor, whose computer reads the place by a clock)",
    rig="fork",
)
def motor_makes_a_part_of_the_spring(w: World, a: float) -> None:
    """Held for a third of a cycle: most slips meet a softer spring, some are jolted amid, and none starts where it should."""
    k, share, tick, v = w.rig.stiffness, 0.3 * a, 0.31 * w.nominal.period, w.belt_velocity
    now = {"stick": None, "tick": 0, "held": 0.0, "before": 0.0}

    def held(s: State):
        n = np.floor(s.t / tick)
        late = s.t - n * tick
        if now["stick"] is not None:
            return np.where(n * tick >= now["stick"], s.x - v * late, now["held"])
        if n > now["tick"]:
            now.update(tick=n, before=now["held"], held=s.x - s.v * late)
        return now["held"] if n == now["tick"] else now["before"]

    def on_stick(s: State) -> None:
        now.update(held=float(held(s)), stick=s.t)

    def on_break(s: State) -> None:
        now.update(held=float(held(s)), stick=None, tick=np.floor(s.t / tick))

    w.spring = lambda s: k * ((1.0 - share) * s.x + share * held(s))
    w.on_stick, w.on_break = on_stick, on_break


@form(UNKNOWN, source="Prandtl 1928 (a ribbed belt: after each slip the box settles into the nearest hollow)", rig="cork")
def box_settles_into_a_hollow(w: World, a: float) -> None:
    """On or back along the belt, as it happens, while it should stick: a contact that yields does so to one side only."""
    v, slip, tau = w.belt_velocity, w.nominal.slip_length, 0.03 * w.nominal.period
    rng = np.random.default_rng(int(1.0e9 * w.rig.mu_s))  # one belt for all runs
    count = int((abs(v) * w.duration + 8.0 * slip) / (0.2 * slip)) + 10
    hollows = np.cumsum(0.3 * slip * rng.uniform(0.6, 1.4, count)) - 4.0 * slip
    since = {"time": 0.0, "travel": 0.0, "back": 0.0}

    def after(t):
        return np.maximum(t - since["time"], 0.0)

    def travel(t):
        u = after(t)
        return since["travel"] + v * u - since["back"] * (1.0 - (1.0 + u / tau) * np.exp(-u / tau))

    def set_out(s: State, back: float) -> None:
        since.update(travel=float(travel(s.t)), time=s.t, back=back)

    def settle(s: State) -> None:
        place = np.sign(v) * (v * s.t - s.x)
        set_out(s, a * np.sign(v) * (hollows[np.argmin(np.abs(hollows - place))] - place))

    w.travel = travel
    w.belt = lambda t: v - since["back"] * after(t) / tau**2 * np.exp(-after(t) / tau)
    w.belt_acceleration = lambda t: -since["back"] * (1.0 - after(t) / tau) / tau**2 * np.exp(-after(t) / tau)
    w.on_stick, w.on_break = settle, lambda s: set_out(s, 0.0)


@form(
    UNKNOWN,
    source="Gent and Petrich 1969 (tack: where it turns round the box clings to its guide, for a time by chance)",
    rig="die",
)
def box_clings_to_its_guide(w: World, a: float) -> None:
    """It stands still after each slip while the belt runs on beneath: the belt's speed, and all places, are as stated."""
    v, mean = w.belt_velocity, 0.08 * a * w.nominal.period
    since = {"time": 0.0, "travel": 0.0, "stands": 0.0}

    def travel(t):
        return since["travel"] + v * np.maximum(t - since["time"] - since["stands"], 0.0)

    def set_out(s: State, stands: float) -> None:
        since.update(travel=float(travel(s.t)), time=s.t, stands=stands)

    w.travel = travel
    w.belt = lambda t: v * (t - since["time"] >= since["stands"])
    w.on_stick = lambda s: set_out(s, mean * min(w.rng.exponential(), 4.0))
    w.on_break = lambda s: set_out(s, 0.0)


@form(
    UNKNOWN,
    source="Webster 1999 (an encoder that misses counts when it is fast, and is set right by its index mark)",
    rig="mill",
)
def encoder_misses_counts_until_its_index(w: World, a: float) -> None:
    """Too high after each slip, right again from one place on: no step stays, and no delay lasts for half of a cycle."""
    slow, index = 0.5 * w.nominal.peak_speed, w.rig.reach - 0.5 * w.rig.slip_length

    def sensor(t, motion, rng):
        v, beyond = motion.velocity, motion.position > index
        missed = 0.35 * a * np.cumsum(np.sign(v) * np.maximum(np.abs(v) - slow, 0.0)) * (t[1] - t[0])
        passed = np.append(False, beyond[1:] != beyond[:-1])
        last = np.maximum.accumulate(np.where(passed, np.arange(t.size), 0))
        return motion.position - missed + missed[last]

    w.sensor = sensor


@form(UNKNOWN, source="Cutler 1952; Jayant and Noll 1984 (a logger that writes differences, cut to whole steps)", rig="fork")
def logger_writes_differences(w: World, a: float) -> None:
    """The belt seems to be slow, and the reading jumps as each block begins with a true one: neither drift, nor one step."""
    step, block = w.nominal.belt_velocity / w.nominal.rate / 2.6, round(0.3 * a * w.nominal.period * w.nominal.rate)
    if block < 2:
        return

    def sensor(t, motion, rng):
        x = np.pad(motion.position, (0, -t.size % block), "edge").reshape(-1, block)
        way = step * np.cumsum(np.fix(np.diff(x, axis=1) / step), axis=1)
        return np.hstack([x[:, :1], x[:, :1] + way]).ravel()[: t.size]

    w.sensor = sensor


@form(UNKNOWN, source="Bendat and Piersol 1971 (a logger that takes the trend out of each page)", rig="mill")
def logger_takes_out_trends(w: World, a: float) -> None:
    """Pages of 2.7 cycles, each tilted by what of a cycle is left over: up or down, with a jump between them."""

    def level(t, x):
        late = t - t.mean()
        return x - a * late * (late @ x) / (late @ late)

    def sensor(t, motion, rng):
        pages = max(int(t[-1] / (2.7 * w.nominal.period)), 1)
        parts = zip(np.array_split(t, pages), np.array_split(motion.position, pages), strict=True)
        return np.concatenate([level(*part) for part in parts])

    w.sensor = sensor


@form(UNKNOWN, source="Lindley 1952 (readings that wait in a queue behind other tasks, and catch up)", rig="seal")
def readings_wait_in_a_queue(w: World, a: float) -> None:
    """Late all at once, by another time each, and then too quick until they are late by nothing: no delay comes and goes."""
    period = w.nominal.period
    times = arrivals(w.rng, w.duration, 0.8 / period)
    work = np.append(0.0, np.cumsum(0.08 * a * period * w.rng.exponential(1.0, times.size)))

    def sensor(t, motion, rng):
        owed = work[np.searchsorted(times, t)] - 0.25 * t
        return np.interp(t - owed + np.minimum.accumulate(owed), t, motion.position)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Welsby and Hitz 1997 (staples of the belt's splice pass beneath an eddy-current gauge)",
    rig="seal",
)
def splice_passes_the_gauge(w: World, a: float) -> None:
    """A hump of the reading each turn of the belt, a fifth of a cycle wide, even while the box sticks: no force does that."""
    size, turn, half = 0.2 * a * w.nominal.slip_length, 3.3 * w.nominal.slip_length, 0.09 * w.nominal.slip_length

    def sensor(t, motion, rng):
        off = np.mod(w.travel(t) + 1.3 * turn, turn) - 0.5 * turn
        return motion.position + size * np.exp(-((off / half) ** 2))

    w.sensor = sensor


@form(
    UNKNOWN, source="Malmstadt, Enke and Crouch 1994 (a transient recorder of two time bases, read as if it had one)", rig="die"
)
def recorder_is_quicker_in_slips(w: World, a: float) -> None:
    """Half as many samples again while the box is fast: slips seem to last longer, over the same way; no force does that."""
    top = w.nominal.peak_speed

    def sensor(t, motion, rng):
        quick = 0.5 * (1.0 + np.tanh((np.abs(motion.velocity) / top - 0.3) / 0.03))
        return np.interp(t, t + 0.5 * a * np.cumsum(quick) * (t[1] - t[0]), motion.position)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Housner 1963 (a tall column on the box, read at its top, that rocks on its edges after each slip)",
    rig="mill",
)
def column_rocks_after_each_slip(w: World, a: float) -> None:
    """Arcs to and fro, each lower and shorter than the last, while the box sticks; a mode would keep its pitch."""
    size, first, keeps = 0.08 * a * w.nominal.slip_length, 0.09 * np.sqrt(a) * w.nominal.period, 0.75
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        ends = np.append(-np.inf, motion.sticks[:, 0])
        late, lean = t - ends[np.searchsorted(ends, t, "right") - 1], np.zeros(t.size)
        begins, span = 0.0, first
        for arc in range(9):
            u = np.clip((late - begins) / span, 0.0, 1.0)
            lean += 4.0 * (-1.0) ** arc * size * (span / first) ** 2 * u * (1.0 - u)
            begins, span = begins + span, keeps * span
        return motion.position + lean

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Considine 1993 (a chart recorder whose pen swings on an arc: both ends of its sweep are drawn early)",
    rig="beetle",
)
def pen_swings_on_an_arc(w: World, a: float) -> None:
    """By the square of the way from the middle: slips begin early and end early, and no delay is early; ramps are bent."""
    half = 0.5 * w.rig.slip_length
    middle, most = w.rig.reach - half, 0.5 * a / w.nominal.pulsation

    def sensor(t, motion, rng):
        off = np.clip((motion.position - middle) / half, -1.3, 1.3)
        return np.interp(t, np.maximum.accumulate(t - most * off**2), motion.position)

    w.sensor = sensor
