"""The rigs and the known effects of the fourteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World

from .friction import (
    asymmetry_of_a_pressed_packing,
    correlated_below_scatter,
    distance_of_a_dulling_edge,
    drift_of_drying,
    dwell_from_nuclei,
    lag_of_a_sheared_bond,
    load_along_a_line,
    position_behind_a_weld,
    presliding_of_felt,
    scatter_of_trapezoids,
    temperature_of_a_cloud_point,
    viscous_of_a_drilling_fluid,
    weakening_of_melting,
)
from .mechanism import (
    backlash_of_a_rubbing_pin,
    belt_that_is_wobbled,
    drag_of_a_bending_vane,
    force_of_a_refrigerator,
    impacts_of_footsteps,
    load_of_a_rocker,
    mode_of_a_hanging_cable,
    stiffness_of_a_long_leaf,
)
from .rigs import RIGS_OF_THE_SET
from .sensor import (
    clipping_of_a_spot,
    delay_of_straight_weights,
    drift_that_swings_in,
    outliers_of_whole_turns,
    step_of_four_bolts,
)

KNOWN = {name: form for name, form in FORMS.items() if form.series == 14 and not form.truth & {UNKNOWN, NONE}}


def world_of(name: str, *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    speed = direction * rig.belt_velocity
    return World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def test_there_is_one_form_for_each_name():
    assert len(KNOWN) == 26
    assert sorted(kind for form in KNOWN.values() for kind in form.truth) == sorted(KINDS)
    assert {form.rig for form in KNOWN.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in KNOWN.values())
    assert all(name.startswith("fourteenth_") for name in KNOWN)


def test_each_form_has_a_source_that_no_earlier_form_of_its_kind_has():
    for form in KNOWN.values():
        assert re.search(r"\b(1[789]|20)\d\d\b", form.source), form.name
        assert form.source not in {other.source for other in FORMS.values() if other.series < 14 and other.truth & form.truth}


def test_the_thirteenth_set_entered_before():
    series = [form.series for form in FORMS.values()]
    first = series.index(14)
    assert set(series[first:]) == {14}
    assert series[first - 1] == 13


def test_half_of_the_rigs_are_read_worse_than_those_of_the_eleventh_set_and_half_better():
    samples, slips = (
        np.array([quality(rig) for rig in RIGS_OF_THE_SET.values()])
        for quality in (lambda rig: rig.rate * 2 * np.pi / rig.pulsation, lambda rig: rig.slip_length / rig.noise)
    )
    worse = (samples > 45.0) & (samples < 62.0) & (slips > 350.0) & (slips < 700.0)
    better = (samples > 75.0) & (samples < 110.0) & (slips > 850.0) & (slips < 1400.0)
    assert (worse.sum(), better.sum()) == (3, 3)


@pytest.mark.parametrize("name", KNOWN)
def test_records_keep_the_preconditions_of_the_page(name):
    series_checks.assert_preconditions(KNOWN[name])


@pytest.mark.parametrize("name", KNOWN)
def test_a_form_moves_what_is_shown_by_tens_of_floors(name):
    sizes, half = series_checks.sizes_moved(KNOWN[name])
    assert max(sizes.values()) > 20.0
    assert 10.0 < max(half.values()) < 0.9 * max(sizes.values())


@pytest.mark.parametrize("name", [name for name in KNOWN if len(KNOWN[name].designs) > 1])
def test_it_is_stick_slip_in_each_run_of_the_last_design(name):
    series_checks.assert_stick_slip(KNOWN[name], 141, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", KNOWN)
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)


@pytest.mark.parametrize("name", ["scatter_of_trapezoids", "correlated_below_scatter", "step_of_four_bolts"])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(KNOWN[f"fourteenth_{name}"])


def draws_of(world: World, count: int) -> np.ndarray:
    drawn = []
    for _ in range(count):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(at(t=0.0)) - world.rig.mu_s, world.mu_k(at(t=0.0)) - world.rig.mu_k])
    return np.array(drawn)


def test_melting_is_level_and_then_an_inverse_root():
    world = world_of("wire")
    weakening_of_melting(world, 1.0)
    top, gap = world.nominal.peak_speed, world.nominal.gap
    more = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap for u in (0.0, 0.04, 0.16, 1.0)]
    assert more == pytest.approx([0.5, 0.5, 0.25, 0.1])


def test_a_drilling_fluid_is_steep_at_first():
    world = world_of("strut")
    viscous_of_a_drilling_fluid(world, 1.0)
    top, gap = world.nominal.peak_speed, world.nominal.gap
    drag = np.array([(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap / 0.4 for u in (0.0, 1e-6, 0.999999, 1.0)])
    assert drag[[0, 3]] == pytest.approx([0.0, 1.0])
    assert drag[1] / (1.0 - drag[2]) == pytest.approx((1.03 / 0.03) ** 0.65, rel=1e-3)


def test_a_soap_grows_late_and_then_fast():
    world = world_of("hair")
    dwell_from_nuclei(world, 1.0)
    dwell = world.nominal.period * np.array([0.0, 1 / 3, 1.0, 2.0, 50.0])
    grown = (world.mu_s(at(dwell=dwell)) - world.rig.mu_s) / world.nominal.gap / 0.6
    assert grown[2] == 0.0
    assert grown - grown[0] == pytest.approx([0.0, 0.036, 0.632, 1.0, 1.0], abs=1e-3)
    assert world.mu_s(at(dwell=0.0)) > world.rig.mu_k


def test_a_bond_falls_fastest_after_its_distance():
    world = world_of("platen")
    lag_of_a_sheared_bond(world, 1.0)
    u = np.linspace(0.0, 8.0, 8001)
    slip = 0.08 * world.nominal.slip_length * u
    left = np.array([(world.mu_k(at(slip=s, slip_time=0.0)) - world.rig.mu_k) / world.rig.gap for s in slip])
    assert left[[0, 1000]] == pytest.approx([0.9, 1.8 / np.e])
    assert u[np.argmin(np.diff(left))] == pytest.approx(1.0, abs=0.01)
    assert left[1] == pytest.approx(0.9, abs=1e-6)
    assert left[-1] < 0.003


def test_a_packing_is_pressed_one_way_and_by_the_load():
    more = []
    for direction, load in ((1.0, 1.0), (1.0, 2.0), (-1.0, 1.0), (-1.0, 0.7)):
        world = world_of("strut", direction=direction, load=load)
        asymmetry_of_a_pressed_packing(world, 1.0)
        more.append([world.mu_s(None) / world.rig.mu_s - 1.0, world.mu_k(at(direction=direction)) / world.rig.mu_k - 1.0])
    np.testing.assert_allclose(more, [[0.0, 0.0], [0.0, 0.0], [0.1, 0.1], [0.07, 0.07]], atol=1e-12)


def test_a_lining_falls_along_a_line():
    share = []
    for load in (0.0, 0.5, 1.0, 2.0):
        world = world_of("tap", load=load)
        load_along_a_line(world, 1.0)
        share.append(world.mu_s(None) / world.rig.mu_s)
        assert world.mu_k(None) / world.rig.mu_k == pytest.approx(share[-1])
    assert share == pytest.approx([1.2, 1.1, 1.0, 0.8])


def test_felt_and_its_inverse():
    world = world_of("chair")
    presliding_of_felt(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, abs=1e-12)
    length = world.contact_deflection(1.0)
    assert length == pytest.approx(0.12 * world.nominal.slip_length)
    assert world.contact(-0.3 * length, 0.0, 3.0) == -world.contact(0.3 * length, 0.0, 3.0)
    stiffness = np.diff([world.contact(u * length, 0.0, 3.0) for u in (0.0, 1e-4, 1.0 - 1e-4, 1.0)])
    assert stiffness[2] / stiffness[0] == pytest.approx(np.cosh(2.3), rel=1e-3)


def test_corrugation_dies_away_and_comes_back_with_the_weld():
    world = world_of("chair")
    position_behind_a_weld(world, 1.0)
    turn = 15.0 * world.nominal.slip_length
    weld = -0.6 * turn
    x = weld + turn * (np.arange(5) / 5 + 0.05)  # the crests, nearly
    crests = world.mu_s(at(travel=x, x=0.0)) / world.rig.mu_s - 1.0
    assert crests[0] == pytest.approx(0.15 * np.exp(-0.2))
    assert crests[1:] / crests[:-1] == pytest.approx(np.exp([-0.8] * 4))
    np.testing.assert_allclose(world.mu_k(at(travel=x + turn, x=0.0)), world.rig.mu_k * (1.0 + crests))
    near = world.mu_s(at(travel=turn * (1.4 + np.array([-1e-9, 1e-9])), x=turn)) / world.rig.mu_s
    assert near == pytest.approx([1.0, 1.0], abs=1e-6)  # nothing jumps at the weld


def test_what_dries_goes_on_from_its_line():
    world = world_of("wire")
    drift_of_drying(world, 1.0)
    cycles = np.array([0.0, 5.5, 11.0, 20.0, 1e3])
    grown = world.mu_s(at(t=cycles * world.nominal.period)) / world.rig.mu_s - 1.0
    assert grown / 0.14 == pytest.approx([0.0, 0.275, 0.55, 0.55 + 0.45 * (1.0 - np.exp(-1.0)), 1.0])
    rates = np.diff(world.mu_k(at(t=world.nominal.period * np.array([10.999, 11.0, 11.001]))))
    assert rates[1] == pytest.approx(rates[0], rel=1e-3)


def test_an_edge_dulls_in_three_stages():
    world = world_of("strut")
    distance_of_a_dulling_edge(world, 1.0)
    slid = world.nominal.slip_length * np.array([0.0, 2.5, 14.0, 24.0, 34.0])
    worn = world.mu_k(at(slid=slid)) / world.rig.mu_k - 1.0
    assert worn == pytest.approx([0.0, 0.0331, 0.0582, 0.0894, 0.1204], abs=1e-4)
    rates = np.diff(world.mu_s(at(slid=world.nominal.slip_length * np.array([0.0, 0.1, 13.0, 13.1, 20.0, 20.1]))))[::2]
    assert rates[0] > 10.0 * rates[1]
    assert rates[2] > 4.0 * rates[1]


def test_wax_is_dissolved_above_the_cloud_point():
    world = world_of("hair", cycles=60.0)
    temperature_of_a_cloud_point(world, 1.0)
    t = np.linspace(0.0, world.duration, 4001)
    celsius, factor = world.temperature(t), world.mu_s(at(t=t)) / world.rig.mu_s
    assert factor[0] == pytest.approx(1.0)
    assert celsius.min() < 19.0
    level = factor[celsius > 25.0]
    assert level.size > 500
    assert level == pytest.approx(1.0 - 0.15 * (1.0 - np.exp(-5 / 3)))
    lost = np.interp(22.0, np.sort(celsius), factor[np.argsort(celsius)]) - level[0]
    assert lost / 0.15 == pytest.approx(1.0 - np.exp(-1.0), abs=4e-3)


def test_trapezoids_have_ends_and_keep_the_means():
    world = world_of("platen")
    scatter_of_trapezoids(world, 1.0)
    z = draws_of(world, 20000) / world.nominal.gap
    assert z.mean(0) == pytest.approx([0.0, 0.0], abs=0.003)
    assert z.std(0) == pytest.approx(np.hypot([0.19, 0.07], [0.08, 0.03]) / np.sqrt(3.0), rel=0.02)
    assert np.abs(z[:, 0]).max() < 0.27
    inner, outer = np.mean(np.abs(z[:, 0]) < 0.05), np.mean(np.abs(z[:, 0] - 0.05) < 0.05)
    assert inner == pytest.approx(outer, rel=0.06)  # level in the middle
    assert inner == pytest.approx(0.1 / 0.38, rel=0.06)
    assert np.corrcoef(z.T)[0, 1] == pytest.approx(0.19 * 0.07 / np.hypot(0.19, 0.08) / np.hypot(0.07, 0.03), abs=0.02)
    assert abs(np.corrcoef(z[1:, 0], z[:-1, 0])[0, 1]) < 0.03


def test_a_level_remembers_below_fresh_scatter():
    world = world_of("tap")
    correlated_below_scatter(world, 1.0)
    factor = draws_of(world, 40000)[:, 0] / world.rig.mu_s / 0.05
    assert factor.std() == pytest.approx(1.0, abs=0.04)
    memory = [np.mean(factor[lag:] * factor[: factor.size - lag]) / np.mean(factor**2) for lag in (1, 8, 60)]
    assert memory == pytest.approx([0.75 * 7 / 8, 0.75 * (7 / 8) ** 8, 0.0], abs=0.04)


def test_ripples_and_tones_have_no_mean_and_the_belt_never_turns_round():
    world = world_of("chair", cycles=60.0)
    load_of_a_rocker(world, 1.0)
    belt_that_is_wobbled(world, 1.0)
    force_of_a_refrigerator(world, 1.0)
    strength = world.nominal.gap * world.nominal.normal_force
    for turn, turns, factor, size in (
        (5.3, 11, lambda t: world.normal(at(t=t)) / world.normal_force, 0.18),
        (1.9, 31, lambda t: world.belt(t) / world.belt_velocity, 0.4),
        (13.0, 100, lambda t: 1.0 + world.load(at(t=t)) / strength, 0.48),
    ):
        t = np.linspace(0.0, turns * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=2e-3)
        assert factor(t).min() > 0.7
        assert np.ptp(factor(t)) == pytest.approx(size, rel=0.03)


def test_a_rocker_has_two_ends_and_is_slower_one_way():
    world = world_of("chair")
    load_of_a_rocker(world, 1.0)
    t = np.linspace(0.0, 5.3 * world.nominal.period, 4000, endpoint=False)
    rises = np.diff(world.normal(at(t=t))) > 0.0
    assert np.count_nonzero(np.diff(rises.astype(int))) == 2
    assert abs(np.mean(rises) - 0.5) > 0.05
    longest, shortest = (np.arccos((1.0 + reach**2 - 0.49) / (2.0 * reach)) for reach in (1.55, 0.85))
    assert max(np.mean(rises), np.mean(~rises)) == pytest.approx(0.5 + abs(longest - shortest) / (2 * np.pi), abs=2e-3)


def test_a_wobble_is_straight_and_jumps_where_it_turns():
    world = world_of("wire", cycles=10.0)
    belt_that_is_wobbled(world, 1.0)
    u = np.linspace(0.0, 1.0, 4001)[:-1]
    shape = (world.belt(1.9 * world.nominal.period * (u + 0.7)) / world.belt_velocity - 1.0) / 0.4
    rates = np.gradient(shape, u)
    assert np.median(rates[(u > 0.02) & (u < 0.46)]) == pytest.approx(0.85 / 0.48, rel=1e-3)
    assert np.median(rates[(u > 0.52) & (u < 0.96)]) == pytest.approx(-0.85 / 0.48, rel=1e-3)
    half = (u > 0.01) & (u < 0.47)
    np.testing.assert_allclose(np.interp(u[half] + 0.5, u, shape), -shape[half], atol=2e-3)
    turn = 1.9 * world.nominal.period
    assert world.travel(turn) == pytest.approx(world.belt_velocity * turn, rel=1e-3)


def test_a_refrigerator_is_on_for_eight_cycles_of_thirteen_and_keeps_its_phase():
    world = world_of("platen", cycles=60.0)
    force_of_a_refrigerator(world, 1.0)
    t = np.linspace(0.0, 52.0 * world.nominal.period, 200000, endpoint=False)
    force = world.load(at(t=t)) / (0.24 * world.nominal.gap * world.nominal.normal_force)
    on = np.abs(force) > 0.0
    assert np.mean(on) == pytest.approx(8 / 13 + 0.03, abs=2e-3)
    tone = np.cos(2 * np.pi * 1.27 * t / world.nominal.period + 0.8)
    assert np.mean(force * tone) / np.mean(tone**2) == pytest.approx(8 / 13, abs=5e-3)


def test_a_leaf_stiffens_as_bisshopp_and_drucker_have_it():
    world = world_of("tap")
    stiffness_of_a_long_leaf(world, 1.0)
    k, span = world.rig.stiffness, world.nominal.reach / 0.55
    load = np.array([world.spring(at(x=x * span)) for x in (0.0, 0.3017, 0.4935, -0.4935, 0.6033)]) / (k * span / 3.0)
    assert load == pytest.approx([0.0, 1.0, 2.0, -2.0, 3.0], rel=3e-3)  # their table
    assert world.spring(at(x=1e-3 * span)) == pytest.approx(1e-3 * k * span, rel=1e-3)


def test_a_vane_bends_from_the_square_to_four_thirds():
    world = world_of("strut")
    drag_of_a_bending_vane(world, 1.0)
    rig, top = world.rig, world.nominal.peak_speed
    force = 0.5 * world.nominal.gap * world.nominal.normal_force

    def drag(u: float) -> float:
        return (world.damping(at(v=u * top)) - rig.damping * u * top) / force

    assert [drag(-1.0), drag(0.0), drag(1.0)] == pytest.approx([-1.0, 0.0, 1.0])
    assert np.log2(drag(0.02) / drag(0.01)) == pytest.approx(2.0, abs=0.01)
    assert np.log2(drag(200.0) / drag(100.0)) == pytest.approx(4 / 3, abs=0.01)


def test_a_pin_rubs_in_its_clearance_alone():
    world = world_of("hair")
    backlash_of_a_rubbing_pin(world, 1.0)
    rig, slip = world.rig, world.rig.slip_length
    rub = world.nominal.gap * world.nominal.normal_force / 12.0
    x = rig.reach + slip * np.array([-0.6, -0.5, -0.45, -0.4, -0.1])
    fast = world.nominal.peak_speed
    there, back, rest = (np.array([world.spring(at(x=one, v=v)) for one in x]) for v in (fast, -fast, 0.0))
    assert there - back == pytest.approx([0.0, 0.0, 2.0 * rub, 0.0, 0.0], abs=1e-9 * rub)
    assert rest == pytest.approx(rig.stiffness * (x - slip * np.array([0.0, 0.0, 0.05, 0.1, 0.1])))


def test_a_cable_has_bessels_zeros_and_all_of_its_mass_in_the_end():
    world = world_of("platen")
    mode_of_a_hanging_cable(world, 1.0)
    p, mass = 0.8 * world.nominal.pulsation, 0.25 * world.rig.mass
    pulls = []
    for i, zero in enumerate((2.404826, 5.520078, 8.653728)):
        q = np.zeros(6)
        q[2 * i] = 1.0
        assert world.rates(at(q=q, a=0.0))[2 * i + 1] == pytest.approx(-((p * zero / 2.404826) ** 2))
        pulls.append(world.load(at(q=q)) / (p * zero / 2.404826) ** 2 / mass)
    assert pulls == pytest.approx([0.6917, 0.1313, 0.0534], abs=1e-4)  # the sum over all zeros is 1
    assert world.rates(at(q=np.zeros(6), a=2.0))[1::2] == pytest.approx((-2.0, -2.0, -2.0))
    light = world_of("platen")
    mode_of_a_hanging_cable(light, 0.0)
    assert light.q0 == ()


def test_a_step_has_two_humps_and_steps_come_by_chance():
    world = world_of("tap", cycles=300.0)
    impacts_of_footsteps(world, 1.0)
    t = np.linspace(0.0, world.duration, 900001)
    force = -world.load(at(t=t)) / (world.nominal.gap * world.nominal.normal_force)
    assert force.min() > -1e-9
    starts = np.flatnonzero(np.diff((force > 1e-6).astype(int)) == 1)
    assert 120 < starts.size < 220  # 180 people, of whom some meet
    alone = starts[:-1][np.diff(starts) > 3.0 * np.mean(force > 1e-6) * t.size / starts.size][0]
    length = 2.0 / world.nominal.pulsation
    heel, middle, ball = np.interp(t[alone] + length * np.array([0.25, 0.5, 0.75]), t, force)
    assert heel == pytest.approx(ball, rel=0.1)
    assert middle / heel == pytest.approx(0.65 / 0.954, rel=0.1)


def test_a_regulated_stand_overshoots_and_bolts_go_there_and_back():
    world = world_of("chair", cycles=60.0)
    still = at(position=0.0)
    drift_that_swings_in(world, 1.0)
    times = world.nominal.period * np.array([0.0, 8.5, 17.0, 1e3])
    share = world.sensor(times, still, None) / world.nominal.slip_length / 0.2
    assert share == pytest.approx([0.0, 1.0 + np.exp(-8.5 / 14.0), 1.0 - np.exp(-17.0 / 14.0), 1.0])
    assert world.sensor(times[1] / 850.0, still, None) < 1e-3 * world.nominal.slip_length  # it begins level
    step_of_four_bolts(world, 1.0)
    t = np.linspace(0.0, world.duration, 600001)
    shown = world.sensor(t, still, None) / world.nominal.slip_length
    jumps = np.flatnonzero(np.diff(shown))
    assert np.diff(shown)[jumps] == pytest.approx([0.22, -0.12, 0.08, -0.04])
    assert np.diff(t[jumps]) / world.nominal.period == pytest.approx([1.1] * 3, abs=1e-3)
    assert 0.25 < t[jumps[0]] / world.duration < 0.55


def test_a_spot_leaves_its_detector():
    world = world_of("strut")
    clipping_of_a_spot(world, 1.0)
    slip = world.rig.slip_length
    begins, wide = world.rig.reach - 0.5 * slip, 0.35 * slip
    x = begins + wide * np.array([-1.0, 0.0, 0.5, 1.0, 1.4])
    shown = (world.sensor(None, at(position=x), None) - begins) / wide
    assert shown == pytest.approx([-1.0, 0.0, 0.5 - 1.0 / (3.0 * np.pi), 0.5, 0.5], abs=1e-3)
    slope = np.diff(world.sensor(None, at(position=begins + wide * np.array([0.0, 1e-3, 0.4995, 0.5005])), None))[::2]
    assert slope / wide / 1e-3 == pytest.approx([1.0, 0.5], abs=1e-3)  # half of the spot counts by half


def test_turns_are_few_and_whole():
    world = world_of("platen")
    outliers_of_whole_turns(world, 1.0)
    off = world.sensor(np.arange(400000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length / 0.22
    hits = off[off != 0.0]
    assert hits.size / off.size == pytest.approx(0.008, rel=0.06)
    assert set(np.round(hits, 9)) == {-2.0, -1.0, 1.0, 2.0}
    assert np.mean(hits > 0.0) == pytest.approx(0.5, abs=0.03)
    assert np.mean(np.abs(hits) > 1.5) == pytest.approx(1 / 6, abs=0.03)


def test_straight_weights_are_late_by_a_third_of_their_length():
    world = world_of("tap")
    delay_of_straight_weights(world, 1.0)
    t = np.arange(400) / world.rig.rate
    length = 1.5 / world.nominal.pulsation
    ramp = world.sensor(t, at(position=3.0 + t), None)
    assert (3.0 + t - ramp)[-1] == pytest.approx(length / 3.0, rel=0.05)
    assert ramp[0] == pytest.approx(3.0)
    step = world.sensor(t, at(position=(np.arange(400) >= 100).astype(float)), None)
    gains = np.diff(step)[99 : 99 + int(length * world.rig.rate)]
    assert np.diff(gains) == pytest.approx(np.full(gains.size - 1, np.diff(gains).mean()))
    assert step[-1] == pytest.approx(1.0)
    assert "velocity [m/s]" in world.columns
