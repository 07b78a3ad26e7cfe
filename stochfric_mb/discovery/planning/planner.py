"""What planned runs could show: detection limits, pairs of effects that stay confused, and the extra run that tells most."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.planning.belt_plan import BeltPlan
from stochfric_mb.discovery.planning.joint_plan import JointPlan
from stochfric_mb.discovery.planning.plan_result import ExtraRun, Limit, Pair, Plan
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.signature import Signature, best_of_each, confused_pairs
from stochfric_mb.effects import effect_class
from stochfric_mb.errors import InputError
from stochfric_mb.mechanisms import BeltBox, HingePendulum, PrismaticJoint, SpringSlider
from stochfric_mb.scenario import Scenario

ADVICE = {
    SpringSlider.kind: "Its laws of memory show in steps of the speed: plan at least two steps up and two down, each over ten "
    "times the distance that friction remembers, and hold out one of each"
}
"""Mechanism that cannot be planned -> what to plan all the same."""

RUN_NUMBERS = ("duration", "sample_rate", "stroke", "period", "noise", "force_noise")
"""Numbers of a run beside those of its mechanism."""
Progress = Callable[[str], None]


@dataclasses.dataclass(frozen=True)
class _Outlook:
    """What some runs could show."""

    signatures: Sequence[Signature]
    unseen: Mapping[str, str]

    @property
    def best(self) -> dict[str, Signature]:
        """Kind -> its form with the smallest limit."""
        return {kind: s for kind, s in best_of_each(self.signatures).items() if math.isfinite(s.limit)}


def planned(
    scenario: Scenario[Any], runs: Sequence[PlannedRun], *, extra: bool = True, progress: Progress = lambda _: None
) -> Plan:
    """Return what runs of a rig could show of what its model may lack, before anything is measured.

    Args:
        scenario: the model believed.
        runs: runs that are planned.
        extra: whether further runs are tried.
        progress: called with the name of each stage as it begins.

    Raises:
        InputError: a mechanism that cannot be planned, or runs that discovery would refuse; says what would do.
    """
    rig = _rig(scenario)
    parts: list[Any] = []
    for i, run in enumerate(runs):
        progress(run.name)
        parts.append(rig.part(run, i))
    progress("detection limits")
    now = _Outlook(*rig.signatures(parts))
    pairs = confused_pairs(now.signatures)
    further: list[ExtraRun] = []
    for text, run in rig.extra_runs(runs[0]) if extra else ():
        progress(f"with {text}")
        try:
            more = _Outlook(*rig.signatures([*parts, rig.part(run, len(parts))]))
        except InputError:
            continue  # a run that discovery would refuse adds nothing
        further.append(_extra(text, run, runs[0], now, more, pairs))
    best = now.best
    return Plan(
        runs=tuple(p.facts() for p in parts),
        limits=tuple(_limit(rig, s) for s in best.values()),
        unseen=now.unseen,
        no_limit=tuple(k for k in rig.no_limit if k not in best and k not in now.unseen),
        pairs=tuple(Pair(*pair, multiple if math.isfinite(multiple) else None) for pair, multiple in pairs.items()),
        extra=tuple(sorted(further, key=lambda e: (-len(e.shows) - len(e.separates), e.limits))),
        notes=tuple(_notes(rig, runs, parts)),
    )


def _limit(rig: Any, best: Signature) -> Limit:
    fields = effect_class(best.kind).__dataclass_fields__
    units = {k: rig.unit(str(fields[k].metadata.get("unit", "-"))) for k, v in best.beside.items() if not isinstance(v, str)}
    return Limit(best.kind, best.parameter, rig.unit(best.unit), best.limit, dict(best.beside), units, best.at_most)


def _rig(scenario: Scenario[Any]) -> Any:
    if isinstance(scenario.mechanism, BeltBox):
        return BeltPlan(scenario)
    if isinstance(scenario.mechanism, PrismaticJoint | HingePendulum):
        return JointPlan(scenario)
    raise InputError(
        f"mechanism {scenario.mechanism.kind!r} cannot be planned; belt_box, prismatic_joint and hinge_pendulum can. "
        + ADVICE.get(scenario.mechanism.kind, "Plan one of its joints by itself, as a prismatic_joint or hinge_pendulum")
    )


def _extra(
    text: str,
    run: PlannedRun,
    first: PlannedRun,
    now: _Outlook,
    more: _Outlook,
    pairs: Mapping[tuple[str, str], float],
) -> ExtraRun:
    """Return what a further run adds."""
    still = confused_pairs(more.signatures)
    before, after = now.best, more.best
    ratios = [after[k].limit / before[k].limit for k in before if k in after]
    shown = tuple(k for k in now.unseen if k not in more.unseen)
    changed = {k: v for k, v in run.settings.items() if first.settings.get(k) != v}
    changed |= {k: getattr(run, k) for k in RUN_NUMBERS if getattr(run, k) != getattr(first, k)}
    return ExtraRun(
        text,
        changed,
        shown,
        tuple(p for p in pairs if p not in still),
        float(np.exp(np.mean(np.log(ratios)))) if ratios else 1.0,
    )


def _notes(rig: Any, runs: Sequence[PlannedRun], parts: Sequence[Any]) -> list[str]:
    return [
        f"{part.run.name}: the noise of the position is not stated; {part.run.noise:.3g} {rig.unit('m')} is assumed"
        for run, part in zip(runs, parts, strict=True)
        if run.noise is None
    ]
