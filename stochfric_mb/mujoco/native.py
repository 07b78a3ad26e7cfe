"""MuJoCo's C interface for compiled code: memory access, functions, and the table that holds what changes per process.

Compiled code is cached on disk and outlives a process, so nothing in it may depend on an address or on the MuJoCo
version. All of that stands in one table whose address LLVM learns by its name each time the code is loaded:
``TABLE`` (64-bit words) holds the address of the Python function that reads configurations, the struct offsets, the
rows of the laws (identifier, init, force, commit, guards, length of a state) and the addresses of the configurations read
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
from pathlib import Path
from typing import Any

import llvmlite.binding
import mujoco
from llvmlite import ir
from numba import carray, types  # pyright: ignore[reportPrivateImportUsage]
from numba.core import cgutils
from numba.extending import intrinsic

from stochfric_mb.compile import compiled
from stochfric_mb.errors import MissingEngineError
from stochfric_mb.mujoco import layout

FIELDS = (
    ("mjModel", "opt.timestep"),
    ("mjModel", "nv"),
    ("mjModel", "geom_bodyid"),
    ("mjModel", "body_rootid"),
    ("mjModel", "plugin_stateadr"),
    ("mjData", "time"),
    ("mjData", "ncon"),
    ("mjData", "contact"),
    ("mjData", "cvel"),
    ("mjData", "subtree_com"),
    ("mjData", "xpos"),
    ("mjData", "xmat"),
    ("mjData", "qpos"),
    ("mjData", "qvel"),
    ("mjData", "ctrl"),
    ("mjData", "qfrc_passive"),
    ("mjData", "qacc_warmstart"),
    ("mjData", "plugin_state"),
    ("mjData", "efc_J"),
    ("mjData", "efc_J_rownnz"),
    ("mjData", "efc_J_rowadr"),
    ("mjData", "efc_J_colind"),
    ("mjData", "efc_D"),
    ("mjData", "efc_pos"),
    ("mjData", "efc_margin"),
    ("mjData", "efc_KBIP"),
    ("mjContact", "geom"),
    ("mjContact", "pos"),
    ("mjContact", "frame"),
    ("mjContact", "surfacevel"),
    ("mjContact", "efc_address"),
)
"""Struct fields that compiled code reads; the constants below are their places in the table, in this order."""
(
    M_TIMESTEP, M_NV, M_GEOM_BODY, M_BODY_ROOT, M_STATE_ADDRESS,
    D_TIME, D_NCON, D_CONTACT, D_CVEL, D_SUBTREE_COM, D_XPOS, D_XMAT, D_QPOS, D_QVEL, D_CTRL, D_QFRC_PASSIVE,
    D_WARMSTART, D_PLUGIN_STATE, D_EFC_J, D_EFC_NNZ, D_EFC_ADDRESS, D_EFC_COLUMN, D_EFC_D, D_EFC_POS, D_EFC_MARGIN,
    D_EFC_KBIP, C_GEOM, C_POS, C_FRAME, C_SURFACEVEL, C_EFC,
) = range(1, 32)  # fmt: skip
CONTACT_SIZE = 32
"""Place of sizeof(mjContact) in the table."""
READER, EXPLAINER = 0, 48
"""Places of the addresses of the Python functions that read a configuration and say what is wrong with one."""
LAW_ROWS, LAW_WIDTH, N_LAWS = 64, 6, 256
"""First place, width and number of the law rows."""
INIT, FORCE, COMMIT, GUARD, N_STATE = 8, 16, 24, 32, 40
"""Where a law's functions and the number of its state's entries stand in its row [byte]; its identifier stands first."""
CONFIGURATIONS, N_CONFIGURATIONS = LAW_ROWS + LAW_WIDTH * N_LAWS, 4096
"""First place and number of the configuration addresses, by hash."""
FURTHER_FIELDS = (
    ("mjModel", "opt.integrator"),
    ("mjModel", "nplugin"),
    ("mjModel", "plugin"),
    ("mjModel", "jnt_dofadr"),
    ("mjModel", "jnt_qposadr"),
    ("mjModel", "dof_treeid"),
    ("mjModel", "ten_J_rownnz"),
    ("mjModel", "ten_J_rowadr"),
    ("mjModel", "ten_J_colind"),
    ("mjData", "tree_asleep"),
    ("mjData", "ten_J"),
    ("mjData", "ten_length"),
    ("mjData", "nefc"),
    ("mjData", "qacc"),
    ("mjData", "qfrc_bias"),
    ("mjModel", "nu"),
    ("mjData", "qfrc_actuator"),
    ("mjModel", "jnt_type"),
    ("mjData", "efc_state"),
    ("mjModel", "nsensor"),
    ("mjModel", "sensor_plugin"),
    ("mjModel", "sensor_adr"),
    ("mjData", "sensordata"),
    ("mjModel", "signature"),
    ("mjModel", "geom_condim"),
    ("mjModel", "body_dofnum"),
    ("mjModel", "body_dofadr"),
    ("mjModel", "body_parentid"),
    ("mjModel", "dof_parentid"),
    ("mjData", "cdof"),
    ("mjData", "efc_force"),
    ("mjContact", "dim"),
)
"""More struct fields, for joints, tendons and the callback; the constants below are their places in the table."""
FURTHER = CONFIGURATIONS + N_CONFIGURATIONS
(
    M_INTEGRATOR, M_NPLUGIN, M_PLUGIN, M_JOINT_DOF, M_JOINT_QPOS, M_DOF_TREE, M_TENDON_NNZ, M_TENDON_ADDRESS,
    M_TENDON_COLUMN, D_TREE_ASLEEP, D_TENDON_J, D_TENDON_LENGTH, D_NEFC, D_QACC, D_QFRC_BIAS, M_NU, D_QFRC_ACTUATOR,
    M_JOINT_TYPE, D_ROW_STATE, M_NSENSOR, M_SENSOR_PLUGIN, M_SENSOR_ADDRESS, D_SENSORDATA,
    M_SIGNATURE, M_GEOM_CONDIM, M_BODY_DOFS, M_BODY_DOF, M_BODY_PARENT, M_DOF_PARENT, D_CDOF, D_EFC_FORCE, C_DIM,
) = range(FURTHER, FURTHER + 32)  # fmt: skip
JOINTS_SLOT, CALLBACK_BEFORE, CALLBACK_ROWS, CALLBACK_SOLVER, CALLBACK_MESSAGE = range(FURTHER + 32, FURTHER + 37)
"""MuJoCo's number of the joints' plugin; the callback installed before, the friction contexts' rows, their implicit mode's
solution, and what is said of copies."""
SOLVER_FIELDS = (
    ("mjModel", "opt.solver"),
    ("mjModel", "opt.noslip_iterations"),
    ("mjModel", "opt.disableflags"),
    ("mjModel", "dof_damping"),
    ("mjData", "efc_type"),
    ("mjData", "efc_state"),
    ("mjData", "efc_aref"),
    ("mjData", "efc_AR"),
    ("mjContact", "dist"),
)
"""Struct fields of the implicit mode, and how far apart surfaces are; the constants below are their places in the table."""
KEYS, N_KEYS = FURTHER + 64, 16
"""First place and number of the addresses of the configuration keys, in the order of `config.ATTRIBUTES`."""
(
    M_SOLVER, M_NOSLIP, M_DISABLE, M_DAMPING, D_EFC_TYPE, D_EFC_STATE, D_EFC_AREF, D_EFC_AR, C_DISTANCE,
) = range(KEYS + N_KEYS, KEYS + N_KEYS + 9)  # fmt: skip
SOLVER, PREPARER, OPTIONS_CHECKER, NO_PASSIVE_MESSAGE = range(KEYS + N_KEYS + 9, KEYS + N_KEYS + 13)
"""Places of the addresses of the implicit mode's solution, once it is compiled, and of two Python functions: the one that
compiles it, and the one that looks at a model's options; and of what is said where passive forces are off."""
TABLE: Any = (ctypes.c_int64 * (KEYS + 64))()
"""What compiled code must look up in this process."""

