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
    """Return ``force(t, q, v, load=0, travelled=0, temperature=0, drive, pressure)``: friction along +q [N or N m].

    F = P - R(abs(v)) tanh(v/smoothing_velocity) with the scenario's law and effects in R, and in P what effects push with
    whichever way the joint moves: what multi-step integrators can take.
    Friction does not hold at rest then; it creeps at a part of ``smoothing_velocity``. ``load`` is what the joint transmits
    (at a pair of geoms: its normal force), ``travelled`` the distance slid, ``temperature`` and ``pressure`` the measured ones
    and ``drive`` the driving force, for effects that ask for them; what these take from the drive is part of the force.

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
    contact, stated_load = place in getattr(mechanism, "pairs", {}), loads[place]
    links = chain(scenario.law, effects, stated_load, contact=contact)
    world, memory = np.zeros(WORLD), np.zeros(8)

    needed = {name: e.kind for e in effects for name in e.reads if name in ("drive", "pressure")}

    def force(
        t: float, q: float, v: float, load: float = 0.0, travelled: float = 0.0, temperature: float = 0.0,
        drive: float | None = None, pressure: float | None = None,
    ) -> float:  # fmt: skip
        for name, kind in needed.items():
            if {"drive": drive, "pressure": pressure}[name] is None:
                raise InputError(f"effect {kind!r} reads the {name}, which is not given; call the friction with {name}=...")
        side = 1.0 if v >= 0.0 else -1.0
        pressed = load / stated_load if contact else 1.0
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
            drive or 0.0,
            pressure or 0.0,
        )
        pushed = float(world[LOAD])
        return pushed - (float(against) + pushed) * math.tanh(abs(v) / smoothing_velocity)

    return force
