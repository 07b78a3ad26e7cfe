"""What the stick phases and the sensor show by themselves: the first effects to be named, before any force is looked at."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np
from scipy.stats import binom

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.false_alarms import Evidence, detected, likely
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.decision import Finding
from stochfric_mb.discovery.stick_slip.records.record import Array, Record
from stochfric_mb.discovery.stick_slip.records.sensor_range import ReadingCurve
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.records.stick_phases import Sticking
from stochfric_mb.discovery.stick_slip.records.stick_waves import in_slips_too, wave_in_stick
from stochfric_mb.discovery.stick_slip.screening.competitors import step_times, steps
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import refit
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import Effect, effect_class, kind_with_signature, make_effect
from stochfric_mb.effects.shapes.course import LeveledCourse
from stochfric_mb.effects.shapes.splines import PIECES, returning
from stochfric_mb.effects.traits import BELT_RIPPLE, CLIPPED, CREEPING_ZERO, JUMP, LATE, STRAY, YIELDING
from stochfric_mb.laws.elastic_stick import ElasticStick
from stochfric_mb.measurement.delay import Delay, Term, estimate_delay

VELOCITY_WINDOW = 0.4
"""Half width of the window through which position and velocity are compared, as an angle of the natural oscillation [rad]: an
eighth of a slip, which is half a turn."""
LIMITS = (1.52e-3, 4.56e-3, 1.52e-2, 4.56e-2)
"""Elastic limits at which fits of a yielding contact begin, over the deflection of the spring under the normal force [-]."""

TURN = 720
"""Places of a turn at which its shape is taken, and by which runs are put in step."""

CREEP = {
    "creep_before": ("stick, before the break-away", "the box departs from the belt's motion before it breaks away"),
    "creep_after": ("stick, after the re-stick", "the box does not follow the belt at once when it sticks again"),
    "yielding": ("stick", "the box lags behind the belt more and more while it sticks"),
}
"""Ways in which a stuck box may creep -> axis and sentence."""
ELSE = ("stick", "in stick the box does not follow the belt, in a way that no known effect explains")
"""The same where none of them explains enough."""
OTHERWISE_ELASTIC = Where(
    "stick",
    "in stick the contact gives way otherwise than the stated law, which is elastic itself: state another limit, or coulomb",
)
"""What is said of a contact whose law has a compliance of its own."""
STEP_SEEN, DRIFT_SEEN = "step_in_stick", "drift_in_stick"
"""Names under which the details hold the score of a step that stands in a stick phase and stays, and of a zero that drifts."""

STICK_SHARE = "share_in_stick"
"""Name under which they hold the share of what the stick phases show that the effect named there explains [-]."""


def with_kinematic(study: Study, model: Model, finding: Finding) -> Model:
    """Return the model with an effect that the stick phases showed; a ripple's phases and amplitude are fitted at once."""
    first = make_effect(finding.kind, **finding.values)
    if finding.kind == kind_with_signature(BELT_RIPPLE):
        return _best_in_forecasts(study, [_rippling(study, model, first)], most=12, evaluations=20)
    if finding.kind == kind_with_signature(YIELDING):
        grid = itertools.product(study.records[0].deflection * np.array(LIMITS), (0.05, 0.3))
        ways = [dataclasses.replace(first, elastic_limit=float(limit), damping_ratio=ratio) for limit, ratio in grid]  # pyright: ignore[reportCallIssue]
        rough = _best_in_forecasts(study, [model.plus(way) for way in ways], most=5, evaluations=4)
        return _best_in_forecasts(study, [rough], most=12, evaluations=20)
    if finding.kind == kind_with_signature(CLIPPED):
        # what is shown at the break-away is not where the box is: the stated friction may be nearer than the forces
        ways = [m.plus(first) for m in (model, dataclasses.replace(study.model, corrections=model.corrections))]
        return _best_in_forecasts(study, ways, most=12, evaluations=20)
    return model.plus(first)


def _best_in_forecasts(study: Study, trials: Sequence[Model], *, most: int, evaluations: int) -> Model:
    """Return the model that forecasts best, fitted to ``most`` forecasts of each run in so many ``evaluations``."""
    fits = [refit(trial, study.windows, study.uncertainty, most=most, evaluations=evaluations) for trial in trials]
    return min(fits, key=lambda f: f.cost).model


