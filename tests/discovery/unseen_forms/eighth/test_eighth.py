"""The rigs and forms of the eighth set keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import asymmetry_of_leaning_bristles, dwell_with_cement, load_of_a_dmt_sphere, presliding_tangent
from .mechanism import belt_in_burst_control, load_of_a_float, stiffness_of_wavy_fibres
from .nameless import anchor_drags, escapement_pushes, panel_clicks
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 8}
LATE = ("eighth_drift_that_feeds_itself",)
"""What shows after twelve cycles alone."""
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
    assert (len(named), len(unknown), len(NULLS)) == (26, 14, 12)
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert {form.rig for form in SET.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in unknown)  # each says which names can be defended
    assert all(name.startswith("eighth_") for name in SET)


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    form, rig = SET[name], rig_of(SET[name])
    stated = form.options.get("uncertainty", UNCERTAINTY)
    assert isinstance(stated, dict)
    stiffest = 1.0 + stated["stiffness"] + stated["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * stated["mu_s"]) - rig.mu_k * (1.0 + 2.0 * stated["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        assert min(cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit") >= 20.0


@pytest.mark.parametrize("name", SET)
def test_a_form_moves_what_is_shown_by_tens_of_floors_and_a_null_by_nothing(name):
    case = Case(SET[name], SET[name].designs[0], 1.0)
    share = 0.5 if name in LATE else 0.2 if case.design == "one" else 0.3
    runs, twins = (make_runs(case, 3, strength=strength, share=share) for strength in (1.0, 0.0))
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
    if not options.get("stamped"):
        assert world.nominal.peak_speed * float(str(options.get("jitter", 0.0))) / rig.rate <= 1.05 * rig.noise
    for key, sd in UNCERTAINTY.items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        limit = 2.0 * float(str(options.get("at_limits", 0.75)).replace("True", "1"))
        assert off == pytest.approx(limit) if "at_limits" in options else off <= limit + 1e-12


def test_declared_scatter_is_as_large_as_declared():
    world = world_of("lens")
    SET["eighth_scatter_declared"].apply(world, 1.0)
    drawn = []
    for _ in range(2000):
        world.on_stick(None)
        drawn.append([world.mu_s(None) - world.rig.mu_s, world.mu_k(None) - world.rig.mu_k])
    assert np.std(drawn, axis=0) == pytest.approx([0.009, 0.009], rel=0.07)  # 4 standard deviations of 1/63


def test_ageing_is_none_at_the_usual_rest_and_steeper_beyond_it():
    world = world_of("piston")
    dwell_with_cement(world, 1.0)
    rest = world.nominal.period * np.array([0.3, 0.5, 1.0, 2.0, 4.0])
    grown = (world.mu_s(at(dwell=rest)) - world.rig.mu_s) / world.nominal.gap
    assert grown[2] == pytest.approx(0.0, abs=1e-12)
    slopes = np.diff(grown) / np.diff(np.log(rest))
    assert np.all(slopes > 0.0)
    assert slopes[-1] > 2.5 * slopes[0]


def test_bristles_lean_one_way():
    along, against = (world_of("head", direction=direction) for direction in (1.0, -1.0))
    for world in (along, against):
        asymmetry_of_leaning_bristles(world, 1.0)
    gap = along.nominal.gap
    assert against.mu_s(None) - along.mu_s(None) == pytest.approx(0.14 * gap)
    assert against.mu_k(at(direction=-1.0)) - along.mu_k(at(direction=1.0)) == pytest.approx(0.28 * gap)


def test_an_adhering_sphere_rubs_less_per_load_the_more_it_is_pressed():
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of("boot", load=load)
        load_of_a_dmt_sphere(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors[1] == pytest.approx(1.0, rel=1e-12)
    assert (factors[0] > 1.2, factors[2] < 0.85) == (True, True)


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of("piston")
    presliding_tangent(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-9)


def test_wavy_fibres_stiffen_and_are_as_stiff_as_believed_at_four_fifths_of_the_reach():
    world = world_of("gate")
    stiffness_of_wavy_fibres(world, 1.0)
    x = np.array([0.2, 0.5, 0.8, 1.1]) * world.nominal.reach
    secant = world.spring(at(x=x)) / x / world.rig.stiffness
    assert secant[2] == pytest.approx(1.0, rel=1e-12)
    assert np.all(np.diff(secant) > 0.05)
    assert world.spring(at(x=0.0)) == 0.0


def test_ripples_of_load_and_belt_have_no_mean_and_no_jump():
    world = world_of("bearing", cycles=200.0)
    load_of_a_float(world, 1.0)
    belt_in_burst_control(world, 1.0)
    for turn, factor in (
        (4.7, lambda t: world.normal(at(t=t)) / world.normal_force),
        (1.53, lambda t: world.belt(t) / world.belt_velocity),
    ):
        t = np.linspace(0.0, 30.0 * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=1e-3)
        assert 0.1 < np.ptp(factor(t)) < 0.4
        assert np.abs(np.diff(factor(t))).max() < 0.01


def test_an_anchor_drags_by_no_more_than_the_spring_has_let_go_and_never_back():
    world = world_of("lens", cycles=12.0)
    anchor_drags(world, 1.0)
    motion = simulate(world, np.linspace(0.0, world.duration, 6001))
    alone = simulate(world_of("lens", cycles=12.0), motion.time)
    moved = (motion.breaks[2:8, 1] - alone.breaks[2:8, 1]) / world.nominal.slip_length
    assert np.all(np.diff(moved) > 0.0)
    assert 0.01 < moved[-1] < 0.2


def test_an_escapement_pushes_for_a_part_of_each_slip():
    world = world_of("gate", cycles=4.0)
    escapement_pushes(world, 1.0)
    world.on_break(at(t=1.0))
    since = np.array([-0.1, 0.0, 0.35, 0.7, 9.0]) / world.nominal.pulsation
    force = world.load(at(t=1.0 + since))
    assert force[2] == pytest.approx(-0.5 * world.nominal.gap * world.nominal.normal_force)
    np.testing.assert_allclose(force[[0, 1, 3, 4]], 0.0, atol=1e-9 * abs(force[2]))


def test_a_panel_clicks_in_at_one_place_and_out_at_another():
    world = world_of("piston")
    panel_clicks(world, 1.0)
    rig, fast = world.rig, world.nominal.peak_speed
    x = rig.reach - np.array([0.1, 0.4, 0.8]) * rig.slip_length
    lost = [(rig.stiffness * x - world.spring(at(x=x, w=w))) / (0.14 * rig.gap * rig.normal_force) for w in (0.0, fast)]
    np.testing.assert_allclose(lost, [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], atol=1e-3)
