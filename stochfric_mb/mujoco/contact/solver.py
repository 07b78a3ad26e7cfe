"""Friction at contacts by MuJoCo's own solver, steered by the law: a cap for each step, and a spring while stuck.

*Stuck* rows ask for the relative velocity and the deflection since the contact stuck to vanish (native friction asks for
the velocity alone, and creeps); their cap is mu_s N. *Sliding* rows ask for the velocity to vanish, with the law's
coefficient at the speed at hand as cap. The solver's solution says when a contact switches: a force at its cap ends
stick, one below it ends slip.

Two terms make the step first order in everything. The elliptic cone of a contact at its cap asks its normal row for
a + mu abs(a_t - aref_t) instead of a (MuJoCo's computation chapter, elliptic cones), which lifts sliding bodies off; that
is taken out of the normal row's reference, with the last step's a_t. Of a stuck contact only the part beyond mu N R_t is, from
where on the cone does so. And integrators with implicit
damping move a contact otherwise than the solver foresaw; a stuck row is told the difference of the last step.

The discrete integrator, which alone solves with the damping of joints and actuators, makes its references anew after the
passive stage. There a stuck row takes its deflection back through the surface's velocity, which it reads then (`set_target`);
R stays MuJoCo's, so all laws at rest are as rigid as that. PGS does not converge on stiff sliding rows, so sliding contacts
keep MuJoCo's own reference there, which lifts bodies a little.
"""

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.abi import call_slide, call_spring
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco.contact.directions import force_stretch_of, product, size, stretch_of, turn
from stochfric_mb.mujoco.contact.face import match, share_out
from stochfric_mb.mujoco.contact.kinematics import bodies_of, dot, ordinal_after, put, set_axes, side, spin
from stochfric_mb.mujoco.contact.law import coefficients
from stochfric_mb.mujoco.contact.rows import (
    LEAST,
    RIGID,
    forget_target,
    raise_normal,
    rate_of,
    resistances,
    set_cap,
    set_reference,
    set_resistance,
    set_target,
    spring_of,
)
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import DISCRETE, ELLIPTIC, PGS, RUNGE_KUTTA, contact_at
from stochfric_mb.numerics import memory as w
from stochfric_mb.numerics.root import ROUNDING, bracket, is_wide, narrowed, trial

SATURATED = 0.9999
"""Share of the cap from which on a force counts as at its cap: the solver's tolerance leaves 1e-6 of it."""
SLIDING_SHARE = 0.99
"""Least share of the cap that sliding friction has where a contact slides and torsion or rolling does not do it alone."""
LIGHTEST = 0.01
"""Smallest weight of a contact among others: a lighter one is as stiff as one of this weight."""
CLOSE = 1.0e-6
"""Part of the force to which the speed of creep gives it: creep over ten minutes is then right to less than a micrometre."""
NOTHING = 1.0e-12
"""Part of the cap below which a force is the solver's rounding."""
FRICTIONLESS = (
    "stochfric_mb: a contact of a pair with friction has condim 1, so MuJoCo's solver has no friction for the law to steer; "
    "give the pair condim 3"
)
PYRAMIDAL = (
    "stochfric_mb: option.cone has been made pyramidal, whose coefficients are fixed before friction can set them; make it "
    "elliptic (model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC)"
)
UNKNOWN = -1.0
"""Value of ``given`` of a contact that has just come up, before it has a share of its face."""
JUST_STUCK = -1.0
"""Value of a slot's ``springs`` in the first step of a stick phase."""


@compiled
def evaluate(m, d, state, law, starting):
    """Steer the solver, at a step's start with new current slots; contacts born at a later stage get slots of their own."""
    header = s.header_record(state)
    since = d.time - header.evaluated
    body, surface = int(header.geom_body), int(header.geom_surface)
    if starting:
        if m.cone != ELLIPTIC:  # since the data were made, which refused it
            engine.mju_error(w.c_string(PYRAMIDAL))
        begin(m, d, state, law)
    k, ordinal = 0, 0
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, body, surface)
        if sign == 0 or contact.efc_address < 0:
            continue
        number = k
        if not starting:
            number = s.find(state, 1, int(header.n_current), contact.geom[0], contact.geom[1], ordinal, k)
            if number < 0:
                number = take_slot(m, d, state, law, contact, sign, ordinal, 0)
                s.slot_at(state, 1, number).given = 0.0
            slot = s.slot_at(state, 1, number)
            if header.across != 1.0:
                turn(m, d, header, slot, contact, bodies_of(m, contact, sign)[0])
            slot.mu_s, slot.mu_k = coefficients(state, canonical_time(d.time, 0.5 * m.timestep), slot.ux, slot.events)
        k += 1
        steer(m, d, state, law, contact, sign, s.slot_address(state, 1, number), since)


