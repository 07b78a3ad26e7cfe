"""The forms of the fifteenth set with an effect of the vocabulary give finite records that they move; nulls move nothing."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.stats import fatiguelife, maxwell

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import nominal_bench
from tests.discovery.joint_generator.case import Case, Made
from tests.discovery.joint_generator.forms import FORMS
from tests.discovery.joint_generator.plant import (
    AREA_AT,
    FACTOR_AT,
    FACTOR_OF_TIME,
    FORCE_AT,
    FORCE_OF_TIME,
    GAIN_AT,
    GAIN_OF_TIME,
)
from tests.discovery.joint_generator.unseen_fourteenth.test_fourteenth import (
    at_places,
    drag_at,
    drive_and_motion,
    energy_and_work,
    shown_and_plain,
    sources,
    stamps,
)

from .law import USUAL, balls_and_plate, heap, rate_under_stress
from .mechanism import area_of_a_zigzag, geneva
from .null import flat_topped, ringing_noise, triggered
from .sensor import LAGS

SERIES = series_checks.Series(15)
MADE_UP_FOR = {"constant_force.current_sensor_stays_magnetised": "size"}
"""What the controller makes up for, and is seen against what is believed."""
OWN = {name: form for name, form in SERIES.forms.items() if not form.draw.__module__.endswith("nameless")}
KNOWN = [name for name in OWN if SERIES.kinds[name] != "none"]
JOINTS = [name for name in KNOWN if name in SERIES.joints]
UNDRIVEN = [name for name in OWN if name in SERIES.undriven]


def of_twelve_seconds(name: str, design: str | None = None) -> Made:
    """A case whose runs are as long as they usually are."""
    made = SERIES.short(name, design=design)
    return replace(made, nominal=replace(made.nominal, duration=12.0), true=replace(made.true, duration=12.0))


def friction(name: str, run: int = 0) -> slider.RateAndState | thrown.Throw:
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    law = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law
    assert law is not None
    drawn = law(case.rng(2, run))
    assert isinstance(drawn, slider.RateAndState | thrown.Throw)
    return drawn


def test_the_set_is_as_wide_as_asked_for():
    assert (len(KNOWN), len(OWN) - len(KNOWN)) == (27, 10)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced() & OWN.keys()
    assert not OWN.keys() & set(SERIES.unsourced())
    fourteenth = [kind for kind in series_checks.Series(14).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(SERIES.kinds[name] for name in KNOWN) == sorted(fourteenth)


def test_no_earlier_form_has_the_name_of_one_of_these():
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}


def test_no_earlier_form_of_its_kind_has_the_source_of_one_of_these():
    earlier = [*FORMS.values(), *(form for i in range(1, 15) for form in joint_plan.SERIES[i][0].values())]
    used = {(form.kind, source) for form in earlier for source in sources(form)}
    own = [(form.kind, source) for form in OWN.values() for source in sources(form)]
    assert len(own) == len(OWN) == len(set(own))
    assert not used & set(own)


@pytest.mark.parametrize("name", JOINTS)
def test_a_record_is_finite_and_moved_at_half_strength(name):
    made = SERIES.short(name, strength=0.5)
    series_checks.assert_finite(made.record(0))
    off = made.effects[0].parameters.get(MADE_UP_FOR.get(name, ""), 0.0)
    assert max(series_checks.columns_moved(made), abs(off) / made.nominal.sensor.drive) > 3.0


@pytest.mark.parametrize("name", [name for name in JOINTS if name not in MADE_UP_FOR])
def test_a_record_is_moved_by_tens_of_noises_at_full_strength(name):
    """In a usual run; shorter ones have too few strokes for what comes with their number."""
    assert series_checks.columns_moved(of_twelve_seconds(name)) > 10.0


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_and_moved_at_half_strength(name):
    series_checks.assert_finite(SERIES.shown(name, strength=0.5))
    if SERIES.kinds[name] != "none":
        assert series_checks.undriven_moved(SERIES, name, strength=0.5) > 5.0


@pytest.mark.parametrize("name", [name for name in UNDRIVEN if "thrown" in SERIES.forms[name].designs])
def test_the_shortest_slides_have_as_many_rows_as_a_record_needs(name):
    for i in range(thrown.N_RUNS):
        law = friction(name, i)
        assert isinstance(law, thrown.Throw)
        slowest = replace(law, starts=(law.starts[0], law.starts[0]))
        assert thrown.record(slowest, np.random.default_rng(i))["time [s]"].size > 50


@pytest.mark.parametrize("name", SERIES.nulls)
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)


@pytest.mark.parametrize("name", OWN)
def test_the_same_seed_gives_the_same_record(name):
    if name in SERIES.undriven:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    else:
        made = SERIES.short(name)
        made = replace(made, nominal=replace(made.nominal, duration=1.5), true=replace(made.true, duration=1.5))
        again = replace(made, effects=SERIES.short(name).effects)
        series_checks.assert_same(made.record(0), again.record(0))


@pytest.mark.parametrize("name", JOINTS)
def test_no_strength_is_no_effect(name):
    """A recorded load decides friction at any strength: by Coulomb's law, if there is no other one."""
    made = SERIES.short(name, strength=0.0)
    made = replace(made, nominal=replace(made.nominal, duration=1.5), true=replace(made.true, duration=1.5))
    if name.startswith("load_dependence"):
        record, plant = made.record(0), made.plant(0)
        load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
        factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
        assert factor / load == pytest.approx(np.ones_like(load), abs=0.015)  # seven deviations of the load cell's noise
        return
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    series_checks.assert_same({name: shown[name] for name in plain}, plain)


