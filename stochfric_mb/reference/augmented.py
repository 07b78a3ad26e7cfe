"""The fast simulator of a belt-box with effects: Coulomb with true stick, or a law that reduces to it, plus any effects.

>>> from stochfric_mb import Coulomb, load_scenario, make_effect
>>> box = load_scenario("kang2015_table1").mechanism
>>> system = augmented_system(box, Coulomb(mu_s=0.8, mu_k=0.46), [make_effect("dwell_ageing", rate=0.02)])
>>> motion = system.march(Start(velocity=box.belt_velocity, stick=True), step=1e-3, count=3_000)
>>> [("stick", "break-away")[int(kind)] for _, kind in motion.events]
['break-away', 'stick', 'break-away', 'stick']

Steps are adaptive (Dormand and Prince, with dense output), switches are located within them, and a rigidly stuck box
rides on the belt in closed form. Everything is compiled once: effects are called through their addresses.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients import CoefficientPath, Process
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.effects import Effect
from stochfric_mb.effects.abi import native_effect
from stochfric_mb.effects.combine import combined_process
from stochfric_mb.errors import InputError, SimulationError, require_number
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference import augmented_march, augmented_model
from stochfric_mb.trajectory import Array

TOLERANCE = 1.0e-8
"""Local error of a step over the static deflection [-]."""
TOLERANCE_SPRING = 1.0e-9
"""The same where a spring sticks: break-away from it is slow, so that small errors grow."""
RESTART = 0.0051
"""First step after a switch, as an angle of the natural oscillation [rad]."""
LOADED = 0.05
"""Longest step in stick, over the time in which the belt loads the spring up to mu_s N, where nothing else is as quick [-]."""
LAWS = ("coulomb", "elastic_stick", "stribeck")
"""Laws that the fast simulator knows."""


@dataclasses.dataclass(frozen=True)
class Start:
    """The state of an augmented belt-box at one instant."""

    time: float = 0.0
    """Time since the start of the record [s]."""
    position: float = 0.0
    """Position of the box [m]."""
    velocity: float = 0.0
    """Its velocity [m/s]; a rigidly stuck box takes the belt's."""
    stick: bool = False
    """Whether it sticks."""
    dwell: float = 0.0
    """Time since it stuck [s]; of a sliding box the duration of the last stick."""
    slip: float = 0.0
    """Distance that a sliding box has slid since break-away [m]."""
    slip_time: float = 0.0
    """Time that a sliding box has slid since break-away [s]."""
    memory: tuple[float, ...] | None = None
    """Unknowns of the effects' own equations, one after the other; None: at rest relative to the box."""
    deflection: float = math.nan
    """Deflection of a contact stuck by a spring [m]; not a number: the one that holds the box in balance."""
    draws: int = 0
    """Number of stick phases begun so far: address of the pair of coefficients of a per_event process."""


@dataclasses.dataclass(frozen=True)
class Motion:
    """Outputs of a march; every array but ``events`` has shape (count,)."""

    time: Array
    """Time [s]."""
    position: Array
    """Position [m]."""
    velocity: Array
    """Velocity [m/s]."""
    friction_force: Array
    """Friction force on the box [N]."""
    stick: Array
    """1 where the contact sticks, otherwise 0."""
    normal_force: Array
    """Normal force [N]."""
    mu_s: Array
    """Static coefficient of the path, before effects [-]."""
    mu_k: Array
    """Kinetic coefficient of the path, before effects [-]."""
    events: Array
    """Located switches, shape (n, 2): time [s] and 1 (break-away) or 0 (stick)."""
    end: Start
    """The state after the last output."""


def augmented_system(
    mechanism: BeltBox,
    law: Law,
    effects: Sequence[Effect] = (),
    process: Process | None = None,
    *,
    seed: int = 0,
    sample: int = 0,
    temperature: tuple[Array, Array] | None = None,
    tolerance: float | None = None,
) -> AugmentedSystem:
    """Return a belt-box with effects, ready to march.

    Args:
        mechanism: what moves.
        law: coulomb, elastic_stick or stribeck.
        effects: what is added; those of a sensor do not act here (`Effect.measure`).
        process: how the coefficients vary; None: constant, unless an effect of randomness sets them.
        seed: first part of the address of random numbers.
        sample: second part.
        temperature: times [s], evenly spaced, and measured temperatures there [degC], `TEMPERATURES` of each; None: none was.
        tolerance: local error of a step over the static deflection [-]; None: as small as a run of many cycles needs.

    Raises:
        InputError: a law that the fast simulator does not know, two processes, more effects than it has room for, or an effect
            that reads a temperature where none was measured.
    """
    process = combined_process(effects, process)
    path = CoefficientPath(process, law, seed=seed, sample=sample)
    run = np.zeros(1, augmented_model.RUN).view(np.recarray)[0]
    _set_mechanism(run, mechanism)
    _set_law(run, law)
    _set_effects(run, effects)
    _set_numerics(run, mechanism, law, effects, path, tolerance)
    _set_temperature(run, effects, temperature)
    return AugmentedSystem(mechanism, law, tuple(effects), process, run, path.descriptor)


