"""What is found at a place, in words and with its numbers: effects, delays, wrong readings, scatter, and what has no name."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, stand_ins
from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision.adequacy import at_bound
from stochfric_mb.discovery.driven_joint.decision.carry_over import above_floor, foretells_nothing, runs_apart, told_by
from stochfric_mb.discovery.driven_joint.decision.estimates import parameters, unit_at
from stochfric_mb.discovery.driven_joint.decision.released import Released, finding
from stochfric_mb.discovery.driven_joint.fit.beliefs import Belief
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.result import EffectEstimate, Interval, Where
from stochfric_mb.effects import Effect, effect_class, kind_with_signature, words_of
from stochfric_mb.effects.contract import OF_MECHANISM
from stochfric_mb.effects.traits import DRAWN_ANEW, LATE, WANDER

PARTS = 20
"""Parts of a run of which the one that misses most is told [-]: a sentence, on which nothing hangs."""


def late_column(channel: tuple[str, Timing] | None) -> list[EffectEstimate]:
    """Return the finding that one column comes late, if it is one."""
    if channel is None:
        return []
    name, timing = channel
    how = "late" if timing.seconds > 0.0 else "early"
    text = f"comes {1e3 * abs(timing.seconds):.1f} ms {how} in the record; it is moved before friction is judged."
    return [_late(timing, f"The column {name} alone {text}")]


def _late(timing: Timing, text: str) -> EffectEstimate:
    """Return the finding of a delay."""
    low, high = sorted((abs(timing.low), abs(timing.high)))
    size = Interval(abs(timing.seconds), low, high, "s")
    return EffectEstimate(kind_with_signature(LATE), (), Where("time", text), {"delay": size}, timing.score, None)


def wrong_reading(effect: Effect, unit_of_friction: str) -> EffectEstimate:
    """Return the finding that readings are wrong, which have been replaced before anything else was asked."""
    axis, how = effect.appears()
    numbers = {f.name: float(getattr(effect, f.name)) for f in dataclasses.fields(effect)}
    about = {
        name: Interval(value, value, value, unit_at(effect.unit_of(name), unit_of_friction)) for name, value in numbers.items()
    }
    text = f"{how[0].upper()}{how[1:]}; they are replaced by a curve through the readings around them."
    return EffectEstimate(effect.kind, (), Where(axis, text), about, None, None)


def unnamed_term(place: PlaceOutcome) -> EffectEstimate:
    """Return the term without a name that is part of the final model of a place."""
    before, after = (place.scores[k].sliding for k in ("recalibrated", "augmented"))
    effect = place.selected.final.model.effects[-1]
    axis, how = effect.appears()
    text = (
        f"{how[0].upper()}{how[1:]}{in_place(place)}: with a table of it the error on the held-out runs falls from "
        f"{before:.4g} to {after:.4g} {place.fit[0].unit}."
    )
    numbers = parameters(place, len(place.selected.final.model.effects) - 1)
    return EffectEstimate(effect.kind, (), Where(axis, text), numbers, place.unnamed or 0.0, 1.0)


def late_motion(place: PlaceOutcome) -> list[EffectEstimate]:
    """Return the finding that the motion of a place comes late, if it is one."""
    timing = place.timing
    if timing is None or not timing.named:
        return []
    first = "position" if timing.seconds > 0.0 else "driving force"
    text = (
        f"The {first}{in_place(place)} comes {1e3 * abs(timing.seconds):.1f} ms late in the record; this is compensated before "
        "friction is judged, and explains more than effects do without it, numbers counted."
    )
    return [_late(timing, text)]


def named_effects(place: PlaceOutcome, pairs: Sequence[Confounded]) -> list[EffectEstimate]:
    """Return the findings of the selected effects at a place; ``pairs`` are conditions that went together."""
    fit = place.selected.final
    first = len(place.stated.effects)
    effects: list[EffectEstimate] = []
    for i, (trial, same) in enumerate(zip(place.selected.effects, place.selected.equivalents, strict=True)):
        effect = fit.model.effects[first + i]
        others = tuple(k for k in dict.fromkeys([*map(finding, same), *stand_ins(effect.kind, pairs)]) if k != effect.kind)
        axis = trial.candidate.where
        stage = next(s for s in place.selected.stages if s.trials[0] is trial)
        # a force of its own is no friction, whatever it depends on
        of_its_own = effect.group == OF_MECHANISM and effect.shows
        opening = effect.shows[0].upper() + effect.shows[1:] if of_its_own else f"Friction depends on {axis}"
        text = (
            f"{opening}{in_place(place)}: the error falls from {stage.before.rms:.4g} to {trial.fit.rms:.4g} "
            f"{place.fit[0].unit} on the fit runs."
        )
        chance = trial.p_value
        if stage.strokes is not None:
            chance = stage.strokes.p_value
            text += (
                f" On strokes left out, one by one, it falls by {100.0 * stage.strokes.rms_gain:.0f} %, in "
                f"{stage.strokes.better} of {stage.strokes.parts}, and each half of the record "
                "predicts the other better; it is named for that."
            )
        numbers = parameters(place, first + i)
        effects.append(EffectEstimate(effect.kind, others, Where(axis, text), numbers, trial.score, chance))
    return effects


def released_numbers(place: PlaceOutcome) -> list[EffectEstimate]:
    """Return the numbers of law and mechanism that are off by more than their uncertainty: those of one name together."""
    effects: list[EffectEstimate] = []
    named = place.selected.released
    for name in dict.fromkeys(finding(n.name) for n in named):
        numbers = [n for n in named if finding(n.name) == name]
        sizes = {n.name: _size(place, n.belief) for n in numbers}
        said = [_off(place, n, sizes[n.name]) for n in numbers]
        first = numbers[0]
        text = (
            f"{' and '.join(said)}. With it the error falls from {first.before:.4g} to {numbers[-1].after:.4g} "
            f"{place.fit[0].unit} on the fit runs."
        )
        alike = dict.fromkeys(map(finding, place.selected.alike[name]))
        effects.append(EffectEstimate(name, tuple(alike), Where("motion", text), sizes, first.score, None))
    return effects


def _size(place: PlaceOutcome, belief: Belief) -> Interval:
    """Return a number of law or mechanism with its interval."""
    fit = place.selected.final
    one = fit.free[fit.at(belief.owner, belief.name)[0]]
    deviation = fit.deviation(belief.owner, belief.name)
    return confidence_interval(belief.in_model(fit.model), deviation, one.unit, one.low, one.high)


def _off(place: PlaceOutcome, number: Released, size: Interval) -> str:
    """Return by how much a number is off, in words."""
    off = abs(number.belief.off(place.selected.final.model))
    unit = "" if size.unit == "-" else f" {size.unit}"
    how = f": off by {off:.0f} of its stated standard deviations" if number.belief.stated else ", for which no doubt is stated"
    believed = number.belief.value
    if believed and not 1.0 / criteria.FACTOR < size.value / believed < criteria.FACTOR:
        how += "; a gear, a unit or a scale that was left out changes numbers so: check these first"
    return f"{number.name}{in_place(place)} is {size.value:.4g}{unit} and not {believed:.4g}{how}"


def drawn_anew(place: PlaceOutcome) -> list[EffectEstimate]:
    """Return the findings that friction is drawn anew for each stroke, or for each run."""
    strokes, runs = place.random, place.runs
    found: list[EffectEstimate] = []
    if strokes is not None and strokes.named:
        how = f"{strokes.strokes} strokes), more than its scatter within them explains, and each stroke by itself"
        found.append(_scattered(strokes, "stroke", place, how, (kind_with_signature(WANDER),) if strokes.may_wander else ()))
    if runs is not None and runs.named:
        how = f"{runs.runs} runs), more than the scatter of their strokes explains; no run says it of another"
        found.append(_scattered(runs, "run", place, how))
    return found


def _scattered(
    seen: CoefficientScatter, axis: str, place: PlaceOutcome, how: str, same: tuple[str, ...] = ()
) -> EffectEstimate:
    share = f"{100.0 * seen.share:.1f} % (standard deviation, {how}."
    where = Where(axis, f"Friction differs from {axis} to {axis}{in_place(place)} by {share}")
    size = {"sigma_k": Interval(seen.sigma, seen.low, seen.high, "-")}
    return EffectEstimate(kind_with_signature(DRAWN_ANEW), same, where, size, seen.score, seen.p_value)


def _curve(kinds: Sequence[str]) -> tuple[str, str]:
    """Return the axis of a curve that two effects would draw, and why neither is named."""
    axes = [effect_class(k).answers_to for k in kinds]
    names = " and ".join(map(words_of, kinds))
    return axes[
        0
    ], f"{axes[0]} and {axes[1]} went together, so that {names} are candidates that these records cannot decide between"


def where_lacking(place: PlaceOutcome) -> Where:
    """Return where what is missing at a place shows, and why it has no name."""
    axis = place.selected.unknown or _axis(place)
    why = "no known effect explains it"
    if place.curve:
        axis, why = _curve(place.curve)
    elif bound := at_bound(place):
        why = f"the model {bound}"
    elif told_by(place) == axis:
        why = f"friction differs from run to run as their {axis} does, which is no chance, and {why}"
    when = _most_at(place) if axis == "time" else ""
    return Where(axis, f"What is missing depends on {axis}{in_place(place)}{when}; {why}.")


def _most_at(place: PlaceOutcome) -> str:
    """Return in which run, and about when, most is missing; empty where nothing slides."""
    worst = (0.0, "")
    for rest, balance in zip(place.selected.final.remainders, place.fit, strict=True):
        if not len(rest):
            continue
        squares, edges = np.histogram(balance.time[balance.window.centres][balance.sliding], PARTS, weights=rest**2)
        at = int(np.argmax(squares))
        when = 0.5 * (edges[at] + edges[at + 1])
        worst = max(worst, (float(squares[at]), f", most about {when:.3g} s of run {balance.run}"))
    return worst[1]


def _axis(place: PlaceOutcome) -> str:
    """Return the axis along which most is left: the runs if only those held out are off, time if chance says as much as any.

    The motion, if the numbers of the mechanism have swallowed it.
    """
    if at_bound(place):
        return "motion"
    if told_by(place):
        return told_by(place)
    if (foretells_nothing(place) or runs_apart(place)) and not above_floor(place):
        return "run"
    if place.selected.left:  # names that do not stand leave it
        return max(place.selected.left, key=lambda axis_and_gain: axis_and_gain[1])[0]
    rivals = place.selected.stages[-1].competitors
    return rivals[0][0] if rivals and rivals[0][1] > 0.0 else "time"


def in_place(place: PlaceOutcome) -> str:
    """Return which joint or tendon it is, to end a sentence with; empty where there is one only."""
    return f" in {place.thing} {place.place}" if place.place else ""
