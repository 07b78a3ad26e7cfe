# type: ignore
# (kernels are typed by Warp)
"""The kernels that steer MuJoCo Warp's constraint solver at contacts.

They run in ``Model.callback.passive``: contacts and their constraint rows are there, the solver has not run, and it reads
``contact.friction``, ``efc.aref``, ``efc.D`` and ``efc.J`` live. A row of the solver gives the force D (reference -
acceleration) within its cap. `learn` reads what the solver found in the step before, `steer` writes what it is to do now.

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
def found_force(force: wp.array2d[float], w: int, slots: Slots, old: int, i: int):
    """Write what the solver found for a slot: its forces, and whether friction reached its cap."""
    rows = slots.rows[old, w, i]
    friction = slots.friction[old, w, i]
    normal = wp.max(force[w, rows[0]], 0.0)
    pull = slots.scale[old, w, i] * wp.vec2(force[w, rows[0] + 1], force[w, rows[0] + 2])
    slots.normal[old, w, i] = normal
    slots.pull[old, w, i] = pull[0] * slots.axis_1[old, w, i] + pull[1] * slots.axis_2[old, w, i]
    total = wp.float32(0.0)
    sliding = wp.float32(0.0)
    for j in range(1, rows[1]):
        part = force[w, rows[0] + j] / friction[j - 1]
        total += part * part
        if j == 2:
            sliding = total
    full = normal > 0.0 and wp.sqrt(total) >= SATURATED * normal and wp.sqrt(sliding) >= SLIDING_SHARE * normal
    slots.saturated[old, w, i] = wp.where(full, 1, 0)


@wp.kernel(module="unique", enable_backward=False)
def learn(force: wp.array2d[float], body: wp.array[int], worlds: Worlds, slots: Slots):
    """Read the forces of the step before, and find the contacts at their cap among which none of two bodies' holds less."""
    w = wp.tid()
    if worlds.fresh[w] == 0 or worlds.count[w] < 1:
        return
    old = 1 - worlds.count[w] % 2
    for i in range(slots.used[old, w]):
        found_force(force, w, slots, old, i)
    for i in range(slots.used[old, w]):
        loose = slots.saturated[old, w, i]
        if loose == 1:
            its = slots.geoms[old, w, i]
            for j in range(slots.used[old, w]):
                other = slots.geoms[old, w, j]
                same = body[other[0]] == body[its[0]] and body[other[1]] == body[its[1]]
                if same and slots.saturated[old, w, j] == 0 and slots.normal[old, w, j] > 0.0:
                    loose = 0
        slots.loose[old, w, i] = loose


@wp.func
def nearest_slot(slots: Slots, old: int, w: int, geoms: wp.vec2i, place: wp.vec3):
    """Return the slot of the step before that lies nearest among those of the same two geoms, -1 if there is none."""
    best = wp.int32(-1)
    least = wp.float32(1.0e30)
    for i in range(slots.used[old, w]):
        its = slots.geoms[old, w, i]
        if its[0] == geoms[0] and its[1] == geoms[1]:
            distance = wp.length_sq(slots.place[old, w, i] - place)
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
    touch.mode = slots.mode[old, w, i]
    touch.load = slots.normal[old, w, i]
    touch.pull = on_axes(now, slots.pull[old, w, i])
    if touch.mode == STICK:
        touch.drift = on_axes(now, slots.drift[old, w, i])
    touch.acceleration = (now.v - on_axes(now, slots.velocity[old, w, i])) / now.h
    touch.mu_s = slots.mu_s[old, w, i]
    touch.mu_k = slots.mu_k[old, w, i]
    touch.creep = slots.creep[old, w, i]
    touch.springs = slots.springs[old, w, i]
    touch.events = slots.events[old, w, i]
    moved = now.h * wp.dot(now.direction, now.v[0] * now.axis_1 + now.v[1] * now.axis_2)
    touch.path = slots.path[old, w, i] + wp.float64(float(now.side) * moved)
    return touch


@wp.func
def reserve(worlds: Worlds, slots: Slots, new: int, w: int):
    """Return the next free slot of a world, -1 if there is none."""
    k = wp.atomic_add(slots.used, new, w, 1)
    if k < slots.geoms.shape[2]:
        return k
    wp.atomic_sub(slots.used, new, w, 1)
    wp.atomic_add(worlds.overflow, w, 1)
    return -1


@wp.func
def keep(slots: Slots, new: int, w: int, k: int, now: Now, touch: Touch):
    """Write a contact into its slot."""
    slots.axis_1[new, w, k] = now.axis_1
    slots.axis_2[new, w, k] = now.axis_2
    slots.side[new, w, k] = now.side
    slots.scale[new, w, k] = touch.scale
    slots.mu_s[new, w, k] = touch.mu_s
    slots.mu_k[new, w, k] = touch.mu_k
    slots.normal[new, w, k] = 0.0
    slots.saturated[new, w, k] = 0
    slots.loose[new, w, k] = 0
    slots.drift[new, w, k] = touch.drift[0] * now.axis_1 + touch.drift[1] * now.axis_2
    slots.velocity[new, w, k] = now.v[0] * now.axis_1 + now.v[1] * now.axis_2
    slots.creep[new, w, k] = touch.creep
    slots.springs[new, w, k] = touch.springs
    slots.path[new, w, k] = touch.path
    slots.events[new, w, k] = touch.events
    slots.mode[new, w, k] = touch.mode


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
                    touch, now.v, now.h, stoppable, now.peak, slots.saturated[old, w, i], slots.loose[old, w, i],
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
            slots.geoms[new, w, k] = geoms
            slots.rows[new, w, k] = wp.vec2i(now.row, dim[c])
            slots.place[new, w, k] = place
            slots.friction[new, w, k] = friction[c]
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
            row = slots.rows[now, w, i][0]
            if force[w, row] > 0.0:
                loaded += 1
                pressing += force[w, row]
                mu_s += force[w, row] * slots.mu_s[now, w, i]
                mu_k += force[w, row] * slots.mu_k[now, w, i]
                vector = force[w, row + 1] * slots.axis_1[now, w, i] + force[w, row + 2] * slots.axis_2[now, w, i]
                # rows push the contact's second geom
                rubbing -= float(slots.side[now, w, i]) * slots.scale[now, w, i] * vector
                if slots.mode[now, w, i] != STICK:
                    stuck = 0
    normal_force[w] = pressing
    friction_force[w] = rubbing
    contacts[w] = loaded
    if slots.cursor.shape[0] > 0 and pressing > 0.0:  # each contact has its own
        worlds.mu_s[w] = mu_s / pressing
        worlds.mu_k[w] = mu_k / pressing
    stick[w] = wp.where(loaded > 0, stuck, 0)
