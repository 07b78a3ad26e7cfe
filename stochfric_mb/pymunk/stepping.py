"""A start that makes pymunk's steps second order: the leap-frog's first half step."""

from __future__ import annotations

import pymunk

from stochfric_mb.errors import require_number
from stochfric_mb.pymunk.handlers import members


def start(space: pymunk.Space, dt: float) -> None:
    """Take the half step that puts velocities on half steps, ahead of steps of ``dt`` [s]; positions stay where they are.

    pymunk drifts with the velocity at hand and then kicks it: x += v dt, v += a dt. Begun with position and velocity of
    the same time, positions are off by a t dt/2. After this call ``space.step(dt)`` is a leap-frog: positions on whole
    steps are second order, velocities belong to dt/2 later (the mean before and after a step belongs to its time).
    Clocks of the space's frictions are where they were.

    Args:
        space: the space, with positions and velocities of the same time.
        dt: the step that will follow [s], > 0.

    Raises:
        InputError: ``dt`` is not a positive number.
    """
    require_number("dt", dt, above=0.0, unit="s")
    for body in space.bodies:
        if body.body_type != pymunk.Body.STATIC:
            body.position -= 0.5 * dt * body.velocity
            body.angle -= 0.5 * dt * body.angular_velocity
    for member in members(space):
        member.time -= 0.5 * dt
    space.step(0.5 * dt)
