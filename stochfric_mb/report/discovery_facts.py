"""The numbers that the page of a discovery shows beside the result's own: data, model as stated, statistics of events."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.discovery.result import Result
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.effects import effect_class, effect_kinds
from stochfric_mb.report.discovery_evidence import BAND, EVENTS, Evidence, band
from stochfric_mb.storage import versions

CONFIDENCE = 0.95
"""Confidence of the intervals in a result [-]."""


def complete(outcome: Outcome, evidence: Evidence | None, command: str) -> Result:
    """Return the result with every number that its page shows, under ``details``.

    Args:
        outcome: result, models and data of the discovery.
        evidence: what is drawn of it.
        command: the command that made it.
    """
    kinds = {e.kind for e in outcome.result.effects} & set(effect_kinds())
    facts: dict[str, Any] = {
        "title": outcome.dataset.title,
        "stated": outcome.dataset.scenario.to_dict(),
        "runs": _runs(outcome),
        "equations": {kind: effect_class(kind).equation for kind in sorted(kinds)},
        "thresholds": {"followed_up": criteria.FOLLOWED_UP, "named": criteria.NAMED},
        "criteria": criteria.values(),
        "confidence": CONFIDENCE,
        "command": command,
        "versions": versions(),
    }
    if outcome.result.power:
        facts["detection_limits"] = [_limit(kind, size) for kind, size in outcome.result.power.items()]
    if evidence is not None:
        facts["band"] = BAND
        facts["events"] = _events(evidence)
        facts["left_over_force"] = {"before": evidence.before.rms} | (
            {"after": evidence.after.rms} if evidence.after is not None else {}
        )
    return dataclasses.replace(outcome.result, details={**outcome.result.details, **facts})


def _limit(kind: str, size: float) -> dict[str, Any]:
    """Return a detection limit with the name and the unit of the parameter that it is a value of: the effect's first number."""
    first = next(f for f in dataclasses.fields(effect_class(kind)) if "choices" not in f.metadata or not f.metadata["choices"])
    return {"kind": kind, "parameter": first.name, "value": size, "unit": first.metadata["unit"]}


def _runs(outcome: Outcome) -> list[dict[str, Any]]:
    slips: dict[str, Slips] = {}
    if outcome.study is not None:
        slips |= {s.record.name: s for s in outcome.study.pool.slips}
    if outcome.runs is not None:
        slips |= {s.record.name: s for s in outcome.runs.slips}
    rows: list[dict[str, Any]] = []
    for run in outcome.dataset.runs:
        row: dict[str, Any] = {
            "name": run.name, "role": run.role, "duration": float(run.time[-1] - run.time[0]),
            "rate": 1.0 / run.sample_interval, "set": dict(run.settings), "notes": list(run.notes),
        }  # fmt: skip
        if run.name in slips:
            row |= {"slips": len(slips[run.name]), "noise": slips[run.name].noise.deviation}
        rows.append(row)
    return rows


def _events(evidence: Evidence) -> dict[str, dict[str, dict[str, float | str | None]]]:
    table: dict[str, dict[str, dict[str, float | str | None]]] = {}
    for name, statistics in evidence.events.items():
        table[name] = {}
        for statistic, values in statistics.items():
            middle, low, high = band(values) if len(values) else (np.nan, np.nan, np.nan)
            table[name][statistic] = {
                "median": float(middle), "low": float(low), "high": float(high), "unit": EVENTS[statistic]
            }  # fmt: skip
    return table
