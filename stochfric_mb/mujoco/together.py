"""The forces of all contacts at the step's end, found together from how velocities and normal forces answer to them.

All is linear but the laws: relative velocities v and normal forces N fall by ``coupling`` times a change of the
forces. The unknown forces F obey F = S(v + h W F, N), with each contact's own answer S (`root.local_force`) and its own
mobility W. Sweeps over the contacts approach that; Newton's method on F - S ends it. Contacts that true stick holds
have v = 0 instead, and share what holds them by their normal forces.

Nothing here knows MuJoCo's structures or a law's formula.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.root import local_force
from stochfric_mb.mujoco.switching import call

SWEEPS, NEWTON_STEPS = 20, 8
"""Most sweeps over the contacts, and most steps of Newton's method after each."""
FORCE_TOLERANCE, SETTLED = 1.0e-10, 1.0e-11
"""Error of a force, and change of one in a sweep, relative to mu_s N, at which the search ends."""
NEAR = 1.0e-2
"""Error of the guess relative to mu_s N from which Newton's method may go without the contacts' own answers."""
TURNED = 1.0e-9
"""How far beyond rest a sliding contact is braked, relative to the velocity taken, so that its law sees it turned."""
U0, V0, SURFACE, MU, FREE = 0, 2, 4, 6, 8
"""Columns of a contact's numbers: displacement, velocity, surface velocity, coefficients, free velocity."""
VX, VY, NORMAL = range(3)
"""Columns of a contact's motion: velocity [m/s] and normal force [N] at the forces so far."""


@compiled
def settle(places, coupling, numbers, motion, f, response, end, h):
    """Find the forces ``f`` of all contacts, with their ``motion``."""
    ready = near(places, numbers, motion, f, end, h)
    if ready and newton(places, coupling, numbers, motion, f, response, end, h, True):
        return
    for _ in range(SWEEPS):
        moved = sweep(places, coupling, numbers, motion, f, response, end, h)
        if moved <= SETTLED or (len(places) == 1 and coupling[2, 0] == 0.0 and coupling[2, 1] == 0.0):
            return
        if newton(places, coupling, numbers, motion, f, response, end, h, False):
            return


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
def near(places, numbers, motion, f, end, h):
    """Return whether the guess is so near to the laws' forces, and the speeds to those before, that Newton may start."""
    for q in range(len(places)):
        address, state, row = places[q, 2], places[q, 3], numbers[q]
        if n.load(state + 8 * s.NEEDS_HOLD) != 0.0:
            return False
        vx, vy = take(places, motion, q)
        gx, gy = law_at(state, address, end, h, row, vx, vy)
        turned = slides(state, address) and gx * vx + gy * vy < 0.0
        if turned or math.hypot(f[q, 0] - gx, f[q, 1] - gy) > NEAR * row[MU] * n.load(address + 8 * s.NORMAL):
            return False
        edge = n.load(state + 8 * s.STICK_SPEED)
        if n.load(state + 8 * s.HAS_MODE) == 0.0 and (math.hypot(vx, vy) > edge) != (math.hypot(row[V0], row[V0 + 1]) > edge):
            return False
    return True


# --- one contact after the other ------------------------------------------------------------------------------------


@compiled
def sweep(places, coupling, numbers, motion, f, response, end, h):
    """Let each contact in turn find its force at the others' last ones; return the largest change over mu_s N."""
    moved = 0.0
    for q in range(len(places)):  # all from the same velocities, so that contacts alike share alike
        if n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0:
            want_hold(places, coupling, motion, f, response, q, h)
    for q in range(len(places)):
        fx, fy, _ = answer(places, numbers, motion, f, response, q, end, h)
        cap = numbers[q, MU] * n.load(places[q, 2] + 8 * s.NORMAL)
        size = math.hypot(fx - f[q, 0], fy - f[q, 1])
        moved = max(moved, size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0))
        add_force(coupling, motion, f, q, fx - f[q, 0], fy - f[q, 1])
    return moved


