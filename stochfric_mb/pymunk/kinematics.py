"""Motion of a contact, and forces on its bodies, read from and written to pymunk's own structures."""

from __future__ import annotations

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled_inline
from stochfric_mb.numerics.memory import load_double, load_int, load_word, store_double
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk.memory import get_double, get_int


@compiled_inline
def advance_clock(table, clock, space):
    """Return the step [s] and the stamp of the space; the clock moves on once a step."""
    stamp = get_int(table[r.GET_STAMP], space)
    dt = get_double(table[r.GET_STEP], space)
    if stamp != table[r.LAST_STAMP]:
        clock[r.NOW] += (stamp - table[r.LAST_STAMP]) * dt
        clock[r.STEP_TIME] = canonical_time(clock[r.NOW], 0.5 * dt)
        table[r.LAST_STAMP] = stamp
    return dt, stamp


@compiled_inline
def motion(table, arbiter, body_is_a, first):
    """Return the frame and the motion of a contact, relative quantities as counter-surface minus body.

    Bodies that press on each other at two points cannot turn, and friction feels their masses alone.

    Returns:
        normal (2) from surface to body, tangent is (n_y, -n_x); arms (4) of shape a and b; tangential velocity
        [m/s], normal velocity (body minus surface) [m/s], inverse tangential and normal mass [1/kg].
    """
    side = -1.0 if body_is_a else 1.0
    nx = side * load_double(arbiter + table[r.AXIS])
    ny = side * load_double(arbiter + table[r.AXIS] + 8)
    count = load_int(arbiter + table[r.COUNT])
    point = load_word(arbiter + table[r.POINTS])
    ax, ay, bx, by = 0.0, 0.0, 0.0, 0.0
    pressed, share = 0, 1.0 / count
    for _ in range(count):
        pressed += 1 if first or load_double(point + table[r.NORMAL_IMPULSE]) > 0.0 else 0
        ax += share * load_double(point + table[r.ARM_1])
        ay += share * load_double(point + table[r.ARM_1] + 8)
        bx += share * load_double(point + table[r.ARM_2])
        by += share * load_double(point + table[r.ARM_2] + 8)
        point += table[r.POINT_SIZE]
    a = load_word(arbiter + table[r.BODY_A])
    b = load_word(arbiter + table[r.BODY_B])
    wa, wb = load_double(a + table[r.SPIN]), load_double(b + table[r.SPIN])
    vx = load_double(b + table[r.SPEED]) - by * wb - load_double(a + table[r.SPEED]) + ay * wa
    vy = load_double(b + table[r.SPEED] + 8) + bx * wb - load_double(a + table[r.SPEED] + 8) - ax * wa
    v_normal = side * (vx * nx + vy * ny)
    vx += load_double(arbiter + table[r.SURFACE])
    vy += load_double(arbiter + table[r.SURFACE] + 8)
    v_rel = -side * (vx * ny - vy * nx)
    inverse_mass = load_double(a + table[r.M_INV]) + load_double(b + table[r.M_INV])
    i_a, i_b = load_double(a + table[r.I_INV]), load_double(b + table[r.I_INV])
    turn_a, turn_b = ax * nx + ay * ny, bx * nx + by * ny
    tip_a, tip_b = ax * ny - ay * nx, bx * ny - by * nx
    inverse_tangential = inverse_mass
    if pressed < 2:
        inverse_tangential += i_a * turn_a * turn_a + i_b * turn_b * turn_b
    inverse_normal = inverse_mass + i_a * tip_a * tip_a + i_b * tip_b * tip_b
    return nx, ny, ax, ay, bx, by, v_rel, v_normal, inverse_tangential, inverse_normal


@compiled_inline
def free_acceleration(table, space, body, rx, ry):
    """Return the acceleration of a body's point at an arm by gravity and applied forces, (x, y) [m/s^2]."""
    m_inv = load_double(body + table[r.M_INV])
    if m_inv == 0.0:
        return 0.0, 0.0
    turn = load_double(body + table[r.I_INV]) * load_double(body + table[r.TORQUE])
    x = load_double(space + table[r.GRAVITY]) + m_inv * load_double(body + table[r.BODY_FORCE])
    y = load_double(space + table[r.GRAVITY] + 8) + m_inv * load_double(body + table[r.BODY_FORCE] + 8)
    return x - turn * ry, y + turn * rx


@compiled_inline
def push(table, body, fx, fy, torque):
    """Add a force and a torque to a dynamic body; they act in this step."""
    if load_double(body + table[r.M_INV]) > 0.0:
        at = body + table[r.BODY_FORCE]
        store_double(at, load_double(at) + fx)
        store_double(at + 8, load_double(at + 8) + fy)
        at = body + table[r.TORQUE]
        store_double(at, load_double(at) + torque)


@compiled_inline
def impulses(table, arbiter):
    """Return the sums of the contact's recorded normal and tangential impulses [N s]."""
    normal, tangent = 0.0, 0.0
    point = load_word(arbiter + table[r.POINTS])
    for _ in range(load_int(arbiter + table[r.COUNT])):
        normal += load_double(point + table[r.NORMAL_IMPULSE])
        tangent += load_double(point + table[r.TANGENT_IMPULSE])
        point += table[r.POINT_SIZE]
    return normal, tangent
