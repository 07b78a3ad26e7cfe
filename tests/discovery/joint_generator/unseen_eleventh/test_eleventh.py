"""The forms of the eleventh set at driven joints give finite records that they move, and nulls that nothing moves but noise."""

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
    GAIN_OF_TIME,
    Array,
    Plant,
)

from .nameless import least_room
from .null import rounded

SERIES = series_checks.Series(11)
MADE_UP_FOR = {"constant_force.web_under_tension": "size"}
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
    tenth = series_checks.Series(10)
    assert sorted(SERIES.kinds.values()) == sorted(tenth.kinds.values())
    cases = list(joint_plan.unseen_cases([1101], 11))
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
        "viscous_friction.damper_without_its_field",
        "direction_asymmetry.band_brake",
        "quadratic_damping.centrifugal_brake",
        "position_dependent_force.spring_with_a_helper",
        "drive_gain_change.capacitors_run_down",
        "harmonic_force.pump_of_three_plungers",
        "constant_force.web_under_tension",
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


def test_a_bearing_is_level_up_to_a_speed_and_then_goes_by_the_power_of_two_thirds():
    made = SERIES.short("viscous_friction.bearing_by_its_diameter")
    knee = made.effects[0].parameters["knee"]
    drag = drag_at(made, [0.2 * knee, 0.9 * knee, 0.125, 1.0])[0]
    assert drag[0] == pytest.approx(drag[1])
    assert drag[3] == pytest.approx(1.7, rel=1e-3)
    assert drag[3] / drag[2] == pytest.approx(4.0, rel=1e-3)


def test_a_damper_is_steep_to_a_speed_and_flat_beyond():
    made = SERIES.short("viscous_friction.damper_without_its_field")
    knee = made.effects[0].parameters["knee"]
    drag = drag_at(made, [0.5 * knee, knee, 0.5 * (1.0 + knee), 1.0])[0] / 1.3
    assert drag == pytest.approx([0.325, 0.65, 0.825, 1.0], abs=5e-3)


def test_a_lining_falls_by_a_ratio_of_roots():
    made = SERIES.short("velocity_weakening.lining_in_a_code")
    knee = made.effects[0].parameters["knee"] / made.nominal.speed
    more = drag_at(made, [0.0, knee, np.sqrt(3.0) * knee])[0]
    assert more == pytest.approx([1.0, 1.0 - np.sqrt(0.5), 1.0 - np.sqrt(0.75)], abs=2e-3)


def test_a_band_holds_one_way_as_the_exponential_of_its_wrap():
    made = SERIES.short("direction_asymmetry.band_brake")
    wrap = made.effects[0].parameters["wrap"]
    slow, half, fast = drag_at(made, [0.0, 0.5, 1.0]).T / 1.1
    assert np.ptp(slow) == pytest.approx(np.exp(wrap) + np.exp(-wrap) - 2.0, rel=1e-3)
    assert half.mean() == pytest.approx(0.0, abs=2e-3)
    assert np.all(fast < slow)
    assert min(slow.min(), fast.min()) * 1.1 > -0.6


def test_shoes_do_nothing_until_they_lift():
    made = SERIES.short("quadratic_damping.centrifugal_brake")
    lifts = made.effects[0].parameters["lifts"]
    drag = drag_at(made, [0.95 * lifts, np.hypot(lifts, 0.3), np.hypot(lifts, 0.6), 1.0])[0]
    assert drag[0] == 0.0
    assert drag[2] / drag[1] == pytest.approx(4.0, rel=5e-3)
    assert drag[3] == pytest.approx(1.2, rel=1e-3)


