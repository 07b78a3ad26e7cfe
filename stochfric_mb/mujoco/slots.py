"""What stands where in the plugin's state: one header, then the committed and the current slots of the contacts.

Everything a contact needs is in ``mjData.plugin_state``, so that copying, saving, pickling and batching carry it.
The *committed* slots are what the last accepted step left; the *current* slots are derived from them at each
evaluation at a step's start, and become the committed ones when the engine advances.
"""

from __future__ import annotations

from stochfric_mb.coefficients.path import CURSOR as CURSOR_SIZE
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS

# Header: places in doubles.
LAW, GEOM_BODY, GEOM_SURFACE, SEED, SAMPLE, CONTACT, N_SLOTS, N_DESCRIPTOR = range(8)
"""Identifier of the law; geom ids; address of the coefficient path; slots per block; length of the descriptor."""
N_PARAMETERS, STICK_SPEED, HAS_MODE, NEEDS_MASS, ORIGIN, MODE = range(8, 14)
"""Length of p; stick speed [m/s]; two flags; displacement of a new contact [m]; mode asked for."""
AUTO, EXPLICIT, IMPLICIT = range(3)
"""Values of MODE."""
ADVANCED, EVALUATED, N_COMMITTED, N_CURRENT, STARTED = range(14, 19)
"""Time of the last advance and of the last evaluation at a step's start [s]; contacts in each block; 1 within a step."""
SOLVED = 19
"""1 where the forces of this step are solved together with its end (see `implicit`), decided at its start."""
PARAMETERS, MAX_PARAMETERS = 20, 16
CURSOR = PARAMETERS + MAX_PARAMETERS
FORCE = CURSOR + CURSOR_SIZE
"""Work space: force and torque on the body, their opposites on the surface, the point where they act, law output."""
TORQUE, COUNTER_FORCE, COUNTER_TORQUE, POINT, OUTPUT = FORCE + 3, FORCE + 6, FORCE + 9, FORCE + 12, FORCE + 15
COEFFICIENTS = OUTPUT + MAX_STATE
"""Time of the last evaluation of a path along time [s], and its mu_s and mu_k."""
NEEDS_HOLD, CRITICAL, CRITICAL_STEP, INSTANT, VELOCITIES, FINISHED = range(COEFFICIENTS + 3, COEFFICIENTS + 9)
"""A flag; normal force over mass [N/kg] where an explicit step of CRITICAL_STEP [s] is at half its limit;
canonical time [s] of the last evaluation at a step's start; a sum that tells the velocities at the end of the last step,
and 1 if there is one."""
LIMITS, N_LIMITS = COEFFICIENTS + 9, 13
"""The law's step limit [s] at normal forces over mass of 1e-4, 1e-3, ... 1e8 N/kg."""
ROWS, MAX_ROW = LIMITS + N_LIMITS, 32
"""Work space: four rows of so many generalised coordinates."""
DESCRIPTOR = ROWS + 4 * MAX_ROW
"""The coefficient descriptor; the two blocks of slots and one row of generalised coordinates follow it."""

# Slot: places in doubles.
GEOM_1, GEOM_2, ORDINAL, LIVE = range(4)
"""Key of the contact (geom ids plus 1, number among equals), and whether it has a law state: 1, or 0 not yet, or -1 where it
was given another velocity."""
NORMAL, MASS, STICK, EVENTS, ENERGY, MU_S, MU_K, SINCE = range(4, 12)
"""Normal force [N], mass felt [kg], stuck flag, stick phases begun, energy dissipated [J], coefficients, time [s]."""
UX, UY, VX, VY, FX, FY, SX, SY = range(12, 20)
"""Displacement [m], velocity [m/s], friction force on the body [N], surface velocity [m/s]: in the tangent frame."""
AXIS_1, AXIS_2, ON_BODY, ON_SURFACE = 20, 23, 26, 29
"""The tangent frame (world), and the contact point in the frames of the two bodies."""
WORK = 32
"""Friction forces of the step before and the displacement since, for the dissipated energy."""
BEFORE = 36
"""Time, displacement and velocity at the commit before: t, ux, uy, vx, vy."""
START_GUARDS = 41
"""The law's guards at the last switch or commit, for laws with modes."""
HOLD_X, HOLD_Y, FELT, IMPLICIT_STEP, LIFT = range(START_GUARDS + GUARDS, START_GUARDS + GUARDS + 5)
"""Force that would hold the contact still [N]; mass felt by this contact alone [kg]; 1 if its last force was solved; how
far above MuJoCo's point, along the normal, the contact is taken to touch [m] (see `level`)."""
STATE = START_GUARDS + GUARDS + 5
"""The law's state."""
SLOT = STATE + MAX_STATE
"""Length of a slot."""


def state_size(n_descriptor: int, n_slots: int, nv: int) -> int:
    """Return the length of the plugin's state [doubles]."""
    return DESCRIPTOR + n_descriptor + 2 * n_slots * SLOT + nv
