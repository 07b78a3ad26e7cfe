"""The columns of a trajectory with effects: friction without the loads that rode along, the normal force, the reading."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence

import numpy as np

from stochfric_mb.effects import contract as e
from stochfric_mb.effects.combine import moving, on_sensor
from stochfric_mb.effects.contract import Array, Effect
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.numerics.cubic import hermite, slope, value
from stochfric_mb.numerics.runge_kutta import RK4
from stochfric_mb.trajectory import Trajectory

SENSOR_STREAM = 0x73656E73
"""Third part of the seed of a sensor's random errors."""
FINENESS = 100.0
"""Steps per shortest period in which an effect's own unknowns are integrated."""


def without_loads(
    trajectory: Trajectory, mechanism: BeltBox, effects: Sequence[Effect], *, seed: int, sample: int
) -> Trajectory:
    """Return the trajectory with the loads taken out of the friction force, and with the normal force that acted.

    Args:
        trajectory: what an engine returned whose friction force carried the loads.
        mechanism: the belt-box.
        effects: the effects.
        seed: first part of the address of random numbers.
        sample: second part.
    """
    acting = [effect for effect in moving(effects) if hasattr(effect.functions(), "surroundings")]
    if not acting:
        return trajectory
    load, normal = surroundings_along(trajectory, mechanism, acting, seed=seed, sample=sample)
    return dataclasses.replace(
        trajectory, friction_force=trajectory.friction_force - load, normal_force=trajectory.normal_force * normal
    )


def surroundings_along(
    trajectory: Trajectory, mechanism: BeltBox, effects: Sequence[Effect], *, seed: int, sample: int
) -> tuple[Array, Array]:
    """Return the load [N] and the factor on the normal force [-] at each sample, shape (n,) each.

    Unknowns of the effects' own are integrated anew, the body moving on a cubic between samples.
    """
    effects = sorted(effects, key=lambda effect: effect.n_memory > 0)  # unknowns follow what the others do
    shortest = min(effect.shortest_time(abs(mechanism.belt_velocity)) for effect in effects)
    n_memory = sum(effect.n_memory for effect in effects)
    first = trajectory.position[:1], trajectory.velocity[:1]
    memory = np.concatenate([effect.rest(*first)[0] for effect in effects])
    world = np.zeros(e.WORLD)
    world[[e.MASS, e.STIFFNESS, e.MEAN_BELT_VELOCITY]] = mechanism.mass, mechanism.stiffness, mechanism.belt_velocity
    world[[e.SEED, e.SAMPLE]] = seed, sample
    parts = [(effect.functions().surroundings, effect.parameters(), effect.n_memory) for effect in effects]

    def surround(t: float, x: float, v: float, m: Array) -> Array:
        world[[e.TIME, e.POSITION, e.VELOCITY]] = t, x, v
        world[[e.BELT_VELOCITY, e.BELT_ACCELERATION, e.BELT_TRAVEL]] = mechanism.belt_velocity, 0.0, mechanism.belt_velocity * t
        world[[e.NORMAL_FORCE, e.LOAD]] = mechanism.normal_force, 0.0
        rates = np.zeros(n_memory)
        at = 0
        for function, p, n in parts:
            function(world, m[at : at + n], rates[at : at + n], p)
            at += n
        return rates

    times, xs, vs = trajectory.time, trajectory.position, trajectory.velocity
    load, normal = np.empty(len(times)), np.empty(len(times))
    for i, t in enumerate(times):
        if i > 0 and n_memory:
            memory = _advanced(surround, times[i - 1 : i + 1], xs[i - 1 : i + 1], vs[i - 1 : i + 1], memory, shortest)
        surround(float(t), float(xs[i]), float(vs[i]), memory)
        load[i], normal[i] = world[e.LOAD], world[e.NORMAL_FORCE] / mechanism.normal_force
    return load, normal


def _advanced(
    surround: Callable[[float, float, float, Array], Array], t: Array, x: Array, v: Array, memory: Array, shortest: float
) -> Array:
    """Return the memories at t[1] from those at t[0], by the classical Runge-Kutta formula."""
    h = float(t[1] - t[0])
    n = max(1, math.ceil(h * FINENESS / shortest))

    path = hermite(h, x[0], v[0], x[1], v[1])
    k = np.zeros((len(RK4.b), len(memory)))
    for i in range(n):
        for s, part in enumerate(RK4.c):
            theta = (i + part) / n
            stage = memory + h / n * (RK4.a[s] @ k)
            k[s] = surround(float(t[0]) + theta * h, value(path, theta), slope(path, theta) / h, stage)
        memory = memory + h / n * (RK4.b @ k)
    return memory


def as_measured(trajectory: Trajectory, effects: Sequence[Effect], *, seed: int, sample: int) -> Trajectory:
    """Return the trajectory with the sensor's reading as its position, and the truth as its ``true_position``.

    Random errors of the sensor are the same for the same (seed, sample), whatever the engine.
    """
    sensors = on_sensor(effects)
    if not sensors:
        return trajectory
    rng = np.random.default_rng([seed, sample, SENSOR_STREAM])
    reading = trajectory.position
    for effect in sensors:
        reading = effect.measure(trajectory.time, reading, rng)
    kinds = ", ".join(effect.kind for effect in sensors)
    notes = [*trajectory.attributes.get("notes", []), f"position is the sensor's reading ({kinds}); the truth: true_position"]
    attributes = trajectory.attributes | {"notes": notes}
    return dataclasses.replace(trajectory, position=reading, true_position=trajectory.position, attributes=attributes)
