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
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.numerics.memory import instructions

_SYMBOL = "stochfric_mb_mujoco_table"
_place = np.zeros(1, np.int64)
_addresses: dict[int, int] = {}
_tables = [np.array([256, *[0] * 512])]
"""The table in use, last, and smaller ones that threads may still be reading: a power of 2, then that many keys and addresses
by turns."""
_lock = threading.Lock()
_place[0] = _tables[0].ctypes.data
llvmlite.binding.add_symbol(_SYMBOL, _place.ctypes.data)


def enter(key: int, address: int) -> None:
    """Let compiled code find ``address`` by ``key``, which is not 0."""
    with _lock:
        _addresses[key] = address
        if 2 * len(_addresses) <= _tables[-1][0]:
            _put(_tables[-1], key, address)
            return
        size = 2 * int(_tables[-1][0])
        table = np.zeros(1 + 2 * size, np.int64)
        table[0] = size
        for known in _addresses.items():
            _put(table, *known)
        _tables.append(table)
        _place[0] = table.ctypes.data


def _put(table: Any, key: int, address: int) -> None:
    size = int(table[0])
    place = key & (size - 1)
    while table[1 + 2 * place] not in (0, key):
        place = (place + 1) & (size - 1)
    table[2 + 2 * place] = address
    table[1 + 2 * place] = key  # last: an entry with a key is complete


def _load(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    module = builder.module
    return builder.load(module.globals.get(_SYMBOL) or ir.GlobalVariable(module, ir.IntType(64), _SYMBOL))


_table = instructions(types.intp(), _load)


@compiled
def address_of(key):
    """Return the address that was entered with a key, 0 if none was."""
    table = _table()
    size = w.word_at(table, 0)
    place = key & (size - 1)
    while True:
        found = w.word_at(table, 1 + 2 * place)
        if found in (key, 0):
            return w.word_at(table, 2 + 2 * place) if found == key else 0
        place = (place + 1) & (size - 1)
