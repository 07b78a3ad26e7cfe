"""From what was selected at each joint to the result: names, numbers with intervals, gap, what cannot be identified."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, confounded, spoken_of
from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision.carry_over import lacks
from stochfric_mb.discovery.driven_joint.decision.estimates import against_priors, mechanism_estimates
from stochfric_mb.discovery.driven_joint.decision.findings import (
    drawn_anew,
    late_column,
    late_motion,
    named_effects,
    released_numbers,
    unnamed_term,
    where_lacking,
    wrong_reading,
)
from stochfric_mb.discovery.driven_joint.decision.remarks import forward_notes, remarks
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.next_experiment import next_experiment
from stochfric_mb.discovery.driven_joint.search.candidates import candidates, span_of
from stochfric_mb.discovery.driven_joint.simulation.scores import floor_from
from stochfric_mb.discovery.result import EffectEstimate, Gap, Result
from stochfric_mb.effects import Effect, effect_kinds, kind_with_signature, kinds_with
from stochfric_mb.effects.traits import (
    ANONYMOUS,
    BELT,
    DRAWN_ANEW,
    LATE,
    REPEATED_READING,
    STRAY,
)
from stochfric_mb.measurement.dataset import Dataset


def verdict(
    dataset: Dataset,
    places: Sequence[PlaceOutcome],
    notes: Sequence[str],
    loop_floor: float | None,
    readings: Sequence[Effect],
    channel: tuple[str, Timing] | None,
    *,
    mostly: bool,
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
        effects += late_motion(place) + ([] if place.idle else released_numbers(place) + named_effects(place, pairs))
        effects += drawn_anew(place)
    gap = _gap(places, None if mostly else loop_floor)  # what a reading is worth shows in no simulation
    effects = late_column(channel) + effects
    lacking = (p for p in places if p.selected.unknown or p.unnamed is not None or lacks(dataset, p))
    unknown = None if effects else next(lacking, None)
    if unknown is None or mostly:  # what is repeated or far off stands in the record, whatever else there is
        effects += [wrong_reading(e, places[0].fit[0].unit) for e in readings]
    kind = "effect" if effects else "unknown" if unknown is not None else "none"
    where = None if unknown is None else where_lacking(unknown)
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
            *forward_notes(places[0]),
            *map(str, spoken_of(pairs, [e.kind for e in effects])),
            *remarks(places),
        ),
        unnamed=unnamed_term(nameless) if nameless is not None else None,
        details=_details(places, pairs),
    )


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
        return place.forecasts
    if before.loop is not None and middle.loop is not None and after.loop is not None and loop_floor is not None:
        metric = "closed_loop_drive" if middle.forward is not None else "closed_loop_voltage"
        return Gap(
            metric, "-", True, before.loop, middle.loop, after.loop, loop_floor,
            f"high-frequency content of the measured {metric.removeprefix('closed_loop_')} (third differences)",
        )  # fmt: skip
    return Gap(
        "inverse_dynamics_sliding", place.fit[0].unit, True, before.sliding, middle.sliding, after.sliding, place.floor,
        floor_from(place.test)
        + (", and the scatter from stroke to stroke" if place.random is not None and place.random.accounted else ""),
    )  # fmt: skip


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
