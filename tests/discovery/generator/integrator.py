"""Time stepping of the belt-box rig: RK4 at a fixed step, every stick and slip event located by bisection.

m x'' = -spring(x) - damper(x') + applied force + second body + friction; friction = sign(v_rel) mu N while slipping, whatever
is needed while stuck, up to mu_s N. In rigid stick the box has the belt's velocity and acceleration.
"""

from math import log

import numba
import numpy as np

from .curve import Array
from .machine import BELT, FORCE, KINETIC, LOAD, SIGNAL_SPACING, STATIC, STIFFNESS, Machine
from .packing import (
    AGEING,
    BACKWARD,
    BELT_SURFACE,
    CONTACT_DAMPING,
    CONTACT_LENGTH,
    CONTACT_SHAPE,
    CREEP,
    CREEPS,
    DAMPER,
    FORCE_BY_SLIP,
    FORWARD,
    GROUND_DAMPING,
    GROUND_STIFFNESS,
    KINETIC_BY_SLIP,
    LINK_DAMPING,
    LINK_STIFFNESS,
    MASS,
    MEMORY_OF_DISTANCE,
    MEMORY_OF_TIME,
    SECOND_MASS,
    SLIDING,
    SPEED_DELAY,
    SPRING,
    START,
    STATIC_BY_SLIP,
    STROKE,
    look_up,
    pack,
)

STEP = 1e-4
X, V, S, DELAYED, Y, W, Z, MODE, SLIPS, SINCE, SLIP_FROM = range(11)
"""State: position, velocity, place on the belt, delayed speed, second body's position and velocity, contact deflection,
mode (0 stuck, +-1 slipping with that sign of v_rel), number of break-aways, time of the last event, place of the
last break-away.
"""
N_STATES, N_MOVING = 11, 7
_BISECTIONS = 45  # halves one step of 1e-4 s to below the rounding of the time
_EVENTS_PER_STEP = 6  # more than this in one step is chatter at v_rel = 0: take the rest of the step as it comes


@numba.njit(cache=True, error_model="numpy")
def _signal(numbers, signals, t, column):
    at = (t - numbers[START]) / SIGNAL_SPACING
    i = min(max(int(at), 0), signals.shape[0] - 2)
    low = signals[i, column]
    return low + (at - i) * (signals[i + 1, column] - low)


@numba.njit(cache=True, error_model="numpy")
def _belt_acceleration(numbers, signals, t):
    at = (t - numbers[START]) / SIGNAL_SPACING
    i = min(max(int(at), 0), signals.shape[0] - 2)
    return (signals[i + 1, BELT] - signals[i, BELT]) / SIGNAL_SPACING


@numba.njit(cache=True, error_model="numpy")
def _place_factor(numbers, signals, heads, values, state):
    return look_up(heads, values, BELT_SURFACE, state[S]) * look_up(heads, values, STROKE, state[X])


@numba.njit(cache=True, error_model="numpy")
def static_limit(numbers, signals, heads, values, t, state, sign):
    """mu_s N [N] for the direction in which the contact would let go."""
    direction = numbers[FORWARD] if sign >= 0.0 else numbers[BACKWARD]
    by_slip = look_up(heads, values, STATIC_BY_SLIP, int(state[SLIPS]))
    dwell = max(t - state[SINCE], 0.0) if state[MODE] == 0.0 else 0.0
    aged = look_up(heads, values, AGEING, log(dwell + 1e-3))
    return (
        _signal(numbers, signals, t, STATIC)
        * _signal(numbers, signals, t, LOAD)
        * direction
        * by_slip
        * aged
        * _place_factor(numbers, signals, heads, values, state)
    )


@numba.njit(cache=True, error_model="numpy")
def sliding_force(numbers, signals, heads, values, t, state, mode):
    """Friction force [N] while slipping, with its sign."""
    direction = numbers[FORWARD] if mode > 0.0 else numbers[BACKWARD]
    index = max(int(state[SLIPS]) - 1, 0)
    speed = state[DELAYED] if numbers[SPEED_DELAY] > 0.0 else abs(_signal(numbers, signals, t, BELT) - state[V])
    mu_s = _signal(numbers, signals, t, STATIC)
    mu_k = _signal(numbers, signals, t, KINETIC)
    kept = look_up(heads, values, MEMORY_OF_DISTANCE, abs(state[S] - state[SLIP_FROM])) + look_up(
        heads, values, MEMORY_OF_TIME, t - state[SINCE]
    )
    mu = mu_k * look_up(heads, values, SLIDING, speed) * look_up(heads, values, KINETIC_BY_SLIP, index) + (mu_s - mu_k) * kept
    return mode * mu * direction * _place_factor(numbers, signals, heads, values, state) * _signal(numbers, signals, t, LOAD)