@compiled
def answer(places, numbers, motion, f, response, q, end, h):
    """Return the force [N] of contact ``q`` at the others' present ones, and whether it was braked to rest."""
    address, state = places[q, 2], places[q, 3]
    row, w = numbers[q], response[q]
    vx, vy = take(places, motion, q)
    row[FREE] = vx + h * (w[0] * f[q, 0] + w[1] * f[q, 1])
    row[FREE + 1] = vy + h * (w[2] * f[q, 0] + w[3] * f[q, 1])
    fx, fy = local_force(state, address, force_function(state), end, h, row, w, f[q, 0], f[q, 1])
    part = brake(row, w, h, fx, fy) if slides(state, address) else 1.0
    return part * fx, part * fy, part < 1.0


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
def force_function(state):
    """Return the address of the law's force."""
    return n.load_word(n.law_row(int(n.load(state + 8 * s.LAW))) + n.FORCE)


@compiled
def law_at(state, address, end, h, row, vx, vy):
    """Return the law's force [N] at an end velocity."""
    call(state, address, force_function(state), end, row[U0] + h * vx, row[U0 + 1] + h * vy, vx, vy, row[MU], row[MU + 1])
    return n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1))


# --- contacts that true stick holds ---------------------------------------------------------------------------------


@compiled
def is_held(places, q):
    """Return whether true stick holds the contact."""
    return n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0 and n.load(places[q, 2] + 8 * s.STICK) != 0.0


@compiled
def want_hold(places, coupling, motion, f, response, q, h):
    """Write the force that would hold contact ``q`` still, of which it takes its share."""
    address = places[q, 2]
    part = share(coupling, motion, q)
    hold(address, response[q], h, part * motion[q, VX], part * motion[q, VY])
    n.store(address + 8 * s.HOLD_X, n.load(address + 8 * s.HOLD_X) + f[q, 0])
    n.store(address + 8 * s.HOLD_Y, n.load(address + 8 * s.HOLD_Y) + f[q, 1])


@compiled
def share(coupling, motion, q):
    """Return the contact's part, by normal forces, of what it and those that move with it have to hold.

    It is N_q/sum_p |W_qq^-1 W_qp| N_p: then N is an eigenvector of the mobilities' sizes so weighted, with eigenvalue 1,
    and by Perron and Frobenius the sweeps, all contacts from the same velocities, never overshoot.
    """
    mine = max(motion[q, NORMAL], 0.0)
    a, b = coupling[3 * q, 2 * q], coupling[3 * q, 2 * q + 1]
    c, d = coupling[3 * q + 1, 2 * q], coupling[3 * q + 1, 2 * q + 1]
    det, total = a * d - b * c, 0.0
    for p in range(len(motion)):
        if not motion[p, NORMAL] > 0.0:
            continue
        e, f = coupling[3 * q, 2 * p], coupling[3 * q, 2 * p + 1]
        g, k = coupling[3 * q + 1, 2 * p], coupling[3 * q + 1, 2 * p + 1]
        if det > 1.0e-9 * (a + d) * (a + d):
            e, f, g, k = (d * e - b * g) / det, (d * f - b * k) / det, (a * g - c * e) / det, (a * k - c * f) / det
        elif a + d > 0.0:
            e, f, g, k = e / (a + d), f / (a + d), g / (a + d), k / (a + d)
        squares, minor = e * e + f * f + g * g + k * k, e * k - f * g
        largest = math.sqrt(0.5 * (squares + math.sqrt(max(squares * squares - 4.0 * minor * minor, 0.0))))
        total += largest * motion[p, NORMAL]
    return mine / total if total > 0.0 else 1.0


