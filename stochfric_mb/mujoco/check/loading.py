"""A model as a user gives it: its file found and loaded, its parts named, its keyframes by name or number."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mujoco

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.scenario import scenario_folders


def load(model: str | Path | mujoco.MjSpec) -> tuple[mujoco.MjSpec | None, mujoco.MjModel]:
    """Return a spec of one's own (None for a binary model) and the compiled model.

    Raises:
        InputError: there is no such file, or MuJoCo cannot load it.
    """
    if isinstance(model, mujoco.MjSpec):
        spec = copied(model)
        return spec, _compiled(spec, "the spec")
    path = _located(Path(model))
    try:
        if path.suffix.lower() == ".mjb":
            return None, mujoco.MjModel.from_binary_path(str(path))
        spec = mujoco.MjSpec.from_file(str(path))
    except (ValueError, mujoco.FatalError) as error:
        raise InputError(f"{path} is no model that MuJoCo can load: {_one_line(error)}") from None
    return spec, _compiled(spec, str(path))


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


def _located(path: Path) -> Path:
    """Return a model file, or the one that comes with the package under that name."""
    if path.is_file():
        return path
    bundled = [folder / path.name / f"{path.name}.xml" for folder in scenario_folders()] if path.name == str(path) else []
    for file in bundled:
        if file.is_file():
            return file
    what = "a folder" if path.is_dir() else "no such file"
    raise InputError(f"{path}: {what}; give an MJCF (.xml), URDF or binary (.mjb) model, or a bundled one: incline, belt_box")


def _compiled(spec: mujoco.MjSpec, what: str) -> mujoco.MjModel:
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise InputError(f"{what} does not compile: {_one_line(error)}") from None


def _one_line(error: Exception) -> str:
    return "; ".join(line.strip() for line in str(error).splitlines() if line.strip())


def name_all(spec: mujoco.MjSpec) -> frozenset[str]:
    """Give every geom, joint and tendon a name; return the names that are not the user's."""
    made: set[str] = set()
    for kind, elements in (("geom", spec.geoms), ("joint", spec.joints), ("tendon", spec.tendons)):
        taken = {e.name for e in elements}
        for element in elements:
            if not element.name:
                name = f"{kind}_{element.id}"
                while name in taken:
                    name += "_"
                element.name = name
                taken.add(name)
                made.add(name)
    return frozenset(made)


def keyframe_number(model: mujoco.MjModel, name: str) -> int:
    """Return the number of a keyframe given by its name or number.

    Raises:
        InputError: there is no such keyframe.
    """
    if name.isdecimal() and int(name) < model.nkey:
        return int(name)
    if not model.nkey:
        raise InputError(f"keyframe {name!r}: the model has no keyframes; leave the option out")
    known = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_KEY, k) or str(k) for k in range(model.nkey)]
    return known.index(require_name("keyframe", name, known))
