"""PyBullet as an engine of stochfric_mb: the belt-box oscillator with friction as a force of its own.

Bullet's friction is off. Bullet first changes velocities and then moves: with velocities half a step behind positions
that is leap-frog, of second order. The velocity on the whole step is what half a step of the force there gives.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pybullet as bullet

from stochfric_mb.contact import Contact
from stochfric_mb.friction import Friction
from stochfric_mb.laws.substitute import elastic_substitute
from stochfric_mb.scenario import Scenario
from stochfric_mb.testing import Accuracy
from stochfric_mb.trajectory import Trajectory

ACCURACY = Accuracy(order=2, switch_order=1)
SIDE = 0.1


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    step = scenario.checked_step(dt)
    m = scenario.mechanism
    law, note = elastic_substitute(scenario.law, step, m.normal_force, m.mass)
    contact = Contact(Friction(law, scenario.process), effective_mass=m.mass, seed=seed, sample=sample, dt=step)
    times, stride = scenario.output_times(), round(scenario.output_step / step)
    rows = np.empty((len(times), 7))
    client = bullet.connect(bullet.DIRECT)
    try:
        belt, box = build(m, step, client)
        normal, v_half, began = m.normal_force, m.initial_velocity, time.perf_counter()
        for n in range((len(times) - 1) * stride + 1):
            t, x = n * step, bullet.getBasePositionAndOrientation(box, client)[0][0]
            u = m.belt_velocity * t - x

            def total(v: float, t: float = t, x: float = x, u: float = u, normal: float = normal) -> float:
                friction = contact.force(t, u, m.belt_velocity - v, normal)
                return friction + m.excitation_force(t) - m.stiffness * x - m.damping * v

            v = m.initial_velocity if n == 0 else whole_step_velocity(total, v_half, 0.5 * step / m.mass)
            (contact.start if n == 0 else contact.commit)(t, u, m.belt_velocity - v, normal)
            if n % stride == 0:
                scenario.require_sane("pybullet", t, x, step)
                friction = contact.force(t, u, m.belt_velocity - v, normal)
                rows[n // stride] = x, v, friction, normal, contact.mu_s, contact.mu_k, contact.stick
                if progress is not None:
                    progress(t)
            force = total(v)
            if n == 0:  # velocities go back by half a step
                bullet.resetBaseVelocity(box, [v - 0.5 * step * force / m.mass, 0.0, 0.0], physicsClientId=client)
            bullet.applyExternalForce(box, -1, [force, 0.0, 0.0], [0.0] * 3, bullet.WORLD_FRAME, client)
            bullet.stepSimulation(client)
            v_half = bullet.getBaseVelocity(box, client)[0][0]
            normal = sum(point[9] for point in bullet.getContactPoints(box, belt, physicsClientId=client))
    finally:
        bullet.disconnect(client)
    steps = (len(times) - 1) * stride
    attributes = {
        "engine": "pybullet", "version": str(bullet.getAPIVersion()), "hook": "external force", "dt": step, "seed": seed,
        "sample": sample, "law": law.kind, "notes": [note] if note else [], "n_steps": steps,
        "seconds_per_step": (time.perf_counter() - began) / steps,
    }  # fmt: skip
    return Trajectory(np.array(times), *np.ascontiguousarray(rows.T), attributes=attributes)


def whole_step_velocity(total: Callable[[float], float], v_half: float, factor: float) -> float:
    """v = v_half + factor total(v), by repetition: it converges within the laws' step limits."""
    v = v_half
    for _ in range(20):
        v, before = v_half + factor * total(v), v
        if abs(v - before) <= 1e-12 * abs(v):
            break
    return v


def build(m, step: float, client: int) -> tuple[int, int]:
    """The belt and the box on it, which does not turn; the surface of the belt moves, the belt itself does not."""
    bullet.setTimeStep(step, client)
    bullet.setGravity(0.0, 0.0, -m.normal_force / m.mass, client)
    sizes = ([4.0, 4.0, SIDE / 2], [SIDE / 2] * 3)
    shapes = [bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=size, physicsClientId=client) for size in sizes]
    belt = bullet.createMultiBody(0.0, shapes[0], basePosition=[0.0, 0.0, -SIDE / 2], physicsClientId=client)
    start = [m.initial_position, 0.0, SIDE / 2]
    box = bullet.createMultiBody(m.mass, shapes[1], basePosition=start, physicsClientId=client)
    bullet.changeDynamics(box, -1, lateralFriction=0.0, linearDamping=0.0, restitution=0.0, physicsClientId=client,
                          localInertiaDiagonal=[0.0] * 3, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING)  # fmt: skip
    return belt, box
