"""Rows of MuJoCo's constraint solver, as friction writes them between their making and the solution.

A row asks for the acceleration a = aref - R f, with aref = -B v - K I (pos - margin) (MuJoCo's computation chapter,
constraint model). Its force in slip is bounded by a friction cone (contacts, elliptic) or by ``frictionloss`` (joints).
"""

from __future__ import annotations

import math

import mujoco

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.mujoco.memory.structs import DISCRETE, PGS
from stochfric_mb.numerics import memory as w

RIGID = 0.25
"""Share of a stuck row's deflection that the solver takes back in one step, where the law is rigid: R K I = RIGID/h^2.

1 would take all of it at once and pass every rounding error on; much less lets a load that rises move it further. Holds
and servo tables move by the same amounts, within a factor of two, from 0.1 to 0.5 (tests/engines/test_mujoco_solver.py).
"""
AT_ONCE = 1.0e6
"""Damping of a row times the step from which on its time constant does not count: the reference is -v B/(1 + h B)."""
LEAST_IMPEDANCE, FREE_REFERENCE = 1.0e-4, int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
"""Least impedance (mjMINIMP), and the option with which time constants may be shorter than two steps."""
LEAST = 1.0e-5
"""Smallest coefficient of friction of an elliptic cone that MuJoCo itself uses (mjMINMU)."""


@compiled_inline
def rate_of(m, d, row, vector):
    """Return a row of the constraint Jacobian times a vector of generalised coordinates, which is given by its address."""
    total = 0.0
    if is_sparse(m):
        first = w.int_at(d.efc_J_rowadr, row)
        for k in range(first, first + w.int_at(d.efc_J_rownnz, row)):
            total += w.at(d.efc_J, k) * w.at(vector, w.int_at(d.efc_J_colind, k))
        return total
    for k in range(m.nv):
        total += w.at(d.efc_J, row * m.nv + k) * w.at(vector, k)
    return total


@compiled_inline
def is_sparse(m):
    """Return whether MuJoCo keeps the constraint Jacobian sparse: asked for, or (auto) from 60 coordinates on."""
    return m.jacobian == 1 or (m.jacobian == 2 and m.nv >= 60)


@compiled_inline
def set_resistance(m, d, row, resistance):
    """Give a row its R, and its D = 1/R, wherever the solver looks for them: PGS in its matrix J M^-1 J' + R."""
    if m.solver == PGS:
        place = place_on_diagonal(m, d, row)
        w.put(d.efc_AR, place, w.at(d.efc_AR, place) + resistance - w.at(d.efc_R, row))
    w.put(d.efc_R, row, resistance)
    w.put(d.efc_D, row, 1.0 / resistance)
    if d.nisland > 0:
        other = w.int_at(d.map_efc2iefc, row)
        w.put(d.iefc_R, other, resistance)
        w.put(d.iefc_D, other, 1.0 / resistance)


@compiled
def place_on_diagonal(m, d, row):
    """Return where the diagonal element of a row stands in the matrix of PGS."""
    if not is_sparse(m):
        return row * d.nefc + row
    place = w.int_at(d.efc_AR_rowadr, row)
    while w.int_at(d.efc_AR_colind, place) != row:
        place += 1
    return place


@compiled_inline
def set_reference(d, row, damping, stiffness, position):
    """Make a row ask for a = -damping v - stiffness position (1/s, 1/s^2, m)."""
    w.put(d.efc_KBIP, 4 * row, stiffness / w.at(d.efc_KBIP, 4 * row + 2))
    w.put(d.efc_KBIP, 4 * row + 1, damping)
    w.put(d.efc_pos, row, position)
    w.put(d.efc_margin, row, 0.0)


@compiled
def set_target(m, contact, slot, u, v):
    """Let a contact's tangents ask the discrete integrator for the velocities -u and -v [m/s] at the step's end.

    It makes their references anew after the passive stage, from ``solreffriction`` and the surface's velocity; what that was
    stays in the slot.
    """
    m.flg_surfacevel = True
    slot.sx, slot.sy = contact.surfacevel[0], contact.surfacevel[1]
    contact.surfacevel[0] += u
    contact.surfacevel[1] += v
    contact.solreffriction[0], contact.solreffriction[1] = -1.0, -AT_ONCE / m.timestep


