"""Fits of a joint's friction and of the numbers believed of its mechanism to the balance of forces."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.joints.friction import friction_along
from stochfric_mb.discovery.joints.gauss_newton import least_squares
from stochfric_mb.discovery.joints.sheet import Nuisance, Sheet
from stochfric_mb.effects import Effect
from stochfric_mb.laws import Law

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

EVALUATIONS = 12
"""Most Gauss-Newton steps: the balance is linear in most numbers."""
PER_STROKE = 6
"""Independent numbers that one stroke can give: friction's errors repeat along a stroke, and that no autocorrelation shows."""
LEAST_PRELOAD = 0.01
"""Smallest reference load of a load-dependent joint, over its believed load [-]."""
INSIDE = 1.0e-6
"""Distance kept from bounds that are themselves forbidden [scales]."""


@dataclasses.dataclass(frozen=True)
class JointModel:
    """What is believed of a joint in the making: corrections, law and effects."""

    law: Law
    """Friction law; mu_k holds while the joint slides."""
    effects: tuple[Effect, ...]
    """Effects added to it."""
    nuisances: Mapping[str, float]
    """Number of the mechanism -> its value."""
    load: float
    """Believed load of the joint [N or N m]."""

    def plus(self, *effects: Effect) -> JointModel:
        """Return the model with further effects."""
        return dataclasses.replace(self, effects=(*self.effects, *effects))

    def remainder(self, sheet: Sheet, nuisances: Sequence[Nuisance]) -> Array:
        """Return what the model leaves of the balance of a sheet [N or N m], shape (n_centres,)."""
        rest = sheet.driven - friction_along(sheet, self.law, self.effects, self.load)
        for n in nuisances:
            if n.name in sheet.columns:
                rest = rest - (self.nuisances[n.name] - n.value) * sheet.columns[n.name]
        return rest


@dataclasses.dataclass(frozen=True)
class Knob:
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


@dataclasses.dataclass(frozen=True)
class JointFit:
    """A fitted model, and what is known of its numbers."""

    model: JointModel
    """The model."""
    knobs: tuple[Knob, ...]
    """What was adjusted."""
    values: Array
    """Fitted values, shape (n_knobs,)."""
    covariance: Array
    """Their covariance, correlation of neighbouring windows allowed for, shape (n_knobs, n_knobs)."""
    remainders: tuple[Array, ...]
    """What is left at the centres that were fitted, sheet by sheet [N or N m]."""
    jacobian: Array
    """Change of the remainder with each number, shape (n, n_knobs)."""
    strokes: int
    """Stretches of sliding one way that were fitted."""

    @property
    def rms(self) -> float:
        """Root mean square of what is left [N or N m]."""
        return float(np.sqrt(np.mean(np.concatenate(self.remainders) ** 2)))

    @property
    def independent(self) -> float:
        """Number of independent windows: from the autocorrelation of what is left, `PER_STROKE` a stroke at most."""
        return min(sum(independent_count(r) for r in self.remainders), float(PER_STROKE * self.strokes))

    def deviation(self, owner: int, name: str) -> float:
        """Return the standard deviation of a fitted number; nan if it was not fitted."""
        for i, knob in enumerate(self.knobs):
            if (knob.owner, knob.name) == (owner, name):
                return float(np.sqrt(max(self.covariance[i, i], 0.0)))
        return float("nan")


