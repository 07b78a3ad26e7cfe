"""User functions of Exudyn that are compiled code, called by their addresses: neither Python nor expressions in a step.

pybind11, with which Exudyn is made, turns a Python callable into a C++ function. Where the callable is one of its own plain
functions with the very type that is wanted, it takes the function's address instead. Such a callable is made here for a
compiled function. What tells pybind11 that a callable is its own is private to it, so nothing is assumed: the place of each
entry is looked up in a function of Exudyn's own, and a small system must show that the address is called. Where it is not
(other builds, systems other than Linux) the functions here return None, and symbolic or Python functions serve.
"""

from __future__ import annotations

import ctypes
import functools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import exudyn
from exudyn.itemInterface import CoordinateSpringDamper, LoadCoordinate, MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround
from numba import types

from stochfric_mb.compile import native
from stochfric_mb.exudyn.contact_force import load_force, pull
from stochfric_mb.exudyn.layout import put_word

LINE, LOAD, STEP = b"PFdRK10MainSystemdidddddE", b"PFdRK10MainSystemddE", b"PFbRK10MainSystemdE"
"""Types of user functions as C++ names them: connectors along a line or about an axis, loads on a coordinate, steps."""
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
_alive: list[Any] = []


class _MethodDef(ctypes.Structure):
    _fields_ = (("name", ctypes.c_char_p), ("call", ctypes.c_void_p), ("flags", ctypes.c_int), ("doc", ctypes.c_char_p))


@functools.cache
def line_function() -> Any:
    """Return the user function of connectors along a line whose ``stiffness`` is the address of a contact; None: not here."""
    return _checked(LINE, native(_line, _LINE_SIGNATURE), line_in_python)


def line_in_python(mbs: Any, t: float, item: Any, displacement: float, velocity: float, where: float, *_: Any) -> float:
    """Return the same as `line_function` gives, called by Python."""
    return pull(t, displacement, velocity, int(where))


@functools.cache
def load_function() -> Any:
    """Return the user function of loads on a coordinate whose ``load`` is the address of a contact; None: not here."""
    return _checked(LOAD, native(_load, _LOAD_SIGNATURE), load_in_python)


def load_in_python(mbs: Any, t: float, load: float) -> float:
    """Return the same as `load_function` gives, called by Python."""
    return load_force(t, int(load))


def step_function(address: int, python: Callable[..., bool]) -> Any:
    """Return the function around steps that is compiled at an address; None: not here."""
    return _callable(STEP, address, python) if _calls_addresses() else None


def system_address(mbs: Any) -> int:
    """Return the address by which compiled functions know a system."""
    return int((ctypes.c_uint64 * (_SYSTEM_AT + 1)).from_address(id(mbs))[_SYSTEM_AT])


def _line(mbs, t, item, displacement, velocity, where, damping, offset):
    return pull(t, displacement, velocity, int(where))


def _load(mbs, t, where):
    return load_force(t, int(where))


def _checked(kind: bytes, function: Any, python: Callable[..., float]) -> Any:
    """Return a callable for a compiled function, or None where Exudyn would not call its address."""
    _alive.append(function)
    return _callable(kind, function.address, python) if _calls_addresses() else None


@functools.cache
def _calls_addresses() -> bool:
    """Return whether Exudyn takes the addresses of functions: tried on a mass with a spring and a load."""
    if not sys.platform.startswith("linux") or _own_record() is None:
        return False
    called: list[str] = []

    def python(*_: Any) -> float:
        called.append("by Python")
        return 0.0

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
    return known and float(mbs.systemData.GetODE2Coordinates_t()[0]) == 7.0 and not called


def _probe_line(mbs, t, item, displacement, velocity, stiffness, damping, offset):
    put_word(int(damping), mbs)  # pyright: ignore[reportCallIssue]
    return stiffness * displacement


def _probe_load(mbs, t, load):
    return load


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
