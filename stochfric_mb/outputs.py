"""Files and folders that appear whole or not at all, and that one command writes at a time."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import tempfile
from collections.abc import Generator
from pathlib import Path

from stochfric_mb.errors import InputError

FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
"""Errors of the system that mean: no room for this file."""


def check_target(path: str | Path, *, force: bool = False, marker: str | None = None) -> Path:
    """Return ``path`` once it can be written: nothing there, or ``force``; a missing parent folder is no obstacle.

    Args:
        path: the file or folder to be written.
        force: whether what is there may be replaced.
        marker: for a folder, a file in it that shows that it was written by the same command: a folder without it is
            never replaced unless it is empty.

    Raises:
        InputError: it exists, is of the wrong kind, or its folder cannot be written.
    """
    path = Path(path)
    what = "file" if marker is None else "folder"
    if path.exists() and path.is_dir() != (marker is not None):
        raise InputError(f"{path} exists and is not a {what}; give another name")
    if path.exists() and not force:
        raise InputError(f"{path} exists; give another name, or --force to replace it")
    if marker is not None and path.exists() and any(path.iterdir()) and not (path / marker).is_file():
        raise InputError(f"{path} is a folder without {marker}: it was not written by this command and is not replaced")
    parent = next(p for p in path.absolute().parents if p.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise InputError(f"{parent} is not a folder that can be written; give another place for {path.name}")
    return path


@contextlib.contextmanager
def claimed(path: Path) -> Generator[None]:
    """Keep other commands from writing to ``path`` until the block ends; its lock file ends with the process at the latest.

    Raises:
        InputError: another command is writing to ``path``.
    """
    from filelock import FileLock, Timeout

    made = [parent for parent in path.absolute().parents if not parent.exists()]
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path.with_name(f".{path.name}.lock"), blocking=False)
    try:
        lock.acquire()
    except Timeout:
        if not Path(lock.lock_file).exists():  # nor can it be made here: not all folders take new files
            raise InputError(f"{path.parent} is not a folder that can be written; give another place for {path.name}") from None
        raise InputError(f"another command is writing to {path}; wait for it, or give another name") from None
    try:
        yield
    finally:
        Path(lock.lock_file).unlink(missing_ok=True)
        lock.release()
        with contextlib.suppress(OSError):  # a folder that holds something stays
            for parent in made:
                parent.rmdir()


@contextlib.contextmanager
def whole_file(path: Path, *, replace: bool = True) -> Generator[Path]:
    """Give a temporary file beside ``path`` that becomes ``path`` when the block ends, and vanishes when it fails.

    Args:
        path: target.
        replace: whether a file that is there by then is replaced.

    Raises:
        InputError: without ``replace``, ``path`` has appeared in the meantime.
        OSError: the disk is full; names ``path``.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".partial", dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        with _full_disk_named(path):
            yield temporary
            temporary.chmod(0o666 & ~_umask())
            _put(temporary, path, replace=replace)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


@contextlib.contextmanager
def whole_folder(path: Path, *, replace: bool = True) -> Generator[Path]:
    """Give a temporary folder beside ``path`` that becomes ``path`` when the block ends, and vanishes when it fails.

    A folder that is there already is replaced; it is put back if the replacement fails.

    Args:
        path: target.
        replace: whether a folder that is there by then is replaced.

    Raises:
        InputError: without ``replace``, ``path`` has appeared in the meantime.
        OSError: the disk is full; names ``path``.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(prefix=f".{path.name}.", suffix=".partial", dir=path.parent))
    try:
        with _full_disk_named(path):
            yield temporary
            temporary.chmod(0o777 & ~_umask())
            _swap(temporary, path, replace=replace)
    except BaseException:
        shutil.rmtree(temporary, ignore_errors=True)
        raise


@contextlib.contextmanager
def _full_disk_named(path: Path) -> Generator[None]:
    """Give the error of a full disk the name of the target: the system gives none where a write fails."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        text = f"{os.strerror(error.errno)}; nothing was written: free some space, or give another place"
        raise OSError(error.errno, text, str(path)) from error


def _put(temporary: Path, path: Path, *, replace: bool) -> None:
    """Give a finished file its name; without ``replace`` in one step that fails where the name is taken."""
    if replace:
        temporary.replace(path)
        return
    try:
        path.hardlink_to(temporary)
    except FileExistsError:
        raise _appeared(path) from None
    except OSError:  # a file system without hard links
        if path.exists():
            raise _appeared(path) from None
        temporary.replace(path)
    else:
        temporary.unlink()


def _swap(temporary: Path, path: Path, *, replace: bool) -> None:
    if not path.exists():
        temporary.rename(path)
        return
    if not replace:
        raise _appeared(path)
    old = temporary.with_suffix(".old")
    path.rename(old)
    try:
        temporary.rename(path)
    except BaseException:
        old.rename(path)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _appeared(path: Path) -> InputError:
    return InputError(f"{path} has been written by another command in the meantime, and is kept; give another name")


def _umask() -> int:
    """Return the process's file mode mask (which can only be read by setting it)."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
