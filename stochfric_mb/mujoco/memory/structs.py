"""MuJoCo's structs as compiled code reads them: named fields at the offsets that MuJoCo gives of itself.

``model_at(address).nv`` is the C expression ``model->nv``; a pointer comes out as an address, for `words.at`.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numba.core import types
from numba.np import numpy_support

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.memory import layout
from stochfric_mb.numerics.memory import instructions

_MODEL = (
    "nv", "nplugin", "nsensor", "npair", "geom_bodyid", "body_rootid", "body_dofnum", "body_dofadr", "body_parentid",
    "body_invweight0", "body_subtreemass", "dof_parentid", "jnt_type", "jnt_dofadr", "jnt_qposadr", "jnt_bodyid",
    "pair_geom1", "pair_geom2", "pair_dim", "ten_J_rownnz", "ten_J_rowadr", "ten_J_colind", "plugin", "plugin_stateadr",
    "sensor_plugin", "sensor_adr", "opt.timestep", "opt.integrator", "opt.disableflags", "opt.cone", "opt.iterations",
    "opt.jacobian", "opt.solver", "opt.gravity", "nu", "actuator_biasprm", "actuator_gear",
    "actuator_acc0", "dof_damping", "dof_invweight0", "opt.impratio", "opt.noslip_iterations", "flg_surfacevel",
)  # fmt: skip
_DATA = (
    "time", "ncon", "contact", "nefc", "nisland", "solver_niter", "cvel", "subtree_com", "xpos", "xmat", "xaxis", "cdof",
    "qpos", "qvel", "qacc", "qacc_warmstart", "ctrl", "qfrc_passive", "plugin_state", "plugin_data", "sensordata", "ten_J",
    "ten_length", "efc_type", "efc_id", "efc_J", "efc_J_rownnz", "efc_J_rowadr", "efc_J_colind", "efc_pos", "efc_margin",
    "efc_frictionloss", "efc_diagA", "efc_KBIP", "efc_D", "efc_R", "efc_aref", "efc_force", "map_efc2iefc",
    "iefc_frictionloss", "iefc_D", "iefc_R", "cfrc_int",
)  # fmt: skip
_CONTACT = (
    "dist", "pos", "frame", "includemargin", "friction", "surfacevel", "solref", "solreffriction", "solimp", "mu", "dim",
    "geom", "exclude", "efc_address",
)  # fmt: skip

EULER, RUNGE_KUTTA, IMPLICIT, IMPLICITFAST, DISCRETE = range(5)
"""mjtIntegrator."""
PGS, ELLIPTIC = 0, 1
"""One of mjtSolver, one of mjtCone."""


def _format(kind: Any) -> Any:
    """Return the NumPy format of a ctypes field."""
    if kind is ctypes.c_void_p:
        return np.int64
    if hasattr(kind, "_length_"):
        inner = _format(kind._type_)
        return (inner[0], (kind._length_, *inner[1])) if isinstance(inner, tuple) else (inner, (kind._length_,))
    return np.dtype(kind).type


def _record(name: str, fields: tuple[str, ...]) -> np.dtype[Any]:
    """Return some fields of a MuJoCo struct as a record; ``opt.timestep`` is called ``timestep``."""
    return np.dtype(
        {
            "names": [field.split(".")[-1] for field in fields],
            "formats": [_format(layout.kind(name, field)) for field in fields],
            "offsets": [layout.offset(name, field) for field in fields],
            "itemsize": ctypes.sizeof(layout.struct(name)),
        }
    )


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
