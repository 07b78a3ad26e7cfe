"""Sliding in a plane that turns, and on bodies that turn: the motion of the point of contact, the force and its torques.

Marker 0 belongs to the counter-surface, marker 1 to the body; the plane turns with frame F (one of both bodies, or space),
the point of contact lies ``radius`` below marker 1, against the normal n. With d = p_1 - p_0 and rotation R of the frame,

    relative velocity in the plane = e . R^T (v_1 - v_0 - omega_F x d)                   (d/dt of R^T d, integrated exactly)
                                   + e . R^T ((omega_F - omega_0) x d - radius (omega_1 - omega_0) x n)      (spin).

The spin is no derivative of a position; its integral follows the trapezoidal rule from step to step.
"""

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact_force import force_now

MARKER_0, MARKER_1, SPACE = 0, 1, 2
"""What the plane turns with."""
POSITION, VELOCITY, OMEGA, ROTATION = 0, 3, 6, 9
"""Places of a marker's position [m], velocity [m/s], angular velocity [rad/s] and rotation matrix, in global axes."""
MARKER = 18
"""Numbers of one marker; those of marker 1 follow those of marker 0."""
PULL, PULL_TORQUE, PULL_GLOBAL, LEVER, GLOBAL = 3, 6, 9, 12, 15
"""Places in the outcome of `push`, after the friction force [N] along both axes and the normal force: force and torque that
a connector pulls marker 1 back with, in the axes of marker 0, and the force in global ones; what is left of the torque on
body 0, and the friction force on body 1, global."""
OUTCOME = 18


@compiled
def cross(a, b):
    """Return the product a x b."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@compiled
def _turned(rotation, a):
    """Return R a, of the nine numbers of R row by row."""
    return np.array([rotation[3 * i] * a[0] + rotation[3 * i + 1] * a[1] + rotation[3 * i + 2] * a[2] for i in range(3)])


@compiled
def _turned_back(rotation, a):
    """Return R^T a."""
    return np.array([rotation[i] * a[0] + rotation[i + 3] * a[1] + rotation[i + 6] * a[2] for i in range(3)])


@compiled
def _frame(markers, frame):
    """Return rotation matrix, as nine numbers, and angular velocity of the frame."""
    if frame == SPACE:
        return np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]), np.zeros(3)
    start = MARKER * frame
    return markers[start + ROTATION : start + ROTATION + 9], markers[start + OMEGA : start + OMEGA + 3]


@compiled
def take_motion(markers, address, frame, radius):
    """Put the motion of the two markers, shape (2 MARKER,), where `contact_force.kinematics` reads it."""
    numbers, _ = at.arrays(address)
    rotation, omega = _frame(markers, frame)
    omega_0, omega_1 = markers[OMEGA : OMEGA + 3], markers[MARKER + OMEGA : MARKER + OMEGA + 3]
    d = markers[MARKER + POSITION : MARKER + POSITION + 3] - markers[POSITION : POSITION + 3]
    rate = markers[MARKER + VELOCITY : MARKER + VELOCITY + 3] - markers[VELOCITY : VELOCITY + 3] - cross(omega, d)
    n = _turned(rotation, numbers[at.NORMAL : at.NORMAL + 3])
    spin = _turned_back(rotation, cross(omega - omega_0, d) - radius * cross(omega_1 - omega_0, n))
    numbers[at.DISTANCE : at.DISTANCE + 3] = _turned_back(rotation, d)
    numbers[at.RATE : at.RATE + 3] = _turned_back(rotation, rate)
    for i in range(2):
        axis = numbers[at.AXIS_1 + 3 * i : at.AXIS_1 + 3 * i + 3]
        numbers[at.SPIN + i] = axis[0] * spin[0] + axis[1] * spin[1] + axis[2] * spin[2]


@compiled
def push(t, markers, address, frame, radius, out):
    """Put forces [N] and torques [N m] at time t into ``out``, shape (OUTCOME,); nothing is committed.

    On body 1 act the force f at the point of contact, that is f and -radius n x f at marker 1; on body 0 the opposite
    force at the same point, of which a connector applies -f and radius n x f at marker 0, and -d x f is left.
    """
    take_motion(markers, address, frame, radius)
    numbers, words = at.arrays(address)
    force_now(t, address, out.ctypes.data)
    rotation, _ = _frame(markers, frame)
    axes = [numbers[at.AXIS_1 : at.AXIS_1 + 3], numbers[at.AXIS_2 : at.AXIS_2 + 3], numbers[at.NORMAL : at.NORMAL + 3]]
    n = _turned(rotation, axes[2])
    friction = _turned(rotation, out[0] * axes[0] + out[1] * axes[1])
    f = friction + out[2] * n if words[at.PENALTY] == 1 else friction
    d = markers[MARKER + POSITION : MARKER + POSITION + 3] - markers[POSITION : POSITION + 3]
    to_0 = markers[ROTATION : ROTATION + 9]
    out[PULL : PULL + 3] = -_turned_back(to_0, f)
    out[PULL_GLOBAL : PULL_GLOBAL + 3] = -f
    out[PULL_TORQUE : PULL_TORQUE + 3] = radius * _turned_back(to_0, cross(n, f))
    out[LEVER : LEVER + 3] = -cross(d, f)
    out[GLOBAL : GLOBAL + 3] = friction
