"""The rigs and the known effects of the fifteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World

from . import friction, mechanism, sensor
from .rigs import RIGS_OF_THE_SET

KNOWN = {name: form for name, form in FORMS.items() if form.series == 15 and not form.truth & {UNKNOWN, NONE}}


def world_of(
    name: str, apply, *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0, strength: float = 1.0
) -> World:
    rig = RIGS_OF_THE_SET[name]
    speed = direction * rig.belt_velocity
    world = World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))
    apply(world, strength)
    return world


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def draws_of(world: World, count: int) -> np.ndarray:
    """Return both coefficients less what is stated, slip by slip."""
    rows = [(world.on_stick(at(t=0.0)), world.mu_s(None), world.mu_k(None))[1:] for _ in range(count)]
    return np.array(rows) - (world.rig.mu_s, world.rig.mu_k)


def test_there_is_one_form_for_each_name():
    assert len(KNOWN) == 26
    assert sorted(kind for form in KNOWN.values() for kind in form.truth) == sorted(KINDS)
    assert {form.rig for form in KNOWN.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ and name.startswith("fifteenth_") for name, form in KNOWN.items())
    for form in KNOWN.values():
        assert re.search(r"\b(1[789]|20)\d\d\b", form.source), form.name
        assert form.source not in {other.source for other in FORMS.values() if other.series < 15 and other.truth & form.truth}
    own = {name.removeprefix("fifteenth_") for name in KNOWN}
    assert not own & {re.sub(r"^[a-z]+th_", "", name) for name, form in FORMS.items() if form.series < 15}


def test_half_of_the_rigs_are_read_worse_than_those_of_the_eleventh_set_and_half_better():
    reads = [(rig.rate * 2 * np.pi / rig.pulsation, rig.slip_length / rig.noise) for rig in RIGS_OF_THE_SET.values()]
    assert sum(50.0 < samples < 60.0 and 380.0 < slips < 640.0 for samples, slips in reads) == 3
    assert sum(80.0 < samples < 110.0 and 900.0 < slips < 1300.0 for samples, slips in reads) == 3


@pytest.mark.parametrize("name", KNOWN)
def test_a_form_keeps_the_preconditions_and_moves_what_is_shown_by_tens_of_floors(name):
    series_checks.assert_preconditions(KNOWN[name])
    sizes, half = series_checks.sizes_moved(KNOWN[name])
    assert max(sizes.values()) > 20.0
    assert 10.0 < max(half.values()) < 0.9 * max(sizes.values())


@pytest.mark.parametrize("name", KNOWN)
def test_it_is_stick_slip_no_strength_is_no_form_and_a_seed_makes_one_record(name):
    series_checks.assert_stick_slip(KNOWN[name], 151, share=0.21, sticks=2)  # five cycles
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)
    series_checks.assert_repeatable(KNOWN[name], KNOWN[name].designs[0])


def test_junctions_lose_the_area_of_two_circles():
    world = world_of("girder", friction.lag_of_round_junctions)
    slip, rig = 0.2 * world.nominal.slip_length, world.rig
    left = [(world.mu_k(at(slip=u * slip, slip_time=0.0)) - rig.mu_k) / rig.gap / 0.9 for u in (0.0, 0.3, 0.7, 1.0, 2.0)]
    lens = [quad(lambda y, d=u: 4.0 * max(np.sqrt(1.0 - y * y) - d, 0.0), 0.0, 1.0)[0] / np.pi for u in (0.3, 0.7)]
    assert left == pytest.approx([1.0, *lens, 0.0, 0.0], abs=1e-6)


def test_a_blunt_side_ploughs_one_way_as_the_root_of_the_load_and_rock_follows_two_lines():
    more = []
    for direction, load in ((1.0, 2.0), (-1.0, 1.0), (-1.0, 0.49)):
        world = world_of("points", friction.asymmetry_of_a_blunt_side, direction=direction, load=load)
        more.append([world.mu_s(None) / world.rig.mu_s - 1.0, world.mu_k(at(direction=direction)) / world.rig.mu_k - 1.0])
    np.testing.assert_allclose(more, [[0.0, 0.0], [0.055, 0.11], [0.0385, 0.077]], atol=1e-12)
    force = []
    for load in (0.4, 0.8, 1.0, 1.5, 2.0):
        world = world_of("organ", friction.load_of_two_lines, load=load)
        force.append(load * world.mu_k(None) / world.rig.mu_k)
    slopes = np.diff([0.0, *force]) / np.diff([0.0, 0.4, 0.8, 1.0, 1.5, 2.0])
    assert force[2] == pytest.approx(1.0)
    assert slopes / slopes[0] == pytest.approx([1.0, 1.0, 0.55, 0.55, 0.55])


def test_soil_and_its_inverse():
    world = world_of("points", friction.presliding_logarithmic)
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, abs=1e-9)
    length = 0.13 * world.nominal.slip_length
    force = np.array([world.contact(u * length, 0.0, 1.0) for u in np.linspace(0.0, 1.0, 1001)]) / 1.01
    assert np.all(np.diff(force) > 0.0)
    assert force[[1, -1]] == pytest.approx([0.006, 1.0], rel=0.1)
    assert force[-1] - force[-11] < 2e-4  # level where it lets go


def test_welds_come_back_with_each_turn_and_debris_flows_out():
    world = world_of("wedge", friction.position_of_two_welds)
    turn = 11.7 * world.nominal.slip_length
    depth = 1.0 - world.mu_s(at(travel=turn * np.array([0.18, 1.18, 0.61, 0.24, 0.12]), x=0.0)) / world.rig.mu_s
    assert depth == pytest.approx([0.16, 0.16, 0.10, 0.16 / np.e, 0.16 / np.e], abs=2e-3)
    world = world_of("fader", friction.distance_of_stored_debris)
    slid = 11.0 * world.nominal.slip_length * np.array([0.0, 0.5, 1.0, 1.8, 90.0])
    more = (world.mu_k(at(slid=slid)) / world.rig.mu_k - 1.0) / 0.125
    assert more == pytest.approx([0.0, 0.5, 1.0, 0.4 + 0.6 / np.e, 0.4])


def test_a_lining_takes_up_moisture_as_a_root_at_first_and_air_lays_on_water_as_it_cools():
    world = world_of("points", friction.drift_of_a_damp_lining)
    share = (world.mu_s(at(t=50.0 * world.nominal.period * np.array([0.0, 0.04, 0.16, 1.0]))) / world.rig.mu_s - 1.0) / 0.14
    assert share == pytest.approx(
        [*(np.array([0.0, 0.4, 0.8]) / np.sqrt(np.pi)), 1.0 - 8.0 / np.pi**2 * np.exp(-0.25 * np.pi**2)], abs=5e-3
    )
    world = world_of("sash", friction.temperature_of_moist_air, cycles=60.0)
    t = np.linspace(0.0, world.duration, 4001)
    factor = world.mu_k(at(t=t)) / world.rig.mu_k
    assert factor[0] == pytest.approx(1.0)
    assert np.all(np.diff(factor[np.argsort(world.temperature(t))]) >= -1e-12)


def test_grains_have_a_ceiling_and_an_edge_breaks_off():
    z = draws_of(world_of("girder", friction.scatter_of_askew_grains), 20000) / RIGS_OF_THE_SET["girder"].gap
    assert z.mean(0) == pytest.approx([0.0, 0.0], abs=0.004)
    assert z.std(0) == pytest.approx([0.11, 0.06], rel=0.06)
    assert z[:, 0].max() == pytest.approx(0.11 * (1.0 - np.exp(-0.32)) * np.sqrt(2.0) / (1.0 - np.exp(-0.64)), rel=0.01)
    assert np.abs(np.corrcoef(z[1:, 0], z[:-1, 0])[0, 1]) < 0.03
    world = world_of("organ", friction.correlated_by_a_built_up_edge)
    level = draws_of(world, 40000)[:, 0] / world.rig.mu_s / 0.05
    assert (level.mean(), level.std()) == pytest.approx((0.0, 1.0), abs=0.05)
    assert np.mean(level == level.min()) == pytest.approx(1 / 8, abs=0.01)


def test_ripples_and_tones_have_no_mean():
    spots, mains = (world_of("wedge", f, cycles=99.0) for f in (mechanism.load_of_hot_spots, mechanism.belt_on_sagging_mains))
    tone = world_of("wedge", mechanism.force_of_a_phase_control)
    strength = tone.nominal.gap * tone.nominal.normal_force
    for turn, ripple, size in (
        (9.1, lambda t: spots.normal(at(t=t)) / spots.normal_force - 1.0, 0.18),
        (1.43, lambda t: mains.belt(t) / mains.belt_velocity - 1.0, 0.42),
        (1.0 / 1.23, lambda t: tone.load(at(t=t)) / strength, 0.52),
    ):
        values = ripple(np.linspace(0.0, 10.0 * turn * tone.nominal.period, 100001)[:-1])
        assert values.mean() == pytest.approx(0.0, abs=2e-3)
        assert np.ptp(values) == pytest.approx(size, rel=0.04)


def test_a_leaf_on_a_block_by_its_differential_equation():
    world = world_of("fader", mechanism.stiffness_on_a_round_block)
    k, place = world.rig.stiffness, 0.7 * world.nominal.reach
    for load in (0.5, 1.0, 1.6, 2.0):  # bending stiffness, length and radius are 1: the leaf touches from a load of 1 on
        rest = min(1.0 / load, 1.0)
        touches = 1.0 - rest  # there it has the block's height and slope
        free = solve_bvp(
            lambda x, y, load=load: np.array([y[1], load * (1.0 - x)]),
            lambda first, last, c=touches: np.array([first[0] - 0.5 * c * c, first[1] - c]),
            np.linspace(touches, 1.0, 50),
            np.zeros((2, 50)),
        )
        tip = free.y[0, -1] * 3.0  # over that at the first touch, a third
        assert [world.spring(at(x=side * tip * place)) for side in (1.0, -1.0)] == pytest.approx(
            [load * k * place, -load * k * place], rel=1e-3
        )


def test_bolts_and_a_mast():
    world = world_of("sash", mechanism.backlash_of_three_bolts)
    rig, gap = world.rig, 0.1 * world.rig.slip_length
    x = rig.reach - 0.6 * rig.slip_length + gap * np.array([-0.5, 0.1, 0.4, 0.8, 1.1, 1.4, 1.7])
    stiffness = [(world.spring(at(x=one + 1e-3 * gap)) - world.spring(at(x=one))) / (1e-3 * gap * rig.stiffness) for one in x]
    assert stiffness == pytest.approx([1.0, 2 / 3, 1 / 3, 0.0, 1 / 3, 2 / 3, 1.0], abs=1e-6)
    for root, mass in ((1.8751041, 0.6131), (4.6940911, 0.1883)):  # of a clamped rod
        sigma = (np.cosh(root) + np.cos(root)) / (np.sinh(root) + np.sin(root))
        z = root * np.linspace(0.0, 1.0, 20001)
        bend = np.cosh(z) - np.cos(z) - sigma * (np.sinh(z) - np.sin(z))
        assert bend.mean() ** 2 / np.mean(bend**2) == pytest.approx(mass, abs=3e-4)


def test_sensors_show_what_they_should():
    world = world_of("sash", sensor.clipping_of_an_air_gauge)
    slip, begins = world.rig.slip_length, world.rig.reach - 0.45 * world.rig.slip_length
    shown = (world.sensor(None, at(position=begins + slip * np.array([-0.3, 0.0, 0.002, 0.45, 9.0])), None) - begins) / slip
    assert shown == pytest.approx([-0.3, 0.0, 0.002, 0.1966, 0.2309], abs=2e-4)
    world = world_of("organ", sensor.delay_of_a_slow_device)
    t = np.arange(400) / world.rig.rate
    late = (t - world.sensor(t, at(position=t), None))[50:]
    assert late == pytest.approx(np.full(350, round(0.5 / world.nominal.pulsation * world.rig.rate) / world.rig.rate))
    world = world_of("wedge", sensor.outliers_of_sparkle_codes)
    off = world.sensor(np.arange(400000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length / 0.5
    assert np.mean(off != 0.0) == pytest.approx(0.01, rel=0.06)
    assert set(np.log2(np.abs(off[off != 0.0]))) == {0.0, -1.0, -2.0, -3.0, -4.0, -5.0}