@pytest.mark.parametrize(
    "name",
    [
        "viscous_friction.open_wet_brake",
        "viscous_friction.thickened_oil",
        "velocity_weakening.rubber_beyond_its_peak",
        "direction_asymmetry.pads_of_a_climbing_robot",
        "quadratic_damping.flaps_bend_back",
        "position_dependent_friction.rail_is_corrugated_behind_a_weld",
        "position_dependent_force.bridge_sags_under_its_trolley",
        "drive_gain_change.single_hookes_joint",
        "harmonic_force.geneva_wheel_on_the_frame",
        "constant_force.current_sensor_stays_magnetised",
    ],
)
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    energy, worked = energy_and_work(made, made.plant(0))
    assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)  # work is summed at the rate of the record
    states, _ = made.states(0)
    quick = np.abs(states[:, 2]) > 0.05 * made.nominal.speed
    assert np.all((states[:, 6] * states[:, 2])[quick] > 0.0)


def test_a_wet_brake_drags_by_a_line_until_its_oil_is_thrown_out():
    made = SERIES.short("viscous_friction.open_wet_brake")
    peak = made.effects[0].parameters["thrown_out"] / made.nominal.speed
    drag = drag_at(made, [0.0, 0.25 * peak, 0.5 * peak, peak, 1.5 * peak, 2.0 * peak])[0] / 1.2
    assert drag == pytest.approx([0.0, 0.25, 0.5, 1.0, 1.0 / 1.5, 0.5], abs=3e-3)  # the table's spacing at the peak


def test_a_thickened_oil_has_two_viscosities():
    stress = np.array([1e-3, 1e3])
    assert rate_under_stress(stress) / stress == pytest.approx([1.0, 10.0], rel=1e-3)  # of the order of the stress squared
    made = SERIES.short("viscous_friction.thickened_oil")
    drag, top = drag_at(made, [0.0, 0.005, 0.5, 1.0])[0], made.effects[0].parameters["top"]
    assert (drag[0], drag[3]) == pytest.approx((0.0, 1.2), abs=3e-3)
    stress = drag[1:] / 1.2
    rates = np.array([0.005, 0.5, 1.0])
    scale = np.interp(top, rate_under_stress(np.linspace(0.0, 25.0, 9001)), np.linspace(0.0, 25.0, 9001))
    assert rate_under_stress(stress * scale) / top == pytest.approx(rates, rel=0.01)  # two tables are read between
    assert drag[1] / 0.005 > 3.0 * drag[3]