def test_a_film_rubs_more_than_twice_as_much_per_load_once_it_is_broken():
    made = SERIES.short("load_dependence.film_breaks_under_load")
    made = replace(made, nominal=replace(made.nominal, duration=12.0), true=replace(made.true, duration=12.0))
    plant, record, breaks = made.plant(0), made.record(0), made.effects[0].parameters["breaks"]
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    per_load = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME]) / load
    assert per_load[load > breaks + 0.5].mean() / per_load[load < breaks - 0.5].mean() == pytest.approx(2.3, abs=0.15)
    np.testing.assert_allclose(per_load, (0.65 + 0.9 / (1.0 + np.exp((breaks - load) / 0.15))) / 0.95, rtol=0.03)


def test_a_guide_dries_is_oiled_once_and_dries_again():
    made = SERIES.short("friction_drift.one_shot_of_the_oiler")
    made = replace(made, nominal=replace(made.nominal, duration=12.0), true=replace(made.true, duration=12.0))
    plant, shot = made.plant(0), made.effects[0].parameters["shot"]
    course = np.interp(12.0 * np.array([0.0, 0.5 * shot, shot, 0.9, 1.0]), plant.times, plant.by_time[FACTOR_OF_TIME])
    assert course[:3] == pytest.approx([1.0, 1.0 + 0.4 * shot, 1.0 + 0.8 * shot], abs=1e-3)
    assert course[3:] == pytest.approx([0.7 + 0.8 * (0.9 - shot), 0.7 + 0.8 * (1.0 - shot)], abs=1e-3)


def test_debris_ploughs_by_the_logarithm_of_the_strokes_alike_in_each_run():
    made = SERIES.short("distance_drift.grooves_stroke_by_stroke")
    one, other = made.plant(0).by_stroke, made.plant(1).by_stroke
    np.testing.assert_array_equal(one, other)
    assert one[[0, 12]] == pytest.approx([1.0, 1.75])
    assert one[72] - one[12] == pytest.approx(0.75)


def test_a_clearance_closes_by_its_inverse():
    made = SERIES.short("temperature_drift.clearance_closes")
    plant, record = made.plant(0), made.record(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    np.testing.assert_allclose(factor, 1.0 + 0.75 * (18.0 / (46.0 - record["temperature [degC]"]) - 1.0), rtol=0.02)


def test_four_scrapers_give_five_levels():
    made = SERIES.short("random_coefficients.four_scrapers")
    level = np.concatenate([made.plant(i).by_stroke for i in range(20)])
    values, counts = np.unique(np.round(level, 6), return_counts=True)
    assert values == pytest.approx(1.0 + 0.22 * np.arange(-2, 3))
    assert counts / level.size == pytest.approx(np.array([1, 4, 6, 4, 1]) / 16.0, abs=0.02)
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05


def test_grades_are_a_geometric_series():
    mu = np.unique([friction("random_coefficients.block_of_one_of_five_grades", i).mu(1.0, 0.0) for i in range(60)])
    assert mu.size == 5
    assert mu[1:] / mu[:-1] == pytest.approx(10.0 ** (1.0 / 18.0))
    assert 0.2 < mu.min() < mu.max() < 0.4


def test_a_chip_stays_for_five_strokes_in_the_mean():
    made = SERIES.short("correlated_coefficients.chip_under_the_wiper")
    off = np.concatenate([made.plant(i).by_stroke for i in range(40)]) - 1.0
    assert np.unique(np.round(off, 6)).size == 2
    assert off.std() == pytest.approx(0.33, rel=0.05)
    assert off.mean() == pytest.approx(0.0, abs=0.02)
    one, two = (np.corrcoef(off[k:], off[:-k])[0, 1] for k in (1, 2))
    kept = 1.0 - 1.0 / 7.0 - 0.2
    assert (one, two) == pytest.approx((kept, kept**2), abs=0.04)


def test_contacts_are_never_younger_than_the_cut_off():
    law = friction("frictional_lag.heals_after_a_cut_off")
    case = Case("frictional_lag.heals_after_a_cut_off", "slider", 1.0, 7)
    cut_off = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).parameters["cut_off"]
    (distance,) = law.distance
    for speed in (1e-6, 3e-5, 1e-2):
        assert law.state(distance / speed + cut_off, speed, distance) == pytest.approx(0.0)
    assert law.state(cut_off, 1.0, distance) == pytest.approx(1.0)
    assert (law.b[0] - law.a) / distance < 1500.0  # the softest frame slides without sticking


