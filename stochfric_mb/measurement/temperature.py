"""Measured temperature of a run."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from stochfric_mb.measurement.run import Run

ZERO = 273.15
"""0 degC [K]."""


def temperature_of(run: Run) -> npt.NDArray[np.float64] | None:
    """Return the measured temperature [degC], shape (count,), whatever it was recorded in; None: there is none."""
    if "temperature" not in run.channels:
        return None
    return run.channels["temperature"] - (ZERO if run.units.get("temperature") == "K" else 0.0)
