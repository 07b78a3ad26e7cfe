"""Pairs of geoms that slide on each other: where they touch, along which line, and what the balance says of both forces.

At the contact the surface pushes the body with N along its normal n and rubs it with F against its motion along the line d.
These act on the joints as J_n N and -J_d F, where J_n and J_d are how fast the body parts from the surface and slides on it
with each joint. What the joints' drives exceed the needs of the motion by is then r = J_d F - J_n N: two unknowns. Penetrations
are micrometres, which no record holds, so N is not asked of the softness of a contact but of this balance.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mechanisms.mjcf_parts import Pair

Array = npt.NDArray[np.float64]

REACH = 0.01
"""Distance at which geoms still count as touching, over the size of the model: positions are noisy."""
STRAIGHT = 0.98
"""Least part of the sliding (mean square) that is along one line of the surface."""
LEAST = 1.0e-6
"""Jacobians below this are 0 [m/s per m/s or rad/s]."""


@dataclasses.dataclass(frozen=True)
class Touch:
    """Where and how two geoms touch: in one state, or along a motion of n states."""

    part: Array
    """J_n: how fast the body parts from the surface with each joint, shape (n_joints,) or (n, n_joints)."""
    slide: Array
    """How fast it slides with each joint, in the surface's axes, shape (3, n_joints) or (n, 3, n_joints)."""
    place: Array
    """Place of the body's geom in these axes [m], shape (3,) or (n, 3)."""


def geom_numbers(mujoco: Any, model: Any, pair: Pair) -> tuple[int, int]:
    """Return the numbers of a pair's geoms, body first.

    Raises:
        InputError: the model has no geom of that name.
    """
    named = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, i) for i in range(model.ngeom)]
    for name in pair.geoms:
        require_name("geom of mechanism.pairs", name, [n for n in named if n])
    body, surface = (named.index(name) for name in pair.geoms)
    return body, surface


def reach_out(model: Any) -> None:
    """Let geoms touch across the noise of measured positions; forces of contacts are of no use in this model then."""
    model.geom_margin[:] = 0.5 * REACH * model.stat.extent
    model.pair_margin[:] = REACH * model.stat.extent


def touch(mujoco: Any, model: Any, data: Any, body: int, surface: int) -> Touch | None:
    """Return how two geoms touch in the state of ``data``, whose positions are evaluated; None if they do not.

    Several points under one body count as one in their middle: their normals are alike where the pair slides along a line.
    """
    between = np.sort(data.contact.geom, axis=1) == np.sort([body, surface])
    seen = np.flatnonzero(between.all(axis=1))
    if not len(seen):
        return None
    outward = np.where(data.contact.geom[seen, 0] == surface, 1.0, -1.0)
    normal = (outward[:, None] * data.contact.frame[seen].reshape(len(seen), -1)[:, :3]).mean(axis=0)
    normal = normal / np.linalg.norm(normal)
    point = data.contact.pos[seen].mean(axis=0)
    rows = [np.zeros((3, model.nv)), np.zeros((3, model.nv))]
    for row, geom in zip(rows, (body, surface), strict=True):
        mujoco.mj_jac(model, data, row, None, point, model.geom_bodyid[geom])
    relative = rows[0] - rows[1]
    part = normal @ relative
    axes = data.geom_xmat[surface].reshape(3, 3)
    place = axes.T @ (data.geom_xpos[body] - data.geom_xpos[surface])
    return Touch(part, axes.T @ (relative - np.outer(normal, part)), place)


def pair_along(mujoco: Any, model: Any, geoms: tuple[int, int], positions: Array) -> Touch:
    """Return a pair along a motion; zeros where it does not touch.

    Args:
        mujoco: the module.
        model: the model after `reach_out`.
        geoms: numbers of the body's geom and of the surface's.
        positions: of the joints, shape (n, n_joints).
    """
    data = mujoco.MjData(model)
    n = len(positions)
    along = Touch(np.zeros_like(positions), np.zeros((n, 3, model.nv)), np.zeros((n, 3)))
    for k, q in enumerate(positions):
        data.qpos[:] = q
        mujoco.mj_fwdPosition(model, data)
        seen = touch(mujoco, model, data, *geoms)
        if seen is not None:
            along.part[k], along.slide[k], along.place[k] = seen.part, seen.slide, seen.place
    return along


def line(along: Touch, rates: Array, name: str) -> Array:
    """Return the direction of sliding in the surface's axes, shape (3,).

    Args:
        along: a pair along a motion.
        rates: of the joints, shape (n, n_joints).
        name: of the pair, for messages.

    Raises:
        InputError: the geoms do not slide on each other, or not along one line.
    """
    velocity = np.einsum("nij,nj->ni", along.slide, rates)
    if not np.abs(velocity).max() > 0.0:
        raise InputError(
            f"pair {name!r}: its geoms do not slide on each other along the measured positions; check the geoms, and that "
            "they touch in the model where the joints were measured"
        )
    _, size, rows = np.linalg.svd(velocity, full_matrices=False)
    if size[0] ** 2 < STRAIGHT * float(np.sum(size**2)):
        raise InputError(
            f"pair {name!r}: only {100.0 * size[0] ** 2 / np.sum(size**2):.0f} % of its sliding is along one line of geom "
            "geoms[1]; name the geom first on which the line turns, or model the motion as a joint"
        )
    return rows[0] * np.sign(rows[0][np.argmax(np.abs(rows[0]))])


def two_forces(part: Array, slide: Array, name: str) -> Array:
    """Return how N and F follow from what the joints have left, F = rows[:, 1] r, shape (n, 2, n_joints).

    Args:
        part: J_n, shape (n, n_joints).
        slide: J_d, shape (n, n_joints).
        name: of the pair, for messages.

    Raises:
        InputError: no joint moves along the normal, or it moves as the sliding does.
    """
    touching = np.linalg.norm(slide, axis=1) > LEAST
    both = np.stack([-part[touching], slide[touching]], axis=2)
    least = np.linalg.eigvalsh(np.swapaxes(both, 1, 2) @ both)[:, 0] if len(both) else np.zeros(1)
    if float(np.median(least)) < LEAST**2:
        raise InputError(
            f"pair {name!r}: no joint moves along its normal, so that the joints' balance does not hold its normal force; give "
            'a channel, normal_force = "...", or the model a joint in that direction, with positions = { lift = 0.0 }'
        )
    rows = np.zeros((len(part), 2, part.shape[1]))
    rows[touching] = np.linalg.pinv(both)
    return rows
