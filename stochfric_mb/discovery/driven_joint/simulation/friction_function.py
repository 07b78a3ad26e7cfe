"""The friction of an augmented scenario as a plain function of time, position and velocity, for any engine."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.fit.friction_along import chain, resistance
from stochfric_mb.effects.contract import LOAD, WORLD
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.mechanisms import BeltBox, SpringSlider
from stochfric_mb.scenario import Scenario

FrictionFunction = Callable[..., float]


def joint_friction(scenario: Scenario[Any], *, smoothing_velocity: float, joint: str = "") -> FrictionFunction:
    """Return ``force(t, q, v, load=0.0, travelled=0.0, temperature=0.0)``: the friction on a joint along +q [N or N m].

    F = P - R(abs(v)) tanh(v/smoothing_velocity) with the scenario's law and effects in R, and in P what effects push with
    whichever way the joint moves: what multi-step integrators can take.
    Friction does not hold at rest then; it creeps at a part of ``smoothing_velocity``. ``load`` is what the joint transmits
    (at a pair of geoms: its normal force), ``travelled`` the distance slid and ``temperature`` the measured one, for effects
    that ask for them.

    Args:
        scenario: a scenario of a driven joint.
        smoothing_velocity: velocity at which friction has reached 76 % [m/s or rad/s], > 0.
        joint: joint of an MJCF model; empty: its first.

    Raises:
        InputError: another mechanism, or a velocity that is not positive.
    """
    require_number("smoothing_velocity", smoothing_velocity, above=0.0, unit="m/s or rad/s")
    mechanism = scenario.mechanism
    if isinstance(mechanism, BeltBox | SpringSlider):
        raise InputError(f"mechanism {mechanism.kind!r} is no driven joint; its augmented.toml can be run by itself")
    loads = getattr(mechanism, "friction", {"": mechanism.normal_force})
    place = joint or next(iter(loads))
    acts_in = getattr(mechanism, "effects_in", ())
    effects = scenario.effects if not acts_in or place in acts_in else ()
    contact, believed = place in getattr(mechanism, "pairs", {}), loads[place]
    links = chain(scenario.law, effects, believed, contact=contact)
    world, memory = np.zeros(WORLD), np.zeros(8)

    def force(t: float, q: float, v: float, load: float = 0.0, travelled: float = 0.0, temperature: float = 0.0) -> float:
        side = 1.0 if v >= 0.0 else -1.0
        pressed = load / believed if contact else 1.0
        against = resistance(
            links.numbers,
            links.calls,
            links.parameters,
            world,
            memory,
            t,
            q,
            v,
            load,
            0.0,
            side,
            travelled,
            temperature,
            pressed,
        )
        pushed = float(world[LOAD])
        return pushed - (float(against) + pushed) * math.tanh(abs(v) / smoothing_velocity)

    return force
