"""What one contact answers: its law's force at an end velocity, and the force that it would find alone."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.root import local_force
from stochfric_mb.mujoco.switching import call

TURNED = 1.0e-9
"""How far beyond rest a sliding contact is braked, relative to the velocity taken, so that its law sees it turned."""
U0, V0, SURFACE, MU, FREE, RESTS = 0, 2, 4, 6, 8, 10
"""Columns of a contact's numbers: displacement, velocity, surface velocity, coefficients, free velocity; 1 while it is taken
to come to rest."""
NUMBERS = 11
"""How many columns."""
VX, VY, NORMAL = range(3)
"""Columns of a contact's motion: velocity [m/s] and normal force [N] at the forces so far."""


@compiled
def add_force(coupling, motion, f, q, dx, dy):
    """Change the force of contact ``q``, with the motions of all."""
    if dx == 0.0 and dy == 0.0:
        return
    f[q, 0] += dx
    f[q, 1] += dy
    for p in range(len(motion)):
        for i in range(3):
            motion[p, i] -= coupling[3 * p + i, 2 * q] * dx + coupling[3 * p + i, 2 * q + 1] * dy


@compiled
def take(places, motion, q):
    """Give the slot of contact ``q`` its normal force; return its velocity."""
    n.store(places[q, 2] + 8 * s.NORMAL, max(motion[q, NORMAL], 0.0))
    return motion[q, VX], motion[q, VY]


@compiled
def answer(places, numbers, motion, f, response, q, end, h):
    """Return the force [N] of contact ``q`` at the others' present ones, and whether it was braked to rest."""
    address, state = places[q, 2], places[q, 3]
    row, w = numbers[q], response[q]
    vx, vy = take(places, motion, q)
    keep_free(row, w, h, vx, vy, f[q, 0], f[q, 1])
    fx, fy = local_force(state, address, places[q, 4], end, h, row, w, f[q, 0], f[q, 1])
    part = brake(row, w, h, fx, fy) if slides(state, address) else 1.0
    return part * fx, part * fy, part < 1.0


@compiled
def keep_free(row, w, h, vx, vy, fx, fy):
    """Write the velocity that the contact would have without its force."""
    row[FREE] = vx + h * (w[0] * fx + w[1] * fy)
    row[FREE + 1] = vy + h * (w[2] * fx + w[3] * fy)


@compiled
def slides(state, address):
    """Return whether the contact is one of a law with modes that slides."""
    return n.load(state + 8 * s.HAS_MODE) != 0.0 and n.load(address + 8 * s.STICK) == 0.0


@compiled
def brake(row, w, h, fx, fy):
    """Return the part of a sliding contact's force that brings it to rest, at most 1.

    Sliding friction does not turn a velocity over: the law switches there, which `implicit.switch_ahead` then sees.
    """
    free = fx * row[FREE] + fy * row[FREE + 1]
    felt = h * (fx * (w[0] * fx + w[1] * fy) + fy * (w[2] * fx + w[3] * fy))
    return min(1.0, max(free, 0.0) * (1.0 + TURNED) / felt) if felt > free else 1.0


@compiled
def law_at(place, end, h, row, vx, vy):
    """Return the law's force [N] at an end velocity; ``place`` is the contact's row of `implicit.gather`."""
    address, state = place[2], place[3]
    call(state, address, place[4], end, row[U0] + h * vx, row[U0 + 1] + h * vy, vx, vy, row[MU], row[MU + 1])
    return n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1))
