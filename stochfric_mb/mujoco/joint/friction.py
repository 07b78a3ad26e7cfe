"""Friction of a joint or tendon from step to step: MuJoCo's own friction row, steered by the law, or the law's force.

State, commits, switches and coefficient paths are those of contacts, with one slot that always touches; of vectors the
first component counts. The counter-surface is at rest: u = -position, v = -rate, and friction acts along +v on the
coordinate. A load that is the joint's own reaction is that of the step before.
"""

from __future__ import annotations

import mujoco

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import call_slide
from stochfric_mb.mujoco.contact import explicit, solver, tracking
from stochfric_mb.mujoco.contact.kinematics import JUMP, NEAR
from stochfric_mb.mujoco.contact.law import call, coefficients, commit_slot
from stochfric_mb.mujoco.contact.rows import set_reference, set_resistance
from stochfric_mb.mujoco.joint.coordinate import (
    add_row,
    along_row,
    bearing_load,
    friction_row,
    is_tendon,
    mobility,
    position_of,
    resting_load,
    set_limit,
)
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import DAMPING, DISCRETE, EULER, N_BIAS, N_GEAR, RUNGE_KUTTA, data_at, model_at
from stochfric_mb.numerics import memory as w

LEAK = 8.0e-5
"""Share of what would move a free coordinate in a step that its friction row lets pass, R over the mobility.

What is held sags by h^2 R F/`RIGID` and comes back with its load: chosen so that an arm of four like links sags by less than
1e-5 rad at 5 ms. Six links of 30 g that hold 1 kg at 0.6 m sag by 1.7e-5 rad at 2 ms, a quadruped that stands on the friction
of its joints by 5e-7, and by 7e-6 at 10 ms. With a smaller share Newton's method crosses more kinks: 24 joints of a Shadow
hand take 1.3, 1.4 and 2.0 iterations a step with 1e-3, 1e-4 and 1e-5 (natively 1.2). MuJoCo's own share, 0.1 of the mobility in
the model's first position, lets such chains sag by milliradians, and slide with a fifth of their friction where something
holds them.
"""

NO_DAMPING = int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
AT_JOINT = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
AFFINE = int(mujoco.mjtBias.mjBIAS_AFFINE)
EXPLICIT_DAMPING = NO_DAMPING | int(mujoco.mjtDisableBit.mjDSBL_EULERDAMP)
"""Options without dampers, and those with which Euler takes damping explicitly."""


@compiled
def evaluate(model, data, state, law):
    """Let friction act at this instant: the first one of a step, or a later stage of a Runge-Kutta step."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    starting = tracking.starts(m, d, header)
    if starting:
        begin(model, data, state, law)
    if header.solved != 0.0:
        steer(m, d, state, law, d.time - header.evaluated)
    else:
        apply(m, d, state, law, not starting)


@compiled
def begin(model, data, state, law):
    """Make the current slot for a step that starts now."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    known = header.advanced == d.time and header.n_committed > 0.0
    slot, old = s.slot_at(state, 1, 0), s.slot_at(state, 0, 0)
    if header.radius > 0.0 and not known:
        header.load = resting_load(m, header)
    fill(model, data, state, slot, old, known)
    header.n_current, slot.normal = 1.0, header.load
    beyond = header.load > explicit.critical_of(header, m.timestep) * slot.felt
    if tracking.tries_explicit(m, d, header) and explicit.will_do(header, beyond):
        header.solved = 0.0
        commit_slot(state, s.slot_address(state, 1, 0), law, header.instant, header.load, 1)
    else:
        header.solved = 1.0
        follow(m, d, state, law, slot, old, known)


