"""What held-out runs do not bear out is not named."""

from __future__ import annotations

import dataclasses

import pytest

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.inference.false_alarms import Evidence
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip import workflow
from stochfric_mb.discovery.stick_slip.decision.decision import Named
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.validation import answers
from stochfric_mb.discovery.stick_slip.validation.held_out_check import Comparison, compared
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from tests.discovery.test_discover import plain
from tests.discovery.unseen_forms.records import cases as unseen_cases
from tests.discovery.unseen_forms.records import write_record

BOGUS = make_effect("harmonic_force", amplitude=0.5, frequency=0.3)


def test_an_effect_that_worsens_forecasts_of_held_out_runs_is_not_named(monkeypatch):
    """The null case, with a force of 0.5 N put into the decision and left as it is by the refit."""
    decide = workflow.decide

    def misled(*arguments, **options):
        decision = decide(*arguments, **options)
        named = (Named("harmonic_force", (), Evidence(100.0, None), Where("time", "a force")),)
        return dataclasses.replace(decision, verdict="effect", named=named, model=decision.model.plus(BOGUS))

    def unfitted(decision, slip_study, recalibrated):
        return dataclasses.replace(recalibrated, model=recalibrated.model.plus(BOGUS))

    monkeypatch.setattr(workflow, "decide", misled)
    monkeypatch.setattr(answers, "_fit", unfitted)
    monkeypatch.setattr(answers, "unexplained", lambda *_: None)  # it, too, would refuse the force
    result = discover(plain()).result
    assert result.verdict == "none"
    assert not result.effects
    assert any("harmonic_force is not validated on the held-out runs" in note for note in result.notes)
    assert result.gap.augmented == result.gap.recalibrated  # nothing of it is left in the model


@pytest.mark.parametrize(
    ("comparison", "worse"),
    [
        (Comparison(5e-6, 5.01e-6, 1e-7, 4.9e-6), False),  # by chance
        (Comparison(5e-6, 5.3e-6, 1e-7, 4.9e-6), True),  # three standard errors
        (Comparison(5e-6, 9e-6, 4e-6, 4.9e-6), True),  # far off, a single forecast may be to blame
        (Comparison(5e-6, 9e-6, 4e-6, 9e-6, most_better=True), False),  # one slip is missed, the others are better
        (Comparison(5e-6, 9e-6, 1e-6, 9e-6, most_better=True), True),  # no chance: four standard errors
        (Comparison(5e-6, 5.01e-6, 1e-7, 4e-6), True),  # a fifth to gain, and nothing gained
        (Comparison(5e-6, 4.0e-6, 1e-9, 1e-6), False),
    ],
)
def test_when_an_effect_makes_forecasts_worse(comparison, worse):
    assert comparison.worse is worse


def test_when_an_effect_makes_forecasts_better():
    assert Comparison(5e-6, 4.7e-6, 1e-7, 4e-6).better  # three standard errors
    assert not Comparison(5e-6, 4.9e-6, 1e-7, 4e-6).better  # by chance


