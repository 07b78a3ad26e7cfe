"""The rigs and the known effects of the seventeenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate

from . import friction, mechanism, sensor
from .rigs import RIGS_OF_THE_SET

KNOWN = {name: form for name, form in FORMS.items() if form.series == 17 and not form.truth & {UNKNOWN, NONE}}


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
    own = {name.removeprefix("seventeenth_") for name in KNOWN}
    assert not own & {re.sub(r"^[a-z]+th_", "", name) for name, form in FORMS.items() if form.series < 17}
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
    series_checks.assert_stick_slip(KNOWN[name], 171, share=0.21, sticks=2)  # five cycles
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)
    series_checks.assert_repeatable(KNOWN[name], KNOWN[name].designs[0])
    world = world_of(KNOWN[name].rig, KNOWN[name].apply, cycles=4.0, direction=-1.0 if "lips" in name else 1.0)
    assert simulate(world, np.arange(0.0, world.duration, 1.0 / world.rig.rate)).friction_work < 0.0


def test_a_slip_with_petroff_s_film_is_that_of_a_better_damped_oscillator():
    world = world_of("caliper", friction.viscous_of_petroff, cycles=3.0)
    motion = simulate(world, np.arange(0.0, world.duration, 1.0 / world.rig.rate))
    rig, v = world.rig, world.belt_velocity
    film = 0.4 * rig.gap * rig.normal_force / rig.peak_speed  # N s/m
    (begins, start), ends = motion.breaks[0], motion.sticks[motion.sticks[:, 0] > motion.breaks[0, 0]][0]

    def rates(t, y):
        pull = rig.mu_k * rig.normal_force + film * (v - y[1]) - rig.damping * y[1] - rig.stiffness * y[0]
        return [y[1], pull / rig.mass]

    t = np.linspace(begins, ends[0], 7)[1:-1]
    other = solve_ivp(rates, (begins, ends[0]), [start, v], t_eval=t, rtol=1e-10, atol=1e-12).y[0]
    assert np.interp(t, motion.time, motion.position) == pytest.approx(other, abs=0.005 * rig.slip_length)


def test_friction_laws_at_a_few_places():
    world = world_of("ring", friction.weakening_of_tustin)
    more = [world.mu_k(at(w=u * world.nominal.peak_speed)) - world.rig.mu_k for u in (0.0, 0.2, 0.4)]
    assert np.array(more) / world.rig.gap == pytest.approx([0.5, 0.5 / np.e, 0.5 / np.e**2])
    world = world_of("ring", friction.dwell_of_dieterich)
    grown = [(world.mu_s(at(dwell=u * world.nominal.period)) - world.rig.mu_s) / world.rig.gap for u in (1.0, 2.5, 0.5)]
    assert grown == pytest.approx([0.0, 0.25 * np.log(51 / 21), 0.25 * np.log(11 / 21)])
    world = world_of("pig", friction.load_of_schallamach, load=8.0)
    assert [world.mu_s(None), world.mu_k(None)] == pytest.approx([0.275, 0.19])
    world = world_of("pig", friction.asymmetry_of_bent_lips, direction=-1.0)
    assert [world.mu_s(None), world.mu_k(at(direction=-1.0))] == pytest.approx([1.09 * 0.55, 1.12 * 0.38])


def test_soil_is_a_hyperbola_whose_inverse_is_right():
    world = world_of("caisson", friction.presliding_of_kondner)
    for share in (0.0, 0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share)
    z = 0.1 * world.nominal.slip_length * np.linspace(0.1, 1.0, 10)
    over = z / np.array([world.contact(one, 0.0, 1.0) for one in z])  # a straight line, as Kondner plotted it
    assert np.diff(over) == pytest.approx(np.full(9, over[1] - over[0]))


def test_what_varies_with_place_way_and_warmth():
    world = world_of("ring", friction.position_of_popovic)
    turn = 8.7 * world.nominal.slip_length
    wave = world.mu_s(at(travel=turn * np.arange(256) / 256, x=0.0)) / world.rig.mu_s - 1.0
    assert 2.0 * np.abs(np.fft.rfft(wave))[:4] / 256 == pytest.approx([0.0, 0.07, 0.035, 0.0], abs=1e-12)
    world = world_of("ring", friction.distance_of_a_worn_coating)
    rise = world.mu_k(at(slid=world.nominal.slip_length * np.array([0.0, 18.0, 90.0]))) / world.rig.mu_k - 1.0
    assert rise == pytest.approx([0.0, 0.07, 0.14], abs=1e-3)
    world = world_of("curtain", friction.temperature_of_thinning_oil, cycles=60.0)
    t = np.linspace(0.0, world.duration, 501)
    factor = world.mu_k(at(t=t)) / world.rig.mu_k
    assert np.polyfit(world.temperature(t), np.log(factor), 1) == pytest.approx([-0.013, 0.26])
    assert 0.8 < factor.min() < 0.95 < factor[0] == pytest.approx(1.0)


def test_scatter_is_independent_and_the_level_forgets():
    world = world_of("ring", friction.scatter_of_rabinowicz)
    rows = np.array([(world.on_stick(None), world.mu_s(None), world.mu_k(None))[1:] for _ in range(20000)])
    z = (rows - (world.rig.mu_s, world.rig.mu_k)) / world.rig.gap
    assert z.std(0) == pytest.approx([0.12, 0.05], rel=0.03)
    assert np.corrcoef([z[1:, 0], z[1:, 1], z[:-1, 0]]) == pytest.approx(np.eye(3), abs=0.03)
    world = world_of("ring", friction.correlated_of_uhlenbeck, cycles=4.0e4)
    level = (world.mu_s(at(t=np.arange(0.0, world.duration, 5.0 * world.nominal.period))) / world.rig.mu_s - 1.0) / 0.045
    assert (level.mean(), level.std()) == pytest.approx((0.0, 1.0), abs=0.06)
    assert np.corrcoef(level[1:], level[:-1])[0, 1] == pytest.approx(1.0 / np.e, abs=0.05)


def test_springs_and_a_bracket():
    world = world_of("curtain", mechanism.backlash_of_a_worn_hole)
    rig, gap = world.rig, 0.1 * world.rig.slip_length
    x = rig.reach - 0.55 * rig.slip_length + gap * np.array([-0.5, 0.0, 0.5, 1.0, 1.5])
    assert world.spring(at(x=x)) / rig.stiffness - x == pytest.approx(gap * np.array([0.0, 0.0, -0.5, -1.0, -1.0]))
    world = world_of("pig", mechanism.stiffness_of_duffing)
    believed = world.rig.stiffness * world.nominal.reach
    assert [world.spring(at(x=u * world.nominal.reach)) / believed for u in (-1.0, 0.5)] == pytest.approx([-1.3, 0.5375])
    world = world_of("caliper", mechanism.mode_of_a_loose_bracket)
    rest = at(q=(1.0, 0.0), a=0.0)  # drawn out by a metre
    assert -world.rates(rest)[1] == pytest.approx((2.4 * world.nominal.pulsation) ** 2)
    assert world.load(rest) == pytest.approx(-0.125 * world.rig.mass * world.rates(rest)[1])


def test_sensors_show_what_they_should():
    world = world_of("ring", sensor.delay_of_a_resistor_and_a_capacitor)
    t, tau = np.arange(600) / world.rig.rate, 0.5 / world.nominal.pulsation
    shown = world.sensor(t, at(position=np.where(t > 0.0, 1.0, 0.0)), None)
    assert shown == pytest.approx(-np.expm1(-t / tau), abs=1e-9)  # of a step
    world = world_of("ring", sensor.outliers_of_a_wide_normal)
    off = world.sensor(np.arange(400000), at(position=0.0), np.random.default_rng(1)) / world.nominal.slip_length
    assert (np.mean(off != 0.0), off[off != 0.0].std()) == pytest.approx((0.009, 0.2), rel=0.06)
