"""From what was selected at each joint to the result: names, numbers with intervals, gap, what cannot be identified."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, confounded, spoken_of, stand_ins
from stochfric_mb.discovery.driven_joint.balance.force_balance import PAYLOADS
from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision.adequacy import at_bound
from stochfric_mb.discovery.driven_joint.decision.carry_over import above_floor, foretells_nothing, lacks, runs_apart, told_by
from stochfric_mb.discovery.driven_joint.decision.estimates import against_priors, mechanism_estimates, parameters, unit_at
from stochfric_mb.discovery.driven_joint.decision.released import Released, finding
from stochfric_mb.discovery.driven_joint.decision.smooth_dependence import SIGNED
from stochfric_mb.discovery.driven_joint.fit.beliefs import Belief
from stochfric_mb.discovery.driven_joint.fit.evidence import scatter, settings_of
from stochfric_mb.discovery.driven_joint.fit.gains import hidden_share
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.next_experiment import next_experiment
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter
from stochfric_mb.discovery.driven_joint.search.candidates import candidates, span_of
from stochfric_mb.discovery.driven_joint.simulation.scores import AHEAD, FLOOR, noise_floor
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.result import EffectEstimate, Gap, Interval, Result, Where
from stochfric_mb.effects import Effect, effect_class, effect_kinds, kind_with_signature, kinds_with, words_of
from stochfric_mb.effects.traits import (
    ANONYMOUS,
    BELT,
    DRAWN_ANEW,
    LATE,
    REPEATED_READING,
    STRAY,
    WANDER,
)
from stochfric_mb.measurement.dataset import Dataset

IMITATED = 0.99
"""Part of an effect's change of friction that other numbers imitate, from which it cannot be identified [-]."""
PLAIN = 14.0
"""Fall of the deviance from which a scatter between settings is spoken of."""
PARTS = 20
"""Parts of a run of which the one that misses most is told [-]: a sentence, on which nothing hangs."""


def verdict(
    dataset: Dataset,
    places: Sequence[PlaceOutcome],
    notes: Sequence[str],
    loop_floor: float | None,
    readings: Sequence[Effect] = (),
    channel: tuple[str, Timing] | None = None,
    *,
    mostly: bool = False,
) -> Result:
    """Return the result of a dataset.

    Args:
        dataset: what was measured.
        places: its places, the one with most evidence first.
        notes: what the reader should know.
        loop_floor: noise of the drive where a controller is in the loop; None: none is.
        readings: effects that wrong readings mean, which have been replaced.
        channel: a column that comes late, and by how much.
        mostly: whether replacing readings explains more of the squared error than it leaves.
    """
    pairs = confounded(places[0].fit)
    effects: list[EffectEstimate] = []
    for place in places:
        effects += _delay(place) + ([] if place.idle else _released(place) + _estimates(place, pairs))
        effects += _drawn(place)
    gap = _gap(places, None if mostly else loop_floor)  # what a reading is worth shows in no simulation
    effects = _late_column(channel) + effects
    lacking = (p for p in places if p.selected.unknown or p.unnamed is not None or lacks(dataset, p))
    unknown = None if effects else next(lacking, None)
    if unknown is None or mostly:  # what is repeated or far off stands in the record, whatever else there is
        effects += [_reading(e, places[0].fit[0].unit) for e in readings]
    kind = "effect" if effects else "unknown" if unknown is not None else "none"
    where = None if unknown is None else _lacking(unknown)
    nameless = places[0] if places[0].unnamed is not None and kind == "unknown" else None
    return Result(
        verdict=kind,
        effects=tuple(effects),
        where=where if kind == "unknown" else None,
        ranking=_ranking(places),
        gap=gap,
        not_identifiable=_unseen(places, effects),
        next_experiment=next_experiment(pairs, places, where.axis if where is not None and kind == "unknown" else ""),
        parameters={_at_place(p, places, k): v for p in places for k, v in mechanism_estimates(p).items()},
        notes=(
            *gap.notes,
            *(p.idle for p in places if p.idle),
            *(f"{e.appears()[1]}; with them replaced, more than noise is left" for e in readings if unknown is not None),
            *([where.text] if where is not None and kind == "effect" else []),
            *notes,
            *_forward_notes(places[0]),
            *map(str, spoken_of(pairs, [e.kind for e in effects])),
            *_remarks(places),
        ),
        unnamed=_unnamed(nameless) if nameless is not None else None,
        details=_details(places, pairs),
    )


def _curve(kinds: Sequence[str]) -> tuple[str, str]:
    """Return the axis of a curve that two effects would draw, and why neither is named."""
    axes = [effect_class(k).answers_to for k in kinds]
    names = " and ".join(map(words_of, kinds))
    return axes[
        0
    ], f"{axes[0]} and {axes[1]} went together, so that {names} are candidates that these records cannot decide between"