_TABLE_SYMBOL = "stochfric_mb_mujoco_table"
_I32, _I64, _F64 = types.int32, types.intp, types.float64


@functools.cache
def library() -> ctypes.CDLL:
    """Return MuJoCo's shared library, the one that the package itself has loaded.

    Raises:
        MissingEngineError: the package holds no such library.
    """
    folder = Path(mujoco.__file__).parent
    for pattern in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll"):
        for path in sorted(folder.glob(pattern)):
            return ctypes.CDLL(str(path))
    raise MissingEngineError(f"no MuJoCo library in {folder}; install the mujoco package from PyPI: pip install mujoco")


def _external(name: str, result: Any, *arguments: Any) -> Any:
    """Return a C function of the library for compiled code; LLVM resolves its name when cached code is loaded."""
    address = ctypes.cast(getattr(library(), name), ctypes.c_void_p).value
    llvmlite.binding.add_symbol(name, address)
    return types.ExternalFunction(name, result(*arguments))


mj_applyFT = _external("mj_applyFT", types.void, _I64, _I64, _I64, _I64, _I64, _I32, _I64)  # noqa: N816
mj_contactForce = _external("mj_contactForce", types.void, _I64, _I64, _I32, _I64)  # noqa: N816
mj_solveM = _external("mj_solveM", types.void, _I64, _I64, _I64, _I64, _I32)  # noqa: N816
mj_isSparse = _external("mj_isSparse", _I32, _I64)  # noqa: N816
mj_getPluginConfig = _external("mj_getPluginConfig", _I64, _I64, _I32, _I64)  # noqa: N816
mj_name2id = _external("mj_name2id", _I32, _I64, _I32, _I64)
mj_fullM = _external("mj_fullM", types.void, _I64, _I64, _I64)  # noqa: N816
mj_mulM = _external("mj_mulM", types.void, _I64, _I64, _I64, _I64)  # noqa: N816
mj_mulJacVec = _external("mj_mulJacVec", types.void, _I64, _I64, _I64, _I64)  # noqa: N816
mj_projectConstraint = _external("mj_projectConstraint", types.void, _I64, _I64)  # noqa: N816
mj_warning = _external("mj_warning", types.void, _I64, _I32, _I32)
mj_forward = _external("mj_forward", types.void, _I64, _I64)
mj_step = _external("mj_step", types.void, _I64, _I64)
mj_fwdActuation = _external("mj_fwdActuation", types.void, _I64, _I64)  # noqa: N816
mj_fwdAcceleration = _external("mj_fwdAcceleration", types.void, _I64, _I64)  # noqa: N816
mj_fwdConstraint = _external("mj_fwdConstraint", types.void, _I64, _I64)  # noqa: N816
mj_referenceConstraint = _external("mj_referenceConstraint", types.void, _I64, _I64)  # noqa: N816
mj_rne = _external("mj_rne", types.void, _I64, _I64, _I32, _I64)
mj_markStack = _external("mj_markStack", types.void, _I64)  # noqa: N816
mj_freeStack = _external("mj_freeStack", types.void, _I64)  # noqa: N816
mj_stackAllocNum = _external("mj_stackAllocNum", _I64, _I64, _I64)  # noqa: N816
mju_error = _external("mju_error", types.void, _I64)


