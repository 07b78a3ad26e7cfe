"""The model as far as the search has come: effects are taken into it one by one, and out of the features of the slips."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.false_alarms import likely
from stochfric_mb.discovery.stick_slip.decision.cases import Case, cases_of
from stochfric_mb.discovery.stick_slip.decision.choice import REFUTED, Chosen
from stochfric_mb.discovery.stick_slip.decision.confirmation import Confirmed, SeenInSlips, confirm
from stochfric_mb.discovery.stick_slip.decision.decision import Finding, Named, selected, term_of
from stochfric_mb.discovery.stick_slip.decision.innovations import beyond_stated, left_by
from stochfric_mb.discovery.stick_slip.decision.kinematics import delay_deviation, with_kinematic
from stochfric_mb.discovery.stick_slip.decision.sensor_zero import steady
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array, corrections_of
from stochfric_mb.discovery.stick_slip.screening.naming import as_harmonic
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, Regression
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.discovery.stick_slip.screening.smooth_term import axes_of, smooth_term
from stochfric_mb.discovery.stick_slip.simulation.delay_compensation import delay_compensated, driven, with_delay, without_delay
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import REFIT_WINDOWS, cost_of, refit
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import effect_class, kind_with_signature, kinds_with, make_effect
from stochfric_mb.effects.traits import BELT_RIPPLE, COURSE_OF_RUN, LATE, MOVES_ZERO, YIELDING


class WorkingModel:
    """The model so far, what it leaves of the slips, and what simulating has said of it."""

    def __init__(self, study: Study) -> None:
        self.study = study
        """What was measured; once the sensor's delay is known, with the records put on time."""
        self.model = at_estimates(study)
        """The stated model, its numbers as estimated, with the effects so far, for these records."""
        self.late: float | None = None
        """The delay [s] by which the records were put on time."""
        self.named: list[Named] = []
        """The effects, in the order of selection."""
        self.form: Named | None = None
        """The term without a name that stands for what the first effect's form leaves."""
        self.baseline: Baseline = study.baseline
        """What the model leaves of the slips."""
        self.stalled = False
        """Whether it leaves so much, or so few slips, that no search in that makes sense."""
        self.taken: list[Candidate] = []
        """The candidates that were taken into it, harmonics included."""
        self.faults: list[Array] = []
        """Regressors of a sensor's zero that moves, which stay among the terms."""
        self.cases: list[Case] = []
        """The slips that simulated ones are compared with."""
        self.unaided: Confirmed | None = None
        """The simulated model before effects were taken from its like."""
        self.confirmed: Confirmed | None = None
        """The simulated model so far."""
        self.simulated = False
        """Whether numbers of an effect come from simulating."""

    @property
    def kinds(self) -> list[str]:
        """Names of the effects."""
        return [n.kind for n in self.named]

    @property
    def as_recorded(self) -> Model:
        """The model of the records as they are: late, if they were put on time."""
        return self.model if self.late is None else with_delay(self.model, self.late)

    @property
    def seen(self) -> SeenInSlips | None:
        """The slips with which the effects were simulated; None where none were."""
        known = self.confirmed if self.simulated else None
        return None if known is None else SeenInSlips(known.kinds, tuple(self.cases))

    @property
    def shape_left(self) -> float:
        """Misfit of simulated slips with the effects over that without [-]; 1 where none were simulated."""
        now, before = self.confirmed, self.unaided
        return 1.0 if now is None or before is None else now.chi2 / before.chi2

    def take_finding(self, finding: Finding, details: Mapping[str, object]) -> None:
        """Take in what the stick phases or the sensor show; ``details``: what else they show."""
        self.named.append(selected(finding.kind, finding.evidence, self.as_recorded))
        late = finding.kind == kind_with_signature(LATE)
        if late and driven(self.study):
            # forces are looked at on time
            self.late = float(finding.values["delay"])
            self.study = beyond_stated(delay_compensated(self.study, self.late))
            self.model, self.baseline = at_estimates(self.study), self.study.baseline
        else:
            self.model = with_kinematic(self.study, self.model, finding)
        if late:
            # a velocity tells it far better than forecasts, and no forecast tells it where no known force acts
            self.model = dataclasses.replace(self.model, measured={"delay": delay_deviation(details)})
        elif finding.kind in (kind_with_signature(BELT_RIPPLE), kind_with_signature(YIELDING)):
            self._take_out()

    def take_random(self, finding: Finding) -> None:
        """Take in what is random in the slips."""
        self.named.append(selected(finding.kind, finding.evidence, self.as_recorded))
        self.model = self.model.plus(make_effect(finding.kind, **finding.values))

    def look_at(self, candidates: Sequence[Candidate]) -> None:
        """Take the slips that simulated ones are compared with, if that has not been done."""
        if not self.cases:
            self.cases = cases_of(steady(self.baseline, candidates, self.faults), self.model)
            self._average_over(frozenset(self.model.effects[i].kind for i in self.model.waves()))
            self.confirmed = confirm(self.cases, self.model, self.study.uncertainty) if self.cases else None
            self.unaided = self.unaided or self.confirmed

    def _average_over(self, waves: frozenset[str]) -> None:
        """Take the slips that simulated ones are compared with as medians over the phases of waves."""
        self.cases = [dataclasses.replace(c, averaged=c.averaged | waves) for c in self.cases]

    def take(self, chosen: Chosen, details: dict[str, object]) -> bool:
        """Take an effect into the model, and out of the features; return whether it is worth a place beside the others."""
        kind, without, before = chosen.candidate.name, self.model, self.as_recorded
        simulated = self.confirmed, self.simulated
        self.confirmed, self.simulated = chosen.confirmed, self.simulated or chosen.simulated
        harmonic = as_harmonic(self.model, chosen.candidate, self.study.pool)
        self.model = chosen.model if harmonic is None else harmonic
        self._complete(kind, details)
        screened = self.model
        fitted = (kind in kinds_with(COURSE_OF_RUN) or chosen.simulated) and kind != kind_with_signature(LATE)
        # single forecasts of friction that scatters tell less than the slips' medians, to which a simulated model is fitted
        fitted &= not (chosen.simulated and without.random)
        if fitted and not self._refitted(without):
            self.confirmed, self.simulated = simulated  # what is simulated is the model that stands
            return kind in self.kinds and self._beside(chosen.candidate, details)
        if harmonic is None and kind not in self.kinds:
            evidence = likely("slips", chosen.candidate.score)
            self.named.append(selected(kind, evidence, before, chosen.class_, self.shape_left))
        self.taken.append(chosen.candidate)
        if chosen.candidate.is_wave and not chosen.simulated:
            self._average_over(frozenset({kind}))
        if kind == kind_with_signature(LATE):
            self._put_on_time()
        else:
            self._go_on(chosen, screened if fitted else None)
        return True

    def _complete(self, kind: str, details: dict[str, object]) -> None:
        """Take what the form of the one effect leaves along the effect's own axis into the model: a term without a name.

        A name says on what friction depends, not how. What is left on that axis is its shape, as long as the effect's own form
        takes the larger part of what both take together.
        """
        own = effect_class(kind).form_axis
        if not own or self.named or self.model.random or any(e.group == "sensor" for e in self.model.effects):
            return
        left = left_by(self.model, self.study, self.baseline)
        if left is None:
            return
        term = smooth_term(left, self.model, next(a for a in axes_of(left.pool) if a.name == own))
        # of the same slips: costs of fewer are those of other data
        measured = Regression(dataclasses.replace(self.study.pool, kept=left.pool.kept))
        fits = ((measured, self.study.baseline.terms), (left.regression, left.terms))
        shown, rest = (r.solve(terms, term.solution.scatter).cost - term.solution.cost for r, terms in fits)
        details["form"] = {"axis": own, "score": term.score}
        if shown <= 0.0:  # both together explain nothing: there is no share of it
            return
        share = float(np.clip(1.0 - rest / shown, 0.0, 1.0))
        details["form"] = {"axis": own, "score": term.score, "share": share}
        if term.score <= criteria.NAMED or share < criteria.OWN_FORM:
            return
        model = term.model
        if self.confirmed is not None:
            fitted = confirm(self.cases, model, self.study.uncertainty)
            self.confirmed, model = fitted, fitted.model
        self.model, self.form = model, term_of(model, term.score)

    def _go_on(self, chosen: Chosen, screened: Model | None) -> None:
        """Go on with what is left; ``screened``: the model before a fit to forecasts, where there was one."""
        if chosen.candidate.name in kinds_with(MOVES_ZERO):
            self.faults += chosen.candidate.hypothesis.columns
        before = self.baseline.variance
        promised = before - dataclasses.replace(self.baseline, solution=chosen.candidate.solution).variance
        self._take_out()
        if chosen.simulated:
            return
        if screened is not None and (self.stalled or self.baseline.variance > criteria.LEFT_OVER * before):
            self._take_out_better(screened)
        removed = before - self.baseline.variance
        # a search for more makes sense where a wave takes out what its marks promised, be it much or little
        self.stalled |= chosen.candidate.is_wave and (removed <= 0.0 or removed < criteria.EXPLAINED * promised)

    def _refitted(self, without: Model) -> bool:
        """Fit the model to forecasts; go back to the one ``without`` its last effect if that forecasts as well."""
        # a simulated fit knows the features alone, whose bias by noise is that of the stated model
        windows, seen = self.study.windows, self.seen
        further = None if seen is None else seen.of(self.model)
        fit = refit(self.model, windows, self.study.uncertainty, most=REFIT_WINDOWS, evaluations=20, further=further)
        least = (1.0 - criteria.CLOSES_NOTHING) * cost_of(without, windows, most=REFIT_WINDOWS)
        idle = bool(self.named) and fit.cost > least
        self.model = without if idle else fit.model
        return not idle

    def _beside(self, more: Candidate, details: dict[str, object]) -> bool:
        """Look for others beside the marks of more of an effect that forecasts do not bear out; return whether to go on.

        They are what its numbers miss while something else is missing. Slips that simulated ones are compared with scatter less
        beside them, too, and are taken anew: what was refuted with the others may stand.
        """
        self.faults += more.hypothesis.columns
        self._take_out()
        if not self.simulated:
            self.cases, self.confirmed, self.unaided = [], None, None
            details.pop(REFUTED, None)
        return not self.stalled

    def _put_on_time(self) -> None:
        """Go on with the records put on time, by the delay that their forecasts show."""
        fit = refit(self.model, self.study.windows, self.study.uncertainty, most=REFIT_WINDOWS, evaluations=20)
        self.model, self.late = without_delay(fit.model), fit.model.late
        self.study = beyond_stated(delay_compensated(self.study, self.late))
        self.cases, self.confirmed, self.simulated = [], None, False
        self._take_out()

    def _take_out(self) -> None:
        """Go on with what the model leaves of the features."""
        shaped = any(c.any_shape for c in self.taken) or self.model.shapes_slips
        left = left_by(self.model, self.study, self.baseline, anew=shaped, faults=self.faults)
        self.stalled |= left is None
        self.baseline = left or self.baseline

    def _take_out_better(self, other: Model) -> None:
        """Go on with what another model leaves, if it leaves less: forecasts that jump between slips may lead a fit astray."""
        fitted = self.model, self.baseline, self.stalled
        self.model, self.stalled = other, False
        self._take_out()
        if self.stalled or (not fitted[2] and self.baseline.variance > fitted[1].variance):
            self.model, self.baseline, self.stalled = fitted


def at_estimates(study: Study) -> Model:
    """Return the stated model at the coefficients that the slips show, with the mechanism that they show."""
    estimates = study.baseline.solution.coefficients
    mu_s, mu_k = map(float, estimates[:2])
    model = dataclasses.replace(study.model, corrections=corrections_of(estimates[2 : 2 + len(CORRECTED)]))
    return model.with_law(max(mu_s, 1.0e-3), float(np.clip(mu_k, 1.0e-5, 0.999 * mu_s)))
