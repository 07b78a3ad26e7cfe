"""Registers engine plugins whose callbacks are compiled when the first model asks for them.

MuJoCo keeps a table of plugins and calls them through it. A plugin is entered with Python functions in the places that
MuJoCo calls first, while a model or its data are made; the first such call compiles all callbacks and writes their
addresses into MuJoCo's table. So importing compiles nothing, and no step ever runs Python.
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
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.engine import library as mujoco_library
from stochfric_mb.mujoco.memory.layout import Plugin

FIRST = {
    "nstate": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int),
    "nsensordata": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_int),
    "init": ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int),
}
"""Callbacks that MuJoCo calls before all others, while it makes a model or its data."""
_alive: list[Any] = []
_lock = threading.RLock()


def register_plugin(
    name: str,
    attributes: Sequence[str],
    *,
    keys: int,
    capability: int,
    callbacks: Mapping[str, tuple[Callable[..., Any], Any]],
    stage: int = 0,
) -> int:
    """Return MuJoCo's slot number of a plugin.

    Args:
        name: its name in MJCF.
        attributes: its configuration keys.
        keys: first place in `words.TABLE` for the addresses of the keys.
        capability: what the plugin does.
        callbacks: function to compile and its numba signature, by the name of the callback.
        stage: the stage that a sensor needs.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    plugin = Plugin()
    library = mujoco_library()
    library.mjp_defaultPlugin(ctypes.byref(plugin))
    texts = [ctypes.create_string_buffer(key.encode()) for key in attributes]
    for i, text in enumerate(texts):
        w.TABLE[keys + i] = ctypes.addressof(text)
    plugin.name = name.encode()
    plugin.nattribute = len(attributes)
    plugin.attributes = (ctypes.c_char_p * len(attributes))(*[key.encode() for key in attributes])
    plugin.capabilityflags = capability
    plugin.needstage = stage
    entered: list[Any] = []
    compile_all = functools.partial(_compile, entered, callbacks, {})
    for callback in FIRST.keys() & callbacks.keys():
        function = FIRST[callback](functools.partial(_call_first, compile_all, callback))
        _alive.append(function)
        setattr(plugin, callback, ctypes.cast(function, ctypes.c_void_p).value)
    _alive.extend([plugin, texts])
    library.mjp_registerPlugin.argtypes = [ctypes.c_void_p]
    slot = library.mjp_registerPlugin(ctypes.byref(plugin))
    entered.append(_entered(slot, plugin))
    return slot


def _call_first(compile_all: Callable[[], dict[str, int]], callback: str, *arguments: Any) -> int:
    """Compile the plugin's callbacks and call one; an error is printed and refuses the model."""
    try:
        return FIRST[callback](compile_all()[callback])(*arguments)
    except BaseException:
        traceback.print_exc()
        return -1


def _compile(
    entered: list[Any], callbacks: Mapping[str, tuple[Callable[..., Any], Any]], addresses: dict[str, int]
) -> dict[str, int]:
    """Return the addresses of the compiled callbacks, which MuJoCo's table holds from now on."""
    with _lock:
        if not addresses:
            made = {callback: native(function, signature) for callback, (function, signature) in callbacks.items()}
            _alive.append(made)
            for callback, function in made.items():
                setattr(entered[0], callback, function.address)
            addresses.update({callback: function.address for callback, function in made.items()})
        return addresses


def _entered(slot: int, mine: Plugin) -> Any:
    """Return MuJoCo's own copy of a plugin: `Plugin` is written by hand, and must be what the library has."""
    library = mujoco_library()
    library.mjp_getPluginAtSlot.restype = ctypes.POINTER(Plugin)
    library.mjp_getPluginAtSlot.argtypes = [ctypes.c_int]
    other = library.mjp_getPlugin
    other.restype = ctypes.POINTER(Plugin)
    other.argtypes = [ctypes.c_char_p, ctypes.POINTER(ctypes.c_int)]
    found = library.mjp_getPluginAtSlot(slot)
    same = bool(found) and all(
        getattr(found.contents, field[0]) == getattr(mine, field[0]) for field in Plugin._fields_ if field[0] != "attributes"
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
    return found.contents
