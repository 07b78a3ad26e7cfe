"""The forms of the seventh set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import LINKS, NUMBERS, VOCABULARY, Case, Made, acceptable, expected, make
from tests.discovery.joint_generator.forms import FORMS, Record
from tests.discovery.joint_generator.plant import FORCE_AT, GAIN_AT

from . import PAIRS, UNSEEN_SEVENTH

KINDS = {
    name: [expected(form) for form in (UNSEEN_SEVENTH[part] for part in name.split("+"))] for name in (*UNSEEN_SEVENTH, *PAIRS)
}
TESTS = ("slider", "thrown")
"""Mechanisms that nothing drives in a loop."""
JOINT_NAMES = [name for name in KINDS if UNSEEN_SEVENTH[name.split("+")[0]].designs[0] not in TESTS]
NUMBERS_OFF = {"constant_force.bellows_under_vacuum": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def short(name: str, *, strength: float = 1.0, design: str | None = None) -> Made:
    """A case whose runs are four seconds long."""
    parts = [UNSEEN_SEVENTH[part] for part in name.split("+")]
    chosen = design or next(d for d in parts[0].designs if all(d in part.designs for part in parts))
    made = make(Case(name, chosen, strength, 7))
    return replace(made, nominal=replace(made.nominal, duration=4.0), true=replace(made.true, duration=4.0))


def moved(made: Made) -> tuple[bool, float]:
    """Whether a record is finite, and how far its columns are, at most, from those without its effects, in their noise."""
    record, plain = made.record(0), replace(made, effects=()).record(0)
    sensor, far = made.nominal.sensor, 0.0
    for name in set(record) & set(plain):
        noise = sensor.position if "position" in name or "angle" in name else sensor.drive / made.nominal.gain
        if record[name].size == plain[name].size and "target" not in name and noise:
            far = max(far, float(np.sqrt(np.mean((record[name] - plain[name]) ** 2))) / noise)
    return all(np.all(np.isfinite(x)) for x in record.values()), far


def shown(case: Case, *, strength: float) -> Record:
    """The first run of a slider, or of a thrown block."""
    form = case.parts[0]
    law = form.draw(case.rng(1, 0), strength, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, 0))
    if isinstance(drawn, thrown.Throw):
        return thrown.record(drawn, case.rng(4, 0))
    assert isinstance(drawn, slider.RateAndState)
    return slider.record(drawn, 3000.0, np.array([1e-6, 1e-5, 1e-6]), 2e-4, case.rng(4, 0))


def test_the_set_is_as_wide_as_asked_for():
    singles = [kinds[0] for kinds in KINDS.values() if len(kinds) == 1]
    known = [kind for kind in singles if kind not in ("none", "unknown")]
    assert (len(known), singles.count("unknown"), singles.count("none"), len(PAIRS)) == (25, 8, 8, 5)
    assert set(known) == VOCABULARY | NUMBERS | LINKS
    assert not any("unknown" in acceptable(form) for form in UNSEEN_SEVENTH.values() if expected(form) in LINKS)
    assert all(form.draw.__doc__ for form in UNSEEN_SEVENTH.values())
    cases = list(joint_plan.unseen_cases([71], 7))
    assert {case.design for case in cases} == set(DESIGNS)
    assert {case.strength for case in cases} == {0.5, 1.0}


def test_no_earlier_form_has_the_name_of_one_of_these():
    earlier = [*FORMS, *(name for series in range(1, 7) for name in joint_plan.SERIES[series][0])]
    assert not set(earlier) & set(UNSEEN_SEVENTH)


@pytest.mark.parametrize(
    ("name", "strength"),
    [(name, size) for name in JOINT_NAMES for size in (1.0, 0.5) if size == 1.0 or KINDS[name] != ["none"]],
)
def test_a_record_is_finite_and_moved_by_its_effects(name, strength):
    made = short(name, strength=strength)
    if "packets" in name:  # which moves the stamps alone
        stamps, step = made.record(0)["time [s]"], 1.0 / made.nominal.rate
        assert np.all(np.diff(stamps) > 0.0)
        assert np.diff(stamps).max() > 20.0 * strength * step
        return
    finite, far = moved(made)
    assert finite
    if KINDS[name] == ["none"]:
        assert far < 10.0
        return
    off = made.effects[0].parameters.get(NUMBERS_OFF.get(name, ""), 0.0)
    assert max(far, abs(off) / made.nominal.sensor.drive) > (5.0 if strength == 1.0 else 3.0)


@pytest.mark.parametrize("name", [name for name in KINDS if name not in JOINT_NAMES])
def test_sliders_and_throws_are_finite_and_moved_by_their_effects(name):
    case = Case(name, UNSEEN_SEVENTH[name].designs[0], 1.0, 7)
    record = shown(case, strength=1.0)
    assert all(np.all(np.isfinite(x)) for x in record.values())
    if KINDS[name] == ["none"]:
        return
    column, noise = ("friction_coefficient", 2e-4) if case.design == "slider" else ("position [m]", thrown.NOISE)
    for strength in (1.0, 0.5):
        changed, plain = shown(case, strength=strength)[column], shown(case, strength=0.0)[column]
        n = min(changed.size, plain.size)
        assert np.sqrt(np.mean((changed[:n] - plain[:n]) ** 2)) > 5.0 * noise


@pytest.mark.parametrize("name", [name for name in JOINT_NAMES if KINDS[name] == ["none"]])
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = short(name, design="slide")
    np.testing.assert_array_equal(made.states(0)[0], made.states(0, with_effects=False)[0])
    nominal, true = made.nominal, made.true
    assert abs(true.numbers["inertia"] / nominal.numbers["inertia"] - 1.0) <= 2.0 * 0.02 + 1e-12
    assert abs(true.level / nominal.level - 1.0) <= 2.0 * 0.2 + 1e-12
    assert abs(true.numbers["offset"] - nominal.numbers["offset"]) <= 2.0 * nominal.offset_sd * (1.0 + 1e-12)


def test_a_hertzian_contact_rubs_less_per_load_the_more_it_is_pressed():
    made = short("load_dependence.hertz_to_a_third")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    coefficient = np.interp(record["time [s]"], plant.times, plant.by_time[0]) / load
    for at in (0.5, 1.0, 1.8):
        assert coefficient[np.abs(load - at) < 0.02].mean() == pytest.approx(at ** (-1.0 / 3.0), rel=0.02)


def test_one_half_of_the_track_gives_less():
    made = short("drive_gain_change.weaker_half_of_the_track")
    plant, reach = made.plant(0), made.nominal.reach
    ends = np.interp([-reach, reach], plant.places, plant.by_place[GAIN_AT])
    assert sorted(ends) == pytest.approx([0.6, 1.0], abs=1e-3)


def test_a_flap_drags_one_way_alone():
    made = short("direction_asymmetry.flap_valve")
    plant, speed = made.plant(0), made.nominal.speed
    drags = sorted(float(np.interp(speed, plant.speeds, row)) for row in plant.by_speed)
    assert drags == pytest.approx([0.154 * made.nominal.level, 1.1 * made.nominal.level], rel=1e-3)


def test_a_conical_spring_pushes_back_to_where_it_is_met():
    made = short("position_dependent_force.conical_spring")
    plant, reach = made.plant(0), made.nominal.reach
    force = np.interp(reach * np.linspace(-1.0, 1.0, 41), plant.places, plant.by_place[FORCE_AT])  # against q
    assert np.all(force * np.sign(force.sum()) >= 0.0)
    assert np.abs(force).max() == pytest.approx(0.8 * made.nominal.level * np.log(4.0), rel=1e-3)
    assert np.all(np.diff(force) >= -1e-9)


def test_a_radio_link_keeps_every_reading_until_the_next_one_and_shows_none_before_its_time():
    made = short("stale_samples.radio_link", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    name = next(name for name in record if name.startswith("position"))
    at = np.array([np.flatnonzero(plain[name] == x)[0] for x in record[name]])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert np.all(np.diff(at) >= 0)
    assert 0.05 < held.max() / made.nominal.rate < 0.16


def test_a_contact_grows_no_older_than_it_can():
    case = Case("frictional_lag.ageing_that_ends", "slider", 1.0, 7)
    law = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, 0))
    assert isinstance(drawn, slider.RateAndState)
    (distance,) = drawn.distance
    oldest = 2.0 * distance / 1e-6
    assert drawn.state(oldest, 0.0, distance) == pytest.approx(0.0)
    assert drawn.state(distance / (1.5 * 1e-6), 1e-6, distance) == pytest.approx(0.0)
