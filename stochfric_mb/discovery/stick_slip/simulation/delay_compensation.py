"""Records whose sensor is late, put back on time: a known force then meets the motion that it drove.

Where nothing known acts on the box as time goes by, no force tells a late record from one on time.
"""

from __future__ import annotations

import dataclasses

from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.study import Study, study
from stochfric_mb.effects import kind_with_signature, make_effect
from stochfric_mb.effects.traits import LATE


def driven(study: Study) -> bool:
    """Return whether a known force acts on the box."""
    return any(r.mechanism.excitation_amplitude for r in study.records)


def delay_compensated(result: Study, delay: float) -> Study:
    """Return the study of the same runs, each sample moved to the time at which the box was where it shows it.

    Args:
        result: the study of the runs as recorded.
        delay: by how much the sensor is late [s].
    """
    runs = tuple(dataclasses.replace(run, time=run.time - delay) for run in result.dataset.runs)
    again = study(dataclasses.replace(result.dataset, runs=runs))
    assert again is not None  # the same slips, at other times
    return again


def without_delay(model: Model) -> Model:
    """Return the model of records put on time."""
    return model.keeping([i for i, e in enumerate(model.effects) if LATE not in e.signatures])


def with_delay(model: Model, delay: float) -> Model:
    """Return the model of the records as they are."""
    return model.plus(make_effect(kind_with_signature(LATE), delay=delay))
