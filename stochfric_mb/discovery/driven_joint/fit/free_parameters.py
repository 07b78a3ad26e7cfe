"""The numbers of a joint's model that a fit may adjust, with their scales and bounds."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel

Array = npt.NDArray[np.float64]

LEAST_PRELOAD = 0.01
"""Smallest reference load of a load-dependent joint, over its believed load [-]."""
INSIDE = 1.0e-6
"""Distance kept from bounds that are themselves forbidden [scales]."""
GIVEN = ("static_share", "reference_temperature", "shape_exponent", "adhesion")
"""Parameters that say where others hold, what shows at rest only, or the finer shape of a curve: they stay."""


@dataclasses.dataclass(frozen=True)
class FreeParameter:
    """One number that a fit adjusts."""

    owner: int
    """Number of the effect, -1 for the law, -2 for the mechanism."""
    name: str
    """Name of the number."""
    scale: float
    """A natural step."""
    low: float
    """Smallest value."""
    high: float
    """Largest value."""
    unit: str
    """Unit."""
    believed: float = 0.0
    """What is believed of it, where `deviation` is finite."""
    deviation: float = np.inf
    """Standard deviation of that belief."""


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
    knobs = [FreeParameter(-1, "mu_k", 0.1 * level, 1.0e-9, 1.0e3, "-")]
    if any(e.kind == "frictional_lag" for e in model.effects):
        knobs.append(FreeParameter(-1, "mu_s", 0.1 * level, 1.0e-9, 1.0e3, "-"))
    for i, effect in enumerate(model.effects):
        for field in dataclasses.fields(effect):
            meta, value = field.metadata, getattr(effect, field.name)
            name = field.name
            if "choices" in meta or not isinstance(value, int | float) or not np.isfinite(value) or (i, name) in fixed:
                continue
            if name in GIVEN or (name[-2:] in ("_2", "_3") and value == 0.0):
                continue
            # a joint's friction grows with what it transmits beyond a preload, a contact's with a power of the normal force
            if effect.kind == "load_dependence" and name == ("reference_load" if model.contact else "exponent"):
                continue
            if name == "reference_load" and value == 0.0:  # viscous friction that does not depend on load
                continue
            scale = max(abs(float(value)), 1.0e-3 * meta["scale"])
            margin = INSIDE * scale if meta["strict"] else 0.0
            # a rise of friction with speed is viscous, not a weakening of the other sign
            low = 0.0 if (effect.kind, name) == ("velocity_weakening", "amplitude") else meta["low"]
            # a smaller preload could not be told from none, and would leave no friction without load
            low = LEAST_PRELOAD * model.load if name == "reference_load" else low
            knobs.append(FreeParameter(i, name, scale, low + margin, meta["high"] - margin, meta["unit"]))
    knobs += [FreeParameter(-2, n.name, n.deviation, n.low, np.inf, n.unit, n.value, n.deviation) for n in nuisances]
    return knobs


def value_of(model: JointModel, knob: FreeParameter) -> float:
    """Return the present value of a knob."""
    if knob.owner == -2:
        return model.nuisances[knob.name]
    return float(getattr(model.law if knob.owner == -1 else model.effects[knob.owner], knob.name))


def adjusted(model: JointModel, knobs: Sequence[FreeParameter], values: Array) -> JointModel:
    """Return the model with its knobs at ``values``, each kept within its bounds."""
    law: dict[str, float] = {}
    nuisances = dict(model.nuisances)
    changes: list[dict[str, float]] = [{} for _ in model.effects]
    for knob, raw in zip(knobs, values, strict=True):
        value = float(min(max(raw, knob.low), knob.high))
        if knob.owner == -2:
            nuisances[knob.name] = value
        elif knob.owner == -1:
            law[knob.name] = value
        else:
            changes[knob.owner][knob.name] = value
    # while a joint slides mu_s plays no part: it keeps its ratio to mu_k
    law["mu_s"] = max(law.get("mu_s", law["mu_k"] * model.law.mu_s / model.law.mu_k), law["mu_k"])
    effects = tuple(dataclasses.replace(e, **c) if c else e for e, c in zip(model.effects, changes, strict=True))
    return dataclasses.replace(model, law=dataclasses.replace(model.law, **law), effects=effects, nuisances=nuisances)


def bounds_of(knobs: Sequence[FreeParameter], start: Array, scale: Array) -> tuple[Array, Array]:
    """Return the bounds of the steps; a start on a bound is let in by a hair."""
    low = np.array([(k.low - v) / s for k, v, s in zip(knobs, start, scale, strict=True)])
    high = np.array([(k.high - v) / s for k, v, s in zip(knobs, start, scale, strict=True)])
    return np.minimum(low, -1.0e-9), np.maximum(high, 1.0e-9)
