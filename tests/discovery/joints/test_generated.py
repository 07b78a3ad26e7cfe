"""Cases of the joint generator that stood for a group of misses, named now."""

import pytest

from stochfric_mb.discovery.driven_joint.joint_workflow import joint_outcome
from stochfric_mb.measurement import load_dataset
from tests.discovery.joint_generator.case import Case, write

pytestmark = pytest.mark.slow

CASES = [
    ("harmonic_force.rotating_unbalance", "slide", 0.5, ["harmonic_force"]),
    ("harmonic_force.floor_vibration", "arm", 1.0, ["harmonic_force"]),
    ("sensor_delay.one_late_encoder", "arm", 1.0, ["sensor_delay"]),
    ("stale_samples.repeated", "slide", 0.5, ["stale_samples"]),
    ("sensor_outliers.spikes", "mjcf_hinge", 1.0, ["sensor_outliers"]),
    ("frictional_lag.slip_law", "slider", 1.0, ["frictional_lag"]),
    ("viscous_friction.logarithmic", "slider", 0.5, ["viscous_friction"]),
    ("direction_asymmetry.viscous_part", "slide", 1.0, ["direction_asymmetry", "viscous_friction"]),
    ("position_dependent_force.effective_area", "slide", 0.5, ["effective_area"]),
    ("unknown.bore_with_a_step", "slide", 1.0, ["effective_area"]),
    ("drive_gain_change.fading_magnets", "hinge", 0.5, ["drive_gain_change"]),
    ("direction_asymmetry.slanted_dimples", "mjcf_hinge", 1.0, ["direction_asymmetry"]),
    ("sensor_delay.dead_time_and_lag", "slide", 1.0, ["sensor_delay"]),
]
"""Form, mechanism, strength, and what is named first."""


def answered(form, design, strength, tmp_path, seed=0):
    write(Case(form, design, strength, seed), tmp_path / "set", tmp_path / "truth.json")
    return joint_outcome(load_dataset(tmp_path / "set")).result


@pytest.mark.parametrize(("form", "design", "strength", "kinds"), CASES)
def test_what_was_a_delay_a_scatter_or_nothing_has_its_name(form, design, strength, kinds, tmp_path):
    result = answered(form, design, strength, tmp_path)
    assert [e.kind for e in result.effects] == kinds
    assert all(e.p_value is None or 0.0 <= e.p_value <= 1.0 for e in result.effects)


@pytest.mark.parametrize(
    ("form", "design", "seed", "kinds"),
    [
        ("none.encoder_smooths", "arm", 31, []),
        ("none.resampled_by_a_spline", "mjcf_slide", 1401, []),  # 500 Hz at 2 kHz: no noise between samples, so short windows
        ("correlated_coefficients.debris_from_stroke_to_stroke", "mjcf_hinge", 61, ["random_coefficients"]),
        ("stale_samples.token_goes_round", "hinge", 61, ["stale_samples"]),
        ("friction_drift.thermostat_overshoots", "mjcf_slide", 1001, ["friction_drift"]),
        ("distance_drift.grooves_stroke_by_stroke", "mjcf_hinge", 1101, ["friction_drift"]),  # a second drift mends 1 % of it
        ("sensor_delay.averages_and_then_sends", "mjcf_slide", 1101, ["sensor_delay", "joint_compliance"]),  # 25 ms at 2 kHz
        ("load_dependence.soft_liner_shears", "slide", 1301, ["load_dependence"]),  # no power: level from one load on
        ("harmonic_force.splice_of_a_belt_passes", "mjcf_slide", 1401, ["harmonic_force"]),  # a pulse a turn is no sine
    ],
)
def test_what_broke_a_principle_is_what_it_is(form, design, seed, kinds, tmp_path):
    result = answered(form, design, 1.0, tmp_path, seed)
    assert [e.kind for e in result.effects] == kinds
    assert result.verdict == ("effect" if kinds else "none")


@pytest.mark.parametrize(
    ("form", "design", "seed", "why"),
    [
        # a mass and viscous friction that forward simulation liked, and that explained 14 % of the held-out balance
        ("unknown.cutter_meets_its_last_pass", "mjcf_slide", 1401, "explains the fit runs, but not the held-out ones"),
        # damping by speed and a drift in time, which went together: beside the scatter between runs they stood
        ("unknown.ball_begins_to_roll", "thrown", 1301, "one curve, and not named"),
    ],
)
def test_what_explains_no_held_out_balance_or_takes_two_names_for_one_curve_is_unknown(form, design, seed, why, tmp_path):
    result = answered(form, design, 0.5, tmp_path, seed)
    assert result.verdict == "unknown"
    assert any(why in note for note in result.notes)


def test_a_reading_at_the_end_of_the_scale_is_told_though_its_windows_turn_round(tmp_path):
    result = answered("sensor_outliers.wiper_lifts", "slide", 0.5, tmp_path, 1301)
    assert [e.kind for e in result.effects] == ["sensor_outliers"]
    assert result.gap.metric == "inverse_dynamics_sliding"  # no simulation reads a sensor
    assert result.gap.closed > 0.99
