"""How much a force along one joint or tendon moves all of them."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco.coordinates import add_row, along_row
from stochfric_mb.numerics.elimination import eliminate

QUADRATIC = 1
"""mjCNSTRSTATE_QUADRATIC."""


@compiled
def mobilities(model, data, states, constrained):
    """Return W = J H^-1 J^T of all coordinates, shape (n, n) [rate per impulse].

    H is the mass matrix; with ``constrained``, plus that of the constraints that push (MuJoCo's soft constraints are
    quadratic there), so that W is what a change of force really does. Elliptic cones count as open.
    """
    nv, count = n.int_field(model, n.M_NV), len(states)
    rows, out = np.zeros((count, nv)), np.zeros((count, count))
    for k in range(count):
        add_row(model, data, states[k], 1.0, rows[k].ctypes.data)
    solved = rows.copy()
    if constrained:
        matrix = np.zeros((nv, nv))
        n.mj_fullM(model, data, matrix.ctypes.data)
        add_constraints(model, data, matrix)
        solved = eliminate(matrix, solved.T.copy()).T.copy()
    else:
        n.mj_solveM(model, data, solved.ctypes.data, rows.ctypes.data, np.int32(count))
    for k in range(count):
        for j in range(count):
            out[j, k] = along_row(model, data, states[j], solved[k].ctypes.data)
    return out


@compiled
def add_constraints(model, data, matrix):
    """Add J^T D J of the constraints in their quadratic zone to the matrix."""
    nv = n.int_field(model, n.M_NV)
    sparse = n.mj_isSparse(model) != 0
    jacobian, columns = n.pointer_field(data, n.D_EFC_J), n.pointer_field(data, n.D_EFC_COLUMN)
    for i in range(n.int_field(data, n.D_NEFC)):
        if n.load_int(n.pointer_field(data, n.D_ROW_STATE) + 4 * i) != QUADRATIC:
            continue
        weight = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * i)
        first, length = nv * i, nv
        if sparse:
            first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * i)
            length = n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * i)
        for a in range(length):
            row = n.load_int(columns + 4 * (first + a)) if sparse else a
            value = weight * n.load(jacobian + 8 * (first + a))
            for b in range(length):
                column = n.load_int(columns + 4 * (first + b)) if sparse else b
                matrix[row, column] += value * n.load(jacobian + 8 * (first + b))
