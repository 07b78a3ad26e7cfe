"""Reference motion under a law: closed form for Coulomb, event-located integration for every other law."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb import __version__
from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.errors import InputError, SimulationError, require_name, require_number
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import native_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference import adaptive, coulomb
from stochfric_mb.reference.problem import N_EVENTS, N_STEPS, NOW, STATUS, Problem, new_run
from stochfric_mb.trajectory import Array, Trajectory

METHODS = ("auto", "closed_form", "adaptive")
CHUNK = 1000
"""Outputs between two calls of ``progress``."""


def solve(
    mechanism: BeltBox,
    law: Law,
    path: CoefficientPath | None,
    times: npt.ArrayLike,
    *,
    rtol: float = 1.0e-12,
    initial_state: Sequence[float] | None = None,
    law_state: Sequence[float] | None = None,
    start_time: float = 0.0,
    method: str = "auto",
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the trajectory at ``times``, with every stick and break-away located.

    A box carried by the belt breaks away when spring and damper hold mu_s N:

    >>> from stochfric_mb import BeltBox, Coulomb
    >>> box = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
    >>> trajectory = solve(box, Coulomb(mu_s=0.8, mu_k=0.46), None, [2.0], initial_state=(0.0, 2.5e-3))
    >>> break_away = (0.8 * 13.0 - 0.768 * 2.5e-3) / (3956.0 * 2.5e-3)
    >>> abs(float(trajectory.events[0, 0]) - break_away) < 1e-12
    True

    Relative displacement is u = v_b t - x, and a path along the belt runs along u. A contact that starts stuck has not
    *entered* stick: the first pair of a per_event path lasts until the first re-stick.

    Args:
        mechanism: what moves.
        law: its friction law.
        path: the coefficients; None: constant at the law's means.
        times: output times [s], shape (n,), increasing, not before ``start_time``; each is stepped onto.
        rtol: local error of a step over the scales of the motion [-], 1e-14 to 1e-3; not used by the closed form.
        initial_state: position [m] and velocity [m/s] at ``start_time``; the mechanism's if not given.
        law_state: the law's state at ``start_time``, as its ``commit`` returns it and as the attribute
            ``final_law_state`` of a trajectory holds it; from the law's ``init`` if not given.
        start_time: where the integration starts [s].
        method: "closed_form" (coulomb whose coefficients are constant or run along time), "adaptive" (any law), or "auto": the
            first where it can be had.
        progress: called with the simulated time [s] now and then.

    Raises:
        InputError: times, tolerance, state or method that cannot be used.
        SimulationError: the integration broke down; says where.
    """
    outputs = _output_times(times, start_time)
    path = CoefficientPath(None, law) if path is None else path
    state = _initial_state(mechanism, initial_state)
    require_name("method", method, METHODS)
    require_number("rtol", rtol, low=1.0e-14, high=1.0e-3)
    obstacle = coulomb.obstacle(law, path) or ("law_state is given" if law_state is not None else "")
    if method == "closed_form" and obstacle:
        raise InputError(f"method = 'closed_form' cannot be used: {obstacle}; use method='adaptive'")
    if method == "adaptive" or obstacle:
        problem = _problem(mechanism, law, path, rtol, state)
        run = _start(problem, law, state, law_state, start_time)
        before = time.perf_counter()
        rows, events = _march(problem, run, outputs, progress)
        seconds, n_steps = time.perf_counter() - before, int(run.clock[N_STEPS])
        final = run.state[: max(len(law.state_names), 1)].tolist()
        hook = "event-located DOP853"
    else:
        before = time.perf_counter()
        rows, events, final, n_steps = coulomb.integrate(mechanism, path, state, start_time, outputs)
        seconds = time.perf_counter() - before
        hook = "closed form between events"
    attributes: dict[str, Any] = {
        "engine": "reference",
        "version": __version__,
        "hook": hook,
        "dt": 0.0,
        "seed": path.seed,
        "sample": path.sample,
        "law": law.kind,
        "notes": ["the reference has no fixed step: dt is stored as 0"],
        "seconds_per_step": seconds / max(n_steps, 1),
        "n_steps": n_steps,
        "final_law_state": final,
    }
    return _trajectory(mechanism, outputs, rows, events, attributes)


