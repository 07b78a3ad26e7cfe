"""A user's own model in MuJoCo Warp: all samples of an ensemble at once, a world each."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import hashlib
import time
from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, SimulationError, require_name, require_number
from stochfric_mb.friction import Friction
from stochfric_mb.mechanisms import Mjcf
from stochfric_mb.mujoco import Joint, Tendon
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory
from stochfric_mb.warp.attach import add_friction
from stochfric_mb.warp.belt_box import HOOK
from stochfric_mb.warp.kinds import ContactFriction, JointFriction

REACH = 1.0e10
"""Size beyond which MuJoCo calls a state bad (mjMAXVAL)."""

Array = npt.NDArray[np.float64]


def run_worlds(scenario: Scenario[Mjcf], *, seed: int, first_sample: int, n: int, dt: float | None) -> list[Trajectory]:
    """Return samples ``first_sample`` .. ``first_sample + n - 1``, from the model's first keyframe, or else its initial state.

    ``mechanism.friction`` names the joint, tendon or pair; ``mechanism.positions`` the joint (or sensor) that is recorded, by
    the channel ``"position"``, and by ``"velocity"`` a sensor of its velocity, which a joint does not need.

    Raises:
        InputError: the model, a name in it, the step or the law cannot be used.
        SimulationError: a state is beyond reason, or there were more contacts than room.
    """
    mechanism = scenario.mechanism
    _require_forward(scenario)
    model, data = _start(mechanism, dt)
    step = float(model.opt.timestep)
    per_output = _steps(scenario.output_step, step)
    position, velocity = _readings(mechanism, model)
    m, d = _on_device(model, data, n)
    law = Friction(scenario.law, scenario.coefficient_process)
    friction = _friction(mechanism, model, m, d, law, seed=seed, first_sample=first_sample)
    began = time.perf_counter()
    rows = np.empty((n, scenario.n_outputs, 7))
    for i in range(scenario.n_outputs):
        rows[:, i, 0], rows[:, i, 1] = position.now(d), velocity.now(d)
        last = i + 1 == scenario.n_outputs
        for k in range(1 if last else per_output):
            (mjw.forward if last else mjw.step)(m, d)
            if k == 0:  # sensors and forces are those of the state at the step's begin
                position.after(d, rows[:, i, 0])
                velocity.after(d, rows[:, i, 1])
                _read(d, friction, rows[:, i])
        _require_sane(d, rows[:, i], first_sample, i * scenario.output_step)
    n_steps = (scenario.n_outputs - 1) * per_output
    about = {
        "engine": "warp", "version": mjw.__version__, "hook": HOOK, "dt": step, "seed": seed, "law": scenario.law.kind,
        "notes": [], "n_steps": n_steps,
        "seconds_per_step": (time.perf_counter() - began) / n / max(n_steps, 1), "position_unit": position.unit,
    }  # fmt: skip
    names = ("position", "velocity", "friction_force", "normal_force", "mu_s", "mu_k", "stick")
    times = scenario.output_times()
    return [
        Trajectory(
            time=times, **{name: rows[w, :, c].copy() for c, name in enumerate(names)},
            attributes=about | {"sample": first_sample + w},
        )
        for w in range(n)
    ]  # fmt: skip


def digest(mechanism: Mjcf) -> str:
    """Return a digest of the compiled model: what it includes, and meshes, count as well as its text."""
    model = _compiled(mechanism)
    buffer = np.zeros(mujoco.mj_sizeModel(model), dtype=np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return hashlib.sha256(buffer.tobytes()).hexdigest()


class Record:
    """One recorded number of each world: a coordinate of the state, or of a sensor."""

    def __init__(self, array: str, place: int, unit: str) -> None:
        """Take entry ``place`` of an array of ``mjw.Data``."""
        self._array, self._place = array, place
        self.unit = unit
        """Unit of a position."""

    def now(self, d: mjw.Data) -> Array:
        """Return the numbers of the present state, shape (n,)."""
        return getattr(d, self._array).numpy()[:, self._place]

    def after(self, d: mjw.Data, column: Array) -> None:
        """Fill in what only the step that begins at the state computes: sensors."""
        if self._array == "sensordata":
            column[:] = self.now(d)


def _require_forward(scenario: Scenario[Mjcf]) -> None:
    mechanism = scenario.mechanism
    for key in ("drives", "damping", "offset", "factors", "payload"):
        if getattr(mechanism, key):
            raise InputError(
                f"mechanism.{key} belongs to measured data, which a simulation does not have; write it into "
                f"{mechanism.file.name} (actuators, springs, damping, mass) and remove the key"
            )
    if scenario.controller is not None:
        raise InputError(
            "[controller] is not simulated in MuJoCo Warp; write it as actuators of the model and remove the table"
        )
    if len(mechanism.friction) != 1:
        raise InputError(
            f"mechanism.friction names {', '.join(mechanism.friction)}; an ensemble records one place: name one (a pair may "
            'have "*" for all geoms that the other one can touch)'
        )


def _compiled(mechanism: Mjcf) -> mujoco.MjModel:
    if not mechanism.file.is_file():
        raise InputError(f"{mechanism.file}: no such file; mechanism.file is relative to the scenario")
    try:
        return mujoco.MjModel.from_xml_path(str(mechanism.file))
    except ValueError as error:
        raise InputError(f"{mechanism.file}: MuJoCo does not read it: {error}") from None


def _start(mechanism: Mjcf, dt: float | None) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = _compiled(mechanism)
    if dt is not None:
        model.opt.timestep = require_number("dt", dt, above=0.0, unit="s")
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def _steps(output_step: float, step: float) -> int:
    number = output_step / step
    if number < 0.5 or abs(number - round(number)) > 1.0e-6 * number:
        raise InputError(
            f"the step {step:g} s (dt, or the model's own) does not divide simulation.output_step = {output_step:g} s; give "
            "--dt, or another output_step"
        )
    return round(number)


def _on_device(model: mujoco.MjModel, data: mujoco.MjData, n: int) -> tuple[mjw.Model, mjw.Data]:
    try:
        return mjw.put_model(model), mjw.put_data(model, data, nworld=n)
    except (NotImplementedError, ValueError) as error:
        raise InputError(
            f"MuJoCo Warp does not take this model: {error}; change the model, or use stochfric_mb.mujoco"
        ) from None


def _friction(
    mechanism: Mjcf, model: mujoco.MjModel, m: mjw.Model, d: mjw.Data, law: Friction, **address: Any
) -> ContactFriction | JointFriction:
    ((place, load),) = mechanism.friction.items()
    if place in mechanism.pairs:
        return add_friction(model, m, d, mechanism.pairs[place].geoms, law, **address)
    where = Tendon(place) if place in mechanism.tendons else Joint(place)
    return add_friction(model, m, d, where, law, normal_force=load, **address)


def _readings(mechanism: Mjcf, model: mujoco.MjModel) -> tuple[Record, Record]:
    """Return the records of position and velocity."""
    by_channel = {channel: name for name, channel in mechanism.positions.items() if isinstance(channel, str)}
    for channel, name in by_channel.items():
        require_name(f"channel of mechanism.positions.{name}", channel, ("position", "velocity"))
    for name, value in mechanism.positions.items():
        if not isinstance(value, str):
            raise InputError(f"mechanism.positions.{name} = {value:g} holds a joint, which a simulation does not; remove it")
    if "position" not in by_channel:
        raise InputError('mechanism.positions records nothing; write { NAME = "position" }, NAME being a joint or a sensor')
    name = by_channel["position"]
    joints = [model.joint(i).name for i in range(model.njnt)]
    if name in joints and "velocity" not in by_channel:
        return _joint(model, joints.index(name))
    if "velocity" not in by_channel:
        place = _sensor(model, name, joints)
        raise InputError(
            f'sensor {name!r} (entry {place} of sensordata) needs one of its velocity beside it; add NAME = "velocity" to '
            "mechanism.positions"
        )
    moves = by_channel["velocity"]
    first = _joint(model, joints.index(name))[0] if name in joints else Record("sensordata", _sensor(model, name, joints), "m")
    return first, Record("sensordata", _sensor(model, moves, []), first.unit)


def _joint(model: mujoco.MjModel, joint: int) -> tuple[Record, Record]:
    kind = int(model.jnt_type[joint])
    units = {int(mujoco.mjtJoint.mjJNT_SLIDE): "m", int(mujoco.mjtJoint.mjJNT_HINGE): "rad"}
    if kind not in units:
        raise InputError(
            f"joint {model.joint(joint).name!r} is a ball or free joint; record a slide, a hinge, or a sensor: "
            '{ "where.0" = "position", "speed.0" = "velocity" } takes x of framepos and framelinvel'
        )
    unit = units[kind]
    return Record("qpos", int(model.jnt_qposadr[joint]), unit), Record("qvel", int(model.jnt_dofadr[joint]), unit)


def _sensor(model: mujoco.MjModel, name: str, joints: list[str]) -> int:
    """Return the entry of ``sensordata`` that ``SENSOR`` or ``SENSOR.NUMBER`` means."""
    sensors = [model.sensor(i).name for i in range(model.nsensor)]
    stem, dot, number = (name, "", "0") if name in sensors else name.rpartition(".")
    if not dot and name not in sensors:
        stem = name
    known = [s for s in sensors if s] + [j for j in joints if j]
    result = sensors.index(require_name("joint or sensor of mechanism.positions", stem, known))
    size = int(model.sensor_dim[result])
    if not number.isdecimal() or int(number) >= size or (not dot and size > 1):
        raise InputError(f"mechanism.positions: sensor {stem!r} has {size} numbers; name one of them, such as '{stem}.0'")
    return int(model.sensor_adr[result]) + int(number)


def _read(d: mjw.Data, friction: ContactFriction | JointFriction, row: Array) -> None:
    friction.observe(d)
    if isinstance(friction, ContactFriction):
        row[:, 2] = np.linalg.norm(friction.friction_force.numpy(), axis=1)
        row[:, 3] = friction.normal_force.numpy()
    else:
        row[:, 2], row[:, 3] = friction.friction_force.numpy(), np.nan
    row[:, 4], row[:, 5] = friction.mu_s.numpy(), friction.mu_k.numpy()
    row[:, 6] = friction.stick.numpy()


def _require_sane(d: mjw.Data, row: Array, first: int, t: float) -> None:
    full = np.flatnonzero(d.overflow.numpy())
    if full.size:
        raise SimulationError(
            f"sample {first + int(full[0])}: more contacts or constraints at t = {t:g} s than MuJoCo Warp has room for; begin "
            "from a keyframe in which they are there, or remove geoms from collision"
        )
    bad = np.flatnonzero(~(np.abs(row[:, :2]) < REACH).all(axis=1))
    if bad.size:
        raise SimulationError(
            f"sample {first + int(bad[0])} has position {row[bad[0], 0]:g} and velocity {row[bad[0], 1]:g} at t = {t:g} s: the "
            "run has broken down; lower --dt, or check the model"
        )
