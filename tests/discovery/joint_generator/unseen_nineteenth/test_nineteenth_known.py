"""The forms of the nineteenth set with an effect of the vocabulary give finite records that they move; nulls move nothing."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.discovery.joint_generator import series_checks
from tests.discovery.joint_generator.case import Made
from tests.discovery.joint_generator.plant import AREA_AT, FACTOR_AT, FACTOR_OF_TIME, FORCE_AT, GAIN_AT, Array
from tests.discovery.joint_generator.unseen_eighteenth.test_eighteenth_known import lasting
from tests.discovery.joint_generator.unseen_fourteenth import test_fourteenth as shapes

from .law import remembered

SERIES = series_checks.Series(19)
MADE_UP_FOR = {"constant_force.rolled_band_pulls_evenly": "size"}
"""What the controller makes up for, and is seen against what is believed."""
OWN = {name: form for name, form in SERIES.forms.items() if not form.draw.__module__.endswith("nameless")}
KNOWN = [name for name in OWN if SERIES.kinds[name] != "none"]
JOINTS = [name for name in (*KNOWN, *SERIES.pairs) if name in SERIES.joints]
UNDRIVEN = [name for name in OWN if name in SERIES.undriven]


def sliding(name: str, design: str | None = None) -> tuple[Made, Array, Array]:
    """A usual run, its states, and where it slides: quick, and not within 20 ms of being slow."""
    made = lasting(SERIES.short(name, design=design), 12.0)
    states, _ = made.states(0)
    near = np.ones(2 * round(0.02 * made.nominal.rate) + 1)
    slow = np.abs(states[:, 2]) < 0.05 * made.nominal.speed
    return made, states, np.convolve(slow, near, "same") < 0.5


def test_the_set_is_as_wide_as_asked_for():
    assert (len(KNOWN), len(OWN) - len(KNOWN), len(SERIES.pairs)) == (27, 10, 4)
    assert not SERIES.misplaced() & OWN.keys()
    assert not OWN.keys() & set(SERIES.unsourced())
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}
    sixteenth = [kind for kind in series_checks.Series(16).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(SERIES.kinds[name] for name in KNOWN) == sorted(sixteenth)
    for one, other in ([SERIES.forms[part] for part in pair.split("+")] for pair in SERIES.pairs):
        assert one.kind not in {other.kind, *other.also}
        assert other.kind not in one.also


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_at_half_strength_and_more_at_full(name):
    made, full = SERIES.short(name, strength=0.5), lasting(SERIES.short(name), 12.0)
    series_checks.assert_finite(made.record(0))
    off = made.effects[0].parameters.get(MADE_UP_FOR.get(name, ""), 0.0)
    assert max(series_checks.columns_moved(made), abs(off) / made.nominal.sensor.drive) > 5.0
    assert name in MADE_UP_FOR or series_checks.columns_moved(full) > 10.0


@pytest.mark.parametrize("name", UNDRIVEN)
def test_thrown_and_slider_are_finite_moved_and_repeatable(name):
    series_checks.assert_finite(SERIES.shown(name, strength=0.5))
    series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    moved = series_checks.undriven_moved(SERIES, name, strength=0.5)
    assert moved == 0.0 if SERIES.kinds[name] == "none" else moved > 5.0
    assert SERIES.shown(name)["time [s]"].size > 50


@pytest.mark.parametrize("name", [name for name in OWN if name in SERIES.nulls])
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)
    assert 200.0 <= made.nominal.rate <= 5000.0


@pytest.mark.parametrize("name", [name for name in OWN if name not in SERIES.undriven])
def test_the_same_seed_gives_the_same_record_and_no_strength_is_no_effect(name):
    made, none = lasting(SERIES.short(name), 1.5), lasting(SERIES.short(name, strength=0.0), 1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    if name in KNOWN:
        shown, plain = none.record(0), replace(none, effects=()).record(0)
        series_checks.assert_same({column: shown[column] for column in plain}, plain)


@pytest.mark.parametrize("name", [name for name in KNOWN if "slide" in OWN[name].designs])
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    states, _ = made.states(0)
    assert np.all((states[:, 6] * states[:, 2])[np.abs(states[:, 2]) > 0.05 * made.nominal.speed] > 0.0)
    if not name.startswith(("backlash", "effective_area")):  # a load has a speed of its own, and pressure works, too
        energy, worked = shapes.energy_and_work(made, made.plant(0))
        assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)  # work is summed at the rate of the record


def test_laws_by_speed_and_place_have_the_shapes_that_are_said():
    one, eight = shapes.drag_at(made := SERIES.short(KNOWN[0]), [0.1, 0.8])[0]
    assert eight / one == pytest.approx(8.0 ** made.effects[0].parameters["power"], rel=1e-3)
    made = SERIES.short("velocity_weakening.slideway_from_boundary_to_mixed_film")
    falls = made.effects[0].parameters["falls"] / made.nominal.speed
    assert shapes.drag_at(made, [0.0, falls, 2.0 * falls])[0] == pytest.approx([0.9, 0.9 / np.e, 0.9 / np.e**4], abs=1e-3)
    sides = shapes.drag_at(SERIES.short("direction_asymmetry.joint_rubs_more_one_way"), [0.0, 1.0])
    np.testing.assert_allclose(np.sort(sides, axis=0), [[-0.35, -0.25], [0.4, 0.8]], atol=1e-3)
    for name, row, level, size in (
        ("position_dependent_friction.screw_runs_out_of_true", FACTOR_AT, 1.0, np.hypot(0.5, 0.2)),
        ("position_dependent_force.iron_core_over_its_magnets", FORCE_AT, 0.0, np.hypot(1.0, 0.25)),
        ("drive_gain_change.torque_ripples_with_the_poles", GAIN_AT, 1.0, 0.3),
    ):
        p = (made := SERIES.short(name)).effects[0].parameters
        pitch = p.get("pitch", p.get("turn")) / made.nominal.reach
        values = shapes.at_places(made, row, list(np.linspace(0.0, pitch, 401)[:-1])) / (p["size"] if row == FORCE_AT else 1.0)
        assert (values.mean(), values.std()) == pytest.approx((level, size / np.sqrt(2.0)), abs=5e-3)
    made = SERIES.short("effective_area.bag_of_an_air_spring")
    assert np.diff(shapes.at_places(made, AREA_AT, [-1.0, 0.5])) == pytest.approx(
        1.5 * made.effects[0].parameters["slope"], abs=1e-3
    )


def test_a_gear_rubs_by_the_weight_alone():
    made, states, quick = sliding("load_dependence.gear_rubs_by_the_weight_it_holds")
    rubs, held = np.abs(states[quick, 6]), np.abs(made.true.numbers["gravity"] * np.sin(states[quick, 0]))
    assert np.polyfit(held, rubs, 1) == pytest.approx([made.effects[0].parameters["share"], made.true.level], rel=0.02)


def test_a_film_builds_in_time_and_debris_by_the_way():
    made, states, quick = sliding("frictional_lag.film_builds_again_after_each_turn", "slide")
    p, t, checked = made.effects[0].parameters, np.arange(len(states)) / made.nominal.rate, 0
    moves = np.flatnonzero(np.abs(states[:, 2]) > 0.004 * made.true.speed)
    for begin, end in pairwise(moves[1:][np.diff(np.sign(states[moves, 2])) != 0.0]):
        rows = np.arange(begin, end)[quick[begin:end]]
        age = -p["time"] * np.log((np.abs(states[rows, 6]) / made.true.level - 1.0) / p["more"])
        ahead = age - (t[rows] - t[begin])  # it breaks away, meets twice the friction, and holds for a moment
        assert np.all((ahead > -0.002) & (ahead < 0.03))
        assert np.all(np.abs(np.diff(ahead)) < 1e-5)
        checked += rows.size
    assert checked > 1000
    made, states, quick = sliding("distance_drift.debris_roughens_the_track", "slide")
    slid, p = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(states[:, 0])))]), made.effects[0].parameters
    level = 1.0 + p["more"] * (1.0 - np.exp(-slid / p["distance"]))
    assert (np.abs(states[:, 6]) / made.true.level)[quick] == pytest.approx(level[quick], abs=0.01)


def test_chance_heat_and_sensors_are_as_they_are_said_to_be():
    x = remembered(np.random.default_rng(0), 100_000)
    assert (x.std(), np.mean(x[1:] * x[:-1]), np.mean(x[3:] * x[:-3])) == pytest.approx((1.0, 0.8, 0.512), abs=0.03)
    record = (made := lasting(SERIES.short("temperature_drift.rail_grease_by_a_thermometer"), 12.0)).record(0)
    factor = np.interp(record["time [s]"], (plant := made.plant(0)).times, plant.by_time[FACTOR_OF_TIME])
    assert np.polyfit(record["temperature [degC]"], np.log(factor), 1) == pytest.approx([-0.05, 27.0 * 0.05], rel=0.01)
    shown, plain = shapes.shown_and_plain(made := SERIES.short("sensor_delay.encoder_by_way_of_a_field_bus"), "position")
    rows = round(made.effects[0].parameters["delay"] * made.nominal.rate)
    assert np.std(shown[rows:] - plain[:-rows]) < 0.1 * np.std(shown - plain)
    shown, plain = shapes.shown_and_plain(lasting(SERIES.short("stale_samples.reader_tries_again"), 12.0), "position")
    np.testing.assert_array_equal(shown[1:][shown[1:] != plain[1:]], shown[:-1][shown[1:] != plain[1:]])
    assert 0.06 < np.mean(shown != plain) < 0.22
