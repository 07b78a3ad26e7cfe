"""PyBullet as an engine of stochfric_mb: the belt-box oscillator, its friction a force of its own.

Bullet's friction is off. Bullet changes velocities first and then moves, so velocities half a step behind positions make
it leap-frog, of second order; the velocity on the whole step is what half a step of the forces there gives.
"""

import time
from importlib.metadata import version

import numpy as np
import pybullet as bullet

from stochfric_mb.contact import Contact
from stochfric_mb.errors import StabilityError
from stochfric_mb.friction import Friction
from stochfric_mb.laws.substitute import elastic_substitute
from stochfric_mb.testing import Accuracy
from stochfric_mb.trajectory import Trajectory

ACCURACY = Accuracy(order=2, switch_order=1, factor=5)
SIDE = 0.1


def simulate(scenario, *, seed=0, sample=0, dt=None, progress=None):
    step = scenario.checked_step(dt)
    m = scenario.mechanism
    longest = 2.0 * (m.mass / m.stiffness) ** 0.5
    if step > longest:  # Bullet caps velocities, so that a spring which leap-frog cannot follow looks sane
        raise StabilityError(f"dt = {step:g} s is beyond 2 sqrt(m/k) = {longest:.3g} s of the spring")
    law, note = elastic_substitute(scenario.law, step, m.normal_force, m.mass)
    friction = Friction(law, scenario.process)
    contact = Contact(friction, effective_mass=m.mass, seed=seed, sample=sample, dt=step)
    began = time.perf_counter()
    client = bullet.connect(bullet.DIRECT)
    try:
        rows = integrate(scenario, step, contact, client, progress)
    finally:
        bullet.disconnect(client)
    n_steps = (scenario.n_outputs - 1) * round(scenario.output_step / step)
    attributes = {"engine": "pybullet", "version": version("pybullet"), "hook": "external force", "law": law.kind}
    attributes |= {"dt": step, "seed": seed, "sample": sample, "notes": [note] if note else [], "n_steps": n_steps}
    attributes["seconds_per_step"] = (time.perf_counter() - began) / n_steps
    return Trajectory(scenario.output_times(), *np.ascontiguousarray(rows.T), attributes=attributes)


def integrate(scenario, step, contact, client, progress):
    m, v_b = scenario.mechanism, scenario.mechanism.belt_velocity
    belt, box = build(m, step, client)
    stride = round(scenario.output_step / step)
    rows = np.empty((scenario.n_outputs, 7))
    v, normal = m.initial_velocity, m.normal_force
    contact.start(0.0, -m.initial_position, v_b - v, normal)
    for n in range((scenario.n_outputs - 1) * stride + 1):
        t, x = n * step, bullet.getBasePositionAndOrientation(box, client)[0][0]
        u = v_b * t - x
        if n > 0:
            v_half = v = bullet.getBaseVelocity(box, client)[0][0]
            for _ in range(20):  # v = v_half + step/2 force(v)/m: the law's force may be asked as often as one likes
                f = contact.force(t, u, v_b - v, normal)
                before, v = v, v_half + 0.5 * step * (f + other_forces(m, t, x, v)) / m.mass
                if abs(v - before) <= 1e-12 * abs(v):
                    break
            contact.commit(t, u, v_b - v, normal)  # the step is accepted: once, and nowhere else
        f = contact.force(t, u, v_b - v, normal)
        if n % stride == 0:
            scenario.require_sane("pybullet", t, x, step)
            rows[n // stride] = x, v, f, normal, contact.mu_s, contact.mu_k, contact.stick
            if progress is not None:
                progress(t)
        total = f + other_forces(m, t, x, v)
        if n == 0:
            bullet.resetBaseVelocity(box, [v - 0.5 * step * total / m.mass, 0.0, 0.0], physicsClientId=client)
        bullet.applyExternalForce(box, -1, [total, 0.0, 0.0], [0.0] * 3, bullet.WORLD_FRAME, client)
        bullet.stepSimulation(client)
        normal = sum(point[9] for point in bullet.getContactPoints(box, belt, physicsClientId=client))
    return rows


def other_forces(m, t, x, v):
    return m.excitation_force(t) - m.stiffness * x - m.damping * v


def build(m, step, client):
    bullet.setTimeStep(step, client)
    bullet.setGravity(0.0, 0.0, -m.normal_force / m.mass, client)
    bullet.setPhysicsEngineParameter(contactSlop=0.0, physicsClientId=client)  # otherwise the box begins by falling
    plane = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=client)
    cube = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[SIDE / 2] * 3, physicsClientId=client)
    belt = bullet.createMultiBody(0.0, plane, physicsClientId=client)
    box = bullet.createMultiBody(m.mass, cube, basePosition=[m.initial_position, 0.0, SIDE / 2], physicsClientId=client)
    settings = {"lateralFriction": 0.0, "linearDamping": 0.0, "restitution": 0.0, "localInertiaDiagonal": [0.0] * 3}
    awake = bullet.ACTIVATION_STATE_DISABLE_SLEEPING
    bullet.changeDynamics(box, -1, **settings, activationState=awake, physicsClientId=client)  # no inertia: cannot turn
    return belt, box
