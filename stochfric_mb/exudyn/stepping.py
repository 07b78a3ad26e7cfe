"""What happens to a contact once a step: the law commits, the coefficients move on, a sample is taken.

One compiled function for all laws. A contact is two arrays: ``numbers`` (floats) and ``words`` (integers: addresses of
the law's functions and of the engine's coordinates, counters, the address of the path).
"""

from __future__ import annotations

import math

import numpy as np
from llvmlite import ir
from numba import carray, types  # pyright: ignore[reportPrivateImportUsage]
from numba.extending import intrinsic

from stochfric_mb.coefficients.path import CURSOR, canonical_time, evaluate, seek
from stochfric_mb.coefficients.processes import EVENT, POSITION
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.laws.contract import GUARDS

# entries of ``numbers``
T, U, V, U_2, V_2 = 0, 1, 2, 3, 4
"""Time [s], relative displacement [m] and velocity [m/s], in both directions, at the last accepted step."""
EVENTS, STUCK, MU_S, MU_K = 5, 6, 7, 8
"""Stick phases begun so far, whether the contact sticks, and its coefficients, at the last accepted step."""
NORMAL_FORCE, MASS, STICK_SPEED, HAS_MODE = 9, 10, 11, 12
"""Normal force [N] at the last accepted step, mass that the contact feels [kg], and two properties of the law."""
STEP, START = 13, 14
"""The solver's step [s] and start time [s], which span the grid that steps keep to."""
WINDOW = 15
"""Knot in the middle of the engine's window on the path."""
SAFE, SAFE_WIDTH = 16, 17
"""Middle and half width of the stretch, of time or displacement, in which the window stays."""
REACH = 18
"""Longest time to the next step [s] after which the engine's coordinates are taken to be where they were."""
SURFACE_VELOCITY, SURFACE_VELOCITY_2 = 19, 20
"""Velocity of the counter-surface on top of marker 0's, in both directions [m/s]."""
RADIUS = 21
"""Length by which a rotation is multiplied to a sliding distance [m/rad]; 1 for displacements."""
GIVEN_NORMAL, GIVEN_RATE = 22, 23
"""Normal force [N] now, and its expected rate of change [N/s] in the next step, where something else sets it."""
STIFFNESS, DAMPING, TOUCH = 24, 25, 26
"""Normal contact: stiffness [N/m], damping [N s/m], and distance along the normal at which it begins [m]."""
AXIS_1, AXIS_2, NORMAL = 27, 30, 33
"""Directions of the tangent plane and its normal, from the counter-surface to the body."""
DISTANCE, RATE = 36, 39
"""Position [m] and velocity [m/s] of marker 1 relative to marker 0."""
SWITCHED = 42
"""Time of the law's last change of mode [s]."""
LARGEST_NORMAL = 43
"""Largest normal force [N] of this simulation."""
SPIN, SPUN, SPIN_BEFORE = 44, 46, 48
"""What turning adds to the motion of marker 1 relative to marker 0, along both axes of the plane: velocity [m/s] now,
displacement [m] up to the last accepted step, and velocity there. 0 for contacts without (see `frames`)."""
NEW = 50
"""Scratch for a law's output."""
GUARDS_BEFORE = NEW + MAX_STATE
"""The law's guards at the last accepted step."""
CURSOR_AT = GUARDS_BEFORE + 8
WINDOW_CURSOR_AT = CURSOR_AT + CURSOR
"""Cursors on the path: of the coefficients now, and of the engine's window."""
LIVE = WINDOW_CURSOR_AT + CURSOR
"""State, pair, line of the normal force and segment, in the order of `symbolic.live_names`, as the engine should have them."""
N_LIVE_MAX = MAX_STATE + 2 + 2 + 9
LAW = LIVE + N_LIVE_MAX
"""The law's parameter vector, then the path's descriptor."""