@compiled
def begin(m, d, state, law):
    """Make the current slots for a step that starts now."""
    header = s.header_record(state)
    known = int(header.n_committed) if header.advanced == d.time else 0
    match(d, state, known, True)
    header.n_current = 0.0
    ordinal = 0
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, int(header.geom_body), int(header.geom_surface))
        if sign != 0 and contact.efc_address >= 0:
            take_slot(m, d, state, law, contact, sign, ordinal, known)
    share_out(state, int(header.n_current))


@compiled_inline
def take_slot(m, d, state, law, contact, sign, ordinal, known):
    """Return the number of the next free slot, filled from a contact."""
    header = s.header_record(state)
    number = int(header.n_current)
    if contact.dim < 3:
        engine.mju_error(w.c_string(FRICTIONLESS))
    s.require_room(header, number)
    header.n_current = number + 1.0
    forget_target(m, contact, s.slot_at(state, 1, number))
    follow(m, d, state, law, contact, sign, ordinal, known, number)
    return number


@compiled_inline
def measure_velocity(m, d, contact, sign):
    """Return the velocity [m/s] of the counter-surface relative to the body, in world axes, as the solver has it."""
    f, row = contact.frame, contact.efc_address
    a = sign * (rate_of(m, d, row + 1, d.qvel) + contact.surfacevel[0])
    b = sign * (rate_of(m, d, row + 2, d.qvel) + contact.surfacevel[1])
    return a * f[3] + b * f[6], a * f[4] + b * f[7], a * f[5] + b * f[8]


@compiled_inline
def follow(m, d, state, law, contact, sign, ordinal, known, k):
    """Fill the current slot ``k`` from a contact and what it was a step ago; decide whether it sticks or slides."""
    header, slot = s.header_record(state), s.slot_at(state, 1, k)
    number = int(slot.continues) if known > 0 else -1
    old = s.slot_at(state, 0, max(number, 0))
    h = m.timestep
    body, surface = bodies_of(m, contact, sign)
    wx, wy, wz = measure_velocity(m, d, contact, sign)
    set_axes(d, contact, slot, old, number >= 0, body, surface, h)
    slot.geom_1, slot.geom_2, slot.ordinal = contact.geom[0] + 1.0, contact.geom[1] + 1.0, ordinal
    slot.since, slot.live, slot.solved, slot.cap = header.instant, 1.0, 1.0, 0.0
    slot.bodies = body * s.BODIES + surface
    put(slot.w, wx, wy, wz)
    put(slot.normal_axis, contact.frame[0], contact.frame[1], contact.frame[2])
    put(slot.place, contact.pos[0], contact.pos[1], contact.pos[2])
    slot.resistance = resistances(m, d, contact.efc_address)[1] if m.integrator != DISCRETE else s.NO_LIMIT
    put(slot.mean, wx / 6.0, wy / 6.0, wz / 6.0)
    slot.vx, slot.vy = dot(slot.axis_1, wx, wy, wz), dot(slot.axis_2, wx, wy, wz)
    mobility = w.at(m.body_invweight0, 2 * body) + w.at(m.body_invweight0, 2 * surface)
    slot.felt = 1.0 / mobility if mobility > 0.0 else 0.0
    slot.mass = slot.felt if header.needs_mass != 0.0 else 0.0
    slot.across = 1.0  # and no side, as after a reset
    if header.across != 1.0:
        turn(m, d, header, slot, contact, body)
    speed = size(stretch_of(header), slot.side, slot.w)
    if number < 0:
        born(header, slot, speed)
    else:
        slot.given, slot.events, slot.energy, slot.saturated = old.given, old.events, old.energy, old.saturated
        slot.creep, slot.creep_share, slot.creep_slope, slot.fluidity = 0.0, 0.0, 0.0, 0.0
        put(slot.pull, old.pull[0], old.pull[1], old.pull[2])
        move(m, d, header, contact, slot, old, body, surface)
        switch(state, law, slot, old, speed, h * mobility)
    slot.mu_s, slot.mu_k = coefficients(state, header.instant, slot.ux, slot.events)


