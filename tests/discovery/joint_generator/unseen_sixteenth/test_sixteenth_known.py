"""The forms of the sixteenth set with an effect of the vocabulary give finite records that they move; nulls move nothing."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.stats import fisk, logser

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

from .law import gel_foot, mean_crumbs, spills
from .mechanism import bell
from .null import by_sine_and_cosine

SERIES = series_checks.Series(16)
MADE_UP_FOR = {"constant_force.float_held_under_water": "size"}
"""What the controller makes up for, and is seen against what is believed."""
OWN = {name: form for name, form in SERIES.forms.items() if not form.draw.__module__.endswith("nameless")}
KNOWN = [name for name in OWN if SERIES.kinds[name] != "none"]
JOINTS = [name for name in KNOWN if name in SERIES.joints]
UNDRIVEN = [name for name in OWN if name in SERIES.undriven]
NULLS = [name for name in OWN if name in SERIES.nulls]


def lasting(made: Made, duration: float) -> Made:
    """The same case with runs of another length."""
    return replace(made, nominal=replace(made.nominal, duration=duration), true=replace(made.true, duration=duration))


def of_twelve_seconds(name: str, design: str | None = None) -> Made:
    """A case whose runs are as long as they usually are."""
    return lasting(SERIES.short(name, design=design), 12.0)


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
    fifteenth = [kind for kind in series_checks.Series(15).kinds.values() if kind not in ("unknown", "none")]
    assert sorted(SERIES.kinds[name] for name in KNOWN) == sorted(fifteenth)


def test_no_earlier_form_has_the_name_of_one_of_these():
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in OWN}


def test_no_earlier_form_of_its_kind_has_the_source_of_one_of_these():
    earlier = [*FORMS.values(), *(form for i in range(1, 16) for form in joint_plan.SERIES[i][0].values())]
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


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_believed_and_is_off_by_no_more_than_is_stated(name):
    made = SERIES.short(name, design="slide")
    series_checks.assert_finite(made.record(0))
    series_checks.assert_nothing_is_missing(made)


@pytest.mark.parametrize("name", OWN)
def test_the_same_seed_gives_the_same_record(name):
    if name in SERIES.undriven:
        series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    else:
        made = lasting(SERIES.short(name), 1.5)
        again = replace(made, effects=SERIES.short(name).effects)
        series_checks.assert_same(made.record(0), again.record(0))


@pytest.mark.parametrize("name", JOINTS)
def test_no_strength_is_no_effect(name):
    """A recorded load decides friction at any strength: by Coulomb's law, if there is no other one."""
    made = lasting(SERIES.short(name, strength=0.0), 1.5)
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
        "viscous_friction.soft_close_of_a_drawer",
        "viscous_friction.stirrer_in_paint",
        "velocity_weakening.glides_of_a_chair_melt",
        "direction_asymmetry.scales_of_a_ski",
        "quadratic_damping.oar_draws_air",
        "position_dependent_friction.planks_of_a_deck",
        "drive_gain_change.dirty_bars_of_a_commutator",
        "harmonic_force.bell_swings_in_the_frame",
        "constant_force.float_held_under_water",
    ],
)
def test_energy_is_kept_and_friction_takes_it_alone(name):
    made = SERIES.short(name, design="slide")
    energy, worked = energy_and_work(made, made.plant(0))
    assert np.abs(energy - energy[0] - worked).max() < 0.02 * np.ptp(energy)  # work is summed at the rate of the record
    states, _ = made.states(0)
    quick = np.abs(states[:, 2]) > 0.05 * made.nominal.speed
    assert np.all((states[:, 6] * states[:, 2])[quick] > 0.0)


