"""Inverse dynamics of a user's own MuJoCo model, place by place, by ``mj_inverse``.

Positions, rates and accelerations come through one window in weak form; the driving forces pass the same window. Friction of
the model's own (``frictionloss``) is left out: it is what is looked for.

A place is a joint or a tendon: a direction J(q) in which friction F acts on the joints as J F. With the forces r that the
joints have left, the balance of a place is (J r)/(J J) = F; for a joint J is a unit vector. What other places take of r is
taken from their models.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
import importlib
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.joints.fitting import JointModel
from stochfric_mb.discovery.joints.friction import friction_along
from stochfric_mb.discovery.joints.mjcf_columns import column, drive_of, require_loops
from stochfric_mb.discovery.joints.mjcf_model import by_mass, effective_inertia, inverse, scale_masses, tendon_along
from stochfric_mb.discovery.joints.sheet import Nuisance, Sheet, least_speed, slides, slipped
from stochfric_mb.discovery.joints.windows import Window, chosen_window, noise_level
from stochfric_mb.errors import InputError, MissingEngineError, require_name
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Mjcf, ProportionalDerivative

Array = npt.NDArray[np.float64]

CORRECTED = {"mass": "-", "armature": "-", "gain": "-", "damping": "-", "offset": "N or N m"}
"""What data may correct: factors on masses, armature, drive and damping of the joint, and an offset of its drive."""
OF_TENDONS = ("mass", "armature", "gain", "offset")
"""The same at a tendon, which has no damping of its own here."""
HELD = 0.5
"""How much later than its sample a drive acts that is held until the next one, on average [periods]."""


def mjcf_sheets(dataset: Dataset) -> MjcfSource:
    """Return the sheets of a dataset whose mechanism is an MJCF model.

    Raises:
        InputError: the file, a joint, a tendon or a channel is unknown or unsuitable.
        MissingEngineError: MuJoCo is not installed.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError:
        raise MissingEngineError("mechanism 'mjcf' needs MuJoCo; run: pip install 'stochfric_mb[mujoco]'") from None
    mechanism: Mjcf = dataset.scenario.mechanism
    try:
        model = mujoco.MjModel.from_xml_path(str(mechanism.file))
    except ValueError as error:
        raise InputError(f"mechanism.file = {str(mechanism.file)!r} cannot be read: {error}") from None
    model.dof_frictionloss[:] = 0.0
    model.tendon_frictionloss[:] = 0.0
    scale_masses(mujoco, model, mechanism.factors.get("mass", 1.0))
    model.dof_armature *= mechanism.factors.get("armature", 1.0)
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, i) for i in range(model.njnt)]
    tendons = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TENDON, i) for i in range(model.ntendon)]
    for joint in mechanism.positions:
        require_name(f"joint (a joint of {mechanism.file.name})", joint, names)
    for tendon in mechanism.tendons:
        require_name(f"tendon (a tendon of {mechanism.file.name})", tendon, tendons)
    missing = [n for n in names if n not in mechanism.positions]
    if missing or model.nq != model.nv:
        raise InputError(
            f"{mechanism.file.name}: joints {', '.join(map(str, missing)) or 'with quaternions'} have no measured position; "
            "every joint needs one in mechanism.positions, hinge or slide"
        )
    require_loops(dataset)
    return MjcfSource(dataset, mechanism, mujoco, model, tuple(names), tuple(tendons))


@dataclasses.dataclass(frozen=True)
class Path:
    """The motion along a place in one run, and its direction among the joints."""

    position: Array
    """Position through the window [m or rad], shape (count,)."""
    velocity: Array
    """Velocity in weak form [m/s or rad/s], shape (count,)."""
    load: Array
    """Load that the place transmits [N or N m], shape (count,)."""
    direction: Array
    """J at the centres, shape (n_centres, n_joints)."""

    @property
    def weights(self) -> Array:
        """Return J/(J J), shape (n_centres, n_joints)."""
        return self.direction / np.sum(self.direction**2, axis=1, keepdims=True)


