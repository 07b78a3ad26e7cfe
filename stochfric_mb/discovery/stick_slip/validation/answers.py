"""Names on trial: fitted, judged by what they explain of the runs they come from, and by the forecasts of held-out runs."""

from __future__ import annotations

import dataclasses
import functools
from typing import cast

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.decision import Decision, Named
from stochfric_mb.discovery.stick_slip.decision.kinematics import STICK_SHARE
from stochfric_mb.discovery.stick_slip.decision.random_effects import kicked
from stochfric_mb.discovery.stick_slip.decision.rounds import of_wander
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED
from stochfric_mb.discovery.stick_slip.screening.folding import comes_back
from stochfric_mb.discovery.stick_slip.simulation.deviations import with_deviations
from stochfric_mb.discovery.stick_slip.simulation.forecast import score
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import (
    HeldOut,
    as_split_for,
    floor_of,
    mean_score,
    settled,
)
from stochfric_mb.discovery.stick_slip.simulation.model import STRENGTHS, Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit, likelihood_ratios, refit
from stochfric_mb.discovery.stick_slip.simulation.scatter import matched
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.discovery.stick_slip.validation.explained import (
    explained_with_its_form,
    shown_elsewhere,
    taken_back,
    unexplained,
    within_noise,
)
from stochfric_mb.discovery.stick_slip.validation.feature_skill import Gaps, slip_force_gap
from stochfric_mb.discovery.stick_slip.validation.held_out_check import Comparison, compared
from stochfric_mb.discovery.stick_slip.validation.predictive_check import VARYING, inadequate
from stochfric_mb.discovery.stick_slip.validation.strength import decided_by_ratio, undecided
from stochfric_mb.effects import kind_with_signature, kinds_with
from stochfric_mb.effects.traits import SCATTER, WANDER, YIELDING


@dataclasses.dataclass(frozen=True)
class Answer:
    """A decision with its model."""

    decision: Decision
    """What is named."""
    fit: Fit | None
    """The fit of the model with the effects; None where there are none."""
    model: Model
    """That model; the recalibrated one where there are none."""
    gaps: Gaps | None = None
    """What it was judged by on held-out runs, if it was."""


def fitted(decision: Decision, slip_study: Study, recalibrated: Fit) -> Answer:
    """Return a decision with the model that has its effects, fitted to the fit runs."""
    fit = _fit(decision, slip_study, recalibrated) if decision.verdict == "effect" else None
    return Answer(decision, fit, fit.model if fit is not None else recalibrated.model)


def _fit(decision: Decision, slip_study: Study, recalibrated: Fit) -> Fit:
    model = decision.model
    calm = model.mean
    windows, uncertainty = slip_study.windows, slip_study.uncertainty
    further = None if decision.seen is None else decision.seen.of(calm)
    if not calm.effects:
        # forecasts follow the draws of the slips that they begin before; the slips, all of them, tell the mean of coefficients,
        # but kicks are in their mean
        fit = refit(calm, windows, uncertainty, evaluations=0) if model.drawn else recalibrated
        return _joined(model, with_deviations(fit, windows, uncertainty), slip_study)
    starts = (calm, dataclasses.replace(calm, law=recalibrated.model.law, corrections=recalibrated.model.corrections))
    fits = [refit(m, windows, uncertainty, evaluations=25, further=further, weigh=calm) for m in starts]
    fit = min(fits, key=lambda f: f.objective)
    if model.random:
        # of a scatter beside effects, too, where it forecasts better
        unmoved = refit(calm, windows, uncertainty, evaluations=0)
        fit = min(fit, unmoved, key=lambda f: sum(float(score(_joined(model, f, slip_study).model, w).sum()) for w in windows))
    return _joined(model, with_deviations(fit, windows, uncertainty, further=further), slip_study)


def _joined(model: Model, fit: Fit, slip_study: Study) -> Fit:
    """Return a fit of a model's mean with what is random in the model, its strength matched to the slips."""
    return dataclasses.replace(fit, model=matched(model.with_mean(fit.model), slip_study.pool))


def explaining(answer: Answer, slip_study: Study, recalibrated: Fit) -> Answer:
    """Return the answer as far as it explains the fit runs.

    What the first effect's form leaves may look like another effect, which in a fit of both takes the first one along.
    """
    decision = answer.decision
    poor = _poor(answer, slip_study, recalibrated)
    if poor is None:
        return answer
    for other in _instead(decision, slip_study):
        tried = fitted(other, slip_study, recalibrated)
        if _poor(tried, slip_study, recalibrated) is None:
            return tried
    return Answer(poor, None, recalibrated.model)


