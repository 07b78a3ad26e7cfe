"""The forces of all contacts at the step's end, found together from how velocities and normal forces answer to them.

All is linear but the laws: relative velocities v and normal forces N fall by ``coupling`` times a change of the
forces. The unknown forces F obey F = law(v, N); contacts that true stick holds have v = 0 instead, and share what holds
them by their normal forces (`holding`).

Newton's method on all forces comes first (`newton`), from the forces of the step before. Its answer counts where no
other root can lie between it and the start of the step (`is_nearest`). Else the contacts find their forces one after
the other (`answer`), in sweeps, each followed by Newton's method.

Nothing here knows MuJoCo's structures or a law's formula.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.answer import FREE, MU, V0, VX, VY, add_force, answer, law_at, slides, take
from stochfric_mb.mujoco.holding import hold_still, is_held, share, want_hold
from stochfric_mb.mujoco.newton import newton

SWEEPS, ROUNDS = 20, 6
"""Most sweeps over the contacts; most turns between the contacts that stick and those that slide before them."""
SETTLED = 1.0e-11
"""Change of a force in a sweep, relative to mu_s N, at which the search ends."""
STILL = 1.0e-8
"""The same where some contacts stick and others slide."""
NEAR = 1.0e-2
"""Change of the sliding force over mu_s N that leaves no room for another root of the law between two velocities."""
AT_LIMIT = 1.0 - 1.0e-6
"""Part of mu_s N from which a law that sticks is at its limit."""
SAMPLES = 3
"""Velocities on the way to rest at which a law is looked at."""
OFTEN = 3
"""Sweeps from one use of the contacts' own answers in Newton's method to the next."""


@compiled
def space_needed(m):
    """Return the length of the work space of `settle` for ``m`` contacts."""
    return 8 * m * m + 32 * m + 16


@compiled
def settle(places, coupling, numbers, motion, f, response, end, h, space):
    """Find the forces ``f`` of all contacts, with their ``motion``; ``space`` is to work in."""
    search(places, coupling, numbers, motion, f, response, end, h, space)
    for q in range(len(places)):
        take(places, motion, q)


@compiled
def search(places, coupling, numbers, motion, f, response, end, h, space):
    """Find the forces all at once, or else one contact after the other."""
    m = len(places)
    first, rest = space[: 2 * m], space[2 * m :]
    remember(f, first)
    held = held_contacts(places)
    if reach(places, coupling, numbers, motion, f, first, end, h, response, held, rest):
        return
    restore(coupling, motion, f, first)
    for k in range(1, SWEEPS + 1):
        moved = sweep(places, coupling, numbers, motion, f, response, end, h, held, rest)
        if moved <= (STILL if 0 < held < m else SETTLED) or (m == 1 and coupling[2, 0] == 0.0 and coupling[2, 1] == 0.0):
            return
        if held == m:
            continue
        remember(f, first)
        close = newton(places, coupling, numbers, motion, f, response, end, h, True, rest)
        if not close or not is_nearest(places, numbers, motion, f, first, response, end, h, True):
            restore(coupling, motion, f, first)
        elif held == 0:
            return
        if k % OFTEN == 0 and newton(places, coupling, numbers, motion, f, response, end, h, False, rest) and held == 0:
            return


@compiled
def remember(f, kept):
    """Copy the forces to ``kept``."""
    for q in range(len(f)):
        kept[2 * q], kept[2 * q + 1] = f[q, 0], f[q, 1]


@compiled
def restore(coupling, motion, f, kept):
    """Go back to the forces in ``kept``."""
    for q in range(len(f)):
        add_force(coupling, motion, f, q, kept[2 * q] - f[q, 0], kept[2 * q + 1] - f[q, 1])


@compiled
def held_contacts(places):
    """Return how many contacts true stick holds."""
    held = 0
    for q in range(len(places)):
        held += is_held(places, q)
    return held


# --- all at once ----------------------------------------------------------------------------------------------------


@compiled
def reach(places, coupling, numbers, motion, f, first, end, h, response, held, space):
    """Go to the forces by Newton's method on all contacts; return whether they are the ones that the motion meets."""
    m = len(places)
    if held < m:
        follow(places, coupling, numbers, motion, f, end, h, space)
    for _ in range(ROUNDS):
        moved = hold_still(places, coupling, numbers, motion, f, response, end, h, space) if held > 0 else 0.0
        if moved < 0.0:
            return False
        if held == m:
            return True
        if not newton(places, coupling, numbers, motion, f, response, end, h, True, space):
            return False
        if moved <= STILL:
            return is_nearest(places, numbers, motion, f, first, response, end, h, False)
    return False