def test_rubber_rubs_most_at_a_slow_speed_and_alike_a_decade_to_either_side():
    made = SERIES.short("velocity_weakening.rubber_beyond_its_peak")
    peak = made.effects[0].parameters["peak"] / made.nominal.speed
    more = drag_at(made, [0.0, 0.2 * peak, peak, 5.0 * peak, 1.0])[0] / 0.95
    assert more[0] == pytest.approx(0.0, abs=1e-12)
    assert more[1] == pytest.approx(more[3], abs=0.02)  # the table has about ten points there
    assert more[2:4] == pytest.approx([1.0, np.exp(-1.2 * np.log10(5.0) ** 2)], abs=2e-3)
    row = made.plant(0).by_speed[0]
    assert np.all(np.diff(row[np.argmax(row) :]) <= 0.0)
    assert more[4] < 0.25


def test_leaning_hairs_grip_by_a_logarithm_and_let_go_the_other_way():
    made = SERIES.short("direction_asymmetry.pads_of_a_climbing_robot")
    ways = drag_at(made, [0.0, 0.18, 0.98, 1.98])
    grips, lets_go = ways if made.effects[0].parameters["forward"] else ways[::-1]
    assert grips == pytest.approx(0.25 + 0.16 * np.log([1.0, 10.0, 50.0, 100.0]), abs=1e-3)  # read between two rows
    assert lets_go == pytest.approx([-0.3] * 4)


def test_flaps_drag_by_the_square_while_slow_and_less_steeply_when_bent():
    made = SERIES.short("quadratic_damping.flaps_bend_back")
    plant = made.plant(0)
    u, drag = plant.speeds / made.nominal.speed, plant.by_speed[0] / made.nominal.level
    power = np.gradient(np.log(drag[1:]), np.log(u[1:]))
    bends = made.effects[0].parameters["bends"]
    assert np.interp([0.05, bends, 3.9], u[1:], power) == pytest.approx([2.0, 5.0 / 3.0, 1.37], abs=0.015)  # 4/3 far beyond
    assert np.interp(1.0, u, drag) == pytest.approx(1.3, rel=1e-3)


def test_a_plate_rubs_by_what_its_balls_do_not_bear():
    assert balls_and_plate(np.array([0.0, 0.75, 1.0, 2.0])) == pytest.approx([0.0, 0.45, 1.0, 3.2])
    made = of_twelve_seconds("load_dependence.sprung_balls_retract")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    light, heavy = load < 0.7, load > 0.8
    assert factor[light] / load[light] == pytest.approx(0.6, abs=0.01)  # the load cell's noise is 0.002 of it
    assert np.polyfit(load[heavy], factor[heavy], 1) == pytest.approx([2.2, -1.2], abs=0.02)
    assert (load.min(), load.max()) == pytest.approx((0.45, 1.9), abs=0.03)


def test_an_oil_sets_by_the_cube_of_time_at_first():
    made = of_twelve_seconds("friction_drift.oil_sets_in_the_cold")
    plant, time = made.plant(0), made.effects[0].parameters["time"]
    more = np.interp(time * np.array([0.0, 0.1, 0.2, 1.0, 1.6]), plant.times, plant.by_time[FACTOR_OF_TIME] - 1.0) / 0.7
    assert more[[0, 3]] == pytest.approx([0.0, 1.0 - np.exp(-1.0)], abs=1e-3)
    assert more[2] / more[1] == pytest.approx(8.0, rel=0.01)
    assert more[4] > 0.98


