"""The known effects of the sixteenth set keep what the pages on discovery and datasets ask of a record."""

import re

import numpy as np
import pytest

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.fifteenth.rigs import RIGS_OF_THE_SET
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate

from . import friction, mechanism, sensor

KNOWN = {name: form for name, form in FORMS.items() if form.series == 16 and not form.truth & {UNKNOWN, NONE}}


def world_of(apply, rig: str = "sash", *, load: float = 1.0, cycles: float = 1.0, direction: float = 1.0) -> World:
    """A rig as believed, to which a form is applied at full strength."""
    rig = RIGS_OF_THE_SET[rig]
    speed = direction * rig.belt_velocity
    world = World(rig, rig, speed, load * rig.normal_force, cycles * rig.period, np.random.default_rng(0))
    apply(world, 1.0)
    return world


def at(**numbers):
    """A state of which these numbers are known."""
    return type("At", (), numbers)


def test_there_is_one_form_for_each_name():
    assert len(KNOWN) == 26
    assert sorted(kind for form in KNOWN.values() for kind in form.truth) == sorted(KINDS)
    assert {form.rig for form in KNOWN.values()} == set(RIGS_OF_THE_SET)
    assert all(form.apply.__doc__ for form in KNOWN.values())
    assert all(re.search(r"\b(1[789]|20)\d\d\b", form.source) for form in KNOWN.values())
    earlier = {name for name, form in FORMS.items() if form.series < 16}
    for name in KNOWN:
        own = name.removeprefix("sixteenth_")
        assert not any(other == own or other.endswith(f"th_{own}") or other.endswith(f"rd_{own}") for other in earlier)


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
    series_checks.assert_stick_slip(KNOWN[name], 161, share=0.21, sticks=2)  # five cycles


@pytest.mark.parametrize("name", KNOWN)
def test_no_strength_is_no_form(name):
    series_checks.assert_no_strength_is_no_form(KNOWN[name], share=0.05)


@pytest.mark.parametrize("name", ["scatter_normal", "correlated_ornstein_uhlenbeck", "impacts_of_a_drop_hammer"])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(KNOWN[f"sixteenth_{name}"])


def test_laws_of_speed_and_slip_have_their_values():
    world = world_of(friction.weakening_exponential)
    rig, top = world.rig, world.nominal.peak_speed
    more = [(world.mu_k(at(w=u * top)) - rig.mu_k) / rig.gap for u in (0.0, 0.25, 0.5)]
    assert more == pytest.approx([0.55, 0.2023, 0.0744], abs=1e-4)
    oil = world_of(friction.viscous_of_an_oil_film, load=2.0)
    drag = [(oil.mu_k(at(w=u * top)) - rig.mu_k) * 2.0 / rig.gap for u in (0.0, 0.5, 1.0)]  # a force, whatever the load
    assert drag == pytest.approx([0.0, 0.2, 0.4])
    gouge = world_of(friction.lag_to_a_twentieth)
    left = [(gouge.mu_k(at(slip=n * rig.slip_length, slip_time=0.0)) - rig.mu_k) / rig.gap for n in (0.0, 0.15, 0.3)]
    assert left == pytest.approx([0.9, 0.9 * np.sqrt(0.05), 0.045])


def test_rest_strengthens_by_as_much_with_each_doubling():
    world = world_of(friction.dwell_logarithmic)
    aged = (world.mu_s(at(dwell=world.rig.period * np.array([0.0, 1.0, 100.0, 200.0]))) - world.rig.mu_s) / world.rig.gap
    assert aged[1] == pytest.approx(0.0, abs=1e-12)
    assert aged[3] - aged[2] == pytest.approx(0.22 * np.log(2.0), rel=1e-3)
    assert world.rig.mu_s + aged[0] * world.rig.gap > world.rig.mu_k


def test_levels_hang_on_direction_and_load_to_a_power():
    for direction, factor in ((1.0, 0.95), (-1.0, 1.05)):
        world = world_of(friction.asymmetry_of_two_levels, direction=direction)
        both = world.mu_s(at()) / world.rig.mu_s, world.mu_k(at(direction=direction)) / world.rig.mu_k
        assert both == pytest.approx((factor, factor))
    worlds = [world_of(friction.load_by_a_power, load=load) for load in (1.0, 16.0)]
    assert [world.mu_k(at()) / world.rig.mu_k for world in worlds] == pytest.approx([1.0, 0.5])


