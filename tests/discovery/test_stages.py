"""The stages between slips and verdict, one after the other, on a rig whose friction weakens with speed."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.inference.paired import paired
from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.advice import next_experiment, not_identifiable
from stochfric_mb.discovery.stick_slip.decision import choice
from stochfric_mb.discovery.stick_slip.decision.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision.choice import Chosen, choose
from stochfric_mb.discovery.stick_slip.decision.confirmation import cases_of, confirm, predict
from stochfric_mb.discovery.stick_slip.decision.entrainment import entrained
from stochfric_mb.discovery.stick_slip.decision.explained import unexplained
from stochfric_mb.discovery.stick_slip.decision.innovations import left_over
from stochfric_mb.discovery.stick_slip.decision.rounds import decide
from stochfric_mb.discovery.stick_slip.decision.sensor_zero import seen_step, steady
from stochfric_mb.discovery.stick_slip.notes import notes
from stochfric_mb.discovery.stick_slip.records.stick_phases import analyse
from stochfric_mb.discovery.stick_slip.refusal import refusal
from stochfric_mb.discovery.stick_slip.screening.competitors import competitors, softening
from stochfric_mb.discovery.stick_slip.screening.naming import with_candidate
from stochfric_mb.discovery.stick_slip.screening.power import smallest
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.simulation.delay_compensation import driven, with_delay, without_delay
from stochfric_mb.discovery.stick_slip.simulation.scaling import USUAL
from stochfric_mb.discovery.stick_slip.study import study
from stochfric_mb.discovery.stick_slip.validation import Answer, explaining, fitted
from stochfric_mb.discovery.stick_slip.workflow import recalibrated_model
from stochfric_mb.effects import make_effect
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box


@pytest.fixture(scope="module")
def data():
    return belt_box(Case("velocity_weakening.rational", "one_free", 1.0, 17))


@pytest.fixture(scope="module")
def found(data):
    return study(data, USUAL)


@pytest.fixture(scope="module")
def candidates(found):
    return screen(found.pool, found.regression, found.terms, found.solution)


@pytest.fixture(scope="module")
def cases(found):
    return cases_of(found.pool, found.model)


@pytest.fixture(scope="module")
def decision(found):
    return decide(found)


@pytest.fixture(scope="module")
def recalibrated(found):
    return recalibrated_model(found.model, found)


def test_patterns_without_a_name_have_one_row_a_slip(found):
    for name, (axis, columns) in competitors(found.pool).items():
        assert axis, name
        assert all(c.shape == found.pool.features.shape for c in columns)
    assert all(len(h.columns) == 1 for h in softening(found.pool))


def test_a_candidate_becomes_an_effect_that_confirmation_bears_out(found, candidates, cases):
    weakening = next(c for c in candidates if c.name == "velocity_weakening")
    model = with_candidate(found.model, weakening, found.pool, found.terms.columns.shape[2])
    assert [e.kind for e in model.effects] == ["velocity_weakening"]
    before, after = (confirm(cases, m, found.uncertainty) for m in (found.model, model))
    assert after.criterion < before.criterion - 100.0
    assert predict(after.model, cases[0]) is not None


def test_a_candidate_that_never_slips_is_no_explanation(found, candidates, cases, monkeypatch):
    # a slip that is missed counts a fixed number of deviations: less than one that is there, and wrong by more
    stuck = dataclasses.replace(confirm(cases, found.model.with_law(9.0, 8.0), found.uncertainty), chi2=0.0)
    assert not stuck.slips
    monkeypatch.setattr(choice, "confirm", lambda *_, **__: stuck)
    monkeypatch.setattr(choice, "entrained", lambda *_: [])
    before = confirm(cases, found.model, found.uncertainty)
    assert before.slips
    chosen = choose(found, found.model, found.terms, candidates, cases, before, {})
    assert not (isinstance(chosen, Chosen) and chosen.simulated)


def test_the_effect_that_was_planted_is_chosen(found, candidates, cases):
    before = confirm(cases, found.model, found.uncertainty)
    details = {}
    chosen = choose(found, found.model, found.terms, candidates, cases, before, details)
    assert isinstance(chosen, Chosen)
    assert chosen.candidate.name == "velocity_weakening"
    assert details["confirmation_1"]["believed"][0] == before.chi2


def test_slips_that_keep_to_a_wave_are_simulated_as_such(found, cases):
    # in a free run every slip is like the one before: waves are tried, and none fits better than weakening does
    for candidate, confirmed in entrained(found, found.model, found.terms, cases):
        assert candidate.is_wave
        assert confirmed.n_parameters >= 3


def test_what_the_effect_leaves_is_less(found, decision):
    left = left_over(found.pool, decision.model, anew=True)
    before, after = (np.abs(p.features[:, 2:].mean(axis=0)).sum() for p in (found.pool, left))
    assert after < 0.3 * before


def test_a_name_that_explains_stands_and_one_that_does_not_falls(found, decision, recalibrated):
    answer = fitted(decision, found, recalibrated)
    assert unexplained(found, decision, recalibrated.model, answer.model) is None
    assert explaining(answer, found, recalibrated) is answer
    idle = Answer(decision, answer.fit, recalibrated.model)  # the name without its effect
    poor = unexplained(found, decision, recalibrated.model, idle.model)
    assert poor is not None
    assert poor.verdict == "unknown"


def test_a_model_that_cannot_run_by_itself_is_no_answer(found, decision, recalibrated):
    # a spring that softens without end holds nothing once the box is far out
    runaway = recalibrated.model.plus(make_effect("nonlinear_stiffness", cubic=-1.0e9))
    poor = unexplained(found, decision, recalibrated.model, runaway)
    assert poor is not None
    assert poor.verdict == "unknown"
    assert "cannot run by itself" in poor.where.text


def test_the_belt_runs_as_stated_and_a_wrong_statement_is_seen(data, found):
    assert belt_speed(found) is None
    wrong = dataclasses.replace(
        data.scenario, mechanism=dataclasses.replace(data.scenario.mechanism, belt_velocity=1.05 * 2.5e-3)
    )
    seen = belt_speed(study(dataclasses.replace(data, scenario=wrong), USUAL))
    assert seen is not None
    assert seen.ratio == pytest.approx(1.0 / 1.05, rel=2e-3)
    assert seen.too_much


def test_stick_phases_of_a_rigid_contact_show_nothing(found):
    sticking = analyse(found.pool.slips)
    assert sticking is not None
    assert max(sticking.scores.values()) < 0.0


def test_no_step_of_the_sensor_is_seen_and_the_slips_stay_as_they_are(found, candidates):
    assert seen_step(candidates, {}) is None
    np.testing.assert_array_equal(
        steady(found.regression, found.terms, candidates, [], found.solution).features, found.pool.features
    )


def test_no_known_force_tells_a_delay_which_can_be_taken_off_again(found):
    assert not driven(found)
    late = with_delay(found.model, 2e-3)
    assert late.late == pytest.approx(2e-3)
    assert without_delay(late).effects == ()


def test_advice_and_notes_speak_of_this_experiment(data, found, decision):
    assert {"dwell_ageing", "direction_asymmetry", "load_dependence"} <= set(not_identifiable(found))
    assert "belt speed" in next_experiment(decision, found)
    gap = Gap("crps_one_cycle", "m", True, 2e-5, 1e-5, 1.2e-5, 4e-6)
    details = decision.details | {"parameters": {"moved_beyond_uncertainty": {"mass": 3.2}}}
    told = notes(found, dataclasses.replace(decision, details=details), gap, None, data)
    assert any("mass is 3.2 stated standard deviations" in note for note in told)
    assert any("off by more" in note for note in told)


def test_what_would_have_been_named_is_small(found):
    power = smallest(found)
    assert 0.0 < power["velocity_weakening"] < 0.1  # of mu_s - mu_k, which is 0.34


def test_runs_that_hardly_slip_are_refused_with_what_they_need(data):
    short = dataclasses.replace(data, runs=tuple(r.between(-1.0, 4.0, name=r.name, role=r.role) for r in data.runs))
    assert study(short, USUAL) is None
    where, needed = refusal(short)
    assert where.axis == "record"
    assert "12 stick-slip cycles" in needed


def test_paired_errors_know_which_model_is_better():
    rng = np.random.default_rng(3)
    without = 1.0 + 0.1 * rng.standard_normal(50)
    seen = paired(without, without - 0.2 + 0.05 * rng.standard_normal(50))
    assert seen.without - seen.with_ == pytest.approx(0.2, abs=0.03)
    assert seen.better + seen.worse == seen.parts == 50
    assert seen.p_value < 1e-6