@compiled_inline
def born(header, slot, speed):
    """Start a contact: sliding if it is faster than the law's stick speed (or peak speed), otherwise stuck."""
    slot.slides = 1.0 if speed > max(header.stick_speed, header.peak_speed) else 0.0
    slot.ux, slot.uy = header.origin, 0.0
    slot.given, slot.events, slot.energy, slot.saturated = UNKNOWN, 0.0, 0.0, 0.0
    put(slot.z, 0.0, 0.0, 0.0)
    put(slot.pull, 0.0, 0.0, 0.0)
    put(slot.a, 0.0, 0.0, 0.0)
    put(slot.lead, 0.0, 0.0, 0.0)
    slot.weight, slot.creep, slot.creep_share, slot.creep_slope, slot.fluidity = 1.0, 0.0, 0.0, 0.0, 0.0


@compiled_inline
def move(m, d, header, contact, slot, old, body, surface):
    """Carry deflection, displacement and dissipated energy of a contact over the step that has just ended."""
    h, f = m.timestep, contact.frame
    v, u, a = slot.w, old.w, slot.a
    stages = m.integrator == RUNGE_KUTTA and old.solved != 0.0  # other integrators move with the velocity at the end
    mean = old.mean if stages else v
    dx, dy, dz = h * mean[0], h * mean[1], h * mean[2]
    slot.ux = old.ux + dot(slot.axis_1, dx, dy, dz)
    slot.uy = old.uy + dot(slot.axis_2, dx, dy, dz)
    slot.energy += dot(old.pull, dx, dy, dz)
    put(a, old.a[0], old.a[1], old.a[2])
    put(slot.lead, 0.0, 0.0, 0.0)
    if old.foreseen != 0.0:
        put(slot.lead, (v[0] - u[0]) / h - a[0], (v[1] - u[1]) / h - a[1], (v[2] - u[2]) / h - a[2])
    z = slot.z
    put(z, old.z[0], old.z[1], old.z[2])
    if old.slides == 0.0:
        turn = 0.5 * h * (spin(d, body, f[0], f[1], f[2]) + spin(d, surface, f[0], f[1], f[2]))
        x, y, k = z[0], z[1], z[2]
        put(
            z,
            x + turn * (f[1] * k - f[2] * y) + dx,
            y + turn * (f[2] * x - f[0] * k) + dy,
            k + turn * (f[0] * y - f[1] * x) + dz,
        )
        out = dot(z, f[0], f[1], f[2])
        put(z, z[0] - out * f[0], z[1] - out * f[1], z[2] - out * f[2])


@compiled_inline
def switch(state, law, slot, old, speed, step_mobility):
    """Let a contact break away or stick again, by the force of the solver's solution in the step that has just ended.

    No contact is stuck that friction could not stop within one step: ``step_mobility`` is the step over the mass.
    """
    header = s.header_record(state)
    stoppable = max(header.stick_speed, header.peak_speed) + step_mobility * old.mu_s * old.given
    z, v = slot.z, slot.w
    if old.slides == 0.0:
        breaks = old.loose != 0.0
        if old.saturated != 0.0 and not breaks:  # the other contacts hold the bodies: its force stays at the cap
            put(z, old.z[0], old.z[1], old.z[2])
        if header.rest == s.CREEP:
            creep(state, law, slot, old)
        elif old.springs != 0.0:
            limit, stretch = old.springs, stretch_of(header)
            squared = product(stretch, slot.side, z, z)
            breaks = breaks and squared >= limit * limit and product(stretch, slot.side, z, v) > 0.0
            if old.saturated != 0.0 and squared > limit * limit:
                part = limit / math.sqrt(squared)
                put(z, part * z[0], part * z[1], part * z[2])
        slot.slides = 1.0 if breaks or speed > stoppable else 0.0
    else:
        fast = old.saturated != 0.0 and (header.rest != s.CREEP or speed > header.peak_speed)
        slot.slides = 1.0 if fast or speed > stoppable else 0.0
        if slot.slides == 0.0:
            slot.events += 1.0
            put(z, 0.0, 0.0, 0.0)
            slot.springs = JUST_STUCK
            if header.rest == s.CREEP:
                creep(state, law, slot, old)


