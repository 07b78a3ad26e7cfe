"""Where a model has friction, and what can be measured there: contact pairs, joints and tendons.

A *site* gives the row of generalised velocities that is its sliding velocity, and what its friction does at an
instant. Signs: ``along`` is the direction in which the probe pushes the first body (or the joint); ``velocity`` is
along it, and ``resistance`` is the friction force against it.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.mujoco.reading import readings

Array = npt.NDArray[np.float64]

SLOPE = 0.98
"""Contacts whose normals have less than this cosine with their mean are not one plane."""
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


# --- contact pairs ---------------------------------------------------------------------------------------------------


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

    @property
    def name(self) -> str:
        """Name for tables."""
        return " - ".join(self.names)

    def row(self, model: mujoco.MjModel, data: mujoco.MjData) -> Array:
        """Return the velocity of the first geom relative to the second at the contacts' centre; zeros without contact."""
        contacts = pair_contacts(data, self.geoms)
        if not len(contacts):
            return np.zeros(model.nv)
        return np.asarray(self.along) @ _jacobians(model, data, self.geoms, _centre(model, data, contacts))[0]

    def sample(self, model: mujoco.MjModel, data: mujoco.MjData) -> Sample:
        """Return the sums over the pair's contacts; the velocity is that of their centre of normal force."""
        contacts = pair_contacts(data, self.geoms)
        if not len(contacts):
            return Sample(0.0, 0.0, 0.0, 0.0, 0.0, False)
        centre = _centre(model, data, contacts)
        translation, rotation = _jacobians(model, data, self.geoms, centre)
        at_centre, spin = translation @ data.qvel, rotation @ data.qvel
        along = np.asarray(self.along)
        own = readings(model, data)[self.instance] if self.instance else []
        normal, power = 0.0, 0.0
        total, belt = np.zeros(3), np.zeros(3)
        for k, i in enumerate(contacts):
            push, friction = contact_forces(model, data, int(i), self.geoms[0])
            if self.instance:
                friction = np.asarray(own[k].force) if k < len(own) else np.zeros(3)
            normal += push
            total += friction
            belt = surface_velocity(data, int(i), self.geoms[0])
            power += friction @ (at_centre + np.cross(spin, data.contact.pos[i] - centre) - belt)
        return Sample(self.mu * normal, normal, -float(total @ along), float(along @ (at_centre - belt)), float(power), True)


def pair_contacts(data: mujoco.MjData, geoms: tuple[int, int]) -> npt.NDArray[np.int64]:
    """Return the numbers of the contacts between two geoms."""
    result = data.contact.geom
    a, b = geoms
    return np.flatnonzero(((result[:, 0] == a) & (result[:, 1] == b)) | ((result[:, 0] == b) & (result[:, 1] == a)))


def contact_forces(model: mujoco.MjModel, data: mujoco.MjData, contact: int, body: int) -> tuple[float, Array]:
    """Return normal force [N] and the engine's friction force on the geom ``body`` [N, world axes] at a contact."""
    wrench = np.zeros(6)
    mujoco.mj_contactForce(model, data, contact, wrench)
    frame = data.contact.frame[contact].reshape(3, 3)
    friction = wrench[1] * frame[1] + wrench[2] * frame[2]
    return float(wrench[0]), -friction if data.contact.geom[contact, 0] == body else friction


def surface_velocity(data: mujoco.MjData, contact: int, body: int) -> Array:
    """Return the velocity [m/s, world axes] that the counter-surface's belt adds at a contact."""
    frame = data.contact.frame[contact].reshape(3, 3)
    belt = data.contact.surfacevel[contact]
    velocity = belt[0] * frame[1] + belt[1] * frame[2]
    return velocity if data.contact.geom[contact, 0] == body else -velocity


def flat(data: mujoco.MjData, contacts: npt.NDArray[np.int64]) -> bool:
    """Return whether all contacts face the same way."""
    normals = data.contact.frame[contacts][:, :3]
    mean = normals.mean(axis=0)
    return bool(np.all(normals @ mean >= SLOPE * np.linalg.norm(mean)))


def mobility(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int], contact: int) -> Array:
    """Return the velocity per impulse in the contact's tangent plane, shape (2, 2) [1/kg]."""
    axes = data.contact.frame[contact].reshape(3, 3)[1:]
    rows = axes @ _jacobians(model, data, geoms, data.contact.pos[contact])[0]
    return rows @ solve_mass(model, data, rows).T


def _centre(model: mujoco.MjModel, data: mujoco.MjData, contacts: npt.NDArray[np.int64]) -> Array:
    weights = np.array([contact_forces(model, data, int(i), 0)[0] for i in contacts])
    weights = weights if weights.sum() > 0.0 else np.ones(len(contacts))
    return weights @ data.contact.pos[contacts] / weights.sum()


