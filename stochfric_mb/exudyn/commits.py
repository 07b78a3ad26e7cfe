"""The PostStep function of systems with friction as compiled code, which asks Python only where there is more to do.

Exudyn passes the address of its system; a register leads from there to the contacts.
"""

from __future__ import annotations

import ctypes
import functools
import weakref
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import types

from stochfric_mb.compile import compiled, native
from stochfric_mb.exudyn import pointers
from stochfric_mb.exudyn.layout import call_at
from stochfric_mb.exudyn.stepping import advance
from stochfric_mb.numerics.memory import as_words, carray

_PYTHON, _ALWAYS, _CONTACTS, _FIRST = 0, 1, 2, 3
"""Words of a system: the function that Python answers with, whether it wants every step, the number of its contacts, and where
these begin (each its address, then the bits of its last step)."""
_CALL = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_double)


class Commits:
    """The compiled PostStep function of one system."""

    def __init__(self, owner: Any, mbs: Any) -> None:
        """Let the system ``mbs`` be known as long as ``owner`` lives."""
        self._system = pointers.system_address(mbs)
        self._words = np.zeros(_FIRST, dtype=np.int64)
        self._call: Any = None
        weakref.finalize(owner, _register().pop, self._system)

    def serve(self, contacts: Sequence[int], finish: Callable[[float, Sequence[int]], bool], *, always: bool) -> Any:
        """Return the function for the system's slot; None: the engine does not call compiled functions.

        Args:
            contacts: addresses of the contacts that it commits.
            finish: called with the time [s] and what `advance` returns for each contact, where one has anything to do.
            always: whether that is called after every step.
        """
        words = np.zeros(_FIRST + 2 * len(contacts), dtype=np.int64)
        words[_FIRST::2] = contacts
        bits = words[_FIRST + 1 :: 2]
        self._call = _CALL(lambda t: int(finish(t, bits.tolist())))
        words[[_PYTHON, _ALWAYS, _CONTACTS]] = ctypes.cast(self._call, ctypes.c_void_p).value or 0, int(always), len(contacts)
        self._words = words
        _register().put(self._system, words.ctypes.data)
        return _function()


class _Register:
    """Addresses of systems and of their words, the last one in use first."""

    def __init__(self) -> None:
        self.head = np.zeros(2, dtype=np.int64)
        """How many systems there are, and the address of their rows."""
        self._rows = np.zeros((0, 2), dtype=np.int64)

    def put(self, system: int, words: int) -> None:
        """Let a system have these words."""
        self._set(np.vstack([[[system, words]], self._rows[self._rows[:, 0] != system]]))

    def pop(self, system: int) -> None:
        """Forget a system."""
        self._set(self._rows[self._rows[:, 0] != system])

    def _set(self, rows: npt.NDArray[np.int64]) -> None:
        rows = np.ascontiguousarray(rows, dtype=np.int64)
        self.head[:] = len(rows), rows.ctypes.data
        self._rows = rows


_register = functools.cache(_Register)


def _post_step(head, system, t):
    register = carray(as_words(head), (2,))
    rows = carray(as_words(register[1]), (register[0], 2))
    for i in range(register[0]):
        if rows[i, 0] == system:
            return _commit(t, rows[i, 1])
    return 1


@compiled
def _commit(t, where):
    """Commit all contacts of the system whose words are at an address; return 0 to end the run."""
    front = carray(as_words(where), (_FIRST,))
    n, ask = front[_CONTACTS], front[_ALWAYS]
    contacts = carray(as_words(where), (_FIRST + 2 * n,))[_FIRST:]
    for i in range(n):
        contacts[2 * i + 1] = advance(t, contacts[2 * i])
        ask |= contacts[2 * i + 1]
    return call_at(front[_PYTHON], t) if ask else 1


@functools.cache
def _function() -> Any:
    """Return the function that all systems share: `_post_step` with the register's address."""
    inner = native(_post_step, types.int64(types.int64, types.int64, types.float64))
    head = _register().head.ctypes.data
    text = f"""
        define i1 @post_step(i64 %system, double %t) {{
            %go = call i64 inttoptr (i64 {inner.address} to i64 (i64, i64, double)*)(i64 {head}, i64 %system, double %t)
            %on = icmp ne i64 %go, 0
            ret i1 %on
        }}
        """
    _alive.append(inner)
    return pointers.step_function(pointers.machine_code(text, "post_step"), _in_python)


_alive: list[Any] = []


def _in_python(mbs: Any, t: float) -> bool:
    """Return what the compiled function returns, called by Python."""
    return bool(_post_step_compiled()(_register().head.ctypes.data, pointers.system_address(mbs), t))


@functools.cache
def _post_step_compiled() -> Any:
    return compiled(_post_step)
