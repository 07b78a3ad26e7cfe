"""The forms of the fourteenth set at driven joints give finite records that they move; nulls nothing moves but noise."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import comb

from tests.discovery import joint_plan
from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import DESIGNS, nominal_bench
from tests.discovery.joint_generator.case import Case, Made
from tests.discovery.joint_generator.forms import FORMS, Record
from tests.discovery.joint_generator.forms.form import Form
from tests.discovery.joint_generator.plant import (
    AREA_AT,
    FACTOR_AT,
    FACTOR_OF_TIME,
    FORCE_AT,
    FORCE_OF_TIME,
    GAIN_AT,
    GAIN_OF_TIME,
    Array,
    Plant,
)

from .law import damped_through, overlap, since_the_turn, water_vapour
from .mechanism import doublet, slope_of_a_hump
from .nameless import engaged, felt
from .null import lognormal
from .sensor import BELOW, SENDERS

SERIES = series_checks.Series(14)
MADE_UP_FOR = {"constant_force.magnets_bear_too_much": "size"}
"""What the controller makes up for, and is seen against what is believed."""
KNOWN = [name for name, kind in SERIES.kinds.items() if kind not in ("unknown", "none")]


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


def sources(form: Form) -> set[str]:
    """Authors with their years, as the first line of a form names them."""
    first = (form.draw.__doc__ or "").split("\n")[0].split(" (")[0]
    return {part.strip(" .") for part in re.split(r";|, in ", first) if re.search(r"\d{4}", part)}


def test_the_set_is_as_wide_as_asked_for():
    assert SERIES.counts() == (27, 10, 10, 4)
    assert not SERIES.kinds_not_shown()
    assert not SERIES.misplaced()
    assert not SERIES.unsourced()
    thirteenth = [kind for kind in series_checks.Series(13).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(SERIES.kinds[name] for name in KNOWN) == sorted(thirteenth)
    cases = list(joint_plan.unseen_cases([1401], 14))
    assert {case.design for case in cases} == set(DESIGNS)
    assert {case.strength for case in cases} == {0.5, 1.0}
    assert {case.forms for case in cases} == {*SERIES.forms, *SERIES.pairs}


def test_no_earlier_form_has_the_name_of_one_of_these():
    assert not SERIES.repeated_names()


def test_no_earlier_form_of_its_kind_has_the_source_of_one_of_these():
    earlier = [*FORMS.values(), *(form for i in range(1, 14) for form in joint_plan.SERIES[i][0].values())]
    used = {(form.kind, source) for form in earlier for source in sources(form)}
    own = [(form.kind, source) for form in SERIES.forms.values() for source in sources(form)]
    assert len(own) == len(SERIES.forms) == len(set(own))
    assert not used & set(own)


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


@pytest.mark.parametrize("name", [name for name in SERIES.undriven if "thrown" in SERIES.forms[name].designs])
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


@pytest.mark.parametrize("name", SERIES.forms)
def test_the_same_seed_gives_the_same_record(name):
    if name in SERIES.undriven:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    else:
        made = SERIES.short(name)
        made = replace(made, nominal=replace(made.nominal, duration=1.5), true=replace(made.true, duration=1.5))
        again = replace(made, effects=SERIES.short(name).effects)
        series_checks.assert_same(made.record(0), again.record(0))


@pytest.mark.parametrize("name", [name for name in SERIES.joints if "+" not in name])
def test_no_strength_is_no_effect(name):
    """A recorded load decides friction at any strength: by Coulomb's law, if there is no other one."""
    made = SERIES.short(name, strength=0.0)
    made = replace(made, nominal=replace(made.nominal, duration=1.5), true=replace(made.true, duration=1.5))
    if name.startswith("load_dependence"):
        record, plant = made.record(0), made.plant(0)
        load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
        factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
        assert factor / load == pytest.approx(np.ones_like(load), abs=0.015)
        return
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    series_checks.assert_same({name: shown[name] for name in plain}, plain)


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
        "viscous_friction.rollers_of_polyurethane",
        "viscous_friction.solid_iron_back_of_a_motor",
        "velocity_weakening.cast_iron_slideway",
        "direction_asymmetry.scraper_of_a_clarifier",
        "quadratic_damping.float_makes_waves",
        "position_dependent_friction.nut_out_of_line",
        "position_dependent_force.follower_on_a_cam",
        "drive_gain_change.elliptic_gears",
        "harmonic_force.splice_of_a_belt_passes",
        "constant_force.magnets_bear_too_much",
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


