"""The forms of the twelfth set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.special import gamma

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
    GAIN_OF_TIME,
    Array,
    Plant,
)

from .null import buzz

SERIES = series_checks.Series(12)
MADE_UP_FOR = {"constant_force.jet_of_coolant": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def column(made: Made, *begins: str) -> str:
    """Name of the first column that begins so."""
    return next(name for name in made.record(0) if name.startswith(begins))


def shown_and_plain(made: Made, *begins: str) -> tuple[Array, Array]:
    """A column with and without the effects."""
    name = column(made, *begins)
    return made.record(0)[name], replace(made, effects=()).record(0)[name]


def drag_at(made: Made, shares: list[float]) -> Array:
    """Friction beyond Coulomb's at shares of the rig's speed, as shares of the believed friction, (2, n)."""
    plant = made.plant(0)
    at = made.nominal.speed * np.array(shares)
    return np.stack([np.interp(at, plant.speeds, row) for row in plant.by_speed]) / made.nominal.level


def at_places(made: Made, row: int, shares: list[float]) -> Array:
    """A row of `by_place` at shares of the rig's reach."""
    plant = made.plant(0)
    return np.interp(made.nominal.reach * np.array(shares), plant.places, plant.by_place[row])


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
    assert SERIES.counts() == (27, 8, 8, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    eleventh = series_checks.Series(11)
    assert sorted(SERIES.kinds.values()) == sorted(eleventh.kinds.values())
    cases = list(joint_plan.unseen_cases([1201], 12))
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


def energy_and_work(made: Made, plant: Plant) -> tuple[Array, Array]:
    """Kinetic energy of a slide, and the work of motor and hidden force less what rubs and pulls, from the record's begin."""
    states, _ = made.states(0)
    q, v, rubs, given = states[:, 0], states[:, 2], states[:, 6], states[:, 7]
    t = np.arange(len(states)) / made.nominal.rate
    pulls = np.interp(q, plant.places, plant.by_place[FORCE_AT]) - np.interp(t, plant.times, plant.by_time[FORCE_OF_TIME])
    lost = (rubs + pulls + plant.body["damping"] * v + plant.body["offset"]) * v
    way, step = 0.5 * (v[1:] + v[:-1]) / made.nominal.rate, 1.0 / made.nominal.rate
    fed = given[1:] * way - 0.5 * (lost[1:] + lost[:-1]) * step  # a row holds what the motor gave until then
    return 0.5 * plant.body["inertia"] * v**2, np.concatenate([[0.0], np.cumsum(fed)])


@pytest.mark.parametrize(
    "name",
    [
        "viscous_friction.drilling_mud",
        "direction_asymmetry.cylinder_out_and_in",
        "quadratic_damping.exhaust_throttles",
        "position_dependent_force.air_shut_in_on_both_sides",
        "drive_gain_change.generator_takes_up_a_load",
        "harmonic_force.indexer_on_the_frame",
        "constant_force.jet_of_coolant",
    ],
)
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    plant = made.plant(0)
    energy, worked = energy_and_work(made, plant)
    assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)
    states, _ = made.states(0)
    quick = np.abs(states[:, 2]) > 0.05 * made.nominal.speed
    assert np.all((states[:, 6] * states[:, 2])[quick] > 0.0)


def test_a_mud_drags_by_a_power_beyond_a_rate_of_its_own():
    made = SERIES.short("viscous_friction.drilling_mud")
    own = made.effects[0].parameters["own"]
    drag = drag_at(made, [0.0, 3.0 * own, 8.0 * own, 1.0])[0]
    assert drag[0] == 0.0
    assert drag[2] / drag[1] == pytest.approx((9.0**0.45 - 1.0) / (4.0**0.45 - 1.0), rel=2e-3)
    assert drag[3] == pytest.approx(1.3, rel=1e-3)