def test_spots_flake_by_their_fatigue_lives():
    made = SERIES.short("distance_drift.spots_flake_by_fatigue")
    one, other = made.plant(0).by_stroke, made.plant(1).by_stroke
    np.testing.assert_array_equal(one, other)
    half = made.effects[0].parameters["half"]
    flaked = (one - 0.65) / 1.1
    assert flaked == pytest.approx(fatiguelife.cdf(np.arange(400.0), 0.6, scale=half), abs=1e-9)
    assert np.interp(half, np.arange(400.0), flaked) == pytest.approx(0.5, abs=0.01)
    assert 0.6 < one.min() < 0.66
    assert one.max() < 1.76


def test_ptfe_slips_in_two_steps():
    made = of_twelve_seconds("temperature_drift.two_transitions_of_ptfe")
    plant, record = made.plant(0), made.record(0)
    celsius = record["temperature [degC]"]
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    for low, high, level in ((10.0, 15.5, 1.45), (23.0, 26.0, 1.0), (33.5, 40.0, 0.55)):
        at = (celsius > low) & (celsius < high)
        assert np.mean(at) > 0.02
        assert factor[at] == pytest.approx(level, abs=0.01)  # five widths away a step is past
    at = np.argsort(celsius)
    assert np.interp([19.0, 30.0], celsius[at], factor[at]) == pytest.approx([1.225, 0.775], abs=0.05)  # noise of 0.05 degrees
    assert abs(np.corrcoef(record["time [s]"], celsius)[0, 1]) < 0.6


def test_a_carriage_is_pressed_by_the_resultant_of_three_errors():
    made = SERIES.short("random_coefficients.carriage_sits_askew")
    level = np.concatenate([made.plant(i).by_stroke for i in range(20)])
    askew = (level - 1.0) / 0.4 + np.sqrt(8.0 / np.pi)
    q = np.array([0.05, 0.25, 0.5, 0.75, 0.95])
    assert np.quantile(askew, q) == pytest.approx(maxwell.ppf(q), abs=0.05)  # three deviations of a quantile of 8000
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05
    assert level.min() > 0.36


def test_three_feet_share_a_load():
    mu = np.array([friction("random_coefficients.block_on_three_feet", i).mu(1.0, 0.0) for i in range(800)])
    assert (mu.mean(), mu.std()) == pytest.approx((0.28, 0.2 / 3.0), abs=0.007)  # three deviations of the mean of 800
    assert (mu.min() > 0.08) & (mu.max() < 0.48)
    assert np.mean(np.abs(mu - 0.28) < 0.2 / 3.0) == pytest.approx(2.0 / 3.0, abs=0.05)  # three even shares add up to 1 to 2


def test_a_heap_is_never_less_than_nothing_and_keeps_what_no_stroke_has_swept():
    rng = np.random.default_rng(5)
    runs = np.stack([heap(rng, 400) for _ in range(200)])
    assert (runs.min(), runs.max()) == (0.0, 6.0)
    assert runs.mean() == pytest.approx(USUAL, abs=0.03)  # 80 000 strokes, of which ten count as one
    fell = runs[:, 1:] - runs[:, :-1]
    assert fell.min() == pytest.approx(-1.4, abs=1e-3)
    inside = (runs[:, :-1] > 1.4) & (runs[:, :-1] < 3.0)  # less than half of what comes then is cut off, and nothing lacks
    assert np.median(fell[inside]) == pytest.approx(np.log(2.0) - 1.4, abs=0.04)  # of an exponential amount of 1 in the mean
    kept = [np.corrcoef(runs[:, k:].ravel(), runs[:, :-k].ravel())[0, 1] for k in (1, 4, 30)]
    assert kept[0] > 0.7 > kept[1] > 0.3 > kept[2]
    made = SERIES.short("correlated_coefficients.heap_before_a_wiper")
    assert made.plant(0).by_stroke.min() == pytest.approx(1.0 - 0.2 * USUAL)


