# type: ignore
# (kernels are typed by Warp)
"""The kernels that steer MuJoCo Warp's constraint solver at contacts.

They run in ``Model.callback.passive``: contacts and their constraint rows are there, the solver has not run, and it reads
``contact.friction`` and ``efc.aref`` live. A row of the solver gives the force D (reference - acceleration) within its cap.

*Stick*: the cap is mu_s, and the two tangential rows get a position reference with the time constant of two steps, which
makes MuJoCo's tangential damper a spring: it holds. A stuck contact at its cap drags its reference along (return mapping), so
that the row stays at the cap and no further: MuJoCo's cone would turn the rest into normal force. Faster than the stick speed,
it slips.

*Slip*: the cap is the law's coefficient at the present speed. The reference asks for the acceleration of the step before, less
twice what the cap is worth in the row, or for rest at the end of the step, whichever is less. So the row stays at its cap and
not far beyond. (MuJoCo's own reference grows with the speed, and lifts fast bodies off the ground.) Where it asked for rest and
the cap was not needed, the contact sticks.
"""

import functools
from typing import Any

import warp as wp

from stochfric_mb.warp.cap import cap_function
from stochfric_mb.warp.state import SLIP, STICK, STOPPING, Slots, Worlds, vec5

SATURATED = wp.constant(0.9999**2)
"""A friction force counts as at its cap from .9999 of it on: the solver's tolerance lies below that."""
LEAST_FRICTION = wp.constant(1.0e-5)
"""MuJoCo's mjMINMU."""
LEAST_IMPEDANCE = wp.constant(0.0001)
"""MuJoCo's mjMINIMP."""
MOST_IMPEDANCE = wp.constant(0.9999)
"""MuJoCo's mjMAXIMP."""
LEAST_SPEED = wp.constant(1.0e-30)
"""Keeps the direction of a sliding contact at rest a number [m/s]."""
DRAGGED = wp.constant(1.01)
"""Friction that a stuck contact at its cap is asked for, over the cap: above `SATURATED`, little for the normal direction."""
PUSHED = wp.constant(2.0)
"""Friction that a sliding contact is asked for, over the cap: the normal force may double in a step."""
MOST_URGENT = wp.constant(1024.0)
"""Bound of that ratio, which doubles with each step in which a sliding contact stays below its cap."""


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
def found_force(force: wp.array2d[float], w: int, slots: Slots, old: int, i: int):
    """Write what the solver found for a slot: normal force, tangential forces, and the square of friction over its cap."""
    rows = slots.rows[old, w, i]
    friction = slots.friction[old, w, i]
    normal_force = force[w, rows[0]]
    total = wp.float32(0.0)
    for j in range(1, rows[1]):
        part = force[w, rows[0] + j] / friction[j - 1]
        total += part * part
    slots.force[old, w, i] = wp.vec3(normal_force, force[w, rows[0] + 1], force[w, rows[0] + 2])
    slots.saturation[old, w, i] = wp.where(normal_force > 0.0, total / (normal_force * normal_force), 0.0)


@wp.func
def on_axes(axis_1: wp.vec3, axis_2: wp.vec3, vector: wp.vec3):
    """Return the two tangential components of a vector."""
    return wp.vec2(wp.dot(axis_1, vector), wp.dot(axis_2, vector))


@wp.func
def spring(h: float, most_impedance: float):
    """Return stiffness [1/s^2] and damping [1/s] of a stuck contact's reference: critical, with the time constant 2 h."""
    impedance = wp.clamp(most_impedance, LEAST_IMPEDANCE, MOST_IMPEDANCE)
    constant = 2.0 * h
    return 1.0 / (impedance * constant * constant), 2.0 / (impedance * constant)


@wp.struct
class Touch:
    """A contact as the step before left it, and as it is now."""

    mode: int
    drift: wp.vec2
    """Displacement since it stuck [m]."""
    acceleration: wp.vec2
    """In the step before [m/s^2]."""
    normal_force: float
    """In the step before, 0 for a new contact [N]."""
    urgency: float
    """Friction to ask for, over the cap [-]."""


@wp.func
def recalled(
    slots: Slots, old: int, w: int, i: int, axis_1: wp.vec3, axis_2: wp.vec3, v: wp.vec2, h: float, limit: float,
    mass: float, stiffness: float, damping: float,
):  # fmt: skip
    """Return a contact that had slot ``i``, and its mode by what the solver found."""
    touch = Touch()
    saturated = slots.saturation[old, w, i] >= SATURATED
    touch.normal_force = slots.force[old, w, i][0]
    touch.acceleration = (v - on_axes(axis_1, axis_2, slots.velocity[old, w, i])) / h
    touch.urgency = PUSHED
    touch.mode = slots.mode[old, w, i]
    if touch.mode == STICK:
        drift = on_axes(axis_1, axis_2, slots.drift[old, w, i])
        if saturated and wp.length(v) > limit:
            touch.mode = SLIP
        elif saturated:
            pull = wp.vec2(slots.force[old, w, i][1], slots.force[old, w, i][2])
            drift = -(touch.acceleration + DRAGGED / mass * pull + damping * v) / stiffness
        else:
            drift += h * v
        touch.drift = drift
    elif touch.mode == STOPPING and not saturated:
        touch.mode = STICK
    else:
        touch.mode = SLIP
        if not saturated:
            touch.urgency = wp.min(2.0 * slots.urgency[old, w, i], MOST_URGENT)
    return touch