# entries of ``words``
NUMBERS, RECORDS = 0, 1
"""Addresses of the contact's numbers and of its records."""
COMMIT, GUARD, INIT = 2, 3, 4
"""Addresses of the law's functions."""
POSITION_0, POSITION_1, VELOCITY_0, VELOCITY_1 = 5, 6, 7, 8
"""Addresses of the coordinates of the two markers."""
N_NUMBERS, N_STATE, N_LAW, SEED, SAMPLE, CONTACT, N_RECORDS, NEXT_RECORD = 9, 10, 11, 12, 13, 14, 15, 16
STARTED, ASK_FIRST, LOCATING, WATCHING = 17, 18, 19, 20
"""Whether the contact has begun, its coordinates must be fetched first, steps are located, and one may switch soon."""
PLANE, PENALTY, FORCE = 21, 22, 23
"""Whether it slides in a plane, whether the normal force follows from the penetration, address of the law's force."""
N_WORDS = 24

NOTHING, CHANGED, RECORDED, LOST, RESTARTED, FETCH, WATCH = 0, 1, 2, 4, 8, 16, 32
"""Bits of what `advance` returns."""
RECORD_COLUMNS = 11
"""time, displacement, velocity, friction force, mu_s, mu_k, stick, normal force; second displacement, velocity, force."""

GRID = 5.0e-5
"""Part of a step that counts as on the grid of steps (as `canonical_time` has it, since engine time is a sum of steps)."""
ROUNDING = 1.0e-9
"""What a sum of many steps may differ from the time it stands for [s]."""
FINE_STEPS = 8.0
"""Steps within so many steps after a change of mode are shortened: the force changes fast then."""
STEPS_AHEAD = 3.0
"""A guard is watched where it may turn within so many steps at the rate of the last one."""


@intrinsic
def number_at(typingctx, address):
    """Return the double at an address."""

    def generate(context, builder, signature, args):
        return builder.load(builder.inttoptr(args[0], ir.DoubleType().as_pointer()))

    return types.float64(types.int64), generate


@intrinsic
def numbers_from(typingctx, address):
    """Return the pointer to the doubles at an address."""

    def generate(context, builder, signature, args):
        return builder.inttoptr(args[0], ir.DoubleType().as_pointer())

    return types.CPointer(types.float64)(types.int64), generate


@intrinsic
def words_from(typingctx, address):
    """Return the pointer to the integers at an address."""

    def generate(context, builder, signature, args):
        return builder.inttoptr(args[0], ir.IntType(64).as_pointer())

    return types.CPointer(types.int64)(types.int64), generate


@compiled
def dot(numbers, a, b):
    """Return the product of the vectors at ``numbers[a:]`` and ``numbers[b:]``."""
    return numbers[a] * numbers[b] + numbers[a + 1] * numbers[b + 1] + numbers[a + 2] * numbers[b + 2]


@compiled
def spun(t, i, numbers):
    """Return the displacement [m] that turning has added by time t along axis i, by the trapezoidal rule in the step."""
    return numbers[SPUN + i] + 0.5 * (t - numbers[T]) * (numbers[SPIN_BEFORE + i] + numbers[SPIN + i])


@compiled
def kinematics(t, numbers, words):
    """Return relative displacements [m] and velocities [m/s], counter-surface minus body, from the engine's coordinates."""
    w = numbers[SURFACE_VELOCITY]
    if words[PLANE] == 1:
        w_2 = numbers[SURFACE_VELOCITY_2]
        dx, dy = dot(numbers, AXIS_1, DISTANCE) + spun(t, 0, numbers), dot(numbers, AXIS_2, DISTANCE) + spun(t, 1, numbers)
        vx, vy = dot(numbers, AXIS_1, RATE) + numbers[SPIN], dot(numbers, AXIS_2, RATE) + numbers[SPIN + 1]
        return w * t - dx, w_2 * t - dy, w - vx, w_2 - vy
    d = number_at(words[POSITION_1]) - number_at(words[POSITION_0])  # pyright: ignore[reportCallIssue]
    v = number_at(words[VELOCITY_1]) - number_at(words[VELOCITY_0])  # pyright: ignore[reportCallIssue]
    return w * t - numbers[RADIUS] * d, 0.0, w - numbers[RADIUS] * v, 0.0


@compiled
def normal_force_at(t, numbers, words):
    """Return the normal force [N] that the engine uses at time t: penalty, or the line on from the last step."""
    if words[PENALTY] == 1:
        return penalty(numbers)
    line = LIVE + words[N_STATE] + 2
    return max(numbers[line] + numbers[line + 1] * t, 0.0)


