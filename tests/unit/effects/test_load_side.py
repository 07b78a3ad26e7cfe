"""A load that moves by itself behind the motor of a joint: closed forms of its force."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stochfric_mb.effects import effect_class, make_effect
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.load_side import FINE, QUICKEST, Link, MotorMotion, load_force
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import load_scenario

H = 1.0e-3


def motion(position, inertia=2.0, gravity=0.0, interval=H):
    """A motor that moves so, its rates by differences."""
    velocity = np.gradient(position, interval)
    n = len(position)
    held = gravity * np.stack([np.sin(position), np.cos(position), -np.sin(position)])
    return MotorMotion(interval, position, velocity, np.gradient(velocity, interval), inertia, held, (2, n - 2))


@pytest.mark.parametrize(("drive", "ratio", "drag"), [(1.0, 0.05, 0.0), (3.0, 0.1, 0.0), (9.0, 0.3, 0.0), (3.0, 0.05, 5.0)])
def test_a_load_on_a_spring_answers_a_sine_as_its_transfer_function_says(drive, ratio, drag):
    # q_l/q_m = (d s + k)/(J s^2 + (d + d_l) s + k), Spong 1987; after ten decay times the start is forgotten
    inertia, frequency = 0.7, 5.0
    w, t = 2.0 * np.pi * frequency, np.arange(0.0, 25.0, H)
    s = 2.0j * np.pi * drive
    follows = (2.0 * ratio * w * s + w**2) / (s**2 + (2.0 * ratio * w + drag / inertia) * s + w**2)
    q = 0.01 * np.sin(2.0 * np.pi * drive * t)
    expected = np.imag((inertia * s**2 + drag * s) * 0.01 * (follows - 1.0) * np.exp(s * t))
    force = load_force(motion(q), Link(inertia, frequency, ratio, damping=drag))
    late = slice(20_000, -10)
    # frequency to FINE^2/24 and differences to (w_drive h)^2/6, both of the load's own force
    tolerance = (FINE**2 / 24.0 / ratio + (abs(s) * H) ** 2) * inertia * abs(s) ** 2 * 0.01 * abs(follows)
    assert np.abs(force - expected)[late].max() < tolerance


@pytest.mark.parametrize("gap", [0.0, 0.08])
def test_a_hanging_load_moves_as_another_integrator_moves_it(gap):
    # a pendulum behind spring or gap, no friction; SciPy's Runge-Kutta of order 8 takes the motion as a function
    inertia, gravity, frequency, ratio = 0.6, 4.0, 3.0, 0.2
    k = inertia * (2.0 * np.pi * frequency) ** 2
    d = 2.0 * ratio * np.sqrt(k * inertia)
    t = np.arange(0.0, 1.5, H)

    def place(at):
        return 0.8 * np.sin(4.0 * at) + 0.3 * np.sin(7.0 * at)

    def rate(at):
        return 3.2 * np.cos(4.0 * at) + 2.1 * np.cos(7.0 * at)

    def carried(at, q, v):
        s = place(at) - q
        beyond = s - np.clip(s, -0.5 * gap, 0.5 * gap)
        force = k * beyond + d * (rate(at) - v) * ((beyond != 0.0) | (gap == 0.0))
        return np.where((gap > 0.0) & (force * beyond < 0.0), 0.0, force)

    motor = motion(place(t), inertia=1.0, gravity=gravity)
    force = load_force(motor, Link(inertia, frequency, ratio, gap))
    own = force + gravity * np.sin(motor.position) + inertia * motor.acceleration  # what the link carries
    # both begin where the link carries what the load needs as it follows
    need = inertia * (rate(3.0 * H) - rate(2.0 * H)) / H + gravity * np.sin(place(2.0 * H))
    start = [place(2.0 * H) - need / k - 0.5 * gap * np.sign(need), rate(2.0 * H)]
    seen = solve_ivp(
        lambda at, y: [y[1], (carried(at, *y) - gravity * np.sin(y[0])) / inertia],
        (2.0 * H, t[-3]), start, method="DOP853", t_eval=t[2:-2], rtol=1.0e-7, atol=1.0e-9, max_step=4.0e-3,
    )  # fmt: skip
    expected = carried(seen.t, *seen.y)
    # a step h errs by h w of the force; a blow within a step, by that step
    assert np.sqrt(np.mean((own[2:-2] - expected) ** 2)) < 2.0 * np.pi * frequency * H * np.sqrt(np.mean(expected**2))


def test_a_load_on_a_stiff_link_follows():
    t = np.arange(0.0, 4.0, H)
    q = 0.1 * np.sin(3.0 * t)
    stiff = load_force(motion(q, gravity=5.0), Link(1.0, 1.0e6, 0.5, friction=0.3))
    soft = load_force(motion(q, gravity=5.0), Link(1.0, 2.0, 0.5, friction=0.3))
    turns = np.abs(np.cos(3.0 * t)) < 0.1  # a link is no stiffer than a sample: friction turns within a few
    assert 1.0 / (2.0 * np.pi) * QUICKEST / H > 100.0
    assert np.abs(stiff[10:-10][~turns[10:-10]]).max() < 0.02 * np.abs(soft).max()


def test_within_a_gap_the_motor_carries_nothing():
    gap, friction, inertia = 2.0e-3, 0.4, 0.5
    t = np.arange(0.0, 4.0, H)
    q = 0.01 * np.abs(((t / 2.0) % 2.0) - 1.0)  # there and back at 5 mm/s: at every turn the gap is crossed in 0.4 s
    motor = motion(q, inertia=1.0)
    force = load_force(motor, Link(inertia, 40.0, 0.5, gap, friction))
    carried = force + friction * np.sign(motor.velocity) + inertia * motor.acceleration
    crossing, beyond = (t > 2.05) & (t < 2.35), (t > 2.6) & (t < 3.9)
    assert np.abs(carried[crossing]).max() < 1.0e-15
    assert np.abs(carried[beyond] - friction).max() < 0.02 * friction  # slides at the motor's speed


def test_a_free_oscillation_starts_as_large_as_it_is_told():
    t = np.arange(0.0, 1.0, H)
    force = load_force(motion(np.zeros(len(t))), Link(1.0, 5.0, 0.0, start=(0.3, 0.4)))
    angle = 2.0 * np.pi * 5.0 * (t - 2.0 * H)
    expected = 0.3 * np.cos(angle) - 0.4 * np.sin(angle)
    assert np.abs(force - expected)[2:-2].max() < 0.5 * np.hypot(0.3, 0.4) * 2.0 * np.pi * 5.0 * H + 0.01


def test_it_is_a_driven_joint_alone_that_has_such_a_load():
    base = load_scenario("kang2015_table1")
    for effect in (
        make_effect("joint_compliance", load_share=0.5, frequency=5.0),
        make_effect("backlash", gap=1.0e-3, load_share=0.5),
    ):
        assert effect.moves_load
        with pytest.raises(InputError, match="driven joint"):
            dataclasses.replace(base, effects=(effect,))
    assert not make_effect("backlash", gap=1.0e-3, position=1.0e-3).moves_load


SPAN = JointSpan(
    speed=0.5, stroke=0.2, lowest=0.0, duration=1.0, load=0.0, both_ways=False, friction=2.0, distance=0.2,
    temperature=None, contact=False, stated_load=20.0, window=0.01, inertia=0.5,
)  # fmt: skip
"""A slide."""


@pytest.mark.parametrize("driven", [True, False])
def test_no_load_swings_behind_a_motor_that_is_not_there(driven):
    """Blocks that a thrown one took along were a compliance."""
    assert (effect_class("joint_compliance").at_joint(dataclasses.replace(SPAN, drive=driven)) is not None) == driven


@pytest.mark.parametrize(("frequency", "seen"), [(0.4, False), (0.6, True)])
def test_a_load_that_swings_more_slowly_than_the_record_lasts_does_not_show(frequency, seen):
    """A pressure in another unit was a load of 0.0017 Hz in 10 s."""
    slow = make_effect("joint_compliance", load_share=0.5, frequency=frequency)
    assert slow.seen_at_joint(dataclasses.replace(SPAN, duration=2.0)) is seen


@pytest.mark.parametrize(("friction", "references"), [(2.0, [3.0, 10.0, 40.0]), (5.0, [10.0, 40.0]), (50.0, [200.0])])
def test_no_fit_of_load_dependence_begins_where_the_joint_locks_itself(friction, references):
    """Friction that grows with the drive as fast as it does leaves nothing of any drive: all else then seemed faint."""
    span = dataclasses.replace(SPAN, load=10.0, friction=friction)
    begun = effect_class("load_dependence").at_joint(span)
    assert [e.reference_load for e in begun.starts] == pytest.approx(references)
