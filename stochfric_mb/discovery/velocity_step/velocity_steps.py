"""Discovery on velocity-step tests: whether friction only knows its speed, or remembers its past.

The load point's history is an input, known also where friction is held out; fits see friction of the fit runs only.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome
from stochfric_mb.discovery.driven_joint.simulation.pictures import Picture, step_picture
from stochfric_mb.discovery.driven_joint.simulation.scores import FLOOR
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.inference.noise import independent_count, white_noise
from stochfric_mb.discovery.result import EffectEstimate, Gap, Interval, Result, Where
from stochfric_mb.discovery.velocity_step.law_fit import Fitted, fit, held_out_error, score_over
from stochfric_mb.discovery.velocity_step.laws import Track, laws
from stochfric_mb.discovery.velocity_step.smooth_law import NOWHERE, SmoothLaw, smooth_law
from stochfric_mb.effects import Effect, effect_class, effect_kinds, kind_with_signature, kinds_with, make_effect
from stochfric_mb.effects.shapes.splines import COURSE, sized, splines
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
AT_END = 1.0e-6
"""Distance of a number from the end of what is looked for, over its size, at which it is held by it [-]."""
STEP = 1.5
"""Factor between two speeds from which on they are of a step [-]: windows leave less than a tenth of noise."""
PARTS = 12
"""Parts of an axis along which what is left of friction is looked at."""


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
    best, own, scores = _best(fits)
    before, after = held_out_error(plain, tracks), held_out_error(best, tracks)
    least = criteria.EXPLAINED_HELD_OUT * (before**2 - min(_noise(tracks, "test"), before) ** 2)
    closes = after < (1.0 - criteria.CLOSES_NOTHING) * before and before**2 - after**2 > least
    accepted = own > criteria.NAMED and closes
    closest = best if accepted else plain
    where = unexplained([t for t in tracks if t.run.role == "fit"], closest)
    term = smooth_law(closest, tracks) if where is not None else None
    kept = term if term is not None and term.carries_over else None
    unnamed = {} if where is None else {"unnamed_term": NOWHERE if term is None else term.sentence}
    result = _result(dataset, tracks, plain, closest, fits, scores, where, kept, unnamed)
    final = closest if kept is None else kept.fitted
    picture = _picture(tracks, {"recalibrated": plain} | ({} if final is plain else {"augmented": final}))
    return JointOutcome(result, _augmented(dataset, tracks, closest, kept), dataset, pictures=(picture,))


def _picture(tracks: Sequence[Track], models: Mapping[str, Fitted]) -> Picture:
    """Return friction over time, measured and by each model, as `step_picture` gives it."""
    series = {"data": np.concatenate([t.friction for t in tracks])}
    series |= {name: np.concatenate(f.law.predict(tracks, f.values)) for name, f in models.items()}
    return step_picture(np.concatenate([t.run.time for t in tracks]), series)


def _fits(tracks: Sequence[Track], dataset: Dataset, progress: Callable[[str], None]) -> list[Fitted]:
    """Return the fit of each law, constant friction first."""
    reference, shortest = float(np.median(tracks[0].speed)), _shortest(tracks)
    fits: list[Fitted] = []
    for law in laws(reference, dataset.scenario.mechanism.stiffness, dataset.scenario.law.mu_k, shortest, _way(tracks)):
        progress(law.kind or "constant friction")
        alike = next((f for f in fits if f.law.variant == "" and f.law.names == law.names), None)
        fits.append(fit(law, tracks, law.starts if alike is None else [alike.values]))
    return fits


def _shortest(tracks: Sequence[Track]) -> float:
    """Return the displacement of the load point in two samples [m]: friction that follows in less is not seen to follow."""
    return 2.0 * min(float(np.median(t.speed)) * t.run.sample_interval for t in tracks)


def _as_stated(dataset: Dataset, tracks: Sequence[Track]) -> list[str]:
    """Return what of the stated stiffness cannot be, by how far the load point moves: often a unit is wrong."""
    stiffness, mu = dataset.scenario.mechanism.stiffness, dataset.scenario.law.mu_k
    units = "check the unit of the position and the stiffness, which is k over the normal force, in 1/m"
    soon, late = stiffness * _shortest(tracks), stiffness * _way(tracks)
    if soon > mu:
        return [f"with the stated stiffness of {stiffness:.4g} 1/m friction would change by {soon:.3g} in two samples: {units}"]
    if late < mu:
        return [
            f"with the stated stiffness of {stiffness:.4g} 1/m friction would change by {late:.3g} over all the "
            f"{_way(tracks):.3g} m of the load point, where it is {mu:.3g}: a block would hardly begin to slide; {units}"
        ]
    return []


def _way(tracks: Sequence[Track]) -> float:
    """Return the displacement of the load point in the fit runs [m]: a course says nothing of what lies beyond."""
    return float(max(t.slid.max() for t in tracks if t.run.role == "fit"))


def _best(fits: Sequence[Fitted]) -> tuple[Fitted, float, dict[str, float]]:
    """Return the law that is meant, its score, and the best score of each kind."""
    plain = fits[0]
    n = max(sum(independent_count(r) for r in min(fits, key=lambda f: f.rms).rest), 4.0)
    each = [score_over(plain, f, n, len(f.law.starts)) for f in fits[1:]]
    scores = {f.kind: max(s for s, g in zip(each, fits[1:], strict=True) if g.kind == f.kind) for f in fits[1:]}
    best = fits[1 + int(np.argmax(each))]
    # of laws that leave as much the simplest: what a few more numbers take off is real, perhaps, but no explanation
    alike = [(f, s) for f, s in zip(fits[1:], each, strict=True) if f.rms <= best.rms / (1.0 - criteria.MATERIAL)]
    return *min(alike, key=lambda fit: (len(fit[0].values), fit[0].rms)), scores


def track_of(run: Run, dataset: Dataset) -> Track:
    """Return a run as friction against the motion of its load point.

    Raises:
        InputError: no position of the load point, or no friction, or one that is no coefficient.
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
    _require_coefficient(run, float(np.median(friction)), dataset.scenario.law.mu_k)
    x, h = run.channels["position"], run.sample_interval
    speed = _through(x, HALF_WIDTH, h, 1)
    least = 0.05 * float(np.median(speed))
    way = np.diff(_quiet(x, h)) / h
    return Track(run, friction, np.maximum(speed, least), np.maximum(np.r_[way, way[-1]], least), x)


