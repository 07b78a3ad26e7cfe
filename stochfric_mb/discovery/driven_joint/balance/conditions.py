"""The conditions of a run that friction may answer to: speed, position, load, time, distance slid, temperature, constants."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import distance_slid
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, narrowest
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.temperature import temperature_of

Array = npt.NDArray[np.float64]


def known_temperature(run: Run) -> Array:
    """Return the measured temperature [degC], shape (count,); zeros where there is none, and no effect that asks for it."""
    seen = temperature_of(run)
    return np.zeros(len(run.time)) if seen is None else seen


def temperature_through(run: Run, window: Window) -> Array | None:
    """Return the measured temperature through a window [degC], shape (count,); None: there is none."""
    seen = temperature_of(run)
    return None if seen is None else window.held(window.through(seen))


def distance_before(run: Run, runs: Sequence[Run], velocity: Callable[[Run], Array]) -> float:
    """Return the distance slid in earlier pieces of the record that a run is a piece of [m or rad].

    Args:
        run: the run.
        runs: all runs of its dataset.
        velocity: velocity of a run through its narrowest window, shape (count,).
    """
    earlier = [r for r in runs if run.source and r.source == run.source and r.time[-1] <= run.time[0]]
    return sum(float(distance_slid(velocity(r), narrowest(r))[-1]) for r in earlier)


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
    table = {
        "direction": np.sign(velocity[at]),
        "speed": np.abs(velocity[at]),
        "position": position[at],
        "load": load[at],
        "time": run.time[at],
        "distance": travelled[at],
    }
    temperature = temperature_through(run, window)
    if temperature is not None:
        table["temperature"] = temperature[at]
    return table | {key: np.full(len(at), value) for key, value in run.constants.items()}
