"""Explicit friction at contacts: the law's force at each instant, as a passive force; MuJoCo's own friction is off.

At the first evaluation of a step (`begin`) each contact's committed slot, advanced along the displacement since its
commit, becomes a current slot: the law's ``commit`` runs with the state at the step's start, which is exact. All
Runge-Kutta stages use the current slots. Only `tracking.finish`, when the engine accepts the step, makes them the
committed ones; so evaluations between steps change nothing. The normal force is that of the step before.
"""

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco.contact.face import match
from stochfric_mb.mujoco.contact.kinematics import (
    add_forces,
    bodies_of,
    displacement,
    dot,
    ordinal_after,
    put,
    relative_velocity,
    set_axes,
    side,
    surface_velocity,
    to_body,
)
from stochfric_mb.mujoco.contact.law import call, coefficients, commit_slot
from stochfric_mb.mujoco.contact.rows import rate_of, set_cap
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import ELLIPTIC, contact_at, data_at, model_at
from stochfric_mb.numerics import memory as w

GOLDEN = 0.6180339887498949
"""Golden ratio: its multiples spread evenly over their fractional parts."""
SUDDEN = 0.05
"""Change of the normal force in a step, relative to it, with which explicit friction (one step late) will not do."""
PYRAMIDAL = (
    "stochfric_mb: explicit friction on a contact that has MuJoCo's own friction with pyramidal cones, which cannot be taken "
    "out; give the pair condim 1, or the model cone='elliptic'"
)
BEYOND = (
    "stochfric_mb: an explicit step is beyond the stability limit of its friction law, so that forces may be far off; give the "
    "model a timestep below law.step_limit(normal_force, mass), or take a law that runs in mode 'solver', as elastic_stick"
)
OFF = 1.0e-12
"""Coefficient of friction that the engine's solver is given in an explicit step: none, to rounding."""


@compiled
def predicted_normal_force(m, d, contact):
    """Return the normal force [N] that a contact would have with the acceleration of the step before."""
    row = contact.efc_address
    if row < 0:
        return 0.0
    imp, gap = w.at(d.efc_KBIP, 4 * row + 2), w.at(d.efc_pos, row) - w.at(d.efc_margin, row)
    wanted = -w.at(d.efc_KBIP, 4 * row + 1) * rate_of(m, d, row, d.qvel) - w.at(d.efc_KBIP, 4 * row) * imp * gap
    return max(0.0, w.at(d.efc_D, row) * (wanted - rate_of(m, d, row, d.qacc_warmstart)))


@compiled
def is_sudden(m, d, contact, slot):
    """Return whether the normal force changes much within this step, as in an impact.

    With the acceleration of the step before, the normal force changes by 1/(1 - d) times as much as it will, d being the
    constraint's impedance (MuJoCo's computation chapter, constraint model: R = (1 - d)/d A).
    """
    row = contact.efc_address
    if row < 0:
        return slot.normal > 0.0
    change = (1.0 - w.at(d.efc_KBIP, 4 * row + 2)) * (predicted_normal_force(m, d, contact) - slot.normal)
    return abs(change) > SUDDEN * slot.normal


@compiled
def tangent_mass(model, data, state, contact, slot, body, surface):
    """Return the mass [kg] that a tangential force feels, 1/(J M^-1 J^T) in the direction where it is smallest."""
    m, d = model_at(model), data_at(data)
    nv = m.nv
    room = s.room_in(s.header_record(state)) if nv <= s.MAX_ROW else np.empty(4 * nv)
    room[: 2 * nv] = 0.0
    rows = room.ctypes.data
    add_forces(m, d, body, surface, contact.pos, slot.axis_1, 1.0, rows)
    add_forces(m, d, body, surface, contact.pos, slot.axis_2, 1.0, rows + 8 * nv)
    engine.mj_solveM(model, data, rows + 16 * nv, rows, np.int32(2))
    a, b, c = 0.0, 0.0, 0.0
    for j in range(nv):
        a += room[j] * room[2 * nv + j]
        b += room[nv + j] * room[3 * nv + j]
        c += room[j] * room[3 * nv + j]
    largest = 0.5 * (a + b) + length(0.5 * (a - b), c)
    return 1.0 / largest if largest > 0.0 else 0.0


@compiled
def sum_of_velocities(m, d):
    """Return a sum that tells the velocities: with weights between 1 and 2, no two alike."""
    total, weight = 0.0, 0.0
    for j in range(m.nv):
        weight += GOLDEN
        weight -= 1.0 if weight >= 1.0 else 0.0
        total += (1.0 + weight) * w.at(d.qvel, j)
    return total