def fill_table() -> None:
    """Check the struct layouts and write them into the table.

    Raises:
        MissingEngineError: a layout is not what MuJoCo says it is.
    """
    layout.verify()
    llvmlite.binding.add_symbol(_TABLE_SYMBOL, ctypes.addressof(TABLE))
    for place, (name, field) in enumerate(FIELDS, start=1):
        TABLE[place] = layout.offset(name, field)
    for place, (name, field) in enumerate(FURTHER_FIELDS, start=FURTHER):
        TABLE[place] = layout.offset(name, field)
    for place, (name, field) in enumerate(SOLVER_FIELDS, start=M_SOLVER):
        TABLE[place] = layout.offset(name, field)
    TABLE[CONTACT_SIZE] = ctypes.sizeof(layout.struct("mjContact"))


def _table_variable(module: ir.Module) -> Any:
    variable = module.globals.get(_TABLE_SYMBOL)
    return ir.GlobalVariable(module, ir.IntType(64), _TABLE_SYMBOL) if variable is None else variable


@intrinsic
def _table(typingctx):
    def generate(context, builder, signature, args):
        return builder.ptrtoint(_table_variable(builder.module), ir.IntType(64))

    return types.intp(), generate


@intrinsic
def offset(typingctx, place):
    """Return the struct offset at ``place`` of the table, which never changes within a process."""

    def generate(context, builder, signature, args):
        word = builder.load(builder.gep(_table_variable(builder.module), [args[0]]))
        word.set_metadata("invariant.load", builder.module.add_metadata([]))
        return word

    return types.intp(types.intp), generate


@intrinsic
def load(typingctx, address):
    """Return the double at ``address``."""

    def generate(context, builder, signature, args):
        return builder.load(builder.inttoptr(args[0], ir.DoubleType().as_pointer()))

    return types.float64(types.intp), generate


@intrinsic
def load_word(typingctx, address):
    """Return the 64-bit integer (or pointer) at ``address``."""

    def generate(context, builder, signature, args):
        return builder.load(builder.inttoptr(args[0], ir.IntType(64).as_pointer()))

    return types.intp(types.intp), generate


@intrinsic
def load_int(typingctx, address):
    """Return the 32-bit integer at ``address``."""

    def generate(context, builder, signature, args):
        value = builder.load(builder.inttoptr(args[0], ir.IntType(32).as_pointer()))
        return builder.sext(value, ir.IntType(64))

    return types.intp(types.intp), generate