@wp.func
def deceleration(touch: Touch, along: wp.vec2, mu: float, pressing: float, ratio: float, gravity: float):
    """Return what a sliding contact is asked for [m/s^2].

    ``pressing`` is the normal force over the normal row's mass [m/s^2], ``ratio`` that mass over a tangential row's.
    """
    if touch.normal_force > 0.0:
        return touch.urgency * mu * pressing * ratio - wp.dot(touch.acceleration, along)
    return touch.urgency * mu * pressing * ratio + mu * (pressing + gravity)


@wp.func
def keep(
    worlds: Worlds, slots: Slots, new: int, w: int, geoms: wp.vec2i, rows: wp.vec2i, side: int, place: wp.vec3,
    axis_1: wp.vec3, axis_2: wp.vec3, friction: vec5, v: wp.vec2, touch: Touch,
):  # fmt: skip
    """Write a contact into the next free slot of its world."""
    k = wp.atomic_add(slots.used, new, w, 1)
    if k >= slots.geoms.shape[2]:
        wp.atomic_sub(slots.used, new, w, 1)
        wp.atomic_add(worlds.overflow, w, 1)
        return
    slots.geoms[new, w, k] = geoms
    slots.rows[new, w, k] = rows
    slots.axis_1[new, w, k] = axis_1
    slots.axis_2[new, w, k] = axis_2
    slots.side[new, w, k] = side
    slots.place[new, w, k] = place
    slots.friction[new, w, k] = friction
    slots.force[new, w, k] = wp.vec3(0.0)
    slots.saturation[new, w, k] = 0.0
    slots.drift[new, w, k] = touch.drift[0] * axis_1 + touch.drift[1] * axis_2
    slots.velocity[new, w, k] = v[0] * axis_1 + v[1] * axis_2
    slots.urgency[new, w, k] = touch.urgency
    slots.mode[new, w, k] = touch.mode


@functools.cache
def steer_kernel(kind: str) -> Any:
    """Return the kernel that steers the solver at each contact, for the law of the given kind."""
    cap = cap_function(kind)

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
        solimp: wp.array[vec5],
        geom_position: wp.array2d[wp.vec3],
        timestep: wp.array[float],
        gravity: wp.array[wp.vec3],
        velocity: wp.array2d[float],
        force: wp.array2d[float],
        partners: wp.array2d[int],
        worlds: Worlds,
        slots: Slots,
        friction: wp.array[vec5],
        mass: wp.array2d[float],
        reference: wp.array2d[float],
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
            h = timestep[w % timestep.shape[0]]
            axis_1 = wp.vec3(frame[c][1, 0], frame[c][1, 1], frame[c][1, 2])
            axis_2 = wp.vec3(frame[c][2, 0], frame[c][2, 1], frame[c][2, 2])
            v = wp.vec2(velocity[w, row + 1], velocity[w, row + 2])
            speed = wp.length(v)
            place = position[c] - geom_position[w, geoms[1]]
            stiffness, damping = spring(h, solimp[c][1])
            limit = worlds.stick_speed[w]

            touch = Touch()
            touch.mode = wp.where(speed > limit, SLIP, STICK)
            touch.urgency = PUSHED
            i = nearest_slot(slots, 1 - new, w, geoms, place)
            if i >= 0:
                if worlds.fresh[w] == 1:
                    found_force(force, w, slots, 1 - new, i)
                if slots.force[1 - new, w, i][0] > 0.0:
                    touch = recalled(
                        slots, 1 - new, w, i, axis_1, axis_2, v, h, limit, mass[w, row + 1], stiffness, damping
                    )  # fmt: skip

            mu = worlds.mu_s[w]
            asked = -damping * v - stiffness * touch.drift
            if touch.mode != STICK:
                touch.drift = wp.vec2(0.0)
                mu = cap(speed, 2.0 * limit, worlds.mu_s[w], worlds.mu_k[w], worlds.parameters[w])
                along = v / wp.max(speed, LEAST_SPEED)
                pressing = wp.max(touch.normal_force / mass[w, row], reference[w, row])
                weight = wp.length(gravity[w % gravity.shape[0]])
                push = deceleration(touch, along, mu, pressing, mass[w, row] / mass[w, row + 1], weight)
                if push * h >= speed:
                    touch.mode = STOPPING
                    push = speed / h
                asked = -push * along
            mu = wp.max(mu, LEAST_FRICTION)
            given = friction[c]
            given = vec5(mu, mu * given[1] / given[0], given[2], given[3], given[4])
            friction[c] = given
            for j in range(3, dim[c]):
                mass[w, row + j] = mass[w, row + 1] * given[j - 1] * given[j - 1] / (mu * mu)
            reference[w, row + 1] = asked[0]
            reference[w, row + 2] = asked[1]
            side = partners[geoms[0], geoms[1]]
            keep(worlds, slots, new, w, geoms, wp.vec2i(row, dim[c]), side, place, axis_1, axis_2, given, v, touch)

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
                rubbing -= float(slots.side[now, w, i]) * vector  # rows push the contact's second geom
                if slots.mode[now, w, i] != STICK:
                    stuck = 0
    normal_force[w] = pressing
    friction_force[w] = rubbing
    contacts[w] = loaded
    stick[w] = wp.where(loaded > 0, stuck, 0)