def test_silicone_is_a_line_while_slow_and_a_power_when_fast():
    made = SERIES.short("viscous_friction.soft_close_of_a_drawer")
    p, drag = made.effects[0].parameters, drag_at(made, [0.0, 0.005, 0.01, 0.3, 1.0])[0] / 0.95
    assert (drag[0], drag[4]) == pytest.approx((0.0, 1.0), abs=2e-3)
    assert drag[2] / drag[1] == pytest.approx(2.0, rel=0.02)  # asinh(w)/w is 1 to w^2/6
    w = p["top"] * np.array([0.3, 1.0])
    log = np.log(w + np.sqrt(w**2 + 1.0))  # asinh
    assert drag[3] == pytest.approx((w[0] / w[1]) ** (1.0 - p["power"]) * (log[0] / log[1]) ** p["power"], rel=5e-3)
    assert drag[1] / 0.005 > 3.0


def test_paint_has_two_viscosities_one_a_seventh_of_the_other():
    made = SERIES.short("viscous_friction.stirrer_in_paint")
    plant, thins = made.plant(0), made.effects[0].parameters["thins"]
    viscosity = plant.by_speed[0][1:] / plant.speeds[1:]
    at = np.interp([0.03 * thins, thins, 20.0 * thins], plant.speeds[1:], viscosity) / viscosity[0]
    assert at == pytest.approx([1.0, 4.0 / 7.0, (1.0 + 400.0 / 7.0) / 401.0], rel=5e-3)
    assert drag_at(made, [1.0])[0] == pytest.approx([1.3], rel=2e-3)
    assert np.all(np.diff(plant.by_speed[0]) > -1e-12)  # a smaller share than a ninth would make it fall


def test_glides_melt_from_a_speed_on():
    made = SERIES.short("velocity_weakening.glides_of_a_chair_melt")
    melts = made.effects[0].parameters["melts"] / made.nominal.speed
    drag = drag_at(made, [0.0, 0.9 * melts, 4.0 * melts, 9.0 * melts])[0] / 0.95
    assert drag == pytest.approx([1.0, 1.0, 0.5, 1.0 / 3.0], abs=2e-3)


def test_a_ski_bites_one_way_and_glides_the_other():
    made = SERIES.short("direction_asymmetry.scales_of_a_ski")
    ways = drag_at(made, [0.0, 0.25, 1.0]) / 0.9
    bites, glides = ways if made.effects[0].parameters["forward"] else ways[::-1]
    assert bites == pytest.approx([1.0, 1.0 / 1.15, 0.625], abs=1e-3)
    assert glides == pytest.approx([-0.35, -0.225, -0.1], abs=1e-3)
    assert 0.9 * 0.35 < 0.7  # what is true of friction is at least seven tenths of the believed one


def test_an_oar_drags_by_the_square_and_then_by_its_front_alone():
    made = SERIES.short("quadratic_damping.oar_draws_air")
    airs = made.effects[0].parameters["airs"] / made.nominal.speed
    u = np.array([0.3 * airs, 0.9 * airs, 1.2 * airs, 1.5 * airs, 2.0 * airs])
    drag = drag_at(made, list(u))[0]
    steep = np.diff(drag[[0, 1]]) / np.diff(u[[0, 1]] ** 2), np.diff(drag[2:]) / np.diff(u[2:] ** 2)
    assert drag[0] / u[0] ** 2 == pytest.approx(steep[0][0], rel=2e-3)
    assert steep[1] / steep[0] == pytest.approx([0.55, 0.55], rel=2e-3)
    assert drag_at(made, [1.0])[0] == pytest.approx([1.3], rel=2e-3)


def test_a_gel_foot_holds_by_the_area_of_a_sphere_that_adheres():
    load = np.linspace(0.3, 2.0, 18)
    area = gel_foot(load)
    cube = area**1.5 * (1.25 + 0.75)  # load + e + sqrt(2 e load + e^2), e = 1/4: the root is 3/4 at a load of 1
    assert (cube - load - 0.25) ** 2 == pytest.approx(0.5 * load + 0.0625)
    made = of_twelve_seconds("load_dependence.gel_feet_under_an_air_bag")
    plant, record = made.plant(0), made.record(0)
    load = record["normal_force [N]"] / (9.81 * made.nominal.numbers["inertia"])
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    assert factor == pytest.approx(np.interp(load, np.linspace(0.3, 2.0, 18), area), abs=0.02)
    assert (load.min(), load.max()) == pytest.approx((0.35, 1.9), abs=0.05)
    step = np.abs(np.diff(np.interp(plant.times, record["time [s]"], load))).max()
    assert step < 0.04  # it never jumps; noise of 0.002


