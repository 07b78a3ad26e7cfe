"""The forces that hold contacts of true stick, all of them together.

The relative velocities v of the held contacts fall by A x for a change x of their forces; A is singular where one body
has more contacts than it can move in, and rigid bodies leave open how those share. Here x = S y with each contact's own
share S_q (`share`): the least x of all in the measure of S^-1, that is, by normal forces. GMRES on
A S y = v finds it in as many steps as the bodies can move in (Saad and Schultz 1986, doi 10.1137/0907058). The largest
eigenvalue of A S is 1.
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
from stochfric_mb.mujoco.answer import MU, NORMAL, RESTS, TURNED, V0, VX, VY, add_force, law_at, take

STILL = 1.0e-12
"""Velocity left, relative to that which mu_s N takes, at which contacts count as held."""
DEPENDENT = 1.0e-11
"""Part of a direction that is left beside the earlier ones, at which it counts as one of them."""
BELOW, AT_REST = 1.0e-6, 1.0e-3
"""Part of mu_s N that is left to a contact which holds all it can, so that it holds on while N changes by what MuJoCo's
solver leaves; velocity, relative to that which mu_s N takes, up to which all contacts rest with the others' help."""
COUPLED = 0.1
"""Velocity that a force at one contact gives another, relative to its own, from which they move each other."""
SLIGHT = 1.0e-3
"""Mobility, relative to the largest, of motions that are stopped a little in each step only: it takes so much force that
what is no motion of rigid bodies at all, but rounding or a change of the contact points, would break the contacts away."""


@compiled
def is_held(places, q):
    """Return whether true stick holds the contact."""
    return n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0 and n.load(places[q, 2] + 8 * s.STICK) != 0.0


@compiled
def hold_still(places, coupling, numbers, motion, f, response, end, h, anew, space):
    """Give the held contacts the forces that hold them; return the largest change over mu_s N, -1 if a law forbids it.

    These are changed as far as needed, or shared ``anew`` by the normal forces.
    """
    want_hold(places, coupling, numbers, motion, f, response, h, anew, space)
    allowed, moved = True, 0.0
    for q in range(len(places)):
        if is_held(places, q):
            vx, vy = take(places, motion, q)
            gx, gy = law_at(places[q], end, h, numbers[q], vx, vy)
            x, y = n.load(places[q, 2] + 8 * s.HOLD_X), n.load(places[q, 2] + 8 * s.HOLD_Y)
            allowed = allowed and gx == x and gy == y
            cap = numbers[q, MU] * n.load(places[q, 2] + 8 * s.NORMAL)
            if cap > 0.0:
                moved = max(moved, math.hypot(gx - f[q, 0], gy - f[q, 1]) / cap)
            add_force(coupling, motion, f, q, gx - f[q, 0], gy - f[q, 1])
    return moved if allowed else -1.0


@compiled
def want_hold(places, coupling, numbers, motion, f, response, h, anew, space):
    """Write the forces that would hold the held contacts still to their slots.

    Where they cannot hold with each other's help, each wants its whole part, with which its law lets it go.
    """
    m = len(places)
    chosen, most, total, whole = space[:m], space[m : 2 * m], space[2 * m : 4 * m], space[4 * m : 6 * m]
    for q in range(m):
        chosen[q] = 1.0 if is_held(places, q) and motion[q, NORMAL] > 0.0 else 0.0
        most[q] = numbers[q, MU] * motion[q, NORMAL]
        kept = not anew or chosen[q] == 0.0
        total[2 * q], total[2 * q + 1] = f[q, 0] if kept else 0.0, f[q, 1] if kept else 0.0
    if not hold(coupling, numbers, motion, f, response, h, chosen, most, total, whole, space[6 * m :]):
        n.move(whole, total)
    for q in range(m):
        if is_held(places, q):
            n.store(places[q, 2] + 8 * s.HOLD_X, total[2 * q])
            n.store(places[q, 2] + 8 * s.HOLD_Y, total[2 * q + 1])


