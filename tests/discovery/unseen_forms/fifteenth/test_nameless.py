"""The unknown forms and the nulls of the fifteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, NONE, UNKNOWN
from tests.discovery.unseen_forms.fourteenth.test_nameless import instants, slips_of
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, noise, rig_of

from . import nameless, nulls
from .rigs import RIGS_OF_THE_SET
from .test_known import at, world_of

SET = {name: form for name, form in FORMS.items() if form.series == 15 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = "fifteenth_scatter_declared_and_coloured_noise"
OF_THE_SENSOR = [name for name in UNKNOWNS if not re.search("belt|variator|drum|chain", name)]


def shown_by(form, rig: str, *, cycles: float = 8.0, strength: float = 1.0):
    """Return the world, its times, its motion, and what the sensor shows of it."""
    world = world_of(rig, form, cycles=cycles, strength=strength)
    t = instants(world)
    motion = simulate(world, t)
    return world, t, motion, world.sensor(t, motion, np.random.default_rng(1))


def errors_of(form, rig: str, *, speed: float = 0.0):
    """Return what a sensor is off by at a steady speed, over the highest one, in multiples of the noise."""
    world = world_of(rig, form, cycles=40.0)
    t, v = instants(world), speed * world.nominal.peak_speed
    return (world.sensor(t, at(position=v * t, velocity=v + 0.0 * t), np.random.default_rng(1)) - v * t) / world.nominal.noise


def test_the_set_is_as_wide_as_asked_for_and_shares_no_name_and_no_source():
    assert (len(UNKNOWNS), len(NULLS)) == (12, 12)
    for names in (UNKNOWNS, NULLS):
        assert sorted(SET[name].rig for name in names) == sorted([*RIGS_OF_THE_SET] * 2)
    earlier = {re.sub(r"^[a-z]+th_", "", name) for name, form in FORMS.items() if form.series < 15}
    for name, form in SET.items():
        assert form.apply.__doc__
        assert re.search(r"\b(1[6789]|20)\d\d\b", form.source), name
        assert form.source not in {other.source for other in FORMS.values() if other is not form and other.truth & form.truth}
        assert name.removeprefix("fifteenth_") not in earlier


@pytest.mark.parametrize("name", SET)
def test_it_keeps_the_preconditions_and_is_stick_slip_in_each_run(name):
    series_checks.assert_preconditions(SET[name])
    series_checks.assert_stick_slip(SET[name], 151, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", UNKNOWNS)
def test_an_unknown_form_moves_what_is_shown_by_tens_of_floors_and_by_less_at_half(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and 10.0 < half[key] < 0.9 * sizes[key] for key in sizes)
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)
    run, twin = (make_runs(Case(SET[name], "one", 1.0), 3, strength=a, share=0.06)[0].motion.position for a in (1.0, 0.0))
    assert np.array_equal(run, twin) == (name in OF_THE_SENSOR)


@pytest.mark.parametrize("name", ["variator_settles_anew_in_each_slip", "link_fades_on_two_paths", DECLARED[10:]])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(SET[f"fifteenth_{name}"])


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_the_stated_law_says_and_is_off_by_no_more_than_is_stated(name):
    """All it shows besides, with the noise that is written, is near the stated noise."""
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 3, share=0.08)[0]
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    if name != DECLARED:
        np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    error = run.reading - run.motion.position
    assert abs(np.mean(error)) < 0.5 * rig.noise
    written = noise(str(form.options.get("noise", "white")), rig.noise, error.size, np.random.default_rng(0))
    assert 0.9 * rig.noise < np.std(error + written) < 2.1 * rig.noise
    assert np.any(error) or form.options
    limit = 2.0 * float(form.options.get("at_limits", 0.0))
    for key, sd in series_checks.stated(form).items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(limit) if limit else off <= 1.5 + 1e-12


def test_noises_are_as_loud_as_said_and_shaped_as_said():
    memory = errors_of(nulls.noise_of_long_memory, "fader")
    low, high = (np.mean(np.array_split(np.abs(np.fft.rfft(memory)) ** 2, 50)[part]) for part in (0, 9))
    assert np.std(memory) == pytest.approx(0.6, rel=0.15)
    assert 3.0 < low / high < 12.0  # f to -0.6, a decade and more
    assert np.std(errors_of(nulls.noise_that_people_make, "wedge")) == pytest.approx(np.sqrt(4.0 / 12 + 11.0 / 108), rel=0.03)
    worn = errors_of(nulls.every_fourth_converter_is_noisier, "points")
    assert sorted(np.std(worn[i::4]) for i in range(4)) == pytest.approx([0.0, 0.0, 0.0, np.sqrt(3.0)], rel=0.05)
    ripple, hum = errors_of(nulls.chopper_leaves_a_ripple, "organ"), errors_of(nulls.hum_of_two_fans_beats, "sash")
    assert (np.std(ripple), np.std(hum)) == pytest.approx((0.9 / np.sqrt(3.0), 0.6), rel=0.03)
    assert (np.abs(ripple).max(), np.abs(hum).max()) == pytest.approx((0.9, 1.2), rel=0.03)


def test_a_counter_an_interval_and_a_busy_computer_are_off_by_no_more_than_said():
    steps = errors_of(nulls.counter_turns_round_late, "organ", speed=0.01)
    assert steps[5:].min() == pytest.approx(-2.0 * 0.75, abs=0.05)  # late by a quarter of a step on the way up
    assert steps.max() == pytest.approx(2.0 * 0.25, abs=0.05)
    late = -errors_of(nulls.readings_are_late_in_spells, "sash", speed=1.0)
    assert (late.min(), late.max()) == pytest.approx((0.0, 2.0), abs=1e-6)
    world, _, motion, shown = shown_by(nulls.readings_are_means_over_their_interval, "girder")
    off = (shown - motion.position)[1:-1] / world.nominal.noise
    bend = (world.nominal.pulsation / world.nominal.rate) ** 2 / 48.0 * world.nominal.slip_length / world.nominal.noise
    assert np.abs(off[np.abs(motion.velocity[1:-1]) > 2.0 * world.belt_velocity]).max() == pytest.approx(bend, rel=0.15)


def test_a_belt_that_swings_does_so_as_a_circuit_does():
    world = world_of("organ", nameless.belt_swings_after_each_slip, cycles=8.0)
    period, v, kicks = world.nominal.period, world.belt_velocity, (0.3, 1.1)
    p2, c = (1 / 0.3**2 + (2 * np.pi / 0.35) ** 2) / period**2, 2.0 / 0.3 / period
    y, t = np.zeros(3), 0.0  # way, speed less the stated one, and its rate
    for end in (*(period * np.array(kicks)), 1.7 * period):
        y = solve_ivp(lambda _, y: (y[1], y[2], -p2 * y[1] - c * y[2]), (t, end), y, rtol=1e-9, atol=1e-12).y[:, -1]
        t = end
        found = [world.travel(t) - v * t, period * (world.belt(t) - v), period**2 * world.belt_acceleration(t)]
        assert found == pytest.approx(y * period ** np.arange(3), abs=1e-5 * v * period)
        if end < 1.7 * period:
            world.on_break(at(t=t))
            y[2] += 0.75 * v * 2 * np.pi / 0.35 / period


def test_a_variator_and_a_drum_have_speeds_that_last():
    world, _, motion, _ = shown_by(nameless.variator_settles_anew_in_each_slip, "points", cycles=20.0)
    rate = np.divide(*(motion.breaks[2:] - motion.sticks[2 : len(motion.breaks)]).T[::-1]) / world.belt_velocity
    assert 0.84 < rate.min() < rate.max() < 1.16
    assert np.std(rate) == pytest.approx(0.15 / np.sqrt(3.0), rel=0.4)
    assert np.std(motion.breaks[2:, 1]) < 1e-3 * world.nominal.slip_length
    drum = world_of("girder", nameless.drum_winds_layer_upon_layer, cycles=60.0)
    way = drum.belt_velocity * instants(drum) / drum.nominal.slip_length
    pace = drum.belt(instants(drum)) / drum.belt_velocity
    assert np.interp([3.0, 12.0, 24.0, 36.0, 48.0], way, pace) == pytest.approx([0.89, 0.945, 1.0, 1.055, 1.11], abs=1e-3)


def test_a_chain_takes_energy_and_gives_none_back():
    world, _, motion, _ = shown_by(nameless.chain_is_drawn_out_of_its_heap, "sash")
    rig, slip, taut, found = world.rig, world.nominal.slip_length, world.rig.reach, slips_of(motion)

    def pull(_, y):  # the momentum of what moves, and what acts on it
        x, p = y
        v = p / (rig.mass + 0.5 * rig.mass / slip * max(taut - x, 0.0))
        return v, rig.mu_k * rig.normal_force - rig.stiffness * x - rig.damping * v

    start, half = (found[-1, 1], rig.mass * rig.belt_velocity), np.pi / rig.pulsation
    turn = solve_ivp(pull, (0.0, 1.4 * half), start, rtol=1e-9, atol=1e-12, max_step=1e-3)
    last = (instants(world) >= found[-1, 0]) & (instants(world) < found[-1, 0] + 1.5 * half)
    assert turn.y[0].min() == pytest.approx(motion.position[last].min(), abs=2e-3 * slip)
    assert found[-1, 2] < 0.97 * slip
    assert found[-1, 3] > 1.05 * np.pi / rig.pulsation
    assert world.load(at(x=taut - 0.5 * slip, v=0.1)) == 0.0


def test_sensors_are_off_where_they_are_said_to_be():
    world, t, motion, shown = shown_by(nameless.restorer_takes_the_least_for_zero, "sash", cycles=14.0)
    late = t > motion.sticks[3, 0]
    assert shown[late].min() > motion.sticks[1, 1] - 0.02 * world.nominal.slip_length
    assert 0.6 < np.ptp(shown[late]) / np.ptp(motion.position[late]) < 0.95
    world, t, motion, shown = shown_by(nameless.gauge_takes_the_wave_beside, "wedge", cycles=30.0)
    waves = (shown - motion.position) / (0.08 * world.nominal.slip_length)
    assert {*np.round(waves, 6)} == {-1.0, 0.0, 1.0}
    assert np.allclose(np.interp(motion.breaks[:, 0], t, waves), 0.0)
    world, t, motion, shown = shown_by(nameless.focus_hunts_after_each_slip, "wedge")
    gain = (shown - motion.position) / (motion.position - world.nominal.reach + 0.5 * world.nominal.slip_length)
    assert 0.06 < gain.max() < 0.1
    assert gain[np.searchsorted(t, motion.sticks[2:, 0])] == pytest.approx(0.0, abs=0.01)
    world, t, motion, shown = shown_by(nameless.worn_track_shows_too_little_in_motion, "fader")
    assert np.all(shown <= motion.position)


def test_packets_paths_whistle_and_heat():
    world = world_of("girder", nameless.packets_are_spread_over_their_arrivals, cycles=60.0)
    t = instants(world)
    off = (world.sensor(t, at(position=t), np.random.default_rng(1)) - t)[200:-200] / world.nominal.period
    assert -0.13 < off.min() < -0.06
    assert 0.03 < off.max() <= 0.04 + 1e-9
    world = world_of("fader", nameless.link_fades_on_two_paths, cycles=60.0)
    gain = world.sensor(instants(world), at(position=1.0), None)
    assert (gain.min(), gain.max()) == pytest.approx((0.88, 1.12), abs=0.003)
    world = world_of("points", nameless.ripple_is_as_quick_as_the_reading_is_high, cycles=60.0)
    t, reach = instants(world), world.nominal.reach
    for part in (0.3, 0.9):
        lines = np.abs(np.fft.rfft(world.sensor(t, at(position=part * reach + 0.0 * t), None) - part * reach))
        assert np.argmax(lines) == pytest.approx(12.0 * part * 60.0, abs=1.5)
    world, t, motion, shown = shown_by(nameless.heat_of_each_slip_comes_late, "organ", cycles=10.0)
    first = (t > motion.breaks[0, 0]) & (t < motion.breaks[1, 0])
    hump = (shown - motion.position)[first] / world.nominal.slip_length
    late = (t[first] - motion.breaks[0, 0]) / world.nominal.period
    assert hump.max() == pytest.approx(0.06 * np.exp(-0.16 / 1.2), rel=0.15)
    assert 0.1 < late[np.argmax(hump)] < 0.18
    assert hump[late < 0.01].max() < 1e-3
