# type: ignore
# (kernels are typed by Warp)
"""The kernels that steer MuJoCo Warp's constraint solver at contacts.

They run in ``Model.callback.passive``: contacts and their constraint rows are there, the solver has not run, and it reads
``contact.friction``, ``efc.aref``, ``efc.D`` and ``efc.J`` live. A row of the solver gives the force D (reference -
acceleration) within its cap. `learn` reads the solver's forces of the step before, `steer` writes its bounds for this step.

*Stick*: the cap is mu_s, and the two tangential rows get a position reference, which makes MuJoCo's tangential damper a spring:
it holds. The law says how stiff the row is: rigid, elastic, or in series with a damper where a law creeps at rest
(`stochfric_mb.warp.law`). Warp's cone ties D of tangential rows to that of the normal row; a softer row is made by scaling its
Jacobian instead. A contact at its cap keeps its reference while others hold the bodies; once none of them holds less than its
cap, all of them slide.

*Slip*: the cap is the law's coefficient at the present speed. The reference asks for rest at the end of the step, so that
friction never pushes along the motion. What the cone makes of it in the normal direction, the lift of a sliding contact, is
taken out of the normal row. Where the cap was not needed, the contact sticks.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.mujoco.contact import solver
from stochfric_mb.warp.law import Touch, felt_mass, rest_rules
from stochfric_mb.warp.rows import Now, allow, hold_rule, on_axes, path_direction, path_rule, seen, slide_rule
from stochfric_mb.warp.state import SLIP, STICK, Slots, Worlds, vec5

SATURATED = wp.constant(solver.SATURATED)
"""Share of the cap from which on a force counts as at its cap."""
SLIDING_SHARE = wp.constant(solver.SLIDING_SHARE)
"""Least share of the cap that sliding friction has where a contact slides and torsion or rolling does not do it alone."""


@wp.func
def store_solver_force(force: wp.array2d[float], w: int, slots: Slots, old: int, i: int):
    """Write the solver's forces of a slot, and whether friction reached its cap."""
    rows = slots.rows[old, i, w]
    friction = slots.friction[old, i, w]
    normal = wp.max(force[w, rows[0]], 0.0)
    pull = slots.scale[old, i, w] * wp.vec2(force[w, rows[0] + 1], force[w, rows[0] + 2])
    slots.normal[old, i, w] = normal
    slots.pull[old, i, w] = pull[0] * slots.axis_1[old, i, w] + pull[1] * slots.axis_2[old, i, w]
    total = wp.float32(0.0)
    sliding = wp.float32(0.0)
    for j in range(1, rows[1]):
        part = force[w, rows[0] + j] / friction[j - 1]
        total += part * part
        if j == 2:
            sliding = total
    full = normal > 0.0 and wp.sqrt(total) >= SATURATED * normal and wp.sqrt(sliding) >= SLIDING_SHARE * normal
    slots.saturated[old, i, w] = wp.where(full, 1, 0)


@wp.kernel(module="unique", enable_backward=False)
def learn(force: wp.array2d[float], body: wp.array[int], worlds: Worlds, slots: Slots):
    """Read the forces of the step before, and find the contacts at their cap among which none of two bodies' holds less."""
    w = wp.tid()
    if worlds.fresh[w] == 0 or worlds.count[w] < 1:
        return
    old = 1 - worlds.count[w] % 2
    for i in range(slots.used[old, w]):
        store_solver_force(force, w, slots, old, i)
    for i in range(slots.used[old, w]):
        loose = slots.saturated[old, i, w]
        if loose == 1:
            its = slots.geoms[old, i, w]
            for j in range(slots.used[old, w]):
                other = slots.geoms[old, j, w]
                same = body[other[0]] == body[its[0]] and body[other[1]] == body[its[1]]
                if same and slots.saturated[old, j, w] == 0 and slots.normal[old, j, w] > 0.0:
                    loose = 0
        slots.loose[old, i, w] = loose


@wp.func
def nearest_slot(slots: Slots, old: int, w: int, geoms: wp.vec2i, place: wp.vec3):
    """Return the slot of the step before that lies nearest among those of the same two geoms, -1 if there is none."""
    best = wp.int32(-1)
    least = wp.float32(1.0e30)
    for i in range(slots.used[old, w]):
        its = slots.geoms[old, i, w]
        if its[0] == geoms[0] and its[1] == geoms[1]:
            distance = wp.length_sq(slots.place[old, i, w] - place)
            if distance < least:
                least = distance
                best = i
    return best


