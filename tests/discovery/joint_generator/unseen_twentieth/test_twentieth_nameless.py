"""What no effect describes, in the twentieth set: finite records that each form moves, and the physics of some of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.joint_generator import series_checks, slider, thrown
from tests.discovery.joint_generator.bench import GRAVITY, nominal_bench
from tests.discovery.joint_generator.case import Case
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_nameless import drive_and_motion, relative

from .nameless import command_of, lagging, steps_of

SERIES = series_checks.Series(20)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]


def for_seconds(name, design=None, *, lasts=12.0, strength=1.0):
    made = SERIES.short(name, design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def friction(name):
    """What a slider or a thrown block has, at full strength, and the numbers that were drawn."""
    case = Case(name, SERIES.forms[name].designs[0], 1.0, 7)
    effect = case.parts[0].draw(case.rng(1, 0), 1.0, nominal_bench("slide", case.rng(0)))
    return effect.law(case.rng(2, 0)), effect.parameters


def test_there_are_fourteen_sourced_forms_of_names_of_their_own():
    assert len(NAMES) == 14
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


def test_solenoids_give_the_force_that_their_command_is_for():
    force, bent, most = np.linspace(-3.0, 3.0, 61), 0.6, 2.0
    y = command_of(force, bent, most) * force / most
    np.testing.assert_allclose(most * ((1.0 - bent) * y + bent * y * np.abs(y)), force, atol=1e-12)


def test_an_elbow_is_off_by_the_shoulder_and_a_spring_over_both_does_the_work_that_it_stores():
    effect = SERIES.short("unknown.elbow_is_driven_from_the_base").effects[0]
    made = for_seconds("unknown.spring_over_both_joints", lasts=6.0)
    record, plain, p = made.record(0), replace(made, effects=()).record(0), made.effects[0].parameters
    a, b = (record[name] for name in positions(record))
    shown = [effect.measure(record, np.random.default_rng(0))[name] for name in positions(record)]
    np.testing.assert_allclose(shown, [a, b + effect.parameters["side"] * effect.parameters["share"] * a])
    pulls = [record[name] - plain[name] for name in drives(record)]
    work = sum(np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(q)) for f, q in zip(pulls, (a, b), strict=True))
    ends = 0.5 * p["size"] / made.nominal.reach * (a + b - p["rest"])[[0, -1]] ** 2
    assert work == pytest.approx(ends[1] - ends[0], rel=1e-6)


def test_a_cart_does_its_work_on_the_laden_way_alone():
    more, _, v, t = drive_and_motion(made := for_seconds("unknown.cart_goes_full_and_comes_back_empty", "slide"))
    p, quick = made.effects[0].parameters, 0.1 * made.nominal.speed
    a, v, more = np.gradient(p["side"] * v, t), p["side"] * v, p["side"] * more
    assert np.abs(more[v < -quick]).max() < 1e-3 * np.abs(more).max()
    assert relative((more - p["load"] * a)[v > quick], more[v > quick]) < 0.15


def test_a_motor_gives_its_current_times_the_field():
    made = for_seconds("unknown.field_is_weakened_beyond_a_speed", "slide", lasts=5.0)
    states, _ = made.states(0)
    base, v = made.effects[0].parameters["base"], np.abs(states[:, 2])
    asked = states[:, 4] * made.nominal.gain * np.minimum(1.0, base / np.maximum(v, 1e-9))
    assert relative((states[:, 7] - asked)[1:], asked[1:]) < 0.1  # given is of the step before
    assert v.max() > 2.0 * base


def test_lags_obey_their_equation_and_a_cell_forgets():
    t = np.arange(4000) * 1e-3
    x = np.sin(3.0 * t) + (t > 1.0)
    exact = solve_ivp(lambda s, y: (np.interp(s, t, x) - y) / 0.7, (0.0, t[-1]), [0.0], t_eval=t, max_step=2e-3).y[0]
    np.testing.assert_allclose(lagging(x, 1e-3, 0.7), exact, atol=3e-3)
    effect = SERIES.short("unknown.piezo_cell_discharges", design="slide").effects[0]
    made = SERIES.short("unknown.piezo_cell_discharges", design="slide").record(0)
    shown = effect.measure({"time [s]": t, drives(made)[0]: np.ones_like(t)}, np.random.default_rng(0))[drives(made)[0]]
    np.testing.assert_allclose(shown, np.exp(-t / effect.parameters["time"]), rtol=1e-9)


def test_gusts_have_their_size_and_memory_and_what_rubs_takes_energy():
    effect = (made := SERIES.short("unknown.draught_buffets_the_link", design="hinge")).effects[0]
    t, name = np.arange(400000) * 1e-2, drives(made.record(0))[0]
    gusts = effect.measure({"time [s]": t, name: 0.0 * t}, np.random.default_rng(1))[name] * made.nominal.gain
    assert gusts.std() == pytest.approx(effect.parameters["size"], rel=0.06)
    assert np.corrcoef(gusts[:-30], gusts[30:])[0, 1] == pytest.approx(np.exp(-0.3 / effect.parameters["time"]), abs=0.04)
    more, *_ = drive_and_motion(made := for_seconds("unknown.pad_fades_and_recovers", "slide"))
    assert 0.3 < np.abs(more).max() / made.nominal.level < 0.65
    for name in ("wheel_sparks_out", "metering_pin_of_a_recoil_brake"):
        more, _, v, _ = drive_and_motion(for_seconds(f"unknown.{name}", "slide"))
        assert np.sum(more * v) > 0.9 * np.sum(np.abs(more * v)) > 0.0


def test_a_ram_rings_about_the_level_and_slips_keep_their_pitch():
    t = np.arange(1200) / slider.RATE
    x = np.cumsum(np.where(t < 12.0, 1e-6, 1e-5)) / slider.RATE
    rows, jumps = steps_of(t, x)
    assert jumps.tolist() == pytest.approx([1.0])
    law, p = friction("unknown.servo_of_the_ram_overshoots")
    ringing = law.added(t, x)[rows[0] :]
    assert np.sum(np.diff(np.sign(ringing[1:])) != 0) == pytest.approx(2.0 * p["often"] * ringing.size / slider.RATE, abs=2)
    law, p = friction("unknown.small_slips_of_a_gouge")
    drops = -np.diff(law.added(t, x))
    big = drops > 0.3 * p["size"]
    assert big.sum() == pytest.approx((x[-1] - x[0]) / p["apart"], abs=1.1)
    assert drops[big & (t[1:] < 12.0)].mean() > 1.4 * drops[big & (t[1:] > 12.0)].mean()


def test_magnets_take_the_energy_that_their_drag_does_on_the_way():
    law, _ = friction("unknown.magnets_under_a_stretch_of_the_rail")
    start = np.random.default_rng(3).uniform(*law.starts)
    way = solve_ivp(lambda t, y: [y[1], -GRAVITY * law.mu(y[1], y[0])], (0.0, 2.0), [0.0, start], rtol=1e-9, max_step=1e-3)
    end = np.interp(-0.05, -way.y[1], way.y[0])
    shown = thrown.record(replace(law, noise=0.0), np.random.default_rng(3))["position [m]"]
    assert shown[-1] == pytest.approx(end, abs=1e-3)
    assert end < 0.8 * start**2 / (2.0 * 0.25 * GRAVITY)
