"""The load of a driven joint that moves by itself, behind a spring or a gap: its motion follows from that of the motor.

With q_m and q_l the positions of motor and load, J_l the load's inertia and G what the load needs beside its own acceleration
(gravity, other joints), G_0(t) where the motor is, G_1(t) and G_2(t) its derivatives there::

    J_l q_l'' + f_l sign(q_l') + d_l q_l' + G = link,  G = G_0 - G_1 sin(s) + G_2 (1 - cos(s))
    link = k b + d b',  b = s - min(max(s, -gap/2), gap/2),  s = q_m - q_l

and ``link`` is 0 within a gap, whose flanks do not pull. G is that of a pendulum exactly, and of others to second order.

As one body, motor and load would need J_l q_m'' + f_l sign(q_m') + d_l q_m' + G_0 of the drive for the load; they need
``link``. The difference is the force that the load brings in by moving by itself. It follows from the motion of the motor
alone, without the drive that it is to explain. That motion is smoothed: fits would take the noise of positions for a motion
that a heavier load does not follow.

References: M. W. Spong, J. Dyn. Syst. Meas. Control 109, 1987, 310-319, doi 10.1115/1.3143860, eqs. 1-2 (a spring); M. Nordin,
P.-O. Gutman, Automatica 38, 2002, 1633-1649, doi 10.1016/S0005-1098(02)00047-X (a gap).
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled

Array = npt.NDArray[np.float64]

FINE = 0.2
"""Angle of the load's own oscillation in a step [rad]: the leapfrog then has its frequency right to FINE^2/24 = 0.2 %."""

QUICKEST = 1.0
"""Largest angle of that oscillation from one sample to the next [rad]: samples tell no stiffer link from this one."""


@dataclasses.dataclass(frozen=True)
class MotorMotion:
    """The measured side of a driven joint in one run, and what its load needs."""

    interval: float
    """Distance between samples [s]."""
    position: Array
    """Position of the motor [m or rad], shape (count,)."""
    velocity: Array
    """Its velocity [m/s or rad/s], shape (count,)."""
    acceleration: Array
    """Its acceleration [m/s^2 or rad/s^2], shape (count,)."""
    inertia: float
    """Inertia of motor and load together as stated [kg or kg m^2], > 0."""
    held: Array
    """What the load needs beside its acceleration where the motor is [N or N m], and the first and second derivative of that by
    the load's position, shape (3, count)."""
    inside: tuple[int, int]
    """First sample at which velocity and acceleration are known, and the one after the last."""


@dataclasses.dataclass(frozen=True)
class Link:
    """What connects motor and load."""

    inertia: float
    """Inertia of the load [kg or kg m^2], > 0."""
    frequency: float
    """Natural frequency of the load with the motor held, sqrt(k/inertia)/(2 pi) [Hz], > 0."""
    damping_ratio: float
    """Damping ratio of the same, d/(2 sqrt(k inertia)) [-], >= 0."""
    gap: float = 0.0
    """Width of the gap [m or rad]; 0: none."""
    friction: float = 0.0
    """Coulomb friction at the load, part of that of the joint [N or N m]."""
    damping: float = 0.0
    """Viscous friction at the load, part of that of the joint [N s/m or N m s/rad]."""
    start: tuple[float, float] = (0.0, 0.0)
    """What the link carries beyond equilibrium at the first sample, in phase and a quarter of a period ahead [N or N m]."""


def load_force(motor: MotorMotion, link: Link) -> Array:
    """Return the force that a load which moves by itself needs beyond one that follows [N or N m], shape (count,).

    It acts against the motor's positive direction, and is 0 outside of `MotorMotion.inside`.

    Args:
        motor: the motion of the motor.
        link: what connects the two.
    """
    w = min(2.0 * math.pi * link.frequency, QUICKEST / motor.interval)
    numbers = np.array([
        link.inertia, link.inertia * w**2, 2.0 * link.damping_ratio * w * link.inertia, link.gap, link.friction, link.damping,
        *link.start,
    ])  # fmt: skip
    steps = max(1, math.ceil(w * motor.interval / FINE))
    force = np.zeros(len(motor.position))
    _march(numbers, motor.position, motor.velocity, motor.held, motor.interval, *motor.inside, steps, force)
    seen = slice(*motor.inside)
    rubs = link.friction * np.sign(motor.velocity) + link.damping * motor.velocity
    follows = link.inertia * motor.acceleration + motor.held[0] + rubs
    force[seen] -= follows[seen]
    return force


@compiled
def _march(numbers, position, velocity, held, interval, first, end, steps, force):
    """Fill ``force`` with what the link carries at the samples from ``first`` to ``end``; leapfrog with implicit damping."""
    inertia, k, damping, gap, friction, drag = numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]
    h = interval / steps
    rate = (velocity[first + 1] - velocity[first]) / interval
    need = inertia * rate + held[0, first] + friction * np.sign(velocity[first]) + drag * velocity[first]
    q = position[first] - (need + numbers[6]) / k - 0.5 * gap * np.sign(need)
    v = velocity[first] - 0.5 * h * rate + numbers[7] / math.sqrt(k * inertia)
    for i in range(first, end):
        after = min(i + 1, end - 1)
        moved, faster = position[after] - position[i], velocity[after] - velocity[i]
        for s in range(steps):
            part = s / steps
            motor = position[i] + part * moved - 0.5 * part * (1.0 - part) * interval * faster
            motor_rate = velocity[i] + part * faster
            stretch = motor - q
            beyond = stretch - min(max(stretch, -0.5 * gap), 0.5 * gap)
            c = damping if gap == 0.0 or beyond != 0.0 else 0.0
            against = held[0, i]
            if held[1, i] != 0.0 or held[2, i] != 0.0:
                against += held[2, i] * (1.0 - math.cos(stretch)) - held[1, i] * math.sin(stretch)
            following = _pushed(v, k * beyond + c * motor_rate - against, c + drag, friction, inertia, h)
            carried = k * beyond + c * (motor_rate - 0.5 * (v + following))
            if gap > 0.0 and carried * beyond < 0.0:  # flanks do not pull
                carried = 0.0
                following = _pushed(v, -against, drag, friction, inertia, h)
            if s == 0:
                force[i] = carried
            v = following
            q += h * v


@compiled
def _pushed(v, force, damping, friction, inertia, h):
    """Return the velocity a step later, Coulomb friction holding what it can stop."""
    share = 0.5 * damping * h / inertia
    free = v * (1.0 - share) + h / inertia * force
    if abs(free) <= h / inertia * friction:
        return 0.0
    return (free - h / inertia * friction * np.sign(free)) / (1.0 + share)
