"""The scenario as discovery believes it: every law as Coulomb friction plus the effects that make up the difference."""

from __future__ import annotations

from stochfric_mb.discovery.model import Model
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import Scenario

LAWS = ("coulomb", "elastic_stick", "stribeck")
"""Laws that the fast simulator takes."""


def believed_model(scenario: Scenario) -> Model:
    """Return what is believed: the scenario's law, process and effects, nothing corrected yet.

    Raises:
        InputError: a law that the simulator of discovery does not take.
    """
    if scenario.law.kind not in LAWS:
        raise InputError(
            f"law {scenario.law.kind!r} cannot be the believed law of a discovery; use one of {', '.join(LAWS)} "
            "(a regularised law is a Coulomb law that creeps: state the Coulomb law it stands for)"
        )
    return Model(scenario.law, {}, tuple(getattr(scenario, "effects", ())), scenario.process)
