"""The unknown forms and the nulls of the sixteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.fifteenth.rigs import RIGS_OF_THE_SET
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.fourteenth.test_nameless import at, instants, slips_of
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, noise, rig_of

from . import nameless, nulls

SET = {name: form for name, form in FORMS.items() if form.series == 15 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = "sixteenth_scatter_declared_in_coloured_noise"
OF_THE_SENSOR = [name for name in UNKNOWNS if not re.search("weights|tank|wave", name)]


def world_of(form, *, cycles: float = 1.0, load: float = 1.0, strength: float = 1.0) -> World:
    true = RIGS_OF_THE_SET[SET[form.__name__].rig]
    world = World(true, true, true.belt_velocity, load * true.normal_force, cycles * true.period, np.random.default_rng(0))
    form(world, strength)
    return world


def shown_by(form, *, cycles: float = 8.0):
    """Return the world, its times, its motion, and what the sensor shows of it."""
    world = world_of(form, cycles=cycles)
    t = instants(world)
    motion = simulate(world, t)
    return world, t, motion, world.sensor(t, motion, np.random.default_rng(1))


def shown_of(form, position, *, cycles: float = 60.0, velocity=0.0):
    """Return the world, its times, and what the sensor shows of a box that is where `position` says, over the noise."""
    world = world_of(form, cycles=cycles)
    t = instants(world)
    x = position(world, t)
    motion = at(position=x, velocity=velocity + 0.0 * t, sticks=np.zeros((0, 2)))
    return world, t, (world.sensor(t, motion, np.random.default_rng(1)) - x) / world.nominal.noise


def test_the_set_is_as_wide_as_asked_for_and_no_earlier_form_has_a_name_or_a_source_of_it():
    assert (len(UNKNOWNS), len(NULLS)) == (12, 12)
    assert all({form.rig for form in map(SET.get, names)} == set(RIGS_OF_THE_SET) for names in (UNKNOWNS, NULLS))
    for name, form in SET.items():
        assert form.right("one") == form.right("several") == form.truth
        assert form.apply.__doc__
        assert re.search(r"\b(1[6789]|20)\d\d\b", form.source), name
        assert form.source not in {other.source for other in FORMS.values() if other is not form and other.truth & form.truth}
    own = {name.removeprefix("sixteenth_") for name in SET}
    assert not own & (set(KINDS) | {re.sub(r"^[a-z]+th_", "", name) for name, form in FORMS.items() if form.series < 15})


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_stick_and_slip_and_are_the_same_for_the_same_seed(name):
    series_checks.assert_preconditions(SET[name])
    series_checks.assert_stick_slip(SET[name], 151, share=0.21, sticks=2)  # five cycles
    series_checks.assert_repeatable(SET[name], SET[name].designs[0])


@pytest.mark.parametrize("name", UNKNOWNS)
def test_a_form_moves_what_is_shown_by_tens_of_floors_by_less_at_half_and_by_nothing_at_none(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and 10.0 < half[key] < 0.9 * sizes[key] for key in sizes)
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)


@pytest.mark.parametrize("name", OF_THE_SENSOR)
def test_a_form_of_the_sensor_leaves_the_motion_alone(name):
    run, twin = (make_runs(Case(SET[name], "one", 1.0), 3, strength=strength, share=0.06)[0] for strength in (1.0, 0.0))
    np.testing.assert_array_equal(run.motion.position, twin.motion.position)
    assert np.std(run.reading - twin.reading) > 3.0 * rig_of(SET[name]).noise


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_the_stated_law_says_and_shows_no_more_than_the_stated_noise(name):
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 3, share=0.1)[0]
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    if name != DECLARED:
        np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    error = run.reading - run.motion.position
    assert np.std(error) < 1.2 * rig.noise
    assert abs(np.mean(error)) < 0.5 * rig.noise
    for key, sd in series_checks.stated(form).items():
        off, limits = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd, float(form.options.get("at_limits", 0.0))
        assert off == pytest.approx(2.0 * limits) if limits else off <= 1.5 + 1e-12
    written = noise(str(form.options.get("noise", "white")), rig.noise, run.reading.size, np.random.default_rng(0))
    assert 0.9 * rig.noise < np.std(error + written) < 1.6 * rig.noise


def test_noises_are_as_loud_and_shaped_as_said():
    kinds = (nulls.noise_of_long_memory, nulls.noise_of_two_tails, nulls.noise_is_louder_from_a_time_on, nulls.telephone_buzzes)
    long, tails, louder, buzz = (shown_of(form, lambda world, t: 1e-3 + 0.0 * t, cycles=150.0)[2] for form in kinds)
    lags = [np.mean(long[k:] * long[:-k]) / 0.49 for k in (1, 2)]
    assert lags == pytest.approx([0.3 / 0.7, 0.3 / 0.7 * 1.3 / 1.7], abs=0.03)  # Hosking 1981, eq. 2.6
    assert (np.std(tails), np.mean(np.abs(tails)), np.mean(tails**4)) == pytest.approx((1.0, np.sqrt(0.5), 6.0), rel=0.1)
    assert not np.any(louder[: louder.size // 3])
    assert np.std(louder[2 * louder.size // 3 + 1 :]) == pytest.approx(np.sqrt(1.25), rel=0.03)
    assert set(np.round(np.unique(buzz), 6)) == {0.0, 0.9}
    assert 0.005 < np.mean(buzz > 0.0) < 0.02


def test_steps_clocks_and_means_are_off_as_said():
    def ramp(world, t):
        return 1e-3 + world.belt_velocity * t

    up, down = (shown_of(nulls.steps_with_hysteresis, ramp, velocity=v)[2] for v in (1.0, -1.0))
    assert np.mean(down - up) == pytest.approx(0.2 * 3.4, rel=0.05)
    world, _, early = shown_of(nulls.clock_spreads_its_spectrum, lambda world, t: world.nominal.peak_speed * t)
    assert (early[9:-9].min(), early[9:-9].max()) == pytest.approx((-1.0, 1.0), abs=0.02)
    omega = world_of(nulls.converter_integrates).nominal.pulsation
    world, t, off = shown_of(nulls.converter_integrates, lambda world, t: 1e-3 * np.cos(omega * t))
    half = 0.5 * omega / world.nominal.rate
    mean = 1e-3 * np.cos(omega * t) * (np.sin(half) / half - 1.0) / world.nominal.noise
    np.testing.assert_allclose(off[1:-1], mean[1:-1], atol=1e-3)


def test_scatter_is_as_declared_and_a_tachometer_swings_alone():
    world = world_of(nulls.scatter_declared_in_coloured_noise)
    draws = np.array([(world.on_stick(None), world.mu_s(None), world.mu_k(None))[1:] for _ in range(4000)])
    assert SET[DECLARED].options["declared_sigma"] == pytest.approx(draws.std(0), rel=0.05)
    assert draws.mean(0) == pytest.approx([world.rig.mu_s, world.rig.mu_k], abs=3e-4)
    world = world_of(nulls.tachometer_is_out_of_true, cycles=34.0)
    shown = world.columns["belt_velocity [m/s]"](instants(world), None) / world.belt_velocity - 1.0
    assert (np.mean(shown), np.std(shown)) == pytest.approx((0.0, 0.02 * np.sqrt(1.5)), abs=1e-3)
    assert np.argmax(np.abs(np.fft.rfft(shown))) == 20  # turns


def test_weights_and_a_tank_make_slips_last_longer_over_the_same_way():
    rig = RIGS_OF_THE_SET["sash"]
    for load in (0.7, 1.3):
        slip, plain = (
            slips_of(simulate(world, instants(world)))[0]
            for world in (world_of(nameless.dead_weights_ride_along, cycles=5.0, load=load, strength=a) for a in (1, 0))
        )
        heavier = np.sqrt(1.0 + (load - 1.0) * rig.normal_force / 9.81 / rig.mass)
        assert slip[3] / plain[3] == pytest.approx(heavier, abs=0.02)
        assert slip[1:3] == pytest.approx(plain[1:3], rel=0.03)
    tank, empty = (
        slips_of(simulate(world, instants(world)))
        for world in (world_of(nameless.tank_fills_and_is_siphoned, cycles=16.0, strength=a) for a in (1.0, 0.0))
    )
    last = tank[:, 3] / empty[0, 3]
    assert 1.0 < last.min() < 1.12
    assert 1.2 < last.max() < np.sqrt(1.6)
    assert tank[:, 1:3] == pytest.approx(np.tile(empty[0, 1:3], (len(tank), 1)), rel=0.03)


def test_a_wave_carries_the_box_on_and_back_and_leaves_places_and_periods():
    world, usual = (world_of(nameless.wave_runs_round_the_belt, cycles=8.0, strength=a) for a in (1.0, 0.0))
    t = instants(world)
    moved, plain = simulate(world, t), simulate(usual, t)
    assert slips_of(moved) == pytest.approx(slips_of(plain), rel=1e-3)
    off = (moved.position - plain.position) / world.nominal.slip_length
    assert (off.min(), off.max()) == pytest.approx((0.0, 0.07), abs=2e-3)
    world.on_stick(at(t=0.3))
    u = np.linspace(0.3, 0.4, 20001)
    for rate, value in ((world.belt, world.travel), (world.belt_acceleration, world.belt)):
        scale = np.abs(rate(u)).max()
        assert np.gradient(value(u), u)[2:-2] == pytest.approx(rate(u)[2:-2], abs=1e-4 * scale)


def test_a_recorder_leaps_after_each_slip_and_ticks_lie_where_a_clock_ticks():
    world, t, motion, shown = shown_by(nameless.recorder_is_blind_after_each_slip)
    blind = 0.05 * world.nominal.period
    leaps = np.flatnonzero(np.diff(shown) > 0.5 * blind * world.belt_velocity)
    assert t[leaps[:5]] == pytest.approx(motion.sticks[:5, 0] - blind * np.arange(5), abs=2.0 / world.nominal.rate)
    world, t, motion, shown = shown_by(nameless.slips_are_put_at_ticks, cycles=12.0)
    tops = np.flatnonzero((shown[:-2] < shown[1:-1]) & (shown[1:-1] > shown[2:]) & (shown[1:-1] > 0.98 * world.rig.reach)) + 1
    ticks = t[tops] / (0.2 * world.nominal.period)
    assert ticks[:8] == pytest.approx(np.round(ticks[:8]), abs=0.05)


def test_wavelets_scanners_means_and_pulses_are_as_said_of_a_ramp():
    def ramp(world, t):
        return world.nominal.reach * (0.5 + 0.4 * t / world.duration)

    for form in (nameless.record_is_hushed_by_wavelets, nameless.running_mean_is_taken_away):
        still = shown_of(form, lambda world, t: 1e-3 + 0.0 * t, cycles=20.0)[2]
        assert np.abs(still).max() < 1e-6
    hushed = shown_of(nameless.record_is_hushed_by_wavelets, ramp, cycles=20.0)[2]
    whole = hushed[: hushed.size // 32 * 32].reshape(-1, 32)
    assert np.abs(whole.mean(1)).max() < 1e-9  # means of blocks are kept
    world, _, swept = shown_of(nameless.scanner_sweeps_to_and_fro, ramp, cycles=20.0)
    sweep = round(0.1 * world.nominal.period * world.nominal.rate)
    whole = swept[: swept.size // (2 * sweep) * 2 * sweep].reshape(-1, 2, sweep)
    assert np.abs(whole[:, 0]).max() < 1e-9
    assert whole[:, 1] == pytest.approx(-whole[:, 1, ::-1])
    world, _, pulses = shown_of(nameless.pulses_shine_through, lambda world, t: 0.65 * world.nominal.reach + 0.0 * t)
    most = 0.6 * 0.125 * world.nominal.slip_length / world.nominal.noise  # half of the full width
    assert (pulses.min(), pulses.max()) == pytest.approx((-most, most), rel=0.02)
    assert (np.mean(pulses), np.std(pulses)) == pytest.approx((0.0, most / np.sqrt(3.0)), abs=0.01 * most)
