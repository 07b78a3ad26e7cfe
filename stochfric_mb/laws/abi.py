"""A law's compiled functions as C function pointers, so that one compiled law serves every compiled caller.

Signatures (all reals are C doubles; ``held``, ``state``, ``p`` and ``out`` are pointers to doubles)::

    force, commit, init, guards: void(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held, state, p, out)
    flow:                        void(vx, vy, normal_force, zx, zy, mu_s, mu_k, p, out)
    slide:                       double(speed, mu_s, mu_k, p)
    spring:                      void(normal_force, effective_mass, mu_s, p, out)

``held`` points to (effective_mass, hx, hy). So every argument travels in a register (x86-64 has eight for doubles):
processors wait for arguments that are written to the stack one by one and passed on in pairs.

The wrappers below are templates: each is bound to the law's own module (its global names and its file), so that numba
caches them beside the law. The law's function is merged into its wrapper.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
from types import FunctionType, ModuleType
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from stochfric_mb.compile import compiled_inline, native
from stochfric_mb.laws import law_class
from stochfric_mb.numerics.memory import function_at, instructions

_DOUBLE = types.float64
_POINTER = types.CPointer(types.float64)
LAW_SIGNATURE = types.void(*[_DOUBLE] * 8, *[_POINTER] * 4)
FLOW_SIGNATURE = types.void(*[_DOUBLE] * 7, _POINTER, _POINTER)
SLIDE_SIGNATURE = _DOUBLE(_DOUBLE, _DOUBLE, _DOUBLE, _POINTER)
SPRING_SIGNATURE = types.void(_DOUBLE, _DOUBLE, _DOUBLE, _POINTER, _POINTER)
MAX_STATE = 16
"""Most state entries a law may have."""


@dataclasses.dataclass(frozen=True)
class NativeLaw:
    """Addresses of a law's C functions in this process."""

    init: int
    """Address of ``init``."""
    force: int
    """Address of ``force``."""
    commit: int
    """Address of ``commit``."""
    guards: int
    """Address of ``guards``."""
    flow: int
    """Address of ``flow``, 0 where the law has none."""
    slide: int
    """Address of ``sliding_coefficient``, 0 where the law has none."""
    spring: int
    """Address of ``stick_spring``, 0 where the law has none."""
    n_state: int
    """Number of state entries (at least 1)."""


@functools.cache
def native_law(kind: str) -> NativeLaw:
    """Return the C functions of the law ``kind``, compiled (or loaded from the cache) at the first call."""
    cls = law_class(kind)
    module = cls.functions()
    functions = {
        name: _bind(template, module, LAW_SIGNATURE)
        for name, template in {"init": _init, "force": _force, "commit": _commit, "guards": _guards}.items()
    }
    flow = _bind(_flow, module, FLOW_SIGNATURE) if cls.has_flow else 0
    slide = _bind(_sliding_coefficient, module, SLIDE_SIGNATURE) if cls.rest != "bristle" else 0
    spring = _bind(_stick_spring, module, SPRING_SIGNATURE) if cls.rest == "elastic" else 0
    return NativeLaw(**functions, flow=flow, slide=slide, spring=spring, n_state=max(len(cls.state_names), 1))


_alive: list[Any] = []


def _bind(template: FunctionType, module: ModuleType, signature: Any) -> int:
    """Compile ``template`` as if it stood in ``module``; return its address."""
    name = f"native{template.__name__}"
    code = template.__code__.replace(
        co_filename=module.__file__ or template.__code__.co_filename, co_name=name, co_qualname=name
    )
    called = template.__name__.removeprefix("_")
    merged = compiled_inline(getattr(module, called).py_func)
    function = FunctionType(code, {**vars(module), called: merged}, name)
    function.__module__ = module.__name__
    function.__qualname__ = name
    compiled = native(function, signature, template=__file__)
    _alive.append(compiled)
    return compiled.address


# The names init, force, commit, guards and flow below are globals of the law's module.
# ruff: noqa: F821


def _init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held, state, p, out):
    new = init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held[0], held[1], held[2], p)  # pyright: ignore
    for i in range(len(new)):
        out[i] = new[i]


def _force(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held, state, p, out):
    out[0], out[1] = force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, held[0], held[1], held[2], p)  # pyright: ignore


def _commit(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held, state, p, out):
    new = commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, held[0], held[1], held[2], p)  # pyright: ignore
    for i in range(len(new)):
        out[i] = new[i]


def _guards(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, held, state, p, out):
    new = guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, held[0], held[1], held[2], p)  # pyright: ignore
    for i in range(len(new)):
        out[i] = new[i]


def _flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p, out):
    out[0], out[1], out[2], out[3] = flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p)  # pyright: ignore


def _sliding_coefficient(speed, mu_s, mu_k, p):
    return sliding_coefficient(speed, mu_s, mu_k, p)  # pyright: ignore


def _stick_spring(normal_force, effective_mass, mu_s, p, out):
    out[0], out[1], out[2] = stick_spring(normal_force, effective_mass, mu_s, p)  # pyright: ignore


def _with_held(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
    function = ir.FunctionType(ir.VoidType(), [ir.DoubleType()] * 8 + [ir.IntType(64)] * 4)
    held = cgutils.alloca_once(builder, ir.DoubleType(), size=3)
    for k, number in enumerate(args[9:12]):
        builder.store(number, cgutils.gep_inbounds(builder, held, k))
    place = builder.ptrtoint(held, ir.IntType(64))
    builder.call(builder.inttoptr(args[0], function.as_pointer()), [*args[1:9], place, *args[12:]])
    return context.get_dummy_value()


call_law = instructions(types.void(types.intp, *[_DOUBLE] * 11, *[types.intp] * 3), _with_held)
"""Call force, commit, init or guards of a law at an address; the arguments are t, ux, uy, vx, vy, normal_force, mu_s, mu_k,
effective_mass, hx, hy, state, p, out; pointers are integers (``array.ctypes.data``)."""
call_slide = function_at(_DOUBLE, *[_DOUBLE] * 3, types.int64)
"""Return sliding_coefficient of a law at an address, of speed, mu_s, mu_k, p."""
call_spring = function_at(types.void, *[_DOUBLE] * 3, *[types.int64] * 2)
"""Call stick_spring of a law at an address: normal_force, effective_mass, mu_s, p, out."""
call_flow = function_at(types.void, *[_DOUBLE] * 7, *[types.int64] * 2)
"""Call flow of a law at an address: vx, vy, normal_force, zx, zy, mu_s, mu_k, p, out."""