@compiled
def bring_to_rest(places, coupling, numbers, motion, f, response, end, h, anew, space):
    """Give the contacts taken to rest the forces that stop them; return the largest change over mu_s N, -1 if they cannot.

    These are changed as far as needed, or shared ``anew`` by the normal forces.
    """
    m = len(places)
    chosen, most, total, whole = space[:m], space[m : 2 * m], space[2 * m : 4 * m], space[4 * m : 6 * m]
    for q in range(m):
        chosen[q] = numbers[q, RESTS]
        total[2 * q], total[2 * q + 1] = f[q, 0], f[q, 1]
        if chosen[q] != 0.0:
            if anew:
                total[2 * q], total[2 * q + 1] = 0.0, 0.0
            take(places, motion, q)
            gx, gy = law_at(places[q], end, h, numbers[q], -TURNED * numbers[q, V0], -TURNED * numbers[q, V0 + 1])
            most[q] = math.sqrt(gx * gx + gy * gy)
    if not hold(coupling, numbers, motion, f, response, h, chosen, most, total, whole, space[6 * m :]):
        return -1.0
    moved = 0.0
    for q in range(m):
        if numbers[q, RESTS] != 0.0:
            x, y = total[2 * q] - f[q, 0], total[2 * q + 1] - f[q, 1]
            moved = max(moved, math.sqrt(x * x + y * y) / (numbers[q, MU] * motion[q, NORMAL]))
            add_force(coupling, motion, f, q, x, y)
    return moved


@compiled
def hold(coupling, numbers, motion, f, response, h, chosen, most, total, whole, space):
    """Change the forces ``total`` to those that hold the ``chosen`` contacts still; return whether they can.

    A contact that would have to hold more than ``most`` holds just that, and the others the rest of it. ``whole`` gets the
    forces without such help.
    """
    m = len(f)
    index, parts, wants, x = space[:m], space[m : 2 * m], space[2 * m : 3 * m], space[3 * m : 5 * m]
    shares = space[5 * m : 7 * m]
    fill_shares(coupling, motion, shares)
    n.move(chosen, wants)
    full = False
    for turn in range(m):
        size, enough = 0, math.inf
        for q in range(m):
            if wants[q] != 0.0:
                index[size], parts[size] = q, shares[q]
                x[2 * size], x[2 * size + 1] = velocity_with(coupling, motion, f, total, q)
                size += 1
                enough = min(enough, smallest(numbers, motion, response, q, h))
        minimise(coupling, index[:size], parts, enough, x, space[7 * m :])
        again = False
        for i in range(size):
            q = int(index[i])
            total[2 * q] += x[2 * i]
            total[2 * q + 1] += x[2 * i + 1]
        if turn == 0:
            n.move(total, whole)
        for i in range(size):
            q = int(index[i])
            force = math.sqrt(total[2 * q] ** 2 + total[2 * q + 1] ** 2)
            if force > most[q]:
                total[2 * q] *= (1.0 - BELOW) * most[q] / force
                total[2 * q + 1] *= (1.0 - BELOW) * most[q] / force
                wants[q] = 0.0
                again, full = True, True
        if not again:
            break
    return not full or (helped(wants) and all_rest(coupling, numbers, motion, f, response, chosen, total, h))


@compiled
def helped(wants):
    """Return whether a contact is left that holds less than it can."""
    return wants.max() > 0.0


@compiled
def velocity_with(coupling, motion, f, total, q):
    """Return the velocity of a contact with the forces ``total`` in place of ``f``."""
    vx, vy = motion[q, VX], motion[q, VY]
    for p in range(len(f)):
        x, y = total[2 * p] - f[p, 0], total[2 * p + 1] - f[p, 1]
        vx -= coupling[3 * q, 2 * p] * x + coupling[3 * q, 2 * p + 1] * y
        vy -= coupling[3 * q + 1, 2 * p] * x + coupling[3 * q + 1, 2 * p + 1] * y
    return vx, vy