def test_a_robot_joint_has_two_knees_and_then_a_line():
    made = SERIES.short("viscous_friction.knees_of_a_robot_joint")
    knee, other = (made.effects[0].parameters[name] for name in ("knee", "other"))
    drag = drag_at(made, [0.0, 1.0, 3.0, 3.5])[0] / 1.1
    assert drag[:2] == pytest.approx([0.0, 0.4 * np.tanh(1.0 / knee) + 0.6], abs=1e-3)
    assert (drag[3] - drag[2]) / 0.5 == pytest.approx(0.3, abs=2e-3)
    steep = drag_at(made, [1e-2])[0][0] / 1.1 / 1e-2
    assert steep == pytest.approx(0.4 / knee + 0.3 / other / np.tanh(1.0 / other) + 0.3, rel=1e-2)


def test_asperities_of_normal_heights_lose_contact_by_the_error_function():
    made = SERIES.short("velocity_weakening.heights_are_normal")
    knee = made.effects[0].parameters["knee"] / made.nominal.speed
    more = drag_at(made, [0.0, knee, 2.0 ** (1.0 / 0.67) * knee])[0]
    assert more == pytest.approx([1.0, 0.15730, 0.00468], abs=2e-3)


def test_a_rod_differs_most_while_slow_and_is_level_in_the_mean():
    made = SERIES.short("direction_asymmetry.cylinder_out_and_in")
    one, other = drag_at(made, [0.05, 0.25, 0.5, 0.75, 1.0])
    apart, mean = np.abs(one - other), 0.5 * (one + other)
    assert np.all(np.diff(apart) < 0.0)
    assert apart[0] > 0.85
    assert apart[-1] > 0.2
    assert np.ptp(mean) < 0.04
    assert min(one.min(), other.min()) > -0.4


def test_back_pressure_is_the_square_while_slow_and_choked_air_is_steeper():
    made = SERIES.short("quadratic_damping.exhaust_throttles")
    drag = drag_at(made, [0.15, 0.3, 0.5, 1.0])[0]
    assert drag[1] / drag[0] == pytest.approx(4.0, rel=0.05)
    assert 4.4 < drag[3] / drag[2] < 7.0
    assert drag[3] == pytest.approx(1.2, rel=1e-3)
    plant = made.plant(0)
    assert np.all(np.diff(plant.by_speed[0]) >= 0.0)
    assert plant.by_speed[0].max() / made.nominal.level < 20.0


def test_the_coefficient_of_a_tyre_falls_as_a_line_of_the_load():
    made = of_twelve_seconds("load_dependence.tyre_under_a_hopper")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    per_load = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME]) / load
    slope, at_zero = np.polyfit(load, per_load, 1)
    assert (slope, at_zero) == pytest.approx((-0.38, 1.38), abs=0.01)
    assert np.std(per_load - at_zero - slope * load) < 0.01
    assert load.min() == pytest.approx(0.45, abs=0.02)
    assert load.max() == pytest.approx(1.9, abs=0.02)


def test_a_bush_swells_by_the_root_first_and_exponentially_last():
    made = of_twelve_seconds("friction_drift.bush_swells")
    plant, time = made.plant(0), made.effects[0].parameters["time"]
    course = (
        np.interp(np.array([0.0, 0.04, 0.16, 1.0, 1.5, 2.0]) * time, plant.times, plant.by_time[FACTOR_OF_TIME]) - 1.0
    ) / 0.75
    assert course[0] == pytest.approx(0.0, abs=1e-2)
    assert course[2] / course[1] == pytest.approx(2.0, rel=0.03)
    left = 1.0 - course[3:]
    assert left[1:] / left[:-1] == pytest.approx(np.exp(-0.5), rel=0.01)


def test_a_dry_film_lives_for_some_strokes_alike_in_each_run():
    made = SERIES.short("distance_drift.life_of_a_dry_film")
    one, other, life = made.plant(0).by_stroke, made.plant(1).by_stroke, made.effects[0].parameters["life"]
    np.testing.assert_array_equal(one, other)
    assert np.interp([0.0, life, 4.0 * life], np.arange(400), one) == pytest.approx(
        [1.0, 1.0 + 0.85 * (1.0 - np.exp(-1.0)), 1.85], abs=0.01
    )
    assert np.diff(one)[0] < 0.2 * np.diff(one).max()  # nothing at first


