"""What it is worth that wrong readings are replaced: by what part the error of a place's balance falls."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.fitting import fit, prior_weight
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.simulation.scores import Score, rms
from stochfric_mb.discovery.driven_joint.sliding import hardly_sliding

Plain = tuple[JointModel, Sequence[Nuisance], float]
"""A model of a place, numbers of its mechanism with their priors, and how beliefs weigh, as of `fit`."""


def as_stated(source: Balances, name: str) -> Plain:
    """Return a place as it is stated."""
    model = source.stated(name)
    return model, source.nuisances(name), model.law.mu_k * model.load


def as_named(place: PlaceOutcome) -> Plain:
    """Return a place with what is named there."""
    final = place.selected.final
    return final.model, place.selected.nuisances, prior_weight(final)


def error_kept(
    as_read: Balances, repaired: Balances, models: Mapping[str, Plain], late: Mapping[str, float] | None = None
) -> float:
    """Return the least part that the error of a place's balance keeps with wrong readings replaced, seen alike [-].

    Args:
        as_read: balances with the readings as they were.
        repaired: the same with wrong ones replaced.
        models: place -> the model of it from which fits begin, numbers of its mechanism, and how beliefs weigh.
        late: place -> by how much positions come late there, beyond what is stated [s].
    """
    parts: list[float] = []
    if hardly_sliding(as_read) is not None:  # as it was read, nothing could be said: a position that is new now and then
        return 0.0
    for name, (model, nuisances, noise) in models.items():
        delay = as_read.stated_delay + (late or {}).get(name, 0.0)
        before = as_read.balances(name, "fit", delay)
        width = _width(before)
        raw, mended_ones = (s.balances(name, "fit", delay, width) for s in (as_read, repaired))
        seen = [_where_sliding(raw, mended_ones), mended_ones]
        error, replaced = (fit(model, s, nuisances, noise=noise).rms for s in seen)
        parts.append(replaced / error)
    return min(parts)


def _width(balances: Sequence[ForceBalance]) -> int:
    """Return the usual half width of windows [samples]."""
    return round(float(np.median([s.window.half_width / s.window.interval for s in balances])))


def _where_sliding(as_read: Sequence[ForceBalance], repaired: Sequence[ForceBalance]) -> list[ForceBalance]:
    """Return balances of readings as they were, where the joint slides: a stray reading turns a motion round in its window."""
    return [
        dataclasses.replace(raw, sliding=better.sliding) if len(raw.sliding) == len(better.sliding) else raw
        for raw, better in zip(as_read, repaired, strict=True)
    ]


def with_readings(place: PlaceOutcome, as_read: Balances) -> PlaceOutcome:
    """Return a place whose errors without effects are those of the readings as they were, seen through the same windows."""
    width = _width(place.test)
    seen = [as_read.balances(place.place, role, as_read.stated_delay, width) for role in ("fit", "test")]
    seen = [_where_sliding(*pair) for pair in zip(seen, (place.fit, place.test), strict=True)]
    if not all(any(s.sliding.any() for s in some) for some in seen):
        return place
    fitted = fit(place.stated, seen[0], place.nuisances, noise=place.stated.law.mu_k * place.stated.load).model
    errors: dict[str, Score] = {}
    for label, model in (("baseline", place.stated), ("recalibrated", fitted)):
        rest = np.concatenate([model.remainder(s, place.nuisances)[s.sliding] for s in seen[1]])
        errors[label] = dataclasses.replace(place.scores[label], sliding=rms(rest))
    return dataclasses.replace(place, scores=dict(place.scores) | errors)