def test_a_bent_rail_is_a_cubic():
    made = SERIES.short("position_dependent_friction.rail_bent_in_an_s")
    factor, more = at_places(made, FACTOR_AT, [-1.0, -np.sqrt(0.2), 0.0, np.sqrt(0.2), 1.0]), 0.65
    side = np.sign(made.effects[0].parameters["more"])
    turn = 2.5 * 0.4 * np.sqrt(0.2)
    assert (factor - 1.0) * side / more == pytest.approx([-1.0, turn, 0.0, -turn, 1.0], abs=5e-3)


def test_each_board_has_a_friction_of_its_own():
    mu = friction("position_dependent_friction.three_boards").mu
    assert [mu(1.0, x) for x in (0.0, 0.079, 0.081, 0.179, 0.181, 0.5)] == pytest.approx(
        [0.195, 0.195, 0.39, 0.39, 0.273, 0.273]
    )


def test_a_helper_makes_a_spring_more_than_four_times_as_stiff():
    made = SERIES.short("position_dependent_force.spring_with_a_helper")
    slopes = np.diff(at_places(made, FORCE_AT, [-0.9, -0.7, 0.7, 0.9])) / made.nominal.level / 0.2
    assert sorted(slopes[[0, 2]]) == pytest.approx([0.4, 1.8], abs=0.01)


def test_a_pleated_muscle_pulls_most_before_it_contracts():
    made = SERIES.short("effective_area.pleated_muscle")
    areas = sorted(at_places(made, AREA_AT, [-1.0, 0.0, 1.0]))
    assert areas == pytest.approx([1.0 + 0.25 * (1.75**-0.5 - 1.0), 1.0, 1.25], abs=1e-3)


def test_the_energy_of_capacitors_falls_evenly():
    made = SERIES.short("drive_gain_change.capacitors_run_down")
    plant = made.plant(0)
    energy = plant.by_time[GAIN_OF_TIME] ** 2
    assert energy[0] == 1.0
    np.testing.assert_allclose(np.diff(energy), np.diff(energy)[0], rtol=1e-6, atol=1e-12)


