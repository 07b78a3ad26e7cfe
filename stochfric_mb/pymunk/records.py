"""Names of the entries of the arrays that compiled callbacks and Python share.

Words are 64-bit integers: the *context* (one for each space with friction), the *table* (one for each call of
`add_friction`) and a *pair* for each slot. Doubles are the *clock* (one for each table) and the *slots*: all that is
known of one contact, that is of one pair of shapes.
"""

from __future__ import annotations

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.pymunk.layout import NAMES

# --- context: what was there before, whom to call when something is wrong, and the addresses of the tables ---
OLD_DATA, OLD_BEGIN, OLD_BEFORE, OLD_AFTER, OLD_SEPARATE, ALARM, ALARM_DATA, N_TABLES, TABLES = range(9)
MAX_TABLES = 64
"""Most frictions in one space."""
CONTEXT = TABLES + MAX_TABLES

# --- table ---
(
    USED, CAPACITY, COUNTER, PAIRS, SLOTS, CLOCK, INIT, FORCE_LAW, COMMIT, GUARD, PARAMETERS, DESCRIPTOR, DESCRIPTOR_SIZE,
    SEED, SAMPLE, HAS_MODE, PER_EVENT, HOLDING, STATEFUL, N_STATE, CAP_WHEN_STIFF, LAST_STAMP, PROBLEM, SIDE_A,
) = range(24)  # fmt: skip
SIDE_KIND, SIDE_TYPE, SIDE_SIZE, SIDE_ADDRESSES, SIDE_NUMBERS, SIDE = range(6)
"""Which shapes belong to a side: all, those of a collision type, or listed ones (addresses, sorted, with numbers)."""
SIDE_B = SIDE_A + SIDE
LAYOUT = SIDE_B + SIDE
TABLE = LAYOUT + len(NAMES)

ANY, TYPE, LISTED = range(3)
"""Values of SIDE_KIND."""
OVERFLOW, NOT_FINITE, UNSTABLE = 1, 2, 4
"""Bits of PROBLEM."""

# --- pair: the space's numbers of the two shapes, the number of the contact, when it was last seen ---
NUMBER_A, NUMBER_B, CONTACT, STAMP, PAIR = range(5)

# --- clock: time, the largest normal force per effective mass that is stable at the step CHECKED_STEP, and the speed at which
# the law's steady friction is largest (its static cap); and the time as the coefficients take it ---
NOW, STICK_SPEED, START, CHECKED_STEP, LARGEST_LOAD, WORST_LOAD, PEAK_SPEED, STEP_TIME, CLOCK_SIZE = range(9)

# --- slot ---
# RATE is the relative velocity over the last drift, VELOCITY the one at the time of the force. NORMAL is what is expected
# before the solve and what it was after it; ISOLATED is the expectation for the pair alone. PUSH and PUSH_... are what was
# written into the bodies as a force and torques; PENDING says that no solve has followed yet;
# ORDER is 1 where pymunk has the body first, otherwise -1. SLOPE is that of the force over velocity, GUARDS_AT.. are the
# law's guards at the end of the last step, if GUARDS_KNOWN. EXTRA_... are impulses that
# pymunk applies but does not count where the step size changes: it scales the last step's impulses by the ratio of the
# steps when it starts from them, not its record of them. OVER counts stiff steps beyond the stability limit, CAPPED is 1 where
# pymunk's own friction got the cap of a law too stiff for the step, KNOWN is 1 once
# the contact was met.
(
    DISPLACEMENT, RATE, FORCE, NORMAL, MU_S, MU_K, STICK, EVENTS, CAP, STEP, VELOCITY, EFFECTIVE_MASS, TIME, KNOWN,
    EXTRA_NORMAL, EXTRA_TANGENT, PAST_DISPLACEMENT, PAST_VELOCITY, PAST_MU_S, PAST_MU_K, PAST_ACCELERATION, ISOLATED,
    PUSH, PUSH_X, PUSH_Y, TORQUE_A, TORQUE_B, PENDING, OVER, NORMAL_X, NORMAL_Y, PAST_NORMAL,
    ORDER, SLOPE, GUARDS_KNOWN, CAPPED,
) = range(36)  # fmt: skip
GUARDS_AT = 36
STATE = GUARDS_AT + GUARDS
CURSOR_AT = STATE + MAX_STATE
OUT = CURSOR_AT + CURSOR
STEADY = OUT + MAX_STATE
SLOT = STEADY + MAX_STATE

# --- where the table keeps the engine's layout ---
_AT = {name: LAYOUT + i for i, name in enumerate(NAMES)}
M_INV, SPEED, BODY_FORCE = _AT["body.m_inv"], _AT["body.v"], _AT["body.f"]
I_INV, SPIN, TORQUE = _AT["body.i_inv"], _AT["body.w"], _AT["body.t"]
GRAVITY, SHAPE_NUMBER = _AT["space.gravity"], _AT["shape.number"]
RESTITUTION, FRICTION, SURFACE, CACHE = (_AT[f"arbiter.{n}"] for n in ("e", "u", "surface_vr", "data"))
ARBITER_A, ARBITER_B = _AT["arbiter.a"], _AT["arbiter.b"]
BODY_A, BODY_B, COUNT, POINTS = (_AT[f"arbiter.{n}"] for n in ("body_a", "body_b", "count", "contacts"))
AXIS, ARBITER_STATE, PROCESS = _AT["arbiter.n"], _AT["arbiter.state"], _AT["arbiter.processCollision"]
ARM_1, ARM_2, NORMAL_IMPULSE, TANGENT_IMPULSE = (_AT[f"contact.{n}"] for n in ("r1", "r2", "jnAcc", "jtAcc"))
POINT_SIZE, FIRST = _AT["contact.size"], _AT["arbiter.first"]
GET_STAMP, GET_STEP = _AT["cpSpaceGetTimestamp"], _AT["cpSpaceGetCurrentTimeStep"]
GET_TYPE, GET_SENSOR = _AT["cpShapeGetCollisionType"], _AT["cpShapeGetSensor"]
