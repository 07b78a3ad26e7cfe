"""Plain memory for compiled code: numbers at addresses, and the table of what changes from process to process.

Compiled code is cached on disk and outlives a process, so no address may stand in it. All of them stand in one table
whose place LLVM learns by its name each time the code is loaded: functions of Python's, the rows of the laws, the
configurations read so far.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
from typing import Any

import llvmlite.binding
from llvmlite import ir
from numba import carray, types  # pyright: ignore[reportPrivateImportUsage]
from numba.core import cgutils
from numba.extending import intrinsic

from stochfric_mb.compile import compiled

(
    OPTIONS_CHECKER, NO_PASSIVE_MESSAGE, SLOTS_MESSAGE, JOINTS_PLUGIN, SENSED_PLUGIN, CALLBACK_BEFORE, CALLBACK_ROWS,
    CALLBACK_MESSAGE, CONDIM_MESSAGE, CONE_MESSAGE, PRIMAL_MESSAGE, WARNER,
) = range(12)  # fmt: skip
"""Places of addresses (functions of Python's, texts, the callback's rows) and of MuJoCo's numbers of our plugins."""
PAIR_KEYS, JOINT_KEYS, SENSOR_KEYS = 16, 32, 48
"""First places of the addresses of each plugin's configuration keys."""
READER = 15
"""Place, after a plugin's first one, of the Python function that reads its configurations."""
LAW_ROWS, N_LAWS = 64, 256
"""First place and number of the rows of the laws."""
IDENTIFIER, INIT, FORCE, COMMIT, GUARDS, SLIDE, SPRING, N_STATE = range(8)
"""What stands in a law's row: its identifier, the addresses of its functions, the number of its state's entries."""
LAW_WIDTH = 8
CONFIGURATIONS, N_CONFIGURATIONS = LAW_ROWS + LAW_WIDTH * N_LAWS, 4096
"""First place and number of the addresses of configurations, by hash."""
TABLE: Any = (ctypes.c_int64 * (CONFIGURATIONS + N_CONFIGURATIONS))()
"""What compiled code must look up in this process."""
_SYMBOL = "stochfric_mb_mujoco_table"


def publish() -> None:
    """Let compiled code find the table."""
    llvmlite.binding.add_symbol(_SYMBOL, ctypes.addressof(TABLE))


@intrinsic
def _table(typingctx):
    def generate(context, builder, signature, args):
        module = builder.module
        variable = module.globals.get(_SYMBOL) or ir.GlobalVariable(module, ir.IntType(64), _SYMBOL)
        return builder.ptrtoint(variable, ir.IntType(64))

    return types.intp(), generate


@compiled
def entry(place):
    """Return one word of the table."""
    return load_word(_table() + 8 * place)


@compiled
def law_row(identifier):
    """Return the first place of the row of a law, 0 if this process has not loaded it."""
    for probe in range(N_LAWS):
        row = LAW_ROWS + LAW_WIDTH * ((identifier + probe) % N_LAWS)
        found = entry(row)
        if found == identifier:
            return row
        if found == 0:
            return 0
    return 0


@compiled
def at(array, i):
    """Return number ``i`` of the doubles at ``array``."""
    return load(array + 8 * i)


@compiled
def put(array, i, value):
    """Write number ``i`` of the doubles at ``array``."""
    store(array + 8 * i, value)


@compiled
def int_at(array, i):
    """Return number ``i`` of the C ints at ``array``."""
    return load_int(array + 4 * i)


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
def store_int(typingctx, address, value):
    """Write the 32-bit integer ``value`` at ``address``."""

    def generate(context, builder, signature, args):
        word = builder.trunc(args[1], ir.IntType(32))
        builder.store(word, builder.inttoptr(args[0], ir.IntType(32).as_pointer()))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp), generate


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
