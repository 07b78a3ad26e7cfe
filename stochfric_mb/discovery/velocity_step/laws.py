"""Laws that are fitted to velocity steps: constant friction, drift with displacement, dependence on speed, memory."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.velocity_step.rate_and_state import AGEING, QUADRATIC, SLIP, friction_path
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.shapes.splines import COARSER, COURSE, splines
from stochfric_mb.effects.traits import MEMORY, RATE, SLOPE_IN_DISTANCE
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

SETTLING = (0.03, 0.1, 0.3)
"""Lengths in which a drift settles where its fits begin, over the whole displacement [-]."""
MEMORY_STARTS = [(b, d, k) for b in (0.01, -0.01) for d in (1.0, 10.0, 100.0) for k in (0.3, 3.0)]
"""Starts of the memory law: evolution effect b, distance D, and stiffness, the last two over the stated ones."""


LONG_BEFORE = 7.0
"""Most that the logarithm of the state at the start may be from steady sliding [-]: it has been held, or slid, a thousand times
as long as it remembers. Further off, the first rise of a memory from nothing stood for a coating that wears off."""


@dataclasses.dataclass(frozen=True)
class Track:
    """One run: friction and the speed of the load point, or the piece of them between two changes of sampling rate."""

    run: Run
    """The run."""
    friction: Array
    """Friction coefficient [-], shape (n,)."""
    speed: Array
    """Speed of the load point, through a window [m/s], shape (n,), > 0."""
    pull: Array
    """Its mean speed from each sample to the next [m/s], shape (n,), > 0."""
    slid: Array
    """Displacement of the load point since the first run began [m], shape (n,)."""


@dataclasses.dataclass(frozen=True)
class Number:
    """A number of a law."""

    name: str
    """Its name."""
    unit: str
    """Its unit."""
    scale: float
    """A natural step."""
    low: float = -np.inf
    """Smallest value."""
    high: float = np.inf
    """Largest value."""


@dataclasses.dataclass(frozen=True)
class Law:
    """A friction law that is fitted."""

    kind: str
    """Effect that it stands for; empty: constant friction."""
    numbers: tuple[Number, ...]
    """Its numbers."""
    starts: tuple[tuple[float, ...], ...]
    """Where fits begin."""
    predict: Callable[[Sequence[Track], Array], list[Array]]
    """Tracks and numbers -> friction coefficients."""
    variant: str = ""
    """Which of several forms of that effect it is."""
    pieces: int = 0
    """Pieces of the course that it follows, its last numbers; 0: none."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its numbers."""
        return tuple(n.name for n in self.numbers)