class AugmentedSystem:
    """A belt-box with effects; made by `augmented_system`, never changed."""

    def __init__(
        self,
        mechanism: BeltBox,
        law: Law,
        effects: tuple[Effect, ...],
        process: Process | None,
        run: Any,
        descriptor: npt.NDArray[np.float64],
    ) -> None:
        """Hold the compiled view of a model; use `augmented_system`."""
        self.mechanism, self.law, self.effects, self.process = mechanism, law, effects, process
        self._run, self._descriptor = run, descriptor

    def march(self, start: Start, step: float, count: int) -> Motion:
        """Return the motion at start.time + step (1, ..., count).

        Args:
            start: where to begin.
            step: distance between outputs [s], > 0.
            count: number of outputs.

        Raises:
            SimulationError: the contact switches without end, or the motion is not finite.
        """
        require_number("step", step, above=0.0, unit="s")
        run = self._begun(start)
        rows = np.empty((count, augmented_march.COLUMNS))
        log = augmented_march.march(run, self._descriptor, float(step), count, rows, False)
        self._require_sane(run.clock[augmented_model.STATUS], run.clock[augmented_model.NOW])
        times = start.time + step * np.arange(1, count + 1, dtype=np.float64)
        return _motion(times, rows, log[: int(run.clock[augmented_model.SWITCHES])].copy(), _end(run))

    def at(self, start: Start) -> Motion:
        """Return the one sample that ``start`` is, with the forces there."""
        run = self._begun(start)
        rows = np.empty((1, augmented_march.COLUMNS))
        augmented_march.record(run, self._descriptor, float(start.time), rows[0], False)
        return _motion(np.array([start.time]), rows, np.empty((0, 2)), _end(run))

    def _begun(self, start: Start) -> Any:
        run = _copied(self._run)
        run.y[2 : 2 + run.counts[2]] = self._memories([start])[0]
        augmented_march.begin(
            run, self._descriptor, float(start.time), float(start.position), float(start.velocity), bool(start.stick),
            float(start.dwell), float(start.slip), float(start.slip_time), float(start.draws), float(start.deflection),
        )  # fmt: skip
        return run

    def recalled(self, time: Array, position: Array, velocity: Array) -> Array:
        """Return the memories of the effects at each sample of a motion as measured, at rest at first, shape (n, n_memory).

        Args:
            time: time [s], shape (n,), increasing by steps that resolve the effects' own motion.
            position: position of the body [m], shape (n,).
            velocity: its velocity [m/s], shape (n,).
        """
        run = _copied(self._run)
        values = np.zeros((len(time), int(run.counts[2])))
        if values.size:
            motion = [np.ascontiguousarray(a, dtype=np.float64) for a in (time, position, velocity)]
            augmented_march.recall(run, *motion, _at_rest(self.effects, position[:1], velocity[:1])[0], values)
        return values

    def forecasts(
        self, starts: npt.ArrayLike, step: float, count: int, memories: Array | None = None
    ) -> npt.NDArray[np.float64]:
        """Return positions [m] at step (1, ..., count) after each start, shape (k, count), in one compiled call.

        Coefficients drawn from event to event are drawn anew for each start, so that forecasts do not share their luck.

        Args:
            starts: shape (k, 5) or (k, 6): time [s], position [m], velocity [m/s], stick (0 or 1), dwell [s] and, if
                given, slip [m]; springs start at rest.
            step: distance between outputs [s], > 0.
            count: number of outputs.
            memories: unknowns of the effects' own equations at the starts, shape (k, n_memory); None: at rest.

        Raises:
            InputError: starts of another shape.
            SimulationError: as `march`.
        """
        table = np.ascontiguousarray(starts, dtype=np.float64)
        if table.ndim != 2 or table.shape[1] not in (5, 6):
            raise InputError(f"starts has shape {table.shape}; give rows of time, position, velocity, stick, dwell[, slip]")
        if table.shape[1] == 5:
            table = np.column_stack([table, np.zeros(len(table))])
        run = _copied(self._run)
        paths = np.empty((len(table), count))
        if memories is None:
            memories = _at_rest(self.effects, table[:, 1], table[:, 2])
        status = augmented_march.forecasts(run, self._descriptor, table, memories, float(step), count, paths)
        self._require_sane(status, math.nan)
        return paths

    def _memories(self, starts: Sequence[Start]) -> Array:
        rest = _at_rest(
            self.effects,
            np.array([s.position for s in starts], dtype=float),
            np.array([s.velocity for s in starts], dtype=float),
        )
        for i, start in enumerate(starts):
            if start.memory is not None:
                if len(start.memory) != rest.shape[1]:
                    raise InputError(f"memory has {len(start.memory)} entries; the effects of this system have {rest.shape[1]}")
                rest[i] = start.memory
        return rest

    def _require_sane(self, status: float, t: float) -> None:
        if status == augmented_march.OK:
            return
        what = {
            augmented_march.ENDLESS: "switches without end",
            augmented_march.TOO_STIFF: f"needs more than {augmented_march.MOST_STEPS} steps per output",
        }.get(status, "is not finite")
        kinds = ", ".join(effect.kind for effect in self.effects) or "none"
        raise SimulationError(f"the motion {what} at t = {t:g} s (effects: {kinds}); check the parameters")


