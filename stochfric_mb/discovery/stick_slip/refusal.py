"""What runs that hardly slip do instead, and what a record would need to say something of friction."""

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.records.preconditions import against_belt
from stochfric_mb.discovery.stick_slip.records.record import Record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.study import record_of
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario


def refusal(dataset: Dataset) -> tuple[Where, str]:
    """Return why no fit run can be judged, run by run, and the experiment that could be.

    Raises:
        InputError: a run that is turned round.
    """
    reasons, needs = list[str](), list[str]()
    for run in dataset.fit:
        reason, need = _of(record_of(run, dataset), dataset.scenario)
        reasons.append(f"{run.name} {reason}")
        needs.append(need)
    text = (
        f"the runs hold too few slips to judge friction by, each needs at least {criteria.FEWEST_SLIPS} stick-slip cycles: "
        + "; ".join(reasons)
    )
    wanted = dict.fromkeys(needs)
    return Where("record", text), f"record at least {criteria.FEWEST_SLIPS} stick-slip cycles a run: " + "; ".join(wanted)


def _of(record: Record, scenario: Scenario) -> tuple[str, str]:
    """Return what a run does instead of slipping, and what it would need."""
    box, law = record.mechanism, scenario.law
    seconds, result = record.duration, len(extract(record))
    travel = 2.0 * (law.mu_s - law.mu_k) * box.normal_force / box.stiffness
    if record.noise > criteria.TOO_LOUD * travel:
        return (
            f"is drowned in noise: {record.noise:.2g} m, where a slip of the stated model is {travel:.2g} m long",
            f"a position sensor with a noise below {criteria.TOO_LOUD * travel:.2g} m, or slips that are longer than "
            f"{record.noise / criteria.TOO_LOUD:.2g} m (a softer spring, a higher normal load)",
        )
    followed, farthest = _followed(record), law.mu_s * box.normal_force / box.stiffness
    reached = float(np.ptp(record.position))
    if followed > criteria.RIDES and reached > criteria.BEYOND_SPRING * farthest:
        return (
            f"moves on with the belt by {reached:.3g} m, where friction can stretch the stated spring by {farthest:.2g} m: its "
            "position is not the spring's deflection",
            "the spring's deflection as position: of a block that a drive pulls, the drive's travel less the block's "
            '(docs/datasets.md, "A block that is pulled")',
        )
    if result == 0 and followed > criteria.RIDES:
        return (
            f"rides on the belt for all its {seconds:.3g} s",
            f"runs of {_needed(box, law.mu_s, travel):.2g} s, by the stated mu_s, or a faster belt",
        )
    if result == 0 and followed < criteria.SLIDES:
        level = float(np.mean(record.position)) * box.stiffness / box.normal_force
        if level < 0.0:  # a box that slips the other way looks as if it never stuck
            raise against_belt(record.name, "on average", level)
        return (
            f"slides for all its {seconds:.3g} s (mean spring force over normal force {level:.3g})",
            f"a belt slower than {box.belt_velocity:.3g} m/s, or a softer spring, so that the box sticks between slips",
        )
    needed = (
        f"runs of {1.1 * criteria.FEWEST_SLIPS * seconds / result:.2g} s at this pace"
        if result
        else "a longer record or a slower belt"
    )
    return f"holds {result} whole slips in {seconds:.3g} s", needed


def _followed(record: Record) -> float:
    """Return the box's travel over the belt's [-], from the first tenth of the record to the last."""
    tenth = max(len(record.time) // 10, 1)
    moved = float(np.median(record.position[-tenth:]) - np.median(record.position[:tenth]))
    passed = float(np.median(record.time[-tenth:]) - np.median(record.time[:tenth]))
    return moved / (record.mechanism.belt_velocity * passed)


def _needed(box: BeltBox, mu_s: float, travel: float) -> float:
    """Return how long a record must be to hold the slips that are needed, by the stated model [s]."""
    slip = math.pi / math.sqrt(box.stiffness / box.mass)
    first = mu_s * box.normal_force / box.stiffness / box.belt_velocity
    return first + (criteria.FEWEST_SLIPS + 1) * (travel / box.belt_velocity + slip)
