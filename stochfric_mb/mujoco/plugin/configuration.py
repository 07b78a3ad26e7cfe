"""Configurations of the plugins: written into a model as the scenario file's own words, and read back from there.

A model carries ``law`` and ``coefficients`` as TOML keys, such as ``kind = 'elastic_stick', mu_s = 0.8, mu_k = 0.46``, and
other keys as numbers or names.
"""

from __future__ import annotations

import hashlib
import threading
import tomllib
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.friction import Friction
from stochfric_mb.laws.abi import MAX_STATE, native_law
from stochfric_mb.laws.contract import Law
from stochfric_mb.mujoco.anisotropy import ISOTROPIC, Anisotropy
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import table
from stochfric_mb.scenario import law_from_dict, process_from_dict

DEFAULT_SLOTS, MAX_SLOTS = 16, 1024
"""Contacts of an instance at a time: if nothing is said, and at most."""
UNNAMED = (
    "the model has a plugin without an instance of its own name, and MuJoCo's to_xml leaves out what comes after such a one: "
    "this friction is missing in a saved XML; write <extension><plugin ...><instance name=...> and name that instance"
)
RECORDED = ("law", "coefficients", "mode", "slots", "across", "direction", "normal_force", "radius")
"""Keys that make up a state's start; names and the address of the coefficient path do not."""
_laws: dict[int, tuple[npt.NDArray[Any], npt.NDArray[np.float64]]] = {}
_lock = threading.Lock()


class PluginWarning(UserWarning):
    """MuJoCo would save a model without its friction."""


def enter(spec: mujoco.MjSpec, plugin: str, name: str, config: Mapping[str, str]) -> None:
    """Enter an instance of one of this package's plugins into a spec; warn where MuJoCo would not save it."""
    if not all(p.name for p in spec.plugins):
        warnings.warn(UNNAMED, PluginWarning, stacklevel=4)
    made: Any = spec.add_plugin(name=name, plugin_name=plugin, active=True)
    made.config = config
    spec.activate_plugin(plugin)


def configuration(
    friction: Friction,
    *,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    slots: int = DEFAULT_SLOTS,
    mode: str = "auto",
    anisotropy: Anisotropy = ISOTROPIC,
) -> dict[str, str]:
    """Return the plugin's configuration, all but the names of its place, as MJCF keys and values.

    Raises:
        InputError: the friction cannot run here, or an address is out of range; says why.
    """
    friction.path(seed, sample, contact)  # checks the address and the process against the law
    texts = {
        "law": _inline(friction.law.to_dict()),
        "coefficients": _inline(friction.process.to_dict()) if friction.process is not None else "",
        "seed": str(int(seed)),
        "sample": str(int(sample)),
        "contact": str(int(contact)),
        "slots": str(int(slots)),
        "mode": mode,
        "across": repr(anisotropy.across) if anisotropy != ISOTROPIC else "",
        "direction": " ".join(repr(x) for x in anisotropy.direction) if anisotropy != ISOTROPIC else "",
    }
    _record(friction, texts)
    return texts


def friction_of(law: str, coefficients: str) -> Friction:
    """Return the friction that a configuration's two texts describe, or raise what a scenario file with them would raise."""
    process = process_from_dict(_parse("coefficients", coefficients), 0.0, Path()) if coefficients.strip() else None
    return Friction(law_from_dict(_parse("law", law)), process)


def _record(friction: Friction, texts: Mapping[str, str]) -> npt.NDArray[np.float64]:
    """Return the header and the descriptor that a configuration's states start with; ``friction`` is what its texts say."""
    mode = texts.get("mode") or "auto"
    _require_runnable(friction.law, mode)
    descriptor = friction.path(0).descriptor
    record = np.zeros(s.N_HEADER + len(descriptor))
    record[: s.N_HEADER] = law_header(friction.law)
    header = s.header_of(record)
    header.n_descriptor, header.n_slots = len(descriptor), 1
    header.mode = s.MODES.index("explicit" if friction.law.rest == "bristle" else mode)
    record[s.N_HEADER :] = np.nan_to_num(descriptor, posinf=s.NO_LIMIT, neginf=-s.NO_LIMIT)
    for key, field in {"normal_force": "load", "radius": "radius"}.items():
        if texts.get(key):
            header[field] = require_number(f"plugin key {key}", _number(texts[key]), above=0.0)
    if "slots" in texts:
        header.n_slots = require_slots(_number(texts["slots"] or str(DEFAULT_SLOTS)))
    anisotropy = ISOTROPIC
    if texts.get("across") or texts.get("direction"):
        direction: Any = tuple(_number(word) for word in texts.get("direction", "").split())
        anisotropy = Anisotropy(_number(texts.get("across") or "1"), direction)
    if anisotropy.across != 1.0 and header.mode == s.EXPLICIT:
        raise InputError(
            f"across = {anisotropy.across:g}: friction that differs by direction is found by MuJoCo's solver; use mode "
            f"'solver' (not {mode!r}) and a law that runs in it (law {friction.law.kind!r} has rest {friction.law.rest!r})"
        )
    header.across, header.direction[:] = anisotropy.across, anisotropy.direction
    return record


