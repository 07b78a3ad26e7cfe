"""The rigs and forms of the fourth set are sane physics and keep what the pages on discovery and datasets ask of a record."""

import argparse

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.discovery.unseen_forms.__main__ import _chosen
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import REVERSED, Case, cases, make_runs, rig_of, write_record
from tests.discovery.unseen_forms.rigs import Rig

from .friction import load_and_adhesion, load_breaks_the_film, presliding_ramberg_osgood, shot_noise
from .mechanism import load_of_a_pump
from .nameless import base_moves, contact_heats_itself
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 4}
NULLS = [name for name, form in SET.items() if NONE in form.truth]


def world_of(rig: Rig, cycles: float, *, speed: float = 1.0, seed: int = 0) -> World:
    return World(
        rig, rig, speed * rig.belt_velocity, rig.normal_force, cycles * rig.period / speed, np.random.default_rng(seed)
    )


def run_of(name: str, *, design: int = 0, strength: float = 1.0, share: float = 0.15) -> list:
    return make_runs(Case(SET[name], SET[name].designs[design], 1.0), 3, strength=strength, share=share)


def test_the_set_is_as_wide_as_asked_for():
    families = {name: next((word for word in (NONE, UNKNOWN) if word in form.truth), "named") for name, form in SET.items()}
    named = [form for name, form in SET.items() if families[name] == "named"]
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert len(named) >= 25
    assert sum(family == UNKNOWN for family in families.values()) >= 15
    assert len(NULLS) >= 20
    halves = {(case.form.name, case.design) for case in cases() if case.form.series == 4 and case.strength == 0.5}
    assert halves == {(name, design) for name, form in SET.items() if families[name] != NONE for design in form.designs}


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    rig = rig_of(SET[name])
    assert SET[name].rig in RIGS_OF_THE_SET
    assert rig.rate * 2 * np.pi / rig.pulsation * (1.0 - 0.02) > 40.0  # samples a period, of the stiffest true rig as well
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    length = float(SET[name].options.get("length", 1.0))
    assert 36.0 * length - 5.0 > 12.0  # cycles of the shorter run, less those at its ends


@pytest.mark.parametrize("speed", [0.4, 1.0, 2.0])
@pytest.mark.parametrize("name", RIGS_OF_THE_SET)
def test_the_limit_cycle_is_that_of_damped_free_vibration(name, speed):
    rig = RIGS_OF_THE_SET[name]
    v, k, decay = speed * rig.belt_velocity, rig.stiffness, 0.5 * rig.damping / rig.mass
    fast = np.sqrt(rig.pulsation**2 - decay**2)
    top = (rig.mu_s * rig.normal_force - rig.damping * v) / k
    start = top - rig.mu_k * rig.normal_force / k  # from where the box would rest

    def speed_after(t: float) -> float:
        return np.exp(-decay * t) * (v * np.cos(fast * t) - (decay * v + rig.pulsation**2 * start) / fast * np.sin(fast * t))

    slip_time = brentq(lambda t: speed_after(t) - v, np.pi / fast, 1.5 * np.pi / fast, xtol=1e-15)
    at = np.exp(-decay * slip_time) * (start * np.cos(fast * slip_time) + (v + decay * start) / fast * np.sin(fast * slip_time))
    bottom = at + rig.mu_k * rig.normal_force / k
    motion = simulate(world_of(rig, 6.0, speed=speed), np.linspace(0.0, 6.0 * rig.period / speed, 6001))
    # fourth order with 400 steps a natural period: (2 pi/400)^4 and less of a slip
    np.testing.assert_allclose(motion.breaks[2:, 1], top, rtol=1e-10)
    np.testing.assert_allclose(motion.sticks[2:, 1], bottom, atol=1e-7 * rig.slip_length)
    np.testing.assert_allclose(np.diff(motion.breaks[2:, 0]), slip_time + (top - bottom) / v, rtol=1e-7)


