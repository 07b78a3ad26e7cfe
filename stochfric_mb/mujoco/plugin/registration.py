"""Registers engine plugins: Python looks at a model once and compiles what then runs, and no step ever runs Python.

MuJoCo keeps a table of plugins and calls them through it. A plugin's ``nstate``, ``nsensordata`` and ``init``, which MuJoCo
calls while it makes a model or its data, are Python functions; the first such call compiles the others and writes their
addresses into MuJoCo's table. So importing compiles nothing.
"""

from __future__ import annotations

import ctypes
import functools
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import mujoco

from stochfric_mb.compile import native
from stochfric_mb.errors import MissingEngineError
from stochfric_mb.mujoco.memory.engine import library as mujoco_library
from stochfric_mb.mujoco.memory.layout import Plugin

FIRST = {
    "nstate": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int),
    "nsensordata": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_int),
    "init": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int),
}
"""Callbacks that MuJoCo calls before all others."""
_alive: list[Any] = []
_lock = threading.RLock()


def register_plugin(
    name: str,
    attributes: Sequence[str],
    *,
    capability: mujoco.mjtPluginCapabilityBit,
    first: Mapping[str, Callable[..., int]],
    compiled: Mapping[str, tuple[Callable[..., Any], Any]],
    stage: int = 0,
) -> int:
    """Return MuJoCo's slot number of a plugin.

    Args:
        name: its name in MJCF.
        attributes: its configuration keys.
        capability: what the plugin does.
        first: Python functions, some of `FIRST`; they return -1 for a model that they refuse, and an error that they raise
            is printed and refuses it too.
        compiled: function to compile and its numba signature, by the name of the callback.
        stage: the stage that a sensor needs.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    plugin = Plugin()
    library = mujoco_library()
    library.mjp_defaultPlugin(ctypes.byref(plugin))
    plugin.name = name.encode()
    plugin.nattribute = len(attributes)
    plugin.attributes = (ctypes.c_char_p * len(attributes))(*[key.encode() for key in attributes])
    plugin.capabilityflags = int(capability)
    plugin.needstage = stage
    entered: list[Any] = []
    for callback, function in first.items():
        made = FIRST[callback](functools.partial(_call, entered, compiled, function))
        _alive.append(made)
        setattr(plugin, callback, ctypes.cast(made, ctypes.c_void_p).value)
    _alive.append(plugin)
    library.mjp_registerPlugin.argtypes = [ctypes.c_void_p]
    slot = library.mjp_registerPlugin(ctypes.byref(plugin))
    entered.append(_entered(slot, plugin))
    return slot


def _call(
    entered: list[Any],
    compiled: Mapping[str, tuple[Callable[..., Any], Any]],
    function: Callable[..., int],
    *arguments: Any,
) -> int:
    """Call one of the Python functions, once MuJoCo's table holds the compiled ones."""
    try:
        with _lock:
            for callback, (source, signature) in compiled.items():
                if not getattr(entered[0], callback):
                    made = native(source, signature)
                    _alive.append(made)
                    setattr(entered[0], callback, made.address)
        return function(*arguments)
    except BaseException:
        traceback.print_exc()
        return -1


def _entered(slot: int, mine: Plugin) -> Any:
    """Return MuJoCo's own copy of a plugin: `Plugin` is written by hand, and must be what the library has."""
    library = mujoco_library()
    library.mjp_getPluginAtSlot.restype = ctypes.POINTER(Plugin)
    library.mjp_getPluginAtSlot.argtypes = [ctypes.c_int]
    other = library.mjp_getPlugin
    other.restype = ctypes.POINTER(Plugin)
    other.argtypes = [ctypes.c_char_p, ctypes.POINTER(ctypes.c_int)]
    result = library.mjp_getPluginAtSlot(slot)
    same = bool(result) and all(
        getattr(result.contents, field[0]) == getattr(mine, field[0]) for field in Plugin._fields_ if field[0] != "attributes"
    )
    bundled = other(b"mujoco.elasticity.cable", None) or other(b"mujoco.pid", None)
    if bundled:
        texts = [bundled.contents.attributes[i] for i in range(bundled.contents.nattribute)]
        same = same and all(isinstance(t, bytes) and t.isascii() for t in texts)
    if not same:
        raise MissingEngineError(
            f"MuJoCo {mujoco.__version__} does not return its plugins as this package knows them (mjpPlugin changed); "
            "install mujoco 4.0, or a newer release of this package"
        )
    return result.contents
