"""The unknown forms and the nulls of the fourteenth set keep what the pages on discovery and datasets ask of a record."""

import re
from functools import partial

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, noise, rig_of

from .nameless import (
    archive_keeps_corners,
    clock_is_set_over_the_network,
    frames_are_joined_by_splines,
    gauge_takes_the_ride_for_drift,
    grit_gives_way_bit_by_bit,
    neighbour_rig_tugs_at_the_table,
    pellets_lie_in_the_way,
    plug_sits_otherwise_after_each_slip,
    radar_sweeps_up_and_down,
    sand_gathers_while_the_box_rests,
    telephone_films_at_two_rates,
    valve_shuts_in_each_slip,
)
from .nulls import (
    gauge_is_polled,
    limits_after_a_tilting_table,
    line_bends_within_the_noise,
    noise_in_time_with_the_mains,
    noise_of_few_photons,
    noise_out_of_focus,
    numbers_of_two_bytes,
    quartz_within_its_tolerance,
    rounded_twice,
    scale_is_interpolated_well,
    scatter_declared_at_the_limits,
)
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 14 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = "fourteenth_scatter_declared_at_the_limits"
OF_THE_SENSOR = [name for name in UNKNOWNS if not re.search("neighbour|valve|pellets|sand|grit", name)]


def world_of(name: str, *, cycles: float = 1.0, speed: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    return World(rig, rig, speed * rig.belt_velocity, rig.normal_force, cycles * rig.period, np.random.default_rng(0))


def at(**numbers):
    """A state or a motion of which these numbers are known."""
    return type("At", (), numbers)


def instants(world: World) -> np.ndarray:
    return np.arange(0.0, world.duration, 1.0 / world.nominal.rate)


def slips_of(motion) -> np.ndarray:
    """Return rows (begins at, from, length, duration) of slips, less the first two."""
    count = min(len(motion.breaks), len(motion.sticks) - 1)
    breaks, sticks = motion.breaks[:count], motion.sticks[1 : count + 1]
    return np.column_stack([breaks, breaks[:, 1] - sticks[:, 1], sticks[:, 0] - breaks[:, 0]])[2:]


def with_and_without(form, rig: str, *, cycles: float = 8.0, speed: float = 1.0):
    """Return the world with the form, and the motions with and without."""
    plain, world = (world_of(rig, cycles=cycles, speed=speed) for _ in range(2))
    form(world, 1.0)
    usual, moved = (simulate(each, instants(each)) for each in (plain, world))
    return world, moved, usual


def shown_by(form, rig: str, *, cycles: float = 8.0):
    """Return the world, its times, its motion, and what the sensor shows of it."""
    world = world_of(rig, cycles=cycles)
    form(world, 1.0)
    t = instants(world)
    motion = simulate(world, t)
    return world, t, motion, world.sensor(t, motion, np.random.default_rng(1))


def errors_of(form, rig: str, *, cycles: float = 60.0, position=0.0):
    """Return what a sensor is off by, in multiples of the noise, where a box stands or is where `position` says."""
    world = world_of(rig, cycles=cycles)
    form(world, 1.0)
    t = instants(world)
    x = position(world, t) if callable(position) else position
    return (world.sensor(t, at(position=x), np.random.default_rng(1)) - x) / world.nominal.noise


def test_the_set_is_as_wide_as_asked_for():
    assert (len(UNKNOWNS), len(NULLS)) == (12, 12)
    assert all(form.right("one") == form.right("several") == form.truth for form in SET.values())
    assert all(len(form.truth) == 1 for form in SET.values())
    assert all({form.rig for form in map(SET.get, names)} == set(RIGS_OF_THE_SET) for names in (UNKNOWNS, NULLS))
    assert all(form.apply.__doc__ for form in SET.values())
    assert all(name.startswith("fourteenth_") for name in SET)
    assert not {name.removeprefix("fourteenth_") for name in SET} & set(KINDS)


def test_each_form_has_a_source_that_no_other_form_of_its_kind_has():
    for form in SET.values():
        assert re.search(r"\b(1[6789]|20)\d\d\b", form.source), form.name
        assert form.source not in {other.source for other in FORMS.values() if other is not form and other.truth & form.truth}


def test_no_earlier_form_has_the_name_of_one():
    words = {name: name.split("_", 1)[1] for name in SET}
    earlier = {part for form in FORMS.values() if form.series < 14 for part in (form.name, form.name.split("_", 1)[-1])}
    assert not set(words.values()) & earlier


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    series_checks.assert_preconditions(SET[name])


@pytest.mark.parametrize("name", UNKNOWNS)
def test_an_unknown_form_moves_what_is_shown_by_tens_of_floors_and_by_less_at_half(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and 10.0 < half[key] < 0.9 * sizes[key] for key in sizes)


@pytest.mark.parametrize("name", SET)
def test_it_is_stick_slip_in_each_run_of_the_last_design(name):
    series_checks.assert_stick_slip(SET[name], 141, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", UNKNOWNS)
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)


@pytest.mark.parametrize("name", OF_THE_SENSOR)
def test_a_form_of_the_sensor_leaves_the_motion_alone(name):
    run, twin = (make_runs(Case(SET[name], "one", 1.0), 3, strength=strength, share=0.06)[0] for strength in (1.0, 0.0))
    np.testing.assert_array_equal(run.motion.position, twin.motion.position)
    assert np.std(run.reading - twin.reading) > 3.0 * rig_of(SET[name]).noise


@pytest.mark.parametrize(
    "name", ["neighbour_rig_tugs_at_the_table", "grit_gives_way_bit_by_bit", "scatter_declared_at_the_limits"]
)
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(SET[f"fourteenth_{name}"])


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_the_stated_law_says_and_is_off_by_no_more_than_is_stated(name):
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 3, share=0.05)[0]
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    if name != DECLARED:
        np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    error = run.reading - run.motion.position
    assert np.std(error) < 2.0 * rig.noise
    assert abs(np.mean(error)) < 0.5 * rig.noise
    assert np.any(error) or form.options
    for key, sd in series_checks.stated(form).items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(2.0) if "at_limits" in form.options else off <= 1.5 + 1e-12


