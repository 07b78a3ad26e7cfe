"""What friction remembers, as named records in ``mjData.plugin_state``: a header, then slots for the contacts.

Everything that changes stands there as doubles, so that copying, saving, pickling and batching carry it. The *committed*
slots are what the last accepted step left; the *current* slots are derived from them at each evaluation at a step's start,
and become the committed ones when the engine advances. Both stand by turns, and after them the coefficient descriptor.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.coefficients.path import CURSOR
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.mujoco.memory import engine, table
from stochfric_mb.mujoco.memory.structs import data_at, model_at, record_view
from stochfric_mb.numerics import memory as w

MAX_PARAMETERS, N_LIMITS, MAX_ROW = 16, 13, 32
BODIES = 2**24
"""What a body's id counts in a slot's ``bodies``; that of the counter-surface counts 1."""
TOO_MANY = (
    "stochfric_mb: more contacts than a friction has slots for; give add_friction(..., slots=...) the most that there can be"
)
NO_LAW = "stochfric_mb: these data are no simulation's, but a copy without plugins; make others with mujoco.MjData(model)"
UNSET = -1.0e300
"""A time before all times."""
NO_LIMIT = 1.0e300
"""Stands for infinity in states, which engines and rollouts expect to be finite."""
MODES = ("auto", "explicit", "solver")
AUTO, EXPLICIT, SOLVER = range(3)
"""Values of a header's ``mode``."""
PAIR, JOINT, TENDON = range(3)
"""Values of a header's ``place``."""
RIGID, ELASTIC, CREEP = range(3)
RESTS = ("rigid", "elastic", "creep", "bristle")
"""Values of a header's ``rest``: the law's `Law.rest`. Laws with bristles of their own are explicit, see ``mode``."""


def _record(*fields: str | tuple[str, int]) -> np.dtype[Any]:
    return np.dtype([(f, np.float64) if isinstance(f, str) else (f[0], np.float64, (f[1],)) for f in fields])


