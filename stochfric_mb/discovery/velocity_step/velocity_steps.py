"""Discovery on velocity-step tests: whether friction only knows its speed, or remembers its past.

The load point's history is an input, known also where friction is held out; fits see friction of the fit runs only.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.fit.fitting import DIFFERENCE, TOLERANCE
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome
from stochfric_mb.discovery.driven_joint.simulation.pictures import Picture, step_picture
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.free_parameter import INSIDE
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.inference.noise import independent_count, white_noise
from stochfric_mb.discovery.result import EffectEstimate, Gap, Interval, Result, Where
from stochfric_mb.discovery.velocity_step.laws import Law, Track, laws
from stochfric_mb.effects import effect_class, effect_kinds, kind_with_signature, kinds_with, make_effect
from stochfric_mb.effects.traits import ANONYMOUS, LATE, MEMORY, MORE_DAMPING, RATE, SLOPE_IN_DISTANCE
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.smoothing import smooth, window

Array = npt.NDArray[np.float64]

HALF_WIDTH = 12
"""Half width of the window through which the load point's speed is seen [samples]."""
HALF_WIDTHS = (0, 3, 4, 6, 8, HALF_WIDTH)
"""Half widths of the windows through which its position may be seen [samples]; 0: none. A wide one smears the steps."""
QUIET = 0.3
"""Noise of its way from sample to sample, over the lowest of these (10 % quantile), up to which no wider window is taken [-]:
the spring adds up the way, so that noise counts only where it turns the motion round."""
PARTS = 12
"""Parts of an axis along which what is left of friction is looked at."""


@dataclasses.dataclass(frozen=True)
class Fitted:
    """A law with its numbers."""

    law: Law
    """The law."""
    values: Array
    """Its numbers."""
    deviations: Array
    """Their standard deviations."""
    rest: list[Array]
    """Residual in the fit runs [-]."""

    @property
    def rms(self) -> float:
        """Root mean square of what is left [-]."""
        return float(np.sqrt(np.mean(np.concatenate(self.rest) ** 2)))

    @property
    def kind(self) -> str:
        """The effect that it is; friction that rises with the speed is viscous."""
        rises = self.law.kind == kind_with_signature(RATE) and self.values[2] > 0.0
        return kind_with_signature(MORE_DAMPING) if rises else self.law.kind


def spring_slider_outcome(dataset: Dataset, progress: Callable[[str], None]) -> JointOutcome:
    """Return the result of a dataset of velocity steps.

    Raises:
        InputError: no position of the load point, or no friction.
    """
    tracks = sorted((track_of(r, dataset) for r in dataset.runs), key=lambda t: float(t.run.time[0]))
    offset = float(tracks[0].slid[0])
    tracks = [dataclasses.replace(t, slid=t.slid - offset) for t in tracks]
    fits = _fits(tracks, dataset, progress)
    plain = fits[0]
    best, scores = _best(fits)
    accepted = scores[best.kind] > criteria.NAMED
    result = _result(dataset, tracks, plain, best if accepted else None, fits, scores)
    picture = _picture(tracks, {"recalibrated": plain} | ({"augmented": best} if accepted else {}))
    return JointOutcome(result, _augmented(dataset, best if accepted else plain), dataset, pictures=(picture,))


def _fits(tracks: Sequence[Track], dataset: Dataset, progress: Callable[[str], None]) -> list[Fitted]:
    """Return the fit of each law, constant friction first."""
    reference = float(np.median(tracks[0].speed))
    shortest = 2.0 * min(float(np.median(t.speed)) * t.run.sample_interval for t in tracks)
    fits: list[Fitted] = []
    for law in laws(reference, dataset.scenario.mechanism.stiffness, dataset.scenario.law.mu_k, shortest):
        progress(law.kind or "constant friction")
        alike = next((f for f in fits if f.law.variant == "" and f.law.names == law.names), None)
        fits.append(_fit(law, tracks, law.starts if alike is None else [alike.values]))
    return fits


