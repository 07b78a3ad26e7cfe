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

*Slip*: the cap is the law's coefficient at the present speed. The reference asks for the acceleration of the step before, less
twice what the cap is worth in the row, or for rest at the end of the step, whichever is less. So the row stays at its cap and
not far beyond, which float32 needs. What the cone makes of it in the normal direction, the lift of a sliding contact, is taken
out of the normal row. Where it asked for rest and the cap was not needed, the contact sticks.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.mujoco.contact import solver
from stochfric_mb.warp.law import Touch, coefficient_functions, rest_rules, slide_function
from stochfric_mb.warp.state import SLIP, STICK, STOPPING, Slots, Worlds, vec5

SATURATED = wp.constant(solver.SATURATED)
"""Share of the cap from which on a force counts as at its cap."""
SLIDING_SHARE = wp.constant(solver.SLIDING_SHARE)
"""Least share of the cap that sliding friction has where a contact slides and torsion or rolling does not do it alone."""
LEAST_FRICTION = wp.constant(1.0e-5)
"""MuJoCo's mjMINMU."""
LEAST_SPEED = wp.constant(1.0e-30)
"""Keeps the direction of a sliding contact at rest a number [m/s]."""
SOFTEST = wp.constant(1.0e-3)
"""Least scale of a row's Jacobian: it is as soft as one of 1e6 times its resistance."""
PUSHED = wp.constant(2.0)
"""Friction that a sliding contact is asked for, over the cap: the normal force may double in a step."""
MOST_URGENT = wp.constant(1024.0)
"""Bound of that ratio, which doubles with each step in which a sliding contact stays below its cap."""


@wp.func
def on_axes(axis_1: wp.vec3, axis_2: wp.vec3, vector: wp.vec3):
    """Return the two tangential components of a vector."""
    return wp.vec2(wp.dot(axis_1, vector), wp.dot(axis_2, vector))


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
                if body[other[0]] == body[its[0]] and body[other[1]] == body[its[1]]:
                    if slots.saturated[old, w, j] == 0 and slots.normal[old, w, j] > 0.0:
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
def recalled(slots: Slots, old: int, w: int, i: int, axis_1: wp.vec3, axis_2: wp.vec3, v: wp.vec2, h: float):
    """Return a contact that had slot ``i``, before its law decides whether it sticks."""
    touch = Touch()
    touch.mode = slots.mode[old, w, i]
    touch.load = slots.normal[old, w, i]
    touch.pull = on_axes(axis_1, axis_2, slots.pull[old, w, i])
    touch.drift = on_axes(axis_1, axis_2, slots.drift[old, w, i])
    touch.acceleration = (v - on_axes(axis_1, axis_2, slots.velocity[old, w, i])) / h
    touch.mu_s = slots.mu_s[old, w, i]
    touch.mu_k = slots.mu_k[old, w, i]
    touch.creep = slots.creep[old, w, i]
    touch.events = slots.events[old, w, i]
    touch.path = slots.path[old, w, i]
    touch.urgency = PUSHED
    if touch.mode == SLIP and slots.saturated[old, w, i] == 0:
        touch.urgency = wp.min(2.0 * slots.urgency[old, w, i], MOST_URGENT)
    return touch


@wp.func
def path_direction(normal: wp.vec3, belt: wp.vec3):
    """Return the direction along which a contact's displacement is counted: of the surface velocity, or the world's x."""
    chosen = wp.vec3(1.0, 0.0, 0.0)
    if wp.abs(normal[0]) >= 0.9:
        chosen = wp.vec3(0.0, 1.0, 0.0)
    if wp.length_sq(belt) > 0.0:
        chosen = belt
        if belt[0] + belt[1] + belt[2] < 0.0:
            chosen = -belt
    return wp.normalize(chosen - wp.dot(chosen, normal) * normal)


