"""A law's friction force as an Exudyn symbolic expression, derived from the law's own source."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping
from typing import Any

import exudyn

from stochfric_mb.coefficients import Process
from stochfric_mb.coefficients.processes import EVENT, POSITION
from stochfric_mb.exudyn.expression import Expression, Value, apply, choose, known, variable, variables
from stochfric_mb.exudyn.trace import trace
from stochfric_mb.laws import Law

symbolic: Any = exudyn.symbolic  # pyright: ignore[reportAttributeAccessIssue]  # a compiled submodule
"""Exudyn's symbols."""
TIME, DISPLACEMENT, VELOCITY, DISPLACEMENT_2, VELOCITY_2 = "t", "u", "v", "u_2", "v_2"
"""Variables of the force: time [s], relative displacement [m] and velocity [m/s], counter-surface minus body."""
SEGMENT = ("knot", "start_s", "start_k", "before_s", "before_k", "after_s", "after_k", "end_s", "end_k")
"""Variables of a path of coefficients around one of its knots: its place, the pairs before, and slopes on each side."""
PAIR = ("mu_s", "mu_k")
NORMAL_LINE = ("normal_now", "normal_rate")
"""Variables of a normal force that changes, normal_now + normal_rate t, never negative."""
MASS = "effective_mass"
"""Variable of a mass that the contact feels which is taken from the system when it starts."""
NORMAL_FORCE = "normal_force"
"""Variable that stands for the normal force in the force in a plane."""


@dataclasses.dataclass(frozen=True)
class ForceExpression:
    """A law's force as expressions."""

    force: Value
    """The friction force on the body [N], of t, u, v, the state's entries and the coefficients' variables."""
    force_2: Value
    """The same along the second direction of the tangent plane; 0 for sliding along a line."""
    names: tuple[str, ...]
    """The variables that the engine must be given after each step, in the order of `live_names`."""


def state_names(law: Law) -> tuple[str, ...]:
    """Return a name for each entry of a law's state."""
    return tuple(f"state_{i}" for i in range(max(len(law.state_names), 1)))


def live_names(law: Law) -> tuple[str, ...]:
    """Return the names of all numbers that can change from step to step: state, coefficients, normal force, segments."""
    return (*state_names(law), *PAIR, *NORMAL_LINE, *SEGMENT, MASS)


@functools.lru_cache(maxsize=64)
def force_expression(
    law: Law, process: Process | None, normal_force: float | None, effective_mass: float | None
) -> ForceExpression:
    """Return the friction force [N] of one-dimensional sliding as an expression.

    Args:
        law: a law that does without the holding force.
        process: how the coefficients vary, None if they do not.
        normal_force: normal force [N], None for one that changes: then it is a line in time given after each step.
        effective_mass: mass that the contact feels [kg], None for one that is taken from the system when it starts.

    Raises:
        InputError: the law's source does more than an expression can hold.
    """
    mass = variable(MASS) if effective_mass is None else effective_mass
    zero = zero_entries(law, 1.0 if normal_force is None else normal_force, 1.0 if effective_mass is None else effective_mass)
    state = [0.0 if i in zero else variable(name) for i, name in enumerate(state_names(law))]
    n = normal_line() if normal_force is None else normal_force
    force, _ = _call(law, "force", n, mass, coefficients(law, process), state)
    return ForceExpression(force, 0.0, _names(law, variables(force)))


@functools.lru_cache(maxsize=64)
def plane_force_expression(law: Law, process: Process | None, effective_mass: float | None) -> ForceExpression:
    """Return the friction force [N] in a plane, of both displacements and velocities and of the variable `NORMAL_FORCE`.

    Raises:
        InputError: as `force_expression`.
    """
    state = [variable(name) for name in state_names(law)]
    n, second = variable(NORMAL_FORCE), (variable(DISPLACEMENT_2), variable(VELOCITY_2))
    mass = variable(MASS) if effective_mass is None else effective_mass
    pair = _call(law, "force", n, mass, coefficients(law, process), state, second)
    return ForceExpression(pair[0], pair[1], _names(law, variables(pair[0]) | variables(pair[1])))


