"""Configurations of the plugins: written into a model as the scenario file's own words, and read back from there.

A model carries ``law`` and ``coefficients`` as TOML keys, such as ``kind = 'elastic_stick', mu_s = 0.8, mu_k = 0.46``, and
other keys as numbers or names. `reader` makes the functions with which compiled code has them read (`instance.record_of`).
"""

# pyright: reportMissingParameterType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import tomllib
import zlib
from collections.abc import Callable, Mapping, Sequence
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
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.engine import library, plugin_text
from stochfric_mb.mujoco.memory.state import MAX_PARAMETERS, MODES, N_HEADER, N_LIMITS, RESTS, UNSET, header_of
from stochfric_mb.scenario import law_from_dict, process_from_dict

DEFAULT_SLOTS, MAX_SLOTS = 16, 1024
"""Contacts of an instance at a time: if nothing is said, and at most."""
NO_LIMIT = 1.0e300
"""Stands for infinity in states, which engines and rollouts expect to be finite."""
_records: dict[int, npt.NDArray[np.float64]] = {}


def configuration(
    friction: Friction,
    body: str,
    surface: str,
    *,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
    slots: int = DEFAULT_SLOTS,
    mode: str = "auto",
    anisotropy: Anisotropy = ISOTROPIC,
) -> dict[str, str]:
    """Return the plugin's configuration as MJCF keys and values.

    Raises:
        InputError: the friction cannot run here, or an address is out of range; says why.
    """
    friction.path(seed, sample, contact)  # checks the address and the process against the law
    texts = {
        "law": _inline(friction.law.to_dict()),
        "coefficients": _inline(friction.process.to_dict()) if friction.process is not None else "",
        "geom1": body,
        "geom2": surface,
        "seed": str(int(seed)),
        "sample": str(int(sample)),
        "contact": str(int(contact)),
        "slots": str(int(slots)),
        "mode": mode,
        "across": repr(anisotropy.across) if anisotropy != ISOTROPIC else "",
        "direction": " ".join(repr(x) for x in anisotropy.direction) if anisotropy != ISOTROPIC else "",
    }
    record_of(texts)
    return texts


def friction_of(law: str, coefficients: str) -> Friction:
    """Return the friction that a configuration's two texts describe.

    Raises:
        InputError: unknown or missing key or value, with the same message as for a scenario file.
    """
    table = _parse("law", law)
    made = law_from_dict(table)
    process = process_from_dict(_parse("coefficients", coefficients), 0.0, Path()) if coefficients.strip() else None
    return Friction(made, process)


def record_of(texts: Mapping[str, str]) -> npt.NDArray[np.float64]:
    """Return the header and the descriptor that the states of a configuration start with.

    Args:
        texts: the plugin's keys and values; those left out are as if empty.

    Raises:
        InputError: a text is malformed, or the law cannot run in this engine, this mode or with this anisotropy.
    """
    friction = friction_of(texts["law"], texts.get("coefficients", ""))
    mode = texts.get("mode") or "auto"
    _require_runnable(friction.law)
    require_mode(friction.law, mode)
    descriptor = friction.path(0).descriptor
    record = np.zeros(N_HEADER + len(descriptor))
    record[:N_HEADER] = law_header(friction.law)
    header = header_of(record)
    header.n_descriptor, header.mode, header.n_slots = len(descriptor), MODES.index(mode), 1
    record[N_HEADER:] = np.nan_to_num(descriptor, posinf=NO_LIMIT, neginf=-NO_LIMIT)
    for key, field in {"normal_force": "load", "radius": "radius"}.items():
        if texts.get(key):
            header[field] = require_number(f"plugin key {key}", _number(texts[key]), above=0.0)
    if "slots" in texts:
        header.n_slots = require_slots(_number(texts["slots"] or str(DEFAULT_SLOTS)))
    anisotropy = _anisotropy(texts.get("across", ""), texts.get("direction", ""))
    if anisotropy.across != 1.0 and (mode == "explicit" or friction.law.rest == "bristle"):
        raise InputError(
            f"across = {anisotropy.across:g}: friction that differs by direction is found by MuJoCo's solver; use mode "
            "'solver' "
            f"(not {mode!r}) and a law that runs in it (law {friction.law.kind!r} has rest {friction.law.rest!r})"
        )
    header.across, header.direction[:] = anisotropy.across, anisotropy.direction
    return record


def _anisotropy(across: str, direction: str) -> Anisotropy:
    if not across and not direction:
        return ISOTROPIC
    numbers = [_number(word) for word in direction.split()]
    return Anisotropy(_number(across or "1"), tuple(numbers))  # type: ignore[arg-type]