@pytest.mark.parametrize("name", NULLS)
def test_all_that_a_null_shows_besides_is_near_the_stated_noise(name):
    """The noise that is written, the sensor's own error, and what jitter of the clock adds in motion."""
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 5, share=0.1)[0]
    written = noise(str(form.options.get("noise", "white")), rig.noise, run.reading.size, np.random.default_rng(0))
    early = (run.motion.time - np.arange(run.motion.time.size) / rig.rate) * run.motion.velocity
    assert 0.95 * rig.noise < np.std(run.reading - run.motion.position + written + early) < 2.1 * rig.noise


def test_errors_along_the_range_are_within_the_noise():
    def ramp(world, t):
        return world.nominal.reach * t / world.duration

    bend, sine = (
        errors_of(line_bends_within_the_noise, "wire", position=ramp),
        errors_of(scale_is_interpolated_well, "platen", position=ramp),
    )
    assert (bend.max(), bend.min()) == pytest.approx((0.8, -0.8), rel=0.01)
    assert np.sum(np.diff(np.sign(bend[1:])) != 0) == 1  # once along the range
    assert 0.7 < np.abs(sine).max() < 1.05
    lines = np.abs(np.fft.rfft(sine - sine.mean()))
    rig = RIGS_OF_THE_SET["platen"]
    assert np.argmax(lines) == pytest.approx(16.3 * rig.reach / rig.slip_length, abs=1.0)


def test_noises_are_as_loud_as_said_and_shaped_as_said():
    photons = errors_of(noise_of_few_photons, "hair")
    assert (np.mean(photons), np.std(photons)) == pytest.approx((0.0, 1.0), abs=0.03)
    assert np.mean(photons**3) == pytest.approx(1.0 / np.sqrt(5.0), abs=0.08)
    assert np.diff(np.unique(np.round(photons, 9))) == pytest.approx(1.0 / np.sqrt(5.0), abs=1e-6)
    mains = errors_of(noise_in_time_with_the_mains, "tap")
    lines = np.abs(np.fft.rfft(mains**2 - np.mean(mains**2)))
    assert np.std(mains) == pytest.approx(1.0, rel=0.03)
    assert mains.size / np.argmax(lines) == pytest.approx(23.7, rel=0.01)
    rig = RIGS_OF_THE_SET["strut"]
    loud = [np.std(errors_of(noise_out_of_focus, "strut", position=rig.reach - u * rig.slip_length)) for u in (0, 0.25, 0.5, 1)]
    assert loud == pytest.approx(np.sqrt(3.0) * np.array([1.0, 0.5, 0.0, 1.0]), rel=0.03)
    tones = errors_of(limits_after_a_tilting_table, "tap")
    lines = np.abs(np.fft.rfft(tones)) / tones.size
    assert np.std(tones) == pytest.approx(0.5 * np.sqrt(1.5), rel=0.01)
    assert np.sum(lines > 0.05) < 12  # three lines, and what leaks beside them