@numba.njit(cache=True, error_model="numpy")
def _other_forces(numbers, signals, heads, values, t, state, velocity):
    force = _signal(numbers, signals, t, FORCE) - _signal(numbers, signals, t, STIFFNESS) * look_up(
        heads, values, SPRING, state[X]
    )
    force -= look_up(heads, values, DAMPER, velocity)
    if numbers[SECOND_MASS] > 0.0:
        force += numbers[LINK_STIFFNESS] * (state[Y] - state[X]) + numbers[LINK_DAMPING] * (state[W] - velocity)
    return force


@numba.njit(cache=True, error_model="numpy")
def holding_force(numbers, signals, heads, values, t, state):
    """Friction force [N] that would keep the box on the belt."""
    return numbers[MASS] * _belt_acceleration(numbers, signals, t) - _other_forces(
        numbers, signals, heads, values, t, state, _signal(numbers, signals, t, BELT)
    )


@numba.njit(cache=True, error_model="numpy")
def contact_force(numbers, signals, heads, values, t, state):
    """Friction force [N] of the compliant stuck contact."""
    v_rel = _signal(numbers, signals, t, BELT) - state[V]
    share = look_up(heads, values, CONTACT_SHAPE, state[Z] / numbers[CONTACT_LENGTH])
    return share * static_limit(numbers, signals, heads, values, t, state, state[Z]) + numbers[CONTACT_DAMPING] * v_rel


@numba.njit(cache=True, error_model="numpy")
def friction_force(numbers, signals, heads, values, t, state):
    """Friction force on the box [N] in any mode."""
    if state[MODE] != 0.0:
        return sliding_force(numbers, signals, heads, values, t, state, state[MODE])
    if numbers[CONTACT_LENGTH] > 0.0:
        return contact_force(numbers, signals, heads, values, t, state)
    return holding_force(numbers, signals, heads, values, t, state)


@numba.njit(cache=True, error_model="numpy")
def _derivative(numbers, signals, heads, values, t, state, rate):
    mode = state[MODE]
    belt = _signal(numbers, signals, t, BELT)
    v_rel = belt - state[V]
    if mode == 0.0 and numbers[CONTACT_LENGTH] == 0.0:
        rate[X] = belt
        if numbers[CREEPS] != 0.0:
            needed = holding_force(numbers, signals, heads, values, t, state)
            share = abs(needed) / static_limit(numbers, signals, heads, values, t, state, needed)
            rate[X] -= np.sign(needed) * look_up(heads, values, CREEP, share)
        rate[V] = _belt_acceleration(numbers, signals, t)
        rate[S] = belt - rate[X]
        rate[Z] = 0.0
    else:
        force = _other_forces(numbers, signals, heads, values, t, state, state[V])
        if mode == 0.0:
            force += contact_force(numbers, signals, heads, values, t, state)
            rate[Z] = v_rel
        else:
            index = int(state[SLIPS]) - 1
            force += sliding_force(numbers, signals, heads, values, t, state, mode) + look_up(
                heads, values, FORCE_BY_SLIP, max(index, 0)
            )
            rate[Z] = 0.0
        rate[X] = state[V]
        rate[V] = force / numbers[MASS]
        rate[S] = v_rel
    rate[DELAYED] = (abs(rate[S]) - state[DELAYED]) / numbers[SPEED_DELAY] if numbers[SPEED_DELAY] > 0.0 else 0.0
    rate[Y] = state[W]
    rate[W] = 0.0
    if numbers[SECOND_MASS] > 0.0:
        link = numbers[LINK_STIFFNESS] * (state[X] - state[Y]) + numbers[LINK_DAMPING] * (rate[X] - state[W])
        rate[W] = (link - numbers[GROUND_STIFFNESS] * state[Y] - numbers[GROUND_DAMPING] * state[W]) / numbers[SECOND_MASS]


@numba.njit(cache=True, error_model="numpy")
def _advance(numbers, signals, heads, values, t, state, h, after, work):
    """One RK4 step from state into after; modes and counters stay as they are."""
    after[:] = state
    for stage in range(4):
        share = 0.0 if stage == 0 else (0.5 if stage < 3 else 1.0)
        weight = 1.0 / 6.0 if stage in (0, 3) else 1.0 / 3.0
        if stage > 0:
            for j in range(N_MOVING):
                work[1, j] = state[j] + share * h * work[0, j]
        else:
            work[1, :] = state
        _derivative(numbers, signals, heads, values, t + share * h, work[1], work[0])
        for j in range(N_MOVING):
            after[j] += weight * h * work[0, j]
    if state[MODE] == 0.0 and numbers[CONTACT_LENGTH] == 0.0:
        after[V] = _signal(numbers, signals, t + h, BELT) - (work[0, S])