@compiled
def begin(model, data, state, law):
    """Make the current slots for a step that starts now, at an accepted state.

    Return whether explicit friction will do in this step, see `will_do`.
    """
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    known = int(header.n_committed) if header.advanced == d.time else 0
    t = header.instant
    body, surface = int(header.geom_body), int(header.geom_surface)
    count, sudden, ordinal = 0, False, 0
    match(d, state, known, False)
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        slot = s.slot_at(state, 1, count)
        track(model, data, state, contact, sign, ordinal, t, known, count)
        if header.mode == s.AUTO and header.advanced != s.UNSET:
            sudden = sudden or slot.live == 0.0 or is_sudden(m, d, contact, slot)
        count += 1
    header.n_current = count
    critical, beyond = critical_of(header, m.timestep), header.mode == s.AUTO and (count == 0 or sudden)
    pushed, total, among = known > 0 and was_pushed(m, d, header), 0.0, 0
    for k in range(count):
        slot = s.slot_at(state, 1, k)
        if pushed and slot.live != 0.0 and length(slot.vx, slot.vy) > header.stick_speed:
            slot.live = -1.0  # it slides from here on, whatever it did before
        if k == 0 or body < 0 or surface < 0:
            total, among = pair_total(state, k, count)
        commit_slot(state, s.slot_address(state, 1, k), law, t, total, among)
        beyond = beyond or total > critical * slot.felt
    return will_do(header, beyond)


@compiled
def will_do(header, beyond):
    """Return whether a step is explicit: of mode auto, unless it is ``beyond`` what that can do; otherwise always."""
    if header.mode == s.AUTO:
        return not beyond
    header.too_long = 1.0 if beyond else 0.0
    return True


@compiled
def count_beyond(header):
    """Count an accepted step that was beyond its law's limit; MuJoCo warns of the first one since the data's reset.

    Evaluations that make no step, as in a search for a rest position, may be anywhere.
    """
    if header.too_long != 0.0:
        if header.beyond == 0.0:
            engine.mju_warning(w.c_string(BEYOND))
        header.beyond += 1.0


@compiled
def was_pushed(m, d, header):
    """Return whether velocities were written since the last step, by more than the law's stick speed."""
    if header.finished == 0.0 or header.has_mode == 0.0:
        return False
    return abs(sum_of_velocities(m, d) - header.velocities) > header.stick_speed


@compiled
def pair_total(state, k, count):
    """Return the normal force [N] and the number of the contacts between the same two geoms as contact ``k``."""
    slot = s.slot_at(state, 1, k)
    total, among = 0.0, 0
    for j in range(count):
        other = s.slot_at(state, 1, j)
        if other.geom_1 == slot.geom_1 and other.geom_2 == slot.geom_2:
            total += other.normal
            among += 1
    return total, among


@compiled
def critical_of(header, step):
    """Return the normal force over the mass [N/kg] at which ``step`` is the law's limit (of mode auto, half of it).

    It is found once for each step.
    """
    if header.critical_step != step:
        header.critical, header.critical_step = critical_ratio(header, 2.0 * step if header.mode == s.AUTO else step), step
    return header.critical


@compiled
def critical_ratio(header, step):
    """Return the normal force over the mass [N/kg] at which the law's step limit falls to ``step``; huge if never."""
    limits = header.limits
    for k in range(s.N_LIMITS):
        low = limits[k]
        if low <= step:
            if k == 0:
                return 0.0
            high = limits[k - 1]
            part = math.log(high / step) / math.log(high / low) if high < s.NO_LIMIT else 1.0
            return 10.0 ** (k - 5 + part)
    return s.NO_LIMIT


@compiled
def track(model, data, state, contact, sign, ordinal, t, known, k):
    """Fill the current slot ``k`` from a contact; return its normal force [N]. ``known`` committed slots count."""
    m, d = model_at(model), data_at(data)
    slot = s.slot_at(state, 1, k)
    number = int(slot.continues)
    old = s.slot_at(state, 0, max(number, 0))
    normal_force = old.normal if number >= 0 else predicted_normal_force(m, d, contact)
    fill(model, data, state, contact, sign, t, slot, old, number >= 0 and old.live != 0.0)
    slot.geom_1, slot.geom_2, slot.ordinal, slot.normal = contact.geom[0] + 1.0, contact.geom[1] + 1.0, ordinal, normal_force
    return normal_force