def test_rollers_lose_most_at_one_speed_and_little_while_slow():
    made = SERIES.short("viscous_friction.rollers_of_polyurethane")
    peak = made.effects[0].parameters["peak"] / made.nominal.speed
    drag = drag_at(made, [0.0, 0.05 * peak, 0.1 * peak, 0.5 * peak, peak, 2.0 * peak])[0] / 1.2
    assert drag == pytest.approx([0.0, 0.1 / 1.0025, 0.2 / 1.01, 0.8, 1.0, 0.8], abs=3e-3)


def test_eddies_drag_by_a_line_in_thin_iron_and_by_a_root_in_thick_iron():
    assert damped_through(np.array([0.1, 0.2])) == pytest.approx([0.01, 0.04], rel=1e-3)
    assert damped_through(np.array([20.0, 40.0])) == pytest.approx([60.0, 120.0], rel=1e-6)
    made = SERIES.short("viscous_friction.solid_iron_back_of_a_motor")
    drag = drag_at(made, [0.0, 0.005, 0.01, 1.0, 2.0])[0]
    assert (drag[0], drag[3]) == pytest.approx((0.0, 1.2), abs=3e-3)
    assert drag[2] / drag[1] == pytest.approx(2.0, rel=0.02)
    assert drag[4] / drag[3] == pytest.approx(np.sqrt(2.0), rel=0.02)


def test_cast_iron_falls_by_a_line_times_an_exponential():
    made = SERIES.short("velocity_weakening.cast_iron_slideway")
    knee = made.effects[0].parameters["knee"] / made.nominal.speed
    more = drag_at(made, [0.0, 0.5 * knee, knee, 2.0 * knee, 8.0 * knee])[0] / 0.95
    w = np.array([0.0, 0.5, 1.0, 2.0, 8.0])
    assert more == pytest.approx((1.0 + 0.6 * w) * np.exp(-w), abs=3e-3)
    assert np.all(np.diff(made.plant(0).by_speed[0]) <= 0.0)


def test_a_scraper_ploughs_one_way_and_is_lifted_the_other_way():
    made = SERIES.short("direction_asymmetry.scraper_of_a_clarifier")
    ways = drag_at(made, [0.0, 0.5, 1.0])
    ploughs, lifted = ways if made.effects[0].parameters["forward"] else ways[::-1]
    assert ploughs == pytest.approx([0.45, 0.45 * 1.25, 0.9], abs=2e-3)
    assert lifted == pytest.approx([-0.25] * 3)


def test_a_float_drags_by_the_square_and_makes_waves_when_quick():
    made = SERIES.short("quadratic_damping.float_makes_waves")
    depth = made.effects[0].parameters["depth"]
    drag = drag_at(made, [0.0, 0.1, 0.2, 0.7, 1.0])[0] / 1.3
    assert (drag[0], drag[4]) == pytest.approx((0.0, 1.0), abs=2e-3)
    assert drag[1:3] == pytest.approx(0.6 * np.array([0.01, 0.04]), rel=0.02)
    assert drag[3] == pytest.approx(0.49 * (0.6 + 0.4 * np.exp(depth * (1.0 - 1.0 / 0.49))), rel=3e-3)
    assert np.all(np.diff(made.plant(0).by_speed[0]) >= 0.0)


def test_pockets_bear_the_same_part_of_any_load():
    made = of_twelve_seconds("load_dependence.pockets_bear_a_part")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    slope, at_zero = np.polyfit(load, factor, 1)
    assert (slope, -at_zero / slope) == pytest.approx((1.0 / 0.72, 0.28), rel=0.01)
    assert (load.min(), load.max()) == pytest.approx((0.45, 1.9), abs=0.03)
    assert factor.min() > 0.2


def test_a_felt_draws_oil_by_the_root_of_time_until_it_is_full():
    made = of_twelve_seconds("friction_drift.felt_wiper_fills")
    plant, full = made.plant(0), made.effects[0].parameters["full"]
    factor = np.interp(full * np.array([0.0, 0.04, 0.25, 1.0, 1.5]), plant.times, plant.by_time[FACTOR_OF_TIME])
    assert factor == pytest.approx(1.0 - 0.6 * np.array([0.0, 0.2, 0.5, 1.0, 1.0]), abs=2e-3)
    assert full < 0.6 * 12.0


