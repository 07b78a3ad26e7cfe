"""The scenario as discovery believes it: every law as Coulomb friction plus the effects that make up the difference."""

from __future__ import annotations

import dataclasses

from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.scenario import Scenario

LAWS = ("coulomb", "elastic_stick", "stribeck")
"""Laws that the fast simulator takes."""
USUAL_UNCERTAINTY = {"mass": 0.01, "stiffness": 0.02, "damping": 0.3}
"""Relative standard deviations of a rig of which nobody said how well it is known [-]: weighed, its spring measured, its
damping guessed from a decay. To take them for exact would make an effect of every small error."""
NOT_STATED = "the scenario states no [uncertainty]; taken were " + ", ".join(
    f"{name} = {value:g}" for name, value in USUAL_UNCERTAINTY.items()
)
"""What is said then."""


def prior_model(scenario: Scenario) -> Model:
    """Return the stated model: the scenario's law, process and effects, nothing corrected yet.

    An effect that draws coefficients declares the process that they are drawn from.

    Raises:
        InputError: a law that the simulator of discovery does not take.
    """
    if scenario.law.kind not in LAWS:
        raise InputError(
            f"law {scenario.law.kind!r} cannot be the stated law of a discovery; use one of {', '.join(LAWS)} "
            "(a regularised law is a Coulomb law that creeps: state the Coulomb law it stands for)"
        )
    stated = {e: e.coefficient_process() for e in getattr(scenario, "effects", ())}
    effects = tuple(e for e, process in stated.items() if process is None)
    process = next((p for p in (scenario.process, *stated.values()) if p is not None), None)
    return Model(scenario.law, {}, effects, process, stated=frozenset(effects))


def assumed(dataset: Dataset) -> Dataset:
    """Return the data set with usual uncertainties where its scenario states none at all."""
    if dataset.scenario.uncertainty:
        return dataset
    return dataclasses.replace(dataset, scenario=dataclasses.replace(dataset.scenario, uncertainty=USUAL_UNCERTAINTY))