def with_bump(answer: Answer, selected: Decision, slip_study: Study) -> Answer:
    """Return an answer whose effects were all taken back, with where slips come back with the belt, if they do.

    Args:
        answer: the answer.
        selected: the decision before it was validated.
        slip_study: what the fit runs show.
    """
    if answer.decision.verdict != "unknown" or not selected.named:
        return answer
    bump = comes_back(slip_study, kicked(slip_study), answer.decision.details)
    return answer if bump is None else dataclasses.replace(answer, decision=dataclasses.replace(answer.decision, where=bump))


def _poor(answer: Answer, slip_study: Study, recalibrated: Fit) -> Decision | None:
    """Return another decision if forecasts or forces of the fit runs say that this one explains too little; None if enough."""
    decision = answer.decision
    poor = unexplained(slip_study, decision, recalibrated.model, answer.model)
    if poor is not None or decision.verdict != "effect":
        return poor
    seen = cast("dict[str, float]", decision.details.get("explained", {}))
    # what explains most of the motion may say what a coefficient truly is; what its own channel alone excuses may not
    most = seen.get("share", 1.0) >= criteria.EXPLAINED
    far = _far_off(answer.model, recalibrated.model, slip_study, most=most)
    if far is not None:
        return taken_back(decision, f"comes closest, but with it {far} stated standard deviations off from what is stated")
    # of a record with stray or clipped readings the forces are not those of its slips
    if explained_with_its_form(decision) or {n.kind for n in decision.named} <= shown_elsewhere(decision.model):
        return None
    where, decision.details["adequacy"] = inadequate(slip_study, answer.model)
    if where is None:
        return None
    reducible = 1.0 - seen["floor"] / seen["before"] if "floor" in seen else 1.0
    if where in VARYING and reducible < criteria.LEAST_REDUCIBLE:  # slips that truly vary are felt: this is noise of readings
        return dataclasses.replace(decision, verdict="none", named=())
    text = f"{decision.named[0].kind} comes closest, but {where.text}"
    return dataclasses.replace(decision, verdict="unknown", named=(), where=Where(where.axis, text))


def _far_off(model: Model, recalibrated: Model, slip_study: Study, *, most: bool) -> str | None:
    """Return which number of law or mechanism effects push far off from what is stated, and by how much; None: none.

    What an effect leaves open is believed as far as the effect says: an oscillator may have been weighed with the body,
    and what holds it not; the stiffness at rest of a curved spring is not believed at all.

    Args:
        model: the model with the effects.
        recalibrated: that without.
        slip_study: what was measured.
        most: whether the effects explain most of the motion, so that only what they leave open is looked at.
    """
    stated, doubt = slip_study.dataset.scenario.law, slip_study.uncertainty

    def share(one: Model, name: str) -> float:
        if name in CORRECTED:
            return one.corrections.get(name, 0.0)
        believed = float(getattr(stated, name))
        return getattr(one.law, name) / believed - 1.0 if believed else 0.0

    left_open = {name: bounds for e in model.effects for name, bounds in e.left_open().items()}
    for name in left_open if most else (*CORRECTED, "mu_s", "mu_k"):
        deviation, (low, high) = doubt.get(name, 0.0), left_open.get(name, (0.0, 0.0))
        now, before = (max(low - s, s - high, 0.0) for s in (share(model, name), share(recalibrated, name)))
        if deviation and now > max(criteria.MOST_OFF * deviation, before):
            return f"{name} would be {now / deviation:.2g}"
    return None


def _instead(decision: Decision, slip_study: Study) -> list[Decision]:
    """Return what may be named instead: fewer of the effects, or a wander of friction."""
    others: list[Decision] = []
    fewer = decision
    while len(fewer.named) > 1 and (before := fewer.named[-1].before) is not None:
        fewer = dataclasses.replace(fewer, named=fewer.named[:-1], model=before)
        others.append(fewer)
    wander = of_wander(slip_study, decision)
    return others if wander is None else [*others, wander]


