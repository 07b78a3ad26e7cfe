"""An effect's functions as C function pointers: one compiled solver serves all effects, a user's own included.

Signature: void(world, memory, rates, p), four pointers to doubles; see `stochfric_mb.effects.contract`.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportMissingTypeStubs=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
from types import FunctionType
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from stochfric_mb.compile import native
from stochfric_mb.effects.contract import Effect

_POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(_POINTER, _POINTER, _POINTER, _POINTER)


@dataclasses.dataclass(frozen=True)
class NativeEffect:
    """Addresses of an effect's C functions in this process, 0 for one that it does not have."""

    surroundings: int
    """Address of ``surroundings``."""
    friction: int
    """Address of ``friction``."""


@functools.cache
def native_effect(cls: type[Effect]) -> NativeEffect:
    """Return the C functions of an effect, compiled (or loaded from the cache) at the first call."""
    return NativeEffect(_address(cls, "surroundings"), _address(cls, "friction"))


_alive: list[Any] = []


def _address(cls: type[Effect], name: str) -> int:
    function = getattr(cls.functions(), name, None)
    if not isinstance(function, FunctionType):
        return 0
    compiled = native(function, SIGNATURE)
    _alive.append(compiled)
    return compiled.address


@intrinsic
def call_effect(typingctx, address, world, memory, rates, p):
    """Call an effect's function at ``address``; pointers are integers (``array.ctypes.data``)."""
    double = ir.DoubleType()
    function_type = ir.FunctionType(ir.VoidType(), [double.as_pointer()] * 4)

    def generate(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        function = builder.inttoptr(args[0], function_type.as_pointer())
        builder.call(function, [builder.inttoptr(a, double.as_pointer()) for a in args[1:]])
        return context.get_dummy_value()

    return types.void(*[types.intp] * 5), generate
