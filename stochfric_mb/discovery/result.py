"""The outcome of discovery, as ``result.json`` holds it (schema ``stochfric.discovery/1``)."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any, Literal

from stochfric_mb.discovery import criteria

SCHEMA = "stochfric.discovery/1"

Verdict = Literal["effect", "none", "unknown"]
Leading = Literal["gap", "slip_forces", "readings"]
ROUNDING = 1.0e-8
"""Relative difference of two errors up to which they are equal [-]: fits of one model end so close, and files hold no more."""


@dataclasses.dataclass(frozen=True)
class Interval:
    """A fitted number with its 95 % interval."""

    value: float
    low: float
    high: float
    unit: str


@dataclasses.dataclass(frozen=True)
class Where:
    """Where a disagreement lives."""

    axis: str
    """Axis, such as "belt position", "time within a slip", "relative velocity"."""
    text: str
    """One sentence for a reader."""


@dataclasses.dataclass(frozen=True)
class EffectEstimate:
    """One effect that discovery identified, with its fitted parameters."""

    kind: str
    """Its name in the vocabulary."""
    equivalent_to: tuple[str, ...]
    """Effects that these data cannot distinguish from it."""
    where: Where
    """Where it shows."""
    parameters: dict[str, Interval]
    """Its fitted parameters."""
    score: float | None
    """Evidence: 2 delta log L - p ln n - 2 ln(grid size) [-]; None for what a detector says, which has no likelihood."""
    p_value: float | None
    """Chance, at most, of as much where nothing is missing [-]; None where it is not known."""

    def to_dict(self) -> dict[str, Any]:
        """Return the effect as ``result.json`` holds it."""
        return {
            "kind": self.kind,
            "equivalent_to": list(self.equivalent_to),
            "where": dataclasses.asdict(self.where),
            "parameters": {k: dataclasses.asdict(v) for k, v in self.parameters.items()},
            "evidence": {"score": self.score, "p_value": self.p_value},
        }


@dataclasses.dataclass(frozen=True)
class Gap:
    """Distance of models from data, before and after."""

    metric: str
    """"crps_one_cycle" for stick-slip, otherwise the forward simulation or inverse dynamics error, named."""
    unit: str
    """Its unit."""
    held_out: bool
    """Whether it was measured on runs that no fit has seen."""
    baseline: float
    """The model as stated."""
    recalibrated: float
    """The same with its parameters fitted within their uncertainty."""
    augmented: float
    """The augmented model: with the identified effects."""
    floor: float
    """What the final model scores on data simulated from itself with the noise of the record, or as ``floor_from`` says."""
    floor_from: str = "simulated from the final model with the record's noise"
    """Where the floor comes from."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What must be said where effects, or fitted numbers, do not bring the model closer to the held-out runs."""
        unit = "" if self.unit == "-" else f" {self.unit}"
        errors = ("augmented", self.augmented, "recalibrated", self.recalibrated), (
            "recalibrated", self.recalibrated, "stated", self.baseline,
        )  # fmt: skip
        return tuple(
            f"on the held-out runs the {worse} model is off by more ({a:.3g}{unit}) than the {better} one ({b:.3g}{unit})"
            for worse, a, better, b in errors
            if a > (1.0 + criteria.CLOSES_NOTHING) * b
        )

    @property
    def reducible(self) -> float:
        """Part of the recalibrated model's error that lies above the floor."""
        return self.recalibrated - self.floor

    @property
    def closed(self) -> float | None:
        """Share of the reducible gap that the effects close; None where there is none."""
        reducible = self.reducible
        measurable = reducible > criteria.CLOSES_NOTHING * self.recalibrated
        if not measurable:
            return None
        removed = self.recalibrated - self.augmented
        return removed / reducible if abs(removed) > ROUNDING * self.recalibrated else 0.0


@dataclasses.dataclass(frozen=True)
class Result:
    """Everything that discovery says; every sentence of the report is backed by a number in here."""

    verdict: Verdict
    """"effect", "none" or "unknown"."""
    effects: tuple[EffectEstimate, ...]
    """The identified effects, in the order of selection; empty for "none" and "unknown"."""
    where: Where | None
    """For "unknown": when and where the disagreement lives."""
    ranking: tuple[tuple[str, float], ...]
    """Every candidate with its score, best first."""
    gap: Gap | None
    """Before and after; None where no forecast was possible."""
    not_identifiable: tuple[str, ...]
    """Effects that this experiment cannot see."""
    next_experiment: str
    """The experiment that would decide what is open."""
    parameters: dict[str, Interval]
    """Parameters of mechanism and law: with the effects where the verdict is an effect, otherwise recalibrated."""
    notes: tuple[str, ...] = ()
    """What a reader should know: outliers removed, belt speed off, data lost, ..."""
    unnamed: EffectEstimate | None = None
    """For "unknown": a smooth change of friction that held-out runs bear out, though it has no name; it is in the augmented
    scenario."""
    slip_forces: Gap | None = None
    """The same in the forces of single slips, the source of evidence; None where nothing was named, or they cannot show it."""
    readings: Gap | None = None
    """The same in single readings; None where the first effect is no fault that these alone show."""
    leading: Leading = "gap"
    """The score in which the effects show: that of forecasts, or, where those can hardly be made better, that of the forces,
    or, where readings stray or are late, that of the readings."""
    power: dict[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Smallest strength of an effect that would have been named, by kind."""
    details: dict[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    """Numbers behind the report: noise, slips, calibration, confirmation, scores of the channels."""

    @property
    def believed(self) -> dict[str, Interval]:
        """`parameters` by the name that ``result.json`` gives them."""
        return self.parameters

    @property
    def leads(self) -> Gap | None:
        """The gap of the score that leads; None where there is none."""
        return {"gap": self.gap, "slip_forces": self.slip_forces, "readings": self.readings}[self.leading]

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``result.json``."""
        gap, forces, readings = (
            None if one is None else dataclasses.asdict(one) | {"closed": one.closed}
            for one in (self.gap, self.slip_forces, self.readings)
        )
        return {
            "schema": SCHEMA,
            "verdict": self.verdict,
            "effects": [e.to_dict() for e in self.effects],
            "unnamed": self.unnamed.to_dict() if self.unnamed is not None else None,
            "where": dataclasses.asdict(self.where) if self.where is not None else None,
            "ranking": [{"kind": kind, "score": score} for kind, score in self.ranking],
            "gap": gap,
            "slip_forces": forces,
            "readings": readings,
            "leading": self.leading,
            "not_identifiable": list(self.not_identifiable),
            "next_experiment": self.next_experiment,
            "believed": {k: dataclasses.asdict(v) for k, v in self.believed.items()},
            "notes": list(self.notes),
            "power": self.power,
            "details": self.details,
        }

    def to_json(self) -> str:
        """Return the text of ``result.json``; numbers that are not finite become null, digits are those that matter."""
        return json.dumps(_plain(self.to_dict()), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]  # pyright: ignore[reportUnknownVariableType]
    if isinstance(value, (bool, str)) or value is None:
        return value
    if isinstance(value, int):
        return value
    number = float(value)
    return float(f"{number:.8g}") if math.isfinite(number) else None