def test_steps_are_as_coarse_as_said():
    def ramp(world, t):
        return world.nominal.reach * (0.45 + 0.5 * t / world.duration)

    def between(low, high, world, t):
        return np.linspace(low, high, t.size)

    rig = RIGS_OF_THE_SET["chair"]
    for low, high, step in ((7.5e-3, 7.9e-3, 2.0**-8), (8.1e-3, 15.6e-3, 2.0**-7)):
        error = rig.noise * errors_of(numbers_of_two_bytes, "chair", position=partial(between, low, high))
        assert np.ptp(error) == pytest.approx(1e-3 * step, rel=0.02)
    assert np.std(errors_of(rounded_twice, "chair", position=ramp)) == pytest.approx(4.5 / np.sqrt(12.0), rel=0.02)
    assert SET["fourteenth_rounded_twice"].options["quantum"] == 3.2


def test_clocks_are_off_by_no_more_than_the_noise_in_fast_motion():
    def fast(world, t):
        return world.nominal.peak_speed * t

    late = -errors_of(gauge_is_polled, "wire", cycles=9.0, position=fast)[1:]
    assert 0.0 <= late.min() < 0.05
    assert 1.95 < late.max() <= 2.0
    assert np.mean(late) == pytest.approx(1.0, rel=0.05)
    world = world_of("strut", cycles=60.0)
    quartz_within_its_tolerance(world, 1.0)
    t = instants(world)
    assert (t - world.sensor(t, at(position=t), None))[-1] == pytest.approx(3.0e-5 * t[-1])
    assert 3.0e-5 * world.duration < 0.002 * world.nominal.period


def test_declared_scatter_is_as_large_as_declared_and_lasts_as_long():
    assert SET[DECLARED].options["declared_sigma"] == 0.002
    world = world_of("platen", cycles=4000.0)
    scatter_declared_at_the_limits(world, 1.0)
    t = np.arange(0.0, world.duration, 0.25 * world.nominal.period)
    for value, mean in ((world.mu_s(at(t=t)), world.rig.mu_s), (world.mu_k(at(t=t)), world.rig.mu_k)):
        z = (value - mean) / 0.002
        assert (np.mean(z), np.std(z)) == pytest.approx((0.0, 1.0), abs=0.08)
        assert np.mean(z[4:] * z[:-4]) == pytest.approx(np.exp(-1.0), abs=0.06)


@pytest.mark.parametrize(
    ("name", "column", "mean", "spread"),
    [("limits_of_a_catalogue_spring", "normal_force [N]", 1.0, 0.004), (DECLARED[11:], "humidity", 44.0, 3.0 / np.sqrt(2.0))],
)
def test_a_column_that_matters_to_nobody_is_true(name, column, mean, spread):
    run = make_runs(Case(SET[f"fourteenth_{name}"], "one", 1.0), 3, share=0.6)[0]
    values = run.world.columns[column](run.motion.time, run.motion) / (run.world.normal_force if "force" in column else 1.0)
    assert np.mean(values) == pytest.approx(mean, rel=0.02)
    assert np.std(values) == pytest.approx(spread, rel=0.1)


def test_a_neighbour_tugs_ever_more_and_lets_go():
    world, moved, usual = with_and_without(neighbour_rig_tugs_at_the_table, "wire", cycles=20.0)
    force = world.load(at(t=instants(world))) / (world.nominal.gap * world.nominal.normal_force)
    assert (force.min(), force.max()) == pytest.approx((-0.2, 0.2), abs=0.005)
    assert abs(np.mean(force)) < 0.02
    grows = np.diff(force) > 0.0
    assert np.mean(grows) > 0.9
    lets_go = instants(world)[1:-1][grows[:-1] & ~grows[1:]] / world.nominal.period
    assert 0.41 < np.diff(lets_go).min() < np.diff(lets_go).max() < 1.01
    assert np.std(moved.breaks[2:, 1]) > 0.03 * world.nominal.slip_length
    assert np.std(usual.breaks[2:, 1]) < 1e-3 * world.nominal.slip_length


