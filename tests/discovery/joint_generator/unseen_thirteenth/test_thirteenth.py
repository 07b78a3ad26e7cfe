"""The forms of the thirteenth set at driven joints give finite records that they move; nulls nothing moves but noise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import gamma

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import Case, Made
from tests.discovery.joint_generator.forms import Record
from tests.discovery.joint_generator.plant import (
    AREA_AT,
    BACKWARD,
    FACTOR_AT,
    FACTOR_OF_TIME,
    FACTOR_ON_SPEED,
    FORCE_AT,
    FORCE_OF_TIME,
    FORWARD,
    GAIN_OF_TIME,
    Array,
    Plant,
)

from .mechanism import dipped, ringing
from .nameless import half_derivative, structure
from .null import clustered
from .sensor import lag_of_one_radian

SERIES = series_checks.Series(13)
MADE_UP_FOR = {"constant_force.wind_from_one_side": "size"}
"""What the controller makes up for, and is seen against what is believed."""


def column(record: Record, *begins: str) -> str:
    """Name of the first column that begins so."""
    return next(name for name in record if name.startswith(begins))


def shown_and_plain(made: Made, *begins: str) -> tuple[Array, Array]:
    """A column with and without the effects."""
    record = made.record(0)
    name = column(record, *begins)
    return record[name], replace(made, effects=()).record(0)[name]


def stamps(made: Made) -> Array:
    """Of the first run's rows [s]."""
    return np.arange(round(made.nominal.duration * made.nominal.rate) + 1) / made.nominal.rate


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


def drive_and_motion(made: Made) -> tuple[Array, Array, Array, Array]:
    """What a single drive shows beyond the plain one, in believed frictions; place, speed and time of the states."""
    shown, plain = shown_and_plain(made, "force", "torque", "voltage")
    states, _ = made.states(0)
    more = (shown - plain) * made.nominal.gain / made.nominal.level
    return more, states[:, 0], states[:, 2], np.arange(len(states)) / made.nominal.rate


