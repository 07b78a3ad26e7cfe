"""The forms of the eighteenth set with an effect of the vocabulary give finite records that they move; nulls move nothing."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.discovery.joint_generator import series_checks
from tests.discovery.joint_generator.case import Made
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_AT, Array
from tests.discovery.joint_generator.unseen_fourteenth.test_fourteenth import (
    at_places,
    drag_at,
    energy_and_work,
    shown_and_plain,
)

SERIES = series_checks.Series(18)
MADE_UP_FOR = {"constant_force.weight_on_a_cord": "size"}
"""What the controller makes up for, and is seen against what is believed."""
OWN = {name: form for name, form in SERIES.forms.items() if not form.draw.__module__.endswith("nameless")}
KNOWN = [name for name in OWN if SERIES.kinds[name] != "none"]
JOINTS = [name for name in (*KNOWN, *SERIES.pairs) if name in SERIES.joints]
UNDRIVEN = [name for name in OWN if name in SERIES.undriven]


def lasting(made: Made, duration: float) -> Made:
    """The same case with runs of another length."""
    return replace(made, nominal=replace(made.nominal, duration=duration), true=replace(made.true, duration=duration))


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
    assert all(len({SERIES.kinds[part] for part in pair.split("+")}) == 2 for pair in SERIES.pairs)


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


@pytest.mark.parametrize("name", [name for name in KNOWN[:7] if "slide" in OWN[name].designs])
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    energy, worked = energy_and_work(made, made.plant(0))
    assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)  # work is summed at the rate of the record
    states, _ = made.states(0)
    assert np.all((states[:, 6] * states[:, 2])[np.abs(states[:, 2]) > 0.05 * made.nominal.speed] > 0.0)


def test_laws_by_speed_and_place_have_the_shapes_that_are_said():
    drag = {name.split(".")[0]: drag_at(SERIES.short(name), [0.0, 0.125, 1.0]) for name in reversed(KNOWN[:6])}
    assert drag["viscous_friction"][0] / drag["viscous_friction"][0, 2] == pytest.approx([0.0, 0.125, 1.0])
    assert drag["quadratic_damping"][0] / drag["quadratic_damping"][0, 2] == pytest.approx([0.0, 1.0 / 64.0, 1.0], abs=1e-4)
    np.testing.assert_allclose(drag["direction_asymmetry"][0], -drag["direction_asymmetry"][1])
    made = SERIES.short("velocity_weakening.ways_float_up_on_oil")
    fades = made.effects[0].parameters["fades"] / made.nominal.speed
    assert drag_at(made, [0.0, fades, 3.0 * fades])[0] == pytest.approx([0.8, 0.8 / np.e, 0.8 / np.e**3], abs=1e-3)
    one, eight = drag_at(SERIES.short("viscous_friction.rolling_bearings_in_oil"), [0.1, 0.8])[0]
    assert eight / one == pytest.approx(4.0, rel=1e-3)
    made = SERIES.short("position_dependent_force.cable_loom_pulls_back")
    p, r = made.effects[0].parameters, made.nominal.reach
    force = at_places(made, FORCE_AT, [p["rest"] / r + u for u in (-0.5, 0.0, 1.0)]) / p["size"]
    assert force == pytest.approx([-0.3875, 0.0, 1.0], abs=1e-3)
    made = SERIES.short("effective_area.diaphragm_of_a_brake_chamber")
    area = at_places(made, AREA_AT, [-1.0, 0.0, 1.0])[:: int(made.effects[0].parameters["side"])]
    assert area == pytest.approx([1.098, 1.0, 0.818], abs=1e-3)


def test_teeth_rub_by_a_share_of_the_torque():
    made, states, quick = sliding("load_dependence.teeth_rub_by_their_torque")
    rubs, torque = np.abs(states[:-1, 6])[quick[1:]], np.abs(states[:-1, 4])[quick[1:]]
    slope, level = np.polyfit(torque, rubs, 1)
    assert slope == pytest.approx(made.effects[0].parameters["share"], rel=0.02)
    assert level == pytest.approx(made.true.level, rel=0.02)


def test_junctions_let_go_exponentially_with_the_way_since_the_turn():
    made, states, quick = sliding("frictional_lag.junctions_let_go_over_a_way", "slide")
    q, v, more = states[:, 0], states[:, 2], np.abs(states[:, 6]) / made.true.level - 1.0
    turns, p, checked = np.flatnonzero(np.diff(np.sign(v))), made.effects[0].parameters, 0
    for begin, end in pairwise(turns):
        rows = np.arange(begin, end)[quick[begin:end]]
        assert more[rows] == pytest.approx(p["more"] * np.exp(-np.abs(q[rows] - q[begin]) / p["way"]), abs=0.05)
        checked += rows.size
    assert checked > 1000


def test_ways_run_in_by_the_distance_slid():
    made, states, quick = sliding("distance_drift.new_ways_run_in", "slide")
    slid, p = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(states[:, 0])))]), made.effects[0].parameters
    level = 1.0 - p["less"] * (1.0 - np.exp(-slid / p["distance"]))
    assert (np.abs(states[:, 6]) / made.true.level)[quick] == pytest.approx(level[quick], abs=0.01)
    assert level[-1] < 0.7  # the most of it is seen


def test_sensors_are_late_and_stale_as_they_are_said_to_be():
    made = SERIES.short("sensor_delay.low_pass_before_the_converter")
    t = np.arange(2000) * 1e-3
    ramp = made.effects[0].measure({"time [s]": t, "position [m]": 0.3 * t}, np.random.default_rng(0))["position [m]"]
    assert (t - ramp / 0.3)[-1] == pytest.approx(made.effects[0].parameters["delay"], abs=6e-4)  # half of a step
    shown, plain = shown_and_plain(lasting(SERIES.short("stale_samples.telegrams_lost_in_spells"), 12.0), "position")
    stale = shown != plain
    np.testing.assert_array_equal(shown[1:][stale[1:]], shown[:-1][stale[1:]])
    assert 0.06 < stale.mean() < 0.17
