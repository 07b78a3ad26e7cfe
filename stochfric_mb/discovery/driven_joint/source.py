"""Where the balances of a dataset come from: a slide or hinge, or a user's own model."""

from __future__ import annotations

from typing import Any

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import PlainBalances
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint


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