def test_a_skin_holds_for_some_strokes_and_comes_off_then_alike_in_each_run():
    made = SERIES.short("distance_drift.skin_tires_first")
    one, other = made.plant(0).by_stroke, made.plant(1).by_stroke
    np.testing.assert_array_equal(one, other)
    assert np.all(one[:4] == one[0])
    np.testing.assert_allclose(np.diff(one)[6:15], 0.13)
    assert np.all(one[16:] == one[15])
    assert (one[0], one[15]) == pytest.approx((0.7, 0.7 + 0.13 * 10.0), abs=0.14)


def test_rails_are_dry_above_the_dew_point_and_wetter_the_colder_they_are_below():
    assert water_vapour(np.array([0.0, 20.0])) == pytest.approx([6.108, 23.38], abs=0.02)
    made = of_twelve_seconds("temperature_drift.rails_sweat")
    plant, record = made.plant(0), made.record(0)
    celsius = record["temperature [degC]"]
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    assert factor[celsius > 17.2] == pytest.approx(0.73)
    assert np.mean(celsius > 17.2) > 0.3
    cold = celsius < 16.8
    assert np.corrcoef(factor[cold], water_vapour(celsius[cold]))[0, 1] < -0.999
    assert 1.2 < factor.max() < 1.75
    assert abs(np.corrcoef(record["time [s]"], celsius)[0, 1]) < 0.6


def test_oversized_balls_are_drawn_without_being_put_back():
    made = SERIES.short("random_coefficients.oversized_balls_come_round")
    level = np.concatenate([made.plant(i).by_stroke for i in range(20)])
    number = np.round((level - 1.0) / 0.2 + 1.5).astype(int)
    np.testing.assert_allclose(level, 1.0 + 0.2 * (number - 1.5))
    k = np.arange(6)
    assert np.bincount(number, minlength=6) / number.size == pytest.approx(comb(6, k) * comb(14, 5 - k) / comb(20, 5), abs=0.02)
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05
    assert level.min() > 0.6


def test_the_rougher_runner_decides():
    mu = np.array([friction("random_coefficients.rougher_of_two_runners", i).mu(1.0, 0.0) for i in range(800)])
    drawn = (mu - 0.28) / 0.07
    assert (drawn.mean(), drawn.std()) == pytest.approx((0.0, np.sqrt(1.0 - 1.0 / np.pi)), abs=0.07)
    assert np.mean(drawn + 1.0 / np.sqrt(np.pi) < 0.0) == pytest.approx(0.25, abs=0.04)  # both are below their mean
    assert mu.min() > 0.03


def test_each_stroke_carries_one_chip_from_a_wiper_to_the_other_one():
    made = SERIES.short("correlated_coefficients.chips_change_wipers")
    runs = np.stack([made.plant(i).by_stroke for i in range(40)])
    number = np.round((runs - 1.0) / 0.2 + 4.0)
    np.testing.assert_allclose(runs, 1.0 + 0.2 * (number - 4.0))
    assert np.all(np.abs(np.diff(number, axis=1)) == 1.0)
    assert (number.min(), number.max()) == (0.0, 8.0)
    assert (number.mean(), number.var()) == pytest.approx((4.0, 2.0), abs=0.15)
    off = number - 4.0
    kept = [np.mean(off[:, k:] * off[:, :-k]) / np.mean(off**2) for k in (1, 2, 3)]
    assert kept == pytest.approx([0.75, 0.75**2, 0.75**3], abs=0.05)


@pytest.mark.parametrize("design", ["slide", "hinge"])
def test_junctions_hold_after_a_turn_and_are_gone_after_a_diameter(design):
    assert overlap(np.array([0.0, 0.5, 1.0, 3.0])) == pytest.approx([1.0, 0.39100, 0.0, 0.0], abs=1e-4)
    x = np.array([0.0, 1.0, 2.0, 1.5, 0.5, 1.0])
    far = since_the_turn(x, np.array([1.0, 1.0, 1.0, -1.0, -1.0, 1.0]), 0.1)
    assert far == pytest.approx([np.inf, np.inf, np.inf, 0.0, 1.0, 0.0])
    made = of_twelve_seconds("frictional_lag.junctions_part_as_circles", design)
    more, q, v, _ = drive_and_motion(made)
    moving = np.abs(v) > 0.1 * made.nominal.speed
    gone = since_the_turn(q, v, 0.02 * made.nominal.speed) / made.effects[0].parameters["diameter"]
    held = (more * np.sign(v))[moving]
    assert held == pytest.approx(1.1 * overlap(gone[moving]), abs=0.08)
    assert held.max() > 0.5
    assert np.mean(held == 0.0) > 0.3