def _jacobians(model: mujoco.MjModel, data: mujoco.MjData, geoms: tuple[int, int], point: Array) -> tuple[Array, Array]:
    """Return translation and rotation of the first geom's body relative to the second's at a point, shape (3, nv)."""
    jacobians = np.zeros((2, 2, 3, model.nv))
    for k, geom in enumerate(geoms):
        mujoco.mj_jac(model, data, jacobians[k, 0], jacobians[k, 1], point, int(model.geom_bodyid[geom]))
    return jacobians[0, 0] - jacobians[1, 0], jacobians[0, 1] - jacobians[1, 1]


# --- joints and tendons ----------------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Coordinate:
    """One degree of freedom, or one tendon, with frictionloss."""

    name: str
    """Name for tables."""
    names: tuple[str]
    """Name of the joint or tendon."""
    kind: str
    """joint or tendon."""
    number: int
    """The degree of freedom, or the tendon."""
    loss: float
    """Its frictionloss [N or N m]."""
    instance: str = ""
    """Friction instance of this package that acts here; empty: the model's own friction."""

    def row(self, model: mujoco.MjModel, data: mujoco.MjData) -> Array:
        """Return the unit row of the degree of freedom, or the tendon's Jacobian."""
        row = np.zeros(model.nv)
        if self.kind == "joint":
            row[self.number] = 1.0
            return row
        first = int(model.ten_J_rowadr[self.number])
        places = slice(first, first + int(model.ten_J_rownnz[self.number]))
        row[model.ten_J_colind[places]] = data.ten_J[places]
        return row

    def sample(self, model: mujoco.MjModel, data: mujoco.MjData) -> Sample:
        """Return what friction does along the coordinate, the package's or the engine's constraint."""
        if self.instance:
            force = sum(reading.force[0] for reading in readings(model, data)[self.instance])
        else:
            kind = CONSTRAINT.mjCNSTR_FRICTION_DOF if self.kind == "joint" else CONSTRAINT.mjCNSTR_FRICTION_TENDON
            force = constraint_force(data, kind, self.number)
        velocity = float(self.row(model, data) @ data.qvel)
        return Sample(self.loss, self.loss, -force, velocity, force * velocity, True)


def constraint_force(data: mujoco.MjData, kind: mujoco.mjtConstraint, number: int) -> float:
    """Return the force of the constraint of a kind on an element, 0 if there is none."""
    rows = (data.efc_type == int(kind)) & (data.efc_id == number)
    return float(data.efc_force[rows].sum())


Site = ContactPair | Coordinate
"""A place with friction."""


# --- the mass that a probe moves -------------------------------------------------------------------------------------


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
    rows: list[Array] = []
    types = data.efc_type
    limits = ((types == CONSTRAINT.mjCNSTR_LIMIT_JOINT) | (types == CONSTRAINT.mjCNSTR_LIMIT_TENDON)) & (data.efc_force > 0.0)
    for i in np.flatnonzero((types == CONSTRAINT.mjCNSTR_EQUALITY) | limits):
        rows.append(_constraint_row(model, data, int(i)))
    for i in range(data.ncon):
        geoms = data.contact.geom[i]
        if min(geoms) >= 0 and contact_forces(model, data, i, 0)[0] > 0.0:
            jacobian = _jacobians(model, data, (int(geoms[0]), int(geoms[1])), data.contact.pos[i])[0]
            rows.append(data.contact.frame[i, :3] @ jacobian)
    return np.array(rows).reshape(-1, model.nv)


def _constraint_row(model: mujoco.MjModel, data: mujoco.MjData, i: int) -> Array:
    if not mujoco.mj_isSparse(model):
        return np.array(data.efc_J).reshape(-1, model.nv)[i]
    row = np.zeros(model.nv)
    places = slice(int(data.efc_J_rowadr[i]), int(data.efc_J_rowadr[i]) + int(data.efc_J_rownnz[i]))
    row[data.efc_J_colind[places]] = data.efc_J[places]
    return row


def lightest_mass(model: mujoco.MjModel, data: mujoco.MjData, site: Site) -> float:
    """Return the least mass [kg or kg m^2] that a force at the site feels, which sets the step limit."""
    if isinstance(site, ContactPair):
        items: list[Any] = [
            np.linalg.eigvalsh(mobility(model, data, site.geoms, int(i)))[-1] for i in pair_contacts(data, site.geoms)
        ]
        largest = max(items, default=0.0)
    else:
        row = site.row(model, data)[None, :]
        largest = float((row @ solve_mass(model, data, row).T)[0, 0])
    return 1.0 / largest if largest > 0.0 else math.inf
