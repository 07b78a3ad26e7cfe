"""Configurations of the plugin: written into a model as the scenario file's own words, and read back from there.

A model carries ``law`` and ``coefficients`` as TOML keys, such as ``kind = 'elastic_stick', mu_s = 0.8, mu_k = 0.46``.
The first time a process meets a text, compiled code calls `read` here, which parses it with the scenario's parser,
loads the law's compiled functions and keeps the numbers; from then on no Python runs.
"""

# pyright: reportMissingParameterType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import tomllib
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.friction import Friction
from stochfric_mb.laws.abi import MAX_STATE, native_law
from stochfric_mb.laws.contract import Law
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.engine import plugin_text
from stochfric_mb.mujoco.memory.state import (
    MAX_PARAMETERS,
    MODES,
    N_HEADER,
    N_LIMITS,
    RESTS,
    UNSET,
    header_of,
)
from stochfric_mb.scenario import law_from_dict, process_from_dict

ATTRIBUTES = ("law", "coefficients", "geom1", "geom2", "seed", "sample", "contact", "slots", "mode")
"""Configuration keys of the plugin; geom1 is the body, geom2 the counter-surface, slots the most contacts at a time,
mode one of MODES."""

MAX_SLOTS = 1024
"""Most contacts of an instance."""
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
    slots: int = 16,
    mode: str = "auto",
) -> dict[str, str]:
    """Return the plugin's configuration as MJCF keys and values.

    Raises:
        InputError: the friction cannot run here, or an address is out of range; says why.
    """
    friction.path(seed, sample, contact)  # checks the address and the process against the law
    require_mode(friction.law, mode)
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
    }
    record_of(texts["law"], texts["coefficients"], 0)
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


def record_of(law: str, coefficients: str, key: int) -> npt.NDArray[np.float64]:
    """Return a configuration's key and the header and descriptor that its states start with.

    Raises:
        InputError: the texts are malformed, or the law cannot run in this engine.
    """
    friction = friction_of(law, coefficients)
    _require_runnable(friction.law)
    descriptor = friction.path(0).descriptor
    record = np.zeros(1 + N_HEADER + len(descriptor))
    record[0] = key
    record[1 : 1 + N_HEADER] = law_header(friction.law)
    header_of(record[1:]).n_descriptor = len(descriptor)
    record[1 + N_HEADER :] = np.nan_to_num(descriptor, posinf=NO_LIMIT, neginf=-NO_LIMIT)
    return record


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


def _read(law: bytes | None, coefficients: bytes | None, key: int) -> int:
    """Keep the numbers of a configuration under its key; return 1, or print the error and return 0."""
    record = record_of((law or b"").decode(), (coefficients or b"").decode(), key)
    _records[key] = record
    w.TABLE[w.CONFIGURATIONS + key % w.N_CONFIGURATIONS] = record.ctypes.data
    return 1


READER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int64)(_read)
"""`_read` as a C function; an exception in it is printed and 0 comes back."""


def _explain(model: int, instance: int, _: int) -> int:
    """Raise the error that says why an instance was refused; ctypes prints it, MuJoCo refuses the model."""
    texts = {key: plugin_text(model, instance, key) for key in ATTRIBUTES}
    record_of(texts["law"], texts["coefficients"], 0)
    require_mode(friction_of(texts["law"], "").law, texts["mode"] or "auto")
    for key in ("seed", "sample", "contact", "slots"):
        if texts[key] and not (texts[key].isdecimal() and int(texts[key]) < 2**32):
            raise InputError(f"plugin key {key} = {texts[key]!r} is not a whole number in [0, 2^32); write one")
    raise InputError(
        f"plugin keys geom1 = {texts['geom1']!r}, geom2 = {texts['geom2']!r}, slots = {texts['slots']!r}: the geoms must be "
        f"two of the model's (one may be '*'), and slots a number from 1 to {MAX_SLOTS}"
    )


EXPLAINER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_explain)
"""`_explain` as a C function."""


@compiled
def text_hash(address, h):
    """Return the FNV-1a hash, continued from ``h``, of the C string at ``address`` (0: an empty one), below 2^53."""
    if address != 0:
        byte = w.load_byte(address)
        while byte != 0:
            h = (h ^ byte) * 1099511628211
            address += 1
            byte = w.load_byte(address)
    return (h ^ 255) * 1099511628211


@compiled
def find_record(law, coefficients):
    """Return the address of the record of a configuration given by its two C strings, 0 if it is malformed."""
    key = text_hash(coefficients, text_hash(law, 1469598103934665603)) & 9007199254740991
    place = w.CONFIGURATIONS + key % w.N_CONFIGURATIONS
    for _ in range(2):
        address = w.entry(place)
        if address != 0 and w.load(address) == float(key):
            return address
        if w.call_python(w.entry(w.READER), law, coefficients, key) != 1:
            return 0
    return 0


@compiled
def parse_integer(address, default):
    """Return the whole number of the C string at ``address``; ``default`` for an empty one, -1 for anything else."""
    if address == 0 or w.load_byte(address) == 0:
        return default
    value = 0
    byte = w.load_byte(address)
    while byte != 0:
        if byte < 48 or byte > 57 or value > 429496729600:
            return -1
        value = 10 * value + byte - 48
        address += 1
        byte = w.load_byte(address)
    return value
