"""The whole workflow on a belt-box: study, decide, refit, score on held-out runs, recommend."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.discovery.result import Result
from stochfric_mb.discovery.stick_slip.advice import next_experiment, not_identifiable
from stochfric_mb.discovery.stick_slip.belt_speed import at_shown_speed, at_speed
from stochfric_mb.discovery.stick_slip.decision.decision import Decision
from stochfric_mb.discovery.stick_slip.decision.innovations import beyond_stated
from stochfric_mb.discovery.stick_slip.decision.rounds import decide
from stochfric_mb.discovery.stick_slip.notes import not_in_augmented, notes
from stochfric_mb.discovery.stick_slip.parameters import effect_estimate, moved, not_measured, own_parameters
from stochfric_mb.discovery.stick_slip.records.preconditions import require_usable
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.refusal import refusal
from stochfric_mb.discovery.stick_slip.screening.power import smallest
from stochfric_mb.discovery.stick_slip.simulation.deviations import with_deviations
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import (
    HeldOut,
    gap_of,
    held_out,
    phased,
    settled,
)
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.prior_model import assumed
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit, refit
from stochfric_mb.discovery.stick_slip.study import EVERYTHING, Channels, Progress, Study, slips_of_run, study
from stochfric_mb.discovery.stick_slip.validation.anonymous import Anonymous, anonymous, sentence_of
from stochfric_mb.discovery.stick_slip.validation.answers import (
    Answer,
    checked_on_held_out,
    explaining,
    fitted,
    with_bump,
)
from stochfric_mb.discovery.stick_slip.validation.explained import felt, taken_back
from stochfric_mb.discovery.stick_slip.validation.feature_skill import Gaps, slip_force_gap
from stochfric_mb.discovery.stick_slip.validation.reading_skill import reading_gap
from stochfric_mb.errors import SimulationError
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.scenario import Scenario


def discover_belt_box(dataset: Dataset, *, channels: Channels = EVERYTHING, progress: Progress = lambda _: None) -> Outcome:
    """Return what a data set of belt-box runs says about its model.

    Args:
        dataset: the runs.
        channels: parts of the method to use.
        progress: called with the name of each stage as it begins.

    Raises:
        InputError: a run without a position or that shows no friction, or a law that cannot be stated here.
    """
    require_usable(dataset)
    given, dataset = dataset, assumed(dataset)
    measured = study(dataset, progress=progress)
    if measured is None:
        return _too_few(given)
    slip_study = beyond_stated(at_shown_speed(measured))
    dataset = slip_study.dataset
    decision = decide(slip_study, channels=channels, progress=progress)
    progress("recalibration")
    recalibrated = recalibrated_model(slip_study.model, slip_study)
    progress("refit")
    slips = _held_out_slips(dataset, slip_study)
    if phased(slip_study.model):  # a wave that is stated has a phase of its own in each run, too
        halves = held_out(slips, phased=True)
        slip_study = dataclasses.replace(slip_study, model=settled(slip_study.model, halves))
        recalibrated = dataclasses.replace(recalibrated, model=settled(recalibrated.model, halves))
    try:
        answer, runs = _answer(decision, slip_study, recalibrated, slips, channels, progress)
    except SimulationError as error:
        taken = taken_back(decision, f"comes closest, but its model cannot run by itself: {error}")
        answer, runs = Answer(taken, None, recalibrated.model), held_out(slips, phased=False)
    term = None
    if channels.unnamed and answer.decision.verdict == "unknown":
        term = anonymous(slip_study, recalibrated, runs)
        answer.decision.details["unnamed_term"] = sentence_of(term)
    kept = term if term is not None and term.carries_over else None
    models = (slip_study.model, recalibrated.model, answer.model if kept is None else kept.fit.model)
    result = _result(answer, kept, recalibrated, models, slip_study, runs, given)
    scenario = augmented_scenario(at_speed(given, slip_study.belt), models[2])
    return Outcome(result, scenario, given, slip_study, answer.decision, models, runs)


def _answer(
    decision: Decision, study: Study, recalibrated: Fit, slips: list[Slips], channels: Channels, progress: Progress
) -> tuple[Answer, HeldOut]:
    """Return the decision as far as fit runs and held-out runs bear it out, with its model, and the held-out runs."""
    answer = fitted(decision, study, recalibrated)
    if channels.confirmation:
        answer = explaining(answer, study, recalibrated)
    progress("held-out runs")
    runs = held_out(slips, phased=phased(answer.model))
    answer = dataclasses.replace(answer, model=settled(answer.model, runs))
    answer, runs = checked_on_held_out(answer, study, recalibrated, runs)
    answer = _explaining_held_out(answer, study, recalibrated, runs)
    return with_bump(answer, decision, study), runs


def _explaining_held_out(answer: Answer, study: Study, recalibrated: Fit, runs: HeldOut) -> Answer:
    """Return the answer without its names where these explain less of held-out runs than they leave.

    What is judged is the score that leads the page, in which the effects show.
    """
    if not felt(answer.decision):
        return answer
    gaps = _gaps((study.model, recalibrated.model, answer.model), study, runs)
    lead = gaps.leads
    if lead is None or lead.closed is None or lead.closed >= criteria.EXPLAINED_HELD_OUT:
        return dataclasses.replace(answer, gaps=gaps)
    why = f"comes closest, but explains only {max(lead.closed, 0.0):.0%} of what held-out runs show"
    return Answer(taken_back(answer.decision, why), None, recalibrated.model)


def _gaps(models: tuple[Model, Model, Model], study: Study, runs: HeldOut, *, named: bool = True) -> Gaps:
    """Return how far stated, recalibrated and augmented model are off held out; ``named``: whether the last has more."""
    gap = gap_of(*models, runs) if sum(map(len, runs.second)) else None
    if not named:
        return Gaps(gap)
    return Gaps(gap, slip_force_gap(*models, runs.slips), reading_gap(models[2], study, [s.record for s in runs.slips]))


def _result(
    answer: Answer,
    kept: Anonymous | None,
    recalibrated: Fit,
    models: tuple[Model, Model, Model],
    study: Study,
    runs: HeldOut,
    given: Dataset,
) -> Result:
    """Return what is said of the data.

    Args:
        answer: the decision that held-out runs have validated, and its fit.
        kept: the term without a name, where one carries over.
        recalibrated: the stated model, fitted.
        models: stated, recalibrated and augmented model.
        study: what the fit runs show.
        runs: the held-out runs.
        given: the data set as it was given, its uncertainties not assumed.
    """
    decision = answer.decision
    gaps = answer.gaps or _gaps(models, study, runs, named=bool(decision.named) or kept is not None)
    final = kept.fit if kept is not None else answer.fit if answer.fit is not None and decision.named else recalibrated
    own, unmeasured = own_parameters(final, models[2], study), not_measured(final)
    beyond = moved(own, given, unmeasured)
    form = kept.named if kept is not None else decision.form if decision.named else None
    decision.details.update(not_in_augmented(models[2]))
    decision.details["parameters"] = {"not_measured": unmeasured, "moved_beyond_uncertainty": beyond}
    return Result(
        verdict=decision.verdict,  # pyright: ignore[reportArgumentType]  # one of three words
        effects=tuple(effect_estimate(n, answer.fit, models[2], study) for n in decision.named),
        where=decision.where,
        ranking=tuple((k, float(s)) for k, s in decision.ranking),
        gap=gaps.forecasts,
        slip_forces=gaps.forces,
        readings=gaps.readings,
        leading=gaps.leading,
        not_identifiable=not_identifiable(study),
        next_experiment=next_experiment(decision, study),
        parameters=own,
        notes=notes(study, decision, models[2], gaps, given),
        unnamed=effect_estimate(form, final, models[2], study) if form is not None else None,
        power=smallest(study) if decision.verdict == "none" else {},
        details=decision.details,
    )


def _held_out_slips(dataset: Dataset, slip_study: Study) -> list[Slips]:
    return [s for s in (slips_of_run(r, dataset, slip_study) for r in dataset.test) if len(s) >= 2]


def augmented_scenario(dataset: Dataset, model: Model) -> Scenario:
    """Return the scenario with the model's corrections and effects; phases are those of the first held-out run.

    A simulated belt-box has no measured temperature: it is at that at which the coefficients hold.
    """
    scenario = dataset.scenario
    names = [r.name for r in (*dataset.test, *dataset.fit) if r.name in model.own]
    effects = tuple(e for e in (model.effects_in(names[0]) if names else model.effects) if not e.reads)
    random = any(e.coefficient_process() is not None for e in effects)
    return dataclasses.replace(
        scenario,
        title=f"{scenario.title}, augmented".lstrip(", "),
        mechanism=model.mechanism(scenario.mechanism),
        law=model.law,
        process=None if random else model.process,
        effects=effects,
    )


def recalibrated_model(model: Model, study: Study) -> Fit:
    """Return the model as stated, fitted within its uncertainty; its scatter, if any is declared, stays as declared."""
    stated = dataclasses.replace(model.mean, corrections=dict.fromkeys(CORRECTED, 0.0))
    mu_s, mu_k = (float(max(c, 1.0e-5)) for c in study.baseline.solution.coefficients[:2])
    shown = dataclasses.replace(stated, corrections=study.pool.slips[0].record.corrections).with_law(mu_s, mu_k)
    # where errors are large their sizes, to which a fit keeps, lead it nowhere: squares do, and sizes from there
    near = refit(shown, study.windows, study.uncertainty, typical=np.inf, evaluations=30).model
    fits = [refit(m, study.windows, study.uncertainty) for m in (shown, stated, near)]
    fit = with_deviations(min(fits, key=lambda f: f.cost), study.windows, study.uncertainty)
    return dataclasses.replace(fit, model=dataclasses.replace(model, law=fit.model.law, corrections=fit.model.corrections))


def _too_few(dataset: Dataset) -> Outcome:
    """Return the answer for runs that hardly slip: nothing can be said, and what is needed to say something."""
    where, needed = refusal(dataset)
    result = Result(
        verdict="unknown", effects=(), where=where, ranking=(), gap=None, not_identifiable=(), next_experiment=needed,
        parameters={}, notes=(where.text,),
    )  # fmt: skip
    return Outcome(result, dataset.scenario, dataset)
