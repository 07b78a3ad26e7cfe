"""What no effect describes, in the twenty-first set: finite records that each form moves, and the physics of some of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.joint_generator import series_checks, slider
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.unseen_sixteenth.test_sixteenth_nameless import drive_and_motion, relative
from tests.discovery.joint_generator.unseen_twentieth.nameless import usual

from .nameless import asked_of_a_weak_supply, first_order, ring_slows, suction

SERIES = series_checks.Series(21)
NAMES = [name for name in SERIES.forms if name.startswith("unknown.")]
UNDRIVEN = [name for name in SERIES.undriven if name in NAMES]
JOINTS = [name for name in NAMES if name not in UNDRIVEN]


def for_seconds(name, design=None, *, lasts=12.0, strength=1.0):
    made = SERIES.short(f"unknown.{name.removeprefix('unknown.')}", design=design, strength=strength)
    return replace(made, nominal=replace(made.nominal, duration=lasts), true=replace(made.true, duration=lasts))


def left_over(made, mass=1.0):
    """What moves a slide beyond its motor, friction and drag [N]; its speed, time, command and what the motor gives."""
    states, n = made.states(0)[0], made.true.numbers
    t, v = np.arange(len(states)) / made.nominal.rate, states[:, 2]
    force = mass * n["inertia"] * np.gradient(v, t) + states[:, 6] + n["damping"] * v + n["offset"] - states[:, 7]
    return force, v, t, states[:, 4] * made.nominal.gain, states[:, 7]


def test_there_are_fourteen_sourced_forms_of_names_of_their_own():
    assert len(NAMES) == 14
    assert not {*SERIES.misplaced(), *SERIES.unsourced()} & set(NAMES)
    assert not SERIES.repeated_names() & {name.split(".")[1] for name in NAMES}


@pytest.mark.parametrize("name", JOINTS)
@pytest.mark.parametrize(("strength", "floors"), [(1.0, 10.0), (0.5, 5.0)])
def test_a_record_is_finite_and_moved_by_many_noise_floors(name, strength, floors):
    for design in SERIES.forms[name].designs:
        made = for_seconds(name, design, lasts=7.0, strength=strength)
        series_checks.assert_finite(made.record(0))
        assert series_checks.columns_moved(made) > floors


@pytest.mark.parametrize("name", UNDRIVEN)
def test_sliders_and_throws_are_finite_moved_and_repeatable(name):
    for strength, floors in ((1.0, 20.0), (0.5, 10.0)):
        series_checks.assert_finite(SERIES.shown(name, strength=strength))
        assert series_checks.undriven_moved(SERIES, name, strength=strength) > floors
    series_checks.assert_same(SERIES.shown(name), SERIES.shown(name))
    assert series_checks.undriven_moved(SERIES, name, strength=0.0) == 0.0


@pytest.mark.parametrize("name", JOINTS)
def test_the_same_seed_gives_the_same_record_and_no_strength_no_effect(name):
    made = for_seconds(name, lasts=1.5)
    series_checks.assert_same(made.record(0), replace(made, effects=SERIES.short(name).effects).record(0))
    none = for_seconds(name, lasts=1.5, strength=0.0)
    series_checks.assert_same(none.record(0), replace(none, effects=()).record(0))


def test_cushions_drag_outwards_alone_and_beyond_half_the_reach():
    more, q, v, _ = drive_and_motion(made := for_seconds("cushioned_cylinder_ends", "slide"))
    far, quick, most = np.abs(q) / made.nominal.reach, np.abs(v) > 0.05 * made.nominal.speed, np.abs(more).max()
    assert np.sum(more * v) > 0.99 * np.sum(np.abs(more * v)) > 0.0
    assert np.abs(more[quick & ((q * v < 0.0) | (far < 0.49))]).max() < 0.01 * most
    full = quick & (q * v > 0.0) & (far > 0.52)
    drag = 2.0 * made.effects[0].parameters["size"] * (far - 0.5) * (v / made.nominal.speed) ** 2 * np.sign(v)
    assert relative((more - drag)[full], drag[full]) < 0.05


def test_air_relaxes_an_unbalance_runs_up_and_a_hopper_loses_its_mass_evenly():
    force, v, t, *_ = left_over(made := for_seconds("trapped_air_leaks_out", "slide"))
    k, time = (made.effects[0].parameters[name] for name in ("stiffness", "time"))
    air = solve_ivp(lambda s, y: k * np.interp(s, t, v) - y / time, (0.0, t[-1]), [-force[5]], t_eval=t, max_step=2e-3).y[0]
    assert relative(force + air, air) < 0.1
    force, _, t, *_ = left_over(made := for_seconds("unbalance_runs_up", "slide"))
    crossings = t[1:][np.diff(np.sign(np.convolve(force, np.ones(9) / 9.0, "same"))) != 0]
    last = made.effects[0].parameters["last"]
    assert np.median(0.5 / np.diff(crossings[crossings > 11.0])) == pytest.approx(last, rel=0.1)
    assert np.quantile(np.abs(force[t > 11.0]), 0.98) == pytest.approx(made.effects[0].parameters["size"], rel=0.2)
    kept, _, t, *_ = left_over(made := for_seconds("hopper_runs_empty", "slide"))
    evenly = left_over(made, 1.0 + made.effects[0].parameters["share"] * (0.5 - t / 12.0))[0]
    assert relative(evenly[5:-5], kept[5:-5]) < 0.1


def test_supplies_teeth_and_lands_take_what_they_say():
    force, v = np.linspace(-0.9, 0.9, 61), np.cos(np.arange(61))
    u = asked_of_a_weak_supply(force, v, 0.25)
    np.testing.assert_allclose(u * (1.0 - 0.25 * u * v), force, atol=1e-12)
    made = for_seconds("battery_sags_under_power", "hinge")
    states, share = made.states(0)[0], made.effects[0].parameters["share"]
    power = states[:, 4] * made.nominal.gain * states[:, 2] / (usual(made.nominal) * made.nominal.speed)
    assert 0.4 < 4.0 * share * power.max() < 1.1
    *_, command, given = left_over(made := for_seconds("teeth_saturate_at_high_current", "slide", lasts=4.0))
    bent = command / (1.0 + (command / made.effects[0].parameters["bend"]) ** 2) ** 0.25
    assert relative((given - bent)[1:], bent[1:]) < 0.1  # given is of the step before
    *_, command, given = left_over(made := for_seconds("lands_overlap_the_ports", "slide", lasts=4.0))
    left = command - np.clip(command, -(zone := made.effects[0].parameters["zone"]), zone)
    assert relative((given - left)[1:], left[1:]) < 0.1


def test_a_low_pass_rounds_and_clocks_agree_in_the_mean():
    t = np.arange(4000) * 1e-3
    np.testing.assert_allclose(first_order((t > 0.5).astype(float), 1e-3, 0.05)[600], 1.0 - np.exp(-0.1 / 0.05), atol=3e-3)
    np.testing.assert_allclose(first_order(t, 1e-3, 0.05)[-1], t[-1] - 0.05, atol=1e-3)
    effect = SERIES.short("unknown.clocks_of_two_loggers_differ", design="slide").effects[0]
    late = t - effect.measure({"time [s]": t, "position [m]": t}, np.random.default_rng(0))["position [m]"]
    assert late.mean() == pytest.approx(0.0, abs=1e-9)
    assert (late[-1] - late[0]) / t[-1] == pytest.approx(effect.parameters["skew"])


def test_tendons_rub_the_shoulder_and_shaking_the_other_joint_loosens():
    made = for_seconds("elbow_tendon_wraps_the_shoulder", lasts=6.0)
    record, plain = made.record(0), replace(made, effects=()).record(0)
    v = np.gradient(plain[positions(plain)[0]], plain["time [s]"])
    rubs = record[drives(record)[0]] - plain[drives(record)[0]]
    assert np.sum(rubs * v) > 0.95 * np.sum(np.abs(rubs * v)) > 0.0
    states, place = (made := for_seconds("other_joint_shakes_it_loose", lasts=6.0)).states(0)[0], made.true.place
    own, other = np.abs(states[:, 2 + place]), np.abs(states[:, 3 - place]) / made.nominal.speed
    lasting = np.minimum(own[:-1], own[1:]) > 0.1 * made.nominal.speed
    expected = made.true.coulomb[place] * (1.0 - made.effects[0].parameters["share"] * other[1:][lasting])
    np.testing.assert_allclose(np.abs(states[1:, 6][lasting]), expected, rtol=0.02)


def test_pores_suck_and_fill_as_their_equations_say():
    t = np.arange(1200) / slider.RATE
    speed, way, time = np.where(t < 12.0, 1e-6, 1e-5), 8e-6, 3.0
    after = t[600:] - t[600]
    ratio = speed[-1] / way
    exact = ratio / (ratio - 1.0 / time) * (np.exp(-after / time) - np.exp(-ratio * after))
    shown = suction(t, np.concatenate([[0.0], np.cumsum(speed[:-1])]) / slider.RATE, way, time)
    np.testing.assert_allclose(shown[:600], 0.0, atol=1e-9)
    np.testing.assert_allclose(shown[600:], exact, atol=0.02)


def test_a_ring_loses_what_its_points_rub_and_a_spinning_puck_goes_farther():
    for v, rim in ((1.0, 0.3), (0.4, 1.0)):
        angle = 2.0 * np.pi * (np.arange(2000) + 0.5) / 2000
        rubs = np.mean(np.hypot(v - rim * np.sin(angle), rim * np.cos(angle)))
        assert np.dot([v, rim], ring_slows(v, rim)) == pytest.approx(rubs, rel=1e-3)
    assert ring_slows(0.01, 1.0)[0] == pytest.approx(0.005, rel=1e-2)
    spins, slides = (SERIES.shown("unknown.puck_spins_as_it_slides", strength=s)["position [m]"][-1] for s in (1.0, 0.0))
    assert spins > 1.1 * slides
