"""An effect's functions as C function pointers: one compiled solver serves all effects, a user's own included.

Signature: void(world, memory, rates, p), four pointers to doubles; see `stochfric_mb.effects.contract`.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
from types import FunctionType
from typing import Any

from numba import types

from stochfric_mb.compile import native
from stochfric_mb.effects.contract import Effect
from stochfric_mb.numerics.memory import function_at

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


call_effect = function_at(types.void, *[types.int64] * 4)
"""Call an effect's function at an address: world, memory, rates, p; pointers are integers (``array.ctypes.data``)."""