@pytest.mark.parametrize("design", ["slide", "hinge"])
def test_a_film_is_drawn_in_over_twice_the_length_of_a_pad(design):
    made = of_twelve_seconds("frictional_lag.film_is_drawn_in_anew", design)
    more, q, v, _ = drive_and_motion(made)
    pad, quick = made.effects[0].parameters["pad"], np.abs(v) > 0.15 * made.nominal.speed
    turns = np.flatnonzero(np.diff(np.sign(v)))
    checked = 0
    for begin, end in pairwise(turns):
        rows = np.arange(begin, end)[quick[begin:end]]
        gone = np.abs(q[rows] - q[begin])
        if rows.size and gone[-1] > 2.5 * pad:
            bare = np.maximum(1.0 - gone / (2.0 * pad), 0.0)
            # the turn is seen at a fiftieth of the speed, from a noisy position
            assert np.sign(v[rows]) * more[rows] == pytest.approx(1.1 * bare, abs=0.12)
            checked += 1
    assert checked >= 2  # long strokes of a run


def test_corrugations_begin_at_the_weld_and_die_away():
    made = SERIES.short("position_dependent_friction.rail_is_corrugated_behind_a_weld")
    p, reach = made.effects[0].parameters, made.nominal.reach
    behind = np.array([-0.2 * reach, 0.0, 0.25 * p["wave"], 0.75 * p["wave"], 2.25 * p["wave"]])
    factor = at_places(made, FACTOR_AT, list(p["side"] * (p["weld"] + behind) / reach))
    dies = 0.6 * np.exp(-behind / (0.9 * reach))
    assert factor == pytest.approx([1.0, 1.0, 1.0 + dies[2], 1.0 - dies[3], 1.0 + dies[4]], abs=5e-3)  # the table's spacing
    assert made.plant(0).by_place[FACTOR_AT].min() > 0.4


def test_a_disc_of_felt_has_polished_by_its_chord():
    one, other = (friction("position_dependent_friction.felt_disc_was_drawn_across", i).mu for i in (0, 1))
    x = 0.11 + 0.07 * np.array([-1.2, -1.0, -0.6, 0.0, 0.8, 1.0, 1.5])
    mu = np.array([one(1.0, float(at)) for at in x])
    assert np.array([other(0.3, float(at)) for at in x]) == pytest.approx(mu)
    assert 1.0 - mu / 0.32 == pytest.approx(0.65 * np.array([0.0, 0.0, 0.8, 1.0, 0.6, 0.0, 0.0]), abs=1e-6)
    assert SERIES.shown("position_dependent_friction.felt_disc_was_drawn_across")["position [m]"].max() > 0.2


def test_a_trolley_is_drawn_to_the_middle_of_its_bridge_and_gains_what_it_has_sunk():
    made = SERIES.short("position_dependent_force.bridge_sags_under_its_trolley")
    half = made.effects[0].parameters["half_span"] / made.nominal.reach
    u = np.linspace(0.0, 1.0, 2001)
    pulls = at_places(made, FORCE_AT, list(half * u)) / made.nominal.level
    assert pulls == pytest.approx(-at_places(made, FORCE_AT, list(-half * u)) / made.nominal.level)
    assert pulls.min() >= 0.0  # a force against q
    assert pulls.max() == pytest.approx(1.3, rel=1e-3)
    sunk = np.concatenate([[0.0], np.cumsum(0.5 * (pulls[1:] + pulls[:-1]) * np.diff(u))])
    path = (1.0 - u**2) ** 2  # a^2 b^2 with a = 1 + u and b = 1 - u
    assert sunk[-1] - sunk == pytest.approx(sunk[-1] * path, abs=1e-3 * sunk[-1])


def test_a_zigzag_pulls_by_the_change_of_its_volume():
    out = np.linspace(0.1, 0.9, 801)
    volume = out * np.sqrt(1.0 - out**2)  # of a rhombus whose facets stay as long
    assert np.gradient(volume, out)[1:-1] == pytest.approx(area_of_a_zigzag(out)[1:-1], rel=1e-3, abs=1e-4)
    made = SERIES.short("effective_area.muscle_over_a_zigzag")
    side = made.effects[0].parameters["side"]
    areas = at_places(made, AREA_AT, [-side, 0.0, side])
    assert areas[1] == pytest.approx(1.0 + 0.28 * 0.1, abs=1e-3)
    assert areas[1] - areas[2] > 1.5 * (areas[0] - areas[1]) > 0.0