@compiled
def penalty(numbers):
    """Return the unilateral normal force [N] of the penetration, k p + c dp/dt while it is positive and p > 0."""
    depth = numbers[TOUCH] - dot(numbers, NORMAL, DISTANCE)
    if depth <= 0.0:
        return 0.0
    return max(numbers[STIFFNESS] * depth - numbers[DAMPING] * dot(numbers, NORMAL, RATE), 0.0)


@compiled
def pair_at(t, u, numbers, words):
    """Return (mu_s, mu_k) [-] at time t and relative displacement u."""
    descriptor = numbers[LAW + words[N_LAW] :]
    cursor = numbers[CURSOR_AT : CURSOR_AT + CURSOR]
    time = canonical_time(t, 0.5 * numbers[STEP])
    return evaluate(descriptor, cursor, words[SEED], words[SAMPLE], words[CONTACT], time, u, numbers[EVENTS])


@compiled
def ask(address, t, motion, n, pair, numbers, into):
    """Call a function of the law with the committed state; its output goes to ``numbers[into:]``."""
    at = numbers.ctypes.data
    state, p, out = at + 8 * LIVE, at + 8 * LAW, at + 8 * into
    ux, uy, vx, vy = motion
    m = numbers[MASS]
    call_law(address, t, ux, uy, vx, vy, n, pair[0], pair[1], m, 0.0, 0.0, state, p, out)  # pyright: ignore[reportCallIssue]