@compiled
def fill(model, data, state, contact, sign, t, slot, old, known):
    """Fill frame, velocity, displacement, material points and mass of a slot; its law state stays the old one."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    body, surface = bodies_of(m, contact, sign)
    sx, sy, sz = surface_velocity(contact, sign)
    vx, vy, vz = relative_velocity(m, d, contact, body, surface, sx, sy, sz)
    dx, dy, step = 0.0, 0.0, 0.0
    slot.solved = 0.0
    if known:
        dx, dy = displacement(d, old, body, surface, t, dot(old.axis_1, vx, vy, vz), dot(old.axis_2, vx, vy, vz))
        slot.ux, slot.uy = old.ux + dx, old.uy + dy
        step = t - old.since
        slot.stick, slot.events, slot.energy, slot.felt = old.stick, old.events, old.energy, old.felt
        for j in range(len(slot.state)):
            slot.state[j] = old.state[j]
        for j in range(len(slot.guards)):
            slot.guards[j] = old.guards[j]
        before = slot.before
        before[0], before[1], before[2], before[3], before[4] = old.since, old.ux, old.uy, old.vx, old.vy
        slot.work[0], slot.work[1] = old.fx, old.fy
    else:
        slot.ux, slot.uy = header.origin, 0.0
        slot.stick, slot.events, slot.energy, slot.felt = 0.0, 0.0, 0.0, 0.0
        slot.work[0], slot.work[1] = 0.0, 0.0
    slot.hold[0], slot.hold[1] = 0.0, 0.0
    slot.live = 1.0 if known else 0.0
    slot.work[2], slot.work[3] = dx, dy
    set_axes(d, contact, slot, old, known, body, surface, step)
    e1, e2 = slot.axis_1, slot.axis_2
    slot.vx, slot.vy = dot(e1, vx, vy, vz), dot(e2, vx, vy, vz)
    slot.sx, slot.sy = dot(e1, sx, sy, sz), dot(e2, sx, sy, sz)
    slot.since = t
    p = contact.pos
    put(slot.place, p[0], p[1], p[2])
    bx, by, bz = to_body(d, body, p[0], p[1], p[2])
    put(slot.on_body, bx, by, bz)
    cx, cy, cz = to_body(d, surface, p[0], p[1], p[2])
    put(slot.on_surface, cx, cy, cz)
    if header.needs_mass != 0.0 or not known:
        slot.felt = tangent_mass(model, data, state, contact, slot, body, surface)
    slot.mass = slot.felt if header.needs_mass != 0.0 else 0.0


@compiled
def apply(model, data, state, law):
    """Add the friction forces at this instant; at a step's start also record them."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    starting = d.time == header.evaluated
    t = header.instant if starting else canonical_time(d.time, 0.5 * m.timestep)
    geom, other = int(header.geom_body), int(header.geom_surface)
    k, ordinal = 0, 0
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, geom, other)
        if sign == 0:
            continue
        number = k if starting else slot_at_stage(model, data, state, law, contact, sign, ordinal, t, k)
        k += 1
        if number < 0:
            continue
        if contact.dim > 2 and m.cone != ELLIPTIC:
            engine.mju_error(w.c_string(PYRAMIDAL))
        if contact.dim > 2 and contact.efc_address >= 0:
            set_cap(m, d, contact, OFF, 1.0, w.at(d.efc_R, contact.efc_address + 1))
        apply_contact(m, d, state, contact, sign, number, law.force, t, starting)


@compiled
def slot_at_stage(model, data, state, law, contact, sign, ordinal, t, k):
    """Return the number of a contact's current slot; one that was born within the step gets a slot of its own.

    In auto mode it gets none (-1), and has MuJoCo's own friction up to the step's end: its explicit limit is not known.
    """
    header = s.header_record(state)
    count = int(header.n_current)
    number = s.find(state, 1, count, contact.geom[0], contact.geom[1], ordinal, k)
    if number >= 0 or header.mode == s.AUTO:
        return number
    s.require_room(header, count)
    header.n_current = count + 1.0
    normal_force = track(model, data, state, contact, sign, ordinal, t, 0, count)
    commit_slot(state, s.slot_address(state, 1, count), law, t, normal_force, 1)
    s.slot_at(state, 1, count).live = 0.0
    return count


@compiled_inline
def apply_contact(m, d, state, contact, sign, number, force, t, starting):
    """Add the friction force of one contact."""
    header = s.header_record(state)
    body, surface = bodies_of(m, contact, sign)
    address = s.slot_address(state, 1, number)
    slot = s.slot_record(address)
    ux, uy, vx, vy, mu_s, mu_k = slot.ux, slot.uy, slot.vx, slot.vy, slot.mu_s, slot.mu_k
    if not starting:
        sx, sy, sz = surface_velocity(contact, sign)
        wx, wy, wz = relative_velocity(m, d, contact, body, surface, sx, sy, sz)
        vx, vy = dot(slot.axis_1, wx, wy, wz), dot(slot.axis_2, wx, wy, wz)
        dx, dy = displacement(d, slot, body, surface, t, vx, vy)
        ux, uy = ux + dx, uy + dy
        mu_s, mu_k = coefficients(state, t, ux, slot.events)
    call(state, address, force, t, ux, uy, vx, vy, mu_s, mu_k)
    fx, fy = header.output[0], header.output[1]
    if starting:
        slot.fx, slot.fy = fx, fy
        work = slot.work
        slot.energy += 0.5 * ((work[0] + fx) * work[2] + (work[1] + fy) * work[3])
        work[2], work[3] = 0.0, 0.0
    add_forces(m, d, body, surface, contact.pos, slot.axis_1, fx, d.qfrc_passive)
    add_forces(m, d, body, surface, contact.pos, slot.axis_2, fy, d.qfrc_passive)