def test_interference_of_rails_counts_by_the_power_of_three_halves():
    made = of_twelve_seconds("temperature_drift.rails_on_another_metal")
    plant, record = made.plant(0), made.record(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    warm = record["temperature [degC]"] > 21.5
    log = np.polyfit(np.log(record["temperature [degC]"][warm] - 20.0), np.log(factor[warm] - 1.0 + 0.28), 1)
    assert log[0] == pytest.approx(1.5, abs=0.02)
    assert factor.min() > 0.7
    assert 1.2 < factor.max() < 1.8
    assert abs(np.corrcoef(record["time [s]"], record["temperature [degC]"])[0, 1]) < 0.5


def test_chips_in_nests_scatter_twice_as_much_as_chips_alone():
    made = SERIES.short("random_coefficients.chips_lie_in_nests")
    level = np.concatenate([made.plant(i).by_stroke for i in range(40)])
    number = np.round((level - 1.0) / 0.14 + 2.0)
    np.testing.assert_allclose(level, 1.0 + 0.14 * (number - 2.0))
    assert number.min() == 0.0
    assert number.mean() == pytest.approx(2.0, abs=0.06)
    assert number.var() / number.mean() == pytest.approx(2.0, abs=0.12)
    assert np.mean(number == 0.0) == pytest.approx(0.25, abs=0.02)
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05


def test_a_sole_touches_by_a_share_between_two_limits():
    mu = np.array([friction("random_coefficients.share_of_the_sole_that_touches", i).mu(1.0, 0.0) for i in range(400)])
    share = (mu - 0.28) / 0.3 + 0.4
    assert 0.0 < share.min() < 0.1
    assert 0.85 < share.max() < 1.0
    assert share.mean() == pytest.approx(0.4, abs=0.03)
    assert share.std() == pytest.approx(0.2, abs=0.02)


def test_a_way_forgets_by_a_power_of_the_strokes():
    made = SERIES.short("correlated_coefficients.way_remembers_for_long")
    runs = np.stack([made.plant(i).by_stroke for i in range(60)]) - 1.0
    assert runs.std() == pytest.approx(0.32, rel=0.1)
    assert runs.min() >= -0.85
    one, four, sixteen = (np.mean(runs[:, k:] * runs[:, :-k]) / np.mean(runs**2) for k in (1, 4, 16))
    d = 0.38

    def kept(k: float) -> float:
        return float(gamma(1.0 - d) * gamma(k + d) / (gamma(d) * gamma(k + 1.0 - d)))

    assert (one, four, sixteen) == pytest.approx((kept(1.0), kept(4.0), kept(16.0)), abs=0.08)
    assert sixteen > 2.0 * one**16


def test_a_state_between_both_laws_is_steady_where_theirs_are_and_heals_by_the_root():
    law = friction("frictional_lag.between_both_laws")
    (distance,) = law.distance
    for speed in (1e-6, 3e-5):
        steady = distance / speed
        assert law.state(steady, speed, distance) == pytest.approx(0.0)
        assert law.state(0.25 * steady, speed, distance) == pytest.approx(0.5)
        for share in (0.2, 0.6):
            assert -share * np.log(share) < law.state(share * steady, speed, distance) < 1.0 - share
    assert (law.b[0] - law.a) / distance < 1500.0  # the softest frame slides without sticking


def test_a_sheath_grips_as_the_exponential_of_its_bend_to_either_side():
    made = SERIES.short("position_dependent_friction.sheath_round_a_bend")
    straight = made.effects[0].parameters["straight"] / made.nominal.reach
    factor = at_places(made, FACTOR_AT, [straight - 0.6, straight - 0.3, straight, straight + 0.3, straight + 0.6])
    assert factor[[0, 1]] == pytest.approx(factor[[4, 3]], rel=5e-3)
    assert factor[[3, 4]] / factor[2] == pytest.approx(np.exp(0.95 * np.array([0.3, 0.6])), rel=5e-3)


def test_a_lane_is_oiled_then_less_and_dry_at_last():
    mu = friction("position_dependent_friction.oil_of_a_bowling_lane").mu
    assert [mu(1.0, x) for x in (0.0, 0.06, 0.13, 0.2, 0.5)] == pytest.approx([0.162, 0.162, 0.26325, 0.3645, 0.3645])


def test_air_on_both_sides_pulls_to_the_middle_and_stiffens():
    made = SERIES.short("position_dependent_force.air_shut_in_on_both_sides")
    length = made.effects[0].parameters["length"]
    force = at_places(made, FORCE_AT, [-1.0, -0.5, 0.0, 0.5, 1.0]) / made.nominal.level
    assert force[[2, 4]] == pytest.approx([0.0, 0.9], abs=2e-3)
    assert force[:2] == pytest.approx(-force[[4, 3]])
    boyle = [1.0 / (length - x) - 1.0 / (length + x) for x in (0.5, 1.0)]
    assert force[4] / force[3] == pytest.approx(boyle[1] / boyle[0], rel=2e-3)


def test_a_pouch_pulls_most_while_it_is_flat():
    made = SERIES.short("effective_area.pouch_motor")
    areas = at_places(made, AREA_AT, [-1.0, 0.0, 1.0])[:: int(made.effects[0].parameters["side"])]
    assert areas[1] == pytest.approx(1.0, abs=1e-3)
    ratio = (areas - 1.0) / 0.22 + 1.0
    for share, shorter in zip(ratio / ratio[1], (0.06, 0.14, 0.22), strict=True):
        angle = np.sqrt(6.0 * shorter)
        for _ in range(50):
            angle += (1.0 - shorter - np.sin(angle) / angle) / (np.cos(angle) / angle - np.sin(angle) / angle**2)
        if shorter == 0.06:
            flat = angle
        pulls = np.cos(angle) / angle
        assert share / (ratio[0] / ratio[1]) == pytest.approx(pulls / (np.cos(flat) / flat), rel=5e-3)
    assert 1.15 < areas[0] < 1.3
    assert 0.8 < areas[2] < 0.92


def test_a_voltage_dips_below_what_it_settles_at():
    made = of_twelve_seconds("drive_gain_change.generator_takes_up_a_load")
    plant, moment = made.plant(0), made.effects[0].parameters["moment"]
    gain = plant.by_time[GAIN_OF_TIME]
    assert np.all(gain[plant.times < moment] == 1.0)
    lowest = plant.times[np.argmin(gain)] - moment
    assert 0.09 * 12.0 < lowest < 0.12 * 12.0  # a little before half of a swing
    assert gain.min() == pytest.approx(0.7 - 0.3 * np.exp(-0.75), abs=0.02)
    assert gain[-1] == pytest.approx(0.7, abs=0.02)


def test_a_battery_on_the_upper_arm_is_borne_by_the_shoulder_alone():
    made = SERIES.short("payload.battery_on_the_upper_arm")
    assert made.nominal.place == 0
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    more = {name: loaded[name] - plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    mass, out = made.effects[0].parameters["share"] * n["m1"], 0.7 * n["l1"]
    assert (more["inertia"], more["gravity"]) == pytest.approx((mass * out**2, 9.81 * mass * out))
    assert (more["inertia_2"], more["coupling"], more["gravity_2"]) == (0.0, 0.0, 0.0)
    assert 0.15 < more["inertia"] / plain["inertia"] < 0.6


def test_windings_in_parallel_give_half_and_a_jet_is_even():
    made = SERIES.short("drive_gain.windings_in_parallel")
    assert np.unique(made.plant(0).by_time[GAIN_OF_TIME]) == pytest.approx([0.5])
    made = SERIES.short("constant_force.jet_of_coolant")
    (force,) = np.unique(made.plant(0).by_time[FORCE_OF_TIME])
    assert abs(force) / made.nominal.level == pytest.approx(0.6)
    assert force == made.plant(1).by_time[FORCE_OF_TIME][0]


def test_an_indexer_pushes_to_and_fro_and_dwells():
    made = SERIES.short("harmonic_force.indexer_on_the_frame")
    plant, frequency = made.plant(0), made.effects[0].parameters["frequency"]
    force = plant.by_time[FORCE_OF_TIME] / made.nominal.level
    whole = force[: round(np.floor(3.0 * frequency) / frequency * 1000.0)]
    assert whole.mean() == pytest.approx(0.0, abs=0.01)
    assert (whole.min(), whole.max()) == pytest.approx((-1.0, 1.0), abs=5e-3)
    assert np.mean(whole == 0.0) == pytest.approx(0.6, abs=0.01)
    later = np.interp(plant.times[:2000] + 1.0 / frequency, plant.times, force)
    np.testing.assert_allclose(later, force[:2000], atol=0.04)


@pytest.mark.parametrize(
    ("name", "load", "held"),
    [("joint_compliance.dish_behind_its_gear", 0.72, 0.25), ("backlash.drawbar_of_a_trolley", 0.6, 0.6)],
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


def test_four_lags_are_late_by_their_sum():
    made = SERIES.short("sensor_delay.four_equal_lags", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = made.record(0)["time [s]"], made.effects[0].parameters["delay"]
    begins = t > 0.2

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.2 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_a_mouse_dozes_while_the_joint_is_slow_alone():
    made = SERIES.short("stale_samples.dozes_while_slow", design="slide")
    shown, plain = shown_and_plain(made, "position")
    states, _ = made.states(0)
    fast = np.abs(states[:, 2]) > 0.45 * made.nominal.speed
    np.testing.assert_array_equal(shown[fast], plain[fast])
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = (np.arange(at.size) - at) / made.nominal.rate
    assert np.all(held >= 0.0)
    assert held.max() < 0.0702
    assert np.mean(held > 0.0) > 0.2


def test_a_decimal_point_slips_at_few_readings():
    made = SERIES.short("sensor_outliers.decimal_point_slips", design="slide")
    shown, plain = shown_and_plain(made, "position")
    hit = np.flatnonzero(shown != plain)
    assert 2 < hit.size < 0.01 * plain.size
    np.testing.assert_allclose(shown[hit], 0.1 * plain[hit])


def test_an_inclinometer_is_right_at_rest_and_errs_with_the_acceleration():
    made = SERIES.short("unknown.inclinometer_feels_the_swing")
    shown, plain = shown_and_plain(made, "position")
    states, _ = made.states(0)
    q, v = states[:, 0], states[:, 2]
    a, out = np.gradient(v, 1.0 / made.nominal.rate), made.effects[0].parameters["out"]
    a = np.convolve(a, np.ones(31) / 31.0, mode="same")
    off = shown - plain
    believed = np.arctan2(9.81 * np.sin(q) + out * a, 9.81 * np.cos(q) + out * v**2) - q
    inner = slice(100, -100)
    assert np.corrcoef(off[inner], believed[inner])[0, 1] > 0.97
    assert np.abs(off[inner]).max() < 0.8
    assert np.std(off[inner]) > 100.0 * made.nominal.sensor.position


def test_a_shutter_is_late_at_one_end_alone():
    made = of_twelve_seconds("unknown.rolling_shutter", "slide")
    shown, plain = shown_and_plain(made, "position")
    most, side = (made.effects[0].parameters[name] for name in ("most", "side"))
    t, u = made.record(0)["time [s]"], side * plain / made.nominal.reach
    begins = t > 0.1
    late = np.interp(t - most, t, plain)
    one, other = begins & (u < -0.8), begins & (u > 0.8)
    assert np.sum(one) > 10
    assert np.sum(other) > 10
    assert np.std((shown - plain)[one]) < 0.25 * np.std((late - plain)[one])
    assert np.std((shown - late)[other]) < 0.25 * np.std((late - plain)[other])


def test_a_counter_of_charges_loses_none_and_waits_longest_for_small_ones():
    made = SERIES.short("unknown.meter_counts_charges", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    step, charge = 1.0 / made.nominal.rate, made.effects[0].parameters["charge"]
    begins = np.flatnonzero(np.diff(shown)) + 1
    assert begins.size > 20
    for before, at in pairwise(begins):
        counted = np.sum(plain[before + 1 : at + 1]) * step
        assert abs(counted) >= charge * (1.0 - 1e-9)
        assert shown[at] == pytest.approx(counted / ((at - before) * step))
    waits, sizes = np.diff(begins), np.abs(shown[begins[1:]])
    assert waits[sizes < np.quantile(sizes, 0.2)].mean() > 2.0 * waits[sizes > np.quantile(sizes, 0.8)].mean()


def test_a_meter_hums_by_the_place_and_at_one_tone():
    made = SERIES.short("unknown.railway_hums_at_one_end", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    size, side = (made.effects[0].parameters[name] for name in ("size", "side"))
    t, u = made.record(0)["time [s]"], side * made.record(0)[column(made, "position")] / made.nominal.reach
    hum = (shown - plain) / size
    assert np.std(hum[u < -0.5]) < 0.1 * np.std(hum[u > 0.5])
    near = np.clip(0.5 + 0.5 * u, 0.0, 1.1) ** 2
    waves = np.stack([near * np.sin(2.0 * np.pi * 16.7 * t), near * np.cos(2.0 * np.pi * 16.7 * t)], axis=1)
    found = np.linalg.lstsq(waves, hum, rcond=None)[0]
    assert np.hypot(*found) == pytest.approx(1.0)
    np.testing.assert_allclose(hum, waves @ found, atol=1e-9)


@pytest.mark.parametrize("design", ["slide", "hinge", "arm"])
def test_a_hose_is_a_spring_of_which_little_is_left(design):
    made = of_twelve_seconds("unknown.hose_softens_as_it_warms", design)
    assert not made.nominal.declared
    record, plain = made.record(0), replace(made, effects=()).record(0)
    words = ("force", "voltage", "torque", "elbow_torque" if made.nominal.place else "shoulder_torque")
    name = column(made, *words)
    place = column(made, "position", "elbow_angle" if made.nominal.place else "shoulder_angle")
    pulls = (record[name] - plain[name]) * made.nominal.gain / made.nominal.level
    t, x = record["time [s]"], (record[place] - made.effects[0].parameters["rest"]) / made.nominal.reach
    first, last = t < 0.5, t > 11.5
    for part, left in ((first, 0.935), (last, 0.115)):
        assert np.sum(x[part] * pulls[part]) / np.sum(x[part] ** 2) == pytest.approx(1.5 * left, rel=0.06)
    for other in set(record) - {name}:
        np.testing.assert_array_equal(record[other], plain[other])


@pytest.mark.parametrize("seed", range(7, 11))
def test_a_harness_grips_one_joint_by_the_angle_of_the_other(seed):
    made = SERIES.short("unknown.harness_twists_in_the_other_joint", seed=seed)
    assert not made.nominal.declared
    record, plain = made.record(0), replace(made, effects=()).record(0)
    own, other = ("elbow", "shoulder") if made.nominal.place else ("shoulder", "elbow")
    more = (record[f"{own}_torque [N m]"] - plain[f"{own}_torque [N m]"]) / made.nominal.level
    np.testing.assert_array_equal(record[f"{other}_torque [N m]"], plain[f"{other}_torque [N m]"])
    states, _ = made.states(0)
    v = states[:, 2 + made.nominal.place]
    quick = np.abs(v) > 0.1 * made.nominal.speed
    twisted = made.effects[0].parameters["side"] * record[f"{other}_angle [rad]"] / made.nominal.reach
    np.testing.assert_allclose((more * np.sign(v))[quick], 0.8 * np.clip(twisted, -1.1, 1.1)[quick], atol=0.02)
    assert np.abs(more).max() < 0.9  # friction remains one


def test_a_fault_keeps_the_polish_of_its_quickest_step():
    law = friction("unknown.polished_by_its_quickest_step")
    assert law.added is not None
    speeds = np.repeat([1e-6, 1e-5, 1e-6, 3e-5, 3e-6], 600)
    t = np.arange(speeds.size) / slider.RATE
    added = law.added(t, np.concatenate([[0.0], np.cumsum(speeds[:-1])]) / slider.RATE)
    middle = added[300::600]
    assert middle == pytest.approx(-0.011 * np.log([1.0, 10.0, 10.0, 30.0, 30.0]), abs=1e-9)
    assert np.all(np.diff(added) < 1e-12)
    assert np.flatnonzero(np.diff(added) < -1e-6).size == 2


def test_a_block_has_a_law_of_the_way_in_each_slide_and_none_over_them():
    mus = [friction("unknown.gathers_dust_or_sheds_it", i).mu for i in range(60)]
    slopes = np.array([mu(1.0, 0.3) - mu(1.0, 0.0) for mu in mus]) / 0.28
    assert np.abs(slopes) == pytest.approx(1.0)
    assert abs(slopes.mean()) < 0.35
    assert min(mu(1.0, x) for mu in mus for x in (0.0, 0.6)) > 0.05


def test_codes_are_missing_and_no_other_step_is():
    made = SERIES.short("none.converter_misses_codes", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    step = 0.02 * made.nominal.level / made.nominal.gain
    codes = np.round(shown / step)
    np.testing.assert_allclose(shown, codes * step, atol=1e-9 * step)
    assert set(np.unique(np.mod(codes, 5.0))) == {0.0, 1.0, 2.0, 4.0}
    assert np.abs(shown - plain).max() <= 1.5001 * step


def test_a_head_buzzes_about_one_tone_and_is_no_louder_than_the_encoder():
    noise = buzz(np.random.default_rng(3), 200_000, 0.11, 4.0)
    assert noise.std() == pytest.approx(1.0, abs=0.02)
    power = np.abs(np.fft.rfft(noise.reshape(200, 1000), axis=1)) ** 2
    assert np.argmax(power.mean(axis=0)) / 1000.0 == pytest.approx(0.11, abs=0.015)


def test_rows_come_in_bursts_and_each_is_stamped_rightly():
    made = SERIES.short("none.rows_in_bursts", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    rows = np.round(record["time [s]"] * made.nominal.rate).astype(int)
    for name, x in record.items():
        np.testing.assert_array_equal(x, plain[name][rows])
    assert set(np.unique(np.diff(rows))) >= {1, 4}
    assert np.diff(rows).max() == 4
    assert rows.size / plain["time [s]"].size == pytest.approx(0.75, abs=0.07)


def test_single_precision_is_finer_than_the_noise():
    made = SERIES.short("none.single_precision", design="slide")
    shown, plain = shown_and_plain(made, "position")
    assert 0.0 < np.abs(shown - plain).max() < 0.1 * made.nominal.sensor.position
    t = made.record(0)["time [s]"]
    assert np.abs(np.diff(t) * made.nominal.rate - 1.0).max() < 1e-3


def test_a_head_shakes_more_the_faster_it_goes_and_arc_sine_noise_has_limits():
    made = SERIES.short("none.read_head_shakes_when_fast", design="slide")
    shown, plain = shown_and_plain(made, "position")
    states, _ = made.states(0)
    share, noise = np.abs(states[:, 2]) / made.nominal.speed, (shown - plain) / made.nominal.sensor.position
    assert noise[share > 0.6].std() > 3.0 * noise[share < 0.2].std()
    assert noise.std() < 3.0
    made = SERIES.short("none.arc_sine_noise_of_a_series", design="slide")
    shown, plain = shown_and_plain(made, "position")
    noise = (shown - plain) / made.nominal.sensor.position
    assert noise.std() == pytest.approx(2.0, rel=0.05)
    assert np.abs(noise).max() <= 2.0 * np.sqrt(2.0) * (1.0 + 1e-9)
    assert np.mean(np.abs(noise) > 2.0) == pytest.approx(0.5, abs=0.03)
