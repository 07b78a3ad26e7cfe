"""The unknown forms and the nulls of the thirteenth set keep what the pages on discovery and datasets ask of a record."""

import itertools
import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, noise, rig_of

from .nameless import (
    box_clings_to_its_guide,
    box_settles_into_a_hollow,
    column_rocks_after_each_slip,
    encoder_misses_counts_until_its_index,
    logger_takes_out_trends,
    logger_writes_differences,
    motor_makes_a_part_of_the_spring,
    pen_swings_on_an_arc,
    readings_wait_in_a_queue,
    recorder_is_quicker_in_slips,
    slow_slips_take_turns_with_fast_ones,
    splice_passes_the_gauge,
)
from .nulls import clock_has_a_spur, noise_in_clusters, noise_of_moving_sums, noise_of_traps, scatter_declared_per_stick
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 13 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = "thirteenth_scatter_declared_per_stick"
OF_THE_SENSOR = [name for name in UNKNOWNS if not re.search("slow_slips|motor|box_", name)]


def world_of(name: str, *, cycles: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    return World(rig, rig, rig.belt_velocity, rig.normal_force, cycles * rig.period, np.random.default_rng(0))


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


def with_and_without(form, rig: str, *, cycles: float = 8.0):
    """Return the world with the form, and the motions with and without."""
    plain, world = (world_of(rig, cycles=cycles) for _ in range(2))
    form(world, 1.0)
    usual, moved = (simulate(each, instants(each)) for each in (plain, world))
    return world, moved, usual


def test_the_set_is_as_wide_as_asked_for():
    assert (len(UNKNOWNS), len(NULLS)) == (12, 12)
    assert all(form.right("one") == form.right("several") == form.truth for form in SET.values())
    assert all(len(form.truth) == 1 for form in SET.values())
    assert all({form.rig for form in map(SET.get, names)} == set(RIGS_OF_THE_SET) for names in (UNKNOWNS, NULLS))
    assert all(form.apply.__doc__ for form in SET.values())
    assert all(name.startswith("thirteenth_") for name in SET)
    assert not {name.removeprefix("thirteenth_") for name in SET} & set(KINDS)


def test_each_form_has_a_source_that_no_other_form_of_its_kind_has():
    for form in SET.values():
        assert re.search(r"\b(1[789]|20)\d\d\b", form.source), form.name
        assert form.source not in {other.source for other in FORMS.values() if other is not form and other.truth & form.truth}


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    series_checks.assert_preconditions(SET[name])


@pytest.mark.parametrize("name", UNKNOWNS)
def test_an_unknown_form_moves_what_is_shown_by_tens_of_floors_and_by_less_at_half(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and 10.0 < half[key] < 0.9 * sizes[key] for key in sizes)


@pytest.mark.parametrize("name", SET)
def test_it_is_stick_slip_in_each_run_of_the_last_design(name):
    series_checks.assert_stick_slip(SET[name], 131, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", UNKNOWNS)
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)


@pytest.mark.parametrize("name", OF_THE_SENSOR)
def test_a_form_of_the_sensor_leaves_the_motion_alone(name):
    run, twin = (make_runs(Case(SET[name], "one", 1.0), 3, strength=strength, share=0.06)[0] for strength in (1.0, 0.0))
    np.testing.assert_array_equal(run.motion.position, twin.motion.position)
    assert np.std(run.reading - twin.reading) > 3.0 * rig_of(SET[name]).noise


@pytest.mark.parametrize("name", ["readings_wait_in_a_queue", "box_clings_to_its_guide", "scatter_declared_per_stick"])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(SET[f"thirteenth_{name}"])


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


def test_jitter_of_the_clock_is_as_much_as_the_noise_in_fast_motion():
    jittered = SET["thirteenth_instants_by_chance"]
    rig = rig_of(jittered)
    assert float(jittered.options["jitter"]) * rig.peak_speed / rig.rate == pytest.approx(rig.noise, rel=0.1)
    world = world_of("seal", cycles=3.0)
    clock_has_a_spur(world, 1.0)
    t = instants(world)
    early = world.sensor(t, at(position=rig.peak_speed * t), np.random.default_rng(1)) / rig.peak_speed - t
    most = world.nominal.noise / world.nominal.peak_speed
    assert np.abs(early[1:-1]).max() == pytest.approx(most, rel=0.02)
    lines = np.abs(np.fft.rfft(early))
    assert t.size / np.argmax(lines) == pytest.approx(19.3, rel=0.03)


def test_noises_are_alike_in_what_they_should_be():
    alike = {}
    for form, rig in ((noise_of_traps, "die"), (noise_of_moving_sums, "fork"), (noise_in_clusters, "cork")):
        world = world_of(rig, cycles=60.0)
        form(world, 1.0)
        t = instants(world)
        z = world.sensor(t, at(position=0.0), np.random.default_rng(1)) / world.nominal.noise
        squares = np.corrcoef(z[1:] ** 2, z[:-1] ** 2)[0, 1]
        alike[form] = (np.std(z), *(np.mean(z[k:] * z[: z.size - k]) / np.mean(z**2) for k in (1, 4, 6)), squares)
    assert alike[noise_of_traps][0] == pytest.approx(0.5, abs=0.06)
    assert alike[noise_of_traps][1] > alike[noise_of_traps][2] > alike[noise_of_traps][3] > 0.5
    assert alike[noise_of_moving_sums][:4] == pytest.approx([0.8, 0.8, 0.2, 0.0], abs=0.05)
    assert alike[noise_in_clusters][:4] == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=0.05)
    assert alike[noise_in_clusters][4] > 0.25


