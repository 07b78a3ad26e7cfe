"""What a class says about its parameters: description and unit from the docstring of a field, rules from its checks."""

from __future__ import annotations

import ast
import builtins
import dataclasses
import functools
import inspect
import math
import re
import textwrap
from collections.abc import Iterator
from typing import Any

from stochfric_mb.c.expressions import Expressions
from stochfric_mb.c.types import DOUBLE, CannotTranslate, number


@dataclasses.dataclass(frozen=True)
class About:
    """What is said about a field."""

    description: str
    """The first line of the docstring under it."""
    unit: str
    """Its unit, "" if it has none."""


@dataclasses.dataclass(frozen=True)
class Rule:
    """A rule that parameters must keep."""

    broken: str
    """C expression, in the names of the fields, that is true where the rule is broken."""
    message: str
    """What to say then."""
    names: frozenset[str]
    """The fields in it."""


@functools.cache
def about_fields(cls: type) -> dict[str, About]:
    """Return what is said of each field of a dataclass: in the docstring under it, otherwise in its metadata."""
    table = {f.name: _of_field(f) for f in dataclasses.fields(cls)}
    for base in reversed(cls.__mro__):
        for statement, after in _pairs(base):
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
                text = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
                if isinstance(text, str) and text:
                    table[statement.target.id] = _about(text)
    return table


def _of_field(field: dataclasses.Field[Any]) -> About:
    """Return what the metadata of an effect's parameter say; a field without any goes by its name."""
    unit = str(field.metadata.get("unit", ""))
    return About(str(field.metadata.get("meaning", field.name)), "" if unit == "-" else unit)


def _about(text: str) -> About:
    line = " ".join(text.partition("\n\n")[0].split()).rstrip(".")
    unit = re.search(r"\[([^\]]*)\]", line)
    return About(line, "" if unit is None or unit[1] == "-" else unit[1].partition(" or ")[0].partition(",")[0])


def _pairs(cls: type) -> Iterator[tuple[ast.stmt, ast.stmt | None]]:
    """Return each statement of a class with the one after it."""
    tree = _class_syntax(cls)
    if tree is not None:
        yield from zip(tree.body, [*tree.body[1:], None], strict=True)


@functools.cache
def _class_syntax(cls: type) -> ast.ClassDef | None:
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(cls))).body[0]
    except (OSError, TypeError):
        return None
    return tree if isinstance(tree, ast.ClassDef) else None


@functools.cache
def rules(cls: type) -> tuple[Rule, ...]:
    """Return the rules of a dataclass's numeric fields: bounds in their metadata, and checks in ``__post_init__``.

    Checks of other kinds (names of choices, lists) concern what is settled before C is made.
    """
    items = [rule for field in dataclasses.fields(cls) for rule in _of_metadata(field)]
    for base in reversed(cls.__mro__):
        for statement, _ in _pairs(base):
            if isinstance(statement, ast.FunctionDef) and statement.name == "__post_init__":
                items += [r for r in map(functools.partial(_rule, base), ast.walk(statement)) if r is not None]
    numeric = {f.name for f in dataclasses.fields(cls) if f.type in (float, "float", "float | None")}
    return tuple(r for r in items if r.names <= numeric)


def _of_metadata(field: dataclasses.Field[Any]) -> Iterator[Rule]:
    about = field.metadata
    if "low" in about:
        less, more = ("<=", ">=") if about["strict"] else ("<", ">")
        yield from _bounds(field.name, [(less, about["low"]), (more, about["high"])], infinite=about["infinite"])


def _bounds(name: str, bounds: list[tuple[str, float]], *, infinite: bool = False) -> Iterator[Rule]:
    finite = f"isnan({name})" if infinite else f"!isfinite({name})"
    yield Rule(finite, f"{name} is not a finite number", frozenset([name]))
    opposite = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
    for sign, bound in bounds:
        if math.isfinite(bound):
            message = f"{name} is out of range: {name} must be {opposite[sign]} {bound:g}"
            yield Rule(f"{name} {sign} {number(float(bound))}", message, frozenset([name]))


_LIMITS = {"low": "<", "above": "<=", "high": ">", "below": ">="}


def _rule(cls: type, node: ast.AST) -> Rule | None:
    """Return the rule that a statement of ``__post_init__`` states, None where it states none about numbers."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "require_number":
        about = node.args[1] if len(node.args) > 1 else None
        if not (isinstance(about, ast.Attribute) and isinstance(about.value, ast.Name) and about.value.id == "self"):
            return None
        limits = {str(k.arg): _constant(cls, k.value) for k in node.keywords if k.arg in _LIMITS}
        bounds = list(_bounds(about.attr, [(_LIMITS[name], bound) for name, bound in limits.items() if bound is not None]))
        broken = " || ".join(f"({b.broken})" for b in bounds)
        return Rule(broken, bounds[-1].message, frozenset([about.attr]))
    if isinstance(node, ast.If) and len(node.body) == 1 and isinstance(node.body[0], ast.Raise):
        return _condition(cls, node, node.body[0])
    return None


def _constant(cls: type, node: ast.expr) -> float | None:
    """Return the number that a bound stands for, None where it is no constant of its module."""
    try:
        value = Expressions(_scope(cls), {}, lambda _function, _args: None).number(node).constant
    except CannotTranslate:
        return None
    return None if value is None else float(value)


def _scope(cls: type) -> dict[str, Any]:
    module = inspect.getmodule(cls)
    return {"__builtins__": builtins, **({} if module is None else vars(module))}


def _condition(cls: type, node: ast.If, raised: ast.Raise) -> Rule | None:
    names: set[str] = set()

    class OwnNames(ast.NodeTransformer):
        def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
            if isinstance(node.value, ast.Name) and node.value.id == "self":
                names.add(node.attr)
                return ast.copy_location(ast.Name(node.attr, ast.Load()), node)
            return self.generic_visit(node)

    test = OwnNames().visit(ast.parse(ast.unparse(node.test), mode="eval").body)
    try:
        broken = Expressions(_scope(cls), dict.fromkeys(names, DOUBLE), lambda _function, _args: None).condition(test)
    except CannotTranslate:
        return None
    return Rule(broken, _message(raised), frozenset(names))


def _message(raised: ast.Raise) -> str:
    """Return the message of an error, with dots for the numbers in it."""
    call = raised.exc
    if not (isinstance(call, ast.Call) and call.args):
        return "a parameter is out of range"
    text = call.args[0]
    if isinstance(text, ast.JoinedStr):
        return "".join(str(v.value) if isinstance(v, ast.Constant) else "..." for v in text.values)
    return str(text.value) if isinstance(text, ast.Constant) else "a parameter is out of range"
