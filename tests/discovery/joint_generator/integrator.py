"""Time stepping of driven joints: midpoint steps, friction by an elastoplastic bristle with return mapping.

The bristle is as stiff as 1000 rad/s, micrometres for usual joints: what sticks is held by force, and the friction of what
slides is its limit. Dupont et al., IEEE Trans. Autom. Control 47 (2002) 787, doi 10.1109/TAC.2002.1000274.
"""

from math import cos, exp, sin, sqrt

import numba
import numpy as np

from .plant import (
    AREA,
    AREA_AT,
    ARM,
    BACKWARD,
    BASE_SPEED,
    BEND,
    CHAIN,
    COUPLING,
    DAMPING,
    DEAD_ZONE,
    DRIVE_FROM,
    DRIVE_POWER,
    DRIVE_SHARE,
    DRIVE_SPEED,
    FACTOR_AT,
    FACTOR_OF_TIME,
    FACTOR_ON_SPEED,
    FORCE_AT,
    FORCE_OF_TIME,
    FORWARD,
    GAIN_AT,
    GAIN_OF_TIME,
    GRAVITY,
    GRAVITY_2,
    HALF_GAP,
    HOLD_SHARE,
    INERTIA,
    INERTIA_2,
    KIND,
    LIMIT_FORWARD,
    LINK_CUBIC,
    LINK_DAMPING,
    LINK_STIFFNESS,
    MASS_OF_TIME,
    MEMORY,
    MEMORY_DISTANCE,
    MEMORY_TIME,
    OFFSET,
    ONE_WAY_AT,
    OTHER_PLACE,
    OTHER_SPEED,
    PLACE,
    PLAY,
    PRESSURE,
    PRESSURE_SHARE,
    QUADRATIC,
    RATIONAL,
    RELAXING_STIFFNESS,
    RELAXING_TIME,
    ROTOR,
    ROTOR_2,
    SATURATION,
    SOFT_FORCE,
    SOFT_LENGTH,
    SPEED_LAG,
    SPEED_TIMES_PLACE,
    TIME_SPACING,
    WEAR,
    WEAR_DISTANCE,
    Array,
    Plant,
)

LARGEST_STEP = 1e-4
BRISTLE = 1000.0  # rad/s
_ROUNDS = 4  # of the implicit midpoint: the bristle's h w = 0.1 leaves 1e-4 of a step's change


@numba.njit(cache=True, error_model="numpy")
def _at(table, row, share):
    """A table's value at a share of its length, held beyond its ends."""
    last = table.shape[1] - 1
    where = min(max(share, 0.0), 1.0) * last
    i = min(int(where), last - 1)
    return table[row, i] + (where - i) * (table[row, i + 1] - table[row, i])


@numba.njit(cache=True, error_model="numpy")
def _limit(d, speed, v, q, t_share, drive, hold, since, other, extra, coulomb, reach, by_speed, by_place, by_time, by_stroke):
    """Friction of coordinate d while it slides [N or N m]."""
    if d != int(extra[PLACE]):
        return coulomb[d]
    level = coulomb[d] * _at(by_place, FACTOR_AT, 0.5 + 0.5 * q / reach[1]) * _at(by_time, FACTOR_OF_TIME, t_share)
    level *= by_stroke[int(since[2]) % by_stroke.shape[0]]
    if extra[MEMORY] != 0.0:
        gone = since[0] / extra[MEMORY_DISTANCE] + since[1] / extra[MEMORY_TIME]
        level *= 1.0 + extra[MEMORY] * (1.0 / (1.0 + gone) if extra[RATIONAL] > 0.0 else exp(-gone))
    level *= 1.0 + extra[WEAR] * (1.0 - exp(-since[3] / extra[WEAR_DISTANCE]))
    carried = max(abs(drive) - extra[DRIVE_FROM], 0.0)
    level += extra[DRIVE_SHARE] * carried ** extra[DRIVE_POWER] + extra[HOLD_SHARE] * abs(hold)
    level += extra[DRIVE_SPEED] * abs(drive) * speed
    level += extra[PRESSURE_SHARE] * _at(by_time, PRESSURE, t_share)
    level += _at(by_speed, FORWARD if v >= 0.0 else BACKWARD, speed / reach[0]) * _at(by_time, FACTOR_ON_SPEED, t_share)
    if v >= 0.0:
        level += _at(by_place, ONE_WAY_AT, 0.5 + 0.5 * q / reach[1])
    level *= 1.0 + extra[OTHER_SPEED] * abs(other)
    return max(level + extra[SPEED_TIMES_PLACE] * speed * q, 0.0)


