"""Plain memory for compiled code: numbers in MuJoCo's arrays, given by their addresses, and texts as C strings."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from stochfric_mb.compile import compiled
from stochfric_mb.numerics.memory import (
    as_doubles,
    carray,
    instructions,
    load_byte,
    load_double,
    load_int,
    load_word,
    store_double,
    store_word,
)


@compiled
def at(array, i):
    """Return number ``i`` of the doubles at ``array``."""
    return load_double(array + 8 * i)


@compiled
def put(array, i, value):
    """Write number ``i`` of the doubles at ``array``."""
    store_double(array + 8 * i, value)


@compiled
def int_at(array, i):
    """Return number ``i`` of the C ints at ``array``."""
    return load_int(array + 4 * i)


@compiled
def byte_at(text, i):
    """Return byte ``i`` of the C string at ``text``."""
    return load_byte(text + i)


@compiled
def word_at(array, i):
    """Return number ``i`` of the 64-bit integers or pointers at ``array``."""
    return load_word(array + 8 * i)


@compiled
def put_word(array, i, value):
    """Write number ``i`` of the 64-bit integers or pointers at ``array``."""
    store_word(array + 8 * i, value)


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
