"""Forms that no effect of the vocabulary describes. Each says why no name can be defended."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from tests.discovery.unseen_forms.forms import UNKNOWN
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(
    UNKNOWN, source="Huygens 1673 (what stands on one table feels each other: a second rig, with slips of its own)", rig="wire"
)
def neighbour_rig_tugs_at_the_table(w: World, a: float) -> None:
    """Its pull grows for a while and is let go at once, at uneven times: no ripple, which keeps time, and no short blow."""
    force, usual = 0.4 * a * w.nominal.gap * w.nominal.normal_force, 0.71 * w.nominal.period
    slips = np.cumsum(usual * w.rng.uniform(0.6, 1.4, int(3.0 * w.duration / usual) + 20)) - 2.0 * usual
    width = 0.5 / w.nominal.pulsation
    times = np.ravel(np.column_stack([slips, slips + width]))
    levels = np.tile([0.5, -0.5], slips.size)
    w.load = lambda s: force * np.interp(s.t, times, levels)


@form(
    UNKNOWN,
    source="Jabbari and Bobrow 2002 (a cylinder beside the spring whose valve shuts as each slip begins, and opens at rest)",
    rig="chair",
)
def valve_shuts_in_each_slip(w: World, a: float) -> None:
    """A second spring that is at rest wherever a slip begins: slips are quick and short, and no curve of the place says so."""
    k, more, shut = w.rig.stiffness, 0.4 * a * w.rig.stiffness, {"at": None}

    def spring(s: State):
        return k * s.x if shut["at"] is None else k * s.x + more * (s.x - shut["at"])

    w.on_break = lambda s: shut.update(at=float(s.x))
    w.on_stick = lambda s: shut.update(at=None)
    w.spring = spring


@form(
    UNKNOWN,
    source="Rankine 1857; Terzaghi 1943 (pellets that the end of each slip shoves together, and that trickle back)",
    rig="platen",
)
def pellets_lie_in_the_way(w: World, a: float) -> None:
    """They hold up the box while it shoves them and never push it back; where they lie hangs on the time since: no spring."""
    force, slip, slow = 0.8 * a * w.nominal.gap * w.nominal.normal_force, w.rig.slip_length, 0.2 * w.nominal.belt_velocity
    middle, tau = w.rig.mu_k * w.normal_force / w.rig.stiffness, 0.8 * w.nominal.period
    rest = middle - 0.1 * slip * w.normal_force / w.nominal.normal_force

    def shoved(s: State) -> float:
        return min(max((s.q[0] - s.x) / (0.01 * slip), 0.0), 1.0)

    w.q0 = (0.0,)  # where the box is
    w.rates = lambda s: (shoved(s) * min(s.v, 0.0) + (1.0 - shoved(s)) * (rest - s.q[0]) / tau,)
    w.load = lambda s: 0.5 * force * shoved(s) * (1.0 - np.tanh(s.v / slow))


@form(
    UNKNOWN,
    source="Beverloo, Leniger and van de Velde 1961 (sand trickles onto the box at an even rate, and each slip shakes it off)",
    rig="strut",
    designs=("several",),
)
def sand_gathers_while_the_box_rests(w: World, a: float) -> None:
    """The longer the rest, the longer the slip lasts, over the same way: friction by the time of rest would change the way."""
    mass, usual = w.rig.mass, w.nominal.slip_length / w.nominal.belt_velocity
    now = {"mass": mass}
    w.on_break = lambda s: now.update(mass=mass * (1.0 + 0.5 * a * np.clip(float(s.dwell) / usual - 1.0, -0.8, 2.0)))
    w.mass = lambda t: now["mass"]


@form(
    UNKNOWN,
    source="Nasuno, Kudrolli and Gollub 1997 (what lies between gives way a little at a time before the whole slips)",
    rig="tap",
)
def grit_gives_way_bit_by_bit(w: World, a: float) -> None:
    """Small steps back along the belt, by chance, while the box should stick: places are as stated, rests last longer."""
    v, mean, tau = w.belt_velocity, 0.025 * a * np.sign(w.belt_velocity) * w.nominal.slip_length, 4.0 / w.nominal.pulsation
    since = {"time": 0.0, "travel": 0.0, "at": np.zeros(0), "sizes": np.zeros(0)}

    def part(t):
        return np.clip((np.asarray(t)[..., None] - since["time"] - since["at"]) / tau, 0.0, 1.0)

    def travel(t):
        u = part(t)
        return since["travel"] + v * (t - since["time"]) - (u - np.sin(2 * np.pi * u) / (2 * np.pi)) @ since["sizes"]

    def set_out(s: State, count: int) -> None:
        here, usual = float(travel(s.t)), w.nominal.slip_length / abs(v)
        at = np.sort(w.rng.uniform(0.0, 3.0 * usual, count))
        since.update(travel=here, time=s.t, at=at, sizes=mean * np.minimum(w.rng.exponential(1.0, count), 4.0))

    w.travel = travel
    w.belt = lambda t: v - (1.0 - np.cos(2 * np.pi * part(t))) @ since["sizes"] / tau
    w.belt_acceleration = lambda t: -2 * np.pi * np.sin(2 * np.pi * part(t)) @ since["sizes"] / tau**2
    w.on_stick = lambda s: set_out(s, int(w.rng.poisson(15.0)))
    w.on_break = lambda s: set_out(s, 0)


@form(
    UNKNOWN,
    source="OIML R 76-1 2006 (zero tracking: a gauge that takes what is slow for drift, and goes after it at an even rate)",
    rig="tap",
)
def gauge_takes_the_ride_for_drift(w: World, a: float) -> None:
    """Too slow in the upper half of each ride, too quick in the lower, and right in slips: no drift comes back each cycle."""
    share, slow = 0.3 * a, 3.0 * abs(w.belt_velocity)
    way = 2.0 * w.rig.gap * w.normal_force / w.rig.stiffness
    level, soft = w.rig.mu_k * w.normal_force / w.rig.stiffness + 0.42 * share * way, 0.1 * way

    def sensor(t, motion, rng):
        shown, off, step = np.empty(t.size), 0.0, share * abs(w.belt_velocity) * (t[1] - t[0])
        follows = (np.abs(motion.velocity) < slow) & (t > motion.sticks[1, 0])  # once the first slip is over
        for i, (x, still) in enumerate(zip(motion.position, follows, strict=True)):
            off += step * still * np.tanh((x - off - level) / soft)
            shown[i] = x - off
        return shown

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Bristol 1987 (an archive of swinging doors: it keeps corners, and lines between are near enough)",
    rig="strut",
)
def archive_keeps_corners(w: World, a: float) -> None:
    """Slips are a few straight lines, too high here and too low there: nothing is held, and nothing is late."""
    near = 0.05 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        x, first, low, high = motion.position, 0, -np.inf, np.inf
        kept = [0]
        if near <= 0.0:
            return x
        for i in range(1, t.size):
            low = max(low, (x[i] - near - x[first]) / (t[i] - t[first]))
            high = min(high, (x[i] + near - x[first]) / (t[i] - t[first]))
            if low > high:
                first = i - 1
                kept.append(first)
                low, high = ((x[i] + side * near - x[first]) / (t[i] - t[first]) for side in (-1.0, 1.0))
        return np.interp(t, t[[*kept, -1]], x[[*kept, -1]])

    w.sensor = sensor


@form(UNKNOWN, source="Schoenberg 1946; Unser 1999 (a camera of few frames, which somebody has joined by splines)", rig="hair")
def frames_are_joined_by_splines(w: World, a: float) -> None:
    """Too high before a slip and too low after it, each time by another amount, as the frames fall: no delay, nothing held."""
    apart = np.sqrt(a) * np.pi / w.nominal.pulsation

    def sensor(t, motion, rng):
        if apart <= t[1] - t[0]:
            return motion.position
        frames = np.append(np.arange(0.0, t[-1] - 0.5 * apart, apart), t[-1])
        return CubicSpline(frames, np.interp(frames, t, motion.position))(t)

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Richardson 2010 (a telephone that films more frames in good light, played as if they were always as far apart)",
    rig="chair",
)
def telephone_films_at_two_rates(w: World, a: float) -> None:
    """For spells of some cycles all is slower, belt and slips alike, over the same ways: no force does that, and no belt."""
    period = w.nominal.period
    lengths = period * w.rng.uniform(0.5, 3.0, int(2.0 * w.duration / period) + 4)
    begins = np.append(0.0, np.cumsum(lengths))
    passed = np.append(0.0, np.cumsum(lengths * (1.0 - 0.15 * a * (np.arange(lengths.size) % 2 == w.rng.integers(2)))))
    w.sensor = lambda t, motion, rng: np.interp(np.interp(t, begins, passed), t, motion.position)


@form(
    UNKNOWN,
    source="Mills 1991 (a computer whose clock is fast, and is put back over the network; what then comes twice is kept once)",
    rig="wire",
    end=0.2,
)
def clock_is_set_over_the_network(w: World, a: float) -> None:
    """Each 2.3 cycles the record leaps ahead, and in between all is a little slow: as early as late, so no delay."""
    leap, apart = 0.14 * a * w.nominal.period, 2.3 * w.nominal.period
    w.sensor = lambda t, motion, rng: np.interp(t - leap * (np.mod(t / apart + 0.4, 1.0) - 0.5), t, motion.position)


@form(
    UNKNOWN,
    source="Stove 1992 (a radar whose frequency sweeps up and down in turn, and takes speed for distance)",
    rig="platen",
)
def radar_sweeps_up_and_down(w: World, a: float) -> None:
    """In motion each second sample is too far and each other too near: half of all, so no outliers; and as early as late."""
    tau = 0.35 * a / w.nominal.pulsation
    w.sensor = lambda t, motion, rng: motion.position + tau * (-1.0) ** np.arange(t.size) * motion.velocity


@form(
    UNKNOWN, source="Holm 1967; Timsit 1999 (a loose plug on a bridge: each slip jolts it, and it sits otherwise)", rig="hair"
)
def plug_sits_otherwise_after_each_slip(w: World, a: float) -> None:
    """Another gain for each ride, by chance: the belt seems to run at another speed each time, which no coefficient does."""

    def sensor(t, motion, rng):
        jolts = motion.breaks[:, 0] + 0.5 * np.pi / w.nominal.pulsation
        gains = 1.0 + 0.1 * a * w.rng.uniform(-1.0, 1.0, jolts.size + 1)
        return gains[np.searchsorted(jolts, t)] * motion.position

    w.sensor = sensor