def test_a_nut_binds_near_either_bearing_and_more_near_one():
    made = SERIES.short("position_dependent_friction.nut_out_of_line")
    side, near, far = (made.effects[0].parameters[name] for name in ("side", "near", "far"))
    u = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    factor = at_places(made, FACTOR_AT, list(side * u))
    stiff = (near * far / ((near + u) * (far - u))) ** 2
    assert factor == pytest.approx(1.0 + 0.4 * (stiff - 1.2), abs=5e-3)
    assert factor[0] > factor[4] > factor[2]
    assert made.plant(0).by_place[FACTOR_AT].min() > 0.8


def test_a_slide_crosses_a_ring_twice_at_the_same_places():
    one, other = (friction("position_dependent_friction.ring_of_a_dried_spill", i).mu for i in (0, 1))
    x = np.linspace(0.0, 0.25, 251)
    mu = np.array([one(1.0, float(at)) for at in x])
    assert np.array([other(0.3, float(at)) for at in x]) == pytest.approx(mu)
    tops = np.flatnonzero((mu[1:-1] > mu[:-2]) & (mu[1:-1] > mu[2:])) + 1
    assert x[tops] == pytest.approx([0.05, 0.14])
    assert mu[tops] == pytest.approx([0.25 * 2.4] * 2, rel=1e-3)
    assert mu[95] == pytest.approx(0.25, rel=0.01)
    assert SERIES.shown("position_dependent_friction.ring_of_a_dried_spill")["position [m]"].max() > 0.15


def test_a_follower_gives_back_what_it_took_less_nothing():
    u = np.linspace(-1.2, 1.2, 24_001)
    pulls = slope_of_a_hump(u, (-0.75, -0.1), (0.25, 0.75), 0.6)
    assert pulls.sum() * 1e-4 == pytest.approx(0.0, abs=1e-6)  # a spring keeps energy
    assert np.all(pulls[(u < -0.75) | ((u > -0.1) & (u < 0.25)) | (u > 0.75)] == 0.0)
    stored = 0.65 / 1.875 * (0.6 + 0.5 * 0.4)
    assert pulls[u < 0.0].sum() * 1e-4 == pytest.approx(stored, rel=1e-4)
    assert -pulls.min() > pulls.max() > 0.8
    made = SERIES.short("position_dependent_force.follower_on_a_cam")
    side, at = made.effects[0].parameters["side"], made.effects[0].parameters["at"]
    force = side * at_places(made, FORCE_AT, [side * (at - 0.425), side * (at + 0.1), side * (at + 0.5)]) / made.nominal.level
    assert force == pytest.approx([1.2 * 0.8, 0.0, -1.2 * 0.8 * 1.3], abs=5e-3)


def test_an_air_spring_has_the_least_area_at_its_waist():
    made = SERIES.short("effective_area.air_spring_on_an_hourglass")
    waist = made.effects[0].parameters["waist"] / made.nominal.reach
    areas = at_places(made, AREA_AT, [waist, waist - 0.35, waist + 0.35, waist + 1.4])
    assert areas == pytest.approx([1.0 - 0.11, 1.0, 1.0, 1.0 + 0.22 * (16.0 / 17.0 - 0.5)], abs=1e-3)


def test_elliptic_gears_give_most_over_a_short_stretch_and_one_in_the_mean():
    made = SERIES.short("drive_gain_change.elliptic_gears")
    plant = made.plant(0)
    turn, off = made.effects[0].parameters["turn"], made.effects[0].parameters["off"]
    within = np.abs(plant.places) <= turn
    gain = plant.by_place[GAIN_AT][within]
    assert (gain.min(), gain.max()) == pytest.approx(((1.0 - off) / (1.0 + off), (1.0 + off) / (1.0 - off)), abs=2e-3)
    assert gain[:-1].mean() == pytest.approx(1.0, abs=5e-3)
    assert np.mean(gain > 1.0) < 0.45


