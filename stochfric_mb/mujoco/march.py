"""The compiled step loop: MuJoCo's own ``mj_step``, called from C, sampled at the output times."""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.contact.kinematics import side
from stochfric_mb.mujoco.contact.tracking import normal_force
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import contact_at, data_at
from stochfric_mb.mujoco.plugin.sensor import report
from stochfric_mb.numerics import memory as w

COLUMNS = 7
"""Position, velocity, friction force along x, normal force, mu_s, mu_k, stick."""


@compiled
def march(model, data, state, joint, foot, amplitude, frequency, step, first, last, per_output, rows):
    """Fill ``rows``, shape (n, COLUMNS), with samples ``per_output`` engine steps apart; return how many are finite.

    The first row is sampled before any step. Model, data and the friction's state are given by their addresses, ``joint`` by
    its coordinate's number. Actuator ``foot`` moves the spring's foot by amplitude [m] times cos(frequency [rad/s] t).
    ``first`` is the number since t = 0 of the first step [s], ``last`` that of the step that is not taken any more.
    """
    control = data_at(data).ctrl
    number = first
    for i in range(len(rows)):
        w.put(control, foot, amplitude * math.cos(frequency * (number * step)))
        engine.mj_forward(model, data)
        sample(model, data, state, joint, rows[i])
        if not math.isfinite(rows[i, 0] + rows[i, 1]):
            return i
        for _ in range(min(per_output, last - number)):
            w.put(control, foot, amplitude * math.cos(frequency * ((number + 0.5) * step)))
            engine.mj_step(model, data)
            number += 1
    return len(rows)


@compiled
def sample(model, data, state, joint, row):
    """Fill one row from the data and the friction's slots, both current."""
    d, header = data_at(data), s.header_record(state)
    row[0], row[1] = w.at(d.qpos, joint), w.at(d.qvel, joint)
    row[2:] = 0.0
    block = report(model, data, state)
    for k in range(int(header.n_current if block == 1 else header.n_committed)):
        slot = s.slot_at(state, block, k)
        row[2] += slot.fx * slot.axis_1[0] + slot.fy * slot.axis_2[0]
        if k == 0:
            row[4], row[5], row[6] = slot.mu_s, slot.mu_k, slot.stick
    for i in range(d.ncon):
        contact = contact_at(d, i)
        if side(contact, int(header.geom_body), int(header.geom_surface)) != 0:
            row[3] += normal_force(d, contact)