@pytest.mark.parametrize("name", RIGS_OF_THE_SET)
def test_energy_is_balanced_over_a_slip(name):
    rig = RIGS_OF_THE_SET[name]
    motion = simulate(world_of(rig, 4.0), np.linspace(0.0, 4.0 * rig.period, 400001))
    i, j = np.searchsorted(motion.time, [motion.breaks[1, 0], motion.sticks[2, 0]])
    x, v, t = motion.position[i : j - 1], motion.velocity[i : j - 1], motion.time[i : j - 1]
    energy = 0.5 * rig.mass * v**2 + 0.5 * rig.stiffness * x**2
    work = rig.mu_k * rig.normal_force * (x[-1] - x[0]) - np.trapezoid(rig.damping * v**2, t)
    assert energy[-1] - energy[0] == pytest.approx(
        work, rel=1e-5
    )  # (pulsation times 1e-5 of 4 cycles)^2, a slip is a part of it
    assert motion.friction_work < 0.0


@pytest.mark.parametrize("name", RIGS_OF_THE_SET)
def test_a_slow_belt_and_no_damping_make_slips_of_twice_the_gap(name):
    rig = RIGS_OF_THE_SET[name]
    world = world_of(rig, 3.0, speed=0.02)
    world.damping = lambda s: 0.0
    motion = simulate(world, np.linspace(0.0, world.duration, 1001))
    slips = motion.breaks[1:, 1] - motion.sticks[-len(motion.breaks[1:]) :, 1]
    # energy about the point of rest: amplitude^2 = gap^2 + (v/pulsation)^2, which is (0.02 v_b/pulsation)^2 more
    assert len(slips) >= 1
    np.testing.assert_allclose(
        slips, rig.slip_length, rtol=(0.04 * rig.belt_velocity / rig.pulsation / rig.slip_length) ** 2 + 1e-7
    )


def test_asymmetry_leaves_the_stated_direction_alone():
    one, none = run_of("fourth_asymmetry_of_stribeck_curves"), run_of("fourth_asymmetry_of_stribeck_curves", strength=0.0)
    moved = [np.ptp(a.reading - b.reading) / a.world.nominal.noise for a, b in zip(one, none, strict=True)]
    assert moved[0] == 0.0
    assert min(moved[i] for i in REVERSED[1:]) > 10.0


@pytest.mark.parametrize("effect", [load_and_adhesion, load_breaks_the_film])
def test_load_dependence_is_none_at_the_stated_load(effect):
    rig = RIGS_OF_THE_SET["axis"]
    shares = []
    for load in (0.5, 1.0, 2.0):
        world = world_of(rig, 1.0)
        world.normal_force *= load
        effect(world, 1.0)
        shares.append([world.mu_s(None) / rig.mu_s, world.mu_k(None) / rig.mu_k])
    np.testing.assert_allclose(shares[1], 1.0, rtol=1e-12)
    assert np.all(np.diff(shares, axis=0) > 0.03) or np.all(np.diff(shares, axis=0) < -0.03)


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of(RIGS_OF_THE_SET["tribometer"], 1.0)
    presliding_ramberg_osgood(world, 1.0)
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 1.0) == pytest.approx(share, abs=1e-6)  # a table of 5e-4


def test_ripples_and_shots_have_no_mean():
    world = world_of(RIGS_OF_THE_SET["axis"], 38.0)
    load_of_a_pump(world, 1.0)
    state = argparse.Namespace(t=np.linspace(0.0, world.duration, 200001)[:-1])
    assert np.mean(world.normal(state)) == pytest.approx(world.normal_force, rel=1e-5)
    t = np.arange(0.0, 40000.0, 0.05)
    z = shot_noise(np.random.default_rng(1), 40000.0, 0.5, 4.0)(t)
    independent = 40000.0 / 8.0  # spans of twice the decay time
    assert abs(z.mean()) < 4.0 / np.sqrt(independent)
    assert z.var() == pytest.approx(1.0, abs=4.0 * np.sqrt(3.0 / independent))  # variance of squares: 2 and the shots' own
    assert np.mean(z[:-80] * z[80:]) == pytest.approx(np.exp(-1.0), abs=4.0 * np.sqrt(3.0 / independent))