def test_a_shut_valve_makes_slips_quick_and_short_and_break_away_as_stated():
    _, moved, usual = with_and_without(valve_shuts_in_each_slip, "chair")
    slip, plain = slips_of(moved), slips_of(usual)
    assert slip[:, 1] == pytest.approx(plain[0, 1], rel=1e-4)
    assert slip[:, 2] == pytest.approx(plain[0, 2] / 1.4, rel=0.02)
    assert slip[:, 3] / plain[0, 3] == pytest.approx(1.0 / np.sqrt(1.4), abs=0.03)


def test_pellets_stop_a_slip_and_push_nothing_back():
    world, moved, usual = with_and_without(pellets_lie_in_the_way, "platen")
    slip, plain = slips_of(moved), slips_of(usual)
    assert slip[:, 1] == pytest.approx(plain[0, 1], rel=1e-4)
    assert 0.75 < np.mean(slip[:, 2]) / plain[0, 2] < 0.92
    heap = at(q=np.array([1.0]), x=1.0 - 0.5 * world.rig.slip_length, v=-world.nominal.peak_speed)
    most = 0.8 * world.nominal.gap * world.nominal.normal_force
    assert world.load(heap) == pytest.approx(most)
    assert world.rates(heap)[0] == pytest.approx(heap.v)
    back = at(q=np.array([1.0]), x=heap.x, v=world.nominal.belt_velocity)
    assert world.load(back) < 1e-3 * most
    clear = at(q=np.array([1.0]), x=1.1, v=-world.nominal.peak_speed)
    assert world.load(clear) == 0.0
    twice, once = (with_and_without(pellets_lie_in_the_way, "platen", speed=speed)[1] for speed in (2.0, 0.4))
    assert slips_of(twice)[:, 2].mean() > 1.03 * slips_of(once)[:, 2].mean()  # less time to trickle back


def test_sand_makes_slips_last_by_the_time_of_rest_and_leaves_their_way():
    stands = {}
    for speed in (0.4, 1.0, 2.0):
        _, moved, usual = with_and_without(sand_gathers_while_the_box_rests, "strut", speed=speed)
        slip, plain = slips_of(moved), slips_of(usual)
        assert slip[:, 2] == pytest.approx(plain[0, 2], rel=0.02)
        stands[speed] = np.mean(slip[:, 3]) / plain[0, 3]
    assert stands[1.0] == pytest.approx(1.0, abs=0.03)
    assert stands[0.4] == pytest.approx(np.sqrt(1.75), abs=0.05)
    assert 0.8 < stands[2.0] < 0.92


def test_grit_gives_way_in_steps_that_add_to_the_rest_alone():
    world, moved, usual = with_and_without(grit_gives_way_bit_by_bit, "tap", cycles=20.0)
    slip, v = world.nominal.slip_length, world.belt_velocity
    count = len(moved.breaks)
    (t0, x0), (t1, x1) = moved.sticks[2:count].T, moved.breaks[2:].T
    back = (v * (t1 - t0) - (x1 - x0)) / slip
    assert back.min() > 0.0
    assert np.mean(back) == pytest.approx(5.0 * 0.025, abs=0.05)
    assert np.std(back) > 0.02
    assert moved.breaks[2:, 1] == pytest.approx(world.rig.reach, abs=0.04 * slip)
    assert np.mean(slips_of(moved)[:, 2]) == pytest.approx(slips_of(usual)[0, 2], rel=0.02)
    t = np.linspace(0.2 * world.duration, 0.2 * world.duration + world.nominal.period, 20001)
    world.on_stick(at(t=t[0]))
    h = t[1] - t[0]
    assert np.gradient(world.travel(t), h)[2:-2] == pytest.approx(world.belt(t)[2:-2], abs=1e-3 * v)
    assert np.gradient(world.belt(t), h)[2:-2] == pytest.approx(
        world.belt_acceleration(t)[2:-2], abs=0.02 * v * world.nominal.pulsation
    )


def test_a_gauge_follows_the_ride_and_not_the_slip():
    world, t, motion, shown = shown_by(gauge_takes_the_ride_for_drift, "tap", cycles=14.0)
    off, slip = (motion.position - shown) / world.rig.slip_length, world.rig.slip_length
    stick, leave, ends = motion.sticks[8, 0], motion.breaks[8, 0], motion.sticks[9, 0]
    rate = np.gradient(shown, t) / world.belt_velocity
    third = (leave - stick) / 3.0
    assert rate[(t > stick + 0.1 * third) & (t < stick + third)] == pytest.approx(1.3, abs=0.03)
    assert rate[(t > leave - third) & (t < leave - 0.1 * third)] == pytest.approx(0.7, abs=0.05)
    fast = (t > leave) & (t < ends) & (np.abs(motion.velocity) > 3.1 * world.belt_velocity)
    assert np.ptp(off[fast]) < 1e-9
    marks = np.interp(motion.breaks[2:, 0], t, shown)
    assert np.ptp(marks) < 0.02 * slip  # it comes back each cycle
    assert np.ptp(off) > 0.1