def _late_column(channel: tuple[str, Timing] | None) -> list[EffectEstimate]:
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


def _reading(effect: Effect, unit_of_friction: str) -> EffectEstimate:
    """Return the finding that readings are wrong, which have been replaced before anything else was asked."""
    axis, how = effect.appears()
    numbers = {f.name: float(getattr(effect, f.name)) for f in dataclasses.fields(effect)}
    about = {
        name: Interval(value, value, value, unit_at(effect.unit_of(name), unit_of_friction)) for name, value in numbers.items()
    }
    text = f"{how[0].upper()}{how[1:]}; they are replaced by a curve through the readings around them."
    return EffectEstimate(effect.kind, (), Where(axis, text), about, None, None)


def _unnamed(place: PlaceOutcome) -> EffectEstimate:
    """Return the term without a name that is part of the final model of a place."""
    before, after = (place.scores[k].sliding for k in ("recalibrated", "augmented"))
    effect = place.selected.final.model.effects[-1]
    axis, how = effect.appears()
    text = (
        f"{how[0].upper()}{how[1:]}{_at(place)}: with a table of it the error on the held-out runs falls from {before:.4g} to "
        f"{after:.4g} {place.fit[0].unit}."
    )
    numbers = parameters(place, len(place.selected.final.model.effects) - 1)
    return EffectEstimate(effect.kind, (), Where(axis, text), numbers, place.unnamed or 0.0, 1.0)


def _delay(place: PlaceOutcome) -> list[EffectEstimate]:
    """Return the finding that the motion of a place comes late, if it is one."""
    timing = place.timing
    if timing is None or not timing.named:
        return []
    first = "position" if timing.seconds > 0.0 else "driving force"
    text = (
        f"The {first}{_at(place)} comes {1e3 * abs(timing.seconds):.1f} ms late in the record; this is compensated before "
        "friction is judged, and explains more than effects do without it."
    )
    return [_late(timing, text)]


