"""A compiled function's own Python source as an expression, so that no law is written twice.

`trace` reads the source of a straight-line function and runs it on expressions: calls of other functions of the
package are followed, a branch on known numbers is decided at once, a branch on unknown ones becomes a choice.
"""

from __future__ import annotations

import ast
import builtins
import functools
import inspect
import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from types import FunctionType, ModuleType
from typing import Any

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn.expression import FUNCTIONS, Value, apply, choose, hypot, known
from stochfric_mb.laws.plane import length

_BINARY = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.Pow: "pow"}
_COMPARE = {ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt", ast.GtE: "ge", ast.Eq: "eq", ast.NotEq: "ne"}
_NOTHING = object()
"""What a block gives that does not return."""


def trace(function: Any, *arguments: Any) -> Any:
    """Return what ``function`` returns for the given arguments: numbers, expressions or tuples of them.

    Args:
        function: a Python function, or one compiled by numba.
        arguments: numbers, expressions, or sequences of them.

    Raises:
        InputError: the source cannot be read, or does more than arithmetic, branches, tuples and calls.
    """
    python = getattr(function, "py_func", function)
    tree = _source(python)
    names = [a.arg for a in tree.args.args]
    if len(names) != len(arguments):
        raise InputError(f"{python.__name__} takes {len(names)} arguments, not {len(arguments)}; pass one for each")
    result = _Frame(python).run(tree.body, dict(zip(names, arguments, strict=True)))
    if result is _NOTHING:
        raise InputError(f"{python.__name__} can end without a return; let every branch return a value")
    return result


@functools.cache
def _source(python: Callable[..., Any]) -> ast.FunctionDef:
    try:
        text = textwrap.dedent(inspect.getsource(python))
    except (OSError, TypeError):
        raise InputError(
            f"the source of {python!r} cannot be read, so no engine's symbols can be made of it; define the law in a file"
        ) from None
    tree = ast.parse(text).body[0]
    if not isinstance(tree, ast.FunctionDef):
        raise InputError(f"{python!r} is not defined by def; define it so in a file")
    return tree


class _Frame:
    """One call in progress: the function's globals and the handlers of its statements and expressions."""

    def __init__(self, python: FunctionType) -> None:
        self.python = python
        self.globals: Mapping[str, Any] = python.__globals__

    def run(self, statements: Sequence[ast.stmt], names: dict[str, Any]) -> Any:
        """Run statements on ``names`` and return the returned value, or `_NOTHING`."""
        for i, statement in enumerate(statements):
            match statement:
                case ast.Return(value=value):
                    return None if value is None else self.value(value, names)
                case ast.If():
                    rest = statements[i + 1 :]
                    condition = self.value(statement.test, names)
                    if known(condition):
                        return self.run([*(statement.body if condition else statement.orelse), *rest], names)
                    if _returns(statement):
                        yes = self.run([*statement.body, *rest], dict(names))
                        no = self.run([*statement.orelse, *rest], dict(names))
                        return self.merge(condition, yes, no, statement)
                    self.branch(condition, statement, names)
                case ast.Assign(targets=[target], value=value):
                    self.assign(target, self.value(value, names), names)
                case ast.AnnAssign(target=target, value=ast.expr() as value):
                    self.assign(target, self.value(value, names), names)
                case ast.AugAssign(target=ast.Name(id=name), op=op, value=value) if type(op) in _BINARY:
                    names[name] = apply(_BINARY[type(op)], names[name], self.value(value, names))
                case ast.Expr(value=ast.Constant()) | ast.Pass():
                    pass
                case _:
                    raise self.unsupported(statement)
        return _NOTHING

    def branch(self, condition: Value, statement: ast.If, names: dict[str, Any]) -> None:
        """Run both sides of an if that returns nowhere, and make a choice of each name they set."""
        yes, no = dict(names), dict(names)
        self.run(statement.body, yes)
        self.run(statement.orelse, no)
        for name in yes.keys() & no.keys():
            same = yes[name] is no[name]
            names[name] = yes[name] if same else self.merge(condition, yes[name], no[name], statement)

    def merge(self, condition: Value, yes: Any, no: Any, node: ast.stmt) -> Any:
        """Return the choice of two values, or of two tuples entry by entry."""
        if isinstance(yes, tuple) and isinstance(no, tuple) and len(yes) == len(no):
            return tuple(choose(condition, a, b) for a, b in zip(yes, no, strict=True))
        if any(isinstance(v, tuple) or v is _NOTHING or v is None for v in (yes, no)):
            raise self.unsupported(node)
        return choose(condition, yes, no)

    def assign(self, target: ast.expr, value: Any, names: dict[str, Any]) -> None:
        """Bind a name, or the names of a tuple."""
        if isinstance(target, ast.Name):
            names[target.id] = value
        elif isinstance(target, ast.Tuple) and isinstance(value, tuple) and len(target.elts) == len(value):
            for name, entry in zip(target.elts, value, strict=True):
                self.assign(name, entry, names)
        else:
            raise self.unsupported(target)

    def value(self, node: ast.expr, names: Mapping[str, Any]) -> Any:
        """Return the value of an expression of the source."""
        handler = getattr(self, f"of_{type(node).__name__.lower()}", None)
        result = _NOTHING if handler is None else handler(node, names)
        if result is _NOTHING:
            raise self.unsupported(node)
        return result

    def of_constant(self, node: ast.Constant, names: Mapping[str, Any]) -> Any:
        """Return a number of the source."""
        return node.value if isinstance(node.value, bool | int | float) else _NOTHING

    def of_name(self, node: ast.Name, names: Mapping[str, Any]) -> Any:
        """Return what a name stands for: a local, a global of the function's module, or a builtin."""
        closure = inspect.getclosurevars(self.python).nonlocals if self.python.__closure__ else {}
        for scope in (names, closure, self.globals, vars(builtins)):
            if node.id in scope:
                return scope[node.id]
        return _NOTHING

    def of_attribute(self, node: ast.Attribute, names: Mapping[str, Any]) -> Any:
        """Return a name of a module, such as math.pi."""
        module = self.value(node.value, names)
        return getattr(module, node.attr, _NOTHING) if isinstance(module, ModuleType) else _NOTHING

    def of_tuple(self, node: ast.Tuple, names: Mapping[str, Any]) -> Any:
        """Return a tuple of values."""
        return tuple(self.value(e, names) for e in node.elts)

    def of_subscript(self, node: ast.Subscript, names: Mapping[str, Any]) -> Any:
        """Return an entry of a sequence at a known place."""
        sequence, place = self.value(node.value, names), self.value(node.slice, names)
        return sequence[place] if isinstance(place, int) and hasattr(sequence, "__getitem__") else _NOTHING

    def of_binop(self, node: ast.BinOp, names: Mapping[str, Any]) -> Any:
        """Return a sum, difference, product, ..."""
        if type(node.op) not in _BINARY:
            return _NOTHING
        return apply(_BINARY[type(node.op)], self.value(node.left, names), self.value(node.right, names))

    def of_unaryop(self, node: ast.UnaryOp, names: Mapping[str, Any]) -> Any:
        """Return a negative or a negation."""
        operand = self.value(node.operand, names)
        if isinstance(node.op, ast.USub):
            return apply("neg", operand)
        return choose(operand, False, True) if isinstance(node.op, ast.Not) else _NOTHING

    def of_boolop(self, node: ast.BoolOp, names: Mapping[str, Any]) -> Any:
        """Return the value of a chain of ``and`` or of ``or``."""
        return self.chain(isinstance(node.op, ast.And), node.values, names)

    def of_compare(self, node: ast.Compare, names: Mapping[str, Any]) -> Any:
        """Return a comparison, or a chain of them."""
        if not all(type(o) in _COMPARE for o in node.ops):
            return _NOTHING
        values = [self.value(e, names) for e in (node.left, *node.comparators)]
        pairs = [apply(_COMPARE[type(o)], a, b) for o, a, b in zip(node.ops, values, values[1:], strict=False)]
        return functools.reduce(lambda a, b: choose(a, b, False), pairs)

    def of_ifexp(self, node: ast.IfExp, names: Mapping[str, Any]) -> Any:
        """Return ``a if condition else b``."""
        condition = self.value(node.test, names)
        if known(condition):
            return self.value(node.body if condition else node.orelse, names)
        return choose(condition, self.value(node.body, names), self.value(node.orelse, names))

    def of_call(self, node: ast.Call, names: Mapping[str, Any]) -> Any:
        """Return the value of a call: of a known operation, or of a function whose source is traced."""
        if node.keywords:
            return _NOTHING
        function, arguments = self.value(node.func, names), [self.value(a, names) for a in node.args]
        name = getattr(function, "__name__", "")
        if function in (math.hypot, length) and len(arguments) == 2:
            return hypot(*arguments)
        if function in (min, max):
            return functools.reduce(functools.partial(apply, name), arguments)
        if function is abs or (getattr(math, name, None) is function and name in FUNCTIONS):
            return apply(name, *arguments)
        if hasattr(function, "py_func") or isinstance(function, FunctionType):
            return trace(function, *arguments)
        return _NOTHING

    def chain(self, both: bool, parts: Sequence[ast.expr], names: Mapping[str, Any]) -> Value:
        """Return the value of a chain of ``and`` or of ``or``; later parts are read only where they matter."""
        first, rest = self.value(parts[0], names), parts[1:]
        if not rest or (known(first) and bool(first) != both):
            return first
        later = self.chain(both, rest, names)
        return choose(first, later, False) if both else choose(first, True, later)

    def unsupported(self, node: ast.AST) -> InputError:
        """Return the error for source that is more than arithmetic, branches, tuples and calls."""
        text = ast.unparse(node).splitlines()[0]  # type: ignore[arg-type]
        return InputError(
            f"{self.python.__module__}.{self.python.__name__}: {text!r} cannot be made an expression; a law for this engine "
            "consists of arithmetic, math functions, branches, tuples with fixed indices and calls of such functions"
        )


def _returns(statement: ast.If) -> bool:
    return any(isinstance(node, ast.Return) for node in ast.walk(statement))