@compiled
def hold(address, w, h, vx, vy):
    """Write the force that takes (vx, vy) from the velocity within the step; a direction that cannot move needs none."""
    a, b, d = w[0], 0.5 * (w[1] + w[2]), w[3]
    det = a * d - b * b
    if det > 1.0e-9 * (a + d) * (a + d):
        n.store(address + 8 * s.HOLD_X, (d * vx - b * vy) / (h * det))
        n.store(address + 8 * s.HOLD_Y, (a * vy - b * vx) / (h * det))
    elif a + d > 0.0:  # one direction only: W = lambda e e^T, and its trace is lambda
        trace = a + d
        x = (a * vx + b * vy) / (h * trace * trace)
        y = (b * vx + d * vy) / (h * trace * trace)
        n.store(address + 8 * s.HOLD_X, x)
        n.store(address + 8 * s.HOLD_Y, y)
    else:
        n.store(address + 8 * s.HOLD_X, 0.0)
        n.store(address + 8 * s.HOLD_Y, 0.0)


# --- Newton's method on all contacts --------------------------------------------------------------------------------


@compiled
def newton(places, coupling, numbers, motion, f, response, end, h, close):  # noqa: PLR0912
    """Improve all forces by Newton's method; return whether it converged, else the best forces are kept.

    It solves F = S(v + h W F, N) with each contact's own answer S, in which a contact that comes to stick or to slip
    takes one step; or, ``close`` to the solution and for less work, F = law(v, N). Held contacts keep their forces.
    """
    m = len(places)
    held = 0
    for q in range(m):
        held += is_held(places, q)
    if held == m:
        return False
    a, slopes, r, best = np.empty((2 * m, 2 * m)), np.empty((m, 6)), np.empty(2 * m), np.empty(2 * m)
    least = math.inf
    for _ in range(NEWTON_STEPS):
        worst = residual(places, numbers, motion, f, response, r, slopes, end, h, close)
        if worst <= FORCE_TOLERANCE:
            return held == 0
        if worst < least:
            least = worst
            for q in range(m):
                best[2 * q], best[2 * q + 1] = f[q, 0], f[q, 1]
        elif close:
            break
        for i in range(2 * m):
            q = i // 2
            by_vx, by_vy, by_normal = slopes[q, i % 2], slopes[q, 2 + i % 2], slopes[q, 4 + i % 2]
            for j in range(2 * m):
                a[i, j] = by_normal * coupling[3 * q + 2, j]
                if close or j // 2 != q:
                    a[i, j] += by_vx * coupling[3 * q, j] + by_vy * coupling[3 * q + 1, j]
            a[i, i] += 1.0
        if not eliminate(a, r):
            break
        for q in range(m):
            add_force(coupling, motion, f, q, -r[2 * q], -r[2 * q + 1])
    if least < math.inf:
        for q in range(m):
            add_force(coupling, motion, f, q, best[2 * q] - f[q, 0], best[2 * q + 1] - f[q, 1])
    return held == 0 and least <= 1.0e3 * FORCE_TOLERANCE


@compiled
def residual(places, numbers, motion, f, response, r, slopes, end, h, close):
    """Fill ``r`` with force minus answer, and the answer's slopes; return the largest part of mu_s N that ``r`` is."""
    worst = 0.0
    for q in range(len(places)):
        address, state, row = places[q, 2], places[q, 3], numbers[q]
        r[2 * q], r[2 * q + 1] = 0.0, 0.0
        for k in range(6):
            slopes[q, k] = 0.0
        if is_held(places, q):
            continue
        braked = False
        if close:
            vx, vy = take(places, motion, q)
            gx, gy = law_at(state, address, end, h, row, vx, vy)
        else:
            gx, gy, braked = answer(places, numbers, motion, f, response, q, end, h)
        r[2 * q], r[2 * q + 1] = f[q, 0] - gx, f[q, 1] - gy
        size, cap = math.hypot(r[2 * q], r[2 * q + 1]), row[MU] * n.load(address + 8 * s.NORMAL)
        part = size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0)
        worst = max(worst, part)
        if cap > 0.0 and worst > FORCE_TOLERANCE:
            if braked:
                brake_slopes(response[q], slopes[q], gx, gy, h)
            else:
                fill_slopes(places, numbers, motion, response, slopes[q], q, gx, gy, end, h, close)
    return worst


