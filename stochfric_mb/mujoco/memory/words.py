"""Plain memory for compiled code: numbers in MuJoCo's arrays, given by their addresses, and texts as C strings."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from stochfric_mb.compile import compiled
from stochfric_mb.numerics.memory import as_doubles, carray, instructions


def _place(context: Any, builder: Any, kind: Any, array: Any, i: Any) -> Any:
    return builder.gep(builder.inttoptr(array, context.get_value_type(kind).as_pointer()), [i])


def _reader(kind: Any) -> Any:
    wide = kind if kind == types.float64 else types.int64

    def read(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return context.cast(builder, builder.load(_place(context, builder, kind, *args)), kind, wide)

    return instructions(wide(types.intp, types.intp), read)


def _writer(kind: Any) -> Any:
    def write(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        builder.store(args[2], _place(context, builder, kind, *args[:2]))
        return context.get_dummy_value()

    return instructions(types.void(types.intp, types.intp, kind), write)


at, int_at, byte_at, word_at = map(_reader, (types.float64, types.int32, types.uint8, types.int64))
"""Return, of (array, i), number ``i`` of the doubles, C ints, bytes, or 64-bit integers or pointers at an address."""
put, put_word = map(_writer, (types.float64, types.int64))
"""Write, of (array, i, value), number ``i`` of the doubles, or 64-bit integers or pointers at an address."""


@compiled
def vector(address, n):
    """Return the ``n`` doubles at ``address`` as an array (a view)."""
    return carray(as_doubles(address), n)


def _copy(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
    byte = ir.IntType(8).as_pointer()
    source, target = builder.inttoptr(args[0], byte), builder.inttoptr(args[1], byte)
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
