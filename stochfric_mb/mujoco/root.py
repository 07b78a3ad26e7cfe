"""The force of one contact at the step's end: the root of F = force(u + h v, v) with v = c - h W F.

Where the law's force runs along the velocity, v = (1 + h k W)^-1 c with F = k v: one equation for one number, whatever
W is (`along_velocity`). Else the direction of the force that the law would give at the free velocity c gives one
equation (`along`), and what is left across it, Newton's method with difference quotients removes.
Where a falling law has several roots, the one is taken that the velocity meets first on its way from that at the
step's start, as the motion itself would.
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
from stochfric_mb.mujoco.switching import call

PRECISION = 1.0e-11
"""Error of a force relative to mu_s N at which the search ends."""
LEVEL = 1.0e-2
"""Change of the force over mu_s N between two velocities that leaves no room for another root between them."""
ROUNDING = 4.0e-16
"""Error of a sum, relative to its terms."""
PARALLEL = 1.0e-9
"""Sine of the angle between force and velocity that counts as none."""
STUCK = 1.0 - 1.0e-12
"""Part of the velocity along W's main axis that is gone when a contact counts as stuck."""
ROOT_STEPS, NEWTON_STEPS, TURNS, EXPANSIONS, HALVINGS = 80, 8, 3, 8, 14
U0, V0, MU, FREE = 0, 2, 6, 8


@compiled
def law_force(state, address, function, end, h, row, w, fx, fy):
    """Return the law's force [N] at the end velocity that (fx, fy) leads to."""
    vx = row[FREE] - h * (w[0] * fx + w[1] * fy)
    vy = row[FREE + 1] - h * (w[2] * fx + w[3] * fy)
    call(state, address, function, end, row[U0] + h * vx, row[U0 + 1] + h * vy, vx, vy, row[MU], row[MU + 1])
    return n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1))


@compiled
def end_speed(h, row, w, fx, fy):
    """Return the relative speed [m/s] at the step's end that (fx, fy) leads to."""
    vx = row[FREE] - h * (w[0] * fx + w[1] * fy)
    vy = row[FREE + 1] - h * (w[2] * fx + w[3] * fy)
    return math.hypot(vx, vy)


@compiled
def local_force(state, address, function, end, h, row, w, fx, fy):  # noqa: PLR0911
    """Return the contact's force [N]; (fx, fy) is the last guess."""
    cap = row[MU] * n.load(address + 8 * s.NORMAL)
    if not cap > 0.0:
        return 0.0, 0.0
    tolerance = PRECISION * cap
    gx, gy = law_force(state, address, function, end, h, row, w, fx, fy)
    if math.hypot(gx - fx, gy - fy) <= tolerance:
        return fx, fy
    keeps = steady(state, h, row, w, gx, gy)
    if keeps:
        kx, ky = law_force(state, address, function, end, h, row, w, gx, gy)
        if math.hypot(kx - gx, ky - gy) <= tolerance:
            return gx, gy
    kx, ky, found = newton(state, address, function, end, h, row, w, gx if keeps else fx, gy if keeps else fy, tolerance)
    if found and is_first(state, address, function, end, h, row, w, kx, ky, cap):
        return kx, ky
    ex, ey = law_force(state, address, function, end, h, row, w, 0.0, 0.0)
    size = math.hypot(ex, ey)
    if size == 0.0:
        return 0.0, 0.0
    if abs(ex * row[FREE + 1] - ey * row[FREE]) <= PARALLEL * size * math.hypot(row[FREE], row[FREE + 1]):
        kx, ky, found = along_velocity(state, address, function, end, h, row, w, cap)
        if found:
            gx, gy = law_force(state, address, function, end, h, row, w, kx, ky)
            if math.hypot(gx - kx, gy - ky) <= tolerance:
                return kx, ky
            kx, ky, _ = newton(state, address, function, end, h, row, w, kx, ky, tolerance)
            return kx, ky
    for _ in range(TURNS):
        ex, ey = ex / size, ey / size
        part = along(state, address, function, end, h, row, w, ex, ey, cap, fx * ex + fy * ey)
        fx, fy = part * ex, part * ey
        gx, gy = law_force(state, address, function, end, h, row, w, fx, fy)
        size = math.hypot(gx, gy)
        across = abs(gx * ey - gy * ex)
        if across <= tolerance or size == 0.0:
            return fx, fy
        ex, ey = gx, gy
        if across > 0.1 * size:
            break
    fx, fy, _ = newton(state, address, function, end, h, row, w, fx, fy, tolerance)
    return fx, fy