def test_lime_closes_a_gap_evenly():
    made = of_twelve_seconds("friction_drift.limescale_closes_a_gap")
    plant, closed = made.plant(0), made.effects[0].parameters["closed"]
    factor = np.interp([0.0, 3.0, 6.0, 9.0, 12.0], plant.times, plant.by_time[FACTOR_OF_TIME])
    gap = 1.0 / (1.0 + (factor - 1.0) / 0.85 * closed / (1.0 - closed))
    assert gap == pytest.approx(1.0 - closed * np.array([0.0, 0.25, 0.5, 0.75, 1.0]), abs=2e-3)
    assert factor[-1] == pytest.approx(1.85, abs=2e-3)


def test_three_coats_wear_through_in_turn():
    made = SERIES.short("distance_drift.coats_of_paint")
    one, other, p = made.plant(0).by_stroke, made.plant(1).by_stroke, made.effects[0].parameters
    np.testing.assert_array_equal(one, other)
    strokes = np.arange(400.0)
    assert one[[0, 1]] == pytest.approx([0.7, 0.7], abs=0.01)
    assert one[[5, 12, 300]] == pytest.approx([1.2, 1.75, 1.75], abs=0.025)
    half = np.interp([0.95, 1.475], one, strokes)  # where half of a coat is gone, between two strokes
    assert half == pytest.approx([p["first"], p["second"]], abs=0.2)


def test_tallow_has_no_more_to_melt_above_its_melting_point():
    made = of_twelve_seconds("temperature_drift.tallow_on_the_ways")
    plant, record = made.plant(0), made.record(0)
    celsius = record["temperature [degC]"]
    factor = np.interp(record["time [s]"], plant.times, plant.by_time[FACTOR_OF_TIME])
    melted, cold = celsius > 31.3, celsius < 28.0
    assert min(melted.mean(), cold.mean()) > 0.02
    assert factor[melted] == pytest.approx(1.0 - 0.33, abs=1e-6)
    solid = ((factor[cold] - 0.67) / 1.1) ** 0.4
    assert np.polyfit(celsius[cold], solid, 1) == pytest.approx([-1.0 / 19.0, 31.0 / 19.0], rel=0.02)
    assert abs(np.corrcoef(record["time [s]"], celsius)[0, 1]) < 0.6


def test_crumbs_are_a_logarithmic_series():
    made = SERIES.short("random_coefficients.crumbs_in_a_drawer")
    level = np.concatenate([made.plant(i).by_stroke for i in range(20)])
    number = np.arange(1, 9)
    chance = np.append(logser.pmf(number[:-1], 0.75), logser.sf(7, 0.75))
    assert mean_crumbs() == pytest.approx(number @ chance)
    crumbs = (level - 1.0) / 0.2 + number @ chance
    assert np.bincount(np.round(crumbs).astype(int), minlength=9)[1:] / level.size == pytest.approx(chance, abs=0.017)
    assert level.mean() == pytest.approx(1.0, abs=0.015)  # three deviations of the mean of 8000
    assert abs(np.corrcoef(level[1:], level[:-1])[0, 1]) < 0.05
    assert level.min() > 0.7


def test_a_swept_board_has_a_log_logistic_friction():
    mu = np.array([friction("random_coefficients.shuffleboard_is_swept_anew", i).mu(1.0, 0.0) for i in range(800)])
    q = np.array([0.1, 0.25, 0.5, 0.75, 0.9])
    whole = 0.01 + 0.98 * q
    assert np.quantile(mu, q) == pytest.approx(fisk.ppf(whole, 1.0 / 0.11, scale=0.28), abs=0.012)
    assert (mu.min() > 0.168) & (mu.max() < 0.465)