def test_a_pound_foot_is_a_newton_metre_and_a_third_and_magnets_pull_evenly():
    made = SERIES.short("drive_gain.pounds_taken_for_newtons")
    assert np.unique(made.plant(0).by_time[GAIN_OF_TIME]) == pytest.approx([4.4482216 * 0.3048], rel=1e-3)
    made = SERIES.short("constant_force.magnets_bear_too_much")
    (force,) = np.unique(made.plant(0).by_time[FORCE_OF_TIME])
    assert abs(force) / made.nominal.level == pytest.approx(0.65)
    assert force == made.plant(1).by_time[FORCE_OF_TIME][0]


def test_a_gun_beyond_the_wrist_adds_what_a_point_mass_there_has():
    made = SERIES.short("payload.welding_gun_beyond_the_wrist")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    more = {name: loaded[name] - plain[name] for name in ("inertia", "inertia_2", "coupling", "gravity", "gravity_2")}
    mass, gun = made.effects[0].parameters["share"] * n["m2"], 1.35 * n["l2"]
    assert (more["inertia"], more["gravity"]) == pytest.approx((mass * n["l1"] ** 2, 9.81 * mass * n["l1"]))
    assert (more["inertia_2"], more["gravity_2"]) == pytest.approx((mass * gun**2, 9.81 * mass * gun))
    assert more["coupling"] == pytest.approx(mass * n["l1"] * gun)


def test_a_splice_pulls_and_pushes_alike_once_a_turn():
    s = np.arange(20_000) / 20_000
    assert doublet(s).mean() == pytest.approx(0.0, abs=1e-6)
    assert (doublet(s).max(), doublet(s).min()) == pytest.approx((1.0, -1.0), abs=1e-4)
    assert np.abs(doublet(s[s < 0.2])).max() < 1e-3
    assert doublet(s + 3.0) == pytest.approx(doublet(s), abs=1e-9)
    made = SERIES.short("harmonic_force.splice_of_a_belt_passes")
    plant, frequency = made.plant(0), made.effects[0].parameters["frequency"]
    force = plant.by_time[FORCE_OF_TIME] / made.nominal.level
    assert force.max() == pytest.approx(1.2, abs=5e-3)
    later = np.interp(plant.times[:2000] + 1.0 / frequency, plant.times, force)
    assert np.corrcoef(later, force[:2000])[0, 1] > 0.99


