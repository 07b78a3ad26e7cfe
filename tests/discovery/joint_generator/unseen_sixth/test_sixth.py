"""The forms of the sixth set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import LINKS, NUMBERS, VOCABULARY, Case, Made, acceptable, expected, make
from tests.discovery.joint_generator.forms import FORMS, Record
from tests.discovery.joint_generator.plant import GAIN_AT

from . import PAIRS, UNSEEN_SIXTH

KINDS = {
    name: [expected(form) for form in (UNSEEN_SIXTH[part] for part in name.split("+"))] for name in (*UNSEEN_SIXTH, *PAIRS)
}
TESTS = ("slider", "thrown")
"""Mechanisms that nothing drives in a loop."""
JOINT_NAMES = [name for name in KINDS if UNSEEN_SIXTH[name.split("+")[0]].designs[0] not in TESTS]
NUMBERS_OFF = {"constant_force.hose_on_a_reel": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def short(name: str, *, strength: float = 1.0, design: str | None = None) -> Made:
    """A case whose runs are four seconds long."""
    parts = [UNSEEN_SIXTH[part] for part in name.split("+")]
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
    assert (len(known), singles.count("unknown"), singles.count("none"), len(PAIRS)) == (26, 8, 8, 6)
    assert set(known) == VOCABULARY | NUMBERS | LINKS
    assert not any("unknown" in acceptable(form) for form in UNSEEN_SIXTH.values() if expected(form) in LINKS)
    assert all(form.draw.__doc__ for form in UNSEEN_SIXTH.values())
    cases = list(joint_plan.unseen_cases([61], 6))
    assert {case.design for case in cases} == set(DESIGNS)
    assert {case.strength for case in cases} == {0.5, 1.0}


def test_no_earlier_form_has_the_name_of_one_of_these():
    earlier = [*FORMS, *(name for series in range(1, 6) for name in joint_plan.SERIES[series][0])]
    assert not set(earlier) & set(UNSEEN_SIXTH)


@pytest.mark.parametrize(
    ("name", "strength"),
    [(name, size) for name in JOINT_NAMES for size in (1.0, 0.5) if size == 1.0 or KINDS[name] != ["none"]],
)
def test_a_record_is_finite_and_moved_by_its_effects(name, strength):
    made = short(name, strength=strength)
    if "scuffs" in name:  # which shows late alone
        made = make(made.case)
    finite, far = moved(made)
    assert finite
    if KINDS[name] == ["none"]:
        assert far < 10.0
        return
    off = made.effects[0].parameters.get(NUMBERS_OFF.get(name, ""), 0.0)
    assert max(far, abs(off) / made.nominal.sensor.drive) > (5.0 if strength == 1.0 else 3.0)


@pytest.mark.parametrize("name", [name for name in KINDS if name not in JOINT_NAMES])
def test_sliders_and_throws_are_finite_and_moved_by_their_effects(name):
    case = Case(name, UNSEEN_SIXTH[name].designs[0], 1.0, 7)
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


def test_an_adhering_sphere_rubs_less_per_load_the_more_it_is_pressed():
    made = short("load_dependence.adhering_sphere")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    coefficient = np.interp(record["time [s]"], plant.times, plant.by_time[0]) / load
    light, heavy = (coefficient[np.abs(load - at) < 0.03].mean() for at in (0.5, 1.6))
    assert light > 1.25
    assert heavy < 0.9


def test_six_steps_give_as_much_on_the_whole_as_is_stated():
    made = short("drive_gain_change.six_steps")
    plant, arc = made.plant(0), made.effects[0].parameters["arc"]
    inside = np.abs(plant.places) < 3.0 * arc
    assert np.mean(plant.by_place[GAIN_AT][inside]) == pytest.approx(1.0, abs=0.01)
    assert np.ptp(plant.by_place[GAIN_AT][inside]) == pytest.approx(2.2 * (1.0 - np.cos(np.pi / 6.0)), rel=0.01)


def test_dimples_drag_alike_at_half_of_the_highest_speed():
    made = short("direction_asymmetry.slanted_dimples")
    plant = made.plant(0)
    forward, backward = (np.interp(made.nominal.speed * np.array([0.0, 0.5, 1.0]), plant.speeds, row) for row in plant.by_speed)
    assert forward[1] == pytest.approx(backward[1], rel=1e-3)
    assert (forward[0] - backward[0]) * (forward[2] - backward[2]) < 0.0


def test_a_token_keeps_every_reading_until_the_next_one_and_shows_none_before_its_time():
    made = short("stale_samples.token_goes_round", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    name = next(name for name in record if name.startswith("position"))
    at = np.array([np.flatnonzero(plain[name] == x)[0] for x in record[name]])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert np.all(np.diff(at) >= 0)
    assert held.max() / made.nominal.rate == pytest.approx(0.048, abs=3.0 / made.nominal.rate)