def _rippling(study: Study, model: Model, first: Effect) -> Model:
    """Return the model with a ripple of the belt's speed as large as stick shows; of any shape where it has several tones."""
    assert study.sticking is not None
    count = int(study.sticking.settings[BELT_RIPPLE]["tones"])
    frequency = float(first.frequency)  # pyright: ignore[reportAttributeAccessIssue]
    shape, phases = in_step(np.array([_ripple(s, frequency, count) for s in study.pool.slips]))
    if count == 1:
        ripple = dataclasses.replace(first, amplitude=float(np.abs(shape[0])))  # pyright: ignore[reportCallIssue]
        phases = phases + np.angle(shape[0])
    else:
        turns = np.arange(TURN) / TURN
        speed = (np.exp(2j * np.pi * np.outer(turns, np.arange(1, count + 1))) @ shape).real
        weights = np.linalg.lstsq(returning(turns, PIECES), speed, rcond=None)[0]
        ripple = make_effect(first.kind, **type(first).returning(weights, PIECES, frequency))  # pyright: ignore[reportAttributeAccessIssue]
    others = ({},) * len(model.effects)
    runs = (s.record.name for s in study.pool.slips)
    own = {run: (*others, {"phase": float(phase)}) for run, phase in zip(runs, phases, strict=True)}
    return dataclasses.replace(model.plus(ripple), own=own)


def in_step(tones: Array) -> tuple[Array, Array]:
    """Return the tones that runs share, complex, shape (count,), and where in its turn each run begins [rad], shape (runs,).

    Args:
        tones: tones of each run's wave, complex, shape (runs, count): the wave is the real part of the sum of
            tone_k exp(i k turn), k = 1, 2, ...
    """
    begins = 2.0 * np.pi * np.arange(TURN) / TURN
    away = np.exp(-1j * np.outer(begins, np.arange(1, tones.shape[1] + 1)))
    best = np.argmax((away @ (tones * tones[0].conj()).T).real, axis=0)
    return np.mean(tones * away[best], axis=0), begins[best]


def _ripple(slips: Slips, frequency: float, count: int) -> Array:
    """Return the tones of a ripple by what their integrals leave in the stick phases [-], complex, shape (count,)."""
    a, b = wave_in_stick(slips, frequency, count).T
    # the position is the integral, v_b A/w sin(w t + phase) = v_b A/w (cos w t sin phase + sin w t cos phase)
    pace = 2.0 * np.pi * frequency * np.arange(1, count + 1)
    return np.asarray((b + 1j * a) * pace / slips.record.mechanism.belt_velocity)


def kinematics(study: Study, details: dict[str, object]) -> list[Finding] | Where:
    """Return the effects that the stick phases and the sensor show, or where they disagree with no known effect."""
    details["ceiling"] = study.range.share
    if study.range.clipped:
        ends = {"high": study.range.high, "low": study.range.low}
        return [Finding(kind_with_signature(CLIPPED), detected("clipped", study.range.share), ends)]
    if (curve := study.curve) is not None and curve.bends:
        return [Finding(kind_with_signature(CLIPPED), likely("stick", curve.score), bent(curve))]
    stray, in_stick = _outliers(study, details), _in_stick(study, details)
    if isinstance(stray, Where) or isinstance(in_stick, Where):
        return stray if isinstance(stray, Where) else in_stick
    if isinstance(study.model.law, ElasticStick) and any(f.kind == kind_with_signature(YIELDING) for f in in_stick):
        return OTHERWISE_ELASTIC
    return _delays(study, details) + stray + in_stick


def bent(curve: ReadingCurve) -> dict[str, float | str]:
    """Return the parameters of a reading that bends over: a course along the stroke, and the ends that it comes to."""
    begin, span = float(curve.position[0]), float(np.ptp(curve.position))
    place = np.linspace(0.0, 1.0, TURN)
    shown = np.interp(begin + span * place, curve.position, curve.reading)
    flat = make_effect(kind_with_signature(CLIPPED), begin=begin, span=span, course=1.0, course_1=1.0)
    assert isinstance(flat, LeveledCourse)
    weights = np.linalg.lstsq(flat.columns(place), shown - (begin + span * place), rcond=None)[0]
    effect = dataclasses.replace(flat, **dict(zip(flat.shaped_by, map(float, weights), strict=True))).normalised()
    lower, upper = curve.slopes
    ends = {"low": float(shown[0])} if lower < criteria.HIDES else {}
    ends |= {"high": float(shown[-1])} if upper < criteria.HIDES else {}
    return {name: value for name, value in effect.given().items() if name != "kind"} | ends


