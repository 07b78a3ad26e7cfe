# type: ignore
# (kernels are typed by Warp)
"""The kernel that steers MuJoCo Warp's constraint solver at a joint or tendon, through its ``frictionloss`` row.

As at contacts (`stochfric_mb.warp.contacts`), with one row: no cone turns friction into normal force, so that a sliding joint
is simply asked to be at rest at the end of the step, and the row's mass is free.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.warp.contacts import PUSHED, SATURATED
from stochfric_mb.warp.law import Touch, coefficient_functions, rest_rules, slide_function
from stochfric_mb.warp.state import STICK, STOPPING, Rows, Worlds


@functools.cache
def hold_kernel(kind: str, clock: float) -> Any:
    """Return the kernel for a law's kind and a coefficient process's clock."""
    slide, (decide, stuck_row) = slide_function(kind), rest_rules(kind)
    coefficients = coefficient_functions()[0]
    OWN_PATH = clock != TIME  # noqa: N806  # as MuJoCo Warp writes what a kernel is made for

    @wp.kernel(module="unique", enable_backward=False)
    def hold(
        type_wanted: int,
        id_wanted: int,
        load: float,
        mobility: float,
        n_equality: wp.array[int],
        n_friction: wp.array[int],
        row_type: wp.array2d[int],
        row_id: wp.array2d[int],
        timestep: wp.array[float],
        velocity: wp.array2d[float],
        force: wp.array2d[float],
        seed: wp.int64,
        contact: wp.int64,
        worlds: Worlds,
        rows: Rows,
        mass: wp.array2d[float],
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
        v = wp.vec2(velocity[w, row], 0.0)
        speed = wp.length(v)
        peak = worlds.peak_speed[w]
        still = wp.max(worlds.stick_speed[w], peak)
        felt = 1.0 / wp.max(mobility, 1.0e-12)

        touch = Touch()
        touch.mode = wp.where(speed > still, STOPPING, STICK)
        touch.urgency = PUSHED
        touch.load = load
        touch.path = worlds.origin
        if worlds.count[w] > 0 and rows.row[old, w] >= 0:
            if worlds.fresh[w] == 1:
                rows.force[old, w] = force[w, rows.row[old, w]]
            touch.mode = rows.mode[old, w]
            touch.drift = wp.vec2(rows.drift[old, w], 0.0)
            touch.pull = wp.vec2(rows.force[old, w], 0.0)
            touch.creep = rows.creep[old, w]
            touch.events = rows.events[old, w]
            touch.path = rows.path[old, w] - wp.float64(h * v[0])
            touch.mu_s = rows.mu_s[old, w]
            touch.mu_k = rows.mu_k[old, w]
            full = wp.where(wp.length(touch.pull) >= SATURATED * rows.cap[old, w], 1, 0)
            was = touch.mode
            if was != STICK:
                touch.drift = wp.vec2(0.0)
            stoppable = still + h * mobility * touch.mu_s * load
            touch = decide(touch, v, h, stoppable, peak, full, full, felt, worlds.parameters[w])
            if was != STICK and touch.mode == STICK:
                touch.events += 1
        touch.mu_s = worlds.mu_s[w]
        touch.mu_k = worlds.mu_k[w]
        if wp.static(OWN_PATH):
            a, b = coefficients(
                worlds.descriptor[w], worlds.cursor[w], seed, worlds.sample[w], contact, wp.float64(0.0), touch.path,
                wp.float64(touch.events),
            )  # fmt: skip
            touch.mu_s = float(a)
            touch.mu_k = float(b)
            worlds.mu_s[w] = touch.mu_s
            worlds.mu_k[w] = touch.mu_k

        cap = wp.float32(0.0)
        if touch.mode == STICK:
            total, stiffness, cap_at_rest = stuck_row(touch, 1.0 / mass[w, row], h, peak, felt, worlds.parameters[w])
            cap = cap_at_rest
            mass[w, row] = 1.0 / total
            reference[w, row] = -v[0] / h - stiffness * touch.drift[0]
        else:
            touch.mode = STOPPING
            touch.drift = wp.vec2(0.0)
            cap = slide(speed, touch.mu_s, touch.mu_k, worlds.parameters[w])
            reference[w, row] = -v[0] / h
        frictionloss[w, row] = cap * load
        rows.cap[new, w] = cap * load
        rows.force[new, w] = 0.0
        rows.drift[new, w] = touch.drift[0]
        rows.creep[new, w] = touch.creep
        rows.events[new, w] = touch.events
        rows.path[new, w] = touch.path
        rows.mu_s[new, w] = touch.mu_s
        rows.mu_k[new, w] = touch.mu_k
        rows.mode[new, w] = touch.mode

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
