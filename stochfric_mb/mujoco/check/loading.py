"""A model as a user gives it: its file found and loaded, its parts named, its keyframes by name or number."""

from __future__ import annotations

import contextlib
from collections.abc import Generator
from pathlib import Path
from typing import Any

import mujoco

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mujoco.pairs import name_all
from stochfric_mb.mujoco.reading import name_in
from stochfric_mb.scenario import scenario_folders


def load(model: str | Path | mujoco.MjSpec) -> tuple[mujoco.MjSpec | None, mujoco.MjModel, frozenset[str]]:
    """Return a spec of one's own (None for a binary model), the compiled model, and the names that are not the user's.

    Raises:
        InputError: there is no such file, or MuJoCo cannot load it.
    """
    if isinstance(model, mujoco.MjSpec):
        spec, what = copied(model), "the spec"
    else:
        what = _located(Path(model))
        with _explained(f"{what} is no model that MuJoCo can load"):
            if what.suffix.lower() == ".mjb":
                return None, mujoco.MjModel.from_binary_path(str(what)), frozenset()
            spec = mujoco.MjSpec.from_file(str(what))
    parts = {"geom": spec.geoms, "joint": spec.joints, "tendon": spec.tendons}
    invented = frozenset(name for kind, elements in parts.items() for name in name_all(kind, elements))
    with _explained(f"{what} does not compile"):
        return spec, spec.compile(), invented


def copied(spec: mujoco.MjSpec) -> mujoco.MjSpec:
    """Return a copy of a spec with its plugin instances, which ``MjSpec.copy`` leaves out."""
    copy: Any = spec.copy()
    have = {p.name for p in copy.plugins}
    for plugin in spec.plugins:
        if plugin.name not in have:
            made = copy.add_plugin(name=plugin.name, plugin_name=plugin.plugin_name, active=plugin.active)
            made.config = dict(plugin.config)
            copy.activate_plugin(plugin.plugin_name)
    return copy


@contextlib.contextmanager
def _explained(what: str) -> Generator[None]:
    """Make MuJoCo's errors in one line of this package's, after ``what``."""
    try:
        yield
    except (ValueError, mujoco.FatalError) as error:
        lines = [line.strip() for line in str(error).splitlines()]
        raise InputError(f"{what}: {'; '.join(filter(None, lines))}") from None


def _located(path: Path) -> Path:
    """Return a model file, or the one that comes with the package under that name."""
    bundled = [folder / path / f"{path}.xml" for folder in scenario_folders()] if path.name == str(path) else []
    for file in (path, *bundled):
        if file.is_file():
            return file
    what = "a folder" if path.is_dir() else "no such file"
    raise InputError(f"{path}: {what}; give an MJCF (.xml), URDF or binary (.mjb) model, or a bundled one: incline, belt_box")


def keyframe_number(model: mujoco.MjModel, name: str) -> int:
    """Return the number of a keyframe given by its name or number.

    Raises:
        InputError: there is no such keyframe.
    """
    if name.isdecimal() and int(name) < model.nkey:
        return int(name)
    if not model.nkey:
        raise InputError(f"keyframe {name!r}: the model has no keyframes; leave the option out")
    known = [name_in(model, mujoco.mjtObj.mjOBJ_KEY, k) for k in range(model.nkey)]
    return known.index(require_name("keyframe", name, known))
