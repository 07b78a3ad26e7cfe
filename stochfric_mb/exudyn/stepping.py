"""What happens to a contact once a step: the law commits, the coefficients move on, a sample is taken.

One compiled function for all laws; a contact is two arrays (`layout`).
"""

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import CURSOR, canonical_time
from stochfric_mb.coefficients.processes import EVENT, POSITION, TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact_force import ask, kinematics, pair_at, penalty, spun
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.numerics.memory import as_doubles, carray

NOTHING, RECORDED, LOST, RESTARTED, FETCH, WATCH = 0, 1, 2, 4, 8, 16
"""Bits of what `advance` returns."""
GRID = 5.0e-5
"""Part of a step that counts as on the grid of steps (as `canonical_time` has it, since engine time is a sum of steps)."""
ROUNDING = 1.0e-9
"""What a sum of many steps may differ from the time it stands for [s]."""
FINE_STEPS = 8.0
"""Steps within so many steps after a change of mode are shortened: the force changes fast then."""
STEPS_AHEAD = 3.0
"""A guard is watched where it may turn within so many steps at the rate of the last one."""


@compiled
def advance(t, address):
    """Commit the accepted step that ends at ``t`` of the contact whose words are at ``address``.

    Returns bits that say what the caller has to do; FETCH: see where the coordinates are, then call `proceed`.
    """
    numbers, words = at.arrays(address)
    ahead = t - numbers[at.T]
    if words[at.ASK_FIRST] == 1 or words[at.STARTED] == 0 or ahead <= 0.0 or ahead > numbers[at.REACH]:
        return FETCH
    return _proceed(t, numbers, words)


@compiled
def proceed(t, address):
    """Commit as `advance`, with coordinates that are in place.

    The same time with the same motion changes nothing (a solver that goes on from where it stopped); an earlier time, or
    a jump, is a new simulation.
    """
    numbers, words = at.arrays(address)
    return _proceed(t, numbers, words)


@compiled_inline
def _proceed(t, numbers, words):
    motion = kinematics(t, numbers, words)
    n = penalty(numbers) if words[at.PENALTY] == 1 else max(numbers[at.GIVEN_NORMAL], 0.0)
    bits = NOTHING
    if words[at.STARTED] == 0 or t < numbers[at.T] or (t == numbers[at.T] and _moved(motion, numbers)):
        _forget_spin(t, numbers)
        motion = kinematics(t, numbers, words)
        restart(t, motion, n, numbers, words)
        numbers[at.START] = t
        bits = RESTARTED
    elif t > numbers[at.T]:
        bits = _commit(t, motion, n, numbers, words)
    due = words[at.NEXT_RECORD]
    if due < words[at.N_RECORDS]:
        records = carray(as_doubles(words[at.RECORDS]), (words[at.N_RECORDS], at.RECORD_COLUMNS))
        if t >= records[due, 0] - max(GRID * numbers[at.STEP], ROUNDING):
            records[due, 0] = canonical_time(t, 0.5 * numbers[at.STEP])
            records[due, 1], records[due, 8], records[due, 2], records[due, 9] = motion
            records[due, 4], records[due, 5], records[due, 6] = numbers[at.MU_S], numbers[at.MU_K], numbers[at.STUCK]
            records[due, 7] = n
            words[at.NEXT_RECORD] = due + 1
            if words[at.HELD] == 1:
                bits |= RECORDED
            else:
                ask(words[at.FORCE], t, motion, n, pair_at(t, motion[0], numbers, words), numbers, at.NEW)
                records[due, 3], records[due, 10] = (numbers[at.NEW], numbers[at.NEW + 1]) if n > 0.0 else (0.0, 0.0)
    return bits


@compiled_inline
def _moved(motion, numbers):
    ux, uy, vx, vy = motion
    return ux != numbers[at.U] or uy != numbers[at.U_2] or vx != numbers[at.V] or vy != numbers[at.V_2]


@compiled
def _forget_spin(t, numbers):
    """Let the displacement that turning adds begin at time t [s]."""
    for i in range(2):
        numbers[at.SPUN + i], numbers[at.SPIN_BEFORE + i] = 0.0, numbers[at.SPIN + i]
    numbers[at.T] = t


@compiled_inline
def _keep(t, motion, n, numbers):
    """Remember the accepted step."""
    for i in range(2):
        numbers[at.SPUN + i] = spun(t, i, numbers)
        numbers[at.SPIN_BEFORE + i] = numbers[at.SPIN + i]
    numbers[at.T], numbers[at.NORMAL_FORCE] = t, n
    numbers[at.HOLD_BEFORE], numbers[at.HOLD_BEFORE + 1] = numbers[at.HOLD], numbers[at.HOLD + 1]
    numbers[at.LARGEST_NORMAL] = max(numbers[at.LARGEST_NORMAL], n)
    numbers[at.U], numbers[at.U_2], numbers[at.V], numbers[at.V_2] = motion


@compiled
def restart(t, motion, n, numbers, words):
    """Start the contact afresh at time t."""
    numbers[at.EVENTS], numbers[at.LARGEST_NORMAL] = 0.0, 0.0
    _keep(t, motion, n, numbers)
    numbers[at.REACH] = 1.5 * numbers[at.STEP]
    numbers[at.SWITCHED], numbers[at.PAIR] = -math.inf, math.nan
    words[at.STARTED] = 1
    pair = pair_at(t, motion[0], numbers, words)
    _law_gives(words[at.INIT], t, motion, n, pair, numbers, words)
    numbers[at.STUCK] = _sticks(motion, n, numbers)
    numbers[at.MU_S], numbers[at.MU_K] = pair
    _set_line(t, numbers)
    ask(words[at.GUARD], t, motion, n, pair, numbers, at.GUARDS_BEFORE)
    words[at.WATCHING] = 1


