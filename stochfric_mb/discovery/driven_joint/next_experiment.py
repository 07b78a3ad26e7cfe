"""What to measure next at a driven joint: what tells findings apart that these data do not."""

from __future__ import annotations

from collections.abc import Sequence

from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, by_clock
from stochfric_mb.discovery.driven_joint.balance.force_balance import GAIN
from stochfric_mb.discovery.driven_joint.decision.carry_over import runs_apart, told_by
from stochfric_mb.discovery.driven_joint.decision.released import finding
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.effects import words_of

ALONG = {
    "time": "The same motion for longer, with a log of what else changes or runs meanwhile: temperature, supply, others.",
    "position": "Slow strokes over all of the travel at several speeds: is it the place, or how fast it is passed?",
    "speed": "More speeds, each both ways over the same part of the travel.",
    "load": "The same motion under two more loads.",
}
"""Condition -> what to measure where what is missing depends on it, and nothing has a name."""


def next_experiment(pairs: Sequence[Confounded], places: Sequence[PlaceOutcome], axis: str = "") -> str:
    """Return what to measure next.

    Args:
        pairs: conditions that went together.
        places: what was found at each place.
        axis: on what depends what is missing and has no name; empty: nothing is.
    """
    known = next((advice for condition, advice in ALONG.items() if axis.startswith(condition)), "")
    if not any(p.selected.named for p in places) and (advice := _where_runs_differ(places) or known):
        return advice
    quiet = ("position", "time", "distance")
    worst = [p for p in pairs if p.first not in quiet and p.second not in quiet]
    if worst:
        first, second = worst[0].first, worst[0].second
        return f"Vary {first} and {second} apart: repeat the experiment with the {second} that each {first} has not had yet."
    numbers = [(name, tuple(map(finding, o))) for p in places if not p.idle for name, o in p.selected.alike.items() if o]
    if any(finding(GAIN) in (name, *others) for name, others in numbers):
        return "Weigh what moves, or hold the drive against a force gauge: is it the mechanism or the factor of the drive?"
    same = [
        (t.candidate.kind, others)
        for p in places
        for t, e in zip(p.selected.effects, p.selected.equivalents, strict=True)
        if (others := tuple(k for k in map(finding, e) if k != t.candidate.kind))
    ] + numbers
    if same:
        kind, others = same[0]
        which = f"{words_of(kind)} from {', '.join(map(words_of, others))}"
        if by_clock(kind):
            return f"To distinguish {which}: pauses, strokes of other lengths, and a start from warm."
        return f"To distinguish {which}: more speeds, both directions at each, and a second load."
    return "Rest before break-away, for what rest does to friction; slow reversals, for presliding; a second load."


def _where_runs_differ(places: Sequence[PlaceOutcome]) -> str:
    """Return the next experiment where runs differ and nothing has a name; empty: they do not."""
    told = next(filter(None, map(told_by, places)), "")
    if told:
        return f"Several runs at each of a few values of the {told}, all else alike: is it the {told}, or what went with it?"
    if any(map(runs_apart, places)):
        return "The same run several times, with the zero of the drive read at rest before each: is it the zero or friction?"
    return ""
