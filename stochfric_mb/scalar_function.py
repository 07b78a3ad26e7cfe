"""A scalar Python function as translators into C and Warp read it: its syntax, the names in its reach, where it stands."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import textwrap
from typing import Any

from stochfric_mb.errors import InputError

ARITHMETIC: dict[type[ast.AST], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*"}
"""Operators on numbers that C, Warp and Python write alike; division and powers are not among them."""
BITS: dict[type[ast.AST], str] = {ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^"}
"""Operators on whole numbers."""
COMPARISONS: dict[type[ast.AST], str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
}  # fmt: skip
"""Comparisons."""


class UntranslatableError(InputError):
    """A function that has no translation."""


@dataclasses.dataclass(frozen=True)
class ScalarFunction:
    """A function of numbers, tuples and arrays, read from its source."""

    function: Any
    """The Python function."""
    tree: ast.FunctionDef
    """Its syntax; line 1 is where it begins."""

    @property
    def arguments(self) -> list[str]:
        """The names of its arguments."""
        return [a.arg for a in self.tree.args.args]

    @property
    def scope(self) -> dict[str, Any]:
        """The names that it finds outside of itself, and their values."""
        return {**self.function.__globals__, **inspect.getclosurevars(self.function).nonlocals}

    @property
    def where(self) -> str:
        """What it is called in messages."""
        return where(self.function)

    def line(self, line: int) -> int:
        """Return the line of its file that a line of its syntax is."""
        return self.function.__code__.co_firstlineno + line - 1

    def types_of(self, given: tuple[Any, ...]) -> dict[str, Any]:
        """Return the types of its arguments by name.

        Raises:
            UntranslatableError: it takes more arguments, or less.
        """
        if len(self.arguments) != len(given):
            raise UntranslatableError(f"{self.where} has {len(self.arguments)} arguments, but {len(given)} are given")
        return dict(zip(self.arguments, given, strict=True))


def plain_function(function: Any) -> Any:
    """Return the Python function behind a compiled one."""
    return getattr(function, "py_func", function)


def where(plain: Any) -> str:
    """Return what a function is called in messages."""
    return f"{plain.__module__}.{plain.__qualname__}"


def read(function: Any) -> ScalarFunction:
    """Return a function, plain or compiled, with its syntax.

    Raises:
        UntranslatableError: its source is not at hand, or it is not written with def.
    """
    plain = plain_function(function)
    try:
        source = textwrap.dedent(inspect.getsource(plain))
    except (OSError, TypeError):
        raise UntranslatableError(f"{where(plain)}: its source is not at hand; put the function into a file") from None
    tree = ast.parse(source).body[0]
    if not isinstance(tree, ast.FunctionDef):
        raise UntranslatableError(f"{where(plain)} is not a plain function; write it with def")
    return ScalarFunction(plain, tree)
