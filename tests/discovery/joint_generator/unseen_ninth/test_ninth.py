"""The forms of the ninth set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks
from tests.discovery.joint_generator.bench import DESIGNS
from tests.discovery.joint_generator.plant import AREA_AT, FACTOR_AT, FACTOR_OF_TIME, FORCE_AT, GAIN_AT, PRESSURE

SERIES = series_checks.Series(9)
MADE_UP_FOR = {"constant_force.air_balancer": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def test_the_set_is_as_wide_as_asked_for():
    assert SERIES.counts() == (27, 8, 8, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    eighth = series_checks.Series(8)
    assert sorted(SERIES.kinds.values()) == sorted(eighth.kinds.values())
    cases = list(joint_plan.unseen_cases([91], 9))
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


@pytest.mark.parametrize("name", ["viscous_friction.film_heats_itself", "viscous_friction.paste_with_a_shoulder"])
def test_a_fluid_drags_more_the_faster_it_is_sheared(name):
    made = SERIES.short(name)
    plant = made.plant(0)
    drag = plant.by_speed[0][plant.speeds <= made.nominal.speed] / made.nominal.level
    assert np.all(np.diff(drag) > -1e-12)
    assert 0.6 < drag[-1] < 0.9


def test_a_shoe_draws_itself_in_one_way():
    made = SERIES.short("direction_asymmetry.leading_and_trailing_shoe")
    ways = sorted(float(row[0]) / made.nominal.level for row in made.plant(0).by_speed)
    assert ways == pytest.approx([1.0 / 1.36 - 1.0, 1.0 / 0.64 - 1.0])


def test_asperities_bear_less_the_thicker_the_film():
    made = SERIES.short("velocity_weakening.film_over_rough_surfaces")
    plant = made.plant(0)
    more = np.interp(made.nominal.speed * np.array([0.0, 0.1, 0.3, 1.0]), plant.speeds, plant.by_speed[0]) / made.nominal.level
    assert more[0] == pytest.approx(0.75)
    assert np.all(np.diff(more) < -0.05)
    assert more[-1] < 0.03


def test_a_sphere_that_ploughs_rubs_more_per_load_the_more_it_is_pressed():
    made = SERIES.short("load_dependence.sphere_ploughs")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    coefficient = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME]) / load
    for at in (0.5, 1.0, 1.8):
        assert coefficient[np.abs(load - at) < 0.02].mean() == pytest.approx(0.2 + 0.8 * np.sqrt(at), rel=0.02)


def test_rails_that_cross_are_looser_there_than_on_either_side():
    made = SERIES.short("position_dependent_friction.rails_cross")
    plant, reach = made.plant(0), made.nominal.reach
    place = made.effects[0].parameters["place"]
    beside, there, beyond = np.interp(place + 0.6 * reach * np.arange(-1.0, 2.0), plant.places, plant.by_place[FACTOR_AT])
    assert beside == pytest.approx(beyond, abs=1e-3)
    assert beside - there == pytest.approx(0.66, abs=3e-3)


def test_a_scissor_lift_is_hardest_to_push_where_it_lies_flat():
    made = SERIES.short("position_dependent_force.scissor_lift")
    plant, reach = made.plant(0), made.nominal.reach
    force = np.interp(reach * np.linspace(-1.0, 1.0, 41), plant.places, plant.by_place[FORCE_AT])  # against q
    assert np.all(np.diff(force) > 0.0)
    assert np.ptp(force) == pytest.approx(0.8 * made.nominal.level * (0.9 / np.sqrt(0.19) - 0.5 / np.sqrt(0.75)), rel=1e-3)


def test_a_diaphragm_keeps_its_area_within_its_cup():
    made = SERIES.short("effective_area.diaphragm_leaves_its_cup")
    plant, reach = made.plant(0), made.nominal.reach
    within, beyond = sorted(np.interp([-reach, reach], plant.places, plant.by_place[AREA_AT]))
    assert (within, beyond) == pytest.approx((1.0, 1.2), abs=1e-3)


def test_the_radius_of_a_drum_is_a_line_of_the_rope():
    made = SERIES.short("drive_gain_change.rope_winds_on_itself")
    plant, reach = made.plant(0), made.nominal.reach
    radius = 1.0 / np.interp([-reach, 0.0, reach], plant.places, plant.by_place[GAIN_AT])
    assert sorted(radius) == pytest.approx([0.65, 1.0, 1.35], abs=1e-3)


def test_a_beam_across_the_pivot_weighs_little_for_its_inertia():
    made = SERIES.short("payload.beam_across_the_pivot", design="hinge")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    inertia = (loaded["inertia"] - plain["inertia"]) / (n["mass"] * n["length"] ** 2)
    weight = (loaded["gravity"] - plain["gravity"]) / n["gravity"]
    assert 3.5 < inertia / weight < 5.0
    assert inertia > 0.4


def test_a_walk_between_two_walls_stays_there_and_remembers():
    made = SERIES.short("correlated_coefficients.walks_between_two_walls")
    off = np.concatenate([made.plant(i).by_stroke for i in range(20)]) - 1.0
    assert np.abs(off).max() <= 0.5 + 1e-12
    assert 0.4 < np.corrcoef(off[1:], off[:-1])[0, 1] < 0.9


def test_a_running_median_is_late_by_half_of_its_readings():
    made = SERIES.short("sensor_delay.running_median", design="slide")
    plain, shown = replace(made, effects=()).record(0), made.record(0)
    name, late = next(name for name in shown if name.startswith("position")), made.effects[0].parameters["delay"]
    t, begins = shown["time [s]"], shown["time [s]"] > 0.2

    def misses(delay: float) -> float:
        return float(np.std((shown[name] - np.interp(t - delay, t, plain[name]))[begins]))

    assert misses(late) < 0.2 * min(misses(0.5 * late), misses(1.5 * late))


def test_pauses_show_no_reading_before_its_time():
    made = SERIES.short("stale_samples.pauses_without_a_scale", design="slide")
    name = next(name for name in made.record(0) if name.startswith("position"))
    shown = made.record(0)[name]
    plain = replace(made, effects=()).record(0)[name]
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert 0.04 < held.max() / made.nominal.rate < 0.4
    assert 0.05 < np.mean(held > 0) < 0.5


def test_the_gauge_behind_a_capillary_shows_the_pressure_later():
    made = SERIES.short("unknown.gauge_behind_a_capillary")
    plant, record = made.plant(0), made.record(0)
    true = np.interp(record["time [s]"], plant.times, plant.by_time[PRESSURE])
    shown = record["pressure [Pa]"]
    off = [np.std(true[: true.size - n] - shown[n:]) for n in (0, round(0.15 * made.nominal.rate))]
    assert off[1] < off[0]
    assert made.nominal.numbers["area"] * off[0] > 0.5 * made.nominal.level


def test_a_meter_that_slews_shows_what_is_slow_and_no_step():
    made = SERIES.short("unknown.meter_slews", design="slide")
    plain, shown = replace(made, effects=()).record(0), made.record(0)
    name = next(name for name in shown if name.startswith(("force", "voltage")))
    fastest, step = made.effects[0].parameters["fastest"], 1.0 / made.nominal.rate
    noise = 0.5 * series_checks.drive_noise(made)
    assert np.abs(np.diff(shown[name])).max() < fastest * step + 8.0 * noise
    alike = np.abs(shown[name] - plain[name]) < 8.0 * noise
    assert 0.1 < np.mean(alike) < 0.95


def test_dead_reckoning_is_right_whenever_news_comes():
    made = SERIES.short("unknown.dead_reckoning", design="slide")
    plain, shown = replace(made, effects=()).record(0), made.record(0)
    name = next(name for name in shown if name.startswith("position"))
    right = np.flatnonzero(shown[name] == plain[name])
    assert np.median(np.diff(right[right > 50])) / made.nominal.rate == pytest.approx(0.09, abs=0.002)
    assert np.mean(np.diff(shown[name]) == 0.0) < 0.1


def test_a_tilted_base_turns_what_the_shoulder_means_and_nothing_else():
    made = SERIES.short("unknown.base_is_tilted")
    plain, shown = replace(made, effects=()).record(0), made.record(0)
    turned = {name: float(np.mean(shown[name] - plain[name])) for name in shown}
    assert {name for name, off in turned.items() if off} == {"shoulder_angle [rad]", "shoulder_target [rad]"}
    assert np.abs([off for off in turned.values() if off]) == pytest.approx([0.25, 0.25])


def test_a_cell_that_is_tared_anew_has_another_zero_in_each_run():
    made = SERIES.short("unknown.tared_anew", design="slide")
    plain = replace(made, effects=())
    name = next(name for name in made.record(0) if name.startswith(("force", "voltage")))
    zeros = [float(np.mean(made.record(i)[name] - plain.record(i)[name])) for i in range(4)]
    assert np.std(zeros) * made.nominal.gain > 0.2 * made.nominal.level
