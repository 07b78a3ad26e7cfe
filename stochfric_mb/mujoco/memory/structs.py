"""MuJoCo's structs by the names of their fields, laid out as the package says of itself, and checked against its bindings.

In compiled code ``model_at(address).nv`` is the C expression ``model->nv``, and in Python ``record_at(MODEL, address).nv``. A
pointer comes out as an address, for `numerics.memory.at` and `array_at`.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.introspect import ast_nodes, structs
from numba.core import types
from numba.np import numpy_support

from stochfric_mb.compile import compiled
from stochfric_mb.errors import MissingEngineError
from stochfric_mb.numerics.memory import instructions

_NUMBERS: dict[str, Any] = {
    "int": np.int32, "float": np.float32, "double": np.float64, "mjtNum": np.float64, "mjtBool": np.bool_, "mjtByte": np.uint8,
    "mjtSize": np.int64, "size_t": np.uint64, "uint64_t": np.uint64, "uintptr_t": np.uint64,
}  # fmt: skip
_MODEL = (
    "nv", "nplugin", "nsensor", "npair", "geom_bodyid", "body_rootid", "body_dofnum", "body_dofadr", "body_parentid",
    "body_invweight0", "body_subtreemass", "dof_parentid", "jnt_type", "jnt_dofadr", "jnt_qposadr", "jnt_bodyid",
    "pair_geom1", "pair_geom2", "pair_dim", "ten_J_rownnz", "ten_J_rowadr", "ten_J_colind", "plugin", "plugin_stateadr",
    "sensor_plugin", "sensor_adr", "opt.timestep", "opt.integrator", "opt.disableflags", "opt.cone", "opt.iterations",
    "opt.jacobian", "opt.solver", "opt.gravity", "nu", "actuator_biasprm", "actuator_gear",
    "actuator_acc0", "actuator_trntype", "actuator_trnid", "actuator_biastype", "dof_damping", "dof_invweight0", "opt.impratio",
    "opt.noslip_iterations", "flg_surfacevel", "M_rownnz", "M_rowadr", "M_colind",
)  # fmt: skip
_DATA = (
    "time", "ncon", "contact", "ne", "nf", "nefc", "nisland", "solver_niter", "cvel", "subtree_com", "xpos", "xmat", "xaxis",
    "cdof", "qpos", "qvel", "qacc", "qacc_warmstart", "ctrl", "qfrc_passive", "plugin_state", "plugin_data", "sensordata",
    "ten_J", "ten_length", "efc_type", "efc_id", "efc_J", "efc_J_rownnz", "efc_J_rowadr", "efc_J_colind", "efc_pos",
    "efc_margin", "efc_frictionloss", "efc_diagA", "efc_KBIP", "efc_D", "efc_R", "efc_AR", "efc_AR_rowadr", "efc_AR_colind",
    "efc_force", "map_efc2iefc", "iefc_frictionloss", "iefc_D", "iefc_R", "cfrc_int", "flg_rnepost", "qLD", "qLDiagInv",
)  # fmt: skip
_CONTACT = (
    "dist", "pos", "frame", "includemargin", "friction", "surfacevel", "solref", "solreffriction", "solimp", "mu", "dim",
    "geom", "exclude", "efc_address",
)  # fmt: skip

EULER, RUNGE_KUTTA, IMPLICIT, IMPLICITFAST, DISCRETE = range(5)
"""mjtIntegrator."""
PGS, ELLIPTIC = 0, 1
"""One of mjtSolver, one of mjtCone."""

N_BIAS, DAMPING, N_GEAR = int(mujoco.mjNBIAS), 2, 6
"""Numbers of an actuator's bias, the place of minus kv among them, numbers of its gear."""


class Plugin(ctypes.Structure):
    """``mjpPlugin``, which MuJoCo does not describe; checked by reading a plugin back (see `plugin.registration`)."""

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
def struct(name: str) -> np.dtype[Any]:
    """Return a whole MuJoCo struct such as ``mjData`` as a record."""
    return _laid_out(structs.STRUCTS[name].fields)


def _laid_out(fields: Sequence[Any]) -> np.dtype[Any]:
    return np.dtype([(field.name, _format(field.type)) for field in fields], align=True)


