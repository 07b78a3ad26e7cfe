"""The stages between slips and verdict, one after the other, on a rig whose friction weakens with speed."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import criteria, discover
from stochfric_mb.discovery.inference.false_alarms import detected
from stochfric_mb.discovery.inference.paired import paired
from stochfric_mb.discovery.result import Gap, Where
from stochfric_mb.discovery.stick_slip.advice import next_experiment, not_identifiable
from stochfric_mb.discovery.stick_slip.belt_speed import belt_speed
from stochfric_mb.discovery.stick_slip.decision import choice
from stochfric_mb.discovery.stick_slip.decision.cases import cases_of, predict
from stochfric_mb.discovery.stick_slip.decision.chance import before_effects, without_accidents
from stochfric_mb.discovery.stick_slip.decision.choice import OTHER_RIG, Chosen, choose
from stochfric_mb.discovery.stick_slip.decision.confirmation import confirm
from stochfric_mb.discovery.stick_slip.decision.decision import Finding
from stochfric_mb.discovery.stick_slip.decision.entrainment import entrained
from stochfric_mb.discovery.stick_slip.decision.innovations import left_over
from stochfric_mb.discovery.stick_slip.decision.kinematics import kinematics
from stochfric_mb.discovery.stick_slip.decision.rounds import decide
from stochfric_mb.discovery.stick_slip.decision.sensor_zero import seen_in_stick, steady
from stochfric_mb.discovery.stick_slip.decision.working_model import WorkingModel
from stochfric_mb.discovery.stick_slip.notes import notes, of_the_record
from stochfric_mb.discovery.stick_slip.records.stick_phases import analyse
from stochfric_mb.discovery.stick_slip.refusal import refusal
from stochfric_mb.discovery.stick_slip.screening.competitors import competitors, softening
from stochfric_mb.discovery.stick_slip.screening.naming import with_candidate
from stochfric_mb.discovery.stick_slip.screening.power import smallest
from stochfric_mb.discovery.stick_slip.screening.regression import baseline_of
from stochfric_mb.discovery.stick_slip.screening.screen import screen
from stochfric_mb.discovery.stick_slip.simulation.delay_compensation import driven, with_delay, without_delay
from stochfric_mb.discovery.stick_slip.study import study
from stochfric_mb.discovery.stick_slip.validation.answers import Answer, explaining, fitted
from stochfric_mb.discovery.stick_slip.validation.explained import unexplained
from stochfric_mb.discovery.stick_slip.validation.feature_skill import Gaps
from stochfric_mb.discovery.stick_slip.validation.predictive_check import inadequate
from stochfric_mb.discovery.stick_slip.workflow import recalibrated_model
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.traits import SHAPES_SLIPS
from stochfric_mb.laws import make_law
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box
from tests.discovery.unseen_forms.records import cases as unseen_cases
from tests.discovery.unseen_forms.records import write_record


@pytest.fixture(scope="module")
def data():
    return belt_box(Case("velocity_weakening.rational", "one_free", 1.0, 17))


@pytest.fixture(scope="module")
def slip_study(data):
    return study(data)


@pytest.fixture(scope="module")
def candidates(slip_study):
    return screen(slip_study.baseline)


@pytest.fixture(scope="module")
def cases(slip_study):
    return cases_of(slip_study.pool, slip_study.model)


@pytest.fixture(scope="module")
def decision(slip_study):
    return decide(slip_study)


@pytest.fixture(scope="module")
def recalibrated(slip_study):
    return recalibrated_model(slip_study.model, slip_study)


def test_a_mechanism_that_is_off_within_its_uncertainty_leaves_no_shape_to_the_slips(monkeypatch):
    data = belt_box(Case("none.wrong_parameters", "several", 1.0, 17))
    box = data.scenario.mechanism
    uncertainty = dict(data.scenario.uncertainty) | {"stiffness": 0.015, "mass": 0.015}
    stated = dataclasses.replace(box, stiffness=0.97 * box.stiffness, mass=1.03 * box.mass)
    data = dataclasses.replace(data, scenario=dataclasses.replace(data.scenario, mechanism=stated, uncertainty=uncertainty))

    def score_of_shape() -> float:
        slip_study = study(data)
        return next(c.score for c in screen(slip_study.baseline) if c.name == "slip_shape")

    assert score_of_shape() < criteria.FOLLOWED_UP
    monkeypatch.setattr("stochfric_mb.discovery.stick_slip.study.RECALIBRATIONS", 0)
    assert score_of_shape() > criteria.NAMED  # forces taken with the stated numbers hold a shape of their own


def test_what_a_declared_scatter_with_a_memory_shows_by_chance_is_not_named(tmp_path):
    name = "third_scatter_declared_correlated-one-1"
    write_record(next(c for c in unseen_cases() if c.name == name), tmp_path, 2311)
    result = discover(tmp_path / "data").result
    assert dict(result.ranking)["harmonic_force"] > criteria.NAMED  # what names a wave where slips are independent
    assert result.details["largest_by_chance"] > criteria.NAMED
    assert result.verdict == "none"


def test_pink_noise_is_no_random_friction(tmp_path):
    write_record(next(c for c in unseen_cases() if c.name == "noise_pink-one-1"), tmp_path, 77)
    result = discover(tmp_path / "data").result
    assert result.details["randomness"]["static"] > criteria.SCATTER_CERTAIN  # beyond doubt, were the noise as calibrated
    assert result.verdict == "none"


def test_patterns_without_a_name_have_one_row_a_slip(slip_study):
    for name, (axis, columns) in competitors(slip_study.pool).items():
        assert axis, name
        assert all(c.shape == slip_study.pool.features.shape for c in columns)
    assert all(len(h.columns) == 1 for h in softening(slip_study.pool))


def test_what_stands_for_all_phases_of_a_wave_is_simulated_without_it(slip_study, cases):
    """Its numbers are no business of a fit to such slips."""
    ripple = make_effect("belt_speed_ripple", amplitude=0.2, frequency=3.0)
    runs = {s.record.name: ({"phase": 0.4},) for s in slip_study.pool.slips}
    waved = dataclasses.replace(slip_study.model, effects=(ripple,), own=runs)
    averaged = [dataclasses.replace(c, averaged=frozenset({ripple.kind})) for c in cases]
    plain = predict(slip_study.model, cases[0])
    np.testing.assert_array_equal(predict(waved, averaged[0]), plain)
    assert np.abs(predict(waved, cases[0]) - plain).max() > 0.01 * np.abs(plain).max()
    fitted = confirm(averaged, waved, slip_study.uncertainty)
    assert (fitted.model.effects, fitted.n_parameters) == ((ripple,), 0)
    assert fitted.chi2 == confirm(cases, slip_study.model, slip_study.uncertainty).chi2


def test_a_candidate_becomes_an_effect_that_confirmation_bears_out(slip_study, candidates, cases):
    weakening = next(c for c in candidates if c.name == "velocity_weakening")
    model = with_candidate(slip_study.model, weakening, slip_study.pool)
    assert [e.kind for e in model.effects] == ["velocity_weakening"]
    before, after = (confirm(cases, m, slip_study.uncertainty) for m in (slip_study.model, model))
    assert after.criterion < before.criterion - 100.0
    assert predict(after.model, cases[0]) is not None


def test_a_candidate_that_never_slips_is_no_explanation(slip_study, candidates, cases, monkeypatch):
    # a slip that is missed counts a fixed number of deviations, whatever the data: no misfit of it says anything
    stuck = dataclasses.replace(confirm(cases, slip_study.model.with_law(9.0, 8.0), slip_study.uncertainty), chi2=0.0)
    assert not stuck.slips
    monkeypatch.setattr(choice, "confirm", lambda *_, **__: stuck)
    monkeypatch.setattr(choice, "entrained", lambda *_: [])
    before = confirm(cases, slip_study.model, slip_study.uncertainty)
    assert before.slips
    chosen = choose(slip_study, slip_study.model, slip_study.baseline, candidates, cases, before, {})
    assert not (isinstance(chosen, Chosen) and chosen.simulated)


def test_what_does_not_slip_fits_no_better_than_what_slips_otherwise(slip_study, cases):
    wrong = [slip_study.model.with_law(mu_s, 0.5 * mu_s) for mu_s in (0.6, 9.0)]
    slipping, stuck = (confirm(cases, m, slip_study.uncertainty, evaluations=1) for m in wrong)
    assert (slipping.slips, stuck.slips) == (True, False)
    assert slipping.chi2 <= stuck.chi2


def simulated(slip_study, cases, before, shaping, monkeypatch, chi2):
    """Return the effects that are simulated of some candidates, each of which leaves ``chi2``."""
    seen = []

    def confirmed(_cases, model, _uncertainty, **rough):
        seen.extend([] if rough else [model.effects[-1]])
        return dataclasses.replace(before, chi2=chi2, model=model, kinds=(model.effects[-1].kind,))

    monkeypatch.setattr(choice, "confirm", confirmed)
    monkeypatch.setattr(choice, "entrained", lambda *_: [])
    choice._Simulation(slip_study, slip_study.model, cases, before, {})._tried(shaping)
    return seen


def test_all_forms_of_a_kind_are_simulated_and_all_kinds_where_none_is_adequate(slip_study, candidates, cases, monkeypatch):
    """Marks are of first order: they tell kinds better than forms, and where no kind explains the slips they told nothing."""
    monkeypatch.setattr(choice, "MOST_SIMULATED", 5)
    before = confirm(cases, slip_study.model, slip_study.uncertainty)
    shaping = [c for c in candidates if c.has(SHAPES_SLIPS) and not c.is_wave and not c.any_shape]
    first, every = (simulated(slip_study, cases, before, shaping, monkeypatch, chi2) for chi2 in (0.0, before.chi2))
    assert [e.kind for e in first] == [c.name for c in shaping[:5]]  # the first explains the slips
    assert sorted(e.kind for e in every) == sorted(c.name for c in shaping)
    assert {e.tail for e in every if e.kind == "velocity_weakening"} == {0.0, 1.0}  # an exponential and a hyperbola


def test_the_effect_that_was_planted_is_chosen(slip_study, candidates, cases):
    before = confirm(cases, slip_study.model, slip_study.uncertainty)
    details = {}
    chosen = choose(slip_study, slip_study.model, slip_study.baseline, candidates, cases, before, details)
    assert isinstance(chosen, Chosen)
    assert chosen.candidate.name == "velocity_weakening"
    assert details["confirmation_1"]["believed"][0] == before.chi2


def test_the_planted_effect_is_taken_into_the_model_and_out_of_the_slips(slip_study, candidates):
    working = WorkingModel(slip_study)
    working.look_at(candidates)
    assert (working.kinds, working.shape_left, working.seen) == ([], 1.0, None)
    chosen = choose(slip_study, working.model, working.baseline, candidates, working.cases, working.confirmed, {})
    assert working.take(chosen, {})
    assert working.kinds == ["velocity_weakening"]
    assert working.named[0].before.effects == ()
    assert working.shape_left < criteria.FORM_MISSES
    assert screen(working.baseline)[0].score < 0.1 * candidates[0].score


def test_an_effect_in_all_slips_is_not_put_down_to_chance(slip_study, candidates):
    details = {}
    assert before_effects(slip_study, candidates, details) is False
    assert not details["switching"]["regular"]


def test_a_slip_that_stands_far_out_is_left_out_and_many_are_not(slip_study):
    def with_far(count: int):
        features = slip_study.pool.features.copy()
        features[3 : 3 + count, 0] += 0.5 * slip_study.pool.static[0]
        return baseline_of(dataclasses.replace(slip_study.pool, features=features), slip_study.uncertainty)

    one, many = with_far(1), with_far(10)
    assert list(np.flatnonzero(one.pool.kept & ~without_accidents(one).pool.kept)) == [3]
    assert without_accidents(many) is many


def test_slips_that_keep_to_a_wave_are_simulated_as_such(slip_study, cases):
    # in a free run every slip is like the one before: waves are tried, and none fits better than weakening does
    for candidate, confirmed in entrained(slip_study, slip_study.model, cases):
        assert candidate.is_wave
        assert confirmed.n_parameters >= 3


def test_what_the_effect_leaves_is_less(slip_study, decision):
    left = left_over(slip_study.pool, decision.model, anew=True)
    before, after = (np.abs(p.features[:, 2:].mean(axis=0)).sum() for p in (slip_study.pool, left))
    assert after < 0.3 * before


def test_a_name_that_explains_stands_and_one_that_does_not_falls(slip_study, decision, recalibrated):
    answer = fitted(decision, slip_study, recalibrated)
    assert unexplained(slip_study, decision, recalibrated.model, answer.model) is None
    assert explaining(answer, slip_study, recalibrated) is answer
    idle = Answer(decision, answer.fit, recalibrated.model)  # the name without its effect
    poor = unexplained(slip_study, decision, recalibrated.model, idle.model)
    assert poor is not None
    assert poor.verdict == "unknown"


def test_a_name_is_held_against_each_part_of_the_evidence(slip_study, decision, recalibrated):
    answer = fitted(decision, slip_study, recalibrated)
    assert inadequate(slip_study, answer.model)[0] is None
    where, numbers = inadequate(slip_study, recalibrated.model)  # the name without its effect
    assert where is not None
    assert where.axis == "shape of the friction force within a slip"
    assert numbers["left"][1] > 0.5 * numbers["shown"][1]


def test_a_name_that_explains_the_shape_of_slips_does_not_stand_for_slips_that_differ(slip_study, decision, recalibrated):
    model = fitted(decision, slip_study, recalibrated).model
    pool = slip_study.pool
    features = pool.features.copy()
    features[::2, 0] += 0.02 * pool.static[::2]
    differing = dataclasses.replace(slip_study, pool=dataclasses.replace(pool, features=features))
    where, _ = inadequate(differing, model)
    assert where is not None
    assert where.axis == "time within the run"


def test_a_model_that_cannot_run_by_itself_is_no_answer(slip_study, decision, recalibrated):
    # a spring that softens without end holds nothing once the box is far out
    runaway = recalibrated.model.plus(make_effect("nonlinear_stiffness", cubic=-1.0e9))
    poor = unexplained(slip_study, decision, recalibrated.model, runaway)
    assert poor is not None
    assert poor.verdict == "unknown"
    assert "cannot run by itself" in poor.where.text


def test_the_belt_runs_as_stated_and_a_wrong_statement_is_seen(data, slip_study):
    assert belt_speed(slip_study) is None
    wrong = dataclasses.replace(
        data.scenario, mechanism=dataclasses.replace(data.scenario.mechanism, belt_velocity=1.05 * 2.5e-3)
    )
    seen = belt_speed(study(dataclasses.replace(data, scenario=wrong)))
    assert seen is not None
    assert seen.ratio == pytest.approx(1.0 / 1.05, rel=2e-3)
    assert seen.too_much


def test_stick_phases_of_a_rigid_contact_show_nothing(slip_study):
    sticking = analyse(slip_study.pool.slips)
    assert sticking is not None
    assert max(sticking.scores.values()) < 0.0


def test_no_step_of_the_sensor_is_seen_and_the_slips_stay_as_they_are(slip_study, candidates):
    assert seen_in_stick(candidates, {}) is None
    np.testing.assert_array_equal(steady(slip_study.baseline, candidates, []).features, slip_study.pool.features)


def test_no_known_force_tells_a_delay_which_can_be_taken_off_again(slip_study):
    assert not driven(slip_study)
    late = with_delay(slip_study.model, 2e-3)
    assert late.late == pytest.approx(2e-3)
    assert without_delay(late).effects == ()


def test_advice_and_notes_speak_of_this_experiment(data, slip_study, decision):
    assert {"dwell_ageing", "direction_asymmetry", "load_dependence"} <= set(not_identifiable(slip_study))
    assert "belt speed" in next_experiment(decision, slip_study)
    gap = Gap("crps_one_cycle", "m", True, 2e-5, 1e-5, 1.2e-5, 4e-6)
    details = decision.details | {"parameters": {"moved_beyond_uncertainty": {"mass": 3.2}}}
    sentences = notes(slip_study, dataclasses.replace(decision, details=details), slip_study.model, Gaps(gap), data)
    assert any("mass is 3.2 stated standard deviations" in note for note in sentences)
    assert any("off by more" in note for note in sentences)


@pytest.mark.parametrize(("left", "said"), [(0.75, False), (2.0, True)])
def test_a_name_that_leaves_more_than_noise_in_the_forces_of_slips_is_said_not_to_be_all(
    data, slip_study, decision, left, said
):
    forces = Gap("crps_slip_forces", "-", True, 28.0, 27.0, left, 0.56)
    details = decision.details | {"parameters": {"moved_beyond_uncertainty": {}}}
    details.pop("more_missing", None)
    named = dataclasses.replace(decision, details=details)
    assert named.named
    sentences = notes(slip_study, named, slip_study.model, Gaps(None, forces), data)
    assert any("more is missing" in note for note in sentences) is said


def test_a_law_that_is_elastic_takes_no_second_compliance(slip_study, monkeypatch):
    """The simulator has room for one: the second ended discovery with an error."""
    yielding = Finding("presliding_compliance", detected("stick", 1.0), {"elastic_limit": 1e-5, "damping_ratio": 0.05})
    monkeypatch.setattr("stochfric_mb.discovery.stick_slip.decision.kinematics._in_stick", lambda *_: [yielding])
    assert yielding in kinematics(slip_study, {})
    law = make_law("elastic_stick", mu_s=slip_study.model.law.mu_s, mu_k=slip_study.model.law.mu_k)
    elastic = dataclasses.replace(slip_study, model=dataclasses.replace(slip_study.model, law=law))
    where = kinematics(elastic, {})
    assert isinstance(where, Where)
    assert "elastic itself" in where.text


def test_advice_asks_for_nothing_that_the_record_has(slip_study, decision):
    nameless = dataclasses.replace(decision, verdict="unknown", named=(), where=Where("scatter", "x"))
    assert "a force sensor and a second belt speed and a second normal load" in next_experiment(nameless, slip_study)
    run = slip_study.dataset.fit[0]
    weighed = dataclasses.replace(run, channels={**run.channels, "force": run.channels["position"]})
    dataset = dataclasses.replace(slip_study.dataset, runs=(weighed, *slip_study.dataset.runs[1:]))
    both = dataclasses.replace(slip_study, dataset=dataset)
    assert "force sensor" not in next_experiment(nameless, both)
    assert any("force is read and not used" in note for note in of_the_record(both))
    elsewhere = dataclasses.replace(nameless, where=Where(OTHER_RIG, "x"))
    assert "weighing" in next_experiment(elsewhere, slip_study)


def test_a_run_without_slips_is_said_to_be_left_out(slip_study):
    still = dataclasses.replace(slip_study.records[0], name="still")
    said = of_the_record(dataclasses.replace(slip_study, records=(*slip_study.records, still)))
    assert [note for note in said if "not used" in note] == [
        "run still is not used: it holds fewer than 8 slips (a dead sensor, a rig at rest, or steady sliding)"
    ]


def test_what_would_have_been_named_is_small(slip_study):
    power = smallest(slip_study)
    assert 0.0 < power["velocity_weakening"] < 0.1  # of mu_s - mu_k, which is 0.34


def test_runs_that_hardly_slip_are_refused_with_what_they_need(data):
    short = dataclasses.replace(data, runs=tuple(r.between(-1.0, 4.0, name=r.name, role=r.role) for r in data.runs))
    assert study(short) is None
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
