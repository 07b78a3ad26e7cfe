"""Inverse dynamics of a user's own MuJoCo model, joint by joint, by ``mj_inverse``.

Positions, rates and accelerations come through one window in weak form; the driving forces pass the same window. Friction of
the model's own (``frictionloss``) is left out: it is what is looked for.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
import dataclasses
import importlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.joints.sheet import Nuisance, Sheet, least_speed, slides, slipped
from stochfric_mb.discovery.joints.windows import Window, chosen_window, noise_level
from stochfric_mb.errors import InputError, MissingEngineError, require_name
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Mjcf

Array = npt.NDArray[np.float64]

CORRECTED = {"mass": "-", "armature": "-", "gain": "-", "damping": "-", "offset": "N or N m"}
"""What data may correct: factors on masses, armature, drive and damping of the joint, and an offset of its drive."""
STEP = 1.0e-3
"""Relative change of the masses by which their column is taken; the balance is linear in them."""


def mjcf_sheets(dataset: Dataset) -> MjcfSource:
    """Return the sheets of a dataset whose mechanism is an MJCF model.

    Raises:
        InputError: the file, a joint or a channel is unknown or unsuitable.
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
    _scale(mujoco, model, mechanism.factors.get("mass", 1.0))
    model.dof_armature *= mechanism.factors.get("armature", 1.0)
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, i) for i in range(model.njnt)]
    for joint in mechanism.positions:
        require_name(f"joint (a joint of {mechanism.file.name})", joint, names)
    missing = [n for n in names if n not in mechanism.positions]
    if missing or model.nq != model.nv:
        raise InputError(
            f"{mechanism.file.name}: joints {', '.join(map(str, missing)) or 'with quaternions'} have no measured position; "
            "every joint needs one in mechanism.positions, hinge or slide"
        )
    return MjcfSource(dataset, mechanism, mujoco, model, tuple(names))


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
    remembered: dict[tuple[str, float], tuple[tuple[Array, Array, Array], Array, Array]] = dataclasses.field(
        default_factory=dict[Any, Any]
    )
    """Run and half width -> motion at the centres, and the forces that it needs, with the model and with heavier masses."""

    @property
    def places(self) -> list[tuple[str, float]]:
        """Joints in which friction is sought, and their loads."""
        return list(self.mechanism.friction.items())

    def nuisances(self, place: str) -> list[Nuisance]:
        """Return what data may correct, with its priors; a believed value of 1 is a factor."""
        spread = self.dataset.scenario.uncertainty
        found: list[Nuisance] = []
        for name, unit in CORRECTED.items():
            if spread.get(name, 0.0) > 0.0:
                value, low = (0.0, -np.inf) if name == "offset" else (1.0, 0.0)
                found.append(Nuisance(name, value, spread[name], unit, low))
        return found

    def sheets(self, place: str, role: str, delay: float, samples: int | None = None) -> list[Sheet]:
        """Return the runs of a role as sheets of one joint; arguments as of `balance.sheet_of`."""
        runs = self.dataset.fit if role == "fit" else self.dataset.test
        return [self._sheet(run, place, delay, samples) for run in runs]

    def _sheet(self, run: Run, place: str, delay: float, samples: int | None) -> Sheet:
        h, count = run.sample_interval, len(run.time)
        load = self.mechanism.friction[place]
        q = _column(run, self.mechanism.positions[place])
        inertia = float(_effective_inertia(self.mujoco, self.model)[self.names.index(place)])
        drive = drive_of(run, self.mechanism, place)
        noise = {0: noise_level(drive) if np.ptp(drive) else 0.0, 2: inertia * noise_level(q)}
        friction = self.dataset.scenario.law.mu_k * load
        window = chosen_window(h, count, noise, friction) if samples is None else Window(samples * h, h, count)
        if len(window.centres) < 8:
            raise InputError(
                f"run {run.name!r}: {count} samples are too few for windows of {window.half_width:.3g} s; record longer"
            )
        i = self.names.index(place)
        motion, needed, by_mass = self._dynamics(run, window)
        velocity = window.through(q, 1)
        least = least_speed(velocity, window.gain(1) * noise_level(q))
        at = window.centres
        damping = self.mechanism.damping.get(place, 0.0)
        driven = window.through(drive, 0, delay)[at]
        columns = {
            "mass": by_mass[:, i],
            "armature": float(self.model.dof_armature[i]) * motion[2][:, i],
            "gain": -driven,
            "damping": (damping + float(self.model.dof_damping[i])) * motion[1][:, i],
            "offset": np.ones(len(at)),
        }
        transmitted = np.abs(window.through(drive) - damping * velocity)
        position = window.through(q)
        return Sheet(
            run=run.name,
            role=run.role,
            place=place if len(self.mechanism.friction) > 1 else "",
            unit="N m" if self.model.jnt_type[i] == self.mujoco.mjtJoint.mjJNT_HINGE else "N",
            window=window,
            time=run.time,
            position=position,
            velocity=velocity,
            load=transmitted,
            slip=slipped(position, velocity, least),
            driven=driven - needed[:, i] - damping * motion[1][:, i] - self.mechanism.offset.get(place, 0.0),
            columns=columns,
            sliding=slides(window, velocity, least),
            noise=float(np.hypot(window.gain(0) * noise[0], window.gain(2) * noise[2])),
            factors=_factors(run, window, velocity, position, transmitted),
        )

    def _dynamics(self, run: Run, window: Window) -> tuple[tuple[Array, Array, Array], Array, Array]:
        """Return motion at the centres, forces that it needs, and their change with a factor on all masses.

        Each is of shape (n_centres, n_joints); the motion is positions, rates and accelerations.
        """
        key = (run.name, window.half_width)
        if key not in self.remembered:
            rows = [_column(run, self.mechanism.positions[name]) for name in self.names]
            q, v, a = (np.column_stack([window.through(x, d)[window.centres] for x in rows]) for d in (0, 1, 2))
            needed = _inverse(self.mujoco, self.model, (q, v, a))
            heavier = _inverse(self.mujoco, _heavier(self.mujoco, self.model), (q, v, a))
            self.remembered[key] = (q, v, a), needed, (heavier - needed) / STEP
        return self.remembered[key]