def test_the_set_is_as_wide_as_asked_for():
    assert SERIES.counts() == (27, 10, 10, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    twelfth = [kind for kind in series_checks.Series(12).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(kind for kind in SERIES.kinds.values() if kind not in ("unknown", "none")) == sorted(twelfth)
    cases = list(joint_plan.unseen_cases([1301], 13))
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
        made = SERIES.short(name)
        made = replace(made, nominal=replace(made.nominal, duration=1.5), true=replace(made.true, duration=1.5))
        again = replace(made, effects=SERIES.short(name).effects)
        series_checks.assert_same(made.record(0), again.record(0))


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
        "viscous_friction.short_journal_bearing",
        "velocity_weakening.wheels_aquaplane",
        "direction_asymmetry.over_a_counterbalance_valve",
        "quadratic_damping.rough_boom_in_water",
        "position_dependent_force.float_dips_in",
        "drive_gain_change.tank_between_two_switch_points",
        "harmonic_force.punch_press_rings",
        "constant_force.wind_from_one_side",
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


def test_a_short_bearing_drags_by_three_quarters_while_slow_and_by_petroff_when_fast():
    made = SERIES.short("viscous_friction.short_journal_bearing")
    drag = drag_at(made, [0.0, 0.01, 0.02, 1.0, 3.0, 3.9])[0]
    assert (drag[0], drag[3]) == pytest.approx((0.0, 1.2), abs=5e-3)
    assert np.log2(drag[2] / drag[1]) == pytest.approx(0.75, abs=0.03)
    assert np.log(drag[5] / drag[4]) / np.log(1.3) == pytest.approx(1.0, abs=0.05)


def test_vortices_make_a_line_steeper_from_a_speed_on():
    made = SERIES.short("viscous_friction.vortices_in_an_oiled_gap")
    critical = made.effects[0].parameters["critical"]
    drag = drag_at(made, [0.0, 0.5 * critical, critical, 1.02 * critical, 4.0 * critical, 8.0 * critical, 1.0])[0]
    assert drag[0] == 0.0
    assert drag[2] / drag[1] == pytest.approx(2.0, rel=5e-3)
    assert (drag[3] - drag[2]) / drag[2] / 0.02 == pytest.approx(2.54, abs=0.1)
    assert np.log2(drag[5] / drag[4]) == pytest.approx(1.36, abs=0.05)
    assert drag[6] == pytest.approx(1.2, rel=2e-3)


def test_water_bears_the_square_of_the_speed_until_it_bears_all():
    made = SERIES.short("velocity_weakening.wheels_aquaplane")
    planing = made.effects[0].parameters["planing"] / made.nominal.speed
    more = drag_at(made, [0.0, 0.5 * planing, 0.8 * planing, 1.1 * planing, 1.0])[0] / 0.95
    assert more == pytest.approx([1.0, 0.75, 0.36, 0.0, 0.0], abs=5e-3)


def test_a_counterbalance_valve_holds_one_way_and_opens_the_other_way():
    made = SERIES.short("direction_asymmetry.over_a_counterbalance_valve")
    ways = drag_at(made, [0.0, 0.5, 1.0])
    lowered, raised = ways if made.effects[0].parameters["forward"] else ways[::-1]
    assert lowered == pytest.approx([0.5, 0.6, 0.7], abs=2e-3)
    assert raised == pytest.approx([-0.4, -0.35, -0.2], abs=2e-3)
    assert raised.min() > -0.7  # what is left of Coulomb's where it is a third less than believed


def test_a_rough_boom_loses_a_third_of_its_coefficient_at_one_speed():
    made = SERIES.short("quadratic_damping.rough_boom_in_water")
    drag = drag_at(made, [0.1, 0.2, 0.3, 0.7, 1.0, 2.0])[0]
    assert drag[1] / drag[0] == pytest.approx(4.0, rel=0.02)
    assert drag[5] / drag[4] == pytest.approx(4.0, rel=0.02)
    assert drag[2] / 0.09 / (drag[4] / 1.0) == pytest.approx(1.1 / 0.74, rel=0.03)
    assert drag[4] == pytest.approx(1.3, rel=2e-3)
    assert np.all(np.diff(made.plant(0).by_speed[0]) >= 0.0)


def test_a_liner_rubs_as_its_load_until_it_shears():
    made = of_twelve_seconds("load_dependence.soft_liner_shears")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    assert factor[load > 0.95].std() < 0.01
    assert factor[load > 0.95].mean() == pytest.approx(1.08, abs=0.01)
    light = load < 0.85
    assert (factor / load)[light].mean() == pytest.approx(1.2, abs=0.01)
    assert (load.min(), load.max()) == pytest.approx((0.4, 1.9), abs=0.03)


def test_a_film_is_squeezed_out_as_the_inverse_root_of_a_line():
    made = of_twelve_seconds("friction_drift.oil_is_squeezed_out")
    plant, time = made.plant(0), made.effects[0].parameters["time"]
    factor = np.interp(np.array([0.0, 3.0, 8.0]) * time, plant.times, plant.by_time[FACTOR_OF_TIME])
    assert factor == pytest.approx(1.0 + 1.1 * (1.0 - np.array([1.0, 0.5, 1.0 / 3.0])), abs=2e-3)
    assert np.all(np.diff(plant.by_time[FACTOR_OF_TIME]) > 0.0)


def test_a_bush_runs_in_first_and_wears_then_alike_in_each_run():
    made = SERIES.short("distance_drift.runs_in_and_then_wears")
    one, other = made.plant(0).by_stroke, made.plant(1).by_stroke
    np.testing.assert_array_equal(one, other)
    least = int(np.argmin(one))
    assert 3 <= least <= 7
    assert one[1] - one[least] > 0.4
    np.testing.assert_allclose(np.diff(one)[12:15], 0.1, atol=0.01)
    assert 0.6 < one.min() < one.max() < 2.0


def test_rails_strain_to_either_side_of_the_temperature_that_fits():
    made = of_twelve_seconds("temperature_drift.rails_fit_at_one_temperature")
    plant, record = made.plant(0), made.record(0)
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    celsius = record["temperature [degC]"]
    for side in (celsius > 22.0, celsius < 21.0):
        slope = np.polyfit(celsius[side], factor[side], 1)[0]
        assert abs(slope) == pytest.approx(0.8 / 3.5, rel=0.05)
        assert np.sum(side) > 0.1 * celsius.size
    assert np.polyfit(celsius[celsius < 21.0], factor[celsius < 21.0], 1)[0] < 0.0
    assert 0.55 < factor.min() < 0.65
    assert 1.3 < factor.max() < 1.6
    assert celsius.min() < 19.5
    assert abs(np.corrcoef(record["time [s]"], celsius)[0, 1]) < 0.5


def test_six_facets_bear_alike_and_stay_for_one_stroke():
    made = SERIES.short("random_coefficients.disc_of_six_facets")
    level = np.concatenate([made.plant(i).by_stroke for i in range(20)])
    facet = np.round((level - 1.0) / 0.16 + 2.5).astype(int)
    np.testing.assert_allclose(level, 1.0 + 0.16 * (facet - 2.5))
    assert np.bincount(facet, minlength=6) / facet.size == pytest.approx(np.full(6, 1.0 / 6.0), abs=0.02)
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05


def test_the_hardest_grain_has_a_tail_to_above_alone():
    mu = np.array([friction("random_coefficients.hardest_grain_decides", i).mu(1.0, 0.0) for i in range(600)])
    grain = (mu - 0.28) / 0.13 + 1.225
    assert np.median(grain) == pytest.approx(np.log(2.0) ** -0.25, abs=0.06)
    assert grain.mean() == pytest.approx(gamma(0.75), abs=0.07)
    assert np.quantile(grain, 0.99) - np.median(grain) > 3.0 * (np.median(grain) - np.quantile(grain, 0.01))
    assert mu.min() > 0.15


def test_chips_that_stay_keep_a_level_and_their_number_is_poissons():
    made = SERIES.short("correlated_coefficients.chips_stay_or_are_swept")
    runs = np.stack([made.plant(i).by_stroke for i in range(40)])
    number = np.round((runs - 1.0) / 0.22 + 2.0)
    np.testing.assert_allclose(runs, 1.0 + 0.22 * (number - 2.0))
    assert number.min() == 0.0
    assert number.mean() == pytest.approx(2.0, abs=0.08)
    assert number.var() == pytest.approx(2.0, abs=0.2)
    off = number - number.mean()
    kept = [np.mean(off[:, k:] * off[:, :-k]) / np.mean(off**2) for k in (1, 2, 3)]
    assert kept == pytest.approx([0.72, 0.72**2, 0.72**3], abs=0.05)


def test_contacts_are_renewed_to_no_less_than_a_cut_off_age():
    law = friction("frictional_lag.no_younger_than_a_cut_off")
    (distance,) = law.distance

    def steady(speed: float) -> float:
        ages = np.linspace(0.1, 30.0, 30_000)
        rates = np.array([law.state(age, speed, distance) for age in ages])
        return float(ages[np.argmin(np.abs(rates))])

    least = steady(1e-6) - distance / 1e-6
    assert 0.29 < least < 0.51
    assert steady(3e-5) == pytest.approx(distance / 3e-5 + least, abs=2e-3)
    slow, fast = (law.a * np.log(10.0) + law.b[0] * np.log(steady(10.0 * v) / steady(v)) for v in (1e-6, 1e-5))
    assert slow < 0.0 < fast  # it weakens while slow, and strengthens when fast
    assert (law.b[0] - law.a) / distance < 1500.0  # the softest frame slides without sticking


def test_a_telescope_is_pressed_by_its_overhang_over_its_overlap():
    made = SERIES.short("position_dependent_friction.telescope_drawn_out")
    side = int(made.effects[0].parameters["side"])
    factor = (at_places(made, FACTOR_AT, [-1.0, -0.5, 0.0, 0.5, 1.0])[::side] - 1.0) / 0.9 + 1.0
    pressed = 1.0 + 2.0 * np.array([0.2 / 3.6, 0.7 / 3.1, 1.2 / 2.6, 1.7 / 2.1, 2.2 / 1.6])
    assert factor == pytest.approx(pressed / pressed[2], abs=5e-3)
    assert np.all(np.diff(factor, 2) > 0.0)


def test_a_milled_table_waves_alike_in_each_slide():
    one, other = (friction("position_dependent_friction.waves_of_a_milled_table", i).mu for i in (0, 1))
    x = np.linspace(0.0, 0.28, 281)[:-1]
    mu = np.array([one(1.0, float(at)) for at in x])
    assert np.array([other(0.3, float(at)) for at in x]) == pytest.approx(mu)
    assert np.abs(np.fft.rfft(mu / 0.28))[[0, 2]] * 2.0 / x.size == pytest.approx([2.0, 0.45], abs=1e-9)
    assert mu.std() == pytest.approx(0.28 * 0.45 / np.sqrt(2.0), rel=1e-6)


def test_a_float_pushes_as_the_segment_that_dips_in():
    assert dipped(np.array([-0.2, 0.0, 0.25, 0.5, 1.0, 1.3])) == pytest.approx([0.0, 0.0, 0.19550, 0.5, 1.0, 1.0], abs=1e-5)
    made = SERIES.short("position_dependent_force.float_dips_in")
    side, middle, width = (made.effects[0].parameters[name] for name in ("side", "middle", "width"))
    places = side * (middle + width * np.array([-0.7, 0.0, 0.25, 0.7]))
    force = side * at_places(made, FORCE_AT, list(places)) / made.nominal.level
    assert force == pytest.approx([-0.65, 0.0, 1.3 * 0.30450, 0.65], abs=6e-3)


def test_a_muscle_pulls_by_an_exponential_and_a_line():
    made = SERIES.short("effective_area.fluidic_muscle_as_fitted")
    areas = at_places(made, AREA_AT, [-1.0, -0.5, 0.0, 0.5, 1.0])[:: int(made.effects[0].parameters["side"])]
    percent = np.array([1.0, 4.5, 8.0, 11.5, 15.0])
    pulls = 1.0 - 0.035 * percent + 0.35 * np.exp(-0.33 * percent)
    assert areas == pytest.approx(1.0 + 0.42 * (pulls / pulls[2] - 1.0), abs=3e-3)
    assert 1.2 < areas[0] < 1.3
    assert 0.8 < areas[4] < 0.9


def test_a_tank_empties_slowly_and_is_filled_faster():
    made = of_twelve_seconds("drive_gain_change.tank_between_two_switch_points")
    plant = made.plant(0)
    loss, falls, rises = (made.effects[0].parameters[name] for name in ("loss", "falls", "rises"))
    at = np.array([0.0, 0.5 * falls, falls, falls + 0.5 * rises, falls + rises, 2.0 * falls + rises])
    gain = np.interp(at, plant.times, plant.by_time[GAIN_OF_TIME])
    assert gain == pytest.approx(1.0 - loss * np.array([0.0, 0.5, 1.0, 0.5, 0.0, 1.0]), abs=2e-3)
    assert falls > 1.7 * rises
    np.testing.assert_array_equal(plant.by_time[GAIN_OF_TIME], made.plant(1).by_time[GAIN_OF_TIME])


def test_a_weight_behind_the_elbow_takes_off_its_moment_and_adds_inertia():
    made = SERIES.short("payload.counterweight_behind_the_elbow")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    more = {name: loaded[name] - plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    mass, tail = made.effects[0].parameters["share"] * n["m2"], 0.55 * n["l2"]
    assert (more["inertia"], more["gravity"]) == pytest.approx((mass * n["l1"] ** 2, 9.81 * mass * n["l1"]))
    assert (more["inertia_2"], more["gravity_2"]) == pytest.approx((mass * tail**2, -9.81 * mass * tail))
    assert more["coupling"] == pytest.approx(-mass * n["l1"] * tail)
    for angle in (1.0, -1.0):  # the inertia that both joints share stays that of a body
        shared = loaded["inertia_2"] + angle * loaded["coupling"]
        whole = loaded["inertia"] + loaded["inertia_2"] + 2.0 * angle * loaded["coupling"]
        assert whole * loaded["inertia_2"] >= shared**2 * (1.0 - 1e-9)


def test_a_small_displacement_gives_three_fifths_and_a_wind_is_even():
    made = SERIES.short("drive_gain.motor_left_in_its_small_displacement")
    assert np.unique(made.plant(0).by_time[GAIN_OF_TIME]) == pytest.approx([0.6])
    made = SERIES.short("constant_force.wind_from_one_side")
    (force,) = np.unique(made.plant(0).by_time[FORCE_OF_TIME])
    assert abs(force) / made.nominal.level == pytest.approx(0.65)
    assert force == made.plant(1).by_time[FORCE_OF_TIME][0]


def test_a_floor_rings_at_each_stroke_of_a_press_and_pushes_nowhere_in_the_mean():
    s = np.arange(20_000) / 20_000
    assert ringing(s).mean() == pytest.approx(0.0, abs=1e-4)
    assert ringing(s).max() == pytest.approx(1.0, abs=1e-4)
    assert ringing(s[s > 0.75]).max() < 0.2
    assert ringing(s + 3.0) == pytest.approx(ringing(s), abs=1e-9)
    made = SERIES.short("harmonic_force.punch_press_rings")
    plant, frequency = made.plant(0), made.effects[0].parameters["frequency"]
    force = plant.by_time[FORCE_OF_TIME] / made.nominal.level
    assert force.max() == pytest.approx(0.9, abs=5e-3)
    later = np.interp(plant.times[:2000] + 1.0 / frequency, plant.times, force)
    assert np.corrcoef(later, force[:2000])[0, 1] > 0.99


@pytest.mark.parametrize(
    ("name", "load", "held"),
    [("joint_compliance.mast_of_a_stacker_crane", 0.5, 0.2), ("backlash.open_teeth_of_a_slewing_ring", 0.8, 0.45)],
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


def test_an_elliptic_filter_is_late_by_what_it_is_said_to_be():
    assert 1.0 < lag_of_one_radian() < 4.0
    made = SERIES.short("sensor_delay.behind_a_cauer_filter", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = stamps(made), made.effects[0].parameters["delay"]
    begins = t > 0.3

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.25 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_a_file_that_grows_is_written_for_longer_and_longer():
    made = of_twelve_seconds("stale_samples.file_grows", "slide")
    shown, plain = shown_and_plain(made, "position")
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held, t = (np.arange(at.size) - at) / made.nominal.rate, stamps(made)
    assert np.all(held >= 0.0)
    for part, share in ((t < 3.0, 0.25 + 0.75 * 0.125), (t > 9.0, 0.25 + 0.75 * 0.875)):
        assert np.mean(held[part] > 0.0) == pytest.approx(0.1 * share / 0.2, abs=0.05)
    assert held.max() < 0.1001


def test_a_wiper_lifts_to_one_end_of_the_scale():
    made = SERIES.short("sensor_outliers.wiper_lifts", design="slide")
    shown, plain = shown_and_plain(made, "position")
    hit = np.flatnonzero(shown != plain)
    assert 2 < hit.size < 0.01 * plain.size
    assert np.unique(shown[hit]) == pytest.approx([made.effects[0].parameters["end"]])
    assert abs(shown[hit[0]]) > np.abs(plain).max()


@pytest.mark.parametrize("design", ["slide", "hinge"])
def test_a_linkage_adds_inertia_by_the_place_and_takes_no_energy(design):
    made = of_twelve_seconds("unknown.linkage_behind_the_joint", design)
    assert not made.nominal.declared
    more, q, v, t = drive_and_motion(made)
    size, wave, start = (made.effects[0].parameters[name] for name in ("size", "wave", "start"))
    assert size / made.nominal.inertia == pytest.approx(0.5)
    stored = 0.5 * size * np.sin(wave * q + start) * v**2 / made.nominal.level
    worked = np.concatenate([[0.0], np.cumsum(0.5 * (more[1:] * v[1:] + more[:-1] * v[:-1]) * np.diff(t))])
    inner = slice(200, -200)
    off = (worked - stored)[inner] - (worked - stored)[200]
    assert np.abs(off).max() < 0.1 * np.ptp(stored)


def test_a_rotor_shakes_by_the_square_of_the_speed_and_by_its_angle():
    made = of_twelve_seconds("unknown.rotor_out_of_balance", "slide")
    more, q, v, _ = drive_and_motion(made)
    pitch, start = (made.effects[0].parameters[name] for name in ("pitch", "start"))
    angle, u = 2.0 * np.pi * q / pitch + start, np.abs(v) / made.nominal.speed
    inner, sizes = slice(100, -100), []
    for low, high in ((0.3, 0.45), (0.6, 0.9)):
        at = np.flatnonzero((u > low) & (u < high))
        at = at[(at > 100) & (at < u.size - 100)]
        sizes.append(np.sum(more[at] * np.sin(angle[at])) / np.sum(np.sin(angle[at]) ** 2) / np.mean(u[at] ** 2))
    assert sizes == pytest.approx([2.0, 2.0], rel=0.2)
    assert np.abs(more[inner][u[inner] < 0.05]).max() < 0.05


def test_a_derivative_of_order_one_half_taken_twice_is_a_derivative():
    t = np.arange(4000) / 1000.0
    x = np.sin(3.0 * t) * t
    twice = half_derivative(half_derivative(x, 1e-3), 1e-3)
    assert twice[50:] == pytest.approx(np.gradient(x, t)[50:], abs=0.02 * np.abs(np.gradient(x, t)).max())
    made = of_twelve_seconds("unknown.rubber_of_half_order", "slide")
    more, q, v, _ = drive_and_motion(made)
    later = slice(more.size // 3, None)
    spring, drag = (float(np.corrcoef(more[later], x[later])[0, 1]) for x in (q, v))
    assert 0.4 < spring < 0.9
    assert 0.4 < drag < 0.9


def test_a_grease_is_soft_after_work_and_stiff_after_rest():
    step, rest, way = 1e-3, 0.8, 0.1
    speed = np.concatenate([np.full(4000, 0.5), np.zeros(1000), np.full(1000, 0.5)])
    left = structure(speed, step, rest, way)
    steady = 1.0 / (1.0 + rest * 0.5 / way)
    assert left[3999] == pytest.approx(steady, abs=1e-3)
    assert left[4999] == pytest.approx(1.0 - (1.0 - steady) * np.exp(-1.0 / rest), abs=2e-3)
    made = of_twelve_seconds("unknown.grease_is_worked_soft", "slide")
    more, _, v, _ = drive_and_motion(made)
    quick = np.abs(v) > 0.1 * made.nominal.speed
    per_speed = (more * made.nominal.speed / v)[quick]
    assert 0.1 < per_speed.min() < per_speed.max() < 3.2
    assert np.quantile(per_speed, 0.95) > 2.0 * np.quantile(per_speed, 0.05)


def test_the_last_stroke_decides_how_this_one_rubs():
    made = of_twelve_seconds("unknown.long_strokes_carry_oil", "slide")
    assert made.nominal.motion == "strokes"
    assert not made.nominal.declared
    more, q, v, _ = drive_and_motion(made)
    moving = np.abs(v) > 0.15 * made.nominal.speed
    parts = np.split(np.flatnonzero(moving), np.flatnonzero(np.diff(np.flatnonzero(moving)) > 1) + 1)
    levels = np.array([np.median(more[part] * np.sign(v[part])) for part in parts])
    turns = [q[part[0]] for part in parts] + [q[parts[-1][-1]]]
    lengths = np.abs(np.diff(turns)) / made.nominal.reach
    assert levels[0] == pytest.approx(0.0, abs=0.6)
    assert np.corrcoef(levels[2:], lengths[1:-1])[0, 1] < -0.8
    assert np.abs(levels).max() < 0.61
    assert np.ptp(levels[1:]) > 0.3


@pytest.mark.parametrize("seed", range(7, 10))
def test_a_rod_rubs_by_the_sum_of_both_speeds_in_both_drives_alike(seed):
    made = SERIES.short("unknown.rod_turns_in_the_base", seed=seed)
    record, plain = made.record(0), replace(made, effects=()).record(0)
    more = [(record[name] - plain[name]) / made.nominal.level for name in record if "torque" in name]
    np.testing.assert_allclose(more[0], more[1], atol=1e-9)
    states, _ = made.states(0)
    whole = states[:, 2] + states[:, 3]
    quick = np.abs(whole) > 0.15 * made.nominal.speed
    np.testing.assert_allclose(more[0][quick], 0.9 * np.sign(whole)[quick], atol=0.03)


def test_a_lip_bites_forward_alone_and_while_it_is_cold():
    made = of_twelve_seconds("unknown.lip_bites_when_cold")
    plant, record = made.plant(0), made.record(0)
    assert plant.by_speed[FORWARD] / made.nominal.level == pytest.approx(1.3)
    assert np.all(plant.by_speed[BACKWARD] == 0.0)
    bites = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_ON_SPEED])
    slope, at_zero = np.polyfit(record["temperature [degC]"], bites, 1)
    assert (slope, at_zero) == pytest.approx((-1.0 / 12.0, 32.0 / 12.0), rel=0.01)
    assert (bites.min(), bites.max()) == pytest.approx((0.0, 1.0), abs=0.01)


def test_an_indicator_is_off_by_a_constant_from_each_rest_on():
    made = of_twelve_seconds("unknown.indicator_tracks_its_zero", "slide")
    more, _, v, _ = drive_and_motion(made)
    u = np.abs(v) / made.nominal.speed
    moving = np.flatnonzero(u > 0.1)
    same = moving[1:][np.diff(moving) == 1]
    assert np.abs(more[same] - more[same - 1]).max() < 1e-9
    parts = np.split(moving, np.flatnonzero(np.diff(moving) > 1) + 1)
    offsets = np.array([more[part[0]] for part in parts])
    assert offsets.size > 4
    assert offsets.std() > 0.2


def test_a_load_is_stepped_at_other_times_in_each_run_and_slip_wears_off_the_answer():
    speeds = np.repeat([1e-6, 1e-5, 1e-6, 3e-5], 600)
    t = np.arange(speeds.size) / slider.RATE
    x = np.concatenate([[0.0], np.cumsum(speeds[:-1])]) / slider.RATE
    jumps = []
    for run in (0, 1):
        law = friction("unknown.load_is_stepped_unnoted", run)
        assert law.added is not None
        added = law.added(t, x)
        at = np.flatnonzero(np.abs(np.diff(added)) > 0.008) + 1
        assert 4 <= at.size <= 6
        between = np.setdiff1d(np.arange(1, t.size), at)
        kept = added[between - 1] * np.exp(-(x[between] - x[between - 1]) / 8e-6)
        np.testing.assert_allclose(added[between], kept, atol=1e-12)
        jumps.append(at)
    assert not np.intersect1d(*jumps).size


def test_a_ball_rolls_from_five_sevenths_of_its_own_start_on():
    law = friction("unknown.ball_begins_to_roll")
    assert isinstance(law, thrown.Throw)
    for start in (0.9, 1.6, 1.1):
        assert law.mu(start, 0.0) == 0.28
        assert law.mu(0.72 * start, 0.05) == 0.28
        assert law.mu(0.71 * start, 0.06) == pytest.approx(0.07)
    record = SERIES.shown("unknown.ball_begins_to_roll")
    v = np.diff(record["position [m]"]) * thrown.RATE
    early, late = (np.polyfit(np.arange(15) / thrown.RATE, v[k : k + 15], 1)[0] / -9.81 for k in (2, 60))
    assert (early, late) == pytest.approx((0.28, 0.07), abs=0.05)


def test_sums_of_five_shocks_are_as_loud_as_the_drive_and_forget_after_five_rows():
    made = SERIES.short("none.sums_of_five_at_200_hz", design="slide")
    assert made.nominal.rate == 200.0
    made = of_twelve_seconds("none.sums_of_five_at_200_hz", "slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    noise = (shown - plain) / series_checks.drive_noise(made)
    assert noise.std() == pytest.approx(1.0, abs=0.1)
    kept = [np.mean(noise[k:] * noise[:-k]) / noise.var() for k in (1, 4, 6, 7)]
    assert kept == pytest.approx([0.8, 0.2, 0.0, 0.0], abs=0.15)


def test_noise_in_clusters_is_white_and_its_loudness_is_not():
    noise = clustered(np.random.default_rng(5), 200_000)
    assert noise.std() == pytest.approx(1.0, abs=0.15)
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 0.05
    assert np.corrcoef(np.abs(noise[1:]), np.abs(noise[:-1]))[0, 1] > 0.15


def test_steps_of_5_khz_are_those_that_are_stated():
    made = SERIES.short("none.both_in_steps_at_5_khz", design="slide")
    assert made.nominal.rate == 5000.0
    record = made.record(0)
    drive, place = record[column(record, "force", "voltage")], record[column(record, "position")]
    for x, step in ((drive, 0.03 * made.nominal.level / made.nominal.gain), (place, 8e-5 * made.nominal.reach)):
        np.testing.assert_allclose(x, step * np.round(x / step), atol=1e-9 * step)
        assert np.unique(x).size > 20


def test_jitter_wanders_by_less_than_a_twentieth_of_an_interval():
    made = SERIES.short("none.jitter_that_wanders", design="slide")
    shown, plain = shown_and_plain(made, "position")
    most = np.maximum(np.abs(np.diff(plain, prepend=plain[0])), np.abs(np.diff(plain, append=plain[-1])))
    assert np.all(np.abs(shown - plain) <= 0.0501 * most + 1e-15)
    assert np.std(shown - plain) > 0.0


def test_warm_air_and_converters_and_a_rectifier_are_as_loud_as_stated():
    made = of_twelve_seconds("none.warm_air_in_the_beam", "slide")
    shown, plain = shown_and_plain(made, "position")
    noise = (shown - plain) / made.nominal.sensor.position
    assert noise.std() == pytest.approx(1.0, abs=0.15)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(np.exp(-1.0 / 7.5), abs=0.05)
    made = SERIES.short("none.two_converters_in_turn", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    noise = (shown - plain) / series_checks.drive_noise(made)
    np.testing.assert_allclose(noise[::2], -0.5, atol=1e-9)
    assert (noise[1::2].mean(), noise[1::2].std()) == pytest.approx((0.5, 1.5), abs=0.1)
    made = SERIES.short("none.ripple_of_a_rectifier", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    noise = (shown - plain) / series_checks.drive_noise(made)
    assert noise.std() == pytest.approx(1.0, abs=0.02)
    power = np.abs(np.fft.rfft(noise[:8000])) ** 2
    assert power[1200] + power[2400] == pytest.approx(power.sum(), rel=1e-6)


def test_good_sensors_and_undriven_nulls_are_what_they_are_said_to_be():
    made = SERIES.short("none.good_sensors_and_wrong_numbers", design="slide")
    usual = nominal_bench("slide", made.case.rng(0)).sensor
    assert made.nominal.sensor.position == pytest.approx(usual.position / 3.0)
    assert made.nominal.sensor.drive == pytest.approx(usual.drive / 3.0)
    law = friction("none.level_below_and_differenced_noise")
    assert law.added is not None
    t = np.arange(20_000) / slider.RATE
    noise = law.added(t, t)
    assert noise.std() == pytest.approx(2e-4 * np.sqrt(2.0), rel=0.03)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(-0.5, abs=0.03)
    assert friction("none.lacquered_table").mu(1.0, 0.1) == 0.255
