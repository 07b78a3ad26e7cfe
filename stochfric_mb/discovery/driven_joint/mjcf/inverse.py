"""Inverse dynamics of a user's own MuJoCo model, place by place, by ``mj_inverse``.

Positions, rates and accelerations come through one window in weak form; the driving forces pass the same window. Friction of
the model's own (``frictionloss``) is left out: it is what is looked for.

A place is a joint, a tendon or a pair of geoms: a direction J(q) in which friction F acts on the joints as J F. With the
forces r that the joints have left, the balance of a place is (J r)/(J J) = F; for a joint J is a unit vector, and at a pair
the normal force is part of the balance (`mjcf_pairs`). What other places take of r is taken from their models.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import (
    PAYLOADS,
    ForceBalance,
    Nuisance,
    balance_along,
    least_speed,
    slides,
    slipped,
)
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, narrowest, window_of
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import (
    by_mass,
    by_payload,
    carrier,
    effective_inertia,
    inverse,
    places_of_payload,
)
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import drive_of, in_si, position_of_joint
from stochfric_mb.discovery.driven_joint.mjcf.motion import Path, Rig
from stochfric_mb.discovery.inference.noise import noise_level
from stochfric_mb.effects.load_side import MotorMotion
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import ProportionalDerivative
from stochfric_mb.mechanisms.mjcf import CORRECTED

Array = npt.NDArray[np.float64]

NOT_OF_TENDONS, NOT_OF_PAIRS = ("damping",), ("damping", "gain")
"""A tendon has no damping of its own here, and nothing drives a pair but through the joints."""
LIFTED = 0.05
"""Normal force over the stated one below which a pair is not taken to slide on its surface [-]."""
LOADS = 400
"""Instants of a run at which it is asked what a load needs, at least: it changes with the place, slowly."""
DISPLACED = 1.0e-3
"""By how much a load is off its motor for the derivatives of what it needs [m or rad]."""
HELD = 0.5
"""How much later than its sample a drive acts that is held until the next one, on average [periods]."""


@dataclasses.dataclass(frozen=True)
class MjcfSource(Rig):
    """The balances of an MJCF model, made when asked for."""

    known: dict[str, JointModel] = dataclasses.field(default_factory=dict[str, JointModel])
    """Place -> the identified model of its friction, which other places are then judged beside."""
    loads: Mapping[str, Array] = dataclasses.field(default_factory=dict[str, Array])
    """Run -> load that its joint transmits where that was measured apart from the drive [N or N m], shape (count,)."""

    @property
    def places(self) -> Mapping[str, float]:
        """Joints, tendons or pair in which friction is sought -> their loads."""
        return self.mechanism.friction

    def nuisances(self, place: str) -> list[Nuisance]:
        """Return what data may correct, with its priors; a stated value of 1 is a factor."""
        spread = self.dataset.scenario.uncertainty
        missing = NOT_OF_PAIRS if place in self.mechanism.pairs else NOT_OF_TENDONS if place in self.tendons else ()
        nuisances: list[Nuisance] = []
        for name, unit in CORRECTED.items():
            if spread.get(name, 0.0) > 0.0 and name not in missing:
                value, low = (0.0, -np.inf) if name == "offset" else (1.0, 0.0)
                own = "N m" if name == "offset" and self.rotates(place) else unit
                nuisances.append(Nuisance(name, value, spread[name], own, low))
        for name in self._payloads:  # the last body is believed to carry no more as surely as its own mass is known
            mass = float(self.model.body_mass[carrier(self.model)])
            nuisances.append(Nuisance(PAYLOADS[name], 0.0, spread["mass"] * mass, "kg", 0.0))
        return nuisances

    @property
    def _payloads(self) -> Sequence[str]:
        """Where a payload is looked for: nowhere if the mass is stated as exact, or a payload is stated."""
        if self.mechanism.payload or self.dataset.scenario.uncertainty.get("mass", 0.0) <= 0.0:
            return ()
        return self._once(("payloads",), lambda: tuple(places_of_payload(self.mujoco, self.model)))

    def coupled(self, place: str) -> bool:
        """Return whether friction elsewhere enters the balance of a place."""
        others = [p for p in self.places if p != place]
        return any(p in self.tendons for p in ((place, *others) if others else ()))

    def window(self, run: Run, place: str, samples: int | None = None) -> Window:
        """Return the window through which a place is seen in a run."""
        friction = self.dataset.scenario.law.mu_k * self.mechanism.friction[place]
        return window_of(run, self._noise(run, place), friction, samples)

    def _noise(self, run: Run, place: str) -> dict[int, float]:
        """Return the noise of the balance of a place: derivative -> standard deviation."""
        return self._once(("noise", run.name, place), lambda: self._noise_anew(run, place))

    def _noise_anew(self, run: Run, place: str) -> dict[int, float]:
        weights = np.abs(self.path(run, place, narrowest(run)).weights).mean(axis=0)
        inertia = weights * effective_inertia(self.mujoco, self.model)
        drives = [w * _level(drive_of(run, self.mechanism, n)) for w, n in zip(weights, self.names, strict=True)]
        if place in self.tendons:
            drives.append(_level(drive_of(run, self.mechanism, place)))
        positions = [m * _level(position_of_joint(run, self.mechanism, n)) for m, n in zip(inertia, self.names, strict=True)]
        return {0: float(np.linalg.norm(drives)), 2: float(np.linalg.norm(positions))}

    def balance(self, run: Run, place: str, delay: float, samples: int | None) -> ForceBalance:
        """Return a run as a balance of a place."""
        window = self.window(run, place, samples)
        at = window.centres
        motion, needed, mass, payload = self._dynamics(run, window)
        path = self.path(run, place, window)
        weights = path.weights
        damped = np.column_stack([self.mechanism.damping.get(n, 0.0) * v for n, v in zip(self.names, motion[1].T, strict=True)])
        own, others = self._drives(run, place, window, delay)
        left = others - needed - damped
        for name, offset in self.mechanism.offset.items():
            left = left - offset * self.path(run, name, window).direction
        taken, known = self._elsewhere(run, place, window)
        left = left - taken
        own_damping = damped + self.model.dof_damping * motion[1]
        least = self._least(run, window, path)
        columns = {
            "mass": np.sum(weights * mass, axis=1),
            **{PAYLOADS[name]: np.sum(weights * change, axis=1) for name, change in payload.items()},
            "armature": np.sum(weights * (self.model.dof_armature * motion[2]), axis=1),
            "gain": -own,
            "damping": np.sum(weights * own_damping, axis=1),
            "offset": np.ones(len(at)),
        }
        sliding = slides(window, path.velocity, least) & known & window.covered(delay)
        load, normal = path.load, None
        if path.part is not None:
            load = normal = self._normal_force(run, place, window, left)
            if path.normal_weights is None:  # a measured force is taken out of the balance; another one is solved with friction
                left = left + normal[at, None] * path.part
            sliding &= normal[at] > LIFTED * self.mechanism.friction[place]
        return balance_along(
            run,
            window,
            path.position,
            path.velocity,
            least,
            unit="N m" if self.rotates(place) else "N",
            load=load,
            load_by_drive=path.load_by_drive,
            driven=own + np.sum(weights * left, axis=1),
            columns=columns,
            sliding=sliding,
            white=self._noise(run, place),
            before=float(self.travelled(run, place)[0]),
            normal_force=normal,
            drive=window.sampled(drive_of(run, self.mechanism, place), delay) if place in self.mechanism.drives else None,
            motor=lambda: self._once(("motor", run.name, place), lambda: self._motor(run, place)),
        )

    def _motor(self, run: Run, place: str) -> MotorMotion | None:
        """Return the motion of a joint's motor, and what its load needs beside its acceleration; None: the place is no joint.

        The load has all that the joint needs but the inertia that it has in the model's reference position: gravity, and what
        other joints' motion asks of this one.
        """
        if place not in self.names:
            return None
        joint = self.names.index(place)
        inertia = float(effective_inertia(self.mujoco, self.model)[joint])
        if inertia <= 0.0:
            return None
        narrow = narrowest(run)
        some = narrow.centres[:: max(1, len(narrow.centres) // LOADS)]
        motion = [self.joints(run, narrow, d)[some] for d in (0, 1, 2)]
        motion[2][:, joint] = 0.0
        step = DISPLACED * np.eye(len(self.names))[joint]
        places = motion[0], motion[0] + step, motion[0] - step
        here, beyond, before = (inverse(self.mujoco, self.model, (q, motion[1], motion[2]))[:, joint] for q in places)
        derivatives = here, (beyond - before) / (2.0 * DISPLACED), (beyond - 2.0 * here + before) / DISPLACED**2
        at, q = np.arange(len(run.time)), position_of_joint(run, self.mechanism, place)
        held = np.stack([np.interp(at, some, x) for x in derivatives])
        seen = [narrow.through(q, derivative) for derivative in (0, 1, 2)]
        return MotorMotion(run.sample_interval, *seen, inertia=inertia, held=held, inside=narrow.inside)

    def _normal_force(self, run: Run, place: str, window: Window, left: Array) -> Array:
        """Return the normal force in a pair [N], shape (count,): measured, or from what the joints have left."""
        rows = self.path(run, place, window).normal_weights
        if rows is None:
            measured = in_si(run, self.mechanism.pairs[place].normal_force, "normal_force")
            return np.maximum(window.through(measured), 0.0)
        return np.interp(np.arange(len(run.time)), window.centres, np.maximum(np.sum(rows * left, axis=1), 0.0))

    def _least(self, run: Run, window: Window, path: Path) -> float:
        """Return the speed above which a place surely slides [m/s or rad/s]."""
        each = [_level(position_of_joint(run, self.mechanism, n)) for n in self.names]
        seen = float(np.linalg.norm(np.abs(path.direction).mean(axis=0) * each))
        return least_speed(path.velocity, window.gain(1) * seen)

    def slip(self, run: Run, place: str) -> Array:
        """Return the distance since a place last reversed or rested in a run [m or rad], shape (count,)."""
        narrow = narrowest(run)
        path = self.path(run, place, narrow)
        return slipped(path.position, path.velocity, self._least(run, narrow, path))

    def rotates(self, place: str) -> bool:
        """Return whether friction in a place acts about an axis."""
        if place not in self.names:
            return False
        return bool(self.model.jnt_type[self.names.index(place)] == self.mujoco.mjtJoint.mjJNT_HINGE)

    def _drives(self, run: Run, place: str, window: Window, delay: float) -> tuple[Array, Array]:
        """Return a place's own drive, shape (n_centres,), and what others put into the joints, shape (n_centres, n_joints)."""
        loop = self.dataset.scenario.controller
        own = np.zeros(len(window.centres))
        others = np.zeros((len(own), len(self.names)))
        for name in self.mechanism.drives:
            held = loop.period * HELD if isinstance(loop, ProportionalDerivative) and name in loop.joints else 0.0
            seen = window.through(drive_of(run, self.mechanism, name), 0, delay + held)[window.centres]
            if name == place:
                own = seen
            else:
                others += seen[:, None] * self.path(run, name, window).direction
        return own, others

    def _elsewhere(self, run: Run, place: str, window: Window) -> tuple[Array, npt.NDArray[np.bool_]]:
        """Return what friction in other places takes of the joints' forces, shape (n_centres, n_joints), and where it is known.

        It is known where they slide, too.
        """
        n = len(window.centres)
        taken, known = np.zeros((n, len(self.names))), np.ones(n, dtype=bool)
        for name, load in self.places.items() if self.coupled(place) else ():
            path = self.path(run, name, window)
            least = self._least(run, window, path)
            sliding = slides(window, path.velocity, least)
            known &= sliding
            if name == place:
                continue
            model = self.known.get(name, JointModel(self.dataset.scenario.law, (), {}, load))
            motion = balance_along(
                run, window, path.position, path.velocity, least,
                unit="", load=path.load, driven=np.zeros(n), columns={}, sliding=sliding,
            )  # fmt: skip
            taken += model.friction(motion)[:, None] * path.direction
        return taken, known

    def _dynamics(self, run: Run, window: Window) -> tuple[tuple[Array, Array, Array], Array, Array, dict[str, Array]]:
        """Return motion at the centres, forces that it needs, and their change with a factor on all masses and with payloads.

        Each is of shape (n_centres, n_joints); the motion is positions, rates and accelerations.
        """

        def anew() -> tuple[tuple[Array, Array, Array], Array, Array, dict[str, Array]]:
            q, v, a = (self.joints(run, window, d)[window.centres] for d in (0, 1, 2))
            needed = inverse(self.mujoco, self.model, (q, v, a))
            asked = self.mujoco, self.model, (q, v, a), needed
            return (q, v, a), needed, by_mass(*asked), by_payload(*asked) if self._payloads else {}

        return self._once(("dynamics", run.name, window.half_width), anew)


def _level(signal: Array) -> float:
    return noise_level(signal) if np.ptp(signal) else 0.0
