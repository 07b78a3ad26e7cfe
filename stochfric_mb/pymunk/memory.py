"""Calls of the engine's own functions by their addresses, for compiled code."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

_DOUBLE, _WORD = ir.DoubleType(), ir.IntType(64)
_BYTE_POINTER = ir.IntType(8).as_pointer()


@intrinsic
def call_handler(typingctx, function, arbiter, space, data):
    """Call the collision callback at address ``function``: void(arbiter, space, data)."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [_BYTE_POINTER] * 3)
        pointers = [builder.inttoptr(a, _BYTE_POINTER) for a in args[1:]]
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), pointers)
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp, types.intp), generate


def _getter(kind: Any, result: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        function = ir.FunctionType(kind, [_BYTE_POINTER])
        value = builder.call(builder.inttoptr(args[0], function.as_pointer()), [builder.inttoptr(args[1], _BYTE_POINTER)])
        if kind is _DOUBLE or kind.width == 64:
            return value
        return builder.zext(value, _WORD)

    return result(types.intp, types.intp), generate


@intrinsic
def get_double(typingctx, function, pointer):
    """Return what the getter at address ``function`` says of ``pointer``, a double."""
    return _getter(_DOUBLE, types.float64)


@intrinsic
def get_int(typingctx, function, pointer):
    """Return what the getter at address ``function`` says of ``pointer``, an unsigned int."""
    return _getter(ir.IntType(32), types.int64)


@intrinsic
def get_word(typingctx, function, pointer):
    """Return what the getter at address ``function`` says of ``pointer``, a word."""
    return _getter(_WORD, types.int64)


@intrinsic
def get_byte(typingctx, function, pointer):
    """Return what the getter at address ``function`` says of ``pointer``, a byte."""
    return _getter(ir.IntType(8), types.int64)
