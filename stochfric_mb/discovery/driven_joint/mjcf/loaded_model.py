"""A user's model as MuJoCo has it: without friction of its own, masses as corrected; for the engine with ours in a pair."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import copy
import importlib
from typing import Any

from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import scale_masses
from stochfric_mb.discovery.driven_joint.mjcf.geom_pairs import geom_numbers, reach_out
from stochfric_mb.discovery.driven_joint.mjcf.inverse import MjcfSource
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import require_loops
from stochfric_mb.errors import InputError, MissingEngineError, require_name
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import Mjcf

PRESLIDING = 1.0e-5
"""Presliding displacement of the law in a pair [m]: it holds at rest."""


def mjcf_balances(dataset: Dataset) -> MjcfSource:
    """Return the balances of a dataset whose mechanism is an MJCF model.

    Raises:
        InputError: the file, a joint, a tendon, a geom or a channel is unknown or unsuitable.
        MissingEngineError: MuJoCo is not installed.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError:
        raise MissingEngineError("mechanism 'mjcf' needs MuJoCo; run: pip install 'stochfric_mb[mujoco]'") from None
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
    require_loops(dataset)
    shapes = None
    if mechanism.pairs:
        for pair in mechanism.pairs.values():
            geom_numbers(mujoco, model, pair)
        shapes = copy.copy(model)
        reach_out(mujoco, shapes)
        # what contacts push with is asked of the balance: the soft contacts of the model have no part in it
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    return MjcfSource(dataset, mechanism, mujoco, model, tuple(names), tuple(tendons), shapes)


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
        if friction is None:
            model = mujoco.MjModel.from_xml_path(str(mechanism.file))
        else:
            attach: Any = importlib.import_module("stochfric_mb.mujoco")
            spec = mujoco.MjSpec.from_file(str(mechanism.file))
            name, mu_s, mu_k = friction
            attach.add_friction(spec, mechanism.pairs[name].geoms, ElasticStick(mu_s=mu_s, mu_k=mu_k, e_lim=PRESLIDING))
            model = spec.compile()
    except ValueError as error:
        raise InputError(f"mechanism.file = {str(mechanism.file)!r} cannot be read: {error}") from None
    model.dof_frictionloss[:] = 0.0
    model.tendon_frictionloss[:] = 0.0
    scale_masses(mujoco, model, mechanism.factors.get("mass", 1.0))
    model.dof_armature *= mechanism.factors.get("armature", 1.0)
    return model