def test_declared_scatter_is_as_large_as_declared():
    assert SET[DECLARED].options["declared_sigma"] == 0.004
    world = world_of("die", cycles=2.0)
    scatter_declared_per_stick(world, 1.0)
    drawn = []
    for _ in range(4000):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(None) - world.rig.mu_s, world.mu_k(None) - world.rig.mu_k])
    assert np.mean(drawn, axis=0) == pytest.approx([0.0, 0.0], abs=3e-4)
    assert np.std(drawn, axis=0) == pytest.approx([0.004, 0.004], rel=0.05)
    assert abs(np.corrcoef(np.array(drawn).T)[0, 1]) < 0.06


def test_each_second_slip_is_slow_and_short():
    world, moved, usual = with_and_without(slow_slips_take_turns_with_fast_ones, "beetle", cycles=10.0)
    lengths, durations = (slips_of(moved)[:, column] / slips_of(usual)[0, column] for column in (2, 3))
    assert lengths[0::2] == pytest.approx(lengths[0], rel=1e-3)
    assert lengths[1::2] == pytest.approx(lengths[1], rel=1e-3)
    assert sorted(lengths[:2]) == pytest.approx([0.62, 1.0], abs=0.04)
    assert durations[np.argmin(lengths[:2])] > 1.15
    assert slips_of(moved)[:, 1] == pytest.approx(world.rig.reach, rel=1e-3)


def test_a_motor_holds_its_part_from_tick_to_tick():
    world, moved, usual = with_and_without(motor_makes_a_part_of_the_spring, "fork")
    k, tick = world.rig.stiffness, 0.31 * world.nominal.period
    slip, plain = slips_of(moved), slips_of(usual)
    assert np.all(slip[:, 1] >= plain[0, 1] - 1e-9)
    assert np.all(slip[:, 1] < plain[0, 1] + 0.5 * world.belt_velocity * tick)
    assert slip[:, 3].min() > 1.04 * plain[0, 3]
    assert slip[:, 3].mean() > 1.08 * plain[0, 3]
    still = world_of("fork")
    motor_makes_a_part_of_the_spring(still, 1.0)
    places = [(0.5 * tick, 1.0), (1.0 * tick, 2.0), (1.9 * tick, 3.0), (0.99 * tick, 1.9)]  # the last one looks back
    force = [still.spring(at(t=t, x=x, v=0.0)) / k for t, x in places]
    assert force == pytest.approx([0.7, 2.0, 2.7, 1.33])
    still.on_stick(at(t=2.5 * tick, x=4.0, v=0.0))
    v, u = still.belt_velocity, np.array([0.2, 0.49, 0.5, 1.2]) * tick
    ridden = still.spring(at(t=2.5 * tick + u, x=4.0 + v * u, v=v)) / k - 4.0
    assert ridden[:2] == pytest.approx(0.7 * v * u[:2], abs=1e-9)
    assert ridden[2:] == pytest.approx([v * u[2], 0.7 * v * u[3] + 0.3 * v * 0.5 * tick], abs=1e-9)


