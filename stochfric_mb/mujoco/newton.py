"""Newton's method on the forces of all contacts at once."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.answer import FREE, MU, RESTS, U0, VX, VY, add_force, answer, brake, keep_free, law_at, slides, take
from stochfric_mb.mujoco.holding import is_held

NEWTON_STEPS, TRIALS = 16, 8
"""Most steps, and most lengths that are tried of one."""
SHORT = 0.1
"""Part of its slope at the start of a step at which the potential counts as least."""
FORCE_TOLERANCE = 1.0e-10
"""Error of a force relative to mu_s N at which the search ends."""
LEVEL = 1.0e-6
"""Slope of a law, relative to the largest, that counts as none: difference quotients leave so much."""
ROUNDING = 4.0e-16
"""Error of a sum, relative to its terms."""
FLOOR, OWN, KIND, GX, SLOPES = 6, 7, 8, 9, 11
"""Columns of the slopes: error that rounding of the displacement leaves, over mu_s N; 1 where the slopes are those of the
contact's own answer; what the contact does; its answer [N]; number of the columns."""
NONE, FREELY, BRAKED = range(3)
"""What a contact does: it is held or open; it obeys its law; it comes to rest."""


@compiled
def newton(places, coupling, numbers, motion, f, response, end, h, close, space):  # noqa: PLR0912
    """Improve all forces by Newton's method; return whether it converged, else the best forces are kept.

    It solves F = S(v + h W F, N) with each contact's own answer S, in which a contact that comes to stick or to slip
    takes one step; or, ``close`` to the solution and for less work, F = law(v, N). Held contacts keep their forces.
    """
    m = len(places)
    a = space[: 4 * m * m].reshape(2 * m, 2 * m)
    at = 4 * m * m
    slopes = space[at : at + SLOPES * m].reshape(m, SLOPES)
    at += SLOPES * m
    r, best = space[at : at + 2 * m], space[at + 2 * m : at + 4 * m]
    before, step = space[at + 4 * m : at + 6 * m], space[at + 6 * m : at + 8 * m]
    slopes[:, FLOOR] = 0.0
    least, rises = math.inf, True
    for _ in range(NEWTON_STEPS):
        worst = residual(places, numbers, motion, f, response, r, slopes, end, h, close)
        if worst >= least and not rises:
            break
        if worst >= least:
            worst = shorten(places, coupling, numbers, motion, f, response, before, step, r, slopes, end, h, close)
        if worst <= FORCE_TOLERANCE:
            return True
        if worst < least:
            least = worst
            for q in range(m):
                best[2 * q], best[2 * q + 1] = f[q, 0], f[q, 1]
        n.move(r, before)
        rises = True
        for q in range(m):
            fill_slopes(places, numbers, motion, response, slopes[q], q, end, h, close)
            rises = rises and not falls(motion, slopes[q], q)
        for i in range(2 * m):
            q = i // 2
            by_vx, by_vy, by_normal = slopes[q, i % 2], slopes[q, 2 + i % 2], slopes[q, 4 + i % 2]
            for j in range(2 * m):
                a[i, j] = by_normal * coupling[3 * q + 2, j]
                if slopes[q, OWN] == 0.0 or j // 2 != q:
                    a[i, j] += by_vx * coupling[3 * q, j] + by_vy * coupling[3 * q + 1, j]
            a[i, i] += 1.0
        if not eliminate(a, r):
            break
        for q in range(m):
            step[2 * q], step[2 * q + 1] = -r[2 * q], -r[2 * q + 1]
            add_force(coupling, motion, f, q, step[2 * q], step[2 * q + 1])
    if least < math.inf:
        for q in range(m):
            add_force(coupling, motion, f, q, best[2 * q] - f[q, 0], best[2 * q + 1] - f[q, 1])
    return least <= 1.0e3 * FORCE_TOLERANCE


@compiled
def falls(motion, slope, q):
    """Return whether the contact's law falls with the speed, by its slopes."""
    if slope[KIND] != FREELY:
        return False
    vx, vy = motion[q, VX], motion[q, VY]
    along = vx * (slope[0] * vx + slope[2] * vy) + vy * (slope[1] * vx + slope[3] * vy)
    size = math.sqrt(slope[0] ** 2 + slope[1] ** 2 + slope[2] ** 2 + slope[3] ** 2)
    return along < -LEVEL * size * (vx * vx + vy * vy)