@wp.func
def soften(
    jacobian: wp.array3d[float], filled: wp.array2d[int], first: wp.array2d[int], sparse: bool, w: int, row: int, scale: float
):  # fmt: skip
    """Multiply a row of the Jacobian: its resistance, in terms of the force on the bodies, is divided by the square."""
    if sparse:
        for k in range(first[w, row], first[w, row] + filled[w, row]):
            jacobian[w, 0, k] = scale * jacobian[w, 0, k]
    else:
        for k in range(jacobian.shape[2]):
            jacobian[w, row, k] = scale * jacobian[w, row, k]


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
def keep(slots: Slots, new: int, w: int, k: int, axis_1: wp.vec3, axis_2: wp.vec3, v: wp.vec2, touch: Touch):
    """Write a contact into its slot."""
    slots.axis_1[new, w, k] = axis_1
    slots.axis_2[new, w, k] = axis_2
    slots.mu_s[new, w, k] = touch.mu_s
    slots.mu_k[new, w, k] = touch.mu_k
    slots.normal[new, w, k] = 0.0
    slots.saturated[new, w, k] = 0
    slots.loose[new, w, k] = 0
    slots.drift[new, w, k] = touch.drift[0] * axis_1 + touch.drift[1] * axis_2
    slots.velocity[new, w, k] = v[0] * axis_1 + v[1] * axis_2
    slots.urgency[new, w, k] = touch.urgency
    slots.creep[new, w, k] = touch.creep
    slots.path[new, w, k] = touch.path
    slots.events[new, w, k] = touch.events
    slots.mode[new, w, k] = touch.mode