def _motion(times: Array, rows: Array, events: Array, end: Start) -> Motion:
    names = ("position", "velocity", "friction_force", "stick", "normal_force", "mu_s", "mu_k")
    return Motion(time=times, **{name: rows[:, i].copy() for i, name in enumerate(names)}, events=events, end=end)


def _copied(run: Any) -> Any:
    return np.array([run], dtype=augmented_model.RUN).view(np.recarray)[0]


def _at_rest(effects: Sequence[Effect], position: Array, velocity: Array) -> Array:
    parts = [effect.rest(position, velocity) for effect in effects if effect.n_memory]
    return np.hstack(parts) if parts else np.zeros((len(position), 0))


def _end(run: Any) -> Start:
    m = augmented_model
    clock, y, world = run.clock, run.y, run.world
    augmented_model.surround(run, clock[m.NOW], y, run.unused)
    sliding = clock[m.MODE] == m.SLIDING
    u = float(world[m.e.BELT_TRAVEL] - y[0])
    return Start(
        time=float(clock[m.NOW]),
        position=float(y[0]),
        velocity=float(y[1]),
        stick=not sliding,
        dwell=float(clock[m.DWELL] if sliding else clock[m.NOW] - clock[m.SINCE]),
        slip=float(clock[m.SLID] + abs(u - clock[m.BROKE_AT])) if sliding else 0.0,
        slip_time=float(clock[m.NOW] - clock[m.SINCE] - clock[m.DWELL]) if sliding else 0.0,
        memory=tuple(float(v) for v in y[2 : 2 + run.counts[2]]),
        deflection=u - float(clock[m.ANCHOR]) if clock[m.MODE] == m.SPRING else math.nan,
        draws=int(clock[m.DRAWS]),
    )


def _set_mechanism(run: Any, mechanism: BeltBox) -> None:
    m = augmented_model
    for name, index in (
        ("mass", m.M), ("damping", m.C), ("stiffness", m.K), ("normal_force", m.N), ("belt_velocity", m.VB),
        ("excitation_amplitude", m.FOOT), ("excitation_angular_frequency", m.W),
    ):  # fmt: skip
        run.constants[index] = getattr(mechanism, name)


def _set_law(run: Any, law: Law) -> None:
    m = augmented_model
    if law.kind not in LAWS:
        raise InputError(
            f"the fast simulator of effects does not know the law {law.kind!r}; use {', '.join(LAWS)}, "
            "or the reference, which takes any law without a flow"
        )
    run.constants[m.MEAN_S], run.constants[m.MEAN_K] = law.mu_s, law.mu_k
    numbers: dict[str, int] = {}
    if law.kind == "elastic_stick":
        run.constants[m.CURVE] = m.ELASTIC
        numbers = {"e_lim": m.LIMIT, "zeta": m.ZETA, "v_s": m.RESTICK, "decay_velocity": m.DECAY}
    elif law.kind == "stribeck":
        run.constants[m.CURVE] = m.STRIBECK
        run.constants[m.FORM] = law.parameters()[3]
        numbers = {"stribeck_velocity": m.DECAY}
    for name, index in numbers.items():
        run.constants[index] = getattr(law, name)


