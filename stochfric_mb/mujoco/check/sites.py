"""Where a model has friction, and what can be measured there: contact pairs, joints and tendons.

A *site* says what its friction does at an instant, and which row of generalised velocities is its sliding velocity. Signs:
``along`` is the direction in which the probe pushes the first body (or the joint); ``velocity`` is along it, and
``resistance`` is the friction force against it.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.mujoco.reading import readings

Array = npt.NDArray[np.float64]

CONSTRAINT = mujoco.mjtConstraint


class Sample(NamedTuple):
    """What a site does at one instant."""

    limit: float
    """Most that friction can hold: mu times the normal force [N], or the frictionloss [N or N m]."""
    normal: float
    """Normal force [N]; the frictionloss for joints and tendons."""
    resistance: float
    """Friction force against the direction of the probe [N or N m]."""
    velocity: float
    """Sliding velocity along the direction of the probe [m/s or rad/s]."""
    power: float
    """Power of friction on the motion [W]; never positive where friction dissipates."""
    touching: bool
    """Whether there is any contact."""
    row: Array
    """Velocity along the direction of the probe per generalised velocity, shape (nv,); zeros without contact."""


class Touch(NamedTuple):
    """One contact between two geoms at an instant, in world axes."""

    normal: float
    """Normal force [N]."""
    friction: Array
    """The engine's friction force on the first geom [N]."""
    frame: Array
    """The contact's normal and tangents, shape (3, 3)."""
    belt: Array
    """Velocity that surface velocities add to the first geom's relative to the second [m/s]."""
    jacobian: Array
    """Velocity of the first geom relative to the second at the contact per generalised velocity, shape (3, nv)."""


def touches(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int]) -> list[Touch]:
    """Return the contacts between two geoms that bear something (see `contact.face`)."""
    contacts = data.contact
    ours = (np.sort(contacts.geom, axis=1) == np.sort(geoms)).all(axis=1)
    return [
        touch(model, data, int(i), geoms) for i in np.flatnonzero(ours & ((contacts.exclude == 0) | (contacts.efc_address < 0)))
    ]


def touch(model: mujoco.MjModel, data: mujoco.MjData, contact: int, geoms: tuple[int, int]) -> Touch:
    """Return one contact, between two geoms that it joins in either order."""
    wrench, jacobians = np.zeros(6), np.zeros((2, 3, model.nv))
    mujoco.mj_contactForce(model, data, contact, wrench)
    for jacobian, geom in zip(jacobians, geoms, strict=True):
        mujoco.mj_jac(model, data, jacobian, None, data.contact.pos[contact], int(model.geom_bodyid[geom]))
    frame = data.contact.frame[contact].reshape(3, 3)
    sign = -1.0 if data.contact.geom[contact, 0] == geoms[0] else 1.0
    belt = -sign * data.contact.surfacevel[contact, :2] @ frame[1:]
    return Touch(float(wrench[0]), sign * wrench[1:3] @ frame[1:], frame, belt, jacobians[0] - jacobians[1])


@dataclasses.dataclass(frozen=True)
class ContactPair:
    """All contacts between two geoms."""

    geoms: tuple[int, int]
    """Body's geom and counter-surface's."""
    names: tuple[str, str]
    """Their names."""
    mu: float
    """Sliding coefficient of the model [-]."""
    along: tuple[float, float, float]
    """Direction of the probe, in world axes."""
    instance: str = ""
    """Friction instance of this package that acts here; empty: the model's own friction."""
    kind = "contact"
    unit = "m"

    @property
    def name(self) -> str:
        """Name for tables."""
        return " - ".join(self.names)

    def sample(self, model: mujoco.MjModel, data: mujoco.MjData, qvel: Array | None = None) -> Sample:
        """Return the sums over the pair's contacts; the velocity is that of their centre of normal force.

        Args:
            model: the model.
            data: its state, with forces.
            qvel: velocities that belong to these forces, shape (nv,); those in ``data`` if not given.
        """
        contacts = touches(model, data, self.geoms)
        if not contacts:
            return Sample(0.0, 0.0, 0.0, 0.0, 0.0, False, np.zeros(model.nv))
        friction = np.array([t.friction for t in contacts])
        if self.instance:
            own = [r.force for r in readings(model, data)[self.instance][: len(contacts)]]
            friction = np.array([*own, *[(0.0, 0.0, 0.0)] * (len(contacts) - len(own))])
        normals = np.array([t.normal for t in contacts])
        normal, along = float(normals.sum()), np.asarray(self.along)
        weights = normals / normal if normal > 0.0 else np.full(len(contacts), 1.0 / len(contacts))
        row = weights @ np.array([along @ t.jacobian for t in contacts])
        qvel = data.qvel if qvel is None else qvel
        slips = np.array([t.jacobian @ qvel - t.belt for t in contacts])
        return Sample(
            limit=self.mu * normal,
            normal=normal,
            resistance=-float(friction.sum(axis=0) @ along),
            velocity=float(weights @ slips @ along),
            power=float((friction * slips).sum()),
            touching=True,
            row=row,
        )

    def mobility(self, model: mujoco.MjModel, data: mujoco.MjData) -> float:
        """Return the largest velocity per impulse [1/kg] that a force at one of the contacts meets."""
        return max(
            (np.linalg.eigvalsh(plane_mobility(model, data, t))[-1] for t in touches(model, data, self.geoms)), default=0.0
        )


