"""Addresses in this process, which compiled code finds by keys that are the same in every process.

Compiled code is cached on disk, and data are copied and pickled, pointers and all; both outlive a process. So no address may
stand in them. All addresses stand in one table, whose own place LLVM learns by its name each time that code is loaded.
"""

from __future__ import annotations

import threading
from typing import Any

import llvmlite.binding
import numpy as np
from llvmlite import ir
from numba import types

from stochfric_mb.compile import compiled
from stochfric_mb.numerics import memory as w
from stochfric_mb.numerics.memory import instructions

_SYMBOL = "stochfric_mb_mujoco_table"
_SIZE = 2**20
"""Entries, a power of 2: more than what they stand for leaves memory for. The system gives their pages as they are used."""
_entries = np.zeros((_SIZE, 2), np.int64)
"""Keys and addresses; an entry without a key is free."""
_lock = threading.Lock()
llvmlite.binding.add_symbol(_SYMBOL, _entries.ctypes.data)


def enter(key: int, address: int) -> None:
    """Let compiled code find ``address`` by ``key``, which is not 0."""
    with _lock:
        place = key % _SIZE
        while _entries[place, 0] not in (0, key):
            place = (place + 1) % _SIZE
        _entries[place, 1] = address
        _entries[place, 0] = key  # last: an entry with a key is complete


def _address(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    module = builder.module
    table = module.globals.get(_SYMBOL) or ir.GlobalVariable(module, ir.IntType(64), _SYMBOL)
    return builder.ptrtoint(table, ir.IntType(64))


_table = instructions(types.intp(), _address)


@compiled
def address_of(key):
    """Return the address that was entered with a key, 0 if none was."""
    place = key & (_SIZE - 1)
    while True:
        entry = _table() + 16 * place
        stored = w.word_at(entry, 0)
        if stored in (key, 0):
            return w.word_at(entry, 1) if stored == key else 0
        place = (place + 1) & (_SIZE - 1)
