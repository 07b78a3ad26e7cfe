# type: ignore
# (Warp functions are typed by Warp)
"""The rows that a contact has in MuJoCo Warp's constraint solver, as friction writes them: `stochfric_mb.warp.contacts`."""

import functools
from typing import Any

import warp as wp

from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.warp.law import Touch, coefficient_functions, felt_mass, rest_rules, slide_function
from stochfric_mb.warp.state import Slots, Worlds, vec5

LEAST_FRICTION = wp.constant(1.0e-5)
"""MuJoCo's mjMINMU."""
LEAST_SPEED = wp.constant(1.0e-30)
"""Keeps the direction of a sliding contact at rest a number [m/s]."""
SOFTEST = wp.constant(1.0e-3)
"""Least scale of a row's Jacobian: it is as soft as one of 1e6 times its resistance."""


@wp.struct
class Now:
    """Where a contact is in this step, and how it moves."""

    w: int
    row: int
    """First row in the solver."""
    side: int
    """1 if the friction's first geom is the contact's first, -1 if it is the second."""
    h: float
    """Step [s]."""
    v: wp.vec2
    """Velocity along the two tangents [m/s]."""
    speed: float
    peak: float
    """Speed of the law's peak [m/s]."""
    mobility: float
    """Of both bodies [1/kg]."""
    normal: wp.vec3
    axis_1: wp.vec3
    axis_2: wp.vec3
    direction: wp.vec3
    """Along which displacements count."""


@wp.func
def seen(w: int, row: int, frame: wp.mat33, velocity: wp.array2d[float], h: float, peak: float):
    """Return what the solver knows of a contact."""
    now = Now()
    now.w = w
    now.row = row
    now.h = h
    now.v = wp.vec2(velocity[w, row + 1], velocity[w, row + 2])
    now.speed = wp.length(now.v)
    now.peak = peak
    now.normal = wp.vec3(frame[0, 0], frame[0, 1], frame[0, 2])
    now.axis_1 = wp.vec3(frame[1, 0], frame[1, 1], frame[1, 2])
    now.axis_2 = wp.vec3(frame[2, 0], frame[2, 1], frame[2, 2])
    return now


@wp.func
def on_axes(now: Now, vector: wp.vec3):
    """Return the two tangential components of a vector."""
    return wp.vec2(wp.dot(now.axis_1, vector), wp.dot(now.axis_2, vector))


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


@functools.cache
def path_rule(clock: float) -> Any:
    """Return the Warp function that gives a contact its coefficients: its world's, or those of its own path."""
    path = coefficient_functions()[0]

    @wp.func
    def of_world(touch: Touch, worlds: Worlds, slots: Slots, new: int, w: int, k: int, seed: wp.int64, contact: wp.int64):
        touch.mu_s = worlds.mu_s[w]
        touch.mu_k = worlds.mu_k[w]
        return touch

    @wp.func
    def own(touch: Touch, worlds: Worlds, slots: Slots, new: int, w: int, k: int, seed: wp.int64, contact: wp.int64):
        slots.cursor[new, k, w, 0] = wp.float64(0.0)
        mu_s, mu_k = path(
            worlds.descriptor[w], slots.cursor[new, k, w], seed, worlds.sample[w], contact, wp.float64(0.0), touch.path,
            wp.float64(touch.events),
        )  # fmt: skip
        touch.mu_s = float(mu_s)
        touch.mu_k = float(mu_k)
        return touch

    return of_world if clock == TIME else own


@functools.cache
def hold_rule(kind: str) -> Any:
    """Return the Warp function that steers a stuck contact."""
    stuck_row = rest_rules(kind)[1]

    @wp.func
    def hold(
        touch: Touch, now: Now, p: wp.array[float], sparse: bool, filled: wp.array2d[int], first: wp.array2d[int],
        mass: wp.array2d[float], reference: wp.array2d[float], jacobian: wp.array3d[float],
    ):  # fmt: skip
        resistance = 1.0 / mass[now.w, now.row + 1]
        total, stiffness, cap, springs = stuck_row(touch, resistance, now.h, now.peak, felt_mass(now.mobility), p)
        touch.springs = springs
        touch.cap = wp.max(cap, LEAST_FRICTION)
        touch.scale = wp.max(wp.sqrt(resistance / total), SOFTEST)
        asked = touch.scale * (-now.v / now.h - stiffness * touch.drift)
        if touch.scale < 1.0:
            soften(jacobian, filled, first, sparse, now.w, now.row + 1, touch.scale)
            soften(jacobian, filled, first, sparse, now.w, now.row + 2, touch.scale)
        reference[now.w, now.row + 1] = asked[0]
        reference[now.w, now.row + 2] = asked[1]
        return touch

    return hold


@functools.cache
def slide_rule(kind: str) -> Any:
    """Return the Warp function that steers a sliding contact."""
    slide = slide_function(kind)

    @wp.func
    def let_slide(
        touch: Touch, now: Now, p: wp.array[float], impratio: float, weight: float, mass: wp.array2d[float],
        reference: wp.array2d[float],
    ):  # fmt: skip
        w, row = now.w, now.row
        touch.drift = wp.vec2(0.0)
        touch.scale = 1.0
        touch.cap = wp.max(slide(now.speed, touch.mu_s, touch.mu_k, p), LEAST_FRICTION)
        kept = 1.0 + touch.cap * touch.cap * impratio * impratio  # the cone divides the normal row's mass by this
        for j in range(3):
            mass[w, row + j] = kept * mass[w, row + j]
        along = now.v / wp.max(now.speed, LEAST_SPEED)
        slowing = -wp.dot(touch.acceleration, along)
        if touch.load <= 0.0:
            slowing = touch.cap * (wp.max(reference[w, row], 0.0) + weight)
        # what the cone adds to the normal row lifts the body
        reference[w, row] = reference[w, row] - touch.cap * wp.max(now.speed / now.h - slowing, 0.0)
        reference[w, row + 1] = -now.v[0] / now.h
        reference[w, row + 2] = -now.v[1] / now.h
        return touch

    return let_slide


@wp.func
def allow(friction: wp.array[vec5], c: int, dim: int, now: Now, touch: Touch, mass: wp.array2d[float]):
    """Give a contact its cap; torsional and rolling friction stay what they are."""
    given = friction[c]
    cap = touch.cap / touch.scale
    given = vec5(cap, cap * given[1] / given[0], given[2], given[3], given[4])
    friction[c] = given
    for j in range(3, dim):  # a cone is circular where this is the same for all
        mass[now.w, now.row + j] = mass[now.w, now.row + 1] * given[j - 1] * given[j - 1] / (cap * cap)
