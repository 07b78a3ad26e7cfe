"""Expressions: what a Python expression on numbers and arrays of numbers becomes in C, with its type."""

from __future__ import annotations

import ast
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from stochfric_mb.c import intrinsics
from stochfric_mb.c.types import (
    BOOL,
    DOUBLE,
    DUAL,
    INT,
    UNSIGNED,
    Array,
    CannotTranslate,
    Known,
    Scalar,
    Several,
    Tuple,
    Value,
    as_c,
    bare,
    number,
    plain,
    unified,
)
from stochfric_mb.scalar_function import ARITHMETIC, BITS, COMPARISONS

Anything = Value | Several | Known

_DUAL: dict[type[ast.operator], str] = {ast.Add: "sum", ast.Sub: "difference", ast.Mult: "product", ast.Div: "quotient",
                                        ast.Pow: "power"}  # fmt: skip


class Expressions:
    """Translates the expressions of one function."""

    def __init__(
        self, scope: dict[str, Any], variables: dict[str, Any], call: Callable[[Any, list[Value]], Value | None]
    ) -> None:
        """Prepare.

        Args:
            scope: global names of the function.
            variables: types of its local names, which grows.
            call: translates the call of a function of the package; None if it is none.
        """
        self._scope, self.variables, self._function = scope, variables, call

    def number(self, node: ast.expr) -> Value:
        """Return an expression that is one value."""
        value = self.any(node)
        if not isinstance(value, Value):
            raise CannotTranslate(node, f"{ast.unparse(node)} is not a number or an array")
        return value

    def any(self, node: ast.expr) -> Anything:
        """Return an expression."""
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        if method is None:
            raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")
        return method(node)

    def condition(self, node: ast.expr) -> str:
        """Return the C code of a truth value."""
        value = self.number(node)
        return value.code if value.type == BOOL else f"({value.code} != 0)"

    # --- names and constants ------------------------------------------------------------------------------------------

    def _constant(self, node: ast.Constant) -> Anything:
        return self._of_object(node, node.value)

    def _name(self, node: ast.Name) -> Anything:
        if node.id in self.variables:
            return Value(c_name(node.id), self.variables[node.id])
        if node.id in self._scope:
            return self._of_object(node, self._scope[node.id])
        builtins: Any = self._scope["__builtins__"]
        result = builtins.get(node.id) if isinstance(builtins, dict) else getattr(builtins, node.id, None)
        if result is None:
            raise CannotTranslate(node, f"the name {node.id!r} has no value before it is used")
        return Known(result)

    def _of_object(self, node: ast.expr, value: Any) -> Anything:
        if type(value) is np.uint64:
            return Value(f"UINT64_C({int(value)})", UNSIGNED)
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, bool):
            return Value(number(value), BOOL, value)
        if isinstance(value, int):
            return Value(number(value), INT, value)
        if isinstance(value, float):
            return Value(number(value), DOUBLE, value)
        if isinstance(value, np.ndarray) and value.dtype == np.float64:
            entries = ", ".join(number(entry) for entry in value.ravel().tolist())
            return Value(f"((double[]){{{entries}}})", Array(DOUBLE, value.shape))
        if value is None or isinstance(value, str):
            raise CannotTranslate(node, f"{ast.unparse(node)} = {value!r} is not a number")
        return Known(value)

    def _attribute(self, node: ast.Attribute) -> Anything:
        owner = self.any(node.value)
        if isinstance(owner, Known) and owner.owner is None and isinstance(owner.value, ModuleType):
            if not hasattr(owner.value, node.attr):
                raise CannotTranslate(node, f"{ast.unparse(node)} does not exist")
            return self._of_object(node, getattr(owner.value, node.attr))
        if isinstance(owner, Value) and isinstance(owner.type, Array) and node.attr in ("ctypes", "copy"):
            return Known(node.attr, owner)
        if isinstance(owner, Known) and owner.value == "ctypes" and owner.owner is not None and node.attr == "data":
            return Value(f"((int64_t)(intptr_t){owner.owner.code})", INT)
        raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")

    # --- operators ----------------------------------------------------------------------------------------------------

    def _binop(self, node: ast.BinOp) -> Value:
        left, right, kind = self.number(node.left), self.number(node.right), type(node.op)
        if kind in BITS and left.type == right.type and left.type in (INT, UNSIGNED):
            return Value(f"({left.code} {BITS[kind]} {right.code})", left.type)
        if DUAL in (left.type, right.type):
            return self._dual(node, kind, left, right)
        if kind is ast.Div:
            return Value(f"({as_c(left, DOUBLE)} / {as_c(right, DOUBLE)})", DOUBLE)
        if kind is ast.Pow:
            return _power(left, right)
        return self._arithmetic(node, kind, left, right)

    def _arithmetic(self, node: ast.BinOp, kind: type[ast.operator], left: Value, right: Value) -> Value:
        wide = UNSIGNED if left.type == right.type == UNSIGNED else unified(left.type, right.type)
        if kind not in ARITHMETIC or not isinstance(wide, Scalar) or wide == BOOL:
            raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")
        constant = None
        if isinstance(left.constant, int) and isinstance(right.constant, int):
            constant = {"+": left.constant + right.constant, "-": left.constant - right.constant}.get(
                ARITHMETIC[kind], left.constant * right.constant
            )
            return Value(number(constant), INT, constant)
        return Value(f"({as_c(left, wide)} {ARITHMETIC[kind]} {as_c(right, wide)})", wide)

    def _dual(self, node: ast.BinOp, kind: type[ast.operator], left: Value, right: Value) -> Value:
        """Return an operation on numbers with derivatives."""
        if kind is ast.Pow and isinstance(right.constant, int) and right.constant >= 0:
            return Value(f"dual_whole_power({left.code}, {right.constant})", DUAL)
        if kind not in _DUAL:
            raise CannotTranslate(node, f"{ast.unparse(node)} has no translation with derivatives")
        return Value(f"dual_{_DUAL[kind]}({as_c(left, DUAL)}, {as_c(right, DUAL)})", DUAL)

    def _unaryop(self, node: ast.UnaryOp) -> Value:
        if isinstance(node.op, ast.Not):
            return Value(f"(!{self.condition(node.operand)})", BOOL)
        value = self.number(node.operand)
        if isinstance(node.op, ast.UAdd):
            return value
        if isinstance(node.op, ast.USub) and value.type == DUAL:
            return Value(f"dual_negative({value.code})", DUAL)
        if isinstance(node.op, ast.USub) and value.type in (DOUBLE, INT):
            constant = None if value.constant is None else -value.constant
            return Value(f"(-{value.code})", value.type, constant)
        raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")

    def _boolop(self, node: ast.BoolOp) -> Value:
        sign = " && " if isinstance(node.op, ast.And) else " || "
        return Value(f"({sign.join(self.condition(v) for v in node.values)})", BOOL)

    def _compare(self, node: ast.Compare) -> Value:
        parts: list[str] = []
        left = plain(self.number(node.left))
        for op, right_node in zip(node.ops, node.comparators, strict=True):
            if isinstance(op, ast.In | ast.NotIn):
                return self._among(node, left, right_node, isinstance(op, ast.NotIn))
            right = plain(self.number(right_node))
            wide = UNSIGNED if left.type == right.type == UNSIGNED else unified(left.type, right.type)
            if type(op) not in COMPARISONS or not isinstance(wide, Scalar):
                raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")
            parts.append(f"({as_c(left, wide)} {COMPARISONS[type(op)]} {as_c(right, wide)})")
            left = right
        return Value(parts[0] if len(parts) == 1 else f"({' && '.join(parts)})", BOOL)

    def _among(self, node: ast.Compare, left: Value, group: ast.expr, negated: bool) -> Value:
        several = self.any(group)
        if not isinstance(several, Several):
            raise CannotTranslate(node, f"no translation of {ast.unparse(node)}")
        equal = " || ".join(f"({as_c(left, DOUBLE)} == {as_c(v, DOUBLE)})" for v in several.values)
        return Value(f"(!({equal}))" if negated else f"({equal})", BOOL)

    def _ifexp(self, node: ast.IfExp) -> Value:
        yes, no = self.number(node.body), self.number(node.orelse)
        wide = unified(yes.type, no.type)
        if wide is None:
            raise CannotTranslate(node, f"the two sides of {ast.unparse(node)} are of different kinds")
        return Value(f"({self.condition(node.test)} ? {as_c(yes, wide)} : {as_c(no, wide)})", wide)

    # --- tuples and arrays --------------------------------------------------------------------------------------------

    def _tuple(self, node: ast.Tuple) -> Several:
        return Several(tuple(self.number(item) for item in node.elts))

    def _subscript(self, node: ast.Subscript) -> Value:
        owner = self.number(node.value)
        if isinstance(owner.type, Tuple):
            index = self.number(node.slice).constant
            if not isinstance(index, int):
                raise CannotTranslate(node, f"the entry of {ast.unparse(node)} is not a constant")
            return Value(f"{owner.code}.a{index}", owner.type.items[index])
        if not isinstance(owner.type, Array):
            raise CannotTranslate(node, f"{ast.unparse(node.value)} is not an array")
        indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return self._entry(node, owner, owner.type, [self.number(i) for i in indices])

    def _entry(self, node: ast.expr, owner: Value, kind: Array, indices: list[Value]) -> Value:
        """Return an entry of an array, or a row of one with rows."""
        if any(i.type != INT for i in indices) or len(indices) > len(kind.shape):
            raise CannotTranslate(node, f"the index of {ast.unparse(node)} is not a whole number")
        place = _plain(indices[0])
        for index, length in zip(indices[1:], kind.shape[1:], strict=False):
            place = f"({place} * {length} + {_plain(index)})"
        rest = kind.shape[len(indices) :]
        if not rest:
            return Value(f"{owner.code}[{bare(place)}]", kind.item)
        row = Array(kind.item, rest)
        return Value(f"({owner.code} + {place} * {row.size})", row)

    # --- calls --------------------------------------------------------------------------------------------------------

    def _call_of(self, node: ast.Call) -> Known:
        known = self.any(node.func)
        if not isinstance(known, Known) or node.keywords:
            raise CannotTranslate(node, f"no translation of the call {ast.unparse(node)}")
        return known

    def _call(self, node: ast.Call) -> Value:
        known = self._call_of(node)
        args = [self.number(a) for a in node.args]
        value = intrinsics.call(known, args) or self._function(known.value, args)
        if value is None:
            raise CannotTranslate(node, f"no translation of the call {ast.unparse(node)}")
        return value

    def made_array(self, node: ast.expr) -> tuple[Array, Value | None] | None:
        """Return type and source of a new array (``np.zeros(...)``, ``a.copy()``), None where ``node`` makes none."""
        if not isinstance(node, ast.Call):
            return None
        known = self._call_of(node)
        if known.value == "copy" and known.owner is not None and isinstance(known.owner.type, Array):
            return known.owner.type, known.owner
        if not intrinsics.constructor(known):
            return None
        shape = self.any(node.args[0])
        lengths = [v.constant for v in (shape.values if isinstance(shape, Several) else (shape,)) if isinstance(v, Value)]
        if not all(isinstance(n, int) for n in lengths):
            raise CannotTranslate(node, f"the length of {ast.unparse(node)} is not known")
        return Array(DOUBLE, tuple(lengths)), None


def _power(left: Value, right: Value) -> Value:
    if isinstance(right.constant, int) and right.constant >= 0 and left.type == DOUBLE:
        return Value(f"whole_power({left.code}, {right.constant})", DOUBLE)
    return Value(f"pow({as_c(left, DOUBLE)}, {as_c(right, DOUBLE)})", DOUBLE)


def _plain(index: Value) -> str:
    return index.code if index.constant is None else str(index.constant)


_KEYWORDS = frozenset(
    """auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while bool near
    far""".split()  # noqa: SIM905
)


def c_name(name: str) -> str:
    """Return a Python name as C takes it."""
    return f"{name}_" if name in _KEYWORDS else name