HEADER = _record(
    "place",  # PAIR, JOINT or TENDON
    "geom_body", "geom_surface",  # geoms, -1 for any; of a joint or tendon its number, twice
    "seed", "sample", "contact",  # address of the coefficient path
    "n_slots", "n_descriptor",  # lengths
    "stick_speed", "peak_speed", "has_mode", "needs_mass", "rest",  # of the law
    "origin",  # displacement of a new contact [m]
    "mode",  # asked for; of a law with bristles EXPLICIT
    "load", "radius",  # of a joint or tendon: given [N or N m], or the radius [m] at which its bearing's reaction rubs
    "across",  # anisotropic friction: the coefficients across ``direction`` over those along it
    ("direction", 3),  # in the body's frame
    "advanced", "evaluated",  # times of the last advance and of the last evaluation at a step's start [s]
    "n_committed", "n_current", "started",  # contacts in each block; 1 within a step
    "solved", "latched",  # 1 in a step in which friction is the engine's own; 1 where it stays so
    "unconverged",  # steps since the start in which MuJoCo's solver stopped at its limit of iterations
    "too_long", "beyond",  # 1 in an explicit step beyond the law's limit; such steps since the start
    "velocities", "finished",  # a sum that tells the velocities at the end of the last step, 1 if there is one
    "instant",  # canonical time [s] of the last evaluation at a step's start
    "path_time", "path_mu_s", "path_mu_k",  # last evaluation of a path along time
    "peak", "peak_mu_s", "peak_mu_k",  # last coefficient at the law's peak speed, and of what coefficients
    "critical", "critical_step",  # normal force over mass [N/kg] at which an explicit step [s] is too long
    ("parameters", MAX_PARAMETERS),
    ("limits", N_LIMITS),  # step limits [s] at normal forces over mass of 1e-4, 1e-3, ... 1e8 N/kg
    ("cursor", CURSOR),
    ("output", MAX_STATE), ("rows", 4 * MAX_ROW),  # room to work in
)  # fmt: skip
SLOT = _record(
    "geom_1", "geom_2", "ordinal",  # key within a step: geoms plus 1, number among equals
    "continues",  # number of the committed slot that it goes on from, -1 if it is new; see `contact.face`
    "bodies",  # number of the two bodies, see `BODIES`
    "live",  # 1 if it has a law state, 0 not yet, -1 where it was given another velocity
    "normal", "mass", "felt",  # normal force [N], mass felt by the law, by this contact alone [kg]
    "stick", "events", "energy",  # stuck, stick phases begun, energy dissipated [J]
    "mu_s", "mu_k", "since",  # coefficients, time [s]
    "ux", "uy", "vx", "vy", "fx", "fy", "sx", "sy",  # displacement, velocity, force on the body, surface velocity
    ("axis_1", 3), ("axis_2", 3),  # the tangent frame, world axes
    ("side", 3),  # the tangent across the direction of anisotropic friction, world axes; 0 if there is none
    "across",  # coefficients along it over those along the direction
    "solved",  # 1 if the engine's solver found the force
    "given",  # normal force [N] of the step before, by which the solver is steered
    "slides", "saturated", "loose",  # sliding; the force was at its cap, and so were all those between the two bodies
    "cap",  # coefficient that the solver was given [-]
    ("z", 3), ("w", 3),  # deflection while stuck [m], relative velocity [m/s], world axes
    ("a", 3),  # relative acceleration that the solver foresaw in the step before [m/s^2], world axes
    "foreseen", ("lead", 3),  # 1 if it was for a step; the acceleration over that step less the foreseen one [m/s^2]
    ("mean", 3),  # relative velocity over a Runge-Kutta step so far, as that weighs its stages [m/s], world axes
    "creep", "creep_share", "creep_slope",  # of a law that creeps at rest: speed at which it has the force [m/s], mu there over
    # mu_s, change of the speed with that [m/s]
    "fluidity",  # that speed over the force [m/(N s)]
    "face",  # number of the first contact of its face
    "weight", "resistance",  # its normal force over the mean of its face, and that mean of R of a tangent row [1/kg]
    ("place", 3), ("normal_axis", 3),  # where it was at the step's start [m], and its normal, world axes
    "springs",  # the deflection [m] at which the law's own spring breaks that held it in the step before, 0 if none did
    ("pull", 3),  # friction force on the body in the step before [N], world axes
    # of explicit steps, joints and tendons alone:
    ("on_body", 3), ("on_surface", 3),  # the contact point in the frames of the two bodies
    "undamped",  # the part of the solver's acceleration that is left of it where damping is implicit [-]
    ("work", 4), ("before", 5), ("guards", GUARDS), ("hold", 2),  # see `contact.law`
    ("state", MAX_STATE),  # the law's
)  # fmt: skip
LAW = np.dtype([(f, np.int64) for f in (
    "key",  # by which it is found, see `memory.table`
    "init", "force", "commit", "guards", "slide", "spring",  # addresses of the law's C functions in this process
    "n_state",  # number of its state's entries
    "start", "n_start",  # address and length [doubles] of what a state starts with: header and descriptor
    "n_all",  # length of the whole state [doubles]
)])  # fmt: skip
"""What friction does not remember, but finds by the key in ``mjData.plugin_data``: it is made anew in each process."""
N_HEADER, N_SLOT = HEADER.itemsize // 8, SLOT.itemsize // 8
header_record, slot_record, law_at = record_view(HEADER), record_view(SLOT), record_view(LAW)
_HEADER_SIZE, _SLOT_SIZE = HEADER.itemsize, SLOT.itemsize
_SOLVED_SIZE = int(SLOT.fields["on_body"][1])  # type: ignore
_CURSOR = int(HEADER.fields["cursor"][1])  # type: ignore

Array = npt.NDArray[np.float64]


