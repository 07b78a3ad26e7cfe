"""Where balances come from: a slide or hinge, or a user's own model; and the stated model at a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import Nuisance
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import PlainBalances
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.simulation.augmented import BESIDE
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint
from stochfric_mb.scenario import Scenario


def source_of(dataset: Dataset) -> Balances:
    """Return the balances of a dataset.

    Raises:
        InputError: the mechanism is no driven joint, or its model or a channel cannot be used.
    """
    mechanism: Any = dataset.scenario.mechanism
    if isinstance(mechanism, Mjcf):
        from stochfric_mb.discovery.driven_joint.mjcf.loaded_model import mjcf_balances

        return mjcf_balances(dataset)
    if isinstance(mechanism, PrismaticJoint | HingePendulum):
        return PlainBalances(dataset)
    raise InputError(
        f"mechanism {mechanism.kind!r} is no driven joint; use prismatic_joint, hinge_pendulum, spring_slider or mjcf"
    )


def prior_model(scenario: Scenario[Any], place: str, nuisances: Sequence[Nuisance], load: float) -> JointModel:
    """Return the model as stated at a place whose load is ``load`` [N or N m]."""
    acts_in = getattr(scenario.mechanism, "effects_in", ())
    own = () if acts_in and place not in acts_in else tuple(e for e in scenario.effects if e.group not in BESIDE)
    contact = place in getattr(scenario.mechanism, "pairs", ())
    mu_k, spread = scenario.law.mu_k, scenario.uncertainty.get("mu_k", 0.0)
    level = mu_k, spread * mu_k if spread > 0.0 else float("inf")
    return JointModel(scenario.law, own, {n.name: n.value for n in nuisances}, load, contact, level)