def _format(node: Any) -> Any:
    """Return the NumPy format of a type that MuJoCo describes."""
    if isinstance(node, ast_nodes.PointerType):
        return np.int64
    if isinstance(node, ast_nodes.ArrayType):
        return _format(node.inner_type), tuple(node.extents)
    if isinstance(node, ast_nodes.AnonymousStructDecl):
        return _laid_out(node.fields)
    if node.name in structs.STRUCTS:
        return struct(node.name)
    if node.name in _NUMBERS or node.name.startswith("mjt"):
        return _NUMBERS.get(node.name, np.int32)
    raise MissingEngineError(f"MuJoCo {mujoco.__version__} describes a type {node.name!r} that this package does not know")


def _record(name: str, fields: tuple[str, ...]) -> np.dtype[Any]:
    """Return some fields of a MuJoCo struct as a record; ``opt.timestep`` is called ``timestep``."""
    formats, offsets = list[Any](), list[int]()
    for field in fields:
        kind, place = struct(name), 0
        for part in field.split("."):
            described: Any = kind.fields
            kind, place = described[part][0], place + described[part][1]
        formats.append(kind)
        offsets.append(place)
    names = [field.split(".")[-1] for field in fields]
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": struct(name).itemsize})


def array_at(address: int, n: int, kind: Any = np.float64) -> npt.NDArray[Any]:
    """Return the ``n`` doubles, or numbers or records of another kind, at an address (a view)."""
    room: Any = ctypes.c_byte * (int(n) * np.dtype(kind).itemsize)
    return np.ndarray(int(n), kind, room.from_address(int(address)))


def record_at(kind: np.dtype[Any], address: int) -> Any:
    """Return the record of a kind at an address (a view), fields by name."""
    return array_at(address, 1, kind).view(np.recarray)[0]


def verify() -> int:
    """Return the number of fields that are equal in the derived layout and in the bindings.

    Raises:
        MissingEngineError: a field differs, so that this MuJoCo build cannot be used.
    """
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 .09'><freejoint/>"
        "<geom type='box' size='.1 .1 .1'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    equal: dict[str, bool] = {}
    for name, obj in (("mjModel", model), ("mjData", data)):
        raw = array_at(obj._address, 1, struct(name))[0]
        for field in struct(name).names or ():
            bound, mine = getattr(obj, field, None), raw[field]
            if isinstance(bound, int | float):
                equal[f"{name}.{field}"] = bool(mine == bound)
            elif isinstance(bound, np.ndarray) and bound.size and mine.ndim == 0 and mine:  # an unused array has no address
                equal[f"{name}.{field}"] = bool(mine == bound.ctypes.data)
    contacts = array_at(record_at(DATA, data._address).contact, data.ncon, struct("mjContact"))
    for field in ("pos", "frame", "surfacevel", "geom", "dist", "efc_address", "dim"):
        equal[f"mjContact.{field}"] = np.array_equal(contacts[field], getattr(data.contact, field))
    wrong = [field for field, same in equal.items() if not same]
    if wrong or len(equal) < 100 or data.ncon < 2:
        raise MissingEngineError(
            f"the layout of MuJoCo {mujoco.__version__} differs from its own description in {wrong or 'too few fields'}; "
            "install another MuJoCo build (pip install --force-reinstall mujoco) or report this version"
        )
    return len(equal)


def record_view(dtype: np.dtype[Any]) -> Any:
    """Return a function for compiled code that takes an address for a record of this kind."""
    kind: Any = numpy_support.from_dtype(dtype)

    def view(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], context.get_value_type(kind))

    return instructions(kind(types.intp), view)


MODEL, DATA, CONTACT = _record("mjModel", _MODEL), _record("mjData", _DATA), _record("mjContact", _CONTACT)
model_at, data_at, contact_record = record_view(MODEL), record_view(DATA), record_view(CONTACT)
_CONTACT_SIZE = CONTACT.itemsize


@compiled
def contact_at(data, i):
    """Return contact ``i`` of the data."""
    return contact_record(data.contact + i * _CONTACT_SIZE)