def laws(reference: float, stiffness: float, mu: float, shortest: float, way: float) -> list[Law]:
    """Return what is fitted: constant friction, drift with displacement, dependence on speed, and memory.

    A drift may settle beside a straight one, as it may beside the other laws: a memory with a drift of its own would win over
    a drift that bends. It may follow a course of any smooth shape: a film that grows, a coating until it is gone.

    A machine in which all of friction deflects the spring by no more than the shortest distance looks rigid: no fit makes it
    stiffer.

    Args:
        reference: speed v_0 at which mu_0 holds [m/s].
        stiffness: stated stiffness [1/m].
        mu: stated friction coefficient [-].
        shortest: least distance D that shows, that of the usual motion in two samples [m].
        way: displacement of the load point in the fit runs [m]; a course stays as it is beyond.
    """

    def constant(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + 0.0 * t.speed for t in tracks]

    def drift(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + p[1] * t.slid for t in tracks]

    def settling(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [
            line + p[2] * (1.0 - np.exp(-np.maximum(t.slid, 0.0) / np.exp(p[3])))
            for t, line in zip(tracks, drift(tracks, p), strict=True)
        ]

    def course(tracks: Sequence[Track], p: Array, *, pieces: int) -> list[Array]:
        return [p[0] + splines(t.slid / way, pieces) @ p[1:] for t in tracks]

    def speed(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + p[1] * t.slid + p[2] * np.log(t.speed / reference) for t in tracks]

    def pulled(tracks: Sequence[Track], p: Array) -> list[Array]:
        return memory(tracks, np.array([*p[:3], 0.0, 0.0, p[3], 0.0]))

    def memory(tracks: Sequence[Track], p: Array, *, state: int = AGEING) -> list[Array]:
        return [p[0] + p[1] * t.slid + m for t, m in zip(tracks, _remembered(tracks, p[2:], reference, state), strict=True)]

    least, stiffest = float(np.log(shortest)), float(np.log(max(mu, 0.01) / shortest))
    level, slope = Number("mu_0", "-", 0.01, 0.0), Number("slope", "1/m", 1.0)
    direct, log_stiffness = Number("direct_effect", "-", 0.002, 1.0e-4), Number("log_stiffness", "-", 0.3, high=stiffest)
    settles = level, slope, Number("change", "-", 0.01), Number("log_distance", "-", 0.3, least, float(np.log(way)))
    remembers = (
        level, slope, direct, Number("evolution_effect", "-", 0.002), Number("log_distance", "-", 0.3, least), log_stiffness,
        Number("log_state", "-", 0.3, -LONG_BEFORE, LONG_BEFORE),
    )  # fmt: skip
    by_way, by_speed, by_memory = (kind_with_signature(finding) for finding in (SLOPE_IN_DISTANCE, RATE, MEMORY))
    memories = {"": memory} | {
        name: functools.partial(memory, state=state) for name, state in (("slip law", SLIP), ("quadratic law", QUADRATIC))
    }
    ends = [(mu, 0.0, size, float(np.log(part * way))) for size in (0.01, -0.01) for part in SETTLING]
    through = [(mu, 0.0, 0.005, float(np.log(stiffer * stiffness))) for stiffer in (0.3, 1.0, 3.0)]
    remembered = [memory_start(mu, stiffness, *start) for start in MEMORY_STARTS]
    return [
        Law("", (level,), ((mu,),), constant),
        Law(by_way, (level, slope), ((mu, 0.0),), drift),
        Law(by_way, settles, tuple(ends), settling, "running-in"),
        *(
            Law(
                by_way, (level, *(Number(name, "-", 0.01) for name in COURSE[: n + 2])), ((mu, *(0.0,) * (n + 2)),),
                functools.partial(course, pieces=n), f"course of {n} pieces", n,
            )
            for n in COARSER
        ),
        Law(by_speed, (level, slope, Number("a_minus_b", "-", 0.001)), ((mu, 0.0, 0.0),), speed),
        Law(by_speed, (level, slope, direct, log_stiffness), tuple(through), pulled, "through the spring"),
        *(Law(by_memory, remembers, tuple(remembered), predict, variant) for variant, predict in memories.items()),
    ]  # fmt: skip


def memory_start(mu: float, stiffness: float, evolution: float, distance: float, stiffer: float) -> tuple[float, ...]:
    """Return a start of the memory law: its numbers in the order of `laws`."""
    length = 1.0e-3 / stiffness
    return (mu, 0.0, 0.01, evolution, float(np.log(distance * length)), float(np.log(stiffer * stiffness)), 0.0)


def _remembered(tracks: Sequence[Track], p: Array, reference: float, state: int) -> list[Array]:
    """Return what the memory law adds to mu_0, marched through each record, all its pieces one after the other."""
    marched = {id(t): m for r in records(tracks) for t, m in zip(r, _marched(r, p, reference, state), strict=True)}
    return [marched[id(t)] for t in tracks]


def records(tracks: Sequence[Track]) -> list[list[Track]]:
    """Return tracks, by rising start, by record: one that begins before all others have ended is a test of its own.

    A piece follows what comes before it in its own file, if there is any.
    """
    groups: list[list[Track]] = []
    for track in tracks:
        ended = [r for r in groups if track.run.time[0] >= r[-1].run.time[-1]]
        own = [r for r in ended if r[-1].run.source == track.run.source] or ended
        if own:
            own[-1].append(track)
        else:
            groups.append([track])
    return groups


def _marched(tracks: Sequence[Track], p: Array, reference: float, state: int) -> list[Array]:
    step = min(t.run.sample_interval for t in tracks)
    start, end = float(tracks[0].run.time[0]), max(float(t.run.time[-1]) for t in tracks)
    grid = np.arange(start, end + step, step)
    times, pull = (np.concatenate(x) for x in ([t.run.time for t in tracks], [t.pull for t in tracks]))
    speed = pull[np.searchsorted(times, grid + 0.5 * step, side="right") - 1]
    speed[0] = tracks[0].speed[0]  # it starts at this speed, which a single step from sample to sample does not show
    mu = np.empty(len(grid))
    limits = np.array([[1.0e-6, -10.0, -40.0, -10.0, -20.0], [10.0, 10.0, 10.0, 40.0, 20.0]])
    direct, evolution, *logarithms = np.clip(p, *limits)
    friction_path(speed, step, direct, evolution, *np.exp(logarithms), reference, state, mu)
    return [np.interp(t.run.time, grid, mu) for t in tracks]
