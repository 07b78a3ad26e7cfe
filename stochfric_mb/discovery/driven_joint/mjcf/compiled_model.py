"""What is asked of MuJoCo about a user's model: forces that a motion needs, and tendons along it."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError

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


def carrier(model: Any) -> int | None:
    """Return the body at the end of the longest chain of joints, which is where a tool goes.

    None: no other body moves, so that further mass in it is a factor on all masses.
    """
    joints, depth = np.zeros(model.nbody, dtype=int), np.zeros(model.nbody, dtype=int)
    for body in range(1, model.nbody):
        parent = model.body_parentid[body]
        joints[body], depth[body] = joints[parent] + model.body_jntnum[body], depth[parent] + 1
    moving = np.flatnonzero((joints > 0) & (model.body_mass > 0.0))
    if len(moving) < 2:
        return None
    return int(max(moving, key=lambda body: (joints[body], depth[body], -body)))


def places_of_payload(mujoco: Any, model: Any) -> dict[str, Array]:
    """Return where a `carrier` may carry more, in its own frame [m]: at its centre of mass, and at its far end.

    Two points stand for any mass between them. The far end is that of its geoms from the nearest joint below; without geoms
    there is none.
    """
    body = carrier(model)
    if body is None:
        return {}
    places = {"centre": np.array(model.body_ipos[body])}
    geoms = np.flatnonzero(model.geom_bodyid == body)
    if len(geoms):
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        below = body
        while not model.body_jntnum[below]:
            below = model.body_parentid[below]
        away = data.geom_xpos[geoms] - data.xanchor[model.body_jntadr[below]]
        far = np.linalg.norm(away, axis=1)
        most = int(np.argmax(far + model.geom_rbound[geoms]))
        if far[most] > 0.0:
            end = data.geom_xpos[geoms[most]] + model.geom_rbound[geoms[most]] * away[most] / far[most]
            places["end"] = data.xmat[body].reshape(3, 3).T @ (end - data.xpos[body])
    return places


def add_payload(mujoco: Any, model: Any, payload: Mapping[str, float]) -> None:
    """Add point masses [kg] to a model, by their places among `places_of_payload`.

    Raises:
        InputError: the model has no such place.
    """
    held = {place: payload[place] for place in payload if payload[place]}
    if not held:
        return
    body, places = carrier(model), places_of_payload(mujoco, model)
    for place, mass in held.items():
        if place not in places:
            why = "its last body has no geoms" if places else "only one of its bodies moves"
            remedy = "use centre" if places else "use mechanism.factors.mass"
            raise InputError(f"mechanism.payload.{place} = {mass:g} kg: the model has no such place, since {why}; {remedy}")
        own, centre, turn = float(model.body_mass[body]), np.array(model.body_ipos[body]), np.empty(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[body])
        axes = turn.reshape(3, 3)
        arm = places[place] - centre
        # of two masses about their common centre, by Steiner
        inertia = axes @ np.diag(model.body_inertia[body]) @ axes.T
        inertia += own * mass / (own + mass) * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        moments, axes = np.linalg.eigh(inertia)
        axes = axes * np.sign(np.linalg.det(axes))
        model.body_mass[body], model.body_ipos[body] = own + mass, centre + mass / (own + mass) * arm
        model.body_inertia[body] = moments
        mujoco.mju_mat2Quat(model.body_iquat[body], np.ascontiguousarray(axes).ravel())
    mujoco.mj_setConst(model, mujoco.MjData(model))


def by_payload(mujoco: Any, model: Any, motion: tuple[Array, Array, Array], needed: Array) -> dict[str, Array]:
    """Return the change of the ``needed`` forces with `add_payload` in each place [N/kg or N m/kg], shape (n, n_joints)."""
    changes: dict[str, Array] = {}
    for place in places_of_payload(mujoco, model):
        loaded = copy.copy(model)
        add_payload(mujoco, loaded, {place: 1.0})
        changes[place] = inverse(mujoco, loaded, motion) - needed
    return changes


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
