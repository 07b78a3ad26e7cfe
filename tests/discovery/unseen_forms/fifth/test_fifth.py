"""The rigs and forms of the fifth set are sane physics and keep what the pages on discovery and datasets ask of a record."""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.discovery.unseen_forms.forms import FORMS, KINDS, NONE, UNKNOWN
from tests.discovery.unseen_forms.motion import World, simulate
from tests.discovery.unseen_forms.records import REVERSED, UNCERTAINTY, Case, cases, make_runs, points, rig_of
from tests.discovery.unseen_forms.rigs import Rig

from .friction import correlated_bounded, load_ploughs, presliding_arc_tangent
from .mechanism import force_of_a_quick_return, stiffness_of_a_rubber_rod
from .nameless import block_beside, guide_rubs
from .rigs import RIGS_OF_THE_SET

SET = {name: form for name, form in FORMS.items() if form.series == 5}
NULLS = [name for name, form in SET.items() if NONE in form.truth]


def world_of(rig: Rig, cycles: float, *, speed: float = 1.0, load: float = 1.0) -> World:
    duration = cycles * rig.period / speed
    return World(rig, rig, speed * rig.belt_velocity, load * rig.normal_force, duration, np.random.default_rng(0))


def runs_of(name: str, *, strength: float = 1.0, share: float = 0.15) -> list:
    return make_runs(Case(SET[name], SET[name].designs[0], 1.0), 3, strength=strength, share=share)


def test_the_set_is_as_wide_as_asked_for():
    families = {name: next((word for word in (NONE, UNKNOWN) if word in form.truth), "named") for name, form in SET.items()}
    named = [form for name, form in SET.items() if families[name] == "named"]
    unknown = [form for name, form in SET.items() if families[name] == UNKNOWN]
    assert len(SET) >= 44
    assert {kind for form in named for kind in form.truth} == set(KINDS)
    assert len(unknown) >= 15
    assert sum(form.truth == {UNKNOWN} for form in unknown) > 0.5 * len(unknown)  # truly without a name
    assert len(NULLS) >= 10
    halves = {(case.form.name, case.design) for case in cases() if case.form.series == 5 and case.strength == 0.5}
    assert halves == {(name, design) for name, form in SET.items() if families[name] != NONE for design in form.designs}


@pytest.mark.parametrize("name", SET)
def test_records_keep_the_preconditions_of_the_page(name):
    form, rig = SET[name], rig_of(SET[name])
    assert form.rig in RIGS_OF_THE_SET
    stated = form.options.get("uncertainty", UNCERTAINTY)
    stiffest = 1.0 + stated["stiffness"] + stated["mass"]  # of two standard deviations each, half in the root
    assert rig.rate * 2 * np.pi / rig.pulsation / stiffest > 40.0
    assert 50.0 < rig.slip_length / rig.noise < 1e4  # a real sensor has noise, and sees the slips
    fall = rig.mu_s * (1.0 - 2.0 * stated["mu_s"]) - rig.mu_k * (1.0 + 2.0 * stated["mu_k"])
    assert fall > 0.4 * rig.gap  # it sticks and slips, however wrong the stated numbers are
    for design in form.designs:
        fitted = [cycles for _, _, role, cycles in points(Case(form, design, 1.0)) if role == "fit"]
        assert min(fitted) >= 20.0


@pytest.mark.parametrize("speed", [0.4, 2.0])
@pytest.mark.parametrize("name", RIGS_OF_THE_SET)
def test_the_limit_cycle_is_that_of_damped_free_vibration(name, speed):
    rig = RIGS_OF_THE_SET[name]
    v, k, decay = speed * rig.belt_velocity, rig.stiffness, 0.5 * rig.damping / rig.mass
    fast = np.sqrt(rig.pulsation**2 - decay**2)
    top = (rig.mu_s * rig.normal_force - rig.damping * v) / k
    start = top - rig.mu_k * rig.normal_force / k  # from where the box would rest

    def speed_after(t: float) -> float:
        return np.exp(-decay * t) * (v * np.cos(fast * t) - (decay * v + rig.pulsation**2 * start) / fast * np.sin(fast * t))

    slip_time = brentq(lambda t: speed_after(t) - v, np.pi / fast, 1.7 * np.pi / fast, xtol=1e-15)
    at = np.exp(-decay * slip_time) * (start * np.cos(fast * slip_time) + (v + decay * start) / fast * np.sin(fast * slip_time))
    bottom = at + rig.mu_k * rig.normal_force / k
    motion = simulate(world_of(rig, 6.0, speed=speed), np.linspace(0.0, 6.0 * rig.period / speed, 6001))
    # fourth order with 400 steps a natural period: (2 pi/400)^4 and less of a slip
    np.testing.assert_allclose(motion.breaks[2:, 1], top, rtol=1e-10)
    np.testing.assert_allclose(motion.sticks[2:, 1], bottom, atol=1e-7 * rig.slip_length)
    np.testing.assert_allclose(np.diff(motion.breaks[2:, 0]), slip_time + (top - bottom) / v, rtol=1e-7)


def test_a_lip_leaves_the_stated_direction_alone():
    one, none = (runs_of("fifth_asymmetry_of_a_lip", strength=strength) for strength in (1.0, 0.0))
    moved = [np.ptp(a.reading - b.reading) / a.world.nominal.noise for a, b in zip(one, none, strict=True)]
    assert moved[0] == 0.0
    assert min(moved[i] for i in REVERSED[1:]) > 10.0


