"""The rigs and forms of the sixth set keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import UNCERTAINTY, Case, effect_sizes, make_runs, points, rig_of

from .friction import load_error_function, presliding_richard_abbott
from .mechanism import stiffness_of_a_sagging_rope
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 6}
NULLS = [name for name, form in SET.items() if NONE in form.truth]


def world_of(name: str, *, load: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    return World(rig, rig, rig.belt_velocity, load * rig.normal_force, rig.period, np.random.default_rng(0))


def test_the_set_is_as_wide_as_asked_for():
    unknown = [form for form in SET.values() if UNKNOWN in form.truth]
    named = [form for form in SET.values() if not form.truth & {UNKNOWN, NONE}]
    assert (len(named), len(unknown), len(NULLS)) == (12, 8, 6)
    assert len({kind for form in named for kind in form.truth}) == 12
    assert {kind for form in named for kind in form.truth} <= set(KINDS)
    assert all(name.startswith("sixth_") for name in SET)


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    form, rig = SET[name], rig_of(SET[name])
    assert form.rig in RIGS_OF_THE_SET
    stiffest = 1.0 + UNCERTAINTY["stiffness"] + UNCERTAINTY["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * UNCERTAINTY["mu_s"]) - rig.mu_k * (1.0 + 2.0 * UNCERTAINTY["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        assert min(cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit") >= 20.0


@pytest.mark.parametrize(("name", "design"), [(name, design) for name, form in SET.items() for design in form.designs])
def test_a_form_moves_what_is_shown_by_tens_of_floors_and_a_null_by_nothing(name, design):
    case = Case(SET[name], design, 1.0)
    runs = make_runs(case, 3, strength=1.0, share=0.3)
    assert all(np.all(np.isfinite(run.reading)) and len(run.motion.sticks) > 4 for run in runs)
    if design != SET[name].designs[0]:
        return
    twins = make_runs(case, 3, strength=0.0, share=0.3)
    sizes = effect_sizes(runs, twins, rig_of(SET[name]))
    if name in NULLS:
        assert max(sizes.values()) == 0.0
    else:
        assert max(sizes.values()) > 10.0


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_the_stated_law_says_and_is_off_by_no_more_than_is_stated(name):
    run, rig = make_runs(Case(SET[name], SET[name].designs[0], 1.0), 3, share=0.05)[0], rig_of(SET[name])
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    assert np.std(run.reading - run.motion.position) < 2.0 * world.nominal.noise
    assert world.nominal.peak_speed * float(SET[name].options.get("jitter", 0.0)) / rig.rate <= 1.05 * rig.noise
    for key, sd in UNCERTAINTY.items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(4.0 / 3.0) if SET[name].options.get("at_limits") else off <= 1.5 + 1e-12


def test_the_error_function_is_none_at_the_stated_load_and_saturates():
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of("spool", load=load)
        load_error_function(world, 1.0)
        factors.append(world.mu_s(None) / world.rig.mu_s)
    assert factors[1] == pytest.approx(1.0, rel=1e-12)
    assert factors[0] > factors[1] > factors[2] > 0.5 * factors[1]


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of("pad")
    presliding_richard_abbott(world, 1.0)
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-9)


def test_the_rope_hardens_and_is_as_stiff_as_believed_at_four_fifths():
    world = world_of("blade")
    stiffness_of_a_sagging_rope(world, 1.0)
    x = np.array([0.4, 0.8, 1.0]) * world.nominal.reach
    secant = world.spring(type("At", (), {"x": x})) / x / world.rig.stiffness
    assert secant[1] == pytest.approx(1.0, rel=1e-6)
    assert np.all(np.diff(secant) > 0.02)