def _outliers(study: Study, details: dict[str, object]) -> list[Finding] | Where:
    """Return outliers; what stands out of a smoothed sensor's samples alone is none, what keeps to the slips no accident."""
    share = outlier_share(study)
    details["outlier_share"] = share
    if share < criteria.LEAST_OUTLIERS or sum(len(_accidents(r)) for r in study.records) < criteria.FEWEST_OUTLIERS:
        return []
    if _in_slips(study) < criteria.OUTLIERS_BY_CHANCE:
        return Where("slip, sensor", "the reading jumps in the slips and at their edges, and hardly anywhere else")
    sizes = np.concatenate([np.abs(r.raw - r.position)[r.outlier] for r in study.records])
    return [
        Finding(
            kind_with_signature(STRAY),
            detected("outliers", share),
            {"fraction": share, "size": float(np.sqrt(np.mean(sizes**2)))},
        )
    ]


def _accidents(record: Record) -> Array:
    """Return the times of outliers [s]; those side by side are one accident."""
    stray = record.time[record.outlier]
    return stray[np.diff(stray, prepend=-np.inf) > 1.5 / record.rate]


def _in_slips(study: Study) -> float:
    """Return the chance of as many outliers within slips if they fell anywhere [-]."""
    inside, far, covered, length = 0, 0, 0.0, 0.0
    for slips in study.pool.slips:
        record = slips.record
        stray = _accidents(record)
        slip = np.searchsorted(slips.onset_time, stray, "right") - 1
        far += len(stray)
        inside += int(np.count_nonzero((slip >= 0) & (stray <= slips.restick_time[np.maximum(slip, 0)])))
        covered += float(np.sum(slips.restick_time - slips.onset_time))
        length += record.duration
    # corners of the motion stand out a little more easily than the rest of it
    return float(binom.sf(inside - 1, far, covered / length)) if inside > far / 2 else 1.0


def outlier_share(study: Study) -> float:
    """Return the share of samples that stand out of the noise [-]."""
    noise = max(s.noise.deviation for s in study.pool.slips)
    sizes = np.concatenate([np.abs(r.raw - r.position)[r.outlier] for r in study.records])
    return float(np.count_nonzero(sizes > criteria.OUTLIER_DEVIATIONS * noise)) / sum(len(r.time) for r in study.records)


def _in_stick(study: Study, details: dict[str, object]) -> list[Finding] | Where:
    """Return what the stick phases show; steps and drifts of the sensor are left to the forces, where their size shows."""
    sticking = study.sticking
    if sticking is None:
        return []
    details["sticking"] = dict(sticking.scores) | {"excess": sticking.excess, "excess_ratio": sticking.excess_ratio}
    best, score = _winner(study, sticking)
    if (line := _line(study, details)) is not None and _gain_of_line(study) > criteria.LINE_OUTSHINES * score:
        return line
    if score <= criteria.NAMED:
        _single_moments(study, sticking, details)
        return line if line is not None else []
    if best in (JUMP, CREEPING_ZERO):
        details[STEP_SEEN if best == JUMP else DRIFT_SEEN] = score
    if _of_the_sensor(study, sticking, best, score):
        return []
    if best in CREEP or score < _least(sticking) or _in_noise_alone(best, sticking) or _keeps_to_phases(best, sticking):
        return Where(*CREEP.get(best, ELSE))
    # a ripple that counts as slow noise leaves nothing in excess of that
    shown = sticking.settings[best].get("share", 0.0)
    details[STICK_SHARE] = score / sticking.excess if sticking.excess > 0.0 else shown
    return _in_stick_named(study, best, score, sticking.settings[best])


def _least(sticking: Sticking) -> float:
    """Return the score that a name needs to explain what the stick phases show [-]."""
    return criteria.STICK_EXPLAINED * sticking.excess - criteria.STICK_SLACK