def test_a_box_settles_into_hollows_to_either_side():
    world, moved, _ = with_and_without(box_settles_into_a_hollow, "cork", cycles=15.0)
    slip, v = world.nominal.slip_length, world.belt_velocity
    held = (
        moved.breaks[2:, 1]
        - moved.sticks[2 : len(moved.breaks), 1]
        - v * (moved.breaks[2:, 0] - moved.sticks[2 : len(moved.breaks), 0])
    )
    assert held.min() < -0.04 * slip
    assert held.max() > 0.04 * slip
    assert np.abs(held).max() < 0.22 * slip  # half of the widest distance
    hollows = np.sort(v * moved.breaks[2:, 0] - moved.breaks[2:, 1])
    apart = np.diff(hollows) / slip
    assert 0.17 < apart.min() < apart.max() < 2.0
    assert moved.breaks[2:, 1] == pytest.approx(world.rig.reach, rel=1e-3)


def test_a_box_stands_still_for_a_while_and_then_rides_as_stated():
    world, moved, usual = with_and_without(box_clings_to_its_guide, "die", cycles=15.0)
    count, v = len(moved.breaks), world.belt_velocity
    (t0, x0), (t1, x1) = moved.sticks[2:count].T, moved.breaks[2:].T
    stood = (t1 - t0 - (x1 - x0) / v) / world.nominal.period
    assert stood.min() >= -1e-9
    assert 0.04 < stood.mean() < 0.14
    assert stood.std() > 0.03
    assert slips_of(moved)[:, 2] == pytest.approx(slips_of(usual)[0, 2], rel=1e-3)
    assert set(np.unique(np.round(moved.velocity[(moved.time > t0[0]) & (moved.time < t1[0])] / v, 6))) <= {0.0, 1.0}


def shown_by(form, rig: str, *, cycles: float = 8.0):
    """Return the world, its motion, and what the sensor shows of it."""
    world = world_of(rig, cycles=cycles)
    form(world, 1.0)
    t = instants(world)
    motion = simulate(world, t)
    return world, t, motion, world.sensor(t, motion, np.random.default_rng(1))


def test_an_encoder_is_too_high_until_its_index():
    world, t, motion, shown = shown_by(encoder_misses_counts_until_its_index, "mill")
    slip, v = world.rig.slip_length, world.belt_velocity
    stick, leave = motion.sticks[3, 0], motion.breaks[3, 0]
    passes = stick + (world.rig.reach - 0.5 * slip - motion.sticks[3, 1]) / v
    error = (shown - motion.position) / slip
    late, right = error[(t > stick) & (t < passes)], error[(t > passes + 1e-3) & (t < leave)]
    assert late == pytest.approx(late[0], abs=1e-6)
    assert 0.03 < late[0] < 0.06
    assert right == pytest.approx(0.0, abs=1e-9)


def test_a_logger_of_differences_is_right_once_a_block():
    world = world_of("fork")
    logger_writes_differences(world, 1.0)
    block, stride = round(0.3 * world.nominal.period * world.nominal.rate), world.belt_velocity / world.nominal.rate
    x = stride * np.arange(3 * block + 5)
    error = (world.sensor(x, at(position=x), None) - x) / stride
    assert error[::block] == pytest.approx(0.0, abs=1e-9)
    assert np.diff(error[:block]) == pytest.approx(2.0 / 2.6 - 1.0)
    back = (world.sensor(x, at(position=-x), None) + x) / stride
    assert back == pytest.approx(-error)


def test_a_logger_levels_each_page_about_its_mean():
    world = world_of("die", cycles=9.0)
    logger_takes_out_trends(world, 1.0)
    t = instants(world)
    pages = np.array_split(np.arange(t.size), 3)
    x = np.random.default_rng(0).standard_normal(t.size).cumsum()
    shown = world.sensor(t, at(position=x), None)
    for page in pages:
        assert np.polyfit(t[page] - t[page].mean(), shown[page], 1) == pytest.approx([0.0, x[page].mean()], abs=1e-6)
    half = world_of("die", cycles=9.0)
    logger_takes_out_trends(half, 0.5)
    assert half.sensor(t, at(position=x), None) == pytest.approx(0.5 * (x + shown))


