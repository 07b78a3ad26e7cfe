"""The rigs and the known effects of the thirteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World

from .friction import (
    asymmetry_of_an_insects_pad,
    correlated_patches_of_film,
    distance_of_galling,
    drift_after_an_induction,
    dwell_of_bitumen,
    lag_of_a_trapezoid,
    load_up_to_the_shear_strength,
    position_of_chatter_marks,
    presliding_sine,
    scatter_of_crests,
    temperature_of_an_adsorbed_film,
    viscous_of_a_paint,
    weakening_of_ageing_asperities,
)
from .mechanism import (
    backlash_of_a_linkage,
    belt_of_a_gas_engine,
    drag_with_a_metering_pin,
    force_of_a_milling_cutter,
    impacts_of_a_water_hammer,
    load_of_a_lobed_roller,
    mode_of_a_heavy_spring,
    stiffness_of_a_strut,
)
from .rigs import RIGS_OF_THE_SET
from .sensor import (
    clipping_of_a_core,
    delay_of_a_running_median,
    drift_of_a_tank_that_runs_out,
    outliers_of_muons,
    step_with_aftershocks,
)

KNOWN = {name: form for name, form in FORMS.items() if form.series == 13 and not form.truth & {UNKNOWN, NONE}}


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
    assert all(name.startswith("thirteenth_") for name in KNOWN)


def test_each_form_has_a_source_that_no_earlier_form_of_its_kind_has():
    for form in KNOWN.values():
        assert re.search(r"\b(1[789]|20)\d\d\b", form.source), form.name
        assert form.source not in {other.source for other in FORMS.values() if other.series < 13 and other.truth & form.truth}


def test_the_twelfth_set_entered_before():
    series = [form.series for form in FORMS.values()]
    first = series.index(13)
    assert set(series[first:]) == {13}
    assert series[first - 1] == 12


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
    series_checks.assert_stick_slip(KNOWN[name], 131, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", KNOWN)
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)


@pytest.mark.parametrize("name", ["scatter_of_crests", "correlated_patches_of_film", "step_with_aftershocks"])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(KNOWN[f"thirteenth_{name}"])


def draws_of(world: World, count: int) -> np.ndarray:
    drawn = []
    for _ in range(count):
        world.on_stick(at(t=0.0))
        drawn.append([world.mu_s(at(t=0.0)) - world.rig.mu_s, world.mu_k(at(t=0.0)) - world.rig.mu_k])
    return np.array(drawn)


def test_ageing_asperities_weaken_and_a_paint_thins():
    world = world_of("die")
    top, gap = world.nominal.peak_speed, world.nominal.gap
    weakening_of_ageing_asperities(world, 1.0)
    more = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap for u in (0.0, 0.15, 0.15 * 8.0, 150.0)]
    assert more == pytest.approx([0.5, 0.5 * (1.0 - np.exp(-1.0)), 0.5 * (1.0 - np.exp(-0.25)), 0.005], abs=1e-4)
    viscous_of_a_paint(world, 1.0)
    drag = [(world.mu_k(at(w=u * top)) - world.rig.mu_k) / gap / 0.4 for u in (0.0, 1e-6, 0.25, 1.0)]
    assert drag == pytest.approx([0.0, 3.0e-6, 0.3125 + 0.125, 1.0], rel=1e-3)


def test_bitumen_spreads_at_once_and_then_on_and_on():
    world = world_of("cork")
    dwell_of_bitumen(world, 1.0)
    dwell = world.nominal.period * np.array([0.0, 0.4, 1.0, 10.0, 14.0])
    spread = (world.mu_s(at(dwell=dwell)) - world.rig.mu_s) / world.nominal.gap / 0.45
    assert spread[2] == pytest.approx(0.0)
    assert spread - spread[0] == pytest.approx([0.0, 0.632 + 0.1, 0.918 + 0.25, 3.5, 4.5], abs=1e-3)
    assert world.mu_s(at(dwell=0.0)) > world.rig.mu_k


def test_a_trapezoid_holds_and_falls_straight():
    world = world_of("mill")
    lag_of_a_trapezoid(world, 1.0)
    slip = world.nominal.slip_length * np.array([0.0, 0.06, 0.15, 0.24, 0.5])
    left = [(world.mu_k(at(slip=s, slip_time=0.0)) - world.rig.mu_k) / world.rig.gap for s in slip]
    assert left == pytest.approx([0.8, 0.8, 0.4, 0.0, 0.0])


def test_a_pad_holds_less_when_it_is_pushed():
    less = []
    for direction in (1.0, -1.0):
        world = world_of("beetle", direction=direction)
        asymmetry_of_an_insects_pad(world, 1.0)
        less.append([1.0 - world.mu_s(None) / world.rig.mu_s, 1.0 - world.mu_k(at(direction=direction)) / world.rig.mu_k])
    assert np.ravel(less) == pytest.approx([0.0, 0.0, 0.14, 0.08])


def test_friction_stops_at_the_shear_strength():
    force = []
    for load in (1e-3, 1.0, 2.0, 100.0, 200.0):
        world = world_of("die", load=load)
        load_up_to_the_shear_strength(world, 1.0)
        force.append(load * world.mu_s(None) / world.rig.mu_s)
        assert world.mu_k(None) / world.rig.mu_k == pytest.approx(world.mu_s(None) / world.rig.mu_s)
    assert force[1] == pytest.approx(1.0)
    assert 0.8 < force[2] / 2.0 < 0.87
    assert force[3] == pytest.approx(force[4])
    assert force[0] / 1e-3 == pytest.approx(0.55 * force[3], rel=1e-3)  # Amontons


def test_a_contact_and_its_inverse():
    world = world_of("seal")
    presliding_sine(world, 1.0)
    assert world.contact
    assert world.contact_deflection
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, abs=1e-12)
    length = world.contact_deflection(1.0) / world.nominal.slip_length
    assert 0.1 < length < 0.13
    stiffness = np.diff([world.contact(u * world.nominal.slip_length, 0.0, 3.0) for u in (0.0, 0.001, 0.129, 0.13)])
    assert stiffness[2] < 0.02 * stiffness[0]


def test_chatter_marks_swell_and_fade():
    world = world_of("beetle")
    position_of_chatter_marks(world, 1.0)
    turn = 17.0 * world.nominal.slip_length
    x = np.linspace(0.0, turn, 1200, endpoint=False)
    share = world.mu_s(at(travel=x, x=0.0)) / world.rig.mu_s - 1.0
    lines = 2.0 * np.abs(np.fft.rfft(share)) / x.size
    assert lines[[0, 1, 5, 6, 7, 8]] == pytest.approx([0.0, 0.0, 0.0225, 0.045, 0.0225, 0.0], abs=1e-9)
    np.testing.assert_allclose(world.mu_k(at(travel=x + turn, x=0.0)), world.rig.mu_k * (1.0 + share))


def test_an_oil_lasts_a_while_and_galling_feeds_itself():
    world = world_of("mill")
    drift_after_an_induction(world, 1.0)
    grown = [world.mu_s(at(t=n * world.nominal.period)) / world.rig.mu_s - 1.0 for n in (0.0, 7.0, 22.0, 1e3)]
    assert grown == pytest.approx([0.0, 0.0, 0.14 * (1.0 - np.exp(-1.0)), 0.14])
    distance_of_galling(world, 1.0)
    picked = [world.mu_k(at(slid=n * world.nominal.slip_length)) / world.rig.mu_k - 1.0 for n in (0.0, 24.0, 60.0)]
    assert picked == pytest.approx([0.0, 0.0492, 0.1718], abs=1e-4)


def test_an_adsorbed_film_leaves_as_it_warms():
    world = world_of("die", cycles=60.0)
    temperature_of_an_adsorbed_film(world, 1.0)
    t = np.linspace(0.0, world.duration, 4001)
    celsius, more = world.temperature(t), world.mu_s(at(t=t)) / world.rig.mu_s - 1.0
    for degrees, share in ((20.5, 0.041), (22.0, 0.137), (24.3, 0.632), (26.7, 1.0)):
        assert np.interp(degrees, np.sort(celsius), more[np.argsort(celsius)]) / 0.14 == pytest.approx(share, abs=4e-3)


def test_crests_lean_upwards_and_keep_the_means():
    world = world_of("fork")
    scatter_of_crests(world, 1.0)
    z = draws_of(world, 20000) / world.nominal.gap / [0.13, 0.05]
    assert z.mean(0) == pytest.approx([0.0, 0.0], abs=0.025)
    assert z.std(0) == pytest.approx([1.0, 1.0], rel=0.03)
    assert np.mean(z[:, 0] ** 3) == pytest.approx(0.631, abs=0.1)  # the skewness of Rayleigh's distribution
    np.testing.assert_allclose(z[:, 0], z[:, 1], atol=1e-9)
    assert abs(np.corrcoef(z[1:, 0], z[:-1, 0])[0, 1]) < 0.03


def test_patches_turn_over_one_by_one_and_are_forgotten_exponentially():
    world = world_of("cork")
    correlated_patches_of_film(world, 1.0)
    level = draws_of(world, 20000)[:, 0] / world.rig.mu_s / 0.05
    assert level.std() == pytest.approx(1.0, abs=0.08)
    assert np.abs(np.diff(level)) == pytest.approx(1.0 / np.sqrt(3.0))
    memory = [np.mean(level[lag:] * level[: level.size - lag]) / np.mean(level**2) for lag in (1, 6, 20)]
    assert memory == pytest.approx([5 / 6, (5 / 6) ** 6, (5 / 6) ** 20], abs=0.06)


def test_ripples_and_tones_have_no_mean_and_the_belt_never_turns_round():
    world = world_of("seal", cycles=60.0)
    load_of_a_lobed_roller(world, 1.0)
    belt_of_a_gas_engine(world, 1.0)
    force_of_a_milling_cutter(world, 1.0)
    strength = world.nominal.gap * world.nominal.normal_force
    for turn, turns, factor, size in (
        (14.0, 4, lambda t: world.normal(at(t=t)) / world.normal_force, 0.195),
        (2.3, 20, lambda t: world.belt(t) / world.belt_velocity, 0.4),
        (1.27, 40, lambda t: 1.0 + world.load(at(t=t)) / strength, 0.4),
    ):
        t = np.linspace(0.0, turns * turn * world.nominal.period, 200001)
        assert np.mean(factor(t)) == pytest.approx(1.0, abs=2e-3)
        assert factor(t).min() > 0.7
        assert np.ptp(factor(t)) == pytest.approx(size, rel=0.03)


def test_a_roller_has_three_lobes_and_five():
    world = world_of("seal")
    load_of_a_lobed_roller(world, 1.0)
    t = 14.0 * world.nominal.period * np.arange(400) / 400
    lines = np.abs(np.fft.rfft(world.normal(at(t=t)) / world.normal_force)) / 200
    assert lines[1:7] == pytest.approx([0.0, 0.0, 0.06, 0.0, 0.045, 0.0], abs=1e-9)


def test_an_engine_is_driven_in_one_stroke_of_four():
    world = world_of("seal", cycles=10.0)
    belt_of_a_gas_engine(world, 1.0)
    t = np.linspace(0.0, 2.3 * world.nominal.period, 4000, endpoint=False)
    rate = world.belt_acceleration(t)
    assert 0.2 < np.mean(rate > 0.0) < 0.25
    assert rate.max() / -rate.min() == pytest.approx(2.16, abs=0.03)  # (1 - 0.111)/(0.3 + 0.111)


def test_chips_thicken_as_a_sine_and_end():
    world = world_of("mill")
    force_of_a_milling_cutter(world, 1.0)
    u = np.linspace(0.0, 1.0, 4001)[:-1]
    force = world.load(at(t=1.27 * world.nominal.period * (u + 0.6)))
    shape = (force - force.min()) / (0.4 * world.nominal.gap * world.nominal.normal_force)
    inside = u < 0.61
    np.testing.assert_allclose(shape[inside], np.sin(np.pi * u[inside]), atol=2e-3)
    assert shape[u > 0.635] == pytest.approx(0.0, abs=1e-9)


def test_a_strut_yields_beyond_the_middle_of_a_slip_and_keeps_the_reach():
    world = world_of("beetle")
    stiffness_of_a_strut(world, 1.0)
    rig, reach = world.rig, world.nominal.reach
    u = np.array([0.2, 0.9, 1.0])
    assert world.spring(at(x=0.0)) == 0.0
    assert world.spring(at(x=reach)) == pytest.approx(rig.stiffness * reach)
    assert world.spring(at(x=-reach)) == pytest.approx(-rig.stiffness * reach)
    soft = (world.spring(at(x=(u + 1e-6) * reach)) - world.spring(at(x=u * reach))) / (1e-6 * reach * rig.stiffness)
    full = 1.0 - 0.6 * (1.0 - rig.mu_k / rig.mu_s)
    assert soft == pytest.approx(np.array([1.0, 0.4, 0.4]) / full, rel=5e-3)


def test_a_pin_narrows_the_hole_along_the_stroke():
    world = world_of("fork")
    drag_with_a_metering_pin(world, 1.0)
    rig, top, slip, reach = world.rig, world.nominal.peak_speed, world.nominal.slip_length, world.nominal.reach
    force = 0.35 * world.nominal.gap * world.nominal.normal_force
    for x, pin in ((reach, 1.0), (reach - 0.5 * slip, 1.6), (reach - slip, 2.2), (reach + slip, 1.0)):
        drag = [(world.damping(at(x=x, v=u * top)) - rig.damping * u * top) / force for u in (-1.0, -0.5, 0.5)]
        assert drag == pytest.approx([-pin, -0.25 * pin, 0.25 * pin])


def test_three_joints_hang_slack_one_after_the_other():
    world = world_of("die")
    backlash_of_a_linkage(world, 1.0)
    x = world.rig.reach - np.linspace(1.0, 0.0, 20001) * world.rig.slip_length
    rate = np.diff(world.spring(at(x=x))) / np.diff(x) / world.rig.stiffness
    slack = rate < 0.5
    assert np.count_nonzero(np.diff(slack.astype(int)) == 1) == 3
    assert np.mean(slack) == pytest.approx(0.03 + 0.065 + 0.045, abs=1e-3)
    assert np.abs(rate[~slack] - 1.0).mean() < 1e-3


def test_a_heavy_spring_is_as_stiff_at_rest_and_surges():
    world = world_of("fork")
    mode_of_a_heavy_spring(world, 1.0)
    rig, mass = world.rig, 0.6 * world.rig.mass
    assert world.spring(at(x=1.0, q=(0.5, 0.0))) == pytest.approx(rig.stiffness)
    assert world.rates(at(x=1.0, q=(0.5, 0.0))) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert world.rates(at(x=0.0, q=(1.0, 0.0)))[1] == pytest.approx(-4.0 * rig.stiffness / mass)
    light = world_of("fork")
    mode_of_a_heavy_spring(light, 0.0)
    assert light.q0 == ()


def test_a_water_hammer_is_square_and_goes_to_and_fro():
    world = world_of("seal", cycles=3.0)
    impacts_of_a_water_hammer(world, 1.0)
    t = np.linspace(0.0, world.duration, 60001)
    force = world.load(at(t=t)) / (world.nominal.gap * world.nominal.normal_force)
    first = np.argmax(force > 0.4)
    length = 0.35 / world.nominal.pulsation
    levels = np.interp(t[first] + length * np.array([0.5, 1.5, 2.5, 3.5]), t, force)
    assert 0.5 < levels[0] < 1.5
    assert levels[1:] / levels[:-1] == pytest.approx([-0.6] * 3)


def test_hammers_come_by_chance_and_start_the_same_way():
    world = world_of("seal", cycles=300.0)
    impacts_of_a_water_hammer(world, 1.0)
    force = world.load(at(t=np.linspace(0.0, world.duration, 600001)))
    assert 170 < np.count_nonzero(np.diff((force > 0.0).astype(int)) == 1) / 3 < 250  # three pushes in each of 210


def test_a_tank_runs_out_and_grouting_cracks():
    world = world_of("mill", cycles=60.0)
    still = at(position=0.0)
    drift_of_a_tank_that_runs_out(world, 1.0)
    times = world.nominal.period * np.array([0.0, 22.5, 45.0, 60.0])
    assert world.sensor(times, still, None) / world.nominal.slip_length == pytest.approx([0.0, 0.165, 0.22, 0.22])
    step_with_aftershocks(world, 1.0)
    t = np.linspace(0.0, world.duration, 600001)
    shown = world.sensor(t, still, None) / world.nominal.slip_length
    jumps = np.flatnonzero(np.diff(shown))
    assert (shown[0], shown[-1]) == pytest.approx((0.0, 0.15))
    assert np.diff(shown)[jumps[0]] >= 0.55 * 0.15 - 1e-12
    assert 7 <= jumps.size <= 9
    assert t[jumps[-1]] - t[jumps[0]] < 12.0 * world.nominal.period
    assert t[jumps[jumps.size // 2]] - t[jumps[0]] < 0.5 * (t[jumps[-1]] - t[jumps[0]])  # ever more seldom


def test_a_core_is_true_below_and_bends_over_above():
    world = world_of("seal")
    clipping_of_a_core(world, 1.0)
    begins, slip = world.rig.reach - 0.4 * world.rig.slip_length, world.rig.slip_length
    x = begins + slip * np.array([-0.5, 0.0, 0.1, 0.4])
    shown = (world.sensor(None, at(position=x), None) - begins) / slip
    assert shown == pytest.approx([-0.5, 0.0, 0.05, 0.08])


def test_muons_are_few_and_push_upwards():
    world = world_of("fork")
    outliers_of_muons(world, 1.0)
    off = world.sensor(np.arange(200000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length
    hits = off[off != 0.0]
    assert hits.size / off.size == pytest.approx(0.01, rel=0.1)
    assert hits.min() > 0.05
    assert hits.mean() == pytest.approx(0.2 * (1.0 + 0.25 * 1.27), rel=0.03)  # Moyal's mean is 1.27
    assert hits.max() > 2.5 * hits.mean()


def test_a_median_is_late_by_half_its_length_and_drops_no_edge():
    world = world_of("beetle")
    delay_of_a_running_median(world, 1.0)
    t = np.arange(400) / world.rig.rate
    late = round(0.5 / world.nominal.pulsation * world.rig.rate)
    assert late == 8
    ramp = world.sensor(t, at(position=3.0 + t), None)
    np.testing.assert_allclose(ramp[2 * late :], 3.0 + t[late:-late])
    assert ramp[0] == 3.0
    step = world.sensor(t, at(position=(np.arange(400) >= 100).astype(float)), None)
    np.testing.assert_array_equal(step, (np.arange(400) >= 100 + late).astype(float))
    assert "velocity [m/s]" in world.columns