@compiled
def fill(model, data, state, slot, old, known):
    """Fill kinematics and mass of the current slot; its law state stays the old one."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    if known:
        s.copy_slot(state, 0, 0, True)
    position, v = position_of(m, d, header), -along_row(m, d, header, d.qvel)
    slot.ux, slot.vx, slot.uy, slot.vy = -position, v, 0.0, 0.0
    slot.live = 1.0 if known else 0.0
    if known:
        before = slot.before
        before[0], before[1], before[3] = old.since, old.ux, old.vx
        slot.ux = old.ux + moved(old, position, v, header.instant)
        slot.work[0], slot.work[2] = old.fx, slot.ux - old.ux
    slot.axis_1[0], slot.since, slot.on_body[0] = 1.0, header.instant, position
    moves = mobility(m, d, header)
    slot.felt = 1.0 / moves if moves > 0.0 else 0.0
    slot.mass = slot.felt


@compiled
def moved(old, position, v, t):
    """Return the displacement since the old slot; a coordinate that was put elsewhere moves by its mean velocity."""
    du, mean = old.on_body[0] - position, 0.5 * (t - old.since) * (v + old.vx)
    if abs(du - mean) > JUMP * (t - old.since) * (abs(v) + abs(old.vx)) + NEAR:
        return mean
    return du


@compiled
def follow(m, d, state, law, slot, old, known):
    """Decide whether the coordinate sticks or slides, by what it was a step ago."""
    header, h = s.header_record(state), m.timestep
    slot.solved, slot.w[0] = 1.0, slot.vx
    if not known or old.solved == 0.0:
        solver.born(header, slot, abs(slot.vx))
        slot.ux, slot.given = -slot.on_body[0] if not known else old.ux, header.load
        if known:
            slot.events, slot.energy = old.events, old.energy
    else:
        slot.given = header.load
        early = 0.5 if m.integrator == RUNGE_KUTTA else 0.0
        slot.z[0] = old.z[0] + h * (slot.vx + early * (old.vx - slot.vx)) if old.slides == 0.0 else 0.0
        slot.energy = old.energy + old.pull[0] * (slot.ux - old.ux)
        slot.lead[0] = (slot.vx - old.w[0]) / h - old.a[0] if old.foreseen != 0.0 else 0.0
        solver.switch(state, law, slot, old, abs(slot.vx), h / slot.felt if slot.felt > 0.0 else 0.0)
    slot.live = 1.0
    slot.mu_s, slot.mu_k = coefficients(state, header.instant, slot.ux, slot.events)


@compiled
def undamped_part(m, header, slot):
    """Return the part of the solver's acceleration that is left where the integrator takes the joint's damping implicitly.

    That is 1/(1 + h c/m). A row asks for what is to be left. What other damping leaves out is known a step late
    (`lead`), which beyond h c/m = 4 would shake: the roots of v' = v + g s, z' = z + v', s' = (1 - g) s - v' - z'/4, with
    g = 1/(1 + h c/m) and time in steps, are then outside the unit circle.
    """
    if is_tendon(header) or m.integrator in (RUNGE_KUTTA, DISCRETE):
        return 1.0
    if m.disableflags & (EXPLICIT_DAMPING if m.integrator == EULER else NO_DAMPING) or slot.felt <= 0.0:
        return 1.0
    number = int(header.geom_surface)
    damping = w.at(m.dof_damping, w.int_at(m.jnt_dofadr, number))
    if m.integrator != EULER:  # which takes that of actuators explicitly
        damping += servo_damping(m, number)
    return 1.0 / (1.0 + m.timestep * damping / slot.felt)


@compiled
def servo_damping(m, joint):
    """Return the damping [N s/m or N m s/rad] that actuators at a joint have by their own kv."""
    total = 0.0
    for i in range(m.nu):
        at_joint = w.int_at(m.actuator_trntype, i) in AT_JOINT and w.int_at(m.actuator_trnid, 2 * i) == joint
        if at_joint and w.int_at(m.actuator_biastype, i) == AFFINE:
            total -= w.at(m.actuator_biasprm, N_BIAS * i + DAMPING) * w.at(m.actuator_gear, N_GEAR * i) ** 2
    return max(total, 0.0)


@compiled
def steer(m, d, state, law, since):
    """Write the largest force of the coordinate's friction row and its reference, ``since`` [s] after the step's start."""
    header, slot, h = s.header_record(state), s.slot_at(state, 1, 0), m.timestep
    place = friction_row(m, d, header)
    if place < 0:
        return
    v, z = slot.vx, 0.0
    if since > 0.0:
        v = -along_row(m, d, header, d.qvel)
        z = 0.5 * since * (slot.vx + v)
    resistance, stiffness, position = LEAK / slot.felt, 0.0, 0.0
    if slot.slides != 0.0:
        slot.cap = call_slide(law.slide, abs(v), slot.mu_s, slot.mu_k, header.parameters.ctypes.data)
    else:
        resistance, stiffness, slot.cap = solver.spring_and_cap(m, state, law, slot, resistance)
        position = -(slot.z[0] + z + slot.lead[0] / stiffness)
    slot.undamped = undamped_part(m, header, slot)
    set_resistance(m, d, place, resistance / slot.undamped)
    set_reference(d, place, 1.0 / (h * slot.undamped), stiffness / slot.undamped, position)
    set_limit(d, place, slot.cap * slot.given)


@compiled
def apply(m, d, state, law, stage):
    """Add the law's force at this instant; MuJoCo's own friction of the coordinate is off."""
    header, address = s.header_record(state), s.slot_address(state, 1, 0)
    slot = s.slot_record(address)
    place = friction_row(m, d, header)
    if place >= 0:
        set_limit(d, place, 0.0)
    t = header.instant
    u, v, mu_s, mu_k = slot.ux, slot.vx, slot.mu_s, slot.mu_k
    if stage:
        t = canonical_time(d.time, 0.5 * m.timestep)
        v = -along_row(m, d, header, d.qvel)
        u += moved(slot, position_of(m, d, header), v, t)
        mu_s, mu_k = coefficients(state, t, u, slot.events)
    call(state, address, law.force, t, u, 0.0, v, 0.0, mu_s, mu_k)
    force = header.output[0]
    if not stage:
        slot.fx, slot.fy = force, 0.0
        slot.energy += 0.5 * (slot.work[0] + force) * slot.work[2]
    add_row(m, d, header, force, d.qfrc_passive)


@compiled
def learn(m, d, state, current):
    """Write the solver's solution for the coordinate to its slot; the committed block (0) is that of an accepted step."""
    header, slot = s.header_record(state), s.slot_at(state, current, 0)
    place = friction_row(m, d, header)
    force = w.at(d.efc_force, place) if place >= 0 else 0.0
    limit = slot.cap * slot.given
    saturated = abs(force) >= solver.SATURATED * limit
    slot.normal, slot.fx = slot.given, force
    slow = abs(slot.vx) <= max(header.stick_speed, header.peak_speed)
    slot.stick = 1.0 if slot.slides == 0.0 and not saturated and slow else 0.0
    if current == 1:
        return
    slot.pull[0], slot.saturated = force, 1.0 if saturated else 0.0
    slot.loose = slot.saturated
    slot.foreseen = 1.0 if slot.slides == 0.0 and not saturated and m.integrator != RUNGE_KUTTA and place >= 0 else 0.0
    if slot.foreseen != 0.0:
        slot.a[0] = -slot.undamped * along_row(m, d, header, d.qacc)


@compiled
def finish(model, data, state):
    """Commit the current slot when the engine accepts a step."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    if header.n_current == 0.0:
        return
    s.copy_slot(state, 1, 0, True)
    if header.solved != 0.0:
        learn(m, d, state, 0)
    if header.radius > 0.0:
        header.load = bearing_load(model, data, m, d, header)
    header.unconverged += 1.0 if tracking.stopped_early(model, data) else 0.0
    explicit.count_beyond(header)
    header.latched = header.solved
    header.n_committed, header.advanced, header.started = 1.0, d.time, 0.0
