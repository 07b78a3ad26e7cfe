"""Calls of the engine's own functions by their addresses, for compiled code."""

from __future__ import annotations

from numba import types

from stochfric_mb.numerics.memory import function_at

call_handler = function_at(types.void, *[types.int64] * 3)
"""Call the collision callback at an address: void(arbiter, space, data)."""
get_double = function_at(types.float64, types.int64)
"""Return what the getter at an address says of a pointer, a double."""
get_int = function_at(types.uint32, types.int64)
"""The same, an unsigned int."""
get_word = function_at(types.int64, types.int64)
"""The same, a word."""
get_byte = function_at(types.uint8, types.int64)
"""The same, a byte."""
