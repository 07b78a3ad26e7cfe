"""Scalar Python functions of this package as Warp functions: the source that numba compiles, read again and given types.

A law's functions are plain Python of numbers, tuples and arrays. Warp wants a type for every argument and mixes no types,
so a function is translated once for each list of argument types that it is called with, and so are those that it calls.
Nothing is rewritten by hand: a change of a law changes its Warp function.

Types: ``REAL`` (float32 or float64, chosen by the `Translator`), ``INT``, ``WORD`` (64 bits without sign), ``BOOL``, ``ARRAY``
(of REAL) and `Numbers`, a tuple of reals such as a law's state, or a NamedTuple of numbers.
"""

from __future__ import annotations

import ast
import dataclasses
import hashlib
import linecache
import math
from collections.abc import Callable
from typing import Any, TypeGuard

import numpy as np
import warp as wp

from stochfric_mb.errors import InputError
from stochfric_mb.scalar_function import ARITHMETIC, BITS, COMPARISONS, UntranslatableError, plain_function, read

REAL, INT, WORD, BOOL, ARRAY = "real", "int", "word", "bool", "array"


@dataclasses.dataclass(frozen=True)
class Numbers:
    """The type of a tuple of reals; as an argument it travels as that many numbers."""

    count: int
    """How many."""
    fields: tuple[str, ...] = ()
    """Their names, where it is a NamedTuple."""


Kind = str | Numbers | tuple[Any, ...]
_RANK = {BOOL: 0, INT: 1, WORD: 2, REAL: 3}
_OPERATORS = ARITHMETIC | BITS | COMPARISONS | {ast.Div: "/", ast.Mod: "%"}
_ONE_ARGUMENT = {"sqrt", "exp", "log", "sin", "cos", "tan", "atan", "tanh", "erf", "erfc", "floor", "asin", "acos"}
_HELPERS = """
@wp.func
def _hypot(x: {real}, y: {real}):
    big = wp.max(wp.abs(x), wp.abs(y))
    if big == {real}(0.0):
        return big
    return big * wp.sqrt((x / big) * (x / big) + (y / big) * (y / big))


@wp.func
def _copysign(x: {real}, y: {real}):
    return wp.where(y < {real}(0.0), -wp.abs(x), wp.abs(x))
"""


@dataclasses.dataclass(frozen=True)
class Made:
    """A function that has been translated."""

    name: str
    """Its name in the Warp source."""
    returns: Kind
    """The type of what it returns."""


class Translator:
    """Collects translated functions, and makes Warp functions of them."""

    def __init__(self, real: type = wp.float32) -> None:
        """Start with nothing translated; ``real`` is Warp's type of all real numbers."""
        self.real = f"wp.{real.__name__}"
        self.largest = float(np.finfo(np.float32 if real is wp.float32 else np.float64).max)
        self._names = 0
        self._made: dict[tuple[Any, ...], Made] = {}
        self._sources: list[str] = [_HELPERS.format(real=self.real)]

    def add(self, function: Callable[..., Any], arguments: tuple[Kind, ...]) -> Made:
        """Translate a function for arguments of the given types, and all that it calls.

        Args:
            function: a plain Python function, or what numba made of one.
            arguments: the type of each argument.

        Raises:
            UntranslatableError: the function holds Python that has no counterpart.
        """
        plain = plain_function(function)
        key = (plain.__module__, plain.__qualname__, arguments)
        if key not in self._made:
            self._names += 1
            name = f"{plain.__name__.lstrip('_')}_{self._names}"
            source, returns = _Function(self, plain, arguments).translated(name)
            self._sources.append(source)
            self._made[key] = Made(name, returns)
        return self._made[key]

    def functions(self, *made: Made, then: str = "") -> tuple[Any, ...]:
        """Return the Warp functions of what was translated, in the order asked for.

        Args:
            made: what `add` returned.
            then: more source that may use all of them, and define functions that ``made`` names (`Made` of their names).
        """
        source = "\n\n".join([*self._sources, then])
        file = f"<stochfric_mb {hashlib.sha256(source.encode()).hexdigest()[:16]}>"
        linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
        names: dict[str, Any] = {"wp": wp, "__name__": "stochfric_mb.warp.translated", "Any": Any}
        exec(compile(source, file, "exec"), names)
        return tuple(names[m.name] for m in made)


