"""The forms of the tenth set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import Case, Made
from tests.discovery.joint_generator.plant import (
    AREA_AT,
    FACTOR_AT,
    FACTOR_OF_TIME,
    FORCE_AT,
    FORCE_OF_TIME,
    GAIN_AT,
    PRESSURE,
    Array,
)

from .law import viscosity

SERIES = series_checks.Series(10)
MADE_UP_FOR = {"constant_force.null_of_the_servo_valve": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def column(made: Made, *begins: str) -> str:
    """Name of the first column that begins so."""
    return next(name for name in made.record(0) if name.startswith(begins))


def shown_and_plain(made: Made, *begins: str) -> tuple[Array, Array]:
    """A column with and without the effects."""
    name = column(made, *begins)
    return made.record(0)[name], replace(made, effects=()).record(0)[name]


def friction(name: str, run: int = 0) -> slider.RateAndState | thrown.Throw:
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    law = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, run))
    assert isinstance(drawn, slider.RateAndState | thrown.Throw)
    return drawn


def test_the_set_is_as_wide_as_asked_for():
    assert SERIES.counts() == (27, 8, 8, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    ninth = series_checks.Series(9)
    assert sorted(SERIES.kinds.values()) == sorted(ninth.kinds.values())
    cases = list(joint_plan.unseen_cases([1001], 10))
    assert {case.design for case in cases} == set(DESIGNS)
    assert {case.strength for case in cases} == {0.5, 1.0}
    assert {case.forms for case in cases} == {*SERIES.forms, *SERIES.pairs}


def test_no_earlier_form_has_the_name_of_one_of_these():
    assert not SERIES.repeated_names()


@pytest.mark.parametrize("name", SERIES.joints)
def test_a_record_is_finite_and_moved_at_half_strength(name):
    made = SERIES.short(name, strength=0.5)
    series_checks.assert_finite(made.record(0))
    off = made.effects[0].parameters.get(MADE_UP_FOR.get(name, ""), 0.0)
    assert max(series_checks.columns_moved(made), abs(off) / made.nominal.sensor.drive) > 3.0


@pytest.mark.parametrize("name", SERIES.undriven)
def test_sliders_and_throws_are_finite_and_moved_at_half_strength(name):
    series_checks.assert_finite(SERIES.shown(name, strength=0.5))
    if SERIES.kinds[name] != "none":
        assert series_checks.undriven_moved(SERIES, name, strength=0.5) > 5.0


@pytest.mark.parametrize("name", SERIES.nulls)
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)


@pytest.mark.parametrize("name", SERIES.forms)
def test_the_same_seed_gives_the_same_record(name):
    if name in SERIES.undriven:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    else:
        series_checks.assert_same(SERIES.short(name).record(0), SERIES.short(name).record(0))


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [("viscous_friction.bearing_catalogue", 0.5, 0.75), ("viscous_friction.slurry_breaks_up", 0.4, 0.75)],
)
def test_a_film_drags_more_the_faster_it_is_sheared_and_less_than_in_proportion(name, least, most):
    made = SERIES.short(name)
    plant = made.plant(0)
    drag = plant.by_speed[0][plant.speeds <= made.nominal.speed] / made.nominal.level
    assert np.all(np.diff(drag) > 0.0)
    assert drag[-1] == pytest.approx(0.9, rel=5e-3)
    assert least < np.interp(0.4, np.linspace(0.0, 1.0, drag.size), drag) / 0.9 < most


def test_a_seal_falls_off_with_the_root_of_the_speed():
    made = SERIES.short("velocity_weakening.seal_of_a_cylinder")
    plant, knee = made.plant(0), made.effects[0].parameters["knee"]
    more = np.interp(knee * np.array([0.0, 1.0, 4.0]), plant.speeds, plant.by_speed[0]) / made.nominal.level
    assert more == pytest.approx([1.0, np.exp(-1.0), np.exp(-2.0)], rel=1e-3)


def test_a_damper_is_digressive_one_way_and_progressive_the_other_way():
    made = SERIES.short("direction_asymmetry.digressive_and_progressive")
    plant, speed = made.plant(0), made.nominal.speed
    half, whole = (sorted(float(np.interp(u * speed, plant.speeds, row)) for row in plant.by_speed) for u in (0.5, 1.0))
    assert np.array(half) / made.nominal.level == pytest.approx([1.1 * 0.25, 1.1 * np.sqrt(0.5)], rel=1e-3)
    assert whole[0] == pytest.approx(whole[1], rel=1e-3)


def test_an_orifice_is_a_line_at_first_and_the_square_in_the_end():
    made = SERIES.short("quadratic_damping.laminar_to_turbulent")
    plant = made.plant(0)
    drag = np.interp(made.nominal.speed * np.array([0.01, 0.02, 0.5, 1.0]), plant.speeds, plant.by_speed[0])
    assert drag[1] / drag[0] == pytest.approx(2.0, rel=0.02)
    assert 3.7 < drag[3] / drag[2] < 4.0


def test_a_preloaded_carriage_rubs_less_per_load_the_more_it_is_pressed():
    made = SERIES.short("load_dependence.preloaded_carriage")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    factor, preload = (
        np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME]),
        made.effects[0].parameters["preload"],
    )
    assert np.ptp(load) > 0.8
    np.testing.assert_allclose(factor, np.sqrt((preload**2 + load**2) / (preload**2 + 1.0)), rtol=0.01)


def test_a_thermostat_overshoots_by_four_tenths():
    made = SERIES.short("friction_drift.thermostat_overshoots")
    plant, period = made.plant(0), made.effects[0].parameters["period"]
    first = 0.5 * period / np.sqrt(1.0 - 0.25**2)
    assert plant.by_time[FACTOR_OF_TIME][0] == pytest.approx(1.0)
    overshoot = np.exp(-0.25 * np.pi / np.sqrt(1.0 - 0.25**2))
    least = np.interp(first, plant.times, plant.by_time[FACTOR_OF_TIME])
    assert least == pytest.approx(1.0 - 0.42 * (1.0 + overshoot), abs=1e-3)


def test_a_soil_has_half_of_what_it_gains_after_its_way():
    law, case = friction("distance_drift.hyperbola_of_a_soil"), Case("distance_drift.hyperbola_of_a_soil", "slider", 1.0, 7)
    half = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).parameters["half"]
    gained = law.added(np.zeros(3), half * np.array([0.0, 1.0, 3.0]))
    assert gained == pytest.approx([0.0, 0.0175, 0.02625])


def test_an_oil_has_the_viscosities_of_its_grade():
    assert viscosity(np.array([40.0, 100.0])) == pytest.approx([150.0, 15.0])
    made = SERIES.short("temperature_drift.oil_by_its_grade")
    plant, record = replace(made, nominal=replace(made.nominal, duration=12.0)).plant(0), made.record(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    law = 1.0 + 0.75 * (viscosity(record["temperature [degC]"]) / viscosity(np.full(1, 28.0)) - 1.0)
    np.testing.assert_allclose(factor, law, rtol=0.02)


def test_a_wrench_sets_another_friction_for_each_run_and_the_believed_one_in_the_mean():
    made = SERIES.short("random_coefficients.gib_set_by_a_wrench")
    level = np.array([made.plant(i).by_time[FACTOR_OF_TIME] for i in range(200)])
    assert np.all(np.ptp(level, axis=1) == 0.0)
    assert level[:, 0].mean() == pytest.approx(1.0, abs=0.05)
    assert 0.15 < level[:, 0].std() < 0.3


def test_dust_makes_no_slide_smoother():
    mu = np.array([friction("random_coefficients.dust_only_adds", i).mu(1.0, 0.0) for i in range(300)])
    assert mu.min() == pytest.approx(0.24, abs=0.002)
    assert mu.mean() == pytest.approx(0.24 * (1.0 + 0.4 * np.sqrt(2.0 / np.pi)), rel=0.03)


def test_a_pelted_pendulum_swings_over_a_dozen_strokes():
    made = SERIES.short("correlated_coefficients.pelted_pendulum")
    off = np.concatenate([made.plant(i).by_stroke for i in range(30)]) - 1.0
    one, two, six = (np.corrcoef(off[k:], off[:-k])[0, 1] for k in (1, 2, 6))
    assert off.std() == pytest.approx(0.35, rel=0.1)
    assert (one, two) == pytest.approx((1.3 / 1.55, 1.69 / 1.55 - 0.55), abs=0.06)
    assert six < 0.0


def test_contacts_at_rest_grow_older_as_the_root_of_time():
    law = friction("frictional_lag.heals_as_the_root")
    (distance,), theta, step = law.distance, 10.0, 1e-3
    begun = theta
    for _ in range(5000):
        theta += step * law.state(theta, 0.0, distance)
    assert theta**2 - begun**2 == pytest.approx(2.0 * 5.0 * distance / slider.V_0, rel=1e-3)
    assert law.state(distance / slider.V_0, slider.V_0, distance) == pytest.approx(0.0)


def test_covers_are_drawn_along_one_by_one():
    made = SERIES.short("position_dependent_friction.telescopic_covers")
    plant, reach = made.plant(0), made.nominal.reach
    factor = np.interp(reach * np.array([-0.8, -0.225, 0.225, 0.8]), plant.places, plant.by_place[FACTOR_AT])
    assert sorted(factor) == pytest.approx([0.325, 0.775, 1.225, 1.675], abs=0.02)


def test_a_table_is_roughest_at_its_ridge():
    mu = friction("position_dependent_friction.ridge_of_varnish").mu
    assert [mu(1.0, x) for x in (0.0, 0.075, 0.11, 0.145, 0.3)] == pytest.approx([0.25, 0.3875, 0.525, 0.3875, 0.25])


def test_hoses_pull_back_from_either_end():
    made = SERIES.short("position_dependent_force.dress_pack")
    plant, reach = made.plant(0), made.nominal.reach
    back, middle, end = (
        np.interp(reach * np.array([-1.0, 0.0, 1.0]), plant.places, plant.by_place[FORCE_AT]) / made.nominal.level
    )
    assert max(end, -back) == pytest.approx(1.2, rel=5e-3)
    assert 0.5 < min(end, -back) < 0.85
    assert abs(middle) < 0.06


def test_each_stage_of_a_cylinder_has_an_area_of_its_own():
    made = SERIES.short("effective_area.telescopic_cylinder")
    plant, reach = made.plant(0), made.nominal.reach
    areas = np.interp(reach * np.array([-0.8, 0.0, 0.8]), plant.places, plant.by_place[AREA_AT])
    assert sorted(areas) == pytest.approx([0.86, 1.0, 1.14], abs=1e-3)


def test_a_yoke_gives_as_much_in_the_mean_as_is_stated_and_most_at_its_ends():
    made = SERIES.short("drive_gain_change.crank_and_yoke")
    plant, reach = made.plant(0), made.nominal.reach
    gain = np.interp(reach * np.linspace(-1.0, 1.0, 2001), plant.places, plant.by_place[GAIN_AT])
    assert gain.mean() == pytest.approx(1.0, abs=2e-3)
    assert gain[-1] / gain[1000] == pytest.approx(1.0 / np.sqrt(0.34), rel=1e-3)


def test_a_block_at_the_elbow_burdens_the_shoulder_alone():
    made = SERIES.short("payload.valve_block_at_the_elbow")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    assert {name for name in loaded if loaded[name] != plain[name]} == {"inertia", "gravity"}
    mass = (loaded["inertia"] - plain["inertia"]) / n["l1"] ** 2
    assert mass == pytest.approx((loaded["gravity"] - plain["gravity"]) / (9.81 * n["l1"]))
    assert 0.7 < mass / n["m1"] < 0.9


def test_a_cutter_pushes_without_a_mean_and_leaves_the_cut_at_once():
    made = SERIES.short("harmonic_force.milling_cutter")
    plant, size = made.plant(0), 0.8 * made.nominal.level
    force = plant.by_time[FORCE_OF_TIME] / size
    whole = round(round(3.0 * made.effects[0].parameters["frequency"]) / made.effects[0].parameters["frequency"] * 1000.0)
    assert force[:whole].mean() == pytest.approx(0.0, abs=0.01)
    assert np.diff(force).min() == pytest.approx(-np.sin(1.9), abs=0.03)


def test_a_polygon_is_late_by_a_whole_cycle():
    made = SERIES.short("sensor_delay.polygon_of_the_last_cycle", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = made.record(0)["time [s]"], made.effects[0].parameters["delay"]
    begins = t > 0.2

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.2 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_dirt_holds_the_last_reading_and_no_later_one():
    made = SERIES.short("stale_samples.dirt_on_the_scale", design="slide")
    shown, plain = shown_and_plain(made, "position")
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert 0.02 < held.max() / made.nominal.rate < 1.0
    assert 0.05 < np.mean(held > 0) < 0.4


def test_a_spark_goes_to_one_side_and_then_to_the_other():
    made = SERIES.short("sensor_outliers.sparks_of_a_contactor", design="slide")
    shown, plain = shown_and_plain(made, "position")
    off = (shown - plain) / made.effects[0].parameters["size"]
    hit = np.flatnonzero(np.abs(off) > 0.1)
    assert 5 < hit.size < 0.02 * off.size
    assert off[hit[1]] == pytest.approx(-0.8 * off[hit[0]])


def test_a_valve_shuts_at_other_times_in_each_run():
    made = SERIES.short("unknown.water_hammer")
    forces = [made.plant(i).by_time[FORCE_OF_TIME] / made.nominal.level for i in range(2)]
    begins = [np.flatnonzero(np.abs(np.diff(force)) > 1.0) for force in forces]
    assert all(1 <= begin.size <= 2 for begin in begins)
    assert begins[0][0] != begins[1][0]
    for force, begin in zip(forces, begins, strict=True):
        assert np.abs(force).max() == pytest.approx(1.6, rel=0.1)
        assert not np.any(force[: begin[0]])


def test_an_encoder_behind_a_soft_coupling_rings_at_its_tone():
    made = SERIES.short("unknown.encoder_on_a_soft_coupling", design="slide")
    shown, plain = shown_and_plain(made, "position")
    frequency, n = made.effects[0].parameters["frequency"], shown.size
    gain = np.abs(np.fft.rfft((shown - shown.mean()) * np.hanning(n))) / np.abs(
        np.fft.rfft((plain - plain.mean()) * np.hanning(n))
    )
    tones = np.fft.rfftfreq(n, 1.0 / made.nominal.rate)
    assert gain[np.abs(tones - frequency) < 0.3].max() > 3.0
    assert gain[(tones > 0.2) & (tones < 0.2 * frequency)].mean() == pytest.approx(1.0, abs=0.15)


def test_a_gauge_shows_no_pressure_beyond_its_range():
    made = SERIES.short("unknown.gauge_ends_too_early")
    plant, record, top = made.plant(0), made.record(0), made.effects[0].parameters["top"]
    true = np.interp(record["time [s]"], plant.times, plant.by_time[PRESSURE])
    shown = record["pressure [Pa]"]
    assert shown.max() < 1.006 * top
    beyond = true > 1.01 * top
    assert 0.1 < beyond.mean() < 0.7
    np.testing.assert_allclose(shown[~beyond], true[~beyond], rtol=0.011)
    assert made.nominal.numbers["area"] * (true.max() - top) > made.nominal.level


def test_a_camera_shows_one_end_further_away_than_the_other():
    made = SERIES.short("unknown.camera_looks_aslant", design="slide")
    shown, plain = shown_and_plain(made, "position")
    slant = made.effects[0].parameters["slant"]
    np.testing.assert_allclose(shown, plain / (1.0 + slant * plain / made.nominal.reach), atol=1e-12)
    assert abs(slant) == pytest.approx(0.35)


def test_a_throttle_is_turned_round_in_some_runs():
    made = SERIES.short("unknown.mounted_the_other_way_round")
    ways = [np.argmax(made.plant(i).by_speed[:, 2000]) for i in range(6)]
    assert set(ways) == {0, 1}
    assert sorted(made.plant(0).by_speed[:, 1000] / made.nominal.level) == pytest.approx([0.13, 1.3], rel=1e-3)


def test_positions_of_a_queue_are_later_and_later():
    made = SERIES.short("unknown.queue_grows", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t = made.record(0)["time [s]"]
    np.testing.assert_allclose(shown, np.interp(t - 0.09 * t / t[-1], t, plain), atol=1e-9)


def test_a_longer_forearm_weighs_by_the_ratio_and_turns_by_its_square():
    made = SERIES.short("unknown.forearm_is_longer")
    plain, longer = made.plant(0, with_effects=False).body, made.plant(0).body
    ratio = {name: longer[name] / plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    assert list(ratio.values()) == pytest.approx([1.0, 1.5625, 1.25, 1.0, 1.25])


def test_slides_of_a_block_that_turns_begin_apart_and_end_alike():
    mus = [friction("unknown.turns_into_its_way", i).mu for i in range(40)]
    assert np.std([mu(1.0, 0.0) for mu in mus]) > 0.1
    assert np.std([mu(1.0, 0.35) for mu in mus]) < 0.01
