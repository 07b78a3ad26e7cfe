"""A joint or a tendon as one generalised coordinate: its position, its rate, the forces along it."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s

KIND, OBJECT, LOAD = s.GEOM_BODY, s.GEOM_SURFACE, s.POINT
"""Header places with another meaning here: 0 joint or 1 tendon, its number, and the load [N or N m]."""
POSITION, BEFORE_FORCE = s.ON_BODY, s.WORK
"""Slot places with another meaning here: position [rad or m], force of the step before."""


@compiled
def add_row(model, data, state, factor, target):
    """Add ``factor`` times the row of the coordinate's rate per generalised velocity to the vector at ``target``."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        address = target + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number)
        n.store(address, n.load(address) + factor)
        return
    first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
    columns = n.pointer_field(model, n.M_TENDON_COLUMN)
    row = n.pointer_field(data, n.D_TENDON_J)
    for j in range(first, first + n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number)):
        address = target + 8 * n.load_int(columns + 4 * j)
        n.store(address, n.load(address) + factor * n.load(row + 8 * j))


@compiled
def along_row(model, data, state, vector):
    """Return the product of the coordinate's row with the vector at ``vector``: its rate, for qvel."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        return n.load(vector + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number))
    first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
    columns = n.pointer_field(model, n.M_TENDON_COLUMN)
    row = n.pointer_field(data, n.D_TENDON_J)
    total = 0.0
    for j in range(first, first + n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number)):
        total += n.load(row + 8 * j) * n.load(vector + 8 * n.load_int(columns + 4 * j))
    return total


@compiled
def position_of(model, data, state):
    """Return the coordinate's position [rad or m]: a joint's, or a tendon's length."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) != 0.0:
        return n.load(n.pointer_field(data, n.D_TENDON_LENGTH) + 8 * number)
    return n.load(n.pointer_field(data, n.D_QPOS) + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_QPOS) + 4 * number))


@compiled
def asleep(model, data, state):
    """Return whether MuJoCo has put the kinematic tree of the coordinate to sleep."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        dof = n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number)
    else:
        if n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number) == 0:
            return True
        first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
        dof = n.load_int(n.pointer_field(model, n.M_TENDON_COLUMN) + 4 * first)
    tree = n.load_int(n.pointer_field(model, n.M_DOF_TREE) + 4 * dof)
    return n.load_int(n.pointer_field(data, n.D_TREE_ASLEEP) + 4 * tree) >= 0