def test_drops_come_by_chance_and_are_wiped_by_a_fifth():
    rng = np.random.default_rng(5)
    runs = np.stack([spills(rng, 400) for _ in range(200)])
    ratio = runs[:, 1:] / runs[:, :-1]
    assert ratio[runs[:, 1:] < 5.0].min() == pytest.approx(0.8)
    assert np.mean(np.isclose(ratio, 0.8)) == pytest.approx(0.8, abs=0.01)
    assert np.quantile(runs, [0.25, 0.5, 0.75]) == pytest.approx(-np.log([0.75, 0.5, 0.25]), rel=0.06)
    kept = [np.corrcoef(runs[:, k:].ravel(), runs[:, :-k].ravel())[0, 1] for k in (1, 4)]
    assert kept == pytest.approx([0.8, 0.8**4], abs=0.04)
    level = SERIES.short("correlated_coefficients.drops_of_syrup").plant(0).by_stroke
    assert level.min() >= 0.67
    assert level.max() <= 1.0 + 0.33 * 4.0 + 1e-12


@pytest.mark.parametrize("design", ["slide", "hinge"])
def test_a_lip_is_half_over_after_half_its_way(design):
    made = of_twelve_seconds("frictional_lag.blade_of_a_wiper_turns_over", design)
    more, q, v, _ = drive_and_motion(made)
    way, quick = made.effects[0].parameters["way"], np.abs(v) > 0.15 * made.nominal.speed
    turns = np.flatnonzero(np.diff(np.sign(v)))
    checked = 0
    for begin, end in pairwise(turns):
        rows = np.arange(begin, end)[quick[begin:end]]
        gone = np.abs(q[rows] - q[begin])
        if rows.size and gone[-1] > 1.5 * way:
            stands = 0.5 + 0.5 * np.cos(np.pi * np.minimum(gone / way, 1.0))
            # the turn is seen at a fiftieth of the speed, from a noisy position
            assert np.sign(v[rows]) * more[rows] == pytest.approx(1.1 * stands, abs=0.12)
            checked += 1
    assert checked >= 2  # long strokes of a run


def test_planks_are_level_and_no_two_alike():
    made = SERIES.short("position_dependent_friction.planks_of_a_deck")
    p, reach = made.effects[0].parameters, made.nominal.reach
    middles = (p["first"] + p["width"] * (np.arange(8) + 0.5)) / reach
    factor = at_places(made, FACTOR_AT, list(middles))
    assert np.sort(factor) == pytest.approx(np.linspace(0.4, 1.6, 8), abs=1e-3)
    beside = at_places(made, FACTOR_AT, list(middles + 0.4 * p["width"] / reach))
    assert beside == pytest.approx(factor, abs=2e-3)
    assert (middles[0] - 0.5 * p["width"] / reach < -0.95) & (middles[-1] + 0.5 * p["width"] / reach > 0.95)


def test_ripples_grow_by_a_line_to_their_height():
    one, other = (friction("position_dependent_friction.ripples_in_a_sand_tray", i).mu for i in (0, 1))
    crests = np.array([0.0225, 0.1125, 0.2025])
    mu = np.array([one(1.0, float(at)) for at in crests]) / 0.28 - 1.0
    assert np.array([other(0.3, float(at)) for at in crests]) / 0.28 - 1.0 == pytest.approx(mu)
    assert mu == pytest.approx(0.7 * np.array([0.125, 0.625, 1.0]))
    assert one(1.0, 0.2475) == pytest.approx(0.28 * 0.3)
    assert SERIES.shown("position_dependent_friction.ripples_in_a_sand_tray")["position [m]"].max() > 0.2


