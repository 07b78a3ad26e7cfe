"""User functions of Exudyn that are compiled code, called by their addresses, so that no Python runs in a step.

pybind11, with which Exudyn is made, turns a Python callable into a C++ function. Where the callable is one of its own plain
functions with the very type that is wanted, it takes the function's address instead. Such a callable is made here for a
compiled function. What tells pybind11 that a callable is its own is private to it, so nothing is assumed: the place of each
entry is looked up in a function of Exudyn's own, and a small system must show that the address is called. Where it is not
(other builds, systems other than Linux) Python functions call the same compiled code.
"""

from __future__ import annotations

import ctypes
import functools
import platform
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import exudyn
import llvmlite.binding as llvm
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    MarkerNodePosition,
    Mass1D,
    MassPoint,
    Node1D,
    NodePoint,
    NodePointGround,
    ObjectGround,
)
from numba import types

from stochfric_mb.compile import native
from stochfric_mb.exudyn.contact_force import load_force, plane_pull, pull
from stochfric_mb.numerics.memory import carray, store_word

LINE, LOAD, STEP = b"PFdRK10MainSystemdidddddE", b"PFdRK10MainSystemddE", b"PFbRK10MainSystemdE"
PLANE = b"PFSt5arrayIdLm3EERK10MainSystemdiS0_S0_S0_S0_S0_E"
"""Types of user functions as C++ names them: connectors along a line or about an axis, loads on a coordinate, steps, and
connectors between positions."""
_SYSTEM_AT = 2
"""Word of a Python system with the address of the engine's."""
_KNOWN, _KNOWN_TYPE = "Help", b"PFvvE"
"""A function of Exudyn's own, and its type."""
_WORD, _RECORD = 8, 24
"""Bytes of a word, and words of pybind11's record of a function that are looked at."""
_ADDRESS, _TYPE = 7, 8
"""Words of the record with the function's address and the address of its type."""
_VARIABLE_ARGUMENTS = 1
_PYTHON = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.py_object, ctypes.py_object)
_LINE_SIGNATURE = types.float64(types.intp, types.float64, types.int32, *[types.float64] * 5)
_LOAD_SIGNATURE = types.float64(types.intp, types.float64, types.float64)
_VECTOR = types.CPointer(types.float64)
_PLANE_SIGNATURE = types.void(types.float64, _VECTOR, _VECTOR, types.float64, _VECTOR)
_alive: list[Any] = []


class _MethodDef(ctypes.Structure):
    _fields_ = (("name", ctypes.c_char_p), ("call", ctypes.c_void_p), ("flags", ctypes.c_int), ("doc", ctypes.c_char_p))


def route() -> str:
    """Return how the functions below are called: "compiled", by their addresses, or "Python"."""
    return "compiled" if calls_addresses() else "Python"


def line_function() -> Any:
    """Return the user function of connectors along a line whose ``stiffness`` is the address of a contact."""
    return _compiled_line() if calls_addresses() else _line_in_python


def plane_function() -> Any:
    """Return the user function of connectors between positions whose first ``stiffness`` is the address of a contact."""
    return _compiled_plane() if calls_addresses() else _plane_in_python


def load_function() -> Any:
    """Return the user function of loads on a coordinate whose ``load`` is the address of a contact."""
    return _compiled_load() if calls_addresses() else _load_in_python


def step_function(address: int, python: Callable[..., bool]) -> Any:
    """Return the function around steps that is compiled at an address; None: not here."""
    return _callable(STEP, address, python) if calls_addresses() else None


def system_address(mbs: Any) -> int:
    """Return the address by which compiled functions know a system."""
    return int((ctypes.c_uint64 * (_SYSTEM_AT + 1)).from_address(id(mbs))[_SYSTEM_AT])


def machine_code(text: str, name: str) -> int:
    """Return the address of a function of that name in LLVM's language."""
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(text), llvm.Target.from_default_triple().create_target_machine())
    engine.finalize_object()
    _alive.append(engine)
    return engine.get_function_address(name)


def _line(mbs, t, item, displacement, velocity, where, damping, offset):
    return pull(t, displacement, velocity, int(where))


def _line_in_python(mbs: Any, t: float, item: Any, displacement: float, velocity: float, where: float, *_: Any) -> float:
    return pull(t, displacement, velocity, int(where))


