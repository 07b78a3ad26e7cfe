"""What planned runs could show: detection limits, pairs of effects that are not distinguished, and what an extra run adds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.planning.belt_plan import BeltPlan
from stochfric_mb.discovery.planning.joint_motion import require_plannable
from stochfric_mb.discovery.planning.joint_plan import JointPlan
from stochfric_mb.discovery.planning.plan_result import ExtraRun, Limit, Pair, Plan
from stochfric_mb.discovery.planning.planned_run import KEYS, PlannedRun
from stochfric_mb.discovery.planning.rig_plan import RigPlan
from stochfric_mb.discovery.planning.signature import Signature, best_of_each, confused_pairs
from stochfric_mb.discovery.planning.step_plan import StepPlan
from stochfric_mb.effects import effect_class
from stochfric_mb.errors import InputError
from stochfric_mb.mechanisms import BeltBox, Mjcf, SpringSlider
from stochfric_mb.scenario import Scenario

Progress = Callable[[str], None]


class _Outlook:
    """What some runs could show."""

    def __init__(self, rig: RigPlan, parts: Sequence[Any]) -> None:
        signatures, self.unseen = rig.signatures(parts)
        self.best = {kind: s for kind, s in best_of_each(signatures).items() if math.isfinite(s.limit)}
        """Kind -> its form with the smallest limit."""
        self.pairs = confused_pairs(signatures, rig.apart)
        """Effects that are not distinguished, and from which size over their limits on they are."""


def planned(
    scenario: Scenario[Any],
    runs: Sequence[PlannedRun],
    *,
    joint: str | None = None,
    extra: bool = True,
    progress: Progress = lambda _: None,
) -> Plan:
    """Return what runs of a rig could show of what its model may lack, before anything is measured.

    Args:
        scenario: the stated model.
        runs: runs that are planned.
        joint: joint of a MuJoCo model whose friction is planned; None: the first that has any.
        extra: whether further runs are tried.
        progress: called with the name of each stage as it begins.

    Raises:
        InputError: a mechanism that cannot be planned, or runs that discovery would refuse; says what would do.
    """
    rig = _rig(scenario, joint)
    parts: list[Any] = []
    for i, run in enumerate(runs):
        progress(run.name)
        parts.append(rig.part(run, i))
    progress("detection limits")
    now = _Outlook(rig, parts)
    further: list[ExtraRun] = []
    for text, run in rig.extra_runs(runs[0]) if extra else ():
        progress(f"with {text}")
        try:
            more = _Outlook(rig, [*parts, rig.part(run, len(parts))])
        except InputError:
            continue  # a run that discovery would refuse adds nothing
        further.append(_extra(text, run, runs[0], now, more))
    best = now.best
    return Plan(
        runs=tuple(map(rig.facts, parts)),
        limits=tuple(_limit(rig, s) for s in best.values()),
        unseen=now.unseen,
        no_limit=tuple(k for k in rig.no_limit if k not in best and k not in now.unseen),
        pairs=tuple(Pair(*pair, multiple if math.isfinite(multiple) else None) for pair, multiple in now.pairs.items()),
        extra=tuple(sorted(further, key=lambda e: (-len(e.shows) - len(e.separates), e.limits))),
        notes=(*rig.notes, *_notes(rig, runs, parts)),
        rotational=rig.rotational,
    )


def _limit(rig: RigPlan, best: Signature) -> Limit:
    fields = effect_class(best.kind).__dataclass_fields__
    units = {k: rig.unit(str(fields[k].metadata.get("unit", "-"))) for k, v in best.beside.items() if not isinstance(v, str)}
    return Limit(best.kind, best.parameter, rig.unit(best.unit), best.limit, dict(best.beside), units, best.at_most)


def _rig(scenario: Scenario[Any], joint: str | None) -> RigPlan:
    mechanism: Any = scenario.mechanism
    if joint is not None and not isinstance(mechanism, Mjcf):
        raise InputError(f"joint = {joint!r}: mechanism {mechanism.kind!r} has one joint; leave it out")
    if isinstance(mechanism, Mjcf):
        place = joint or next(iter(mechanism.friction))
        require_plannable(mechanism, place)
        return JointPlan(scenario, place)
    plans = {BeltBox: BeltPlan, SpringSlider: StepPlan}
    return plans.get(type(mechanism), JointPlan)(scenario)


def _extra(text: str, run: PlannedRun, first: PlannedRun, now: _Outlook, more: _Outlook) -> ExtraRun:
    """Return what a further run adds."""
    before, after = now.best, more.best
    ratios = [after[k].limit / before[k].limit for k in before if k in after]
    shown = tuple(k for k in now.unseen if k not in more.unseen)
    changed = {k: v for k, v in run.settings.items() if first.settings.get(k) != v}
    changed |= {k: getattr(run, k) for k in KEYS if getattr(run, k) != getattr(first, k)}
    return ExtraRun(
        text,
        changed,
        shown,
        tuple(p for p in now.pairs if p not in more.pairs),
        float(np.exp(np.mean(np.log(ratios)))) if ratios else 1.0,
    )


def _notes(rig: RigPlan, runs: Sequence[PlannedRun], parts: Sequence[Any]) -> list[str]:
    return [
        f"{part.run.name}: the noise of the {what} is not stated; {getattr(part.run, key):.3g} {rig.unit(unit)} is assumed"
        for run, part in zip(runs, parts, strict=True)
        for key, what, unit in (("noise", "position", "m"), ("force_noise", "force", "N"))
        if getattr(run, key) is None and getattr(part.run, key) is not None
    ]