def _of_the_sensor(study: Study, sticking: Sticking, best: str, score: float) -> bool:
    """Return whether what is seen in stick is a sensor's: rounding, a zero that steps, drifts or wanders by less than noise."""
    if best in (CREEPING_ZERO, JUMP) or _rounded(study, sticking):
        return True
    if best == BELT_RIPPLE:
        frequency, share = (sticking.settings[best][name] for name in ("frequency", "share"))
        if share < criteria.WAVE_EXPLAINED and sticking.departure < criteria.STICK_DEPARTS:
            return True  # slow noise has a wave that follows it best
        if _of_the_zero(study, frequency) or sum(in_slips_too(s, frequency) for s in study.pool.slips) > criteria.NAMED:
            return True
    slow = score < _least(sticking) and sticking.departure < criteria.STICK_DEPARTS
    return slow and best not in CREEP and not _in_noise_alone(best, sticking)


def _rounded(study: Study, sticking: Sticking) -> bool:
    """Return whether noise is mostly rounding, and what is seen in stick no more: slips that are alike are rounded alike."""
    noise = [s.noise.deviation for s in study.pool.slips]
    rounding = [float(np.min(np.diff(np.unique(r.raw)), initial=np.inf)) / np.sqrt(12.0) for r in study.records]
    coarse = all(criteria.ROUNDING * n < r < np.inf for n, r in zip(noise, rounding, strict=True))
    return coarse and sticking.departure * max(noise) < min(rounding)


def _in_noise_alone(best: str, sticking: Sticking) -> bool:
    """Return whether a ripple is part of what counts as noise, and leaves much of that."""
    if best != BELT_RIPPLE:
        return False
    settings = sticking.settings[best]
    return settings["plain"] <= criteria.NAMED and settings["share"] < criteria.STICK_EXPLAINED


def _keeps_to_phases(best: str, sticking: Sticking) -> bool:
    """Return whether a ripple has the rate of the slips, and what all stick phases share explains more than its form misses.

    A belt to which slips keep moves in a wave; a sensor that lags, or a contact that gives way, does the same in every phase.
    """
    if best != BELT_RIPPLE:
        return False
    settings = sticking.settings[best]
    return settings["alike"] - settings["share"] > criteria.FORM_MISSES


def _of_the_zero(study: Study, frequency: float) -> bool:
    """Return whether a ripple is so slow that a sensor's zero may move so, and the forces say that it does.

    While the box sticks the two look alike; at the break-away a zero that has moved takes the spring's force along.
    """
    if frequency * study.pool.duration >= PIECES / 2.0:
        return False
    ways = [h.columns for h in effect_class(kind_with_signature(CREEPING_ZERO)).hypotheses(study.pool)]
    gains = study.baseline.gains(ways)
    return max(2.0 * gain - len(way) * study.baseline.price for gain, way in zip(gains, ways, strict=True)) > criteria.NAMED


def _single_moments(study: Study, sticking: Sticking, details: dict[str, object]) -> None:
    """Note that the box jumps at single moments, where nothing else is seen in stick and no known force shakes it."""
    forced = any(r.mechanism.excitation_amplitude for r in study.records)
    if sticking.scores[JUMP] > max(criteria.NAMED, criteria.SINGLE_MOMENTS * sticking.excess) and not forced:
        details["single_moments"] = sticking.scores[JUMP]


def _in_stick_named(study: Study, best: str, score: float, settings: dict[str, float]) -> list[Finding]:
    """Return the effect that stands for what is seen in stick, at numbers to start from."""
    if best == BELT_RIPPLE:
        return [
            Finding(kind_with_signature(best), likely("stick", score), {"amplitude": 0.0, "frequency": settings["frequency"]})
        ]
    box = study.records[0].mechanism
    stiffness = max(settings["angular_frequency"] ** 2 * box.mass - box.stiffness, 0.1 * box.stiffness)
    limit = float(study.baseline.solution.coefficients[0]) * box.normal_force / stiffness
    values: dict[str, float | str] = {"elastic_limit": limit, "damping_ratio": settings["damping_ratio"]}
    return [Finding(kind_with_signature(best), likely("stick", score), values)]