def test_a_tape_folds_at_an_angle_and_is_weak_from_there():
    made = SERIES.short("position_dependent_force.tape_of_a_tape_measure")
    folds = made.effects[0].parameters["folds"] / made.nominal.reach
    u = [0.5 * folds, folds, folds + 0.2, 3.0]
    pulls = at_places(made, FORCE_AT, u) / made.nominal.level
    assert pulls == pytest.approx([0.75, 1.5, 1.5 * (0.35 + 0.65 / np.e), 1.5 * 0.35], abs=0.02)  # the table's spacing
    assert pulls == pytest.approx(-at_places(made, FORCE_AT, [-x for x in u]) / made.nominal.level)


def test_a_spear_takes_its_face_from_pressure_while_in_the_bush():
    made = SERIES.short("effective_area.spear_leaves_its_bush")
    p, reach = made.effects[0].parameters, made.nominal.reach
    leaves = p["side"] * p["leaves"] / reach
    area = at_places(made, AREA_AT, [leaves - 0.06 * p["side"], leaves, leaves + 0.06 * p["side"]])
    assert area == pytest.approx([0.8, 0.9, 1.0], abs=3e-3)
    assert made.plant(0).by_place[AREA_AT][[0, -1]] == pytest.approx([0.8, 1.0][:: int(p["side"])])


def test_dirty_bars_give_less_for_a_seventh_of_each_turn():
    made = SERIES.short("drive_gain_change.dirty_bars_of_a_commutator")
    plant, turn = made.plant(0), made.effects[0].parameters["turn"]
    gain = plant.by_place[GAIN_AT]
    assert (gain.min(), gain.max()) == pytest.approx((0.45, 1.0), abs=3e-3)
    inside = np.abs(plant.places) < 2.0 * turn
    assert np.mean((1.0 - gain)[inside]) == pytest.approx(0.55 * 0.14, rel=0.03)
    later = np.interp(plant.places[inside] + turn, plant.places, gain)
    assert later == pytest.approx(gain[inside], abs=0.05)  # read between steep rows


def test_a_lever_gives_half_as_much_again_and_a_float_pulls_evenly():
    made = SERIES.short("drive_gain.lever_pinned_at_its_outer_hole")
    assert np.unique(made.plant(0).by_time[GAIN_OF_TIME]) == pytest.approx([90.0 / 60.0])
    made = SERIES.short("constant_force.float_held_under_water")
    (force,) = np.unique(made.plant(0).by_time[FORCE_OF_TIME])
    assert abs(force) / made.nominal.level == pytest.approx(0.65)
    assert force == made.plant(1).by_time[FORCE_OF_TIME][0]


def test_a_reel_adds_what_its_rings_add():
    made = SERIES.short("payload.reel_on_the_end")
    plain, loaded, n = made.plant(0, with_effects=False).body, made.plant(0).body, made.nominal.numbers
    mass = made.effects[0].parameters["share"] * n["mass"]
    edges = np.linspace(0.25, 0.55, 2001)
    r, rings = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges**2)
    own = np.sum(rings * r**2) / np.sum(rings)
    assert loaded["inertia"] - plain["inertia"] == pytest.approx(mass * n["length"] ** 2 * (1.0 + own), rel=1e-5)
    assert loaded["gravity"] - plain["gravity"] == pytest.approx(9.81 * mass * n["length"])