def _best(fits: Sequence[Fitted]) -> tuple[Fitted, dict[str, float]]:
    """Return the law that is meant, and the best score of each kind."""
    plain = fits[0]
    n = max(sum(independent_count(r) for r in min(fits, key=lambda f: f.rms).rest), 4.0)
    each = [_score(plain, f, n) for f in fits[1:]]
    scores = {f.kind: max(s for s, g in zip(each, fits[1:], strict=True) if g.kind == f.kind) for f in fits[1:]}
    best = fits[1 + int(np.argmax(each))]
    # of laws that leave as much the simplest: what a few more numbers take off is real, perhaps, but no explanation
    return min(
        (f for f in fits[1:] if f.rms <= best.rms / (1.0 - criteria.MATERIAL)), key=lambda f: (len(f.values), f.rms)
    ), scores


def _picture(tracks: Sequence[Track], models: Mapping[str, Fitted]) -> Picture:
    """Return friction over time, measured and by each model, as `step_picture` gives it."""
    series = {"data": np.concatenate([t.friction for t in tracks])}
    series |= {name: np.concatenate(f.law.predict(tracks, f.values)) for name, f in models.items()}
    return step_picture(np.concatenate([t.run.time for t in tracks]), series)


def track_of(run: Run, dataset: Dataset) -> Track:
    """Return a run as friction against the motion of its load point.

    Raises:
        InputError: no position of the load point, or no friction.
    """
    if "position" not in run.channels:
        raise InputError(
            f"run {run.name!r} has no position of the load point; name its column with columns = {{ position = ... }}"
        )
    if "friction_coefficient" in run.covariates:
        friction = run.covariates["friction_coefficient"]
    elif "friction_force" in run.channels:
        load = run.channels.get("normal_force", np.full(len(run.time), dataset.scenario.mechanism.normal_force))
        friction = run.channels["friction_force"] / load
    else:
        raise InputError(f"run {run.name!r} has neither friction_coefficient nor friction_force; name its column with columns")
    x, h = run.channels["position"], run.sample_interval
    speed = _through(x, HALF_WIDTH, h, 1)
    least = 0.05 * float(np.median(speed))
    way = np.diff(_quiet(x, h)) / h
    return Track(run, friction, np.maximum(speed, least), np.maximum(np.r_[way, way[-1]], least), x)


def _quiet(x: Array, interval: float) -> Array:
    """Return a position through the narrowest window that leaves its way from sample to sample in one direction, shape (n,)."""
    noise, seen = white_noise(x), x
    for half in HALF_WIDTHS:
        seen = _through(x, half, interval, 0) if half else x
        gain = float(np.linalg.norm(window(half * interval, interval, derivative=1))) * interval if half else np.sqrt(2.0)
        if gain * noise <= QUIET * float(np.quantile(np.diff(seen), 0.1)):
            break
    return seen


def _through(x: Array, half: int, interval: float, derivative: int) -> Array:
    """Return a signal, turned about its ends, or its derivative through a window of ``half`` samples to either side, (n,)."""
    more = half + 3
    padded = np.r_[2.0 * x[0] - x[more - 1 : 0 : -1], x, 2.0 * x[-1] - x[-2 : -more - 1 : -1]]
    return smooth(padded, half * interval, interval, derivative=derivative)[more - 1 : more - 1 + len(x)]


def _fit(law: Law, tracks: Sequence[Track], starts: Sequence[Sequence[float] | Array]) -> Fitted:
    fits = [_from(law, tracks, np.array(s), 6) for s in starts]
    best = min(fits, key=lambda f: f.rms)
    return _from(law, tracks, best.values, 30)


def _from(law: Law, tracks: Sequence[Track], start: Array, evaluations: int) -> Fitted:
    scale = np.array(law.scales)
    fitted = [i for i, t in enumerate(tracks) if t.run.role == "fit"]

    def errors(step: Array) -> Array:
        predicted = law.predict(tracks, start + scale * step)
        return np.concatenate([tracks[i].friction - predicted[i] for i in fitted])

    low, high = (np.array(law.low) - start) / scale - INSIDE, np.full(len(start), np.inf)
    minimum = minimised(
        errors, np.zeros(len(start)), low, high, difference=DIFFERENCE, evaluations=evaluations, tolerance=TOLERANCE
    )
    jacobian, values = minimum.jacobian, start + scale * minimum.x
    predicted = law.predict(tracks, values)
    rest = [tracks[i].friction - predicted[i] for i in fitted]
    n, total = sum(map(len, rest)), sum(independent_count(r) for r in rest)
    variance = float(np.mean(errors(minimum.x) ** 2)) * n / max(total, 1.0)
    covariance = np.linalg.pinv(jacobian.T @ jacobian, hermitian=True) * variance
    return Fitted(law, values, np.sqrt(np.maximum(np.diag(covariance), 0.0)) * scale, rest)


