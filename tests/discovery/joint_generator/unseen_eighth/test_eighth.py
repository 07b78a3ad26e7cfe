"""The forms of the eighth set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks
from tests.discovery.joint_generator.bench import DESIGNS
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_AT

SERIES = series_checks.Series(8)
MADE_UP_FOR = {"constant_force.rod_on_one_side": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def test_the_set_is_as_wide_as_asked_for():
    assert SERIES.counts() == (27, 8, 8, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    cases = list(joint_plan.unseen_cases([81], 8))
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


def test_a_rubber_cord_pulls_to_one_side_more_the_further_it_is_drawn():
    made = SERIES.short("position_dependent_force.rubber_cord")
    plant, reach = made.plant(0), made.nominal.reach
    force = np.interp(reach * np.linspace(-1.0, 1.0, 41), plant.places, plant.by_place[FORCE_AT])  # against q
    assert np.all(np.diff(force) > 0.0)
    assert np.ptp(force) == pytest.approx(0.9 * made.nominal.level * (0.85 + 1.15**-2 - 2.0**-2), rel=1e-3)


def test_a_rolling_lobe_has_two_areas():
    made = SERIES.short("effective_area.rolling_lobe")
    plant, reach = made.plant(0), made.nominal.reach
    ends = np.interp([-reach, reach], plant.places, plant.by_place[AREA_AT])
    assert sorted(ends) == pytest.approx([0.9, 1.1], abs=1e-9)


def test_pauses_after_a_collision_show_no_reading_before_its_time():
    made = SERIES.short("stale_samples.backs_off_after_collisions", design="slide")
    name = next(name for name in made.record(0) if name.startswith("position"))
    shown = made.record(0)[name]
    plain = replace(made, effects=()).record(0)[name]
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert 0.04 < held.max() / made.nominal.rate < 0.2


def test_packets_that_overtake_each_other_lose_no_row():
    made = SERIES.short("unknown.packets_out_of_order")
    plain = replace(made, effects=()).record(0)
    for name, x in made.record(0).items():
        np.testing.assert_array_equal(np.sort(x), np.sort(plain[name]))