@functools.cache
def steer_kernel(kind: str, clock: float) -> Any:
    """Return the kernel that steers the solver at each contact, for a law's kind and a coefficient process's clock."""
    slide, (decide, stuck_row) = slide_function(kind), rest_rules(kind)
    coefficients = coefficient_functions()[0]
    OWN_PATH = clock != TIME  # noqa: N806  # as MuJoCo Warp writes what a kernel is made for

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
            geoms = geom[c]
            row = address[c, 0]
            if geoms[0] < 0 or geoms[1] < 0 or row < 0 or dim[c] < 3:
                continue
            if partners[geoms[0], geoms[1]] == 0:
                continue
            w = world[c]
            new = worlds.count[w] % 2
            k = reserve(worlds, slots, new, w)
            if k < 0:
                continue
            h = timestep[w % timestep.shape[0]]
            normal = wp.vec3(frame[c][0, 0], frame[c][0, 1], frame[c][0, 2])
            axis_1 = wp.vec3(frame[c][1, 0], frame[c][1, 1], frame[c][1, 2])
            axis_2 = wp.vec3(frame[c][2, 0], frame[c][2, 1], frame[c][2, 2])
            side = partners[geoms[0], geoms[1]]
            v = wp.vec2(velocity[w, row + 1], velocity[w, row + 2])
            speed = wp.length(v)
            place = position[c] - geom_position[w, geoms[1]]
            some = w % mobility.shape[0]
            yielding = mobility[some, geom_body[geoms[0]]][0] + mobility[some, geom_body[geoms[1]]][0]
            felt = 1.0 / wp.max(yielding, 1.0e-12)
            parameters = worlds.parameters[w]
            peak = worlds.peak_speed[w]
            still = wp.max(worlds.stick_speed[w], peak)

            touch = Touch()
            touch.mode = wp.where(speed > still, SLIP, STICK)
            touch.urgency = PUSHED
            touch.path = worlds.origin
            old = 1 - new
            i = nearest_slot(slots, old, w, geoms, place)
            if i >= 0:
                touch = recalled(slots, old, w, i, axis_1, axis_2, v, h)
                stoppable = still + h * yielding * touch.mu_s * touch.load
                was = touch.mode
                if was != STICK:
                    touch.drift = wp.vec2(0.0)
                touch = decide(
                    touch, v, h, stoppable, peak, slots.saturated[old, w, i], slots.loose[old, w, i], felt, parameters
                )  # fmt: skip
                if was != STICK and touch.mode == STICK:
                    touch.events += 1
            if wp.static(OWN_PATH):
                direction = path_direction(normal, belt[c][0] * axis_1 + belt[c][1] * axis_2)
                if i >= 0:
                    touch.path += wp.float64(float(side) * h * wp.dot(direction, v[0] * axis_1 + v[1] * axis_2))
                slots.cursor[new, w, k, 0] = wp.float64(0.0)
                a, b = coefficients(
                    worlds.descriptor[w], slots.cursor[new, w, k], seed, worlds.sample[w], contact, wp.float64(0.0),
                    touch.path, wp.float64(touch.events),
                )  # fmt: skip
                touch.mu_s = float(a)
                touch.mu_k = float(b)
            else:
                touch.mu_s = worlds.mu_s[w]
                touch.mu_k = worlds.mu_k[w]

            scale = wp.float32(1.0)
            cap = wp.float32(0.0)
            asked = wp.vec2(0.0)
            if touch.mode == STICK:
                resistance = 1.0 / mass[w, row + 1]
                total, stiffness, cap_at_rest = stuck_row(touch, resistance, h, peak, felt, parameters)
                cap = wp.max(cap_at_rest, LEAST_FRICTION)
                scale = wp.max(wp.sqrt(resistance / total), SOFTEST)
                asked = scale * (-v / h - stiffness * touch.drift)
                if scale < 1.0:
                    soften(jacobian, filled, first, sparse, w, row + 1, scale)
                    soften(jacobian, filled, first, sparse, w, row + 2, scale)
            else:
                touch.drift = wp.vec2(0.0)
                cap = wp.max(slide(speed, touch.mu_s, touch.mu_k, parameters), LEAST_FRICTION)
                along = v / wp.max(speed, LEAST_SPEED)
                root = impratio[w % impratio.shape[0]]
                kept = 1.0 + cap * cap * root * root  # the cone divides the normal row's mass by this
                mass[w, row] = kept * mass[w, row]
                mass[w, row + 1] = kept * mass[w, row + 1]
                mass[w, row + 2] = kept * mass[w, row + 2]
                pressing = wp.max(touch.load / mass[w, row], reference[w, row])
                slowing = -wp.dot(touch.acceleration, along)
                if touch.load <= 0.0:
                    slowing = cap * (pressing + wp.length(gravity[w % gravity.shape[0]]))
                beyond = touch.urgency * cap * pressing * mass[w, row] / mass[w, row + 1]
                touch.mode = SLIP
                if (beyond + slowing) * h >= speed:
                    touch.mode = STOPPING
                    beyond = wp.max(speed / h - slowing, 0.0)
                    asked = -v / h
                else:
                    asked = -(beyond + slowing) * along
                reference[w, row] = reference[w, row] - cap * beyond
            given = friction[c]
            given = vec5(cap / scale, cap / scale * given[1] / given[0], given[2], given[3], given[4])
            friction[c] = given
            for j in range(3, dim[c]):  # a cone is circular where this is the same for all
                mass[w, row + j] = mass[w, row + 1] * given[j - 1] * given[j - 1] / (given[0] * given[0])
            reference[w, row + 1] = asked[0]
            reference[w, row + 2] = asked[1]
            slots.geoms[new, w, k] = geoms
            slots.rows[new, w, k] = wp.vec2i(row, dim[c])
            slots.side[new, w, k] = side
            slots.place[new, w, k] = place
            slots.friction[new, w, k] = given
            slots.scale[new, w, k] = scale
            keep(slots, new, w, k, axis_1, axis_2, v, touch)

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
    """Write the sums of the forces over the contacts of each world, and whether all of them stick."""
    w = wp.tid()
    now = worlds.count[w] % 2
    pressing = wp.float32(0.0)
    rubbing = wp.vec3(0.0)
    loaded = wp.int32(0)
    stuck = wp.int32(1)
    if worlds.count[w] >= 0:
        for i in range(slots.used[now, w]):
            row = slots.rows[now, w, i][0]
            if force[w, row] > 0.0:
                loaded += 1
                pressing += force[w, row]
                vector = force[w, row + 1] * slots.axis_1[now, w, i] + force[w, row + 2] * slots.axis_2[now, w, i]
                # rows push the contact's second geom
                rubbing -= float(slots.side[now, w, i]) * slots.scale[now, w, i] * vector
                if slots.mode[now, w, i] != STICK:
                    stuck = 0
    normal_force[w] = pressing
    friction_force[w] = rubbing
    contacts[w] = loaded
    stick[w] = wp.where(loaded > 0, stuck, 0)
