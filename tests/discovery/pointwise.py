"""The plain way, for comparison: differentiate, regress the force sample by sample, drop terms by BIC, name the largest.

It is treated kindly. Samples next to a break-away or re-stick, where the derivative is smeared, are left out; samples
are taken half a smoothing window apart, so that BIC counts nearly independent ones; stiffness, mass and damping may be
anything.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.ndimage import binary_erosion
from scipy.signal import savgol_filter

from stochfric_mb.measurement.dataset import Run, load_dataset

Array = npt.NDArray[np.float64]

WINDOW = 31
"""Samples under the cubic that is differentiated: 31 ms, a fifth of a slip."""
PERIODS = (60.0, 30.0, 15.0, 7.0, 3.0, 1.5, 0.7, 0.3)
"""Of harmonic forces [s]."""
WAVELENGTHS = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)
"""Along the belt [m]."""
VELOCITIES = (5e-3, 15e-3)
"""Decay velocities of a weakening law [m/s]."""
LENGTHS = (2e-4, 1e-3)
"""Slip distances over which friction forgets [m]."""
STATED = ("coulomb", "stiffness", "mass", "damping")
"""Terms that are always there and are no effect."""


@dataclass(frozen=True)
class Term:
    """Columns of the library that stand or fall together; shape (samples, columns)."""

    kind: str
    columns: Array


def samples(run: Run, scenario: Any) -> tuple[Array, list[Term]]:
    """The friction force of a run's slip samples [N], and the library there."""
    box = run.mechanism(scenario)
    time, position = run.time, run.channels["position"]
    x, velocity, acceleration = (savgol_filter(position, WINDOW, 3, deriv=d, delta=1e-3) for d in range(3))
    relative = box.belt_velocity - velocity
    slipping = np.abs(relative) > 2.0 * abs(box.belt_velocity)
    start = np.maximum.accumulate(np.where(slipping & ~np.roll(slipping, 1), np.arange(time.size), 0))
    end = np.maximum.accumulate(np.where(~slipping & np.roll(slipping, 1), np.arange(time.size), 0))
    kept = np.flatnonzero(binary_erosion(slipping, iterations=WINDOW // 2))[:: WINDOW // 2]
    v, t, sign = relative[kept], time[kept], np.sign(relative[kept])
    forcing = box.stiffness * box.excitation_amplitude * np.cos(box.excitation_angular_frequency * t)
    force = box.mass * acceleration[kept] + box.damping * velocity[kept] + box.stiffness * x[kept] - forcing
    load, belt = box.normal_force, box.belt_velocity * t - x[kept]
    slid = np.abs(belt - (box.belt_velocity * time - x)[start[kept]])
    dwell = np.maximum(time[start[kept]] - time[end[kept]], 1e-3)

    def waves(phases: list[Array]) -> Array:
        return np.column_stack([f(p) for p in phases for f in (np.sin, np.cos)])

    terms = [
        Term("coulomb", sign * load),
        Term("stiffness", x[kept]),
        Term("mass", acceleration[kept]),
        Term("damping", velocity[kept]),
        Term("viscous_friction", load * v),  # at one operating point the same as damping, which comes first
        Term("quadratic_damping", v * np.abs(v)),
        Term("nonlinear_stiffness", x[kept] ** 3),
        Term("friction_drift", sign * load * t),
        Term("direction_asymmetry", np.full(kept.size, load)),
        Term("load_dependence", sign * load**2),
        Term("dwell_ageing", sign * load * np.log(dwell)),
        *(Term("velocity_weakening", sign * load * np.exp(-np.abs(v) / w)) for w in VELOCITIES),
        *(Term("frictional_lag", sign * load * np.exp(-slid / length)) for length in LENGTHS),
        *(Term("harmonic_force", waves([2.0 * np.pi * t / period])) for period in PERIODS),
        *(Term("position_dependent_friction", load * waves([2.0 * np.pi * belt / w])) for w in WAVELENGTHS),
    ]
    return force, [Term(term.kind, term.columns.reshape(kept.size, -1)) for term in terms]


def selected(force: Array, terms: list[Term]) -> list[tuple[str, float]]:
    """Terms of the set with the least BIC, and the root mean square of their force [N]; thrown out smallest first.

    What the terms of the stated model can explain is taken out of the force and of all terms before.
    """
    stated = np.hstack([term.columns for term in terms if term.kind in STATED])
    basis = np.linalg.qr(stated / np.linalg.norm(stated, axis=0))[0]
    force = force - basis @ (basis.T @ force)
    left = [Term(t.kind, t.columns - basis @ (basis.T @ t.columns)) for t in terms if t.kind not in STATED]
    whole = [np.linalg.norm(t.columns) for t in terms if t.kind not in STATED]
    left = [t for t, norm in zip(left, whole, strict=True) if np.linalg.norm(t.columns) > 1e-6 * norm]  # else the same
    best: tuple[float, list[tuple[str, float]]] = (force.size * np.log(np.mean(force**2)), [])
    while left:
        matrix = np.hstack([term.columns for term in left])
        scales = np.linalg.norm(matrix, axis=0)
        parts = matrix * (np.linalg.lstsq(matrix / scales, force)[0] / scales)
        ends = np.cumsum([term.columns.shape[1] for term in left])[:-1]
        sizes = [float(np.std(part.sum(axis=1))) for part in np.split(parts, ends, axis=1)]
        bic = force.size * np.log(np.mean((force - parts.sum(axis=1)) ** 2)) + matrix.shape[1] * np.log(force.size)
        if bic < best[0]:
            best = (bic, [(term.kind, size) for term, size in zip(left, sizes, strict=True)])
        smallest = int(np.argmin(sizes))
        left = left[:smallest] + left[smallest + 1 :]
    return best[1]


def by_points(dataset: Path, out: Path) -> None:
    """Leave a result.json with the largest selected term's name; this way has no "unknown" and no forecasts."""
    data = load_dataset(dataset)
    items = [samples(run, data.scenario) for run in data.fit]
    force = np.concatenate([f for f, _ in items])
    joined = [Term(same[0].kind, np.vstack([t.columns for t in same])) for same in zip(*(t for _, t in items), strict=True)]
    terms = selected(force, joined)
    effects = [{"kind": max(terms, key=lambda term: term[1])[0], "equivalent_to": []}] if terms else []
    out.mkdir(parents=True, exist_ok=True)
    result = {"verdict": "effect" if effects else "none", "effects": effects, "gap": None}
    (out / "result.json").write_text(json.dumps(result))
