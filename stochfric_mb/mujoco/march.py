"""The compiled step loop: MuJoCo's own ``mj_step``, called from C, sampled at the output times."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.kinematics import contact_address, side

COLUMNS = 7
"""Position, velocity, friction force along x, normal force, mu_s, mu_k, stick."""


@compiled
def march(model, data, state, joint, foot, amplitude, frequency, step, first, last, per_output, rows):
    """Fill ``rows`` with samples, ``per_output`` engine steps apart; return how many are finite.

    Args:
        model: address of the model.
        data: address of the data.
        state: address of the friction's state.
        joint: number of the slide joint's coordinate.
        foot: number of the actuator whose control is the displacement of the spring's foot.
        amplitude: amplitude of the foot [m].
        frequency: angular frequency of the foot [rad/s].
        step: engine step [s].
        first: number of the first step since t = 0.
        last: number of the step that is not taken any more.
        per_output: steps between rows.
        rows: shape (n, COLUMNS), filled here; the first row is sampled before any step.
    """
    control = n.pointer_field(data, n.D_CTRL) + 8 * foot
    number = first
    for i in range(len(rows)):
        n.store(control, amplitude * math.cos(frequency * (number * step)))
        n.mj_forward(model, data)
        sample(model, data, state, joint, rows[i])
        if not math.isfinite(rows[i, 0] + rows[i, 1]):
            return i
        for _ in range(min(per_output, last - number)):
            n.store(control, amplitude * math.cos(frequency * ((number + 0.5) * step)))
            n.mj_step(model, data)
            number += 1
    return len(rows)


@compiled
def sample(model, data, state, joint, row):
    """Fill one row from the data and the friction's slots, both current."""
    row[0] = n.load(n.pointer_field(data, n.D_QPOS) + 8 * joint)
    row[1] = n.load(n.pointer_field(data, n.D_QVEL) + 8 * joint)
    row[2:] = 0.0
    for k in range(int(n.load(state + 8 * s.N_CURRENT))):
        address = slot(state, 1, k)
        row[2] += n.load(address + 8 * s.FX) * n.load(address + 8 * s.AXIS_1)
        row[2] += n.load(address + 8 * s.FY) * n.load(address + 8 * s.AXIS_2)
        if k == 0:
            row[4] = n.load(address + 8 * s.MU_S)
            row[5] = n.load(address + 8 * s.MU_K)
            row[6] = n.load(address + 8 * s.STICK)
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    wrench = np.empty(6)
    for i in range(n.int_field(data, n.D_NCON)):
        if side(contact_address(data, i), body, surface) != 0:
            n.mj_contactForce(model, data, np.int32(i), wrench.ctypes.data)
            row[3] += wrench[0]
