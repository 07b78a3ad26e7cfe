"""The unknown forms and the nulls of the eighteenth set keep what the pages on discovery and datasets ask of a record."""

import re
from types import SimpleNamespace as At  # a state or a motion of which a few numbers are known

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.discovery.unseen_forms import series_checks
from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import Case, make_runs, noise, rig_of

from .nameless import ALIKE
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 18 and form.truth & {UNKNOWN, NONE}}
UNKNOWNS = [name for name, form in SET.items() if UNKNOWN in form.truth]
NULLS = [name for name, form in SET.items() if NONE in form.truth]
OF_THE_SENSOR = [name for name in UNKNOWNS if re.search("charge|hum|play|logger|arm|telegraph", name)]
SLIPS = [name.removeprefix("eighteenth_") for name in UNKNOWNS if re.search("rubber|freight|bounces|gouge", name)]
BELTS = ("battery_of_the_drive_runs_down", "drive_pauses", "box_creeps_after_each_slip")


def made(name: str, *, cycles: float = 8.0):
    """Return a world of the rig as believed with the form, and its times."""
    rig = rig_of(SET[f"eighteenth_{name}"])
    world = World(rig, rig, rig.belt_velocity, rig.normal_force, cycles * rig.period, np.random.default_rng(0))
    SET[f"eighteenth_{name}"].apply(world, 1.0)
    return world, np.arange(0.0, world.duration, 1.0 / rig.rate)


def shown(name: str, position, *, cycles: float = 8.0):
    """Return the world, its times and what the sensor shows of the position (a function of time)."""
    world, t = made(name, cycles=cycles)
    return world, t, world.sensor(t, At(position=position(t)), np.random.default_rng(1))


def rates_in_slip(name: str, world: World, t, x, y, u):
    """Return the rates of velocity and of the further unknown, written anew."""
    rig, w, friction = world.rig, world.nominal.pulsation, world.rig.mu_k * world.normal_force
    plain, period = friction - rig.stiffness * x - rig.damping * y, world.nominal.period
    if name.startswith("rubber"):
        return (plain - 0.3 * rig.stiffness * u) / rig.mass, y - 4.0 * u / period
    if name.startswith("freight"):
        pull = 0.175 * rig.slip_length * w**2 * np.tanh((y - u) / (0.02 * rig.peak_speed))
        return plain / (0.7 * rig.mass) - 3.0 / 7.0 * pull, pull
    if name.startswith("box"):
        return (plain - 0.4 * friction * np.exp(-0.3 * w * t) * np.sin(3.0 * w * t)) / rig.mass, 0.0
    return (plain + friction * u) / rig.mass, 0.2 * abs(world.belt_velocity - y) / rig.slip_length - 2.0 * u / period


def test_the_set_is_as_wide_as_asked_for():
    assert (len(UNKNOWNS), len(NULLS)) == (14, 12)
    assert all(len(form.truth) == 1 and form.apply.__doc__ for form in SET.values())
    assert all({SET[name].rig for name in names} == set(RIGS_OF_THE_SET) for names in (UNKNOWNS, NULLS))
    assert all(form.truth_one - form.truth in (set(), set(ALIKE)) for form in SET.values())
    assert not {name.removeprefix("eighteenth_") for name in SET} & set(KINDS)
    assert all(re.search(r"\b(1[6789]|20)\d\d\b", form.source) for form in SET.values())


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_and_stick_and_slip(name):
    series_checks.assert_preconditions(SET[name])
    series_checks.assert_stick_slip(SET[name], 181, share=0.21, sticks=2)


@pytest.mark.parametrize("name", UNKNOWNS)
def test_an_unknown_form_is_plain_at_full_strength_clear_at_half_and_gone_at_none(name):
    sizes, half = series_checks.sizes_moved(SET[name])
    assert any(sizes[key] > 20.0 and half[key] > 5.0 for key in sizes)
    series_checks.assert_no_strength_is_no_form(SET[name], share=0.05)
    run, twin = (make_runs(Case(SET[name], "one", 1.0), 3, strength=strength, share=0.06)[0] for strength in (1.0, 0.0))
    assert np.array_equal(run.motion.position, twin.motion.position) == (name in OF_THE_SENSOR)


@pytest.mark.parametrize("name", ["drive_pauses", "telegraph_in_the_amplifier", "scatter_of_each_slip_is_declared"])
def test_the_same_seed_makes_the_same_record_and_another_one_does_not(name):
    series_checks.assert_repeatable(SET[f"eighteenth_{name}"])


