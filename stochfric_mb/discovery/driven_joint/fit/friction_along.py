"""The friction of a joint along a measured motion, from the law and the effects' own functions.

Friction is mu N along the motion's opposite, N being the stated load of the joint. Where an effect depends on load, the
contact carries that effect's reference load plus the load that the joint transmits; the reference load is fitted.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportCallIssue=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.effects import Effect
from stochfric_mb.effects import contract as e
from stochfric_mb.effects.abi import call_effect, native_effect
from stochfric_mb.effects.traits import READS_DRIVE, READS_LOAD
from stochfric_mb.laws import Law

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Chain:
    """Law and effects in the form that compiled code takes."""

    numbers: Array
    """mu_s, mu_k, stated load, reference load of a joint whose friction depends on what it transmits, or 0; shape (4,)."""
    calls: npt.NDArray[np.int64]
    """Address of ``surroundings`` and of ``friction`` (0: none) and offset of the parameters, shape (n_effects, 3)."""
    parameters: Array
    """Parameters of all effects, one after the other."""


@functools.lru_cache(maxsize=256)
def chain(law: Law, effects: tuple[Effect, ...], load: float, *, contact: bool = False) -> Chain:
    """Return law and effects, in the order in which effects act; made once for all runs of a record.

    Args:
        law: the law.
        effects: what is added to it.
        load: stated load of the joint [N or N m].
        contact: whether the place is a contact, whose normal force is known along the motion.
    """
    ordered = sorted((x for x in effects if x.group != "sensor"), key=lambda x: x.order)
    calls = np.zeros((len(ordered), 3), dtype=np.int64)
    parameters: list[float] = []
    for row, effect in zip(calls, ordered, strict=True):
        native = native_effect(type(effect))
        row[:] = native.surroundings, native.friction, len(parameters)
        parameters += list(effect.parameters())
    reference = 0.0 if contact else _reference(ordered)
    return Chain(np.array([law.mu_s, law.mu_k, load, reference]), calls, np.array([*parameters, 0.0]))


def _reference(effects: Sequence[Effect]) -> float:
    """Return the reference load of the first of effects that reads the load, 0 if none does [N or N m]."""
    return next((float(x.reference_load) for x in effects if READS_LOAD in x.traits), 0.0)  # type: ignore[attr-defined]


def reads_drive(effects: Sequence[Effect]) -> bool:
    """Return whether forces in a joint depend on the load that it transmits, or on its drive."""
    return _reference(sorted(effects, key=lambda x: x.order)) > 0.0 or any(READS_DRIVE in x.traits for x in effects)


def friction_along(balance: ForceBalance, law: Law, effects: Sequence[Effect], load: float) -> Array:
    """Return the friction against the motion, seen through the windows of a balance [N or N m], shape (n_centres,).

    Args:
        balance: the motion.
        law: its mu_k holds while the joint slides.
        effects: what is added to it.
        load: stated load [N or N m].
    """
    moving = [x for x in effects if x.moves_load]
    key = (law, tuple(x for x in effects if not x.moves_load), load)
    if not moving or key not in balance.at_motor:
        seen = _friction_of_one_body(balance, *key)
        if moving:  # a fit moves the numbers of the load one by one, and the rest of friction stays
            balance.at_motor.clear()
            balance.at_motor[key] = seen
    else:
        seen = balance.at_motor[key]
    carried = [own for x in moving if (own := balance.load_force(x)) is not None]
    return seen + np.sum(carried, axis=0) if carried else seen


def _friction_of_one_body(balance: ForceBalance, law: Law, effects: tuple[Effect, ...], load: float) -> Array:
    """Return the friction of a joint whose load follows the motor; arguments as of `friction_along`."""
    links = chain(law, effects, load, contact=balance.normal_force is not None)
    *motion, normal_force, drive, pressure = balance.signals
    pressed = np.ones(len(normal_force)) if balance.normal_force is None else normal_force / load
    force = np.empty(len(pressed))
    along(links.numbers, links.calls, links.parameters, *motion, pressed, drive, pressure, force)
    return balance.window.means @ force


@compiled
def along(
    numbers, calls, parameters, time, position, velocity, load, slip, travelled, temperature, pressed, drive, pressure, force
):
    """Fill ``force`` with the friction against the motion at each sample."""
    world = np.zeros(e.WORLD)
    memory = np.zeros(8)
    for i in range(len(time)):
        force[i] = resistance(
            numbers, calls, parameters, world, memory, time[i], position[i], velocity[i], load[i], slip[i],
            np.sign(velocity[i]), travelled[i], temperature[i], pressed[i], drive[i], pressure[i],
        )  # fmt: skip


@compiled
def resistance(
    numbers, calls, parameters, world, memory, time, position, velocity, load, slip, side, travelled, temperature, pressed,
    drive, pressure,
):  # fmt: skip
    """Return the force against the motion at one instant.

    ``side`` is the direction of the motion, 1, -1 or 0, ``pressed`` the normal force of a contact over its stated load (1 for
    a joint), ``drive`` the driving force as stated and ``pressure`` that on a piston.
    """
    world[:] = 0.0
    world[e.DRIVE], world[e.PRESSURE], world[e.TEMPERATURE] = drive, pressure, temperature
    world[e.TIME], world[e.POSITION], world[e.VELOCITY] = time, position, velocity
    base = numbers[2] * pressed
    around = numbers[3] + load if numbers[3] > 0.0 else base
    world[e.NORMAL_FORCE] = around
    p = parameters.ctypes.data
    for k in range(len(calls)):
        if calls[k, 0] != 0:
            call_effect(calls[k, 0], world.ctypes.data, memory.ctypes.data, memory.ctypes.data, p + 8 * calls[k, 2])
    ripple = world[e.NORMAL_FORCE] / around if around > 0.0 else 1.0
    # v_rel is counter-surface minus body: the counter-surface rests
    world[e.DIRECTION], world[e.SPEED], world[e.BELT_POSITION] = -side, abs(velocity), -position
    world[e.SLIP], world[e.TRAVELLED] = slip, travelled
    world[e.MU_S], world[e.MU_K] = numbers[0], numbers[1]
    for k in range(len(calls)):
        if calls[k, 1] != 0:
            call_effect(calls[k, 1], world.ctypes.data, memory.ctypes.data, memory.ctypes.data, p + 8 * calls[k, 2])
    return side * (world[e.MU_K] * base * ripple + world[e.VISCOUS_FORCE]) - world[e.LOAD]