@compiled_inline
def _commit(t, motion, n, numbers, words):
    pair = pair_at(t, motion[0], numbers, words)
    mode, h, before = numbers[at.STATE], t - numbers[at.T], (numbers[at.MU_S], numbers[at.MU_K])
    function = words[at.COMMIT] if n > 0.0 else words[at.INIT]  # without normal force the contact begins again
    _law_gives(function, t, motion, n, pair, numbers, words)
    bits = _skipped(t, motion[0], numbers, words)
    numbers[at.REACH] = 1.5 * max(numbers[at.STEP], t - numbers[at.T])
    _keep(t, motion, n, numbers)
    stuck = _sticks(motion, n, numbers)
    if stuck > numbers[at.STUCK]:
        numbers[at.EVENTS] += 1.0
        pair = pair_at(t, motion[0], numbers, words)
    numbers[at.STUCK] = stuck
    numbers[at.MU_S], numbers[at.MU_K] = pair
    _set_line(t, numbers)
    if words[at.LOCATING] == 1:
        switched = numbers[at.HAS_MODE] == 1.0 and numbers[at.STATE] != mode
        bent = _bent_pair(pair, before, numbers[at.STEP] / h, numbers, words)
        bits |= _watch(t, motion, n, pair, bent, switched, numbers, words)
    return bits


@compiled_inline
def _law_gives(address, t, motion, n, pair, numbers, words):
    """Take the state that ``init`` or ``commit`` gives."""
    ask(address, t, motion, n, pair, numbers, at.NEW)
    for i in range(words[at.N_STATE]):
        numbers[at.STATE + i] = numbers[at.NEW + i]


@compiled
def _watch(t, motion, n, pair, bent, switched, numbers, words):
    """Find out whether the next step may contain a switch or must return to the grid; return WATCH if that is news."""
    ask(words[at.GUARD], t, motion, n, bent, numbers, at.NEW + GUARDS)
    ask(words[at.GUARD], t, motion, n, pair, numbers, at.NEW)
    steps = (t - numbers[at.START]) / numbers[at.STEP]
    if switched:
        numbers[at.SWITCHED] = t
    watch = settling(t, numbers) or numbers[at.JUMP] < math.inf or abs(steps - math.floor(steps + 0.5)) > GRID
    for i in range(GUARDS):
        new = numbers[at.NEW + i]
        change = new - numbers[at.GUARDS_BEFORE + i]
        if new > 0.0 and new < STEPS_AHEAD * max(abs(change), abs(change + numbers[at.NEW + GUARDS + i] - new)):
            watch = True
        numbers[at.GUARDS_BEFORE + i] = new
    if watch == (words[at.WATCHING] == 1):
        return NOTHING
    words[at.WATCHING] = 1 if watch else 0
    return WATCH


@compiled_inline
def _bent_pair(pair, before, steps, numbers, words):
    """Return the pair with what a bend of the path adds to it in the next step, on a path in time that is linear between knots.

    ``before`` is the pair at the start of the step just taken, ``steps`` a step over that one.
    """
    descriptor = numbers[at.LAW + words[at.N_LAW] :]
    if descriptor[0] == 0.0 or descriptor[1] != TIME or descriptor[2] == 0.0:
        return pair
    cursor, part = numbers[at.CURSOR_AT : at.CURSOR_AT + CURSOR], numbers[at.STEP] / descriptor[3]
    bend_s = (cursor[4] - cursor[2]) * part - (pair[0] - before[0]) * steps
    bend_k = (cursor[5] - cursor[3]) * part - (pair[1] - before[1]) * steps
    return pair[0] + bend_s, pair[1] + bend_k


@compiled_inline
def settling(t, numbers):
    """Return whether a step that begins at t follows a change of mode closely."""
    return t - numbers[at.SWITCHED] < (FINE_STEPS - GRID) * numbers[at.STEP]


@compiled_inline
def _sticks(motion, n, numbers):
    if n <= 0.0:
        return 0.0
    if numbers[at.HAS_MODE] == 1.0:
        return 1.0 if numbers[at.STATE] == 0.0 else 0.0
    return 1.0 if math.hypot(motion[2], motion[3]) <= numbers[at.STICK_SPEED] else 0.0


@compiled_inline
def _set_line(t, numbers):
    """Put the normal force of the next step on the line from now on."""
    numbers[at.LINE], numbers[at.LINE + 1] = numbers[at.GIVEN_NORMAL] - numbers[at.GIVEN_RATE] * t, numbers[at.GIVEN_RATE]


@compiled_inline
def _skipped(t, u, numbers, words):
    """Return LOST where the step that ends at t and u has passed more than one knot of the path."""
    descriptor = numbers[at.LAW + words[at.N_LAW] :]
    if descriptor[0] == 0.0 or descriptor[1] == EVENT:
        return NOTHING
    now, before = (u, numbers[at.U]) if descriptor[1] == POSITION else (t, numbers[at.T])
    if abs(now - before) <= descriptor[3]:
        return NOTHING
    passed = math.floor(now / descriptor[3] + GRID) - math.floor(before / descriptor[3] + GRID)
    return LOST if abs(passed) > 1 else NOTHING