def _number(text: str) -> Any:
    """Return the number that a text stands for, or the text itself."""
    try:
        return float(text)
    except ValueError:
        return text


def require_slots(slots: Any) -> int:
    """Return a number of slots.

    Raises:
        InputError: it is no whole number, or out of range.
    """
    if not isinstance(slots, int | float) or int(slots) != slots or not 0 < slots <= MAX_SLOTS:
        shown = f"{slots:g}" if isinstance(slots, float) else repr(slots)
        raise InputError(f"slots = {shown} must be a whole number from 1 to {MAX_SLOTS}; {DEFAULT_SLOTS} suits most pairs")
    return int(slots)


def law_header(law: Law) -> npt.NDArray[np.float64]:
    """Return the numbers of a header with what a law alone decides; the law's functions are in the table from now on."""
    numbers = np.zeros(N_HEADER)
    header = header_of(numbers)
    parameters = law.parameters()
    header.law, header.n_parameters = load_law(law.kind), len(parameters)
    header.stick_speed, header.peak_speed = law.stick_speed, law.peak_speed
    header.has_mode, header.needs_mass = law.state_names[:1] == ("mode",), law.needs_effective_mass
    header.rest = RESTS.index(law.rest)
    limits = [law.step_limit(10.0**k, 1.0) for k in range(-4, N_LIMITS - 4)]
    header.limits[:] = np.nan_to_num(limits, posinf=NO_LIMIT)
    header.parameters[: len(parameters)] = parameters
    header.advanced = header.evaluated = header.path_time = UNSET
    header.across = 1.0
    return numbers


def load_law(kind: str) -> int:
    """Return the identifier of a law (from its name alone, so that states travel), its functions in the table."""
    identifier = zlib.crc32(kind.encode()) or 1
    for probe in range(w.N_LAWS):
        place = w.LAW_ROWS + w.LAW_WIDTH * ((identifier + probe) % w.N_LAWS)
        if w.TABLE[place] == identifier:
            return identifier
        if w.TABLE[place] == 0:
            f = native_law(kind)
            words = [f.init, f.force, f.commit, f.guards, f.slide, f.spring, f.n_state]
            w.TABLE[place + 1 : place + w.LAW_WIDTH] = words
            w.TABLE[place] = identifier  # last: a row with an identifier is complete
            return identifier
    raise InputError(f"law {kind!r} is one too many: MuJoCo's table holds {w.N_LAWS}; use fewer laws in one process")


def _require_runnable(law: Law) -> None:
    if len(law.parameters()) > MAX_PARAMETERS or len(law.state_names) > MAX_STATE:
        raise InputError(
            f"law {law.kind!r} has {len(law.parameters())} parameters and {len(law.state_names)} state entries; "
            f"at most {MAX_PARAMETERS} and {MAX_STATE} fit"
        )


def require_mode(law: Law, mode: str) -> None:
    """Refuse a law that cannot run in the mode asked for.

    Raises:
        InputError: says why.
    """
    if mode == "implicit":
        raise InputError(
            "mode 'implicit' is no more: mode 'solver' lets MuJoCo's own solver find the friction; use that, or 'auto'"
        )
    require_name("mode", mode, MODES)
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


def reader(attributes: Sequence[str], require_place: Callable[[int, Mapping[str, str]], None]) -> Any:
    """Return the C function with which compiled code has an instance of a plugin read; its errors are printed.

    Args:
        attributes: the plugin's configuration keys.
        require_place: called with the model's address and the texts, refuses names that the model does not have.
    """

    def read(model: int, instance: int, key: int) -> int:
        texts = {name: plugin_text(model, instance, name) for name in attributes}
        record = record_of(texts)
        for name in ("seed", "sample", "contact"):
            if texts[name] and not (texts[name].isdecimal() and int(texts[name]) < 2**32):
                raise InputError(f"plugin key {name} = {texts[name]!r} is not a whole number in [0, 2^32); write one")
        require_place(model, texts)
        kept = np.concatenate([[float(key)], record])
        _records[key] = kept
        w.TABLE[w.CONFIGURATIONS + key % w.N_CONFIGURATIONS] = kept.ctypes.data
        return 1

    return ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(read)


def id_in(model: int, kind: mujoco.mjtObj, name: str) -> int:
    """Return the id of an object in the model at an address, -1 if there is none of that name."""
    function = library().mj_name2id
    function.restype, function.argtypes = ctypes.c_int, [ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p]
    return int(function(model, int(kind), name.encode()))
