"""A translation: functions of the package, and all that they call, as one piece of C99.

A function is translated once for each combination of argument types that it is called with, as numba compiles it. What
cannot be translated is refused by name; nothing is left out.
"""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Sequence
from typing import Any

from stochfric_mb.c.expressions import Expressions, c_name
from stochfric_mb.c.intrinsics import DUALS, PRELUDE
from stochfric_mb.c.statements import Body
from stochfric_mb.c.types import DUAL, VOID, Array, CannotTranslate, Scalar, Tuple, Type, Value, as_c, unified
from stochfric_mb.scalar_function import ScalarFunction, UntranslatableError, plain_function, read, where

ROUNDS = 8
"""Most passes over a body until the types of its local names stand."""


@dataclasses.dataclass(frozen=True)
class Function:
    """A translated function."""

    name: str
    """Its C name."""
    returns: Type
    """What it returns."""
    arguments: tuple[Type, ...]
    """What it takes."""
    text: str
    """Its C source."""
    calls: tuple[str, ...]
    """C names of the translated functions that it calls."""


class Translation:
    """Functions and what they call, each once; a piece of C that grows."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._functions: dict[tuple[Any, tuple[Type, ...]], Function | None] = {}
        self._by_name: dict[str, Function] = {}
        self._roots: list[str] = []

    def add(self, function: Callable[..., Any], arguments: Sequence[Type]) -> Function:
        """Return the translation of a function for the given types of its arguments.

        Raises:
            UntranslatableError: it, or something that it calls, has none; says which and why.
        """
        made = self._function(function, tuple(arguments))
        self._roots.append(made.name)
        return made

    @property
    def text(self) -> str:
        """The C source: prelude, structures, then every function that is reached, callees first."""
        used: list[Function] = []
        for name in dict.fromkeys(self._roots):
            self._collect(name, used)
        tuples = {f.returns for f in used if isinstance(f.returns, Tuple)}
        structures = "\n".join(sorted(t.definition for t in tuples))
        duals = DUALS if any(DUAL in _scalars(f) for f in used) else ""
        return "\n".join([PRELUDE, duals, structures, _DISPATCHERS, *(f.text for f in used)])

    def _collect(self, name: str, used: list[Function]) -> None:
        function = self._by_name[name]
        if function in used:
            return
        for callee in function.calls:
            self._collect(callee, used)
        used.append(function)

    def _function(self, function: Any, arguments: tuple[Type, ...]) -> Function:
        plain = plain_function(function)
        key = (plain, arguments)
        if key not in self._functions:
            self._functions[key] = None
            self._functions[key] = self._translated(plain, arguments)
        made = self._functions[key]
        if made is None:
            raise UntranslatableError(f"{where(plain)} calls itself, which C made here cannot; use a loop")
        return made

    def _translated(self, plain: Any, arguments: tuple[Type, ...]) -> Function:
        source = read(plain)
        variables = source.types_of(arguments)
        calls: list[str] = []

        def call(callee: Any, args: list[Value]) -> Value | None:
            if not _is_ours(callee):
                return None
            made = self._function(callee, tuple(a.type for a in args))
            calls.append(made.name)
            code = ", ".join(as_c(a, t) for a, t in zip(args, made.arguments, strict=True))
            return Value(f"{made.name}({code})", made.returns)

        expressions = Expressions(source.scope, variables, call)
        body, returned = Body(expressions), None
        for _ in range(ROUNDS):
            before, before_returned = dict(variables), returned
            calls.clear()
            body = Body(expressions)
            body.returned = returned
            try:
                body.block(source.tree.body)
            except CannotTranslate as problem:
                raise UntranslatableError(
                    f"{source.where}, line {source.line(problem.line)}: {problem}; C is made from "
                    "plain scalar Python: numbers, arrays of floats, if, for over range, while, math"
                ) from None
            returned = body.returned if before_returned is None else unified(before_returned, body.returned or before_returned)
            if variables == before and returned == before_returned:
                break
        result = returned or VOID
        name = self._free_name(plain)
        made = Function(name, result, arguments, _text(name, source, variables, body, result), tuple(dict.fromkeys(calls)))
        self._by_name[name] = made
        return made

    def _free_name(self, plain: Any) -> str:
        module = plain.__module__.rpartition(".")[2].strip("_")
        base = f"{module}_{plain.__name__.strip('_')}"
        name, n = base, 2
        while name in self._by_name:
            name, n = f"{base}_{n}", n + 1
        return name


_DISPATCHERS = """
static void call_law(int64_t address, double t, double ux, double uy, double vx, double vy, double normal_force, double mu_s,
                     double mu_k, double effective_mass, double hx, double hy, int64_t state, int64_t p, int64_t out);
static void call_effect(int64_t address, int64_t world, int64_t memory, int64_t rates, int64_t p);
"""


def _scalars(function: Function) -> set[Type]:
    """Return the types that a function takes and returns, those within tuples included."""
    names = {function.returns, *function.arguments}
    return names | {item for kind in names if isinstance(kind, Tuple) for item in kind.items}


def _is_ours(callee: Any) -> bool:
    return inspect.isfunction(plain_function(callee))


def _text(name: str, source: ScalarFunction, variables: dict[str, Any], body: Body, result: Type) -> str:
    """Return the C text of a function: comment, head, local names, body."""
    names = source.arguments
    head = ", ".join(_declared(variables[n], c_name(n)) for n in names) or "void"
    lines = [f"/* {source.where}: {_first_line(source.function)} */", f"static {result.c} {name}({head}) {{"]
    for variable, kind in variables.items():
        if variable in names:
            continue
        zero = " = {0}" if isinstance(kind, Tuple) or kind == DUAL else " = 0"
        lines.append(f"    {_declared(kind, c_name(variable))}{zero};")
    lines += [f"    {kind.item.c} {room}[{kind.size}];" for room, kind in body.arrays.items()]
    unused = [f"    (void){c_name(n)};" for n in names if not _mentions(body.lines, c_name(n))]
    return "\n".join([*lines, *unused, *body.lines, "}", ""])


def _declared(kind: Scalar | Array | Tuple, name: str) -> str:
    return f"{kind.c}{name}" if isinstance(kind, Array) else f"{kind.c} {name}"


def _mentions(lines: list[str], name: str) -> bool:
    import re

    return any(re.search(rf"\b{name}\b", line) for line in lines)


def _first_line(plain: Any) -> str:
    return (inspect.getdoc(plain) or "").partition("\n")[0].replace("*/", "* /")