def _load(mbs, t, where):
    return load_force(t, int(where))


def _load_in_python(mbs: Any, t: float, load: float) -> float:
    return load_force(t, int(load))


def _plane(t, displacement, velocity, where, out):
    d, v, f = carray(displacement, (3,)), carray(velocity, (3,)), carray(out, (3,))
    plane_pull(t, d, v, int(where), f)


def _plane_in_python(mbs: Any, t: float, item: Any, displacement: Any, velocity: Any, stiffness: Any, *_: Any) -> Any:
    out = np.empty(3)
    plane_pull(t, np.array(displacement), np.array(velocity), int(stiffness[0]), out)
    return out


@functools.cache
def _compiled_line() -> Any:
    function = native(_line, _LINE_SIGNATURE)
    _alive.append(function)
    return _callable(LINE, function.address, _line_in_python)


@functools.cache
def _compiled_load() -> Any:
    function = native(_load, _LOAD_SIGNATURE)
    _alive.append(function)
    return _callable(LOAD, function.address, _load_in_python)


@functools.cache
def _compiled_plane() -> Any:
    function = native(_plane, _PLANE_SIGNATURE)
    _alive.append(function)
    return _callable(PLANE, _passing_vectors(function.address), _plane_in_python)


def _passing_vectors(address: int) -> int:
    """Return the address of a connector's function that hands its vectors, which C++ passes by value, to the one at an address.

    That one takes the time, pointers to displacement and velocity, the first stiffness, and a pointer for the outcome.
    """
    vectors = ", ".join(f"[3 x double]* byval([3 x double]) align 8 %v{i}" for i in range(5))
    return machine_code(
        f"""
        define void @plane(
            [3 x double]* noalias sret([3 x double]) align 8 %out, i64 %system, double %t, i32 %item, {vectors}) {{
            %d = bitcast [3 x double]* %v0 to double*
            %w = bitcast [3 x double]* %v1 to double*
            %k = bitcast [3 x double]* %v2 to double*
            %f = bitcast [3 x double]* %out to double*
            %where = load double, double* %k
            call void inttoptr (i64 {address} to void (double, double*, double*, double, double*)*)(
                double %t, double* %d, double* %w, double %where, double* %f)
            ret void
        }}
        """,
        "plane",
    )


@functools.cache
def calls_addresses() -> bool:
    """Return whether Exudyn takes the addresses of functions: tried on a mass with a spring and a load, and on a point.

    How vectors are handed over is that of x86-64.
    """
    known_machine = sys.platform.startswith("linux") and platform.machine() == "x86_64"
    if not known_machine or _own_record() is None:
        return False
    called: list[str] = []

    def python(*_: Any) -> Any:
        called.append("by Python")
        return 0.0

    return _takes_numbers(python) and not called and _takes_vectors(lambda *_: [python()] * 3) and not called


def _takes_numbers(python: Callable[..., Any]) -> bool:
    probes = native(_probe_line, _LINE_SIGNATURE), native(_probe_load, _LOAD_SIGNATURE)
    spring, load = (_callable(kind, probe.address, python) for kind, probe in zip((LINE, LOAD), probes, strict=True))
    seen = ctypes.c_int64()
    mbs: Any = exudyn.SystemContainer().AddSystem()
    node: Any = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=1.0))
    ground_node: Any = mbs.AddNode(NodePointGround())
    ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground_node, coordinate=0))
    slide: Any = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    item: Any = mbs.AddObject(
        CoordinateSpringDamper(
            markerNumbers=[ground, slide], stiffness=3.0, damping=ctypes.addressof(seen), springForceUserFunction=spring
        )
    )
    mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=7.0, loadUserFunction=load))
    mbs.Assemble()
    mbs.systemData.SetODE2Coordinates([2.0])
    force = float(mbs.GetObjectOutput(item, exudyn.OutputVariableType.Force))
    settings = exudyn.SimulationSettings()
    settings.solution.file.write, settings.timeIntegration.verboseMode = False, 0
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 1, 1.0
    mbs.systemData.SetODE2Coordinates([0.0])
    solver = exudyn.DynamicSolverType.ExplicitEuler
    mbs.SolveDynamic(settings, solverType=solver, showHints=False)
    known = force == 6.0 and seen.value == system_address(mbs)
    return known and float(mbs.systemData.GetODE2Coordinates_t()[0]) == 7.0


