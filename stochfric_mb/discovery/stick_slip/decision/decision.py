"""What was decided: the effects that are named, or where a disagreement without a name lives."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from stochfric_mb.discovery.inference.false_alarms import Evidence
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.confirmation import SeenInSlips
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects import effect_class


@dataclasses.dataclass(frozen=True)
class Finding:
    """An effect with numbers to start from, as one channel shows it: stick phases, sensor, or the scatter of the slips."""

    kind: str
    """Its name."""
    evidence: Evidence
    """What speaks for it."""
    values: Mapping[str, float | str]
    """Its parameters."""


@dataclasses.dataclass(frozen=True)
class Named:
    """One effect that was decided on."""

    kind: str
    """Its name."""
    class_: tuple[str, ...]
    """Effects that the data cannot distinguish from it, without itself."""
    evidence: Evidence
    """What speaks for it."""
    where: Where
    """Where it shows."""
    before: Model | None = None
    """The model without it, as it stood when it was selected."""
    shape_left: float = 1.0
    """Misfit of simulated slips with it and those before it over that without any [-]; 1 where none were simulated."""


@dataclasses.dataclass(frozen=True)
class Decision:
    """What the fit runs say."""

    verdict: str
    """"effect", "none" or "unknown"."""
    named: tuple[Named, ...]
    """The effects, in the order of selection."""
    where: Where | None
    """Where an unknown disagreement lives."""
    model: Model
    """The model with the effects, at starting values for the refit."""
    ranking: tuple[tuple[str, float], ...]
    """Every candidate of the first round with its score."""
    details: dict[str, object]
    """Numbers behind it."""
    form: Named | None = None
    """The unnamed term of the model that carries what the form of the first effect leaves along the effect's own axis."""
    seen: SeenInSlips | None = None
    """The slips that the effects were simulated with, where they were."""


def selected(kind: str, evidence: Evidence, before: Model, class_: tuple[str, ...] = (), shape_left: float = 1.0) -> Named:
    """Return an effect that is taken into the model ``before``, with where effects of its kind show."""
    cls = effect_class(kind)
    where = Where(cls.shows_on or kind, cls.shows or f"{kind} explains the disagreement")
    return Named(kind, class_, evidence, where, before, shape_left)


def term_of(model: Model, score: float) -> Named:
    """Return a model's last effect, a term without a name, for the result."""
    term = model.effects[-1]
    return Named(term.kind, (), Evidence(score, None), Where(*term.appears()))