def _set_effects(run: Any, effects: Sequence[Effect]) -> None:
    m = augmented_model
    if len(effects) > m.MAX_EFFECTS:
        raise InputError(f"{len(effects)} effects; there is room for {m.MAX_EFFECTS}: leave some out")
    offset = memory = 0
    around: list[tuple[bool, tuple[int, int, int]]] = []
    friction: list[tuple[int, tuple[int, int, int]]] = []
    for effect in effects:
        p = effect.parameters()
        if effect.kind == "presliding_compliance":
            if run.constants[m.LIMIT] != 0.0:
                raise InputError("law elastic_stick has presliding compliance; leave out the effect or use law coulomb")
            run.constants[m.LIMIT], run.constants[m.ZETA] = p
        elif effect.coefficient_process() is None and ((native := native_effect(type(effect))).surroundings or native.friction):
            if offset + len(p) > m.MAX_PARAMETERS or memory + effect.n_memory > m.MAX_MEMORY:
                raise InputError(f"the effects up to {effect.kind} have more parameters or unknowns than there is room for")
            run.p[offset : offset + len(p)] = p
            if native.surroundings:
                around.append((effect.n_memory > 0, (native.surroundings, offset, memory)))
            if native.friction:
                friction.append((effect.order, (native.friction, offset, memory)))
            offset += len(p)
            memory += effect.n_memory
    around.sort(key=lambda item: item[0])  # unknowns follow what the others do around the contact
    friction.sort(key=lambda item: item[0])
    run.counts[:] = len(around), len(friction), memory
    for i, (_, entry) in enumerate(around):
        run.around[i] = entry
    for i, (_, entry) in enumerate(friction):
        run.friction[i] = entry


def _set_temperature(run: Any, effects: Sequence[Effect], temperature: tuple[Array, Array] | None) -> None:
    if temperature is not None:
        time, values = temperature
        run.temperature[:2] = time[0], time[1] - time[0]
        run.temperature[2:] = values
        return
    for effect in effects:
        if "temperature" in effect.reads:
            raise InputError(f"effect {effect.kind!r} reads a temperature, and none is given; leave it out")


def _set_numerics(
    run: Any, mechanism: BeltBox, law: Law, effects: Sequence[Effect], path: CoefficientPath, tolerance: float | None
) -> None:
    m = augmented_model
    c = run.constants
    natural = max(math.sqrt(mechanism.stiffness / mechanism.mass), mechanism.damping / mechanism.mass)
    excited = mechanism.excitation_angular_frequency if mechanism.excitation_amplitude != 0.0 else 0.0
    fastest = max(natural, excited)
    static = law.mu_s * mechanism.normal_force / mechanism.stiffness
    speed = static * math.sqrt(mechanism.stiffness / mechanism.mass) + abs(mechanism.belt_velocity)
    shortest = min((effect.shortest_time(abs(mechanism.belt_velocity)) for effect in effects), default=math.inf)
    in_slip = min((effect.shortest_time(speed) for effect in effects), default=math.inf)
    c[m.SEED], c[m.SAMPLE], c[m.CONTACT] = path.seed, path.sample, path.contact
    c[m.TOLERANCE] = (tolerance or (TOLERANCE_SPRING if c[m.LIMIT] > 0.0 else TOLERANCE)) * static
    c[m.RESTART] = RESTART * math.sqrt(mechanism.mass / mechanism.stiffness)
    c[m.LONGEST_SLIDE] = min(0.25 / fastest, 0.1 * in_slip)
    descriptor = path.descriptor
    drawn = descriptor[0] != 0.0
    c[m.KNOTS] = descriptor[3] if drawn and descriptor[1] == TIME and descriptor[2] == 1.0 else 0.0
    c[m.LONGEST_STICK] = min(0.1 / fastest, 0.05 * shortest)
    if not drawn and excited == 0.0 and mechanism.belt_velocity != 0.0:
        # a stuck box knows no oscillation: nothing happens sooner than the belt loads the spring
        loading = static / abs(mechanism.belt_velocity)
        c[m.LONGEST_STICK] = min(max(0.1 / fastest, LOADED * loading), 0.05 * shortest)
