"""Confirmation by forward simulation: the joint with its friction, and the controller that was in the loop, run again."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled
from stochfric_mb.discovery.driven_joint.balance.force_balance import known_temperature
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import channel, drive_channel, measured_load, position_of
from stochfric_mb.discovery.driven_joint.fit.friction_along import chain, resistance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import in_si
from stochfric_mb.effects import contract as e
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, PrismaticJoint

Array = npt.NDArray[np.float64]

FINER = 10
"""Steps of the simulation in one sample; the controller acts once a sample, as the real one did."""
FIRST = 15
"""Samples from which the first position is taken."""


class CascadeLoop:
    """The controller of a slide in one run.

    Raises:
        InputError: the run lacks a covariate that the controller reads, or what it gave.
    """

    def __init__(self, run: Run, joint: PrismaticJoint, controller: Cascade) -> None:
        for name in filter(None, (controller.reference, controller.added)):
            if name not in run.covariates:
                given = ", ".join(run.covariates)
                raise InputError(f"run {run.name!r} has no covariate {name!r} for the controller (it has: {given})")
        added = run.covariates[controller.added] if controller.added else np.zeros(len(run.time))
        self._controller = controller
        self.reference = np.ascontiguousarray(in_si(run, controller.reference, "position"))
        """Reference position [m], shape (n,)."""
        self.added = np.ascontiguousarray(added)
        """What is added to its output [V or N], shape (n,)."""
        self.recorded = controller_output(run, joint)
        """What it gave, shape (n,)."""

    def output(self, reference: Array, position: Array, velocity: Array) -> Array:
        """Return what it gives at all samples, shape (n,)."""
        loop = self._controller
        u = loop.velocity_gain * (loop.position_gain * (reference - position) - velocity) + self.added
        return np.clip(u, -loop.limit, loop.limit)


def closed_loop(
    run: Run, joint: PrismaticJoint, model: JointModel, controller: Cascade, before: float = 0.0
) -> tuple[Array, Array]:
    """Return output [V or N] and position [m] that the joint and its controller give for the reference of a run, shape (n,).

    Load and pressure are those that were measured, where they were: what presses on a seal is no part of what is simulated.
    Semi-implicit Euler with friction that holds: where the friction available can stop the mass within a step, it does.

    Args:
        run: holds the reference position as a covariate, and the measured output for the state at its start.
        joint: mass, gain and offset are those of ``model`` where it has corrected them.
        model: friction and corrections.
        controller: the cascade.
        before: distance slid in pieces of the same record that came before [m].

    Raises:
        InputError: the run has no such reference.
    """
    given = CascadeLoop(run, joint, controller)
    q = position_of(run)
    temperature = known_temperature(run)
    pressure = run.channels.get("pressure", np.zeros(len(q)))
    load = measured_load(run, joint)
    assert load is not None
    names = ("mass", "damping", "offset", "force_gain", "drive_factor", "piston_area")
    value = {name: model.nuisances.get(name, float(getattr(joint, name))) for name in names}
    links = chain(model.law, model.effects_in(run.name), model.load, contact=model.contact)
    gain = value["drive_factor"] * (value["force_gain"] if joint.force_gain else 1.0)
    plant = np.array([value["mass"], value["damping"], gain])
    pushed = value["offset"] + value["piston_area"] * pressure
    loop = np.array([controller.position_gain, controller.velocity_gain, controller.limit])
    start = float(np.polyfit(np.arange(FIRST), q[:FIRST], 2)[2])
    # the voltage that the controller gave tells the velocity that it saw
    u = given.recorded[0]
    rate = controller.position_gain * (given.reference[0] - start) - (u - given.added[0]) / controller.velocity_gain
    if abs(u) >= controller.limit:
        rate = float(np.polyfit(np.arange(FIRST), q[:FIRST], 1)[0]) / run.sample_interval
    voltage, position = np.empty(len(q)), np.empty(len(q))
    pressed = np.abs(load) / model.load if model.contact else np.ones(len(q))
    _march(
        links.numbers, links.calls, links.parameters, plant, loop, given.reference, given.added, float(run.time[0]),
        run.sample_interval, start, rate, before, temperature, pressure, np.abs(load), pressed, pushed, voltage, position,
    )  # fmt: skip
    return voltage, position


def controller_output(run: Run, joint: PrismaticJoint) -> Array:
    """Return what the controller gave, shape (n,): a voltage [V] where the joint has a force gain, else the force [N]."""
    return channel(run, drive_channel(joint)[0])


@compiled
def _march(
    numbers, calls, parameters, plant, loop, reference, added, start, interval, q, v, travelled, temperature, pressure, load,
    pressed, pushed, voltage, position,
):  # fmt: skip
    world = np.zeros(e.WORLD)
    memory = np.zeros(8)
    mass, damping, gain = plant[0], plant[1], plant[2]
    h = interval / FINER
    turned = q
    before = np.sign(v)
    for i in range(len(reference)):
        u = loop[1] * (loop[0] * (reference[i] - q) - v) + added[i]
        u = min(max(u, -loop[2]), loop[2])
        voltage[i], position[i] = u, q
        for k in range(FINER):
            t = start + i * interval + k * h
            known = gain * u - pushed[i] - damping * v
            side = (
                np.sign(v) if v != 0.0 else np.sign(known + world[e.LOAD])
            )  # at rest the other forces are those of a moment ago
            if side not in (0.0, before):
                turned, before = q, side
            friction = resistance(
                numbers, calls, parameters, world, memory, t, q, v, load[i], abs(q - turned), side, travelled, temperature[i],
                pressed[i], gain * u, pressure[i],
            )  # fmt: skip
            v += h * (known - friction) / mass
            if v * side < 0.0:  # friction stops a mass, it does not turn it
                v = 0.0
            q += h * v
            travelled += h * abs(v)