def _number(text: str) -> Any:
    """Return the number that a text stands for, or the text itself."""
    try:
        return float(text)
    except ValueError:
        return text


def require_slots(slots: Any) -> int:
    """Return a number of slots, or refuse what is no whole number or out of range."""
    if not isinstance(slots, int | float) or int(slots) != slots or not 0 < slots <= MAX_SLOTS:
        shown = f"{slots:g}" if isinstance(slots, float) else repr(slots)
        raise InputError(f"slots = {shown} must be a whole number from 1 to {MAX_SLOTS}; {DEFAULT_SLOTS} suits most pairs")
    return int(slots)


def law_of(texts: Mapping[str, str], place: tuple[int, int, int]) -> npt.NDArray[Any]:
    """Return the `memory.state.LAW` of a configuration, made once for each and kept for good.

    Args:
        texts: the plugin's keys and values, see `configuration`; seeds and names do not count.
        place: PAIR, JOINT or TENDON, and the numbers of the geoms, or twice that of the joint or tendon.
    """
    text = repr((*place, *(texts.get(name, "") for name in RECORDED)))
    key = int.from_bytes(hashlib.blake2b(text.encode(), digest_size=7).digest()) or 1
    with _lock:
        if key not in _laws:
            friction = friction_of(texts["law"], texts.get("coefficients", ""))
            start = _record(friction, texts)
            header = s.header_of(start)
            header.place, header.geom_body, header.geom_surface = place
            law = np.zeros(1, s.LAW)
            functions = native_law(friction.law.kind)
            for name in ("init", "force", "commit", "guards", "slide", "spring", "n_state"):
                law[name] = getattr(functions, name)
            law["key"], law["start"], law["n_start"] = key, start.ctypes.data, len(start)
            law["n_all"] = s.descriptor_place(header) + int(header.n_descriptor)
            _laws[key] = law, start
            table.enter(key, law.ctypes.data)
        return _laws[key][0]


def law_header(law: Law) -> npt.NDArray[np.float64]:
    """Return the numbers of a header with what a law alone decides."""
    numbers = np.zeros(s.N_HEADER)
    header = s.header_of(numbers)
    parameters = law.parameters()
    header.stick_speed, header.peak_speed = law.stick_speed, law.peak_speed
    header.has_mode, header.needs_mass = law.state_names[:1] == ("mode",), law.needs_effective_mass
    header.rest = s.RESTS.index(law.rest)
    limits = [law.step_limit(10.0**k, 1.0) for k in range(-4, s.N_LIMITS - 4)]
    header.limits[:] = np.nan_to_num(limits, posinf=s.NO_LIMIT)
    header.parameters[: len(parameters)] = parameters
    header.advanced = header.evaluated = header.path_time = s.UNSET
    header.across = 1.0
    return numbers


def _require_runnable(law: Law, mode: str) -> None:
    """Refuse a law that cannot run in this engine, or not in the mode asked for."""
    require_name("mode", mode, s.MODES)
    if len(law.parameters()) > s.MAX_PARAMETERS or len(law.state_names) > MAX_STATE:
        raise InputError(
            f"law {law.kind!r} has {len(law.parameters())} parameters and {len(law.state_names)} state entries; "
            f"at most {s.MAX_PARAMETERS} and {MAX_STATE} fit"
        )

    if law.needs_holding_force and mode == "explicit":
        raise InputError(
            f"law {law.kind!r} needs the force that would hold the contact, which the explicit mode cannot know; use mode "
            "'solver' (or 'auto'), elastic_stick, or "
            "stochfric_mb.laws.substitute.elastic_substitute(law, dt, normal_force, effective_mass)"
        )
    if law.rest == "bristle" and mode == "solver":
        raise InputError(
            f"law {law.kind!r} has a memory of its own, which MuJoCo's solver cannot take as a cap; use mode 'explicit' (or "
            "'auto') with a step below law.step_limit(...), or elastic_stick, which is elastic before it slides, too"
        )


def _parse(key: str, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads("table = {" + text + "}")["table"]
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            f"{key} = {text!r} is not a list of keys ({error}); write e.g. kind = 'havsin', mu_s = 0.8, mu_k = 0.46"
        ) from None


def _inline(table: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} = {_toml(value)}" for key, value in table.items())


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, Mapping):
        return "{" + _inline(value) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return repr(value.item() if isinstance(value, np.generic) else value)
