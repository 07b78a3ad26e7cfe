"""The rigs and forms of the twelfth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, rig_of

from .friction import (
    asymmetry_of_loaded_fibres,
    correlated_over_long,
    distance_of_a_worn_tip,
    drift_of_an_oxide,
    dwell_drains,
    lag_of_a_steep_power,
    load_of_a_rough_joint,
    position_of_a_fractal_belt,
    presliding_error_function,
    scatter_of_the_better_spot,
    temperature_of_a_rotator_phase,
    viscous_of_a_suspension,
    weakening_of_even_heights,
)
from .mechanism import (
    backlash_with_oil,
    belt_of_a_geneva_wheel,
    drag_with_a_crisis,
    force_of_a_six_step_inverter,
    impacts_of_drops,
    load_of_a_ball_in_its_zone,
    mode_of_a_floating_magnet,
    stiffness_of_foam,
)
from .nameless import (
    box_creeps_on_after_each_slip,
    channel_beside_leaks_in,
    clock_is_pulled_by_the_signal,
    felt_rubs_along_a_part,
    governor_trips_in_each_slip,
    logger_compresses_blocks,
    logger_keeps_the_extremes,
    tape_prints_through,
)
from .rigs import RIGS_OF_THE_SET
from .sensor import (
    clipping_of_a_transformer,
    delay_of_a_long_cable,
    drift_of_a_soldered_joint,
    outliers_of_class_a,
    step_in_a_burst,
)

SET = {name: form for name, form in FORMS.items() if form.series == 12}
NULLS = [name for name, form in SET.items() if NONE in form.truth]
DECLARED = "twelfth_scatter_declared_in_knots"


def world_of(name: str, *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    speed = direction * rig.belt_velocity
    return World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def test_the_set_is_as_wide_as_asked_for():
    unknown = [form for form in SET.values() if UNKNOWN in form.truth]
    named = [form for form in SET.values() if not form.truth & {UNKNOWN, NONE}]
    assert (len(named), len(unknown), len(NULLS)) == (26, 8, 8)
    assert sorted(kind for form in named for kind in form.truth) == sorted(KINDS)
    assert all(form.right("one") == {UNKNOWN} for form in unknown)
    assert {form.rig for form in SET.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in SET.values())
    assert all(name.startswith("twelfth_") for name in SET)


def test_each_form_has_a_source_that_no_earlier_form_of_its_kind_has():
    for form in SET.values():
        assert re.search(r"\b(1[789]|20)\d\d\b", form.source), form.name
        others = {other.source for other in FORMS.values() if other.series < 12 and other.truth & form.truth}
        assert form.name == DECLARED or form.source not in others


def test_the_eleventh_set_entered_before():
    series = [form.series for form in FORMS.values()]
    first = series.index(12)
    assert series[first : first + len(SET)] == [12] * len(SET)
    assert series[first - 1] == 11


def test_half_of_the_rigs_are_read_worse_than_those_of_the_eleventh_set_and_half_better():
    samples, slips = (
        np.array([quality(rig) for rig in RIGS_OF_THE_SET.values()])
        for quality in (lambda rig: rig.rate * 2 * np.pi / rig.pulsation, lambda rig: rig.slip_length / rig.noise)
    )
    worse = (samples < 67.0) & (slips < 820.0)
    better = (samples > 73.0) & (slips > 850.0)
    assert (worse.sum(), better.sum()) == (3, 3)
    assert 40.0 < samples.min() < samples.max() < 120.0
    assert 300.0 < slips.min() < slips.max() < 1500.0


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    series_checks.assert_preconditions(SET[name])


@pytest.mark.parametrize("name", SET)
def test_a_form_moves_what_is_shown_by_tens_of_floors_and_a_null_by_nothing(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    if name in NULLS:
        assert max(sizes.values()) == 0.0
    else:
        assert max(sizes.values()) > 20.0
        assert 10.0 < max(half.values()) < 0.9 * max(sizes.values())


@pytest.mark.parametrize("name", SET)
def test_it_is_stick_slip_in_each_run_of_the_last_design(name):
    series_checks.assert_stick_slip(SET[name], 121, share=series_checks.SHARE, sticks=4)


@pytest.mark.parametrize("name", [name for name in SET if name not in NULLS])
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.1)


def test_the_same_seed_makes_the_same_record_and_another_one_does_not():
    series_checks.assert_repeatable(SET["twelfth_scatter_of_the_better_spot"])


@pytest.mark.parametrize("name", [name for name in NULLS if name != DECLARED])
def test_a_null_moves_as_the_stated_law_says_and_is_off_by_no_more_than_is_stated(name):
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 3, share=0.05)[0]
    true, world = run.world.rig, run.world
    plain = World(true, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    error = run.reading - run.motion.position
    assert np.std(error) < 2.0 * rig.noise
    assert abs(np.mean(error)) < 0.5 * rig.noise
    assert np.any(error) or "at_limits" in form.options
    for key, sd in series_checks.stated(form).items():
        off = abs(getattr(true, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(2.0) if "at_limits" in form.options else off <= 1.5 + 1e-12


def draws_of(world: World, count: int) -> np.ndarray:
    drawn = []
    for _ in range(count):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(at(t=0.0)) - world.rig.mu_s, world.mu_k(at(t=0.0)) - world.rig.mu_k])
    return np.array(drawn)


def test_declared_scatter_is_as_large_as_declared_and_straight_between_knots():
    assert SET[DECLARED].options["declared_sigma"] == 0.004
    world = world_of("lift", cycles=60.0)
    SET[DECLARED].apply(world, 1.0)
    knots = np.arange(0.0, world.duration, 0.01)
    drawn = world.mu_s(at(t=knots)) - world.rig.mu_s
    assert np.std(drawn) == pytest.approx(0.004, rel=0.08)  # 4 standard deviations of 1/70
    assert world.mu_s(at(t=knots[:-1] + 0.005)) == pytest.approx(world.rig.mu_s + 0.5 * (drawn[1:] + drawn[:-1]))


def test_the_better_spot_leans_and_keeps_the_means():
    world = world_of("ice")
    scatter_of_the_better_spot(world, 1.0)
    z = draws_of(world, 20000) / world.nominal.gap / [0.13, 0.06]
    assert z.mean(0) == pytest.approx([0.0, 0.0], abs=0.025)
    assert z.std(0) == pytest.approx([np.sqrt(1.0 - 1.0 / np.pi)] * 2, rel=0.03)  # the greater of two normal numbers
    assert np.mean((z / z.std(0)) ** 3, axis=0) == pytest.approx([0.137, 0.137], abs=0.07)
    assert abs(np.corrcoef(z.T)[0, 1]) < 0.03


def test_a_long_memory_falls_as_a_power():
    world = world_of("shoe")
    correlated_over_long(world, 1.0)
    level = draws_of(world, 20000)[:, 0] / world.rig.mu_s / 0.05
    assert level.std() == pytest.approx(1.0, abs=0.1)
    memory = [np.mean(level[lag:] * level[: level.size - lag]) / np.mean(level**2) for lag in (1, 5, 40)]
    assert memory == pytest.approx([0.35 / 0.65, 0.32, 0.17], abs=0.06)  # d/(1 - d), then as lag^(2 d - 1)


def test_speed_weakens_up_to_lift_off_and_a_suspension_thins():
    world = world_of("sheet")
    top, gap = world.nominal.peak_speed, world.nominal.gap
    weakening_of_even_heights(world, 1.0)
    more = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap for u in (0.0, 0.4, 0.8, 1.2)]
    assert more == pytest.approx([0.55, 0.55 * 0.5**2.5, 0.0, 0.0])
    viscous_of_a_suspension(world, 1.0)
    drag = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap for u in (0.0, 1e-6, 0.5, 1.0)]
    assert drag[::3] == pytest.approx([0.0, 0.4])
    assert 3.8 < drag[1] / 1e-6 / 0.4 < 4.05
    assert 0.5 * 0.4 < drag[2] < 0.6 * 0.4


def test_a_lag_falls_steeply_and_ends():
    world = world_of("lift")
    lag_of_a_steep_power(world, 1.0)
    end = 0.45 * world.nominal.slip_length
    left = [(world.mu_k(at(slip=u * end, slip_time=0.0)) - world.rig.mu_k) / world.rig.gap for u in (0.0, 0.107, 1.0, 2.0)]
    assert left == pytest.approx([0.8, 0.4, 0.0, 0.0], abs=2e-3)


def test_a_lining_drains_as_the_root_of_time_and_then_wholly():
    world = world_of("sheet")
    dwell_drains(world, 1.0)
    dwell = world.nominal.period * np.array([0.0, 0.12, 0.48, 1.0, 1e4])
    drained = (world.mu_s(at(dwell=dwell)) - world.rig.mu_s) / world.nominal.gap / 0.8
    assert drained[3] == pytest.approx(0.0)
    assert drained - drained[0] == pytest.approx([0.0, 0.357, 0.697, 0.896, 1.0], abs=0.012)  # Terzaghi's table
    assert world.mu_s(at(dwell=0.0)) > world.rig.mu_k


def test_fibres_rub_more_against_their_scales_and_less_so_under_load():
    more = []
    for direction, load in ((1.0, 1.0), (-1.0, 1.0), (-1.0, 8.0)):
        world = world_of("ice", direction=direction, load=load)
        asymmetry_of_loaded_fibres(world, 1.0)
        more.append([world.mu_s(None) / world.rig.mu_s - 1.0, world.mu_k(at(direction=direction)) / world.rig.mu_k - 1.0])
    assert np.ravel(more) == pytest.approx([0.0, 0.0, 0.12, 0.12, 0.06, 0.06], abs=1e-12)


def test_a_rough_joint_loses_its_angle_by_the_decade():
    for load, lost in ((0.1, -7.0), (1.0, 0.0), (10.0, 7.0)):
        world = world_of("jewel", load=load)
        load_of_a_rough_joint(world, 1.0)
        for mu, base in ((world.mu_s(None), world.rig.mu_s), (world.mu_k(None), world.rig.mu_k)):
            assert np.rad2deg(np.arctan(base) - np.arctan(mu)) == pytest.approx(lost, abs=1e-9)


def test_a_contact_and_its_inverse():
    world = world_of("shoe")
    presliding_error_function(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, abs=1e-12)
    length = world.contact_deflection(1.0) / world.nominal.slip_length
    assert 0.1 < length < 0.15
    assert world.contact(-1e-9 * length, 0.0, 3.0) < 0.0


def test_a_fractal_belt_has_shares_in_a_geometric_row():
    world = world_of("bracket")
    position_of_a_fractal_belt(world, 1.0)
    longest = 9.0 * world.nominal.slip_length
    x = np.linspace(0.0, 32.0 * longest, 2**14, endpoint=False)  # all six lengths fit in
    share = world.mu_s(at(travel=x, x=0.0)) / world.rig.mu_s - 1.0
    lines = 2.0 * np.abs(np.fft.rfft(share)) / x.size
    assert lines[[32, 48, 72, 108, 162, 243]] == pytest.approx(0.045 * 1.5 ** (-0.5 * np.arange(6)), rel=1e-6)
    assert lines[0] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(world.mu_k(at(travel=x, x=0.0)), world.rig.mu_k * (1.0 + share))


def test_drifts_go_on_ever_slower():
    world = world_of("jewel")
    drift_of_an_oxide(world, 1.0)
    grown = [world.mu_s(at(t=n * world.nominal.period)) / world.rig.mu_s - 1.0 for n in (0.0, 15.0, 40.0, 60.0)]
    assert grown == pytest.approx([0.0, 0.055, 0.11, 0.055 * (np.sqrt(13.0) - 1.0)])
    distance_of_a_worn_tip(world, 1.0)
    worn = [world.mu_k(at(slid=n * world.nominal.slip_length)) / world.rig.mu_k - 1.0 for n in (0.0, 3.75, 60.0)]
    assert worn == pytest.approx([0.0, 0.07, 0.14])


def test_a_wax_softens_in_two_steps():
    world = world_of("lift", cycles=60.0)
    temperature_of_a_rotator_phase(world, 1.0)
    t = np.linspace(0.0, world.duration, 4001)
    celsius, left = world.temperature(t), world.mu_s(at(t=t)) / world.rig.mu_s
    for low, high, level in ((0.0, 20.2, 1.0), (22.4, 24.4, 0.94), (26.8, 40.0, 0.87)):
        inside = (celsius > low) & (celsius < high)
        assert inside.sum() > 100
        assert left[inside] == pytest.approx(level, abs=2e-3)


def test_ripples_and_tones_have_no_mean_and_the_belt_never_turns_round():
    world = world_of("bracket", cycles=60.0)
    load_of_a_ball_in_its_zone(world, 1.0)
    belt_of_a_geneva_wheel(world, 1.0)
    force_of_a_six_step_inverter(world, 1.0)
    strength = world.nominal.gap * world.nominal.normal_force
    for turn, factor, size in (
        (4.9, lambda t: world.normal(at(t=t)) / world.normal_force, 0.16),
        (1.63, lambda t: world.belt(t) / world.belt_velocity, 0.4 * (1.0 + np.sqrt(2.0))),  # a wheel of four slots
        (1.41, lambda t: 1.0 + world.load(at(t=t)) / strength, 0.4),
    ):
        t = np.linspace(0.0, 5.0 * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=2e-3)
        assert factor(t).min() > 0.45
        assert np.ptp(factor(t)) == pytest.approx(size, rel=5e-3)


def test_a_six_step_inverter_has_neither_even_nor_third_harmonics():
    world = world_of("bracket")
    force_of_a_six_step_inverter(world, 1.0)
    turn = 1.41 * world.nominal.period
    lines = np.abs(np.fft.rfft(world.load(at(t=turn * np.arange(3000) / 3000))))
    assert lines[5] / lines[1] == pytest.approx(0.2, abs=0.01)
    assert lines[[2, 3, 4, 6, 8, 9]] / lines[1] == pytest.approx(0.0, abs=2e-3)


def test_foam_yields_in_the_middle_and_keeps_the_reach_and_drag_falls_in_its_crisis():
    world = world_of("lift")
    stiffness_of_foam(world, 1.0)
    u, reach, k = np.array([0.25, 0.45, 1.0]), world.nominal.reach, world.rig.stiffness
    assert world.spring(at(x=reach)) == pytest.approx(k * reach)
    assert world.spring(at(x=-reach)) == pytest.approx(-k * reach)
    soft = (world.spring(at(x=(u + 1e-6) * reach)) - world.spring(at(x=u * reach))) / (1e-6 * reach * k)
    assert soft == pytest.approx(0.35 / np.sqrt(u) + 1.2 * u**3, rel=1e-4)
    assert soft[1] < soft[0] < soft[2]
    drag_with_a_crisis(world, 1.0)
    top, force = world.nominal.peak_speed, 0.6 * world.nominal.gap * world.nominal.normal_force
    drag = [(world.damping(at(v=u * top)) - world.rig.damping * u * top) / force for u in (-0.4, 0.4, 0.75, 1.1)]
    assert drag == pytest.approx([-0.16, 0.16, 0.75 * 0.75**2, 0.5 * 1.1**2], rel=1e-3)


def test_play_is_slack_and_its_oil_takes_energy_where_a_wall_comes_closer():
    world = world_of("ice")
    backlash_with_oil(world, 1.0)
    slip = world.nominal.slip_length
    x = world.rig.reach - 0.55 * slip + 0.11 * slip * np.array([-1.0, 0.0, 0.02, 0.5, 0.98, 1.0, 2.0])
    held = world.spring(at(x=x, v=0.0))
    assert np.diff(held) / np.diff(x) / world.rig.stiffness == pytest.approx([1.0, 0, 0, 0, 0, 1.0], abs=1e-9)
    back, forth = world.spring(at(x=x, v=-1.0)) - held, world.spring(at(x=x, v=1.0)) - held
    assert back[[0, 1, 6]] == pytest.approx(0.0, abs=1e-9)
    assert back[2] < 5.0 * back[3] < 5.0 * back[4] < 0.0
    assert forth[2:5] == pytest.approx(-back[4:1:-1], rel=1e-6)


def test_a_floating_magnet_stiffens_alike_to_both_sides():
    world = world_of("shoe")
    mode_of_a_floating_magnet(world, 1.0)
    room, mass, p = 0.9 * world.nominal.slip_length, 0.15 * world.rig.mass, 1.6 * world.nominal.pulsation
    push = np.array([world.load(at(q=(y * room, 0.0))) for y in (-0.5, 1e-4, 0.25, 0.5)]) / (mass * p * p * room)
    assert push[1] == pytest.approx(1e-4, rel=1e-6)
    assert push[3] == -push[0]
    assert push[3] == pytest.approx((16.0 - 1.5**-4) / 8.0)
    assert push[2] > 0.3
    assert world.rates(at(q=(0.0, 0.0), a=3.0)) == pytest.approx((0.0, -3.0))


def test_drops_push_one_way_and_the_small_ones_far_less_than_the_large_ones():
    world = world_of("bracket", cycles=200.0)
    impacts_of_drops(world, 1.0)
    t = np.linspace(0.0, world.duration, 400001)
    force = world.load(at(t=t)) / (world.nominal.gap * world.nominal.normal_force)
    assert force.max() <= 0.0
    assert -4.0 < force.min() < -0.35 * 1.6**3 * 0.95
    assert 0.9 < np.mean(force < -0.01 * 0.35) * world.duration * world.nominal.pulsation / 180.0 < 1.5  # 180 drops


def test_a_joint_creeps_and_a_scale_jumps_nine_times():
    world = world_of("lift", cycles=60.0)
    still = at(position=0.0)
    drift_of_a_soldered_joint(world, 1.0)
    crept = world.sensor(world.duration * np.array([0.0, 0.125, 1.0]), still, None) / world.nominal.slip_length
    assert crept == pytest.approx(0.24 * np.array([0.0, 0.375 + 0.03125, 1.0]))
    step_in_a_burst(world, 1.0)
    t = np.linspace(0.0, world.duration, 100001)
    shown = world.sensor(t, still, None) / world.nominal.slip_length
    jumps = np.diff(shown)
    assert (shown[0], shown[-1]) == pytest.approx((0.0, 0.14))
    assert jumps.min() == 0.0
    assert 7 <= np.count_nonzero(jumps) <= 9
    assert np.ptp(t[1:][jumps > 0.0]) < 1.5 * world.nominal.period


def test_a_transformer_is_true_below_and_level_above():
    world = world_of("jewel")
    clipping_of_a_transformer(world, 1.0)
    begins, slip = world.rig.reach - 0.45 * world.rig.slip_length, world.rig.slip_length
    x = begins + slip * np.array([-0.5, 0.0, 0.1, 0.2 * np.pi / 2, 0.45])
    shown = (world.sensor(None, at(position=x), None) - begins) / slip
    assert shown == pytest.approx([-0.5, 0.0, 0.2 * np.sin(0.5), 0.2, 0.2])


def test_outliers_are_few_and_of_class_a():
    world = world_of("lift")
    outliers_of_class_a(world, 1.0)
    off = world.sensor(np.arange(200000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length
    assert np.mean(off != 0.0) == pytest.approx(1.0 - np.exp(-0.025), rel=0.06)
    assert np.mean(off**2) == pytest.approx(0.025 * 0.36**2, rel=0.1)


def test_a_cable_is_late_by_half_its_time_and_answers_a_step_by_thomsons_curve():
    world = world_of("ice")
    delay_of_a_long_cable(world, 1.0)
    cable = 1.1 / world.nominal.pulsation
    t = np.arange(0.0, 20.0 * cable, cable / 400)
    late = world.sensor(t, at(position=3.0 + 2.0 * t), None)
    assert late[-1] == pytest.approx(3.0 + 2.0 * (t[-1] - 0.5 * cable), abs=1e-3 * cable)
    assert late[0] == pytest.approx(3.0, abs=0.01 * cable)
    step = world.sensor(t, at(position=(t > 0.0).astype(float)), None)
    odd = np.arange(1, 60, 2)
    for u in (0.2, 0.5, 1.0):
        exact = 1.0 - 4.0 / np.pi * np.sum((-1.0) ** (odd // 2) / odd * np.exp(-((odd * np.pi) ** 2) * u / 4.0))
        assert np.interp(u * cable, t, step) == pytest.approx(exact, abs=0.01)


def steady(world: World):
    return simulate(world, np.arange(0.0, world.duration, 0.1 / world.rig.rate))


def slip_of(world: World) -> tuple[float, float, float, float]:
    """Return where the third slip begins, its length, its duration, and the share of it at which it is fastest."""
    motion = steady(world)
    (t0, x0), (t1, x1) = motion.breaks[2], motion.sticks[3]
    inside = (motion.time > t0) & (motion.time < t1)
    fastest = motion.time[inside][np.argmin(motion.velocity[inside])]
    return float(x0), float(x0 - x1), float(t1 - t0), float((fastest - t0) / (t1 - t0))


def test_a_governor_and_a_felt_take_way_and_leave_break_away():
    plain, governor, felt = (world_of("lift", cycles=6.0) for _ in range(3))
    governor_trips_in_each_slip(governor, 1.0)
    felt_rubs_along_a_part(felt, 1.0)
    usual, tripped, rubbed = (slip_of(world) for world in (plain, governor, felt))
    assert [tripped[0], rubbed[0]] == pytest.approx([usual[0]] * 2, rel=1e-4)
    assert 0.6 < tripped[1] / usual[1] < 0.9
    assert 0.85 < rubbed[1] / usual[1] < 0.97
    assert tripped[3] < usual[3] - 0.03  # it is fastest early
    x = felt.rig.reach - felt.rig.slip_length * np.array([0.0, 0.65, 1.0])
    force = felt.load(at(x=x, v=-1.0)) / felt.nominal.gap / felt.nominal.normal_force
    assert force == pytest.approx([0.0, 0.3, 0.0], abs=1e-4)


def test_a_box_that_creeps_on_comes_late_by_the_logarithm():
    plain, creeping = (world_of("ice", cycles=6.0) for _ in range(2))
    box_creeps_on_after_each_slip(creeping, 1.0)
    usual, moved = steady(plain), steady(creeping)
    assert moved.breaks[2, 1] == pytest.approx(usual.breaks[2, 1], rel=1e-3)
    (t0, x0), (t1, x1) = moved.sticks[3], moved.breaks[3]
    late = creeping.belt_velocity * (t1 - t0) - (x1 - x0)
    tau = 0.02 * creeping.nominal.period
    assert late / creeping.nominal.slip_length == pytest.approx(0.016 * np.log1p((t1 - t0) / tau), rel=1e-3)
    assert np.diff(moved.breaks[2:, 0]).mean() > np.diff(usual.breaks[2:, 0]).mean()
    assert moved.velocity[moved.time > t0][0] > 0.0


def test_what_a_logger_keeps():
    world = world_of("jewel")
    t = np.arange(6400) / world.rig.rate
    x = world.rig.slip_length * np.random.default_rng(0).uniform(size=6400).cumsum() / 100.0
    logger_compresses_blocks(world, 1.0)
    step = 0.25 * world.nominal.slip_length
    error = (world.sensor(t, at(position=x), None) - x).reshape(-1, 64)
    assert np.sum(error**2, axis=1).max() <= 64 * (step / 2) ** 2  # half a step for each cosine
    assert 0.01 < np.std(error) / world.nominal.slip_length < 0.1
    logger_keeps_the_extremes(world, 1.0)
    for rising in (1.0, -1.0):
        shown = world.sensor(t[:24], at(position=rising * np.arange(24.0)), None)
        assert list(shown[::6]) == ([0, 11, 12, 23] if rising > 0 else [-11, 0, -23, -12])
        assert np.all(shown.reshape(-1, 6) == shown[::6, None])


def test_what_leaks_into_a_reading():
    world = world_of("ice", cycles=60.0)
    t = np.arange(0.0, world.duration, 1.0 / world.rig.rate)
    tape_prints_through(world, 1.0)
    shown = world.sensor(t, at(position=(t > 30.0 * world.nominal.period).astype(float)), None)
    levels = [np.interp(n * world.nominal.period, t, shown) for n in (29.5, 29.8, 30.2, 30.5)]
    assert levels == pytest.approx(np.array([0.0, 0.07, 1.07, 1.14]) / 1.14)
    channel_beside_leaks_in(world, 1.0)
    leak = world.sensor(t, at(position=0.0), None) / world.nominal.slip_length
    assert abs(leak.mean()) < 0.02
    assert 0.15 < np.ptp(leak) < 0.19 * 1.31
    drops = t[1:][np.diff(leak) < -0.05]
    assert np.diff(drops).mean() / world.nominal.period == pytest.approx(0.618, rel=0.08)
    assert np.diff(drops).std() > 0.1 * np.diff(drops).mean()


def test_a_pulled_clock_bends_ramps_and_keeps_their_ends():
    world = world_of("lift")
    clock_is_pulled_by_the_signal(world, 1.0)
    t = np.linspace(0.0, 1.0, 10001)
    off = (world.sensor(t, at(position=world.rig.slip_length * t), None) / world.rig.slip_length - t)[[0, 2500, 5000, 10000]]
    assert off == pytest.approx(0.15 * np.array([0.0, -0.09375, -0.125, 0.0]), abs=1e-4)
