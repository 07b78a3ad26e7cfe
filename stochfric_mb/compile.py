"""How compiled functions are made: numba, cached on disk, with plain IEEE arithmetic.

``error_model="numpy"`` lets loops vectorise; ``fastmath`` is never used, so that the same source gives the same
bits wherever it is inlined. The cache lives beside the sources, or in the user's cache folder when the package
folder is read-only; where neither can be written, compilation still works and is repeated in each process.

numba itself takes a cached function as valid while its own file is unchanged. Here it is valid while that file and
all those it imports from this package are (`sources`); code of other versions is removed when new code is written.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
# (numba is not typed)

from __future__ import annotations

import contextlib
import functools
import glob
import importlib.metadata
import inspect
import os
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba import types
from numba.core import sigutils
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.ccallback import CFunc
from numba.core.registry import CPUDispatcher

from stochfric_mb.linking import Part, StoredPart
from stochfric_mb.sources import source_stamp


def compiled(function: Callable[..., Any], *, parts: str = "") -> Any:
    """Return ``function`` as a cached numba dispatcher (compiled at its first call, never at import).

    Args:
        function: what to compile.
        parts: file whose compiled functions a nested function holds: its stored code is named after that file, and
            valid while that file is.
    """
    return _Function(function, targetoptions=_OPTIONS, parts=parts)


def compiled_inline(function: Callable[..., Any], *, parts: str = "") -> Any:
    """Return ``function`` as `compiled` does, but merged into its compiled callers, so that their loops can vectorise."""
    return _Function(function, targetoptions={**_OPTIONS, "forceinline": True}, parts=parts)


def native(function: Callable[..., Any], signature: Any, *, template: str = "") -> Any:
    """Return ``function`` compiled now as a C function; ``.address`` is its pointer.

    Args:
        function: what to compile.
        signature: its numba signature.
        template: file that the function's text stands in, where that is not the file of its module.
    """
    made = CFunc(function, sigutils.normalize_signature(signature), locals={}, options={"error_model": "numpy"})
    made._cache = _cache(function, template=template)  # pyright: ignore[reportAttributeAccessIssue]
    made.compile()
    return made


_OPTIONS = {"nopython": True, "error_model": "numpy", "nogil": True}


class _Called(CPUDispatcher):
    """A function as compiled callers see it.

    It has no wrappers for Python and C, no machine code of its own, and one version serves all the constants that are
    passed: all three save much compilation.
    """

    def __init__(self, function: Callable[..., Any], options: dict[str, Any], parts: str) -> None:
        bare = {**options, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        super().__init__(function, targetoptions=bare, pipeline_class=Part)
        self._cache = _cache(function, parts=parts, variant="merged" if options.get("forceinline") else "called")

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return numba's template of the call, with constants taken as any values of their types."""
        return super().get_call_template([types.unliteral(a) for a in args], {k: types.unliteral(v) for k, v in kws.items()})


class _Function(CPUDispatcher):
    """A function as Python sees it; compiled callers get it as `_Called`."""

    def __init__(
        self,
        py_func: Callable[..., Any],
        locals: Any = None,  # noqa: A002
        targetoptions: Any = None,
        parts: str = "",
    ) -> None:
        self._called = _Called(py_func, targetoptions, parts)
        super().__init__(py_func, locals, targetoptions)
        self._cache = _cache(py_func, parts=parts)

    @property
    def _numba_type_(self) -> Any:
        return self._called._numba_type_

    @property
    def _type(self) -> Any:
        """What numba enters as the type of this global name; the type that it would write here is never used."""
        return self._called._numba_type_

    @_type.setter
    def _type(self, value: Any) -> None:
        pass


def _cache(function: Callable[..., Any], *, template: str = "", parts: str = "", variant: str = "") -> _SourceCache:
    """Return the function's cache, in a temporary folder if neither the package nor the user's folder can be written."""
    try:
        return _SourceCache(function, template, parts, variant)
    except RuntimeError:
        user = os.getuid() if hasattr(os, "getuid") else "cache"
        numba.config.CACHE_DIR = str(Path(tempfile.gettempdir()) / f"stochfric_mb-{user}")  # type: ignore[attr-defined]
        return _SourceCache(function, template, parts, variant)


class _SourceCache(FunctionCache):
    """numba's cache of one function, in files whose names carry the stamp of all sources that it is made of."""

    def __init__(self, function: Callable[..., Any], template: str, parts: str, variant: str) -> None:
        super().__init__(function)
        if variant:
            self._impl = StoredPart(function)
        file = inspect.getfile(function)
        stamp = source_stamp(*(name for name in (file, template, parts) if name)) + _engine_version(file)
        owner = f"{Path(parts).stem}." if parts else ""
        self._base, self._short = owner + self._impl.filename_base, f"{stamp[:14]}{zlib.crc32(stamp.encode()) & 255:02x}"
        self._cache_file = _StoredCode(self._cache_path, f"{self._base}.{self._short}{variant}", stamp)
        self._tidy, self._stamped = False, bool(parts)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        """Return the key of a compiled version; of a nested function with ``parts`` without what it holds, which they stamp."""
        return (sig, codegen.magic_tuple()) if self._stamped else super()._index_key(sig, codegen)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the stored code, None if there is none that can be read: half written, or removed by another process."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # pickles of half a file raise what they like
            with contextlib.suppress(OSError):
                self.flush()
            return None

    def _save_overload(self, sig: Any, data: Any) -> None:
        with contextlib.suppress(OSError):  # a full disk, say: it is compiled again in the next process
            super()._save_overload(sig, data)
        if not self._tidy:
            self._tidy = True
            _remove_others(Path(self._cache_path), self._base, self._short)


class _StoredCode(IndexDataCacheFile):
    """An index and its files; each file is named after what it holds.

    numba numbers them, so that two processes that store two versions at once can give both the same name.
    """

    def save(self, key: Any, data: Any) -> None:
        """Store the code of the version ``key``."""
        name = self._data_name(zlib.crc32(repr(key).encode()))
        self._save_data(name, data)
        self._save_index({**self._load_index(), key: name})


def _engine_version(file: str) -> str:
    """Return the version of MuJoCo for code of its room, which holds the layout of MuJoCo's structs; "" for other code."""
    return _version("mujoco") if "mujoco" in Path(file).parts else ""


_version = functools.cache(importlib.metadata.version)


def _remove_others(folder: Path, base: str, stamp: str) -> None:
    """Remove the compiled code of other versions of a function, wherever it stood in its file (``name-LINE.pyXY``)."""
    name, _, rest = base.rpartition("-")
    python = rest.partition(".")[2]
    for path in folder.glob(f"{glob.escape(name)}-*.{python}*.nb[ic]"):
        line, _, tail = path.name[len(name) + 1 :].partition(".")
        if line.isdecimal() and not tail.startswith(f"{python}.{stamp}"):
            with contextlib.suppress(OSError):
                path.unlink()
