"""The rigs and forms of the ninth set keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import asymmetry_of_level_and_slope, dwell_exponential, load_of_hertz_and_amontons, presliding_bar
from .mechanism import backlash_between_shoulders, belt_of_a_motor, load_of_half_a_wave, stiffness_of_a_conical_spring
from .nameless import damper_with_play, plunger_leaves_the_box
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 9}
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
    assert all(form.apply.__doc__ for form in unknown)  # each says which names can be defended
    assert all(name.startswith("ninth_") for name in SET)


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
    runs, twins = (make_runs(case, 3, strength=strength, share=0.2 if case.design == "one" else 0.3) for strength in (1.0, 0.0))
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > 4 for run in runs)
    sizes = effect_sizes(runs, twins, rig_of(SET[name]))
    if name in NULLS:
        assert max(sizes.values()) == 0.0
    else:
        assert max(sizes.values()) > 10.0


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


def test_declared_scatter_is_as_large_as_declared():
    world = world_of("hip")
    SET["ninth_scatter_declared"].apply(world, 1.0)
    drawn = []
    for _ in range(2000):
        world.on_stick(None)
        drawn.append([world.mu_s(None) - world.rig.mu_s, world.mu_k(None) - world.rig.mu_k])
    assert np.std(drawn, axis=0) == pytest.approx([0.003, 0.003], rel=0.07)  # 4 standard deviations of 1/63


def test_ageing_is_none_at_the_usual_rest_and_ends():
    world = world_of("tendon")
    dwell_exponential(world, 1.0)
    grown = (world.mu_s(at(dwell=world.nominal.period * np.array([0.0, 1.0, 6.0, 12.0]))) - world.rig.mu_s) / world.nominal.gap
    assert grown[1] == pytest.approx(0.0, abs=1e-12)
    assert grown[0] < -0.3
    assert 0.15 < grown[2] < grown[3] < grown[2] + 1e-3


def test_one_direction_is_as_stated_and_the_other_drags_more_the_faster_it_slides():
    along, against = (world_of("comb", direction=direction) for direction in (1.0, -1.0))
    for world in (along, against):
        asymmetry_of_level_and_slope(world, 1.0)
    rig, top = along.rig, along.nominal.peak_speed
    assert (along.mu_s(None), along.mu_k(at(direction=1.0, w=top))) == (rig.mu_s, rig.mu_k)
    assert against.mu_s(None) - rig.mu_s == pytest.approx(0.1 * rig.gap)
    more = [against.mu_k(at(direction=-1.0, w=-u * top)) - rig.mu_k for u in (0.0, 1.0)]
    assert more == pytest.approx([0.1 * rig.gap, 0.3 * rig.gap])


def test_a_hertzian_share_rubs_less_per_load_the_more_it_is_pressed():
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of("hip", load=load)
        load_of_hertz_and_amontons(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors == pytest.approx([0.25 + 0.75 * 2 ** (1 / 3), 1.0, 0.25 + 0.75 * 0.5 ** (1 / 3)])


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of("cylinder")
    presliding_bar(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-9)


def test_a_conical_spring_stiffens_from_a_place_on_and_has_no_jump():
    world = world_of("slipway")
    stiffness_of_a_conical_spring(world, 1.0)
    x = np.linspace(0.0, 3.0, 3001) * world.nominal.reach
    stiffness = np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness
    assert stiffness[:440] == pytest.approx(1.0)
    assert stiffness[1000] == pytest.approx(1.0 / (1.0 - 0.8 * 0.55), rel=0.01)
    assert np.all(np.diff(stiffness) > -1e-9)
    assert np.diff(stiffness).max() < 0.05


def test_a_gap_has_shoulders():
    world = world_of("hip")
    backlash_between_shoulders(world, 1.0)
    gap = 0.11 * world.nominal.slip_length
    start = world.rig.reach - 0.6 * world.rig.slip_length
    x = start + gap * np.array([-0.5, 0.0, 0.25, 1.25, 1.5, 2.5])
    stiffness = np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness
    assert stiffness == pytest.approx([1.0, 0.5, 0.03, 0.5, 1.0])


def test_ripples_of_load_and_belt_have_no_mean_and_never_turn_round():
    world = world_of("tendon", cycles=200.0)
    load_of_half_a_wave(world, 1.0)
    belt_of_a_motor(world, 1.0)
    for turn, factor in (
        (5.3, lambda t: world.normal(at(t=t)) / world.normal_force),
        (1.71, lambda t: world.belt(t) / world.belt_velocity),
    ):
        t = np.linspace(0.0, 30.0 * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=1e-3)
        assert factor(t).min() > 0.5
        assert 0.1 < np.ptp(factor(t)) < 0.8


def test_a_damper_with_play_is_moved_by_less_than_the_box_is():
    world = world_of("slipway", cycles=4.0)
    damper_with_play(world, 1.0)
    free = 0.1 * world.nominal.slip_length
    assert world.load(at(x=0.99 * free, q=(0.0,))) == 0.0
    assert world.load(at(x=1.5 * free, q=(0.0,))) < 0.0
    assert world.load(at(x=-1.5 * free, q=(0.0,))) > 0.0


def test_a_plunger_is_late_in_slips_alone_and_never_below_the_box():
    run = make_runs(Case(SET["ninth_plunger_leaves_the_box"], "one", 1.0), 3, share=0.1)[0]
    late = run.reading - run.motion.position
    assert plunger_leaves_the_box.__doc__
    assert late.min() >= 0.0
    assert late.max() > 0.1 * run.world.nominal.slip_length
    assert 0.8 < np.mean(late == 0.0) < 0.99
