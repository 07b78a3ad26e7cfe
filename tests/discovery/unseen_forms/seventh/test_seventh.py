"""The rigs and forms of the seventh set keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import load_with_a_least, presliding_segalman
from .mechanism import backlash_between_arc_tangents, belt_of_a_governor, load_of_a_dwelling_cam, stiffness_of_an_air_spring
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 7}
NULLS = [name for name, form in SET.items() if NONE in form.truth]


def world_of(name: str, *, load: float = 1.0, cycles: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    return World(rig, rig, rig.belt_velocity, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))


def test_the_set_is_as_wide_as_asked_for():
    unknown = [form for form in SET.values() if UNKNOWN in form.truth]
    named = [form for form in SET.values() if not form.truth & {UNKNOWN, NONE}]
    assert (len(named), len(unknown), len(NULLS)) == (26, 14, 12)
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert {form.rig for form in SET.values()} == set(RIGS_OF_THE_SET)
    assert all(name.startswith("seventh_") for name in SET)


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
    share = 0.2 if case.design == "one" else 0.3
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
    assert world.nominal.peak_speed * float(str(options.get("jitter", 0.0))) / rig.rate <= 1.05 * rig.noise
    stated = options.get("uncertainty", UNCERTAINTY)
    assert isinstance(stated, dict)
    for key, sd in stated.items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        limit = 2.0 * float(str(options.get("at_limits", 0.75)).replace("True", "1"))
        assert off == pytest.approx(limit) if "at_limits" in options else off <= limit + 1e-12


def test_friction_is_least_below_the_stated_load_and_as_stated_at_it():
    factors = []
    for load in (0.2, 0.5, 1.0, 2.0):
        world = world_of("gib", load=load)
        load_with_a_least(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors[2] == pytest.approx(1.0, rel=1e-12)
    assert factors[0] > factors[1] < factors[2] < factors[3]


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of("catheter")
    presliding_segalman(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-6)


def test_the_air_spring_hardens_and_the_clearance_loses_its_width():
    world = world_of("isolator")
    stiffness_of_an_air_spring(world, 1.0)
    x = np.array([0.2, 0.5, 1.0]) * world.nominal.reach
    secant = world.spring(type("At", (), {"x": x})) / x / world.rig.stiffness
    assert secant[1] == pytest.approx(1.0, rel=1e-12)
    assert np.all(np.diff(secant) > 0.05)
    backlash_between_arc_tangents(world, 1.0)
    far = np.array([0.0, 50.0]) * world.nominal.slip_length
    lost = far - world.spring(type("At", (), {"x": far})) / world.rig.stiffness
    assert lost[0] == pytest.approx(0.0, abs=1e-15)
    assert lost[1] == pytest.approx(0.95 * 0.13 * world.nominal.slip_length, rel=0.05)


def test_ripples_of_load_and_belt_have_no_mean_and_no_jump():
    world = world_of("drawer", cycles=200.0)
    load_of_a_dwelling_cam(world, 1.0)
    belt_of_a_governor(world, 1.0)
    t = np.linspace(0.0, 4.3 * 13.7 * world.nominal.period, 200001)  # whole periods of both
    load = world.normal(type("At", (), {"t": t})) / world.normal_force
    speed = world.belt(t) / world.belt_velocity
    assert [np.mean(load), np.mean(speed)] == pytest.approx([1.0, 1.0], abs=1e-3)
    assert np.ptp(speed) == pytest.approx(0.5, rel=0.01)
    assert max(np.abs(np.diff(load)).max(), np.abs(np.diff(speed)).max()) < 0.01
