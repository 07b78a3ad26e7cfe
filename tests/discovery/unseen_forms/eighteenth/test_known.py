"""The rigs and the known effects of the eighteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate

from . import friction, mechanism, sensor
from .rigs import RIGS_OF_THE_SET

KNOWN = {name: form for name, form in FORMS.items() if form.series == 18 and not form.truth & {UNKNOWN, NONE}}


def world_of(name: str, apply, *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0) -> World:
    rig = RIGS_OF_THE_SET[name]
    speed = direction * rig.belt_velocity
    world = World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))
    apply(world, 1.0)
    return world


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def test_there_is_one_form_for_each_name_and_rigs_are_read_as_laboratories_read_them():
    assert len(KNOWN) == 26
    assert sorted(kind for form in KNOWN.values() for kind in form.truth) == sorted(KINDS)
    assert {form.rig for form in KNOWN.values()} == set(RIGS_OF_THE_SET)
    for name, form in KNOWN.items():
        assert form.apply.__doc__
        assert re.search(r"\b(1[6789]|20)\d\d\b", form.source), name
    own = {name.removeprefix("eighteenth_") for name in KNOWN}
    assert not own & {re.sub(r"^[a-z]+th_", "", name) for name, form in FORMS.items() if form.series < 18}
    for rig in RIGS_OF_THE_SET.values():
        assert 45.0 < rig.rate * 2 * np.pi / rig.pulsation < 150.0
        assert 300.0 < rig.slip_length / rig.noise < 2000.0


@pytest.mark.parametrize("name", KNOWN)
def test_a_form_keeps_the_preconditions_and_moves_what_is_shown_by_tens_of_floors(name):
    series_checks.assert_preconditions(KNOWN[name])
    sizes, half = series_checks.sizes_moved(KNOWN[name])
    assert max(sizes.values()) > 20.0
    assert 5.0 < max(half.values()) < 0.9 * max(sizes.values())


@pytest.mark.parametrize("name", KNOWN)
def test_it_is_stick_slip_takes_energy_is_nothing_without_strength_and_a_seed_makes_one_record(name):
    series_checks.assert_stick_slip(KNOWN[name], 181, share=0.21, sticks=2)  # five cycles
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)
    series_checks.assert_repeatable(KNOWN[name], KNOWN[name].designs[0])
    world = world_of(KNOWN[name].rig, KNOWN[name].apply, cycles=4.0, direction=-1.0 if "two_pairs" in name else 1.0)
    assert simulate(world, np.arange(0.0, world.duration, 1.0 / world.rig.rate)).friction_work < 0.0


@pytest.mark.parametrize("rig", ["finger", "brush"])
def test_a_slip_over_junctions_is_that_of_an_oscillator_whose_friction_falls_with_the_slip(rig):
    world = world_of(rig, friction.lag_over_a_junction, cycles=3.0)
    motion = simulate(world, np.arange(0.0, world.duration, 1.0 / world.rig.rate))
    rig, v = world.rig, world.belt_velocity
    (begins, start), ends = motion.breaks[0], motion.sticks[motion.sticks[:, 0] > motion.breaks[0, 0]][0]

    def rates(t, y):
        slip = max(v * (t - begins) - (y[0] - start), 0.0)
        mu = rig.mu_k + 0.9 * rig.gap * np.exp(-slip / 0.06 / rig.slip_length)
        return [y[1], (mu * rig.normal_force - rig.damping * y[1] - rig.stiffness * y[0]) / rig.mass]

    t = np.linspace(begins, ends[0], 7)[1:-1]
    other = solve_ivp(rates, (begins, ends[0]), [start, v], t_eval=t, rtol=1e-10, atol=1e-12).y[0]
    assert np.interp(t, motion.time, motion.position) == pytest.approx(other, abs=0.005 * rig.slip_length)


def test_friction_laws_at_a_few_places():
    world = world_of("barn", friction.weakening_of_bo_and_pavelescu)
    more = [world.mu_k(at(w=u * world.nominal.peak_speed)) - world.rig.mu_k for u in (0.0, 1 / 6, 16 ** (4 / 3) / 6)]
    assert np.array(more) / world.rig.gap == pytest.approx([0.5, 0.5 / np.e, 0.5 * np.exp(-16.0)])
    world = world_of("bolt", friction.dwell_of_coulomb)
    grown = [(world.mu_s(at(dwell=u * world.nominal.period)) - world.rig.mu_s) / world.rig.gap for u in (0.0, 1.0, 32.0)]
    assert grown == pytest.approx([-0.8, 0.0, 0.8])
    world = world_of("pallet", friction.load_of_a_round_rider, load=8.0)
    assert [world.mu_s(None), world.mu_k(None)] == pytest.approx([0.225, 0.15])
    for direction, shares in ((1.0, [1.0, 1.0]), (-1.0, [13 / 12, 1.1])):
        world = world_of("furnace", friction.asymmetry_of_two_pairs, direction=direction)
        assert [world.mu_s(None) / 0.22, world.mu_k(at(direction=direction)) / 0.14] == pytest.approx(shares)
    world = world_of("finger", friction.presliding_of_bristles)
    force = world.contact(0.02 * world.nominal.slip_length, 0.0, 3.0)
    assert (force, world.contact_deflection(0.25)) == pytest.approx((0.75, 0.02 * world.nominal.slip_length))


def test_what_varies_with_time_way_and_warmth():
    world = world_of("barn", friction.drift_of_running_in)
    down = world.mu_s(at(t=world.nominal.period * np.array([0.0, 16.0, 1e3]))) / world.rig.mu_s - 1.0
    assert down == pytest.approx([0.0, -0.125 * (1.0 - 1.0 / np.e), -0.125])
    world = world_of("barn", friction.distance_of_wear_particles)
    up = world.mu_k(at(slid=world.nominal.slip_length * np.array([0.0, 4.0, 15.0, 25.0]))) / world.rig.mu_k - 1.0
    assert up == pytest.approx([0.0, 0.0086, 0.079, 0.1172], abs=1e-4)
    world = world_of("bolt", friction.temperature_of_fade, cycles=60.0)
    t = np.linspace(0.0, world.duration, 501)
    factor = world.mu_k(at(t=t)) / world.rig.mu_k
    assert np.polyfit(world.temperature(t), factor, 1) == pytest.approx([-0.016, 1.32])
    assert 0.8 < factor.min() < 0.9 < factor[0] == pytest.approx(1.0)


def test_scatter_goes_together_in_part_and_the_level_forgets_slip_by_slip():
    world = world_of("bolt", friction.scatter_of_new_asperities)
    rows = np.array([(world.on_stick(None), world.mu_s(None), world.mu_k(None))[1:] for _ in range(20000)])
    z = (rows - (world.rig.mu_s, world.rig.mu_k)) / world.rig.gap
    assert z.std(0) == pytest.approx([0.1, 0.05], rel=0.03)
    assert np.corrcoef([z[1:, 0], z[1:, 1], z[:-1, 0]])[np.triu_indices(3, 1)] == pytest.approx([0.6, 0.0, 0.0], abs=0.03)
    world = world_of("bolt", friction.correlated_by_autoregression)
    level = np.array([(world.on_stick(None), world.mu_s(None))[1] for _ in range(40000)]) / world.rig.mu_s - 1.0
    assert (level.mean(), level.std()) == pytest.approx((0.0, 0.045), abs=0.004)
    assert [np.corrcoef(level[n:], level[:-n])[0, 1] for n in (1, 4)] == pytest.approx([0.85, 0.85**4], abs=0.04)


def test_coils_that_close_leave_a_stiffer_spring_and_a_nut_leaves_the_force():
    world = world_of("furnace", mechanism.stiffness_of_closing_coils)
    reach, k = world.nominal.reach, world.rig.stiffness
    for u in (-0.9, 0.3, 0.7, 1.0):  # force from compliances in a row: those coils count that are open
        other = quad(lambda y: k / (1.0 - 0.8 * max(y / reach - 0.4, 0.0)), 0.0, abs(u) * reach, points=[0.4 * reach])[0]
        assert world.spring(at(x=u * reach)) == pytest.approx(np.sign(u) * other)
    world = world_of("pallet", mechanism.backlash_of_a_loose_nut)
    rig, gap = world.rig, 0.1 * world.rig.slip_length
    x = rig.reach - 0.5 * rig.slip_length + gap * np.array([-0.5, 0.0, 0.5, 1.0, 1.5])
    assert world.spring(at(x=x)) / rig.stiffness - x == pytest.approx(gap * np.array([0.0, 0.0, -0.5, -1.0, -1.0]))


def test_a_belt_leaves_a_circle_that_turns_about_a_point_off_its_middle():
    world = world_of("brush", mechanism.belt_of_an_eccentric_bore, cycles=4.6)
    turn = 2.3 * world.nominal.period
    assert (world.travel(turn), world.travel(2.0 * turn)) == pytest.approx(world.belt_velocity * turn * np.array([1.0, 2.0]))
    speed = world.belt(np.linspace(0.0, turn, 2001))
    assert speed.max() / speed.min() == pytest.approx(1.25 / 0.75, rel=1e-4)


def test_sensors_show_what_they_should():
    world = world_of("finger", sensor.delay_of_a_pipeline)
    t = np.arange(600) / world.rig.rate
    shown = world.sensor(t, at(position=2.0 * t), None)
    assert shown == pytest.approx(2.0 * np.maximum(t - 0.4 / world.nominal.pulsation, 0.0))
    world = world_of("bolt", sensor.outliers_of_specks)
    off = world.sensor(np.arange(400000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length
    assert (np.mean(off != 0.0), 3.0 * np.abs(off).max()) == pytest.approx((0.01, 1.0), rel=0.05)