@compiled
def is_first(state, address, function, end, h, row, w, fx, fy, cap):
    """Return whether a root is the one that the velocity meets first: the law is almost level on the way, or only rises."""
    modes = n.load(state + 8 * s.HAS_MODE) != 0.0
    if modes and n.load(address + 8 * s.STICK) != 0.0:
        return True
    vx, vy = row[V0], row[V0 + 1]
    if not modes:
        fast = math.hypot(vx, vy) > n.load(state + 8 * s.STICK_SPEED)
        if (end_speed(h, row, w, fx, fy) > n.load(state + 8 * s.STICK_SPEED)) != fast:
            return False
        if not fast:
            return True
    call(state, address, function, end, row[U0] + h * vx, row[U0 + 1] + h * vy, vx, vy, row[MU], row[MU + 1])
    before = math.hypot(n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1)))
    return abs(math.hypot(fx, fy) - before) <= LEVEL * cap


@compiled
def steady(state, h, row, w, fx, fy):
    """Return whether a force may be a root of its own: the speed stays on its side of the law's peak."""
    if n.load(state + 8 * s.HAS_MODE) != 0.0:
        return True
    edge = n.load(state + 8 * s.STICK_SPEED)
    return (end_speed(h, row, w, fx, fy) > edge) == (math.hypot(row[V0], row[V0 + 1]) > edge)


@compiled
def force_at(h, row, w, ex, ey, turns, part):
    """Return a force [N]: ``part`` along (ex, ey), or, if it ``turns``, the one along the velocity that it leads to.

    Then (ex, ey) is W's main axis, and ``part`` of the free velocity along it is gone.
    """
    if not turns:
        return part * ex, part * ey
    b = 0.5 * (w[1] + w[2])
    main = ex * (w[0] * ex + b * ey) + ey * (b * ex + w[3] * ey)
    k = part / ((1.0 - part) * h * main)
    x = (row[FREE] * ex + row[FREE + 1] * ey) * (1.0 - part)
    y = (row[FREE + 1] * ex - row[FREE] * ey) / (1.0 + h * k * max(w[0] + w[3] - main, 0.0))
    return k * (x * ex - y * ey), k * (x * ey + y * ex)


@compiled
def excess(state, address, function, end, h, row, w, ex, ey, turns, part):
    """Return the force minus the law's, along the force [N]."""
    fx, fy = force_at(h, row, w, ex, ey, turns, part)
    gx, gy = law_force(state, address, function, end, h, row, w, fx, fy)
    if not turns:
        return part - (gx * ex + gy * ey)
    size = math.hypot(fx, fy)
    return size - (gx * fx + gy * fy) / size if size > 0.0 else -math.hypot(gx, gy)


@compiled
def part_at(h, row, w, ex, ey, speed):
    """Return the part of the velocity along W's main axis that is gone where ``speed`` is left of it all."""
    low, high = math.log(1.0 - STUCK), 0.0
    for _ in range(HALVINGS):  # to half a per cent of the speed: it is to tell one root from the next
        middle = 0.5 * (low + high)
        fx, fy = force_at(h, row, w, ex, ey, True, 1.0 - math.exp(middle))
        if end_speed(h, row, w, fx, fy) > speed:
            high = middle
        else:
            low = middle
    return 1.0 - math.exp(high)


@compiled
def along_velocity(state, address, function, end, h, row, w, cap):
    """Return the force [N] that runs along the velocity that it leads to, and whether there is one."""
    angle = 0.5 * math.atan2(w[1] + w[2], w[0] - w[3])
    ex, ey = math.cos(angle), math.sin(angle)
    if not ex * (w[0] * ex + w[1] * ey) + ey * (w[2] * ex + w[3] * ey) > 0.0:
        return 0.0, 0.0, False
    high = STUCK
    at_high = excess(state, address, function, end, h, row, w, ex, ey, True, high)
    if not at_high > 0.0:
        return 0.0, 0.0, False
    start = part_at(h, row, w, ex, ey, math.hypot(row[V0], row[V0 + 1]))
    edge = part_at(h, row, w, ex, ey, n.load(state + 8 * s.STICK_SPEED))
    low, at_low = start, excess(state, address, function, end, h, row, w, ex, ey, True, start)
    if at_low > 0.0:
        high, at_high, low = start, at_low, 0.0
        at_low = excess(state, address, function, end, h, row, w, ex, ey, True, low)
    if low < edge < high:
        middle = excess(state, address, function, end, h, row, w, ex, ey, True, edge)
        if middle > 0.0:
            high, at_high = edge, middle
        else:
            low, at_low = edge, middle
    part = root(state, address, function, end, h, row, w, ex, ey, True, low, at_low, high, at_high, -1.0, PRECISION * cap)
    fx, fy = force_at(h, row, w, ex, ey, True, part)
    return fx, fy, True