def test_a_hookes_joint_gives_as_much_on_as_off_over_a_half_turn():
    made = SERIES.short("drive_gain_change.single_hookes_joint")
    plant, p = made.plant(0), made.effects[0].parameters
    gain = plant.by_place[GAIN_AT]
    assert (gain.min(), gain.max()) == pytest.approx((np.sqrt(0.58), 1.0 / np.sqrt(0.58)), abs=2e-3)
    turns = np.concatenate([[0.0], np.cumsum(0.5 * (1.0 / gain[1:] + 1.0 / gain[:-1]) * np.diff(plant.places))])
    half = p["half_turn"]
    on = np.interp(half, plant.places, turns) - np.interp(0.0, plant.places, turns)
    assert on == pytest.approx(half, rel=1e-3)  # driven shaft and driving one turn alike in the mean


def test_a_ring_is_smaller_than_its_bore_and_a_zero_is_off_evenly():
    made = SERIES.short("drive_gain.cylinder_piped_the_other_way_round")
    assert np.unique(made.plant(0).by_time[GAIN_OF_TIME]) == pytest.approx([1.0 / 1.6])
    made = SERIES.short("constant_force.current_sensor_stays_magnetised")
    (force,) = np.unique(made.plant(0).by_time[FORCE_OF_TIME])
    assert abs(force) / made.nominal.level == pytest.approx(0.65)
    assert force == made.plant(1).by_time[FORCE_OF_TIME][0]