@wp.func
def born(now: Now, still: float, origin: wp.float64):
    """Return a new contact: sliding if it is faster than the law's stick speed (or peak speed), otherwise stuck."""
    touch = Touch()
    touch.mode = wp.where(now.speed > still, SLIP, STICK)
    touch.path = origin
    return touch


@wp.func
def recalled(slots: Slots, old: int, w: int, i: int, now: Now):
    """Return a contact that had slot ``i``, before its law decides whether it sticks."""
    touch = Touch()
    touch.mode = slots.mode[old, i, w]
    touch.load = slots.normal[old, i, w]
    touch.pull = on_axes(now, slots.pull[old, i, w])
    if touch.mode == STICK:
        touch.drift = on_axes(now, slots.drift[old, i, w])
    touch.acceleration = (now.v - on_axes(now, slots.velocity[old, i, w])) / now.h
    touch.mu_s = slots.mu_s[old, i, w]
    touch.mu_k = slots.mu_k[old, i, w]
    touch.creep = slots.creep[old, i, w]
    touch.springs = slots.springs[old, i, w]
    touch.events = slots.events[old, i, w]
    moved = now.h * wp.dot(now.direction, now.v[0] * now.axis_1 + now.v[1] * now.axis_2)
    touch.path = slots.path[old, i, w] + wp.float64(float(now.side) * moved)
    return touch


@wp.func
def reserve(worlds: Worlds, slots: Slots, new: int, w: int):
    """Return the next free slot of a world, -1 if there is none."""
    k = wp.atomic_add(slots.used, new, w, 1)
    if k < slots.geoms.shape[1]:
        return k
    wp.atomic_sub(slots.used, new, w, 1)
    wp.atomic_add(worlds.overflow, w, 1)
    return -1


@wp.func
def keep(slots: Slots, new: int, w: int, k: int, now: Now, touch: Touch):
    """Write a contact into its slot."""
    slots.axis_1[new, k, w] = now.axis_1
    slots.axis_2[new, k, w] = now.axis_2
    slots.side[new, k, w] = now.side
    slots.scale[new, k, w] = touch.scale
    slots.mu_s[new, k, w] = touch.mu_s
    slots.mu_k[new, k, w] = touch.mu_k
    slots.normal[new, k, w] = 0.0
    slots.saturated[new, k, w] = 0
    slots.loose[new, k, w] = 0
    slots.drift[new, k, w] = touch.drift[0] * now.axis_1 + touch.drift[1] * now.axis_2
    slots.velocity[new, k, w] = now.v[0] * now.axis_1 + now.v[1] * now.axis_2
    slots.creep[new, k, w] = touch.creep
    slots.springs[new, k, w] = touch.springs
    slots.path[new, k, w] = touch.path
    slots.events[new, k, w] = touch.events
    slots.mode[new, k, w] = touch.mode


@wp.func
def ours(c: int, geom: wp.array[wp.vec2i], address: wp.array2d[int], dim: wp.array[int], partners: wp.array2d[int]):
    """Return whether a contact has friction rows and is of the geoms asked for."""
    geoms = geom[c]
    if geoms[0] < 0 or geoms[1] < 0 or address[c, 0] < 0 or dim[c] < 3:
        return False
    return partners[geoms[0], geoms[1]] != 0


