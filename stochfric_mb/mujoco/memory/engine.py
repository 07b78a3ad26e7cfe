"""MuJoCo's shared library: the functions that compiled code calls, and what Python asks it."""

from __future__ import annotations

import ctypes
import functools
from pathlib import Path
from typing import Any

import llvmlite.binding
import mujoco
from numba import types

from stochfric_mb.errors import MissingEngineError

_I32, _I64, _F64 = types.int32, types.intp, types.float64


@functools.cache
def library() -> ctypes.CDLL:
    """Return MuJoCo's shared library, the one that the package itself has loaded.

    Raises:
        MissingEngineError: the package holds no such library.
    """
    folder = Path(mujoco.__file__).parent
    for pattern in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll"):
        for path in sorted(folder.glob(pattern)):
            return ctypes.CDLL(str(path))
    raise MissingEngineError(f"no MuJoCo library in {folder}; install the mujoco package from PyPI: pip install mujoco")


def _external(name: str, result: Any, *arguments: Any) -> Any:
    """Return a C function of the library for compiled code; LLVM resolves its name when cached code is loaded."""
    address = ctypes.cast(getattr(library(), name), ctypes.c_void_p).value
    llvmlite.binding.add_symbol(name, address)
    return types.ExternalFunction(name, result(*arguments))


mj_solveM = _external("mj_solveM", types.void, _I64, _I64, _I64, _I64, _I32)  # noqa: N816
mj_getPluginConfig = _external("mj_getPluginConfig", _I64, _I64, _I32, _I64)  # noqa: N816
mj_forward = _external("mj_forward", types.void, _I64, _I64)
mj_step = _external("mj_step", types.void, _I64, _I64)
mj_rnePostConstraint = _external("mj_rnePostConstraint", types.void, _I64, _I64)  # noqa: N816
mju_error = _external("mju_error", types.void, _I64)
mju_warning = _external("mju_warning", types.void, _I64)


_text = ctypes.CFUNCTYPE(ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p)(("mj_getPluginConfig", library()))
_number = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p)(("mj_name2id", library()))


def plugin_text(model: int, instance: int, key: str) -> str:
    """Return a configuration value of a plugin instance of the model at an address, "" if there is none."""
    return (_text(model, instance, key.encode()) or b"").decode()


def id_in(model: int, kind: mujoco.mjtObj, name: str, default: int) -> int:
    """Return the id of an object in the model at an address, ``default`` if there is none of that name."""
    number = _number(model, int(kind), name.encode())
    return number if number >= 0 else default