def test_a_board_adds_what_its_parts_add_as_points():
    made = SERIES.short("payload.board_in_the_gripper")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    mass = made.effects[0].parameters["share"] * n["m2"]
    places = n["l2"] * (1.0 + 0.7 * (np.arange(1000) + 0.5) / 1000)
    first, second = mass * places.mean(), mass * np.mean(places**2)
    more = {name: loaded[name] - plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    assert more["inertia"] == pytest.approx(mass * n["l1"] ** 2)
    assert more["inertia_2"] == pytest.approx(second, rel=1e-5)  # a thousand points
    assert more["coupling"] == pytest.approx(n["l1"] * first)
    assert (more["gravity"], more["gravity_2"]) == pytest.approx((9.81 * mass * n["l1"], 9.81 * first))


def test_a_geneva_wheel_turns_by_a_quarter_and_is_at_rest_before_and_behind():
    turns = np.linspace(0.0, 1.0, 40_001)
    pushes, step = geneva(turns), 2.0 * np.pi / 40_000
    assert np.all(pushes[np.abs(turns - 0.5) > 0.126] == 0.0)
    assert (pushes.min(), pushes.max()) == pytest.approx((-1.0, 1.0), abs=1e-4)
    speed = np.cumsum(pushes) * step * 5.40698  # of the wheel, in that of the crank
    assert speed[-1] == pytest.approx(0.0, abs=1e-3)
    assert speed.max() == pytest.approx(np.sqrt(0.5) / (1.0 - np.sqrt(0.5)), rel=1e-3)
    assert speed.sum() * step == pytest.approx(np.pi / 2.0, rel=1e-3)
    made = SERIES.short("harmonic_force.geneva_wheel_on_the_frame")
    plant, frequency = made.plant(0), made.effects[0].parameters["frequency"]
    force = plant.by_time[FORCE_OF_TIME] / made.nominal.level
    assert np.abs(force).max() == pytest.approx(1.3, rel=0.01)
    later = np.interp(plant.times[:2000] + 1.0 / frequency, plant.times, force)
    assert np.corrcoef(later, force[:2000])[0, 1] > 0.99


@pytest.mark.parametrize(
    ("name", "load", "held"),
    [("joint_compliance.limb_in_an_exoskeleton", 0.6, 0.1), ("backlash.stem_of_a_control_valve", 0.4, 0.6)],
)
def test_a_link_parts_inertia_and_friction_and_adds_none(name, load, held):
    made = SERIES.short(name)
    plain, linked = made.plant(0, with_effects=False), made.plant(0)
    assert linked.body["rotor"] + linked.body["inertia"] == pytest.approx(plain.body["inertia"])
    assert linked.body["inertia"] / plain.body["inertia"] == pytest.approx(load)
    assert sum(linked.coulomb) == pytest.approx(plain.coulomb[0])
    assert linked.coulomb[1] / plain.coulomb[0] == pytest.approx(held)
    assert (linked.body["half_gap"] > 0.0) == name.startswith("backlash")
    assert linked.body["link_damping"] > 0.0


def test_a_tube_is_a_row_of_lags_and_late_by_what_it_is_said_to_be():
    w = np.array([0.3, 1.0, 3.0])
    lags = np.append(LAGS, 1.0 - LAGS.sum())
    row = np.prod(1.0 / (1.0 + 1j * np.outer(lags, w)), axis=0)
    assert row == pytest.approx(1.0 / np.cosh(np.sqrt(2j * w)), abs=5e-3)  # of what diffuses; the last lag stands for many
    made = SERIES.short("sensor_delay.pneumatic_transmitter", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = stamps(made), made.effects[0].parameters["delay"]
    begins = t > 0.3

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.25 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_a_camera_shows_fewer_frames_in_the_dark():
    made = of_twelve_seconds("stale_samples.camera_in_changing_light", "slide")
    shown, plain = shown_and_plain(made, "position")
    new = np.flatnonzero(np.diff(shown) != 0.0) + 1
    np.testing.assert_array_equal(shown[new], plain[new])
    lasts, step = np.diff(new) / made.nominal.rate, 1.0 / made.nominal.rate
    assert lasts.min() >= 0.012 - 1.01 * step
    assert lasts.max() <= 0.06 + 1.01 * step
    assert np.ptp(lasts) > 0.04
    assert np.abs(np.diff(lasts)).max() < 0.012 + 2.0 * step  # a cloud comes slowly


def test_an_echo_of_an_echo_is_twice_as_far_away():
    made = of_twelve_seconds("sensor_outliers.echo_there_and_back_twice", "slide")
    shown, plain = shown_and_plain(made, "position")
    hit, side, reach = shown != plain, made.effects[0].parameters["side"], made.nominal.reach
    assert 0.5 / 320.0 < np.mean(hit) < 1.6 / 320.0
    far = [1.3 * reach + side * x[hit] for x in (shown, plain)]
    assert far[0] == pytest.approx(2.0 * far[1])
    assert far[1].min() > 0.0


def test_runs_are_of_unequal_length_and_else_as_they_were():
    made = SERIES.short("none.runs_ended_by_hand", design="slide")
    sizes = []
    for i in range(len(made.roles)):
        record, plain = made.record(i), replace(made, effects=()).record(i)
        series_checks.assert_same(record, {name: x[: record["time [s]"].size] for name, x in plain.items()})
        sizes.append(record["time [s]"].size / plain["time [s]"].size)
    assert made.roles == ["fit"] * 3 + ["test"] * 2
    assert len(set(sizes)) == len(sizes)
    assert (min(sizes) > 0.54) & (max(sizes) <= 1.0)


def test_a_trigger_switches_late_either_way_and_by_the_same():
    x = np.concatenate([np.linspace(0.0, 5.0, 5001), np.linspace(5.0, 0.0, 5001)])
    counts = triggered(x, 1.0)
    up, down = (x[1:][np.diff(counts) == way] for way in (1.0, -1.0))
    assert up == pytest.approx(np.arange(5) + 0.6, abs=2e-3)
    assert down == pytest.approx(np.arange(4, -1, -1) + 0.4, abs=2e-3)
    made = SERIES.short("none.trigger_with_hysteresis", design="slide")
    shown, plain = shown_and_plain(made, "position")
    assert np.abs(shown - plain).max() < 0.601 * 8e-5 * made.nominal.reach


def test_a_multiplexer_and_a_clock_are_off_by_less_than_an_interval():
    made = SERIES.short("none.channels_one_after_another", design="slide")
    assert made.nominal.rate == 5000.0
    shown, plain = shown_and_plain(made, "position")
    assert shown[:-1] == pytest.approx(plain[:-1] + np.diff(plain) / 7.0)
    drive, same = shown_and_plain(made, "force", "voltage")
    np.testing.assert_array_equal(drive, same)
    made = SERIES.short("none.clock_is_set_each_second", design="slide")
    shown, plain = shown_and_plain(made, "position")
    most = np.maximum(np.abs(np.diff(plain, prepend=plain[0])), np.abs(np.diff(plain, append=plain[-1])))
    assert np.all(np.abs(shown - plain) <= 0.0501 * most + 1e-15)
    assert np.std(shown - plain) > 0.0


def test_flat_topped_and_ringing_noise_are_as_loud_as_stated():
    noise = flat_topped(np.random.default_rng(5), 400_000)
    assert (noise.mean(), noise.std()) == pytest.approx((0.0, 1.0), abs=0.01)
    assert np.mean(noise**4) == pytest.approx(2.188, abs=0.02)  # of gammas: G(5/4) G(1/4)/G(3/4)^2
    noise = ringing_noise(np.random.default_rng(5), 400_000, 0.16, 0.9)
    assert noise.std() == pytest.approx(1.0, abs=0.01)
    spectrum = np.abs(np.fft.rfft(noise.reshape(-1, 400), axis=1)) ** 2
    assert np.argmax(spectrum.mean(axis=0)) / 400 == pytest.approx(0.16, abs=0.01)


def test_a_companded_drive_is_fine_about_zero_and_a_hundredth_off_when_large():
    made = SERIES.short("none.companded_drive", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    off, full = np.abs(shown - plain), 20.0 * made.nominal.level / made.nominal.gain
    step = np.log(256.0) / 512.0 * (full / 255.0 + np.abs(plain))
    assert np.all(off < 0.51 * step)
    assert np.unique(shown).size <= 1025
    assert np.abs(plain).max() < full


def test_a_folded_tone_and_a_noise_of_two_times_are_as_loud_as_the_drive():
    made = SERIES.short("none.switching_tone_folds_back", design="slide")
    assert made.nominal.rate == 1000.0
    shown, plain = shown_and_plain(made, "force", "voltage")
    tone = (shown - plain) / series_checks.drive_noise(made)
    assert tone.std() == pytest.approx(1.0, rel=0.01)
    assert np.argmax(np.abs(np.fft.rfft(tone[:4000]))) / 4.0 == pytest.approx(40.0)
    made = SERIES.short("none.noise_of_two_times", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    noise = (shown - plain) / series_checks.drive_noise(made)
    assert noise.std() == pytest.approx(1.0, rel=0.15)  # some fifty times of 40 ms in four seconds
    kept = [np.corrcoef(noise[k:], noise[:-k])[0, 1] for k in (17, 204)]
    assert kept == pytest.approx([0.5 * np.exp(-10.0 / 3.0) + 0.5 * np.exp(-0.25), 0.5 * np.exp(-3.0)], abs=0.15)


def test_undriven_nulls_are_what_they_are_said_to_be():
    law = friction("none.level_below_and_a_cell_that_rings")
    assert law.added is not None
    t = np.arange(40_000) / slider.RATE
    assert law.added(t, t).std() == pytest.approx(2e-4, rel=0.03)
    assert (0.62 - law.mu_0) / 0.062 == pytest.approx(1.0 / 3.0, abs=0.01)
    assert friction("none.planed_beech").mu(1.0, 0.1) == 0.345