@pytest.mark.parametrize("name", NULLS)
def test_a_null_moves_as_stated_and_shows_little_besides(name):
    form, rig = SET[name], rig_of(SET[name])
    run = make_runs(Case(form, "one", 1.0), 5, share=0.1)[0]
    world, t = run.world, run.motion.time
    plain = World(world.rig, world.nominal, world.belt_velocity, world.normal_force, world.duration, world.rng)
    if "declared" not in form.options:
        np.testing.assert_array_equal(simulate(plain, t).position, run.motion.position)
    written = noise(str(form.options.get("noise", "white")), rig.noise, t.size, np.random.default_rng(0))
    late = 0.0 if form.options.get("stamped") else (t - np.arange(t.size) / rig.rate) * run.motion.velocity
    assert 0.9 * rig.noise < np.std(run.reading - run.motion.position + written + late) < 1.6 * rig.noise
    for key, sd in series_checks.stated(form).items():
        off = abs(getattr(world.rig, key) / getattr(rig, key) - 1.0) / sd
        assert off == pytest.approx(2.0) if "at_limits" in form.options else off <= 1.5 + 1e-12


@pytest.mark.parametrize(("name", "size"), [("wandering_is_declared", 0.005), ("scatter_of_each_slip_is_declared", 0.006)])
def test_scatter_is_as_large_as_declared(name, size):
    world, _ = made(name, cycles=3000.0)
    assert SET[f"eighteenth_{name}"].options["declared_sigma"] == size
    times = world.nominal.period * np.arange(3000)
    drawn = [(world.on_stick(At()), world.mu_s(At(t=t)), world.mu_k(At(t=t)))[1:] for t in times]
    z = (np.array(drawn) - [world.rig.mu_s, world.rig.mu_k]) / size
    assert (*z.mean(0), *z.std(0)) == pytest.approx((0.0, 0.0, 1.0, 1.0), abs=0.08)


def test_instruments_show_a_ramp_as_their_equations_say():
    world, t, leaks = shown("charge_of_the_gauge_leaks", lambda t: 3.0 * t)
    tau = 0.4 * world.nominal.period
    np.testing.assert_allclose(leaks, 3.0 * tau * (1.0 - np.exp(-t / tau)), atol=1e-9 * tau)
    world, t, arm = shown("arm_of_the_target_rings", lambda t: 3.0 * t)
    fall, free = 3.0 * world.nominal.pulsation * np.array([0.03, np.sqrt(1.0 - 0.03**2)])
    np.testing.assert_allclose(arm, 3.0 * (t - np.exp(-fall * t) * np.sin(free * t) / free), atol=1e-9)
    world, t, play = shown("play_in_the_linkage_of_the_gauge", np.sin)
    assert np.abs(play - np.sin(t)).max() == pytest.approx(0.05 * world.nominal.slip_length)
    world, t, jumps = shown("telegraph_in_the_amplifier", lambda t: 0.0 * t, cycles=60.0)
    assert np.unique(np.round(jumps / world.nominal.noise, 6)) == pytest.approx([0.0, 50.0])
    assert 50 < np.count_nonzero(np.diff(jumps)) < 110


@pytest.mark.parametrize("name", BELTS)
def test_a_belt_that_is_uneven_runs_as_far_as_its_speed_says_and_never_back(name):
    world, _ = made(name, cycles=8.0)
    world.on_stick(At(t=0.0))
    t, h = np.linspace(0.0, world.duration, 100_001, retstep=True)
    v, rate = world.belt(t), world.belt_acceleration(t)
    assert -1e-9 < v.min() / world.belt_velocity < 0.95
    assert np.gradient(world.travel(t), h)[2:-2] == pytest.approx(v[2:-2], abs=0.005 * world.belt_velocity)
    assert np.gradient(v, h)[2:-2] == pytest.approx(rate[2:-2], abs=0.02 * np.abs(rate).max())


@pytest.mark.parametrize("name", SLIPS)
def test_mechanisms_slip_as_another_integrator_says(name):
    world, t = made(name, cycles=5.0)
    rig, v, motion = world.rig, world.belt_velocity, simulate(world, t)
    (begins, place), hold = motion.breaks[2], world.rig.mu_s * world.normal_force
    force = rig.stiffness * place + rig.damping * v  # what must be held at break-away
    first = {"r": (hold - force) / (0.3 * rig.stiffness), "f": v, "b": 0.0, "w": force / hold - 1.0}[name[0]]

    def rates(t, y):
        return [y[1], *rates_in_slip(name, world, t, *y)]

    t = np.linspace(0.0, 10.0 / rig.pulsation, 20001)
    slip = solve_ivp(rates, (0.0, t[-1]), [place, v, first], t_eval=t, rtol=1e-8, max_step=t[40])
    end = 10 + np.argmax(slip.y[1, 10:] >= v)
    assert begins + t[end] == pytest.approx(motion.sticks[3, 0], abs=2e-3 / rig.pulsation)
    assert slip.y[0, end] == pytest.approx(motion.sticks[3, 1], abs=1e-3 * rig.slip_length)
    assert motion.friction_work < 0.0