@pytest.mark.parametrize(
    ("name", "load", "held"),
    [("joint_compliance.cage_of_a_lift", 0.8, 0.55), ("backlash.spindle_of_a_rolling_mill", 0.55, 0.35)],
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


def test_a_filter_that_is_steep_without_a_ripple_is_late_by_what_it_is_said_to_be():
    w = np.linspace(0.0, 6.0, 601)
    gain = BELOW[3] / np.abs(np.polyval(BELOW, 1j * w))
    assert np.all(np.diff(gain) <= 1e-9)
    assert np.interp(1.0, w, gain) == pytest.approx(np.sqrt(0.5), abs=2e-3)
    made = SERIES.short("sensor_delay.behind_a_papoulis_filter", design="slide")
    shown, plain = shown_and_plain(made, "position")
    t, delay = stamps(made), made.effects[0].parameters["delay"]
    begins = t > 0.3

    def misses(delay: float) -> float:
        return float(np.std((shown - np.interp(t - delay, t, plain))[begins]))

    assert misses(delay) < 0.25 * min(misses(0.5 * delay), misses(1.5 * delay))


def test_a_telegram_waits_for_three_senders_and_shows_the_last_value_meanwhile():
    made = of_twelve_seconds("stale_samples.loses_arbitration", "slide")
    shown, plain = shown_and_plain(made, "position")
    at = np.array([np.flatnonzero(plain == x)[0] for x in shown])
    held = (np.arange(at.size) - at) / made.nominal.rate
    assert np.all(held >= 0.0)
    free = np.prod([1.0 - keeps / period for period, keeps in SENDERS])
    assert np.mean(held == 0.0) == pytest.approx(free, abs=0.08)
    assert 0.034 < held.max() < 0.12


def test_dust_is_always_nearer_to_the_laser_than_the_joint():
    made = of_twelve_seconds("sensor_outliers.dust_before_the_laser", "slide")
    shown, plain = shown_and_plain(made, "position")
    hit, side = shown != plain, made.effects[0].parameters["side"]
    assert 0.5 / 300.0 < np.mean(hit) < 1.6 / 300.0
    assert np.all((side * (shown - plain))[hit] < 0.0)
    assert np.all((side * shown)[hit] >= -1.6 * made.nominal.reach)
    assert np.std((shown - plain)[hit]) > 0.3 * made.nominal.reach


def test_a_freewheel_drives_its_wheel_one_way_and_only_when_it_is_quick():
    v = np.concatenate([np.linspace(0.0, 1.0, 100), np.linspace(1.0, -1.0, 100), np.linspace(-1.0, 1.0, 100)])
    driven = engaged(v, 1e-3, 0.8)
    assert np.all(driven[:100])
    assert not driven[105:200].any()
    assert not driven[200:270].any()
    assert driven[-1]
    made = of_twelve_seconds("unknown.flywheel_behind_a_freewheel", "slide")
    more, _, v, _ = drive_and_motion(made)
    side, inner = made.effects[0].parameters["side"], slice(200, -200)
    assert np.all((side * more)[inner] >= 0.0)
    pushed = (side * more)[inner] > 0.02 * (side * more)[inner].max()
    assert 0.05 < np.mean(pushed) < 0.5
    assert np.all((side * v)[inner][pushed] > 0.0)
    worked = np.sum(more[inner] * v[inner]) / made.nominal.rate * made.nominal.level
    assert worked > 0.3 * made.effects[0].parameters["size"] * np.max((side * v) ** 2) / 2.0


def test_a_governor_asks_for_the_change_of_the_cube_of_the_speed():
    made = of_twelve_seconds("unknown.governor_flies_out", "slide")
    more, _, v, t = drive_and_motion(made)
    size, inner = made.effects[0].parameters["size"], slice(200, -200)
    assert size / felt(made.nominal) == pytest.approx(0.45)
    momentum = size * v**3 / made.nominal.speed**2 / made.nominal.level
    given = np.concatenate([[0.0], np.cumsum(0.5 * (more[1:] + more[:-1]) * np.diff(t))])
    off = (given - momentum)[inner]
    assert np.abs(off - off.mean()).max() < 0.08 * np.ptp(momentum)


@pytest.mark.parametrize("seed", range(7, 10))
def test_a_potentiometer_shows_a_share_of_the_other_motors_torque(seed):
    made = SERIES.short("unknown.potentiometer_hears_the_other_motor", seed=seed)
    record, plain = made.record(0), replace(made, effects=()).record(0)
    angles, torques = ([name for name in record if word in name] for word in ("angle", "torque"))
    place = made.nominal.place
    np.testing.assert_array_equal(record[angles[1 - place]], plain[angles[1 - place]])
    for name in torques:
        np.testing.assert_array_equal(record[name], plain[name])
    off = record[angles[place]] - plain[angles[place]]
    assert abs(np.corrcoef(off, record[torques[1 - place]])[0, 1]) == pytest.approx(1.0)
    assert np.quantile(np.abs(off), 0.95) / made.nominal.reach == pytest.approx(0.05, rel=1e-6)


def test_a_rail_bows_by_the_square_of_the_place_and_while_it_is_warm():
    made = of_twelve_seconds("unknown.rail_bows_when_warm", "slide")
    more, q, v, _ = drive_and_motion(made)
    moving = np.abs(v) > 0.1 * made.nominal.speed
    warm = (made.record(0)["temperature [degC]"] - 22.0) / 12.0
    rubs = 1.5 * warm * np.minimum((q / made.nominal.reach) ** 2, 1.3)
    assert (more * np.sign(v))[moving] == pytest.approx(rubs[moving], abs=0.04)
    assert (warm.min(), warm.max()) == pytest.approx((0.0, 1.0), abs=0.03)


def test_vortices_shake_by_the_square_of_the_speed_and_by_the_way_gone():
    made = of_twelve_seconds("unknown.vortices_are_shed", "slide")
    more, _, v, _ = drive_and_motion(made)
    u, apart = np.abs(v) / made.nominal.speed, made.effects[0].parameters["apart"]
    gone = np.cumsum(np.abs(v)) / made.nominal.rate / apart
    quick = np.flatnonzero(u > 0.3)
    quick = quick[(quick > 100) & (quick < u.size - 100)]
    waves = np.stack([np.sin(2.0 * np.pi * gone), np.cos(2.0 * np.pi * gone)], axis=1)[quick] * u[quick, None] ** 2
    sizes, *_ = np.linalg.lstsq(waves, more[quick], rcond=None)
    assert np.hypot(*sizes) == pytest.approx(2.2, rel=0.05)
    assert np.std(more[quick] - waves @ sizes) < 0.1 * np.std(more[quick])
    assert np.abs(more[u < 0.05]).max() < 0.03


def test_an_index_ends_what_a_counter_has_missed():
    made = of_twelve_seconds("unknown.index_sets_the_counter_right", "slide")
    shown, plain = shown_and_plain(made, "position")
    states, _ = made.states(0)
    side, index = made.effects[0].parameters["side"], made.effects[0].parameters["index"]
    off, x, v = side * (shown - plain), states[:, 0], states[:, 2]
    assert off.max() < 1e-9
    assert -0.25 * made.nominal.reach < off.min() < -0.03 * made.nominal.reach
    back = side * v < -0.05 * made.nominal.speed
    within = (back[1:] & back[:-1]) & (np.abs(x[1:] - index) > 0.01 * made.nominal.reach)
    assert np.diff(off)[within] == pytest.approx(0.0, abs=2e-5 * made.nominal.reach)
    on = side * v > 0.2 * made.nominal.speed
    further = (on[1:] & on[:-1]) & (np.abs(x[1:] - index) > 0.01 * made.nominal.reach)
    assert np.sum(np.diff(off)[further]) / np.sum(np.abs(np.diff(x))[further]) == pytest.approx(-0.1, rel=0.03)


def test_a_wattmeter_adds_the_square_of_the_force_over_the_speed():
    made = of_twelve_seconds("unknown.drive_from_a_wattmeter", "slide")
    more, _, v, _ = drive_and_motion(made)
    _, plain = shown_and_plain(made, "force", "voltage")
    force = plain * made.nominal.gain / made.nominal.level
    quick = np.abs(v) > 0.4 * made.nominal.speed
    loss, least = made.effects[0].parameters["loss"] * made.nominal.level, made.effects[0].parameters["least"]
    assert more[quick] == pytest.approx((loss * force**2 * v / (v**2 + least**2))[quick], abs=0.03 * np.abs(more).max())
    assert np.all((more * v)[quick] >= 0.0)
    still = np.abs(v) < 1e-3 * made.nominal.speed
    assert np.abs(more[still]).max(initial=0.0) < 0.1 * np.abs(more).max()


def test_a_tool_is_pushed_by_the_way_gone_since_a_turn_ago():
    made = of_twelve_seconds("unknown.cutter_meets_its_last_pass", "slide")
    more, q, _, t = drive_and_motion(made)
    turn, b = made.effects[0].parameters["turn"], made.nominal
    assert turn * b.speed / b.reach == pytest.approx(2.0)
    chip = 1.1 * (q - np.interp(t - turn, t, q)) / b.reach
    assert more == pytest.approx(chip, abs=5e-3)
    held = np.gradient(q, t)
    later = t > turn
    assert all(abs(np.corrcoef(more[later], x[later])[0, 1]) < 0.97 for x in (q, held))


def test_grains_are_stronger_after_a_step_to_either_side_and_tire_in_time():
    speeds = np.repeat([1e-6, 1e-5, 1e-6, 1e-4], 600)
    t = np.arange(speeds.size) / slider.RATE
    x = np.concatenate([[0.0], np.cumsum(speeds[:-1])]) / slider.RATE
    law = friction("unknown.jolts_pack_the_grains")
    assert law.added is not None
    added = law.added(t, x)
    assert np.all(added[:600] == 0.0)
    jumps = np.diff(added)[[599, 1199, 1799]]
    assert jumps == pytest.approx([0.011, 0.011, 0.022], rel=0.02)
    assert added[750] / added[600] == pytest.approx(np.exp(-1.0), rel=1e-3)
    assert added[1350] / added[1200] == pytest.approx(np.exp(-1.0), rel=1e-3)


def test_a_bend_rubs_by_the_square_of_the_speed_and_nowhere_else():
    law = friction("unknown.chute_bends")
    assert isinstance(law, thrown.Throw)
    assert [law.mu(v, 0.1) - 0.25 for v in (0.0, 0.6, 1.2)] == pytest.approx([0.0, 0.35 * 0.36 / 0.981, 0.35 * 1.44 / 0.981])
    assert {law.mu(v, x) for v in (0.2, 1.5) for x in (0.01, 0.16, 0.3)} == {0.25}
    record = SERIES.shown("unknown.chute_bends")
    assert record["position [m]"].max() > 0.15


def test_a_drive_is_rounded_by_chance_and_right_in_the_mean():
    made = SERIES.short("none.rounds_by_chance", design="slide")
    assert made.nominal.rate == 3000.0
    shown, plain = shown_and_plain(made, "force", "voltage")
    step = 0.03 * made.nominal.level / made.nominal.gain
    np.testing.assert_allclose(shown, step * np.round(shown / step), atol=1e-9 * step)
    assert np.abs(shown - plain).max() < step
    assert (shown - plain).mean() == pytest.approx(0.0, abs=0.02 * step)
    assert (shown - plain).std() == pytest.approx(step / np.sqrt(6.0), rel=0.05)


def test_an_encoder_counts_whole_lines_alone():
    made = SERIES.short("none.counts_whole_lines", design="slide")
    shown, plain = shown_and_plain(made, "position")
    step = 8e-5 * made.nominal.reach
    np.testing.assert_allclose(shown, step * np.round(shown / step), atol=1e-9 * step)
    assert np.all((plain - shown > -1e-9 * step) & (plain - shown < step * (1.0 + 1e-9)))


def test_a_spline_goes_through_each_fourth_row_and_adds_no_more_than_noise():
    made = SERIES.short("none.resampled_by_a_spline", design="slide")
    assert (made.nominal.rate, made.nominal.motion) == (2000.0, "sweep")
    shown, plain = shown_and_plain(made, "position")
    assert shown[::4] == pytest.approx(plain[::4], abs=1e-12)
    assert np.std(shown - plain) < 1.5 * made.nominal.sensor.position


def test_a_clock_swings_by_a_twentieth_of_an_interval():
    made = SERIES.short("none.clock_swings_with_the_mains", design="slide")
    shown, plain = shown_and_plain(made, "position")
    most = np.maximum(np.abs(np.diff(plain, prepend=plain[0])), np.abs(np.diff(plain, append=plain[-1])))
    assert np.all(np.abs(shown - plain) <= 0.0501 * most + 1e-15)
    assert shown[8] - plain[8] != 0.0


def test_lognormal_noise_and_thyristors_are_as_loud_as_stated():
    noise = lognormal(np.random.default_rng(5), 400_000)
    assert (noise.mean(), noise.std()) == pytest.approx((0.0, 1.0), abs=0.01)
    assert np.mean(noise**3) > 2.0
    made = SERIES.short("none.thyristors_are_heard", design="slide")
    assert made.nominal.rate == 4000.0
    shown, plain = shown_and_plain(made, "force", "voltage")
    noise = (shown - plain) / series_checks.drive_noise(made)
    assert noise.std() == pytest.approx(np.sqrt(2.0), rel=0.05)
    by_phase = noise[:16_000].reshape(-1, 40).std(axis=0)
    assert by_phase.max() == pytest.approx(2.0, rel=0.15)
    assert by_phase.min() < 0.3


def test_a_slow_controller_and_short_strokes_are_what_they_are_said_to_be():
    made = SERIES.short("none.detuned_controller_at_5_khz", design="slide")
    usual = nominal_bench("slide", made.case.rng(0))
    assert (made.nominal.rate, made.nominal.motion, made.nominal.bandwidth) == (5000.0, "series", 0.6)
    at_rate = replace(made, nominal=replace(made.nominal, bandwidth=1.0))
    assert made.gains[0] / at_rate.gains[0] == pytest.approx(0.36)
    assert usual.bandwidth == 1.0
    made = SERIES.short("none.short_strokes_at_200_hz", design="slide")
    usual = nominal_bench("slide", made.case.rng(0))
    assert (made.nominal.reach, made.nominal.speed) == pytest.approx((0.6 * usual.reach, 0.8 * usual.speed))
    assert made.roles == ["fit"] * 4 + ["test"] * 2


def test_undriven_nulls_are_what_they_are_said_to_be():
    law = friction("none.level_above_and_logistic_noise")
    assert law.added is not None
    t = np.arange(40_000) / slider.RATE
    noise = law.added(t, t)
    assert noise.std() == pytest.approx(2e-4, rel=0.03)
    assert np.mean((noise / noise.std()) ** 4) == pytest.approx(4.2, abs=0.4)
    assert (law.mu_0 - 0.62) / 0.062 == pytest.approx(0.9)
    assert friction("none.polished_granite").mu(1.0, 0.1) == 0.195