def test_an_archive_is_off_by_little_and_straight_between_corners():
    world, t, motion, shown = shown_by(archive_keeps_corners, "strut")
    near = 0.05 * world.nominal.slip_length
    assert 0.5 * near < np.abs(shown - motion.position).max() < 2.0 * near
    bent = np.abs(np.diff(shown, 2)) > 1e-3 * world.belt_velocity * (t[1] - t[0])
    assert np.sum(bent) < 12 * 8  # some corners a cycle
    ramp = t * world.belt_velocity
    np.testing.assert_allclose(world.sensor(t, at(position=ramp), None), ramp, atol=1e-12)


def test_splines_go_through_the_frames_and_swing_beside_them():
    world, t, motion, shown = shown_by(frames_are_joined_by_splines, "hair")
    apart, slip = np.pi / world.nominal.pulsation, world.nominal.slip_length
    frames = np.arange(1, int(t[-1] / apart) - 1) * apart
    off = np.interp(frames, t, shown - motion.position) / slip
    assert np.abs(off).max() < 3e-3
    error = (shown - motion.position) / slip
    assert error.min() < -0.1
    assert error.max() > 0.1
    np.testing.assert_allclose(world.sensor(t, at(position=world.belt_velocity * t), None), world.belt_velocity * t, atol=1e-9)


def test_a_telephone_shows_spells_in_which_all_is_slower():
    world = world_of("chair", cycles=60.0)
    telephone_films_at_two_rates(world, 1.0)
    t = instants(world)
    rate = np.diff(world.sensor(t, at(position=t), None)) * world.nominal.rate
    slow = np.abs(rate - 0.85) < 1e-6
    assert 0.35 < np.mean(slow) < 0.65
    assert np.mean(slow | (np.abs(rate - 1.0) < 1e-6)) > 0.99
    turns = t[1:-1][slow[1:] != slow[:-1]]
    spells = np.diff(turns)[np.diff(turns) > 2.0 / world.nominal.rate] / world.nominal.period
    assert 0.5 < spells.min() < spells.max() < 3.1


def test_a_clock_is_a_little_slow_and_leaps_ahead():
    world = world_of("wire", cycles=30.0)
    clock_is_set_over_the_network(world, 1.0)
    t = instants(world)
    off = (world.sensor(t, at(position=t), None) - t)[20:-20] / world.nominal.period
    assert (off.min(), off.max()) == pytest.approx((-0.07, 0.07), abs=0.002)
    assert abs(np.mean(off)) < 0.003
    leaps = np.flatnonzero(np.diff(off) > 0.1)
    assert np.diff(t[20:-20][leaps]) / world.nominal.period == pytest.approx(2.3, abs=0.01)
    assert np.median(np.diff(off)) * world.nominal.rate * world.nominal.period == pytest.approx(-0.14 / 2.3, rel=1e-3)


def test_a_radar_is_right_at_rest_and_off_to_either_side_in_motion():
    world = world_of("platen")
    radar_sweeps_up_and_down(world, 1.0)
    t = instants(world)
    still = world.sensor(t, at(position=1.0, velocity=0.0 * t), None)
    assert still == pytest.approx(1.0)
    moving = world.sensor(t, at(position=0.0, velocity=world.nominal.peak_speed + 0.0 * t), None) / world.nominal.slip_length
    assert moving[1:] == pytest.approx(-moving[:-1])
    assert 0.15 < moving[0] < 0.25


def test_a_loose_plug_keeps_its_gain_through_a_ride():
    _, t, motion, shown = shown_by(plug_sits_otherwise_after_each_slip, "hair", cycles=20.0)
    gains = []
    for (begins, _), (leaves, _) in zip(motion.sticks[2:], motion.breaks[2:], strict=False):
        ride = (t > begins) & (t < leaves)
        gain = shown[ride] / motion.position[ride]
        assert np.ptp(gain) < 1e-9
        gains.append(gain[0])
    assert 0.9 < min(gains) < max(gains) < 1.1
    assert np.std(gains) == pytest.approx(0.1 / np.sqrt(3.0), rel=0.4)