def test_the_yielding_base_is_as_stiff_as_believed():
    rig = RIGS_OF_THE_SET["turntable"]
    world = world_of(rig, 3.0, speed=0.05)
    base_moves(world, 1.0)
    motion = simulate(world, np.linspace(0.0, world.duration, 1001))
    np.testing.assert_allclose(motion.breaks[:, 1], rig.reach, rtol=1e-3)  # damping at 0.05 of the belt's speed: 1e-4


def test_the_contact_warms_to_what_its_speed_says():
    rig = RIGS_OF_THE_SET["turntable"]
    world = world_of(rig, 40.0)
    contact_heats_itself(world, 1.0)
    motion = simulate(world, np.linspace(0.0, world.duration, 4001))
    # what slides in a cycle is what the belt runs, so warmth tends to 1, +-a tenth within a cycle of a fifth of its time
    assert motion.breaks[0, 1] == pytest.approx(rig.reach, rel=5e-3)
    assert motion.breaks[-1, 1] == pytest.approx(0.92 * rig.reach, rel=0.01)


@pytest.mark.parametrize("name", [name for name in NULLS if not SET[name].options.get("declared")])
def test_a_null_moves_as_the_stated_law_says_and_its_sensor_is_right_within_its_noise(name):
    form = SET[name]
    run = run_of(name, share=0.05 / float(form.options.get("length", 1.0)))[0]
    rig = run.world.rig
    plain = World(rig, run.world.nominal, run.world.belt_velocity, run.world.normal_force, run.world.duration, run.world.rng)
    np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    assert np.std(run.reading - run.motion.position) < run.world.nominal.noise
    sampling = float(form.options.get("jitter", 0.0)) / run.world.nominal.rate
    assert run.world.nominal.peak_speed * sampling <= 1.05 * run.world.nominal.noise


@pytest.mark.parametrize("name", NULLS)
def test_a_null_is_off_by_no_more_than_is_stated(name):
    form, rig = SET[name], rig_of(SET[name])
    stated = form.options.get("uncertainty") or {"mass": 0.003, "stiffness": 0.01, "damping": 0.2, "normal_force": 0.01}
    true = run_of(name, share=0.03)[0].world.rig
    for key, sd in stated.items():
        assert abs(getattr(true, key) / getattr(rig, key) - 1.0) <= 2.0 * sd + 1e-12


@pytest.mark.parametrize(("name", "slips"), [("fourth_begins_in_a_slip", True), ("fourth_begins_in_a_stick", False)])
def test_records_begin_where_they_say(name, slips, tmp_path):
    write_record(Case(SET[name], "one", 1.0), tmp_path, 3, share=0.15)
    t, x = np.loadtxt(tmp_path / "data" / "run_1.csv", delimiter=",", skiprows=1, unpack=True)
    rig = rig_of(SET[name])
    x = x / {"m": 1.0, "mm": 1e3, "um": 1e6}[rig.unit]
    rate = np.polyfit(t[:10], x[:10], 1)[0]
    error = rig.noise * rig.rate / np.sqrt(10 * 99 / 12)  # of a straight line through ten samples
    if slips:
        assert rate < -0.3 * rig.peak_speed
    else:
        assert rate == pytest.approx(rig.belt_velocity, abs=5.0 * error)
    assert t[0] > float(SET[name].options["begins"])


def test_lost_blocks_leave_no_box_at_rest_at_the_end(tmp_path):
    form = SET["fourth_blocks_are_lost"]
    write_record(Case(form, "one", 1.0), tmp_path, 3, share=0.3)
    t, x = np.loadtxt(tmp_path / "data" / "run_1.csv", delimiter=",", skiprows=1, unpack=True)
    rig = rig_of(form)
    end = x[t > t[-1] - 0.4 * rig.period] / {"m": 1.0, "mm": 1e3, "um": 1e6}[rig.unit]
    assert np.ptp(end) > 0.2 * rig.slip_length


def test_the_plan_of_nulls_has_each_in_each_design():
    given = argparse.Namespace(series=4, plan="nulls", strength=[], only=[])
    chosen = _chosen(given)
    assert {(case.form.name, case.design) for case in chosen} == {(name, d) for name in NULLS for d in SET[name].designs}
    first, second = (make_runs(chosen[0], seed, share=0.03)[0] for seed in (0, 1))
    assert first.world.rig != second.world.rig
