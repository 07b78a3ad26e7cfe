"""What no effect describes, in the eighteenth set: finite records that each form moves, and the physics of some of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import gamma

from tests.discovery.joint_generator import series_checks, thrown
from tests.discovery.joint_generator.bench import GRAVITY, nominal_bench
from tests.discovery.joint_generator.case import Case
from tests.discovery.joint_generator.plant import FORCE_OF_TIME
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_nameless import relative, sources

from .nameless import bouc_wen, carried, half_derivative, stopped

SERIES = series_checks.Series(18)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]
INNER = slice(300, -300)


def for_seconds(name, design=None, *, lasts=12.0, strength=1.0):
    made = SERIES.short(name, design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def drive_and_motion(name, design=None):
    """A case; what its drives show beyond the plain ones [N or N m], by coordinate; states, which have no noise."""
    made = for_seconds(name, design)
    shown, plain = made.record(0), replace(made, effects=()).record(0)
    names = [c for c in plain if any(word in c for word in ("force", "torque", "voltage"))]
    return made, [(shown[c] - plain[c]) * made.nominal.gain for c in names], made.states(0)[0]


def friction(name, run=0):
    """What a slider or a thrown block has in a run, at full strength."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    return case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0))).law(case.rng(2, run))


def test_there_are_fourteen_sourced_forms_of_names_of_their_own():
    assert len(NAMES) == 14
    assert all(SERIES.kinds[name] == "unknown" for name in NAMES)
    assert not {*SERIES.misplaced(), *SERIES.unsourced()} & set(NAMES)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in NAMES}
    own = [source for name in NAMES for source in sources(SERIES.forms[name])]
    assert len(own) == len(NAMES) == len(set(own))


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


@pytest.mark.parametrize("name", JOINTS)
def test_the_same_seed_gives_the_same_record_and_no_strength_no_effect(name):
    made = for_seconds(name, lasts=1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    none = for_seconds(name, lasts=1.5, strength=0.0)
    for column, x in replace(none, effects=()).record(0).items():
        np.testing.assert_allclose(none.record(0)[column], x, rtol=1e-12, atol=1e-12)


def test_a_stop_goes_along_and_is_held_at_half_its_width():
    np.testing.assert_allclose(stopped(np.array([3.0, 3.5, 9.0, 8.5, 6.0, 7.0]), 1.0), [0.0, 0.5, 1.0, 0.5, -1.0, 0.0])


def test_half_a_derivative_is_the_known_one_of_a_ramp_and_twice_it_is_the_whole():
    t = np.arange(4001) * 1e-3
    np.testing.assert_allclose(half_derivative(5.0 + t, 1e-3)[500:], t[500:] ** 0.5 / gamma(1.5), rtol=2e-3)
    twice = half_derivative(half_derivative(t**2, 1e-3), 1e-3)
    np.testing.assert_allclose(twice[500:], 2.0 * t[500:], rtol=3e-3)


def test_a_wire_rope_has_the_loop_of_an_exponential_and_takes_energy():
    """From 0, gripping alone, z = 1 - exp(-x/length); in a closed loop the work is positive."""
    x = np.linspace(0.0, 2.0, 20001)
    np.testing.assert_allclose(bouc_wen(x, 0.5, 0.8), 1.0 - np.exp(-x / 0.5), atol=1e-3)
    loop = np.sin(np.linspace(0.0, 20.0 * np.pi, 40001))
    z = bouc_wen(loop, 0.6, 0.7)
    assert np.abs(z).max() < 1.0
    assert np.trapezoid(z[-4001:], loop[-4001:]) > 0.1


def test_a_crate_goes_along_slides_and_catches_up():
    """Of 3 m/s^2 for a second the crate has 1; then the carriage is even, and it is as fast 2 s later."""
    a = np.concatenate([np.full(1000, 0.5), np.full(1000, 3.0), np.zeros(3000)])
    gains = carried(a, 1e-3, 1.0)
    np.testing.assert_allclose(gains[[500, 1500, 3500, 4500]], [0.5, 1.0, 1.0, 0.0], atol=1e-9)
    assert gains.sum() == pytest.approx(a.sum())
    made, (more,), states = drive_and_motion("unknown.crate_slides_on_the_carriage", "slide")
    a = np.gradient(states[:, 2]) * made.nominal.rate
    p = made.effects[0].parameters
    gains = carried(a, 1.0 / made.nominal.rate, p["most"])
    assert relative((more - p["crate"] * (gains - a))[INNER], more[INNER]) < 0.2
    assert np.mean(np.abs(gains - a) > 0.1 * p["most"]) > 0.2


def test_a_disc_behind_a_wave_generator_takes_its_kinetic_energy():
    made, (more,), states = drive_and_motion("unknown.wave_generator_errs", "hinge")
    p, (q, v) = made.effects[0].parameters, states[:, [0, 2]].T
    ahead = q + p["error"] * p["pitch"] / (2.0 * np.pi) * np.sin(2.0 * np.pi * q / p["pitch"] + p["start"])
    energy = 0.5 * p["disc"] * ((np.gradient(ahead) * made.nominal.rate) ** 2 - v**2)
    work = np.cumsum(more * v) / made.nominal.rate
    off = (work - energy)[INNER]
    assert np.std(off) < 0.2 * np.std(energy[INNER])


def test_an_unbalanced_wheel_turns_slower_evenly_until_it_stands():
    made = for_seconds("unknown.grinding_wheel_coasts_down")
    p, plant = made.effects[0].parameters, made.plant(0)
    force, t = plant.by_time[FORCE_OF_TIME], plant.times
    assert not np.any(force[t > p["stands"]])
    for at in (1.0, 4.0):
        near = force[np.abs(t - at) < 1.0]
        turns = 0.5 * np.sum(np.diff(np.sign(near)) != 0.0)
        assert turns == pytest.approx(2.0 * p["first"] * (1.0 - at / p["stands"]), abs=1.0)


def test_a_differential_takes_energy_of_both_joints_together():
    made, more, states = drive_and_motion("unknown.differential_rubs_in_its_cage")
    power, ratio = more[0] * states[:, 2] + more[1] * states[:, 3], made.effects[0].parameters["ratio"]
    assert power[np.abs(states[:, 2] - ratio * states[:, 3]) > 0.1 * made.nominal.speed].min() > 0.0


def test_a_cord_stops_a_block_where_its_energy_is_spent():
    """v^2/2 = g (mu s + pull (s - slack)^2/2), of the slack that the force shows."""
    law = replace(friction("unknown.cord_comes_taut", 3), starts=(1.3, 1.3), noise=0.0)
    pull = law.mu(1.0, 1.0) - law.mu(1.0, 0.9)
    slack = 1.0 - (law.mu(1.0, 1.0) - law.mu(1.0, 0.0)) / (10.0 * pull)
    far = thrown.record(law, np.random.default_rng(0))["position [m]"][-1]
    spent = GRAVITY * (law.mu(1.0, 0.0) * far + 5.0 * pull * max(far - slack, 0.0) ** 2)
    assert spent == pytest.approx(0.5 * 1.3**2, rel=0.02)