@intrinsic
def load_byte(typingctx, address):
    """Return the unsigned byte at ``address``."""

    def generate(context, builder, signature, args):
        value = builder.load(builder.inttoptr(args[0], ir.IntType(8).as_pointer()))
        return builder.zext(value, ir.IntType(64))

    return types.intp(types.intp), generate


@intrinsic
def store(typingctx, address, value):
    """Write the double ``value`` at ``address``."""

    def generate(context, builder, signature, args):
        builder.store(args[1], builder.inttoptr(args[0], ir.DoubleType().as_pointer()))
        return context.get_dummy_value()

    return types.void(types.intp, types.float64), generate


@intrinsic
def store_word(typingctx, address, value):
    """Write the 64-bit integer ``value`` at ``address``."""

    def generate(context, builder, signature, args):
        builder.store(args[1], builder.inttoptr(args[0], ir.IntType(64).as_pointer()))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp), generate


@intrinsic
def copy_bytes(typingctx, source, target, count):
    """Copy ``count`` bytes to another place; the two must not overlap."""

    def generate(context, builder, signature, args):
        byte = ir.IntType(8).as_pointer()
        source, target = builder.inttoptr(args[0], byte), builder.inttoptr(args[1], byte)
        cgutils.raw_memcpy(builder, target, source, args[2], 1)
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@intrinsic
def _pointer(typingctx, address):
    def generate(context, builder, signature, args):
        return builder.inttoptr(args[0], ir.DoubleType().as_pointer())

    return types.CPointer(types.float64)(types.intp), generate


@intrinsic
def _word_pointer(typingctx, address):
    def generate(context, builder, signature, args):
        return builder.inttoptr(args[0], ir.IntType(64).as_pointer())

    return types.CPointer(types.int64)(types.intp), generate


@intrinsic
def call_function(typingctx, function, a, b, c):
    """Call a function of three words at an address; return its answer."""

    def generate(context, builder, signature, args):
        word = ir.IntType(64)
        kind = ir.FunctionType(word, [word, word, word])
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), list(args[1:]))

    return types.intp(types.intp, types.intp, types.intp, types.intp), generate


@compiled
def call_python(function, a, b, c):
    """Call a Python function of three words at an address; return its answer, 0 if it raised (and printed) an error."""
    return call_function(function, a, b, c)


@compiled
def vector(address, n):
    """Return the ``n`` doubles at ``address`` as an array (a view)."""
    return carray(_pointer(address), n)


@compiled
def stack(data, length):
    """Return a vector on MuJoCo's stack, not yet filled; it lasts until mj_freeStack."""
    return carray(_pointer(mj_stackAllocNum(data, length)), length)


@compiled
def stack_table(data, rows, columns):
    """Return a matrix on MuJoCo's stack, not yet filled."""
    return carray(_pointer(mj_stackAllocNum(data, rows * columns)), (rows, columns))


@compiled
def stack_words(data, rows, columns):
    """Return a matrix of 64-bit integers on MuJoCo's stack, not yet filled."""
    return carray(_word_pointer(mj_stackAllocNum(data, rows * columns)), (rows, columns))


@compiled
def move(source, target):
    """Copy a vector (numba's slice assignment takes seconds to compile, for the text of its errors)."""
    for j in range(len(target)):
        target[j] = source[j]


@compiled
def entry(place):
    """Return one word of the table."""
    return load_word(_table() + 8 * place)


@compiled
def number_field(base, place):
    """Return the double in a field of the struct at ``base``."""
    return load(base + offset(place))


@compiled
def int_field(base, place):
    """Return the C int in a field of the struct at ``base``."""
    return load_int(base + offset(place))


@compiled
def pointer_field(base, place):
    """Return the pointer in a field of the struct at ``base``."""
    return load_word(base + offset(place))


@compiled
def field(base, place):
    """Return the address of a field of the struct at ``base``."""
    return base + offset(place)


@compiled
def law_row(identifier):
    """Return the address of the row of a law, 0 if this process has not loaded it."""
    for probe in range(N_LAWS):
        row = _table() + 8 * (LAW_ROWS + LAW_WIDTH * ((identifier + probe) % N_LAWS))
        found = load_word(row)
        if found == identifier:
            return row
        if found == 0:
            return 0
    return 0


def plugin_text(model: mujoco.MjModel | int, instance: int, key: str) -> str:
    """Return a configuration value of a plugin instance, "" if there is none; a model may be given by its address."""
    function = library().mj_getPluginConfig
    function.restype = ctypes.c_char_p
    function.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p]
    address = model if isinstance(model, int) else model._address
    return (function(address, instance, key.encode()) or b"").decode()
