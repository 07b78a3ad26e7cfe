"""How compiled functions are made: numba, cached on disk, with plain IEEE arithmetic.

``error_model="numpy"`` lets loops vectorise; ``fastmath`` is never used, so that the same source gives the same
bits wherever it is inlined. The cache lives beside the sources, or in the user's cache folder when the package
folder is read-only; where neither can be written, compilation still works and is repeated in each process.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba


def compiled(function: Callable[..., Any]) -> Any:
    """Return ``function`` as a cached numba dispatcher (compiled at its first call, never at import)."""
    return numba.njit(cache=True, error_model="numpy", nogil=True)(_with_cache_folder(function))


def compiled_inline(function: Callable[..., Any]) -> Any:
    """Return ``function`` as `compiled` does, but merged into its compiled callers, so that their loops can vectorise."""
    return numba.njit(cache=True, error_model="numpy", nogil=True, forceinline=True)(_with_cache_folder(function))


def inlined(function: Callable[..., Any]) -> Any:
    """Return ``function`` as a numba dispatcher that is pasted into the functions that call it."""
    return numba.njit(inline="always", error_model="numpy", nogil=True)(function)


def native(function: Callable[..., Any], signature: Any) -> Any:
    """Return ``function`` compiled now as a C function; ``.address`` is its pointer."""
    return numba.cfunc(signature, cache=True, error_model="numpy")(_with_cache_folder(function))


def _with_cache_folder(function: Callable[..., Any]) -> Callable[..., Any]:
    """Point numba at a temporary folder when neither the package nor the user's cache folder can be written."""
    if numba.config.CACHE_DIR:  # type: ignore[attr-defined]
        return function
    from numba.core.caching import FunctionCache

    try:
        FunctionCache(function)
    except RuntimeError:
        user = os.getuid() if hasattr(os, "getuid") else "cache"
        folder = Path(tempfile.gettempdir()) / f"stochfric_mb-{user}"
        numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
    return function
