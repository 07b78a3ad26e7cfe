"""A contact's law at work: its coefficients, its calls, the commit of its state, and the switches within a step."""

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import evaluate
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.abi import call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial

SWITCHES = 4
"""Most switches of a law looked for within one step."""
INSTANT = 1.0e-12
"""Part of a step to which the instant of a switch is found."""


@compiled_inline
def coefficients(state, t, position, events):
    """Return (mu_s, mu_k) of the instance's path; along time, once for all its contacts."""
    header = s.header_record(state)
    if header.path_time == t:
        return header.path_mu_s, header.path_mu_k
    mu_s, mu_k = coefficients_anew(state, t, position, events)
    if s.descriptor_of(state)[1] == TIME:
        header.path_mu_s, header.path_mu_k, header.path_time = mu_s, mu_k, t
    return mu_s, mu_k


@compiled
def coefficients_anew(state, t, position, events):
    """Return (mu_s, mu_k) of the instance's path, evaluated now."""
    header = s.header_record(state)
    address = int(header.seed), int(header.sample), int(header.contact)
    return evaluate(s.descriptor_of(state), s.cursor_of(state), address[0], address[1], address[2], t, position, events)


@compiled_inline
def call(state, address, function, t, ux, uy, vx, vy, mu_s, mu_k):
    """Call one of the law's functions on a slot; the result goes to the header's ``output``."""
    slot, header = s.slot_record(address), s.header_record(state)
    call_law(
        function, t, ux, uy, vx, vy, slot.normal, mu_s, mu_k, slot.mass, slot.hold[0], slot.hold[1],
        slot.state.ctypes.data, header.parameters.ctypes.data, header.output.ctypes.data,
    )  # fmt: skip


@compiled
def commit_slot(state, address, law, t, total, count):
    """Run the commit (init for a new contact) of the law on a current slot.

    Contacts of one pair share the mass that they feel, in proportion to their normal forces.
    """
    header, slot = s.header_record(state), s.slot_record(address)
    slot.mass *= slot.normal / total if total > 0.0 else 1.0 / count
    modes, live = header.has_mode != 0.0, slot.live
    new = live <= 0.0
    if not new and modes:
        switch_within(state, address, law, t)
    function = law.init if new else law.commit
    changed = switch(state, address, law, function, t, slot.ux, slot.uy, slot.vx, slot.vy)
    if live == 0.0:
        slot.events = 0.0
    slot.mu_s, slot.mu_k = coefficients(state, t, slot.ux, slot.events)
    slot.live = 1.0
    if modes and changed:
        guards_at(state, address, law, t, slot.ux, slot.uy, slot.vx, slot.vy)
        keep_guards(state, address)


@compiled_inline
def keep_guards(state, address):
    """Copy the guards from the output to the slot, for the search in the time that follows."""
    slot, output = s.slot_record(address), s.header_record(state).output
    for j in range(GUARDS):
        slot.guards[j] = output[j]


@compiled_inline
def guards_at(state, address, law, t, ux, uy, vx, vy):
    """Write the law's guards at this instant to the output."""
    mu_s, mu_k = coefficients(state, t, ux, s.slot_record(address).events)
    call(state, address, law.guards, t, ux, uy, vx, vy, mu_s, mu_k)


@compiled_inline
def switch(state, address, law, function, t, ux, uy, vx, vy):
    """Give a slot the law state that ``function`` (init or commit) returns; return whether it is another one.

    Stick phases that begin are counted.
    """
    header, slot = s.header_record(state), s.slot_record(address)
    changed = slot.live == 0.0
    mu_s, mu_k = coefficients(state, t, ux, slot.events)
    call(state, address, function, t, ux, uy, vx, vy, mu_s, mu_k)
    for j in range(law.n_state):
        new = header.output[j]
        changed = changed or slot.state[j] != new
        slot.state[j] = new
    was = slot.stick
    if header.has_mode != 0.0:
        slot.stick = 1.0 if slot.state[0] == 0.0 else 0.0
    else:
        slot.stick = 1.0 if length(vx, vy) <= header.stick_speed else 0.0
    if slot.stick > was:
        slot.events += 1.0
    return changed


@compiled
def switch_within(state, address, law, t):
    """Let a law with modes switch where it should have within the step that has just ended.

    Where one of the law's guards has changed sign, ``commit`` runs with the state there, by the cubic through both
    ends of the step: what the law remembers of a switch then does not depend on where the step ended.
    """
    before, start = s.slot_record(address).before[0], 0.0
    for _ in range(SWITCHES):
        if least_guard(state, address, law, t, 1.0) > 0.0:
            keep_guards(state, address)
            return
        start = first_crossing(state, address, law, t, start)
        ux, uy, vx, vy = between(address, t, start)
        now = before + start * (t - before)
        switch(state, address, law, law.commit, now, ux, uy, vx, vy)
        guards_at(state, address, law, now, ux, uy, vx, vy)
        keep_guards(state, address)


@compiled
def first_crossing(state, address, law, t, low):
    """Return the part of the step, after ``low``, just behind which no guard that was positive is so any more.

    False position on the least of them, which ends on both sides of the root.
    """
    b = bracket(low, least_guard(state, address, law, t, low), 1.0, least_guard(state, address, law, t, 1.0))
    while is_wide(b, INSTANT):
        part = trial(b, INSTANT)
        b = narrowed(b, part, least_guard(state, address, law, t, part))
    return b.negative


@compiled
def between(address, t, part):
    """Return displacement [m] and velocity [m/s] at a part of the step that ends at ``t``: the cubic through its ends."""
    slot = s.slot_record(address)
    b = slot.before
    h = t - b[0]
    ux, uy, vx, vy = b[1], b[2], b[3], b[4]
    dx, dy = slot.ux - ux, slot.uy - uy
    wx, wy = slot.vx, slot.vy
    p, q = part, 1.0 - part
    end, here, there = p * p * (3.0 - 2.0 * p), p * q * q * h, -p * p * q * h
    rise, early, late = 6.0 * p * q / h, q * (1.0 - 3.0 * p), p * (3.0 * p - 2.0)
    return (
        ux + end * dx + here * vx + there * wx,
        uy + end * dy + here * vy + there * wy,
        rise * dx + early * vx + late * wx,
        rise * dy + early * vy + late * wy,
    )


@compiled_inline
def least_guard(state, address, law, t, part):
    """Return the least of the guards that were positive at the start of the search, at a part of the step."""
    slot = s.slot_record(address)
    if part == 1.0:
        now, ux, uy, vx, vy = t, slot.ux, slot.uy, slot.vx, slot.vy
    else:
        ux, uy, vx, vy = between(address, t, part)
        now = slot.before[0] + part * (t - slot.before[0])
    guards_at(state, address, law, now, ux, uy, vx, vy)
    output = s.header_record(state).output
    least = math.inf
    for j in range(GUARDS):
        if slot.guards[j] > 0.0:
            least = min(least, output[j])
    return least