def _require_coefficient(run: Run, typical: float, stated: float) -> None:
    """Return if the typical friction of a run is a coefficient of friction.

    Raises:
        InputError: it is not positive, or far larger than any.
    """
    if typical <= 0.0:
        name = "friction_coefficient" if "friction_coefficient" in run.covariates else "friction_force"
        raise InputError(
            f"run {run.name!r}: friction is {typical:.3g} times the normal force, along the load point's motion; turn its "
            f"column round with sign = {{ {name} = -1 }}"
        )
    if typical > criteria.MOST_FRICTION * max(1.0, stated):
        raise InputError(
            f"run {run.name!r}: friction is {typical:.3g} times the normal force, with mu_k stated as {stated:.3g}; give a "
            "force as friction_force, in its unit, or correct normal_force"
        )


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


def _result(
    dataset: Dataset,
    tracks: Sequence[Track],
    plain: Fitted,
    closest: Fitted,
    fits: Sequence[Fitted],
    scores: dict[str, float],
    where: Where | None,
    kept: SmoothLaw | None,
    unnamed: dict[str, str],
) -> Result:
    """Return what is said of the runs.

    Args:
        dataset: the runs.
        tracks: the same, as friction against motion.
        plain: constant friction.
        closest: the law that is named, or would be; constant friction where none is.
        fits: all laws.
        scores: of each kind.
        where: where friction disagrees with it.
        kept: what then stands beside it without a name, where it carries over.
        unnamed: what is said of such a term, for the details.
    """
    gap = _gap(dataset, tracks, plain, closest if kept is None else kept.fitted)
    effects = () if closest is plain or where is not None else (_estimate(plain, closest, scores),)
    searched = {f.law.kind for f in fits} | {kind_with_signature(finding) for finding in (MORE_DAMPING, LATE)}
    return Result(
        verdict="unknown" if where is not None else "effect" if effects else "none",
        effects=effects,
        where=where,
        ranking=tuple(sorted(scores.items(), key=lambda s: -s[1])),
        gap=gap,
        not_identifiable=tuple(k for k in effect_kinds() if k not in (*searched, *kinds_with(ANONYMOUS))),
        next_experiment=_advice(effects, tracks),
        parameters=_of_the_rig(closest if kept is None else kept.law_alone(closest.law)),
        notes=(
            *gap.notes,
            *unnamed.values(),
            *([] if not effects else _doubts(closest, gap)),
            *_as_stated(dataset, tracks),
            "the load point's speed is taken through a window; the machine's stiffness is fitted",
        ),
        unnamed=_unnamed(kept) if kept is not None else None,
        details={"laws": {f"{f.law.kind or 'constant'} {f.law.variant}".strip(): _facts(f, tracks) for f in fits}} | unnamed,
    )


