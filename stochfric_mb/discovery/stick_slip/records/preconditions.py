"""What runs of a belt-box need for friction to be identified from them; others are refused with the remedy."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.scales import load_in_kilograms


def require_usable(dataset: Dataset) -> None:
    """Require that the belt runs, and that samples are close enough to see how a slip begins.

    Raises:
        InputError: a belt at rest, or too few samples in a period of the natural oscillation.
    """
    for run in (*dataset.fit, *dataset.test):
        box = run.mechanism(dataset.scenario)
        if box.belt_velocity == 0.0:
            raise InputError(
                f"run {run.name}: belt_velocity is 0 m/s, but friction is inferred from stick and slip on a moving belt; "
                "state the speed at which it ran, in [mechanism] or in the run's set = { belt_velocity = ... }"
            )
        natural = math.sqrt(box.stiffness / box.mass) / (2.0 * math.pi)
        count = 1.0 / (natural * run.sample_interval)
        if count < criteria.FEWEST_SAMPLES:
            raise InputError(
                f"run {run.name}: {1.0 / run.sample_interval:.4g} samples a second are {count:.3g} in a period of the natural "
                f"oscillation ({natural:.3g} Hz by the stated mass and stiffness); at least "
                f"{criteria.FEWEST_SAMPLES} are needed: sample at {math.ceil(criteria.FEWEST_SAMPLES * natural)} Hz or faster, "
                f"or correct mass and stiffness{_in_milliseconds(run.sample_interval, count)}"
            )


def _in_milliseconds(interval: float, count: float) -> str:
    """Return what to write if the time is in ms, where that would do; samples more than half a second apart are rare."""
    return (
        ', or give the unit of time, units = { time = "ms" }'
        if interval > 0.5 and 1e3 * count > criteria.FEWEST_SAMPLES
        else ""
    )


def against_belt(run: str, when: str, share: float) -> InputError:
    """Return the error of a run whose friction acts against the belt's motion, at ``share`` of the normal force [-]."""
    return InputError(
        f"run {run}: friction {when} comes out at {share:.3g} times the normal force, against the belt's motion; give position "
        "and belt_velocity the same positive direction (sign = { position = -1 } turns a column round) and count the position "
        "from the unstressed spring"
    )


def require_driven(slips: Sequence[Slips], mu_s: float) -> None:
    """Require that friction drives the box along with the belt, with a coefficient that dry friction can have.

    Args:
        slips: the slips of each run.
        mu_s: static coefficient as stated [-].

    Raises:
        InputError: a run whose spring pulls along the belt's motion at break-away or in slip, or pulls too hard or too little.
    """
    for one in slips:
        load = one.record.mechanism.normal_force
        for forces, when in ((one.onset_force, "at break-away"), (one.moments[:, 0], "in slip")):
            share = float(np.median(forces)) / load
            if share <= 0.0:
                raise against_belt(one.record.name, when, share)
            # a load scales both; a zero that is off takes away from what is in slip
            if forces is one.onset_force and share < mu_s / criteria.FAR_OFF:
                raise InputError(
                    f"run {one.record.name}: friction {when} comes out at {share:.3g} times the normal force, with mu_s stated "
                    f"as {mu_s:.3g}: correct normal_force = {load:.6g} N, or stiffness, or the unit of the position; so small "
                    "a mu_s has to be stated"
                )
            if share > criteria.MOST_FRICTION * max(1.0, mu_s):
                zero = "count the position from where the spring is unstressed, or correct normal_force"
                raise InputError(
                    f"run {one.record.name}: friction {when} comes out at {share:.3g} times the normal force, with mu_s stated "
                    f"as {mu_s:.3g}; {load_in_kilograms((share,), (mu_s,), load) or zero}"
                )
