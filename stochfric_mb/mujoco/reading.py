"""What can be read of a friction while the model runs."""

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.plugin.frictions import DOFS, PAIRS, slot_of
from stochfric_mb.mujoco.plugin.sensor import report

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Reading:
    """One contact, joint or tendon, in the step that ended last, or at the last evaluation after it."""

    time: float
    """Time [s]."""
    body: str
    """Geom on which ``force`` acts; a joint's or tendon's name."""
    surface: str
    """The counter-surface; empty for a joint or tendon."""
    force: tuple[float, float, float]
    """Friction force on the body [N], world axes; for a joint or tendon, along its coordinate [N or N m], 0, 0."""
    normal_force: float
    """Normal force that the law was given [N]."""
    mu_s: float
    """Static coefficient [-]."""
    mu_k: float
    """Kinetic coefficient [-]."""
    stick: bool
    """Whether the contact sticks."""
    displacement: tuple[float, float]
    """Relative displacement, surface minus body, in the contact's tangent frame [m]."""
    velocity: tuple[float, float]
    """Relative velocity, likewise [m/s]."""
    effective_mass: float
    """Mass that the contact feels [kg], 0 for laws that do not use it."""
    stick_phases: int
    """How many times the contact has begun to stick since it was made."""
    dissipated: float
    """Energy dissipated since the contact was made [J]."""
    converged: bool
    """Whether MuJoCo's solver ended within its limit of iterations in all steps so far."""
    stable: bool
    """Whether all explicit steps so far were within the stability limit of the law."""


def readings(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, list[Reading]]:
    """Return what each friction instance did at its contacts, by instance name.

    After ``mj_step`` these are the forces in the step that has just ended, with position and velocity at its start;
    after ``mj_forward`` everything belongs to ``data.time``.
    """
    return {name: readings_of(model, data, state_of(model, data, i)) for name, i in instances(model).items()}


def readings_of(model: mujoco.MjModel, data: mujoco.MjData, state: Array) -> list[Reading]:
    """Return what the friction that has this state did at its contacts."""
    block = report(model._address, data._address, state.ctypes.data)
    return [reading_of(model, state, row) for row in s.slots_of(state, committed=block == 0)]


def instances(model: mujoco.MjModel, *plugins: str) -> dict[str, int]:
    """Return the numbers of a model's friction instances by name, a number with a # if one has none.

    Args:
        model: the model.
        plugins: `PAIRS` or `DOFS`; both if not given.
    """
    slots = [slot_of(plugin) for plugin in plugins or (PAIRS, DOFS)]
    return {name_in(model, mujoco.mjtObj.mjOBJ_PLUGIN, i): i for i in range(model.nplugin) if model.plugin[i] in slots}


def state_of(model: mujoco.MjModel, data: mujoco.MjData, instance: int) -> Array:
    """Return the state of one instance (a view), laid out as `memory.state` says."""
    first = int(model.plugin_stateadr[instance])
    return data.plugin_state[first : first + int(model.plugin_statenum[instance])]


def diverged(data: mujoco.MjData) -> bool:
    """Return whether MuJoCo has met a state that is not finite or huge."""
    warnings = mujoco.mjtWarning
    return any(data.warning[int(w)].number for w in (warnings.mjWARN_BADQPOS, warnings.mjWARN_BADQVEL, warnings.mjWARN_BADQACC))


def name_in(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    """Return the name of an object of a model, its number with a # if it has none."""
    return mujoco.mj_id2name(model, kind, number) or f"#{number}"


def reading_of(model: mujoco.MjModel, state: Array, row: Any) -> Reading:
    """Return the reading of one contact from its instance's state and its slot there."""
    header = state[: s.N_HEADER].view(s.HEADER)[0]  # fields by index: by attribute each takes microseconds
    if header["place"] != s.PAIR:
        kind = mujoco.mjtObj.mjOBJ_TENDON if header["place"] == s.TENDON else mujoco.mjtObj.mjOBJ_JOINT
        body, surface = name_in(model, kind, int(header["geom_surface"])), ""
        force: Any = (row["fx"], 0.0, 0.0)
    else:
        pair = [int(row["geom_1"]) - 1, int(row["geom_2"]) - 1]
        if pair[1] == header["geom_body"] or (header["geom_body"] < 0 and pair[0] == header["geom_surface"]):
            pair.reverse()
        body, surface = (name_in(model, mujoco.mjtObj.mjOBJ_GEOM, g) for g in pair)
        force = row["fx"] * row["axis_1"] + row["fy"] * row["axis_2"]
    return Reading(
        time=float(header["evaluated"]),
        body=body,
        surface=surface,
        force=(float(force[0]), float(force[1]), float(force[2])),
        normal_force=float(row["normal"]),
        mu_s=float(row["mu_s"]),
        mu_k=float(row["mu_k"]),
        stick=bool(row["stick"]),
        displacement=(float(row["ux"]), float(row["uy"])),
        velocity=(float(row["vx"]), float(row["vy"])),
        effective_mass=float(row["mass"]),
        stick_phases=int(row["events"]),
        dissipated=float(row["energy"]),
        converged=bool(header["unconverged"] == 0.0),
        stable=bool(header["beyond"] == 0.0),
    )