def _winner(study: Study, sticking: Sticking) -> tuple[str, float]:
    """Return what explains the stick phases best, and its score."""
    scores = dict(sticking.scores)
    if not _step_stays(study, sticking.settings[JUMP]):
        scores[JUMP] = -np.inf
    if _driven(study, sticking.settings[BELT_RIPPLE]["frequency"]):
        # a stuck box that moves with the known force: the contact yields
        scores[YIELDING] = max(scores[YIELDING], scores.pop(BELT_RIPPLE))
    best = max(scores, key=lambda k: scores[k])
    if best in CREEP:
        rings = scores[YIELDING]
        if max(scores["yielding"], rings) > criteria.YIELDS_FOR_CREEP * scores[best]:
            return YIELDING, max(scores[best], sticking.settings[best]["ringing"])
    return best, scores[best]


def _driven(study: Study, frequency: float) -> bool:
    """Return whether a frequency [Hz] is that of the known excitation."""
    return any(
        r.mechanism.excitation_amplitude
        and abs(frequency - r.mechanism.excitation_angular_frequency / (2.0 * np.pi)) < 2.0 / r.duration
        for r in study.records
    )


def _delays(study: Study, details: dict[str, object]) -> list[Finding]:
    """Return the delay of the position after a velocity channel, where runs have one and the delay is beyond doubt."""
    delays: list[Delay] = []
    for run in study.dataset.fit:
        if "velocity" in run.channels:
            position = Term(run.channels["position"], 1)
            width = VELOCITY_WINDOW / study.records[0].angular_frequency
            delays.append(estimate_delay(run.channels["velocity"], [position], run.sample_interval, half_width=width))
    if not delays:
        return []
    seconds = float(np.mean([d.seconds for d in delays]))
    doubt = float(np.mean([d.high - d.low for d in delays])) / 3.92 / np.sqrt(len(delays))
    details["delay"] = {"seconds": seconds, "deviation": doubt}
    # a velocity that is late, a filtered one, is none of the position's faults
    if seconds < max(5.0 * doubt, 0.5 * study.dataset.fit[0].sample_interval):
        return []
    # twice the log likelihood ratio of one normal number against 0
    ratio = (seconds / doubt) ** 2 if doubt > 0.0 else float("inf")
    return [Finding(kind_with_signature(LATE), Evidence(ratio, None), {"delay": seconds})]


def delay_deviation(details: Mapping[str, object]) -> float:
    """Return the standard deviation of the delay estimated against a velocity channel [s]."""
    return float(cast("dict[str, float]", details["delay"])["deviation"])


def _step_stays(study: Study, setting: dict[str, float]) -> bool:
    """Return whether a jump seen in stick is still there in the forces of the slips that follow."""
    pool = study.pool
    place = step_times(pool)
    for run in range(pool.n_runs):
        when = setting.get(f"time_{run}")
        if when is None:
            continue
        trials = steps(pool, run, multiplied=False)
        near = [trials[i] for i in np.flatnonzero(np.abs(place - when) < 1.5 * (place[1] - place[0]))]
        if near and max(study.baseline.gains([[t] for t in near])) > criteria.NAMED / 2.0:
            return True
    return False


def _line(study: Study, details: dict[str, object]) -> Where | None:
    """Return where the noise has a line; None if it has none."""
    frequency, amplitude, strength = max((s.line for s in study.pool.slips), key=lambda line: line[2])
    details["noise_line"] = {"frequency": frequency, "amplitude": amplitude, "strength": strength}
    variance = max(s.noise.deviation for s in study.pool.slips) ** 2
    if strength < criteria.LINE_STRENGTH or amplitude**2 / 2.0 < criteria.LOUD_LINE * max(variance - amplitude**2 / 2.0, 0.0):
        return None
    return Where(
        "frequency, sensor", f"the position holds a vibration of {frequency:.3g} Hz and {amplitude:.2g} m, in stick too"
    )


def _gain_of_line(study: Study) -> float:
    """Return by how much the strongest line lowers chi^2 of the stick phases' samples [-]."""
    slips = max(study.pool.slips, key=lambda s: s.line[2])
    count = sum(len(s.stick.time) * s.stick.bin_size for s in study.pool.slips)
    return count * slips.line[1] ** 2 / 2.0 / slips.noise.deviation**2
