"""The rigs and forms of the tenth set keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import (
    asymmetry_of_a_band,
    correlated_between_walls,
    dwell_of_menisci,
    lag_of_concrete,
    load_of_a_bridge_bearing,
    presliding_elasto_plastic,
    scatter_of_shares,
    viscous_reiner_philippoff,
    weakening_of_rubber,
)
from .mechanism import backlash_of_worn_teeth, belt_of_a_treadle, force_of_a_fan, load_of_a_magnet, stiffness_of_a_cushion
from .nameless import belt_droops_under_load, gel_stays_weak, loader_sags_at_each_slip, spring_surges
from .rigs import RIGS_OF_THE_SET
from .sensor import clipping_that_latches, step_that_chatters

SET = {name: form for name, form in FORMS.items() if form.series == 10}
NULLS = [name for name, form in SET.items() if NONE in form.truth]


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
    assert (len(named), len(unknown), len(NULLS)) == (26, 12, 12)
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert {form.rig for form in SET.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in SET.values())  # of the unknown ones: which names can be defended
    assert all(name.startswith("tenth_") for name in SET)


def test_the_ninth_set_entered_before():
    series = [form.series for form in FORMS.values()]
    first = series.index(10)
    assert series[first : first + len(SET)] == [10] * len(SET)
    assert series[first - 1] == 9


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    form, rig = SET[name], rig_of(SET[name])
    stated = form.options.get("uncertainty", UNCERTAINTY)
    assert isinstance(stated, dict)
    stiffest = 1.0 + stated["stiffness"] + stated["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert rig.rate * rig.period > 60.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * stated["mu_s"]) - rig.mu_k * (1.0 + 2.0 * stated["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        assert min(cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit") >= 20.0


@pytest.mark.parametrize("name", SET)
def test_a_form_moves_what_is_shown_by_tens_of_floors_and_a_null_by_nothing(name):
    case = Case(SET[name], SET[name].designs[0], 1.0)
    share = 0.2 if case.design == "one" else 0.3
    runs, halves, twins = (make_runs(case, 3, strength=strength, share=share) for strength in (1.0, 0.5, 0.0))
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > 4 for run in runs)
    sizes, half = (effect_sizes(moved, twins, rig_of(SET[name])) for moved in (runs, halves))
    if name in NULLS:
        assert max(sizes.values()) == 0.0
    else:
        assert max(sizes.values()) > 20.0
        assert max(half.values()) > 10.0


def test_the_same_seed_makes_the_same_record_and_another_one_does_not():
    case = Case(SET["tenth_scatter_of_shares"], "one", 1.0)
    first, again, other = (make_runs(case, seed, share=0.1)[0].reading for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.std(first - other) > 10.0 * rig_of(case.form).noise


@pytest.mark.parametrize("name", [name for name in NULLS if not SET[name].options.get("declared")])
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
        limit = 2.0 * float(str(options.get("at_limits", 0.75)).replace("True", "1"))
        assert off == pytest.approx(limit) if "at_limits" in options else off <= limit + 1e-12


def draws_of(world: World, count: int) -> np.ndarray:
    drawn = []
    for _ in range(count):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(None) - world.rig.mu_s, world.mu_k(None) - world.rig.mu_k])
    return np.array(drawn)


def test_declared_scatter_is_as_large_as_declared():
    world = world_of("clutch")
    SET["tenth_scatter_declared"].apply(world, 1.0)
    assert np.std(draws_of(world, 2000), axis=0) == pytest.approx([0.006, 0.006], rel=0.07)  # 4 standard deviations of 1/63


def test_shares_scatter_about_what_is_stated_and_lean():
    world = world_of("stern")
    scatter_of_shares(world, 1.0)
    drawn = draws_of(world, 4000) / world.nominal.gap
    assert drawn.mean(0) == pytest.approx([0.0, 0.0], abs=0.006)
    assert drawn.std(0) == pytest.approx([0.09, 0.06], rel=0.06)
    assert drawn[:, 0].max() > 1.3 * -drawn[:, 0].min()


def test_a_walk_between_walls_is_even_and_forgets_in_seven_slips():
    world = world_of("stage")
    correlated_between_walls(world, 1.0)
    level = draws_of(world, 20000)[:, 0] / (0.045 * world.rig.mu_s)
    assert np.abs(level).max() <= np.sqrt(3.0)
    assert level.std() == pytest.approx(1.0, abs=0.05)
    assert np.mean(level[7:] * level[:-7]) / np.mean(level**2) == pytest.approx(np.exp(-1.0), abs=0.06)


def test_rubber_weakens_over_most_speeds_and_concrete_over_a_way():
    world = world_of("syringe")
    weakening_of_rubber(world, 1.0)
    top = world.nominal.peak_speed
    more = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / world.nominal.gap for u in (0.05, 0.1, 0.3, 1.0)]
    assert more[0] == pytest.approx(0.45)
    assert np.all(np.diff(more) < -0.03)
    world = world_of("webbing")
    lag_of_concrete(world, 1.0)
    left = [(world.mu_k(at(slip=u * 0.4 * world.nominal.slip_length, slip_time=0.0)) - world.rig.mu_k) for u in (0.0, 0.1, 1.0)]
    assert np.array(left) / world.rig.gap == pytest.approx([1.0, 0.51, 0.0], abs=0.01)


def test_a_fluid_is_thick_at_low_stress_and_thin_at_high():
    world = world_of("telescope")
    viscous_reiner_philippoff(world, 1.0)
    u = np.linspace(0.0, 1.0, 101)
    drag = np.array([world.mu_k(at(w=v * world.nominal.peak_speed)) for v in u]) - world.rig.mu_k
    assert drag[-1] == pytest.approx(0.4 * world.nominal.gap)
    assert np.all(np.diff(drag) > 0.0)
    assert drag[5] / u[5] > 2.0 * drag[-1]


def test_ageing_is_none_at_the_usual_rest_begins_as_a_root_and_ends():
    world = world_of("clutch")
    dwell_of_menisci(world, 1.0)
    rest = world.nominal.period * np.array([0.0, 0.01, 0.04, 1.0, 9.0, 12.0])
    grown = (world.mu_s(at(dwell=rest)) - world.rig.mu_s) / world.nominal.gap
    assert grown[3] == pytest.approx(0.0, abs=1e-12)
    assert (grown[2] - grown[0]) / (grown[1] - grown[0]) == pytest.approx(2.0, rel=0.08)
    assert 0.1 < grown[4] < grown[5] < grown[4] + 1e-3


def test_a_band_holds_more_one_way_by_the_angle_that_is_wound():
    along, against = (world_of("webbing", direction=direction) for direction in (1.0, -1.0))
    for world in (along, against):
        asymmetry_of_a_band(world, 1.0)
    rig, angle = along.rig, 0.25 / along.nominal.mu_s
    assert along.mu_s(None) / against.mu_s(None) == pytest.approx(np.exp(rig.mu_s * angle))
    assert along.mu_k(at(direction=1.0)) / along.mu_k(at(direction=-1.0)) == pytest.approx(np.exp(rig.mu_k * angle))
    assert against.mu_s(None) < rig.mu_s < along.mu_s(None)
    asymmetry_of_a_band(along, 0.0)
    assert (along.mu_s(None), along.mu_k(at(direction=1.0))) == (rig.mu_s, rig.mu_k)


def test_a_bridge_bearing_rubs_less_per_load_the_more_it_is_pressed():
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of("stern", load=load)
        load_of_a_bridge_bearing(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors == pytest.approx([1.267, 1.0, 0.791], abs=2e-3)


def test_the_presliding_curve_is_straight_at_first_and_has_an_inverse():
    world = world_of("stage")
    presliding_elasto_plastic(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-9)
    assert world.contact_deflection(0.4) == pytest.approx(2.0 * world.contact_deflection(0.2), rel=1e-6)
    assert world.contact_deflection(0.98) > 1.3 * 0.98 / 0.4 * world.contact_deflection(0.4)


def test_a_cushion_stiffens_and_has_no_jump():
    world = world_of("clutch")
    stiffness_of_a_cushion(world, 1.0)
    x = np.linspace(-0.5, 3.0, 3501) * world.nominal.reach
    stiffness = np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness
    assert stiffness[500] == pytest.approx(1.0, abs=1e-3)
    assert stiffness[1500] == pytest.approx(0.4 + 0.6 / np.cos(0.5 * np.pi / 1.7) ** 2, rel=0.01)
    assert np.all(np.diff(stiffness[500:]) > -1e-6)


def test_worn_teeth_give_way_slowly_and_close_at_once():
    world = world_of("stern")
    backlash_of_worn_teeth(world, 1.0)
    gap, start = 0.12 * world.nominal.slip_length, world.rig.reach - 0.62 * world.rig.slip_length
    x = start + gap * np.array([-1.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.5])
    stiffness = np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness
    assert stiffness == pytest.approx([1.0, 0.879, 0.636, 0.394, 0.151, 0.03, 1.0], abs=1e-3)


def test_ripples_and_puffs_have_no_mean_and_the_belt_never_turns_round():
    world = world_of("syringe", cycles=200.0)
    load_of_a_magnet(world, 1.0)
    belt_of_a_treadle(world, 1.0)
    force_of_a_fan(world, 1.0)
    strength = world.nominal.gap * world.nominal.normal_force
    for turn, factor in (
        (4.9, lambda t: world.normal(at(t=t)) / world.normal_force),
        (1.23, lambda t: world.belt(t) / world.belt_velocity),
        (1.0 / 1.17, lambda t: 1.0 + world.load(at(t=t)) / strength),
    ):
        t = np.linspace(0.0, 30.0 * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=1e-3)
        assert factor(t).min() > 0.5
        assert 0.1 < np.ptp(factor(t)) < 0.8


def test_a_plug_chatters_and_stays():
    world = world_of("webbing", cycles=20.0)
    step_that_chatters(world, 1.0)
    t = np.linspace(0.0, world.duration, 20001)
    shown = world.sensor(t, at(position=np.zeros_like(t)), None)
    assert np.count_nonzero(np.diff(shown)) == 7
    assert np.all(shown[t > 7.7 * world.nominal.period] == 0.1 * world.nominal.slip_length)


def test_a_latch_is_on_above_one_level_and_off_below_a_lower_one():
    world = world_of("stern")
    clipping_that_latches(world, 1.0)
    on, back = world.rig.reach - 0.17 * world.rig.slip_length, 0.06 * world.nominal.slip_length
    x = on + back * np.array([-2.0, -0.5, 0.5, -0.5, -0.9, -1.1, -0.5])
    shown = world.sensor(np.arange(7.0), at(position=x), None)
    np.testing.assert_array_equal(shown, [x[0], x[1], on, on, on, x[5], x[6]])


def test_a_belt_that_droops_is_slowest_at_break_away_and_nowhere_jumps():
    world = world_of("clutch", cycles=6.0)
    belt_droops_under_load(world, 1.0)
    speeds, gaps = [], []
    for name in ("on_stick", "on_break"):
        act = getattr(world, name)

        def watched(s, act=act, name=name):
            before = float(world.travel(s.t)), float(world.belt(s.t))
            act(s)
            gaps.append(float(world.travel(s.t)) - before[0])
            speeds.append(before[1] if name == "on_break" else float(world.belt(s.t)))

        setattr(world, name, watched)
    motion = simulate(world, np.linspace(0.0, world.duration, 2000))
    assert len(motion.breaks) > 4
    assert np.abs(gaps).max() < 1e-12
    begin, end = np.array(speeds[2:-2:2]) / world.belt_velocity, np.array(speeds[3:-1:2]) / world.belt_velocity
    assert np.all(begin > 1.1)
    assert end == pytest.approx(0.75, abs=0.01)


def test_a_gel_never_sets_within_a_slip_and_is_stiff_again_after_a_rest():
    world = world_of("stern")
    gel_stays_weak(world, 1.0)
    speeds = world.nominal.peak_speed * np.array([0.0, 0.3, 0.6, 0.3, 0.0])
    course = np.array([world.mu_k(at(w=speed)) for speed in speeds]) - world.rig.mu_k
    assert np.all(np.diff(course[:3]) < 0.0)
    assert np.all(course[2:] == course[2])
    world.on_break(None)
    assert world.mu_k(at(w=0.0)) - world.rig.mu_k == course[0]


def test_a_loader_sags_at_a_break_away_and_recovers():
    world = world_of("telescope")
    loader_sags_at_each_slip(world, 1.0)
    world.on_break(at(t=5.0))
    loads = np.array([world.normal(at(t=5.0 + rest * world.nominal.period)) for rest in (0.0, 0.8, 8.0)]) / world.normal_force
    assert loads == pytest.approx([0.87, 1.0 - 0.13 * np.exp(-1.0), 1.0], abs=1e-4)


def test_a_surging_spring_is_as_stiff_as_believed_at_rest():
    world = world_of("webbing")
    spring_surges(world, 1.0)
    x = 0.01
    rest = at(x=x, q=(0.25 * x, 0.0, 0.5 * x, 0.0, 0.75 * x, 0.0))
    assert world.spring(rest) == pytest.approx(world.rig.stiffness * x)
    assert np.abs(world.rates(rest)).max() < 1e-9
