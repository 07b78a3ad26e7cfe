"""The numbers of a joint's model that a fit may adjust, with their scales and bounds."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM, FreeParameter
from stochfric_mb.effects import Effect

Array = npt.NDArray[np.float64]

LEAST_COEFFICIENT, MOST_COEFFICIENT = 1.0e-9, 1.0e3
"""Bounds of a coefficient of friction that nothing is believed of [-]: the load that it is taken of may be any."""
LEAST_PRELOAD = 0.01
"""Smallest reference load of a load-dependent joint, over its stated load [-]."""
INSIDE = 1.0e-6
"""Distance kept from bounds that are themselves forbidden [scales]."""
GIVEN = ("static_share", "reference_temperature", "shape_exponent", "tail")
"""Parameters that say where others hold, what shows at rest only, or the finer shape of a curve: they stay."""


def free_parameters(
    model: JointModel, nuisances: Sequence[Nuisance], fixed: Sequence[tuple[int, str]] = ()
) -> list[FreeParameter]:
    """Return what a fit may adjust.

    Args:
        model: the model; effects bring the numbers that they hold.
        nuisances: numbers of the mechanism with their priors.
        fixed: number of an effect and name of its parameter, for those that stay.
    """
    level = max(model.law.mu_k, 1.0e-6)
    coefficients = ("mu_k", "mu_s") if any("mu_s" in e.frees for e in model.effects) else ("mu_k",)
    free = [FreeParameter(LAW, n, getattr(model.law, n), 0.1 * level, *_coefficient_prior(model, n)) for n in coefficients]
    for i, effect in enumerate(model.effects):
        for field in dataclasses.fields(effect):
            value = getattr(effect, field.name)
            if (i, field.name) in fixed or not isinstance(value, int | float) or not _fitted(model, effect, field.name, value):
                continue
            one = _parameter(model, i, field, float(value))
            runs = [(run, x) for (kind, run, name), x in model.own.items() if (kind, name) == (effect.kind, field.name)]
            free += [dataclasses.replace(one, run=run, value=x) for run, x in runs] or [one]
    return free + [_with_prior(model, n) for n in nuisances]


def _coefficient_prior(model: JointModel, name: str) -> tuple[float, float, str, float, float]:
    """Return the bounds of a coefficient, its unit, and mean and deviation of its prior: `MOST_OFF` of these are its bounds."""
    value, deviation = model.level if name == "mu_k" else (0.0, np.inf)
    most = criteria.MOST_OFF * deviation
    return max(LEAST_COEFFICIENT, value - most), min(MOST_COEFFICIENT, value + most), "-", value, deviation


def _with_prior(model: JointModel, n: Nuisance) -> FreeParameter:
    """Return a number of the mechanism, which data may move by `MOST_OFF` of its deviations."""
    low, high = max(n.low, n.value - criteria.MOST_OFF * n.deviation), n.value + criteria.MOST_OFF * n.deviation
    return FreeParameter(
        MECHANISM, n.name, model.nuisances.get(n.name, n.value), n.deviation, low, high, n.unit, n.value, n.deviation
    )


def _fitted(model: JointModel, effect: Effect, name: str, value: float) -> bool:
    """Return whether a number of an effect is to be fitted: one at its default is no part of this form of the effect."""
    default = effect.__dataclass_fields__[name].default
    return bool(np.isfinite(value)) and value != default and name not in (*GIVEN, *effect.kept_at_joints(model.contact))


def _parameter(model: JointModel, owner: int, field: dataclasses.Field[Any], value: float) -> FreeParameter:
    """Return a number of an effect as what a fit adjusts."""
    name, about = field.name, field.metadata
    scale = max(abs(value), 1.0e-3 * about["scale"])
    low = about["fit_low"]
    # at its default it would be no part of this form, and stay there
    margin = INSIDE * scale if about["strict"] or low == field.default else 0.0
    # a smaller preload could not be measured, and would leave no friction without load
    low = LEAST_PRELOAD * model.load if name == "reference_load" else low
    return FreeParameter(owner, name, value, scale, low + margin, about["fit_high"] - margin, about["unit"])


def adjusted(model: JointModel, free: Sequence[FreeParameter], values: Array) -> JointModel:
    """Return the model with its free parameters at ``values``, each kept within its bounds."""
    law: dict[str, float] = {}
    nuisances = dict(model.nuisances)
    changes: list[dict[str, float]] = [{} for _ in model.effects]
    own = dict(model.own)
    for one, raw in zip(free, values, strict=True):
        value = one.inside(raw)
        if one.owner == MECHANISM:
            nuisances[one.name] = value
        elif one.owner == LAW:
            law[one.name] = value
        elif one.run:
            own[model.effects[one.owner].kind, one.run, one.name] = value
        else:
            changes[one.owner][one.name] = value
    # while a joint slides mu_s plays no part: it keeps its ratio to mu_k
    law["mu_s"] = max(law.get("mu_s", law["mu_k"] * model.law.mu_s / model.law.mu_k), law["mu_k"])
    effects = tuple(e.changed(**c) if c else e for e, c in zip(model.effects, changes, strict=True))
    return dataclasses.replace(model, law=dataclasses.replace(model.law, **law), effects=effects, nuisances=nuisances, own=own)
