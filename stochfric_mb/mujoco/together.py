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
from stochfric_mb.mujoco.answer import FREE, MU, NORMAL, RESTS, V0, VX, VY, add_force, answer, law_at, slides, take
from stochfric_mb.mujoco.holding import COUPLED, bring_to_rest, fill_shares, hold_still, is_held, largest, want_hold
from stochfric_mb.mujoco.newton import newton

SWEEPS, ROUNDS = 20, 6
"""Most sweeps over the contacts; most turns between the contacts that stick and those that slide before them."""
SETTLED = 1.0e-11
"""Change of a force in a sweep, relative to mu_s N, at which the search ends."""
AS_BEFORE, TO_REST, AWAY = range(3)
"""What is tried of the contacts that slide, in this order."""
SHARINGS = 2
"""Turns in which contacts that come to rest share by their normal forces, which change with it."""
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
    return 8 * m * m + 40 * m + 16


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
    first, start, rest = space[: 2 * m], space[2 * m : 5 * m], space[5 * m :]
    remember(motion, f, first, start)
    held = held_contacts(places)
    for way in (AS_BEFORE, TO_REST, AWAY):
        found = reach(places, coupling, numbers, motion, f, first, end, h, response, held, way, rest)
        numbers[:, RESTS] = 0.0
        if found:
            return
        restore(motion, f, first, start)
        if sliding(places) == 0:
            break
    for k in range(1, SWEEPS + 1):
        moved = sweep(places, coupling, numbers, motion, f, response, end, h, held, rest)
        if moved <= (STILL if 0 < held < m else SETTLED) or (m == 1 and coupling[2, 0] == 0.0 and coupling[2, 1] == 0.0):
            return
        if held == m:
            continue
        remember(motion, f, first, start)
        close = newton(places, coupling, numbers, motion, f, response, end, h, True, rest)
        if not close or not is_nearest(places, coupling, numbers, motion, f, first, response, end, h, True, rest):
            restore(motion, f, first, start)
        elif held == 0:
            return
        if k % OFTEN == 0 and newton(places, coupling, numbers, motion, f, response, end, h, False, rest) and held == 0:
            return


@compiled
def sliding(places):
    """Return how many contacts slide by their law's mode."""
    count = 0
    for q in range(len(places)):
        count += slides(places[q, 3], places[q, 2])
    return count


@compiled
def remember(motion, f, forces, motions):
    """Copy the forces and the motion."""
    for q in range(len(f)):
        forces[2 * q], forces[2 * q + 1] = f[q, 0], f[q, 1]
        for i in range(3):
            motions[3 * q + i] = motion[q, i]


@compiled
def restore(motion, f, forces, motions):
    """Copy the forces and the motion back: a search that went astray leaves no rounding behind."""
    for q in range(len(f)):
        f[q, 0], f[q, 1] = forces[2 * q], forces[2 * q + 1]
        for i in range(3):
            motion[q, i] = motions[3 * q + i]


@compiled
def held_contacts(places):
    """Return how many contacts true stick holds."""
    held = 0
    for q in range(len(places)):
        held += is_held(places, q)
    return held


# --- all at once ----------------------------------------------------------------------------------------------------


@compiled
def reach(places, coupling, numbers, motion, f, first, end, h, response, held, way, space):
    """Go to the forces by Newton's method on all contacts; return whether they are the ones that the motion meets.

    ``way`` says from where: contacts that slide go on as before, come to rest, or run away where their law falls.
    """
    m = len(places)
    set_out(places, coupling, numbers, motion, f, end, h, way, space)
    for turn in range(ROUNDS):
        moved = 0.0
        if held > 0:
            moved = hold_still(places, coupling, numbers, motion, f, response, end, h, turn == 0, space)
            if moved < 0.0:  # the normal forces changed: the others may help
                continue
        if way == TO_REST:
            rested = bring_to_rest(places, coupling, numbers, motion, f, response, end, h, turn < SHARINGS, space)
            if rested < 0.0:
                return False
            moved = max(moved, rested)
        if held == m:
            return True
        if not newton(places, coupling, numbers, motion, f, response, end, h, True, space):
            return False
        if moved <= STILL:
            return is_nearest(places, coupling, numbers, motion, f, first, response, end, h, False, space)
    return False


@compiled
def set_out(places, coupling, numbers, motion, f, end, h, way, space):
    """Give the contacts the forces to start from on a ``way``, and mark those that are taken to rest."""
    for q in range(len(places)):
        if way == AWAY and slides(places[q, 3], places[q, 2]):
            add_force(coupling, motion, f, q, -f[q, 0], -f[q, 1])
    follow(places, coupling, numbers, motion, f, end, h, space)
    for q in range(len(places)):
        if way == TO_REST and slides(places[q, 3], places[q, 2]) and motion[q, NORMAL] > 0.0:
            numbers[q, RESTS] = 1.0


@compiled
def follow(places, coupling, numbers, motion, f, end, h, space):
    """Give the contacts the forces to start from, all from the same velocities.

    Those that slide get their laws' forces at these velocities. Those that stick keep theirs, but where the law is at
    its limit, and its slope says nothing of how stiff it is within, they get what would stop them.
    """
    m = len(places)
    shares = space[2 * m : 4 * m]
    fill_shares(coupling, motion, shares)
    for q in range(m):
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
                x, y = f[q, 0] + shares[q] * vx, f[q, 1] + shares[q] * vy
                size = math.hypot(x, y)
                if size > cap:
                    x, y = x * cap / size, y * cap / size
                space[2 * q], space[2 * q + 1] = x, y
    for q in range(m):
        add_force(coupling, motion, f, q, space[2 * q] - f[q, 0], space[2 * q + 1] - f[q, 1])


