"""Work on several cores within one process, for what compiled code does: it lets other threads run."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Made = TypeVar("Made")

CORES = os.cpu_count() or 1
"""Cores of the machine, and threads."""


def in_threads(function: Callable[[Item], Made], items: Iterable[Item]) -> list[Made]:
    """Return what a function makes of each item, in their order; the function must not call this itself."""
    return list(_pool().map(function, items))


@functools.cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(CORES, thread_name_prefix="discovery")
