"""The unknown forms and the nulls of the seventeenth set keep what the pages on discovery and datasets ask of a record."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, features, make_runs, rig_of

from .nameless import OF_THE_PLACE
from .rigs import RIGS_OF_THE_SET

SET = {name[12:]: form for name, form in FORMS.items() if form.series == 17 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
OF_THE_SENSOR = [name for name in UNKNOWNS if not re.search("rubber|leaves|gouge|creeps|motor|tank", name)]


def made(name: str, *, strength: float = 1.0, cycles: float = 8.0):
    """Return the world of a form on its rig, its times, its motion, and what the sensor shows of it."""
    rig = rig_of(SET[name])
    world = World(rig, rig, rig.belt_velocity, rig.normal_force, cycles * rig.period, np.random.default_rng(0))
    SET[name].apply(world, strength)
    t = np.arange(0.0, world.duration, 1.0 / rig.rate)
    motion = simulate(world, t)
    return world, t, motion, world.sensor(t, motion, np.random.default_rng(1))


def slips_of(motion) -> np.ndarray:
    """Return rows (from, length, duration) of slips, less the first two."""
    breaks, sticks = motion.breaks[: len(motion.sticks) - 1], motion.sticks[1 : len(motion.breaks) + 1]
    return np.column_stack([breaks[:, 1], breaks[:, 1] - sticks[:, 1], sticks[:, 0] - breaks[:, 0]])[2:]


def ride_of(t, motion, number: int = 4):
    return (t > motion.sticks[number, 0]) & (t < motion.breaks[number, 0])


def test_the_set_is_as_wide_as_asked_for():
    assert (len(UNKNOWNS), len(NULLS)) == (14, 12)
    assert all({SET[name].rig for name in names} == set(RIGS_OF_THE_SET) for names in (UNKNOWNS, NULLS))
    assert all(form.right("several") == form.truth and len(form.truth) == 1 for form in SET.values())
    assert {name.split("_")[0] for name, form in SET.items() if form.right("one") - form.truth} == {"rubber", "leaves", "wet"}
    assert all(form.right("one") - form.truth <= set(OF_THE_PLACE) for form in SET.values())
    assert all(re.search(r"\b(1[6789]|20)\d\d\b", form.source) and form.apply.__doc__ for form in SET.values())


@pytest.mark.parametrize("name", SET)
def test_records_keep_what_the_pages_ask(name):
    series_checks.assert_preconditions(SET[name])
    series_checks.assert_stick_slip(SET[name], 171, share=0.21, sticks=2)


@pytest.mark.parametrize("name", UNKNOWNS)
def test_an_unknown_form_moves_what_is_shown_at_full_strength_and_at_half(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and 5.0 < half[key] < 0.9 * sizes[key] for key in sizes)
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)


@pytest.mark.parametrize("name", OF_THE_SENSOR)
def test_a_form_of_the_sensor_leaves_the_motion_alone(name):
    (_, _, motion, _), (_, _, twin, _) = (made(name, strength=strength) for strength in (1.0, 0.0))
    np.testing.assert_array_equal(motion.position, twin.position)


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_nothing_beyond_the_noise(name):
    run, rig = make_runs(Case(SET[name], "one", 1.0), 3, share=0.2)[0], rig_of(SET[name])
    late = 0.0 if SET[name].options.get("stamped") else run.motion.time - np.arange(run.motion.time.size) / rig.rate
    assert np.abs(run.reading - run.motion.position).max() < rig.noise
    assert np.std(late * run.motion.velocity) < 0.5 * rig.noise
    world = run.world
    if "scatter" in name:
        places = features(run)["break_away"] * world.rig.stiffness / world.normal_force - world.rig.mu_s
        assert 0.5 * 0.003 < np.std(places) < 1.6 * 0.003
    else:
        plain = World(world.rig, rig, world.belt_velocity, world.normal_force, world.duration, world.rng)
        twin = simulate(plain, run.motion.time)
        assert np.abs((run.motion.breaks - twin.breaks)[:, 1]).max() < rig.noise


def test_the_same_seed_makes_the_same_record():
    for name in ("buffers_overrun", "stand_of_the_gauge_sways", "scatter_as_declared"):
        series_checks.assert_repeatable(SET[name])


def test_a_box_creeps_and_a_motor_gives_way_as_their_equations_say():
    for name, most in (("box_creeps_before_it_slips", 0.1), ("motor_gives_way_under_load", 0.75)):
        world, t, motion, _ = made(name)
        rig, v = world.rig, world.belt_velocity
        half, middle = rig.slip_length / 2.0, rig.mu_k * rig.normal_force / rig.stiffness
        top = (rig.mu_s * rig.normal_force - 0.1 * rig.damping * v) / rig.stiffness

        def speed(_, x, name=name, v=v, rig=rig, top=top, half=half, middle=middle):
            return v * (1.0 - (0.9 * np.exp((x - top) / (0.12 * half)) if "creep" in name else 0.25 * (x - middle) / half))

        rides = ride_of(t, motion)
        span = motion.sticks[4, 0], motion.breaks[4, 0]
        sure = solve_ivp(speed, span, motion.sticks[4, 1:], rtol=1e-9, atol=1e-12, dense_output=True)
        assert motion.position[rides] == pytest.approx(sure.sol(t[rides])[0], abs=1e-4 * rig.slip_length)
        assert motion.velocity[rides] == pytest.approx(speed(0.0, motion.position[rides]), abs=1e-3 * v)
        assert motion.velocity[rides][-1] == pytest.approx(most * v, abs=0.1 * v)
        assert motion.breaks[2:, 1] == pytest.approx(rig.reach, rel=1e-3)


def test_forces_take_energy_and_change_slips_as_said():
    slips = {name: [slips_of(made(name, strength=a)[2]) for a in (1.0, 0.0)] for name in UNKNOWNS[:6]}
    moved, plain = slips["wet_gouge_dilates"]
    assert moved[:, 0] == pytest.approx(plain[:, 0].mean(), rel=0.01)
    assert 1.0 / moved[:, 1].mean() == pytest.approx(1.2 / plain[:, 1].mean(), rel=0.03)  # k/(k + mu_k rise)
    moved, plain = slips["rubber_spring_relaxes"]
    assert moved[:, 2].mean() / plain[:, 2].mean() == pytest.approx(1.0 / np.sqrt(1.3), abs=0.03)
    moved, plain = slips["tank_on_the_box_runs_dry"]
    assert moved[:, 1] == pytest.approx(plain[:, 1].mean(), rel=0.02)
    assert np.all(np.diff(moved[:, 2]) < 0.0)
    world = made("leaves_of_the_spring_rub", cycles=3.0)[0]
    most, q, work, step = 0.15 * world.rig.gap * world.rig.normal_force, 0.0, [], 1e-3 * world.rig.slip_length
    for turn in np.repeat([1.0, -1.0] * 4, 2000):  # to and fro, two slips each
        q += step * world.rates(SimpleNamespace(v=turn, q=(q,)))[0]
        work.append(world.load(SimpleNamespace(q=(q,))) * turn * step)
    assert (abs(q), -sum(work[-4000:])) == pytest.approx((most, 4.0 * most * world.rig.slip_length * (1.0 - 0.2)), rel=0.02)


def test_sensors_show_what_is_said_of_them():
    world, t, motion, shown = made("arm_of_the_feeler_rings")
    ride = ride_of(t, motion)
    waves = np.diff(np.sign(np.diff((shown - motion.position)[ride])))
    assert np.sum(waves != 0) == pytest.approx(np.ptp(t[ride]) * 6.0 * world.rig.pulsation / (2 * np.pi), rel=0.1)
    world, t, motion, shown = made("box_nods_as_friction_pulls")
    rate = np.gradient(shown, t)[ride_of(t, motion)] / world.belt_velocity
    assert rate[rate.size // 2] == pytest.approx(1.15, abs=0.01)
    world, t, motion, shown = made("tracker_overshoots")
    off = ((shown - motion.position) / world.rig.slip_length)[(t > motion.breaks[4, 0]) & (t < motion.breaks[5, 0])]
    assert (off.max(), off.min(), off[-1]) == pytest.approx((0.03, -0.03, 0.0), abs=0.02)
    gauge, t, motion, shown = made("strain_gauge_has_hysteresis")
    off = (motion.position - shown) / gauge.rig.slip_length
    assert (off[t > t[-1] / 3].min(), off.max()) == pytest.approx((-0.042, 0.042), abs=1e-4)
    buffers, t, motion, _ = made("buffers_overrun", cycles=60.0)
    lost = (buffers.sensor(t, SimpleNamespace(position=t), None) - t)[t < 50.0 * buffers.rig.period] / buffers.rig.period
    assert np.unique(np.round(np.diff(lost), 6)) == pytest.approx([0.0, 0.05], abs=1e-5)
    leaks, t, _, _ = made("charge_leaks_from_the_amplifier")
    mean = leaks.rig.mu_k * leaks.rig.normal_force / leaks.rig.stiffness
    fading = leaks.sensor(t, SimpleNamespace(position=mean + np.ones(t.size)), None) - mean
    assert fading == pytest.approx(np.exp(-t / (2.0 * leaks.rig.period)), abs=0.01)