@compiled
def is_fast(state, address, vx, vy):
    """Return whether the contact slides: by its mode, or beyond the speed of a law without modes' peak."""
    if n.load(state + 8 * s.HAS_MODE) != 0.0:
        return slides(state, address)
    return math.hypot(vx, vy) > n.load(state + 8 * s.STICK_SPEED)


@compiled
def is_nearest(places, coupling, numbers, motion, f, first, response, end, h, own, space):
    """Return whether the forces are the roots that the motion meets first on its way from the start of the step.

    Where a contact sticks, its law only rises, and the root is the only one. Where it slides, there is no other if the
    law is almost level from the velocity before to that after, or the force almost that of the first guess; the others
    are looked at together. With ``own``, the ways are those from the contacts' own answers, the forces ``first``.
    """
    m = len(places)
    start, marked = space[: 2 * m], space[2 * m : 3 * m]
    changed = False
    for q in range(m):
        address, state, row, w = places[q, 2], places[q, 3], numbers[q], response[q]
        ux, uy = row[V0], row[V0 + 1]
        if own:
            ux = row[FREE] - h * (w[0] * first[2 * q] + w[1] * first[2 * q + 1])
            uy = row[FREE + 1] - h * (w[2] * first[2 * q] + w[3] * first[2 * q + 1])
        start[2 * q], start[2 * q + 1], marked[q] = ux, uy, 0.0
        modes, cap = n.load(state + 8 * s.HAS_MODE) != 0.0, row[MU] * n.load(address + 8 * s.NORMAL)
        vx, vy = motion[q, VX], motion[q, VY]
        fast = is_fast(state, address, vx, vy)
        if not modes and fast != is_fast(state, address, ux, uy):
            return False
        if not fast or not cap > 0.0:
            continue
        if math.hypot(f[q, 0] - first[2 * q], f[q, 1] - first[2 * q + 1]) > NEAR * cap:
            gx, gy = law_at(places[q], end, h, row, vx, vy)
            kx, ky = law_at(places[q], end, h, row, ux, uy)
            stops = math.hypot(f[q, 0], f[q, 1]) < AT_LIMIT * math.hypot(gx, gy)
            if stops or abs(math.hypot(gx, gy) - math.hypot(kx, ky)) > NEAR * cap:
                if not slides(state, address):
                    return False
                marked[q], changed = 1.0, True
    return not changed or no_other(places, coupling, numbers, motion, f, first, end, h, start, marked)


@compiled
def no_other(places, coupling, numbers, motion, f, first, end, h, start, marked):
    """Return whether the ``marked`` contacts meet no other root on the way from the velocities ``start`` to the present ones.

    There the power of the laws' forces must be more, where they slow down, or less, where they get faster, than that of
    the forces which leave each part of the way: between the present ones and ``first``. Contacts that move each other
    count together. Those that get faster do so because their force falls.
    """
    left = 1.0
    for _ in range(SAMPLES):
        for q in range(len(places)):
            if marked[q] == 0.0:
                continue
            vx, vy = motion[q, VX], motion[q, VY]
            ux, uy = start[2 * q] - vx, start[2 * q + 1] - vy
            wx, wy = velocity_before(coupling, motion, f, first, q)
            wx, wy = wx - vx, wy - vy
            size = wx * wx + wy * wy
            part = left * (wx * ux + wy * uy) / size if size > 0.0 else 0.0
            x, y = f[q, 0] + part * (first[2 * q] - f[q, 0]), f[q, 1] + part * (first[2 * q + 1] - f[q, 1])
            gx, gy = law_at(places[q], end, h, numbers[q], vx + left * ux, vy + left * uy)
            slower = math.hypot(vx, vy) < math.hypot(vx + ux, vy + uy)
            if not slower and math.hypot(f[q, 0], f[q, 1]) > math.hypot(first[2 * q], first[2 * q + 1]):
                return False
            power = (math.hypot(gx, gy) - math.hypot(x, y)) * math.hypot(ux, uy)
            marked[q] = power if slower else -power
        for q in range(len(places)):
            total = 0.0
            for p in range(len(places)):
                total += marked[p] if largest(coupling, q, p) > COUPLED * largest(coupling, q, q) else 0.0
            if marked[q] != 0.0 and not total > 0.0:
                return False
        left *= 0.3
    return True


@compiled
def velocity_before(coupling, motion, f, first, q):
    """Return the velocity [m/s] of contact ``q`` with the forces ``first`` of all in place of ``f``."""
    vx, vy = motion[q, VX], motion[q, VY]
    for p in range(len(f)):
        x, y = f[p, 0] - first[2 * p], f[p, 1] - first[2 * p + 1]
        vx += coupling[3 * q, 2 * p] * x + coupling[3 * q, 2 * p + 1] * y
        vy += coupling[3 * q + 1, 2 * p] * x + coupling[3 * q + 1, 2 * p + 1] * y
    return vx, vy


# --- one contact after the other ------------------------------------------------------------------------------------


@compiled
def sweep(places, coupling, numbers, motion, f, response, end, h, held, space):
    """Let each contact in turn find its force at the others' last ones; return the largest change over mu_s N."""
    moved = 0.0
    if held > 0:
        want_hold(places, coupling, numbers, motion, f, response, h, False, space)
    for q in range(len(places)):
        fx, fy, _ = answer(places, numbers, motion, f, response, q, end, h)
        cap = numbers[q, MU] * n.load(places[q, 2] + 8 * s.NORMAL)
        size = math.hypot(fx - f[q, 0], fy - f[q, 1])
        moved = max(moved, size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0))
        add_force(coupling, motion, f, q, fx - f[q, 0], fy - f[q, 1])
    return moved