def _takes_vectors(python: Callable[..., Any]) -> bool:
    probe = native(_probe_plane, _PLANE_SIGNATURE)
    function = _callable(PLANE, _passing_vectors(probe.address), python)
    mbs: Any = exudyn.SystemContainer().AddSystem()
    ground: Any = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    node: Any = mbs.AddNode(NodePoint())
    point: Any = mbs.AddMarker(MarkerNodePosition(nodeNumber=node))
    mbs.AddObject(MassPoint(nodeNumber=node, mass=1.0))
    item: Any = mbs.AddObject(
        CartesianSpringDamper(markerNumbers=[ground, point], stiffness=[3.0, 0.0, 0.0], springForceUserFunction=function)
    )
    mbs.Assemble()
    mbs.systemData.SetODE2Coordinates([1.0, 2.0, 4.0])
    mbs.systemData.SetODE2Coordinates_t([10.0, 20.0, 40.0])
    return list(mbs.GetObjectOutput(item, exudyn.OutputVariableType.Force)) == [13.0, 26.0, 52.0]


def _probe_line(mbs, t, item, displacement, velocity, stiffness, damping, offset):
    store_word(int(damping), mbs)
    return stiffness * displacement


def _probe_load(mbs, t, load):
    return load


def _probe_plane(t, displacement, velocity, where, out):
    d, v, f = carray(displacement, (3,)), carray(velocity, (3,)), carray(out, (3,))
    for i in range(3):
        f[i] = where * d[i] + v[i]


def _callable(kind: bytes, address: int, python: Callable[..., Any]) -> Any:
    """Return a callable that pybind11 takes for the plain function at an address; called from Python it runs ``python``."""
    known = getattr(exudyn, _KNOWN).__self__
    words = (ctypes.c_uint64 * _RECORD).from_buffer_copy(_memory(_pointer(known), _WORD * _RECORD))
    name, method = ctypes.create_string_buffer(kind), _PYTHON(lambda _, arguments: python(*arguments))
    type_info = (ctypes.c_uint64 * 2)(0, ctypes.addressof(name))
    words[_ADDRESS], words[_TYPE] = address, ctypes.addressof(type_info)
    definition = _MethodDef(b"compiled", ctypes.cast(method, ctypes.c_void_p).value, _VARIABLE_ARGUMENTS, None)
    new_capsule = ctypes.pythonapi.PyCapsule_New
    new_capsule.restype, new_capsule.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    new_function = ctypes.pythonapi.PyCFunction_NewEx
    new_function.restype, new_function.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.py_object, ctypes.c_void_p]
    capsule = new_capsule(ctypes.addressof(words), _capsule_name(known), None)
    _alive.append((words, name, type_info, definition, method, capsule))
    return new_function(ctypes.addressof(definition), capsule, None)


def _own_record() -> bytes | None:
    """Return pybind11's record of a function of Exudyn's own, or None where its entries stand elsewhere than known here."""
    try:
        record = _memory(_pointer(getattr(exudyn, _KNOWN).__self__), _WORD * _RECORD)
        type_info = _memory(_word(record, _TYPE), 2 * _WORD)
        same = _memory(_word(type_info, 1), len(_KNOWN_TYPE) + 1) == _KNOWN_TYPE + b"\0"
    except (AttributeError, OSError, TypeError, ValueError, OverflowError):
        return None
    return record if same else None


def _word(data: bytes, i: int) -> int:
    return int.from_bytes(data[_WORD * i : _WORD * (i + 1)], sys.byteorder)


def _memory(address: int, size: int) -> bytes:
    """Return what stands in this process's memory; an address that is none raises OSError."""
    with Path("/proc/self/mem").open("rb", buffering=0) as memory:
        memory.seek(address)
        return memory.read(size)


def _capsule_name(capsule: Any) -> int | None:
    get = ctypes.pythonapi.PyCapsule_GetName
    get.restype, get.argtypes = ctypes.c_void_p, [ctypes.py_object]
    return get(capsule)


def _pointer(capsule: Any) -> int:
    get = ctypes.pythonapi.PyCapsule_GetPointer
    get.restype, get.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_void_p]
    return int(get(capsule, _capsule_name(capsule)))
