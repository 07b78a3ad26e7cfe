"""Measured columns of a run for an MJCF model, and the model as corrected by data."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import PAYLOADS
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.measurement.quantities import KNOWN
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.units import to_si
from stochfric_mb.mechanisms import Mjcf

Array = npt.NDArray[np.float64]


def corrected(mechanism: Mjcf, corrections: Mapping[str, Mapping[str, float]]) -> Mjcf:
    """Return the mechanism with what data have corrected: place -> number -> value.

    Masses, payload and armature belong to the whole model: those of the first place given are taken.
    """
    first = next(iter(corrections.values()))
    drives = {
        j: dataclasses.replace(d, gain=d.gain * corrections.get(j, {}).get("gain", 1.0)) for j, d in mechanism.drives.items()
    }
    damping = {j: c * corrections.get(j, {}).get("damping", 1.0) for j, c in mechanism.damping.items()}
    offset = {j: mechanism.offset.get(j, 0.0) + values.get("offset", 0.0) for j, values in corrections.items()}
    factors = {k: mechanism.factors.get(k, 1.0) * first.get(k, 1.0) for k in ("mass", "armature")}
    # one that is stated is a mass of the model, and none is looked for beside it
    payload = {place: x * first.get("mass", 1.0) for place, x in mechanism.payload.items()} or payload_of(first)
    return dataclasses.replace(mechanism, drives=drives, damping=damping, offset=offset, factors=factors, payload=payload)


def payload_of(numbers: Mapping[str, float]) -> dict[str, float]:
    """Return the payload among the corrected numbers of a model: place -> mass [kg]."""
    return {place: numbers[name] for place, name in PAYLOADS.items() if name in numbers}


def drive_of(run: Run, mechanism: Mjcf, place: str) -> Array:
    """Return the measured driving force of a joint or tendon [N or N m], shape (count,); zeros where nothing drives it.

    Raises:
        InputError: one of its columns is missing.
    """
    drive = mechanism.drives.get(place)
    return np.zeros(len(run.time)) if drive is None else product(run, drive.gain, drive.columns)


def back_emf(run: Run, mechanism: Mjcf, place: str) -> float:
    """Return the damping that is no part of the load of a joint or tendon: a motor's back-EMF [N s/m or N m s/rad].

    Where the drive is a voltage, alone or as a part of it, the stated damping is that. What a torque or force drives transmits
    all of it: 0.
    """
    drive = mechanism.drives.get(place)
    if drive is None or not (len(drive.columns) > 1 or any(c == "voltage" or run.units.get(c) == "V" for c in drive.columns)):
        return 0.0
    return mechanism.damping.get(place, 0.0)


def product(run: Run, gain: float, names: Sequence[str]) -> Array:
    """Return a gain times columns of a run, shape (count,)."""
    force = np.full(len(run.time), gain)
    for name in names:
        force = force * column(run, name)
    return force


def position_of_joint(run: Run, mechanism: Mjcf, joint: str) -> Array:
    """Return the measured position of a joint, or the number at which it stays [m or rad], shape (count,)."""
    given = mechanism.positions[joint]
    return in_si(run, given, "position") if isinstance(given, str) else np.full(len(run.time), given)


def in_si(run: Run, name: str, quantity: str) -> Array:
    """Return a channel, or a covariate brought from the unit of its header to the SI unit of a quantity.

    Raises:
        InputError: the run has none of that name, or its unit is none of that quantity.
    """
    values, unit = column(run, name), run.units.get(name, "")
    if name in run.channels or not unit:
        return values
    try:
        return to_si(values, unit, KNOWN[quantity], rotational=None)[0]
    except InputError as error:
        raise InputError(f"run {run.name!r}: column {name!r} is used as {quantity}: {error}") from None


def column(run: Run, name: str) -> Array:
    """Return a channel or covariate of a run.

    Raises:
        InputError: it has none of that name.
    """
    known = {**run.covariates, **run.channels}
    return known[require_name(f"column of run {run.name} (for the mechanism)", name, known)]


def position_columns(mechanism: Any) -> tuple[str, ...]:
    """Return the names of the columns that hold measured positions."""
    given = mechanism.positions.values() if isinstance(mechanism, Mjcf) else ("position",)
    return tuple(dict.fromkeys(x for x in given if isinstance(x, str)))


def with_column(run: Run, name: str, values: Array) -> Run:
    """Return the run with another channel or covariate in the place of the one of that name."""
    where = "channels" if name in run.channels else "covariates"
    return dataclasses.replace(run, **{where: {**getattr(run, where), name: values}})