@dataclasses.dataclass(frozen=True)
class MjcfSource:
    """The sheets of an MJCF model, made when asked for."""

    dataset: Dataset
    """The dataset."""
    mechanism: Mjcf
    """Its mechanism."""
    mujoco: Any
    """The engine."""
    model: Any
    """The compiled model, without friction of its own."""
    names: tuple[str, ...]
    """Joints in the order of their degrees of freedom."""
    tendons: tuple[str, ...]
    """Tendons in the order of the model."""
    remembered: dict[tuple[Any, ...], Any] = dataclasses.field(default_factory=dict[Any, Any])
    """What was computed for a run and a window."""
    known: dict[str, JointModel] = dataclasses.field(default_factory=dict[str, JointModel])
    """Place -> what has been found of its friction, which other places are then judged beside."""

    @property
    def places(self) -> list[tuple[str, float]]:
        """Joints and tendons in which friction is sought, and their loads."""
        return list(self.mechanism.friction.items())

    def nuisances(self, place: str) -> list[Nuisance]:
        """Return what data may correct, with its priors; a believed value of 1 is a factor."""
        spread = self.dataset.scenario.uncertainty
        found: list[Nuisance] = []
        for name, unit in CORRECTED.items():
            if spread.get(name, 0.0) > 0.0 and (place in self.names or name in OF_TENDONS):
                value, low = (0.0, -np.inf) if name == "offset" else (1.0, 0.0)
                found.append(Nuisance(name, value, spread[name], unit, low))
        return found

    def coupled(self, place: str) -> bool:
        """Return whether friction elsewhere enters the balance of a place."""
        others = [p for p, _ in self.places if p != place]
        return any(p in self.tendons for p in ((place, *others) if others else ()))

    def sheets(self, place: str, role: str, delay: float, samples: int | None = None) -> list[Sheet]:
        """Return the runs of a role as sheets of one place; arguments as of `balance.sheet_of`."""
        runs = self.dataset.fit if role == "fit" else self.dataset.test
        return [self._sheet(run, place, delay, samples) for run in runs]

    def window(self, run: Run, place: str, samples: int | None = None) -> Window:
        """Return the window through which a place is seen in a run.

        Raises:
            InputError: the run is too short.
        """
        h, count = run.sample_interval, len(run.time)
        friction = self.dataset.scenario.law.mu_k * self.mechanism.friction[place]
        window = (
            Window(samples * h, h, count) if samples is not None else chosen_window(h, count, self._noise(run, place), friction)
        )
        if len(window.centres) < 8:
            raise InputError(
                f"run {run.name!r}: {count} samples are too few for windows of {window.half_width:.3g} s; record longer"
            )
        return window

    def _noise(self, run: Run, place: str) -> dict[int, float]:
        """Return the noise of the balance of a place: derivative -> standard deviation."""
        key = ("noise", run.name, place)
        if key not in self.remembered:
            narrow = Window(8 * run.sample_interval, run.sample_interval, len(run.time))
            weights = np.abs(self.path(run, place, narrow).weights).mean(axis=0)
            inertia = effective_inertia(self.mujoco, self.model)
            noise: dict[int, float] = {0: 0.0, 2: 0.0}
            for weight, size, joint in zip(weights, inertia, self.names, strict=True):
                noise[0] = float(np.hypot(noise[0], weight * _level(drive_of(run, self.mechanism, joint))))
                noise[2] = float(np.hypot(noise[2], weight * size * noise_level(column(run, self.mechanism.positions[joint]))))
            if place in self.tendons:
                noise[0] = float(np.hypot(noise[0], _level(drive_of(run, self.mechanism, place))))
            self.remembered[key] = noise
        return self.remembered[key]

    def _sheet(self, run: Run, place: str, delay: float, samples: int | None) -> Sheet:
        window = self.window(run, place, samples)
        at = window.centres
        motion, needed, mass = self._dynamics(run, window)
        path = self.path(run, place, window)
        weights = path.weights
        damped = np.column_stack([self.mechanism.damping.get(n, 0.0) * v for n, v in zip(self.names, motion[1].T, strict=True)])
        own, others = self._drives(run, place, window, delay)
        left = others - needed - damped
        for name, offset in self.mechanism.offset.items():
            left = left - offset * self.path(run, name, window).direction
        left = left - self._friction_elsewhere(run, place, window)
        own_damping = damped + self.model.dof_damping * motion[1]
        columns = {
            "mass": np.sum(weights * mass, axis=1),
            "armature": np.sum(weights * (self.model.dof_armature * motion[2]), axis=1),
            "gain": -own,
            "damping": np.sum(weights * own_damping, axis=1),
            "offset": np.ones(len(at)),
        }
        least = self._least(run, place, window, path)
        noise = self._noise(run, place)
        return Sheet(
            run=run.name,
            role=run.role,
            place=place if len(self.mechanism.friction) > 1 else "",
            unit="N m" if self._rotates(place) else "N",
            window=window,
            time=run.time,
            position=path.position,
            velocity=path.velocity,
            load=path.load,
            slip=slipped(path.position, path.velocity, least),
            driven=own + np.sum(weights * left, axis=1),
            columns=columns,
            sliding=slides(window, path.velocity, least) & self._others_slide(run, place, window),
            noise=float(np.hypot(window.gain(0) * noise[0], window.gain(2) * noise[2])),
            factors=_factors(run, window, path.velocity, path.position, path.load),
        )

    def _least(self, run: Run, place: str, window: Window, path: Path) -> float:
        """Return the speed above which a place surely slides [m/s or rad/s]."""
        each = [noise_level(column(run, self.mechanism.positions[n])) for n in self.names]
        seen = float(np.linalg.norm(np.abs(path.direction).mean(axis=0) * each))
        return least_speed(path.velocity, window.gain(1) * seen)

    def _rotates(self, place: str) -> bool:
        if place in self.tendons:
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

    def _friction_elsewhere(self, run: Run, place: str, window: Window) -> Array:
        """Return what friction in other places takes of the joints' forces, shape (n_centres, n_joints)."""
        taken = np.zeros((len(window.centres), len(self.names)))
        if not self.coupled(place):
            return taken
        for name, load in self.places:
            if name != place:
                path = self.path(run, name, window)
                model = self.known.get(name, JointModel(self.dataset.scenario.law, (), {}, load))
                least = self._least(run, name, window, path)
                sheet = _motion(run, window, path, least)
                force = friction_along(sheet, model.law, model.effects, model.load)
                taken += force[:, None] * path.direction
        return taken

    def _others_slide(self, run: Run, place: str, window: Window) -> npt.NDArray[np.bool_]:
        """Return at which centres friction that enters from other places is known, since they slide, too."""
        known = np.ones(len(window.centres), dtype=bool)
        if self.coupled(place):
            for name, _ in self.places:
                path = self.path(run, name, window)
                known &= slides(window, path.velocity, self._least(run, name, window, path))
        return known

    def path(self, run: Run, place: str, window: Window) -> Path:
        """Return the motion along a joint or tendon in a run."""
        key = ("path", run.name, place, window.half_width)
        if key not in self.remembered:
            self.remembered[key] = self._path(run, place, window)
        return self.remembered[key]

    def _path(self, run: Run, place: str, window: Window) -> Path:
        drive = drive_of(run, self.mechanism, place)
        if place in self.names:
            q = column(run, self.mechanism.positions[place])
            position, velocity = window.through(q), window.through(q, 1)
            direction = np.zeros((len(window.centres), len(self.names)))
            direction[:, self.names.index(place)] = 1.0
        else:
            rows = [column(run, self.mechanism.positions[n]) for n in self.names]
            joints = np.column_stack([window.through(x) for x in rows])
            rates = np.column_stack([window.through(x, 1) for x in rows])
            position, all_along = tendon_along(self.mujoco, self.model, self.tendons.index(place), joints)
            velocity = np.sum(all_along * rates, axis=1)
            direction = all_along[window.centres]
        load = np.abs(window.through(drive) - self.mechanism.damping.get(place, 0.0) * velocity)
        return Path(position, velocity, load, direction)

    def _dynamics(self, run: Run, window: Window) -> tuple[tuple[Array, Array, Array], Array, Array]:
        """Return motion at the centres, forces that it needs, and their change with a factor on all masses.

        Each is of shape (n_centres, n_joints); the motion is positions, rates and accelerations.
        """
        key = ("dynamics", run.name, window.half_width)
        if key not in self.remembered:
            rows = [column(run, self.mechanism.positions[name]) for name in self.names]
            q, v, a = (np.column_stack([window.through(x, d)[window.centres] for x in rows]) for d in (0, 1, 2))
            needed = inverse(self.mujoco, self.model, (q, v, a))
            self.remembered[key] = (q, v, a), needed, by_mass(self.mujoco, self.model, (q, v, a), needed)
        return self.remembered[key]


def _level(signal: Array) -> float:
    return noise_level(signal) if np.ptp(signal) else 0.0


def _motion(run: Run, window: Window, path: Path, least: float) -> Sheet:
    """Return a sheet of the motion along a place alone."""
    none = np.zeros(len(window.centres))
    return Sheet(
        run=run.name, role=run.role, place="", unit="", window=window, time=run.time, position=path.position,
        velocity=path.velocity, load=path.load, slip=slipped(path.position, path.velocity, least), driven=none, columns={},
        sliding=none > 0.0, noise=0.0, factors={},
    )  # fmt: skip


def _factors(run: Run, window: Window, velocity: Array, position: Array, load: Array) -> dict[str, Array]:
    at = window.centres
    found = {
        "direction": np.sign(velocity[at]),
        "speed": np.abs(velocity[at]),
        "position": position[at],
        "load": load[at],
        "time": run.time[at],
    }
    if "temperature" in run.channels:
        found["temperature"] = window.through(run.channels["temperature"])[at]
    return found | {key: np.full(len(at), value) for key, value in run.constants.items()}
