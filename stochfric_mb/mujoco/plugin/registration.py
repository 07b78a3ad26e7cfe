"""Registers engine plugins: Python looks at a model once and compiles what then runs, and no step ever runs Python.

MuJoCo keeps a table of plugins and calls them through it. A plugin's ``nstate``, ``nsensordata`` and ``init``, which MuJoCo
calls while it makes a model or its data, are Python functions; the first such call compiles the others and writes their
addresses into MuJoCo's table. So importing compiles nothing.

What a Python function raises cannot pass through MuJoCo, which would go on with a result that is none. So a few machine
instructions stand between (`guarded`): they stop with MuJoCo's error, which says what was raised, where the user's call fails.
"""

from __future__ import annotations

import ctypes
import functools
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import llvmlite.binding
import mujoco
from numba import types

from stochfric_mb.compile import native
from stochfric_mb.errors import MissingEngineError, StochfricError
from stochfric_mb.mujoco.memory.engine import library as mujoco_library
from stochfric_mb.mujoco.memory.structs import Plugin

FIRST = {
    "nstate": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int),
    "nsensordata": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_int),
    "init": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int),
}
"""Callbacks that MuJoCo calls before all others."""
_POINTER, _INT = types.intp, types.int32
COMPILED = {
    "copy": types.void(_POINTER, _POINTER, _POINTER, _INT),
    "reset": types.void(_POINTER, _POINTER, _POINTER, _INT),
    "compute": types.void(_POINTER, _POINTER, _INT, _INT),
    "advance": types.void(_POINTER, _POINTER, _INT),
}
"""Callbacks that Python never sees."""
LONGEST = 480
"""Most characters of an error: MuJoCo's compiler keeps 500."""
GUARD = """
define i32 @guarded({parameters}) {{
  %result = call i32 inttoptr (i64 {function} to i32 ({types})*)({parameters})
  %failed = icmp slt i32 %result, 0
  br i1 %failed, label %stop, label %done
stop:
  call void (i64, ...) inttoptr (i64 {error} to void (i64, ...)*)(i64 {text})
  br label %done
done:
  ret i32 %result
}}
"""
_alive: list[Any] = []
_lock = threading.RLock()
_TABLE = ctypes.POINTER(Plugin)
_register = ctypes.CFUNCTYPE(ctypes.c_int, _TABLE)(("mjp_registerPlugin", mujoco_library()))
_at_slot = ctypes.CFUNCTYPE(_TABLE, ctypes.c_int)(("mjp_getPluginAtSlot", mujoco_library()))
_by_name = ctypes.CFUNCTYPE(_TABLE, ctypes.c_char_p, ctypes.c_void_p)(("mjp_getPlugin", mujoco_library()))


def register_plugin(
    name: str,
    attributes: Sequence[str],
    *,
    capability: mujoco.mjtPluginCapabilityBit,
    first: Mapping[str, Callable[..., int]],
    compiled: Mapping[str, Callable[..., Any]],
    stage: int = 0,
) -> int:
    """Return MuJoCo's slot number of a plugin.

    Args:
        name: its name in MJCF.
        attributes: its configuration keys.
        capability: what the plugin does.
        first: Python functions, some of `FIRST`; what they raise is MuJoCo's error where the user's call fails.
        compiled: functions to compile, some of `COMPILED`.
        stage: the stage that a sensor needs.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    keys = (ctypes.c_char_p * len(attributes))(*[key.encode() for key in attributes])
    plugin = Plugin(name.encode(), len(attributes), keys, int(capability), stage)

    def call(function: Callable[..., int], *arguments: Any) -> int:
        """Call one of the Python functions, once MuJoCo's table holds the compiled ones."""
        with _lock:
            for callback, source in compiled.items():
                if not getattr(entered, callback):
                    made = native(source, COMPILED[callback])
                    _alive.append(made)
                    setattr(entered, callback, made.address)
        return function(*arguments)

    for callback, function in first.items():
        setattr(plugin, callback, guarded(name, FIRST[callback], functools.partial(call, function)))
    _alive.append(plugin)
    slot = _register(plugin)
    entered = _entered(slot, plugin)
    return slot


def guarded(name: str, kind: Any, function: Callable[..., int]) -> int:
    """Return the address of a C function that calls a Python one, and stops with MuJoCo's error where that raises.

    Args:
        name: of the plugin, which the error says.
        kind: ctypes' type of the function; it has addresses and ints, and returns an int that is not negative.
        function: what to call; an error that is not of this package is printed as well, with the way to it.
    """
    text = ctypes.create_string_buffer(LONGEST + 1)

    def call(*arguments: Any) -> int:
        try:
            return function(*arguments)
        except BaseException as error:
            if not isinstance(error, StochfricError):
                traceback.print_exc()
            said = f"stochfric_mb: plugin {name}: {type(error).__name__}: {error}".replace("%", "%%")  # MuJoCo formats it
            text.value = said.encode("ascii", "replace")[:LONGEST].rstrip(b"%")
            return -1

    made = kind(call)
    words = ["i64" if argument is ctypes.c_void_p else "i32" for argument in kind._argtypes_]
    source = GUARD.format(
        parameters=", ".join(f"{word} %a{i}" for i, word in enumerate(words)),
        types=", ".join(words),
        function=ctypes.cast(made, ctypes.c_void_p).value,
        error=ctypes.cast(mujoco_library().mju_error, ctypes.c_void_p).value,
        text=ctypes.addressof(text),
    )
    machine = llvmlite.binding.Target.from_default_triple().create_target_machine()
    engine = llvmlite.binding.create_mcjit_compiler(llvmlite.binding.parse_assembly(source), machine)
    engine.finalize_object()
    _alive.extend([text, made, engine])
    return engine.get_function_address("guarded")


def _entered(slot: int, mine: Plugin) -> Any:
    """Return MuJoCo's own copy of a plugin: `Plugin` is written by hand, and must be what the library has."""
    result = _at_slot(slot)
    same = bool(result) and all(
        getattr(result.contents, field[0]) == getattr(mine, field[0]) for field in Plugin._fields_ if field[0] != "attributes"
    )
    bundled = _by_name(b"mujoco.elasticity.cable", None) or _by_name(b"mujoco.pid", None)
    if bundled:
        texts = [bundled.contents.attributes[i] for i in range(bundled.contents.nattribute)]
        same = same and all(isinstance(t, bytes) and t.isascii() for t in texts)
    if not same:
        raise MissingEngineError(
            f"MuJoCo {mujoco.__version__} does not return its plugins as this package knows them (mjpPlugin changed); "
            "install mujoco 4.0, or a newer release of this package"
        )
    return result.contents
