"""Loads and stores through addresses, for compiled code that works inside an engine's own structures."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

_DOUBLE = ir.DoubleType()
_WORD = ir.IntType(64)


def _loader(kind: Any, result: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        value = builder.load(builder.inttoptr(args[0], kind.as_pointer()))
        if kind is _DOUBLE or kind.width == 64:
            return value
        return builder.zext(value, _WORD)

    return result(types.intp), generate


@intrinsic
def load_double(typingctx, address):
    """Return the double at ``address``."""
    return _loader(_DOUBLE, types.float64)


@intrinsic
def load_word(typingctx, address):
    """Return the 64-bit integer or pointer at ``address``."""
    return _loader(_WORD, types.int64)


@intrinsic
def load_int(typingctx, address):
    """Return the 32-bit unsigned integer at ``address``."""
    return _loader(ir.IntType(32), types.int64)


@intrinsic
def load_byte(typingctx, address):
    """Return the byte at ``address``."""
    return _loader(ir.IntType(8), types.int64)


@intrinsic
def store_double(typingctx, address, value):
    """Write a double at ``address``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[1], builder.inttoptr(args[0], _DOUBLE.as_pointer()))
        return context.get_dummy_value()

    return types.void(types.intp, types.float64), generate


@intrinsic
def store_word(typingctx, address, value):
    """Write a 64-bit integer at ``address``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[1], builder.inttoptr(args[0], _WORD.as_pointer()))
        return context.get_dummy_value()

    return types.void(types.intp, types.int64), generate


@intrinsic
def as_doubles(typingctx, address):
    """Return ``address`` as a pointer to doubles, for ``numba.carray``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], context.get_value_type(signature.return_type))

    return types.CPointer(types.float64)(types.intp), generate


@intrinsic
def as_words(typingctx, address):
    """Return ``address`` as a pointer to 64-bit integers, for ``numba.carray``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], context.get_value_type(signature.return_type))

    return types.CPointer(types.int64)(types.intp), generate
