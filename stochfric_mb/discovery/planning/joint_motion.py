"""What would be measured at a driven joint as stated: a harmonic motion, and the drive that the stated model needs for it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import drive_channel
from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import inverse
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint

Array = npt.NDArray[np.float64]


def harmonic(run: PlannedRun, centre: float, turn: float = 0.0) -> tuple[Array, Array, Array]:
    """Return position, velocity and acceleration along q = centre + stroke/2 sin(2 pi (t/period + turn)), shape (n,) each.

    Args:
        run: the planned run, with its stroke and period.
        centre: middle of the stroke [m or rad].
        turn: part of the period by which it is ahead [-].
    """
    half, rate = 0.5 * (run.stroke or 0.0), 2.0 * math.pi / (run.period or 1.0)
    phase = rate * run.time + 2.0 * math.pi * turn
    away = half * np.sin(phase)
    return centre + away, half * rate * np.cos(phase), -(rate**2) * away


def measured_at_joint(run: PlannedRun, joint: PrismaticJoint | HingePendulum, friction: float, seed: int) -> Run:
    """Return the record of a slide or a hinge.

    Args:
        run: the planned run, its motion and noise stated.
        joint: the mechanism.
        friction: Coulomb friction [N or N m].
        seed: of the noise.
    """
    generator = np.random.default_rng(seed)
    q, velocity, acceleration = harmonic(run, joint.initial_position)
    drive = joint.damping * velocity + joint.offset + friction * np.sign(velocity)
    if isinstance(joint, PrismaticJoint):
        drive = drive + joint.mass * acceleration
    else:
        inertia = joint.mass * joint.length**2 + joint.inertia
        drive = drive + inertia * acceleration + joint.mass * joint.gravity * joint.length * np.sin(q)
    drive = drive + (run.force_noise or 0.0) * generator.standard_normal(len(q))
    name, factor = drive_channel(joint)
    return run.record({"position": q + (run.noise or 0.0) * generator.standard_normal(len(q)), name: drive / factor})


def measured_in_model(run: PlannedRun, source: Any, place: str, mu_k: float, seed: int) -> Run:
    """Return the record of a user's MuJoCo model: hinges, or slides, move alike, each a quarter of a period ahead of the last.

    Args:
        run: the planned run, its motion and noise stated.
        source: the model, as `source_of` gives it.
        place: the joint that is planned.
        mu_k: Coulomb coefficient: friction is mu_k times the load of each joint [-].
        seed: of the noise.

    Raises:
        InputError: the motion leaves a joint's range.
    """
    mechanism, model, time = source.mechanism, source.model, run.time
    own = source.names.index(place)
    moved = [n for i, n in enumerate(source.names) if _is_measured(mechanism, n) and model.jnt_type[i] == model.jnt_type[own]]
    moved.sort(key=lambda n: n != place)
    motions = [
        _in_range(run, model, i, moved.index(n)) if n in moved else _rest(mechanism, model, i, n, len(time))
        for i, n in enumerate(source.names)
    ]
    q, v, a = (np.stack(rows, axis=1) for rows in zip(*motions, strict=True))
    needed, generator = inverse(source.mujoco, model, (q, v, a)), np.random.default_rng(seed)
    channels: dict[str, Array] = {}
    for i, name in enumerate(source.names):
        # a joint of the other kind rests: its sensor is not the planned one's, and noise in the wrong unit would say nothing
        noise = (run.noise or 0.0, run.force_noise or 0.0) if name in moved else (0.0, 0.0)
        if isinstance(column := mechanism.positions[name], str):
            channels[column] = q[:, i] + noise[0] * generator.standard_normal(len(time))
        if (drive := mechanism.drives.get(name)) is not None:
            force = needed[:, i] + mechanism.damping.get(name, 0.0) * v[:, i] + mechanism.offset.get(name, 0.0)
            force = force + mu_k * mechanism.friction.get(name, 0.0) * np.sign(v[:, i])
            first, *others = drive.columns
            channels[first] = (force + noise[1] * generator.standard_normal(len(time))) / drive.gain
            channels |= {other: np.ones(len(time)) for other in others}
    return run.record(channels)


def require_plannable(mechanism: Mjcf, place: str) -> None:
    """Return if the motion of a model can be planned: every joint that moves is driven by itself.

    Raises:
        InputError: friction is sought in a tendon or pair, a tendon drives, or a joint moves that nothing drives.
    """
    require_name("joint (of mechanism.friction)", place, mechanism.friction)
    if place not in mechanism.positions:
        raise InputError(
            f"{place!r} is a tendon or a pair: only friction in joints can be planned; plan one of its joints by itself, as a "
            "prismatic_joint or hinge_pendulum"
        )
    passive = [n for n in mechanism.positions if _is_measured(mechanism, n) and n not in mechanism.drives]
    if passive:
        raise InputError(
            f"joint {passive[0]!r} is not driven: its motion follows from that of the others and cannot be planned; name its "
            "drive in mechanism.drives, or give the position at which it stays"
        )
    if driving := [name for name in mechanism.tendons if name in mechanism.drives]:
        raise InputError(
            f"tendon {driving[0]!r} drives the joints: plan one of them by itself, as a prismatic_joint or hinge_pendulum"
        )


def _is_measured(mechanism: Mjcf, joint: str) -> bool:
    """Return whether a joint moves; of one that stays the scenario has the number."""
    return isinstance(mechanism.positions[joint], str)


def _rest(mechanism: Mjcf, model: Any, number: int, name: str, n: int) -> tuple[Array, Array, Array]:
    given = mechanism.positions[name]
    return np.full(n, model.qpos0[number] if isinstance(given, str) else given), np.zeros(n), np.zeros(n)


def _in_range(run: PlannedRun, model: Any, number: int, turn: int) -> tuple[Array, Array, Array]:
    low, high = (float(x) for x in model.jnt_range[number])
    limited, stroke = bool(model.jnt_limited[number]), run.stroke or 0.0
    if limited and stroke > high - low:
        raise InputError(f"{run.name}: stroke = {stroke:g} is more than the range of a joint, {low:g} to {high:g}; plan less")
    return harmonic(run, 0.5 * (low + high) if limited else float(model.qpos0[number]), 0.25 * turn)