@compiled
def brake_slopes(w, slope, gx, gy, h):
    """Fill the slopes of the force that brings a contact to rest along its own direction."""
    felt = h * (gx * (w[0] * gx + w[1] * gy) + gy * (w[2] * gx + w[3] * gy))
    if felt > 0.0:
        slope[0], slope[1], slope[2], slope[3] = gx * gx / felt, gx * gy / felt, gx * gy / felt, gy * gy / felt


@compiled
def fill_slopes(places, numbers, motion, response, slope, q, gx, gy, end, h, close):
    """Fill the slopes of the force (gx, gy) by vx (x, y), by vy, and by the normal force: the law's, or the answer's.

    With G and k the slopes of the law, those of the answer are (1 + h G W)^-1 G and (1 + h G W)^-1 k.
    """
    address, state, row, w = places[q, 2], places[q, 3], numbers[q], response[q]
    vx, vy = motion[q, VX], motion[q, VY]
    if not close:
        vx = row[FREE] - h * (w[0] * gx + w[1] * gy)
        vy = row[FREE + 1] - h * (w[2] * gx + w[3] * gy)
    step = 1.0e-4 * n.load(state + 8 * s.STICK_SPEED)
    ax, ay = law_at(state, address, end, h, row, vx + step, vy)
    bx, by = law_at(state, address, end, h, row, vx, vy + step)
    ax, ay, bx, by = (ax - gx) / step, (ay - gy) / step, (bx - gx) / step, (by - gy) / step
    normal_force = n.load(address + 8 * s.NORMAL)
    n.store(address + 8 * s.NORMAL, (1.0 + 1.0e-6) * normal_force)
    kx, ky = law_at(state, address, end, h, row, vx, vy)
    n.store(address + 8 * s.NORMAL, normal_force)
    kx, ky = (kx - gx) / (1.0e-6 * normal_force), (ky - gy) / (1.0e-6 * normal_force)
    if not close:
        p, o = 1.0 + h * (ax * w[0] + bx * w[2]), h * (ax * w[1] + bx * w[3])
        u, v = h * (ay * w[0] + by * w[2]), 1.0 + h * (ay * w[1] + by * w[3])
        det = p * v - o * u
        if det == 0.0:
            return
        ax, ay = (v * ax - o * ay) / det, (p * ay - u * ax) / det
        bx, by = (v * bx - o * by) / det, (p * by - u * bx) / det
        kx, ky = (v * kx - o * ky) / det, (p * ky - u * kx) / det
    slope[0], slope[1], slope[2], slope[3], slope[4], slope[5] = ax, ay, bx, by, kx, ky


@compiled
def eliminate(a, x):
    """Replace x by the solution of A y = x (Gauss, partial pivots); return whether A is regular."""
    size = len(x)
    for k in range(size):
        p = k
        for i in range(k + 1, size):
            if abs(a[i, k]) > abs(a[p, k]):
                p = i
        if a[p, k] == 0.0:
            return False
        if p != k:
            for j in range(k, size):
                a[k, j], a[p, j] = a[p, j], a[k, j]
            x[k], x[p] = x[p], x[k]
        for i in range(k + 1, size):
            part = a[i, k] / a[k, k]
            if part != 0.0:
                for j in range(k + 1, size):
                    a[i, j] -= part * a[k, j]
                x[i] -= part * x[k]
    for i in range(size - 1, -1, -1):
        total = x[i]
        for j in range(i + 1, size):
            total -= a[i, j] * x[j]
        x[i] = total / a[i, i]
    return True