def checked_on_held_out(answer: Answer, slip_study: Study, recalibrated: Fit, runs: HeldOut) -> tuple[Answer, HeldOut]:
    """Return the answer less the effects that held-out runs do not bear out, last selected first, and the runs as scored.

    An effect must not make their forecasts worse, and must make them or the forces of their slips better; a further one must
    make the forecasts better. All together must not make them worse. What is named then has a strength that differs from zero.
    """
    if answer.decision.named and answer.decision.form is not None:
        answer = _with_form(answer, answer.decision.form.kind, slip_study, recalibrated, runs)
    answer, dropped, last, noise, runs = _less_refused(answer, slip_study, recalibrated, runs)
    if dropped and answer.decision.named:
        # what is refused explains nothing: the rest has to explain the fit runs without it
        poor = unexplained(slip_study, answer.decision, recalibrated.model, answer.model)
        if poor is not None:
            poor.details["not_borne_out"] = dropped
            return Answer(poor, None, recalibrated.model), runs
    together = len(answer.decision.named) > 1
    while together and answer.decision.named:
        # what stands beside an effect may make up for what that one does wrong: all together are held against none
        seen = compared(recalibrated.model, answer.model, runs)
        if seen is None or not seen.worse:
            break
        last = answer.decision.named[-1]
        dropped[last.kind] = dataclasses.asdict(seen)
        answer = _without_last(answer, slip_study, recalibrated, runs)
        runs = as_split_for(answer.model, runs)
    answer = _with_strengths(answer, slip_study, recalibrated)
    if not dropped or last is None:
        return answer, runs
    answer.decision.details["not_borne_out"] = dropped
    if not answer.decision.named:
        answer = dataclasses.replace(answer, decision=_nothing_left(answer, last, runs, noise))
    return answer, runs


def _less_refused(
    answer: Answer, slip_study: Study, recalibrated: Fit, runs: HeldOut
) -> tuple[Answer, dict[str, object], Named | None, bool, HeldOut]:
    """Return the answer less the effects that held-out runs refuse, last selected first, and how these forecast.

    Returns:
        The answer, the comparisons by which effects went, the effect looked at last, whether the last one to go was a
        sensor's slow noise, and the runs as what is left is scored on them.
    """
    dropped: dict[str, object] = {}
    last: Named | None = None
    noise = False
    while answer.decision.named and answer.decision.named[-1].kind not in shown_elsewhere(answer.decision.model):
        last = answer.decision.named[-1]
        fewer = _without_last(answer, slip_study, recalibrated, runs)
        seen = compared(fewer.model, answer.model, runs)
        if seen is None or not (_refused(seen, last, fewer) or _refuted_by_forces(seen, last, fewer, answer, slip_study, runs)):
            break
        dropped[last.kind] = dataclasses.asdict(seen)
        noise = within_noise(last.kind, answer.model, runs.slips)
        answer = fewer
        runs = as_split_for(answer.model, runs)
    return answer, dropped, last, noise, runs


def _with_form(answer: Answer, term: str, slip_study: Study, recalibrated: Fit, runs: HeldOut) -> Answer:
    """Return the answer without the term for what its effect's form leaves, unless that matters to held-out forecasts."""
    decision = dataclasses.replace(answer.decision, model=answer.decision.model.without_last(term), form=None)
    plain = explaining(fitted(decision, slip_study, recalibrated), slip_study, recalibrated)
    plain = dataclasses.replace(plain, model=settled(plain.model, runs))
    seen = compared(plain.model, answer.model, runs)
    return answer if seen is not None and seen.better and not seen.idle else plain


def _refuted_by_forces(seen: Comparison, last: Named, fewer: Answer, answer: Answer, slip_study: Study, runs: HeldOut) -> bool:
    """Return whether the forces of held-out slips speak against the effect selected last.

    It leaves them and the forecasts as they are without it; or it makes them worse, unless the motion in stick speaks for it.
    """
    if last.kind in kinds_with(SCATTER):
        return False
    if any(e.group == "sensor" for e in answer.model.effects):
        return seen.idle and bool(fewer.decision.named)  # predicted forces do not hold what a sensor adds
    forces = slip_force_gap(slip_study.model, fewer.model, answer.model, runs.slips)
    if forces is None:
        return False
    nothing = criteria.CLOSES_NOTHING * forces.recalibrated
    worse = forces.augmented - forces.recalibrated > nothing and not _by_its_motion(last.kind, answer.decision)
    return worse or (seen.idle and forces.recalibrated - forces.augmented < nothing)