def independent_count(values: Array) -> float:
    """Return to how many independent numbers a series is worth: n over its integrated autocorrelation.

    The sum ends where the autocorrelation first falls below two standard errors of white noise.
    """
    n = len(values)
    if n < 8:
        return float(n)
    x = values - values.mean()
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.abs(np.fft.rfft(x, size)) ** 2
    correlation = np.fft.irfft(spectrum, size)[: n // 2]
    if correlation[0] <= 0.0:
        return float(n)
    correlation = correlation / correlation[0]
    end = int(np.argmax(correlation < 2.0 / np.sqrt(n))) or len(correlation)
    return float(n / max(1.0 + 2.0 * correlation[1:end].sum(), 1.0))


def stroke_count(masks: Sequence[Mask]) -> int:
    """Return the number of stretches of windows without a gap."""
    return sum(int(np.count_nonzero(np.diff(np.r_[0, m.astype(np.int8)]) > 0)) for m in masks)


def knobs_of(model: JointModel, nuisances: Sequence[Nuisance], fixed: Sequence[str] = ()) -> list[Knob]:
    """Return what a fit may adjust.

    Args:
        model: the model; effects bring the numbers that they hold.
        nuisances: numbers of the mechanism with their priors.
        fixed: names of parameters of effects that stay.
    """
    level = max(model.law.mu_k, 1.0e-6)
    knobs = [Knob(-1, "mu_k", 0.1 * level, 1.0e-9, 1.0e3, "-")]
    if any(e.kind == "frictional_lag" for e in model.effects):
        knobs.append(Knob(-1, "mu_s", 0.1 * level, 1.0e-9, 1.0e3, "-"))
    for i, effect in enumerate(model.effects):
        for field in dataclasses.fields(effect):
            meta, value = field.metadata, getattr(effect, field.name)
            name = field.name
            if "choices" in meta or not isinstance(value, int | float) or not np.isfinite(value) or name in fixed:
                continue
            if name in ("exponent", "static_share") or (name[-2:] in ("_2", "_3") and value == 0.0):
                continue
            if name == "reference_load" and value == 0.0:  # viscous friction that does not depend on load
                continue
            scale = max(abs(float(value)), 1.0e-3 * meta["scale"])
            margin = INSIDE * scale if meta["strict"] else 0.0
            # a rise of friction with speed is viscous, not a weakening of the other sign
            low = 0.0 if (effect.kind, name) == ("velocity_weakening", "amplitude") else meta["low"]
            # a smaller preload could not be told from none, and would leave no friction without load
            low = LEAST_PRELOAD * model.load if name == "reference_load" else low
            knobs.append(Knob(i, name, scale, low + margin, meta["high"] - margin, meta["unit"]))
    knobs += [Knob(-2, n.name, n.deviation, n.low, np.inf, n.unit, n.value, n.deviation) for n in nuisances]
    return knobs


def value_of(model: JointModel, knob: Knob) -> float:
    """Return the present value of a knob."""
    if knob.owner == -2:
        return model.nuisances[knob.name]
    return float(getattr(model.law if knob.owner == -1 else model.effects[knob.owner], knob.name))


def adjusted(model: JointModel, knobs: Sequence[Knob], values: Array) -> JointModel:
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


def fit(
    model: JointModel,
    sheets: Sequence[Sheet],
    nuisances: Sequence[Nuisance],
    *,
    noise: float,
    masks: Sequence[Mask] | None = None,
    evaluations: int = EVALUATIONS,
    fixed: Sequence[str] = (),
) -> JointFit:
    """Return the model fitted to the balance of ``sheets``.

    Args:
        model: where the fit starts.
        sheets: runs to learn from.
        nuisances: numbers of the mechanism with their priors.
        noise: standard deviation of the remainder per window for which priors count as one independent window [N or N m].
        masks: windows to use in each sheet; None: those in which the joint slides.
        evaluations: most Gauss-Newton steps.
        fixed: names of parameters of effects that stay.
    """
    used = [s.sliding for s in sheets] if masks is None else list(masks)
    knobs = knobs_of(model, nuisances, fixed)
    start = np.array([value_of(model, k) for k in knobs])
    scale = np.array([k.scale for k in knobs])
    tied = [i for i, k in enumerate(knobs) if np.isfinite(k.deviation)]
    believed = np.array([knobs[i].believed for i in tied])
    deviation = np.array([knobs[i].deviation for i in tied])

    def errors(step: Array) -> Array:
        values = start + scale * step
        trial = adjusted(model, knobs, values)
        parts = [trial.remainder(s, nuisances)[m] for s, m in zip(sheets, used, strict=True)]
        return np.concatenate([*parts, noise * (values[tied] - believed) / deviation])

    steps, jacobian = least_squares(errors, *bounds_of(knobs, start, scale), evaluations=evaluations)
    values = start + scale * steps
    fitted = adjusted(model, knobs, values)
    parts = tuple(fitted.remainder(s, nuisances)[m] for s, m in zip(sheets, used, strict=True))
    n = sum(map(len, parts))
    result = JointFit(
        fitted, tuple(knobs), values, np.zeros((len(knobs), len(knobs))), parts, jacobian[:n] / scale, stroke_count(used)
    )
    inflation = n / max(result.independent, 1.0)
    # priors enter the information as they did the fit, with the weight of one window at ``noise``
    information = jacobian[:n].T @ jacobian[:n] / (result.rms**2 * inflation + 1.0e-300)
    for i, d in zip(tied, deviation, strict=True):
        information[i, i] += (scale[i] / d) ** 2
    covariance = np.linalg.pinv(information, hermitian=True) * np.outer(scale, scale)
    return dataclasses.replace(result, covariance=covariance)


def prior_rows(fitted: JointFit, noise: float) -> tuple[Array, Array]:
    """Return the rows by which priors enter a linear fit about ``fitted``, shape (n_tied, n_knobs), and their values.

    Args:
        fitted: the fit.
        noise: as of `fit`.
    """
    tied = [i for i, k in enumerate(fitted.knobs) if np.isfinite(k.deviation)]
    rows = np.zeros((len(tied), len(fitted.knobs)))
    values = np.zeros(len(tied))
    for row, i in enumerate(tied):
        knob = fitted.knobs[i]
        rows[row, i] = noise / knob.deviation
        values[row] = noise * (fitted.values[i] - knob.believed) / knob.deviation
    return rows, values


def bounds_of(knobs: Sequence[Knob], start: Array, scale: Array) -> tuple[Array, Array]:
    """Return the bounds of the steps; a start on a bound is let in by a hair."""
    low = np.array([(k.low - v) / s for k, v, s in zip(knobs, start, scale, strict=True)])
    high = np.array([(k.high - v) / s for k, v, s in zip(knobs, start, scale, strict=True)])
    return np.minimum(low, -1.0e-9), np.maximum(high, 1.0e-9)


def effect_columns(model: JointModel, effect: Effect, sheets: Sequence[Sheet]) -> Array:
    """Return how an effect and its parameters would change the friction of a model, shape (n, 1 + n_parameters)."""
    trial = model.plus(effect)
    owner = len(trial.effects) - 1
    knobs = [k for k in knobs_of(trial, ()) if k.owner == owner]
    if effect.kind == "frictional_lag":
        knobs += [k for k in knobs_of(trial, ()) if k.name == "mu_s"]
    level = Knob(-1, "mu_k", 1.0, 0.0, np.inf, "-")

    def force(some: JointModel) -> Array:
        return np.concatenate([friction_along(s, some.law, some.effects, some.load)[s.sliding] for s in sheets])

    here = force(trial)
    columns = [here - force(model)]
    for knob in knobs:
        step = 1.0e-3 * knob.scale
        moved = adjusted(trial, [level, knob], np.array([model.law.mu_k, value_of(trial, knob) + step]))
        columns.append((force(moved) - here) / step)
    return np.column_stack(columns)


def predicted_rms(model: JointModel, effect: Effect, sheets: Sequence[Sheet], current: JointFit) -> float:
    """Return the rms that ``effect`` would leave if the balance were linear in all numbers [N or N m].

    Cheap: one evaluation a parameter. It ranks starting points; the fit itself is not linear.
    """
    design = np.column_stack([current.jacobian, effect_columns(model, effect, sheets)])
    left = _left_by(design, np.concatenate(current.remainders))
    return float(np.sqrt(np.mean(left**2)))


def hidden_share(effect: Effect, sheets: Sequence[Sheet], current: JointFit) -> float:
    """Return what part of an effect's change of friction the numbers fitted already would imitate [-]."""
    columns = effect_columns(current.model, effect, sheets)
    change = columns[:, int(np.argmax(np.abs(columns).max(axis=0) > 0.0))]
    size = float(change @ change)
    left = _left_by(current.jacobian, change)
    return 1.0 - float(left @ left) / size if size > 0.0 else 1.0


def _left_by(design: Array, values: Array) -> Array:
    """Return what the columns of ``design`` leave of ``values``."""
    scaled = design / np.maximum(np.linalg.norm(design, axis=0), 1.0e-300)
    return values - scaled @ np.linalg.lstsq(scaled, values, rcond=1.0e-10)[0]