@compiled
def along(state, address, function, end, h, row, w, ex, ey, cap, guess):  # noqa: PLR0912
    """Return the size [N] of the force along the direction (ex, ey)."""
    felt = h * (ex * (w[0] * ex + w[1] * ey) + ey * (w[2] * ex + w[3] * ey))
    high, top = cap, 0.0
    for _ in range(EXPANSIONS):
        top = excess(state, address, function, end, h, row, w, ex, ey, False, high)
        if top >= 0.0:
            break
        high *= 2.0
    if not felt > 0.0:
        return high - top
    free = row[FREE] * ex + row[FREE + 1] * ey
    start = min(max((free - row[V0] * ex - row[V0 + 1] * ey) / felt, 0.0), high)
    edge = (free - n.load(state + 8 * s.STICK_SPEED)) / felt
    here = excess(state, address, function, end, h, row, w, ex, ey, False, start)
    if here == 0.0:
        return start
    if here < 0.0:
        low, at_low, at_high = start, here, top
        if start < edge < high:
            middle = excess(state, address, function, end, h, row, w, ex, ey, False, edge)
            if middle >= 0.0:
                high, at_high = edge, middle
            else:
                low, at_low = edge, middle
    else:
        low, at_low, high, at_high = 0.0, -1.0, start, here
        if 0.0 < edge < start:
            middle = excess(state, address, function, end, h, row, w, ex, ey, False, edge)
            if middle <= 0.0:
                low, at_low = edge, middle
            else:
                high, at_high = edge, middle
        if low == 0.0:
            at_low = excess(state, address, function, end, h, row, w, ex, ey, False, 0.0)
    return root(state, address, function, end, h, row, w, ex, ey, False, low, at_low, high, at_high, guess, PRECISION * cap)


@compiled
def root(state, address, function, end, h, row, w, ex, ey, turns, low, at_low, high, at_high, guess, tolerance):
    """Return the root between two sizes of opposite excess: false position (Anderson and Bjorck), halved when slow."""
    if at_low >= 0.0:
        return low
    if at_high <= 0.0:
        return high
    x = guess if low < guess < high else low - at_low * (high - low) / (at_high - at_low)
    width, last = high - low, 0
    for i in range(ROOT_STEPS):
        y = excess(state, address, function, end, h, row, w, ex, ey, turns, x)
        if abs(y) <= tolerance:
            return x
        shrink = 1.0 - y / (at_low if y < 0.0 else at_high)
        shrink = shrink if shrink > 0.0 else 0.5
        if y < 0.0:
            low, at_low = x, y
            at_high *= shrink if last < 0 else 1.0
            last = -1
        else:
            high, at_high = x, y
            at_low *= shrink if last > 0 else 1.0
            last = 1
        if high - low <= 4.0e-16 * high:
            return x
        if i % 3 == 2:
            slow = high - low > 0.5 * width
            width = high - low
            if slow:
                x = 0.5 * (low + high)
                continue
        x = low - at_low * (high - low) / (at_high - at_low)
        if not low < x < high:
            x = 0.5 * (low + high)
    return x


@compiled
def newton(state, address, function, end, h, row, w, fx, fy, tolerance):
    """Return the force (fx, fy) [N] improved by Newton's method in the plane, and whether nothing is left to improve."""
    step = 1.0e-4 * n.load(state + 8 * s.STICK_SPEED)
    gx, gy = law_force(state, address, function, end, h, row, w, fx, fy)
    rx, ry = fx - gx, fy - gy
    size = math.hypot(rx, ry)
    for _ in range(NEWTON_STEPS):
        if size <= tolerance:
            return fx, fy, True
        row[FREE] += step
        ax, ay = law_force(state, address, function, end, h, row, w, fx, fy)
        row[FREE] -= step
        row[FREE + 1] += step
        bx, by = law_force(state, address, function, end, h, row, w, fx, fy)
        row[FREE + 1] -= step
        ax, ay, bx, by = (ax - gx) / step, (ay - gy) / step, (bx - gx) / step, (by - gy) / step
        rounding = ROUNDING * (math.hypot(row[U0], row[U0 + 1]) / h + math.hypot(row[FREE], row[FREE + 1]))
        if size <= rounding * math.sqrt(ax * ax + ay * ay + bx * bx + by * by):
            return fx, fy, True
        p, q = 1.0 + h * (ax * w[0] + bx * w[2]), h * (ax * w[1] + bx * w[3])
        u, v = h * (ay * w[0] + by * w[2]), 1.0 + h * (ay * w[1] + by * w[3])
        det = p * v - q * u
        if det == 0.0:
            break
        dx, dy = (v * rx - q * ry) / det, (p * ry - u * rx) / det
        better = False
        for _ in range(6):
            tx, ty = law_force(state, address, function, end, h, row, w, fx - dx, fy - dy)
            new = math.hypot(fx - dx - tx, fy - dy - ty)
            if new < size:
                fx, fy, gx, gy = fx - dx, fy - dy, tx, ty
                rx, ry, size = fx - gx, fy - gy, new
                better = True
                break
            dx, dy = 0.5 * dx, 0.5 * dy
        if not better:
            break
    return fx, fy, size <= tolerance