def place(field: str) -> int:
    """Return where a field of the header stands in an instance's state [doubles]."""
    fields: Any = HEADER.fields
    return int(fields[field][1]) // 8


def header_of(state: Array) -> Any:
    """Return the header of an instance's state (a view); fields by name."""
    return state[:N_HEADER].view(HEADER).view(np.recarray)[0]


def slots_of(state: Array, *, committed: bool) -> npt.NDArray[Any]:
    """Return the committed or the current contacts of an instance's state (a view), fields by index: that is fast."""
    header = state[:N_HEADER].view(HEADER)[0]
    count = int(header["n_committed" if committed else "n_current"])
    return state[N_HEADER : N_HEADER + 2 * count * N_SLOT].view(SLOT)[0 if committed else 1 :: 2]


def descriptor_place(header: Any) -> int:
    """Return where the coefficient descriptor stands in the state that has this header [doubles]."""
    return N_HEADER + 2 * int(header.n_slots) * N_SLOT


@compiled
def restart(address, state):
    """Begin the state at an address anew, as the `LAW` at another one has it; seed, sample and contact are 0 then."""
    law = law_at(address)
    n_descriptor = law.n_start - N_HEADER
    w.copy_bytes(law.start, state, 8 * N_HEADER)
    for j in range(N_HEADER, law.n_all - n_descriptor):
        w.put(state, j, 0.0)
    w.copy_bytes(law.start + 8 * N_HEADER, state + 8 * (law.n_all - n_descriptor), 8 * n_descriptor)


@compiled
def state_address(model, data, instance):
    """Return the address of an instance's state."""
    return data_at(data).plugin_state + 8 * w.int_at(model_at(model).plugin_stateadr, instance)


@compiled
def law_in(data, instance):
    """Return an instance's `LAW`; stop with MuJoCo's error if there is none, as in copies for display."""
    address = table.address_of(w.word_at(data_at(data).plugin_data, instance))
    if address == 0:
        engine.mju_error(w.c_string(NO_LAW))
    return law_at(address)


@compiled
def slot_address(state, current, k):
    """Return the address of the committed (0) or the current (1) slot ``k``."""
    return state + _HEADER_SIZE + (2 * k + current) * _SLOT_SIZE


@compiled
def slot_at(state, current, k):
    """Return the committed (0) or the current (1) slot ``k``."""
    return slot_record(slot_address(state, current, k))


@compiled
def require_room(header, count):
    """Stop with MuJoCo's error where a contact comes after ``count`` that fill all slots."""
    if count == int(header.n_slots):
        engine.mju_error(w.c_string(TOO_MANY))


@compiled
def copy_slot(state, current, k, whole):
    """Copy the committed (0) or the current (1) slot ``k`` to the other one, or (not ``whole``) what solved contacts need."""
    size = _SLOT_SIZE if whole else _SOLVED_SIZE
    w.copy_bytes(slot_address(state, current, k), slot_address(state, 1 - current, k), size)


@compiled
def find(state, current, count, a, b, ordinal, guess):
    """Return the number of the slot of a contact (geoms a, b, number among equals) in a block, -1 if there is none."""
    for i in range(count):
        k = guess + i if guess + i < count else (guess + i) % count
        slot = slot_at(state, current, k)
        if slot.geom_1 == a + 1 and slot.geom_2 == b + 1 and slot.ordinal == ordinal:
            return k
    return -1


@compiled
def descriptor_of(state):
    """Return the coefficient descriptor."""
    header = header_record(state)
    return w.vector(slot_address(state, 0, int(header.n_slots)), int(header.n_descriptor))


@compiled
def cursor_of(state):
    """Return the cursor of the coefficient path."""
    return w.vector(state + _CURSOR, CURSOR)


@compiled
def room_in(header):
    """Return the header's room to work in, 4 * `MAX_ROW` doubles."""
    return w.vector(header.rows.ctypes.data, 4 * MAX_ROW)
