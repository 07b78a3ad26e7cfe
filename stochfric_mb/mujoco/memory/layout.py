"""Layouts of MuJoCo's C structs, built from what the package says of itself and checked against its own bindings."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.introspect import ast_nodes, enums, structs

from stochfric_mb.errors import MissingEngineError

_BASE: dict[str, Any] = {
    "int": ctypes.c_int,
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "char": ctypes.c_char,
    "unsigned char": ctypes.c_ubyte,
    "unsigned int": ctypes.c_uint,
    "unsigned short": ctypes.c_ushort,
    "mjtNum": ctypes.c_double,
    "mjtByte": ctypes.c_ubyte,
    "mjtBool": ctypes.c_bool,
    "mjtSize": ctypes.c_int64,
    "size_t": ctypes.c_size_t,
    "uintptr_t": ctypes.c_void_p,
    "int64_t": ctypes.c_int64,
    "uint64_t": ctypes.c_uint64,
    "uint32_t": ctypes.c_uint32,
    "uint16_t": ctypes.c_uint16,
}
_SCALARS = (ctypes.c_int, ctypes.c_int64, ctypes.c_uint64, ctypes.c_double, ctypes.c_bool)


class Plugin(ctypes.Structure):
    """``mjpPlugin``, which MuJoCo does not describe; checked by reading a plugin back (see `plugin.register`)."""

    _fields_ = [
        ("name", ctypes.c_char_p),
        ("nattribute", ctypes.c_int),
        ("attributes", ctypes.POINTER(ctypes.c_char_p)),
        ("capabilityflags", ctypes.c_int),
        ("needstage", ctypes.c_int),
        *(
            (name, ctypes.c_void_p)
            for name in (
                "nstate", "nsensordata", "init", "destroy", "copy", "reset", "compute", "advance", "visualize",
                "actuator_act_dot", "sdf_distance", "sdf_gradient", "sdf_staticdistance", "sdf_attribute", "sdf_aabb",
            )
        ),
    ]  # fmt: skip


@functools.cache
def struct(name: str) -> Any:
    """Return the ctypes structure of a MuJoCo struct such as ``mjData``."""
    return _structure(name, structs.STRUCTS[name].fields, ctypes.Structure)


def offset(name: str, field: str) -> int:
    """Return the offset [byte] of a field; ``opt.timestep`` reaches into nested structs."""
    return _place(name, field)[0]


def kind(name: str, field: str) -> Any:
    """Return the ctypes type of a field."""
    return _place(name, field)[1]


def _place(name: str, field: str) -> tuple[int, Any]:
    base, inner = 0, struct(name)
    for part in field.split("."):
        base += getattr(inner, part).offset
        inner = {f[0]: f[1] for f in inner._fields_}[part]
    return base, inner


def view(obj: mujoco.MjModel | mujoco.MjData) -> Any:
    """Return the C struct behind a model or data object."""
    return struct("mjModel" if isinstance(obj, mujoco.MjModel) else "mjData").from_address(obj._address)


def integers(address: int, n: int) -> npt.NDArray[np.int32]:
    """Return the ``n`` C ints at an address (a view)."""
    return np.ctypeslib.as_array((ctypes.c_int32 * n).from_address(address)) if n else np.zeros(0, np.int32)


def doubles(address: int, n: int) -> npt.NDArray[np.float64]:
    """Return the ``n`` doubles at an address (a view)."""
    return np.ctypeslib.as_array((ctypes.c_double * n).from_address(address)) if n else np.zeros(0)


def pointers(address: int, n: int) -> npt.NDArray[np.int64]:
    """Return the ``n`` pointers at an address (a view)."""
    return np.ctypeslib.as_array((ctypes.c_int64 * n).from_address(address))


def verify() -> int:
    """Return the number of fields found equal through the derived layout and through the bindings.

    Raises:
        MissingEngineError: a field differs, so that this MuJoCo build cannot be used.
    """
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .09'><freejoint/>"
        "<geom type='box' size='.1 .1 .1'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    checked, wrong = 0, list[str]()
    for obj in (model, data):
        for field, equal in _compared(obj):
            checked += 1
            if not equal:
                wrong.append(f"{type(obj).__name__}.{field}")
    size = ctypes.sizeof(struct("mjContact"))
    for i in range(data.ncon):
        raw = struct("mjContact").from_address(view(data).contact + i * size)
        bound = data.contact[i]
        for field in ("pos", "frame", "surfacevel", "geom", "dist", "efc_address", "dim"):
            checked += 1
            if not np.array_equal(np.array(getattr(raw, field)), np.array(getattr(bound, field))):
                wrong.append(f"mjContact.{field}")
    if wrong or checked < 100 or data.ncon < 2:
        raise MissingEngineError(
            f"the layout of MuJoCo {mujoco.__version__} differs from its own description in {wrong or 'too few fields'}; "
            "install another MuJoCo build (pip install --force-reinstall mujoco) or report this version"
        )
    return checked


def _compared(obj: Any) -> list[tuple[str, bool]]:
    raw = view(obj)
    out: list[tuple[str, bool]] = []
    for field, kind in raw._fields_:
        bound = getattr(obj, field, None)
        if kind in _SCALARS and isinstance(bound, int | float):
            out.append((field, getattr(raw, field) == bound))
        elif kind is ctypes.c_void_p and isinstance(bound, np.ndarray) and bound.size and getattr(raw, field):
            out.append((field, getattr(raw, field) == bound.ctypes.data))  # arrays not in use here have no address
    return out


def _structure(name: str, fields: Sequence[Any], base: Any) -> Any:
    members = [(getattr(f, "name", None) or f"_anonymous{i}", _ctype(getattr(f, "type", f))) for i, f in enumerate(fields)]
    return type(name, (base,), {"_fields_": members})


def _ctype(node: Any) -> Any:
    if isinstance(node, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(node, ast_nodes.ArrayType):
        kind = _ctype(node.inner_type)
        for extent in reversed(node.extents):
            kind = kind * (extent if isinstance(extent, int) else getattr(mujoco, extent))
        return kind
    if isinstance(node, ast_nodes.AnonymousUnionDecl):
        return _structure("union", node.fields, ctypes.Union)
    if isinstance(node, ast_nodes.AnonymousStructDecl | ast_nodes.StructDecl):
        return _structure("struct", node.fields, ctypes.Structure)
    return _value(node.name.replace("const ", "").replace("struct ", "").rstrip("_").strip())


def _value(name: str) -> Any:
    if name in _BASE:
        return _BASE[name]
    if "(*)" in name:
        return ctypes.c_void_p
    if name in structs.STRUCTS:
        return struct(name)
    if name in enums.ENUMS or name.startswith("mjt"):
        return ctypes.c_int
    raise MissingEngineError(f"MuJoCo {mujoco.__version__} describes a type {name!r} that this package does not know")
