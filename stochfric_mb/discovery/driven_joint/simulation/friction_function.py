"""Friction as a plain function of time, position and velocity: of a model, and of an augmented scenario for any engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import bearing_alone
from stochfric_mb.discovery.driven_joint.fit.friction_along import chain, resistance
from stochfric_mb.effects import Effect
from stochfric_mb.effects.contract import LOAD, WORLD
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox, SpringSlider
from stochfric_mb.scenario import Scenario

FrictionFunction = Callable[..., float]


class FrictionAt:
    """The friction that law and effects make available, instant by instant.

    Args:
        law: the law.
        effects: what is added to it.
        load: stated load [N or N m].
        contact: whether the place is a contact, whose normal force is known along the motion.
    """

    def __init__(self, law: Law, effects: Sequence[Effect], load: float, *, contact: bool = False) -> None:
        self._links = chain(law, effects, load, contact=contact)
        self._world, self._memory = np.zeros(WORLD), np.zeros(8)

    def __call__(
        self, t: float, q: float, v: float, side: float, *, load: float = 0.0, slip: float = 0.0, travelled: float = 0.0,
        temperature: float = 0.0, pressed: float = 1.0, drive: float = 0.0, pressure: float = 0.0,
    ) -> tuple[float, float]:  # fmt: skip
        """Return the friction against the motion, and what effects push along +q with whichever way it goes [N or N m].

        ``side`` is the direction of the motion, 1 or -1, ``slip`` the distance since the last reversal, and ``pressed`` the
        normal force of a contact over its stated load.
        """
        links = self._links
        against = resistance(
            links.numbers, links.calls, links.parameters, self._world, self._memory, t, q, v, load, slip, side, travelled,
            temperature, pressed, drive, pressure,
        )  # fmt: skip
        pushed = float(self._world[LOAD])
        return side * (float(against) + pushed), pushed


def joint_friction(scenario: Scenario[Any], *, smoothing_velocity: float, joint: str = "") -> FrictionFunction:
    """Return ``force(t, q, v, load=0, travelled=0, temperature=0, drive, pressure)``: friction along +q [N or N m].

    F = P - R(abs(v)) tanh(v/smoothing_velocity) with the scenario's law and effects in R, and in P what effects push with
    whichever way the joint moves: what multi-step integrators can take.
    Friction does not hold at rest then; it creeps at a part of ``smoothing_velocity``. ``load`` is what the joint transmits
    (its normal force at a pair of geoms, and at a slide without a piston, where 0 stands for the stated one), ``travelled`` the
    distance slid, ``temperature`` and ``pressure`` the measured ones and ``drive`` the driving force, for effects that ask for
    them; what these take from the drive is part of the force.

    Args:
        scenario: a scenario of a driven joint.
        smoothing_velocity: velocity at which friction has reached 76 % [m/s or rad/s], > 0.
        joint: joint of an MJCF model; empty: its first.

    Raises:
        InputError: another mechanism, or a velocity that is not positive; from ``force``, where it lacks what an effect reads.
    """
    require_number("smoothing_velocity", smoothing_velocity, above=0.0, unit="m/s or rad/s")
    mechanism = scenario.mechanism
    if isinstance(mechanism, BeltBox | SpringSlider):
        raise InputError(f"mechanism {mechanism.kind!r} is no driven joint; its augmented.toml can be run by itself")
    loads = getattr(mechanism, "friction", {"": mechanism.normal_force})
    place = joint or next(iter(loads))
    acts_in = getattr(mechanism, "effects_in", ())
    effects = scenario.effects if not acts_in or place in acts_in else ()
    moves = next((e.kind for e in effects if e.moves_load), None)
    if moves is not None:
        raise InputError(
            f"effect {moves!r} lets the load move by itself, which no friction of the joint does; give the engine a second "
            "body with the numbers of that effect, and leave the effect out of the scenario"
        )
    pair, stated_load = place in getattr(mechanism, "pairs", {}), loads[place]
    contact = pair or bearing_alone(mechanism)
    friction = FrictionAt(scenario.law, effects, stated_load, contact=contact)
    needed = {name: e.kind for e in effects for name in e.reads if name in ("drive", "pressure")}

    def force(
        t: float, q: float, v: float, load: float = 0.0, travelled: float = 0.0, temperature: float = 0.0,
        drive: float | None = None, pressure: float | None = None,
    ) -> float:  # fmt: skip
        for name, kind in needed.items():
            if {"drive": drive, "pressure": pressure}[name] is None:
                raise InputError(f"effect {kind!r} reads the {name}, which is not given; call the friction with {name}=...")
        side = 1.0 if v >= 0.0 else -1.0
        pressed = load / stated_load if pair or (contact and load > 0.0) else 1.0
        available, pushed = friction(
            t, q, v, side, load=load, travelled=travelled, temperature=temperature, pressed=pressed, drive=drive or 0.0,
            pressure=pressure or 0.0,
        )  # fmt: skip
        return pushed - side * available * math.tanh(abs(v) / smoothing_velocity)

    return force