@numba.njit(cache=True, error_model="numpy")
def _applied(drive, v, q, t_share, extra, reach, by_place, by_time):
    """What the motor gives for a commanded force."""
    size = max(abs(drive) - extra[DEAD_ZONE], 0.0)
    size *= _at(by_place, GAIN_AT, 0.5 + 0.5 * q / reach[1]) * _at(by_time, GAIN_OF_TIME, t_share)
    if extra[BEND] > 0.0:
        size /= sqrt(sqrt(1.0 + (size / extra[BEND]) ** 2))
    if abs(v) > extra[BASE_SPEED]:
        size *= extra[BASE_SPEED] / abs(v)
    size = min(size, extra[SATURATION])
    return min(size, extra[LIMIT_FORWARD]) if drive >= 0.0 else -size


@numba.njit(cache=True, error_model="numpy")
def _accelerations(body, q, v, force):
    """Accelerations of both coordinates under generalised forces that hold everything but inertia, gravity and links."""
    a = np.zeros(2)
    if body[KIND] == ARM:
        c2, s2 = cos(q[1]), sin(q[1])
        m11 = body[INERTIA] + body[INERTIA_2] + 2.0 * body[COUPLING] * c2 + body[ROTOR]
        m12 = body[INERTIA_2] + body[COUPLING] * c2
        m22 = body[INERTIA_2] + body[ROTOR_2]
        f0 = force[0] + body[COUPLING] * s2 * (2.0 * v[0] * v[1] + v[1] * v[1])
        f1 = force[1] - body[COUPLING] * s2 * v[0] * v[0]
        f0 -= body[GRAVITY] * sin(q[0]) + body[GRAVITY_2] * sin(q[0] + q[1])
        f1 -= body[GRAVITY_2] * sin(q[0] + q[1])
        determinant = m11 * m22 - m12 * m12
        a[0] = (m22 * f0 - m12 * f1) / determinant
        a[1] = (m11 * f1 - m12 * f0) / determinant
    elif body[KIND] == CHAIN:
        stretch = q[0] - q[1]
        beyond = stretch - min(max(stretch, -body[HALF_GAP]), body[HALF_GAP])
        touching = body[HALF_GAP] == 0.0 or beyond != 0.0
        link = (
            body[LINK_STIFFNESS] * beyond
            + body[LINK_CUBIC] * beyond**3
            + (body[LINK_DAMPING] * (v[0] - v[1]) if touching else 0.0)
        )
        a[0] = (force[0] - link) / body[ROTOR]
        a[1] = (force[1] + link - body[GRAVITY] * sin(q[1])) / body[INERTIA]
    else:
        a[0] = (force[0] - body[GRAVITY] * sin(q[0])) / body[INERTIA]
    return a