def test_readings_are_late_by_turns_and_never_early():
    world = world_of("seal", cycles=300.0)
    readings_wait_in_a_queue(world, 1.0)
    t = instants(world)
    late = t - world.sensor(t, at(position=t), None)
    period, steps = world.nominal.period, np.diff(late)
    assert late.min() > -1e-9
    assert 0.6 < np.mean(late < 1e-9) < 0.85  # idle for three quarters: 0.8 tasks a cycle of 0.32 cycles each
    assert np.median(steps[(steps < -1e-9)]) == pytest.approx(-0.25 * (t[1] - t[0]), rel=1e-6)
    assert np.sum(steps[steps > 0.0]) / period == pytest.approx(0.8 * 300.0 * 0.08, rel=0.25)


def test_a_splice_comes_by_once_a_turn():
    world = world_of("seal", cycles=66.0)
    splice_passes_the_gauge(world, 1.0)
    t = instants(world)
    hump = world.sensor(t, at(position=0.0), None) / world.nominal.slip_length
    tops = t[1:-1][(hump[1:-1] > hump[:-2]) & (hump[1:-1] >= hump[2:]) & (hump[1:-1] > 0.1)]
    assert np.diff(tops) * world.belt_velocity / world.nominal.slip_length == pytest.approx(3.3, abs=0.03)
    assert hump.max() == pytest.approx(0.2, rel=0.02)
    assert np.mean(hump > 0.1) * 3.3 == pytest.approx(2.0 * 0.09 * np.sqrt(np.log(2.0)), rel=0.05)


def test_slips_last_longer_to_a_recorder_that_is_quicker_in_them():
    world, t, motion, shown = shown_by(recorder_is_quicker_in_slips, "die")
    fast = np.abs(motion.velocity) > 0.3 * world.nominal.peak_speed
    shift = 0.5 * np.cumsum(fast) * (t[1] - t[0])
    assert np.interp(t + shift, t, shown)[shift < t[-1] - t] == pytest.approx(
        motion.position[shift < t[-1] - t], abs=0.05 * world.nominal.slip_length
    )
    stick = (t > motion.sticks[2, 0] + shift[t < motion.sticks[2, 0]][-1] + 2e-3) & (t < motion.breaks[2, 0])
    assert np.diff(shown[stick]) / (t[1] - t[0]) == pytest.approx(world.belt_velocity, rel=1e-6)
    assert np.ptp(shown) == pytest.approx(np.ptp(motion.position), rel=0.01)


def test_arcs_of_a_column_are_lower_and_shorter_each_time():
    world, t, motion, shown = shown_by(column_rocks_after_each_slip, "mill")
    slip, first = world.nominal.slip_length, 0.09 * world.nominal.period
    lean = (shown - motion.position) / slip
    late = t - motion.sticks[3, 0]
    ends = first * np.cumsum([0.0, 1.0, 0.75, 0.75**2])
    tops = [np.interp(0.5 * (a + b), late, lean) for a, b in itertools.pairwise(ends)]
    assert tops == pytest.approx([0.08, -0.08 * 0.75**2, 0.08 * 0.75**4], rel=0.02)
    assert np.interp(ends, late, lean) == pytest.approx(0.0, abs=2e-3)
    assert np.abs(lean[(late > 0.4 * world.nominal.period) & (t < motion.breaks[3, 0])]).max() < 1e-3


def test_a_pen_draws_both_ends_of_its_sweep_early():
    world = world_of("beetle")
    pen_swings_on_an_arc(world, 1.0)
    slip, most = world.rig.slip_length, 0.5 / world.nominal.pulsation
    t = np.linspace(0.0, 50.0 * most, 20001)
    u = np.linspace(-1.0, 1.0, t.size)
    x = world.rig.reach - 0.5 * slip + 0.5 * slip * u
    shown = world.sensor(t, at(position=x), None)
    early = np.interp(x[2000:-2000:4000], shown, t) - t[2000:-2000:4000]
    assert early / most == pytest.approx(-(u[2000:-2000:4000] ** 2), abs=0.01)