def test_a_bell_pushes_as_a_pendulum_does():
    most = np.radians(110.0)
    solved = solve_ivp(lambda _, y: [y[1], -np.sin(y[0])], (0.0, 20.0), [most, 0.0], rtol=1e-10, atol=1e-12, dense_output=True)
    t = np.linspace(0.0, 20.0, 200_001)
    angle, speed = solved.sol(t)
    across = (np.cos(angle) + speed**2) * np.sin(angle)  # of what a light rod bears
    down = np.flatnonzero((angle[:-1] < 0.0) & (angle[1:] >= 0.0))  # it passes the middle forward
    begin, end = t[down[0]], t[down[1]]
    assert bell((t - begin) / (end - begin), most) == pytest.approx(across, abs=2e-3)
    one = across[down[0] + 10 : down[1] - 10]
    assert np.sum(np.diff(np.sign(one)) != 0) == 5  # six lobes
    made = SERIES.short("harmonic_force.bell_swings_in_the_frame")
    plant, frequency = made.plant(0), made.effects[0].parameters["frequency"]
    force = plant.by_time[FORCE_OF_TIME] / made.nominal.level
    assert np.abs(force).max() == pytest.approx(0.7, rel=0.01)
    later = np.interp(plant.times[:2000] + 1.0 / frequency, plant.times, force)
    assert np.corrcoef(later, force[:2000])[0, 1] > 0.99