def corrected(mechanism: Mjcf, corrections: Mapping[str, Mapping[str, float]]) -> Mjcf:
    """Return the mechanism with what data have corrected: joint -> number of `CORRECTED` -> value.

    Masses and armature belong to the whole model: those of the first joint given are taken.
    """
    first = next(iter(corrections.values()))
    drives = {
        j: dataclasses.replace(d, gain=d.gain * corrections.get(j, {}).get("gain", 1.0)) for j, d in mechanism.drives.items()
    }
    damping = {j: c * corrections.get(j, {}).get("damping", 1.0) for j, c in mechanism.damping.items()}
    offset = {j: mechanism.offset.get(j, 0.0) + values.get("offset", 0.0) for j, values in corrections.items()}
    factors = {k: mechanism.factors.get(k, 1.0) * first.get(k, 1.0) for k in ("mass", "armature")}
    return dataclasses.replace(mechanism, drives=drives, damping=damping, offset=offset, factors=factors)


def drive_of(run: Run, mechanism: Mjcf, joint: str) -> Array:
    """Return the measured driving force of a joint [N or N m], shape (count,); zeros where nothing drives it.

    Raises:
        InputError: one of its columns is missing.
    """
    drive = mechanism.drives.get(joint)
    if drive is None:
        return np.zeros(len(run.time))
    force = np.full(len(run.time), drive.gain)
    for name in drive.columns:
        force = force * _column(run, name)
    return force


def _column(run: Run, name: str) -> Array:
    for columns in (run.channels, run.covariates):
        if name in columns:
            return columns[name]
    require_name(f"column of run {run.name} (for the mechanism)", name, [*run.channels, *run.covariates])
    raise AssertionError  # require_name has raised


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


def _inverse(mujoco: Any, model: Any, motion: tuple[Array, Array, Array]) -> Array:
    """Return the generalised forces that a motion needs, shape (n, n_joints)."""
    data = mujoco.MjData(model)
    forces = np.empty_like(motion[0])
    for k, (q, v, a) in enumerate(zip(*motion, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        forces[k] = data.qfrc_inverse
    return forces


def _heavier(mujoco: Any, model: Any) -> Any:
    """Return the model with all masses and inertias larger by `STEP`."""
    heavier = copy.copy(model)
    _scale(mujoco, heavier, 1.0 + STEP)
    return heavier


def _scale(mujoco: Any, model: Any, factor: float) -> None:
    """Multiply all masses and inertias of a model."""
    model.body_mass *= factor
    model.body_inertia *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _effective_inertia(mujoco: Any, model: Any) -> Array:
    """Return the inertia of each joint in the model's reference position, shape (n_joints,)."""
    n = model.nv
    still, unit = np.zeros((n, n)), np.eye(n)
    pose = np.tile(model.qpos0, (n, 1))
    return np.diag(_inverse(mujoco, model, (pose, still, unit)) - _inverse(mujoco, model, (pose, still, still)))