@compiled_inline
def spring_at(state, law, slot, load):
    """Return stiffness [N/m], damping [N s/m] and largest deflection [m] of an elastic law under a load [N]."""
    header = s.header_record(state)
    call_spring(law.spring, load, slot.felt, slot.mu_s, header.parameters.ctypes.data, header.output.ctypes.data)
    return header.output[0], header.output[1], header.output[2]


@compiled
def creep(state, law, slot, old):
    """Find the speed at which the law has the force at hand, at which the anchor of a law that creeps at rest follows."""
    header = s.header_record(state)
    force = size(force_stretch_of(header), slot.side, old.pull)
    if force > 0.0:
        slot.creep, slot.creep_share = creep_at(state, law, old, force)
        more = slot.creep_share - old.creep_share
        slot.creep_slope = (slot.creep - old.creep) / more if more != 0.0 else old.creep_slope
        slot.fluidity = slot.creep / force
        if old.slides == 0.0:
            move_along(header, slot, old.pull, (old.since - slot.since) * slot.fluidity)


@compiled_inline
def move_along(header, slot, force, part):
    """Add to the deflection what a spring of stiffness 1/``part`` [N/m] gives under a force."""
    z, e = slot.z, slot.side
    more = force_stretch_of(header) * dot(e, force[0], force[1], force[2])
    x, y, k = force[0] + more * e[0], force[1] + more * e[1], force[2] + more * e[2]
    put(z, z[0] + part * x, z[1] + part * y, z[2] + part * k)


@compiled_inline
def peak_coefficient(state, law, slot):
    """Return the law's coefficient [-] at its peak speed, evaluated where mu_s or mu_k has changed."""
    header = s.header_record(state)
    if header.peak_mu_s != slot.mu_s or header.peak_mu_k != slot.mu_k:
        header.peak = call_slide(law.slide, header.peak_speed, slot.mu_s, slot.mu_k, header.parameters.ctypes.data)
        header.peak_mu_s, header.peak_mu_k = slot.mu_s, slot.mu_k
    return header.peak


@compiled
def creep_at(state, law, slot, force):
    """Return the speed [m/s], up to the peak, at which the law has ``force`` [N], and its coefficient there over mu_s.

    The search starts where the slot was a step ago, and as that had changed in the step before.
    """
    header = s.header_record(state)
    slide, parameters, fastest = law.slide, header.parameters.ctypes.data, header.peak_speed
    most = peak_coefficient(state, law, slot)
    cap = most * slot.given
    excess, close = force - cap, CLOSE * force + NOTHING * cap
    if excess > 0.0:
        return fastest, most / slot.mu_s
    b, least = bracket(0.0, force, fastest, excess), ROUNDING * fastest
    share = force / (slot.given * slot.mu_s)
    speed = slot.creep + slot.creep_slope * (share - slot.creep_share)
    speed = speed if 0.0 < speed < fastest else trial(b, least)
    while is_wide(b, least):
        coefficient = call_slide(slide, speed, slot.mu_s, slot.mu_k, parameters)
        lack = force - coefficient * slot.given
        if abs(lack) <= close:
            return speed, coefficient / slot.mu_s
        b = narrowed(b, speed, lack)
        speed = trial(b, least)
    return b.negative, share


@compiled_inline
def steer(m, d, state, law, contact, sign, address, since):
    """Write a contact's cap and its rows' references, ``since`` [s] after the step's start."""
    slot = s.slot_record(address)
    vx, vy, vz = slot.w[0], slot.w[1], slot.w[2]
    x, y, z = 0.0, 0.0, 0.0
    if since > 0.0:
        ux, uy, uz = measure_velocity(m, d, contact, sign)
        part = 1.0 / 3.0 if since < 0.75 * m.timestep else 1.0 / 6.0
        mean, half = slot.mean, 0.5 * since
        put(mean, mean[0] + part * ux, mean[1] + part * uy, mean[2] + part * uz)
        x, y, z = half * (vx + ux), half * (vy + uy), half * (vz + uz)
        vx, vy, vz = ux, uy, uz
    if slot.slides != 0.0:
        let_slide(m, d, state, law, contact, slot, vx, vy, vz)
    else:
        hold(m, d, state, law, contact, sign, slot, x, y, z, vx, vy, vz)


