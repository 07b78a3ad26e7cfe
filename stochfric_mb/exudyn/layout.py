"""What stands where in the two arrays of a contact: ``numbers`` (floats) and ``words`` (integers).

The words are addresses, of the law's functions, the engine's coordinates and the path, and counters.
"""

from __future__ import annotations

import numpy as np
from numba import types

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.compile import compiled_inline
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.numerics.memory import as_doubles, as_words, carray, function_at

# entries of ``numbers``
T, U, V, U_2, V_2 = 0, 1, 2, 3, 4
"""Time [s], relative displacement [m] and velocity [m/s], in both directions, at the last accepted step."""
EVENTS, STUCK, MU_S, MU_K = 5, 6, 7, 8
"""Stick phases begun so far, whether the contact sticks, and its coefficients, at the last accepted step."""
NORMAL_FORCE, MASS, STICK_SPEED, HAS_MODE = 9, 10, 11, 12
"""Normal force [N] at the last accepted step, mass that the contact feels [kg], and two properties of the law."""
STEP, START = 13, 14
"""The solver's step [s] and start time [s], which span the grid that steps keep to."""
LINE = 15
"""The normal force of the next step is on a line in time: its value [N] at time 0 and its slope [N/s]."""
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
HOLD, HOLD_BEFORE = GUARDS_BEFORE + 6, GUARDS_BEFORE + 8
"""Friction force [N] that would hold the contact still, in both directions, now and at the last accepted step; 0 where nothing
tells it."""
JUMP = GUARDS_BEFORE + 10
"""Time [s] just after a jump of the normal force as a function of time that lies in the next step; infinity: none does."""
PERIOD = GUARDS_BEFORE + 11
"""Displacement [m] of a whole turn, after which the engine's angle begins again; 0 for displacements."""
PAIR = GUARDS_BEFORE + 12
"""Time [s], mu_s and mu_k of the last coefficients asked for that depend on time alone: solvers ask several times for one."""
CURSOR_AT = PAIR + 3
"""Cursor on the path of coefficients, where the last ones were asked for."""
STATE = CURSOR_AT + CURSOR
"""The law's committed state."""
LAW = STATE + MAX_STATE
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
HELD = 24
"""Whether a constraint may hold the contact, so that samples need the force from the engine."""
N_WORDS = 25

RECORD_COLUMNS = 11
"""time, displacement, velocity, friction force, mu_s, mu_k, stick, normal force; second displacement, velocity, force."""


call_at = function_at(types.int32, types.float64)
"""Return what the function at an address, int(double), says of a time."""


@compiled_inline
def arrays(address):
    """Return the numbers and the words of the contact whose words are at an address."""
    words = carray(as_words(address), (N_WORDS,))
    return carray(as_doubles(words[NUMBERS]), (words[N_NUMBERS],)), words


def blank(n_law: int, n_path: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the two arrays of a contact, zero."""
    numbers, words = np.zeros(LAW + n_law + n_path), np.zeros(N_WORDS, dtype=np.int64)
    words[[NUMBERS, N_NUMBERS]] = numbers.ctypes.data, len(numbers)
    return numbers, words
