"""Pictures for the report, as data: what is drawn, not how."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.fit.wave_scan import with_phases

if TYPE_CHECKING:
    from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome

Array = npt.NDArray[np.float64]
Picture = tuple[str, str, dict[str, Any]]
"""Title, caption, and panels with their series."""

MOST = 1500
"""Most points of a series."""


def friction_picture(place: PlaceOutcome) -> Picture:
    """Return friction against velocity, and what the models leave of it against time, on the held-out runs of a place."""
    balances = place.test
    unit = balances[0].unit
    rate = "rad/s" if unit == "N m" else "m/s"
    at = [s.window.centres[s.sliding] for s in balances]
    speed = np.concatenate([s.velocity[c] for s, c in zip(balances, at, strict=True)])
    time = np.concatenate([s.time[c] for s, c in zip(balances, at, strict=True)])
    selected = place.selected
    models = {
        "recalibrated": selected.recalibrated.model,
        "augmented": with_phases(selected.final.model, balances, selected.nuisances),
    }
    along = {n: np.concatenate([m.friction(s)[s.sliding] for s in balances]) for n, m in models.items()}
    rest = {n: np.concatenate([m.remainder(s, place.nuisances)[s.sliding] for s in balances]) for n, m in models.items()}
    data = along["augmented"] + rest["augmented"]
    some = np.unique(np.linspace(0, len(speed) - 1, min(MOST, len(speed))).round().astype(int))
    left = [_points("data", speed[some], data[some]), *(_points(n, speed[some], along[n][some]) for n in models)]
    right = [_points(n, time[some], rest[n][some]) for n in models]
    panels = [
        {"x": f"velocity [{rate}]", "y": f"friction [{unit}]", "series": left},
        {"x": "time [s]", "y": f"residual [{unit}]", "series": right},
    ]
    title = f"Friction in {place.thing} {place.place}" if place.place else "Friction"
    caption = (
        "Held-out runs. Left: friction from inverse dynamics and as the models have it. Right: residual while the joint slides."
    )
    return title, caption, {"panels": panels}


def step_picture(time: Array, series: dict[str, Array]) -> Picture:
    """Return the friction coefficient against time, shape (n,) each: the data and the models.

    Lines break where time steps back: there another record begins.
    """
    some = np.unique(np.linspace(0, len(time) - 1, min(2 * MOST, len(time))).round().astype(int))
    begins = np.flatnonzero(np.diff(time[some]) < 0.0) + 1
    x = np.insert(time[some], begins, np.nan)
    drawn = [_points(n, x, np.insert(y[some], begins, np.nan), "points" if n == "data" else "line") for n, y in series.items()]
    panel = {"x": "time [s]", "y": "friction coefficient", "series": drawn}
    return "Velocity steps", "All runs, those that were held out included.", {"panels": [panel]}


def _points(name: str, x: Array, y: Array, draw: str = "points") -> dict[str, Any]:
    return {"name": name, "x": x.tolist(), "y": y.tolist(), "draw": draw}
