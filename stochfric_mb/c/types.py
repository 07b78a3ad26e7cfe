"""The types of translated values, and what C calls them."""

from __future__ import annotations

import ast
import dataclasses
import math
from typing import Any


class CannotTranslate(Exception):  # noqa: N818  (caught inside this room)
    """A construct that has no translation."""

    def __init__(self, node: ast.AST | None, what: str) -> None:
        super().__init__(what)
        self.line = getattr(node, "lineno", 1)


@dataclasses.dataclass(frozen=True)
class Scalar:
    """A number."""

    c: str
    """Its C type."""
    letter: str
    """What stands for it in the names of structures and functions."""


DOUBLE = Scalar("double", "d")
INT = Scalar("int64_t", "i")
UNSIGNED = Scalar("uint64_t", "u")
BOOL = Scalar("bool", "b")
VOID = Scalar("void", "v")
DUAL = Scalar("dual", "x")
"""A number with its derivative along one direction: the same source, translated for it, gives derivatives."""


@dataclasses.dataclass(frozen=True)
class Array:
    """Numbers in a row, or in rows; the first length is None where it is not known."""

    item: Scalar
    """What it holds."""
    shape: tuple[int | None, ...]
    """Its lengths."""

    @property
    def c(self) -> str:
        """Its C type as an argument."""
        return f"{self.item.c} *"

    @property
    def letter(self) -> str:
        """What stands for it in names."""
        return "p" + self.item.letter + "x".join("" if n is None else str(n) for n in self.shape)

    @property
    def size(self) -> int:
        """Number of entries of an array whose shape is known."""
        size = 1
        for n in self.shape:
            assert n is not None
            size *= n
        return size


@dataclasses.dataclass(frozen=True)
class Tuple:
    """Several numbers that a function returns together."""

    items: tuple[Scalar, ...]
    """Their types."""

    @property
    def letter(self) -> str:
        """What stands for it in names."""
        letters = "".join(item.letter for item in self.items)
        return f"{letters[0]}{len(letters)}" if letters == letters[0] * len(letters) else letters

    @property
    def c(self) -> str:
        """Its C structure, with members a0, a1, ..."""
        return f"tuple_{self.letter}"

    @property
    def definition(self) -> str:
        """The definition of that structure."""
        members = " ".join(f"{item.c} a{i};" for i, item in enumerate(self.items))
        return f"typedef struct {{ {members} }} {self.c};"


Type = Scalar | Array | Tuple


@dataclasses.dataclass(frozen=True)
class Value:
    """A translated expression."""

    code: str
    """The C expression, safe within any other."""
    type: Type
    """Its type."""
    constant: Any = None
    """Its value where that is known now."""


@dataclasses.dataclass(frozen=True)
class Several:
    """Expressions with commas between them: what a tuple is before it is returned or taken apart."""

    values: tuple[Value, ...]
    """The expressions."""


@dataclasses.dataclass(frozen=True)
class Known:
    """A Python object that a name stands for: a module, a function, a method."""

    value: Any
    """The object."""
    owner: Value | None = None
    """What a method belongs to."""


def as_c(value: Value, wanted: Type) -> str:
    """Return the C code of a value, converted to a type."""
    if value.type == wanted or isinstance(wanted, Array):
        return value.code
    if isinstance(value.constant, int) and not isinstance(value.constant, bool) and wanted == DOUBLE:
        return number(float(value.constant))
    assert isinstance(wanted, Scalar)
    if wanted == DUAL:
        return f"dual_of({as_c(value, DOUBLE)})"
    if value.type == DUAL:
        raise CannotTranslate(None, "a number with a derivative cannot go where there is room for a number alone")
    return f"(({wanted.c}){value.code})"


def plain(value: Value) -> Value:
    """Return the number of a number with a derivative; other values as they are."""
    return Value(f"{value.code}.v", DOUBLE) if value.type == DUAL else value


def bare(code: str) -> str:
    """Return C code without the parentheses around all of it."""
    if not (code.startswith("(") and code.endswith(")")):
        return code
    depth = 0
    for i, letter in enumerate(code):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and i < len(code) - 1:
            return code
    return code[1:-1]


def number(value: float | int | bool) -> str:
    """Return a constant as C reads it, to the bit."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        text = f"INT64_C({abs(value)})"
        return f"(-{text})" if value < 0 else text
    if math.isnan(value):
        return "((double)NAN)"
    if math.isinf(value):
        return "((double)INFINITY)" if value > 0 else "(-(double)INFINITY)"
    text = repr(value)
    return f"({text})" if text.startswith("-") else text


def unified(a: Type | None, b: Type) -> Type | None:
    """Return the type that holds both, None if there is none."""
    if a is None or a == b:
        return b
    if isinstance(a, Scalar) and isinstance(b, Scalar):
        for wide in (DUAL, DOUBLE, INT):
            if wide in (a, b) and {a, b} <= {DUAL, DOUBLE, INT, BOOL}:
                return wide
        return None
    if isinstance(a, Tuple) and isinstance(b, Tuple) and len(a.items) == len(b.items):
        items = [unified(x, y) for x, y in zip(a.items, b.items, strict=True)]
        return Tuple(tuple(i for i in items if isinstance(i, Scalar))) if all(isinstance(i, Scalar) for i in items) else None
    if isinstance(a, Array) and isinstance(b, Array) and a.item == b.item and a.shape[1:] == b.shape[1:]:
        return Array(a.item, (None, *a.shape[1:]))
    return None
