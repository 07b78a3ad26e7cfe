"""Which source files a function is made of: its own module's and all that it imports from this package.

Compiled code holds the functions that it calls, so it is out of date as soon as any of these files changes.
"""

from __future__ import annotations

import functools
import hashlib
import re
from pathlib import Path

_ROOT = Path(__file__).parent
_IMPORT = re.compile(rf"^(?:from ({_ROOT.name}[\w.]*) import (\([^)]*\)|[^\n#]*)|import ({_ROOT.name}[\w.]*))", re.MULTILINE)


@functools.cache
def source_stamp(*files: str) -> str:
    """Return a hash of the contents of ``files`` and of all files of this package that they import, directly or not.

    Only imports at the top of a module count: compiled code sees no others. A file that cannot be read counts as empty.
    """
    seen: dict[str, bytes] = {}
    waiting = list(files)
    while waiting:
        file = waiting.pop()
        if file not in seen:
            seen[file], imports = _read(file)
            waiting.extend(imports)
    return hashlib.sha256(b"".join(sorted(seen.values()))).hexdigest()


@functools.cache
def _read(file: str) -> tuple[bytes, frozenset[str]]:
    """Return the hash of a file's content and the files of this package that it imports."""
    try:
        content = Path(file).read_bytes()
    except OSError:
        content = b""
    imports: set[str] = set()
    for module, names, plain in _IMPORT.findall(content.decode("utf-8", "replace")):
        imports.add(_file_of(plain))
        for name in re.findall(r"\w+", re.sub(r"#.*|\bas\s+\w+", "", names)):
            imports.add(_file_of(f"{module}.{name}") or _file_of(module))
    return hashlib.sha256(content).digest(), frozenset(imports - {""})


@functools.cache
def _file_of(module: str) -> str:
    """Return the file of a module of this package, "" if there is none of that name (a function, say)."""
    path = _ROOT.joinpath(*module.split(".")[1:])
    for file in (path.with_name(path.name + ".py"), path / "__init__.py"):
        if module and file.is_file():
            return str(file)
    return ""