@compiled
def follow(places, coupling, numbers, motion, f, end, h, space):
    """Give the contacts the forces to start from, all from the same velocities.

    Those that slide get their laws' forces at these velocities. Those that stick keep theirs, but where the law is at
    its limit, and its slope says nothing of how stiff it is within, they get what would stop them.
    """
    for q in range(len(places)):
        space[2 * q], space[2 * q + 1] = f[q, 0], f[q, 1]
        if is_held(places, q):
            continue
        vx, vy = take(places, motion, q)
        gx, gy = law_at(places[q], end, h, numbers[q], vx, vy)
        if is_fast(places[q, 3], places[q, 2], vx, vy):
            space[2 * q], space[2 * q + 1] = gx, gy
        elif n.load(places[q, 3] + 8 * s.HAS_MODE) != 0.0:
            cap = numbers[q, MU] * n.load(places[q, 2] + 8 * s.NORMAL)
            if math.hypot(gx, gy) >= AT_LIMIT * cap:
                part = share(coupling, motion, q)
                x, y = f[q, 0] + part * vx, f[q, 1] + part * vy
                size = math.hypot(x, y)
                if size > cap:
                    x, y = x * cap / size, y * cap / size
                space[2 * q], space[2 * q + 1] = x, y
    restore(coupling, motion, f, space)


@compiled
def is_fast(state, address, vx, vy):
    """Return whether the contact slides: by its mode, or beyond the speed of a law without modes' peak."""
    if n.load(state + 8 * s.HAS_MODE) != 0.0:
        return slides(state, address)
    return math.hypot(vx, vy) > n.load(state + 8 * s.STICK_SPEED)


@compiled
def is_nearest(places, numbers, motion, f, first, response, end, h, own):
    """Return whether the forces are the roots that the motion meets first on its way from the start of the step.

    Where a contact sticks, its law only rises, and the root is the only one. Where it slides, there is no other if the
    law is almost level from the velocity before to that after, or the force almost that of the first guess. With
    ``own``, the ways are those from the contacts' own answers, the forces ``first``.
    """
    for q in range(len(places)):
        address, state, row, w = places[q, 2], places[q, 3], numbers[q], response[q]
        ux, uy = row[V0], row[V0 + 1]
        if own:
            ux = row[FREE] - h * (w[0] * first[2 * q] + w[1] * first[2 * q + 1])
            uy = row[FREE + 1] - h * (w[2] * first[2 * q] + w[3] * first[2 * q + 1])
        modes, cap = n.load(state + 8 * s.HAS_MODE) != 0.0, row[MU] * n.load(address + 8 * s.NORMAL)
        vx, vy = motion[q, VX], motion[q, VY]
        fast = is_fast(state, address, vx, vy)
        if not modes and fast != is_fast(state, address, ux, uy):
            return False
        if not fast or not cap > 0.0:
            continue
        if math.hypot(f[q, 0] - first[2 * q], f[q, 1] - first[2 * q + 1]) > NEAR * cap:
            gx, gy = law_at(places[q], end, h, row, vx, vy)
            if slides(state, address) and math.hypot(f[q, 0], f[q, 1]) < AT_LIMIT * math.hypot(gx, gy):
                if not stops_at_all(places[q], end, h, row, ux, uy, math.hypot(f[q, 0], f[q, 1])):
                    return False
                continue
            kx, ky = law_at(places[q], end, h, row, ux, uy)
            if abs(math.hypot(gx, gy) - math.hypot(kx, ky)) > NEAR * cap:
                return False
    return True


@compiled
def stops_at_all(place, end, h, row, vx, vy, force):
    """Return whether the law's force is more than the one that stops the contact on the whole way from (vx, vy) to rest."""
    part = 1.0
    for _ in range(SAMPLES):
        gx, gy = law_at(place, end, h, row, part * vx, part * vy)
        if not math.hypot(gx, gy) > force:
            return False
        part *= 0.3
    return True


# --- one contact after the other ------------------------------------------------------------------------------------


@compiled
def sweep(places, coupling, numbers, motion, f, response, end, h, held, space):
    """Let each contact in turn find its force at the others' last ones; return the largest change over mu_s N."""
    moved = 0.0
    if held > 0:
        want_hold(places, coupling, numbers, motion, f, response, h, space)
    for q in range(len(places)):
        fx, fy, _ = answer(places, numbers, motion, f, response, q, end, h)
        cap = numbers[q, MU] * n.load(places[q, 2] + 8 * s.NORMAL)
        size = math.hypot(fx - f[q, 0], fy - f[q, 1])
        moved = max(moved, size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0))
        add_force(coupling, motion, f, q, fx - f[q, 0], fy - f[q, 1])
    return moved