def _by_its_motion(kind: str, decision: Decision) -> bool:
    """Return whether a contact that yields was selected for what it does in stick, and explains the motion as a name must.

    The forces of a slip begin at its edges, which such a contact has moved; a belt that does not run evenly has not.
    """
    if kind != kind_with_signature(YIELDING):
        return False
    seen = cast("dict[str, float]", decision.details.get("explained", {}))
    if STICK_SHARE not in decision.details or "share" not in seen:
        return STICK_SHARE in decision.details
    reducible = seen["before"] - seen["floor"]
    return seen["share"] * reducible + criteria.LACKS * seen["doubt"] >= criteria.EXPLAINED * reducible


def _with_strengths(answer: Answer, slip_study: Study, recalibrated: Fit) -> Answer:
    """Return the answer with intervals that do not hold zero where a fit without the effect tells that its strength is none."""
    fit, named = answer.fit, {n.kind: n for n in answer.decision.named}
    for kind in [] if fit is None else undecided(fit, answer.model):
        if kind not in named:
            continue
        model = answer.decision.model
        while any(e.kind == kind for e in model.effects):
            model = model.without_last(kind)
        rest = tuple(n for n in answer.decision.named if n.kind != kind)
        fewer = dataclasses.replace(answer.decision, named=rest, model=model)
        assert fit is not None
        other = _fit(fewer, slip_study, recalibrated) if rest else recalibrated
        without, with_ = likelihood_ratios([other.model, fit.model], slip_study.windows)
        ratio = float(without - with_)
        evidence = max(ratio, named[kind].evidence.score or 0.0)
        answer.decision.details.setdefault("strengths", {})[kind] = ratio  # pyright: ignore[reportIndexIssue, reportAttributeAccessIssue]
        if evidence >= criteria.STRENGTH_DECIDED:
            fit = decided_by_ratio(fit, answer.model, kind, evidence, functools.partial(_held_at, fit, kind, slip_study))
    return dataclasses.replace(answer, fit=fit)


def _held_at(fit: Fit, kind: str, slip_study: Study, strength: float) -> float:
    """Return twice the log likelihood ratio of a fit to the same with a kind's only strength held at a value [-]."""
    model = fit.model.mean
    (name,) = (k.name for k in fit.free if k.owner >= 0 and k.name in STRENGTHS and model.effects[k.owner].kind == kind)
    effects = tuple(e.changed(**{name: strength}) if e.kind == kind else e for e in model.effects)
    held = dataclasses.replace(model, effects=effects, measured={**model.measured, name: 0.0})
    other = refit(held, slip_study.windows, slip_study.uncertainty, evaluations=25)
    without, with_ = likelihood_ratios([other.model, fit.model], slip_study.windows)
    return float(without - with_)


def _without_last(answer: Answer, slip_study: Study, recalibrated: Fit, runs: HeldOut) -> Answer:
    decision, last = answer.decision, answer.decision.named[-1]
    fewer = dataclasses.replace(decision, named=decision.named[:-1], model=decision.model.without_last(last.kind))
    if not fewer.named:
        return Answer(fewer, None, recalibrated.model)
    again = fitted(fewer, slip_study, recalibrated)
    if last.before is not None:
        # beside it the others have been bent to suit it: without it they begin where they were before, too
        other = fitted(dataclasses.replace(fewer, model=last.before), slip_study, recalibrated)
        again = min(again, other, key=lambda a: a.fit.objective if a.fit is not None else np.inf)
    return dataclasses.replace(again, model=settled(again.model, runs))


def _refused(seen: Comparison, last: Named, fewer: Answer) -> bool:
    """Return whether held-out runs speak against the effect that was selected last."""
    # what is beside a named effect needs evidence of its own; a wander's forecasts hang on where the record happens to be
    idle = bool(fewer.decision.named) and last.kind != kind_with_signature(WANDER) and not seen.better
    return seen.worse or idle


def _nothing_left(answer: Answer, last: Named, runs: HeldOut, noise: bool) -> Decision:
    """Return the decision where held-out runs have refused every effect: none, or unknown where much is to be explained."""
    error = mean_score(answer.model, runs)
    reducible = error - min(floor_of(answer.model, runs), error)
    if noise or reducible < criteria.LEAST_REDUCIBLE * error:
        return dataclasses.replace(answer.decision, verdict="none")
    text = f"{last.kind} comes closest on the fit runs, but the held-out runs do not bear it out"
    return dataclasses.replace(answer.decision, verdict="unknown", where=Where(last.where.axis, text))
