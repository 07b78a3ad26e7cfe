"""What is asked of MuJoCo about a user's model: forces that a motion needs, and tendons along it."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

STEP = 1.0e-3
"""Relative change of the masses by which their column is taken; the balance is linear in them."""


def inverse(mujoco: Any, model: Any, motion: tuple[Array, Array, Array]) -> Array:
    """Return the generalised forces that a motion needs [N or N m], shape (n, n_joints).

    Args:
        mujoco: the module.
        model: the compiled model.
        motion: positions, rates and accelerations, each of shape (n, n_joints).
    """
    data = mujoco.MjData(model)
    forces = np.empty_like(motion[0])
    for k, (q, v, a) in enumerate(zip(*motion, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        forces[k] = data.qfrc_inverse
    return forces


def by_mass(mujoco: Any, model: Any, motion: tuple[Array, Array, Array], needed: Array) -> Array:
    """Return the change of the ``needed`` forces with a factor on all masses and inertias, shape (n, n_joints)."""
    heavier = copy.copy(model)
    scale_masses(mujoco, heavier, 1.0 + STEP)
    return (inverse(mujoco, heavier, motion) - needed) / STEP


def scale_masses(mujoco: Any, model: Any, factor: float) -> None:
    """Multiply all masses and inertias of a model."""
    model.body_mass *= factor
    model.body_inertia *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))


def effective_inertia(mujoco: Any, model: Any) -> Array:
    """Return the inertia of each joint in the model's reference position [kg or kg m^2], shape (n_joints,)."""
    n = model.nv
    still, unit = np.zeros((n, n)), np.eye(n)
    pose = np.tile(model.qpos0, (n, 1))
    return np.diag(inverse(mujoco, model, (pose, still, unit)) - inverse(mujoco, model, (pose, still, still)))


def tendon_along(mujoco: Any, model: Any, tendon: int, positions: Array) -> tuple[Array, Array]:
    """Return the length of a tendon [m], shape (n,), and its change with each joint, shape (n, n_joints).

    Args:
        mujoco: the module.
        model: the compiled model.
        tendon: number of the tendon.
        positions: of the joints, shape (n, n_joints).
    """
    data = mujoco.MjData(model)
    length, rows = np.empty(len(positions)), np.empty_like(positions)
    for k, q in enumerate(positions):
        data.qpos[:] = q
        mujoco.mj_fwdPosition(model, data)
        length[k], rows[k] = data.ten_length[tendon], tendon_row(model, data, tendon)
    return length, rows


def tendon_row(model: Any, data: Any, tendon: int) -> Array:
    """Return how a tendon's length changes with each joint in the present state, shape (n_joints,)."""
    row = np.zeros(model.nv)
    start, count = int(model.ten_J_rowadr[tendon]), int(model.ten_J_rownnz[tendon])
    row[model.ten_J_colind[start : start + count]] = data.ten_J[start : start + count]
    return row
