"""Symmetric positive definite systems, factored from the last coordinate to the first.

In that order the mass matrix of a tree of bodies gets no further entries (Featherstone 2005, doi
10.1177/0278364905054928): entries that are zero stay so, and are passed over.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

from stochfric_mb.compile import compiled

LEAST = 1.0e-20
"""Pivot in place of one that rounding has made zero or negative."""


@compiled
def factor(a):
    """Replace the lower triangle of A = L^T D L by L, and its diagonal by that of D^-1."""
    for k in range(len(a) - 1, -1, -1):
        row = a[k]
        inverse = 1.0 / (row[k] if row[k] > 0.0 else LEAST)
        for i in range(k):
            part = row[i] * inverse
            if part != 0.0:
                target = a[i]
                for j in range(i + 1):
                    target[j] -= part * row[j]
        for i in range(k):
            row[i] *= inverse
        row[k] = inverse


@compiled
def substitute(a, x):
    """Replace the columns of ``x`` by the solutions of A y = x, ``a`` from `factor`."""
    size, width = x.shape
    for k in range(size - 1, -1, -1):
        for i in range(k):
            part = a[k, i]
            if part != 0.0:
                for j in range(width):
                    x[i, j] -= part * x[k, j]
    for k in range(size):
        for j in range(width):
            x[k, j] *= a[k, k]
        for i in range(k):
            part = a[k, i]
            if part != 0.0:
                for j in range(width):
                    x[k, j] -= part * x[i, j]