def _estimates(place: PlaceOutcome, pairs: Sequence[Confounded]) -> list[EffectEstimate]:
    fit = place.selected.final
    first = len(place.stated.effects)
    effects: list[EffectEstimate] = []
    for i, (trial, same) in enumerate(zip(place.selected.effects, place.selected.equivalents, strict=True)):
        effect = fit.model.effects[first + i]
        others = tuple(k for k in dict.fromkeys([*map(finding, same), *stand_ins(effect.kind, pairs)]) if k != effect.kind)
        axis = trial.candidate.where
        stage = next(s for s in place.selected.stages if s.trials[0] is trial)
        # a force of its own is no friction, whatever it depends on
        of_its_own = effect.group == "mechanism" and effect.shows
        opening = effect.shows[0].upper() + effect.shows[1:] if of_its_own else f"Friction depends on {axis}"
        text = (
            f"{opening}{_at(place)}: the error falls from {stage.before.rms:.4g} to {trial.fit.rms:.4g} "
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


def _released(place: PlaceOutcome) -> list[EffectEstimate]:
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
        alike = dict.fromkeys(k for n in numbers for k in map(finding, n.alike) if k != name)
        effects.append(EffectEstimate(name, tuple(alike), Where("motion", text), sizes, first.score, None))
    return effects


def _size(place: PlaceOutcome, belief: Belief) -> Interval:
    """Return a number of law or mechanism with its interval."""
    fit = place.selected.final
    one = next(k for k in fit.free if (k.owner, k.name) == (belief.owner, belief.name))
    deviation = fit.deviation(belief.owner, belief.name)
    return confidence_interval(belief.in_model(fit.model), deviation, one.unit, one.low, one.high)


def _off(place: PlaceOutcome, number: Released, size: Interval) -> str:
    """Return by how much a number is off, in words."""
    off = abs(number.belief.off(place.selected.final.model))
    unit = "" if size.unit == "-" else f" {size.unit}"
    how = f": off by {off:.0f} of its stated standard deviations" if number.belief.stated else ", for which no doubt is stated"
    return f"{number.name}{_at(place)} is {size.value:.4g}{unit} and not {number.belief.value:.4g}{how}"


def _lacking(place: PlaceOutcome) -> Where:
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
    return Where(axis, f"What is missing depends on {axis}{_at(place)}{when}; {why}.")


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


def _drawn(place: PlaceOutcome) -> list[EffectEstimate]:
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
    where = Where(axis, f"Friction differs from {axis} to {axis}{_at(place)} by {share}")
    size = {"sigma_k": Interval(seen.sigma, seen.low, seen.high, "-")}
    return EffectEstimate(kind_with_signature(DRAWN_ANEW), same, where, size, seen.score, seen.p_value)


def _at(place: PlaceOutcome) -> str:
    return f" in {place.thing} {place.place}" if place.place else ""


def _ranking(places: Sequence[PlaceOutcome]) -> tuple[tuple[str, float], ...]:
    best: dict[str, float] = {}
    for place in places:
        for stage in place.searched:
            for candidate, score in (*((t.candidate, t.score) for t in stage.trials), *stage.faint):
                name = f"{candidate.kind} ({place.place})" if len(places) > 1 else candidate.kind
                best[name] = max(best.get(name, -np.inf), score)
    late = [p.timing.score for p in places if p.timing is not None]
    if late:
        best[kind_with_signature(LATE)] = max(late)
    return tuple(sorted(best.items(), key=lambda item: -item[1]))


def _gap(places: Sequence[PlaceOutcome], loop_floor: float | None) -> Gap:
    place = places[0]
    before, middle, after = (place.scores[k] for k in ("baseline", "recalibrated", "augmented"))
    if place.forecasts is not None:
        seen = place.forecasts
        return Gap(
            "crps_friction", place.fit[0].unit, True, seen.baseline, seen.recalibrated, seen.augmented, seen.floor,
            "the same forecasts of data that the model gives itself; its noise from differences between neighbouring windows",
        )  # fmt: skip
    if before.loop is not None and middle.loop is not None and after.loop is not None and loop_floor is not None:
        metric = "closed_loop_drive" if middle.forward is not None else "closed_loop_voltage"
        return Gap(
            metric, "-", True, before.loop, middle.loop, after.loop, loop_floor,
            f"high-frequency content of the measured {metric.removeprefix('closed_loop_')} (third differences)",
        )  # fmt: skip
    return Gap(
        "inverse_dynamics_sliding", place.fit[0].unit, True, before.sliding, middle.sliding, after.sliding, place.floor,
        "differences between neighbouring windows that do not overlap"
        + (", and the scatter from stroke to stroke" if place.random is not None and place.random.accounted else ""),
    )  # fmt: skip


def _imitated(place: PlaceOutcome) -> list[str]:
    """Return the one-parameter effects, not selected, that corrections of the mechanism imitate."""
    fit = place.selected.final
    selected = {t.candidate.kind for t in place.selected.effects}
    stage = place.selected.stages[0]
    tried = [*(t.candidate for t in stage.trials), *(c for c, _ in stage.faint)]
    return [
        c.kind
        for c in tried
        if c.parameters == 1
        and c.kind not in selected
        and place.nuisances
        and hidden_share(c.starts[0], place.fit, fit) > IMITATED
    ]


def _unseen(places: Sequence[PlaceOutcome], effects: Sequence[EffectEstimate]) -> tuple[str, ...]:
    """Return the kinds for which no motion here asks, and that are no part of the model or of what is named."""
    spans = [span_of(p.fit, p.stated.law.mu_k * p.stated.load, p.stated.load) for p in places]
    seen = {t.candidate.kind for p in places for s in p.searched for t in s.trials}
    seen |= {c.kind for span in spans for c in candidates(span, ())}  # one that was not needed would have been seen, too
    seen |= {e.kind for p in places for e in p.stated.effects}
    seen |= {kind for e in effects for kind in (e.kind, *e.equivalent_to)}
    seen |= {kind_with_signature(finding) for finding in (LATE, STRAY, REPEATED_READING)}
    seen |= {kind_with_signature(DRAWN_ANEW)} if any(p.random is not None or p.runs is not None for p in places) else set()
    return tuple(k for k in effect_kinds() if k not in seen and k not in (*kinds_with(BELT), *kinds_with(ANONYMOUS)))


def _forward_notes(place: PlaceOutcome) -> list[str]:
    """Return what forward simulation says."""
    before, after = (place.scores[k] for k in ("recalibrated", "augmented"))
    if any(e.moves_load for e in place.selected.final.model.effects):
        return [
            "the load moves by itself in the augmented model: simulations and exports of one body do not carry that, and "
            "held-out runs are scored by inverse dynamics alone; give an engine a second body with these numbers"
        ]
    if before.forward is None or after.forward is None:
        return []
    how = "with the controller in the loop" if after.loop is not None else f"{AHEAD:g} s at a time from the measured state"
    unit = "m or rad" if place.place else "m" if place.fit[0].unit == "N" else "rad"
    return [
        f"simulated in MuJoCo, {how}, positions of the held-out runs are off by {before.forward:.3g} {unit} recalibrated, by "
        f"{after.forward:.3g} augmented (rms)"
    ]


def _remarks(places: Sequence[PlaceOutcome]) -> list[str]:
    remarks: list[str] = []
    if any(number.name in PAYLOADS.values() for place in places for number in place.selected.released):
        remarks.append(
            "a payload is that of points in the last body of the model, at its centre of mass and at its far end: one that "
            "sits elsewhere weighs otherwise"
        )
    for place in places:
        for kind in dict.fromkeys(_imitated(place)):  # several forms of a kind are one name
            names = ", ".join(n.name for n in place.nuisances)
            remarks.append(
                f"{words_of(kind)} cannot be distinguished from a correction of {names} here{_at(place)}: any of it is "
                "included in these numbers"
            )
        remarks += _between_settings(place)
        if place.random is not None and place.random.low > 0.0 and not place.random.accounted:
            how = "drifts at random" if place.random.wanders else "scatters"
            share, strokes = 100.0 * place.random.share, place.random.strokes
            why = "; it goes on across reversals, as slow noise of the drive does" if place.random.slow_noise else ""
            remarks.append(f"friction {how} by {share:.1f} % from stroke to stroke ({strokes} strokes){_at(place)}{why}")
        if place.selected.effects and place.selected.unknown:
            remarks.append(f"what remains depends on {place.selected.unknown}{_at(place)}; no known effect explains it")
        remarks += _more_missing(place)
    return remarks


def _more_missing(place: PlaceOutcome) -> list[str]:
    """Return a remark if what is named, effects and scatter, leaves more than noise."""
    final = place.selected.final
    drawn = any(s is not None and s.accounted for s in (place.random, place.runs))
    noise = noise_floor(final.model, place.fit, place.nuisances)
    if not place.selected.effects or drawn or final.rms < FLOOR * noise:
        return []
    axes = ", ".join(axis.removesuffix(SIGNED) for axis, _ in place.selected.left)
    return [
        f"{final.rms / noise:.1f} times the noise is left{_at(place)} with what is named: more is missing"
        + (f"; it depends on {axes}" if axes else "")
    ]


def _between_settings(place: PlaceOutcome) -> list[str]:
    """Return a remark if what is left stays the same in a run and direction."""
    fit, settings = place.selected.final, settings_of(place.fit)
    rest, n = np.concatenate(fit.remainders), max(place.selected.final.independent, 4.0)
    seen, none = scatter(rest, settings, n), scatter(rest, settings, n, ratios=np.zeros(1))
    if none.deviance - seen.deviance < PLAIN or (place.runs is not None and place.runs.accounted):
        return []
    return [
        f"{seen.between:.2g} {place.fit[0].unit} of what is left{_at(place)} stay the same in all strokes of a run in one "
        f"direction, and differ between these {len(np.unique(settings))} settings: a zero or a law, the data do not say which"
    ]


def _at_place(place: PlaceOutcome, places: Sequence[PlaceOutcome], name: str) -> str:
    """Return the name of a number, with its place where there are several."""
    return f"{place.place}.{name}" if len(places) > 1 else name


def _details(places: Sequence[PlaceOutcome], pairs: Sequence[Confounded]) -> dict[str, Any]:
    known = [(p, *against_priors(p)) for p in places]
    return {
        "parameters": {
            "not_measured": [_at_place(p, places, name) for p, made, _ in known for name in made],
            "moved_beyond_uncertainty": {_at_place(p, places, name): by for p, _, off in known for name, by in off.items()},
        },
        "confounded": [dataclasses.asdict(p) for p in pairs],
        "places": [
            {
                "place": p.place,
                "held_out": {k: dataclasses.asdict(v) for k, v in p.scores.items()},
                "floor": p.floor,
                "timing": dataclasses.asdict(p.timing) if p.timing is not None else None,
                "runs": dataclasses.asdict(p.runs) if p.runs is not None else None,
                "strokes": dataclasses.asdict(p.random) if p.random is not None else None,
                "half_width": [s.window.half_width for s in p.fit],
                "independent_windows": p.selected.final.independent,
                "stages": [
                    {
                        "before": s.before.rms,
                        "trials": [[t.candidate.kind, t.score, t.fit.rms] for t in s.trials],
                        "not_worth_a_fit": [[c.kind, score] for c, score in s.faint],
                        "competitors": [list(c) for c in s.competitors],
                        "gain_on_blocks_left_out": s.blocks.rms_gain,
                        "blocks_better": s.blocks.better,
                        "strokes_left_out": dataclasses.asdict(s.strokes) if s.strokes is not None else None,
                        "accepted": s.accepted,
                    }
                    for s in p.selected.stages
                ],
            }
            for p in places
        ],
    }