def _score(plain: Fitted, richer: Fitted, n: float) -> float:
    p = len(richer.values) - len(plain.values)
    return float(n * np.log((plain.rms / richer.rms) ** 2) - p * np.log(n) - 2.0 * np.log(len(richer.law.starts)))


def _held_out(fitted: Fitted, tracks: Sequence[Track]) -> float:
    predicted = fitted.law.predict(tracks, fitted.values)
    rest = [t.friction - p for t, p in zip(tracks, predicted, strict=True) if t.run.role == "test"]
    return float(np.sqrt(np.mean(np.concatenate(rest) ** 2)))


def _result(
    dataset: Dataset,
    tracks: Sequence[Track],
    plain: Fitted,
    best: Fitted | None,
    fits: Sequence[Fitted],
    scores: dict[str, float],
) -> Result:
    gap = _gap(dataset, tracks, plain, best or plain)
    where = unexplained([t for t in tracks if t.run.role == "fit"], best or plain)
    effects = () if best is None or where is not None else (_estimate(plain, best, scores),)
    searched = {f.law.kind for f in fits} | {kind_with_signature(finding) for finding in (MORE_DAMPING, LATE)}
    return Result(
        verdict=_verdict(effects, where),
        effects=effects,
        where=where,
        ranking=tuple(sorted(scores.items(), key=lambda s: -s[1])),
        gap=gap,
        not_identifiable=tuple(k for k in effect_kinds() if k not in (*searched, *kinds_with(ANONYMOUS))),
        next_experiment="Steps down as well as up, and hold tests: they separate ageing with time from slip with distance.",
        parameters=_numbers(plain),
        notes=(
            *gap.notes,
            "the load point's speed is taken through a window; the machine's stiffness is fitted",
        ),
        details={"laws": {f"{f.law.kind or 'constant'} {f.law.variant}".strip(): _facts(f, tracks) for f in fits}},
    )


def _gap(dataset: Dataset, tracks: Sequence[Track], plain: Fitted, final: Fitted) -> Gap:
    """Return the errors on held-out runs."""
    test = [t.friction for t in tracks if t.run.role == "test"]
    floor = float(np.sqrt(np.sum([white_noise(x) ** 2 * len(x) for x in test]) / sum(map(len, test))))
    stated = float(np.sqrt(np.mean(np.concatenate([x - dataset.scenario.law.mu_k for x in test]) ** 2)))
    source = "high-frequency content of the friction coefficient (third differences)"
    before, after = _held_out(plain, tracks), _held_out(final, tracks)
    return Gap("friction_coefficient", "-", True, stated, before, after, floor, source)


def _facts(fitted: Fitted, tracks: Sequence[Track]) -> dict[str, Any]:
    """Return errors and numbers of a law."""
    numbers = dict(zip(fitted.law.names, fitted.values.tolist(), strict=True))
    return {"fit": fitted.rms, "held_out": _held_out(fitted, tracks), "numbers": numbers}


def _verdict(effects: Sequence[EffectEstimate], where: Where | None) -> Literal["effect", "none", "unknown"]:
    if where is not None:
        return "unknown"
    return "effect" if effects else "none"


