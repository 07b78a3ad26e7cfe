"""Motion of a box on a belt with true stick: fixed Runge-Kutta steps in slip, switches located within their step."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from .rigs import Rig

ELASTIC_STEP = 2.0
"""Step while an elastic contact holds, over that in slip [-]."""
CHUNK = 2048
"""Grid points of a stick phase that are looked at together."""
STEPS = 400
"""Steps in a natural period of the rig."""


class State:
    """What a force may depend on; numbers in slip, arrays in stick."""

    t: Any = 0.0
    """Time [s]."""
    x: Any = 0.0
    """Position [m]."""
    v: Any = 0.0
    """Velocity [m/s]."""
    a: Any = 0.0
    """Acceleration, where it is known before friction is [m/s^2]."""
    w: Any = 0.0
    """Belt velocity less velocity [m/s]."""
    travel: Any = 0.0
    """Belt travel [m]."""
    slip: Any = 0.0
    """Distance slid since break-away [m]; in stick that of the last slip."""
    slip_time: Any = 0.0
    """Time since break-away [s]."""
    dwell: Any = 0.0
    """Time since the box stuck [s]; in slip the duration of the last stick."""
    slid: Any = 0.0
    """Distance slid since the start of the run [m]."""
    q: Any = ()
    """Further unknowns."""
    count: int = 0
    """Break-aways so far."""
    direction: float = 1.0
    """Sign of friction in slip."""


@dataclasses.dataclass
class World:
    """One run of a rig, with its forces as functions of the state that forms replace."""

    rig: Rig
    """The true rig."""
    nominal: Rig
    """The rig as believed, whose sizes forms refer to."""
    belt_velocity: float
    """[m/s]."""
    normal_force: float
    """True normal force of this run [N]."""
    duration: float
    """[s]."""
    rng: np.random.Generator
    """Randomness of the process."""
    step: float = 0.0
    """Step in slip [s]."""
    q0: tuple[float, ...] = ()
    """Further unknowns at the start."""
    memory: dict[str, float] = dataclasses.field(default_factory=dict)
    """What events leave behind."""
    columns: dict[str, Callable] = dataclasses.field(default_factory=dict)
    """Header of a further column -> its values from (time, motion)."""

    def __post_init__(self) -> None:
        rig, load, speed = self.rig, self.normal_force, self.belt_velocity
        self.step = self.step or 2.0 * np.pi / self.nominal.pulsation / STEPS
        self.belt: Callable = lambda t: speed + 0.0 * t
        self.travel: Callable = lambda t: speed * t
        self.belt_acceleration: Callable = lambda t: 0.0 * t
        self.normal: Callable = lambda s: load
        self.mu_s: Callable = lambda s: rig.mu_s
        self.mu_k: Callable = lambda s: rig.mu_k
        self.spring: Callable = lambda s: rig.stiffness * s.x
        self.damping: Callable = lambda s: rig.damping * s.v
        self.mass: Callable = lambda t: rig.mass
        self.foot: Callable = lambda t: (
            rig.stiffness * rig.excitation_amplitude * np.cos(rig.excitation_angular_frequency * t)
            if rig.excitation_amplitude
            else 0.0
        )
        self.load: Callable = lambda s: 0.0
        self.rates: Callable = lambda s: ()
        self.on_stick: Callable = lambda s: None
        self.on_break: Callable = lambda s: None
        self.contact: Callable | None = None  # (z, v_rel, mu_s N) -> force of the stuck contact [N]
        self.contact_deflection: Callable | None = None  # share of mu_s N -> z [m]
        self.sensor: Callable = lambda t, motion, rng: motion.position

    def set_belt(self, velocity: Callable) -> None:
        """Make the belt run at velocity(t) [m/s], tabulated every quarter of a step."""
        grid = np.arange(0.0, self.duration + 4 * self.step, 0.25 * self.step)
        values = velocity(grid)
        travel = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(grid))])
        rate = np.gradient(values, grid)
        self.belt = lambda t: np.interp(t, grid, values)
        self.travel = lambda t: np.interp(t, grid, travel)
        self.belt_acceleration = lambda t: np.interp(t, grid, rate)


@dataclasses.dataclass(frozen=True)
class Motion:
    """A run as it truly was."""

    time: np.ndarray
    """[s]."""
    position: np.ndarray
    """[m]."""
    velocity: np.ndarray
    """[m/s]."""
    breaks: np.ndarray
    """Rows (time [s], position [m]) of break-aways."""
    sticks: np.ndarray
    """Rows (time [s], position [m]) of the ends of slips."""
    friction_work: float
    """Work of friction between box and belt [J]; what it dissipates is counted negative."""


def simulate(world: World, time: np.ndarray) -> Motion:
    """Return the motion of `world` from rest at x = 0, at the times `time` [s]."""
    return _Run(world, time).motion()


class _Run:
    """The integration of one run."""

    def __init__(self, world: World, time: np.ndarray) -> None:
        self.world, self.time = world, time
        self.x, self.v = np.zeros_like(time), np.zeros_like(time)
        self.s = State()
        self.slid, self.dwell, self.count, self.work = 0.0, 0.0, 0, 0.0
        self.breaks: list[tuple[float, float]] = []
        self.sticks: list[tuple[float, float]] = []

    def motion(self) -> Motion:
        world = self.world
        end = float(self.time[-1])
        t, x, v, q = 0.0, 0.0, 0.0, np.array(world.q0)
        direction = float(np.sign(world.belt_velocity))
        held = False
        while t < end:
            if held:
                t, x, v, q, direction = (
                    self._elastic(t, x, v, q, end, direction) if world.contact else self._stick(t, x, q, end)
                )
                if t < end:
                    self.count += 1
                    self.breaks.append((t, x))
                    world.on_break(self._fill(self.s, t, x, v, q))
            else:
                start = float(world.travel(t)) - x
                t, x, v, q = self._slip(t, x, v, q, end, direction)
                moved = abs(float(world.travel(t)) - x - start)
                if t < end:
                    self.slid += moved
                    self.s.slip = moved
                    self.s.slid = self.slid
                    self.sticks.append((t, x))
                    world.on_stick(self._fill(self.s, t, x, v, q))
                    self.dwell = 0.0
                    self.s.dwell = 0.0
                    need, hold = self._need(t, x, q)
                    if abs(need) > hold and not world.contact:
                        direction, held = float(np.sign(need)), False
                        continue
            held = not held
        return Motion(
            self.time, self.x, self.v, np.array(self.breaks).reshape(-1, 2), np.array(self.sticks).reshape(-1, 2), self.work
        )

    def _fill(self, s: State, t: Any, x: Any, v: Any, q: Any) -> State:
        s.t, s.x, s.v, s.q, s.count = t, x, v, q, self.count
        s.travel = self.world.travel(t)
        s.w = self.world.belt(t) - v
        return s

    def _need(self, t: Any, x: Any, q: Any) -> tuple[Any, Any]:
        """Return the friction force that keeps the box on the belt, and the largest one there is [N]."""
        world = self.world
        s = self._fill(self.s, t, x, world.belt(t), q)
        s.a = world.belt_acceleration(t)
        need = world.mass(t) * s.a + world.spring(s) + world.damping(s) - world.load(s) - world.foot(t)
        return need, world.mu_s(s) * world.normal(s)

    def _stick(self, t0: float, x0: float, q0: np.ndarray, end: float) -> tuple[float, float, float, np.ndarray, float]:
        world, s, origin = self.world, self.s, float(self.world.travel(t0))

        def place(t: Any) -> Any:
            return x0 + world.travel(t) - origin

        def excess(t: Any, q: Any) -> Any:
            s.dwell = t - t0
            need, hold = self._need(t, place(t), q)
            return np.abs(need) - hold

        if len(q0):
            t, q = self._ride(t0, q0, end, place, excess)
        else:
            t, q = self._search(t0, end, excess), q0
        inside = slice(*np.searchsorted(self.time, [t0, t if t < end else np.inf]))
        self.x[inside], self.v[inside] = place(self.time[inside]), world.belt(self.time[inside])
        self.dwell = s.dwell = t - t0
        need, _ = self._need(t, place(t), q)
        return t, float(place(t)), float(world.belt(t)), q, float(np.sign(need))

    def _search(self, t0: float, end: float, excess: Callable) -> float:
        """Return the time at which a stick phase without unknowns of its own ends, or `end`."""
        h, start = self.world.step, t0
        while start < end:
            grid = start + h * np.arange(CHUNK + 1)
            over = np.flatnonzero(np.broadcast_to(excess(grid, ()), grid.shape) > 0.0)
            if over.size:
                i = over[0]
                t = float(grid[i])
                if i and excess(float(grid[i - 1]), ()) < 0.0 < excess(t, ()):
                    t = float(brentq(lambda u: float(excess(u, ())), grid[i - 1], t, xtol=1e-12))
                return min(t, end)
            start = float(grid[-1])
        return end

    def _ride(self, t: float, q: np.ndarray, end: float, place: Callable, excess: Callable) -> tuple[float, np.ndarray]:
        """Return when a stick phase ends, and the further unknowns then."""
        world, s = self.world, self.s

        def rate(u: float, y: np.ndarray) -> np.ndarray:
            self._fill(s, u, place(u), world.belt(u), y)
            s.a = world.belt_acceleration(u)
            return np.array(world.rates(s))

        def advanced(h: float) -> np.ndarray:
            a = rate(t, q)
            b = rate(t + h / 2, q + h / 2 * a)
            c = rate(t + h / 2, q + h / 2 * b)
            return q + h / 6 * (a + 2 * b + 2 * c + rate(t + h, q + h * c))

        while t < end:
            h = min(2.0 * world.step, end - t)
            new = advanced(h)
            if excess(t + h, new) > 0.0:
                if excess(t, q) < 0.0:
                    h = float(
                        brentq(lambda g: float(excess(t + g, advanced(g))), 0.0, h, xtol=1e-12)  # noqa: B023
                    )
                return t + h, advanced(h)
            t, q = t + h, new
        return end, q

    def _derivative(self, t: float, y: np.ndarray, friction: Callable) -> np.ndarray:
        """Return the rates of (x, v, further unknowns)."""
        world, s = self.world, self.s
        self._fill(s, t, y[0], y[1], y[2:])
        others = world.foot(t) + world.load(s) - world.spring(s) - world.damping(s)
        s.a = others / world.mass(t)
        s.a = (others + friction(s)) / world.mass(t)
        return np.array([y[1], s.a, *world.rates(s)])

    def _advanced(self, t: float, y: np.ndarray, h: float, first: np.ndarray, friction: Callable) -> np.ndarray:
        b = self._derivative(t + h / 2, y + h / 2 * first, friction)
        c = self._derivative(t + h / 2, y + h / 2 * b, friction)
        d = self._derivative(t + h, y + h * c, friction)
        return y + h / 6 * (first + 2 * b + 2 * c + d)

    def _record(self, t: float, y: np.ndarray, a: float, h: float, new: np.ndarray, a_new: float) -> None:
        """Fill the samples in [t, t + h) by cubic Hermite polynomials."""
        i, j = np.searchsorted(self.time, [t, t + h])
        if t + h >= self.time[-1]:
            j = len(self.time)
        if i == j:
            return
        u = (self.time[i:j] - t) / h
        p, r, m, n = (1 + 2 * u) * (1 - u) ** 2, u * (1 - u) ** 2 * h, u * u * (3 - 2 * u), u * u * (u - 1) * h
        self.x[i:j] = p * y[0] + r * y[1] + m * new[0] + n * new[1]
        self.v[i:j] = p * y[1] + r * a + m * new[1] + n * a_new

    def _slip(
        self, t: float, x: float, v: float, q: np.ndarray, end: float, direction: float
    ) -> tuple[float, float, float, np.ndarray]:
        world, s = self.world, self.s
        t0, start, slid0 = t, float(world.travel(t)) - x, self.slid
        s.direction, s.dwell = direction, self.dwell

        def friction(s: State) -> float:
            s.slip_time = s.t - t0
            s.slip = direction * (s.travel - s.x - start)
            s.slid = slid0 + abs(s.slip)
            return direction * world.mu_k(s) * world.normal(s)

        def speed(u: float, z: np.ndarray) -> float:
            return direction * float(world.belt(u) - z[1])

        y, first_step = np.array([x, v, *q]), True
        while t < end:
            h = min(world.step, end - t)
            rate = self._derivative(t, y, friction)
            new = self._advanced(t, y, h, rate, friction)
            done = speed(t + h, new) <= 0.0
            if done and not first_step and speed(t, y) > 0.0:
                h = float(brentq(lambda g: speed(t + g, self._advanced(t, y, g, rate, friction)), 0.0, h, xtol=1e-13))  # noqa: B023
                new = self._advanced(t, y, h, rate, friction)
            rate_new = self._derivative(t + h, new, friction)
            self._record(t, y, rate[1], h, new, rate_new[1])
            self.work -= (
                direction * friction(s) * (direction * (float(world.travel(t + h)) - float(world.travel(t)) - new[0] + y[0]))
            )
            t, y, first_step = t + h, new, False
            if done:
                break
        return t, float(y[0]), float(y[1]), y[2:]

    def _elastic(
        self, t: float, x: float, v: float, q: np.ndarray, end: float, direction: float
    ) -> tuple[float, float, float, np.ndarray, float]:
        """Return where an elastic contact breaks away."""
        world, s = self.world, self.s
        t0 = t
        self._fill(s, t, x, v, q)
        share = float(world.mu_k(s) / world.mu_s(s))
        zero = direction * world.contact_deflection(share) - (float(world.travel(t)) - x)

        def friction(s: State) -> float:
            s.dwell = s.t - t0
            return world.contact(zero + s.travel - s.x, s.w, world.mu_s(s) * world.normal(s))

        y = np.array([x, v, *q])
        force = 0.0
        while t < end:
            h = min(ELASTIC_STEP * world.step, end - t)
            rate = self._derivative(t, y, friction)
            new = self._advanced(t, y, h, rate, friction)
            rate_new = self._derivative(t + h, new, friction)
            self._record(t, y, rate[1], h, new, rate_new[1])
            t, y = t + h, new
            force = friction(s)
            if abs(force) >= world.mu_s(s) * world.normal(s) and force * s.w > 0.0:
                break
        self.dwell = s.dwell
        return t, float(y[0]), float(y[1]), y[2:], float(np.sign(force))