@compiled
def let_slide(m, d, state, law, contact, slot, vx, vy, vz):
    """Steer a sliding contact: the law's coefficient at its speed, and the cone's lift taken out of the normal row."""
    h, first, header = m.timestep, contact.efc_address, s.header_record(state)
    e, stretch = slot.side, stretch_of(header)
    v = vx, vy, vz
    speed = size(stretch, e, v)
    cap = max(call_slide(law.slide, speed, slot.mu_s, slot.mu_k, header.parameters.ctypes.data), LEAST)
    lift = cap * max(0.0, speed / h + product(stretch, e, slot.a, v) / speed) if speed > 0.0 else 0.0
    resistance = w.at(d.efc_R, first + 1)
    if m.integrator == DISCRETE:
        set_target(m, contact, slot, 0.0, 0.0)
        raise_normal(m, d, contact, lift)
    elif m.solver != PGS:
        set_reference(d, first + 1, 1.0 / h, 0.0, 0.0)
        set_reference(d, first + 2, 1.0 / h, 0.0, 0.0)
        if take_out(d, contact, lift):
            resistance = keep_normal(m, d, first, cap)
    set_cap(m, d, contact, cap, slot.across, resistance)
    slot.cap = cap


@compiled
def take_out(d, contact, lift):
    """Let a contact's normal row ask for less, by ``lift`` [m/s^2], if that is positive; return whether it does."""
    first = contact.efc_address
    stiffness = w.at(d.efc_KBIP, 4 * first) * w.at(d.efc_KBIP, 4 * first + 2)
    if lift > 0.0 and stiffness > 0.0:
        w.put(d.efc_pos, first, contact.dist + lift / stiffness)
        return True
    return False


@compiled
def keep_normal(m, d, first, cap):
    """Let the normal force of a sliding contact be that of a frictionless one; return R of the tangents for it [1/kg].

    In slip the cone's normal force is (...)/(R_n (1 + mu^2)) with mu^2 = cap^2 R_t/R_n; R_n - cap^2 R_t in place of R_n
    makes that (...)/R_n. Where that would be less than 3/4 of R_n, R_t is lowered, which in slip changes nothing else.
    """
    normal, tangent = resistances(m, d, first)
    if 4.0 * cap * cap * tangent > normal:
        tangent = 0.25 * normal / (cap * cap)
    set_resistance(m, d, first, normal - cap * cap * tangent)
    return tangent


@compiled_inline
def spring_and_cap(m, state, law, slot, resistance):
    """Return R [1/kg] and K I [1/s^2] of a stuck row that has R = ``resistance``, and its cap [-].

    Rigid laws get the stiffest spring that suits the step, elastic ones their own, where a step can follow it: it would not
    take back more than all of the deflection at once. A law that creeps at rest is that rigid
    spring in series with a damper, of the force over the speed at which the law has it. Noslip iterations find the force as if
    R were 0, so all laws are rigid with them.
    """
    header, h = s.header_record(state), m.timestep
    stiffness, cap, compliant = RIGID / (h * h), slot.mu_s, m.noslip_iterations == 0
    just_stuck, slot.springs = slot.springs == JUST_STUCK, 0.0
    if header.rest == s.CREEP:
        cap = peak_coefficient(state, law, slot)
        resistance += slot.fluidity / h if compliant else 0.0
    elif header.rest == s.ELASTIC and compliant:
        weight = max(slot.weight, LIGHTEST)  # contacts of one face share what they hold together, by their normal forces
        k, c, limit = spring_at(state, law, slot, slot.given / weight)
        if k > 0.0:
            total, own = spring_of(resistance, weight * k, weight * c, h)
            if own <= 1.0 / (h * h):
                resistance, stiffness, slot.springs = total, own, limit
                if just_stuck:  # the deflection that keeps the force
                    move_along(header, slot, slot.pull, 1.0 / (weight * k))
    return resistance, stiffness, max(cap, LEAST)