def test_the_last_of_a_kind_is_taken_out_with_its_own_numbers():
    first, second = (
        make_effect("backlash", gap=1e-5, position=1e-3),
        make_effect("harmonic_force", amplitude=0.1, frequency=1.0),
    )
    model = workflow.Model(
        law=None, corrections={}, effects=(first, second, first), own={"a": ({}, {"phase": 1.0}, {"x": 2.0})}
    )
    fewer = model.without_last("backlash")
    assert fewer.effects == (first, second)
    assert fewer.own == {"a": ({}, {"phase": 1.0})}


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        # slips of one run keep to the wave, which that run tells nothing of: its size was 543 N beside 25 N of load
        ("fifth_force_of_a_quick_return-several-1", ["harmonic_force"]),
        # a wave knows when the box breaks away whatever its start, and the 12 forecasts of a fit cannot tell its frequency
        ("fifth_weakening_by_a_power-one-1", ["velocity_weakening"]),
        ("fifth_weakening_by_a_power-one-0.5", ["velocity_weakening"]),
        ("fourth_noise_and_hum-one-1", []),  # hum of the sensor, a ripple of the belt in stick, is in the slips as well
        ("fifth_waves_travel-several-1", []),  # scatter beside it hid that the effect makes forecasts worse
        # the ripple is nearly all of what counts as slow noise, which favoured its third harmonic
        ("fourth_belt_of_elliptical_gears-several-1", ["belt_speed_ripple"]),
        ("fourth_quantised-several-1", []),  # rounding, alike in slips that are alike, was a contact that yields
        ("fourth_impacts_in_clusters-several-1", ["impacts"]),  # three slips of 125, and forecasts 50 times off
        ("sixth_gauge_leaks-one-1", []),  # mu_k would be 7 stated deviations off
        ("fourth_zero_wanders-one-1", []),  # by less than a reading errs
        ("fourth_delay_of_an_all_pass-one-0.5", ["sensor_delay"]),  # measured behind a velocity: forecasts show nothing of it
        # marks say little of where to begin: one start ended at a misfit of 7500, others at 4
        ("seventh_mode_of_a_liquid_column-one-1", ["second_mode"]),
        ("seventh_weakening_cubic_step-one-0.5", ["velocity_weakening"]),  # the same, and the damping that imitates it best
        ("seventh_spring_levels_itself-one-1", []),  # the drift named made predicted forces of held-out slips worse
        # a gain of the sensor that ripples moves stick and forces at once: the belt's ripple made predicted forces worse
        ("seventh_supply_of_the_bridge_sways-one-0.5", []),
        # the sensor's zero drifts faster than in the middle of a record at its end: no step, though it looks like one
        ("seventh_drift_of_a_sunny_stand-several-1", ["sensor_drift"]),
        # a zero within a reading's error: a ripple that is 4 % of the noise, then scatter
        ("eighth_zero_wanders-several-1", []),
        # of three tones the second takes out less than half of what is left, as it should
        ("eighth_force_of_a_planet_gear-several-1", ["harmonic_force"]),
        # half of a wave: compared as sines, friction of a load that ripples imitated the overtones better
        ("seventh_force_of_a_feeder-one-0.5", ["harmonic_force"]),
        # the run has its step in the half that a ripple's phase takes; the ripple was refused, the step went with it
        ("ninth_step_by_hand-one-1", ["sensor_step"]),
        # slips that stand out by more force at the break-away alone: no kick is always there in time to hold a box back
        ("eighth_scatter_of_first_passages-several-1", ["random_coefficients"]),
        # each run's step was looked for alone, with levels that lie between those of the others
        ("ninth_step_by_hand-several-1", ["sensor_step"]),
        ("eighth_step_that_is_put_right-several-1", ["sensor_step"]),  # what one step leaves of two was scatter
        ("eighth_outliers_that_ring-one-1", ["sensor_outliers"]),  # four in a row were motion
        ("ninth_arm_grows_by_friction-one-0.5", ["sensor_drift"]),  # the reading drifts in stick, where no friction acts
        ("tenth_probe_is_overcompensated-one-0.5", []),  # a contact that gives way, to stick; forecasts show 7 % of it
        ("twelfth_belt_of_a_geneva_wheel-one-1", ["belt_speed_ripple"]),  # all but its first tone was slow noise of the sensor
        ("twelfth_clipping_of_a_transformer-one-1", ["sensor_clipping"]),  # it leaves a tenth, "none" would leave less
        ("twelfth_delay_of_a_long_cable-one-1", ["sensor_delay"]),  # two channels show it, and forecasts something else besides
        ("thirteenth_clipping_of_a_core-one-1", ["sensor_clipping"]),  # a reading that bends over was creep, or a slow belt
        ("ninth_gauge_has_hysteresis-one-0.5", []),  # alike in every phase, which a ripple at the rate of the slips imitates
    ],
)
def test_records_on_which_an_answer_broke_a_principle(name, kinds, tmp_path):
    case = next(c for c in unseen_cases() if c.name == name)
    write_record(case, tmp_path / name, 31)
    assert [e.kind for e in discover(tmp_path / name / "data").result.effects] == kinds


@pytest.mark.parametrize(
    ("name", "verdict"),
    [
        ("thirteenth_noise_of_traps-one-1", "none"),  # a zero that moves by half of what a reading errs was a step
        ("thirteenth_clock_has_a_spur-one-1", "none"),  # noise of fast motion alone, which no forecast feels, was missing
        ("thirteenth_motor_makes_a_part_of_the_spring-one-0.5", "unknown"),  # jumps said ten times what the name explained
        ("fourteenth_valve_shuts_in_each_slip-one-1", "unknown"),  # a cubic spring of 1e-5 of the force left the stiffness open
    ],
)
def test_what_is_noise_is_none_and_a_name_says_more_than_what_it_leaves(name, verdict, tmp_path):
    case = next(c for c in unseen_cases() if c.name == name)
    write_record(case, tmp_path / name, 10 * case.form.series + 1)
    assert discover(tmp_path / name / "data").result.verdict == verdict


def test_nothing_is_compared_where_no_run_is_held_out():
    """Of a contact that yields no held-out slip could be read: it ended in a traceback."""
    model = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {})
    assert compared(model, model, HeldOut((), (), ())) is None