@numba.njit(cache=True, error_model="numpy")
def _event_passed(numbers, signals, heads, values, t, state):
    """Whether the present mode has ended at or before this state."""
    mode = state[MODE]
    if mode != 0.0:
        return mode * (_signal(numbers, signals, t, BELT) - state[V]) < -1e-13
    if numbers[CONTACT_LENGTH] > 0.0:
        force = contact_force(numbers, signals, heads, values, t, state)
        v_rel = _signal(numbers, signals, t, BELT) - state[V]
        return abs(force) > static_limit(numbers, signals, heads, values, t, state, force) and force * v_rel > 0.0
    needed = holding_force(numbers, signals, heads, values, t, state)
    return abs(needed) > static_limit(numbers, signals, heads, values, t, state, needed)


@numba.njit(cache=True, error_model="numpy")
def _let_go(t, state, sign):
    state[MODE] = sign
    state[SLIPS] += 1.0
    state[SINCE] = t
    state[SLIP_FROM] = state[S]


@numba.njit(cache=True, error_model="numpy")
def _deflection(numbers, signals, heads, values, share):
    """Contact deflection [m] that carries this share of the static limit."""
    low, high = -1.0, 1.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        if look_up(heads, values, CONTACT_SHAPE, middle) < share:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high) * numbers[CONTACT_LENGTH]


@numba.njit(cache=True, error_model="numpy")
def _switch(numbers, signals, heads, values, t, state):
    """Change the mode at an event."""
    if state[MODE] == 0.0:
        force = (
            contact_force(numbers, signals, heads, values, t, state)
            if numbers[CONTACT_LENGTH] > 0.0
            else holding_force(numbers, signals, heads, values, t, state)
        )
        _let_go(t, state, np.sign(force))
        return
    last = sliding_force(numbers, signals, heads, values, t, state, state[MODE])
    was = state[MODE]
    state[MODE] = 0.0
    state[SINCE] = t
    if numbers[CONTACT_LENGTH] > 0.0:
        state[Z] = _deflection(
            numbers, signals, heads, values, last / static_limit(numbers, signals, heads, values, t, state, last)
        )
        return
    needed = holding_force(numbers, signals, heads, values, t, state)
    if abs(needed) > static_limit(numbers, signals, heads, values, t, state, needed):
        _let_go(t, state, np.sign(needed))
        if state[MODE] == was:
            state[SLIPS] -= 1.0


@numba.njit(cache=True, error_model="numpy")
def _step(numbers, signals, heads, values, t, state, h, after, work):
    """Advance the state by h, through all events on the way."""
    left = h
    for _ in range(_EVENTS_PER_STEP):
        _advance(numbers, signals, heads, values, t, state, left, after, work)
        if not _event_passed(numbers, signals, heads, values, t + left, after):
            state[:] = after
            return
        low, high = 0.0, left
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            _advance(numbers, signals, heads, values, t, state, middle, after, work)
            if _event_passed(numbers, signals, heads, values, t + middle, after):
                high = middle
            else:
                low = middle
        _advance(numbers, signals, heads, values, t, state, high, after, work)
        state[:] = after
        t += high
        left -= high
        _switch(numbers, signals, heads, values, t, state)
        if left <= 0.0:
            return
    _advance(numbers, signals, heads, values, t, state, left, after, work)
    state[:] = after


@numba.njit(cache=True, error_model="numpy")
def _run(numbers, signals, heads, values, state, t, n_samples, steps_per_sample, h):
    states = np.empty((n_samples, N_STATES))
    friction = np.empty(n_samples)
    after = np.empty(N_STATES)
    work = np.empty((2, N_STATES))
    for i in range(n_samples):
        states[i] = state
        friction[i] = friction_force(numbers, signals, heads, values, t + i * steps_per_sample * h, state)
        if i == n_samples - 1:
            break
        for j in range(steps_per_sample):
            _step(numbers, signals, heads, values, t + (i * steps_per_sample + j) * h, state, h, after, work)
    return states, friction


def simulate(
    machine: Machine, n_samples: int, *, state: Array | None = None, start: float | None = None, step: float = STEP
) -> tuple[Array, Array]:
    """States, shape (n_samples, 11), and friction force [N], shape (n_samples,), every millisecond.

    Starts at `start` (default: where the signals begin) from `state` (default: at rest on the belt at x = 0).
    """
    begin = machine.start if start is None else start
    if state is None:
        state = np.zeros(N_STATES)
        state[V] = machine.signals[0, BELT]
        state[SINCE] = begin
    steps_per_sample = round(SIGNAL_SPACING / step)
    return _run(*pack(machine), state.copy(), begin, n_samples, steps_per_sample, SIGNAL_SPACING / steps_per_sample)
