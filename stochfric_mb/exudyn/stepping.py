"""What happens to a contact once a step: the law commits, the coefficients move on, a sample is taken.

One compiled function for all laws; a contact is two arrays (`layout`).
"""

from __future__ import annotations

import math

from numba import carray  # pyright: ignore[reportPrivateImportUsage]

from stochfric_mb.coefficients.path import CURSOR, canonical_time
from stochfric_mb.coefficients.processes import EVENT, POSITION, TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.exudyn.contact_force import ask, kinematics, pair_at, penalty, spun
from stochfric_mb.exudyn.layout import (
    ASK_FIRST,
    COMMIT,
    CURSOR_AT,
    EVENTS,
    FORCE,
    GIVEN_NORMAL,
    GIVEN_RATE,
    GUARD,
    GUARDS_BEFORE,
    HAS_MODE,
    HELD,
    HOLD,
    HOLD_BEFORE,
    INIT,
    JUMP,
    LARGEST_NORMAL,
    LAW,
    LINE,
    LOCATING,
    MU_K,
    MU_S,
    N_LAW,
    N_NUMBERS,
    N_RECORDS,
    N_STATE,
    N_WORDS,
    NEW,
    NEXT_RECORD,
    NORMAL_FORCE,
    NUMBERS,
    PAIR,
    PENALTY,
    REACH,
    RECORD_COLUMNS,
    RECORDS,
    SPIN,
    SPIN_BEFORE,
    SPUN,
    START,
    STARTED,
    STATE,
    STEP,
    STICK_SPEED,
    STUCK,
    SWITCHED,
    U_2,
    V_2,
    WATCHING,
    T,
    U,
    V,
)
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.numerics.memory import as_doubles, as_words

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
    words = carray(as_words(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(as_doubles(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    ahead = t - numbers[T]
    if words[ASK_FIRST] == 1 or words[STARTED] == 0 or ahead <= 0.0 or ahead > numbers[REACH]:
        return FETCH
    return _proceed(t, numbers, words)


@compiled
def proceed(t, address):
    """Commit as `advance`, with coordinates that are in place.

    The same time with the same motion changes nothing (a solver that goes on from where it stopped); an earlier time, or
    a jump, is a new simulation.
    """
    words = carray(as_words(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(as_doubles(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    return _proceed(t, numbers, words)


@compiled_inline
def _proceed(t, numbers, words):
    motion = kinematics(t, numbers, words)
    n = penalty(numbers) if words[PENALTY] == 1 else max(numbers[GIVEN_NORMAL], 0.0)
    bits = NOTHING
    if words[STARTED] == 0 or t < numbers[T] or (t == numbers[T] and _moved(motion, numbers)):
        _forget_spin(t, numbers)
        motion = kinematics(t, numbers, words)
        restart(t, motion, n, numbers, words)
        numbers[START] = t
        bits = RESTARTED
    elif t > numbers[T]:
        bits = _commit(t, motion, n, numbers, words)
    due = words[NEXT_RECORD]
    if due < words[N_RECORDS]:
        records = carray(as_doubles(words[RECORDS]), (words[N_RECORDS], RECORD_COLUMNS))  # pyright: ignore[reportCallIssue]
        if t >= records[due, 0] - max(GRID * numbers[STEP], ROUNDING):
            records[due, 0] = canonical_time(t, 0.5 * numbers[STEP])
            records[due, 1], records[due, 8], records[due, 2], records[due, 9] = motion
            records[due, 4], records[due, 5], records[due, 6] = numbers[MU_S], numbers[MU_K], numbers[STUCK]
            records[due, 7] = n
            words[NEXT_RECORD] = due + 1
            if words[HELD] == 1:
                bits |= RECORDED
            else:
                ask(words[FORCE], t, motion, n, pair_at(t, motion[0], numbers, words), numbers, NEW)
                records[due, 3], records[due, 10] = (numbers[NEW], numbers[NEW + 1]) if n > 0.0 else (0.0, 0.0)
    return bits


@compiled_inline
def _moved(motion, numbers):
    ux, uy, vx, vy = motion
    return ux != numbers[U] or uy != numbers[U_2] or vx != numbers[V] or vy != numbers[V_2]


@compiled
def _forget_spin(t, numbers):
    """Let the displacement that turning adds begin at time t [s]."""
    for i in range(2):
        numbers[SPUN + i], numbers[SPIN_BEFORE + i] = 0.0, numbers[SPIN + i]
    numbers[T] = t


@compiled_inline
def _keep(t, motion, n, numbers):
    """Remember the accepted step."""
    for i in range(2):
        numbers[SPUN + i] = spun(t, i, numbers)
        numbers[SPIN_BEFORE + i] = numbers[SPIN + i]
    numbers[T], numbers[NORMAL_FORCE] = t, n
    numbers[HOLD_BEFORE], numbers[HOLD_BEFORE + 1] = numbers[HOLD], numbers[HOLD + 1]
    numbers[LARGEST_NORMAL] = max(numbers[LARGEST_NORMAL], n)
    numbers[U], numbers[U_2], numbers[V], numbers[V_2] = motion


@compiled
def restart(t, motion, n, numbers, words):
    """Start the contact afresh at time t."""
    numbers[EVENTS], numbers[LARGEST_NORMAL] = 0.0, 0.0
    _keep(t, motion, n, numbers)
    numbers[REACH] = 1.5 * numbers[STEP]
    numbers[SWITCHED], numbers[PAIR] = -math.inf, math.nan
    words[STARTED] = 1
    pair = pair_at(t, motion[0], numbers, words)
    _law_gives(words[INIT], t, motion, n, pair, numbers, words)
    numbers[STUCK] = _sticks(motion, n, numbers)
    numbers[MU_S], numbers[MU_K] = pair
    _set_line(t, numbers)
    ask(words[GUARD], t, motion, n, pair, numbers, GUARDS_BEFORE)
    words[WATCHING] = 1


@compiled_inline
def _commit(t, motion, n, numbers, words):
    pair = pair_at(t, motion[0], numbers, words)
    mode, h, before = numbers[STATE], t - numbers[T], (numbers[MU_S], numbers[MU_K])
    function = words[COMMIT] if n > 0.0 else words[INIT]  # without normal force the contact begins again
    _law_gives(function, t, motion, n, pair, numbers, words)
    bits = _skipped(t, motion[0], numbers, words)
    numbers[REACH] = 1.5 * max(numbers[STEP], t - numbers[T])
    _keep(t, motion, n, numbers)
    stuck = _sticks(motion, n, numbers)
    if stuck > numbers[STUCK]:
        numbers[EVENTS] += 1.0
        pair = pair_at(t, motion[0], numbers, words)
    numbers[STUCK] = stuck
    numbers[MU_S], numbers[MU_K] = pair
    _set_line(t, numbers)
    if words[LOCATING] == 1:
        switched = numbers[HAS_MODE] == 1.0 and numbers[STATE] != mode
        bent = _bent_pair(pair, before, numbers[STEP] / h, numbers, words)
        bits |= _watch(t, motion, n, pair, bent, switched, numbers, words)
    return bits


@compiled_inline
def _law_gives(address, t, motion, n, pair, numbers, words):
    """Take the state that ``init`` or ``commit`` gives."""
    ask(address, t, motion, n, pair, numbers, NEW)
    for i in range(words[N_STATE]):
        numbers[STATE + i] = numbers[NEW + i]


@compiled
def _watch(t, motion, n, pair, bent, switched, numbers, words):
    """Find out whether the next step may contain a switch or must return to the grid; return WATCH if that is news."""
    ask(words[GUARD], t, motion, n, bent, numbers, NEW)
    bend = (numbers[NEW], numbers[NEW + 1], numbers[NEW + 2], numbers[NEW + 3], numbers[NEW + 4], numbers[NEW + 5])
    ask(words[GUARD], t, motion, n, pair, numbers, NEW)
    steps = (t - numbers[START]) / numbers[STEP]
    if switched:
        numbers[SWITCHED] = t
    watch = settling(t, numbers) or numbers[JUMP] < math.inf or abs(steps - math.floor(steps + 0.5)) > GRID
    for i in range(GUARDS):
        new = numbers[NEW + i]
        change = new - numbers[GUARDS_BEFORE + i]
        if new > 0.0 and new < STEPS_AHEAD * max(abs(change), abs(change + bend[i] - new)):
            watch = True
        numbers[GUARDS_BEFORE + i] = new
    if watch == (words[WATCHING] == 1):
        return NOTHING
    words[WATCHING] = 1 if watch else 0
    return WATCH


@compiled_inline
def _bent_pair(pair, before, steps, numbers, words):
    """Return the pair with what a bend of the path adds to it in the next step, on a path in time that is linear between knots.

    ``before`` is the pair at the start of the step just taken, ``steps`` a step over that one.
    """
    descriptor = numbers[LAW + words[N_LAW] :]
    if descriptor[0] == 0.0 or descriptor[1] != TIME or descriptor[2] == 0.0:
        return pair
    cursor, part = numbers[CURSOR_AT : CURSOR_AT + CURSOR], numbers[STEP] / descriptor[3]
    bend_s = (cursor[4] - cursor[2]) * part - (pair[0] - before[0]) * steps
    bend_k = (cursor[5] - cursor[3]) * part - (pair[1] - before[1]) * steps
    return pair[0] + bend_s, pair[1] + bend_k


@compiled_inline
def settling(t, numbers):
    """Return whether a step that begins at t follows a change of mode closely."""
    return t - numbers[SWITCHED] < (FINE_STEPS - GRID) * numbers[STEP]


@compiled_inline
def _sticks(motion, n, numbers):
    if n <= 0.0:
        return 0.0
    if numbers[HAS_MODE] == 1.0:
        return 1.0 if numbers[STATE] == 0.0 else 0.0
    return 1.0 if math.hypot(motion[2], motion[3]) <= numbers[STICK_SPEED] else 0.0


@compiled_inline
def _set_line(t, numbers):
    """Put the normal force of the next step on the line from now on."""
    numbers[LINE], numbers[LINE + 1] = numbers[GIVEN_NORMAL] - numbers[GIVEN_RATE] * t, numbers[GIVEN_RATE]


@compiled_inline
def _skipped(t, u, numbers, words):
    """Return LOST where the step that ends at t and u has passed more than one knot of the path."""
    descriptor = numbers[LAW + words[N_LAW] :]
    if descriptor[0] == 0.0 or descriptor[1] == EVENT:
        return NOTHING
    now, before = (u, numbers[U]) if descriptor[1] == POSITION else (t, numbers[T])
    if abs(now - before) <= descriptor[3]:
        return NOTHING
    passed = math.floor(now / descriptor[3] + GRID) - math.floor(before / descriptor[3] + GRID)
    return LOST if abs(passed) > 1 else NOTHING