def unexplained(tracks: Sequence[Track], closest: Fitted) -> Where | None:
    """Return where friction disagrees with the law that comes closest, if it leaves more than another form would; else None.

    Noise is what third differences show; what is left beyond it must not be the larger part of friction's own changes. Of what
    a law of sliding leaves only that counts which goes along an axis: rock has slow scatter of its own.

    Args:
        tracks: the fit runs.
        closest: the best law, constant friction among them.
    """
    noise = sum(white_noise(t.friction) ** 2 * len(t.friction) for t in tracks)
    left = sum(float(r @ r) for r in closest.rest) - noise
    middle = float(np.mean(np.concatenate([t.friction for t in tracks])))
    changes = sum(float(np.sum((t.friction - middle) ** 2)) for t in tracks) - noise
    if changes <= criteria.NONE_MISSES * noise:
        return None
    speed, slid, run = ([getattr(t, name) for t in tracks] for name in ("speed", "slid", "run"))
    places = {"speed": speed, "displacement": slid, "time": [r.time for r in run]}
    rest = np.concatenate(closest.rest)
    shares = {axis: _share_along(np.concatenate(place), rest) for axis, place in places.items()}
    axis = max(shares, key=lambda a: shares[a])
    explained = left * (shares[axis] if closest.law.kind else 1.0)
    if explained <= (1.0 - criteria.EXPLAINED) * changes:
        return None
    law = closest.law.kind or "constant friction"
    return Where(
        axis,
        f"{law} comes closest, but leaves {left / changes:.0%} of the changes of friction; "
        f"{shares[axis]:.0%} of what is left goes along the {axis}",
    )


def _share_along(place: Array, rest: Array) -> float:
    """Return the share of a residual's squares that a step function of a place explains, in `PARTS` equally full parts [-]."""
    part = np.minimum(PARTS * np.argsort(np.argsort(place, kind="stable")) // len(place), PARTS - 1)
    means = np.bincount(part, rest) / np.bincount(part)
    return float(np.sum(means[part] ** 2) / np.sum(rest**2))


def _estimate(plain: Fitted, best: Fitted, scores: dict[str, float]) -> EffectEstimate:
    """Return the law that is named, as an effect of the result."""
    kind = best.kind
    same = tuple(k for k, s in scores.items() if k != kind and s > scores[kind] - criteria.TIE)
    form = f"{kind} ({best.law.variant})" if best.law.variant else kind
    text = (
        f"A constant friction coefficient is off by {plain.rms:.3g} (rms), {form} by {best.rms:.3g}, on the runs that were "
        "fitted."
    )
    axes = {MEMORY: "distance since a change of speed", SLOPE_IN_DISTANCE: "displacement", RATE: "speed", MORE_DAMPING: "speed"}
    axis = next(axes[finding] for finding in effect_class(kind).signatures if finding in axes)
    return EffectEstimate(kind, same, Where(axis, text), _numbers(best), scores[kind], None)


def _numbers(fitted: Fitted) -> dict[str, Interval]:
    intervals: dict[str, Interval] = {}
    law = fitted.law
    for name, value, deviation, unit, low in zip(law.names, fitted.values, fitted.deviations, law.units, law.low, strict=True):
        number = confidence_interval(value, deviation, unit, low)
        if name.startswith("log_"):
            middle, least, most = (float(np.exp(min(x, 700.0))) for x in (number.value, number.low, number.high))
            intervals[name[4:]] = Interval(
                middle, least, most, {"log_distance": "m", "log_stiffness": "1/m", "log_state": "-"}[name]
            )
        else:
            intervals[name] = number
    return intervals


def _augmented(dataset: Dataset, fitted: Fitted) -> Any:
    """Return the scenario with the fitted law: static friction is the peak that a fast step gives, mu_0 + b."""
    scenario = dataset.scenario
    numbers = _numbers(fitted)
    mu = float(numbers["mu_0"].value)
    if fitted.law.kind != kind_with_signature(MEMORY):
        return dataclasses.replace(scenario, law=dataclasses.replace(scenario.law, mu_s=mu, mu_k=mu))
    rise = max(numbers["evolution_effect"].value, 0.0)
    law = dataclasses.replace(scenario.law, mu_s=mu + rise, mu_k=mu)
    mechanism = dataclasses.replace(scenario.mechanism, stiffness=numbers["stiffness"].value)
    effect = make_effect(kind_with_signature(MEMORY), distance=numbers["distance"].value)
    return dataclasses.replace(scenario, law=law, mechanism=mechanism, effects=(effect,))
