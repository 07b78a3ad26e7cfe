"""Statements: what the body of a Python function becomes in C."""

from __future__ import annotations

import ast
import itertools

from stochfric_mb.c.expressions import Expressions, c_name
from stochfric_mb.c.types import (
    DOUBLE,
    INT,
    VOID,
    Array,
    CannotTranslate,
    Scalar,
    Several,
    Tuple,
    Type,
    Value,
    as_c,
    bare,
    unified,
)

_OPERATORS: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


class Body:
    """Translates the statements of one function; the types of its local names grow until they hold all that is put in."""

    def __init__(self, expressions: Expressions) -> None:
        self.x = expressions
        self.returned: Type | None = None
        self.arrays: dict[str, Array] = {}
        self.lines: list[str] = []
        self._indent = 1
        self._numbers = itertools.count()

    def block(self, statements: list[ast.stmt]) -> None:
        """Translate statements one after the other."""
        for statement in statements:
            method = getattr(self, f"_{type(statement).__name__.lower()}", None)
            if method is None:
                raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement).splitlines()[0]}")
            method(statement)

    def _write(self, line: str) -> None:
        self.lines.append("    " * self._indent + line)

    def _nested(self, statements: list[ast.stmt]) -> None:
        self._indent += 1
        self.block(statements)
        self._indent -= 1

    def _pass(self, _statement: ast.Pass) -> None:
        pass

    def _break(self, _statement: ast.Break) -> None:
        self._write("break;")

    def _continue(self, _statement: ast.Continue) -> None:
        self._write("continue;")

    def _expr(self, statement: ast.Expr) -> None:
        if isinstance(statement.value, ast.Constant) and isinstance(statement.value.value, str):
            return  # a docstring
        self._write(f"{self.x.number(statement.value).code};")

    def _return(self, statement: ast.Return) -> None:
        if statement.value is None:
            self.returned = VOID
            self._write("return;")
            return
        value = self.x.any(statement.value)
        if isinstance(value, Several):
            scalars = tuple(v.type for v in value.values if isinstance(v.type, Scalar))
            self._note_return(statement, Tuple(tuple(DOUBLE if s == INT else s for s in scalars)))
            assert isinstance(self.returned, Tuple)
            items = ", ".join(as_c(v, t) for v, t in zip(value.values, self.returned.items, strict=True))
            self._write(f"return ({self.returned.c}){{{items}}};")
            return
        if not isinstance(value, Value):
            raise CannotTranslate(statement, f"{ast.unparse(statement)} returns no number")
        self._note_return(statement, value.type)
        assert self.returned is not None
        self._write(f"return {bare(as_c(value, self.returned))};")

    def _note_return(self, statement: ast.Return, kind: Type) -> None:
        self.returned = unified(self.returned, kind)
        if self.returned is None or isinstance(kind, Array):
            raise CannotTranslate(statement, f"{ast.unparse(statement)} returns another kind of value than before")

    # --- assignments --------------------------------------------------------------------------------------------------

    def _assign(self, statement: ast.Assign) -> None:
        target = statement.targets[0]
        if self._new_arrays(statement, target, statement.value):
            return
        value = self.x.any(statement.value)
        if len(statement.targets) > 1:
            self._to_all(statement, value)
        elif isinstance(target, ast.Tuple):
            self._take_apart(statement, target, value)
        elif isinstance(value, Value):
            self._set(target, value)
        elif isinstance(value, Several):
            scalars = tuple(v.type for v in value.values if isinstance(v.type, Scalar))
            code = ", ".join(v.code for v in value.values)
            self._set(target, Value(f"({Tuple(scalars).c}){{{code}}}", Tuple(scalars)))
        else:
            raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement)}")

    def _to_all(self, statement: ast.Assign, value: object) -> None:
        """Translate ``a = b = value``."""
        if not isinstance(value, Value):
            raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement)}")
        for target in statement.targets:
            self._set(target, value)

    def _new_arrays(self, statement: ast.Assign, target: ast.expr, value: ast.expr) -> bool:
        """Translate ``a = np.zeros(3)`` and ``a, b = np.zeros(3), np.zeros(4)``; return whether it was that."""
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            made = [self.x.made_array(item) for item in value.elts]
            if None in made:
                return False
            return all(self._new_arrays(statement, t, v) for t, v in zip(target.elts, value.elts, strict=True))
        one = self.x.made_array(value)
        if one is not None:
            self._new_array(statement, target, *one)
        return one is not None

    def _new_array(self, statement: ast.Assign, target: ast.expr, kind: Array, source: Value | None) -> None:
        if not isinstance(target, ast.Name) or None in kind.shape:
            raise CannotTranslate(statement, f"the length of the new array in {ast.unparse(statement)} is not known")
        name, room = c_name(target.id), f"{target.id}_room_"
        self.arrays[room] = kind
        known = unified(self.x.variables.get(target.id), kind)
        if known is None:
            raise CannotTranslate(target, f"{target.id!r} is given values of different kinds")
        self.x.variables[target.id] = known
        self._write(f"{name} = {room};")
        if source is None:
            self._write(f"memset({name}, 0, sizeof {room});")
        else:
            self._write(f"memcpy({name}, {source.code}, sizeof {room});")

    def _set(self, target: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Name):
            kind = unified(self.x.variables.get(target.id), value.type)
            if kind is None:
                raise CannotTranslate(target, f"{target.id!r} is given values of different kinds")
            self.x.variables[target.id] = kind
            self._write(f"{c_name(target.id)} = {bare(as_c(value, kind))};")
        elif isinstance(target, ast.Subscript):
            place = self.x.number(target)
            self._write(f"{place.code} = {bare(as_c(value, place.type))};")
        else:
            raise CannotTranslate(target, f"no translation of an assignment to {ast.unparse(target)}")

    def _take_apart(self, statement: ast.Assign, target: ast.Tuple, value: object) -> None:
        """Translate ``a, b = value``: all of the right side first."""
        if isinstance(value, Several):
            parts = list(value.values)
            if any(not isinstance(p.type, Scalar) for p in parts):
                raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement)}")
            temporaries = [self._temporary(p) for p in parts]
        elif isinstance(value, Value) and isinstance(value.type, Tuple):
            whole = self._temporary(value)
            temporaries = [Value(f"{whole.code}.a{i}", kind) for i, kind in enumerate(value.type.items)]
        else:
            raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement)}")
        for item, part in zip(target.elts, temporaries, strict=True):
            if not (isinstance(item, ast.Name) and item.id == "_"):
                self._set(item, part)

    def _temporary(self, value: Value) -> Value:
        if value.constant is not None:
            return value
        name = f"t{next(self._numbers)}_"
        self._write(f"const {value.type.c} {name} = {bare(value.code)};")
        return Value(name, value.type)

    def _augassign(self, statement: ast.AugAssign) -> None:
        as_binary = ast.BinOp(statement.target, statement.op, statement.value)
        ast.copy_location(as_binary, statement)
        ast.fix_missing_locations(as_binary)
        self._set(statement.target, self.x.number(as_binary))

    # --- control flow -------------------------------------------------------------------------------------------------

    def _if(self, statement: ast.If) -> None:
        self._write(f"if ({bare(self.x.condition(statement.test))}) {{")
        self._nested(statement.body)
        if statement.orelse:
            self._write("} else {")
            self._nested(statement.orelse)
        self._write("}")

    def _while(self, statement: ast.While) -> None:
        if statement.orelse:
            raise CannotTranslate(statement, "no translation of while ... else")
        self._write(f"while ({bare(self.x.condition(statement.test))}) {{")
        self._nested(statement.body)
        self._write("}")

    def _for(self, statement: ast.For) -> None:
        loop, target = statement.iter, statement.target
        is_range = isinstance(loop, ast.Call) and isinstance(loop.func, ast.Name) and loop.func.id == "range"
        if isinstance(loop, ast.Tuple):
            self._for_each(statement, loop)
            return
        if not is_range or statement.orelse or not isinstance(target, ast.Name) or not isinstance(loop, ast.Call):
            raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement).splitlines()[0]}")
        bounds = [self.x.number(a) for a in loop.args]
        first, last = ("INT64_C(0)", bounds[0].code) if len(bounds) == 1 else (bounds[0].code, bounds[1].code)
        if len(bounds) > 2 or any(b.type != INT for b in bounds):
            raise CannotTranslate(statement, f"no translation of: {ast.unparse(statement).splitlines()[0]}")
        n = next(self._numbers)
        self._write(f"const int64_t end{n}_ = {last};")
        self._write(f"for (int64_t k{n}_ = {first}; k{n}_ < end{n}_; k{n}_++) {{")
        self._indent += 1
        if target.id != "_":
            self._set(target, Value(f"k{n}_", INT))
        self._indent -= 1
        self._nested(statement.body)
        self._write("}")

    def _for_each(self, statement: ast.For, group: ast.Tuple) -> None:
        """Translate ``for x in (a, b, c)``."""
        values = [self.x.number(item) for item in group.elts]
        n = next(self._numbers)
        codes = ", ".join(as_c(v, DOUBLE) for v in values)
        self._write(f"const double each{n}_[] = {{{codes}}};")
        self._write(f"for (int k{n}_ = 0; k{n}_ < {len(values)}; k{n}_++) {{")
        self._indent += 1
        self._set(statement.target, Value(f"each{n}_[k{n}_]", DOUBLE))
        self._indent -= 1
        self._nested(statement.body)
        self._write("}")