@compiled
def raise_normal(m, d, contact, lift):
    """Let the discrete integrator's normal row ask for less, by ``lift`` [m/s^2].

    Of the row only its position is there yet. The reference will be -(B v + K I pos)/(1 + h B + h^2 K I), with the stiffness,
    damping and impedance of MuJoCo's modeling chapter (solver parameters).
    """
    h, ref, gap = m.timestep, contact.solref, contact.dist - contact.includemargin
    largest = min(max(contact.solimp[1], LEAST_IMPEDANCE), 1.0 - LEAST_IMPEDANCE)
    k, b = -ref[0] / largest**2, -ref[1] / largest
    if ref[0] > 0.0:
        constant = ref[0] if m.disableflags & FREE_REFERENCE else max(ref[0], 2.0 * h)
        k, b = 1.0 / (largest * constant * ref[1]) ** 2, 2.0 / (largest * constant)
    ki, position = k * impedance(contact.solimp, gap), gap
    pressing = ki * gap
    for _ in range(3):  # the impedance hardly depends on the position
        position = (pressing + lift * (1.0 + h * b + h * h * ki)) / ki
        ki = k * impedance(contact.solimp, position)
    w.put(d.efc_pos, contact.efc_address, position + contact.includemargin)


@compiled
def impedance(solimp, position):
    """Return the impedance of a row at a position [m] (MuJoCo's modeling chapter, solimp)."""
    first = min(max(solimp[0], LEAST_IMPEDANCE), 1.0 - LEAST_IMPEDANCE)
    last = min(max(solimp[1], LEAST_IMPEDANCE), 1.0 - LEAST_IMPEDANCE)
    middle, power = min(max(solimp[3], LEAST_IMPEDANCE), 1.0 - LEAST_IMPEDANCE), max(solimp[4], 1.0)
    x = abs(position) / solimp[2] if solimp[2] > 0.0 else 1.0
    if x >= 1.0:
        return last
    part = middle * (x / middle) ** power if x <= middle else 1.0 - (1.0 - middle) * ((1.0 - x) / (1.0 - middle)) ** power
    return first + part * (last - first)


@compiled_inline
def forget_target(m, contact, slot):
    """Give a contact that was steered already (MuJoCo left out its position stage) the surface's own velocity again."""
    if m.integrator == DISCRETE and contact.solreffriction[1] == -AT_ONCE / m.timestep:
        contact.surfacevel[0], contact.surfacevel[1] = slot.sx, slot.sy


@compiled_inline
def spring_of(resistance, stiffness, damping, h):
    """Return R [1/kg] and K I [1/s^2] of a row that is a spring and a damper in the velocity at the step's end.

    F = k (z + h v') + c v' with v' = v + h a is the row B = 1/h, K I = k/(h (k h + c)), R = 1/(h (k h + c)); in series with
    the R that the row has already. K I is set so that F = k z at rest.
    """
    total = resistance + 1.0 / (h * (stiffness * h + damping))
    return total, stiffness * total


@compiled_inline
def resistances(m, d, row):
    """Return R [1/kg] of a contact's normal row and of its tangents, as MuJoCo made them (constraint model, impratio)."""
    impedance = w.at(d.efc_KBIP, 4 * row + 2)
    normal = w.at(d.efc_diagA, row) * (1.0 - impedance) / impedance
    return normal, normal / m.impratio


@compiled_inline
def set_cap(m, d, contact, cap, across, resistance):
    """Give an elliptic contact its coefficient of sliding friction; torsional and rolling friction stay what they are.

    ``across`` is the coefficient along the second tangent over that along the first, ``resistance`` R of the first [1/kg].
    """
    row, friction = contact.efc_address, contact.friction
    friction[0] = cap
    friction[1] = cap * across
    if m.integrator == DISCRETE:  # it makes these rows later, and mu with them
        return
    contact.mu = cap * math.sqrt(resistance / w.at(d.efc_R, row))
    set_resistance(m, d, row + 1, resistance)
    # a cone is circular where R_j friction_j^2 is the same for all
    set_resistance(m, d, row + 2, resistance / (across * across))
    for j in range(2, contact.dim - 1):
        set_resistance(m, d, row + 1 + j, resistance * (cap / friction[j]) ** 2)
