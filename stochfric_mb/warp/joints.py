# type: ignore
# (kernels are typed by Warp)
"""The kernel that steers MuJoCo Warp's constraint solver at a joint or tendon, through its ``frictionloss`` row.

As at contacts (`stochfric_mb.warp.contacts`), with one row: no cone turns friction into normal force, so that a sliding joint
is simply asked to be at rest at the end of the step.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.warp.cap import cap_function
from stochfric_mb.warp.contacts import DRAGGED, spring
from stochfric_mb.warp.state import STICK, STOPPING, Rows, Worlds

AT_CAP = wp.constant(0.9999)
"""A friction force counts as at its cap from here on."""


@functools.cache
def hold_kernel(kind: str) -> Any:
    """Return the kernel for the law of the given kind."""
    cap = cap_function(kind)

    @wp.kernel(module="unique", enable_backward=False)
    def hold(
        type_wanted: int,
        id_wanted: int,
        load: float,
        impedance: float,
        n_equality: wp.array[int],
        n_friction: wp.array[int],
        row_type: wp.array2d[int],
        row_id: wp.array2d[int],
        timestep: wp.array[float],
        velocity: wp.array2d[float],
        force: wp.array2d[float],
        mass: wp.array2d[float],
        worlds: Worlds,
        rows: Rows,
        frictionloss: wp.array2d[float],
        reference: wp.array2d[float],
    ):
        w = wp.tid()
        new = worlds.count[w] % 2
        old = 1 - new
        row = wp.int32(-1)
        for i in range(n_equality[w], n_equality[w] + n_friction[w]):
            if row_type[w, i] == type_wanted and row_id[w, i] == id_wanted:
                row = i
        rows.row[new, w] = row
        if row < 0:
            return
        h = timestep[w % timestep.shape[0]]
        v = velocity[w, row]
        limit = worlds.stick_speed[w]
        stiffness, damping = spring(h, impedance)
        mode = wp.where(wp.abs(v) > limit, STOPPING, STICK)
        drift = wp.float32(0.0)
        if worlds.count[w] > 0 and rows.row[old, w] >= 0:
            if worlds.fresh[w] == 1:
                rows.force[old, w] = force[w, rows.row[old, w]]
            found = rows.force[old, w]
            saturated = wp.abs(found) >= AT_CAP * rows.cap[old, w]
            mode = rows.mode[old, w]
            if mode == STICK:
                drift = rows.drift[old, w]
                if saturated and wp.abs(v) > limit:
                    mode = STOPPING
                elif saturated:
                    acceleration = (v - rows.velocity[old, w]) / h
                    drift = -(acceleration + DRAGGED * found / mass[w, row] + damping * v) / stiffness
                else:
                    drift += h * v
            elif not saturated:
                mode = STICK
        mu = worlds.mu_s[w]
        asked = -damping * v - stiffness * drift
        if mode != STICK:
            drift = 0.0
            mu = cap(wp.abs(v), 2.0 * limit, worlds.mu_s[w], worlds.mu_k[w], worlds.parameters[w])
            asked = -v / h
        frictionloss[w, row] = mu * load
        reference[w, row] = asked
        rows.cap[new, w] = mu * load
        rows.force[new, w] = 0.0
        rows.drift[new, w] = drift
        rows.velocity[new, w] = v
        rows.mode[new, w] = mode

    return hold


@wp.kernel(module="unique", enable_backward=False)
def observe_row(
    force: wp.array2d[float], worlds: Worlds, rows: Rows, friction_force: wp.array[float], stick: wp.array[int]
):  # fmt: skip
    """Write the friction force in the joint's coordinate, and whether it sticks, of each world."""
    w = wp.tid()
    now = worlds.count[w] % 2
    friction_force[w] = 0.0
    stick[w] = 0
    if worlds.count[w] >= 0 and rows.row[now, w] >= 0:
        friction_force[w] = force[w, rows.row[now, w]]
        stick[w] = wp.where(rows.mode[now, w] == STICK, 1, 0)
