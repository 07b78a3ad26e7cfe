"""The rigs and forms of the eleventh set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import (
    asymmetry_of_leaning_facets,
    correlated_that_sways,
    dwell_squeezes_out,
    lag_of_glued_sheets,
    load_of_a_pendulum_bearing,
    presliding_brush,
    scatter_below_a_ceiling,
    viscous_of_a_film_that_heats,
    weakening_of_shared_load,
)
from .mechanism import (
    backlash_damped_where_it_bears,
    belt_with_a_lump,
    force_of_a_hunting_motor,
    load_of_a_compressor,
    stiffness_beyond_a_preload,
)
from .nameless import camera_reads_rows_in_turn, flywheel_on_a_freewheel, linkage_weighs_more_where_slips_end, target_is_rough
from .rigs import RIGS_OF_THE_SET
from .sensor import clipping_of_an_amplifier, delay_of_a_camera

SET = {name: form for name, form in FORMS.items() if form.series == 11}
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = {"eleventh_scatter_declared": 0.005, "eleventh_scatter_declared_correlated": 0.004}


def world_of(name: str, *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    speed = direction * rig.belt_velocity
    return World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def test_the_set_is_as_wide_as_asked_for():
    unknown = [form for form in SET.values() if UNKNOWN in form.truth]
    named = [form for form in SET.values() if not form.truth & {UNKNOWN, NONE}]
    assert (len(named), len(unknown), len(NULLS)) == (26, 8, 8)
    assert sorted(kind for form in named for kind in form.truth) == sorted(KINDS)
    assert all(form.right("one") == {UNKNOWN} for form in unknown)
    assert {form.rig for form in SET.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in SET.values())
    assert all(name.startswith("eleventh_") for name in SET)


def test_each_form_has_a_source_that_no_earlier_form_of_its_kind_has():
    for form in SET.values():
        assert re.search(r"\b(1[789]|20)\d\d\b|JCGM 100:2008", form.source), form.name
        if form.truth & {NONE}:
            continue
        others = {other.source for other in FORMS.values() if other.series < 11 and other.truth & form.truth}
        assert form.source not in others


def test_the_tenth_set_entered_before():
    series = [form.series for form in FORMS.values()]
    first = series.index(11)
    assert series[first : first + len(SET)] == [11] * len(SET)
    assert series[first - 1] == 10


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    form, rig = SET[name], rig_of(SET[name])
    stiffest = 1.0 + UNCERTAINTY["stiffness"] + UNCERTAINTY["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert rig.rate * rig.period > 60.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * UNCERTAINTY["mu_s"]) - rig.mu_k * (1.0 + 2.0 * UNCERTAINTY["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        assert min(cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit") >= 20.0


@pytest.mark.parametrize("name", SET)
def test_a_form_moves_what_is_shown_by_tens_of_floors_and_a_null_by_nothing(name):
    case = Case(SET[name], SET[name].designs[0], 1.0)
    share = 0.3  # seven cycles of each run at least
    runs, halves, twins = (make_runs(case, 3, strength=strength, share=share) for strength in (1.0, 0.5, 0.0))
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > 4 for run in runs)
    sizes, half = (effect_sizes(moved, twins, rig_of(SET[name])) for moved in (runs, halves))
    if name in NULLS:
        assert max(sizes.values()) == 0.0
    else:
        assert max(sizes.values()) > 20.0
        assert max(half.values()) > 10.0


@pytest.mark.parametrize("name", [name for name in SET if name not in NULLS])
def test_no_strength_is_no_form(name):
    runs = make_runs(Case(SET[name], SET[name].designs[0], 1.0), 3, strength=0.0, share=0.1)
    for run in runs:
        world = run.world
        plain = World(world.rig, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
        motion = simulate(plain, run.motion.time)
        assert np.abs(motion.position - run.reading).max() < 0.1 * world.nominal.noise


def test_the_same_seed_makes_the_same_record_and_another_one_does_not():
    case = Case(SET["eleventh_scatter_below_a_ceiling"], "one", 1.0)
    first, again, other = (make_runs(case, seed, share=0.1)[0].reading for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.std(first - other) > 10.0 * rig_of(case.form).noise


@pytest.mark.parametrize("name", [name for name in NULLS if name not in DECLARED])
def test_a_null_moves_as_the_stated_law_says_and_is_off_by_no_more_than_is_stated(name):
    options = SET[name].options
    run, rig = make_runs(Case(SET[name], "one", 1.0), 3, share=0.05)[0], rig_of(SET[name])
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    assert np.std(run.reading - run.motion.position) < 2.0 * world.nominal.noise
    assert world.nominal.peak_speed * float(str(options.get("jitter", 0.0))) / rig.rate <= 1.05 * rig.noise
    for key, sd in UNCERTAINTY.items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(2.0) if "at_limits" in options else off <= 1.5 + 1e-12


def draws_of(world: World, count: int) -> np.ndarray:
    drawn = []
    for _ in range(count):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(None) - world.rig.mu_s, world.mu_k(None) - world.rig.mu_k])
    return np.array(drawn)


def test_declared_scatter_is_as_large_as_declared():
    assert {name: SET[name].options["declared_sigma"] for name in DECLARED} == DECLARED
    world = world_of("film")
    SET["eleventh_scatter_declared"].apply(world, 1.0)
    assert np.std(draws_of(world, 2000), axis=0) == pytest.approx([0.005, 0.005], rel=0.07)  # 4 standard deviations of 1/63
    world = world_of("crane", cycles=2000.0)
    SET["eleventh_scatter_declared_correlated"].apply(world, 1.0)
    t = np.linspace(0.0, world.duration, 20001)
    assert np.std(world.mu_s(at(t=t))) == pytest.approx(0.004, rel=0.12)


def test_scatter_has_a_ceiling_and_the_stated_means():
    world = world_of("needle")
    scatter_below_a_ceiling(world, 1.0)
    drawn = draws_of(world, 4000) / world.nominal.gap
    assert drawn.mean(0) == pytest.approx([0.0, 0.0], abs=0.006)
    assert drawn.max(0) == pytest.approx([0.09, 0.06], abs=1e-3)
    assert drawn.min(0) == pytest.approx([-0.315, -0.21], abs=0.03)


def test_what_sways_turns_round_within_half_a_sway():
    world = world_of("ski")
    correlated_that_sways(world, 1.0)
    drawn = []
    for _ in range(20000):
        world.on_stick(at(t=0.0))
        drawn.append(world.mu_s(None) / world.rig.mu_s - 1.0)
    level = np.array(drawn) / 0.05
    assert level.std() == pytest.approx(1.0, abs=0.05)
    memory = [np.mean(level[lag:] * level[: level.size - lag]) / np.mean(level**2) for lag in (1, 5)]
    assert memory == pytest.approx([0.8125, -0.205], abs=0.05)


def test_speed_and_way_weaken_friction_and_a_film_that_heats_levels_off():
    world = world_of("damper")
    weakening_of_shared_load(world, 1.0)
    top = world.nominal.peak_speed
    more = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / world.nominal.gap for u in (0.0, 0.15, 1.0)]
    assert more == pytest.approx([0.7, 0.175, 0.0336], abs=1e-3)
    lag_of_glued_sheets(world, 1.0)
    way = 0.03 * world.nominal.slip_length
    left = [(world.mu_k(at(slip=u * way, slip_time=0.0)) - world.rig.mu_k) / world.rig.gap for u in (0.0, 1.0, 4.0)]
    assert left == pytest.approx(np.exp([0.0, -1.0, -2.0]))
    viscous_of_a_film_that_heats(world, 1.0)
    drag = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / world.nominal.gap for u in (0.0, 0.2, 0.8, 1.0)]
    assert drag[::3] == pytest.approx([0.0, 0.4])
    assert drag[1] > 1.3 * 0.2 * 0.4
    assert 0.0 < drag[3] - drag[2] < 0.06 * drag[3]


def test_ageing_is_none_at_the_usual_rest_and_ends_with_the_film():
    world = world_of("ski")
    dwell_squeezes_out(world, 1.0)
    grown = (world.mu_s(at(dwell=world.nominal.period * np.array([0.0, 0.9, 1.0, 1e6]))) - world.rig.mu_s) / world.nominal.gap
    assert grown == pytest.approx([-0.6236, -0.0232, 0.0, 0.5764], abs=2e-3)
    assert world.rig.mu_s + grown[0] * world.nominal.gap > world.rig.mu_k


def test_facets_add_their_angle_one_way_and_take_it_off_the_other():
    along, against = (world_of("crane", direction=direction) for direction in (1.0, -1.0))
    for world in (along, against):
        asymmetry_of_leaning_facets(world, 1.0)
    rig, angle = along.rig, np.arctan(0.25 * along.nominal.gap)
    for world, side in ((along, 1.0), (against, -1.0)):
        assert np.arctan(world.mu_s(None)) == pytest.approx(np.arctan(rig.mu_s) + side * angle)
        assert np.arctan(world.mu_k(at(direction=side))) == pytest.approx(np.arctan(rig.mu_k) + side * angle)


def test_a_bearing_rubs_less_per_load_and_a_brush_has_an_inverse():
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of("damper", load=load)
        load_of_a_pendulum_bearing(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors == pytest.approx([0.7**-0.4, 1.0, 0.7**0.8])
    world = world_of("film")
    presliding_brush(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, abs=1e-12)


def test_a_preload_gives_without_a_jump_and_play_is_slack():
    world = world_of("crane")
    stiffness_beyond_a_preload(world, 1.0)
    x = np.array([0.0, 0.5, 0.62, 0.8, 1.0]) * world.nominal.reach
    assert np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness == pytest.approx([1.0, 1.0, 0.55, 0.55])
    backlash_damped_where_it_bears(world, 1.0)
    slip = world.nominal.slip_length
    x = world.rig.reach - 0.58 * slip + slip * np.array([-0.2, 0.0, 0.05, 0.1, 0.3])
    stiffness = np.diff(world.spring(at(x=x, v=0.0))) / np.diff(x) / world.rig.stiffness
    assert stiffness == pytest.approx([1.0, 0.0, 0.0, 1.0], abs=1e-9)
    taken = world.spring(at(x=x, v=-1.0)) - world.spring(at(x=x, v=0.0))
    assert np.all(taken[:4] == pytest.approx(0.0, abs=1e-9))
    assert taken[4] < 0.0


def test_ripples_and_tones_have_no_mean_and_the_belt_never_turns_round():
    world = world_of("needle", cycles=320.0)
    load_of_a_compressor(world, 1.0)
    belt_with_a_lump(world, 1.0)
    force_of_a_hunting_motor(world, 1.0)
    strength = world.nominal.gap * world.nominal.normal_force
    for turn, factor in (
        (6.1, lambda t: world.normal(at(t=t)) / world.normal_force),
        (1.37, lambda t: world.belt(t) / world.belt_velocity),
        (7.3 * 10 / 1.31, lambda t: 1.0 + world.load(at(t=t)) / strength),
    ):
        t = np.linspace(0.0, 5.0 * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=2e-3)
        assert factor(t).min() > 0.45
        assert 0.1 < np.ptp(factor(t)) < 1.05


def test_an_amplifier_is_true_in_the_middle_and_a_camera_is_late():
    world = world_of("film", cycles=3.0)
    clipping_of_an_amplifier(world, 1.0)
    middle, slip = world.rig.reach - 0.5 * world.rig.slip_length, world.rig.slip_length
    x = middle + slip * np.array([-0.5, -0.2, 0.0, 0.2, 0.5, 0.9])
    shown = (world.sensor(np.arange(6.0), at(position=x), None) - middle) / slip
    assert shown == pytest.approx([-0.384, -0.2, 0.0, 0.2, 0.384, 0.39], abs=2e-3)
    delay_of_a_camera(world, 1.0)
    t = np.arange(0.0, world.duration, 1.0 / world.rig.rate)
    late = world.sensor(t, at(position=3.0 + 2.0 * t), None)
    assert late[100:] == pytest.approx(3.0 + 2.0 * (t[100:] - 0.45 / world.nominal.pulsation), rel=1e-4)
    assert late[0] == pytest.approx(3.0)


def test_a_camera_is_early_at_one_end_and_late_at_the_other_and_a_target_is_rough_alike_in_all_runs():
    world = world_of("needle")
    camera_reads_rows_in_turn(world, 1.0)
    t, slip = np.linspace(0.0, 1.0, 2001), world.rig.slip_length
    x = world.rig.reach - slip * t
    early = (x - world.sensor(t, at(position=x), None)) / slip * world.nominal.pulsation
    assert early[[500, 1000, 1500]] == pytest.approx([0.2, 0.0, -0.2], abs=1e-3)
    shown = []
    for seed in (0, 1):
        world = World(world.rig, world.rig, 1.0, 1.0, 1.0, np.random.default_rng(seed))
        target_is_rough(world, 1.0)
        shown.append(world.sensor(t, at(position=x), None))
    np.testing.assert_array_equal(*shown)
    assert 0.01 < np.std(shown[0] - x) / slip < 0.06


def slip_of(world: World) -> tuple[float, float, float]:
    """Return the length of the third slip, its duration, and the share of it at which it is fastest."""
    motion = simulate(world, np.arange(0.0, world.duration, 0.1 / world.rig.rate))
    (t0, x0), (t1, x1) = motion.breaks[2], motion.sticks[3]
    inside = (motion.time > t0) & (motion.time < t1)
    fastest = motion.time[inside][np.argmin(motion.velocity[inside])]
    return float(x0 - x1), float(t1 - t0), float((fastest - t0) / (t1 - t0))


def test_a_linkage_and_a_flywheel_change_how_a_slip_goes():
    plain, linkage, wheel = (world_of("damper", cycles=6.0) for _ in range(3))
    linkage_weighs_more_where_slips_end(linkage, 1.0)
    flywheel_on_a_freewheel(wheel, 1.0)
    usual, moved, driven = (slip_of(world) for world in (plain, linkage, wheel))
    assert moved[0] == pytest.approx(usual[0], rel=0.02)  # inertia takes no energy
    assert moved[2] < usual[2] - 0.03
    assert driven[0] < 0.96 * usual[0]  # the wheel keeps what it was given
    assert driven[2] > usual[2] + 0.02
