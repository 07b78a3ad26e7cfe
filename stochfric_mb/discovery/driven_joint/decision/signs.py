"""Signs: friction that brings in energy, and drives that fit the motion when they are turned round."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.decision.selection import Selector
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.signs import SEGMENTS, probable_sign_error, turned_round
from stochfric_mb.mechanisms import Mjcf

TURNED = 0.5
"""Part of the error that is left with the drive turned round, below which its sign is probably wrong."""
BY_SCALE = 1.5
"""Factor from which a drive is too small by its scale [-]: gains and masses are believed to be nearer."""
DRIVES = ("voltage", "force", "torque")
"""Channels that drive a slide or hinge."""


def sign_notes(dataset: Dataset, place: str, balances: Sequence[ForceBalance]) -> list[str]:
    """Return what looks like a wrong sign at a place, by the balance of forces with the drive as given and turned round.

    Args:
        dataset: the dataset.
        place: name of the joint, tendon or pair; empty where there is one only.
        balances: its fit runs.

    Raises:
        InputError: friction brings in energy in a run.
    """
    require_dissipation(dataset, place, balances)
    return _fits_turned(dataset, place, balances)


def require_dissipation(dataset: Dataset, place: str, balances: Sequence[ForceBalance]) -> None:
    """Return if friction, as inverse dynamics has it, takes energy out of the motion of runs; arguments as of `sign_notes`.

    Raises:
        InputError: it feeds the motion of a run: the drive is dead, or its sign is wrong.
    """
    for balance in balances:
        created = _brought_in(balance)
        if created is not None:
            dead = _dead_drive(dataset, balance.run)
            cause = dead or _wrong_scale(dataset, place, balance) or _sign_or_other(dataset, place, balance)
            raise InputError(
                f"run {balance.run!r}: friction brings in energy ({100 * created:.0f} % of what it exchanges): {cause}"
            )


def _sign_or_other(dataset: Dataset, place: str, balance: ForceBalance) -> str:
    """Return that the sign of a drive is wrong, or that it is not, where friction brings in energy with the other one, too."""
    if place not in getattr(dataset.scenario.mechanism, "pairs", ()):  # with the drives turned round nothing touches there
        turned = source_of(_turned(dataset, place)).balances(place, "fit", 0.0)
        created = next((_brought_in(b) for b in turned if b.run == balance.run), None)
        if created is not None:
            return (
                f"with the drive turned round it does, too ({100 * created:.0f} %), so the sign is not what is wrong: columns "
                "may be swapped, a unit wrong (an angle in degrees that is labelled rad), or the mechanism another one; "
                "compare columns, units and [mechanism] with the rig"
            )
    return f"the sign of the driving force, or of the position, is wrong; {_remedy(dataset, place)}"


def _dead_drive(dataset: Dataset, run: str) -> str:
    """Return what is said of a drive that never changes in a run; nothing where it changes, or where joints have their own."""
    if isinstance(dataset.scenario.mechanism, Mjcf):
        return ""
    channels = next((r.channels for r in dataset.runs if r.name == run), {})
    dead = [k for k in DRIVES if k in channels and np.ptp(channels[k]) == 0.0]
    value = channels[dead[0]][0] + 0.0 if dead else 0.0
    return f"{dead[0]} is {value:g} in all samples: repair a dead channel, or leave the run out" if dead else ""


def _wrong_scale(dataset: Dataset, place: str, balance: ForceBalance) -> str:
    """Return what is said of a drive that a factor makes what the motion and a friction against it need; empty: none does."""
    if balance.drive is None:
        return ""
    drive = balance.window.at_centres(balance.drive)
    needed, at = drive - balance.driven, balance.sliding
    basis = np.stack([drive, -np.sign(balance.velocity[balance.window.centres])], axis=1)[at]
    (factor, friction), *_ = np.linalg.lstsq(basis, needed[at])
    left = float(np.mean((needed[at] - basis @ [factor, friction]) ** 2))
    if factor < BY_SCALE or friction < 0.0 or left > TURNED**2 * float(np.mean(needed[at] ** 2)):
        return ""
    if isinstance(dataset.scenario.mechanism, Mjcf):
        remedy = f"multiply the gain of mechanism.drives.{place or next(iter(dataset.scenario.mechanism.friction))} by it"
    else:
        name = next((k for k in DRIVES if k in dataset.fit[0].channels), DRIVES[0])
        remedy = f"give scale = {{ {name} = {factor:.3g} }}, or the gain that is meant"
    wrong = "its unit or gain is wrong (a current is no torque)"
    return f"{factor:.3g} times the driving force would move the joint so: {wrong}; {remedy}"


def _brought_in(balance: ForceBalance) -> float | None:
    """Return the part of what friction exchanges that it brings into a run [-]; None: it takes energy out, or hardly slides."""
    resistance, velocity = balance.driven[balance.sliding], balance.velocity[balance.window.centres][balance.sliding]
    if len(resistance) < 2 * SEGMENTS:
        return None
    wrong = probable_sign_error(-(resistance - np.median(resistance)), velocity)
    return None if wrong is None else wrong.created


def _remedy(dataset: Dataset, place: str) -> str:
    """Return how the sign of the drive of a place is turned."""
    mechanism: Any = dataset.scenario.mechanism
    if isinstance(mechanism, Mjcf):
        return f"turn the sign of the gain of mechanism.drives.{place or next(iter(mechanism.friction))}"
    name = next((k for k in DRIVES if k in dataset.fit[0].channels), DRIVES[0])
    return turned_round(dataset.fit[0], name)


def _fits_turned(dataset: Dataset, place: str, balances: Sequence[ForceBalance]) -> list[str]:
    """Return a note if the stated model explains the motion far better with the drive turned round.

    Where inertia outweighs friction a wrong sign shows as twice the inertia, not as energy.
    """
    if place in getattr(dataset.scenario.mechanism, "pairs", ()):
        return []  # the drives press there, too: with them turned round nothing touches
    source = source_of(_turned(dataset, place))
    nuisances, stated = source.nuisances(place), source.stated(place)
    both = balances, source.balances(place, "fit", 0.0)
    as_given, turned = (Selector(s, nuisances, stated).recalibrated.rms for s in both)
    if turned > TURNED * as_given:
        return []
    where = f" at {place}" if place else ""
    return [
        f"the balance of forces{where} is off by {as_given:.3g} {balances[0].unit} as given, by {turned:.3g} "
        f"{balances[0].unit} with the drive turned round: the sign of the driving force, or of the position, is probably "
        f"wrong; {_remedy(dataset, place)}"
    ]


def _turned(dataset: Dataset, place: str) -> Dataset:
    """Return the dataset with the drive of a place turned round."""
    mechanism: Any = dataset.scenario.mechanism
    if isinstance(mechanism, Mjcf):
        drives = {n: dataclasses.replace(d, gain=-d.gain) if n == place else d for n, d in mechanism.drives.items()}
        scenario = dataclasses.replace(dataset.scenario, mechanism=dataclasses.replace(mechanism, drives=drives))
        return dataclasses.replace(dataset, scenario=scenario)
    runs = (dataclasses.replace(r, channels={k: -v if k in DRIVES else v for k, v in r.channels.items()}) for r in dataset.runs)
    return dataclasses.replace(dataset, runs=tuple(runs))