@compiled_inline
def hold(m, d, state, law, contact, sign, slot, x, y, z, vx, vy, vz):
    """Steer a stuck contact that has moved by (x, y, z) [m] since the step's start, and now moves by (vx, vy, vz) [m/s]."""
    f, first = contact.frame, contact.efc_address
    weight = max(slot.weight, LIGHTEST)  # so contacts share a load by their normal forces
    resistance, stiffness, slot.cap = spring_and_cap(m, state, law, slot, slot.resistance / weight)
    x, y, z = x + slot.z[0], y + slot.z[1], z + slot.z[2]
    if m.integrator == DISCRETE:
        part = sign * weight * RIGID / m.timestep
        u, v = part * (x * f[3] + y * f[4] + z * f[5]), part * (x * f[6] + y * f[7] + z * f[8])
        set_target(m, contact, slot, u, v)
    else:
        rate, part = 1.0 / m.timestep, sign / stiffness
        x, y, z = sign * x + part * slot.lead[0], sign * y + part * slot.lead[1], sign * z + part * slot.lead[2]
        if slot.saturated != 0.0 and m.solver != PGS:
            a, k = slot.a, sign * stiffness
            wanted = a[0] + rate * vx + k * x, a[1] + rate * vy + k * y, a[2] + rate * vz + k * z
            excess = size(stretch_of(s.header_record(state)), slot.side, wanted) - slot.cap * slot.given * resistance
            take_out(d, contact, slot.cap * excess)
        set_reference(d, first + 1, rate, stiffness, x * f[3] + y * f[4] + z * f[5])
        set_reference(d, first + 2, rate, stiffness, x * f[6] + y * f[7] + z * f[8])
    set_cap(m, d, contact, slot.cap, slot.across, resistance)


@compiled_inline
def learn(m, d, header, contact, sign, slot, accepted):
    """Write the solver's solution for a contact to its slot (see `settle`)."""
    first = contact.efc_address
    normal, a, b = w.at(d.efc_force, first), w.at(d.efc_force, first + 1), w.at(d.efc_force, first + 2)
    others = 0.0
    for j in range(2, contact.dim - 1):
        others += (w.at(d.efc_force, first + 1 + j) / contact.friction[j]) ** 2
    p, q = 0.0, 0.0
    if accepted:
        p, q = rate_of(m, d, first + 1, d.qacc), rate_of(m, d, first + 2, d.qacc)
    settle(header, slot, contact.frame, sign, normal, a, b, others, p, q, accepted, m.integrator != RUNGE_KUTTA)


@compiled_inline
def settle(header, slot, f, sign, normal, a, b, others, p, q, accepted, foresees):
    """Write the forces of a contact to its slot, and of an accepted step what follows from them.

    That is whether the cap was reached, and the acceleration that the solver foresaw. (normal, a, b) are the contact's
    forces and (p, q) its accelerations along MuJoCo's tangents in frame ``f``; ``others`` is the sum of squares of torsional
    and rolling friction over their coefficients [N^2].
    """
    x, y, z = -sign * (a * f[3] + b * f[6]), -sign * (a * f[4] + b * f[7]), -sign * (a * f[5] + b * f[8])
    slot.normal = max(normal, 0.0)
    slot.fx, slot.fy = dot(slot.axis_1, x, y, z), dot(slot.axis_2, x, y, z)
    force = length(a, b / slot.across)
    at_cone = normal > 0.0 and (force / slot.cap) ** 2 + others >= (SATURATED * normal) ** 2
    saturated = at_cone and force >= SLIDING_SHARE * slot.cap * normal
    slow = size(stretch_of(header), slot.side, slot.w) <= max(header.stick_speed, header.peak_speed)
    slot.stick = 1.0 if slot.slides == 0.0 and not saturated and slow else 0.0
    if not accepted:
        return
    slot.given = slot.normal
    put(slot.pull, x, y, z)
    slot.saturated = 1.0 if saturated else 0.0
    slot.foreseen = 1.0 if slot.slides == 0.0 and not saturated and foresees else 0.0
    p, q = sign * p, sign * q
    put(slot.a, p * f[3] + q * f[6], p * f[4] + q * f[7], p * f[5] + q * f[8])
