"""Where the balances of a dataset come from: a slide or hinge, or a user's own model."""

from __future__ import annotations

from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import PlainBalances
from stochfric_mb.discovery.driven_joint.balance.timing import SHORT_RUN
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import HingePendulum, Mjcf, PrismaticJoint


def source_of(dataset: Dataset) -> Balances:
    """Return the balances of a dataset.

    Raises:
        InputError: the mechanism is no driven joint, or its model, a channel or a stated delay cannot be used.
    """
    _require_short_delay(dataset)
    mechanism: Any = dataset.scenario.mechanism
    if isinstance(mechanism, Mjcf):
        from stochfric_mb.discovery.driven_joint.mjcf.loaded_model import mjcf_balances

        return mjcf_balances(dataset)
    if isinstance(mechanism, PrismaticJoint | HingePendulum):
        return PlainBalances(dataset)
    raise InputError(
        f"mechanism {mechanism.kind!r} is no driven joint; use prismatic_joint, hinge_pendulum, spring_slider or mjcf"
    )


def _require_short_delay(dataset: Dataset) -> None:
    """Raise an error where a stated delay leaves too little of a run."""
    shortest = min((float(np.ptp(run.time)) for run in dataset.runs), default=np.inf)  # a plan has no runs yet
    for effect in getattr(dataset.scenario, "effects", ()):
        if abs(effect.late) > SHORT_RUN * shortest:
            raise InputError(
                f"{effect.kind} is late by {effect.late:g} s, more than {100.0 * SHORT_RUN:g} % of the shortest run "
                f"({shortest:g} s); give it in s, not in ms, or leave it out"
            )
