"""Exudyn's own bristle friction with coefficients that follow a path: the cheap route where its law is enough."""

from __future__ import annotations

import math
from typing import Any

from exudyn.itemInterface import CoordinateSpringDamperExt, NodeGenericData

from stochfric_mb.coefficients.processes import EVENT, POSITION
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn.hooks import Hooks
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.elastic_stick import ElasticStick

LEAST_DECAY = 1.0e-9
"""Velocity scale of a fall from mu_s to mu_k at once [m/s]; Exudyn divides by it."""
_POSITION, _VELOCITY = ("initialCoordinates", "initialDisplacements"), ("initialVelocities", "initialCoordinates_t")


def add_bristle(
    mbs: Any,
    marker0: Any,
    marker1: Any,
    friction: Law | Friction,
    *,
    normal_force: float,
    effective_mass: float,
    hold: float = 0.0,
    seed: int = 0,
    sample: int = 0,
    contact: int | None = None,
) -> Bristle:
    """Return Exudyn's bristle (CoordinateSpringDamperExt) with the parameters nearest to an elastic stick.

    Stuck: spring mu_s N/e_lim and damper 2 zeta sqrt(k m_eff). Sliding: mu_k + (mu_s - mu_k) exp(-v/decay_velocity), the
    law's with v_s = 0. It starts sliding where the initial velocity is above v_s, otherwise stuck. The coefficients are those
    at the middle of each step, or of each stretch of ``hold``, passed in the system's PostStep function.

    Args:
        mbs: the system.
        marker0: coordinate marker of the counter-surface. A moving one needs a coordinate that moves.
        marker1: coordinate marker of the body.
        friction: an `ElasticStick`, or one with a process in time.
        normal_force: normal force [N], > 0.
        effective_mass: mass that the contact feels [kg], > 0.
        hold: time for which coefficients are held [s], >= 0: passing new ones costs as much as all the rest of the bristle.
        seed: seed of the path of coefficients.
        sample: number of the sample.
        contact: number of the contact; if not given, how many frictions the system had before.

    Raises:
        InputError: another law, a process along the surface or along events, or a number out of range.
    """
    friction = as_friction(friction)
    law = friction.law
    if not isinstance(law, ElasticStick):
        raise InputError(f"the bristle is an elastic stick; law {law.kind} needs add_friction")
    if friction.process is not None and friction.process.clock in (POSITION, EVENT):
        raise InputError(f"the bristle takes coefficients of time alone; process {friction.process.kind} needs add_friction")
    n = require_number("normal_force", normal_force, above=0.0, unit="N")
    mass = require_number("effective_mass", effective_mass, above=0.0, unit="kg")
    stiffness = law.mu_s * n / law.e_lim
    start, speed = (_initial(mbs, marker1, what) - _initial(mbs, marker0, what) for what in (_POSITION, _VELOCITY))
    contact = Hooks.of(mbs).join() if contact is None else contact
    mu_s, mu_k = friction.path(seed, sample, contact).at(0.0)
    slip = (mu_k + (mu_s - mu_k) * math.exp(-abs(speed) / max(law.decay_velocity, LEAST_DECAY))) * n
    mode = math.copysign(slip, speed) if abs(speed) > law.v_s else 0.0  # implicit solvers take their first step with it
    node = mbs.AddNode(NodeGenericData(initialCoordinates=[mode, start, 0.0], numberOfDataCoordinates=3))
    connector = CoordinateSpringDamperExt(
        markerNumbers=[marker0, marker1],
        nodeNumber=node,
        dynamicFrictionForce=law.mu_k * n,
        staticFrictionOffsetForce=(law.mu_s - law.mu_k) * n,
        stickingStiffness=stiffness,
        stickingDamping=2.0 * law.zeta * math.sqrt(stiffness * mass),
        exponentialDecayStatic=max(law.decay_velocity, LEAST_DECAY),
        frictionProportionalZone=0.0,
    )
    hold = require_number("hold", hold, low=0.0, unit="s")
    return Bristle(mbs, mbs.AddObject(connector), friction, n, (seed, sample, contact), hold)


class Bristle:
    """Exudyn's bristle in a system; made by `add_bristle`."""

    def __init__(
        self, mbs: Any, number: Any, friction: Friction, normal_force: float, address: tuple[int, int, int], hold: float
    ) -> None:
        self.object = number
        """Index of the connector."""
        self._mbs, self._normal_force = mbs, normal_force
        self._path = friction.path(*address)
        self._last, self._hold, self._until = math.nan, hold, -math.inf
        self.mu_s, self.mu_k = self._path.at(0.0)
        """The coefficients [-] of the step to come."""
        if friction.process is not None:
            hooks = Hooks.of(mbs)
            hooks.followers.append(self.follow)
            hooks.install(locate=False)
            self._set(0.0)

    def follow(self, t: float) -> None:
        """Pass on the coefficients of what begins at t [s]: of a step as long as the last one, or of a longer ``hold``."""
        step = t - self._last if t > self._last else 0.0
        if t <= self._last:
            self._until = -math.inf  # a new simulation
        self._last = t
        if t >= self._until:
            held = max(step, self._hold)
            self._until = t + held * (1.0 - 1.0e-6) - 0.5 * step  # times are sums of rounded steps
            self._set(t + 0.5 * held)

    def _set(self, t: float) -> None:
        self.mu_s, self.mu_k = self._path.at(t)
        n = self._normal_force
        self._mbs.SetObjectParameter(self.object, "dynamicFrictionForce", self.mu_k * n)
        self._mbs.SetObjectParameter(self.object, "staticFrictionOffsetForce", (self.mu_s - self.mu_k) * n)


def _initial(mbs: Any, marker: Any, names: tuple[str, str]) -> float:
    """Return the initial value that a node keeps under one of ``names``, 0 where the marker is on ground or on no node."""
    entry = mbs.GetMarker(marker)
    node = mbs.GetNode(entry["nodeNumber"]) if "nodeNumber" in entry else {}
    values = next((node[name] for name in names if name in node), None)
    return 0.0 if values is None else float(values[entry["coordinate"]])
