"""The conditions of a run that friction may answer to: speed, position, load, time, distance slid, temperature, constants."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.joints.sheet import distance_slid
from stochfric_mb.discovery.joints.windows import Window
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]


def temperature_of(run: Run, window: Window) -> Array | None:
    """Return the measured temperature in the unit of its channel, shape (count,); None: there is none."""
    if "temperature" not in run.channels:
        return None
    return window.through(run.channels["temperature"])


def distance_before(run: Run, runs: Sequence[Run], velocity: Callable[[Run], Array]) -> float:
    """Return the distance slid in earlier pieces of the record that a run is a piece of [m or rad].

    Args:
        run: the run.
        runs: all runs of its dataset.
        velocity: velocity of a run, shape (count,).
    """
    earlier = [r for r in runs if run.source and r.source == run.source and r.time[-1] <= run.time[0]]
    return sum(float(distance_slid(velocity(r), r.sample_interval)[-1]) for r in earlier)


def known_factors(
    run: Run, window: Window, position: Array, velocity: Array, load: Array, travelled: Array
) -> dict[str, Array]:
    """Return the conditions that friction may depend on, at the centres of the windows: name -> shape (n_centres,).

    Args:
        run: the run.
        window: its window.
        position: position [m or rad], shape (count,).
        velocity: velocity [m/s or rad/s], shape (count,).
        load: load that is transmitted, or normal force [N or N m], shape (count,).
        travelled: distance slid [m or rad], shape (count,).
    """
    at = window.centres
    found = {
        "direction": np.sign(velocity[at]),
        "speed": np.abs(velocity[at]),
        "position": position[at],
        "load": load[at],
        "time": run.time[at],
        "distance": travelled[at],
    }
    temperature = temperature_of(run, window)
    if temperature is not None:
        found["temperature"] = temperature[at]
    return found | {key: np.full(len(at), value) for key, value in run.constants.items()}