def test_a_camera_weighs_half_way_along_the_forearm():
    made = SERIES.short("payload.camera_on_the_forearm")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    more = {name: loaded[name] - plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    mass = more["inertia"] / n["l1"] ** 2
    assert 0.8 < mass / n["m2"] < 1.0
    assert more["inertia_2"] == pytest.approx(mass * 0.25 * n["l2"] ** 2)
    assert more["coupling"] ** 2 == pytest.approx(more["inertia"] * more["inertia_2"])
    assert (more["gravity"], more["gravity_2"]) == pytest.approx((9.81 * mass * n["l1"], 9.81 * mass * 0.5 * n["l2"]))


def test_a_pump_pushes_in_arches_without_a_mean():
    made = SERIES.short("harmonic_force.pump_of_three_plungers")
    plant, size = made.plant(0), 1.3 * made.nominal.level
    force, frequency = plant.by_time[FORCE_OF_TIME] / size, made.effects[0].parameters["frequency"]
    whole = round(np.floor(3.0 * frequency) / frequency * 1000.0)
    assert force[:whole].mean() == pytest.approx(0.0, abs=0.01)
    assert np.ptp(force) == pytest.approx(1.0, abs=0.02)
    tones = np.abs(np.fft.rfft(force[:whole]))
    assert np.argmax(tones[1:]) + 1 == round(np.floor(3.0 * frequency))


@pytest.mark.parametrize("name", ["joint_compliance.belt_in_an_h", "backlash.worm_of_a_rotary_table"])
def test_a_link_parts_inertia_and_friction_and_adds_none(name):
    made = SERIES.short(name)
    plain, linked = made.plant(0, with_effects=False), made.plant(0)
    assert linked.body["rotor"] + linked.body["inertia"] == pytest.approx(plain.body["inertia"])
    assert linked.body["rotor"] / plain.body["inertia"] == pytest.approx(0.3)
    assert sum(linked.coulomb) == pytest.approx(plain.coulomb[0])
    assert linked.body["link_damping"] > 0.0


def test_a_tracker_is_late_by_an_exposure_and_a_half():
    made = SERIES.short("sensor_delay.averages_and_then_sends", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = made.record(0)["time [s]"], made.effects[0].parameters["delay"]
    begins = t > 0.2

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.2 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_telegrams_fail_where_the_motor_is_strained_and_hold_the_last_reading():
    made = SERIES.short("stale_samples.telegrams_fail_under_current", design="slide")
    shown, plain = shown_and_plain(made, "position")
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = np.arange(at.size) - at
    assert np.all(held >= 0)
    assert 0.03 < np.mean(held > 0) < 0.7
    strained = np.abs(made.record(0)[column(made, "force", "voltage")])
    assert strained[held > 0].mean() > 1.1 * strained[held == 0].mean()


def test_a_minus_is_lost_below_zero_alone():
    made = SERIES.short("sensor_outliers.minus_is_lost", design="slide")
    shown, plain = shown_and_plain(made, "position")
    hit = np.flatnonzero(shown != plain)
    assert 3 < hit.size < 0.02 * plain.size
    assert np.all(plain[hit] < 0.0)
    np.testing.assert_array_equal(shown[hit], -plain[hit])


def test_a_hose_has_one_slope_and_another_rest_in_each_run():
    made = SERIES.short("unknown.hose_is_laid_anew")
    level, reach = made.nominal.level, made.nominal.reach
    rests = []
    for i in range(12):
        plant = made.plant(i)
        force = np.interp(reach * np.array([0.0, 1.0]), plant.places, plant.by_place[FORCE_AT]) / level
        assert np.diff(force)[0] == pytest.approx(0.6, rel=1e-3)
        rests.append(force[0] / 0.6)
    assert 0.39 < np.abs(rests).min() < np.abs(rests).max() < 1.61
    assert min(rests) < 0.0 < max(rests)


def test_a_transformer_shows_too_little_toward_both_ends_and_never_turns_back():
    made = SERIES.short("unknown.transformer_beyond_its_range", design="slide")
    shown, plain = shown_and_plain(made, "position")
    u = plain / made.nominal.reach
    np.testing.assert_allclose(shown, plain * (1.0 - 0.24 * np.clip(u, -1.2, 1.2) ** 2), atol=1e-12)
    places = np.linspace(-1.15, 1.15, 400)
    assert np.all(np.diff(places * (1.0 - 0.24 * places**2)) > 0.0)


def test_a_wheel_loses_way_when_it_is_jerked_alone():
    made = SERIES.short("unknown.wheel_slips_when_jerked", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, limit = made.record(0)["time [s]"], made.effects[0].parameters["limit"]
    states, _ = made.states(0)
    lost = np.gradient(plain - shown, t)
    jerked = np.abs(np.gradient(states[:, 2], t)) > 1.4 * limit
    calm = np.convolve(np.abs(np.gradient(states[:, 2], t)) > 0.6 * limit, np.ones(61), mode="same") == 0.0
    v = states[:, 2]
    assert np.mean(np.abs(lost[calm])) < 0.01 * np.mean(np.abs(v))
    assert np.sum(lost[jerked] * v[jerked]) > 0.1 * np.sum(v[jerked] ** 2)


def test_a_wire_winds_up_no_faster_than_its_spring_does():
    made = SERIES.short("unknown.draw_wire_goes_slack", design="slide")
    shown, plain = shown_and_plain(made, "position")
    fastest, side = (made.effects[0].parameters[name] for name in ("fastest", "side"))
    t = made.record(0)["time [s]"]
    assert np.all(side * (shown - plain) >= 0.0)
    assert (side * np.diff(shown)).min() > -1.01 * fastest * np.median(np.diff(t))
    assert 0.05 < np.mean(shown != plain) < 0.9


def test_oil_drags_in_each_run_by_another_coefficient():
    made = SERIES.short("unknown.oil_of_the_day")
    speed, level = made.nominal.speed, made.nominal.level
    drags = [np.interp(speed, p.speeds, p.by_speed[0]) / level for p in (made.plant(i) for i in range(60))]
    assert 0.07 < min(drags) < 0.4
    assert 1.3 < max(drags) < 1.61


@pytest.mark.parametrize("seed", range(7, 19))
def test_a_rotor_couples_the_joints_and_changes_neither_alone(seed):
    made = SERIES.short("unknown.rotor_couples_the_joints", seed=seed)
    plain, coupled = made.plant(0, with_effects=False).body, made.plant(0).body

    def inertia(n: dict[str, float], angle: float) -> Array:
        c = n["coupling"] * np.cos(angle)
        both = n["inertia_2"] + c
        return np.array([[n["inertia"] + n["inertia_2"] + 2.0 * c + n["rotor"], both], [both, n["inertia_2"] + n["rotor_2"]]])

    for angle in np.linspace(0.0, np.pi, 7):
        more = inertia(coupled, angle) - inertia(plain, angle)
        assert np.diag(more) == pytest.approx([0.0, 0.0], abs=1e-12)
        assert more[0, 1] == pytest.approx(0.6 * least_room(plain))
        assert np.linalg.eigvalsh(inertia(coupled, angle)).min() > 0.0
    assert coupled["gravity"] == plain["gravity"]


def test_a_sample_settles_anew_at_each_step_and_in_each_run():
    name = "unknown.settles_anew_at_each_step"
    t = np.arange(3000) / slider.RATE
    one, other = (friction(name, i).added(t, 0.0 * t) for i in range(2))
    assert np.unique(one).size == 5
    assert np.flatnonzero(np.diff(one)).tolist() == [599, 1199, 1799, 2399]
    assert not np.any(one == other)


def test_a_sole_has_a_law_of_the_speed_in_each_slide_and_none_over_them():
    mus = [friction("unknown.sole_is_wet_or_dry", i).mu for i in range(60)]
    slopes = np.array([mu(1.2, 0.0) - mu(0.2, 0.0) for mu in mus]) / (0.28 * 0.55 / 0.7)
    assert np.abs(slopes) == pytest.approx(1.0)
    assert abs(slopes.mean()) < 0.35
    assert min(mu(v, 0.0) for mu in mus for v in (0.0, 1.5)) > 0.05


def test_numbers_keep_their_first_digits():
    assert rounded(np.array([123.456, -0.00987654, 0.0, 99.96]), 3) == pytest.approx([123.0, -0.00988, 0.0, 100.0])


def test_rows_are_fewer_while_slow_and_each_is_stamped_rightly():
    made = SERIES.short("none.fewer_rows_while_slow", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    rows = np.round(record["time [s]"] * made.nominal.rate).astype(int)
    for name, x in record.items():
        np.testing.assert_array_equal(x, plain[name][rows])
    assert set(np.unique(np.diff(rows))) <= {1, 2, 3}
    assert 0.35 < rows.size / plain["time [s]"].size < 0.95


def test_shot_noise_is_as_loud_as_the_noise_of_the_drive():
    made = SERIES.short("none.shot_noise_of_the_drive", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    assert np.std(shown - plain) == pytest.approx(series_checks.drive_noise(made), rel=0.15)
