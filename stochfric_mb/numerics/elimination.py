"""Systems of linear equations, solved by elimination."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

from stochfric_mb.compile import compiled


@compiled
def eliminate(matrix, right):
    """Return the solution of matrix x = right (both are overwritten), by elimination with pivots."""
    size = len(matrix)
    for i in range(size):
        best = i
        for j in range(i + 1, size):
            if abs(matrix[j, i]) > abs(matrix[best, i]):
                best = j
        for k in range(i, size):
            matrix[i, k], matrix[best, k] = matrix[best, k], matrix[i, k]
        for k in range(right.shape[1]):
            right[i, k], right[best, k] = right[best, k], right[i, k]
        for j in range(i + 1, size):
            factor = matrix[j, i] / matrix[i, i]
            if factor != 0.0:
                for k in range(i, size):
                    matrix[j, k] -= factor * matrix[i, k]
                for k in range(right.shape[1]):
                    right[j, k] -= factor * right[i, k]
    for i in range(size - 1, -1, -1):
        for k in range(right.shape[1]):
            for j in range(i + 1, size):
                right[i, k] -= matrix[i, j] * right[j, k]
            right[i, k] /= matrix[i, i]
    return right