@pytest.mark.parametrize(
    ("name", "load", "held"),
    [("joint_compliance.tub_of_a_washing_machine", 0.66, 0.2), ("backlash.loose_steering_column", 0.5, 0.45)],
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


def test_a_buffer_is_late_by_between_seven_and_thirteen_tenths():
    made = of_twelve_seconds("sensor_delay.buffer_of_a_wireless_link", "slide")
    made = replace(made, nominal=replace(made.nominal, sensor=replace(made.nominal.sensor, position=0.0)))
    shown, plain = shown_and_plain(made, "position")
    t, delay = stamps(made), made.effects[0].parameters["delay"]
    speed = np.gradient(plain, t)
    quick = (np.abs(speed) > 0.3 * made.nominal.speed) & (t > 0.1)
    sent = np.array([_when(at, shown, plain, t, 2.0 * delay) for at in np.flatnonzero(quick)[::20]])
    late = (t[np.flatnonzero(quick)[::20]] - sent) / delay
    assert np.all((late > 0.65) & (late < 1.35))
    assert np.ptp(late) > 0.3


def _when(row: int, shown: np.ndarray, plain: np.ndarray, t: np.ndarray, most: float) -> float:
    """The time, at most so long before a row, at which the plain column was what the shown one is there."""
    span = np.flatnonzero((t <= t[row]) & (t >= t[row] - most))
    return float(t[span[np.argmin(np.abs(plain[span] - shown[row]))]])


def test_a_film_stays_for_two_and_three_fields_in_turn():
    made = of_twelve_seconds("stale_samples.film_shown_as_video", "slide")
    shown, plain = shown_and_plain(made, "position")
    new = np.flatnonzero(np.diff(shown) != 0.0) + 1
    np.testing.assert_array_equal(shown[new], plain[new])
    lasts, step = np.diff(new) / made.nominal.rate, 1.0 / made.nominal.rate
    first = int(lasts[0] > 2.5 / 60.0)
    assert lasts[first::2] == pytest.approx(2.0 / 60.0, abs=1.01 * step)
    assert lasts[1 - first :: 2] == pytest.approx(3.0 / 60.0, abs=1.01 * step)


def test_two_digits_change_places_and_the_others_stay():
    made = of_twelve_seconds("sensor_outliers.digits_change_places", "slide")
    shown, plain = shown_and_plain(made, "position")
    hit, unit = shown != plain, 1e-3 * made.nominal.reach
    assert 0.4 / 220.0 < np.mean(hit) < 1.6 / 220.0  # one of ten has two digits alike
    before, after = (np.floor(x[hit] / unit + 5000.0 + 1e-6).astype(int) for x in (plain, shown))
    for one, other in zip(before, after, strict=True):
        a, b = f"{one:04d}", f"{other:04d}"
        assert b == a[0] + a[2] + a[1] + a[3]


def test_nulls_that_change_stamps_or_rigs_are_what_they_are_said_to_be():
    made = SERIES.short("none.recorder_with_a_pre_trigger", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    assert (record["time [s]"][0], made.nominal.rate) == (-2.0, 1600.0)
    assert np.diff(record["time [s]"]) == pytest.approx(np.diff(plain["time [s]"]))
    made = SERIES.short("none.thermometer_on_the_wall", design="slide")
    record, plain = made.record(0), replace(made, effects=()).record(0)
    series_checks.assert_same({name: record[name] for name in plain}, plain)
    assert 0.2 < np.std(record["temperature [degC]"]) < 5.0
    made = SERIES.short("none.one_run_to_fit_and_five_to_score")
    assert made.roles == ["fit"] + ["test"] * 5
    made = SERIES.short("none.new_and_tight_seals", design="slide")
    bare = nominal_bench("slide", made.case.rng(0))
    assert made.nominal.level == pytest.approx(2.0 * bare.level)
    assert abs(made.true.level / made.nominal.level - 1.0) == pytest.approx(0.4)


def test_a_fan_and_extremes_are_as_loud_as_the_sensors():
    made = SERIES.short("none.fan_of_the_cabinet_runs_up", design="slide")
    shown, plain = shown_and_plain(made, "force", "voltage")
    tone = (shown - plain) / series_checks.drive_noise(made)
    assert tone.std() == pytest.approx(1.0, rel=0.02)
    for begin, expected in ((0, 60.0), (len(tone) // 2 - 220, 150.0), (len(tone) - 441, 240.0)):
        heard = np.abs(np.fft.rfft(tone[begin : begin + 440]))  # a fifth of a second
        assert np.argmax(heard) * 5.0 == pytest.approx(expected, abs=16.0)
    made = SERIES.short("none.largest_of_many_shocks", design="slide")
    for begins, size in (
        (("position",), made.nominal.sensor.position),
        (("force", "voltage"), series_checks.drive_noise(made)),
    ):
        shown, plain = shown_and_plain(made, *begins)
        noise = (shown - plain) / size
        assert (noise.mean(), noise.std()) == pytest.approx((0.0, 1.0), abs=0.1)  # 2200 rows
        assert np.mean(noise**3) == pytest.approx(1.14, abs=0.5)  # the skewness of extremes


def test_a_task_is_late_by_little_and_never_early():
    made = SERIES.short("none.task_wakes_late", design="slide")
    shown, plain = shown_and_plain(made, "position")
    late = (shown - plain)[:-1] / np.diff(plain)
    assert (late.min() >= -1e-9) & (late.max() <= 0.1 + 1e-6)
    assert np.median(late) == pytest.approx(0.02 * np.log(2.0), abs=2e-3)


def test_eight_bits_of_sine_and_cosine_are_a_fine_and_unbiased_reading():
    x = np.linspace(-3.0, 3.0, 60_001)
    off = by_sine_and_cosine(x, 1.0) - x
    assert np.abs(off).max() < np.sqrt(0.5) / 127.0 / (2.0 * np.pi) * 1.01  # half a level across and half along
    assert abs(off.mean()) < 1e-5
    assert np.unique(np.round(by_sine_and_cosine(x[20_000:30_000], 1.0), 12)).size > 600
    made = SERIES.short("none.sine_and_cosine_in_eight_bits", design="slide")
    shown, plain = shown_and_plain(made, "position")
    assert np.abs(shown - plain).max() < 3e-5 * made.nominal.reach


def test_undriven_nulls_are_what_they_are_said_to_be():
    law = friction("none.level_above_and_a_cell_that_settles")
    assert law.added is not None
    t = np.arange(40_000) / slider.RATE
    noise = law.added(t, t)
    assert (noise[:50].std(), noise[8000:].std()) == pytest.approx((3e-4, 1e-4), rel=0.4)
    assert noise[8000:].std() == pytest.approx(1e-4, rel=0.03)
    assert (law.mu_0 - 0.62) / 0.062 == pytest.approx(0.5)
    assert friction("none.planed_ash").mu(1.0, 0.1) == 0.3 - 0.25 * 0.15  # its stated deviation is half of 0.3