def test_ploughing_is_none_at_the_stated_load_and_rises_beyond():
    rig = RIGS_OF_THE_SET["rock"]
    factors = []
    for load in (0.5, 1.0, 2.0):
        world = world_of(rig, 1.0, load=load)
        load_ploughs(world, 1.0)
        factors.append(world.mu_s(None) / rig.mu_s)
    assert factors[1] == pytest.approx(1.0, rel=1e-12)
    assert factors[2] - factors[1] > 4.0 * (factors[1] - factors[0]) > 0.0


def test_the_presliding_curve_and_its_inverse_agree():
    world = world_of(RIGS_OF_THE_SET["valve"], 1.0)
    presliding_arc_tangent(world, 1.0)
    for share in (0.2, 0.7, 1.0):
        assert world.contact(world.contact_deflection(share), 0.0, 3.0) == pytest.approx(3.0 * share, rel=1e-9)


def test_the_quick_return_has_no_mean():
    rig = RIGS_OF_THE_SET["bow"]
    world = world_of(rig, 100.0)
    force_of_a_quick_return(world, 1.0)
    state = type("At", (), {"t": np.linspace(0.0, world.duration, 127001)[:-1]})  # 127 turns
    assert abs(np.mean(world.load(state))) < 1e-9 * rig.gap * rig.normal_force


def test_the_rubber_rod_softens_and_is_as_stiff_as_believed_in_the_middle():
    rig = RIGS_OF_THE_SET["wiper"]
    world = world_of(rig, 1.0)
    stiffness_of_a_rubber_rod(world, 1.0)
    x = np.array([0.2, 0.8, 1.4]) * rig.reach  # the middle: 0.4 of a rod of twice the reach
    secant = world.spring(type("At", (), {"x": x})) / x / rig.stiffness
    assert secant[1] == pytest.approx(1.0, rel=1e-12)
    assert np.all(np.diff(secant) < -0.05)


def test_bounded_noise_has_the_spread_and_the_memory_of_the_sine_of_a_random_walk():
    rig = RIGS_OF_THE_SET["valve"]
    world = world_of(rig, 20000.0)
    correlated_bounded(world, 1.0)
    t = np.arange(0.0, world.duration, 0.5 * rig.period)
    z = (world.mu_s(type("At", (), {"t": t})) / rig.mu_s - 1.0) / 0.06
    independent = 20000.0 / 10.0  # spans of twice the correlation time
    assert np.abs(z).max() <= 1.0
    assert np.mean(z**2) == pytest.approx(0.5, abs=4.0 * 0.36 / np.sqrt(independent))
    assert np.mean(z[:-10] * z[10:]) == pytest.approx(0.5 * np.exp(-1.0), abs=4.0 * 0.5 / np.sqrt(independent))


def test_a_rubbing_guide_takes_from_what_holds_and_adds_to_what_slides():
    rig = RIGS_OF_THE_SET["brake"]
    world = world_of(rig, 6.0)
    guide_rubs(world, 1.0)
    motion = simulate(world, np.linspace(0.0, world.duration, 6001))
    force = 0.15 * rig.gap * rig.normal_force
    # in stick it drags at the belt's speed; (mu_k N + force) is where the box would rest in a slip
    expected = (rig.mu_s * rig.normal_force - force * np.tanh(5.0) - rig.damping * rig.belt_velocity) / rig.stiffness
    np.testing.assert_allclose(motion.breaks[2:, 1], expected, rtol=1e-9)
    slips = motion.breaks[2:5, 1] - motion.sticks[2:5, 1]
    np.testing.assert_allclose(slips, (1.0 - 2.0 * 0.15) * rig.slip_length, rtol=0.1)  # damping takes 3 %, the belt gives some


def test_the_block_beside_pulls_by_no_more_than_its_own_friction():
    rig = RIGS_OF_THE_SET["wiper"]
    world = world_of(rig, 5.0)
    block_beside(world, 1.0)
    motion = simulate(world, np.linspace(0.0, world.duration, 5001))
    alone = simulate(world_of(rig, 5.0), motion.time)
    lifted = motion.breaks[2:4, 1] - (rig.mu_s * rig.normal_force - rig.damping * rig.belt_velocity) / rig.stiffness
    most = 0.12 * rig.mu_k * rig.normal_force / rig.stiffness
    assert np.all(np.abs(lifted) < most)
    # it is dragged along for nearly the whole slip, so that the box stops earlier by up to twice that
    higher = motion.sticks[2:4, 1] - alone.sticks[2:4, 1]
    assert np.all((higher > 0.5 * most) & (higher < 2.5 * most))


@pytest.mark.parametrize("name", [name for name in NULLS if not SET[name].options.get("declared")])
def test_a_null_moves_as_the_stated_law_says_and_its_sensor_is_right_within_its_noise(name):
    run = runs_of(name, share=0.05)[0]
    rig = run.world.rig
    plain = World(rig, run.world.nominal, run.world.belt_velocity, run.world.normal_force, run.world.duration, run.world.rng)
    np.testing.assert_array_equal(simulate(plain, run.motion.time).position, run.motion.position)
    assert np.std(run.reading - run.motion.position) < 2.0 * run.world.nominal.noise
    sampling = float(SET[name].options.get("jitter", 0.0)) / run.world.nominal.rate
    assert run.world.nominal.peak_speed * sampling <= 1.05 * run.world.nominal.noise


@pytest.mark.parametrize("name", NULLS)
def test_a_null_is_off_by_no_more_than_is_stated(name):
    form, rig = SET[name], rig_of(SET[name])
    true = runs_of(name, share=0.03)[0].world.rig
    for key, sd in form.options.get("uncertainty", UNCERTAINTY).items():
        assert abs(getattr(true, key) / getattr(rig, key) - 1.0) <= 2.0 * sd + 1e-12