def test_debris_ploughs_late():
    world = world_of(friction.distance_of_ploughing_debris)
    up = world.mu_k(at(slid=world.rig.slip_length * np.array([0.0, 14.0, 1e3]))) / world.rig.mu_k - 1.0
    assert up == pytest.approx([0.0, 0.1011, 0.16], abs=1e-4)


def test_a_jenkins_element_and_a_spring_in_series_share_the_travel():
    world = world_of(friction.presliding_of_a_jenkins_element)
    motion, rig = simulate(world, np.linspace(0.0, world.duration, 2001)), world.rig
    yields = rig.mu_s * rig.normal_force / (0.12 * rig.slip_length)
    i = slice(1000, 2000)  # it has rung out, and holds yet
    rate = np.polyfit(motion.time[i], motion.position[i], 1)[0] / rig.belt_velocity
    assert rate == pytest.approx(yields / (yields + rig.stiffness), rel=5e-3)


def test_a_level_forgets_in_six_cycles():
    world = world_of(friction.correlated_ornstein_uhlenbeck, cycles=30000.0)
    level = (world.mu_s(at(t=world.rig.period * np.arange(30000))) / world.rig.mu_s - 1.0) / 0.05
    memory = [np.mean(level[n:] * level[: level.size - n]) for n in (0, 6, 12)]
    assert memory == pytest.approx([1.0, np.exp(-1.0), np.exp(-2.0)], abs=0.1)


def test_the_mechanism_has_its_balances():
    world = world_of(mechanism.backlash_of_a_clevis)
    rig, middle = world.rig, world.rig.reach - 0.5 * world.rig.slip_length
    force = world.spring(at(x=middle + rig.slip_length * np.array([-0.1, 0.0, 0.06, 0.12, 0.22]))) - rig.stiffness * middle
    assert force / rig.stiffness / rig.slip_length == pytest.approx([-0.1, 0.0, 0.0, 0.0, 0.1])
    strip = world_of(mechanism.stiffness_of_a_clamped_strip)
    assert strip.spring(at(x=-rig.reach)) == pytest.approx(-1.5 * rig.stiffness * rig.reach)
    belt = world_of(mechanism.belt_of_a_cogging_motor, cycles=15.0)
    assert belt.travel(14.0 * rig.period) == pytest.approx(14.0 * rig.period * rig.belt_velocity, rel=1e-3)
    assert belt.belt(np.linspace(0.0, belt.duration, 9999)).min() > 0.5 * rig.belt_velocity


def test_a_bracket_and_a_held_box_have_the_bracket_s_frequency():
    world = world_of(mechanism.mode_of_a_bracket)
    matrix = np.array([world.rates(at(q=q, a=0.0)) for q in np.eye(2)]).T
    assert np.abs(np.linalg.eigvals(matrix)) == pytest.approx([2.1 * world.rig.pulsation] * 2)
    assert world.load(at(q=(1.0, 0.0))) == pytest.approx(0.2 * world.rig.mass * (2.1 * world.rig.pulsation) ** 2)


def test_the_sensor_is_late_clipped_and_spiked_as_said():
    rig, t = RIGS_OF_THE_SET["sash"], np.arange(200000) / 260.0
    late = world_of(sensor.delay_of_a_bus).sensor(t[:400], at(position=3.0 + t[:400]), None)
    assert (3.0 + t[:400] - late)[60:] == pytest.approx(0.05 * 2 * np.pi / rig.pulsation)
    level = world_of(sensor.clipping_of_a_converter).sensor(t, at(position=rig.reach), None)
    assert level == pytest.approx(rig.reach - 0.3 * rig.slip_length)
    off = world_of(sensor.outliers_of_tukey).sensor(t, at(position=0.0), np.random.default_rng(1)) / rig.slip_length
    assert np.mean(off != 0.0) == pytest.approx(0.01, rel=0.06)
    assert off[off != 0.0].std() == pytest.approx(0.3, rel=0.06)