class _Function:
    """One function on its way."""

    def __init__(self, translator: Translator, function: Any, arguments: tuple[Kind, ...]) -> None:
        self.all = translator
        self.source = read(function)
        self.globals = self.source.scope
        self.types: dict[str, Kind] = self.source.types_of(arguments)
        self.arguments = dict(self.types)
        self.locals: dict[str, Kind] = {}
        self.returns: Kind | None = None
        self.temporaries = 0

    def translated(self, name: str) -> tuple[str, Kind]:
        """Return the source and the type of what is returned."""
        body = self._block(self.source.tree.body, "    ")
        head = [self._declared(variable, kind) for variable, kind in self.locals.items()]
        parameters = ", ".join(self._parameter(n, k) for n, k in self.arguments.items())
        lines = [f"@wp.func\ndef {name}({parameters}):", *head, *body]
        return "\n".join(lines), self.returns if self.returns is not None else ()

    def _parameter(self, name: str, kind: Kind) -> str:
        if isinstance(kind, Numbers):
            return ", ".join(f"{name}_{i}: {self.all.real}" for i in range(kind.count))
        return f"{name}: {self._warp_type(kind)}"

    def _declared(self, name: str, kind: Kind) -> str:
        """Return the line that makes a variable which may change in branches and loops."""
        start = name if name in self.arguments else {REAL: "0.0", INT: "0", WORD: "0", BOOL: "False"}[str(kind)]
        return f"    {name} = {self._warp_type(kind)}({start})"

    def _warp_type(self, kind: Kind) -> str:
        return {REAL: self.all.real, INT: "wp.int64", WORD: "wp.uint64", BOOL: "bool", ARRAY: f"wp.array[{self.all.real}]"}[
            str(kind)
        ]

    def _no(self, node: ast.AST, what: str) -> InputError:
        line = self.source.line(getattr(node, "lineno", 1))
        return UntranslatableError(
            f"{self.source.where}, line {line}: {what} cannot run in Warp; use plain arithmetic, if, for and math"
        )

    # Statements

    def _block(self, statements: list[ast.stmt], indent: str) -> list[str]:
        lines: list[str] = []
        for statement in statements:
            lines += self._statement(statement, indent)
        return lines or [f"{indent}pass"]

    def _statement(self, node: ast.stmt, indent: str) -> list[str]:  # noqa: PLR0911  # one for each kind of node
        if isinstance(node, ast.Expr):
            if isinstance(node.value, ast.Constant):
                return []  # a docstring
            code, _ = self._value(node.value)
            return [f"{indent}{code}"]
        if isinstance(node, ast.Return):
            return self._return(node, indent)
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            return self._assignment(node.targets[0], node.value, indent)
        if isinstance(node, ast.AugAssign):
            return self._assignment(node.target, ast.BinOp(_loaded(node.target), node.op, node.value), indent)
        if isinstance(node, ast.If):
            code, kind = self._value(node.test)
            if kind != BOOL:
                raise self._no(node, "a condition that is no comparison")
            lines = [f"{indent}if {code}:", *self._block(node.body, indent + "    ")]
            return [*lines, f"{indent}else:", *self._block(node.orelse, indent + "    ")] if node.orelse else lines
        if isinstance(node, ast.For):
            return self._loop(node, indent)
        raise self._no(node, type(node).__name__)

    def _return(self, node: ast.Return, indent: str) -> list[str]:
        if node.value is None:
            return [f"{indent}return"]
        lines, parts = self._several(node.value, indent)
        kinds = tuple(kind for _, kind in parts)
        single = not isinstance(node.value, ast.Tuple) and len(parts) == 1 and not self._is_tuple_call(node.value)
        result: Kind = kinds[0] if single else Numbers(len(kinds)) if set(kinds) <= {REAL, INT} else kinds
        if single and self.returns == REAL and result == INT:
            result = REAL
        if self.returns is None:
            self.returns = result
        elif self.returns != result:
            raise self._no(node, f"returning {result} here and {self.returns} elsewhere")
        if isinstance(result, Numbers) or result == REAL:
            parts = [(self._cast(code, kind, REAL), REAL) for code, kind in parts]
        return [*lines, f"{indent}return {', '.join(code for code, _ in parts)}"]

    def _is_tuple_call(self, node: ast.expr) -> bool:
        return self._is_named_tuple(node) or (isinstance(node, ast.Call) and not isinstance(self._call(node)[1], str))

    def _is_named_tuple(self, node: ast.expr) -> TypeGuard[ast.Call]:
        made = self.globals.get(node.func.id) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else None
        return isinstance(made, type) and issubclass(made, tuple)

    def _several(self, node: ast.expr, indent: str) -> tuple[list[str], list[tuple[str, Kind]]]:
        """Return the values of a tuple, or of a call that returns one, and the lines that they need before."""
        if isinstance(node, ast.Tuple):
            return [], [self._value(e) for e in node.elts]
        if self._is_named_tuple(node):
            return [], [self._value(e) for e in node.args]
        code, kind = self._value(node)
        if isinstance(kind, str):
            return [], [(code, kind)]
        kinds = (REAL,) * kind.count if isinstance(kind, Numbers) else kind
        if len(kinds) == 1:
            return [], [(code, kinds[0])]
        names = [self._temporary() for _ in kinds]
        return [f"{indent}{', '.join(names)} = {code}"], list(zip(names, kinds, strict=True))

    def _assignment(self, target: ast.expr, value: ast.expr, indent: str) -> list[str]:
        if not isinstance(target, ast.Tuple):
            code, kind = self._value(value)
            return [self._store(target, code, kind, indent)]
        lines, parts = self._several(value, indent)
        if len(parts) != len(target.elts):
            raise self._no(target, f"{len(parts)} values for {len(target.elts)} names")
        if isinstance(value, ast.Tuple):  # all are read before any is written
            names = [self._temporary() for _ in parts]
            lines += [f"{indent}{n} = {self._warp_type(k)}({c})" for n, (c, k) in zip(names, parts, strict=True)]
            parts = [(n, k) for n, (_, k) in zip(names, parts, strict=True)]
        return lines + [
            self._store(t, c, k, indent)
            for t, (c, k) in zip(target.elts, parts, strict=True)
            if not (isinstance(t, ast.Name) and t.id == "_")
        ]

    def _store(self, target: ast.expr, code: str, kind: Kind, indent: str) -> str:
        if isinstance(target, ast.Subscript):
            array, _ = self._value(target.value)
            index, index_kind = self._value(target.slice)
            return f"{indent}{array}[{self._index(index, index_kind)}] = {self._cast(code, kind, REAL)}"
        if not isinstance(target, ast.Name) or not isinstance(kind, str):
            raise self._no(target, "this assignment")
        known = self.types.setdefault(target.id, kind)
        if known != kind:
            code = self._cast(code, kind, known)
        self.locals[target.id] = known
        return f"{indent}{target.id} = {self._warp_type(known)}({code})"

    def _loop(self, node: ast.For, indent: str) -> list[str]:
        called = node.iter
        if not (isinstance(called, ast.Call) and isinstance(called.func, ast.Name) and called.func.id == "range"):
            raise self._no(node, "a loop over anything but range")
        assert isinstance(node.target, ast.Name)
        limits = [self._index(*self._value(a)) for a in called.args]
        name = self._temporary()
        self.types[node.target.id] = INT
        self.locals[node.target.id] = INT
        first = f"{indent}    {node.target.id} = wp.int64({name})"
        return [f"{indent}for {name} in range({', '.join(limits)}):", first, *self._block(node.body, indent + "    ")]

    def _temporary(self) -> str:
        self.temporaries += 1
        return f"t_{self.temporaries}"

    # Expressions: each returns its source and its type

    def _value(self, node: ast.expr) -> tuple[str, Kind]:  # noqa: PLR0911  # one for each kind of node
        if isinstance(node, ast.Constant):
            return self._constant(node.value, node)
        if isinstance(node, ast.Name):
            return self._name(node)
        if isinstance(node, ast.Attribute):
            return self._attribute(node)
        if isinstance(node, ast.Subscript):
            return self._element(node)
        if isinstance(node, ast.Call):
            return self._call(node)
        if isinstance(node, ast.BinOp):
            return self._arithmetic(node)
        if isinstance(node, ast.UnaryOp):
            code, kind = self._value(node.operand)
            return (f"(not {code})", BOOL) if isinstance(node.op, ast.Not) else (f"(-{code})", kind)
        if isinstance(node, ast.Compare):
            return self._comparison(node)
        if isinstance(node, ast.BoolOp):
            word = " and " if isinstance(node.op, ast.And) else " or "
            return f"({word.join(self._value(v)[0] for v in node.values)})", BOOL
        if isinstance(node, ast.IfExp):
            test, _ = self._value(node.test)
            (a, b), kind = self._alike([self._value(node.body), self._value(node.orelse)])
            return f"wp.where({test}, {a}, {b})", kind
        raise self._no(node, type(node).__name__)

    def _constant(self, value: Any, node: ast.AST) -> tuple[str, Kind]:
        if isinstance(value, bool | np.bool_):
            return str(bool(value)), BOOL
        if isinstance(value, np.unsignedinteger):
            return f"wp.uint64({int(value)})", WORD
        if isinstance(value, int | np.integer):
            return f"wp.int64({int(value)})", INT
        if isinstance(value, float | np.floating):
            within = math.copysign(min(abs(float(value)), self.all.largest), float(value))
            return f"{self.all.real}({within!r})", REAL
        raise self._no(node, f"the value {value!r}")

    def _name(self, node: ast.Name) -> tuple[str, Kind]:
        if node.id in self.types:
            return node.id, self.types[node.id]
        return self._constant(self._global(node), node)

    def _global(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Name) and node.id in self.globals:
            return self.globals[node.id]
        raise self._no(node, f"{ast.unparse(node)!r}")

    def _attribute(self, node: ast.Attribute) -> tuple[str, Kind]:
        kind = self.types.get(node.value.id) if isinstance(node.value, ast.Name) else None
        if isinstance(kind, Numbers) and node.attr in kind.fields:
            return f"{ast.unparse(node.value)}_{kind.fields.index(node.attr)}", REAL
        return self._constant(getattr(self._global(node.value), node.attr), node)

    def _element(self, node: ast.Subscript) -> tuple[str, Kind]:
        array, kind = self._value(node.value)
        if isinstance(kind, Numbers):
            if not isinstance(node.slice, ast.Constant):
                raise self._no(node, "a state entry whose number is not written out")
            return f"{array}_{node.slice.value}", REAL
        index, index_kind = self._value(node.slice)
        return f"{array}[{self._index(index, index_kind)}]", REAL

    def _arithmetic(self, node: ast.BinOp) -> tuple[str, Kind]:
        if isinstance(node.op, ast.Pow):
            base, kind = self._value(node.left)
            if isinstance(node.right, ast.Constant) and node.right.value == 2:
                return f"({base} * {base})", kind
            return f"wp.pow({self._cast(base, kind, REAL)}, {self._cast(*self._value(node.right), REAL)})", REAL
        (a, b), kind = self._alike([self._value(node.left), self._value(node.right)])
        if isinstance(node.op, ast.Div) and kind == INT:
            a, b, kind = self._cast(a, INT, REAL), self._cast(b, INT, REAL), REAL
        return f"({a} {self._operator(node.op)} {b})", kind

    def _comparison(self, node: ast.Compare) -> tuple[str, Kind]:
        if isinstance(node.ops[0], ast.NotIn) and isinstance(node.comparators[0], ast.Tuple):
            each = [ast.Compare(node.left, [ast.NotEq()], [e]) for e in node.comparators[0].elts]
            return f"({' and '.join(self._comparison(e)[0] for e in each)})", BOOL
        terms = [self._value(e) for e in (node.left, *node.comparators)]
        parts: list[str] = []
        for left, operator, right in zip(terms, node.ops, terms[1:], strict=False):
            (a, b), _ = self._alike([left, right])
            parts.append(f"({a} {self._operator(operator)} {b})")
        return (parts[0] if len(parts) == 1 else f"({' and '.join(parts)})"), BOOL

    def _operator(self, node: ast.AST) -> str:
        if type(node) not in _OPERATORS:
            raise self._no(node, type(node).__name__)
        return _OPERATORS[type(node)]

    def _call(self, node: ast.Call) -> tuple[str, Kind]:
        arguments = [self._value(a) for a in node.args]
        if isinstance(node.func, ast.Attribute) and self._global(node.func.value) is math:
            return self._math(node.func.attr, arguments, node)
        if not isinstance(node.func, ast.Name):
            raise self._no(node, ast.unparse(node.func))
        name = node.func.id
        if name == "len" and isinstance(arguments[0][1], Numbers):
            return f"wp.int64({arguments[0][1].count})", INT
        if name in _BUILT_IN:
            return self._built_in(name, arguments)
        made = self.all.add(self._global(node.func), tuple(kind for _, kind in arguments))
        return f"{made.name}({', '.join(self._passed(c, k) for c, k in arguments)})", made.returns

    def _passed(self, code: str, kind: Kind) -> str:
        return ", ".join(f"{code}_{i}" for i in range(kind.count)) if isinstance(kind, Numbers) else code

    def _built_in(self, name: str, arguments: list[tuple[str, Kind]]) -> tuple[str, Kind]:
        if name in _CASTS:
            return self._cast(*arguments[0], _CASTS[name]), _CASTS[name]
        if name in {"bits_of", "double_of"}:
            to = "uint64" if name == "bits_of" else "float64"
            return f"wp.cast({arguments[0][0]}, wp.{to})", WORD if name == "bits_of" else REAL
        codes, kind = self._alike(arguments)
        code = codes[0]
        if name == "abs":
            return f"wp.abs({code})", kind
        for other in codes[1:]:
            code = f"wp.{name}({code}, {other})"
        return code, kind

    def _math(self, name: str, arguments: list[tuple[str, Kind]], node: ast.AST) -> tuple[str, Kind]:
        codes = [self._cast(code, kind, REAL) for code, kind in arguments]
        if name in _ONE_ARGUMENT:
            return f"wp.{name}({codes[0]})", REAL
        if name in {"hypot", "copysign"}:
            return f"_{name}({codes[0]}, {codes[1]})", REAL
        if name == "pow":
            return f"wp.pow({codes[0]}, {codes[1]})", REAL
        raise self._no(node, f"math.{name}")

    def _alike(self, values: list[tuple[str, Kind]]) -> tuple[list[str], Kind]:
        """Return values brought to the highest of their types, as numba does."""
        highest = max((kind for _, kind in values), key=lambda kind: _RANK[str(kind)])
        return [self._cast(code, kind, highest) for code, kind in values], highest

    def _cast(self, code: str, kind: Kind, to: Kind) -> str:
        return code if kind == to else f"{self._warp_type(to)}({code})"

    def _index(self, code: str, kind: Kind) -> str:
        if kind not in {INT, WORD, REAL}:
            raise UntranslatableError(f"{self.source.where}: {code} is no index")
        return f"wp.int32({code})"


_CASTS: dict[str, Kind] = {"float": REAL, "float64": REAL, "int": INT, "int64": INT, "uint64": WORD}
_BUILT_IN = {*_CASTS, "bits_of", "double_of", "abs", "min", "max"}


def _loaded(target: ast.expr) -> ast.expr:
    """Return an assignment's target as an expression that reads it."""
    return ast.parse(ast.unparse(target), mode="eval").body
