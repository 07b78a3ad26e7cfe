"""A user's model as MuJoCo has it: without friction of its own, masses as corrected; for the engine with ours in a pair."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
import importlib
import math
from collections.abc import Mapping
from typing import Any

from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import add_payload, scale_masses
from stochfric_mb.discovery.driven_joint.mjcf.geom_pairs import geom_numbers, reach_out
from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import joint_loops
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import position_of_joint
from stochfric_mb.errors import InputError, MissingEngineError, require_name
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Mjcf

PRESLIDING = 1.0e-5
"""Presliding displacement of the law in a pair [m]: it holds at rest."""
LEEWAY = 0.1
"""How far beyond its range a joint may go in a record that has the right unit, over the range [-]: stops are soft."""
OTHER_UNITS = {"rad": {"deg": math.pi / 180.0}, "m": {"mm": 1.0e-3, "um": 1.0e-6}}
"""SI unit of a joint's position -> units in which it may really be, with their size in it."""


def mjcf_balances(dataset: Dataset) -> MjcfSource:
    """Return the balances of a dataset whose mechanism is an MJCF model.

    Raises:
        InputError: the file, a joint, a tendon, a geom or a channel is unknown or unsuitable.
        MissingEngineError: MuJoCo is not installed.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError:
        raise MissingEngineError(
            "mechanism 'mjcf' needs MuJoCo; in a clone of this package run: pip install '.[mujoco]'"
        ) from None
    mechanism: Mjcf = dataset.scenario.mechanism
    model = without_friction(mujoco, mechanism)
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
            "every joint needs one in mechanism.positions, hinge or slide; of one that stays, its number"
        )
    for run in dataset.test:
        joint_loops(run, mechanism, dataset.scenario.controller)  # refuses what cannot be simulated
    _require_ranges(dataset, mechanism, mujoco, model)
    shapes = None
    if mechanism.pairs:
        for pair in mechanism.pairs.values():
            geom_numbers(mujoco, model, pair)
        shapes = copy.copy(model)
        reach_out(shapes)
    # soft contacts and stops push by how deep noise puts them, and overlapping geoms of neighbours always: forces that a motion
    # needs know none of them, and what a pair is pressed with is asked of the balance
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    return MjcfSource(dataset, mechanism, mujoco, model, tuple(names), tuple(tendons), shapes)


def _require_ranges(dataset: Dataset, mechanism: Mjcf, mujoco: Any, model: Any) -> None:
    """Require that no record lies far beyond a joint's range where another unit would bring it back within."""
    for i in range(model.njnt):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, i)
        column = mechanism.positions[name]
        if not model.jnt_limited[i] or isinstance(column, float):
            continue
        si = "rad" if model.jnt_type[i] == mujoco.mjtJoint.mjJNT_HINGE else "m"
        low, high = model.jnt_range[i]
        for run in dataset.runs:
            q = position_of_joint(run, mechanism, name)
            unit = _better_unit(float(q.min()), float(q.max()), low, high, OTHER_UNITS[si])
            if unit is not None:
                raise InputError(
                    f"{run.source}: joint {name!r} goes from {q.min():.4g} to {q.max():.4g} {si}, but its range in "
                    f"{mechanism.file.name} is {low:.4g} to {high:.4g} {si}. Column {column!r} is probably in {unit}: write "
                    f"its header as '{column} [{unit}]'"
                )


def _better_unit(first: float, last: float, low: float, high: float, units: Mapping[str, float]) -> str | None:
    """Return the unit in which a motion lies in a range that it leaves by more than its whole width; None if none does."""
    width, slack = high - low, LEEWAY * (high - low)
    if low - width <= first and last <= high + width:
        return None
    return next((unit for unit, size in units.items() if low - slack <= size * first and size * last <= high + slack), None)


def without_friction(mujoco: Any, mechanism: Mjcf, friction: tuple[str, float, float] | None = None) -> Any:
    """Return the compiled model without friction of its own, masses and armature as corrected.

    Args:
        mujoco: the module.
        mechanism: the mechanism.
        friction: name of a pair, mu_s and mu_k: our plugin gives it elastic-stick friction; None: no pair has any.

    Raises:
        InputError: the file cannot be read.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(mechanism.file))  # a spec warns as Python does: once, and in no MUJOCO_LOG.TXT
        if friction is not None:
            attach: Any = importlib.import_module("stochfric_mb.mujoco")
            name, mu_s, mu_k = friction
            attach.add_friction(spec, mechanism.pairs[name].geoms, ElasticStick(mu_s=mu_s, mu_k=mu_k, e_lim=PRESLIDING))
        model = spec.compile()
    except ValueError as error:
        raise InputError(f"mechanism.file = {str(mechanism.file)!r} cannot be read: {error}") from None
    model.dof_frictionloss[:] = 0.0
    model.tendon_frictionloss[:] = 0.0
    scale_masses(mujoco, model, mechanism.factors.get("mass", 1.0))
    add_payload(mujoco, model, mechanism.payload)
    model.dof_armature *= mechanism.factors.get("armature", 1.0)
    return model