@functools.cache
def steer_kernel(kind: str, clock: float) -> Any:
    """Return the kernel that steers the solver at each contact, for a law's kind and a coefficient process's clock."""
    decide, hold, let_slide, coefficients = rest_rules(kind)[0], hold_rule(kind), slide_rule(kind), path_rule(clock)

    @wp.kernel(module="unique", enable_backward=False)
    def steer(
        stride: int,
        nacon: wp.array[int],
        geom: wp.array[wp.vec2i],
        world: wp.array[int],
        dim: wp.array[int],
        address: wp.array2d[int],
        frame: wp.array[wp.mat33],
        position: wp.array[wp.vec3],
        belt: wp.array[wp.vec3],
        geom_position: wp.array2d[wp.vec3],
        geom_body: wp.array[int],
        mobility: wp.array2d[wp.vec2],
        timestep: wp.array[float],
        impratio: wp.array[float],
        gravity: wp.array[wp.vec3],
        velocity: wp.array2d[float],
        sparse: bool,
        filled: wp.array2d[int],
        first: wp.array2d[int],
        partners: wp.array2d[int],
        seed: wp.int64,
        contact: wp.int64,
        worlds: Worlds,
        slots: Slots,
        friction: wp.array[vec5],
        mass: wp.array2d[float],
        reference: wp.array2d[float],
        jacobian: wp.array3d[float],
    ):
        for c in range(wp.tid(), wp.min(nacon[0], geom.shape[0]), stride):
            if not ours(c, geom, address, dim, partners):
                continue
            w = world[c]
            new = worlds.count[w] % 2
            k = reserve(worlds, slots, new, w)
            if k < 0:
                continue
            geoms = geom[c]
            now = seen(w, address[c, 0], frame[c], velocity, timestep[w % timestep.shape[0]], worlds.peak_speed[w])
            bodies = wp.vec2i(geom_body[geoms[0]], geom_body[geoms[1]])
            now.mobility = mobility[w % mobility.shape[0], bodies[0]][0] + mobility[w % mobility.shape[0], bodies[1]][0]
            now.direction = path_direction(now.normal, belt[c][0] * now.axis_1 + belt[c][1] * now.axis_2)
            now.side = partners[geoms[0], geoms[1]]
            place = position[c] - geom_position[w, geoms[1]]
            old = 1 - new
            i = nearest_slot(slots, old, w, geoms, place)
            touch = born(now, wp.max(worlds.stick_speed[w], now.peak), worlds.origin)
            if i >= 0:
                touch = recalled(slots, old, w, i, now)
                was = int(touch.mode)  # a copy
                stoppable = (
                    wp.max(worlds.stick_speed[w], now.peak) + now.h * now.mobility * touch.mu_s * touch.load
                )  # no contact sticks that friction could not stop within a step
                touch = decide(
                    touch, now.v, now.h, stoppable, now.peak, slots.saturated[old, i, w], slots.loose[old, i, w],
                    felt_mass(now.mobility), worlds.parameters[w],
                )  # fmt: skip
                if was != STICK and touch.mode == STICK:
                    touch.events += 1
            touch = coefficients(touch, worlds, slots, new, w, k, seed, contact)
            if touch.mode == STICK:
                touch = hold(touch, now, worlds.parameters[w], sparse, filled, first, mass, reference, jacobian)
            else:
                weight = wp.length(gravity[w % gravity.shape[0]])
                touch = let_slide(
                    touch, now, worlds.parameters[w], impratio[w % impratio.shape[0]], weight, mass, reference
                )  # fmt: skip
            allow(friction, c, dim[c], now, touch, mass)
            slots.geoms[new, k, w] = geoms
            slots.rows[new, k, w] = wp.vec2i(now.row, dim[c])
            slots.place[new, k, w] = place
            slots.friction[new, k, w] = friction[c]
            keep(slots, new, w, k, now, touch)

    return steer


@wp.kernel(module="unique", enable_backward=False)
def observe(
    force: wp.array2d[float],
    worlds: Worlds,
    slots: Slots,
    normal_force: wp.array[float],
    friction_force: wp.array[wp.vec3],
    stick: wp.array[int],
    contacts: wp.array[int],
):
    """Write the sums of the forces over the contacts of each world, whether all of them stick, and their mean coefficients."""
    w = wp.tid()
    now = worlds.count[w] % 2
    pressing = wp.float32(0.0)
    rubbing = wp.vec3(0.0)
    loaded = wp.int32(0)
    stuck = wp.int32(1)
    mu_s = wp.float32(0.0)
    mu_k = wp.float32(0.0)
    if worlds.count[w] >= 0:
        for i in range(slots.used[now, w]):
            row = slots.rows[now, i, w][0]
            if force[w, row] > 0.0:
                loaded += 1
                pressing += force[w, row]
                mu_s += force[w, row] * slots.mu_s[now, i, w]
                mu_k += force[w, row] * slots.mu_k[now, i, w]
                vector = force[w, row + 1] * slots.axis_1[now, i, w] + force[w, row + 2] * slots.axis_2[now, i, w]
                # rows push the contact's second geom
                rubbing -= float(slots.side[now, i, w]) * slots.scale[now, i, w] * vector
                if slots.mode[now, i, w] != STICK:
                    stuck = 0
    normal_force[w] = pressing
    friction_force[w] = rubbing
    contacts[w] = loaded
    if slots.cursor.shape[0] > 0 and pressing > 0.0:  # each contact has its own
        worlds.mu_s[w] = mu_s / pressing
        worlds.mu_k[w] = mu_k / pressing
    stick[w] = wp.where(loaded > 0, stuck, 0)
