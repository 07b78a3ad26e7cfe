"""Compiling C for this machine and for others, with the compiler of the ``ziglang`` wheel."""

from __future__ import annotations

import dataclasses
import importlib.util
import platform
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from stochfric_mb.errors import InputError, MissingEngineError, SimulationError


@dataclasses.dataclass(frozen=True)
class Target:
    """A platform that binaries are made for."""

    name: str
    """Its name here and in FMI 3."""
    fmi2: str
    """Its name in FMI 2, "" where FMI 2 has none."""
    triple: str
    """The compiler's name for it: an old glibc, so that the binary loads on old systems too."""
    ending: str
    """Ending of its shared libraries."""


TARGETS = {
    t.name: t
    for t in (
        Target("x86_64-linux", "linux64", "x86_64-linux-gnu.2.17", ".so"),
        Target("aarch64-linux", "aarch64-linux", "aarch64-linux-gnu.2.17", ".so"),
        Target("x86_64-windows", "win64", "x86_64-windows-gnu", ".dll"),
        Target("x86_64-darwin", "darwin64", "x86_64-macos.11.0", ".dylib"),
        Target("aarch64-darwin", "aarch64-darwin", "aarch64-macos.11.0", ".dylib"),
    )
}
"""Name of a platform -> how it is compiled for."""
FLAGS = (
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-fno-sanitize=undefined",
    "-fvisibility=hidden",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wno-unused-function",
    "-Wno-unused-but-set-variable",
)
"""No contraction into fused operations: the same source gives the same bits everywhere but in the system's libm."""


def host() -> Target:
    """Return the platform of this machine.

    Raises:
        InputError: it is none that binaries are made for.
    """
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    system = {"linux": "linux", "win32": "windows", "darwin": "darwin"}.get(sys.platform, sys.platform)
    name = f"{machine}-{system}"
    if name not in TARGETS:
        raise InputError(f"no binaries are made for {name}; known platforms: {', '.join(TARGETS)}")
    return TARGETS[name]


def compile_library(
    sources: Sequence[Path], out: Path, target: Target, *, include: Sequence[Path] = (), flags: Sequence[str] = ()
) -> None:
    """Compile C files into a shared library.

    Args:
        sources: the C files.
        out: the library to write.
        target: what to compile for.
        include: folders of headers.
        flags: further options of the compiler.

    Raises:
        MissingEngineError: the compiler is not installed; says what to install.
        SimulationError: the compiler reports an error in the sources.
    """
    if importlib.util.find_spec("ziglang") is None:
        raise MissingEngineError(
            "compiling C needs ziglang, which is not installed; in a clone of this package run: pip install '.[fmi]'"
        )
    command = [sys.executable, "-m", "ziglang", "cc", "-target", target.triple, *FLAGS, *flags, "-shared"]
    command += ["-s"] if target.ending != ".dylib" else ["-Wl,-S"]
    command += ["-fPIC"] if target.ending != ".dll" else []
    command += [f"-I{folder}" for folder in include] + ["-o", str(out), *map(str, sources)]
    command += [f"-Wl,-install_name,@rpath/{out.name}"] if target.ending == ".dylib" else []
    command += ["-lm"] if target.ending == ".so" else []
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=out.parent)
    if done.returncode != 0:
        raise SimulationError(f"the C compiler failed for {target.name}: {done.stderr.strip()[-2000:]}")
    out.with_suffix(".pdb").unlink(missing_ok=True)