@dataclasses.dataclass(frozen=True)
class Coordinate:
    """One degree of freedom, or one tendon, with frictionloss."""

    name: str
    """Name for tables."""
    names: tuple[str]
    """Name of the joint or tendon."""
    kind: str
    """joint or tendon."""
    unit: str
    """Unit of its displacement: m or rad."""
    number: int
    """The degree of freedom, or the tendon."""
    loss: float
    """Its frictionloss [N or N m]."""
    along: float = 1.0
    """Direction of the probe: 1, or -1 against the coordinate."""
    instance: str = ""
    """Friction instance of this package that acts here; empty: the model's own friction."""

    def sample(self, model: mujoco.MjModel, data: mujoco.MjData, qvel: Array | None = None) -> Sample:
        """Return what friction does along the coordinate, the package's or the engine's constraint (see `ContactPair`)."""
        if self.kind == "joint":
            row, kind = np.eye(1, model.nv, self.number)[0], CONSTRAINT.mjCNSTR_FRICTION_DOF
        else:
            rows, kind = np.zeros((model.ntendon, model.nv)), CONSTRAINT.mjCNSTR_FRICTION_TENDON
            mujoco.mju_sparse2dense(rows, data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind)
            row = rows[self.number]
        if self.instance:
            force = sum(reading.force[0] for reading in readings(model, data)[self.instance])
        else:
            force = float(data.efc_force[(data.efc_type == int(kind)) & (data.efc_id == self.number)].sum())
        row, force = self.along * row, self.along * force
        velocity = float(row @ (data.qvel if qvel is None else qvel))
        return Sample(self.loss, self.loss, -force, velocity, force * velocity, True, row)

    def mobility(self, model: mujoco.MjModel, data: mujoco.MjData) -> float:
        """Return the velocity per impulse [1/kg or 1/(kg m^2)] along the coordinate."""
        row = self.sample(model, data).row[None, :]
        return float((row @ solve_mass(model, data, row).T)[0, 0])


Site = ContactPair | Coordinate
"""A place with friction."""


def plane_mobility(model: mujoco.MjModel, data: mujoco.MjData, contact: Touch) -> Array:
    """Return the velocity per impulse in a contact's tangent plane, shape (2, 2) [1/kg]."""
    rows = contact.frame[1:] @ contact.jacobian
    return rows @ solve_mass(model, data, rows).T


def solve_mass(model: mujoco.MjModel, data: mujoco.MjData, rows: Array) -> Array:
    """Return M^-1 applied to each row."""
    solved = np.zeros_like(rows)
    mujoco.mj_solveM(model, data, solved, np.ascontiguousarray(rows))
    return solved


def kick(model: mujoco.MjModel, data: mujoco.MjData, row: Array) -> tuple[Array, float]:
    """Return the change of qvel that slides a site at 1 m/s, and the mass [kg] that slides with it.

    It is the change of least kinetic energy that leaves active contacts, limits and equalities as they are:
    R M^-1 R^T p = (1, 0, ...), and the mass is p of the first row. The mass is infinite where they forbid sliding.
    """
    rows = np.vstack([row[None, :], held_rows(model, data)])
    solved = solve_mass(model, data, rows)
    wanted = np.zeros(len(rows))
    wanted[0] = 1.0
    compliance = rows @ solved.T
    impulse = np.linalg.pinv(compliance, rcond=1.0e-10, hermitian=True) @ wanted
    change = impulse @ solved
    if not np.allclose(rows @ change, wanted, atol=1.0e-4) or not impulse[0] > 0.0:
        return np.zeros(model.nv), math.inf
    return change, float(impulse[0])


def held_rows(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Return the rows that a slide must leave at rest: equalities, active limits and normals of loaded contacts."""
    types = data.efc_type
    limits = ((types == CONSTRAINT.mjCNSTR_LIMIT_JOINT) | (types == CONSTRAINT.mjCNSTR_LIMIT_TENDON)) & (data.efc_force > 0.0)
    held = np.flatnonzero((types == CONSTRAINT.mjCNSTR_EQUALITY) | limits).tolist()
    rows = np.zeros((len(held), model.nv))
    for row, i in zip(rows, held, strict=True):
        mujoco.mj_mulJacTVec(model, data, row, np.eye(1, data.nefc, i)[0])
    loaded = [touch(model, data, i, tuple(geoms)) for i, geoms in enumerate(data.contact.geom.tolist()) if min(geoms) >= 0]
    return np.vstack([rows, *(t.frame[:1] @ t.jacobian for t in loaded if t.normal > 0.0)])
