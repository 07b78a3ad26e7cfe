"""The belt-box around the contact, in scalars: what a model of it in C is made from."""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled

# Entries of ``box``: the fields of `stochfric_mb.mechanisms.BeltBox` in their order.
MASS, DAMPING, STIFFNESS, NORMAL_FORCE, BELT_VELOCITY, AMPLITUDE, FREQUENCY, INITIAL_POSITION, INITIAL_VELOCITY = range(9)


@compiled
def slip(box, t, x):
    """Return the relative displacement [m], belt minus box."""
    return box[BELT_VELOCITY] * t - x


@compiled
def slip_velocity(box, v):
    """Return the relative velocity [m/s], belt minus box."""
    return box[BELT_VELOCITY] - v


@compiled
def holding_force(box, t, x, v, external):
    """Return the friction force [N] that would keep the velocity as it is: c v + k x - k u_0 cos(W t) - external force."""
    drive = box[STIFFNESS] * box[AMPLITUDE] * math.cos(box[FREQUENCY] * t)
    return box[DAMPING] * v + box[STIFFNESS] * x - drive - external
