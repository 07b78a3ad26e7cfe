"""What compiled code does beyond Python: loads and stores through addresses, and calls of functions at addresses."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from stochfric_mb.compile import compiled

carray: Any = numba.carray  # pyright: ignore[reportPrivateImportUsage]
_LLVM: dict[Any, Any] = {
    types.void: ir.VoidType(),
    types.float64: ir.DoubleType(),
    types.int64: ir.IntType(64),
    types.int32: ir.IntType(32),
    types.uint32: ir.IntType(32),
    types.uint8: ir.IntType(8),
}
_WIDE = (types.void, types.float64, types.int64)


def instructions(signature: Any, generate: Callable[[Any, Any, Any, Any], Any]) -> Any:
    """Return a function for compiled code that is a few LLVM instructions.

    Args:
        signature: its numba signature.
        generate: what writes them, of (context, builder, signature, arguments), as `numba.extending.intrinsic` has it.
    """

    def typing(_context: Any, *_arguments: Any) -> Any:
        return signature, generate

    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    names = ["context", *(f"argument_{i}" for i in range(len(signature.args)))]
    typing.__signature__ = inspect.Signature([inspect.Parameter(name, kind) for name in names])  # type: ignore[attr-defined]
    return intrinsic(typing)


def function_at(returns: Any, *arguments: Any) -> Any:
    """Return a function for compiled code that calls one at an address: (address, arguments); pointers are whole numbers.

    Args:
        returns: numba type of what it returns: void, a double, or a whole number, which is widened to 64 bits.
        arguments: numba types of what it takes, doubles and whole numbers of 64 bits.
    """
    kind = ir.FunctionType(_LLVM[returns], [_LLVM[a] for a in arguments])

    def generate(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        answer = builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value() if returns == types.void else _widened(builder, answer, returns)

    return instructions(_wide(returns)(types.intp, *arguments), generate)


def _wide(kind: Any) -> Any:
    return kind if kind in _WIDE else types.int64


def _widened(builder: Any, value: Any, kind: Any) -> Any:
    if kind in _WIDE:
        return value
    return (builder.sext if kind.signed else builder.zext)(value, ir.IntType(64))


def _place(builder: Any, kind: Any, address: Any, *number: Any) -> Any:
    pointer = builder.inttoptr(address, _LLVM[kind].as_pointer())
    return builder.gep(pointer, number) if number else pointer


def _load(kind: Any, *number: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return _widened(builder, builder.load(_place(builder, kind, *args)), kind)

    return instructions(_wide(kind)(types.intp, *number), generate)


def _store(kind: Any, *number: Any) -> Any:
    def generate(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        builder.store(args[-1], _place(builder, kind, *args[:-1]))
        return context.get_dummy_value()

    return instructions(types.void(types.intp, *number, kind), generate)


def _pointer(kind: Any) -> Any:
    def generate(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return _place(builder, kind, args[0])

    return instructions(types.CPointer(kind)(types.intp), generate)


load_double = _load(types.float64)
"""Return the double at an address."""
load_word = _load(types.int64)
"""Return the 64-bit integer or pointer at an address."""
load_int = _load(types.int32)
"""Return the 32-bit integer at an address."""
load_byte = _load(types.uint8)
"""Return the byte at an address."""
store_double = _store(types.float64)
"""Write at an address a double."""
store_word = _store(types.int64)
"""Write at an address a 64-bit integer."""
at, int_at, byte_at, word_at = (_load(kind, types.intp) for kind in (types.float64, types.int32, types.uint8, types.int64))
"""Return, of (array, i), number ``i`` of the doubles, 32-bit integers, bytes, or 64-bit integers or pointers at an address."""
put, put_word = (_store(kind, types.intp) for kind in (types.float64, types.int64))
"""Write, of (array, i, value), number ``i`` of the doubles, or 64-bit integers or pointers at an address."""
as_doubles = _pointer(types.float64)
"""Return an address as a pointer to doubles, for `carray`."""
as_words = _pointer(types.int64)
"""Return an address as a pointer to 64-bit integers, for `carray`."""


@compiled
def vector(address, n):
    """Return the ``n`` doubles at ``address`` as an array (a view)."""
    return carray(as_doubles(address), n)


def _copy(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
    source, target = (_place(builder, types.uint8, address) for address in args[:2])
    cgutils.raw_memcpy(builder, target, source, args[2], 1)
    return context.get_dummy_value()


copy_bytes = instructions(types.void(types.intp, types.intp, types.intp), _copy)
"""Copy from one address to another some bytes; the two must not overlap."""


@intrinsic
def c_string(typingctx, text):
    """Return the address of a text, a constant in the source, as a C string."""
    if not isinstance(text, types.StringLiteral):
        return None

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.ptrtoint(context.insert_const_string(builder.module, text.literal_value), ir.IntType(64))

    return types.intp(text), generate
