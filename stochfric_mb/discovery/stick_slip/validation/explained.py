"""Whether a decision explains what the very runs show that it was made on: their forecasts one cycle ahead are judged."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import cast

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.decision import Decision
from stochfric_mb.discovery.stick_slip.decision.kinematics import STICK_SHARE
from stochfric_mb.discovery.stick_slip.decision.rounds import SCORE_LEFT
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows, score
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut, floor_of, floor_scores, phased, scores
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import kind_with_signature, kinds_with
from stochfric_mb.effects.traits import JUMP, KICKS, MOVES_ZERO, OUTSIDE_FORECASTS, SCATTER
from stochfric_mb.errors import SimulationError

GOLDEN = 0.6180339887498949
"""The ratio whose multiples repeat least."""
JUDGED_WINDOWS = 24
"""Forecasts of each run that are judged."""
FORECASTS = "forecasts of one cycle"
"""Where the disagreement lives that forecasts alone show."""
MORE_MISSING = "more_missing"
"""Name under which the details hold what is missing beside what is named."""


def unexplained(study: Study, decision: Decision, recalibrated: Model, augmented: Model) -> Decision | None:
    """Return another decision if this one explains too little of what the fit runs show; None if enough.

    A name is worth little if the model with the effect forecasts the very runs that it was fitted to hardly better, and
    so is "none" if a model that explained the runs would forecast them far better than the recalibrated one does: both
    become "unknown". Kicks that throw no forecast off are none.
    """
    if decision.verdict == "unknown":
        return None
    kinds = {n.kind for n in decision.named}
    windows = tuple(_scattered(w, JUDGED_WINDOWS) for w in study.windows if len(w))
    if not windows:
        return None
    runs = HeldOut(study.pool.slips[:2], windows, windows)
    without, with_ = scores(recalibrated, runs), scores(augmented, runs)
    before = float(without.mean())
    if _unfelt(kinds, recalibrated, study, runs, before):
        return dataclasses.replace(decision, verdict="none", named=())
    try:
        best = floor_scores(augmented, runs, recalibrated if kind_with_signature(KICKS) in kinds else None)
    except SimulationError as error:
        return taken_back(decision, f"comes closest, but its model cannot run by itself: {error}")
    return _judged(study, decision, augmented, without, with_, best)


def _judged(study: Study, decision: Decision, augmented: Model, without: Array, with_: Array, best: Array) -> Decision | None:
    """Return what `unexplained` does, from errors of forecasts without and with the effects, and if they are true."""
    kinds, before, after = {n.kind for n in decision.named}, float(without.mean()), float(with_.mean())
    if not kinds or not len(best):
        return _nothing_shown(decision, before, after, best)
    enough = _enough(decision)
    little = _too_little(decision, enough, without, with_, best)
    if little is not None and kinds <= shown_elsewhere(decision.model):
        # what forecasts do not show need not explain them, but neither may anything else be missing from them
        return _nothing_shown(decision, before, after, best)
    # a zero that moves by less than a reading errs is noise unless it is seen to explain something: doubt speaks against it
    floor = min(float(best.mean()), after)
    little_seen = before - after <= enough * max(before - floor, 0.0)
    noise = little_seen and len(kinds) == 1 and within_noise(decision.named[0].kind, augmented, study.pool.slips)
    return dataclasses.replace(decision, verdict="none", named=()) if noise else little


def _nothing_shown(decision: Decision, before: float, after: float, best: Array) -> Decision | None:
    """Return the decision that something is missing, if forecasts say so, where nothing is named that they would show.

    Args:
        decision: the decision.
        before: mean error of the forecasts without the effects [m].
        after: the same with them.
        best: what they would be if the model were true, shape (m,); none where it does not slip.
    """
    if not len(best):
        return taken_back(decision, "comes closest, but its model does not slip as the record does") if decision.named else None
    floor = min(float(best.mean()), after)
    decision.details["explained"] = {"before": before, "floor": floor}
    return _missed(decision, after, floor) if after - floor > criteria.NONE_MISSES * after else None


def _enough(decision: Decision) -> float:
    """Return the share of the reducible error that the names must explain [-].

    Recalibration takes the mean of an effect that all slips have alike, and forecasts then hold little but its form. Of a wave
    it takes nothing: forecasts hold as much of it as the stick phases. A contact that gives way in stick breaks away at another
    time, which forecasts show: what only looks like it there does not.
    """
    if explained_with_its_form(decision) and not phased(decision.model):
        return criteria.EXPLAINED_RANDOM if STICK_SHARE in decision.details else criteria.CLOSES_NOTHING
    return criteria.EXPLAINED_RANDOM if lenient(decision) else criteria.EXPLAINED


def felt(decision: Decision) -> bool:
    """Return whether forecasts have to show what is named: nothing else has shown that there is little doubt of it.

    Simulated slips, where they keep next to nothing of the misfit, have: forecasts then miss by what else differs from slip to
    slip. Stick phases have not, for what a reading does there a contact need not do.
    """
    elsewhere = {n.kind for n in decision.named} <= shown_elsewhere(decision.model)
    by_slips = explained_with_its_form(decision) and not phased(decision.model) and STICK_SHARE not in decision.details
    return bool(decision.named) and not (elsewhere or by_slips or lenient(decision))


def lenient(decision: Decision) -> bool:
    """Return whether forecasts cannot show all of what is named: it is random, or a step at a moment that is not known well.

    What is random beside a named effect does not excuse what that one does not explain.
    """
    first = next(e for e in decision.model.effects if e.kind == decision.named[0].kind)
    return first.random or any(n.kind == kind_with_signature(JUMP) for n in decision.named)


def _too_little(decision: Decision, enough: float, without: Array, with_: Array, best: Array) -> Decision | None:
    """Return the decision without its names where forecasts show that these explain less than ``enough``; None if they do not.

    Args:
        decision: the decision.
        enough: share of the reducible error [-].
        without: errors of the forecasts without the effects [m], shape (n,).
        with_: the same with them.
        best: what they would be if the model with the effects were true, shape (m,).
    """
    before, after = float(without.mean()), float(with_.mean())
    floor = min(float(best.mean()), after)
    # what is left beyond the share that may be, and how well so few forecasts tell it
    left = with_ - (1.0 - enough) * without
    doubt = float(np.hypot(_error_of_mean(left), enough * _error_of_mean(best)))
    share = (before - after) / (before - floor) if before > floor else 0.0
    decision.details["explained"] = {"before": before, "after": after, "floor": floor, "share": share, "doubt": doubt}
    why = f"comes closest, but explains only {max(share, 0.0):.0%} of what the runs show"
    return taken_back(decision, why) if float(left.mean()) - enough * floor > criteria.LACKS * doubt else None


def within_noise(kind: str, model: Model, slips: Sequence[Slips]) -> bool:
    """Return whether a kind is a sensor's zero that moves by less than a reading errs: slow noise, which is no effect.

    Args:
        kind: an effect of the model.
        model: the model with it, fitted.
        slips: the slips of the runs.
    """
    if kind not in kinds_with(MOVES_ZERO):
        return False
    moved = [
        float(np.std(effect.measure(s.record.time, np.zeros_like(s.record.time), np.random.default_rng(0))))
        for s in slips
        for effect in model.effects_in(s.record.name)
        if effect.kind == kind
    ]
    return max(moved, default=np.inf) < criteria.STICK_DEPARTS * min(s.noise.deviation for s in slips)


def shown_elsewhere(model: Model) -> set[str]:
    """Return the effects that forecasts do not show.

    A delay behind a measured velocity is measured itself; a forecast that starts late as well shows little of it.
    """
    return {*kinds_with(OUTSIDE_FORECASTS), *_measured(model)}


def _measured(model: Model) -> set[str]:
    """Return the effects a number of which two channels of the record have given."""
    return {e.kind for e in model.effects if any(hasattr(e, name) for name in model.measured)}


def _error_of_mean(values: Array) -> float:
    """Return the standard error of the mean of ``values``, shape (n,)."""
    return float(np.std(values)) / max(len(values) - 1, 1) ** 0.5


def explained_with_its_form(decision: Decision) -> bool:
    """Return whether the one effect named explains what its channel shows, but for what another form of its kind would leave.

    What its form leaves adds up in a forecast of a whole cycle. The forces of the slips, or the stick phases, in which it was
    selected say more of its kind, unless a pattern without a name in what it leaves says more still.
    """
    if len(decision.named) != 1:
        return False
    in_stick = cast("float", decision.details.get(STICK_SHARE, 0.0))
    pattern = cast("float", decision.details.get(SCORE_LEFT, 0.0))
    explained = decision.named[0].shape_left < criteria.FORM_MISSES or in_stick > criteria.STICK_EXPLAINED
    return explained and pattern < (decision.named[0].evidence.score or 0.0)


def taken_back(decision: Decision, why: str) -> Decision:
    """Return the decision without its names; ``why`` is said of the first one."""
    best = decision.named[0]
    return dataclasses.replace(decision, verdict="unknown", named=(), where=Where(best.where.axis, f"{best.kind} {why}"))


def _unfelt(kinds: set[str], recalibrated: Model, study: Study, runs: HeldOut, before: float) -> bool:
    """Return whether what is random stands out of the forces alone, and leaves the motion as forecast without it.

    Edges that noise has hidden stand out as kicks do, and a scatter of the forces may be smaller than any forecast feels.
    """
    if kinds == {kind_with_signature(KICKS)}:
        return not _thrown_off(recalibrated, study)
    return (
        bool(kinds)
        and kinds <= set(kinds_with(SCATTER))
        and before - floor_of(recalibrated, runs) <= criteria.LEAST_REDUCIBLE * before
    )


def _thrown_off(model: Model, study: Study) -> bool:
    """Return whether some forecasts of the fit runs miss by far more than most."""
    errors = np.concatenate([score(model, w) for w in study.windows])
    return bool(np.count_nonzero(errors > criteria.THROWN_OFF * np.median(errors)) >= criteria.FEWEST_THROWN_OFF)


def _scattered(windows: Windows, most: int) -> Windows:
    """Return at most ``most`` windows, spread over the run at no regular intervals: a pattern of slips must not escape."""
    order = np.argsort(np.arange(len(windows)) * GOLDEN % 1.0, kind="stable")
    return windows.part(np.sort(order[:most]))


def _missed(decision: Decision, before: float, floor: float) -> Decision | None:
    """Return the decision that something is missing; None: what is named stands, for two channels show it whatever that is."""
    faults = ", ".join(n.kind for n in decision.named)
    seen = f"the readings look like {faults}, but with it" if faults else "no effect stands out in the forces of the slips, but"
    where = Where(
        FORECASTS,
        f"{seen} forecasts of the fit runs miss by {before:.2g} m, where the model would miss by {floor:.2g} m if it were true",
    )
    if decision.named and {n.kind for n in decision.named} <= _measured(decision.model):
        decision.details[MORE_MISSING] = where.text
        return None
    return dataclasses.replace(decision, verdict="unknown", named=(), where=where)