@compiled
def all_rest(coupling, numbers, motion, f, response, chosen, total, h):
    """Return whether the ``chosen`` contacts rest with the forces ``total``."""
    for q in range(len(f)):
        if chosen[q] != 0.0:
            vx, vy = velocity_with(coupling, motion, f, total, q)
            if abs(vx) + abs(vy) > AT_REST / STILL * smallest(numbers, motion, response, q, h):
                return False
    return True


@compiled
def want_rest(places, coupling, numbers, motion, f, response, h, space):
    """Write the forces that would hold the contacts that slide, once they are at rest, to their slots.

    It is their share of what keeps all contacts of such laws at the velocities that they have at the step's start.
    """
    m = len(places)
    size = 0
    index, parts, x, shares = space[:m], space[m : 2 * m], space[2 * m : 4 * m], space[4 * m : 6 * m]
    fill_shares(coupling, motion, shares)
    enough = math.inf
    for q in range(m):
        if n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0 and motion[q, NORMAL] > 0.0:
            index[size], parts[size] = q, shares[q]
            vx, vy = motion[q, VX] - numbers[q, V0], motion[q, VY] - numbers[q, V0 + 1]
            for p in range(m):
                if n.load(places[p, 3] + 8 * s.NEEDS_HOLD) != 0.0 and motion[p, NORMAL] > 0.0:
                    vx += coupling[3 * q, 2 * p] * f[p, 0] + coupling[3 * q, 2 * p + 1] * f[p, 1]
                    vy += coupling[3 * q + 1, 2 * p] * f[p, 0] + coupling[3 * q + 1, 2 * p + 1] * f[p, 1]
            x[2 * size], x[2 * size + 1] = vx, vy
            size += 1
            enough = min(enough, smallest(numbers, motion, response, q, h))
    minimise(coupling, index[:size], parts, enough, x, space[6 * m :])
    for i in range(size):
        q = int(index[i])
        if not is_held(places, q):
            n.store(places[q, 2] + 8 * s.HOLD_X, x[2 * i])
            n.store(places[q, 2] + 8 * s.HOLD_Y, x[2 * i + 1])


@compiled
def smallest(numbers, motion, response, q, h):
    """Return the velocity [m/s] that counts as none at a contact."""
    return STILL * numbers[q, MU] * motion[q, NORMAL] * h * (response[q, 0] + response[q, 3])


@compiled
def minimise(coupling, index, shares, enough, x, space):  # noqa: PLR0912
    """Replace the velocities in ``x`` by the changes of the contacts' forces that stop them, by GMRES."""
    size = 2 * len(index)
    basis = space[: (size + 1) * size].reshape(size + 1, size)
    at = (size + 1) * size
    r = space[at : at + (size + 1) * size].reshape(size, size + 1)  # column k of the triangle in row k
    at += (size + 1) * size
    cosine, sine, g = space[at : at + size], space[at + size : at + 2 * size], space[at + 2 * size : at + 3 * size + 1]
    rest = space[at + 3 * size + 1 : at + 4 * size + 1]
    g[0] = norm(x[:size])
    if g[0] <= enough:
        x[:size] = 0.0
        return
    for j in range(size):
        rest[j] = x[j]
        basis[0, j] = x[j] / g[0]
    steps = 0
    for k in range(size):
        new, column = basis[k + 1], r[k]
        mobility(coupling, index, shares, basis[k], x, new)
        length = norm(new)
        column[: k + 1] = 0.0
        for _ in range(2):  # what rounding leaves of the first time is removed by the second
            for i in range(k + 1):
                part = 0.0
                for j in range(size):
                    part += basis[i, j] * new[j]
                column[i] += part
                for j in range(size):
                    new[j] -= part * basis[i, j]
        left = norm(new)
        last = left <= DEPENDENT * length
        for j in range(size):
            new[j] = 0.0 if last else new[j] / left
        for i in range(k):
            a, b = column[i], column[i + 1]
            column[i], column[i + 1] = cosine[i] * a + sine[i] * b, cosine[i] * b - sine[i] * a
        pivot = math.sqrt(column[k] ** 2 + (0.0 if last else left**2))
        if not pivot > SLIGHT:
            break
        cosine[k], sine[k] = column[k] / pivot, (0.0 if last else left / pivot)
        column[k] = pivot
        g[k + 1] = -sine[k] * g[k]
        g[k] *= cosine[k]
        steps = k + 1
        if abs(g[k + 1]) <= enough or last:
            break
    for k in range(steps - 1, -1, -1):
        for i in range(k + 1, steps):
            g[k] -= r[i, k] * g[i]
        g[k] /= r[k, k]
    y = r[0]  # no longer needed
    y[:] = 0.0
    for k in range(steps):
        for j in range(size):
            y[j] += g[k] * basis[k, j]
    mobility(coupling, index, shares, y[:size], x, basis[0])
    for j in range(size):
        y[j] += rest[j] - basis[0, j]
    spread(index, shares, y, x)


