"""What no effect describes, in the seventeenth set: finite records that each form moves, and the physics of some of them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.forms import FORMS
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_nameless import relative, sources

from .nameless import behind_a_throttle, dragged, flag, heaped, peak_since_turn, trapped

SERIES = series_checks.Series(17)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]
INNER = slice(300, -300)


def for_seconds(name, design=None, *, lasts=12.0, strength=1.0):
    made = SERIES.short(name, design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def drive_and_motion(name, design=None):
    """A case; what its single drive shows beyond the plain one [N or N m], place and speed of the states"""
    made = for_seconds(name, design)
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    column = next(c for c in shown if c.startswith(("force", "torque", "voltage")))
    states, _ = made.states(0)
    return made, (shown[column] - plain[column]) * made.nominal.gain, states[:, 0], states[:, 2]


def friction(name, run=0):
    """What a slider or a thrown block has in a run, at full strength."""
    case = series_checks.Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    law = case.parts[0].draw(case.rng(1, 0), 1.0, series_checks.nominal_bench("slide", case.rng(0))).law
    return law(case.rng(2, run))


def test_there_are_fourteen_of_names_and_sources_that_no_earlier_form_has():
    assert len(NAMES) == 14
    assert {SERIES.kinds[name] for name in NAMES} == {"unknown"}
    assert not (SERIES.misplaced() | set(SERIES.unsourced())) & set(NAMES)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in NAMES}
    earlier = [*FORMS.values(), *(form for i in range(1, 17) for form in joint_plan.SERIES[i][0].values())]
    used = {source for form in earlier if form.kind == "unknown" for source in sources(form)}
    own = [source for name in NAMES for source in sources(SERIES.forms[name])]
    assert len(own) == len(NAMES) == len(set(own))
    assert not used & set(own)


@pytest.mark.parametrize("name", JOINTS)
@pytest.mark.parametrize(("strength", "floors"), [(1.0, 10.0), (0.5, 5.0)])
def test_a_record_is_finite_and_moved_by_many_noise_floors(name, strength, floors):
    for design in SERIES.forms[name].designs:
        made = for_seconds(name, design, lasts=7.0, strength=strength)
        series_checks.assert_finite(made.record(0))
        assert series_checks.columns_moved(made) > floors


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_moved_and_repeatable(name):
    for strength, floors in ((1.0, 20.0), (0.5, 10.0)):
        series_checks.assert_finite(SERIES.shown(name, strength=strength))
        assert series_checks.undriven_moved(SERIES, name, strength=strength) > floors
    series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))


@pytest.mark.parametrize("name", JOINTS)
def test_the_same_seed_gives_the_same_record_and_no_strength_no_effect(name):
    made = for_seconds(name, lasts=1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    none = for_seconds(name, lasts=1.5, strength=0.0)
    for column, x in replace(none, effects=()).record(0).items():
        np.testing.assert_allclose(none.record(0)[column], x, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    "name", ["taper_is_drawn_tight", "screw_whips", "load_brake_drags_while_lowering", "seals_trap_pressure"]
)
def test_what_rubs_takes_energy_at_each_moment(name):
    made, more, _, v = drive_and_motion(f"unknown.{name}")
    quick = np.abs(v) > 0.1 * made.nominal.speed
    assert (more * v)[quick].min() >= 0.0
    assert np.abs(more[np.abs(v) < 1e-3 * made.nominal.speed]).max(initial=0.0) < 0.5 * np.abs(more).max()


def test_a_taper_keeps_the_most_that_a_stroke_asked_for():
    load, v = np.array([1.0, 3.0, 2.0, 1.0, 1.5]), np.array([1.0, 1.0, 1.0, -1.0, 0.01])
    np.testing.assert_array_equal(peak_since_turn(load, v, 0.1), [1.0, 3.0, 3.0, 1.0, 1.5])


def test_a_screw_resonates_slower_where_more_of_it_is_free():
    made, more, x, v = drive_and_motion("unknown.screw_whips", "slide")
    p = made.effects[0].parameters
    length = p["free"] + p["side"] * x
    r = np.abs(v) / (p["critical"] * (p["free"] / length) ** 2)
    bends = r**2 / np.abs(1.0 - r**2 + 0.4j * r)
    assert relative((more - p["size"] * bends * np.sign(v))[INNER], more[INNER]) < 0.05
    assert np.mean(np.abs(more) > 2.0 * p["size"]) > 0.02


def test_a_load_brake_drags_only_where_the_weight_helps():
    made, more, q, v = drive_and_motion("unknown.load_brake_drags_while_lowering", "hinge")
    quick = np.abs(v) > 0.1 * made.nominal.speed
    lowers = v * np.sin(q) < -0.02 * made.nominal.speed
    asked = made.effects[0].parameters["size"] * np.abs(np.sin(q)) * np.sign(v)
    np.testing.assert_allclose(more[quick & lowers], asked[quick & lowers], atol=0.02 * np.abs(asked).max())
    assert np.abs(more[quick & (v * np.sin(q) > 0.02 * made.nominal.speed)]).max() < 1e-9


def test_a_friction_drive_gains_by_the_torque_along_the_way():
    made = for_seconds("unknown.friction_drive_creeps", "hinge")
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    states, _ = made.states(0)
    gained = (shown["position [rad]"] - plain["position [rad]"])[INNER]
    torque = plain["torque [N m]"] * made.nominal.gain / made.nominal.numbers["gravity"]
    way = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.abs(np.diff(states[:, 0])))])[INNER]
    assert np.abs(gained - gained[0] - 0.08 * (way - way[0])).max() < 0.03 * np.ptp(gained)


def test_seals_blow_off_at_a_pressure_and_shut_again():
    fed = np.where(np.arange(2000) % 500 < 250, 4.0, 0.0)
    pressure = trapped(fed, 1e-3, 0.02)
    assert 1.0 < pressure.max() < 1.01
    assert pressure[np.flatnonzero(np.diff(pressure) < 0.0)[-1] + 1] < 0.16


def test_a_wheel_goes_with_the_shaft_until_its_friction_gives_way():
    t = np.arange(4000) * 1e-3
    gentle, hasty = np.sin(t), np.sin(4.0 * t)
    np.testing.assert_allclose(dragged(gentle, 1e-3, 1.5)[1:], np.diff(gentle) / 1e-3, atol=1e-9)
    rates = dragged(hasty, 1e-3, 1.5)
    assert np.abs(rates).max() == 1.5
    wheel = np.cumsum(rates) * 1e-3
    apart = np.abs(hasty - wheel) > 0.01
    np.testing.assert_array_equal(rates[apart], 1.5 * np.sign(hasty - wheel)[apart])
    assert np.sum(rates * hasty) * 1e-3 > 0.5 * wheel[-1] ** 2  # what the shaft gives and the wheel has not was rubbed away


def test_a_wire_loses_the_area_of_its_flag():
    """Plateaus 1 and 0.3 apart, drawn by 5 yields: 0.7 times 4 of them; drawn by less than one nothing."""
    out = np.concatenate([np.linspace(0.0, 5.0, 4001), np.linspace(5.0, 0.0, 4001)])
    pulls = flag(out, 1.0, 0.3)
    assert np.trapezoid(pulls, out) == pytest.approx(0.7 * 4.0, abs=0.01)
    assert pulls[-1] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(flag(0.18 * out, 1.0, 0.3), 0.18 * out)


def test_sludge_is_met_where_it_has_flowed_back_to():
    x = np.concatenate([np.linspace(0.0, 1.0, 101), np.linspace(1.0, 0.0, 101), np.linspace(0.0, 1.0, 101)])
    heaps = heaped(x, 1e-3, 0.1)
    assert np.all(heaps[102:202] == 0.0)
    again = x[202 + np.flatnonzero(heaps[202:] > 0.0)[0]]
    assert again == pytest.approx(1.0 - 1e-3 * (101 + 100 * again), abs=0.02)
    assert heaps[-1] == 1.0


def test_air_before_a_throttle_settles_at_the_square_and_springs_back():
    u = np.concatenate([np.full(50000, 0.6), np.full(500, -1.0)])
    pressure = behind_a_throttle(u, 1e-4, 20.0, 20.0 / 2.6)
    assert pressure[49999] == pytest.approx((2.6 * 0.6) ** 2, rel=1e-3)
    assert pressure[300] == pytest.approx(20.0 * 0.6 * 0.03 - 20.0 / 2.6 * 2.0 / 3.0 * np.sqrt(12.0) * 0.03**1.5, rel=0.05)
    fall = pressure[50000:50100]
    assert np.all(np.diff(fall) < -20.0 * 1e-4)


def test_a_polished_plate_takes_force_times_the_way_of_the_tip():
    made = for_seconds("unknown.tool_polishes_a_plate", "arm")
    shown, plain, (states, _) = made.record(0), replace(made, effects=()).record(0), made.states(0)
    power = sum((shown[c] - plain[c]) * states[:, 2 + i] for i, c in enumerate(c for c in plain if "torque" in c))
    n = made.nominal.numbers
    tip = n["l1"] * np.exp(1j * states[:, 0]) + n["l2"] * np.exp(1j * (states[:, 0] + states[:, 1]))
    asked = made.effects[0].parameters["size"] * np.abs(np.gradient(tip)) * made.nominal.rate
    assert relative((power - asked)[INNER], asked[INNER]) < 0.05


def test_a_gel_has_two_frictions_at_one_speed_by_what_came_before():
    law = friction("unknown.gel_sets_when_slow")
    v = np.repeat([3e-6, 3e-5, 3e-6, 1e-6, 3e-6], 3000)
    added = law.added(np.arange(v.size) / slider.RATE, np.cumsum(v) / slider.RATE)
    np.testing.assert_allclose(added[[2990, 5990, 8990, 11990, 14990]], [0.0, -0.03, -0.03, 0.0, 0.0], atol=1e-4)
    assert np.abs(np.diff(added)).max() < 0.004


def test_a_hand_pushes_over_another_way_each_time_and_gives_half_of_it():
    ways = []
    for run in range(thrown.N_RUNS):
        law = friction("unknown.hand_lets_go_late", run)
        x = np.linspace(0.0, 0.12, 2001)
        push = 0.28 - np.array([law.mu(1.0, place) for place in x])
        assert push[0] == pytest.approx(0.5)
        ways.append(2.0 * np.trapezoid(push, x) / push[0])
        slow = replace(law, starts=(law.starts[0], law.starts[0]))
        assert thrown.record(slow, np.random.default_rng(run))["time [s]"].size > 50
    assert min(ways) < 0.03
    assert max(ways) > 0.07