@compiled
def force_at(t, u, v, address):
    """Return the friction force [N] at time t [s], displacement u [m] and velocity v [m/s]; nothing is committed."""
    words = carray(words_from(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(numbers_from(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    n = normal_force_at(t, numbers, words)
    ask(words[FORCE], t, (u, 0.0, v, 0.0), n, pair_at(t, u, numbers, words), numbers, NEW)
    return numbers[NEW]


@compiled
def advance(t, address):
    """Commit the accepted step that ends at ``t`` of the contact whose words are at ``address``.

    Returns bits that say what the caller has to do; FETCH: see where the coordinates are, then call `proceed`.
    """
    words = carray(words_from(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(numbers_from(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
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
    words = carray(words_from(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(numbers_from(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    return _proceed(t, numbers, words)


@compiled
def _proceed(t, numbers, words):
    motion = kinematics(t, numbers, words)
    n = penalty(numbers) if words[PENALTY] == 1 else max(numbers[GIVEN_NORMAL], 0.0)
    bits = NOTHING
    if words[STARTED] == 0 or t < numbers[T] or (t == numbers[T] and _moved(motion, numbers)):
        _forget_spin(t, numbers)
        motion = kinematics(t, numbers, words)
        restart(t, motion, n, numbers, words)
        numbers[START] = t
        bits = CHANGED | RESTARTED
    elif t > numbers[T]:
        bits = _commit(t, motion, n, numbers, words)
    due = words[NEXT_RECORD]
    if due < words[N_RECORDS]:
        records = carray(numbers_from(words[RECORDS]), (words[N_RECORDS], RECORD_COLUMNS))  # pyright: ignore[reportCallIssue]
        if t >= records[due, 0] - max(GRID * numbers[STEP], ROUNDING):
            records[due, 0] = canonical_time(t, 0.5 * numbers[STEP])
            records[due, 1], records[due, 8], records[due, 2], records[due, 9] = motion
            records[due, 4], records[due, 5], records[due, 6] = numbers[MU_S], numbers[MU_K], numbers[STUCK]
            records[due, 7] = n
            words[NEXT_RECORD] = due + 1
            bits |= RECORDED
    return bits


@compiled
def _moved(motion, numbers):
    ux, uy, vx, vy = motion
    return ux != numbers[U] or uy != numbers[U_2] or vx != numbers[V] or vy != numbers[V_2]


@compiled
def _forget_spin(t, numbers):
    """Let the displacement that turning adds begin at time t [s]."""
    for i in range(2):
        numbers[SPUN + i], numbers[SPIN_BEFORE + i] = 0.0, numbers[SPIN + i]
    numbers[T] = t


@compiled
def _keep(t, motion, n, numbers):
    """Remember the accepted step."""
    for i in range(2):
        numbers[SPUN + i] = spun(t, i, numbers)
        numbers[SPIN_BEFORE + i] = numbers[SPIN + i]
    numbers[T], numbers[NORMAL_FORCE] = t, n
    numbers[LARGEST_NORMAL] = max(numbers[LARGEST_NORMAL], n)
    numbers[U], numbers[U_2], numbers[V], numbers[V_2] = motion


@compiled
def restart(t, motion, n, numbers, words):
    """Start the contact afresh at time t."""
    numbers[EVENTS], numbers[LARGEST_NORMAL] = 0.0, 0.0
    _keep(t, motion, n, numbers)
    numbers[REACH] = 1.5 * numbers[STEP]
    numbers[SWITCHED] = -math.inf
    words[STARTED] = 1
    pair = pair_at(t, motion[0], numbers, words)
    _law_gives(words[INIT], t, motion, n, pair, numbers, words)
    numbers[STUCK] = _sticks(motion, n, numbers)
    _set_pair(pair, numbers, words)
    _set_normal_line(t, numbers, words)
    numbers[WINDOW], numbers[SAFE_WIDTH] = math.nan, 0.0
    _move_window(t, motion[0], numbers, words)
    ask(words[GUARD], t, motion, n, pair, numbers, GUARDS_BEFORE)
    words[WATCHING] = 1


@compiled
def _commit(t, motion, n, numbers, words):
    pair = pair_at(t, motion[0], numbers, words)
    mode = numbers[LIVE]
    function = words[COMMIT] if n > 0.0 else words[INIT]  # without normal force the contact begins again
    bits = _law_gives(function, t, motion, n, pair, numbers, words)
    numbers[REACH] = 1.5 * max(numbers[STEP], t - numbers[T])
    _keep(t, motion, n, numbers)
    stuck = _sticks(motion, n, numbers)
    if stuck > numbers[STUCK]:
        numbers[EVENTS] += 1.0
        pair = pair_at(t, motion[0], numbers, words)
    numbers[STUCK] = stuck
    if words[LOCATING] == 1:
        switched = numbers[HAS_MODE] == 1.0 and numbers[LIVE] != mode
        bits |= _watch(t, motion, n, pair, switched, numbers, words)
    bits |= _set_pair(pair, numbers, words) | _set_normal_line(t, numbers, words)
    return bits | _move_window(t, motion[0], numbers, words)


@compiled
def _law_gives(address, t, motion, n, pair, numbers, words):
    """Take the state that ``init`` or ``commit`` gives; return CHANGED if it differs."""
    ask(address, t, motion, n, pair, numbers, NEW)
    bits = NOTHING
    for i in range(words[N_STATE]):
        if numbers[LIVE + i] != numbers[NEW + i]:
            numbers[LIVE + i] = numbers[NEW + i]
            bits = CHANGED
    return bits


@compiled
def _watch(t, motion, n, pair, switched, numbers, words):
    """Find out whether the next step may contain a switch or must return to the grid; return WATCH if that is news."""
    ask(words[GUARD], t, motion, n, pair, numbers, NEW)
    steps = (t - numbers[START]) / numbers[STEP]
    if switched:
        numbers[SWITCHED] = t
    watch = settling(t, numbers) or abs(steps - math.floor(steps + 0.5)) > GRID
    for i in range(GUARDS):
        new = numbers[NEW + i]
        if new > 0.0 and new < STEPS_AHEAD * abs(new - numbers[GUARDS_BEFORE + i]):
            watch = True
        numbers[GUARDS_BEFORE + i] = new
    if watch == (words[WATCHING] == 1):
        return NOTHING
    words[WATCHING] = 1 if watch else 0
    return WATCH


@compiled
def settling(t, numbers):
    """Return whether a step that begins at t follows a change of mode closely."""
    return t - numbers[SWITCHED] < (FINE_STEPS - GRID) * numbers[STEP]


@compiled
def _sticks(motion, n, numbers):
    if n <= 0.0:
        return 0.0
    if numbers[HAS_MODE] == 1.0:
        return 1.0 if numbers[LIVE] == 0.0 else 0.0
    return 1.0 if math.hypot(motion[2], motion[3]) <= numbers[STICK_SPEED] else 0.0


@compiled
def _set_pair(pair, numbers, words):
    """Take the coefficients; return CHANGED if the engine's own pair differs (a path along events only)."""
    numbers[MU_S], numbers[MU_K] = pair
    at = LIVE + words[N_STATE]
    if numbers[LAW + words[N_LAW] + 1] != EVENT or (numbers[at] == pair[0] and numbers[at + 1] == pair[1]):
        return NOTHING
    numbers[at], numbers[at + 1] = pair
    return CHANGED


@compiled
def _set_normal_line(t, numbers, words):
    """Put the engine's normal force on the line from now on; return CHANGED if it is another one."""
    line = LIVE + words[N_STATE] + 2
    rate = numbers[GIVEN_RATE]
    start = numbers[GIVEN_NORMAL] - rate * t
    if numbers[line] == start and numbers[line + 1] == rate:
        return NOTHING
    numbers[line], numbers[line + 1] = start, rate
    return CHANGED


@compiled
def _move_window(t, u, numbers, words):
    """Put the engine's window on the path around the knot ahead (time) or the nearest one (position).

    Returns LOST where the step has left the window it was computed with: then its coefficients were not the path's.
    """
    descriptor = numbers[LAW + words[N_LAW] :]
    if descriptor[0] == 0.0 or descriptor[1] == EVENT:
        return NOTHING
    spacing = descriptor[3]
    place = u if descriptor[1] == POSITION else t
    if abs(place - numbers[SAFE]) < numbers[SAFE_WIDTH]:
        return NOTHING
    if descriptor[1] == POSITION:
        r = u / spacing
        middle = math.floor(r + 0.5)
    else:
        r = canonical_time(t, 0.5 * numbers[STEP]) / spacing
        middle = math.floor(r) + 1.0
    reach = 0.0 if descriptor[1] == POSITION else 0.5
    numbers[SAFE], numbers[SAFE_WIDTH] = (middle - reach) * spacing, (0.5 - GRID) * spacing
    if middle == numbers[WINDOW]:
        return NOTHING
    bits = LOST if abs(r - numbers[WINDOW]) > 1.0 + GRID else NOTHING
    numbers[WINDOW] = middle
    cursor = numbers[WINDOW_CURSOR_AT : WINDOW_CURSOR_AT + CURSOR]
    seek(descriptor, cursor, words[SEED], words[SAMPLE], words[CONTACT], middle - 1.0)
    left_s, left_k, mid_s, mid_k = cursor[2], cursor[3], cursor[4], cursor[5]
    seek(descriptor, cursor, words[SEED], words[SAMPLE], words[CONTACT], middle)
    segment = numbers[LIVE + words[N_STATE] + 4 :]
    segment[0] = middle * spacing
    segment[1], segment[2] = left_s, left_k
    segment[3], segment[4] = (mid_s - left_s) / spacing, (mid_k - left_k) / spacing
    segment[5], segment[6] = (cursor[4] - mid_s) / spacing, (cursor[5] - mid_k) / spacing
    segment[7], segment[8] = mid_s, mid_k
    return bits | CHANGED


@compiled
def force_now(t, address, into):
    """Put the friction force [N] at time t at the doubles ``into``: its two directions and the normal force.

    Coordinates must be in place; nothing is committed.
    """
    words = carray(words_from(address), (N_WORDS,))  # pyright: ignore[reportCallIssue]
    numbers = carray(numbers_from(words[NUMBERS]), (words[N_NUMBERS],))  # pyright: ignore[reportCallIssue]
    out = carray(numbers_from(into), (3,))  # pyright: ignore[reportCallIssue]
    out[0], out[1] = 0.0, 0.0
    motion, out[2] = kinematics(t, numbers, words), normal_force_at(t, numbers, words)
    if out[2] > 0.0:
        pair = pair_at(t, motion[0], numbers, words)
        ask(words[FORCE], t, motion, out[2], pair, numbers, NEW)
        out[0], out[1] = numbers[NEW], numbers[NEW + 1]


def blank(n_law: int, n_path: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the two arrays of a contact, zero."""
    numbers, words = np.zeros(LAW + n_law + n_path), np.zeros(N_WORDS, dtype=np.int64)
    words[[NUMBERS, N_NUMBERS]] = numbers.ctypes.data, len(numbers)
    return numbers, words