@compiled
def norm(x):
    """Return the length of a vector."""
    total = 0.0
    for j in range(len(x)):
        total += x[j] * x[j]
    return math.sqrt(total)


@compiled
def spread(index, shares, y, x):
    """Fill the changes of forces x = S y; they run along the velocities, so that contacts do not pull at each other."""
    for i in range(len(index)):
        x[2 * i], x[2 * i + 1] = shares[i] * y[2 * i], shares[i] * y[2 * i + 1]


@compiled
def mobility(coupling, index, shares, y, x, out):
    """Fill the velocities A S y; ``x`` is to work in."""
    spread(index, shares, y, x)
    for i in range(len(index)):
        p = 3 * int(index[i])
        a, b = 0.0, 0.0
        for j in range(len(index)):
            q = 2 * int(index[j])
            a += coupling[p, q] * x[2 * j] + coupling[p, q + 1] * x[2 * j + 1]
            b += coupling[p + 1, q] * x[2 * j] + coupling[p + 1, q + 1] * x[2 * j + 1]
        out[2 * i], out[2 * i + 1] = a, b


@compiled
def fill_shares(coupling, motion, shares):
    """Fill the forces over the velocities that are the contacts' parts of what they hold together.

    They are S_q = N_q/D with D = sum_p |W_qp| N_p, its largest value among the contacts that move each other: contacts of
    one body share by their normal forces. N is a left eigenvector of |W_qp| N_p/D_p with D as for q alone, of eigenvalue 1,
    and by Perron and Frobenius all contacts together never hold more than there is.
    """
    m = len(motion)
    for q in range(m):
        shares[q] = 0.0
        for p in range(m):
            shares[q] += largest(coupling, q, p) * max(motion[p, NORMAL], 0.0)
    for q in range(m):
        most, own = 0.0, largest(coupling, q, q)
        for p in range(m):
            if p == q or largest(coupling, q, p) > COUPLED * own:
                most = max(most, abs(shares[p]))
        shares[m + q] = max(motion[q, NORMAL], 0.0) / most if most > 0.0 else 0.0
    for q in range(m):
        shares[q] = shares[m + q]


@compiled
def largest(coupling, q, p):
    """Return the most speed [m/s] that contact ``q`` gets from a newton at ``p``."""
    e, f = coupling[3 * q, 2 * p], coupling[3 * q, 2 * p + 1]
    g, k = coupling[3 * q + 1, 2 * p], coupling[3 * q + 1, 2 * p + 1]
    squares, minor = e * e + f * f + g * g + k * k, e * k - f * g
    return math.sqrt(0.5 * (squares + math.sqrt(max(squares * squares - 4.0 * minor * minor, 0.0))))
