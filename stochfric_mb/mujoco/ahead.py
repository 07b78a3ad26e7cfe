"""What happens within the step to come: where laws with modes would switch, with the forces found so far."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.answer import NORMAL, TURNED, U0, V0, VX, VY, law_at, slides
from stochfric_mb.mujoco.holding import want_rest
from stochfric_mb.mujoco.kinematics import put
from stochfric_mb.mujoco.switching import guards_at, keep_guards, switch_within

FULL = 1.0e-8
"""Part of a sliding force that is missing where it has brought the contact to rest."""
SWITCH_SPACE = 9 + MAX_STATE
"""Length of the work space of `switch_slot`."""


@compiled
def start_guards(places, numbers, at, t):
    """Keep the guards at the step's start, with the normal forces of the step."""
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        n.store(address + 8 * s.NORMAL, at[q, NORMAL])
        if n.load(state + 8 * s.HAS_MODE) != 0.0:
            row = n.law_row(int(n.load(state + 8 * s.LAW)))
            guards_at(state, address, row, t, numbers[q, U0], numbers[q, U0 + 1], numbers[q, V0], numbers[q, V0 + 1])
            keep_guards(state, address)


@compiled
def switch_ahead(places, coupling, numbers, response, at, f, t, end, h, space):
    """Let the laws with modes switch where they would within the step; return whether any did."""
    switched, rests = False, False
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        if n.load(state + 8 * s.NEEDS_HOLD) != 0.0 and n.load(address + 8 * s.STICK) == 0.0:
            n.store(address + 8 * s.HOLD_X, f[q, 0])
            n.store(address + 8 * s.HOLD_Y, f[q, 1])
            rests = rests or stops(places, numbers, at, f, q, end, h)
    if rests:
        want_rest(places, coupling, numbers, at, f, response, h, space)
    for q in range(len(places)):
        address, state, row = places[q, 2], places[q, 3], numbers[q]
        if n.load(state + 8 * s.HAS_MODE) == 0.0 or not n.load(address + 8 * s.NORMAL) > 0.0:
            continue
        vx, vy = at[q, VX], at[q, VY]
        if stops(places, numbers, at, f, q, end, h):  # a little beyond rest, whatever rounding leaves
            vx, vy = -TURNED * row[V0], -TURNED * row[V0 + 1]
        switched = switch_slot(state, address, row, t, end, h, vx, vy, space) or switched
    return switched


@compiled
def stops(places, numbers, at, f, q, end, h):
    """Return whether a contact that slides comes to rest within the step: its force is less than the law's."""
    address, state = places[q, 2], places[q, 3]
    if not slides(state, address) or not n.load(address + 8 * s.NORMAL) > 0.0:
        return False
    gx, gy = law_at(places[q], end, h, numbers[q], at[q, VX], at[q, VY])
    return math.hypot(f[q, 0], f[q, 1]) < (1.0 - FULL) * math.hypot(gx, gy)


@compiled
def switch_slot(state, address, row, t, end, h, vx, vy, kept):
    """Run `switch_within` on a slot over the step to come; return whether its law state is another one.

    ``kept`` is to work in.
    """
    before, now = address + 8 * s.BEFORE, address + 8 * s.UX
    for j in range(5):
        kept[j] = n.load(before + 8 * j)
    for j in range(4):
        kept[5 + j] = n.load(now + 8 * j)
    for j in range(MAX_STATE):
        kept[9 + j] = n.load(address + 8 * (s.STATE + j))
    put(before, t, row[U0], row[U0 + 1])
    n.store(before + 24, row[V0])
    n.store(before + 32, row[V0 + 1])
    put(now, row[U0] + h * vx, row[U0 + 1] + h * vy, vx)
    n.store(now + 24, vy)
    switch_within(state, address, n.law_row(int(n.load(state + 8 * s.LAW))), end)
    for j in range(5):
        n.store(before + 8 * j, kept[j])
    for j in range(4):
        n.store(now + 8 * j, kept[5 + j])
    changed = False
    for j in range(MAX_STATE):
        changed = changed or n.load(address + 8 * (s.STATE + j)) != kept[9 + j]
    return changed