def _output_times(times: npt.ArrayLike, start_time: float) -> Array:
    outputs = np.atleast_1d(np.asarray(times, dtype=np.float64))
    require_number("start_time", start_time, unit="s")
    if outputs.ndim != 1 or len(outputs) == 0 or not np.all(np.isfinite(outputs)):
        raise InputError(f"times = {times!r} are not finite numbers in one row; give output times [s]")
    if outputs[0] < start_time:
        raise InputError(f"times[0] = {outputs[0]:g} s is before start_time = {start_time:g} s; start earlier")
    if np.any(np.diff(outputs) <= 0.0):
        i = int(np.argmax(np.diff(outputs) <= 0.0)) + 1
        raise InputError(f"times[{i}] = {outputs[i]:g} s is not after {outputs[i - 1]:g} s; sort them and drop repeats")
    return outputs


def _initial_state(mechanism: BeltBox, given: Sequence[float] | None) -> tuple[float, float]:
    if given is None:
        return mechanism.initial_position, mechanism.initial_velocity
    if len(given) != 2:
        raise InputError(f"initial_state has {len(given)} entries; give position [m] and velocity [m/s]")
    return require_number("initial position", given[0], unit="m"), require_number("initial velocity", given[1], unit="m/s")


def _problem(mechanism: BeltBox, law: Law, path: CoefficientPath, rtol: float, state: tuple[float, float]) -> Problem:
    """Return the compiled solver's view of the problem."""
    native = native_law(law.kind)
    natural, fastest = math.sqrt(mechanism.stiffness / mechanism.mass), mechanism.fastest
    static = law.mu_s * mechanism.normal_force / mechanism.stiffness
    length = static + abs(mechanism.excitation_amplitude) + abs(state[0])
    speed = natural * length + abs(mechanism.belt_velocity) + abs(state[1])
    return Problem(
        init=native.init,
        force=native.force,
        commit=native.commit,
        guards=native.guards,
        flow=native.flow,
        parameters=law.parameters(),
        moded=bool(law.state_names) and law.state_names[0] == "mode",
        holding=law.needs_holding_force,
        bristle=law.state_names.index("zx") if law.has_flow else -1,
        stick_speed=law.stick_speed,
        box=mechanism.numbers(),
        descriptor=path.descriptor,
        seed=path.seed,
        sample=path.sample,
        contact=path.contact,
        tolerance=rtol,
        scale=np.array([length, speed, 0.01 * length]),
        longest=0.2 / fastest,
        restart=1.0e-4 / fastest,
        shortest=1.0e-11 / fastest,
    )


def _start(
    problem: Problem,
    law: Law,
    state: tuple[float, float],
    law_state: Sequence[float] | None,
    start_time: float,
) -> Any:
    run = new_run()
    run.y[:2] = state
    if law_state is not None:
        n = max(len(law.state_names), 1)
        if len(law_state) != n:
            raise InputError(f"law_state has {len(law_state)} entries; {law.kind} has {n}: {', '.join(law.state_names)}")
        run.state[:n] = law_state
    adaptive.start(problem, run, float(start_time), law_state is not None)
    return run


def _march(problem: Problem, run: Any, outputs: Array, progress: Callable[[float], None] | None) -> tuple[Array, Array]:
    """Return the rows and the events of the whole run, in chunks so that it can report and be interrupted."""
    rows = np.empty((len(outputs), 6))
    events: list[Array] = []
    for first in range(0, len(outputs), CHUNK):
        part = slice(first, first + CHUNK)
        log = adaptive.march(problem, run, outputs[part], rows[part])
        events.append(log[: int(run.clock[N_EVENTS])])
        if run.clock[STATUS] != adaptive.OK:
            raise SimulationError(_breakdown(run))
        if progress is not None:
            progress(float(run.clock[NOW]))
    return rows, np.concatenate(events)


def _breakdown(run: Any) -> str:
    where = f"after t = {run.clock[NOW]:.9g} s, at x = {run.y[0]:.6g} m and velocity {run.y[1]:.6g} m/s"
    if run.clock[STATUS] == adaptive.NOT_FINITE:
        return f"the solution is not finite {where}; the law returned no finite force there: check its parameters"
    return (
        f"more than {adaptive.MAX_STEPS_PER_LEG} steps between two outputs {where}; the law is too stiff for an "
        "explicit formula, or switches without end: soften it (larger v_s or e_lim) or raise rtol"
    )


def _trajectory(mechanism: BeltBox, outputs: Array, rows: Array, events: Array, attributes: dict[str, Any]) -> Trajectory:
    return Trajectory(
        time=outputs,
        position=rows[:, 0].copy(),
        velocity=rows[:, 1].copy(),
        friction_force=rows[:, 2].copy(),
        normal_force=np.full(len(outputs), mechanism.normal_force),
        mu_s=rows[:, 3].copy(),
        mu_k=rows[:, 4].copy(),
        stick=rows[:, 5].copy(),
        attributes=attributes,
        events=events,
    )