def _doubts(named: Fitted, gap: Gap) -> list[str]:
    """Return what speaks against the law that is named: numbers at the end of what is looked for, and more left than noise."""
    ends = [
        f"{n.name.removeprefix('log_')} is as {'small' if value - n.low <= n.high - value else 'large'} as is looked for: the "
        "form is in doubt, and so are the other numbers"
        for n, value in zip(named.law.numbers, named.values, strict=True)
        if min(value - n.low, n.high - value) <= AT_END * max(abs(value), 1.0e-12)
    ]
    ratio = gap.augmented / gap.floor if gap.floor > 0.0 else 0.0
    if ratio > FLOOR:
        why = "more is missing, or friction scatters by itself"
        ends.append(f"{ratio:.1f} times the noise is left on the held-out runs: {why}")
    return ends


def _advice(effects: Sequence[EffectEstimate], tracks: Sequence[Track]) -> str:
    """Return the next experiment."""
    if any(e.kind == kind_with_signature(SLOPE_IN_DISTANCE) for e in effects):
        return "The same steps over the same way again, and from another place: they separate the distance slid from the place."
    slows = any((np.maximum.accumulate(t.speed) > STEP * t.speed).any() for t in tracks)
    steps = "Hold tests" if slows else "Steps down as well as up, and hold tests"
    return f"{steps}: they separate ageing with time from slip with distance."


def _gap(dataset: Dataset, tracks: Sequence[Track], plain: Fitted, final: Fitted) -> Gap:
    """Return the errors on held-out runs."""
    test = [t.friction for t in tracks if t.run.role == "test"]
    floor = _noise(tracks, "test")
    stated = float(np.sqrt(np.mean(np.concatenate([x - dataset.scenario.law.mu_k for x in test]) ** 2)))
    source = "high-frequency content of the friction coefficient (third differences)"
    before, after = held_out_error(plain, tracks), held_out_error(final, tracks)
    return Gap("friction_coefficient", "-", True, stated, before, after, floor, source)


def _noise(tracks: Sequence[Track], role: str) -> float:
    """Return the root mean square of the noise of runs with a role, as third differences show it [-]."""
    frictions = [t.friction for t in tracks if t.run.role == role]
    return float(np.sqrt(np.sum([white_noise(x) ** 2 * len(x) for x in frictions]) / sum(map(len, frictions))))


def _facts(fitted: Fitted, tracks: Sequence[Track]) -> dict[str, Any]:
    """Return errors and numbers of a law."""
    numbers = dict(zip(fitted.law.names, fitted.values.tolist(), strict=True))
    return {"fit": fitted.rms, "held_out": held_out_error(fitted, tracks), "numbers": numbers}


def unexplained(tracks: Sequence[Track], closest: Fitted) -> Where | None:
    """Return where friction disagrees with the law that comes closest, if it leaves more than another form would; else None.

    Noise is what third differences show; what is left beyond it must not be the larger part of friction's own changes. Of what
    a law of sliding leaves only that counts which goes along an axis: rock has slow scatter of its own. Of what a course of any
    shape leaves all counts.

    Args:
        tracks: the fit runs.
        closest: the best law, constant friction among them.
    """
    noise = _noise(tracks, "fit") ** 2 * sum(len(t.friction) for t in tracks)
    left = sum(float(r @ r) for r in closest.rest) - noise
    middle = float(np.mean(np.concatenate([t.friction for t in tracks])))
    changes = sum(float(np.sum((t.friction - middle) ** 2)) for t in tracks) - noise
    measured = (criteria.MEASURED_TO * middle) ** 2 * sum(len(t.friction) for t in tracks)
    if changes <= max(criteria.NONE_MISSES * noise, measured):
        return None
    speed, slid, run = ([getattr(t, name) for t in tracks] for name in ("speed", "slid", "run"))
    places = {"speed": speed, "displacement": slid, "time": [r.time for r in run]}
    rest = np.concatenate(closest.rest)
    shares = {axis: _share_along(np.concatenate(place), rest) for axis, place in places.items()}
    axis = max(shares, key=lambda a: shares[a])
    any_shape = not closest.law.kind or closest.law.pieces
    explained = left * (1.0 if any_shape else shares[axis])
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


def _of_the_rig(fitted: Fitted) -> dict[str, Interval]:
    """Return what stands in the augmented scenario's own law and mechanism: the coefficient, and a memory's stiffness."""
    return {name: number for name, number in _numbers(fitted).items() if name in ("mu_0", "stiffness")}


