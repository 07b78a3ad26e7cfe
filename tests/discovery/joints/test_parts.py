"""The parts: windows, fits, the memory law, timing, confounding, against what is known in closed form."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.balance.force_balance import slipped
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import PlainBalances
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, chosen_window
from stochfric_mb.discovery.inference.noise import independent_count, white_noise
from stochfric_mb.discovery.velocity_step.rate_and_state import AGEING, friction_path
from stochfric_mb.errors import InputError
from stochfric_mb.laws import make_law
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.mechanisms import BeltBox, HingePendulum, JointLoop, PrismaticJoint, ProportionalDerivative
from stochfric_mb.scenario import Scenario, any_scenario_from_dict

H = 1.0e-3


def sine_run(friction, *, mass=2.0, delay=0.0, noise=1.0e-6, seed=0, role="fit", start=0.0, gain=1.0):
    """A mass moved along two sines, ``gain`` times as far as usual, with the force that it takes; exact but for noise."""
    rng = np.random.default_rng(seed)
    t = start + H * np.arange(8000)

    def motion(time):
        q = 0.1 * np.sin(4.0 * time) + 0.03 * np.sin(9.0 * time + 1.0)
        v = 0.4 * np.cos(4.0 * time) + 0.27 * np.cos(9.0 * time + 1.0)
        return gain * q, gain * v, gain * (-1.6 * np.sin(4.0 * time) - 2.43 * np.sin(9.0 * time + 1.0))

    q, _, _ = motion(t - delay)
    _, v, a = motion(t)
    force = mass * a + friction(motion(t)[0], v)
    channels = {"position": q + noise * rng.standard_normal(len(t)), "force": force + 0.02 * rng.standard_normal(len(t))}
    return Run(name=f"{role} {seed}", role=role, time=t, channels=channels, sample_interval=H)


def scenario(**changes):
    joint = PrismaticJoint(mass=2.0, normal_force=20.0)
    law = make_law("coulomb", mu_s=0.1, mu_k=0.1)
    values = {
        "mechanism": joint,
        "law": law,
        "duration": 8.0,
        "output_step": 1e-3,
        "uncertainty": {"mass": 0.05, "offset": 0.1},
    }
    return Scenario(**(values | changes))


def balance_of(run, model):
    """The balance of a single run."""
    return PlainBalances(Dataset(title="", scenario_path=None, scenario=model, runs=(run,))).balance(run, "", 0.0, None)


def pair(friction, **keys):
    runs = (sine_run(friction, seed=1, **keys), sine_run(friction, seed=2, role="test", start=20.0, **keys))
    return Dataset(title="", scenario_path=None, scenario=scenario(), runs=runs)


def coulomb(q, v):
    return 2.0 * np.sign(v)


def test_the_balance_of_a_known_motion_is_its_friction():
    balance = balance_of(sine_run(coulomb), scenario())
    side = np.sign(balance.velocity[balance.window.centres])
    # through a window of 8 ms the inertia of the fastest sine is off by (9 rad/s w)^2/30 = 2e-4 of 9 N, below the noise
    noise = np.linalg.norm([balance.window.gain(d) * size for d, size in balance.white.items()])
    np.testing.assert_allclose(balance.driven[balance.sliding], 2.0 * side[balance.sliding], atol=6.0 * noise)


def test_coulomb_friction_alone_names_nothing():
    assert joint_outcome(pair(coulomb)).result.verdict == "none"


def grease(q, v):
    return coulomb(q, v) + 1.5 * v


def stribeck(q, v):
    return coulomb(q, v) * (1.0 + 0.8 * np.exp(-np.abs(v) / 0.1))


def wave(q, v):
    return coulomb(q, v) * (1.0 + 0.3 * np.cos(2.0 * np.pi * q / 0.08))


@pytest.mark.parametrize(
    ("friction", "kind", "name", "truth"),
    [
        (grease, "viscous_friction", "coefficient", 1.5),
        (stribeck, "velocity_weakening", "decay_velocity", 0.1),
        (wave, "position_dependent_friction", "wavelength", 0.08),
    ],
)
def test_one_effect_is_named_and_measured(friction, kind, name, truth):
    result = joint_outcome(pair(friction)).result
    assert [e.kind for e in result.effects] == [kind]
    interval = result.effects[0].parameters[name]
    assert interval.low - 0.03 * truth <= truth <= interval.high + 0.03 * truth
    assert result.gap is not None
    assert result.gap.closed is not None
    assert result.gap.closed > 0.9


def cogging(q, v):
    return coulomb(q, v) + 3.0 * np.cos(2.0 * np.pi * q / 0.05 + 1.0)


def test_half_a_sample_of_sampling_and_holding_is_no_further_effect():
    """Beside friction alone it is a small part of what cogging leaves; beside cogging, friction imitates it."""
    result = joint_outcome(pair(cogging, delay=0.5 * H)).result
    assert [e.kind for e in result.effects] == ["position_dependent_force"]
    # a fifth of the tenth by which the error is larger without it
    assert result.gap.augmented == pytest.approx(joint_outcome(pair(cogging)).result.gap.augmented, rel=0.02)


@pytest.mark.parametrize("delay", [0.006, 0.012])
def test_a_delay_beside_an_effect_that_is_larger_is_told_beside_that(delay):
    """Beside friction alone 6 ms took less than 3 % away: two effects were named, and the error was three times the noise."""
    result = joint_outcome(pair(cogging, delay=delay)).result
    assert [e.kind for e in result.effects] == ["sensor_delay", "position_dependent_force"]
    seen = result.effects[0].parameters["delay"]
    assert seen.low <= delay <= seen.high
    assert seen.high - seen.low < 5.0e-4  # half a sample: the drive changes by thirty times its noise in that


def worn_patch(q, v):
    return coulomb(q, v) * (1.0 + 0.4 * np.exp(-(((q - 0.03) / 0.04) ** 2)))


def soft_stop(q, v):
    return coulomb(q, v) + 1.5 * np.log1p(np.exp((q - 0.05) / 0.01)) / np.log1p(np.exp(5.0))


@pytest.mark.parametrize(
    ("force", "kind", "size"), [(worn_patch, "position_dependent_friction", 0.4), (soft_stop, "position_dependent_force", None)]
)
def test_along_the_stroke_any_smooth_shape_has_its_name(force, kind, size):
    outcome = joint_outcome(pair(force))
    result = outcome.result
    assert [e.kind for e in result.effects] == [kind]
    assert result.gap.closed > 0.9
    course = result.effects[0].parameters["course"]
    if size is not None:  # of a force, how much is a level and how much an offset of the drive is not told
        assert course.low <= size <= course.high
    effect = next(e for e in outcome.scenario.effects if e.kind == kind)
    assert effect.course == pytest.approx(course.value)
    assert np.abs(effect.shape(np.linspace(0.0, 1.0, 321))).max() == pytest.approx(1.0)


def test_a_slide_is_simulated_again_from_measured_states():
    pytest.importorskip("mujoco", reason="the slide runs in MuJoCo")
    scores = joint_outcome(pair(grease)).places[0].scores
    before, after = scores["recalibrated"].forward, scores["augmented"].forward
    # half a second after a start whose velocity is known to 1e-4 m/s, with a drive that is held for 1 ms
    assert after < 5e-4
    assert before > 10.0 * after


def test_a_delay_is_named_first_and_is_not_friction():
    result = joint_outcome(pair(coulomb, delay=0.012)).result
    assert [e.kind for e in result.effects] == ["sensor_delay"]
    assert result.effects[0].parameters["delay"].value == pytest.approx(0.012, abs=0.001)


def test_friction_that_rises_one_way_and_falls_the_other_is_one_asymmetry():
    def dimples(q, v):
        return np.sign(v) * (2.0 + np.where(v > 0.0, 1.0, -1.0) * (0.8 - 2.0 * np.abs(v)))

    result = joint_outcome(pair(dimples)).result
    assert [e.kind for e in result.effects] == ["direction_asymmetry"]
    assert abs(result.effects[0].parameters["viscous_difference"].value) == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("channel", ["force", "position"])
def test_a_wrong_sign_is_pointed_out_where_inertia_outweighs_friction(channel):
    data = pair(coulomb)
    runs = [dataclasses.replace(r, channels={**r.channels, channel: -r.channels[channel]}) for r in data.runs]
    notes = joint_outcome(dataclasses.replace(data, runs=tuple(runs))).result.notes
    assert "with the drive turned round" in notes[0]
    assert "sign = { force = -1 }" in notes[0]
    assert not any("turned round" in note for note in joint_outcome(data).result.notes)


def test_the_augmented_scenario_reads_back():
    outcome = joint_outcome(pair(grease))
    assert any_scenario_from_dict(outcome.scenario.to_dict()) == outcome.scenario


def test_a_missing_channel_is_named():
    run = sine_run(coulomb)
    bare = dataclasses.replace(run, channels={"position": run.channels["position"]})
    with pytest.raises(InputError, match=r"has no force .*columns = \{ force = ... \}$"):
        balance_of(bare, scenario())
    volts = dataclasses.replace(run, channels=bare.channels | {"voltage": run.channels["force"]})
    with pytest.raises(InputError, match=r"has no force .*or state mechanism.force_gain \[N/V\]"):
        balance_of(volts, scenario())


def settings(friction, zero):
    """Four fit runs and one held out; ``friction(run, q, v)`` and ``zero[run]`` are those of each run."""
    roles = ("fit", "fit", "fit", "fit", "test")
    runs = [
        sine_run(lambda q, v, i=i: friction(i, q, v) + zero[i], seed=i, role=role, start=20.0 * i, gain=0.4 + 0.3 * i)
        for i, role in enumerate(roles)
    ]
    return Dataset(title="", scenario_path=None, scenario=scenario(), runs=tuple(runs))


@pytest.mark.parametrize("seed", [1, 2])
def test_runs_that_differ_for_no_known_reason_name_nothing(seed):
    rng = np.random.default_rng(seed)
    level, zero = 1.0 + 0.06 * rng.standard_normal(5), 0.15 * rng.standard_normal(5)
    result = joint_outcome(settings(lambda i, q, v: level[i] * coulomb(q, v), zero)).result
    assert result.verdict == "none"


def test_what_no_effect_explains_is_unknown_in_several_runs_too():
    rng = np.random.default_rng(5)

    def hump(i, q, v):  # most friction in the middle of the speeds, least at both ends
        return coulomb(q, v) * (1.0 + 0.6 * np.sin(np.pi * np.minimum(np.abs(v), 0.8) / 0.8))

    result = joint_outcome(settings(hump, 0.05 * rng.standard_normal(5))).result
    assert result.verdict == "unknown"
    assert result.where is not None
    assert "speed" in result.where.axis


def test_a_joint_that_rests_is_refused():
    data = pair(coulomb)
    still = [{**r.channels, "position": 1e-6 * np.random.default_rng(0).standard_normal(len(r.time))} for r in data.runs]
    runs = tuple(dataclasses.replace(r, channels=c) for r, c in zip(data.runs, still, strict=True))
    with pytest.raises(InputError, match="slides one way in only"):
        joint_outcome(dataclasses.replace(data, runs=runs))


def test_a_loud_drive_is_told_where_it_leaves_no_window_in_which_the_joint_slides():
    data = pair(coulomb)
    loud = [{**r.channels, "force": r.channels["force"] + noise_of(r, 300.0)} for r in data.runs]
    runs = tuple(dataclasses.replace(r, channels=c) for r, c in zip(data.runs, loud, strict=True))
    with pytest.raises(InputError, match=r"windows are up to .* without noise.*noise of the drive is .* N, beside .* N of"):
        joint_outcome(dataclasses.replace(data, runs=runs))


def noise_of(run, size):
    return size * np.random.default_rng(3).standard_normal(len(run.time))


def test_without_uncertainty_the_mechanism_is_taken_as_exact():
    outcome = joint_outcome(dataclasses.replace(pair(grease), scenario=scenario(uncertainty={})))
    assert [e.kind for e in outcome.result.effects] == ["viscous_friction"]
    assert set(outcome.result.parameters) == {"mu_k"}
    assert outcome.scenario.mechanism == scenario().mechanism


def test_a_controller_of_another_mechanism_is_refused():
    loop = ProportionalDerivative(joints={"joint": JointLoop(position_gain=1.0, reference="goal")})
    with pytest.raises(InputError, match="cannot drive mechanism 'prismatic_joint'"):
        joint_outcome(dataclasses.replace(pair(coulomb), scenario=scenario(controller=loop)))


def test_a_belt_box_is_no_joint():
    box = BeltBox(mass=1.0, damping=0.0, stiffness=1.0, normal_force=1.0, belt_velocity=0.1)
    with pytest.raises(InputError, match="no driven joint"):
        joint_outcome(dataclasses.replace(pair(coulomb), scenario=scenario(mechanism=box)))


def test_noise_sets_the_window_and_not_the_number_of_samples():
    assert chosen_window(H, 4000, {0: 0.01, 2: 0.0}, 1.0).half_width == pytest.approx(8 * H)
    wide = chosen_window(H, 4000, {0: 0.0, 2: 2.0e-5}, 1.0)
    assert wide.gain(2) * 2.0e-5 <= 0.05
    assert 8 * H < chosen_window(H, 4000, {0: 0.0, 2: 1.0}, 1.0).half_width <= 1.5 * 4.0 / 24.0
    fine = chosen_window(H / 5.0, 20000, {0: 0.0, 2: 2.0e-5 * np.sqrt(5.0)}, 1.0)  # as much noise a second
    assert fine.half_width == pytest.approx(wide.half_width, rel=0.45)  # one ratio of the widths that are tried


def test_noise_level_of_white_noise_on_a_slow_signal():
    rng = np.random.default_rng(3)
    signal = np.sin(np.arange(20_000) * 1.0e-3) + 0.1 * rng.standard_normal(20_000)
    assert white_noise(signal) == pytest.approx(0.1, rel=0.03)  # 1/sqrt(2 n) times the inefficiency of a median is 1 %


def test_white_noise_counts_fully_and_coloured_noise_less():
    rng = np.random.default_rng(4)
    white = rng.standard_normal(20_000)
    slow = np.convolve(white, np.ones(10) / 10.0, "valid")
    assert independent_count(white) > 0.8 * len(white)
    # a moving mean over 10 has the integrated autocorrelation 10
    assert independent_count(slow) == pytest.approx(len(slow) / 10.0, rel=0.2)


def test_slip_starts_again_at_reversals():
    q = np.r_[np.linspace(0.0, 1.0, 11), np.linspace(0.9, 0.0, 10)]
    v = np.r_[np.ones(11), -np.ones(10)]
    s = slipped(q, v, 0.1)
    assert s[10] == pytest.approx(1.0)
    assert s[11] == 0.0
    assert s[-1] == pytest.approx(0.9)


def test_the_memory_law_settles_at_a_minus_b_times_the_log_of_the_speed():
    speed = np.r_[np.full(100, 1.0e-6), np.full(3000, 1.0e-5)]
    mu = np.empty(len(speed))
    friction_path(speed, 0.01, 0.01, 0.015, 5.0e-6, 1.0e4, 1.0, 1.0e-6, AGEING, mu)
    assert mu[50] == pytest.approx(0.0, abs=1e-12)
    assert mu[-1] == pytest.approx((0.01 - 0.015) * np.log(10.0), rel=1e-6)
    # a stiff spring shows the direct effect before the memory has faded
    stiff = np.empty(len(speed))
    friction_path(speed, 0.01, 0.01, 0.015, 5.0e-4, 1.0e7, 1.0, 1.0e-6, AGEING, stiff)
    assert stiff.max() == pytest.approx(0.01 * np.log(10.0), rel=0.03)


def test_the_memory_law_converges_with_the_step():
    coarse, fine = (np.r_[np.full(n // 4, 1.0e-6), np.full(3 * n // 4, 1.0e-5)] for n in (400, 1600))
    a, b = np.empty(len(coarse)), np.empty(len(fine))
    friction_path(coarse, 0.04, 0.01, 0.012, 2.0e-5, 2.0e3, 1.0, 1.0e-6, AGEING, a)
    friction_path(fine, 0.01, 0.01, 0.012, 2.0e-5, 2.0e3, 1.0, 1.0e-6, AGEING, b)
    # first order in the step of 5 ms against 1.25 ms; the peak is 0.01
    np.testing.assert_allclose(a, b[::4], atol=3e-4)


def test_windows_leave_out_the_ends():
    w = Window(0.02, H, 1000)
    assert w.centres[0] >= 2 * (len(w.taps) // 2)
    assert w.centres[-1] <= 1000 - 2 * (len(w.taps) // 2)
    np.testing.assert_allclose(w.at_centres(np.full(1000, 3.0)), 3.0, rtol=1e-6)


def test_hinge_pendulum_gravity_is_in_the_balance():
    joint = HingePendulum(mass=1.0, length=0.5, normal_force=1.0)
    t = H * np.arange(4000)
    q = 0.8 * np.sin(2.0 * t)
    torque = 0.25 * (-3.2 * np.sin(2.0 * t)) + 9.81 * 0.5 * np.sin(q)
    run = Run(name="r", role="fit", time=t, channels={"position": q, "torque": torque}, sample_interval=H)
    balance = balance_of(run, scenario(mechanism=joint))
    np.testing.assert_allclose(balance.driven, 0.0, atol=1e-3)  # (2 rad/s 8 ms)^2/30 of 5 N m
