"""A friction instance from step to step: which way a step goes, and what is kept of it once the engine accepts it."""

from __future__ import annotations

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.mujoco.contact import explicit, solver
from stochfric_mb.mujoco.contact.face import rest_on_corners
from stochfric_mb.mujoco.contact.kinematics import ordinal_after, put, side
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import RUNGE_KUTTA, contact_at, data_at, model_at
from stochfric_mb.numerics import memory as w


@compiled
def evaluate(model, data, state, law):
    """Let friction act at this instant: the first one of a step, or a later stage of a Runge-Kutta step."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    rest_on_corners(d, int(header.geom_body), int(header.geom_surface))
    starting = starts(m, d, header)
    if starting:
        explicit_does = tries_explicit(m, d, header) and explicit.begin(model, data, state, law)
        header.solved = 0.0 if explicit_does else 1.0
    if header.solved != 0.0:
        solver.evaluate(m, d, state, law, starting)
    else:
        explicit.apply(model, data, state, law)


@compiled_inline
def starts(m, d, header):
    """Return whether a step starts at this instant, which is noted then; otherwise it is a later stage of one."""
    start = header.evaluated
    if header.started != 0.0 and start < d.time <= start + 1.0001 * m.timestep:
        return False
    header.evaluated, header.started = d.time, 1.0
    header.instant = canonical_time(d.time, 0.5 * m.timestep)
    return True


@compiled_inline
def tries_explicit(m, d, header):
    """Return whether a step may be explicit: asked for, or (auto) of Runge-Kutta kind and not beyond it before."""
    if header.mode == s.EXPLICIT:
        return True
    if header.mode == s.SOLVER or header.rest == s.RIGID:
        return False
    known = header.advanced == d.time
    return m.integrator == RUNGE_KUTTA and not (known and header.latched != 0.0)


@compiled_inline
def finish(model, data, state):
    """Commit the current slots when the engine accepts a step, with the forces of its last solution."""
    m, header = model_at(model), s.header_record(state)
    commit(model, data, state)
    header.n_committed = learn(data, state, 0, int(header.n_committed), m)
    close(model, data, state)


@compiled_inline
def commit(model, data, state):
    """Make the current slots the committed ones, still without forces."""
    header = s.header_record(state)
    count = int(header.n_current)
    for k in range(count):
        s.copy_slot(state, 1, k, header.solved == 0.0)
        slot = s.slot_at(state, 0, k)  # its forces count as zero until known: it may have ended within the step
        slot.normal, slot.given, slot.saturated, slot.foreseen = 0.0, 0.0, 0.0, 0.0
        put(slot.pull, 0.0, 0.0, 0.0)
    header.n_committed = count


@compiled_inline
def close(model, data, state):
    """End a step whose forces are known."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    if header.solved != 0.0:
        compare(state, int(header.n_committed))
    else:
        header.velocities, header.finished = explicit.sum_of_velocities(m, d), 1.0
    header.latched = 1.0 if header.solved != 0.0 and header.n_committed > 0.0 else 0.0
    header.unconverged += 1.0 if stopped_early(model, data) else 0.0
    explicit.count_beyond(header)
    header.advanced, header.started = d.time, 0.0


@compiled_inline
def learn(data, state, current, count, m):
    """Write the forces of the engine's last solution to the slots of a block; return the number of its contacts.

    The committed block (0) is that of an accepted step. A contact that came up at the end of an explicit step gets a slot
    there, for its normal force.
    """
    d, header = data_at(data), s.header_record(state)
    body, surface = int(header.geom_body), int(header.geom_surface)
    k, ordinal = 0, 0
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        a, b = contact.geom[0], contact.geom[1]
        number = s.find(state, current, count, a, b, ordinal, k)
        k += 1
        if header.solved != 0.0:
            if number >= 0 and contact.efc_address >= 0 and contact.dim > 2:
                solver.learn(m, d, header, contact, sign, s.slot_at(state, current, number), current == 0)
            continue
        if number < 0:
            s.require_room(header, count)
            number, count = count, count + 1
            slot = s.slot_at(state, current, number)
            slot.geom_1, slot.geom_2, slot.ordinal, slot.live = a + 1.0, b + 1.0, ordinal, 0.0
            put(slot.place, contact.pos[0], contact.pos[1], contact.pos[2])
        s.slot_at(state, current, number).normal = normal_force(d, contact)
    return count


@compiled_inline
def compare(state, count):
    """Find which contacts are loose: at their cap, and none of those between the same two bodies holds less than its own."""
    for k in range(count):
        slot = s.slot_at(state, 0, k)
        slot.loose = slot.saturated
        for j in range(count if slot.saturated != 0.0 else 0):
            other = s.slot_at(state, 0, j)
            if other.bodies == slot.bodies and other.saturated == 0.0 and other.given > 0.0:
                slot.loose = 0.0


@compiled_inline
def normal_force(d, contact):
    """Return the normal force [N] of a contact (elliptic, or frictionless) in MuJoCo's last solution."""
    row = contact.efc_address
    return max(w.at(d.efc_force, row), 0.0) if row >= 0 else 0.0


@compiled
def stopped_early(model, data):
    """Return whether MuJoCo's solver stopped at its limit of iterations in the last solution."""
    m, d = model_at(model), data_at(data)
    most = 0
    for i in range(max(1, min(d.nisland, len(d.solver_niter)))):
        most = max(most, d.solver_niter[i])
    return m.iterations > 1 and most >= m.iterations