@numba.njit(cache=True, error_model="numpy")
def _run(body, extra, coulomb, reach, by_speed, by_place, by_time, by_stroke, gains, wanted, start, n_before, stride, h):  # noqa: PLR0912
    """Rows of (q, q_2, v, v_2, u, u_2, friction, drive given) at every control instant; the first n_before are left out."""
    n = wanted.shape[0]
    out = np.zeros((n - n_before, 8))
    two = body[KIND] != 0.0
    place = int(extra[PLACE])
    span = (by_time.shape[1] - 1) * TIME_SPACING
    stiffness = np.empty(2)
    stiffness[0] = (body[ROTOR] if body[KIND] == CHAIN else body[INERTIA]) * BRISTLE**2
    stiffness[1] = (body[INERTIA] if body[KIND] == CHAIN else max(body[INERTIA_2], 1e-9)) * BRISTLE**2
    q, v, z, f = start.copy(), np.zeros(2), np.zeros(2), np.zeros(2)
    soft, slow, pull = 0.0, 0.0, 0.0
    # distance and time since the last reversal where the effect sits, number of reversals, distance since the record began
    since = np.zeros(4)
    sent = np.zeros(2)  # commands as an actuator with play passes them on
    u, given = np.zeros(2), np.zeros(2)
    direction = 0.0
    for i in range(n):
        for d in range(2):
            raw = gains[d, 0] * (wanted[i, d] - q[d]) + gains[d, 1] * (gains[d, 2] * wanted[i, 2 + d] - v[d]) + wanted[i, 4 + d]
            u[d] = min(max(raw, -gains[d, 3]), gains[d, 3])
        if i >= n_before:
            row = out[i - n_before]
            row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7] = (
                q[0], q[1], v[0], v[1], u[0], u[1], f[place], given[0],
            )  # fmt: skip
        for s in range(stride):
            t_share = max((i - n_before) * stride + s, 0) * h / span
            q_mid = q + 0.5 * h * v
            v_next = v.copy()
            z_next, soft_next, pull_next = z.copy(), soft, pull
            for d in range(2):
                command, play = gains[d, 4] * u[d], extra[PLAY] if d == place else 0.0
                sent[d] = min(max(sent[d], command - play), command + play)
            for _ in range(_ROUNDS):
                v_mid = 0.5 * (v + v_next)
                force = np.zeros(2)
                for d in range(2):
                    drive = gains[d, 4] * u[d]
                    if d == place or (body[KIND] == CHAIN and d == 0):
                        given[d] = _applied(sent[d], v_mid[d], q_mid[d], t_share, extra, reach, by_place, by_time)
                    else:
                        given[d] = drive if body[KIND] == ARM else 0.0  # the load of a chain has no motor
                    if d == 1 and not two:
                        continue
                    hold = body[GRAVITY] * sin(q_mid[0]) if body[KIND] != ARM else body[GRAVITY_2] * sin(q_mid[0] + q_mid[1])
                    speed = slow if extra[SPEED_LAG] > 0.0 and d == place else abs(v_mid[d])
                    limit = _limit(
                        d, speed, v_mid[d], q_mid[d], t_share, drive, hold, since, v_mid[1 - d],
                        extra, coulomb, reach, by_speed, by_place, by_time, by_stroke,
                    )  # fmt: skip
                    trial = stiffness[d] * (z[d] + h * v_mid[d]) + stiffness[d] / BRISTLE * v_mid[d]
                    f[d] = min(max(trial, -limit), limit)
                    z_next[d] = min(max(z[d] + h * v_mid[d], -limit / stiffness[d]), limit / stiffness[d])
                    force[d] = given[d] - f[d]
                    if d == place:
                        if extra[SOFT_LENGTH] > 0.0:
                            soft_next = min(max(soft + h * v_mid[d], -extra[SOFT_LENGTH]), extra[SOFT_LENGTH])
                            force[d] -= extra[SOFT_FORCE] * soft_next / extra[SOFT_LENGTH]
                        if extra[RELAXING_TIME] > 0.0:
                            share = 0.5 * h / extra[RELAXING_TIME]
                            grown = h * extra[RELAXING_STIFFNESS] * v_mid[d]
                            pull_next = (pull * (1.0 - share) + grown) / (1.0 + share)
                            force[d] -= 0.5 * (pull + pull_next)
                        force[d] -= extra[OTHER_PLACE] * q_mid[1 - d]
                        force[d] -= _at(by_place, FORCE_AT, 0.5 + 0.5 * q_mid[d] / reach[1])
                        force[d] += _at(by_time, FORCE_OF_TIME, t_share) - extra[QUADRATIC] * v_mid[d] * abs(v_mid[d])
                    if d == 0:
                        area = body[AREA] * _at(by_place, AREA_AT, 0.5 + 0.5 * q_mid[d] / reach[1])
                        force[d] -= body[DAMPING] * v_mid[d] + body[OFFSET] + area * _at(by_time, PRESSURE, t_share)
                if not two:
                    force[0] /= _at(by_time, MASS_OF_TIME, t_share)
                v_next = v + h * _accelerations(body, q_mid, v_mid, force)
            moved = 0.5 * h * (v[place] + v_next[place])
            q = q_mid + 0.5 * h * v_next
            v, z, soft, pull = v_next, z_next, soft_next, pull_next
            if extra[SPEED_LAG] > 0.0:
                slow += (abs(v[place]) - slow) * h / extra[SPEED_LAG]
            now = 1.0 if v[place] > 1e-3 * reach[0] else (-1.0 if v[place] < -1e-3 * reach[0] else 0.0)
            since[0] += abs(moved)
            since[1] += h
            since[3] += abs(moved) if i >= n_before else 0.0
            if now not in (0.0, direction):
                direction = now
                since[0], since[1] = 0.0, 0.0
                since[2] += 1.0
    return out


def simulate(plant: Plant, gains: Array, wanted: Array, start: Array, n_before: int, interval: float) -> Array:
    """Run a plant under control.

    Args:
        plant: what moves.
        gains: position gain, velocity gain, share of the wanted velocity that is fed forward, limit of the output and force per
            unit of output, shape (2, 5).
        wanted: wanted positions, velocities and outputs that are added, at each control instant, shape (n, 6).
        start: coordinates at the start, shape (2,) [m or rad].
        n_before: control instants before the record begins.
        interval: time between control instants [s]; outputs are held.

    Returns:
        Rows of q, q_2, v, v_2, output, output_2, friction where the effect sits, force given by the first motor.
    """
    stride = int(np.ceil(interval / LARGEST_STEP - 1e-9))
    return _run(*plant.packed(), gains, wanted, np.asarray(start, dtype=np.float64), n_before, stride, interval / stride)
