"""The mass that a contact feels, from the system's own mass matrix and constraints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import exudyn
import numpy as np
import numpy.typing as npt
from exudyn.solver import ComputeLinearizedSystem

Array = npt.NDArray[np.float64]
_INITIAL = exudyn.ConfigurationType.Initial


def effective_masses(mbs: Any, velocities: Callable[[], tuple[float, ...]]) -> Array:
    """Return the masses [kg] that forces on a contact feel in the system's initial configuration, smallest first.

    The inverse masses are the eigenvalues of J a (see `response`): those of the directions in which force and acceleration are
    parallel. Directions in which nothing moves are left out.
    """
    rows, accelerations = response(mbs, velocities)
    inverse = rows @ accelerations
    values = np.linalg.eigvalsh(0.5 * (inverse + inverse.T))
    felt = values[values > 1.0e-12 * max(np.max(np.abs(values)), 1.0e-300)]
    return np.array(np.sort(1.0 / felt), dtype=np.float64)


def response(mbs: Any, velocities: Callable[[], tuple[float, ...]]) -> tuple[Array, Array]:
    """Return how a contact's relative velocities depend on the system's, and what unit forces along them do.

    The rows J, shape (directions, n), are the relative velocities' derivatives by the system's velocities; a unit force gives
    the accelerations a, shape (n, directions), of M a + C^T lambda = J^T, C a = 0 (C: the constraints' Jacobian).

    Args:
        mbs: the assembled system; its state is as before afterwards.
        velocities: what reads the relative velocities [m/s] from the system's current state.
    """
    data = mbs.systemData
    state = data.GetSystemState()
    try:
        linear = ComputeLinearizedSystem(mbs, returnConstraintJacobian=True)
        mass, constraints = linear[0], linear[3] if len(linear) > 3 else ()  # C^T; without constraints not there
        data.SetODE2Coordinates(data.GetODE2Coordinates(_INITIAL))
        rows = _derivatives(data, len(mass), velocities)
    finally:
        data.SetSystemState(state)
    c = np.asarray(constraints).reshape(len(mass), -1).T
    matrix = np.block([[np.asarray(mass), c.T], [c, np.zeros((len(c), len(c)))]])
    right = np.vstack([rows.T, np.zeros((len(c), len(rows)))])
    return rows, np.array(np.linalg.lstsq(matrix, right, rcond=1.0e-12)[0][: len(mass)], dtype=np.float64)


def _derivatives(data: Any, n: int, velocities: Callable[[], tuple[float, ...]]) -> Array:
    """Return the derivatives of the relative velocities by the system's velocities, shape (directions, n); they are linear."""
    data.SetODE2Coordinates_t(np.zeros(n))
    rest = np.array(velocities())
    columns = []
    for i in range(n):
        data.SetODE2Coordinates_t(np.eye(1, n, i)[0])
        columns.append(np.array(velocities()) - rest)
    return np.array(columns).T