@compiled
def shorten(places, coupling, numbers, motion, f, response, before, step, r, slopes, end, h, close):
    """Go back on the last ``step`` to where the forces' potential is least; return the error there, as `residual` does.

    Laws that only rise have a convex potential, whose slope along the step is that of the velocities times the errors of
    the forces, ``before`` and ``r``. False position (Dahlquist and Bjorck, the Illinois method) finds where it is zero.
    """
    at_low, at_high = slope_along(coupling, step, before), slope_along(coupling, step, r)
    worst, least = 0.0, SHORT * abs(at_low)
    low, high, part, last = 0.0, 1.0, 1.0, 0
    if not at_low < 0.0 < at_high:
        return residual(places, numbers, motion, f, response, r, slopes, end, h, close)
    for _ in range(TRIALS):
        new = low - at_low * (high - low) / (at_high - at_low)
        for q in range(len(f)):
            add_force(coupling, motion, f, q, (new - part) * step[2 * q], (new - part) * step[2 * q + 1])
        part = new
        worst = residual(places, numbers, motion, f, response, r, slopes, end, h, close)
        slope = slope_along(coupling, step, r)
        if abs(slope) <= least:
            break
        if slope < 0.0:
            low, at_low = part, slope
            at_high *= 0.5 if last < 0 else 1.0
            last = -1
        else:
            high, at_high = part, slope
            at_low *= 0.5 if last > 0 else 1.0
            last = 1
    return worst


@compiled
def slope_along(coupling, step, errors):
    """Return the slope of the potential along a step of the forces, from their errors."""
    total = 0.0
    for i in range(len(step)):
        row, fall = coupling[3 * (i // 2) + i % 2], 0.0
        for j in range(len(step)):
            fall += row[j] * step[j]
        total += fall * errors[i]
    return total


@compiled
def residual(places, numbers, motion, f, response, r, slopes, end, h, close):
    """Fill ``r`` with force minus answer; return the largest part of mu_s N that it is.

    What rounding leaves counts as none.
    """
    worst = 0.0
    for q in range(len(places)):
        address, state, row, slope = places[q, 2], places[q, 3], numbers[q], slopes[q]
        r[2 * q], r[2 * q + 1] = 0.0, 0.0
        slope[KIND] = NONE
        if is_held(places, q) or row[RESTS] != 0.0:
            continue
        slope[KIND], braked = FREELY, False
        if close:
            vx, vy = take(places, motion, q)
            gx, gy = law_at(places[q], end, h, row, vx, vy)
            if gx * vx + gy * vy < 0.0 and slides(state, address):
                keep_free(row, response[q], h, vx, vy, f[q, 0], f[q, 1])
                part = brake(row, response[q], h, gx, gy)
                gx, gy, braked = part * gx, part * gy, part < 1.0
        else:
            gx, gy, braked = answer(places, numbers, motion, f, response, q, end, h)
        slope[GX], slope[GX + 1] = gx, gy
        r[2 * q], r[2 * q + 1] = f[q, 0] - gx, f[q, 1] - gy
        size, cap = math.hypot(r[2 * q], r[2 * q + 1]), row[MU] * n.load(address + 8 * s.NORMAL)
        part = size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0)
        if part > slope[FLOOR]:
            worst = max(worst, part)
        slope[KIND] = NONE if not cap > 0.0 else BRAKED if braked else FREELY
    return worst


@compiled
def fill_slopes(places, numbers, motion, response, slope, q, end, h, close):
    """Fill the slopes of a contact's force by vx (x, y), by vy, and by the normal force: the law's, or the answer's.

    With G and k the slopes of the law, those of the answer are (1 + h G W)^-1 G and (1 + h G W)^-1 k. A force that brings
    the contact to rest along its own direction has those of G = infinity in that direction.
    """
    address, state, row, w = places[q, 2], places[q, 3], numbers[q], response[q]
    gx, gy = slope[GX], slope[GX + 1]
    for k in range(6):
        slope[k] = 0.0
    slope[OWN] = 0.0 if close else 1.0
    if slope[KIND] == NONE:
        return
    if slope[KIND] == BRAKED:
        slope[OWN] = 1.0
        felt = h * (gx * (w[0] * gx + w[1] * gy) + gy * (w[2] * gx + w[3] * gy))
        if felt > 0.0:
            slope[0], slope[1], slope[2], slope[3] = gx * gx / felt, gx * gy / felt, gx * gy / felt, gy * gy / felt
        return
    vx, vy = motion[q, VX], motion[q, VY]
    if not close:
        vx = row[FREE] - h * (w[0] * gx + w[1] * gy)
        vy = row[FREE + 1] - h * (w[2] * gx + w[3] * gy)
    step = 1.0e-4 * n.load(state + 8 * s.STICK_SPEED)
    ax, ay = law_at(places[q], end, h, row, vx + step, vy)
    bx, by = law_at(places[q], end, h, row, vx, vy + step)
    ax, ay, bx, by = (ax - gx) / step, (ay - gy) / step, (bx - gx) / step, (by - gy) / step
    normal_force = n.load(address + 8 * s.NORMAL)
    n.store(address + 8 * s.NORMAL, (1.0 + 1.0e-6) * normal_force)
    kx, ky = law_at(places[q], end, h, row, vx, vy)
    n.store(address + 8 * s.NORMAL, normal_force)
    kx, ky = (kx - gx) / (1.0e-6 * normal_force), (ky - gy) / (1.0e-6 * normal_force)
    place = ROUNDING * (math.hypot(row[U0], row[U0 + 1]) / h + math.hypot(vx, vy))
    slope[FLOOR] = math.sqrt(ax * ax + ay * ay + bx * bx + by * by) * place / (row[MU] * normal_force)
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
