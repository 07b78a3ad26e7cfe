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
from stochfric_mb.warp.contacts import SATURATED
from stochfric_mb.warp.law import Touch, coefficient_functions, felt_mass, rest_rules, slide_function
from stochfric_mb.warp.state import SLIP, STICK, Rows, Worlds


@wp.func
def friction_row(
    w: int, type_wanted: int, id_wanted: int, n_equality: wp.array[int], n_friction: wp.array[int], row_type: wp.array2d[int],
    row_id: wp.array2d[int],
):  # fmt: skip
    """Return the friction row of the joint or tendon, -1 if it has none."""
    row = wp.int32(-1)
    for i in range(n_equality[w], n_equality[w] + n_friction[w]):
        if row_type[w, i] == type_wanted and row_id[w, i] == id_wanted:
            row = i
    return row


@wp.func
def recalled(rows: Rows, old: int, w: int, moved: float, load: float):
    """Return the joint as the step before left it, before its law decides whether it sticks."""
    touch = Touch()
    touch.load = load
    touch.mode = rows.mode[old, w]
    if touch.mode == STICK:
        touch.drift = wp.vec2(rows.drift[old, w], 0.0)
    touch.pull = wp.vec2(rows.force[old, w], 0.0)
    touch.creep = rows.creep[old, w]
    touch.springs = rows.springs[old, w]
    touch.events = rows.events[old, w]
    touch.path = rows.path[old, w] - wp.float64(moved)
    touch.mu_s = rows.mu_s[old, w]
    touch.mu_k = rows.mu_k[old, w]
    return touch


@wp.func
def keep(rows: Rows, new: int, w: int, cap: float, touch: Touch):
    """Write the joint into its set."""
    rows.cap[new, w] = cap
    rows.force[new, w] = 0.0
    rows.drift[new, w] = touch.drift[0]
    rows.creep[new, w] = touch.creep
    rows.springs[new, w] = touch.springs
    rows.events[new, w] = touch.events
    rows.path[new, w] = touch.path
    rows.mu_s[new, w] = touch.mu_s
    rows.mu_k[new, w] = touch.mu_k
    rows.mode[new, w] = touch.mode


@functools.cache
def path_rule(clock: float) -> Any:
    """Return the Warp function that gives a joint its coefficients: its world's, along time or along its own path."""
    path = coefficient_functions()[0]

    @wp.func
    def of_world(touch: Touch, worlds: Worlds, w: int, seed: wp.int64, contact: wp.int64):
        touch.mu_s = worlds.mu_s[w]
        touch.mu_k = worlds.mu_k[w]
        return touch

    @wp.func
    def own(touch: Touch, worlds: Worlds, w: int, seed: wp.int64, contact: wp.int64):
        mu_s, mu_k = path(
            worlds.descriptor[w], worlds.cursor[w], seed, worlds.sample[w], contact, wp.float64(0.0), touch.path,
            wp.float64(touch.events),
        )  # fmt: skip
        touch.mu_s = float(mu_s)
        touch.mu_k = float(mu_k)
        worlds.mu_s[w] = touch.mu_s
        worlds.mu_k[w] = touch.mu_k
        return touch

    return of_world if clock == TIME else own


@functools.cache
def hold_kernel(kind: str, clock: float) -> Any:
    """Return the kernel for a law's kind and a coefficient process's clock."""
    slide, (decide, stuck_row), coefficients = slide_function(kind), rest_rules(kind), path_rule(clock)

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
        row = friction_row(w, type_wanted, id_wanted, n_equality, n_friction, row_type, row_id)
        rows.row[new, w] = row
        if row < 0:
            return
        h = timestep[w % timestep.shape[0]]
        v = wp.vec2(velocity[w, row], 0.0)
        peak = worlds.peak_speed[w]
        still = wp.max(worlds.stick_speed[w], peak)
        felt = felt_mass(mobility)
        touch = Touch()
        touch.mode = wp.where(wp.length(v) > still, SLIP, STICK)
        touch.load = load
        touch.path = worlds.origin
        if worlds.count[w] > 0 and rows.row[old, w] >= 0:
            if worlds.fresh[w] == 1:
                rows.force[old, w] = force[w, rows.row[old, w]]
            touch = recalled(rows, old, w, h * v[0], load)
            was = int(touch.mode)  # a copy
            full = wp.where(wp.length(touch.pull) >= SATURATED * rows.cap[old, w], 1, 0)
            stoppable = still + h * mobility * touch.mu_s * load
            touch = decide(touch, v, h, stoppable, peak, full, full, felt, worlds.parameters[w])
            if was != STICK and touch.mode == STICK:
                touch.events += 1
        touch = coefficients(touch, worlds, w, seed, contact)
        cap = wp.float32(0.0)
        reference[w, row] = -v[0] / h
        if touch.mode == STICK:
            total, stiffness, cap_at_rest, springs = stuck_row(
                touch, 1.0 / mass[w, row], h, peak, felt, worlds.parameters[w]
            )  # fmt: skip
            touch.springs = springs
            cap = cap_at_rest
            mass[w, row] = 1.0 / total
            reference[w, row] = -v[0] / h - stiffness * touch.drift[0]
        else:
            touch.mode = SLIP
            touch.drift = wp.vec2(0.0)
            cap = slide(wp.length(v), touch.mu_s, touch.mu_k, worlds.parameters[w])
        frictionloss[w, row] = cap * load
        keep(rows, new, w, cap * load, touch)

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
