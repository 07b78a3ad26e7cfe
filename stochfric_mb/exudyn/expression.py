"""Arithmetic expressions as data: what a law's source becomes before an engine's own symbols take its place.

Nodes are unique: the same operation on the same arguments is the same object, so that equality is identity. Known
numbers are folded and neutral elements dropped while an expression is built; sums and products are never reordered,
so that values differ from the compiled law's by rounding at most.
"""

from __future__ import annotations

import dataclasses
import math
import operator
import weakref
from collections.abc import Callable, Mapping
from typing import Any

Value = Any
"""A known number (float, int, bool) or an `Expression`."""


@dataclasses.dataclass(frozen=True, eq=False)
class Expression:
    """One node: an operation and its arguments, or a variable and its name."""

    operation: str
    """Name of the operation, "variable" for a variable."""
    arguments: tuple[Any, ...]
    """Arguments: numbers and nodes; the name of a variable."""

    def __repr__(self) -> str:
        if self.operation == "variable":
            return str(self.arguments[0])
        return f"{self.operation}({', '.join(map(repr, self.arguments))})"

    def __bool__(self) -> bool:
        raise TypeError(f"the truth of {self!r} is not known; build it with choose()")


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "pow": operator.pow,
    "neg": operator.neg,
    "sign": lambda x: float((x > 0.0) - (x < 0.0)),
    "abs": abs,
    "min": min,
    "max": max,
    "lt": operator.lt,
    "le": operator.le,
    "gt": operator.gt,
    "ge": operator.ge,
    "eq": operator.eq,
    "ne": operator.ne,
    **{
        name: getattr(math, name)
        for name in (
            "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh",
            "acosh", "atanh", "floor", "ceil",
        )
    },
}  # fmt: skip
"""Operations on numbers; "choose" (condition, if true, if not) is the only other one."""

_nodes: weakref.WeakValueDictionary[tuple[Any, ...], Expression] = weakref.WeakValueDictionary()


def variable(name: str) -> Expression:
    """Return the variable of that name."""
    return _node("variable", (name,))


def known(value: Value) -> bool:
    """Return whether ``value`` is a number and no expression."""
    return not isinstance(value, Expression)


def apply(operation: str, *arguments: Value) -> Value:
    """Return the operation on the arguments: a number if they are known, otherwise a node, simplified."""
    if all(known(a) for a in arguments):
        try:
            return FUNCTIONS[operation](*arguments)
        except (ZeroDivisionError, ValueError, OverflowError):
            return math.nan
    simple = _SIMPLER.get(operation)
    if simple is not None and (result := simple(*arguments)) is not None:
        return result
    return _node(operation, arguments)


def hypot(x: Value, y: Value) -> Value:
    """Return the length of (x, y): abs(x) where y is known to be 0."""
    if _is(y, 0.0):
        return apply("abs", x)
    if _is(x, 0.0):
        return apply("abs", y)
    return apply("sqrt", apply("add", apply("mul", x, x), apply("mul", y, y)))


def choose(condition: Value, yes: Value, no: Value) -> Value:
    """Return ``yes`` where the condition holds, otherwise ``no``."""
    if known(condition):
        return yes if condition else no
    yes, no = _under(condition, yes, True), _under(condition, no, False)
    if yes is no or (known(yes) and known(no) and yes == no):
        return yes
    if yes is True and no is False:
        return condition
    if condition.operation == "gt" and (simple := _clipped(condition, yes, no)) is not None:
        return simple
    if condition.operation == "gt" and _is(no, 0.0) and _vanishes(condition, yes):
        return yes
    return _node("choose", (condition, yes, no))


def evaluate(expression: Value, values: Mapping[str, float]) -> float:
    """Return the number that an expression has where its variables have the given values."""
    if known(expression):
        return float(expression)
    if expression.operation == "variable":
        return float(values[expression.arguments[0]])
    if expression.operation == "choose":
        condition, yes, no = expression.arguments
        return evaluate(yes if evaluate(condition, values) else no, values)
    try:
        return float(FUNCTIONS[expression.operation](*[evaluate(a, values) for a in expression.arguments]))
    except ZeroDivisionError:
        return math.nan


def variables(expression: Value) -> set[str]:
    """Return the names of the variables in an expression."""
    if known(expression):
        return set()
    if expression.operation == "variable":
        return {expression.arguments[0]}
    return set().union(*map(variables, expression.arguments))


def size(expression: Value) -> int:
    """Return the number of nodes and numbers in an expression, written out as a tree."""
    if known(expression) or expression.operation == "variable":
        return 1
    return 1 + sum(map(size, expression.arguments))


def _node(operation: str, arguments: tuple[Any, ...]) -> Expression:
    key = (operation, *((type(a), a) if known(a) else a for a in arguments))
    return _nodes.setdefault(key, Expression(operation, arguments))


def _is(value: Value, number: float) -> bool:
    return known(value) and value == number


def _simple_add(x: Value, y: Value) -> Value:
    if _is(x, 0.0):
        return y
    return x if _is(y, 0.0) else None


def _simple_sub(x: Value, y: Value) -> Value:
    if _is(x, 0.0):
        return apply("neg", y)
    return x if _is(y, 0.0) else None


def _simple_mul(x: Value, y: Value) -> Value:
    if _is(x, 0.0) or _is(y, 0.0):
        return 0.0
    if _is(x, 1.0):
        return y
    return x if _is(y, 1.0) else None


def _simple_div(x: Value, y: Value) -> Value:
    if _is(x, 0.0):
        return 0.0
    if _is(y, 1.0):
        return x
    return apply("sign", x) if isinstance(y, Expression) and y.operation == "abs" and y.arguments[0] is x else None


def _simple_abs(x: Expression) -> Value:
    return x if x.operation in ("abs", "sqrt") else None


_SIMPLER: dict[str, Callable[..., Value]] = {
    "add": _simple_add,
    "sub": _simple_sub,
    "mul": _simple_mul,
    "div": _simple_div,
    "abs": _simple_abs,
}


def _under(condition: Expression, value: Value, holds: bool) -> Value:
    """Return ``value`` simplified where it asks for the same condition again."""
    if isinstance(value, Expression) and value.operation == "choose" and value.arguments[0] is condition:
        return value.arguments[1 if holds else 2]
    return value


def _clipped(condition: Expression, yes: Value, no: Value) -> Expression | None:
    """Return min(max(x, -limit), limit) for "x (limit/abs(x)) where abs(x) > limit, otherwise x"."""
    if not isinstance(no, Expression):
        return None
    size_of, limit = condition.arguments
    if size_of is not apply("abs", no) or yes is not apply("mul", no, apply("div", limit, size_of)):
        return None
    return apply("min", apply("max", no, apply("neg", limit)), limit)


def _vanishes(condition: Expression, yes: Value) -> bool:
    """Return whether ``yes`` is y sign(x) and the condition abs(x) > 0, so that it is 0 where the condition fails."""
    if not isinstance(yes, Expression) or yes.operation != "mul" or not _is(condition.arguments[1], 0.0):
        return False
    sign = yes.arguments[1]
    return isinstance(sign, Expression) and sign.operation == "sign" and condition.arguments[0] is apply("abs", *sign.arguments)
