"""What no effect describes, in the nineteenth set: finite records that each form moves, and the physics of some of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import GRAVITY, nominal_bench
from tests.discovery.joint_generator.case import Case
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_nameless import (
    drive_and_motion,
    ratio_and_motion,
    relative,
)

from .nameless import followed, pulled, stretched

SERIES = series_checks.Series(19)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]


def for_seconds(name, design=None, *, lasts=12.0, strength=1.0):
    made = SERIES.short(name, design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def friction(name, run=0):
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    return case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law(case.rng(2, run))


def test_there_are_fourteen_sourced_forms_of_names_of_their_own():
    assert len(NAMES) == 14
    assert all(SERIES.kinds[name] == "unknown" for name in NAMES)
    assert not {*SERIES.misplaced(), *SERIES.unsourced()} & set(NAMES)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in NAMES}


@pytest.mark.parametrize("name", JOINTS)
@pytest.mark.parametrize(("strength", "floors"), [(1.0, 10.0), (0.5, 5.0)])
def test_a_record_is_finite_and_moved_by_many_noise_floors(name, strength, floors):
    for design in SERIES.forms[name].designs:
        made = for_seconds(name, design, lasts=7.0, strength=strength)
        series_checks.assert_finite(made.record(0))
        assert series_checks.columns_moved(made) > floors


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_moved_and_repeatable(name):
    for strength, floors in ((1.0, 20.0), (0.5, 10.0)):
        series_checks.assert_finite(SERIES.shown(name, strength=strength))
        assert series_checks.undriven_moved(SERIES, name, strength=strength) > floors
    series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    assert series_checks.undriven_moved(SERIES, name, strength=0.0) == 0.0


@pytest.mark.parametrize("name", JOINTS)
def test_the_same_seed_gives_the_same_record_and_no_strength_no_effect(name):
    made = for_seconds(name, lasts=1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    none = for_seconds(name, lasts=1.5, strength=0.0)
    series_checks.assert_same(none.record(0), replace(none, effects=()).record(0))


def test_rubber_obeys_maxwells_equation_and_takes_energy():
    more, _, v, t = drive_and_motion(made := for_seconds("unknown.rubber_mount_relaxes", "slide", lasts=5.0))
    stiff, time = made.effects[0].parameters.values()
    asked = solve_ivp(lambda s, y: stiff * np.interp(s, t, v) - y / time, (0.0, t[-1]), [0.0], t_eval=t, max_step=5e-3).y[0]
    assert relative(more - asked, asked) < 0.02
    assert np.sum(more * v) > 0.0


def test_strands_lose_in_a_full_loop_what_masing_says():
    """Each strand of limit f that slides from d on loses 4 f (a - d) in a cycle of amplitude a, and none if a < d."""
    most, a, x = np.array([0.1, 0.4, 2.0]), 0.7, 0.7 * np.sin(np.linspace(0.0, 4.0 * np.pi, 40001))
    force = stretched(x, most) / most
    lost = np.sum(force[20000:-1] * np.diff(x[20000:])[:, None], axis=0)
    np.testing.assert_allclose(lost, 4.0 * np.maximum(a - most, 0.0), atol=2e-3)


def test_a_hose_is_never_stretched_beyond_its_hold_and_takes_energy():
    np.testing.assert_allclose(pulled(np.array([0.0, 1.0, 1.5, 0.5, -1.0]), np.array([1.2, 2.0])), [0.0, 1.0, 0.0, -1.0, 0.0])
    more, _, v, _ = drive_and_motion(made := for_seconds("unknown.hose_catches_and_springs_free", "slide"))
    size = made.effects[0].parameters["size"]
    assert np.abs(more).max() < 1.5 * size * 1.01
    assert np.sum(more * v) > 0.0
    assert np.sum(np.abs(np.diff(more)) > 0.4 * size) > 10


def test_a_crank_does_the_work_that_its_slide_has_as_kinetic_energy():
    more, q, v, t = drive_and_motion(made := for_seconds("unknown.crank_pulls_a_slide_along", "hinge"))
    p = made.effects[0].parameters
    energy = 0.5 * p["heavy"] * (np.sin(q + p["start"]) * v) ** 2
    work = np.concatenate([[0.0], np.cumsum(0.5 * (more[1:] * v[1:] + more[:-1] * v[:-1]) * np.diff(t))])
    assert np.std((work - energy)[300:-300]) < 0.05 * np.std(energy)


def test_gains_of_a_cylinder_a_motor_and_a_spool_go_by_the_force():
    ratio, plain, _, _ = ratio_and_motion(made := for_seconds("unknown.rod_side_has_less_area", "slide"))
    p = made.effects[0].parameters
    np.testing.assert_allclose(ratio, np.where(p["side"] * plain > 0.0, 1.0, 1.0 + p["more"]))
    ratio, plain, _, _ = ratio_and_motion(made := for_seconds("unknown.iron_of_the_motor_saturates", "hinge"))
    assert 1.1 < ratio.max() < 3.0
    assert np.all(np.diff((plain * ratio)[np.argsort(plain)]) > -1e-12)  # more current always gives more torque
    more, *_ = drive_and_motion(made := for_seconds("unknown.spool_overlaps_its_ports", "slide"))
    assert np.mean(np.abs(np.abs(more) / made.effects[0].parameters["zone"] - 1.0) < 0.01) > 0.6


def test_a_head_on_a_bracket_swings_as_its_own_equation_says():
    effect, t = SERIES.short("unknown.bracket_of_the_sensor_swings", design="slide").effects[0], np.arange(5000) * 1e-3
    w, a = effect.parameters["often"], 0.3 * effect.parameters["often"]
    shown = effect.measure({"time [s]": t, "position [m]": 0.1 * np.sin(a * t)}, np.random.default_rng(0))["position [m]"]
    gain = a**2 / (w**2 - a**2 + 0.12j * w * a)
    steady = 0.1 * np.imag((1.0 + gain) * np.exp(1j * a * t))
    assert np.abs(shown - steady)[-1000:-50].max() < 0.1 * np.abs(gain) * 0.1


def test_an_absorber_drags_on_the_way_in_alone():
    more, x, v, _ = drive_and_motion(made := for_seconds("unknown.absorber_at_the_end_of_the_way", "slide"))
    p, b = made.effects[0].parameters, made.nominal
    x, v, more = p["side"] * x, p["side"] * v, p["side"] * more
    assert np.abs(more[(x < p["at"] - 0.01 * b.reach) | (v < -0.02 * b.speed)]).max() < 0.01 * p["size"]
    inside = (x > p["at"] + 0.17 * b.reach) & (v > 0.2 * b.speed)
    np.testing.assert_allclose(more[inside], p["size"] * (v[inside] / b.speed) ** 2, rtol=0.1)


def test_a_load_that_is_stepped_acts_in_part_at_once_and_a_pump_lifts_it():
    x = np.linspace(0.0, 3e-5, 3001)
    assert followed(x, np.where(x > 1e-5, 1.0, 0.0), 1e-5)[2000] == pytest.approx(1.0 - np.exp(-1.0), abs=2e-3)
    t = np.arange(2400) / slider.RATE
    added = friction("unknown.ram_leaks_and_is_pumped_up").added(t, 1e-5 * t)
    assert added.max() <= 0.0
    assert 8 <= np.sum(np.diff(added) > 3e-3) <= 24


def test_a_block_keeps_its_momentum_when_it_takes_another_along():
    """Way to rest by hand: v^2 falls by 2 mu g x, and by the square of the ratio of masses at each block."""
    law = friction("unknown.strikes_blocks_at_rest")
    places = np.cumsum(Case("unknown.strikes_blocks_at_rest", "thrown", 1.0, 7).rng(2, 0).uniform(0.04, 0.11, 2))
    square, x = np.random.default_rng(3).uniform(*law.starts) ** 2, 0.0
    for place, ratio in zip(places, (1.0 / 1.12, 1.12 / 1.24), strict=True):
        square, x = (square - 2.0 * 0.24 * GRAVITY * (place - x)) * ratio**2, place
    end = x + (square - 0.05**2) / (2.0 * 0.24 * GRAVITY)
    shown = thrown.record(replace(law, noise=0.0), np.random.default_rng(3))["position [m]"]
    assert shown[-1] == pytest.approx(end, abs=1.5e-3)