def normal_line() -> Value:
    """Return a normal force that changes along a line in time after each step and is never negative."""
    now, rate = map(variable, NORMAL_LINE)
    return apply("max", apply("add", now, apply("mul", rate, variable(TIME))), 0.0)


def _names(law: Law, used: set[str]) -> tuple[str, ...]:
    return tuple(n for n in live_names(law) if n in used)


def zero_entries(law: Law, normal_force: float, effective_mass: float) -> frozenset[int]:
    """Return the entries of the state that stay zero in one-dimensional sliding: ``commit`` keeps them if it finds them so."""
    pair = tuple(variable(name) for name in PAIR)
    zero = _zeros(_call(law, "init", normal_force, effective_mass, pair))
    while True:
        state = [0.0 if i in zero else variable(name) for i, name in enumerate(state_names(law))]
        kept = zero & _zeros(_call(law, "commit", normal_force, effective_mass, pair, state))
        if kept == zero:
            return zero
        zero = kept


def coefficients(law: Law, process: Process | None) -> tuple[Value, Value]:
    """Return mu_s and mu_k as the force needs them: numbers, a pair per stick phase, or lines around the nearest knot."""
    if process is None:
        return law.mu_s, law.mu_k
    if process.clock == EVENT:
        return variable("mu_s"), variable("mu_k")
    clock = variable(DISPLACEMENT if process.clock == POSITION else TIME)
    knot = variable("knot")
    way = apply("sub", clock, knot)
    before = apply("lt", clock, knot)

    def line(of: str) -> Value:
        slope = choose(before, variable(f"before_{of}"), variable(f"after_{of}"))
        if process.linear:
            return apply("add", variable(f"end_{of}"), apply("mul", way, slope))
        return choose(before, variable(f"start_{of}"), variable(f"end_{of}"))

    return line("s"), line("k")


def lower(expression: Value, values: Mapping[str, Any]) -> Any:
    """Return the expression in Exudyn's symbols.

    Args:
        expression: what to write.
        values: symbol of each variable.
    """
    memory: dict[Expression, Any] = {}

    def write(e: Value) -> Any:
        if known(e):
            return symbolic.Real(float(e))
        if e.operation == "variable":
            return values[e.arguments[0]]
        if e not in memory:
            memory[e] = _OPERATIONS[e.operation](*map(write, e.arguments))
        return memory[e]

    return write(expression)


def _call(
    law: Law, name: str, normal_force: Value, effective_mass: Value, pair: Any, state: Any = None, second: Any = (0.0, 0.0)
) -> Any:
    function = getattr(law.functions(), name)
    u, v = variable(DISPLACEMENT), variable(VELOCITY)
    before = (variable(TIME), u, second[0], v, second[1], normal_force)
    after = (*pair, effective_mass, 0.0, 0.0, law.parameters().tolist())
    return trace(function, *before, *after) if state is None else trace(function, *before, state, *after)


def _zeros(state: tuple[Value, ...]) -> frozenset[int]:
    return frozenset(i for i, entry in enumerate(state) if i > 0 and known(entry) and entry == 0.0)


_OPERATIONS: dict[str, Callable[..., Any]] = {
    "add": lambda x, y: x + y,
    "sub": lambda x, y: x - y,
    "mul": lambda x, y: x * y,
    "div": lambda x, y: x / y,
    "neg": lambda x: -x,
    "lt": lambda x, y: x < y,
    "le": lambda x, y: x <= y,
    "gt": lambda x, y: x > y,
    "ge": lambda x, y: x >= y,
    "eq": lambda x, y: x == y,
    "ne": lambda x, y: x != y,
    "choose": symbolic.IfThenElse,
    **{
        name: getattr(symbolic, name)
        for name in (
            "pow", "abs", "sign", "min", "max", "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan",
            "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "floor", "ceil",
        )
    },
}  # fmt: skip