def _largest_change(fitted: Fitted) -> dict[str, Interval]:
    """Return the largest change of a course, which says more than its weights; nothing where there is none."""
    pieces = fitted.law.pieces
    if not pieces:
        return {}
    course = splines(np.linspace(0.0, 1.0, 20 * pieces + 1), pieces)
    changes = course @ fitted.values[1:]
    largest = course[int(np.argmax(np.abs(changes)))]
    deviation = float(np.sqrt(largest @ fitted.covariance[1:, 1:] @ largest))
    return {"largest_change": confidence_interval(float(largest @ fitted.values[1:]), deviation, "-")}


def _numbers(fitted: Fitted) -> dict[str, Interval]:
    intervals = _largest_change(fitted)
    for one, value, deviation in zip(fitted.law.numbers, fitted.values, fitted.deviations, strict=True):
        if one.name in COURSE or deviation == 0.0:  # nothing in these data depends on it
            continue
        number = confidence_interval(value, deviation, one.unit, one.low)
        if one.name.startswith("log_"):
            middle, least, most = (float(np.exp(min(x, 700.0))) for x in (number.value, number.low, number.high))
            unit = {"log_distance": "m", "log_stiffness": "1/m", "log_state": "-"}[one.name]
            intervals[one.name[4:]] = Interval(middle, least, most, unit)
        else:
            intervals[one.name] = number
    return intervals


def _augmented(dataset: Dataset, tracks: Sequence[Track], closest: Fitted, kept: SmoothLaw | None) -> Any:
    """Return the scenario with the fitted law, and the term beside it: static friction is the peak of a fast step, mu_0 + b."""
    scenario = dataset.scenario
    fitted = closest if kept is None else kept.law_alone(closest.law)
    terms: tuple[Effect, ...] = () if kept is None else (_term(kept),)
    numbers = dict(zip(fitted.law.names, fitted.values.tolist(), strict=True))
    mu = numbers["mu_0"]
    if fitted.law.kind == kind_with_signature(SLOPE_IN_DISTANCE):
        terms = (*_drift(numbers, fitted.law.pieces, _way(tracks)), *terms)
    if fitted.law.kind != kind_with_signature(MEMORY):
        return dataclasses.replace(scenario, law=dataclasses.replace(scenario.law, mu_s=mu, mu_k=mu), effects=terms)
    rise = max(numbers["evolution_effect"], 0.0)
    law = dataclasses.replace(scenario.law, mu_s=mu + rise, mu_k=mu)
    mechanism = dataclasses.replace(scenario.mechanism, stiffness=float(np.exp(numbers["log_stiffness"])))
    effect = make_effect(kind_with_signature(MEMORY), distance=float(np.exp(numbers["log_distance"])))
    return dataclasses.replace(scenario, law=law, mechanism=mechanism, effects=(effect, *terms))


def _drift(numbers: Mapping[str, float], pieces: int, way: float) -> tuple[Effect, ...]:
    """Return a drift with the displacement as effects, from the numbers of its law.

    It is straight, with what settles beside it, or a course of so many pieces over the whole way [m].
    """
    kind, mu = kind_with_signature(SLOPE_IN_DISTANCE), numbers["mu_0"]
    if pieces:
        return (make_effect(kind, **sized(np.array([numbers[name] for name in COURSE[: pieces + 2]]) / mu, pieces, way)),)
    straight = make_effect(kind, rate=numbers["slope"] / mu)
    if "change" not in numbers:
        return (straight,)
    distance = float(np.exp(numbers["log_distance"]))
    return straight, make_effect(kind, rate=numbers["change"] / (mu * distance), settling_distance=distance)


def _term(kept: SmoothLaw) -> Effect:
    """Return the term without a name as an effect."""
    changes = {name: float(x) for name, x in zip(kept.names, kept.fitted.values[-len(kept.names) :], strict=True)}
    kind = kinds_with(ANONYMOUS)[0]
    return make_effect(kind, axis=kept.axis, low=kept.low, high=kept.high, static_share=1.0, **changes)


def _unnamed(kept: SmoothLaw) -> EffectEstimate:
    """Return the term without a name for the result."""
    effect = _term(kept)
    numbers = {n: Interval(x, x, x, effect.unit_of(n)) for n, x in (("low", kept.low), ("high", kept.high))}
    table = zip(kept.names, kept.fitted.values[-len(kept.names) :], kept.fitted.deviations[-len(kept.names) :], strict=True)
    numbers |= {name: confidence_interval(value, deviation, "-") for name, value, deviation in table}
    return EffectEstimate(effect.kind, (), Where(*effect.appears()), numbers, kept.score, None)
